//! Golden values against present ones.

use super::GoldenFile;
use std::collections::BTreeMap;

/// What happened to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// Beyond the tolerance, and not better.
    Moved,
    /// Beyond the tolerance, and better: the golden is to be renewed.
    Stale,
    /// In the golden and no longer measured.
    Missing,
    /// Measured and not in the golden.
    Extra,
}

impl Change {
    /// Word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moved => "moved",
            Self::Stale => "better: stale golden",
            Self::Missing => "missing",
            Self::Extra => "not in the golden",
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

/// Every difference beyond the tolerance `atol + rtol · max(|x|, |g|)`; a value that is not a
/// number never agrees.
pub fn compare(golden: &GoldenFile, found: &BTreeMap<String, f64>) -> Vec<Difference> {
    let mut differences = Vec::new();
    for (name, value) in &golden.values {
        let present = found.get(name).copied();
        let largest = value.abs().max(present.map_or(0.0, f64::abs));
        let tolerance = golden.tolerance(name, largest);
        let change = match present {
            None => Change::Missing,
            Some(present) if (present - value).abs() <= tolerance => continue,
            Some(present) if present.abs() < value.abs() => Change::Stale,
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
    differences
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
        assert_eq!(changes(&golden, &[("a", 1.0 + 0.9e-8), ("b", 2.0)]), []);
        assert_eq!(changes(&golden, &[("a", 1.0 + 1e-7), ("b", 2.0)]), [("a".to_owned(), Change::Moved)]);
        assert_eq!(changes(&golden, &[("a", 1.0), ("b", 2.0 - 2e-7)]), [("b".to_owned(), Change::Stale)]);
    }

    #[test]
    fn missing_extra_and_no_numbers_never_agree() {
        let golden = golden(&[("a", 1.0), ("b", 2.0)]);
        let found = changes(&golden, &[("a", f64::NAN), ("c", 3.0)]);
        let expected = [("a", Change::Moved), ("b", Change::Missing), ("c", Change::Extra)];
        assert_eq!(found, expected.map(|(name, change)| (name.to_owned(), change)));
    }
}
