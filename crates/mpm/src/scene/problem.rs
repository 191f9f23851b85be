//! A scene's problem for the solver: grid, lattice of points, start and load. One `match` turns the number
//! of dimensions into a type.

use crate::actions::surface_load::LoadShape;
use crate::integrate::critical_step::predicted::{predict_for_run, whole_growth};
use crate::integrate::results::outcome::Outcome;
use crate::kernel::ExplicitSettings;
use crate::kernel::body::{DrivenPlate, Problem};
use crate::method::{Method, Quadrature};
use crate::run::observed::{CriticalStep, Stopped, critical_step};
use crate::run::{Observer, Schedule, run};
use crate::scene::SceneKind;
use crate::scene::arrangement::place_points;
use crate::scene::column::{Column, Undrained, column_parameters};
use crate::scene::definition::{ColumnStart, SceneLoad, SceneStart};
use crate::scene::manufactured;
use crate::scene::moment_fitting::fit_volumes;
use crate::state::grid::Grid;
use crate::state::nodes::{PlateOnTop, Support};
use crate::state::points::Points;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::parameters::{Base, ColumnParameters};
use oedometer_soil::law::History;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Tensor;

/// Cells above the column, so that a surface that rises stays on the grid.
const HEADROOM: usize = 1;
/// Share of its conductivity that a sealed soil keeps.
const SEALED: f64 = 1e-12;

/// A problem of one or of two dimensions.
#[derive(Clone, Debug)]
pub enum SceneProblem {
    /// A column.
    Column(Problem<1>),
    /// Plane strain.
    Plane(Problem<2>),
}

impl SceneProblem {
    /// The scene's problem in the dimensions of the column, as [`column_problem`] makes it.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn new(
        scene: SceneKind,
        column: &Column,
        soil: &Material,
        method: Method,
        cells: usize,
        points_per_cell: usize,
    ) -> Result<Self, ExactError> {
        if column.dimensions == 1 {
            column_problem(scene, column, soil, method, cells, points_per_cell).map(Self::Column)
        } else {
            column_problem(scene, column, soil, method, cells, points_per_cell).map(Self::Plane)
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

impl From<Problem<1>> for SceneProblem {
    fn from(problem: Problem<1>) -> Self {
        Self::Column(problem)
    }
}

impl From<Problem<2>> for SceneProblem {
    fn from(problem: Problem<2>) -> Self {
        Self::Plane(problem)
    }
}

/// The scene's problem on `cells` cells over the height with `points_per_cell` points each, in the
/// dimension that is asked for.
///
/// # Errors
/// When the parameters are impossible.
pub fn column_problem<const D: usize>(
    scene: SceneKind,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Problem<D>, ExactError> {
    let cell_size = column.cell_size(cells);
    let mut extent = [column.cells_across(cells).unwrap_or(1); D];
    extent[D - 1] = column.cells_up(cells);
    let start = match &scene.definition().start {
        SceneStart::OverDepth(start) => Some(start(column, soil)?),
        SceneStart::Solved => None,
    };
    let mut initial_gradient = [[0.0; D]; D];
    if let Some(start) = &start {
        initial_gradient[D - 1][D - 1] = start.vertical_gradient;
    }
    let sets = PointSets { column, soil, method, cell_size, extent, start };
    let points = sets.with(points_per_cell)?;
    let of_water = column.points.water_per_cell;
    let water =
        column.points.has_two_sets().then_some(if of_water == 0 { points_per_cell } else { of_water });
    let water = water.map(|per_cell| sets.with(per_cell)).transpose()?;
    let forcing = scene
        .model()
        .map(|model| manufactured::forcing(model, column, soil, &points.initial_position))
        .transpose()?;
    let top = extent[D - 1] as f64 * cell_size;
    if forcing.is_none() {
        extent[D - 1] += HEADROOM;
    }
    let driven_plate = driven_plate(scene, column, soil);
    let method = method_on(method, driven_plate);
    let load = column.pressure_scale().abs();
    let balanced_weight = balanced_weight(scene, column, soil, method, &points);
    let soil = drained_soil(scene, soil);
    let weight = column.self_weight.then_some(soil.gravity);
    Ok(Problem {
        grid: Grid::new(cell_size, extent),
        support: support(scene, column, top),
        points,
        water,
        material: soil,
        soils: match &column.soils[..] {
            [] => vec![soil],
            layers => layers.iter().map(|layer| layer.soil(&soil)).collect(),
        },
        method,
        configuration: method.configuration_in(scene.configuration()),
        load: if scene.is_loaded() && !scene.has_plates() { column.load } else { 0.0 },
        load_shape: load_shape(scene, column),
        driven_plate,
        plate_load: scene.has_plates().then_some(column.load),
        weight,
        balanced_weight,
        undrained_start: scene.start_is_solved(),
        loading_time: column.loading_time,
        initial_gradient,
        // Round-off is of the size of what weighs.
        pressure_scale: weight
            .map_or(load, |gravity| load.max(soil.mixture_density() * gravity * column.height)),
        forcing,
        // A plate of prescribed motion presses as hard as it has to.
        is_bounded: driven_plate.is_none(),
    })
}

/// Choices from which the point sets of a problem are made.
struct PointSets<'a, const D: usize> {
    column: &'a Column,
    soil: &'a Material,
    method: Method,
    /// m.
    cell_size: f64,
    /// Cells in each direction.
    extent: [usize; D],
    /// The state at the start, where it is not solved for.
    start: Option<ColumnStart>,
}

impl<const D: usize> PointSets<'_, D> {
    /// Points at the start, so many in each cell.
    fn with(&self, per_cell: usize) -> Result<Points<D>, ExactError> {
        let Self { column, soil, method, cell_size, extent, start } = self;
        let mut points = place_points(&column.points, *cell_size, *extent, per_cell);
        if method.quadrature == Quadrature::Moments {
            fit_volumes(&mut points, *cell_size, *extent, column.height);
        }
        if soil.law.has_history() {
            // Stresses are counted from the initial one.
            let yield_stress = soil.preconsolidation - column.initial_stress;
            points.history = vec![History { yield_stress, ..History::default() }; points.len()];
        }
        for point in 0..points.len() {
            let layer = column.soils.number_at(points.initial_position[point][D - 1]);
            points.soil[point] = u8::try_from(layer).unwrap_or(u8::MAX);
        }
        if let Some(start) = start {
            start.apply(&mut points, column.height)?;
            if column.self_weight {
                add_initial_stress(&mut points, &column_parameters(column, soil));
            }
        }
        Ok(points)
    }
}

/// Stresses that the points' weight is in balance with from the start; none where it is not.
fn balanced_weight<const D: usize>(
    scene: SceneKind,
    column: &Column,
    soil: &Material,
    method: Method,
    points: &Points<D>,
) -> Vec<Tensor<D>> {
    // A column at rest is there to show what a method leaves unbalanced.
    let is_integrated = column.points.is_lattice() && !method.basis.is_spline();
    if !column.self_weight || is_integrated || scene.is_at_rest() {
        return Vec::new();
    }
    let mut weighing = Points::<D> { effective_stress: vec![[[0.0; D]; D]; points.len()], ..points.clone() };
    add_initial_stress(&mut weighing, &column_parameters(column, soil));
    weighing.effective_stress
}

/// Faces that are held, and the plate on a top at a height, m.
fn support<const D: usize>(scene: SceneKind, column: &Column, top: f64) -> Support<D> {
    let support = if scene.is_manufactured() {
        Support::closed()
    } else if column.base() == Some(Base::Rough) {
        Support::oedometer().on_rough_base()
    } else if scene.has_plates() {
        Support::oedometer().with_movable_side()
    } else {
        Support::oedometer()
    };
    let plate = (scene == SceneKind::Footing).then_some(PlateOnTop {
        extent: 0.5 * column.footing.width,
        height: top,
        is_rough: column.footing.contact == Base::Rough,
    });
    Support { plate, ..support }
}

/// The plate that is pushed into a body by its width in the time of `T_v = 1`.
fn driven_plate(scene: SceneKind, column: &Column, soil: &Material) -> Option<DrivenPlate> {
    (scene == SceneKind::Footing).then(|| DrivenPlate {
        velocity: column.footing.width / column_parameters(column, soil).time(1.0),
        has_water: column.footing.undrained == Undrained::TwoPhase,
    })
}

/// The method under a plate: total stress has one phase, whose volume goes the way that the water's would.
fn method_on(method: Method, plate: Option<DrivenPlate>) -> Method {
    let of_one_phase = plate.filter(|plate| !plate.has_water).and_then(|_| method.strain.with_bbar());
    of_one_phase.map_or(method, |strain| Method { strain, ..method })
}

/// A scene's soil: what no water leaves is a soil that lets none through.
fn drained_soil(scene: SceneKind, soil: &Material) -> Material {
    let sealing = if scene == SceneKind::SealedElement { SEALED } else { 1.0 };
    Material { hydraulic_conductivity: sealing * soil.hydraulic_conductivity, ..*soil }
}

/// Variation of a scene's load along the surface.
fn load_shape(scene: SceneKind, column: &Column) -> LoadShape {
    match scene.definition().load {
        SceneLoad::Cosine => LoadShape::Cosine { length: column.extent() },
        SceneLoad::None | SceneLoad::Sudden | SceneLoad::SuddenOrGrowing(_) | SceneLoad::Plates => {
            LoadShape::Uniform
        }
    }
}

/// Gives points the stress of the soil's own weight, that to the sides as an oedometer at rest has it.
fn add_initial_stress<const D: usize>(points: &mut Points<D>, parameters: &ColumnParameters) {
    let lateral = parameters.soil.poissons_ratio / (1.0 - parameters.soil.poissons_ratio);
    for point in 0..points.len() {
        let depth = 1.0 - points.initial_position[point][D - 1] / parameters.height;
        let vertical = parameters.initial_stress(depth);
        for d in 0..D {
            points.effective_stress[point][d][d] += if d + 1 == D { vertical } else { lateral * vertical };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::arrangement::Arrangement;

    #[test]
    fn points_of_any_height_and_arrangement_lie_in_the_body() {
        let (soil, method) = (Material::default(), Method::named("GC-SRI-patch").expect("known"));
        for number in 1..=300_usize {
            let height = 0.05 + 0.01051 * number as f64;
            let (offset, jitter) = ([0.0, 0.3, 0.5, -0.5][number % 4], [0.0, 0.5, 0.3][number % 3]);
            for scene in SceneKind::ALL.into_iter().filter(|scene| !scene.is_manufactured()) {
                let mut column = Column { height, ..scene.default_column() };
                column = column.with_extent(height);
                column.points = Arrangement { offset, jitter, ..Arrangement::default() };
                let cells = 3 + number % 5;
                let problem = SceneProblem::new(scene, &column, &soil, method, cells, 2);
                let problem = problem.unwrap_or_else(|error| panic!("{} {height}: {error}", scene.name()));
                let is_inside = match &problem {
                    SceneProblem::Column(problem) => {
                        problem.points.position.iter().all(|place| problem.grid.holds(place))
                    }
                    SceneProblem::Plane(problem) => {
                        problem.points.position.iter().all(|place| problem.grid.holds(place))
                    }
                };
                assert!(is_inside, "{} {height} {offset} {jitter}", scene.name());
            }
        }
    }

    #[test]
    fn a_soil_yields_at_its_preconsolidation_less_the_initial_stress() {
        let scene = SceneKind::YieldFront;
        let soil = Material { law: scene.default_law(), preconsolidation: 5.0, ..Material::default() };
        let column = Column { initial_stress: 2.0, load: 10.0, ..scene.default_column() };
        let method = Method::named("GIMP").expect("known");
        let problem = column_problem::<1>(scene, &column, &soil, method, 3, 2).expect("a column");
        let yields: Vec<f64> = problem.points.history.iter().map(|history| history.yield_stress).collect();
        assert_eq!(yields, [3.0; 6]);
    }
}
