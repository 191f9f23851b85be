//! Exact and reference solutions of consolidation, with no knowledge of solvers.
//!
//! Everything is SI; excess pore pressure is positive in compression, effective stress in tension,
//! displacement upward. Depth is the Lagrangian `ζ = 1 − Y/H` below the drained surface, time the
//! factor `T_v = c_v t/H²` with the *drained* coefficient of consolidation.
//!
//! [`reference::Reference`] gives the fields of any of them; the front page of `oedometer` has an example that runs.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod at_rest;
pub mod consolidation;
pub mod cosine_layer;
pub mod dynamic_column;
#[doc(hidden)]
pub mod exact_error;
#[doc(hidden)]
pub mod field_values;
pub mod large_strain;
pub mod mandel;
pub mod manufactured;
#[doc(hidden)]
pub mod parameters;
#[doc(hidden)]
pub mod quadrature;
pub mod reference;
pub mod single_mode;
pub mod terzaghi;
pub mod xie_leo;

pub use crate::exact_error::{ExactError, normal};
pub use crate::field_values::{Accuracy, FieldValues};
pub use crate::parameters::{Base, ColumnParameters, MotionParameters};
pub use crate::reference::{Reference, ReferenceKind};
