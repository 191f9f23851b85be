//! Whole runs of the solver, and exact solutions that take as long: linked with the solver as the program is, with every
//! optimisation. Tests beside the formulas are compiled without (`oedometer-solver-units`).

use oedometer_solver::mpm::run::Schedule;
use oedometer_solver::mpm::run::results::outcome::Outcome;
use oedometer_solver::scene::problem::SceneProblem;
use oedometer_solver::{exact, mpm, scene, soil};

mod door;
mod exact_dynamic_column;
mod exact_large_strain;
mod exact_references;
mod implicit;
mod invariants;
mod step_growth;
mod two_dimensions;

/// Solves a problem by the code that is compiled with the solver: a function with type parameters would be compiled
/// here, again.
fn run(problem: impl Into<SceneProblem>, schedule: &Schedule) -> Outcome {
    problem.into().run(schedule, &|_, _| true)
}
