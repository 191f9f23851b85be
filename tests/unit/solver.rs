//! Tests of the solver that take several rooms together; those of one room stand beside its code, or in
//! a file here that the room names.

mod mpm_invariants;
mod mpm_registers;
mod mpm_two_dimensions;
pub(crate) mod two_layer_columns;
