//! What made a record: version, sources, compiler, target.

use serde::{Deserialize, Serialize};

/// Origin of a record.
///
/// The rule for records that are taken together, by `run --resume`, `report`, `explain` and `merge`: version and
/// sources must be the same, for they decide the values. Compiler, target, build profile and whether a commit has
/// the tree may differ, for elementary functions come from one source and the values are the same to the bit;
/// what differs is said.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Provenance {
    /// Version of `oedometer`.
    pub version: String,
    /// Hash over the sources the program was built from.
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
    /// Whether both are of one version and of the same sources: what they compute is the same.
    pub fn is_of_one_program_with(&self, other: &Self) -> bool {
        self.version == other.version && self.sources == other.sources
    }

    /// Whether compiler, target and profile are the same too: what they take is the same.
    pub fn is_of_one_build_with(&self, other: &Self) -> bool {
        self.compiler == other.compiler && self.target == other.target && self.profile == other.profile
    }

    /// A number for version and sources: the same for programs whose values are the same.
    pub fn program_tag(&self) -> u64 {
        tag(&[&self.version, &self.sources])
    }

    /// A number for everything else that is told of a build.
    pub fn build_tag(&self) -> u64 {
        let tree = if self.dirty { "changed" } else { "committed" };
        tag(&[&self.commit, tree, &self.compiler, &self.target, &self.profile])
    }

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

/// A number for some words.
fn tag(words: &[&str]) -> u64 {
    let hash = blake3::hash(words.join("\n").as_bytes());
    hash.as_bytes().iter().take(8).fold(0, |number, byte| (number << 8) | u64::from(*byte))
}
