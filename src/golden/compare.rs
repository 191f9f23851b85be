//! Golden values against present ones.

use crate::golden::references::REFERENCES;
use crate::golden::{GoldenFile, parts};
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
    /// the change itself. Infinite for what is no number, `None` where one side is missing.
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

    /// The order of a list: kinds by how bad they are, then the largest relative change first.
    fn worst_first(&self, other: &Self) -> Ordering {
        let size = |one: &Self| one.relative_change().unwrap_or(0.0);
        self.change
            .cmp(&other.change)
            .then_with(|| size(other).total_cmp(&size(self)))
            .then_with(|| self.name.cmp(&other.name))
    }
}

/// Whether a smaller value is a better one: an error or a counter, and no exact solution or critical step.
fn is_better_if_smaller(study: &str, name: &str) -> bool {
    study != REFERENCES && !parts(name).1.ends_with("critical step")
}

/// Every difference beyond the tolerance `atol + rtol · max(|x|, |g|)`, the worst first; a value that is
/// not a number never agrees.
pub fn compare(golden: &GoldenFile, found: &BTreeMap<String, f64>) -> Vec<Difference> {
    let mut differences = Vec::new();
    for (name, value) in &golden.values {
        let present = found.get(name).copied();
        let largest = value.abs().max(present.map_or(0.0, f64::abs));
        let tolerance = golden.tolerance(name, largest);
        let change = match present {
            None => Change::Missing,
            Some(present) if (present - value).abs() <= tolerance => continue,
            Some(present) if present.abs() < value.abs() && is_better_if_smaller(&golden.study, name) => {
                Change::Stale
            }
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

/// A value that fell is no good news in a case where another one moved.
fn tell_apart_what_is_paid_for(differences: &mut [Difference]) {
    let case_of = |one: &Difference| parts(&one.name).0.to_owned();
    let moved = |one: &&Difference| one.change == Change::Moved;
    let worse: BTreeSet<String> = differences.iter().filter(moved).map(case_of).collect();
    for one in differences.iter_mut().filter(|one| one.change == Change::Stale) {
        if worse.contains(parts(&one.name).0) {
            one.change = Change::Smaller;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn golden(values: &[(&str, f64)]) -> GoldenFile {
        let values = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        GoldenFile { values, ..GoldenFile::of("study", &[], "test") }
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
    fn an_exact_solution_or_a_critical_step_that_falls_is_no_better_one() {
        let step = "a | predicted critical step";
        let fallen = |study: &str, name: &str| {
            let golden = GoldenFile { study: study.to_owned(), ..golden(&[(name, 1.0)]) };
            changes(&golden, &[(name, 0.5)])[0].1
        };
        assert_eq!(fallen("study", step), Change::Moved);
        assert_eq!(fallen("references", "terzaghi seed column | p/q ζ=0.5 T_v=0.02"), Change::Moved);
        assert_eq!(fallen("study", "a | pressure points l2 terzaghi T_v=0.1"), Change::Stale);
    }
}
