//! Golden values against generated present ones, and states beside each other: every difference, group, trend and order, whole.
//! And golden files with one edit.

use crate::golden::GoldenFile;
use crate::golden::compare::{case_changes, compare, groups_of};
use crate::golden::measure::{GoldenKey, SpreadKey, key};
use crate::golden::tolerance::spread_by_group;
use crate::history::comparison::{StudyComparison, compare_states};
use crate::history::state::{State, StudyState};
use crate::tests::{assert_snapshot, told};
use oedometer_wording::rounded;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Numbers that are the same on every machine (the generator of Park & Miller 1988).
struct Draw(u64);

impl Draw {
    fn below(&mut self, below: usize) -> usize {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        usize::try_from(self.0).expect("small") / 7 % below
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }
}

/// Golden values of two methods on three meshes: errors of first and second order, counters, critical steps and balances.
fn golden() -> GoldenFile {
    let mut values = BTreeMap::new();
    for (method, order, factor) in [("MPM", 1.0, 0.4_f64), ("GIMP-SRI", 2.0, -0.7)] {
        for cells in [5.0, 10.0, 20.0_f64] {
            let case = format!("{method} implicit cells={cells} points=2 growth=0.05");
            for (time, measure, value) in [
                (None, "steps", 11.0 * cells),
                (Some(0.1), "pressure points terzaghi", factor.abs() * cells.powf(-order)),
                (Some(0.3), "pressure nodes terzaghi", 0.9 * factor.abs() * cells.powf(-order)),
                (Some(0.3), "settlement surface terzaghi", factor * cells.powf(-order)),
                (Some(0.3), "water balance", 1e-13 * cells),
                (None, "observed critical step", 0.01 / cells),
            ] {
                values.insert(key(&case, time, measure), value);
            }
        }
    }
    GoldenFile { values, ..GoldenFile::of("the-study", &[], "a test") }
}

/// The spread of a case.
fn spread() -> (SpreadKey, f64) {
    let of = key("MPM implicit cells=10 points=2 growth=0.05", 0.1, "pressure points terzaghi");
    (of.spread().expect("a spread"), 2e-4)
}

/// Present values: most as they were, some of a case or of a measure another.
fn present(draw: &mut Draw, golden: &GoldenFile) -> BTreeMap<GoldenKey, f64> {
    let mut found = golden.values.clone();
    let keys: Vec<GoldenKey> = found.keys().cloned().collect();
    for _ in 0..=draw.below(4) {
        let about = draw.one_of(&[
            "MPM",
            "cells=10",
            "GIMP-SRI implicit cells=20",
            "pressure",
            "steps",
            "settlement",
            "critical",
            "water",
            "T_v=0.3",
        ]);
        let factor =
            draw.one_of(&[1.0 + 4e-7, 1.0 + 2e-6, 0.5, 0.97, 1.01, 1.4, 2.0, 3.5, -1.0, 0.0, f64::NAN, 1e9]);
        for key in keys.iter().filter(|key| key.to_string().contains(about)) {
            found.entry(key.clone()).and_modify(|value| *value *= factor);
        }
    }
    if draw.below(3) == 0 {
        found.remove(&keys[draw.below(keys.len())]);
    }
    if draw.below(3) == 0 {
        found.insert(key("VP implicit cells=5", None, "steps"), 7.0);
    }
    found
}

#[test]
fn differences_from_golden_values_are_told_as_they_were() {
    let mut draw = Draw(4_711);
    let mut golden = golden();
    golden.spread = [spread()].into();
    let mut text = String::new();
    for number in 0..24 {
        let found = present(&mut draw, &golden);
        let differences = compare(&golden, &found);
        writeln!(text, "## {number}").expect("memory");
        for one in &differences {
            let [change, growth] =
                [one.relative_change(), one.growth()].map(|value| value.map_or("–".to_owned(), rounded));
            writeln!(text, "{}, changes by {change}, grows {growth}", told(one)).expect("memory");
        }
        for one in case_changes(&differences) {
            writeln!(text, "case {}, stale {}", told(&one), one.is_stale()).expect("memory");
        }
        for group in groups_of(&differences, golden.values.keys().chain(found.keys())) {
            writeln!(text, "group {}", told(&group)).expect("memory");
        }
    }
    assert_snapshot("golden_differences", &text);
}

#[test]
fn states_beside_each_other_are_told_as_they_were() {
    let mut draw = Draw(815);
    let before = golden();
    let mut text = String::new();
    for number in 0..24 {
        let after = GoldenFile { values: present(&mut draw, &before), ..before.clone() };
        let mut states = [&before, &after].map(|golden| StudyState::of_golden(golden.clone()));
        for (state, seconds) in states.iter_mut().zip([0.5, 0.7]) {
            let case = draw.one_of(&["MPM", "GIMP-SRI"]);
            state.seconds = [(case.to_owned(), vec![3.0 * seconds, seconds, 2.5 * seconds])].into();
        }
        let found = StudyComparison::of("the-study", &states[0], &states[1]);
        // The commit of this build is another tomorrow.
        let found = StudyComparison { made_by: Default::default(), ..found };
        writeln!(text, "## {number}: changed {}, regression {}", found.has_changed(), found.is_regression())
            .expect("memory");
        writeln!(text, "{}", told(&found)).expect("memory");
    }
    let state = |name: &str, studies: &[&str]| State {
        name: name.to_owned(),
        studies: studies
            .iter()
            .map(|study| ((*study).to_owned(), StudyState::of_golden(before.clone())))
            .collect(),
        notes: vec![format!("a note on {name}")],
    };
    let (one, other) = (state("one", &["a", "b", "c"]), state("other", &["b", "d", "e"]));
    for only in [&[][..], &["b"], &["a", "e"], &["x", "c"]] {
        let only: Vec<String> = only.iter().map(|name| (*name).to_owned()).collect();
        let (found, notes) = compare_states(&one, &other, &only);
        let names: Vec<&str> = found.iter().map(|one| one.study.as_str()).collect();
        writeln!(text, "only {only:?}: {names:?} {notes:?}").expect("memory");
    }
    assert_snapshot("history_comparisons", &text);
}

#[test]
fn golden_files_with_one_edit_are_read_or_refused_as_they_were() {
    let mut golden = golden();
    golden.spread = [spread()].into();
    golden.cases =
        [("MPM implicit cells=5 points=2 growth=0.05".into(), "0123456789abcdef".to_owned())].into();
    let whole = golden.to_text().expect("a text");
    let back = GoldenFile::from_text(&whole).expect("it is read");
    assert_eq!(back.to_text().expect("a text"), whole);
    let mut text = whole.clone();
    let row = "MPM implicit cells=10 points=2 growth=0.05,,0.1,";
    for (from, to) in [
        ("golden 4", "golden 5"),
        ("golden 4", "golden"),
        ("# golden", "# silver"),
        ("# reason: a test", "# reason: "),
        ("# reason: a test", "# reason:"),
        ("# reason: a test", "# why: a test"),
        ("case,hash,T_v,", "case,hash,T,"),
        ("case,hash,T_v,", "case,T_v,hash,"),
        ("pressure points terzaghi", "pressure points l2 terzaghi"),
        (",steps,", ",point updates,"),
        ("spread of pressure", "spread of heat"),
        (row, "MPM implicit cells=10 points=2 growth=0.05,,0.1,x"),
        (row, "MPM implicit cells=10 points=2 growth=0.05,,0.1,7"),
        (row, "MPM implicit cells=10 points=2 growth=0.05,,0.3,"),
        (row, "MPM implicit cells=10 points=2 growth=0.05,,soon,"),
        ("0.0002", "0.2"),
        ("0.0002", "-0.2"),
        ("110", "inf"),
        ("110", "NaN"),
    ] {
        assert!(whole.contains(from), "{from} in\n{whole}");
        let read = GoldenFile::from_text(&whole.replacen(from, to, 1));
        let said = read.map_or_else(
            |reason| reason.to_string(),
            |golden| format!("{:?}, {} values", golden.out_of_bounds(), golden.values.len()),
        );
        writeln!(text, "{from:?} → {to:?}: {said}").expect("memory");
    }
    let cut = GoldenFile::from_text(whole.trim_end()).expect_err("it is cut");
    writeln!(text, "cut: {cut}").expect("memory");
    assert_snapshot("golden_files", &text);
}

#[test]
fn tolerances_follow_the_spread_of_their_group() {
    let golden = golden();
    let mut draw = Draw(99);
    let moved = |draw: &mut Draw| -> BTreeMap<GoldenKey, f64> {
        let mut moved = golden.values.clone();
        for value in moved.values_mut() {
            *value *= 1.0 + draw.one_of(&[0.0, 1e-14, 3e-9, 2e-6, f64::NAN]);
        }
        moved
    };
    let others = [moved(&mut draw), moved(&mut draw)];
    let spread = spread_by_group(&golden.values, &others);
    let widened = golden.clone().widened_by(spread.clone());
    let mut text = String::new();
    for (key, change) in &spread {
        writeln!(text, "{key}: {}, kept {}", rounded(*change), widened.spread.contains_key(key))
            .expect("memory");
    }
    for (key, value) in &golden.values {
        writeln!(text, "{key}: {}", rounded(widened.tolerance(key, value.abs()))).expect("memory");
    }
    assert_snapshot("golden_tolerances", &text);
}
