//! Whole runs of the solver.

use oedometer_mpm::run::Schedule;
use oedometer_mpm::run::results::outcome::Outcome;
use oedometer_mpm::scene::column::Column;
use oedometer_mpm::scene::problem::SceneProblem;
use oedometer_soil::material::Material;

mod door;
mod exact_references;
mod implicit;
mod invariants;
mod step_by_hand;
mod step_growth;
mod two_dimensions;

/// Solves a problem from start to end, whatever its dimension.
fn run(problem: impl Into<SceneProblem>, schedule: &Schedule) -> Outcome {
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
