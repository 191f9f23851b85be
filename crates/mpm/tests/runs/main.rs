//! Whole runs of the solver.

use oedometer_mpm::discretise::{Discretised, discretise};
use oedometer_mpm::kernel::body::Discrete;
use oedometer_mpm::run::Schedule;
use oedometer_problem::method::Method;
use oedometer_problem::outcome::Outcome;
use oedometer_problem::problem::StartError;
use oedometer_scenes::Scene;
use oedometer_scenes::column::Column;
use oedometer_soil::material::Material;

mod door;
mod exact_references;
mod implicit;
mod invariants;
mod step_by_hand;
mod step_growth;
mod two_dimensions;

/// A scene's problem in the dimension that is asked for.
fn column_problem<const D: usize>(
    scene: &'static Scene,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Discrete<D>, StartError> {
    discretise(&scene.problem(column, soil, method, cells, points_per_cell)?)
}

/// A scene's problem in the dimensions of its column.
fn discretised(
    scene: &'static Scene,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Discretised, StartError> {
    Discretised::new(&scene.problem(column, soil, method, cells, points_per_cell)?)
}

/// Solves a problem from start to end, whatever its dimension.
fn run(problem: impl Into<Discretised>, schedule: &Schedule) -> Outcome {
    problem.into().run(schedule, &|_, _| true)
}

/// A column in which no number is one, nor a power of ten of another: a height for a share, or a load for a ratio, shows.
fn odd_column() -> Column {
    Column { height: 2.3, load: 37.0, ..Column::default() }
}

/// A soil of the same kind, whose water is soft enough for a large explicit step.
fn odd_soil() -> Material {
    Material {
        youngs_modulus: 1.3e6,
        poissons_ratio: 0.22,
        porosity: 0.43,
        grain_density: 2710.0,
        water_density: 1030.0,
        water_bulk_modulus: 1.7e7,
        hydraulic_conductivity: 4.1e-2,
        gravity: 9.7,
        ..Material::default()
    }
}
