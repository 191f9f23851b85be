//! Tests of the library that take several rooms together; those of one room stand beside its code, or in
//! a file here that the room names.

mod architecture;
mod case_work_estimate;
mod distinct_numbers;
mod documented_tables;
mod judge_permuted_lists;
mod judge_reductions;
mod judge_verdicts;
mod measure_of_runs;
mod measure_pressure_peak;
mod option_pairs;
mod record_tables;
mod runs_cosine_layer;
mod runs_large_strain;
mod runs_manufactured;
mod study_limits;
