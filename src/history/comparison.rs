//! Two states beside each other: inputs that differ first, then accuracy and cost, apart; and the orders and classes of
//! errors under refinement, found from values by their names.

use crate::golden::compare::{
    CaseChange, Change, Difference, DifferenceGroup, case_changes, cases_apart, compare, groups_of,
};
use crate::golden::inputs::InputChange;
use crate::golden::{is_counter, is_error, parts};
use crate::history::state::{State, StudyState};
use crate::measure::statistics::spread;
use oedometer_convergence::{Context, ErrorSeries, SeriesLevel, classify};
use oedometer_soil::wording::count_of;
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
    /// Work counters.
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
    /// Each case in the plane of cost and error, before and after.
    #[serde(skip)]
    pub arrows: Vec<Arrow>,
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

/// A case in the plane of cost and error.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Label of the case.
    pub case: String,
    /// Point updates and error before.
    pub before: (f64, f64),
    /// Point updates and error after.
    pub after: (f64, f64),
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
        let found = &after.golden.values;
        let seconds = Seconds::of_both(before, after);
        let cases_apart = cases_apart(before.golden.values.keys(), found.keys());
        let made_by = [before, after].map(|state| state.made_by.clone());
        let (before, pairing) = before.golden.clone().beside(&after.golden.inputs);
        let differences = compare(&before, found);
        let (counters, errors): (Vec<&Difference>, Vec<&Difference>) = differences
            .iter()
            .filter(|difference| difference.golden.is_some() && difference.found.is_some())
            .partition(|difference| is_counter(parts(&difference.name).1));
        let grew = |difference: &&Difference| difference.found > difference.golden;
        let cost = Trend::of(counters.iter().any(|difference| !grew(difference)), counters.iter().any(grew));
        let is_better =
            |difference: &&Difference| matches!(difference.change, Change::Stale | Change::Smaller);
        let accuracy =
            Trend::of(errors.iter().any(is_better), errors.iter().any(|difference| !is_better(difference)));
        let names = before.values.keys().chain(found.keys()).map(String::as_str);
        Self {
            study: study.to_owned(),
            cases_apart,
            accuracy,
            cost,
            values: before.values.keys().filter(|name| found.contains_key(*name)).count(),
            unpaired: differences
                .iter()
                .filter(|difference| difference.golden.is_none() || difference.found.is_none())
                .count(),
            inputs: pairing.changes,
            groups: groups_of(&differences, names.collect::<BTreeSet<_>>()),
            changes: case_changes(&differences),
            orders: order_changes(&before.values, found, &differences),
            seconds,
            made_by,
            arrows: arrows(&before.values, found),
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
    let (mut found, mut gone, mut new) = (Vec::new(), Vec::new(), Vec::new());
    let names: BTreeSet<&String> = before.studies.keys().chain(after.studies.keys()).filter(wanted).collect();
    for name in names {
        match (before.studies.get(name), after.studies.get(name)) {
            (Some(a), Some(b)) => found.push(StudyComparison::of(name, a, b)),
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
        notes.push(format!("neither state has a study `{study}`"));
    }
    (found, notes)
}

/// Every case that has point updates and an error in both states: the error of the pressure, or of the first quantity
/// there is, at its last time.
fn arrows(before: &BTreeMap<String, f64>, after: &BTreeMap<String, f64>) -> Vec<Arrow> {
    let mut measures: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for name in before.keys().filter(|name| after.contains_key(*name)) {
        let (case, measure) = parts(name);
        measures.entry(case).or_default().push(measure);
    }
    let time = |measure: &str| measure.rsplit_once(" T_v=").and_then(|(_, time)| time.parse::<f64>().ok());
    let arrow = |(case, measures): (&str, Vec<&str>)| {
        let work = measures.iter().find(|measure| **measure == "point updates")?;
        let errors = measures.iter().filter(|measure| is_error(measure));
        let error = errors.max_by(|a, b| {
            let rank = |measure: &str| (measure.starts_with("pressure"), time(measure).unwrap_or(0.0));
            rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal)
        })?;
        let point = |values: &BTreeMap<String, f64>| {
            let value = |measure: &str| values.get(&format!("{case} | {measure}")).copied();
            Some((value(work)?, value(error)?.abs()))
        };
        Some(Arrow { case: case.to_owned(), before: point(before)?, after: point(after)? })
    };
    measures.into_iter().filter_map(arrow).collect()
}

/// Errors up to this are round-off.
const ROUND_OFF: f64 = 1e-12;
/// Errors up to this may be what iterations leave.
const ITERATIONS: f64 = 1e-8;
/// Change of an order that is reported.
const TOLD: f64 = 0.05;
/// Fall of an order from which on it is lost.
const LOST: f64 = 0.15;
/// Levels from which on a series has a class.
const LEAST_LEVELS: usize = 3;

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
    /// What the runs share, with the axis, `GIMP implicit cells=… points=2 | pressure points l2 terzaghi T_v=0.1`.
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
        let told = |state: &Behaviour| match state.order {
            Some(order) => format!("{order:.2}"),
            None => format!("none, {}", state.class),
        };
        format!("{} {} → {}", self.series, told(&self.before), told(&self.after))
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
fn places(name: &str) -> Vec<(String, f64)> {
    let (case, measure) = parts(name);
    if !is_error(measure) {
        return Vec::new();
    }
    let words: Vec<&str> = case.split(' ').collect();
    let of_word = |(at, word): (usize, &&str)| {
        let (size, axis) = level(word)?;
        let mut shared = words.clone();
        shared[at] = &axis;
        Some((format!("{} | {measure}", shared.join(" ")), size))
    };
    words.iter().enumerate().filter_map(of_word).collect()
}

/// The behaviour of the series that are asked for, where they have enough levels.
fn behaviours(values: &BTreeMap<String, f64>, asked: &BTreeSet<String>) -> BTreeMap<String, Behaviour> {
    let mut series: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    for (name, value) in values {
        for (key, size) in places(name).into_iter().filter(|(key, _)| asked.contains(key)) {
            series.entry(key).or_default().push((size, *value));
        }
    }
    series.retain(|_, levels| levels.len() >= LEAST_LEVELS);
    let behaviour = |mut levels: Vec<(f64, f64)>| {
        levels.sort_by(|a, b| b.0.total_cmp(&a.0));
        let level = |(size, error): &(f64, f64)| SeriesLevel { size: *size, error: Some(error.abs()) };
        let has_signs = levels.iter().any(|(_, error)| *error < 0.0);
        let signed = if has_signs { levels.iter().map(|(_, error)| *error).collect() } else { Vec::new() };
        let tolerance = Some(ITERATIONS);
        let context = Context { round_off: Some(ROUND_OFF), tolerance, signed, ..Context::default() };
        let found = classify(&ErrorSeries::new(levels.iter().map(level).collect()), &context);
        Behaviour { class: found.class.name(), order: found.order }
    };
    series.into_iter().map(|(key, levels)| (key, behaviour(levels))).collect()
}

/// The series with values that moved whose class is another, or whose order moved by 0.05.
pub(crate) fn order_changes(
    before: &BTreeMap<String, f64>,
    after: &BTreeMap<String, f64>,
    differences: &[Difference],
) -> Vec<OrderChange> {
    let moved =
        differences.iter().filter(|difference| difference.golden.is_some() && difference.found.is_some());
    let asked: BTreeSet<String> =
        moved.flat_map(|difference| places(&difference.name)).map(|(key, _)| key).collect();
    let mut after = behaviours(after, &asked);
    let change = |(series, before): (String, Behaviour)| {
        let after = after.remove(&series)?;
        let order_moved = match (before.order, after.order) {
            (Some(a), Some(b)) => (a - b).abs() > TOLD,
            (a, b) => a.is_some() != b.is_some(),
        };
        let is_other = before.class != after.class || order_moved;
        is_other.then_some(OrderChange { series, before, after })
    };
    behaviours(before, &asked).into_iter().filter_map(change).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::golden::compare::compare;
    use crate::golden::inputs::CaseInputs;

    fn state(values: &[(&str, f64)], modulus: &str) -> StudyState {
        let values: BTreeMap<String, f64> =
            values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let own = |case: &str| (case.to_owned(), [("cells".to_owned(), case[6..].to_owned())].into());
        let inputs = CaseInputs {
            shared: [("youngs_modulus".to_owned(), modulus.to_owned())].into(),
            own: ["cells=4", "cells=8"].map(own).into(),
        };
        let golden = GoldenFile { inputs, values, ..GoldenFile::of("s", &[], "-") };
        StudyState::of_golden(golden)
    }

    const BEFORE: [(&str, f64); 4] = [
        ("cells=4 | point updates", 100.0),
        ("cells=4 | pressure points l2 terzaghi T_v=0.1", 1e-2),
        ("cells=8 | point updates", 400.0),
        ("cells=8 | pressure points l2 terzaghi T_v=0.1", 2e-3),
    ];

    fn with(change: impl Fn(&mut [(&'static str, f64); 4])) -> StudyComparison {
        let mut after = BEFORE;
        change(&mut after);
        StudyComparison::of("s", &state(&BEFORE, "1e6"), &state(&after, "1e6"))
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
        assert_eq!(dearer.arrows[1].after, (500.0, 1e-3));
    }

    #[test]
    fn values_that_are_gone_are_a_regression_and_new_ones_are_not() {
        let fewer = StudyComparison::of("s", &state(&BEFORE, "1e6"), &state(&BEFORE[..3], "1e6"));
        assert!(fewer.is_regression() && fewer.unpaired == 1);
        let more = StudyComparison::of("s", &state(&BEFORE[..3], "1e6"), &state(&BEFORE, "1e6"));
        assert!(!more.is_regression() && more.unpaired == 1);
    }

    #[test]
    fn a_case_whose_label_tells_another_input_is_compared_with_its_nearest() {
        let mut after = state(&BEFORE, "1.1e6");
        let finer = after.golden.inputs.own.remove("cells=8").expect("a case");
        after.golden.inputs.own.insert("cells=9".to_owned(), [("cells".to_owned(), "9".to_owned())].into());
        assert_ne!(finer, after.golden.inputs.own["cells=9"]);
        after.golden.values = BEFORE.map(|(name, value)| (name.replace("cells=8", "cells=9"), value)).into();
        let found = StudyComparison::of("s", &state(&BEFORE, "1e6"), &after);
        let told: Vec<String> = found.inputs.iter().map(InputChange::sentence).collect();
        assert_eq!(told, ["youngs_modulus 1e6 → 1.1e6 in 2 cases", "cells 8 → 9 in 1 case"]);
        assert_eq!((found.unpaired, found.is_regression(), found.has_changed()), (0, false, true));
    }

    #[test]
    fn an_order_that_fell_is_told_and_a_constant_that_grew_is_not() {
        let values = |errors: [f64; 3]| -> BTreeMap<String, f64> {
            let names =
                [4, 8, 16].map(|cells| format!("GIMP implicit cells={cells} points=2 | pressure T_v=0.1"));
            names.into_iter().zip(errors).collect()
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
        assert_eq!(first[0].series, "GIMP implicit cells=… points=2 | pressure T_v=0.1");
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
            studies: studies.iter().map(|study| ((*study).to_owned(), state(&BEFORE, "1e6"))).collect(),
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
        assert_eq!(notes[2..], ["1 study is in old only: gone", "neither state has a study `none`"]);
    }

    #[test]
    fn seconds_are_summed_over_the_cases_of_both_states() {
        let with = |cases: &[(&str, [f64; 3])]| {
            let seconds = cases.iter().map(|(case, runs)| ((*case).to_owned(), runs.to_vec()));
            StudyState { seconds: seconds.collect(), ..state(&BEFORE, "1e6") }
        };
        let before = with(&[("a", [3.0, 1.0, 2.0]), ("b", [10.0, 30.0, 20.0]), ("gone", [9.0; 3])]);
        let after = with(&[("a", [4.0, 6.0, 5.0]), ("b", [40.0; 3]), ("new", [7.0; 3])]);
        let [old, new] = Seconds::of_both(&before, &after).expect("times of both");
        assert_eq!(old, Seconds { median: 22.0, least: 11.0, most: 33.0 });
        assert_eq!(new, Seconds { median: 45.0, least: 44.0, most: 46.0 });
    }

    #[test]
    fn an_arrow_is_that_of_the_pressure_at_the_last_output_wherever_it_is_listed() {
        let named = |factor: f64| -> BTreeMap<String, f64> {
            let rows = [
                ("effective_stress points l2 terzaghi T_v=10", 1e-1),
                ("point updates", 100.0),
                ("pressure points l2 terzaghi T_v=0.1", 2e-2),
                ("pressure points l2 terzaghi T_v=10", 3e-2),
                ("pressure points l2 terzaghi T_v=2", 4e-2),
                ("settlement surface relative terzaghi T_v=10", -5e-2),
            ];
            rows.map(|(name, value)| (format!("MPM | {name}"), factor * value)).into()
        };
        let [arrow] = arrows(&named(1.0), &named(2.0)).try_into().unwrap_or_else(|_| panic!("one case"));
        assert_eq!((arrow.before, arrow.after), ((100.0, 3e-2), (200.0, 6e-2)));
        // Without a pressure the last of what there is, by its size; without a counter or an error there is none.
        for (rows, found) in [
            (&["point updates", "settlement a T_v=0.1", "settlement a T_v=2"][..], Some((1.0, 3.0))),
            (&["point updates", "steps", "water balance T_v=2"], None),
            (&["steps", "settlement a T_v=2"], None),
        ] {
            let rows: BTreeMap<String, f64> = rows
                .iter()
                .zip([1.0, -2.0, -3.0])
                .map(|(name, value)| (format!("MPM | {name}"), value))
                .collect();
            let told: Vec<(f64, f64)> = arrows(&rows, &rows).into_iter().map(|arrow| arrow.after).collect();
            assert_eq!(told, found.into_iter().collect::<Vec<_>>());
        }
    }

    #[test]
    fn signs_of_a_series_belong_to_their_levels_in_whatever_order_they_are_listed() {
        let name = |cells: u32| format!("MPM cells={cells} | settlement surface relative terzaghi T_v=0.1");
        let values: BTreeMap<String, f64> = [(4, 0.16), (8, -0.04), (16, 0.01), (32, -0.0025)]
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
        let values = |order: f64| -> BTreeMap<String, f64> {
            let level = |cells: u32| (f64::from(cells) / 4.0).powf(-order);
            [4, 8, 16].map(|cells| (format!("MPM cells={cells} | pressure T_v=0.1"), level(cells))).into()
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
