//! Provenance of a record: program version, sources, compiler, target and machine; and the provenances of several
//! records combined.

pub use crate::case::machine::Machine;
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

    /// Program and commit, in words.
    pub fn made_by(&self) -> String {
        let commit = if self.commit.is_empty() {
            format!("sources {}", self.sources)
        } else {
            format!("commit {}{}", self.commit, if self.dirty { " with changes" } else { "" })
        };
        format!("oedometer {} of {commit}", self.version)
    }

    /// Digest of version and sources: equal for programs that compute equal values.
    pub fn program_tag(&self) -> u64 {
        tag(&[&self.version, &self.sources])
    }

    /// A number for all other properties of a build.
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

/// A property in which builds of one program may differ: its name, and its word for an origin.
type Property = (&'static str, fn(&Provenance) -> &str);

/// Every such property.
const OF_A_BUILD: [Property; 4] = [
    ("compiler", |origin| &origin.compiler),
    ("target", |origin| &origin.target),
    ("profile", |origin| &origin.profile),
    ("tree", |origin| if origin.dirty { "changed since its commit" } else { "as committed" }),
];

/// Origins of records, each with the number of its records.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origins {
    counts: Vec<(Provenance, usize)>,
}

impl Origins {
    /// Counts one record.
    pub fn add(&mut self, origin: &Provenance) {
        self.add_many(origin, 1);
    }

    /// Counts several records.
    pub fn add_many(&mut self, origin: &Provenance, records: usize) {
        match self.counts.iter_mut().find(|(known, _)| known == origin) {
            Some((_, count)) => *count += records,
            None => self.counts.push((origin.clone(), records)),
        }
    }

    /// Counts those of others too.
    pub fn join(&mut self, others: &Self) {
        for (origin, records) in &others.counts {
            self.add_many(origin, *records);
        }
    }

    /// The origin of most records; of the first ones where several have as many.
    pub fn main(&self) -> Option<&Provenance> {
        let most = self.counts.iter().map(|(_, count)| *count).max()?;
        self.counts.iter().find(|(_, count)| *count == most).map(|(origin, _)| origin)
    }

    /// Some of the origins with the numbers of their records, those that are alike as one.
    fn counted(
        &self,
        is_meant: impl Fn(&Provenance) -> bool,
        are_alike: impl Fn(&Provenance, &Provenance) -> bool,
    ) -> Vec<(&Provenance, usize)> {
        let mut origins: Vec<(&Provenance, usize)> = Vec::new();
        for (origin, count) in self.counts.iter().filter(|(origin, _)| is_meant(origin)) {
            match origins.iter_mut().find(|(known, _)| are_alike(known, origin)) {
                Some((_, all)) => *all += count,
                None => origins.push((origin, *count)),
            }
        }
        origins
    }

    /// The programs, in words with the number of their records, where there is more than one: their records
    /// must not be taken together.
    pub fn several_programs(&self) -> Option<String> {
        let programs = self.counted(|_| true, Provenance::is_of_one_program_with);
        let word = |(origin, count): &(&Provenance, usize)| {
            let tree = if origin.dirty { ", changed since their commit" } else { "" };
            format!("{count} of version {} and sources {}{tree}", origin.version, origin.sources)
        };
        (programs.len() > 1).then(|| programs.iter().map(word).collect::<Vec<_>>().join(", "))
    }

    /// In what builds differ from one of them, and in how many records; none where they do not.
    pub fn differences_from(&self, main: &Provenance) -> Option<String> {
        let parts: Vec<String> = OF_A_BUILD.iter().filter_map(|part| self.difference(*part, main)).collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    fn difference(&self, (name, word): Property, main: &Provenance) -> Option<String> {
        let others = self.counted(
            |provenance| word(provenance) != word(main),
            |provenance, other| word(provenance) == word(other),
        );
        let counted: Vec<String> =
            others.iter().map(|(other, count)| format!("`{}` in {count}", word(other))).collect();
        (!counted.is_empty()).then(|| format!("{name} {} instead of `{}`", counted.join(", "), word(main)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin() -> Provenance {
        Provenance {
            version: "1.0.0".to_owned(),
            sources: "aaaa".to_owned(),
            commit: "c1".to_owned(),
            dirty: false,
            compiler: "rustc 1.89.0".to_owned(),
            target: "x86_64-unknown-linux-gnu".to_owned(),
            profile: "release".to_owned(),
        }
    }

    fn origins(all: &[Provenance]) -> Origins {
        let mut origins = Origins::default();
        for provenance in all {
            origins.add(provenance);
        }
        origins
    }

    #[test]
    fn the_main_origin_is_that_of_most_records_wherever_it_stands() {
        let [one, two] = ["c1", "c2"].map(|commit| Provenance { commit: commit.to_owned(), ..origin() });
        for all in [[&one, &two, &two], [&two, &one, &two], [&two, &two, &one]] {
            let all = origins(&all.map(Clone::clone));
            assert_eq!(all.main(), Some(&two));
        }
        assert_eq!(origins(&[one.clone(), two]).main(), Some(&one), "the first of as many");
        assert_eq!(Origins::default().main(), None);
    }

    #[test]
    fn one_build_has_no_differences_whatever_its_commit() {
        let other = Provenance { commit: "c2".to_owned(), ..origin() };
        let all = origins(&[origin(), other]);
        assert_eq!((all.several_programs(), all.differences_from(&origin())), (None, None));
    }

    #[test]
    fn every_property_of_a_build_is_named_with_the_number_of_its_records() {
        let other = |change: fn(&mut Provenance)| {
            let mut other = origin();
            change(&mut other);
            other
        };
        let quick = other(|other| other.profile = "quick".to_owned());
        let newer = other(|other| other.compiler = "rustc 1.90.0".to_owned());
        let all = origins(&[
            origin(),
            quick.clone(),
            origin(),
            quick,
            origin(),
            newer,
            other(|other| other.target = "aarch64-apple-darwin".to_owned()),
            other(|other| other.dirty = true),
        ]);
        assert_eq!(all.main(), Some(&origin()));
        assert_eq!(all.several_programs(), None);
        let told = all.differences_from(&origin()).unwrap_or_default();
        assert_eq!(
            told,
            "compiler `rustc 1.90.0` in 1 instead of `rustc 1.89.0`; target `aarch64-apple-darwin` in 1 instead of \
             `x86_64-unknown-linux-gnu`; profile `quick` in 2 instead of `release`; tree `changed since its commit` \
             in 1 instead of `as committed`"
        );
    }

    #[test]
    fn other_sources_or_another_version_are_another_program() {
        let dirty = Provenance { sources: "bbbb".to_owned(), dirty: true, ..origin() };
        let told = origins(&[origin(), dirty.clone(), dirty]).several_programs();
        let words = "1 of version 1.0.0 and sources aaaa, 2 of version 1.0.0 and sources bbbb, changed since their commit";
        assert_eq!(told.as_deref(), Some(words));
        let newer = Provenance { version: "1.1.0".to_owned(), ..origin() };
        assert!(origins(&[origin(), newer]).several_programs().is_some());
    }

    /// What is another in an origin.
    type Change = fn(&mut Provenance);

    /// A change of every property of an origin.
    const CHANGES: [(&str, Change); 7] = [
        ("version", |changed| changed.version = "1.1.0".to_owned()),
        ("sources", |changed| changed.sources = "bbbb".to_owned()),
        ("commit", |changed| changed.commit = "c2".to_owned()),
        ("dirty", |changed| changed.dirty = true),
        ("compiler", |changed| changed.compiler = "rustc 1.90.0".to_owned()),
        ("target", |changed| changed.target = "aarch64-apple-darwin".to_owned()),
        ("profile", |changed| changed.profile = "quick".to_owned()),
    ];

    #[test]
    fn every_property_is_of_the_program_or_of_the_build_and_those_that_cost_time_are_of_one_build() {
        for (name, change) in CHANGES {
            let (one, mut other) = (origin(), origin());
            change(&mut other);
            let is_of_program = ["version", "sources"].contains(&name);
            assert_eq!(one.is_of_one_program_with(&other), !is_of_program, "{name}");
            assert_eq!(one.program_tag() == other.program_tag(), !is_of_program, "{name}");
            // A tag of what is told of a build: two records with equal tags are told as of one.
            assert_eq!(one.build_tag() == other.build_tag(), is_of_program, "{name}");
            let is_of_times = ["compiler", "target", "profile"].contains(&name);
            for (one, other) in [(&one, &other), (&other, &one)] {
                assert_eq!(one.is_of_one_build_with(other), !is_of_times, "{name}");
            }
        }
        let (one, other) = (origin(), origin());
        assert_eq!((one.build_tag(), one.program_tag()), (other.build_tag(), other.program_tag()));
    }

    #[test]
    fn what_is_told_of_builds_and_programs_counts_all_their_records() {
        let of = |changes: &[&str]| {
            let mut origin = origin();
            CHANGES
                .iter()
                .filter(|(name, _)| changes.contains(name))
                .for_each(|(_, change)| change(&mut origin));
            origin
        };
        let counted = |all: &[(&[&str], usize)]| {
            let mut origins = Origins::default();
            for (changes, records) in all {
                let mut more = Origins::default();
                more.add_many(&of(changes), *records);
                origins.join(&more);
            }
            origins
        };
        // Builds that differ in their commit alone are alike in their profile, in any order.
        for all in [
            [(&["profile"][..], 3), (&["profile", "commit"][..], 40), (&[][..], 100)],
            [(&["profile", "commit"], 40), (&[], 100), (&["profile"], 3)],
            [(&[], 60), (&["profile"], 43), (&[], 40)],
        ] {
            let origins = counted(&all);
            assert_eq!(origins.main(), Some(&origin()), "100 of 143");
            let told = origins.differences_from(&origin());
            assert_eq!(told.as_deref(), Some("profile `quick` in 43 instead of `release`"), "{all:?}");
        }
        let programs =
            counted(&[(&["sources"], 2), (&[], 5), (&["sources", "commit"], 30), (&["target"], 10)]);
        let told = "32 of version 1.0.0 and sources bbbb, 15 of version 1.0.0 and sources aaaa";
        assert_eq!(programs.several_programs().as_deref(), Some(told));
    }
}
