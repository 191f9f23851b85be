//! How much work a case will be, before it runs, and what a step costs by its kind.
//!
//! The constants are nanoseconds of processor time on one of two virtual cores of an AMD EPYC at 3.3 GHz, both of them at
//! work, fitted there to the cases of the shipped studies.

use crate::{Case, Task};
use oedometer_problem::critical_step::OBSERVED_STEPS;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::{Configuration, Memory, Method, StrainGradient};
use oedometer_problem::time_step::TimeStep;
use oedometer_problem::wave_speeds;
use oedometer_scenes::column::column_parameters;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;

/// Steps after which a run at a share of the critical step has shown that it is clean.
pub const MOST_PROBE_STEPS: u64 = 262_144;

/// Runs of a search for the critical step that hold to their end, as a rule: it begins between the runs beside it.
const HELD_RUNS: f64 = 4.0;

/// Work of a case: the time that it will take on one core, ns.
pub fn estimated_work(case: &Case) -> u64 {
    work_of_seconds(estimated_seconds(case))
}

/// Work that takes so many seconds on one core, ns.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, it is an estimate")]
pub fn work_of_seconds(seconds: f64) -> u64 {
    (1e9 * seconds).max(1.0) as u64
}

/// Time in which a result that lies there is read and judged, s.
pub const READING_SECONDS: f64 = 4e-3;

/// Time assumed for a case whose work is not counted, s: it cannot be estimated.
const UNKNOWN_SECONDS: f64 = 5.0;

/// Time that a case will take on one core of the machine that [`seconds_per_step`] was measured on, s.
pub fn estimated_seconds(case: &Case) -> f64 {
    if !case.has_integrator() {
        return UNKNOWN_SECONDS;
    }
    CASE_SECONDS + estimated_steps(case) * seconds_per_step(case)
}

/// Point updates that a case will take, by formula and before any operator is built.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, it is an estimate")]
pub fn estimated_updates(case: &Case) -> u64 {
    (estimated_steps(case) * case.expected_points() as f64).max(1.0) as u64
}

/// Steps that a case will take, by formula.
pub fn estimated_steps(case: &Case) -> f64 {
    let parameters = column_parameters(&case.column, &case.material);
    let end = parameters.time(case.time_factors.last().copied().unwrap_or(0.0));
    let cell_size = case.cell_size();
    // Every layer may be the one that sets the limit.
    let least_of_soils = |limit: &dyn Fn(&Material) -> f64| {
        case.soils().iter().map(|(_, soil)| limit(soil)).fold(f64::INFINITY, f64::min)
    };
    let critical = if case.integrator == IntegratorKind::SemiImplicit {
        let are_undamped = case.has_undamped_motions();
        least_of_soils(&|soil| wave_speeds::semi_implicit_limit(soil, cell_size, are_undamped))
    } else {
        1.5 * least_of_soils(&|soil| wave_speeds::combined_limit(soil, cell_size, case.settings.drag))
    };
    let step = match case.time_step {
        // The mean of steps that vary.
        TimeStep::Tolerance(tolerance) => end * tolerance.sqrt() / 20.0,
        TimeStep::Growth(growth) => {
            let first = parameters.time(elementary::powi(case.cells as f64, -2));
            growth * end / (2.0 + elementary::ln((end / first).max(1.0)))
        }
        rule => rule.first(&case.step_scales(critical)),
    };
    match case.task {
        // The undrained start alone: no steps, and rules relative to the time give none.
        Task::Solve if end == 0.0 => 0.0,
        Task::Solve => end / step,
        Task::Stability => {
            // Runs bracket the limit, of a fixed length unless the body deforms; that below it ends with the scene, or before,
            // and that above soon.
            let observed = OBSERVED_STEPS as f64;
            let whole = (end / step).clamp(observed, MOST_PROBE_STEPS as f64);
            HELD_RUNS * if case.configuration().deforms() { whole } else { observed } + whole
        }
    }
}

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
/// Factor of a point-wise step that assembles and factors the projection of its pressure anew.
const PROJECTION_FACTOR: f64 = 4.5;
/// Factors of a linear step whose soil yields, by dimensions: it takes iterations, most of them with a new tangent.
const YIELDING_FACTORS: [f64; 2] = [7.0, 25.0];
/// Factor for a scene whose body forces and sources are evaluated at every point.
const FORCED_FACTOR: f64 = 2.0;

impl StepKind {
    /// The kind of step that a case takes.
    pub fn for_case(case: &Case) -> Self {
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
    let kind = StepKind::for_case(case);
    let cost = kind.cost(case.column.dimensions);
    let points = case.expected_points() as f64;
    let width =
        case.column.cells_across(case.cells).unwrap_or(1).min(case.column.cells_up(case.cells)) as f64;
    let method = case.method.built_in().unwrap_or(Method::STANDARD);
    let follows = matches!(kind, StepKind::PointWise | StepKind::Newton);
    let fits = method.uses_patch() || method.strain != StrainGradient::Standard;
    let mut factor = 1.0;
    if kind == StepKind::PointWise && fits {
        factor *= if case.column.dimensions == 1 { FIT_FACTOR } else { PLANE_FIT_FACTOR };
    }
    if kind == StepKind::PointWise && method.has_projection() {
        factor *= PROJECTION_FACTOR;
    }
    if follows && method.memory == Memory::Cells {
        factor *= MEMORY_FACTOR;
    }
    if case.scene.motion.is_some() {
        factor *= FORCED_FACTOR;
    }
    if kind == StepKind::Linear && case.soils().iter().any(|(_, soil)| soil.law.has_history()) {
        factor *= YIELDING_FACTORS[case.column.dimensions - 1];
    }
    1e-9 * factor * (cost.fixed + points * (cost.point + cost.front * width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Task;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, Scene, TERZAGHI, XIE_LEO};

    fn case(scene: &'static Scene, method: &str, integrator: IntegratorKind, cells: usize) -> Case {
        let method = Method::named(method).expect("a method").into();
        let formulation = integrator.default_formulation();
        Case { method, integrator, formulation, cells, ..Case::seed(Task::Solve, scene) }
    }

    #[test]
    fn the_kind_of_step_follows_the_motion_and_the_integrator() {
        use IntegratorKind::{Explicit, Implicit, SemiImplicit};
        let kind = |scene, method, integrator| StepKind::for_case(&case(scene, method, integrator, 10));
        assert_eq!(kind(&TERZAGHI, "MPM", Explicit), StepKind::Assembled);
        assert_eq!(kind(&XIE_LEO, "MPM", Explicit), StepKind::PointWise);
        assert_eq!(kind(&TERZAGHI, "MPM", Implicit), StepKind::Linear);
        assert_eq!(kind(&XIE_LEO, "MPM", Implicit), StepKind::Newton);
        assert_eq!(kind(&TERZAGHI, "MPM", SemiImplicit), StepKind::Inertial);
    }

    #[test]
    fn a_step_costs_more_with_points_width_and_fits() {
        let column =
            |method, cells| seconds_per_step(&case(&XIE_LEO, method, IntegratorKind::Explicit, cells));
        assert!(column("MPM", 1000) > 5.0 * column("MPM", 100));
        assert!((column("GIMP-SRI-patch", 10) / column("MPM", 10) - FIT_FACTOR).abs() < 1e-12);
        assert!((column("PPP", 10) / column("VP", 10) - PROJECTION_FACTOR).abs() < 1e-12);
        let layer = |cells| seconds_per_step(&case(&COSINE_LAYER, "MPM", IntegratorKind::Implicit, cells));
        // Four times the points and twice the width.
        assert!(layer(80) > 6.0 * layer(40), "{} for {}", layer(80), layer(40));
        // A layer that lies costs what it does when it stands: a front is as wide as the shorter side.
        let layer_seconds = |height: f64, extent: f64, cells| {
            let mut case = case(&COSINE_LAYER, "MPM", IntegratorKind::Implicit, cells);
            let column = Column { height, ..*case.column }.with_extent(extent);
            *case.column = column;
            seconds_per_step(&case)
        };
        let (lying, standing) = (layer_seconds(1.0, 4.0, 4), layer_seconds(4.0, 1.0, 16));
        assert!(
            (lying / standing - 1.0).abs() < 1e-12 && lying < layer_seconds(2.0, 2.0, 8),
            "{lying} {standing}"
        );
    }
}
