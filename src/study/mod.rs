//! Studies: as typed (`file`, `inputs`, `reading`), as planned (`check`), and as judged (`expectation`).

pub mod check;
pub mod expectation;
pub mod file;
pub mod inputs;
pub mod overrides;
pub mod shipped;

pub use check::{Purpose, Study};
pub use file::StudySource;
pub use oedometer_foreign::solver;
pub use oedometer_input::{diagnostic, synonyms, toml_text as reading, units};
