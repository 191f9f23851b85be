//! An external result: a CSV file of samples, with a declared meaning.
//!
//! Programs differ in units, signs, the origins of their coordinates and the place where they keep
//! the time; a mapping file declares all of these, and nothing is guessed from the numbers.

pub mod convention;
pub mod import_error;
pub mod mapping;
pub mod sample_row;
pub mod table;
pub mod units;
