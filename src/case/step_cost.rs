//! What a step costs, by kind of step: the constants from which times are estimated before anything runs.
//!
//! They are nanoseconds of processor time on one of two virtual cores of an AMD EPYC at 3.3 GHz, both of them at work, fitted
//! there to the cases of the shipped studies.

use crate::case::Case;
use oedometer_mpm::method::{Configuration, Memory, Method, StrainGradient};
use oedometer_mpm::run::integrator::{Formulation, IntegratorKind};

/// Kinds of steps that differ in what they cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepKind {
    /// Explicit, as one sparse map: nothing moves.
    Assembled,
    /// Explicit, point by point: operators follow the points.
    PointWise,
    /// Implicit with one linear system.
    Linear,
    /// Implicit with inertia where nothing moves: the first iteration meets the solution.
    Inertial,
    /// Implicit, by Newton's iteration.
    Newton,
}

/// Cost of a step: `fixed + points · (point + front · width)`, ns, with the width in cells of the narrower
/// side: fronts of a plane's elimination grow with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepCost {
    /// Whatever the size.
    pub fixed: f64,
    /// Per point.
    pub point: f64,
    /// Per point and width.
    pub front: f64,
}

/// Time of a case beside its steps, s: set-up, exact solutions, the record.
pub const CASE_SECONDS: f64 = 1e-3;
/// A point-wise step of a column with a fit over patches or a composite gradient, over one without. In Newton's steps
/// what it costs is won by fewer iterations.
const FIT_FACTOR: f64 = 1.2;
/// Factor for a step of a plane with such a fit.
const PLANE_FIT_FACTOR: f64 = 1.3;
/// Factor for cell averages.
const MEMORY_FACTOR: f64 = 1.8;
/// Factor for a scene whose body forces and sources are evaluated at every point.
const FORCED_FACTOR: f64 = 2.0;

impl StepKind {
    /// The kind of step that a case takes.
    pub fn of(case: &Case) -> Self {
        let frozen = case.configuration() == Configuration::Frozen;
        match case.integrator {
            IntegratorKind::Explicit if frozen && !case.column.points.has_two_sets() => Self::Assembled,
            IntegratorKind::Explicit => Self::PointWise,
            _ if frozen && case.formulation == Formulation::QuasiStatic => Self::Linear,
            _ if frozen => Self::Inertial,
            IntegratorKind::SemiImplicit | IntegratorKind::Implicit => Self::Newton,
        }
    }

    /// Its cost in one or two dimensions.
    pub fn cost(self, dimensions: usize) -> StepCost {
        let [fixed, point, front] = match (self, dimensions) {
            (Self::Assembled, 1) => [80.0, 3.8, 0.0],
            (Self::Assembled, _) => [700.0, 45.0, 0.0],
            (Self::PointWise, 1) => [1000.0, 55.0, 0.0],
            (Self::PointWise, _) => [2500.0, 140.0, 0.0],
            (Self::Linear, 1) => [1000.0, 50.0, 0.0],
            (Self::Linear, _) => [1000.0, 230.0, 13.0],
            (Self::Inertial, 1) => [1500.0, 250.0, 0.0],
            (Self::Inertial, _) => [3000.0, 300.0, 13.0],
            (Self::Newton, 1) => [12_000.0, 550.0, 0.0],
            (Self::Newton, _) => [20_000.0, 1700.0, 80.0],
        };
        StepCost { fixed, point, front }
    }
}

/// Time of one step of a case on one core, s.
pub fn seconds_per_step(case: &Case) -> f64 {
    let kind = StepKind::of(case);
    let cost = kind.cost(case.column.dimensions);
    let points = case.expected_points() as f64;
    let width =
        case.column.cells_across(case.cells).unwrap_or(1).min(case.column.cells_up(case.cells)) as f64;
    let method = case.method.own().unwrap_or(Method::STANDARD);
    let follows = matches!(kind, StepKind::PointWise | StepKind::Newton);
    let fits = method.uses_patch() || method.strain != StrainGradient::Standard;
    let mut factor = 1.0;
    if kind == StepKind::PointWise && fits {
        factor *= if case.column.dimensions == 1 { FIT_FACTOR } else { PLANE_FIT_FACTOR };
    }
    if follows && method.memory == Memory::Cells {
        factor *= MEMORY_FACTOR;
    }
    if case.scene.is_manufactured() {
        factor *= FORCED_FACTOR;
    }
    1e-9 * factor * (cost.fixed + points * (cost.point + cost.front * width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_mpm::method::Method;
    use oedometer_mpm::scene::SceneKind;

    fn case(scene: SceneKind, method: &str, integrator: IntegratorKind, cells: usize) -> Case {
        let method = Method::named(method).expect("a method").into();
        let formulation = integrator.default_formulation();
        Case { method, integrator, formulation, cells, ..Case::seed(Task::Solve, scene) }
    }

    #[test]
    fn the_kind_of_step_follows_what_moves_and_who_integrates() {
        use IntegratorKind::{Explicit, Implicit, SemiImplicit};
        let kind = |scene, method, integrator| StepKind::of(&case(scene, method, integrator, 10));
        assert_eq!(kind(SceneKind::Terzaghi, "MPM", Explicit), StepKind::Assembled);
        assert_eq!(kind(SceneKind::XieLeo, "MPM", Explicit), StepKind::PointWise);
        assert_eq!(kind(SceneKind::Terzaghi, "MPM", Implicit), StepKind::Linear);
        assert_eq!(kind(SceneKind::XieLeo, "MPM", Implicit), StepKind::Newton);
        assert_eq!(kind(SceneKind::Terzaghi, "MPM", SemiImplicit), StepKind::Inertial);
    }

    #[test]
    fn a_step_costs_more_with_points_with_width_and_with_fits() {
        let column = |method, cells| {
            seconds_per_step(&case(SceneKind::XieLeo, method, IntegratorKind::Explicit, cells))
        };
        assert!(column("MPM", 1000) > 5.0 * column("MPM", 100));
        assert!((column("GIMP-SRI-patch", 10) / column("MPM", 10) - FIT_FACTOR).abs() < 1e-12);
        let layer =
            |cells| seconds_per_step(&case(SceneKind::CosineLayer, "MPM", IntegratorKind::Implicit, cells));
        // Four times the points and twice the width.
        assert!(layer(80) > 6.0 * layer(40), "{} for {}", layer(80), layer(40));
    }
}
