//! What may put a floor under the errors along a path of runs: the causes that its cases name.

use crate::case::Case;
use crate::case::quantity::Quantity;
use crate::judge::paths::Path;
use crate::measure::fields::exact_fields::exact_samples;
use crate::measure::fields::norms::relative_error;
use crate::measure::known_references::known_reference;
use crate::record::Record;
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_convergence::limiter::{Limiter, LimiterKind};
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::run::TimeStepRule;

impl Path<'_> {
    /// Everything that might limit an error along the path, but for its reference's accuracy.
    pub(crate) fn limiters(&self, measure: &Measure) -> Vec<Limiter> {
        let finest = self.records[self.records.len() - 1];
        model_limiter(finest, measure)
            .into_iter()
            .chain(self.mesh_limiter(measure))
            .chain(self.held_limiters(measure))
            .collect()
    }

    /// What a series over meshes holds while the mesh falls: a step rule that does not follow the mesh,
    /// and the points per cell where they move through it. How high a floor they make nobody knows
    /// without varying them.
    fn held_limiters(&self, measure: &Measure) -> Vec<Limiter> {
        if self.axis != Axis::Cells || measure.reference == NEXT_FINER {
            return Vec::new();
        }
        let case = &self.records[0].case;
        if case.is_attached() {
            // What it holds while the mesh falls is its own business.
            return Vec::new();
        }
        let points =
            case.method.configuration_or(case.scene.configuration()).moves_points().then(|| Limiter {
                kind: LimiterKind::PointsPerCell,
                name: "the points per cell".to_owned(),
                magnitude: None,
                order: None,
            });
        step_limiter(case).into_iter().chain(points).collect()
    }

    /// Along any other axis than its own the mesh is what is left of the error.
    fn mesh_limiter(&self, measure: &Measure) -> Option<Limiter> {
        (self.axis != Axis::Cells && measure.reference != NEXT_FINER).then(|| Limiter {
            kind: LimiterKind::Mesh,
            name: "the mesh".to_owned(),
            magnitude: None,
            order: Some(2.0),
        })
    }
}

/// The floor that the error in time puts under errors on ever finer meshes, where the step does not fall
/// with the cells.
fn step_limiter(case: &Case) -> Option<Limiter> {
    let of_steps = case.integrator.order_in_time(&case.settings);
    let (name, order) = match case.time_step {
        TimeStepRule::Stable(_) | TimeStepRule::Courant(_) => return None,
        TimeStepRule::Seconds(_) => ("the time step", Some(of_steps)),
        TimeStepRule::Growth(_) => ("`growth`", Some(of_steps)),
        TimeStepRule::Tolerance(_) => ("`tolerance`", None),
    };
    Some(Limiter { kind: LimiterKind::Step, name: name.to_owned(), magnitude: None, order })
}

/// The floor that a reference of other equations puts under an error: its own distance from the
/// scene's reference, in the same norm and at the same places.
fn model_limiter(finest: &Record, measure: &Measure) -> Option<Limiter> {
    let case = &finest.case;
    let kind: ReferenceKind = measure.reference.parse().ok()?;
    let difference = case.scene.model_difference(kind, &case.material)?;
    let of = |kind: ReferenceKind| known_reference(case, kind, &[measure.time_factor]).ok();
    let (own, other) = (of(case.scene.references()[0].of_soil(&case.material))?, of(kind)?);
    let magnitude = if measure.quantity == Quantity::Settlement {
        let settlement = |reference: &Reference| reference.settlement(measure.time_factor).ok();
        (settlement(&own)? / settlement(&other)? - 1.0).abs()
    } else {
        let snapshot = finest.snapshot(measure.time_factor)?;
        let samples = measure.sample.of(snapshot).unwrap_or(&snapshot.nodes);
        let exact = |reference| exact_samples(case, reference, measure.time_factor, samples).ok();
        let (own, other) = (exact(&own)?, exact(&other)?);
        let field = |samples| measure.quantity.field(samples);
        relative_error(measure.norm, field(&own)?, field(&other)?, &samples.volume)?
    };
    Some(Limiter {
        kind: LimiterKind::Model,
        name: difference.to_owned(),
        magnitude: Some(magnitude),
        order: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::norm::Norm;
    use crate::case::quantity::Sample;
    use crate::judge::paths::{first_norm, paths};
    use oedometer_convergence::class::{Class, Classification};
    use oedometer_mpm::run::integrator::IntegratorKind;

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
        let norm: Norm = first_norm(quantity);
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
        for rule in [TimeStepRule::Stable(0.8), TimeStepRule::Courant(0.5)] {
            assert_eq!(step_limiter(&Case { time_step: rule, ..case.clone() }), None);
        }
    }
}
