//! The errors that the race judges a run by: the largest over its outputs, of pressure, effective stress and settlement.

use crate::case::{Quantity, Sample};
use crate::record::{Record, Status};

/// Errors of a run that are judged: of pressure, effective stress, and settlement, displacement or load.
pub const ERRORS: usize = 3;
/// An error that shows the physics and no more.
pub const ROUGH: f64 = 1e-1;
/// The finishing line.
pub const ARRIVED: f64 = 1e-2;
/// An error below this is as good as any smaller one: refinement ends.
pub const NEGLIGIBLE: f64 = 1e-3;

/// The largest errors over the outputs, `None` where something is not measured.
pub type RunErrors = [Option<f64>; ERRORS];

/// Largest errors over the outputs, of pressure and effective stress at the points and of the settlement; of a plane, of
/// the displacement at the nodes; of a footing, of its load. None where the run failed.
pub fn errors_of(record: &Record) -> RunErrors {
    let Some(reference) = record.references.first().filter(|_| record.status == Status::Ok) else {
        return [None; ERRORS];
    };
    let largest_of = |quantity: Quantity, sample| {
        let errors = record.case.time_factors.iter().filter_map(|time| {
            let row = record.error(quantity, sample, quantity.first_norm(), &reference.name, *time)?;
            Some(row.value.abs())
        });
        // What is no number is the largest.
        errors.max_by(f64::total_cmp)
    };
    [
        largest_of(Quantity::Pressure, Sample::Points),
        largest_of(Quantity::EffectiveStress, Sample::Points),
        largest_of(Quantity::Settlement, Sample::Surface)
            .or_else(|| largest_of(Quantity::Displacement, Sample::Nodes))
            .or_else(|| largest_of(Quantity::LoadFactor, Sample::Surface)),
    ]
}

/// The largest error of a run; `None` if it failed or an error is not a number.
pub fn largest_error(record: &Record) -> Option<f64> {
    errors_of(record).into_iter().flatten().max_by(f64::total_cmp).filter(|error| error.is_finite())
}
