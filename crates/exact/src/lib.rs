//! Exact and reference solutions of poromechanics, each with a bound on its own error, with no knowledge of solvers.
//!
//! | module | problem | source |
//! |---|---|---|
//! | [`terzaghi`] | column under a sudden load, compressible or incompressible water | Terzaghi (1943) |
//! | [`single_mode`] | decay of the slowest mode of an unloaded column | Carslaw & Jaeger (1959) |
//! | [`xie_leo`] | large strain in closed form, incompressible water | Xie & Leo (2004) |
//! | [`large_strain`] | large strain for any soil law, continuity and water, sudden or growing load | Gibson, England & Hussey (1967) |
//! | [`dynamic_column`] | column with the inertia of both phases, under a step, a ramp, or let go | after Zienkiewicz et al. (1980) |
//! | [`cosine_layer`] | layer in plane strain under a cosine load | Biot (1941) |
//! | [`mandel`] | slab between rigid plates | Mandel (1953), Cheng & Detournay (1988) |
//! | [`layered`] | column of layers | Schiffman & Stein (1970) |
//! | [`mirrored`] | columns of one soil drained at both ends | two of half the height |
//! | [`yield_front`] | front of first loading that moves into a column | Neumann, in Carslaw & Jaeger (1959) |
//! | [`textbook`] | Biot's column, Cryer's sphere, drains, seabed, injection, Davis & Raymond's column | there |
//! | [`manufactured`] | motions of the unit square with body forces and sources that make them exact | docs/theory.md, Eqs 24–28 |
//!
//! [`consolidation`] has Terzaghi's functions of depth and time that several of them share. [`Reference`] gives the fields
//! of any of them by name; the front page of `oedometer` has an example that runs.
//!
//! Everything is SI; excess pore pressure is positive in compression, effective stress in tension, displacement upward.
//! Depth is the Lagrangian `ζ = 1 − Y/H` below the drained surface, time the factor `T_v = c_v t/H²` with the *drained*
//! coefficient of consolidation. Every solution is a [`Solution`].

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod consolidation;
pub mod cosine_layer;
pub mod dynamic_column;
#[doc(hidden)]
pub mod exact_error;
pub mod footing;
pub mod inputs;
pub mod large_strain;
pub mod layered;
pub mod mandel;
pub mod manufactured;
pub mod mirrored;
#[doc(hidden)]
pub mod numerics;
#[doc(hidden)]
pub mod parameters;
mod porous_soil;
pub mod reference;
pub mod row;
pub mod single_mode;
pub mod solution;
mod talbot;
pub mod terzaghi;
pub mod textbook;
mod unchanging;
pub mod xie_leo;
pub mod yield_front;

pub use crate::exact_error::{ExactError, normal};
pub use crate::inputs::AddedKey;
pub use crate::parameters::{Base, ColumnParameters, Drainage, MotionParameters, TextbookParameters};
pub use crate::reference::{Reference, ReferenceKind};
pub use crate::solution::{Accuracy, FieldValues, Solution};
pub use crate::textbook::TextbookProblem;
