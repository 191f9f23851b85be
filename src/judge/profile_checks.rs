//! What expectations ask of a path of runs beside its errors: how much its finest profile oscillates,
//! and how far a value without an exact one may be off.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::{Path, level_size};
use crate::judge::verdict::Beside;
use crate::measure::fields::exact_fields::exact_samples;
use crate::measure::fields::oscillation::reversal;
use crate::measure::fields::plane_field::PlaneField;
use crate::measure::known_references::known_reference;
use crate::record::Record;
use crate::study::expectation::Measure;
use oedometer_convergence::series_demand::SeriesDemand as Demand;
use oedometer_convergence::uncertainty::ValueSeries;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::column::column_parameters;

/// Order of the values where neither the method nor the study promises one.
const USUAL_ORDER: f64 = 2.0;

impl Path<'_> {
    /// Everything that a demand asks beside the errors.
    pub(crate) fn beside(&self, demand: &Demand, measure: &Measure, formal_order: Option<f64>) -> Beside {
        let order = formal_order.or(demand.order.map(|band| band.value)).unwrap_or(USUAL_ORDER);
        Beside {
            oscillation: demand.oscillation_below.and_then(|_| self.oscillation(demand, measure)),
            uncertainty: demand.uncertainty_below.map(|_| self.values(measure).uncertainty(order)),
        }
    }

    /// The values of a quantity that is held against no reference, over its scale: a settlement over
    /// the final one of small strain, a pressure at a place over the load.
    pub(crate) fn values(&self, measure: &Measure) -> ValueSeries {
        let asked =
            self.records.iter().filter(|record| record.case.time_factors.contains(&measure.time_factor));
        ValueSeries::new(
            asked.map(|record| (level_size(record, self.axis), value_of(record, measure))).collect(),
        )
    }

    /// Spurious oscillation of the profile at the level that a demand names, else at the finest.
    ///
    /// In a column, the variation beyond the net changes that the exact profile has too, over those; in
    /// a plane, the variation along all rows and columns of points over that of the exact field, less one.
    fn oscillation(&self, demand: &Demand, measure: &Measure) -> Option<f64> {
        let named = |record: &&&Record| {
            let size = level_size(record, self.axis);
            demand.at.is_some_and(|at| (size - at.size).abs() <= 1e-9 * at.size)
        };
        let record = self.records.iter().find(named).or(self.records.last())?;
        if record.case.scene.has_plane_fields() {
            let is_measured = (measure.quantity, measure.sample) == (Quantity::Pressure, Sample::Points);
            let field = PlaneField::of(record, measure.time_factor).ok()?;
            return field.filter(|_| is_measured).map(|field| field.oscillation_index());
        }
        let case = &record.case;
        let samples = measure.sample.of(record.snapshot(measure.time_factor)?)?;
        let kind = measure.reference.parse::<ReferenceKind>().ok()?.of_soil(&case.material);
        let reference = known_reference(case, kind, &[measure.time_factor]).ok()?;
        let exact = exact_samples(case, &reference, measure.time_factor, samples).ok()?;
        reversal(measure.quantity.field(samples)?, measure.quantity.field(&exact)?)
    }
}

/// The value of a run: its settlement, or a field between the two cell centres about the probe.
fn value_of(record: &Record, measure: &Measure) -> Option<f64> {
    let case = &record.case;
    let snapshot = record.snapshot(measure.time_factor)?;
    let final_settlement = column_parameters(&case.column, &case.material).final_settlement();
    let scale = match measure.quantity {
        Quantity::Settlement => return Some(snapshot.settlement / final_settlement),
        Quantity::Pressure | Quantity::EffectiveStress => case.column.load,
        Quantity::Displacement => final_settlement,
    };
    let height = (1.0 - measure.probe?) * case.column.height;
    let field = measure.quantity.field(&snapshot.centres)?;
    Some(between(&snapshot.centres.initial_height, field, height)? / scale)
}

/// A field at a height between two of its own, which ascend; none beyond the ends.
fn between(heights: &[f64], field: &[f64], height: f64) -> Option<f64> {
    let upper = heights.iter().position(|one| *one >= height)?;
    if heights[upper] == height {
        return field.get(upper).copied();
    }
    let lower = upper.checked_sub(1)?;
    let share = (height - heights[lower]) / (heights[upper] - heights[lower]);
    Some(field.get(lower)? + share * (field.get(upper)? - field.get(lower)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_probe_lies_between_centres_and_never_beyond_them() {
        let (heights, field) = ([0.25, 0.75], [1.0, 3.0]);
        assert_eq!(between(&heights, &field, 0.5), Some(2.0));
        assert_eq!(between(&heights, &field, 0.25), Some(1.0));
        assert_eq!(between(&heights, &field, 0.75), Some(3.0));
        assert_eq!(between(&heights, &field, 0.2), None);
        assert_eq!(between(&heights, &field, 0.8), None);
        assert_eq!(between(&heights, &[], 0.5), None);
    }
}
