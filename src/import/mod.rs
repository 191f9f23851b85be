//! Somebody else's result: a CSV file of samples, with a declared meaning.
//!
//! Programs differ in units, signs, the origins of their coordinates and the place where they keep
//! the time; a mapping file declares all of these, and nothing is guessed from the numbers.

mod error;
mod mapping;
mod row;
mod table;
mod units;

pub use error::ImportError;
pub use mapping::{CONVENTION, Mapping, PLANE_CONVENTION};
pub use table::{Frame, SampledState, states_of};
pub use units::{LengthUnit, StressUnit, TimeUnit};
