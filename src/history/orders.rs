//! Orders and classes of a study's errors under refinement, found from values by their names.

use crate::golden::compare::Difference;
use crate::golden::{is_error, parts};
use oedometer_convergence::{Context, ErrorSeries, SeriesLevel, classify};
use std::collections::{BTreeMap, BTreeSet};

/// Errors up to this are round-off.
const ROUND_OFF: f64 = 1e-12;
/// Change of an order that is told.
const TOLD: f64 = 0.05;
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
        let context = Context { round_off: Some(ROUND_OFF), signed, ..Context::default() };
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
    let moved = differences.iter().filter(|one| one.golden.is_some() && one.found.is_some());
    let asked: BTreeSet<String> = moved.flat_map(|one| places(&one.name)).map(|(key, _)| key).collect();
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
        let lost = changes([4e-2, 1e-2, 4e-2]);
        assert!(lost[0].after.class != lost[0].before.class, "{lost:?}");
    }
}
