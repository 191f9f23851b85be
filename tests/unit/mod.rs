//! Tests of the library that take several rooms together; those of one room stand beside its code, or in
//! a file here that the room names.

mod architecture;
mod convergence_classes;
mod documented_tables;
mod judge_verdicts;
mod option_pairs;
mod runs_cosine_layer;
mod runs_large_strain;
mod runs_manufactured;
mod runs_profile;
