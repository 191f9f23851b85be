//! Scenes: the physical problems by name, with what a study may say of each, and the exact solutions that hold for it.
//!
//! A scene makes a [`Problem`](oedometer_problem::problem::Problem), which any solver may solve: nothing here knows one.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod column;
mod columns;
mod definition;
mod manufactured;
mod plane;
mod problem;
mod scene;

pub use scene::SceneKind;
