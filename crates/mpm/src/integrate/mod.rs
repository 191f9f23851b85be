//! Integrators: ways through time for a body.
//!
//! `explicit_stepper` takes the kernel's step, `assembled` the same as sparse maps where nothing moves, `double_point` with
//! the water in points of its own; `implicit` takes steps of any size on the same operators. `critical_step` says how large a
//! step may be, `undrained_start` where a run begins. `schedule` and `run_plan` say when to step and how far, `stepper` is
//! what each integrator is to a driver, `sampling` takes a snapshot.

pub mod assembled;
pub mod critical_step;
pub(crate) mod double_point;
pub(crate) mod explicit_stepper;
pub mod implicit;
pub(crate) mod lost_point;
pub(crate) mod physical_bounds;
pub mod run_plan;
pub mod sampling;
pub mod schedule;
pub mod stepper;
mod undrained_start;
