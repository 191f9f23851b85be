//! An external result: tables or files of other programs, with a declared meaning.
//!
//! Programs differ in units, signs, the origins of their coordinates and the place where they keep
//! the time; a mapping file declares all of these, and nothing is guessed from the numbers.

pub mod expected;
pub mod frame_rows;
pub mod mapping;
pub mod opened_csv;
pub mod raw_row;
pub mod rows;
pub mod runs;
pub mod sample_row;
pub mod settlement_series;
pub mod step_times;
pub mod table;
