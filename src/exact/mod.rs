//! Exact and reference solutions of consolidation, with no knowledge of solvers.
//!
//! Everything is SI; excess pore pressure is positive in compression, effective stress in tension,
//! displacement upward. Depth is the Lagrangian `ζ = 1 − Y/H` below the drained surface, time the
//! factor `T_v = c_v t/H²` with the *drained* coefficient of consolidation.
//!
//! [`reference::Reference`] is the one door for the rest of the crate.

pub mod consolidation;
pub mod cosine_layer;
pub mod dynamic_column;
pub mod error;
pub mod large_strain;
pub mod parameters;
pub mod quadrature;
pub mod reference;
pub mod single_mode;
pub mod terzaghi;
pub mod xie_leo;

pub use crate::exact::error::{ExactError, normal};
pub use crate::exact::parameters::ColumnParameters;
pub use crate::exact::reference::{Accuracy, FieldValues, Reference, ReferenceKind};
