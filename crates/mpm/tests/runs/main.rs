//! Whole runs of the solver.

use oedometer_mpm::run::Schedule;
use oedometer_mpm::run::results::outcome::Outcome;
use oedometer_mpm::scene::problem::SceneProblem;

mod door;
mod exact_references;
mod implicit;
mod invariants;
mod step_growth;
mod two_dimensions;

/// Solves a problem from start to end, whatever its dimension.
fn run(problem: impl Into<SceneProblem>, schedule: &Schedule) -> Outcome {
    problem.into().run(schedule, &|_, _| true)
}
