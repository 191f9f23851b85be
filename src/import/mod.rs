//! Somebody else's result: a CSV file of samples, with a declared meaning.
//!
//! Programs differ in units, signs, the origin of the height and the place where they keep the
//! time; a mapping file declares all of these, and nothing is guessed from the numbers.

mod mapping;
mod table;

pub use mapping::{CONVENTION, Mapping};
pub use table::{ImportError, SampledState, states_of};
