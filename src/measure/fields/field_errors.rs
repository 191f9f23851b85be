//! Errors of a snapshot's fields and settlement against a reference.

use crate::case::{Case, Norm, Quantity, Sample};
use crate::measure::fields::{FieldDifference, exact_samples};
use crate::measure::other_measures::load_error;
use crate::record::ErrorRow;
use oedometer_exact::{ExactError, Reference, ReferenceKind};
use oedometer_problem::snapshot::{Samples, Snapshot};
use std::cell::LazyCell;

/// Norms of a field's error.
const FIELD_NORMS: [Norm; 3] = [Norm::L1, Norm::L2, Norm::Linf];

/// Time factor by which every column is consolidated to round-off.
pub const LONG_AFTER: f64 = 50.0;

/// Which field of which sample is compared with which reference.
#[derive(Clone, Copy, Debug)]
pub struct FieldError<'a> {
    /// Time factor.
    pub time_factor: f64,
    /// Quantity.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// Name of the reference.
    pub reference: &'a str,
    /// What absolute errors are divided by, in the unit of the field.
    pub scale: f64,
    /// Components of the field, listed one after the other; a mean counts the volume once.
    pub components: usize,
    /// Share of the scale below which the reference cannot tell a field from zero: see [`resolution`].
    pub resolution: f64,
}

/// Exact values below this share of their scale are lost in the round-off of a run, whose pressures
/// and displacements are of the size of the scale: an error relative to them means nothing.
const UNRESOLVED: f64 = 1e4 * f64::EPSILON;

/// Share of its start to which a value must have fallen to have vanished: a method's error of a hundredth is a hundred
/// times as large then.
const VANISHED: f64 = 1e-4;

/// Share of the scale below which a value that has fallen is nothing, whatever its start.
const NOTHING: f64 = 1e-6;

/// Share of the scale above which a value has not vanished, whatever its start.
const PRESENT: f64 = 1e-3;

/// Whether an exact value has vanished against its start or the load, so that an error relative to it means nothing: a
/// wave that has died out, a pressure that has dissipated. A value that is small at the start and grows, as a settlement,
/// has not. All are absolute values in one unit; `at_start` is asked for where the value is small, and not a number where
/// it is not known.
pub fn has_vanished(value: f64, scale: f64, at_start: impl FnOnce() -> f64) -> bool {
    if value > PRESENT * scale.abs() {
        return false;
    }
    let start = at_start();
    value <= VANISHED * start || value <= NOTHING * scale.abs() && value <= 0.5 * start
}

/// Time factor from which on a pressure of the size of the load has been there, whatever the start.
const CONSOLIDATING: f64 = 1.0;

/// The largest value of a quantity at the start, against which it may vanish; `exact` are the fields there. A pressure
/// that waves or a growing load raise from nothing has been as large as the load.
pub fn start_of(quantity: Quantity, exact: Option<&[f64]>, scale: f64, time_factor: f64) -> f64 {
    let at_start = exact.map_or(f64::NAN, largest);
    let is_late = quantity == Quantity::Pressure && time_factor >= CONSOLIDATING;
    if is_late { at_start.max(scale.abs()) } else { at_start }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |most, value| most.max(value.abs()))
}

/// Share of the load, or of the final settlement, below which no error against a reference
/// is defined: its own accuracy at that time, and round-off at least.
pub fn resolution(reference: &Reference, time_factor: f64) -> f64 {
    let accuracy = reference.accuracy(time_factor).map_or(0.0, |accuracy| accuracy.bound());
    accuracy.max(UNRESOLVED)
}

impl FieldError<'_> {
    /// The error in every norm in which it is defined; no row where the exact field is zero, indistinguishable from
    /// zero, or has vanished against its largest value at the start.
    pub fn rows(
        self,
        computed: &[f64],
        exact: &[f64],
        volume: &[f64],
        at_start: impl FnOnce() -> f64,
    ) -> Vec<ErrorRow> {
        let largest = largest(exact);
        let is_lost =
            largest <= self.resolution * self.scale.abs() || has_vanished(largest, self.scale, at_start);
        let difference = FieldDifference::of(computed, exact, volume).filter(|_| !is_lost);
        let row = |norm| {
            let (absolute, relative) = difference.as_ref()?.in_norm(norm);
            Some(ErrorRow {
                time_factor: self.time_factor,
                quantity: self.quantity,
                sample: self.sample,
                norm,
                reference: self.reference.to_owned(),
                value: relative?,
                absolute: absolute? * of_components(norm, self.components) / self.scale,
            })
        };
        FIELD_NORMS.into_iter().filter_map(row).collect()
    }
}

/// Factor from the mean of a norm over all components to the mean over the volume, in which components add up.
fn of_components(norm: Norm, components: usize) -> f64 {
    match norm {
        Norm::L1 => components as f64,
        Norm::L2 => (components as f64).sqrt(),
        Norm::Linf | Norm::Relative => 1.0,
    }
}

/// The signed error of a settlement, m, where it is defined and the exact one is above round-off; its absolute value
/// is over a scale, m.
///
/// # Errors
/// When the reference refuses the time factor.
pub fn settlement_error(
    reference: &Reference,
    time_factor: f64,
    settlement: f64,
    scale: f64,
) -> Result<Option<ErrorRow>, ExactError> {
    let exact = reference.settlement(time_factor)?;
    let at_start = || reference.settlement(0.0).map_or(f64::NAN, f64::abs);
    if exact.abs() <= resolution(reference, time_factor) * scale.abs()
        || has_vanished(exact.abs(), scale, at_start)
    {
        return Ok(None);
    }
    let value = settlement / exact - 1.0;
    Ok(value.is_finite().then(|| ErrorRow {
        time_factor,
        quantity: Quantity::Settlement,
        sample: Sample::Surface,
        norm: Norm::Relative,
        reference: reference.name().to_owned(),
        value,
        absolute: (settlement - exact) / scale,
    }))
}

/// Every error of a snapshot against a reference; no row where a relative error is not defined because the
/// exact field is zero or below round-off.
///
/// # Errors
/// When the reference refuses the time factor.
pub fn snapshot_errors(
    case: &Case,
    reference: &Reference,
    time_factor: f64,
    snapshot: &Snapshot,
) -> Result<Vec<ErrorRow>, ExactError> {
    if reference.kind() == ReferenceKind::Footing {
        return Ok(load_error(case, reference, time_factor, snapshot).into_iter().collect());
    }
    let load = case.column.pressure_scale();
    let final_settlement = reference.displacement_scale()?;
    let resolution = resolution(reference, time_factor);
    let mut rows = Vec::new();
    for (sample, samples) in [
        (Sample::Points, &snapshot.points),
        (Sample::Centres, &snapshot.centres),
        (Sample::Nodes, &snapshot.nodes),
    ] {
        let exact = exact_samples(case, reference, time_factor, samples)?;
        let start = LazyCell::new(|| exact_samples(case, reference, 0.0, samples).ok());
        let displacements = (displacement_components(samples), displacement_components(&exact));
        let directions = if samples.plane.is_some() { 2 } else { 1 };
        let volumes = samples.volume.repeat(directions);
        let (pressure, pressure_volume) = samples.pressures();
        for (quantity, computed, exact, volume, scale) in [
            (Quantity::Pressure, pressure, exact.pressures().0, pressure_volume, load),
            (
                Quantity::EffectiveStress,
                &samples.effective_stress[..],
                &exact.effective_stress[..],
                &samples.volume[..],
                load,
            ),
            (Quantity::Displacement, &displacements.0, &displacements.1, &volumes, final_settlement),
        ] {
            let reference = reference.name();
            let components = if quantity == Quantity::Displacement { directions } else { 1 };
            let field =
                FieldError { time_factor, quantity, sample, reference, scale, components, resolution };
            let at_start = || {
                let exact = start.as_ref().and_then(|start| match quantity {
                    Quantity::Pressure => Some(start.pressures().0),
                    other => other.field(start),
                });
                start_of(quantity, exact, scale, time_factor)
            };
            rows.extend(field.rows(computed, exact, volume, at_start));
        }
    }
    rows.extend(settlement_error(reference, time_factor, snapshot.settlement, final_settlement)?);
    Ok(rows)
}

/// Every component of the displacement in one list: its L2 norm is that of the vectors.
fn displacement_components(samples: &Samples) -> Vec<f64> {
    let mut components = samples.displacement.clone();
    if let Some(plane) = &samples.plane {
        components.extend(&plane.horizontal_displacement);
    }
    components
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_exact::parameters::ColumnParameters;

    fn field(scale: f64, resolution: f64) -> FieldError<'static> {
        let (quantity, sample) = (Quantity::Pressure, Sample::Points);
        FieldError {
            time_factor: 1.0,
            quantity,
            sample,
            reference: "terzaghi",
            scale,
            components: 1,
            resolution,
        }
    }

    #[test]
    fn an_exact_field_below_the_resolution_has_no_relative_error() {
        let rows = |exact: f64, resolution: f64| {
            field(100.0, resolution)
                .rows(&[1e-11, 2e-11], &[exact, 0.5 * exact], &[1.0, 1.0], || f64::NAN)
                .len()
        };
        assert_eq!(rows(1e-50, UNRESOLVED), 0);
        assert_eq!(rows(0.9 * 100.0 * UNRESOLVED, UNRESOLVED), 0);
        assert_eq!(rows(1.1 * 100.0 * UNRESOLVED, UNRESOLVED), FIELD_NORMS.len());
        // A reference that is good to 1e-6 of the load resolves no pressure of 1e-7 of it.
        assert_eq!(rows(1e-5, 1e-6), 0);
        assert_eq!(rows(1e-3, 1e-6), FIELD_NORMS.len());
    }

    #[test]
    fn what_has_vanished_against_its_start_has_no_relative_error_and_what_grows_from_little_has() {
        let unknown = f64::NAN;
        for (value, start, vanished) in [
            (1.0, 100.0, false),
            (0.9e-2, 100.0, true),
            (1.1e-2, 100.0, false),
            (1.1e-2, 200.0, true),
            // A stress that stiff water leaves at the start, and one that has fallen from it.
            (5e-5, 5e-5, false),
            (5e-5, 2e-4, true),
            (5e-5, 0.0, false),
            (5e-5, unknown, false),
            (0.0, unknown, false),
        ] {
            assert_eq!(has_vanished(value, 100.0, || start), vanished, "{value} of {start}");
        }
        assert_eq!(start_of(Quantity::Pressure, Some(&[0.0, 0.0]), 100.0, 5.0), 100.0);
        assert_eq!(start_of(Quantity::Pressure, Some(&[0.0, -3.0]), 100.0, 0.5), 3.0);
        assert_eq!(start_of(Quantity::EffectiveStress, Some(&[-2.0]), 100.0, 5.0), 2.0);
        assert!(start_of(Quantity::Displacement, None, 100.0, 0.5).is_nan());
    }

    #[test]
    fn long_after_the_end_pressures_have_no_error_and_the_settlement_has() {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[50.0]).expect("the seed column");
        assert_eq!(resolution(&reference, 50.0), UNRESOLVED);
        assert!(reference.fields(50.0, 1.0).expect("inside").pressure < 1e-40 * column.load);
        let settled = column.final_settlement();
        let row = settlement_error(&reference, 50.0, 1.01 * settled, settled).expect("a time");
        assert!((row.expect("an error").value - 0.01).abs() < 1e-9);
        // A settlement that round-off could have made has none.
        let nothing = settlement_error(&reference, 50.0, settled, 1e13 * settled).expect("a time");
        assert_eq!(nothing, None);
    }
}
