//! What is known along a path of runs beside the errors: formal order, possible causes of a floor, signs, mobility,
//! oscillation, and values without a reference.

use crate::case::{Case, Norm, Quantity, Sample};
use crate::judge::paths::{Path, level_size};
use crate::judge::verdict::Beside;
use crate::measure::fields::{PlaneField, exact_samples, half_a_digit, relative_error, reversal};
use crate::measure::other_measures::load_factor;
use crate::measure::round_off::{ITERATIONS, ROUND_OFF, SINGLE_PRECISION};
use crate::measure::theory::known_reference;
use crate::record::Record;
use crate::study::expectation::{Axis, Measure, NEXT_FINER, NO_REFERENCE};
use oedometer_convergence::{Context, Limiter, LimiterKind, SeriesDemand, ValueSeries};
use oedometer_exact::{Reference, ReferenceKind};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::column_parameters;

/// Order of the values where neither the method nor the study promises one.
const USUAL_ORDER: f64 = 2.0;

impl Path<'_> {
    /// What is known besides the errors: formal order, accuracy of the reference, and the model's
    /// difference where the reference does not solve the scene's own equations.
    pub(crate) fn context(&self, measure: &Measure) -> Context {
        let case = &self.records[0].case;
        let finest = self.records[self.records.len() - 1];
        let used = finest.references.iter().find(|used| used.name == measure.reference);
        Context {
            formal_order: (self.axis == Axis::Cells).then(|| formal_order(case, measure)).flatten(),
            round_off: Some(self.round_off(measure)),
            tolerance: Some(if case.has_integrator() { ITERATIONS } else { SINGLE_PRECISION }),
            reference_accuracy: used.map(|used| used.bound_at(&finest.case, measure.time_factor)),
            limiters: self.limiters(measure),
            mobility: self.mobility(measure),
            signed: self.signed(measure),
        }
    }

    /// Errors up to this are round-off: of a linear system, whose condition grows with the cells (measured in a sealed
    /// element: 2e-13 times their number to the power of 1.5), and of the digits that stand in a file.
    fn round_off(&self, measure: &Measure) -> f64 {
        let of_system =
            |record: &&Record| ROUND_OFF * (record.case.cells as f64).sqrt() * record.case.cells as f64;
        let of_digits = |record: &&Record| {
            let snapshot = record.snapshot(measure.time_factor)?;
            let samples = measure.sample.samples(snapshot).unwrap_or(&snapshot.nodes);
            Some(2.0 * half_a_digit(measure.quantity.field(samples)?))
        };
        let read = self.records.iter().filter(|record| record.outside_run().is_some());
        let digits = read.filter_map(of_digits);
        // An explicit step solves no system.
        let solved = self.records.iter().filter(|record| !record.case.is_explicit());
        solved.map(of_system).chain(digits).fold(ROUND_OFF, f64::max)
    }

    /// Signed errors of single numbers, a settlement or a value without a reference; empty for norms of fields.
    fn signed(&self, measure: &Measure) -> Vec<f64> {
        if measure.norm != Norm::Relative && measure.reference != NO_REFERENCE {
            return Vec::new();
        }
        self.signed_levels(measure).into_iter().filter_map(|level| level.1).collect()
    }

    /// Settlement over the exact one at each level, for the errors of displacements: it is near zero for a locked body.
    fn mobility(&self, measure: &Measure) -> Vec<f64> {
        if !matches!(measure.quantity, Quantity::Displacement | Quantity::Settlement) {
            return Vec::new();
        }
        let (quantity, sample, norm) = (Quantity::Settlement, Sample::Surface, Norm::Relative);
        let settlement = Measure { quantity, sample, norm, ..measure.clone() };
        self.records.iter().filter_map(|record| Some(1.0 + settlement.error(record)?.value)).collect()
    }

    /// Everything that might limit an error along the path, but for its reference's accuracy.
    pub(crate) fn limiters(&self, measure: &Measure) -> Vec<Limiter> {
        let finest = self.records[self.records.len() - 1];
        model_limiter(finest, measure)
            .into_iter()
            .chain(strain_limiter(finest, measure))
            .chain(self.mesh_limiter(measure))
            .chain(self.held_limiters(measure))
            .collect()
    }

    /// What a series over meshes keeps while the mesh is refined: a step rule that does not follow the mesh,
    /// and the points per cell where points move through it. How high a floor they cause is not known
    /// without varying them.
    fn held_limiters(&self, measure: &Measure) -> Vec<Limiter> {
        let case = &self.records[0].case;
        // What another program keeps while the mesh is refined is not known here.
        if self.axis != Axis::Cells || measure.reference == NEXT_FINER || !case.has_integrator() {
            return Vec::new();
        }
        let moves = case.configuration().moves_points();
        let points = moves.then(|| Limiter::new(LimiterKind::PointsPerCell, "the points per cell"));
        let step = step_limiter(case).filter(|_| !self.has_no_floor_of_step(measure));
        step.into_iter().chain(points).collect()
    }

    /// Whether a smaller step on the finest mesh leaves the error as it is.
    fn has_no_floor_of_step(&self, measure: &Measure) -> bool {
        let finest = self.records[self.records.len() - 1];
        let error = |record: &Record| measure.error(record).map(|row| row.value.abs());
        let both = error(finest).zip(self.smaller_step.and_then(error));
        both.is_some_and(|(finest, smaller)| (finest - smaller).abs() <= UNMOVED * finest)
    }

    /// Along any other axis the mesh limits the error.
    fn mesh_limiter(&self, measure: &Measure) -> Option<Limiter> {
        (self.axis != Axis::Cells && measure.reference != NEXT_FINER)
            .then(|| Limiter { order: Some(2.0), ..Limiter::new(LimiterKind::Mesh, "the mesh") })
    }

    /// Everything that a demand asks besides the errors.
    pub(crate) fn beside(
        &self,
        demand: &SeriesDemand,
        measure: &Measure,
        formal_order: Option<f64>,
    ) -> Beside {
        let order = formal_order.or(demand.order.map(|band| band.value)).unwrap_or(USUAL_ORDER);
        Beside {
            oscillation: demand.oscillation_below.and_then(|_| self.oscillation(demand, measure)),
            uncertainty: demand.uncertainty_below.map(|_| self.values(measure).uncertainty(order)),
        }
    }

    /// The values of a quantity without a reference, over its scale: a settlement over
    /// the final one of small strain, a pressure at a place over the load.
    pub(crate) fn values(&self, measure: &Measure) -> ValueSeries {
        let level = |record: &Record| (level_size(record, self.axis), value_of(record, measure));
        ValueSeries::new(self.asked(measure).into_iter().map(level).collect())
    }

    /// Spurious oscillation of the profile at the level that a demand names, else at the finest.
    fn oscillation(&self, demand: &SeriesDemand, measure: &Measure) -> Option<f64> {
        oscillation_of(self.bounded_level(demand), measure)
    }
}

/// Spurious oscillation of the profile of a run.
///
/// In a column, the variation beyond the net changes that the exact profile has too, over those; in
/// a plane, the variation along all rows and columns of points over that of the exact field, less one.
pub(crate) fn oscillation_of(record: &Record, measure: &Measure) -> Option<f64> {
    if record.case.scene.body.is_plane() {
        let is_measured = (measure.quantity, measure.sample) == (Quantity::Pressure, Sample::Points);
        let field = PlaneField::of(record, measure.time_factor).ok()?;
        return field.filter(|_| is_measured).map(|field| field.oscillation_index());
    }
    let case = &record.case;
    let samples = measure.sample.samples(record.snapshot(measure.time_factor)?)?;
    let kind = measure.reference.parse::<ReferenceKind>().ok()?.for_soil(&case.material);
    let reference = known_reference(case, kind, &[measure.time_factor]).ok()?;
    let exact = exact_samples(case, &reference, measure.time_factor, samples).ok()?;
    reversal(measure.quantity.field(samples)?, measure.quantity.field(&exact)?)
}

/// Order in the cell size that a method's operators promise at small strain, where they promise
/// one: constant fields in a cell are of first order at points and of second at the centres.
fn formal_order(case: &Case, measure: &Measure) -> Option<f64> {
    let method = case.method.built_in()?;
    let by_points = |second: bool| if second { 2.0 } else { 1.0 };
    match (measure.quantity, measure.sample) {
        (Quantity::Pressure, Sample::Points) => {
            Some(by_points(method.uses_patch() || method.has_nodal_pressure()))
        }
        (Quantity::EffectiveStress, Sample::Points) => Some(by_points(method.strain.is_composite())),
        (Quantity::Pressure | Quantity::EffectiveStress, Sample::Centres)
        | (Quantity::Settlement, _)
        | (Quantity::Displacement, Sample::Nodes) => Some(2.0),
        _ => None,
    }
}

/// The floor that the error in time puts under errors on ever finer meshes, where the step does not fall
/// with the cells.
fn step_limiter(case: &Case) -> Option<Limiter> {
    let of_steps = case.integrator.order_in_time(&case.settings);
    let (name, order) = match case.time_step {
        TimeStep::Stable(_) | TimeStep::Courant(_) => return None,
        TimeStep::Seconds(_) => ("the time step", Some(of_steps)),
        TimeStep::Growth(_) => ("`growth`", Some(of_steps)),
        TimeStep::Tolerance(_) => ("`tolerance`", None),
    };
    Some(Limiter { order, ..Limiter::new(LimiterKind::Step, name) })
}

/// Change of an error, relative, by which a smaller step has not moved it.
const UNMOVED: f64 = 0.1;

/// The floor that finite strain puts under errors against a theory of small strain. Settlements of linear soil that is
/// measured on its present length differ by about half of `m_vl q`.
fn strain_limiter(finest: &Record, measure: &Measure) -> Option<Limiter> {
    let case = &finest.case;
    let is_theory = measure.reference != NEXT_FINER && measure.reference != NO_REFERENCE;
    let is_finite = !case.scene.is_large_strain() && case.configuration().deforms() && case.has_integrator();
    let magnitude = Some(0.5 * finest.groups.finite_strain).filter(|_| is_theory && is_finite)?;
    let name = "finite strain against a theory of small strain";
    Some(Limiter { magnitude: Some(magnitude), ..Limiter::new(LimiterKind::Model, name) })
}

/// The floor that a reference of other equations puts under an error: its own distance from the
/// scene's reference, in the same norm and at the same places.
fn model_limiter(finest: &Record, measure: &Measure) -> Option<Limiter> {
    let case = &finest.case;
    let kind: ReferenceKind = measure.reference.parse().ok()?;
    let difference = case.scene.model_difference(kind, &case.material)?;
    let of = |kind: ReferenceKind| known_reference(case, kind, &[measure.time_factor]).ok();
    let (own, other) = (of(case.scene.references[0].kind.for_soil(&case.material))?, of(kind)?);
    let magnitude = if measure.quantity == Quantity::Settlement {
        let settlement = |reference: &Reference| reference.settlement(measure.time_factor).ok();
        Some((settlement(&own)? / settlement(&other)? - 1.0).abs()).filter(|ratio| ratio.is_finite())?
    } else {
        let snapshot = finest.snapshot(measure.time_factor)?;
        let samples = measure.sample.samples(snapshot).unwrap_or(&snapshot.nodes);
        let exact = |reference| exact_samples(case, reference, measure.time_factor, samples).ok();
        let (own, other) = (exact(&own)?, exact(&other)?);
        let field = |samples| measure.quantity.field(samples);
        relative_error(measure.norm, field(&own)?, field(&other)?, &samples.volume)?
    };
    Some(Limiter { magnitude: Some(magnitude), ..Limiter::new(LimiterKind::Model, difference) })
}

/// The value of a run: its settlement, or a field between the two cell centres about the probe.
fn value_of(record: &Record, measure: &Measure) -> Option<f64> {
    let case = &record.case;
    let snapshot = record.snapshot(measure.time_factor)?;
    let final_settlement = column_parameters(&case.column, &case.material).final_settlement();
    let scale = match measure.quantity {
        Quantity::Settlement => return Some(snapshot.settlement / final_settlement),
        Quantity::LoadFactor => return load_factor(case, snapshot.plate_force?),
        Quantity::Pressure | Quantity::EffectiveStress => case.column.pressure_scale(),
        Quantity::Displacement => final_settlement,
    };
    let height = (1.0 - measure.probe?) * case.column.height;
    let field = measure.quantity.field(&snapshot.centres)?;
    Some(between(&snapshot.centres.initial_height, field, height)? / scale)
}

/// A field interpolated at a height, with heights in rising order; `None` beyond the ends.
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
    use crate::campaign::runner::records_of;
    use crate::case::SolverName;
    use crate::case::quantity::Norm;
    use crate::case::quantity::Sample;
    use crate::judge::paths::{first_measure, paths};
    use oedometer_convergence::{Class, Classification, ErrorBound, OrderBand};
    use oedometer_problem::integrator::IntegratorKind;

    fn records(rule: &str, cells: &str) -> Vec<Record> {
        let text = format!(
            "title = \"Causes\"\nscene = \"terzaghi\"\noutput = {{ time_factors = [0.05, 0.2] }}\n[[sweep]]\n\
             method = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = {cells}\ntime_step = [{rule}]\n"
        );
        records_of(&text)
    }

    fn class_of(records: &[Record], quantity: Quantity, reference: &str, time_factor: f64) -> Classification {
        let all = paths(records, Axis::Cells);
        let sample = if quantity == Quantity::Settlement { Sample::Surface } else { Sample::Points };
        let norm: Norm = quantity.first_norm();
        let reference = reference.to_owned();
        let measure = Measure { quantity, sample, norm, reference, time_factor, probe: None };
        all[0].summary(&measure).classification
    }

    #[test]
    fn a_floor_of_the_step_rule_names_the_rule() {
        let runs = records("{ tolerance = 1e-3 }", "[5, 10, 20, 40, 80, 160]");
        let found = class_of(&runs, Quantity::Pressure, "terzaghi", 0.2);
        assert_eq!(found.class, Class::FloorLimited, "{found:?}");
        assert_eq!(found.floor.expect("a floor").limiter, Some(LimiterKind::Step));
        assert!(found.advice.expect("advice").starts_with("lower `tolerance` by"), "{}", found.reason);
        // Where the model's difference is of the floor's height, it is the cause.
        let model = class_of(&runs, Quantity::Pressure, "terzaghi-incompressible", 0.2);
        assert_eq!(model.floor.expect("a floor").limiter, Some(LimiterKind::Model), "{}", model.reason);
    }

    #[test]
    fn a_settlement_that_passes_through_zero_goes_to_the_difference_of_the_models() {
        let runs = records("{ growth = 0.002 }", "[10, 20, 40, 80]");
        let found = class_of(&runs, Quantity::Settlement, "terzaghi-incompressible", 0.05);
        assert_eq!(found.class, Class::FloorLimited, "{found:?}");
        let floor = found.floor.expect("a floor");
        assert_eq!(floor.limiter, Some(LimiterKind::Model));
        // Settlements without the water's storage differ by 4.0e-4 at T_v = 0.05.
        assert!((floor.value / 4.0e-4 - 1.0).abs() < 0.05, "{floor:?}");
        let three = class_of(&runs[..3], Quantity::Settlement, "terzaghi-incompressible", 0.05);
        assert_ne!(three.class, Class::FloorLimited, "{three:?}");
    }

    #[test]
    fn steps_that_fall_with_the_cells_are_no_cause_and_held_ones_are() {
        let named = |rule: &str| {
            let runs = records(rule, "[4, 8]");
            step_limiter(&runs[0].case).map(|limiter| (limiter.name, limiter.order))
        };
        assert_eq!(named("{ growth = 0.02 }"), Some(("`growth`".to_owned(), Some(2.0))));
        assert_eq!(named("{ seconds = 0.1 }"), Some(("the time step".to_owned(), Some(2.0))));
        assert_eq!(named("{ tolerance = 1e-3 }"), Some(("`tolerance`".to_owned(), None)));
        let mut case = records("{ growth = 0.02 }", "[4, 8]").remove(0).case;
        case.integrator = IntegratorKind::SemiImplicit;
        assert_eq!(step_limiter(&case).and_then(|limiter| limiter.order), Some(1.0));
        for rule in [TimeStep::Stable(0.8), TimeStep::Courant(0.5)] {
            assert_eq!(step_limiter(&Case { time_step: rule, ..case.clone() }), None);
        }
    }

    /// Small strain and Xie & Leo's column settle by `x` and `1 − exp(−x)` of the height, `x` the load over the modulus.
    #[test]
    fn a_finite_strain_makes_the_floor_by_which_the_theories_differ() {
        let mut runs = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[column]\nload = 3.6e4\n[[sweep]]\n\
             method = ['VP', 'MPM']\nintegrator = ['implicit']\ncells = [4]\n",
        );
        let method = runs[0].case.method.built_in().expect("a method of this program");
        let configuration = Some(oedometer_problem::method::Configuration::Updated);
        runs[0].case.method = SolverName::Own(oedometer_problem::method::Method { configuration, ..method });
        let measure = first_measure(Quantity::Settlement, Sample::Surface, "terzaghi-incompressible", 0.2);
        let strain: f64 = 3.6e4 / 1.2e6;
        let difference = 1.0 + (-strain).exp_m1() / strain;
        for (run, deforms) in runs.iter().zip([true, false]) {
            let of = |reference: &str| {
                let measure = Measure { reference: reference.to_owned(), ..measure.clone() };
                strain_limiter(run, &measure).map(|limiter| limiter.magnitude.expect("it is known"))
            };
            let [theory, finer, none] = ["terzaghi-incompressible", NEXT_FINER, NO_REFERENCE].map(of);
            assert_eq!((theory.is_some(), finer, none), (deforms, None, None), "{}", run.case.label());
            let near = theory.is_none_or(|floor| (floor / difference - 1.0).abs() < strain);
            assert!(near, "{theory:?} for {difference}");
        }
    }

    #[test]
    fn a_probe_lies_between_centres_and_never_beyond_them() {
        let (heights, field) = ([0.25, 0.75], [1.0, 3.0]);
        assert_eq!(between(&heights, &field, 0.375), Some(1.5));
        assert_eq!(between(&heights, &field, 0.25), Some(1.0));
        assert_eq!(between(&heights, &field, 0.75), Some(3.0));
        assert_eq!(between(&heights, &field, 0.2), None);
        assert_eq!(between(&heights, &field, 0.8), None);
        assert_eq!(between(&heights, &[], 0.5), None);
    }

    #[test]
    fn the_formal_order_follows_the_operator_of_each_field() {
        let mut case = records("{ growth = 0.02 }", "[4, 8]").remove(0).case;
        let mut orders = |method: &str| {
            let method = oedometer_problem::method::Method::named(method).expect("a known method");
            case.method = crate::case::solver::SolverName::Own(method);
            [
                (Quantity::Pressure, Sample::Points),
                (Quantity::EffectiveStress, Sample::Points),
                (Quantity::Pressure, Sample::Centres),
                (Quantity::Displacement, Sample::Nodes),
            ]
            .map(|(quantity, sample)| {
                let reference = "terzaghi".to_owned();
                let measure =
                    Measure { quantity, sample, norm: Norm::L2, reference, time_factor: 0.2, probe: None };
                formal_order(&case, &measure).unwrap_or(0.0)
            })
        };
        assert_eq!(orders("GIMP-SRI"), [1.0, 1.0, 2.0, 2.0]);
        assert_eq!(orders("GIMP-SRI-patch"), [2.0, 1.0, 2.0, 2.0]);
        assert_eq!(orders("GC-SRI-patch"), [2.0, 2.0, 2.0, 2.0]);
        assert_eq!(orders("VP"), [2.0, 1.0, 2.0, 2.0]);
    }

    #[test]
    fn an_oscillation_is_that_of_the_level_that_is_named_and_else_of_the_finest() {
        let mut runs = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
             integrator = ['implicit']\ncells = [4, 8, 16]\npoints_per_cell = [2, 3, 4]\n",
        );
        // A saw of another height in each run.
        for (number, run) in runs.iter_mut().enumerate() {
            let height = 0.01 * (number + 1) as f64 * run.case.column.pressure_scale();
            for (point, pressure) in run.snapshots[0].points.pressure.iter_mut().enumerate() {
                *pressure += if point.is_multiple_of(2) { height } else { -height };
            }
        }
        let measure = first_measure(Quantity::Pressure, Sample::Points, "terzaghi", 0.2);
        for axis in [Axis::Cells, Axis::PointsPerCell] {
            let all = paths(&runs, axis);
            assert_eq!(all.len(), 3, "{axis:?}");
            for path in &all {
                let found = |size: Option<f64>| {
                    let at = size.map(|size| ErrorBound { size, below: 1.0, above: 0.0 });
                    let demand = SeriesDemand { at, oscillation_below: Some(1.0), ..SeriesDemand::default() };
                    path.beside(&demand, &measure, None).oscillation
                };
                let own: Vec<Option<f64>> =
                    path.records.iter().map(|record| oscillation_of(record, &measure)).collect();
                assert!(own[0].is_some() && own[0] != own[1] && own[1] != own[2], "{axis:?}: {own:?}");
                for (record, own) in path.records.iter().zip(&own) {
                    assert_eq!(found(Some(level_size(record, axis))), *own, "{axis:?}");
                }
                assert_eq!(found(None), own[2], "{axis:?}");
                let nothing = path.beside(&SeriesDemand::default(), &measure, None);
                assert!(nothing.oscillation.is_none() && nothing.uncertainty.is_none());
            }
        }
    }

    #[test]
    fn an_uncertainty_is_by_the_order_of_the_method_or_else_that_of_the_study() {
        let mut runs = records("{ growth = 0.1 }", "[4, 8, 16]");
        for (run, settlement) in runs.iter_mut().zip([1.0, 1.25, 1.28]) {
            run.snapshots.iter_mut().for_each(|snapshot| snapshot.settlement = settlement);
        }
        let measure = first_measure(Quantity::Settlement, Sample::Surface, NO_REFERENCE, 0.2);
        let path = &paths(&runs, Axis::Cells)[0];
        let by = |order: f64| format!("{:?}", path.values(&measure).uncertainty(order));
        assert!(by(1.0) != by(2.0) && by(2.0) != by(1.5) && by(1.0) != by(1.5), "{}", by(1.0));
        for (formal, promised, order) in [
            (Some(1.0), Some(1.5), 1.0),
            (Some(1.5), None, 1.5),
            (None, Some(1.5), 1.5),
            (None, Some(1.0), 1.0),
            (None, None, USUAL_ORDER),
        ] {
            let order_band = promised.map(|value| OrderBand { value, minus: 0.1, plus: 0.1 });
            let demand =
                SeriesDemand { order: order_band, uncertainty_below: Some(1.0), ..SeriesDemand::default() };
            let found = path.beside(&demand, &measure, formal).uncertainty.expect("it is asked for");
            assert_eq!(format!("{found:?}"), by(order), "{formal:?} {promised:?}");
        }
    }

    #[test]
    fn a_value_is_that_at_its_depth_over_the_scale_of_its_quantity() {
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\ncolumn.height = 2.0\noutput.time_factors = [0.2]\n[[sweep]]\n\
             method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [4]\n",
        )
        .remove(0);
        let (load, soil) = (record.case.column.load, &record.case.material);
        let nu = soil.poissons_ratio;
        let oedometric = soil.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let settlement = load * 2.0 / oedometric;
        let snapshot = &mut record.snapshots[0];
        snapshot.settlement = 0.75 * settlement;
        // Once, twice and three times the share of the height.
        let shares: Vec<f64> = snapshot.centres.initial_height.iter().map(|y| y / 2.0).collect();
        assert_eq!(shares, [0.125, 0.375, 0.625, 0.875]);
        let field = |scale: f64| shares.iter().map(|share| scale * share).collect();
        snapshot.centres.pressure = field(load);
        snapshot.centres.effective_stress = field(2.0 * load);
        snapshot.centres.displacement = field(3.0 * settlement);
        let value = |quantity: Quantity, zeta: Option<f64>| {
            let measure = first_measure(quantity, Sample::Centres, NO_REFERENCE, 0.2);
            value_of(&record, &Measure { probe: zeta, ..measure })
        };
        let fields = [Quantity::Pressure, Quantity::EffectiveStress, Quantity::Displacement];
        for (zeta, share) in [
            (0.2, Some(0.8)),
            (0.8, Some(0.2)),
            (0.5, Some(0.5)),
            (0.125, Some(0.875)),
            (0.875, Some(0.125)),
            (0.1, None),
            (0.9, None),
        ] {
            for (quantity, times) in fields.into_iter().zip([1.0, 2.0, 3.0]) {
                let found = value(quantity, Some(zeta));
                let is_near = match (found, share) {
                    (Some(found), Some(share)) => (found / (times * share) - 1.0).abs() < 1e-12,
                    (found, share) => found.is_none() && share.is_none(),
                };
                assert!(is_near, "{quantity:?} at {zeta}: {found:?}");
            }
        }
        assert!(fields.iter().all(|quantity| value(*quantity, None).is_none()), "a field needs a place");
        let settled = value(Quantity::Settlement, None).expect("a settlement");
        assert!((settled - 0.75).abs() < 1e-12, "{settled}");
    }

    #[test]
    fn what_may_limit_an_error_depends_on_the_axis_the_reference_and_what_moves() {
        let study = |scene: &str, sweep: &str| {
            records_of(&format!(
                "title = 't'\nscene = '{scene}'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP-SRI']\n\
                 integrator = ['implicit']\ntime_step = [{{ growth = 0.5 }}]\n{sweep}\n"
            ))
        };
        let own = |scene: &str| if scene == "terzaghi" { "terzaghi" } else { "large-strain" };
        let meshes = "cells = [2, 4]";
        let points = "cells = [2]\npoints_per_cell = [2, 4]";
        let step = ("`growth`", LimiterKind::Step, Some(2.0));
        let mesh = ("the mesh", LimiterKind::Mesh, Some(2.0));
        let of_points = ("the points per cell", LimiterKind::PointsPerCell, None);
        for (scene, sweep, axis, reference, wanted) in [
            ("terzaghi", meshes, Axis::Cells, own("terzaghi"), vec![step]),
            ("terzaghi", meshes, Axis::Cells, NEXT_FINER, vec![]),
            ("terzaghi", meshes, Axis::Cells, NO_REFERENCE, vec![step]),
            ("xie-leo", meshes, Axis::Cells, own("xie-leo"), vec![step, of_points]),
            ("terzaghi", points, Axis::PointsPerCell, own("terzaghi"), vec![mesh]),
            ("terzaghi", points, Axis::PointsPerCell, NEXT_FINER, vec![]),
            (
                "terzaghi",
                meshes,
                Axis::Cells,
                "terzaghi-incompressible",
                vec![("the water's storage", LimiterKind::Model, None), step],
            ),
        ] {
            let mut runs = study(scene, sweep);
            let measure = first_measure(Quantity::Settlement, Sample::Surface, reference, 0.1);
            let found = paths(&runs, axis)[0].limiters(&measure);
            let told: Vec<_> = found.iter().map(|one| (one.name.as_str(), one.kind, one.order)).collect();
            assert_eq!(told, wanted, "{scene} {axis:?} {reference}");
            let known: Vec<bool> = found.iter().map(|one| one.magnitude.is_some()).collect();
            assert_eq!(known, wanted.iter().map(|one| one.1 == LimiterKind::Model).collect::<Vec<_>>());
            // Of another program neither steps nor points are known.
            for run in &mut runs {
                let digest = "0123456789abcdef";
                run.case.method =
                    crate::case::Attached::new("ogs", digest).map(SolverName::Attached).expect("plain");
            }
            let kinds: Vec<_> = paths(&runs, axis)[0].limiters(&measure).iter().map(|one| one.kind).collect();
            assert!(
                kinds.iter().all(|kind| matches!(kind, LimiterKind::Mesh | LimiterKind::Model)),
                "{kinds:?}"
            );
        }
        // What is known beside the errors: signs of single numbers, and how far a body moves.
        let mut runs = study("terzaghi", meshes);
        for (run, value) in runs.iter_mut().zip([-0.25, 0.125]) {
            run.errors.iter_mut().for_each(|row| (row.value, row.absolute) = (value, 100.0));
            run.references[0].tail_bound = value.abs();
        }
        let path = &paths(&runs, Axis::Cells)[0];
        let of = |quantity: Quantity, sample: Sample| {
            path.context(&first_measure(quantity, sample, "terzaghi", 0.1))
        };
        let settlement = of(Quantity::Settlement, Sample::Surface);
        assert_eq!((settlement.signed, settlement.mobility), (vec![-0.25, 0.125], vec![0.75, 1.125]));
        assert_eq!((settlement.formal_order, settlement.round_off), (Some(2.0), Some(8e-12)));
        assert_eq!(settlement.reference_accuracy, Some(0.125), "that of the finest");
        let displacement = of(Quantity::Displacement, Sample::Points);
        assert_eq!((displacement.signed, displacement.mobility), (vec![], vec![0.75, 1.125]));
        let pressure = of(Quantity::Pressure, Sample::Points);
        assert_eq!((pressure.signed, pressure.mobility, displacement.formal_order), (vec![], vec![], None));
    }
}
