//! Two states beside each other: inputs that differ first, then accuracy and cost, apart.

use crate::golden::compare::{
    CaseChange, Change, Difference, DifferenceGroup, case_changes, compare, groups_of,
};
use crate::golden::{is_counter, is_error, parts};
use crate::history::orders::{OrderChange, order_changes};
use crate::history::state::{Inputs, State, StudyState};
use crate::measure::statistics::spread;
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

/// An input that differs in the same way in some cases of a study.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct InputChange {
    /// Key, `material.youngs_modulus`.
    pub key: String,
    /// Value before; empty where it was not given.
    pub before: String,
    /// Value after.
    pub after: String,
    /// Cases in which it differs so.
    pub cases: usize,
}

/// A study in two states.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StudyComparison {
    /// Its name.
    pub study: String,
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
        let sum = |one: &StudyState, other: &StudyState| {
            let runs = one.seconds.iter().filter(|(case, _)| other.seconds.contains_key(*case));
            let all = runs.filter_map(|(_, runs)| spread(runs)).map(|one| Self {
                median: one.median,
                least: one.minimum,
                most: one.maximum,
            });
            all.reduce(|sum, one| Self {
                median: sum.median + one.median,
                least: sum.least + one.least,
                most: sum.most + one.most,
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
        let differences = compare(&before.golden, found);
        let (counters, errors): (Vec<&Difference>, Vec<&Difference>) = differences
            .iter()
            .filter(|one| one.golden.is_some() && one.found.is_some())
            .partition(|one| is_counter(parts(&one.name).1));
        let grew = |one: &&Difference| one.found > one.golden;
        let cost = Trend::of(counters.iter().any(|one| !grew(one)), counters.iter().any(grew));
        let is_better = |one: &&Difference| matches!(one.change, Change::Stale | Change::Smaller);
        let accuracy = Trend::of(errors.iter().any(is_better), errors.iter().any(|one| !is_better(one)));
        let names = before.golden.values.keys().chain(found.keys()).map(String::as_str);
        Self {
            study: study.to_owned(),
            accuracy,
            cost,
            values: before.golden.values.keys().filter(|name| found.contains_key(*name)).count(),
            unpaired: differences.iter().filter(|one| one.golden.is_none() || one.found.is_none()).count(),
            inputs: input_changes(before.inputs.as_ref(), after.inputs.as_ref()),
            groups: groups_of(&differences, names.collect::<BTreeSet<_>>()),
            changes: case_changes(&differences),
            orders: order_changes(&before.golden.values, found, &differences),
            seconds: Seconds::of_both(before, after),
            arrows: arrows(&before.golden.values, found),
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

/// What differs in the inputs of cases of the same label, the most cases first. A label may tell the input that
/// changed: cases without a partner of that label are paired with the one whose inputs differ least.
fn input_changes(
    before: Option<&BTreeMap<String, Inputs>>,
    after: Option<&BTreeMap<String, Inputs>>,
) -> Vec<InputChange> {
    let (Some(before), Some(after)) = (before, after) else { return Vec::new() };
    let mut counts: BTreeMap<(&str, &str, &str), usize> = BTreeMap::new();
    for (label, old) in before {
        let Some(new) = after.get(label).or_else(|| nearest(old, after, before)) else { continue };
        for key in old.keys().chain(new.keys()).collect::<BTreeSet<_>>() {
            let value = |inputs: &'_ Inputs| inputs.get(key).map_or("", String::as_str).to_owned();
            if value(old) != value(new) {
                let text = |inputs| <BTreeMap<String, String>>::get(inputs, key).map_or("", String::as_str);
                *counts.entry((key, text(old), text(new))).or_default() += 1;
            }
        }
    }
    let change = |((key, before, after), cases): ((&str, &str, &str), usize)| InputChange {
        key: key.to_owned(),
        before: before.to_owned(),
        after: after.to_owned(),
        cases,
    };
    let mut changes: Vec<InputChange> = counts.into_iter().map(change).collect();
    changes.sort_by(|a, b| b.cases.cmp(&a.cases).then_with(|| a.key.cmp(&b.key)));
    changes
}

/// Inputs of the case that differs in the fewest keys, of those whose label is new.
fn nearest<'a>(
    inputs: &Inputs,
    cases: &'a BTreeMap<String, Inputs>,
    known: &BTreeMap<String, Inputs>,
) -> Option<&'a Inputs> {
    let unlike = |other: &Inputs| {
        let keys: BTreeSet<&String> = inputs.keys().chain(other.keys()).collect();
        keys.into_iter().filter(|key| inputs.get(*key) != other.get(*key)).count()
    };
    cases
        .iter()
        .filter(|(label, _)| !known.contains_key(*label))
        .map(|(_, case)| case)
        .min_by_key(|case| unlike(case))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;

    fn state(values: &[(&str, f64)], modulus: &str) -> StudyState {
        let values: BTreeMap<String, f64> =
            values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let inputs = |case: &str| {
            let pairs = [("material.youngs_modulus", modulus), ("cells", &case[6..])];
            (case.to_owned(), pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).into())
        };
        StudyState {
            golden: GoldenFile { values, ..GoldenFile::of("s", &[], "-") },
            inputs: Some(["cells=4", "cells=8"].map(inputs).into()),
            seconds: BTreeMap::new(),
        }
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
    fn inputs_that_differ_are_named_with_the_number_of_their_cases() {
        let found = StudyComparison::of("s", &state(&BEFORE, "1e6"), &state(&BEFORE, "1.1e6"));
        let expected = InputChange {
            key: "material.youngs_modulus".to_owned(),
            before: "1e6".to_owned(),
            after: "1.1e6".to_owned(),
            cases: 2,
        };
        assert_eq!(found.inputs, [expected]);
    }

    #[test]
    fn a_case_whose_label_changed_is_compared_with_the_nearest_new_one() {
        let mut after = state(&BEFORE, "1e6");
        let mut renamed = after.inputs.take().expect("inputs");
        let mut finer = renamed.remove("cells=8").expect("a case");
        finer.insert("cells".to_owned(), "16".to_owned());
        renamed.insert("cells=16".to_owned(), finer);
        after.inputs = Some(renamed);
        let found = StudyComparison::of("s", &state(&BEFORE, "1e6"), &after);
        let told: Vec<_> =
            found.inputs.iter().map(|one| (&*one.key, &*one.before, &*one.after, one.cases)).collect();
        assert_eq!(told, [("cells", "8", "16", 1)]);
    }
}
