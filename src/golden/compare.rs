//! Compares golden values with present ones: value by value, by case, and by kind of change.
//!
//! Accuracy and cost are judged together: a case that is dearer or worse than its golden values, and in nothing better,
//! is dominated by them; one that pays for one with the other is a trade. A long list of differences says less than one
//! line a kind, with what its values have in common and its largest change.

use crate::case::grouping::grouped;
use crate::golden::GoldenFile;
use crate::golden::measure::{GoldenKey, Measure, TimeFactor};
use oedometer_convergence::ParetoChange;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What happened to a value, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// Beyond the tolerance, and not better.
    Moved,
    /// In the golden and no longer measured.
    Missing,
    /// Measured and not in the golden.
    Extra,
    /// Smaller beyond the tolerance, in a case that has other values which moved.
    Smaller,
    /// Smaller beyond the tolerance, in a case of which nothing got worse: the golden is to be renewed.
    Stale,
}

impl Change {
    /// Word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moved => "moved",
            Self::Missing => "missing",
            Self::Extra => "not in the golden",
            Self::Smaller => "smaller, others grew",
            Self::Stale => "better: stale golden",
        }
    }
}

/// One value that is not what it was.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// Which value.
    #[serde(rename = "name")]
    pub key: GoldenKey,
    /// What happened.
    pub change: Change,
    /// Golden value.
    pub golden: Option<f64>,
    /// Present value.
    pub found: Option<f64>,
    /// Allowed change.
    pub tolerance: f64,
}

/// Sizes below which an error is not divided by: there a relative change says nothing.
const LEAST_SIZE: f64 = 1e-9;

impl Difference {
    /// Change over the larger of both values; of a water balance, which is a share already and near zero,
    /// the change itself. Infinite for NaN, `None` where one side is missing.
    pub fn relative_change(&self) -> Option<f64> {
        let (golden, found) = (self.golden?, self.found?);
        let largest = golden.abs().max(found.abs());
        let size = match self.key.measure {
            Measure::Water(_) => 1.0,
            Measure::Error { .. } => largest.max(LEAST_SIZE),
            Measure::Steps | Measure::CriticalStep { .. } => largest,
        };
        let change = (found - golden).abs() / size;
        Some(if change.is_nan() { f64::INFINITY } else { change })
    }

    /// Whether there is a value on both sides.
    pub fn is_paired(&self) -> bool {
        self.golden.is_some() && self.found.is_some()
    }

    /// How many times its golden value it is, from the double on: a change over the larger value says nothing of that.
    pub fn growth(&self) -> Option<f64> {
        let times = self.found?.abs() / self.golden?.abs();
        (times >= 2.0 && times.is_finite() && !self.key.measure.is_water()).then_some(times)
    }

    /// The order of a list: kinds by how bad they are, then the largest relative change first.
    fn worst_first(&self, other: &Self) -> Ordering {
        let size = |difference: &Self| difference.relative_change().unwrap_or(0.0);
        self.change
            .cmp(&other.change)
            .then_with(|| size(other).total_cmp(&size(self)))
            .then_with(|| self.key.cmp(&other.key))
    }
}

/// Every difference beyond the tolerance, the worst first; a value that is not a finite number never agrees.
pub fn compare(golden: &GoldenFile, found: &BTreeMap<GoldenKey, f64>) -> Vec<Difference> {
    let mut differences = Vec::new();
    for (key, value) in &golden.values {
        let present = found.get(key).copied();
        let largest = value.abs().max(present.map_or(0.0, f64::abs));
        let tolerance = golden.tolerance(key, largest);
        let change = match present {
            None => Change::Missing,
            Some(present) if tolerance.is_finite() && (present - value).abs() <= tolerance => continue,
            Some(present) if present.abs() < value.abs() && key.measure.is_better_if_smaller() => {
                Change::Stale
            }
            Some(_) => Change::Moved,
        };
        differences.push(Difference {
            key: key.clone(),
            change,
            golden: Some(*value),
            found: present,
            tolerance,
        });
    }
    for (key, value) in found.iter().filter(|(key, _)| !golden.values.contains_key(*key)) {
        differences.push(Difference {
            key: key.clone(),
            change: Change::Extra,
            golden: None,
            found: Some(*value),
            tolerance: 0.0,
        });
    }
    tell_apart_what_is_paid_for(&mut differences);
    differences.sort_by(Difference::worst_first);
    differences
}

/// Marks values that fell in a case in which another value moved: these do not count as improvements.
fn tell_apart_what_is_paid_for(differences: &mut [Difference]) {
    let moved = |difference: &&Difference| difference.change == Change::Moved;
    let worse: BTreeSet<Arc<str>> =
        differences.iter().filter(moved).map(|difference| difference.key.case.clone()).collect();
    for difference in differences.iter_mut().filter(|difference| difference.change == Change::Stale) {
        if worse.contains(&difference.key.case) {
            difference.change = Change::Smaller;
        }
    }
}

/// A case that differs from its golden values.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CaseChange {
    /// Label of the case.
    pub case: String,
    /// Accuracy and cost together.
    pub change: ParetoChange,
    /// Ratio of the steps to their golden number; 1 where that did not change.
    pub cost_ratio: f64,
    /// Errors that grew beyond their tolerance.
    pub worse: usize,
    /// Errors that fell beyond their tolerance.
    pub better: usize,
    /// Values that are missing, or that nothing is known of.
    pub unpaired: usize,
}

impl CaseChange {
    fn of(case: &str, differences: &[&Difference]) -> Self {
        let (mut cost_ratio, mut worse, mut better, mut unpaired) = (1.0, 0, 0, 0);
        for difference in differences {
            match (difference.golden, difference.found) {
                (Some(golden), Some(found)) if difference.key.measure == Measure::Steps => {
                    cost_ratio = found / golden;
                }
                (Some(_), Some(_)) if matches!(difference.change, Change::Stale | Change::Smaller) => {
                    better += 1;
                }
                (Some(_), Some(_)) => worse += 1,
                _ => unpaired += 1,
            }
        }
        let is_comparable = unpaired == 0 && f64::is_finite(cost_ratio);
        let change = match (is_comparable, better > 0 || cost_ratio < 1.0, worse > 0 || cost_ratio > 1.0) {
            (false, ..) => ParetoChange::NotComparable,
            (_, false, false) => ParetoChange::Same,
            (_, true, false) => ParetoChange::Better,
            (_, true, true) => ParetoChange::Traded,
            (_, false, true) => ParetoChange::Dominated,
        };
        Self { case: case.to_owned(), change, cost_ratio, worse, better, unpaired }
    }

    /// Whether the golden values are to be looked at again and nothing has failed: all that changed
    /// is better, or cost was traded for accuracy throughout.
    pub fn is_stale(&self) -> bool {
        let cheaper = self.cost_ratio < 1.0;
        let dearer = self.cost_ratio > 1.0;
        match self.change {
            ParetoChange::Better => true,
            ParetoChange::Traded => cheaper && self.better == 0 || dearer && self.worse == 0,
            ParetoChange::Same | ParetoChange::Dominated | ParetoChange::NotComparable => false,
        }
    }
}

/// The cases of differences, in their order.
pub fn case_changes(differences: &[Difference]) -> Vec<CaseChange> {
    let cases = grouped(differences, |difference| &*difference.key.case);
    cases.into_iter().map(|(case, differences)| CaseChange::of(case, &differences)).collect()
}

/// Cases that only the first of two states has, and those that only the second has, by their values.
pub fn cases_apart<'a>(
    before: impl IntoIterator<Item = &'a GoldenKey>,
    after: impl IntoIterator<Item = &'a GoldenKey>,
) -> [Vec<String>; 2] {
    let before: BTreeSet<&str> = before.into_iter().map(|key| &*key.case).collect();
    let after: BTreeSet<&str> = after.into_iter().map(|key| &*key.case).collect();
    let only = |one: &BTreeSet<&str>, other: &BTreeSet<&str>| {
        one.difference(other).map(|case| (*case).to_owned()).collect()
    };
    [only(&before, &after), only(&after, &before)]
}

/// The differences of one kind.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DifferenceGroup {
    /// What happened.
    pub change: Change,
    /// Values.
    pub values: usize,
    /// Cases that they are of.
    pub cases: usize,
    /// Words of the cases' labels that all of them share and that not every value of the study has.
    pub shared_by_cases: Vec<String>,
    /// Words of the measures that all of them share and that not every value of the study has.
    pub shared_by_measures: Vec<String>,
    /// The worst.
    pub worst: Difference,
    /// Where most of its error is, as a sentence: for a result of another program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
}

/// Words of a case and of a measure with its time, each marked with the side it stands on.
fn words(key: &GoldenKey) -> BTreeSet<(NameSide, String)> {
    // Variants stand in brackets behind the label: `(u-p, implicit drag)`.
    let (label, variants) = key.case.split_once(" (").unwrap_or((&*key.case, ""));
    let variants = variants.trim_end_matches(')').split(", ").filter(|variant| !variant.is_empty());
    let of_case = label.split_whitespace().chain(variants).map(|word| (NameSide::Case, word.to_owned()));
    let measure = key.measure.to_string();
    let time = key.time.map(|TimeFactor(time)| format!("T_v={time}"));
    let of_measure = measure.split(' ').map(str::to_owned).chain(time);
    of_case.chain(of_measure.map(|word| (NameSide::Measure, word))).collect()
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum NameSide {
    Case,
    Measure,
}

/// The groups of differences that are in their order, the worst group first. `all` are the keys of every value that was
/// compared.
pub fn groups_of<'a>(
    differences: &[Difference],
    all: impl IntoIterator<Item = &'a GoldenKey>,
) -> Vec<DifferenceGroup> {
    if differences.is_empty() {
        return Vec::new();
    }
    let mut everywhere: BTreeMap<(NameSide, String), usize> = BTreeMap::new();
    let mut number = 0;
    for key in all {
        number += 1;
        for word in words(key) {
            *everywhere.entry(word).or_default() += 1;
        }
    }
    let mut groups = Vec::new();
    for of_kind in differences.chunk_by(|a, b| a.change == b.change) {
        let Some(worst) = of_kind.first() else { continue };
        let mut shared = words(&worst.key);
        for difference in of_kind {
            let words = words(&difference.key);
            shared.retain(|word| words.contains(word));
        }
        shared.retain(|word| everywhere.get(word).is_none_or(|count| *count < number));
        let of = |side| shared.iter().filter(|word| word.0 == side).map(|word| word.1.clone()).collect();
        groups.push(DifferenceGroup {
            change: worst.change,
            values: of_kind.len(),
            cases: of_kind.iter().map(|difference| &difference.key.case).collect::<BTreeSet<_>>().len(),
            shared_by_cases: of(NameSide::Case),
            shared_by_measures: of(NameSide::Measure),
            worst: worst.clone(),
            place: None,
        });
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::measure::key;

    const PRESSURE: &str = "pressure points terzaghi";
    const SETTLEMENT: &str = "settlement surface terzaghi";

    /// The error of the pressure of a case.
    fn error(case: &str) -> GoldenKey {
        key(case, 0.1, PRESSURE)
    }

    fn golden(values: &[(GoldenKey, f64)]) -> GoldenFile {
        GoldenFile { values: values.iter().cloned().collect(), ..GoldenFile::of("study", &[], "test") }
    }

    #[test]
    fn a_value_has_grown_from_the_double_on_and_a_balance_never() {
        let growth = |key: GoldenKey, golden: f64, found: f64| difference(key, golden, found).growth();
        assert_eq!(growth(error("a"), 2e-3, 7e-3), Some(3.5));
        assert_eq!(growth(error("a"), 2e-3, -4e-3), Some(2.0));
        assert_eq!(growth(error("a"), 2e-3, 3.99e-3), None);
        assert_eq!(growth(error("a"), 0.0, 1.0), None, "no share of nothing");
        assert_eq!(growth(key("a", 0.1, "water balance"), 1e-9, 1e-3), None, "a share already");
    }

    fn changes(golden: &GoldenFile, found: &[(GoldenKey, f64)]) -> Vec<(GoldenKey, Change)> {
        let found = found.iter().cloned().collect();
        compare(golden, &found).into_iter().map(|difference| (difference.key, difference.change)).collect()
    }

    #[test]
    fn a_value_within_its_tolerance_is_silent_and_ten_times_beyond_is_named_alone() {
        let [a, b] = ["a", "b"].map(error);
        let golden = golden(&[(a.clone(), 1.0), (b.clone(), 2.0)]);
        let found = |one: f64, other: f64| changes(&golden, &[(a.clone(), one), (b.clone(), other)]);
        assert_eq!(found(1.0 + 0.9e-6, 2.0), []);
        assert_eq!(found(1.0 + 1e-5, 2.0), [(a.clone(), Change::Moved)]);
        assert_eq!(found(1.0, 2.0 - 2e-5), [(b.clone(), Change::Stale)]);
    }

    #[test]
    fn missing_extra_and_no_numbers_never_agree() {
        let [a, b, c] = ["a", "b", "c"].map(error);
        let golden = golden(&[(a.clone(), 1.0), (b.clone(), 2.0)]);
        let found = changes(&golden, &[(a.clone(), f64::NAN), (c.clone(), 3.0)]);
        assert_eq!(found, [(a, Change::Moved), (b, Change::Missing), (c, Change::Extra)]);
    }

    #[test]
    fn the_largest_relative_change_comes_first_and_what_is_no_number_before_it() {
        let (small, large, none) = (error("a"), error("b"), error("c"));
        let (balance, steps) = (key("d", 0.1, "water balance"), key("e", None, "steps"));
        let keys = [&small, &large, &none, &balance, &steps].map(Clone::clone);
        let with = |values: [f64; 5]| keys.clone().into_iter().zip(values).collect::<Vec<_>>();
        let golden = golden(&with([1e3, 1e-4, 1.0, 1e-15, 1.0]));
        let found = with([1.01e3, 2e-4, f64::NAN, 1e-9, 1.0]);
        let order: Vec<GoldenKey> = changes(&golden, &found).into_iter().map(|(key, _)| key).collect();
        // One percent of a thousand is more than 1e-4 and weighs less than a doubling of 1e-4; a balance
        // that is a thousandth of a millionth of the water weighs least, though it grew by a million.
        assert_eq!(order, [none, large, small, balance]);
    }

    #[test]
    fn a_smaller_error_is_no_better_one_where_the_case_got_worse_elsewhere() {
        let keys = [error("a"), key("a", 0.1, SETTLEMENT), error("b")];
        let golden = golden(&keys.clone().map(|key| (key, 1.0)));
        let [first, second, third] = keys;
        let found = [(first.clone(), 0.5), (second.clone(), 1.1), (third.clone(), 0.5)];
        let expected = [(second, Change::Moved), (first, Change::Smaller), (third, Change::Stale)];
        assert_eq!(changes(&golden, &found), expected);
    }

    #[test]
    fn a_critical_step_that_falls_is_no_better_one() {
        let fallen = |key: GoldenKey| changes(&golden(&[(key.clone(), 1.0)]), &[(key, 0.5)])[0].1;
        assert_eq!(fallen(key("a", None, "predicted critical step")), Change::Moved);
        assert_eq!(fallen(error("a")), Change::Stale);
    }

    fn difference(key: GoldenKey, golden: f64, found: f64) -> Difference {
        Difference {
            key,
            change: if found.abs() < golden.abs() { Change::Stale } else { Change::Moved },
            golden: Some(golden),
            found: Some(found),
            tolerance: 0.0,
        }
    }

    fn only(differences: &[Difference]) -> CaseChange {
        let mut changes = case_changes(differences);
        assert_eq!(changes.len(), 1);
        changes.remove(0)
    }

    #[test]
    fn accuracy_and_cost_are_judged_together() {
        let steps = |before: f64, after: f64| difference(key("a", None, "steps"), before, after);
        let pressure = |after: f64| difference(error("a"), 0.1, after);
        let dominated = only(&[steps(100.0, 120.0), pressure(0.2)]);
        assert_eq!((dominated.change, dominated.is_stale()), (ParetoChange::Dominated, false));
        assert_eq!(dominated.cost_ratio, 1.2);
        let worse = only(&[pressure(0.2)]);
        assert_eq!((worse.change, worse.is_stale()), (ParetoChange::Dominated, false));
        let better = only(&[steps(100.0, 50.0), pressure(0.05)]);
        assert_eq!((better.change, better.is_stale()), (ParetoChange::Better, true));
        let trade = only(&[steps(100.0, 50.0), pressure(0.2)]);
        assert_eq!((trade.change, trade.is_stale()), (ParetoChange::Traded, true));
        // At the same cost some errors fell and some grew: a change of method, not a trade of cost for accuracy.
        let mixed = only(&[pressure(0.2), difference(key("a", 0.1, SETTLEMENT), 0.1, 0.05)]);
        assert_eq!((mixed.change, mixed.is_stale()), (ParetoChange::Traded, false));
    }

    #[test]
    fn what_is_no_number_never_agrees() {
        let golden = golden(&[(error("a"), 0.1)]);
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(changes(&golden, &[(error("a"), wrong)])[0].1, Change::Moved, "{wrong}");
        }
    }

    #[test]
    fn what_has_no_partner_cannot_be_compared() {
        let missing = Difference { found: None, ..difference(error("a"), 0.1, 0.1) };
        assert_eq!(only(&[missing]).change, ParetoChange::NotComparable);
        let steps = |case: &str, before: f64| difference(key(case, None, "steps"), before, 2.0);
        let from_nothing = only(&[steps("a", 0.0), difference(error("a"), 0.2, 0.1)]);
        assert_eq!((from_nothing.change, from_nothing.is_stale()), (ParetoChange::NotComparable, false));
        let all = [steps("a", 1.0), steps("b", 1.0), difference(error("a"), 1.0, 2.0)];
        let names: Vec<String> = case_changes(&all).into_iter().map(|change| change.case).collect();
        assert_eq!(names, ["a", "b"]);
    }

    /// Keys of a study with two methods, two meshes, two formulations and three measures.
    fn keys() -> Vec<GoldenKey> {
        let mut all = Vec::new();
        for method in ["MPM", "GIMP"] {
            for cells in [4, 8] {
                for variant in ["(u-p, implicit drag)", "(implicit drag)"] {
                    let case = format!("{method} implicit cells={cells} {variant}");
                    all.push(key(&case, None, "steps"));
                    all.push(key(&case, 0.1, PRESSURE));
                    all.push(key(&case, 1.0, SETTLEMENT));
                }
            }
        }
        all
    }

    /// The groups where values are changed by factors, by their names.
    fn groups(factor: impl Fn(&str) -> f64) -> Vec<DifferenceGroup> {
        let values: BTreeMap<GoldenKey, f64> = keys().into_iter().map(|key| (key, 5.0)).collect();
        let changed = |(key, value): (&GoldenKey, &f64)| (key.clone(), value * factor(&key.to_string()));
        let found = values.iter().map(changed).collect();
        let golden = GoldenFile { values: values.clone(), ..GoldenFile::of("study", &[], "test") };
        groups_of(&compare(&golden, &found), values.keys())
    }

    #[test]
    fn what_the_values_of_a_group_share_is_told_and_what_all_share_is_not() {
        let found = groups(|name| match (name.contains("u-p"), name.contains("pressure")) {
            (true, true) if name.contains("cells=8") && name.starts_with("GIMP") => 1.5,
            (true, true) => 1.1,
            _ => 1.0,
        });
        assert_eq!(found.len(), 1, "{found:?}");
        let group = &found[0];
        assert_eq!((group.change, group.values, group.cases), (Change::Moved, 4, 4));
        assert_eq!(group.shared_by_cases, ["u-p"], "`implicit` and `implicit drag` are of every case");
        assert_eq!(group.shared_by_measures, ["T_v=0.1", "points", "pressure", "terzaghi"]);
        assert!(group.worst.key.case.starts_with("GIMP implicit cells=8 (u-p"), "{}", group.worst.key);
        assert!((group.worst.relative_change().expect("both sides") - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn kinds_are_kept_apart_and_values_without_a_common_word_have_none() {
        let found = groups(|name| match name {
            name if name.starts_with("MPM") && name.contains("steps") => 2.0,
            name if name.starts_with("GIMP") && name.contains("settlement") => 0.5,
            _ => 1.0,
        });
        let kinds: Vec<_> = found.iter().map(|group| (group.change, group.values)).collect();
        assert_eq!(kinds, [(Change::Moved, 4), (Change::Stale, 4)]);
        assert_eq!(found[0].shared_by_cases, ["MPM"]);
        assert_eq!(found[1].shared_by_cases, ["GIMP"]);
        let everything = groups(|_| 1.2);
        assert!(everything[0].shared_by_cases.is_empty() && everything[0].shared_by_measures.is_empty());
    }
}
