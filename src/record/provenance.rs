//! What made a record: version, sources, compiler, target.

use serde::{Deserialize, Serialize};

/// Origin of a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of `oedometer`.
    pub version: String,
    /// Hash over the sources the program was built from: a stored record is only taken up again
    /// by the program that made it.
    pub sources: String,
    /// Commit, where the sources were in a repository.
    pub commit: String,
    /// Whether the sources differed from that commit.
    pub dirty: bool,
    /// Compiler.
    pub compiler: String,
    /// Target triple.
    pub target: String,
    /// Build profile.
    pub profile: String,
}

impl Provenance {
    /// This program's.
    pub fn of_this_program() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            sources: env!("OEDOMETER_SOURCES").to_owned(),
            commit: env!("OEDOMETER_COMMIT").to_owned(),
            dirty: env!("OEDOMETER_DIRTY") == "true",
            compiler: env!("OEDOMETER_COMPILER").to_owned(),
            target: env!("OEDOMETER_TARGET").to_owned(),
            profile: env!("OEDOMETER_PROFILE").to_owned(),
        }
    }
}
