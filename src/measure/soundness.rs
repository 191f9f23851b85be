//! Requirements on every record, whatever a study expects: a lost point, or a reference no more accurate than the
//! result, invalidates any verdict.

use crate::case::Quantity;
use crate::measure::record_checks;
use crate::record::{ErrorRow, Record, ReferenceUse, Status};
use oedometer_exact::solution::ROUND_OFF;
use oedometer_wording::{rounded, typed};

/// A reference must be more accurate than this share of the smallest error against it.
const TAIL_SHARE: f64 = 0.1;

/// What is wrong with the start and the balances of a record, as sentences.
pub fn complaints_of_run(record: &Record) -> Vec<String> {
    record_checks::complaints(record)
}

/// What is wrong with a record, as sentences; empty where it is sound.
pub fn complaints(record: &Record) -> Vec<String> {
    let mut sentences = complaints_of_run(record);
    sentences.extend(record.references.iter().filter_map(|reference| reference.does_not_hold.clone()));
    if let Some(row) = record.errors.iter().find(|row| !row.value.is_finite()) {
        sentences.push(format!("the error of {} is {}", row.quantity.name(), row.value));
    }
    for reference in &record.references {
        let poor = poor_outputs(record, reference);
        let outputs =
            record.case.time_factors.iter().filter(|time| smallest_at(record, reference, **time).is_some());
        let none_is_left = poor.len() == outputs.count();
        let worst = poor.iter().min_by(|a, b| a.error.total_cmp(&b.error));
        sentences.extend(worst.filter(|_| none_is_left).map(PoorOutput::sentence));
    }
    sentences
}

/// An output at which a reference is not accurate enough to judge by.
#[derive(Clone, Debug, PartialEq)]
pub struct PoorOutput {
    /// Name of the reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// Accuracy of the reference, over the load.
    pub accuracy: f64,
    /// The smallest error of the pressure against it there, over the load.
    pub error: f64,
}

impl PoorOutput {
    /// What is too inaccurate where, and how much better it would have to be.
    pub fn sentence(&self) -> String {
        let Self { reference, time_factor, accuracy, error } = self;
        format!(
            "the reference {reference} is only accurate to {accuracy:.1e}, but the smallest error against \
             it is {error:.1e}, at T_v = {}: it would have to be {} times as accurate",
            typed(*time_factor),
            rounded((10.0 * accuracy / (TAIL_SHARE * error).max(ROUND_OFF)).ceil() / 10.0)
        )
    }
}

/// The smallest error of the pressure against a reference at an output, over the load.
fn smallest_at(record: &Record, reference: &ReferenceUse, time_factor: f64) -> Option<f64> {
    let is_of = |row: &&ErrorRow| {
        let is_pressure = row.quantity == Quantity::Pressure && row.reference == reference.name;
        is_pressure && row.time_factor == time_factor
    };
    record.errors.iter().filter(is_of).map(|row| row.absolute).min_by(f64::total_cmp)
}

/// The outputs at which a reference is not accurate enough: what is measured there is not judged.
fn poor_outputs(record: &Record, reference: &ReferenceUse) -> Vec<PoorOutput> {
    let poor = |time_factor: &f64| {
        let error = smallest_at(record, reference, *time_factor)?;
        let (name, accuracy) = (reference.name.clone(), reference.bound_at(&record.case, *time_factor));
        // No reference is better than its round-off, whatever a result at round-off asks; NaN is not enough.
        let is_enough = accuracy <= (TAIL_SHARE * error).max(ROUND_OFF);
        (!is_enough).then_some(PoorOutput { reference: name, time_factor: *time_factor, accuracy, error })
    };
    record.case.time_factors.iter().filter_map(poor).collect()
}

/// The outputs that are not judged while others are, because a reference is not accurate enough there.
pub fn unjudged_outputs(record: &Record) -> Vec<PoorOutput> {
    let poor = record.references.iter().flat_map(|reference| poor_outputs(record, reference));
    poor.collect()
}

/// Whether an error against a reference is not judged, because the reference is not accurate enough at its output.
pub fn is_unjudged(record: &Record, reference: &str, time_factor: f64) -> bool {
    let used = record.references.iter().find(|used| used.name == reference);
    // What is accurate to round-off serves every result, at no cost.
    let poor = used.filter(|used| used.tail_bound.is_nan() || used.tail_bound > ROUND_OFF);
    poor.is_some_and(|used| poor_outputs(record, used).iter().any(|output| output.time_factor == time_factor))
}

/// Whether the numbers of a record may be quoted: its run ended well, and nothing is said against it.
pub fn is_sound(record: &Record) -> bool {
    record.status == Status::Ok && complaints(record).is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    const STUDY: &str = r#"title = "Sound"
scene = "terzaghi"
output = { time_factors = [0.05, 0.2] }

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [10]
time_step = [{ growth = 0.05 }]
"#;

    fn sound() -> Record {
        records_of(STUDY).remove(0)
    }

    /// What is said of a record that differs from a sound one.
    fn said(change: impl Fn(&mut Record)) -> String {
        let mut record = sound();
        assert_eq!(complaints(&record), Vec::<String>::new());
        change(&mut record);
        complaints(&record).join("; ")
    }

    #[test]
    fn a_reference_must_be_ten_times_better_than_the_least_pressure_error_of_each_output_that_is_judged() {
        let record = sound();
        let own = &record.references[0];
        let at = |time: f64| smallest_at(&record, own, time).expect("a pressure");
        let mut times = [0.05, 0.2];
        times.sort_by(|a, b| at(*a).total_cmp(&at(*b)));
        let with = |bound: f64| {
            let mut record = record.clone();
            record.references[0].tail_bound = bound;
            record
        };
        assert_eq!(unjudged_outputs(&with(0.09 * at(times[0]))), []);
        // The output with the smaller error is left out, and the other is judged.
        let poor = with(0.11 * at(times[0]));
        assert_eq!(complaints(&poor), Vec::<String>::new());
        let told: Vec<String> = unjudged_outputs(&poor).iter().map(PoorOutput::sentence).collect();
        let wanted = format!(
            "the reference terzaghi is only accurate to {:.1e}, but the smallest error against it is \
             {:.1e}, at T_v = {}: it would have to be 1.1 times as accurate",
            0.11 * at(times[0]),
            at(times[0]),
            times[0]
        );
        assert_eq!(told, [wanted.as_str()]);
        assert_eq!(times.map(|time| is_unjudged(&poor, "terzaghi", time)), [true, false]);
        assert!(!is_unjudged(&poor, "terzaghi-incompressible", times[0]));
        // Where no output is left the record is complained of.
        let none = complaints(&with(0.11 * at(times[1]))).join("; ");
        assert!(none.starts_with("the reference terzaghi is only accurate to"), "{none}");
        // An output at which the reference is poor leaves those at which it is not.
        let mut early = with(1.0);
        early.references[0].tail_bounds = vec![1.0, 0.0];
        assert_eq!(complaints(&early), Vec::<String>::new());
        assert_eq!([0.05, 0.2].map(|time| is_unjudged(&early, "terzaghi", time)), [true, false]);
        // Of two references the poor one is named.
        let second = said(|record| record.references[1].tail_bound = 1.0);
        assert!(second.contains("the reference terzaghi-incompressible"), "{second}");
    }

    #[test]
    fn a_reference_at_round_off_serves_results_at_round_off_and_no_worse_one_does() {
        let told = |bound: f64| {
            said(|record| {
                record.references.iter_mut().for_each(|reference| reference.tail_bound = bound);
                record.errors.iter_mut().for_each(|row| row.absolute = 0.0);
            })
        };
        assert_eq!(told(ROUND_OFF), "");
        assert!(told(f64::NAN).contains("is only accurate to NaN"), "{}", told(f64::NAN));
        assert!(told(1.1 * ROUND_OFF).contains("is only accurate to 1.1e-14"), "{}", told(1.1 * ROUND_OFF));
    }

    #[test]
    fn lost_points_drifts_and_gaps_are_told_with_their_bounds() {
        let lost = said(|record| record.start.as_mut().expect("a start").points -= 1);
        assert_eq!(lost, "19 points at the start instead of 20");
        for drift in [2e-9, -2e-9, f64::NAN] {
            let mass = said(|record| record.balance[1].solid_mass_drift = drift);
            assert!(mass.contains("mass of solids, drift is") && mass.contains("at T_v = 0.2"), "{mass}");
            let forces = said(|record| record.balance[0].internal_force_imbalance = drift);
            assert!(
                forces.contains("sum of internal forces") && forces.contains("at T_v = 0.05"),
                "{forces}"
            );
        }
        assert_eq!(said(|record| record.balance[0].solid_mass_drift = 0.9e-9), "");
        let gap = said(|record| record.balance[0].settlement_curve_gap = 2.1e-3);
        assert!(gap.contains("final settlement against settlement curve is 2.10e-3"), "{gap}");
        assert_eq!(said(|record| record.balance[0].settlement_curve_gap = 1.9e-3), "");
        let nonsense = said(|record| record.errors[0].value = f64::NAN);
        assert!(nonsense.contains("is NaN"), "{nonsense}");
    }
}
