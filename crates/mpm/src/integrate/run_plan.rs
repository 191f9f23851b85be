//! Plan of a run: step sizes, bounds, loading time and plate.

use crate::actions::surface_load::LoadedSurface;
use crate::integrate::critical_step::predicted::{GrowingMode, predict_for_run};
use crate::integrate::critical_step::skeleton;
use crate::integrate::physical_bounds::PhysicalBounds;
use crate::integrate::schedule::Schedule;
use crate::kernel::body::{Discrete, DrivenPlate};
use crate::state::points::Points;
use oedometer_problem::integrator::StepBound;
use oedometer_problem::outcome::StepSizes;
use oedometer_problem::time_step::{StepScales, Steps, TimeStep};
use oedometer_problem::wave_speeds;
use oedometer_soil::material::Material;

/// Share of a semi-implicit run's critical step that growing steps end at.
const LARGEST_SHARE: f64 = 0.8;

/// Plan of a run: all that it needs beside its body.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Outputs, step rule and integrator.
    pub schedule: &'a Schedule,
    /// Its steps.
    pub steps: Steps,
    /// A mode that grows too far within the run under any explicit step: steps cannot be shares of a limit then.
    pub growing: Option<GrowingMode>,
    /// One that grows under any explicit step, and stays small within the run as far as it is predicted.
    pub slowly_growing: Option<GrowingMode>,
    /// Step sizes as far as they are known before the run.
    pub sizes: StepSizes,
    /// Material points, of skeleton and water.
    pub points: usize,
    /// Grid nodes, ghosts included.
    pub nodes: usize,
    /// Pressure that the problem is about, Pa.
    pub pressure_scale: f64,
    /// Velocity that the problem is about, m/s.
    pub velocity_scale: f64,
    /// Height of the surface that settlements count from, m.
    pub initial_height: f64,
    /// Bounds of a sound result.
    pub bounds: PhysicalBounds,
    /// Time over which the load grows to its full value, s.
    pub loading_time: f64,
    /// Whether points may leave their cells.
    pub moves_points: bool,
    /// Rigid plate that is pushed into the surface.
    pub driven_plate: Option<DrivenPlate>,
}

impl<'a> Plan<'a> {
    /// The plan of a problem.
    ///
    /// Where the skeleton is explicit the critical step is that of the skeleton's waves. A fully implicit step has no limit: the
    /// formula for the explicit integrator stands in its place, as a scale.
    pub fn new<const D: usize>(problem: &Discrete<D>, schedule: &'a Schedule) -> Self {
        let (cell_size, settings) = (problem.grid.cell_size, &schedule.settings);
        let end = schedule.outputs.last().copied().unwrap_or(0.0);
        let (critical, prediction) = match (schedule.integrator.step_bound(), schedule.critical_step) {
            (StepBound::AllWaves, None) => {
                let prediction = predict_for_run(problem, settings);
                (prediction.critical_step, Some(prediction))
            }
            (StepBound::AllWaves, Some(known)) => (known, None),
            (StepBound::SkeletonWaves, _) if problem.points.began_as_full_lattice() => {
                let are_undamped = D > 1 || problem.method.has_projection();
                let limit = |soil: &Material| wave_speeds::semi_implicit_limit(soil, cell_size, are_undamped);
                (problem.least_of_soils(limit), None)
            }
            (StepBound::SkeletonWaves, _) => (skeleton::semi_implicit_limit(problem), None),
            (StepBound::Accuracy, _) => {
                let limit = |soil: &Material| wave_speeds::combined_limit(soil, cell_size, settings.drag);
                (problem.least_of_soils(limit), None)
            }
        };
        let scales = StepScales {
            critical,
            cell_size,
            wave_speed: problem.most_of_soils(|soil| wave_speeds::fastest_wave_speed(soil, soil.porosity)),
            consolidation: problem.most_of_soils(Material::coefficient_of_consolidation),
        };
        let target = schedule.time_step.first(&scales);
        let prediction = prediction.filter(|_| matches!(schedule.time_step, TimeStep::Stable(_)));
        let grows_far = |mode: &GrowingMode| !mode.stays_small_for(end);
        let mode = prediction.as_ref().and_then(|prediction| prediction.growing);
        let growing = mode.filter(grows_far);
        let growth =
            prediction.filter(|_| growing.is_none()).and_then(|found| found.growth_over(end, target));
        let sizes = StepSizes { predicted_critical: critical, target, growth, ..StepSizes::default() };
        // Steps that grow must not outgrow what an explicit skeleton can stand.
        let most = match schedule.integrator.step_bound() {
            StepBound::SkeletonWaves => LARGEST_SHARE * sizes.predicted_critical,
            StepBound::AllWaves | StepBound::Accuracy => f64::INFINITY,
        };
        Self {
            steps: schedule.time_step.steps(&scales, &schedule.outputs, most),
            growing,
            slowly_growing: mode.filter(|_| growing.is_none()),
            sizes,
            points: problem.points.len() + problem.water.as_ref().map_or(0, Points::len),
            nodes: problem.grid.node_count(),
            pressure_scale: problem.pressure_scale,
            velocity_scale: velocity_scale(problem),
            initial_height: LoadedSurface::new(&problem.points, problem.load)
                .shaped(problem.load_shape, &problem.points)
                .height(&problem.points),
            bounds: PhysicalBounds::new(problem),
            loading_time: problem.loading_time,
            moves_points: problem.configuration.moves_points(),
            driven_plate: problem.driven_plate,
            schedule,
        }
    }
}

/// Velocity, m/s, of an undrained wave or of Darcy's flow through one cell under the problem's
/// pressure, the larger: what a sound run does not leave a thousandfold.
fn velocity_scale<const D: usize>(problem: &Discrete<D>) -> f64 {
    problem.most_of_soils(|soil| {
        let wave = wave_speeds::undrained_wave_speed(soil);
        let density = soil.mixture_density();
        let flow = soil.hydraulic_conductivity / soil.unit_weight_of_water() / problem.grid.cell_size;
        problem.pressure_scale * (1.0 / (density * wave)).max(flow / soil.porosity)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::schedule::Kernel;
    use crate::tests::column_problem;
    use crate::time_limit::TimeLimit;
    use oedometer_problem::formulation::Formulation;
    use oedometer_problem::integrator::IntegratorKind;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::ExplicitSettings;
    use oedometer_scenes::LAYERED;
    use oedometer_scenes::column::Column;
    use oedometer_soil::layers::{SoilLayer, SoilLayers};

    #[test]
    fn courant_steps_of_layers_are_those_of_the_fastest_layer() {
        let soil = Material { water_bulk_modulus: 1e5, ..Material::default() };
        let method = Method::named("GIMP").expect("known");
        let layer = |youngs_modulus: f64| SoilLayer {
            thickness: 0.5,
            youngs_modulus: Some(youngs_modulus),
            ..SoilLayer::default()
        };
        let speed_of = |layer: SoilLayer| {
            let soil = layer.soil(&soil);
            wave_speeds::fastest_wave_speed(&soil, soil.porosity)
        };
        let (soft, stiff) = (layer(1e6), layer(4e9));
        for layers in [[soft, stiff], [stiff, soft]] {
            let column = Column { soils: SoilLayers::from_slice(&layers).expect("two"), ..Column::default() };
            let problem = column_problem::<1>(&LAYERED, &column, &soil, method, 4, 2).expect("a column");
            let schedule = Schedule {
                outputs: vec![1.0],
                history: Vec::new(),
                notes_energy: false,
                time_step: TimeStep::Courant(0.5),
                settings: ExplicitSettings::default(),
                kernel: Kernel::Fastest,
                integrator: IntegratorKind::Explicit,
                critical_step: Some(1.0),
                formulation: Formulation::VW,
                threads: 1,
                time_limit: TimeLimit::default(),
            };
            let step = Plan::new(&problem, &schedule).sizes.target;
            assert!((step * speed_of(stiff) / (0.5 * 0.25) - 1.0).abs() < 1e-12, "{step:e}");
        }
        assert!(
            speed_of(stiff) > 1.5 * speed_of(soft).max(wave_speeds::fastest_wave_speed(&soil, soil.porosity))
        );
    }
}
