//! Estimates the work of a case before it runs.

use crate::case::step_cost::{CASE_SECONDS, seconds_per_step};
use crate::case::{Case, Task};
use oedometer_mpm::critical_step::formula;
use oedometer_mpm::critical_step::observed::OBSERVED_STEPS;
use oedometer_mpm::run::TimeStepRule;
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::elementary;

/// Steps after which a run at a share of the critical step has shown that it is clean.
pub const MOST_PROBE_STEPS: u64 = 262_144;

/// Runs of a search for the critical step that hold to their end, as a rule: it begins between the runs beside it.
const HELD_RUNS: f64 = 4.0;

/// Work of cases together: the largest number where there is more.
pub fn work_of<'a>(cases: impl Iterator<Item = &'a Case>) -> u64 {
    cases.fold(0, |sum, case| sum.saturating_add(estimated_work(case)))
}

/// Work of a case: the time that it will take on one core, ns.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, it is an estimate")]
pub fn estimated_work(case: &Case) -> u64 {
    (1e9 * estimated_seconds(case)).max(1.0) as u64
}

/// Time assumed for a case of an attached solver, s: it cannot be estimated.
const ATTACHED_SECONDS: f64 = 5.0;

/// Time that a case will take on one core of the machine that [`step_cost`](crate::case::step_cost) names, s.
pub fn estimated_seconds(case: &Case) -> f64 {
    if case.is_attached() {
        return ATTACHED_SECONDS;
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
    let step = match case.time_step {
        TimeStepRule::Stable(share) if case.integrator == IntegratorKind::SemiImplicit => {
            share
                * formula::semi_implicit_limit(&case.material, case.cell_size(), case.has_undamped_motions())
        }
        TimeStepRule::Stable(share) => {
            1.5 * share * formula::combined_limit(&case.material, case.cell_size(), case.settings.drag)
        }
        TimeStepRule::Courant(share) => {
            share * case.cell_size() / formula::fastest_wave_speed(&case.material, case.material.porosity)
        }
        TimeStepRule::Seconds(seconds) => seconds,
        TimeStepRule::Tolerance(tolerance) => end * tolerance.sqrt() / 20.0,
        TimeStepRule::Growth(growth) => {
            let first = parameters.time(elementary::powi(case.cells as f64, -2));
            growth * end / (2.0 + elementary::ln((end / first).max(1.0)))
        }
    };
    match case.task {
        // The undrained start alone: no steps, and rules relative to the time give none.
        Task::Solve if end == 0.0 => 0.0,
        Task::Solve => end / step,
        Task::Stability => {
            // Runs of a fixed length bracket the limit; that below it ends with the scene, or before, and that above soon.
            let observed = OBSERVED_STEPS as f64;
            HELD_RUNS * observed + (end / step).clamp(observed, MOST_PROBE_STEPS as f64)
        }
    }
}
