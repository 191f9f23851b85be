//! The tolerance of each golden value, from how far round-off alone was seen to move it.

use crate::golden::GoldenFile;
use std::collections::BTreeMap;

/// Factor between the largest change seen and a tolerance that leaves room for other machines.
pub const ROOM: f64 = 10.0;
/// Allowed relative change where round-off was not seen to do more: last digits.
pub const RELATIVE_FLOOR: f64 = 1e-12;
/// Allowed absolute change where round-off was not seen to do more: what the exact solutions are good to.
pub const ABSOLUTE_FLOOR: f64 = 1e-13;
/// Where such tolerances come from.
pub const BASIS: &str = "round-off, measured by `oedometer spread` and by `accept` itself: ten times the largest change \
                         of the same quantity of the case at the same time when the last digit of the stiffness or of \
                         the conductivity changes (`spread`); where that is less, the 1e-13 that the exact solutions \
                         are good to and the last digits of another platform's functions";

/// What a value shares its spread with: the errors of one quantity of a case at one time, in all norms,
/// at all places and against all references. A single difference may be small by luck, the largest of
/// such a group is not. Work counters are whole numbers and share with none.
pub fn spread_group(name: &str) -> Option<String> {
    let (case, measure) = name.rsplit_once(" | ")?;
    let quantity = measure.split(' ').next()?;
    match (measure, quantity, measure.rsplit_once(" T_v=")) {
        ("steps" | "point updates", ..) => None,
        (_, "water", _) => Some(format!("{case} | water balance")),
        (_, _, Some((_, time_factor))) => Some(format!("{case} | {quantity} T_v={time_factor}")),
        (_, _, None) => Some(name.to_owned()),
    }
}

/// The largest change of each group between values and what round-off alone made of them.
pub fn spread_by_group<'a>(
    values: &BTreeMap<String, f64>,
    others: impl IntoIterator<Item = &'a BTreeMap<String, f64>>,
) -> BTreeMap<String, f64> {
    let mut spread: BTreeMap<String, f64> = BTreeMap::new();
    for (name, other) in others.into_iter().flatten() {
        let (Some(group), Some(value)) = (spread_group(name), values.get(name)) else { continue };
        // What is no number on one side is no spread: the comparison itself must fail on it.
        let change = (value - other).abs();
        if change > 0.0 && change.is_finite() {
            let largest = spread.entry(group).or_default();
            *largest = largest.max(change);
        }
    }
    spread
}

impl GoldenFile {
    /// Allowed change of a value whose larger side is of a size.
    pub fn tolerance(&self, name: &str, size: f64) -> f64 {
        let seen = spread_group(name).and_then(|group| self.spread.get(&group)).copied().unwrap_or(0.0);
        let floor = self.absolute_tolerance + self.relative_tolerance * size;
        floor.max(ROOM * seen)
    }

    /// The same values with tolerances from measured spreads, which widen those there are.
    #[must_use]
    pub fn with_spread(mut self, spread: BTreeMap<String, f64>) -> Self {
        self.relative_tolerance = RELATIVE_FLOOR;
        self.absolute_tolerance = ABSOLUTE_FLOOR;
        BASIS.clone_into(&mut self.basis);
        for (group, change) in spread {
            let largest = self.spread.entry(group).or_default();
            *largest = largest.max(change);
        }
        self
    }
}

impl GoldenFile {
    /// The same values with tolerances that measured spreads widen and nothing narrows: what somebody has widened by
    /// hand stays wide.
    #[must_use]
    pub fn widened_by(self, spread: BTreeMap<String, f64>) -> Self {
        let (relative, absolute) = (self.relative_tolerance, self.absolute_tolerance);
        let measured = self.with_spread(spread);
        Self {
            relative_tolerance: measured.relative_tolerance.max(relative),
            absolute_tolerance: measured.absolute_tolerance.max(absolute),
            ..measured
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_widen_in_any_order_and_never_narrow_not_even_what_was_widened_by_hand() {
        let mut seed = 3_u64;
        let mut dice = |count: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % count
        };
        let name = |case: u64| format!("MPM cells={case} | pressure points l2 terzaghi T_v=0.1");
        for _ in 0..300 {
            let mut measured = || -> BTreeMap<String, f64> {
                let groups = (0..dice(4)).map(|_| {
                    let group = spread_group(&name(dice(3))).expect("a group");
                    // Spreads that a file may have without values: around zero.
                    (group, 10.0_f64.powi(-9 - i32::try_from(dice(8)).expect("small")))
                });
                groups.collect()
            };
            let (first, second) = (measured(), measured());
            let by_hand = GoldenFile {
                relative_tolerance: [1e-9, 1e-12][usize::try_from(dice(2)).expect("small")],
                absolute_tolerance: [1e-10, 1e-13][usize::try_from(dice(2)).expect("small")],
                ..GoldenFile::of("s", &[], "test")
            };
            let steps = [
                by_hand.clone(),
                by_hand.clone().widened_by(first.clone()),
                by_hand.clone().widened_by(first.clone()).widened_by(second.clone()),
                by_hand
                    .clone()
                    .widened_by(first.clone())
                    .widened_by(second.clone())
                    .widened_by(BTreeMap::new()),
            ];
            let other_way = by_hand.clone().widened_by(second.clone()).widened_by(first.clone());
            for case in 0..3 {
                for size in [0.0, 1e-3, 1.0] {
                    let all: Vec<f64> = steps.iter().map(|file| file.tolerance(&name(case), size)).collect();
                    assert!(all.is_sorted(), "{all:?} narrows: {first:?} {second:?}");
                    assert_eq!(other_way.tolerance(&name(case), size), all[3], "{first:?} {second:?}");
                }
            }
            // Kept in a file and read back it allows the same.
            let folder = tempfile::TempDir::new().expect("a folder");
            other_way.write(folder.path()).expect("written");
            let read = GoldenFile::read(folder.path(), "s").expect("read");
            assert_eq!(read.tolerance(&name(0), 1.0), other_way.tolerance(&name(0), 1.0));
        }
    }

    const ERROR: &str = "MPM cells=4 | pressure points l2 terzaghi T_v=0.1";

    #[test]
    fn values_share_a_spread_by_case_quantity_and_time() {
        assert_eq!(spread_group(ERROR).as_deref(), Some("MPM cells=4 | pressure T_v=0.1"));
        let balance = "MPM cells=4 | water balance T_v=0.1";
        assert_eq!(spread_group(balance).as_deref(), Some("MPM cells=4 | water balance"));
        assert_eq!(spread_group("MPM cells=4 | steps"), None);
        let step = "MPM cells=4 | predicted critical step";
        assert_eq!(spread_group(step).as_deref(), Some(step));
    }

    #[test]
    fn a_tolerance_is_ten_times_the_spread_of_the_group_or_the_floor() {
        let values = |l1: f64, l2: f64| {
            BTreeMap::from([
                ("MPM cells=4 | pressure points l1 terzaghi T_v=0.1".to_owned(), l1),
                (ERROR.to_owned(), l2),
                ("MPM cells=4 | steps".to_owned(), l1),
            ])
        };
        let spread = spread_by_group(&values(1.0, 2.0), [&values(1.0 + 2e-10, 2.0), &values(1.0, f64::NAN)]);
        assert_eq!(spread.len(), 1, "{spread:?}");
        let golden = GoldenFile::of("s", &[], "test").with_spread(spread);
        assert!((golden.tolerance(ERROR, 2.0) / 2e-9 - 1.0).abs() < 1e-5, "by the other norm's change");
        let floor = ABSOLUTE_FLOOR + 2.0 * RELATIVE_FLOOR;
        assert_eq!(golden.tolerance("MPM cells=5 | pressure points l2 terzaghi T_v=0.1", 2.0), floor);
        assert!(golden.tolerance("MPM cells=4 | steps", 1e6) < 1e-3, "counters are exact");
        let wider = golden.with_spread(BTreeMap::from([("MPM cells=4 | pressure T_v=0.1".to_owned(), 1e-9)]));
        assert!((wider.tolerance(ERROR, 2.0) / 1e-8 - 1.0).abs() < 1e-9, "the largest that was ever seen");
    }
}
