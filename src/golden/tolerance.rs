//! The tolerance of each golden value, from how far round-off alone was seen to move it when the last digit of an input
//! changes, and the bounds on what a file may allow: a tolerance leaves room for round-off, and one that lets an error of
//! the method pass is refused.

use crate::case::planned::PlannedCase;
use crate::golden::{GoldenFile, is_counter, parts};
use crate::study::check::{MOST_TOLERANCE, Study};
use crate::study::file::GoldenRule;
use oedometer_soil::elementary;
use oedometer_soil::wording::words;
use std::collections::BTreeMap;

/// Factor between the largest change seen and a tolerance that leaves room for other machines.
pub const ROOM: f64 = 10.0;
/// Smallest relative tolerance: a value moves when its meaning moves, not its last digits.
pub(super) const RELATIVE_FLOOR: f64 = 1e-9;
/// Smallest absolute tolerance. Errors are differences of values near 1: this is 1e-6 of an error of 1e-6, and more of
/// a smaller one, down to those that are zero to round-off.
pub(super) const ABSOLUTE_FLOOR: f64 = 1e-12;
/// Where tolerances come from.
pub(super) const BASIS: &str = "1e-9 of the value and 1e-12 beside it; more where round-off was seen to move it by \
                                more: ten times the largest change of the same quantity of the case at the same time \
                                when the last digit of the stiffness or of the conductivity changes (`spread`)";
/// Largest relative tolerance of a file.
const MOST_RELATIVE: f64 = 1e-6;
/// Largest absolute tolerance of a file.
const MOST_ABSOLUTE: f64 = 1e-9;
/// Largest tolerance by a measured spread, over the largest value of the spread's group.
const MOST_OF_THE_LARGEST: f64 = 0.1;
/// Largest spread that round-off around zero explains, whatever the size of the values: balances on 640 cells
/// scatter by 1.5e-10.
const ROUND_OFF: f64 = 1e-9;

/// What a value shares its spread with: the errors of one quantity of a case at one time, in all norms,
/// at all places and against all references. A single difference may be small by luck, the largest of
/// such a group is not. Work counters are whole numbers and share with none.
pub fn spread_group(name: &str) -> Option<String> {
    let (case, measure) = name.rsplit_once(" | ").filter(|(_, measure)| !is_counter(measure))?;
    let quantity = measure.split(' ').next()?;
    Some(match measure.rsplit_once(" T_v=") {
        _ if quantity == "water" => format!("{case} | water balance"),
        Some((_, time_factor)) => format!("{case} | {quantity} T_v={time_factor}"),
        None => name.to_owned(),
    })
}

/// The largest change of each group between values and what round-off alone made of them.
pub fn spread_by_group<'a>(
    values: &BTreeMap<String, f64>,
    others: impl IntoIterator<Item = &'a BTreeMap<String, f64>>,
) -> BTreeMap<String, f64> {
    let mut spread: BTreeMap<String, f64> = BTreeMap::new();
    for (name, other) in others.into_iter().flatten() {
        let (Some(group), Some(value)) = (spread_group(name), values.get(name)) else { continue };
        // A NaN on one side is not a spread: the comparison itself must fail on it.
        let change = (value - other).abs();
        if change > 0.0 && change.is_finite() {
            let largest = spread.entry(group).or_default();
            *largest = largest.max(change);
        }
    }
    spread
}

impl GoldenFile {
    /// Allowed change of a value whose larger side is of a size; of a work counter, a whole number, less than one.
    pub fn tolerance(&self, name: &str, size: f64) -> f64 {
        if is_counter(parts(name).1) {
            return 0.5;
        }
        let seen = spread_group(name).and_then(|group| self.spread.get(&group)).copied().unwrap_or(0.0);
        let relative = self.relative_tolerance.max(RELATIVE_FLOOR);
        let absolute = self.absolute_tolerance.max(ABSOLUTE_FLOOR);
        (absolute + relative * size).max(ROOM * seen).max(self.wider * (1.0 + size))
    }

    /// The file with the tolerance that its study gives all values.
    #[must_use]
    pub fn allowing(self, rule: GoldenRule) -> Self {
        let wider = if let GoldenRule::Within(tolerance) = rule { tolerance } else { 0.0 };
        Self { wider, ..self }
    }

    /// Widens the tolerances to measured spreads and narrows none: tolerances widened by hand stay. Spreads
    /// within the absolute tolerance are left out, for they widen nothing.
    #[must_use]
    pub fn widened_by(mut self, spread: BTreeMap<String, f64>) -> Self {
        self.relative_tolerance = self.relative_tolerance.max(RELATIVE_FLOOR);
        self.absolute_tolerance = self.absolute_tolerance.max(ABSOLUTE_FLOOR);
        BASIS.clone_into(&mut self.basis);
        for (group, change) in spread {
            let largest = self.spread.entry(group).or_default();
            *largest = largest.max(change);
        }
        self.spread.retain(|_, change| ROOM * *change > self.absolute_tolerance);
        self
    }

    /// What is out of bounds in the file, as a sentence; `None` where it is sound.
    pub fn out_of_bounds(&self) -> Option<String> {
        if self.reason.trim().is_empty() || self.basis.trim().is_empty() {
            let what = if self.reason.trim().is_empty() { "reason" } else { "basis" };
            return Some(format!("its `{what}` is empty: give the reason for these values and tolerances"));
        }
        let tolerances = [
            ("relative_tolerance", self.relative_tolerance, MOST_RELATIVE),
            ("absolute_tolerance", self.absolute_tolerance, MOST_ABSOLUTE),
        ];
        for (name, value, most) in tolerances {
            // Written so that NaN is refused.
            let holds = (0.0..=most).contains(&value);
            if !holds {
                return Some(format!("its `{name}` is {value:e}, which is not between 0 and {most:e}"));
            }
        }
        if let Some((name, value)) = self.values.iter().find(|(_, value)| !value.is_finite()) {
            return Some(format!("its value `{name}` is {value}"));
        }
        self.wide_spread()
    }

    /// The largest value of each group that shares a spread.
    fn largest_by_group(&self) -> BTreeMap<String, f64> {
        let mut largest: BTreeMap<String, f64> = BTreeMap::new();
        for (name, value) in &self.values {
            if let Some(group) = spread_group(name) {
                let size = largest.entry(group).or_default();
                *size = size.max(value.abs());
            }
        }
        largest
    }

    /// The value that a changed last digit moves farthest beyond what round-off explains and the study's tolerance lets pass;
    /// none where no value is moved so far. `others` are the values with each changed digit.
    pub fn jump(&self, others: &[(LastDigit, BTreeMap<String, f64>)]) -> Option<Jump> {
        let largest = self.largest_by_group();
        let jump = |(digit, name, after): (LastDigit, &String, f64)| {
            let before = *self.values.get(name)?;
            let size = spread_group(name).and_then(|group| largest.get(&group).copied())?;
            let (change, most) = ((after - before).abs(), most_spread(size));
            let is_allowed = change <= most.max(self.wider * (1.0 + before.abs().max(after.abs())));
            (!is_allowed).then(|| Jump { name: name.clone(), digit, before, after, most })
        };
        let all = others
            .iter()
            .flat_map(|(digit, values)| values.iter().map(move |(name, value)| (*digit, name, *value)));
        all.filter_map(jump).max_by(|a, b| a.needed().total_cmp(&b.needed()))
    }

    /// The measured spreads without those that only the study's tolerance covers.
    pub fn explained(&self, mut spread: BTreeMap<String, f64>) -> BTreeMap<String, f64> {
        let largest = self.largest_by_group();
        spread.retain(|group, change| *change <= most_spread(largest.get(group).copied().unwrap_or(0.0)));
        spread
    }

    /// The first spread that is wider than round-off can be.
    fn wide_spread(&self) -> Option<String> {
        let largest = self.largest_by_group();
        self.spread.iter().find_map(|(group, spread)| {
            let size = largest.get(group).copied().unwrap_or(0.0);
            let most = most_spread(size);
            let holds = (0.0..=most).contains(spread);
            (!holds).then(|| {
                format!(
                    "its spread of `{group}` is {spread:e}, which is not between 0 and {most:.1e}: round-off moves \
                     values of {size:.1e} by no more"
                )
            })
        })
    }
}

/// Largest spread that round-off explains in values of a size.
fn most_spread(size: f64) -> f64 {
    (MOST_OF_THE_LARGEST * size / ROOM).max(ROUND_OFF)
}

/// A value that jumps where the last digit of an input changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Its name.
    pub name: String,
    /// The digit.
    pub digit: LastDigit,
    /// The value.
    pub before: f64,
    /// The value with the other digit.
    pub after: f64,
    /// Largest change that round-off explains.
    pub most: f64,
}

impl Jump {
    /// Tolerance of a study that lets it pass, twice over, in one digit.
    pub fn needed(&self) -> f64 {
        let size = self.before.abs().max(self.after.abs());
        let needed = 2.0 * (self.after - self.before).abs() / (1.0 + size);
        let power = format!("{needed:e}").split('e').nth(1).map_or(0, |power| power.parse().unwrap_or(0));
        let digit = elementary::powi(10.0, power);
        format!("{:e}", (needed / digit).ceil() * digit).parse().unwrap_or(needed)
    }

    /// What jumps, why, and what can be done.
    pub fn sentence(&self) -> String {
        let Self { name, digit, before, after, most } = self;
        let needed = self.needed();
        let accepted = if needed <= MOST_TOLERANCE {
            format!(
                "let the values scatter by that much: `[golden]` with `tolerance = {needed:e}` in the study, and accept again; \
                 without golden values `golden = \"none\"` leaves the verdict to the expectations"
            )
        } else {
            "leave the verdict to the expectations: `golden = \"none\"` in the study".to_owned()
        };
        format!(
            "`{name}` changes from {before:.6e} to {after:.6e}, by {:.2e}, when the {} changes ({}), and round-off moves \
             such values by {most:.1e} at most. A solver does so that rounds a number to a whole one, most often the number \
             of its steps, as in ceil((T − t)/Δt): give that some room, as in ceil((T − t)/Δt − 1e-6). Or {accepted}",
            (after - before).abs(),
            digit.name(),
            digit.input(),
        )
    }
}

/// The input whose last digit changes. Every operator's entries follow, and with them every rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LastDigit {
    /// Young's modulus, upwards.
    Stiffness,
    /// Hydraulic conductivity, downwards.
    Conductivity,
}

words!(
    LastDigit:
    Stiffness "last digit of the stiffness", Conductivity "last digit of the conductivity",
);

impl LastDigit {
    /// The key of the input, and where its digit goes.
    fn input(self) -> &'static str {
        match self {
            Self::Stiffness => "`youngs_modulus` to the next larger number",
            Self::Conductivity => "`hydraulic_conductivity` to the next smaller number",
        }
    }

    /// Changes the digit.
    pub fn change(self, youngs_modulus: &mut f64, hydraulic_conductivity: &mut f64) {
        match self {
            Self::Stiffness => *youngs_modulus = youngs_modulus.next_up(),
            Self::Conductivity => *hydraulic_conductivity = hydraulic_conductivity.next_down(),
        }
    }
}

impl Study {
    /// The study with the last digit of an input of every case changed; its cases keep their labels.
    #[must_use]
    pub fn perturbed(&self, digit: LastDigit) -> Self {
        let planned = self.planned.iter().cloned().map(|mut planned: PlannedCase| {
            let soil = &mut *planned.case.material;
            digit.change(&mut soil.youngs_modulus, &mut soil.hydraulic_conductivity);
            planned
        });
        Self { planned: planned.collect(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenError;

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
                relative_tolerance: [1e-8, 1e-12][usize::try_from(dice(2)).expect("small")],
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
        let spread = spread_by_group(&values(1.0, 2.0), [&values(1.0 + 2e-8, 2.0), &values(1.0, f64::NAN)]);
        assert_eq!(spread.len(), 1, "{spread:?}");
        let golden = GoldenFile::of("s", &[], "test").widened_by(spread);
        assert!((golden.tolerance(ERROR, 2.0) / 2e-7 - 1.0).abs() < 1e-5, "by the other norm's change");
        let floor = ABSOLUTE_FLOOR + 2.0 * RELATIVE_FLOOR;
        assert_eq!(golden.tolerance("MPM cells=5 | pressure points l2 terzaghi T_v=0.1", 2.0), floor);
        assert_eq!(golden.tolerance("MPM cells=4 | steps", 1e9), 0.5, "counters are exact");
        let wider = golden.widened_by(BTreeMap::from([("MPM cells=4 | pressure T_v=0.1".to_owned(), 1e-7)]));
        assert!((wider.tolerance(ERROR, 2.0) / 1e-6 - 1.0).abs() < 1e-9, "the largest that was ever seen");
    }

    const VALUE: &str = "MPM cells=4 | pressure points l2 terzaghi T_v=0.1";
    const GROUP: &str = "MPM cells=4 | pressure T_v=0.1";

    fn sound() -> GoldenFile {
        let values = BTreeMap::from([(VALUE.to_owned(), 0.02)]);
        let spread = BTreeMap::from([(GROUP.to_owned(), 1e-9)]);
        GoldenFile { values, ..GoldenFile::of("study", &[], "a reason") }.widened_by(spread)
    }

    fn refusal(change: impl FnOnce(&mut GoldenFile)) -> String {
        let mut file = sound();
        change(&mut file);
        file.out_of_bounds().expect("it is refused")
    }

    #[test]
    fn tolerances_that_let_anything_or_nothing_pass_are_refused() {
        assert_eq!(sound().out_of_bounds(), None);
        for value in [1e9, 1.1e-6, -1.0, f64::NAN, f64::INFINITY] {
            let told = refusal(|file| file.relative_tolerance = value);
            assert!(told.starts_with("its `relative_tolerance` is "), "{told}");
        }
        for value in [1e9, 1.1e-9, -1e-13, f64::NAN] {
            let told = refusal(|file| file.absolute_tolerance = value);
            assert!(told.starts_with("its `absolute_tolerance` is "), "{told}");
        }
        // Ten times a hundredth of the largest value is a tenth of it.
        for value in [1e9, 2.1e-4, -1.0, f64::NAN] {
            let told = refusal(|file| {
                file.spread.insert(GROUP.to_owned(), value);
            });
            assert!(told.starts_with(&format!("its spread of `{GROUP}` is ")), "{told}");
        }
        let mut file = sound();
        file.spread.insert(GROUP.to_owned(), 1.9e-4);
        assert_eq!(file.out_of_bounds(), None);
    }

    #[test]
    fn values_without_a_reason_or_a_number_are_refused() {
        assert!(refusal(|file| file.reason = "  ".to_owned()).contains("its `reason` is empty"));
        assert!(refusal(|file| file.basis.clear()).contains("its `basis` is empty"));
        let told = refusal(|file| {
            file.values.insert(VALUE.to_owned(), f64::NAN);
        });
        assert_eq!(told, format!("its value `{VALUE}` is NaN"));
    }

    #[test]
    fn a_file_out_of_bounds_is_neither_read_nor_written() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = sound().write(folder.path()).expect("written");
        assert_eq!(GoldenFile::read(folder.path(), "study").expect("sound"), sound());
        let wide = GoldenFile { relative_tolerance: 1e9, ..sound() };
        assert!(matches!(wide.write(folder.path()), Err(GoldenError::Refused { what: "is refused", .. })));
        let text = std::fs::read_to_string(&path).expect("a file");
        let edited = text.replace("relative_tolerance = 1e-9", "relative_tolerance = 1e9");
        assert_ne!(edited, text);
        std::fs::write(&path, edited).expect("written");
        let error = GoldenFile::read(folder.path(), "study").expect_err("refused");
        assert!(error.to_string().contains("its `relative_tolerance` is 1e9"), "{error}");
    }

    #[test]
    fn a_spread_is_the_largest_change_and_its_room_that_of_the_largest_value_wherever_they_stand() {
        let name = |norm: &str| format!("MPM cells=4 | pressure points {norm} terzaghi T_v=0.1");
        let values = |all: [f64; 3]| -> BTreeMap<String, f64> {
            ["l1", "l2", "linf"].map(name).into_iter().zip(all).collect()
        };
        let (mut changes, mut sizes) = ([3e-5, 1e-5, 2e-5], [1.0, 1e-3, 2e-3]);
        for _ in 0..3 {
            let others = changes.map(|change| values([1.0, 1.0 - change, 1.0]));
            let spread = spread_by_group(&values([1.0; 3]), &others);
            assert!((spread[GROUP] / 3e-5 - 1.0).abs() < 1e-9, "{changes:?}: {spread:?}");
            let spread = spread_by_group(&values([1.0; 3]), [&values(changes.map(|change| 1.0 + change))]);
            assert!((spread[GROUP] / 3e-5 - 1.0).abs() < 1e-9, "{changes:?}: {spread:?}");
            let spread = BTreeMap::from([(GROUP.to_owned(), 9e-3)]);
            let file = GoldenFile { values: values(sizes), ..GoldenFile::of("study", &[], "a reason") };
            assert_eq!(file.widened_by(spread).out_of_bounds(), None, "{sizes:?}");
            changes.rotate_left(1);
            sizes.rotate_left(1);
        }
    }

    #[test]
    fn a_spread_is_kept_where_ten_times_it_are_more_than_the_absolute_tolerance() {
        for (by_hand, change, is_kept, tolerance) in [
            (1e-12, 0.9e-13, false, 1e-12),
            (1e-12, 1.1e-13, true, 1.1e-12),
            (1e-12, 0.9e-12, true, 9e-12),
            (1e-12, 1.1e-12, true, 1.1e-11),
            // What is narrower than the floor is the floor.
            (0.0, 0.9e-13, false, 1e-12),
            (0.0, 5e-13, true, 5e-12),
            (1e-10, 0.9e-11, false, 1e-10),
            (1e-10, 1.1e-11, true, 1.1e-10),
        ] {
            let file = GoldenFile { absolute_tolerance: by_hand, ..GoldenFile::of("s", &[], "test") };
            let other = "MPM cells=8 | pressure T_v=0.1";
            let file =
                file.widened_by([(GROUP, change), (other, 1e-9)].map(|(n, s)| (n.to_owned(), s)).into());
            assert_eq!(file.spread.contains_key(GROUP), is_kept, "{change:e} at {by_hand:e}");
            assert_eq!(file.spread.get(other), Some(&1e-9), "each for itself");
            let allowed = file.tolerance(VALUE, 0.0);
            assert!((allowed / tolerance - 1.0).abs() < 1e-9, "{allowed:e} for {change:e} at {by_hand:e}");
        }
    }

    #[test]
    fn a_last_digit_is_that_of_one_input_of_every_case_and_labels_stay() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2, 3]\n";
        let source = crate::study::file::StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        let study = Study::check(&source).expect("sound");
        for (digit, stiffness, conductivity) in [
            (LastDigit::Stiffness, 1e6_f64.next_up(), 1e-4),
            (LastDigit::Conductivity, 1e6, 1e-4_f64.next_down()),
        ] {
            let other = study.perturbed(digit);
            for (before, after) in study.planned.iter().zip(&other.planned) {
                let wanted =
                    crate::case::Case { material: after.case.material.clone(), ..before.case.clone() };
                assert_eq!((&after.case, after.case.label()), (&wanted, before.case.label()));
                let soil = &after.case.material;
                assert_eq!(
                    (soil.youngs_modulus, soil.hydraulic_conductivity),
                    (stiffness, conductivity),
                    "{digit:?}"
                );
            }
            assert_eq!(other.planned.len(), 2);
        }
    }
}
