//! How far two runs scatter that should give equal values.

use crate::golden::tolerance::ROOM;
use std::collections::BTreeMap;

/// Differences up to this are round-off of a value near zero.
const ROUND_OFF: f64 = 1e-12;

/// The largest differences between two sets of values.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct ValueScatter {
    /// Study.
    pub study: String,
    /// What was varied.
    pub source: String,
    /// Values that both runs have.
    pub values: usize,
    /// Values that one run has and the other has not.
    pub unpaired: usize,
    /// Values that differ in any bit.
    pub differing: usize,
    /// Largest difference.
    pub absolute: f64,
    /// Largest difference over the larger of the two values, among differences that are not round-off of a
    /// value near zero.
    pub relative: f64,
    /// The value with the largest relative difference.
    pub place: Option<String>,
}

impl ValueScatter {
    /// A relative tolerance that this spread allows, ten times as wide.
    pub fn tolerance(&self) -> f64 {
        ROOM * self.relative
    }
}

/// The spread between two runs.
pub fn spread_of(
    study: &str,
    source: &str,
    one: &BTreeMap<String, f64>,
    other: &BTreeMap<String, f64>,
) -> ValueScatter {
    let mut spread = ValueScatter {
        study: study.to_owned(),
        source: source.to_owned(),
        unpaired: names_missing(one, other) + names_missing(other, one),
        ..ValueScatter::default()
    };
    for (name, a) in one {
        let Some(b) = other.get(name) else { continue };
        spread.values += 1;
        if a.to_bits() == b.to_bits() {
            continue;
        }
        spread.differing += 1;
        let difference = (a - b).abs();
        let relative = difference / a.abs().max(b.abs());
        // What is no number is the widest spread of all.
        let relative = if relative.is_nan() { f64::INFINITY } else { relative };
        spread.absolute = spread.absolute.max(difference);
        // Errors are relative themselves: what is this near zero has no digits left to compare.
        if difference <= ROUND_OFF {
            continue;
        }
        if relative > spread.relative {
            spread.relative = relative;
            spread.place = Some(name.clone());
        }
    }
    spread
}

/// How many values of one run the other does not name.
fn names_missing(one: &BTreeMap<String, f64>, other: &BTreeMap<String, f64>) -> usize {
    one.keys().filter(|name| !other.contains_key(*name)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(pairs: &[(&str, f64)]) -> BTreeMap<String, f64> {
        pairs.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
    }

    #[test]
    fn the_widest_pair_is_named() {
        let one = values(&[("a", 1.0), ("b", 2.0), ("c", 3.0)]);
        let same = spread_of("s", "again", &one, &one);
        assert_eq!((same.differing, same.relative, &same.place), (0, 0.0, &None));
        let other = values(&[("a", 1.0), ("b", 2.0 + 2e-9), ("d", 1.0)]);
        let spread = spread_of("s", "kernel", &one, &other);
        assert_eq!((spread.values, spread.differing, spread.place.as_deref()), (2, 1, Some("b")));
        assert_eq!((same.unpaired, spread.unpaired), (0, 2), "a renamed value is missing on both sides");
        assert!((spread.tolerance() / 1e-8 - 1.0).abs() < 1e-6);
        let tiny = spread_of("s", "kernel", &values(&[("a", 1e-15)]), &values(&[("a", -2e-15)]));
        assert_eq!((tiny.differing, tiny.relative), (1, 0.0), "round-off of zero");
        let nonsense = spread_of("s", "kernel", &one, &values(&[("a", f64::NAN)]));
        assert_eq!(nonsense.relative, f64::INFINITY);
    }
}
