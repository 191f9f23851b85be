//! The tolerance of each golden value: 1e-6 of it and 1e-10 beside it; more where the study says so, or where round-off
//! alone was seen to move it by more when the last digit of an input changes. And the bound on what a file may allow: one that
//! lets an error of the method pass is refused.

use crate::case::planned::PlannedCase;
use crate::golden::GoldenFile;
use crate::golden::measure::{GoldenKey, Measure, SpreadKey};
use crate::study::check::{MOST_TOLERANCE, Study};
use crate::study::file::GoldenRule;
use oedometer_soil::elementary;
use oedometer_wording::words;
use std::collections::BTreeMap;

/// Factor between the largest change seen and a tolerance that leaves room for other machines.
pub const ROOM: f64 = 10.0;
/// Change of a value, over the larger side, that always passes: a value moves when its meaning moves, not its last digits.
const RELATIVE: f64 = 1e-6;
/// Change beside it that always passes: errors are differences of values near 1, and those that are zero to round-off
/// scatter by less.
const ABSOLUTE: f64 = 1e-10;
/// Largest tolerance by a measured spread, over the largest value of the spread's group.
const MOST_OF_THE_LARGEST: f64 = 0.1;
/// Largest spread that round-off around zero explains, whatever the size of the values: balances on 640 cells
/// scatter by 1.5e-10.
const ROUND_OFF: f64 = 1e-9;

/// The largest change of each group between values and what round-off alone made of them.
pub fn spread_by_group<'a>(
    values: &BTreeMap<GoldenKey, f64>,
    others: impl IntoIterator<Item = &'a BTreeMap<GoldenKey, f64>>,
) -> BTreeMap<SpreadKey, f64> {
    let mut spread: BTreeMap<SpreadKey, f64> = BTreeMap::new();
    for (key, other) in others.into_iter().flatten() {
        let (Some(group), Some(value)) = (key.spread(), values.get(key)) else { continue };
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
    /// Allowed change of a value whose larger side is of a size; of steps, a whole number, less than one.
    pub fn tolerance(&self, key: &GoldenKey, size: f64) -> f64 {
        if key.measure == Measure::Steps {
            return 0.5;
        }
        let seen = key.spread().and_then(|group| self.spread.get(&group)).copied().unwrap_or(0.0);
        (ABSOLUTE + RELATIVE * size).max(ROOM * seen).max(self.wider * (1.0 + size))
    }

    /// The file with the tolerance that its study gives all values.
    #[must_use]
    pub fn allowing(self, rule: GoldenRule) -> Self {
        let wider = if let GoldenRule::Within(tolerance) = rule { tolerance } else { 0.0 };
        Self { wider, ..self }
    }

    /// Widens the tolerances to measured spreads and narrows none. Spreads that widen no tolerance are left out.
    #[must_use]
    pub fn widened_by(mut self, spread: BTreeMap<SpreadKey, f64>) -> Self {
        for (group, change) in spread {
            let largest = self.spread.entry(group).or_default();
            *largest = largest.max(change);
        }
        let mut least: BTreeMap<SpreadKey, f64> = BTreeMap::new();
        for (key, value) in &self.values {
            if let Some(group) = key.spread() {
                let size = least.entry(group).or_insert(f64::INFINITY);
                *size = size.min(value.abs());
            }
        }
        self.spread.retain(|group, change| {
            ROOM * *change > ABSOLUTE + RELATIVE * least.get(group).copied().unwrap_or(0.0)
        });
        self
    }

    /// What is out of bounds in the file, as a sentence; `None` where it is sound.
    pub fn out_of_bounds(&self) -> Option<String> {
        if self.reason.trim().is_empty() {
            return Some("its `reason` is empty: give the reason for these values".to_owned());
        }
        if let Some((key, value)) = self.values.iter().find(|(_, value)| !value.is_finite()) {
            return Some(format!("its value `{key}` is {value}"));
        }
        self.wide_spread()
    }

    /// The largest value of each group that shares a spread.
    fn largest_by_group(&self) -> BTreeMap<SpreadKey, f64> {
        let mut largest: BTreeMap<SpreadKey, f64> = BTreeMap::new();
        for (key, value) in &self.values {
            if let Some(group) = key.spread() {
                let size = largest.entry(group).or_default();
                *size = size.max(value.abs());
            }
        }
        largest
    }

    /// The value that a changed last digit moves farthest beyond what round-off explains and the study's tolerance lets pass;
    /// none where no value is moved so far. `others` are the values with each changed digit.
    pub fn jump(&self, others: &[(LastDigit, BTreeMap<GoldenKey, f64>)]) -> Option<Jump> {
        let largest = self.largest_by_group();
        let jump = |(digit, key, after): (LastDigit, &GoldenKey, f64)| {
            let before = *self.values.get(key)?;
            let size = key.spread().and_then(|group| largest.get(&group).copied())?;
            let (change, most) = ((after - before).abs(), most_spread(size));
            let is_allowed = change <= most.max(self.wider * (1.0 + before.abs().max(after.abs())));
            (!is_allowed).then(|| Jump { key: key.clone(), digit, before, after, most })
        };
        let all = others
            .iter()
            .flat_map(|(digit, values)| values.iter().map(move |(key, value)| (*digit, key, *value)));
        all.filter_map(jump).max_by(|a, b| a.needed().total_cmp(&b.needed()))
    }

    /// The measured spreads without those that only the study's tolerance covers.
    pub fn explained(&self, mut spread: BTreeMap<SpreadKey, f64>) -> BTreeMap<SpreadKey, f64> {
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
            // Written so that NaN is refused.
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
    /// Which value.
    pub key: GoldenKey,
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
        // As it is typed: a product would leave a last digit of its own.
        format!("{}e{power}", (needed / digit).ceil()).parse().unwrap_or(needed)
    }

    /// What jumps, why, and what can be done.
    pub fn sentence(&self) -> String {
        let Self { key, digit, before, after, most } = self;
        let needed = self.needed();
        let accepted = if needed <= MOST_TOLERANCE {
            format!(
                "allow that much scatter with `[golden]` and `tolerance = {needed:e}` in the study, and \
                 accept again; or leave the verdict to the expectations with `golden = \"none\"`"
            )
        } else {
            "leave the verdict to the expectations: `golden = \"none\"` in the study".to_owned()
        };
        format!(
            "`{key}` changes from {before:.6e} to {after:.6e}, by {:.2e}, when the {} changes ({}), but \
             round-off moves such values by {most:.1e} at most. Solvers that round a number to an integer \
             do this, most often with the number of steps, as in ceil((T − t)/Δt): leave a margin, as in \
             ceil((T − t)/Δt − 1e-6). Or {accepted}",
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
    use crate::golden::measure::key;

    fn error(case: u64, sample: &str) -> GoldenKey {
        key(&format!("MPM cells={case}"), 0.1, &format!("pressure {sample} terzaghi"))
    }

    fn group(case: u64) -> SpreadKey {
        error(case, "points").spread().expect("a spread")
    }

    #[test]
    fn spreads_widen_in_any_order_and_never_narrow() {
        let mut seed = 3_u64;
        let mut dice = |count: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % count
        };
        for _ in 0..300 {
            let mut measured = || -> BTreeMap<SpreadKey, f64> {
                // Spreads that a file may have without values: around zero.
                let groups = (0..dice(4))
                    .map(|_| (group(dice(3)), 10.0_f64.powi(-9 - i32::try_from(dice(8)).expect("small"))));
                groups.collect()
            };
            let (first, second) = (measured(), measured());
            let plain = GoldenFile::of("s", &[], "test");
            let steps = [
                plain.clone(),
                plain.clone().widened_by(first.clone()),
                plain.clone().widened_by(first.clone()).widened_by(second.clone()),
                plain
                    .clone()
                    .widened_by(first.clone())
                    .widened_by(second.clone())
                    .widened_by(BTreeMap::new()),
            ];
            let other_way = plain.widened_by(second.clone()).widened_by(first.clone());
            for case in 0..3 {
                for size in [0.0, 1e-3, 1.0] {
                    let of = |file: &GoldenFile| file.tolerance(&error(case, "points"), size);
                    let all: Vec<f64> = steps.iter().map(of).collect();
                    assert!(all.is_sorted(), "{all:?} narrows: {first:?} {second:?}");
                    assert_eq!(of(&other_way), all[3], "{first:?} {second:?}");
                }
            }
            // Kept in a file and read back it allows the same.
            let folder = tempfile::TempDir::new().expect("a folder");
            other_way.write(folder.path()).expect("written");
            let read = GoldenFile::read(folder.path(), "s").expect("read");
            assert_eq!(
                read.tolerance(&error(0, "points"), 1.0),
                other_way.tolerance(&error(0, "points"), 1.0)
            );
        }
    }

    #[test]
    fn a_tolerance_is_ten_times_the_spread_of_the_group_or_the_floor() {
        let steps = key("MPM cells=4", None, "steps");
        let values = |nodes: f64, points: f64| {
            BTreeMap::from([(error(4, "nodes"), nodes), (error(4, "points"), points), (steps.clone(), nodes)])
        };
        let spread = spread_by_group(&values(1.0, 2.0), [&values(1.0 + 2e-6, 2.0), &values(1.0, f64::NAN)]);
        assert_eq!(spread.len(), 1, "{spread:?}");
        let golden = GoldenFile::of("s", &[], "test").widened_by(spread);
        let allowed = golden.tolerance(&error(4, "points"), 2.0);
        assert!((allowed / 2e-5 - 1.0).abs() < 1e-5, "by the change at the nodes");
        assert_eq!(golden.tolerance(&error(5, "points"), 2.0), ABSOLUTE + 2.0 * RELATIVE);
        assert_eq!(golden.tolerance(&steps, 1e9), 0.5, "steps are exact");
        let wider = golden.clone().widened_by(BTreeMap::from([(group(4), 1e-5)]));
        let allowed = wider.tolerance(&error(4, "points"), 2.0);
        assert!((allowed / 1e-4 - 1.0).abs() < 1e-9, "the largest that was ever seen");
        let by_study = golden.allowing(GoldenRule::Within(1e-3));
        assert_eq!(by_study.tolerance(&error(4, "points"), 2.0), 3e-3);
    }

    fn sound() -> GoldenFile {
        let values = BTreeMap::from([(error(4, "points"), 0.02)]);
        let cases = [("MPM cells=4".into(), String::new())].into();
        GoldenFile { cases, values, ..GoldenFile::of("study", &[], "a reason") }
            .widened_by(BTreeMap::from([(group(4), 1e-8)]))
    }

    fn refusal(change: impl FnOnce(&mut GoldenFile)) -> String {
        let mut file = sound();
        change(&mut file);
        file.out_of_bounds().expect("it is refused")
    }

    #[test]
    fn spreads_that_let_anything_or_nothing_pass_are_refused() {
        assert_eq!((sound().out_of_bounds(), sound().spread.len()), (None, 1));
        // Ten times a hundredth of the largest value is a tenth of it.
        for value in [1e9, 2.1e-4, -1.0, f64::NAN] {
            let told = refusal(|file| {
                file.spread.insert(group(4), value);
            });
            assert!(told.starts_with(&format!("its spread of `{}` is ", group(4))), "{told}");
        }
        let mut file = sound();
        file.spread.insert(group(4), 1.9e-4);
        assert_eq!(file.out_of_bounds(), None);
    }

    #[test]
    fn values_without_a_reason_or_a_number_are_refused_when_read_and_when_written() {
        assert!(refusal(|file| file.reason = "  ".to_owned()).contains("its `reason` is empty"));
        let name = error(4, "points");
        let told = refusal(|file| {
            file.values.insert(name.clone(), f64::NAN);
        });
        assert_eq!(told, format!("its value `{name}` is NaN"));
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = sound().write(folder.path()).expect("written");
        assert_eq!(GoldenFile::read(folder.path(), "study").expect("sound"), sound());
        let wide = GoldenFile { reason: String::new(), ..sound() };
        assert!(matches!(wide.write(folder.path()), Err(GoldenError::Refused { what: "is refused", .. })));
        let text = std::fs::read_to_string(&path).expect("a file");
        let edited = text.replace("0.02", "inf");
        assert_ne!(edited, text);
        std::fs::write(&path, edited).expect("written");
        let error = GoldenFile::read(folder.path(), "study").expect_err("refused");
        assert!(error.to_string().contains("T_v=0.1` is inf"), "{error}");
    }

    #[test]
    fn a_spread_is_the_largest_change_and_its_room_that_of_the_largest_value_wherever_they_stand() {
        let values = |all: [f64; 3]| -> BTreeMap<GoldenKey, f64> {
            ["points", "centres", "nodes"].map(|sample| error(4, sample)).into_iter().zip(all).collect()
        };
        let (mut changes, mut sizes) = ([3e-5, 1e-5, 2e-5], [1.0, 1e-3, 2e-3]);
        for _ in 0..3 {
            let others = changes.map(|change| values([1.0, 1.0 - change, 1.0]));
            let spread = spread_by_group(&values([1.0; 3]), &others);
            assert!((spread[&group(4)] / 3e-5 - 1.0).abs() < 1e-9, "{changes:?}: {spread:?}");
            let spread = spread_by_group(&values([1.0; 3]), [&values(changes.map(|change| 1.0 + change))]);
            assert!((spread[&group(4)] / 3e-5 - 1.0).abs() < 1e-9, "{changes:?}: {spread:?}");
            let spread = BTreeMap::from([(group(4), 9e-3)]);
            let file = GoldenFile { values: values(sizes), ..GoldenFile::of("study", &[], "a reason") };
            assert_eq!(file.widened_by(spread).out_of_bounds(), None, "{sizes:?}");
            changes.rotate_left(1);
            sizes.rotate_left(1);
        }
    }

    #[test]
    fn the_jump_that_is_told_needs_the_widest_tolerance_wherever_it_stands() {
        let samples = ["points", "centres", "nodes"];
        let values = |all: [f64; 3]| -> BTreeMap<GoldenKey, f64> {
            samples.map(|sample| error(4, sample)).into_iter().zip(all).collect()
        };
        let file = GoldenFile { values: values([1.0; 3]), ..GoldenFile::of("study", &[], "a reason") };
        assert_eq!(file.jump(&[(LastDigit::Stiffness, values([1.0 + 1e-9; 3]))]), None);
        for widest in 0..3 {
            let mut all = [1.01, 1.02, 1.03];
            all[widest] = 1.2;
            let digits = [
                (LastDigit::Stiffness, values([1.0; 3])),
                (LastDigit::Conductivity, values(all)),
                (LastDigit::Stiffness, values([1.05; 3])),
            ];
            let jump = file.jump(&digits).expect("far off");
            assert_eq!((&jump.key, jump.digit), (&error(4, samples[widest]), LastDigit::Conductivity));
            // In one digit, with no other behind it.
            assert_eq!(Jump { before: 1.08e-3, after: 1.114e-3, ..jump }.needed(), 7e-5);
        }
    }

    #[test]
    fn a_spread_is_kept_where_it_widens_the_tolerance_of_any_of_its_values() {
        for (sizes, change, is_kept) in [
            ([0.0, 1.0], 0.9e-11, false),
            ([0.0, 1.0], 1.1e-11, true),
            ([1.0, 2.0], 0.9e-7, false),
            ([2.0, 1.0], 1.1e-7, true),
        ] {
            let values = [error(4, "points"), error(4, "nodes")].into_iter().zip(sizes).collect();
            let file = GoldenFile { values, ..GoldenFile::of("s", &[], "test") };
            let file = file.widened_by([(group(4), change), (group(8), 1e-9)].into());
            assert_eq!(file.spread.contains_key(&group(4)), is_kept, "{change:e} at {sizes:?}");
            assert_eq!(file.spread.get(&group(8)), Some(&1e-9), "each for itself");
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
