//! The door of the solver: where an integrator and a kernel become a stepper.

use crate::mpm::body::{Body, Problem};
use crate::mpm::direct_solver::singular::Singular;
use crate::mpm::implicit::linear::LinearStepper;
use crate::mpm::implicit::newton::NewtonStepper;
use crate::mpm::layers::two_layer_stepper::TwoLayerStepper;
use crate::mpm::method::Configuration;
use crate::mpm::run::driver::Driver;
use crate::mpm::run::explicit_stepper::ExplicitStepper;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::mpm::run::results::outcome::{Failure, FailureKind, Outcome};
use crate::mpm::run::run_plan::Plan;
use crate::mpm::run::schedule::{Observer, Schedule};
use crate::mpm::run::stepper::Stepper;

/// Solves a problem. Never panics and never loops for ever: what goes wrong ends the run with a
/// named status, and what was finished before stays.
pub fn run<const D: usize>(problem: Problem<D>, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
    let plan = Plan::of(&problem, schedule);
    let (undrained_start, gradient) = (problem.undrained_start, problem.initial_gradient);
    let mut problem = problem;
    let water = problem.water.take();
    let mut body = Body::new(problem);
    let start_failure =
        if undrained_start { body.settle_undrained(schedule.threads).err().map(no_start) } else { None };
    match water {
        Some(lattice) => {
            let start_failure = start_failure.or_else(|| no_layers(schedule.integrator));
            let mut stepper = TwoLayerStepper::new(body, &lattice, &gradient, undrained_start, &plan);
            Driver::new(&mut stepper, &plan, observer).solve(start_failure)
        }
        None => Driver::new(stepper_of(body, &plan).as_mut(), &plan, observer).solve(start_failure),
    }
}

/// The integrator of a body: explicit; one linear system where the body is frozen and at rest;
/// Newton's iteration elsewhere.
fn stepper_of<const D: usize>(body: Body<D>, plan: &Plan<'_>) -> Box<dyn Stepper> {
    let Schedule { integrator, formulation, .. } = *plan.schedule;
    let is_linear = body.configuration == Configuration::Frozen && formulation == Formulation::QuasiStatic;
    match integrator {
        IntegratorKind::Explicit => Box::new(ExplicitStepper::new(body, plan)),
        _ if is_linear => Box::new(LinearStepper::new(body, plan)),
        IntegratorKind::SemiImplicit | IntegratorKind::Implicit => Box::new(NewtonStepper::new(body, plan)),
    }
}

/// The end of a run that has no undrained start.
fn no_start(singular: Singular) -> Failure {
    let reason = format!("the undrained start has no pivot in row {}: nothing holds the body", singular.row);
    Failure { kind: FailureKind::Singular, step: 0, time: 0.0, growth: None, reason }
}

/// The end of a run in two layers by an integrator that has none.
fn no_layers(integrator: IntegratorKind) -> Option<Failure> {
    let reason = format!("two layers of points are integrated explicitly, not by `{}`", integrator.name());
    let failure = Failure { kind: FailureKind::NotConverged, step: 0, time: 0.0, growth: None, reason };
    (integrator != IntegratorKind::Explicit).then_some(failure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::explicit::ExplicitSettings;
    use crate::mpm::method::Method;
    use crate::mpm::run::results::outcome::RunStatus;
    use crate::mpm::run::schedule::Kernel;
    use crate::mpm::run::time_step_rule::TimeStepRule;
    use crate::scene::SceneKind;
    use crate::scene::column::Column;
    use crate::scene::problem::column_problem;
    use crate::soil::material::Material;

    fn problem(method: &str, cells: usize, per_cell: usize) -> Problem<1> {
        let method = Method::named(method).expect("a known method");
        let (column, soil) = (Column::default(), Material::default());
        column_problem(SceneKind::SingleMode, &column, &soil, method, cells, per_cell)
            .expect("the seed column")
    }

    fn schedule(kernel: Kernel, settings: ExplicitSettings, end: f64) -> Schedule {
        let history = vec![0.25 * end, 0.5 * end];
        Schedule {
            outputs: vec![0.0, 0.4 * end, end],
            history,
            rule: TimeStepRule::Stable(0.6),
            settings,
            kernel,
            integrator: IntegratorKind::Explicit,
            critical_step: None,
            formulation: Formulation::VW,
            threads: 1,
        }
    }

    #[test]
    fn outputs_are_hit_and_history_is_noted() {
        let outcome = run(
            problem("GIMP", 5, 2),
            &schedule(Kernel::Fastest, ExplicitSettings::default(), 0.01),
            &|_, _| true,
        );
        let times: Vec<f64> = outcome.snapshots.iter().map(|snapshot| snapshot.time).collect();
        assert_eq!(times[0], 0.0);
        assert!((times[1] - 0.004).abs() < 1e-15 && (times[2] - 0.01).abs() < 1e-15);
        assert_eq!(outcome.history.len(), 2);
        assert_eq!(outcome.history.iter().map(|point| point.time).collect::<Vec<_>>(), [0.0025, 0.005]);
        assert!(outcome.step_sizes.largest <= 0.6 * outcome.step_sizes.predicted_critical * (1.0 + 1e-12));
    }

    #[test]
    fn an_observer_can_stop_a_run() {
        let schedule = schedule(Kernel::Fastest, ExplicitSettings::default(), 0.1);
        let outcome = run(problem("GIMP", 5, 2), &schedule, &|done, _| done < 100);
        let RunStatus::Failed(failure) = outcome.status else { panic!("not stopped") };
        assert_eq!((failure.kind, failure.step), (FailureKind::Stopped, 128));
        assert_eq!(outcome.snapshots.len(), 1, "what was finished stays");
    }
}
