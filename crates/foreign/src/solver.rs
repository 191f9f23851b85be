//! A checked external solver: its command, and how its result is read.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use oedometer_case::solver::{Attached, SolverName};
use std::path::PathBuf;

/// A program whose files are known; `import` has what their arrays mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Its name at the command line and in study files.
    pub name: &'static str,
    about: &'static str,
    /// Names of arrays that show that a file is the program's.
    pub signs: &'static [&'static str],
}

const fn preset(name: &'static str, about: &'static str, signs: &'static [&'static str]) -> Preset {
    Preset { name, about, signs }
}

/// All presets.
pub const PRESETS: [Preset; 10] = [
    preset("ogs", "OpenGeoSys 6", &["OGS_VERSION", "pressure_interpolated"]),
    preset("kratos", "KratosMultiphysics with its GeoMechanicsApplication", &["WATER_PRESSURE"]),
    preset("porepy", "PorePy", &["mortar_side", "subdomain_id"]),
    preset("geotaichi", "GeoTaichi's material points", &["t_current", "estress"]),
    preset("anura3d", "Anura3D's material points, VTK", &["pressure_liquid", "displacement_solid"]),
    preset("cb-geo", "CB-Geo mpm's particles, HDF5 or VTP", &["liquid_svars_0", "pore_pressures"]),
    preset("kratos-poro", "KratosMultiphysics with its PoromechanicsApplication", &["LIQUID_PRESSURE"]),
    preset("kratos-mpm", "KratosMultiphysics with its MPMApplication", &["MP_DISPLACEMENT"]),
    preset("mpm-geomechanics", "MPM-Geomechanics", &["Pore Pressure", "Stress_ZZ"]),
    preset("meshio", "meshio, scikit-fem, FEniCS and others with a pressure and a displacement", &[]),
];

impl ValueEnum for Preset {
    fn value_variants<'a>() -> &'a [Self] {
        &PRESETS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name).help(self.about))
    }
}

/// Units of the time that a solver says it took, s.
pub const SOLVE_UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("min", 60.0), ("h", 3600.0)];

/// What stands for values of a case in commands, environment and result.
pub const PLACEHOLDERS: [(&str, &str); 7] = [
    ("case", "path of the case file, case.json"),
    ("out", "fresh folder in which the solver is started and writes its result"),
    ("study", "folder of the study file"),
    ("cells", "cells over the height"),
    ("points_per_cell", "material points per cell and direction"),
    ("time_step", "suggested time step, s"),
    ("end_time", "time of the last output, s"),
];

/// A program that solves a case of the study and writes a result.
#[derive(Clone, Debug, PartialEq)]
pub struct ExternalSolver {
    /// Its name, with the digest of its command and files.
    pub identity: Attached,
    /// Folder of the study file, against which its files are named.
    pub folder: PathBuf,
    /// The program and its arguments, as typed.
    pub command: Vec<String>,
    /// The result, as typed: below `{out}`.
    pub result: String,
    /// Files of a result that is there already, as typed; empty where the command makes one.
    pub files: Vec<String>,
    /// Seconds from one numbered step to the next, where file names have the number of the step.
    pub time_step: Option<f64>,
    /// Mapping file, below the folder.
    pub mapping: Option<String>,
    /// Program whose files are known.
    pub preset: Option<Preset>,
    /// Command that prints its version; empty by default.
    pub version: Vec<String>,
    /// Files and folders that it is made of beside those of its command, as typed, where the study declares that results
    /// may be taken over while they and the output of the version command stay the same; `None`: it is always run.
    pub known_by: Option<Vec<String>>,
    /// Longest wall time of one run, s.
    pub timeout: f64,
    /// Runs of each case that are timed.
    pub repeats: usize,
    /// Whether a run goes before the timed ones.
    pub warm_up: bool,
    /// How many of its runs may go on at the same time.
    pub at_once: usize,
    /// Variables of its environment, as typed.
    pub environment: Vec<(String, String)>,
    /// Pattern of the time that it says it took.
    pub solve_seconds: Option<String>,
    /// Unit of that time, s.
    pub solve_unit: f64,
}

impl ExternalSolver {
    /// Whether its results exist already, so that nothing runs.
    pub fn is_given(&self) -> bool {
        !self.files.is_empty()
    }

    /// The name that the study gives it.
    pub fn name(&self) -> &str {
        self.identity.name()
    }

    /// What cases have as their method that are given to it.
    pub fn method(&self) -> SolverName {
        SolverName::Attached(self.identity)
    }

    /// The words of its command and the values of its environment.
    pub fn words(&self) -> impl Iterator<Item = &String> {
        self.command.iter().chain(self.environment.iter().map(|(_, value)| value))
    }

    /// Where a file or folder that the study names lies.
    pub fn place(&self, word: &str) -> PathBuf {
        self.folder.join(word.strip_prefix("{study}/").unwrap_or(word))
    }

    /// The file that a word names, where one of that name is in the study's folder.
    pub fn file(&self, word: &str) -> Option<PathBuf> {
        file_beside(&self.folder, word)
    }
}

/// The file of a folder that a word names, as it stands or behind `{study}/`, which is that folder; `None` for a word
/// without a letter or one that begins like an option.
pub fn file_beside(folder: &std::path::Path, word: &str) -> Option<PathBuf> {
    let word = word.strip_prefix("{study}/").unwrap_or(word);
    let is_name = word.contains(|letter: char| letter.is_alphabetic()) && !word.starts_with('-');
    Some(folder.join(word)).filter(|path| is_name && path.is_file())
}

/// The placeholders of a text, `{case}` and its like, without their braces.
pub fn placeholders_of(text: &str) -> impl Iterator<Item = &str> {
    let parts = text.split('{').skip(1).filter_map(|part| part.split_once('}'));
    parts.map(|(name, _)| name).filter(|name| {
        let is_word = |letter: char| letter.is_ascii_lowercase() || letter == '_';
        !name.is_empty() && name.chars().all(is_word)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placeholders_are_words_in_braces_and_nothing_else() {
        let found: Vec<&str> = placeholders_of("a{case}/{out}/x{}{1}{ \"a\": 1 }{end_time").collect();
        assert_eq!(found, ["case", "out"]);
        let known = PLACEHOLDERS.map(|(name, _)| name);
        let text = known.map(|name| format!("{{{name}}}")).join("-");
        assert_eq!(placeholders_of(&text).collect::<Vec<_>>(), known);
        // A word with a slip in it is one too, wherever its underscore stands, and is complained of.
        let found: Vec<&str> =
            placeholders_of("{end_tme} {_end} {end_} {_} {End} {a-b} {a b} {x2}").collect();
        assert_eq!(found, ["end_tme", "_end", "end_", "_"]);
    }

    #[test]
    fn a_word_is_a_file_only_where_the_folder_has_one() {
        let folder = tempfile::TempDir::new().expect("a folder");
        std::fs::write(folder.path().join("adapter.py"), "").expect("a file");
        std::fs::write(folder.path().join("10"), "").expect("a file");
        assert!(file_beside(folder.path(), "adapter.py").is_some());
        for word in ["python3", "10", "-adapter.py", "{case}"] {
            assert_eq!(file_beside(folder.path(), word), None, "{word}");
        }
    }
}
