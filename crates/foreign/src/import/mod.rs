//! Results of other programs: tables and files with arrays, whose meaning a mapping declares.
//!
//! Programs differ in units, signs, the origin of their coordinates and where they write the time. A mapping file, a
//! preset or the convention declares all of these; nothing is guessed from the numbers.

mod contradictions;
mod csv_text;
mod expected;
mod frame_rows;
pub mod given_files;
mod listed_states;
pub mod mapping;
pub mod nodes;
pub mod origins;
pub mod raw_row;
pub mod run;
pub mod runs;
mod said_units;
mod samples;
mod spelling;
mod step_times;
mod table_rows;
#[cfg(test)]
mod tests;

pub use expected::Absent;
pub use samples::{Beside, RIM, SampledState, states_of};
pub use table_rows::not_ended;
