//! Two states beside each other: inputs that differ first, then accuracy and cost, apart; and the orders and classes of
//! errors under refinement.

use crate::case::Case;
use crate::golden::compare::{
    CaseChange, Change, Difference, DifferenceGroup, case_changes, cases_apart, compare, groups_of,
};
use crate::golden::inputs::InputChange;
use crate::golden::measure::{GoldenKey, Measure};
use crate::history::state::{State, StudyState};
use crate::measure::round_off::{ITERATIONS, ROUND_OFF};
use crate::measure::statistics::spread;
use oedometer_convergence::{Context, ErrorSeries, SeriesLevel, WINDOW, classify};
use oedometer_wording::count_of;
use std::collections::{BTreeMap, BTreeSet};

/// Where something went from the first state to the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Trend {
    /// Nothing moved beyond its tolerance.
    Same,
    /// Better and nowhere worse.
    Improved,
    /// Better here, worse there.
    Mixed,
    /// Worse and nowhere better.
    Regressed,
}

impl Trend {
    fn of(is_better: bool, is_worse: bool) -> Self {
        match (is_better, is_worse) {
            (false, false) => Self::Same,
            (true, false) => Self::Improved,
            (true, true) => Self::Mixed,
            (false, true) => Self::Regressed,
        }
    }

    /// Whether something got worse.
    pub fn is_regression(self) -> bool {
        matches!(self, Self::Mixed | Self::Regressed)
    }

    /// Its word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::Improved => "improved",
            Self::Mixed => "mixed",
            Self::Regressed => "regressed",
        }
    }
}

/// A study in two states.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StudyComparison {
    /// Its name.
    pub study: String,
    /// Cases that only the first state has, and those that only the second has.
    pub cases_apart: [Vec<String>; 2],
    /// Errors of what both states have; values that only one state has are in `unpaired`.
    pub accuracy: Trend,
    /// Steps.
    pub cost: Trend,
    /// Values that both states have.
    pub values: usize,
    /// Values that only one of the states has.
    pub unpaired: usize,
    /// Inputs that differ; nothing where both states do not know them.
    pub inputs: Vec<InputChange>,
    /// What moved, by kind.
    pub groups: Vec<DifferenceGroup>,
    /// Cases that moved.
    pub changes: Vec<CaseChange>,
    /// Series whose order or class is another. They are shown; accuracy is judged by the errors themselves.
    pub orders: Vec<OrderChange>,
    /// Processor times of the cases that both states timed, before and after. Never judged.
    pub seconds: Option<[Seconds; 2]>,
    /// What made the values, before and after.
    pub made_by: [Vec<String>; 2],
}

/// Processor time of some cases, s.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Seconds {
    /// Sum of the medians over the runs of each case.
    pub median: f64,
    /// Sum of the shortest runs.
    pub least: f64,
    /// Sum of the longest runs.
    pub most: f64,
}

impl Seconds {
    /// Of the cases that two states timed.
    fn of_both(before: &StudyState, after: &StudyState) -> Option<[Self; 2]> {
        let sum = |state: &StudyState, other: &StudyState| {
            let runs = state.seconds.iter().filter(|(case, _)| other.seconds.contains_key(*case));
            let all = runs.filter_map(|(_, runs)| spread(runs)).map(|times| Self {
                median: times.median,
                least: times.minimum,
                most: times.maximum,
            });
            all.reduce(|sum, times| Self {
                median: sum.median + times.median,
                least: sum.least + times.least,
                most: sum.most + times.most,
            })
        };
        Some([sum(before, after)?, sum(after, before)?])
    }
}

impl StudyComparison {
    /// Whether a value or an input is another.
    pub fn has_changed(&self) -> bool {
        !(self.groups.is_empty() && self.inputs.is_empty())
    }

    /// Whether accuracy or cost got worse, or values have gone.
    pub fn is_regression(&self) -> bool {
        let is_missing = self.groups.iter().any(|group| group.change == Change::Missing);
        self.accuracy.is_regression() || self.cost.is_regression() || is_missing
    }

    /// Compares a study's states; tolerances are those of the first.
    pub(crate) fn of(study: &str, before: &StudyState, after: &StudyState) -> Self {
        let values_after = &after.golden.values;
        let seconds = Seconds::of_both(before, after);
        let cases_apart = cases_apart(before.golden.values.keys(), values_after.keys());
        let made_by = [before, after].map(|state| state.made_by.clone());
        let now: Vec<&Case> = after.cases.values().collect();
        let inputs = InputChange::between(&before.cases, &after.cases);
        let (before, _) = before.golden.clone().beside(&now);
        let differences = compare(&before, values_after);
        let (counters, errors): (Vec<&Difference>, Vec<&Difference>) = differences
            .iter()
            .filter(|difference| difference.is_paired())
            .partition(|difference| difference.key.measure == Measure::Steps);
        let grew = |difference: &&Difference| difference.found > difference.golden;
        let cost = Trend::of(counters.iter().any(|difference| !grew(difference)), counters.iter().any(grew));
        let is_better =
            |difference: &&Difference| matches!(difference.change, Change::Stale | Change::Smaller);
        let accuracy =
            Trend::of(errors.iter().any(is_better), errors.iter().any(|difference| !is_better(difference)));
        let keys: BTreeSet<&GoldenKey> = before.values.keys().chain(values_after.keys()).collect();
        Self {
            study: study.to_owned(),
            cases_apart,
            accuracy,
            cost,
            values: before.values.keys().filter(|key| values_after.contains_key(*key)).count(),
            unpaired: differences.iter().filter(|difference| !difference.is_paired()).count(),
            inputs,
            groups: groups_of(&differences, keys),
            changes: case_changes(&differences),
            orders: order_changes(&before.values, values_after, &differences),
            seconds,
            made_by,
        }
    }
}

/// The studies that both states have, and what only one of them has, a sentence each.
pub(crate) fn compare_states(
    before: &State,
    after: &State,
    only: &[String],
) -> (Vec<StudyComparison>, Vec<String>) {
    let wanted = |study: &&String| only.is_empty() || only.contains(study);
    let mut notes: Vec<String> = before.notes.iter().chain(&after.notes).cloned().collect();
    let (mut both, mut gone, mut new) = (Vec::new(), Vec::new(), Vec::new());
    let names: BTreeSet<&String> = before.studies.keys().chain(after.studies.keys()).filter(wanted).collect();
    for name in names {
        match (before.studies.get(name), after.studies.get(name)) {
            (Some(a), Some(b)) => both.push(StudyComparison::of(name, a, b)),
            (Some(_), None) => gone.push(name.as_str()),
            (None, _) => new.push(name.as_str()),
        }
    }
    for (state, studies) in [(before, gone), (after, new)] {
        if !studies.is_empty() {
            let count = count_of(studies.len(), "study is", "studies are");
            notes.push(format!("{count} in {} only: {}", state.name, studies.join(", ")));
        }
    }
    for study in only
        .iter()
        .filter(|study| !before.studies.contains_key(*study) && !after.studies.contains_key(*study))
    {
        notes.push(format!("neither state contains a study `{study}`"));
    }
    (both, notes)
}

/// Change of an order that is reported.
const TOLD: f64 = 0.05;
/// Fall of an order from which on it is lost.
const LOST: f64 = 0.15;

/// Order and class of a series in one state.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Behaviour {
    /// Class.
    pub class: &'static str,
    /// Order, where the class has one.
    pub order: Option<f64>,
}

/// A series whose order or class is another.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OrderChange {
    /// What the runs share, with the axis, `GIMP implicit cells=… points=2 | pressure points terzaghi T_v=0.1`.
    pub series: String,
    /// In the first state.
    pub before: Behaviour,
    /// In the second.
    pub after: Behaviour,
}

impl OrderChange {
    /// Whether a settled order is gone or is smaller. Errors that are round-off now have none and lost nothing.
    pub fn is_loss(&self) -> bool {
        let is_smaller = |before: f64| self.after.order.is_none_or(|after| after < before - LOST);
        self.after.class != "exact" && self.before.order.is_some_and(is_smaller)
    }

    /// The series with its order before and after.
    pub fn sentence(&self) -> String {
        let shown = |state: &Behaviour| match state.order {
            Some(order) => format!("{order:.2}"),
            None => format!("none, {}", state.class),
        };
        format!("{} {} → {}", self.series, shown(&self.before), shown(&self.after))
    }
}

/// The size of a level by a word of a label, with the word that stands for the axis: cells or a rule of time steps.
fn level(word: &str) -> Option<(f64, String)> {
    let (key, value) = word.split_once('=')?;
    let value: f64 = value.parse().ok()?;
    let size = match key {
        "cells" => 1.0 / value,
        "growth" | "seconds" | "courant" | "stable" | "tolerance" => value,
        _ => return None,
    };
    Some((size, format!("{key}=…")))
}

/// Each series that an error belongs to, with its level in it.
fn places(key: &GoldenKey) -> Vec<(GoldenKey, f64)> {
    if !key.measure.is_error() {
        return Vec::new();
    }
    let words: Vec<&str> = key.case.split(' ').collect();
    let of_word = |(at, word): (usize, &&str)| {
        let (size, axis) = level(word)?;
        let mut shared = words.clone();
        shared[at] = &axis;
        Some((GoldenKey { case: shared.join(" ").into(), ..key.clone() }, size))
    };
    words.iter().enumerate().filter_map(of_word).collect()
}

/// The behaviour of the series that are asked for, where they have enough levels.
fn behaviours(
    values: &BTreeMap<GoldenKey, f64>,
    asked: &BTreeSet<GoldenKey>,
) -> BTreeMap<GoldenKey, Behaviour> {
    let mut series: BTreeMap<GoldenKey, Vec<(f64, f64)>> = BTreeMap::new();
    for (key, value) in values {
        for (key, size) in places(key).into_iter().filter(|(key, _)| asked.contains(key)) {
            series.entry(key).or_default().push((size, *value));
        }
    }
    series.retain(|_, levels| levels.len() >= WINDOW);
    let behaviour = |mut levels: Vec<(f64, f64)>| {
        levels.sort_by(|a, b| b.0.total_cmp(&a.0));
        let level = |(size, error): &(f64, f64)| SeriesLevel { size: *size, error: Some(error.abs()) };
        let has_signs = levels.iter().any(|(_, error)| *error < 0.0);
        let signed = if has_signs { levels.iter().map(|(_, error)| *error).collect() } else { Vec::new() };
        let tolerance = Some(ITERATIONS);
        let context = Context { round_off: Some(ROUND_OFF), tolerance, signed, ..Context::default() };
        let classification = classify(&ErrorSeries::new(levels.iter().map(level).collect()), &context);
        Behaviour { class: classification.class.name(), order: classification.order }
    };
    series.into_iter().map(|(key, levels)| (key, behaviour(levels))).collect()
}

/// The series with values that moved whose class is another, or whose order moved by 0.05.
pub(crate) fn order_changes(
    before: &BTreeMap<GoldenKey, f64>,
    after: &BTreeMap<GoldenKey, f64>,
    differences: &[Difference],
) -> Vec<OrderChange> {
    let moved = differences.iter().filter(|difference| difference.is_paired());
    let asked: BTreeSet<GoldenKey> =
        moved.flat_map(|difference| places(&difference.key)).map(|(key, _)| key).collect();
    let mut after = behaviours(after, &asked);
    let change = |(series, before): (GoldenKey, Behaviour)| {
        let after = after.remove(&series)?;
        let order_moved = match (before.order, after.order) {
            (Some(a), Some(b)) => (a - b).abs() > TOLD,
            (a, b) => a.is_some() != b.is_some(),
        };
        let is_other = before.class != after.class || order_moved;
        is_other.then(|| OrderChange { series: series.to_string(), before, after })
    };
    behaviours(before, &asked).into_iter().filter_map(change).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::golden::compare::compare;
    use crate::golden::measure::key;

    fn state(values: &[(GoldenKey, f64)]) -> StudyState {
        let values = values.iter().cloned().collect();
        StudyState::of_golden(GoldenFile { values, ..GoldenFile::of("s", &[], "-") })
    }

    fn before() -> [(GoldenKey, f64); 4] {
        let steps = |case: &str| key(case, None, "steps");
        let error = |case: &str| key(case, 0.1, "pressure points terzaghi");
        [
            (steps("cells=4"), 100.0),
            (error("cells=4"), 1e-2),
            (steps("cells=8"), 400.0),
            (error("cells=8"), 2e-3),
        ]
    }

    fn with(change: impl Fn(&mut [(GoldenKey, f64); 4])) -> StudyComparison {
        let mut after = before();
        change(&mut after);
        StudyComparison::of("s", &state(&before()), &state(&after))
    }

    #[test]
    fn accuracy_and_cost_are_told_apart() {
        let same = with(|_| ());
        assert_eq!((same.accuracy, same.cost, same.is_regression()), (Trend::Same, Trend::Same, false));
        let worse = with(|values| values[3].1 = 3e-3);
        assert_eq!(
            (worse.accuracy, worse.cost, worse.is_regression()),
            (Trend::Regressed, Trend::Same, true)
        );
        let mixed = with(|values| (values[1].1, values[3].1) = (5e-3, 3e-3));
        assert_eq!(mixed.accuracy, Trend::Mixed);
        let dearer = with(|values| (values[3].1, values[2].1) = (1e-3, 500.0));
        assert_eq!(
            (dearer.accuracy, dearer.cost, dearer.is_regression()),
            (Trend::Improved, Trend::Regressed, true)
        );
        assert!(!with(|values| (values[3].1, values[2].1) = (1e-3, 300.0)).is_regression());
    }

    #[test]
    fn values_that_are_gone_are_a_regression_and_new_ones_are_not() {
        let fewer = StudyComparison::of("s", &state(&before()), &state(&before()[..3]));
        assert!(fewer.is_regression() && fewer.unpaired == 1);
        let more = StudyComparison::of("s", &state(&before()[..3]), &state(&before()));
        assert!(!more.is_regression() && more.unpaired == 1);
    }

    #[test]
    fn inputs_that_differ_are_told_and_a_case_of_other_inputs_and_label_has_no_partner() {
        let text = |modulus: &str, cells: &str| {
            format!(
                "title = 't'\nscene = 'terzaghi'\nmaterial.youngs_modulus = {modulus}\noutput.time_factors = [0.1]\n\
                 [[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [2, {cells}]\n"
            )
        };
        let of = |modulus: &str, cells: &str| {
            StudyState::of_records("s", &crate::campaign::runner::records_of(&text(modulus, cells)))
        };
        let found = StudyComparison::of("s", &of("1e6", "3"), &of("1.1e6", "4"));
        let told: Vec<String> = found.inputs.iter().map(InputChange::sentence).collect();
        assert_eq!(told, ["youngs_modulus 1e6 Pa → 1.1e6 Pa in 1 case"]);
        assert!(found.is_regression() && found.has_changed() && found.unpaired > 0);
        assert_eq!(found.cases_apart.map(|cases| cases.len()), [1, 1]);
    }

    #[test]
    fn an_order_that_fell_is_told_and_a_constant_that_grew_is_not() {
        let values = |errors: [f64; 3]| -> BTreeMap<GoldenKey, f64> {
            let case = |cells: u32| format!("GIMP implicit cells={cells} points=2");
            let keys = [4, 8, 16].map(|cells| key(&case(cells), 0.1, "pressure points terzaghi"));
            keys.into_iter().zip(errors).collect()
        };
        let before = values([4e-2, 1e-2, 2.5e-3]);
        let changes = |after: [f64; 3]| {
            let golden = GoldenFile { values: before.clone(), ..GoldenFile::of("s", &[], "-") };
            order_changes(&before, &values(after), &compare(&golden, &values(after)))
        };
        assert_eq!(changes([4e-2, 1e-2, 2.5e-3]), []);
        assert_eq!(changes([8e-2, 2e-2, 5e-3]), []);
        let first = changes([4e-2, 2e-2, 1e-2]);
        assert_eq!(first.len(), 1);
        assert_eq!(first[0].series, "GIMP implicit cells=… points=2 | pressure points terzaghi T_v=0.1");
        let [before, after] = [&first[0].before, &first[0].after].map(|one| one.order.expect("an order"));
        assert!((before - 2.0).abs() < 1e-9 && (after - 1.0).abs() < 1e-9);
        // Below round-off there is no order.
        let classes = changes([4e-13, 3e-13, 1e-13]);
        assert_eq!((classes[0].after.class, classes[0].after.order), ("exact", None));
        let lost = changes([4e-2, 1e-2, 4e-2]);
        assert!(lost[0].after.class != lost[0].before.class, "{lost:?}");
    }

    #[test]
    fn a_study_of_one_state_only_is_told_with_the_name_of_that_state() {
        let of = |name: &str, studies: &[&str]| State {
            name: name.to_owned(),
            studies: studies.iter().map(|study| ((*study).to_owned(), state(&before()))).collect(),
            notes: vec![format!("note of {name}")],
        };
        let (before, after) = (of("old", &["both", "gone"]), of("young", &["both", "new", "newer"]));
        let (found, notes) = compare_states(&before, &after, &[]);
        assert_eq!(found.iter().map(|one| one.study.as_str()).collect::<Vec<_>>(), ["both"]);
        let expected = [
            "note of old",
            "note of young",
            "1 study is in old only: gone",
            "2 studies are in young only: new, newer",
        ];
        assert_eq!(notes, expected);
        let (found, notes) = compare_states(&before, &after, &["gone".to_owned(), "none".to_owned()]);
        assert!(found.is_empty());
        assert_eq!(notes[2..], ["1 study is in old only: gone", "neither state contains a study `none`"]);
    }

    #[test]
    fn seconds_are_summed_over_the_cases_of_both_states() {
        let with = |cases: &[(&str, [f64; 3])]| {
            let seconds = cases.iter().map(|(case, runs)| ((*case).to_owned(), runs.to_vec()));
            StudyState { seconds: seconds.collect(), ..state(&before()) }
        };
        let before = with(&[("a", [3.0, 1.0, 2.0]), ("b", [10.0, 30.0, 20.0]), ("gone", [9.0; 3])]);
        let after = with(&[("a", [4.0, 6.0, 5.0]), ("b", [40.0; 3]), ("new", [7.0; 3])]);
        let [old, new] = Seconds::of_both(&before, &after).expect("times of both");
        assert_eq!(old, Seconds { median: 22.0, least: 11.0, most: 33.0 });
        assert_eq!(new, Seconds { median: 45.0, least: 44.0, most: 46.0 });
    }

    #[test]
    fn signs_of_a_series_belong_to_their_levels_in_whatever_order_they_are_listed() {
        let name = |cells: u32| key(&format!("MPM cells={cells}"), 0.1, "settlement surface terzaghi");
        let values: BTreeMap<GoldenKey, f64> = [(4, 0.16), (8, -0.04), (16, 0.01), (32, -0.0025)]
            .map(|(cells, error)| (name(cells), error))
            .into();
        let asked = places(&name(4)).into_iter().map(|(key, _)| key).collect();
        let found = behaviours(&values, &asked);
        assert_eq!(found.len(), 1);
        assert!(found.values().all(|one| one.class == "oscillatory" && one.order.is_none()), "{found:?}");
    }

    #[test]
    fn every_axis_of_a_label_is_refined_towards_more_cells_and_smaller_steps() {
        for (finer, coarser) in [
            ("cells=8", "cells=4"),
            ("growth=0.05", "growth=0.1"),
            ("seconds=1e-3", "seconds=2e-3"),
            ("courant=0.25", "courant=0.5"),
            ("stable=0.25", "stable=0.5"),
            ("tolerance=1e-5", "tolerance=1e-4"),
        ] {
            let [(fine, axis), (coarse, other)] = [finer, coarser].map(|word| level(word).expect("an axis"));
            assert!(fine < coarse && axis == other, "{finer} {fine}, {coarser} {coarse}");
        }
        for word in ["points=2", "GIMP", "cells=many"] {
            assert_eq!(level(word), None, "{word}");
        }
    }

    #[test]
    fn an_order_is_told_from_a_twentieth_on_and_one_that_is_lost_or_won() {
        let values = |order: f64| -> BTreeMap<GoldenKey, f64> {
            let level = |cells: u32| (f64::from(cells) / 4.0).powf(-order);
            let name = |cells: u32| key(&format!("MPM cells={cells}"), 0.1, "pressure points terzaghi");
            [4, 8, 16].map(|cells| (name(cells), level(cells))).into()
        };
        let told = |before: f64, after: f64| {
            let (before, after) = (values(before), values(after));
            let golden = GoldenFile { values: before.clone(), ..GoldenFile::of("s", &[], "-") };
            order_changes(&before, &after, &compare(&golden, &after)).len()
        };
        for (before, after, count) in
            [(2.0, 2.04, 0), (2.0, 2.06, 1), (2.0, 1.96, 0), (2.0, 1.94, 1), (2.0, -1.0, 1), (-1.0, 2.0, 1)]
        {
            assert_eq!(told(before, after), count, "{before} {after}");
        }
    }
}
