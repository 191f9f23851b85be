//! A run: from a problem and a schedule to snapshots, history, counters and a named end.
//!
//! [`run`] makes a [`stepper::Stepper`] of the problem and its integrator, and `driver` takes it from output to output;
//! `watch` looks at it on the way. `observed` finds by runs where steps become unstable.

pub(crate) mod driver;
pub mod observed;
pub(crate) mod watch;

pub use crate::integrate::schedule::{Kernel, Observer, Schedule};
pub use crate::integrate::{run_plan, schedule, stepper};

use crate::direct_solver::Singular;
use crate::entries::of_dimension;
use crate::integrate::critical_step::predicted::GrowingMode;
use crate::integrate::double_point::DoublePoint;
use crate::integrate::explicit_stepper::{ExplicitStepper, PointSets};
use crate::integrate::implicit::driven::DrivenStepper;
use crate::integrate::implicit::linear::LinearStepper;
use crate::integrate::implicit::newton::NewtonStepper;
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{StepFailure, Stepper};
use crate::kernel::body::{Body, Discrete};
use crate::run::driver::Driver;
use crate::time_limit::TimeLimit;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::Configuration;
use oedometer_problem::outcome::{Failure, FailureKind, Outcome};

/// Solves a problem. Never panics and never loops for ever: what goes wrong ends the run with a
/// named status, and what was finished before stays.
pub fn run<const D: usize>(problem: Discrete<D>, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
    let Entry(solved) = of_dimension::<Entry<D>>(&LINE, &PLANE);
    solved(problem, schedule, observer)
}

/// What other crates call of a run.
struct Entry<const D: usize>(fn(Discrete<D>, &Schedule, Observer<'_>) -> Outcome);

static LINE: Entry<1> = Entry(solved);
static PLANE: Entry<2> = Entry(solved);

fn solved<const D: usize>(problem: Discrete<D>, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
    let plan = Plan::new(&problem, schedule);
    if let Some(growing) = &plan.growing {
        return Driver::new(stepper_of(Body::new(problem), &plan).as_mut(), &plan, observer)
            .solve(Some(no_limit(growing)));
    }
    let (undrained_start, gradient) = (problem.undrained_start, problem.initial_gradient);
    let mut problem = problem;
    let water = problem.water.take();
    let mut body = Body::new(problem);
    let time_limit = schedule.time_limit;
    let start_failure = if undrained_start {
        let settled = body.settle_undrained(schedule.threads, time_limit);
        settled.err().map(|singular| no_start(singular, time_limit))
    } else {
        None
    };
    match water {
        Some(lattice) => {
            let start_failure = start_failure.or_else(|| no_water_points(schedule.integrator));
            let double = DoublePoint::new(body, &lattice, &gradient, undrained_start);
            let mut stepper = ExplicitStepper::new(PointSets::Two(Box::new(double)), &plan);
            Driver::new(&mut stepper, &plan, observer).solve(start_failure)
        }
        None => Driver::new(stepper_of(body, &plan).as_mut(), &plan, observer).solve(start_failure),
    }
}

/// The integrator of a body: that of a driven plate; explicit; one linear system where the body is frozen and at rest;
/// Newton's iteration elsewhere.
fn stepper_of<const D: usize>(body: Body<D>, plan: &Plan<'_>) -> Box<dyn Stepper> {
    let Schedule { integrator, formulation, .. } = *plan.schedule;
    let is_linear = body.configuration == Configuration::Frozen
        && formulation == Formulation::QuasiStatic
        && !body.has_history();
    if let Some(plate) = plan.driven_plate {
        return Box::new(DrivenStepper::new(body, plate, plan));
    }
    match integrator {
        IntegratorKind::Explicit => Box::new(ExplicitStepper::new(PointSets::One(Box::new(body)), plan)),
        _ if is_linear => Box::new(LinearStepper::new(body, plan)),
        IntegratorKind::SemiImplicit | IntegratorKind::Implicit => Box::new(NewtonStepper::new(body, plan)),
    }
}

/// The end of a run before its first step.
fn at_start(StepFailure { kind, reason }: StepFailure, growth: Option<f64>) -> Failure {
    Failure { kind, step: 0, time: 0.0, growth, reason }
}

/// The end of a run that has no undrained start: nothing holds it, or its time was over.
fn no_start(singular: Singular, time_limit: TimeLimit) -> Failure {
    if time_limit.is_over() {
        return at_start(StepFailure::out_of_time(), None);
    }
    let reason = format!("the undrained start has no pivot in row {}: nothing holds the body", singular.row);
    at_start(StepFailure { kind: FailureKind::Singular, reason }, None)
}

/// The end of a run whose steps are shares of an unknown limit.
fn no_limit(growing: &GrowingMode) -> Failure {
    let reason = format!("{growing}; a step in `seconds` is not checked");
    at_start(StepFailure { kind: FailureKind::Unstable, reason }, Some(growing.growth))
}

/// The end of a run of double-point MPM by an integrator that has none.
fn no_water_points(integrator: IntegratorKind) -> Option<Failure> {
    let reason = format!("two sets of points are integrated explicitly, not with `{}`", integrator.name());
    (integrator != IntegratorKind::Explicit)
        .then(|| at_start(StepFailure { kind: FailureKind::NotConverged, reason }, None))
}
