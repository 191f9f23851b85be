//! A run: from a problem and a schedule to snapshots, history, counters and a named end.
//!
//! - `door`: the problem's basis and integrator become a [`stepper::Stepper`],
//! - `driver`: takes it from output to output; `watch`, `history`: what it looks at and notes,
//! - `schedule`, `time_step_rule`, `step_limit`, `plan`: when to step and how far,
//! - `explicit_stepper`: the explicit integrator as a stepper; the others are in `implicit`,
//! - `snapshot`, `outcome`: what is left of it.

pub mod door;
pub mod driver;
pub mod energy;
pub mod explicit_stepper;
pub mod integrator;
pub mod physical_bounds;
pub mod profile;
pub mod results;
pub mod run_plan;
pub mod schedule;
pub mod step_limit;
pub mod stepper;
pub mod time_step_rule;
pub mod watch;

pub use door::run;
pub use schedule::{Kernel, Observer, Schedule};
pub use time_step_rule::TimeStepRule;
