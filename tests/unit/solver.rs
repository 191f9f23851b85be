//! Tests of the solver that take several rooms together; those of one room stand beside its code, or in
//! a file here that the room names.

mod mpm_registers;
pub(crate) mod two_layer_columns;
