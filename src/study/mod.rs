//! Studies: as typed (`file`, `inputs`, `reading`), as planned (`check`), and as judged (`expectation`).

pub mod check;
pub mod diagnostic;
pub mod expectation;
pub mod file;
pub mod inputs;
pub mod overrides;
pub mod reading;
pub mod shipped;
pub mod solver;
pub mod units;

pub use check::{Purpose, Study};
pub use file::StudySource;
