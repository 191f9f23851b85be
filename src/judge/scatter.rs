//! The differences between two runs that should give equal values.

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
    /// Values that only one of the runs has.
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
    /// The relative tolerance for this spread, ten times as wide.
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
    let both = || one.iter().filter_map(|(name, a)| Some((name, *a, *other.get(name)?)));
    let missing_in = |of: &BTreeMap<String, f64>, from: &BTreeMap<String, f64>| {
        of.keys().filter(|name| !from.contains_key(*name)).count()
    };
    // NaN is the widest spread of all.
    let relative = |a: f64, b: f64| {
        let relative = (a - b).abs() / a.abs().max(b.abs());
        if relative.is_nan() { f64::INFINITY } else { relative }
    };
    let differing = || both().filter(|(_, a, b)| a.to_bits() != b.to_bits());
    // Errors are relative themselves: a value this near zero has no digits left to compare.
    let compared = differing().filter(|(_, a, b)| (a - b).is_nan() || (a - b).abs() > ROUND_OFF);
    let worst = compared
        .map(|(name, a, b)| (name, relative(a, b)))
        .filter(|(_, relative)| *relative > 0.0)
        .reduce(|worst, next| if next.1 > worst.1 { next } else { worst });
    ValueScatter {
        study: study.to_owned(),
        source: source.to_owned(),
        values: both().count(),
        unpaired: missing_in(one, other) + missing_in(other, one),
        differing: differing().count(),
        absolute: differing().map(|(_, a, b)| (a - b).abs()).fold(0.0, f64::max),
        relative: worst.map_or(0.0, |(_, relative)| relative),
        place: worst.map(|(name, _)| name.clone()),
    }
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
