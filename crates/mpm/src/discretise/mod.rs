//! From a problem to the body that is stepped: grid, points at their places and in their state, supports. One `match` turns the
//! number of dimensions into a type.

pub mod moment_fitting;
mod placing;

use crate::actions::forcing::Forcing;
use crate::actions::surface_load::LoadShape;
use crate::discretise::moment_fitting::fit_volumes;
use crate::discretise::placing::place_points;
use crate::integrate::critical_step::predicted::{predict_for_run, whole_growth};
use crate::kernel::body::{Discrete, DrivenPlate};
use crate::run::observed::{Stopped, critical_step};
use crate::run::{Observer, Schedule, run};
use crate::state::grid::Grid;
use crate::state::nodes::{PlateOnTop, Support};
use crate::state::points::Points;
use oedometer_problem::critical_step::CriticalStep;
use oedometer_problem::method::Quadrature;
use oedometer_problem::outcome::Outcome;
use oedometer_problem::problem::{Faces, Load, MakeForcing, Problem, Start, StartError, Weight};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_soil::law::History;
use oedometer_soil::tensor::Tensor;
use std::any::Any;
use std::sync::Arc;

/// Cells above the column, so that a surface that rises stays on the grid.
const HEADROOM: usize = 1;

/// A discretised problem of one or of two dimensions.
#[derive(Clone, Debug)]
pub enum Discretised {
    /// A column.
    Column(Discrete<1>),
    /// Plane strain.
    Plane(Discrete<2>),
}

impl Discretised {
    /// The problem in its dimensions, as [`discretise`] makes it.
    ///
    /// # Errors
    /// When its start has no state at the height of a point.
    pub fn new(problem: &Problem) -> Result<Self, StartError> {
        if problem.dimensions == 1 {
            discretise(problem).map(Self::Column)
        } else {
            discretise(problem).map(Self::Plane)
        }
    }

    /// Predicts and observes its critical step, with runs beside it up to `end` seconds or
    /// `most_steps` steps.
    ///
    /// # Errors
    /// [`Stopped`] where the observer ends it.
    pub fn critical_step(
        &self,
        settings: &ExplicitSettings,
        end: f64,
        most_steps: u64,
        observer: Observer<'_>,
    ) -> Result<CriticalStep, Stopped> {
        match self {
            Self::Column(problem) => critical_step(problem, settings, end, most_steps, observer),
            Self::Plane(problem) => critical_step(problem, settings, end, most_steps, observer),
        }
    }

    /// The predicted critical step of the problem, s: that of the formula where no limit is known.
    pub fn predicted_critical_step(&self, settings: &ExplicitSettings) -> f64 {
        match self {
            Self::Column(problem) => predict_for_run(problem, settings).critical_step,
            Self::Plane(problem) => predict_for_run(problem, settings).critical_step,
        }
    }

    /// The predicted critical step of the problem, s, where a limit is known.
    pub fn known_critical_step(&self, settings: &ExplicitSettings) -> Option<f64> {
        match self {
            Self::Column(problem) => predict_for_run(problem, settings).known_step(),
            Self::Plane(problem) => predict_for_run(problem, settings).known_step(),
        }
    }

    /// Growth per step of the fastest mode in a plane under explicit steps of a size, s, where its step is small enough
    /// for eigenvalues.
    pub fn growth_under(&self, settings: &ExplicitSettings, step: f64) -> Option<f64> {
        match self {
            Self::Column(problem) => whole_growth(problem, settings, step),
            Self::Plane(problem) => whole_growth(problem, settings, step),
        }
    }

    /// Solves it.
    pub fn run(self, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
        match self {
            Self::Column(problem) => run(problem, schedule, observer),
            Self::Plane(problem) => run(problem, schedule, observer),
        }
    }
}

impl From<Discrete<1>> for Discretised {
    fn from(problem: Discrete<1>) -> Self {
        Self::Column(problem)
    }
}

impl From<Discrete<2>> for Discretised {
    fn from(problem: Discrete<2>) -> Self {
        Self::Plane(problem)
    }
}

/// Grid, points and supports of a problem.
///
/// # Errors
/// When its start has no state at the height of a point.
pub fn discretise<const D: usize>(problem: &Problem) -> Result<Discrete<D>, StartError> {
    let Problem { cell_size, points_per_cell, material: soil, method, .. } = problem;
    let mut extent = [problem.cells[0]; D];
    extent[D - 1] = problem.cells[1];
    let points = point_set::<D>(problem, extent, *points_per_cell)?;
    let of_water = problem.points.water_per_cell;
    let water =
        problem.points.has_two_sets().then_some(if of_water == 0 { *points_per_cell } else { of_water });
    let water = water.map(|per_cell| point_set::<D>(problem, extent, per_cell)).transpose()?;
    let forcing = problem.forcing.as_ref().and_then(|make| forcing_on(make, &points));
    let top = extent[D - 1] as f64 * cell_size;
    if forcing.is_none() {
        extent[D - 1] += HEADROOM;
    }
    let mut initial_gradient = [[0.0; D]; D];
    if let Start::OverDepth { gradient, .. } = &problem.start {
        initial_gradient[D - 1][D - 1] = *gradient;
    }
    let (load, load_shape) = match problem.load {
        Load::Uniform(pressure) => (pressure, LoadShape::Uniform),
        Load::Cosine { amplitude, length } => (amplitude, LoadShape::Cosine { length }),
        Load::None | Load::Plate(_) | Load::Push { .. } => (0.0, LoadShape::Uniform),
    };
    let driven_plate = match problem.load {
        Load::Push { velocity, has_water, .. } => Some(DrivenPlate { velocity, has_water }),
        _ => None,
    };
    Ok(Discrete {
        grid: Grid::new(*cell_size, extent),
        support: support(problem, top),
        balanced_weight: balanced_weight(problem, &points),
        points,
        water,
        material: *soil,
        soils: match &problem.layers[..] {
            [] => vec![*soil],
            layers => layers.iter().map(|layer| layer.soil(soil)).collect(),
        },
        method: *method,
        configuration: method.configuration_in(problem.strain.configuration()),
        load,
        load_shape,
        driven_plate,
        plate_load: if let Load::Plate(pressure) = problem.load { Some(pressure) } else { None },
        weight: problem.weight.as_ref().map(|weight| weight.gravity),
        undrained_start: matches!(problem.start, Start::Undrained),
        loading_time: problem.loading_time,
        initial_gradient,
        pressure_scale: problem.pressure_scale,
        forcing,
        // A plate of prescribed motion presses as hard as it has to.
        is_bounded: driven_plate.is_none(),
    })
}

/// Points at the start, so many in each cell.
fn point_set<const D: usize>(
    problem: &Problem,
    extent: [usize; D],
    per_cell: usize,
) -> Result<Points<D>, StartError> {
    let soil = &problem.material;
    let mut points = place_points(&problem.points, problem.cell_size, extent, per_cell);
    if problem.method.quadrature == Quadrature::Moments {
        fit_volumes(&mut points, problem.cell_size, extent, problem.height);
    }
    if soil.law.has_history() {
        // Stresses are counted from the initial one.
        let yield_stress = soil.preconsolidation - problem.initial_stress;
        points.history = vec![History { yield_stress, ..History::default() }; points.len()];
    }
    for point in 0..points.len() {
        let layer = problem.layers.number_at(points.initial_position[point][D - 1]);
        points.soil[point] = u8::try_from(layer).unwrap_or(u8::MAX);
    }
    if let Start::OverDepth { fields, .. } = &problem.start {
        for point in 0..points.len() {
            let fields = fields(1.0 - points.initial_position[point][D - 1] / problem.height)?;
            points.pressure[point] = fields.pressure;
            for d in 0..D {
                points.effective_stress[point][d][d] =
                    if d + 1 == D { fields.vertical_stress } else { fields.lateral_stress };
            }
            points.solid_velocity[point][D - 1] = fields.solid_velocity;
            points.water_velocity[point][D - 1] = fields.water_velocity;
        }
        if let Some(weight) = &problem.weight {
            add_stress_of_weight(&mut points, problem, weight);
        }
    }
    Ok(points)
}

/// Gives points the stress of the soil's own weight, that to the sides as an oedometer at rest has it.
fn add_stress_of_weight<const D: usize>(points: &mut Points<D>, problem: &Problem, weight: &Weight) {
    let lateral = problem.material.poissons_ratio / (1.0 - problem.material.poissons_ratio);
    for point in 0..points.len() {
        let depth = 1.0 - points.initial_position[point][D - 1] / problem.height;
        let vertical = (weight.stress)(depth);
        for d in 0..D {
            points.effective_stress[point][d][d] += if d + 1 == D { vertical } else { lateral * vertical };
        }
    }
}

/// Stresses that the points' weight is in balance with from the start; none where it is not.
fn balanced_weight<const D: usize>(problem: &Problem, points: &Points<D>) -> Vec<Tensor<D>> {
    let is_integrated = problem.points.is_lattice() && !problem.method.basis.is_spline();
    match &problem.weight {
        Some(weight) if weight.is_balanced && !is_integrated => {
            let effective_stress = vec![[[0.0; D]; D]; points.len()];
            let mut weighing = Points::<D> { effective_stress, ..points.clone() };
            add_stress_of_weight(&mut weighing, problem, weight);
            weighing.effective_stress
        }
        _ => Vec::new(),
    }
}

/// Faces that are held, and the plate on a top at a height, m.
fn support<const D: usize>(problem: &Problem, top: f64) -> Support<D> {
    let support = match problem.faces {
        Faces::Oedometer => Support::oedometer(),
        Faces::DrainedBase => Support::oedometer().on_drained_base(),
        Faces::RoughBase => Support::oedometer().on_rough_base(),
        Faces::MovableSide => Support::oedometer().with_movable_side(),
        Faces::Closed => Support::closed(),
    };
    let plate = match problem.load {
        Load::Push { extent, is_rough, .. } => Some(PlateOnTop { extent, height: top, is_rough }),
        _ => None,
    };
    Support { plate, ..support }
}

/// What acts on points in the plane; nothing acts so on a line.
fn forcing_on<const D: usize>(make: &MakeForcing, points: &Points<D>) -> Option<Arc<dyn Forcing<D>>> {
    let places: Vec<[f64; 2]> =
        points.initial_position.iter().map(|place| [place[0], place[D - 1]]).collect();
    // In two dimensions the types are one.
    let forcing: Box<dyn Any> = Box::new(make(&places));
    forcing.downcast().ok().map(|forcing| *forcing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::arrangement::Arrangement;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{SCENES, YIELD_FRONT};
    use oedometer_soil::material::Material;

    #[test]
    fn points_of_any_height_and_arrangement_lie_in_the_body() {
        let (soil, method) = (Material::default(), Method::named("GC-SRI-patch").expect("known"));
        for number in 1..=300_usize {
            let height = 0.05 + 0.01051 * number as f64;
            let (offset, jitter) = ([0.0, 0.3, 0.5, -0.5][number % 4], [0.0, 0.5, 0.3][number % 3]);
            for scene in SCENES.into_iter().filter(|scene| scene.motion.is_none()) {
                let mut column = Column { height, ..(scene.column)() };
                column = column.with_extent(height);
                column.points = Arrangement { offset, jitter, ..Arrangement::default() };
                let cells = 3 + number % 5;
                let problem =
                    scene.problem(&column, &soil, method, cells, 2).map(|problem| Discretised::new(&problem));
                let problem = problem.expect("a problem").expect("a start at every height");
                let is_inside = match &problem {
                    Discretised::Column(problem) => {
                        problem.points.position.iter().all(|place| problem.grid.holds(place))
                    }
                    Discretised::Plane(problem) => {
                        problem.points.position.iter().all(|place| problem.grid.holds(place))
                    }
                };
                assert!(is_inside, "{} {height} {offset} {jitter}", scene.name);
            }
        }
    }

    #[test]
    fn a_soil_yields_at_its_preconsolidation_less_the_initial_stress() {
        let scene = &YIELD_FRONT;
        let soil = Material { law: (scene.soil)().law, preconsolidation: 5.0, ..Material::default() };
        let column = Column { initial_stress: 2.0, load: 10.0, ..(scene.column)() };
        let method = Method::named("GIMP").expect("known");
        let problem = column_problem::<1>(scene, &column, &soil, method, 3, 2).expect("a column");
        let yields: Vec<f64> = problem.points.history.iter().map(|history| history.yield_stress).collect();
        assert_eq!(yields, [3.0; 6]);
    }
}
