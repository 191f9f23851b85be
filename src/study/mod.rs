//! Studies: as typed (`file`, `inputs`, `reading`), as planned (`check`), as judged (`expectation`), and as typed at the command line
//! (`overrides`, `asked`).

pub mod asked;
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
