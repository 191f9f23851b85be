//! Compares golden values with present ones: value by value, by case, and by kind of change.
//!
//! Accuracy and cost are judged together: a case that is dearer or worse than its golden values, and in nothing better,
//! is dominated by them; one that pays for one with the other is a trade. A long list of differences says less than one
//! line a kind, with what its values have in common and its largest change.

use crate::golden::{GoldenFile, is_counter, parts};
use oedometer_convergence::ParetoChange;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

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
    /// Case and measure.
    pub name: String,
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
        let measure = parts(&self.name).1;
        let size = match measure {
            _ if measure.starts_with("water balance") => 1.0,
            _ if measure.contains("T_v=") => largest.max(LEAST_SIZE),
            _ => largest,
        };
        let change = (found - golden).abs() / size;
        Some(if change.is_nan() { f64::INFINITY } else { change })
    }

    /// How many times its golden value it is, from the double on: a change over the larger value says nothing of that.
    pub fn growth(&self) -> Option<f64> {
        let times = self.found?.abs() / self.golden?.abs();
        let is_share = parts(&self.name).1.starts_with("water balance");
        (times >= 2.0 && times.is_finite() && !is_share).then_some(times)
    }

    /// The order of a list: kinds by how bad they are, then the largest relative change first.
    fn worst_first(&self, other: &Self) -> Ordering {
        let size = |difference: &Self| difference.relative_change().unwrap_or(0.0);
        self.change
            .cmp(&other.change)
            .then_with(|| size(other).total_cmp(&size(self)))
            .then_with(|| self.name.cmp(&other.name))
    }
}

/// Whether a smaller value is better: true of errors and counters, not of critical steps.
fn is_better_if_smaller(name: &str) -> bool {
    !parts(name).1.ends_with("critical step")
}

/// Every difference beyond the tolerance `atol + rtol · max(|x|, |g|)`, the worst first; a value that is
/// not a finite number never agrees.
pub fn compare(golden: &GoldenFile, found: &BTreeMap<String, f64>) -> Vec<Difference> {
    let mut differences = Vec::new();
    for (name, value) in &golden.values {
        let present = found.get(name).copied();
        let largest = value.abs().max(present.map_or(0.0, f64::abs));
        let tolerance = golden.tolerance(name, largest);
        let change = match present {
            None => Change::Missing,
            Some(present) if tolerance.is_finite() && (present - value).abs() <= tolerance => continue,
            Some(present) if present.abs() < value.abs() && is_better_if_smaller(name) => Change::Stale,
            Some(_) => Change::Moved,
        };
        differences.push(Difference {
            name: name.clone(),
            change,
            golden: Some(*value),
            found: present,
            tolerance,
        });
    }
    for (name, value) in found.iter().filter(|(name, _)| !golden.values.contains_key(*name)) {
        differences.push(Difference {
            name: name.clone(),
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
    let case_of = |difference: &Difference| parts(&difference.name).0.to_owned();
    let moved = |difference: &&Difference| difference.change == Change::Moved;
    let worse: BTreeSet<String> = differences.iter().filter(moved).map(case_of).collect();
    for difference in differences.iter_mut().filter(|difference| difference.change == Change::Stale) {
        if worse.contains(parts(&difference.name).0) {
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
    /// Largest ratio of a work counter to its golden value; 1 where none changed.
    pub cost_ratio: f64,
    /// Errors that grew beyond their tolerance.
    pub worse: usize,
    /// Errors that fell beyond their tolerance.
    pub better: usize,
    /// Values that are missing, or that nothing is known of.
    pub unpaired: usize,
}

impl CaseChange {
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
    let mut changes: Vec<CaseChange> = Vec::new();
    for difference in differences {
        let (case, measure) = parts(&difference.name);
        let place = changes.iter().position(|change| change.case == case).unwrap_or_else(|| {
            changes.push(CaseChange {
                case: case.to_owned(),
                change: ParetoChange::Same,
                cost_ratio: 1.0,
                worse: 0,
                better: 0,
                unpaired: 0,
            });
            changes.len() - 1
        });
        let change = &mut changes[place];
        match (difference.golden, difference.found) {
            (Some(golden), Some(found)) if is_counter(measure) => {
                let ratio = found / golden;
                if (ratio - 1.0).abs() > (change.cost_ratio - 1.0).abs() {
                    change.cost_ratio = ratio;
                }
            }
            (Some(_), Some(_)) if matches!(difference.change, Change::Stale | Change::Smaller) => {
                change.better += 1;
            }
            (Some(_), Some(_)) => change.worse += 1,
            _ => change.unpaired += 1,
        }
    }
    for change in &mut changes {
        let worse = change.worse > 0 || change.cost_ratio > 1.0;
        let better = change.better > 0 || change.cost_ratio < 1.0;
        change.change = match (change.unpaired > 0 || !change.cost_ratio.is_finite(), better, worse) {
            (true, ..) => ParetoChange::NotComparable,
            (_, false, false) => ParetoChange::Same,
            (_, true, false) => ParetoChange::Better,
            (_, true, true) => ParetoChange::Traded,
            (_, false, true) => ParetoChange::Dominated,
        };
    }
    changes
}

/// Cases that only the first of two states has, and those that only the second has, by the names of their values.
pub fn cases_apart<'a>(
    before: impl IntoIterator<Item = &'a String>,
    after: impl IntoIterator<Item = &'a String>,
) -> [Vec<String>; 2] {
    let before: BTreeSet<&str> = before.into_iter().map(|name| parts(name).0).collect();
    let after: BTreeSet<&str> = after.into_iter().map(|name| parts(name).0).collect();
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

/// Words of a value's name, each marked with the side it stands on.
fn words(name: &str) -> BTreeSet<(NameSide, &str)> {
    let (case, measure) = parts(name);
    // Variants stand in brackets behind the label: `(u-p, implicit drag)`.
    let (label, variants) = case.split_once(" (").unwrap_or((case, ""));
    let variants = variants.trim_end_matches(')').split(", ").filter(|variant| !variant.is_empty());
    let of_case = label.split_whitespace().chain(variants).map(|word| (NameSide::Case, word));
    of_case.chain(measure.split_whitespace().map(|word| (NameSide::Measure, word))).collect()
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum NameSide {
    Case,
    Measure,
}

/// The groups of differences that are in their order, the worst group first. `all` are the names of
/// every value that was compared.
pub fn groups_of<'a>(
    differences: &[Difference],
    all: impl IntoIterator<Item = &'a str>,
) -> Vec<DifferenceGroup> {
    let mut everywhere: BTreeMap<(NameSide, &str), usize> = BTreeMap::new();
    let mut number = 0;
    for name in all {
        number += 1;
        for word in words(name) {
            *everywhere.entry(word).or_default() += 1;
        }
    }
    let mut groups = Vec::new();
    for of_kind in differences.chunk_by(|a, b| a.change == b.change) {
        let Some(worst) = of_kind.first() else { continue };
        let mut shared = words(&worst.name);
        for difference in of_kind {
            let words = words(&difference.name);
            shared.retain(|word| words.contains(word));
        }
        shared.retain(|word| everywhere.get(word).is_none_or(|count| *count < number));
        let of = |side| shared.iter().filter(|word| word.0 == side).map(|word| word.1.to_owned()).collect();
        groups.push(DifferenceGroup {
            change: worst.change,
            values: of_kind.len(),
            cases: of_kind.iter().map(|difference| parts(&difference.name).0).collect::<BTreeSet<_>>().len(),
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

    fn golden(values: &[(&str, f64)]) -> GoldenFile {
        let values = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        GoldenFile { values, ..GoldenFile::of("study", &[], "test") }
    }

    #[test]
    fn a_value_has_grown_from_the_double_on_and_a_balance_never() {
        let growth = |name: &str, golden: f64, found: f64| difference(name, golden, found).growth();
        assert_eq!(growth("a | pressure points l2", 2e-3, 7e-3), Some(3.5));
        assert_eq!(growth("a | pressure points l2", 2e-3, -4e-3), Some(2.0));
        assert_eq!(growth("a | pressure points l2", 2e-3, 3.99e-3), None);
        assert_eq!(growth("a | pressure points l2", 0.0, 1.0), None, "no share of nothing");
        assert_eq!(growth("a | water balance", 1e-9, 1e-3), None, "a share already");
    }

    fn changes(golden: &GoldenFile, found: &[(&str, f64)]) -> Vec<(String, Change)> {
        let found = found.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        compare(golden, &found).into_iter().map(|difference| (difference.name, difference.change)).collect()
    }

    #[test]
    fn a_value_within_its_tolerance_is_silent_and_ten_times_beyond_is_named_alone() {
        let golden = golden(&[("a", 1.0), ("b", 2.0)]);
        assert_eq!(changes(&golden, &[("a", 1.0 + 0.9e-9), ("b", 2.0)]), []);
        assert_eq!(changes(&golden, &[("a", 1.0 + 1e-8), ("b", 2.0)]), [("a".to_owned(), Change::Moved)]);
        assert_eq!(changes(&golden, &[("a", 1.0), ("b", 2.0 - 2e-8)]), [("b".to_owned(), Change::Stale)]);
    }

    #[test]
    fn missing_extra_and_no_numbers_never_agree() {
        let golden = golden(&[("a", 1.0), ("b", 2.0)]);
        let found = changes(&golden, &[("a", f64::NAN), ("c", 3.0)]);
        let expected = [("a", Change::Moved), ("b", Change::Missing), ("c", Change::Extra)];
        assert_eq!(found, expected.map(|(name, change)| (name.to_owned(), change)));
    }

    #[test]
    fn the_largest_relative_change_comes_first_and_what_is_no_number_before_it() {
        let pressure = |case: &str| format!("{case} | pressure points l2 terzaghi T_v=0.1");
        let (small, large, none) = (pressure("a"), pressure("b"), pressure("c"));
        let balance = "d | water balance T_v=0.1";
        let golden =
            golden(&[(&small, 1e3), (&large, 1e-4), (&none, 1.0), (balance, 1e-15), ("e | steps", 1.0)]);
        let found =
            [(&*small, 1.01e3), (&*large, 2e-4), (&*none, f64::NAN), (balance, 1e-11), ("e | steps", 1.0)];
        let order: Vec<String> = changes(&golden, &found).into_iter().map(|(name, _)| name).collect();
        // One percent of a thousand is more than 1e-4 and weighs less than a doubling of 1e-4; a balance
        // that is a thousandth of a millionth of the water weighs least, though it grew by ten thousand.
        assert_eq!(order, [none.as_str(), &large, &small, balance]);
    }

    #[test]
    fn a_smaller_error_is_no_better_one_where_the_case_got_worse_elsewhere() {
        let names = ["a | pressure T_v=0.1", "a | settlement T_v=0.1", "b | pressure T_v=0.1"];
        let golden = golden(&names.map(|name| (name, 1.0)));
        let found = changes(&golden, &[(names[0], 0.5), (names[1], 1.1), (names[2], 0.5)]);
        let expected = [(names[1], Change::Moved), (names[0], Change::Smaller), (names[2], Change::Stale)];
        assert_eq!(found, expected.map(|(name, change)| (name.to_owned(), change)));
    }

    #[test]
    fn a_critical_step_that_falls_is_no_better_one() {
        let fallen = |name: &str| changes(&golden(&[(name, 1.0)]), &[(name, 0.5)])[0].1;
        assert_eq!(fallen("a | predicted critical step"), Change::Moved);
        assert_eq!(fallen("a | pressure points l2 terzaghi T_v=0.1"), Change::Stale);
    }

    fn difference(name: &str, golden: f64, found: f64) -> Difference {
        Difference {
            name: name.to_owned(),
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
        let (steps, error, other) = ("a | steps", "a | pressure T_v=0.1", "a | settlement T_v=0.1");
        let dominated = only(&[difference(steps, 100.0, 120.0), difference(error, 0.1, 0.2)]);
        assert_eq!((dominated.change, dominated.is_stale()), (ParetoChange::Dominated, false));
        let worse = only(&[difference(error, 0.1, 0.2)]);
        assert_eq!((worse.change, worse.is_stale()), (ParetoChange::Dominated, false));
        let better = only(&[difference(steps, 100.0, 50.0), difference(error, 0.1, 0.05)]);
        assert_eq!((better.change, better.is_stale()), (ParetoChange::Better, true));
        let trade = only(&[difference(steps, 100.0, 50.0), difference(error, 0.1, 0.2)]);
        assert_eq!((trade.change, trade.is_stale()), (ParetoChange::Traded, true));
        // At the same cost some errors fell and some grew: a change of method, not a trade of cost for accuracy.
        let mixed = only(&[difference(error, 0.1, 0.2), difference(other, 0.1, 0.05)]);
        assert_eq!((mixed.change, mixed.is_stale()), (ParetoChange::Traded, false));
    }

    #[test]
    fn what_is_no_number_never_agrees() {
        let golden = GoldenFile {
            values: BTreeMap::from([("a | pressure T_v=0.1".to_owned(), 0.1)]),
            ..GoldenFile::of("study", &[], "test")
        };
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let found = BTreeMap::from([("a | pressure T_v=0.1".to_owned(), wrong)]);
            assert_eq!(compare(&golden, &found)[0].change, Change::Moved, "{wrong}");
        }
    }

    #[test]
    fn what_has_no_partner_cannot_be_compared() {
        let missing = Difference { found: None, ..difference("a | pressure T_v=0.1", 0.1, 0.1) };
        assert_eq!(only(&[missing]).change, ParetoChange::NotComparable);
        let from_nothing =
            only(&[difference("a | steps", 0.0, 5.0), difference("a | pressure T_v=1", 0.2, 0.1)]);
        assert_eq!((from_nothing.change, from_nothing.is_stale()), (ParetoChange::NotComparable, false));
        let names: Vec<String> = case_changes(&[
            difference("a | steps", 1.0, 2.0),
            difference("b | steps", 1.0, 2.0),
            difference("a | pressure T_v=1", 1.0, 2.0),
        ])
        .into_iter()
        .map(|change| change.case)
        .collect();
        assert_eq!(names, ["a", "b"]);
    }

    /// Names of a study with two methods, two meshes, two formulations and three measures.
    fn names() -> Vec<String> {
        let mut all = Vec::new();
        for method in ["MPM", "GIMP"] {
            for cells in [4, 8] {
                for variant in ["(u-p, implicit drag)", "(implicit drag)"] {
                    for measure in
                        ["steps", "pressure points l2 terzaghi T_v=0.1", "settlement surface relative T_v=1"]
                    {
                        all.push(format!("{method} implicit cells={cells} {variant} | {measure}"));
                    }
                }
            }
        }
        all
    }

    /// The groups where values are changed by factors.
    fn groups(factor: impl Fn(&str) -> f64) -> Vec<DifferenceGroup> {
        let values: BTreeMap<String, f64> = names().into_iter().map(|name| (name, 5.0)).collect();
        let found = values.iter().map(|(name, value)| (name.clone(), value * factor(name))).collect();
        let golden = GoldenFile { values: values.clone(), ..GoldenFile::of("study", &[], "test") };
        groups_of(&compare(&golden, &found), values.keys().map(String::as_str))
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
        assert_eq!(group.shared_by_measures, ["T_v=0.1", "l2", "points", "pressure", "terzaghi"]);
        assert!(group.worst.name.starts_with("GIMP implicit cells=8 (u-p"), "{}", group.worst.name);
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
        let everything = groups(|_| 1.1);
        assert!(everything[0].shared_by_cases.is_empty() && everything[0].shared_by_measures.is_empty());
    }
}
