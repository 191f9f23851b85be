//! Studies inside the program, and valid names of studies.

use crate::study::file::StudySource;

/// The studies by their names, each with its text.
macro_rules! shipped {
    ($($name:literal)+) => {
        &[$((concat!("studies/", $name, ".toml"), include_str!(concat!("../../studies/", $name, ".toml")))),+]
    };
}

/// The files in the order of the report, and their texts.
const SHIPPED: &[(&str, &str)] = shipped! {
    "terzaghi-mesh" "terzaghi-both-ends" "terzaghi-floor" "terzaghi-points" "terzaghi-time-step" "step-control"
    "value-uncertainty" "terzaghi-methods" "terzaghi-integrators" "any-soil" "any-column" "jittered-points" "work-precision" "terzaghi-moving"
    "single-mode" "dynamic-column" "dynamic-ramp" "dynamic-growth" "dynamic-mode" "standing-wave-mesh"
    "standing-wave-step" "column-in-the-plane" "column-in-the-plane-steps" "layer-locking" "layer-mesh"
    "layer-smooth" "pressure-projection" "mandel" "self-weight" "self-weight-large" "self-weight-options" "self-weight-plane"
    "self-weight-waves" "at-rest"
    "layered-conductivity" "layered-stiffness" "layered-node" "layered-both-ends" "layered-water" "yield-front-moduli" "yield-front-integrators" "sealed-element" "footing"
    "stability-conductivity" "stability-stiffness" "stability-porosity" "stability-points"
    "stability-offset" "stability-flip" "stability-slow-growth" "hard-undrained" "hard-stiff-water"
    "hard-tiny-porosity" "hard-large-porosity" "hard-one-point" "hard-faces" "hard-jitter" "hard-empty-top"
    "hard-tiny" "hard-huge" "hard-early" "hard-strain" "hard-long" "large-strain-column" "large-strain-mesh"
    "large-strain-explicit" "large-strain-implicit" "large-strain-integrators" "large-strain-models"
    "large-strain-points" "large-strain-crossing" "large-strain-plane" "large-strain-small"
    "large-strain-half" "large-strain-start" "large-strain-chord" "large-strain-chord-plane" "large-strain-ramp" "large-strain-ramp-half"
    "large-strain-ramp-steps" "large-strain-limit" "large-strain-both-ends" "large-strain-layers" "nodal-pressure" "large-strain-nodal" "double-point"
    "double-point-large-strain" "double-point-plane" "stability-double-point" "manufactured-box" "manufactured-shear"
    "manufactured-vortex" "map"
    "race-column-usual" "race-points-jitter-30" "race-points-offset" "race-points-one"
    "race-points-unequal" "race-waves-column" "race-waves-standing" "race-layer-0.3" "race-layer-0.49"
    "race-layer-0.4999" "race-layer-mandel-0.4999" "race-strain-30" "race-strain-50"
    "race-strain-50-growing" "race-plane-box" "race-plane-shear" "race-plane-vortex" "race-plane-vortex-large"
    "race-plane-crossings" "race-soil-cell" "race-soil-yield" "race-property-step" "race-property-rest"
    "race-footing"
};

/// The shipped study of a name.
pub fn shipped_study(name: &str) -> Option<StudySource> {
    SHIPPED.iter().find(|(file, _)| name_of(file) == name).map(source)
}

/// The names of the shipped studies.
pub fn shipped_names() -> Vec<String> {
    SHIPPED.iter().map(|(file, _)| name_of(file)).collect()
}

/// Names and titles of the shipped studies. Only the line of the title is read: nothing is checked.
pub fn shipped_titles() -> impl Iterator<Item = (String, String)> {
    SHIPPED.iter().map(|(file, text)| {
        let title = text.lines().find_map(|line| toml::from_str::<Titled>(line).ok());
        (name_of(file), title.map_or(String::new(), |titled| titled.title))
    })
}

/// The first key of a study.
#[derive(serde::Deserialize)]
struct Titled {
    title: String,
}

/// Every shipped study.
pub fn shipped_studies() -> Vec<StudySource> {
    SHIPPED.iter().map(source).collect()
}

fn source((file, text): &(&str, &str)) -> StudySource {
    StudySource { name: (*file).to_owned(), text: (*text).to_owned() }
}

/// Longest name, bytes: file systems take 255, and what is made of a name puts more around it.
const LONGEST: usize = 100;
/// Names of parts of the report, the golden values and the tables.
const TAKEN: [&str; 6] = ["findings", "survival", "how", "profiles", "history", "columns"];

/// Name of a study by its file: without folders and extension, in lower case, with `-` for blanks.
pub fn name_of(file: &str) -> String {
    let file = file.rsplit(['/', '\\']).next().unwrap_or_default();
    let name = file.strip_suffix(".toml").unwrap_or(file).to_ascii_lowercase();
    if !name.contains(' ') {
        return name;
    }
    let words = name.split(' ').map(|word| word.trim_matches('-')).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

/// Why a name cannot be that of a study that is kept; none where it can.
///
/// Plain names only: they become folders, files and anchors, on file systems that know upper from lower case and
/// on those that do not.
pub fn refused_name(name: &str) -> Option<String> {
    let is_inner = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    let is_plain = name.starts_with(|first: char| first.is_ascii_lowercase() || first.is_ascii_digit())
        && name.ends_with(is_inner)
        && name.chars().all(|letter| is_inner(letter) || ".-".contains(letter))
        && !name.contains("--");
    if !is_plain {
        return Some(
            "use letters and digits, with single `-`, `_` or `.` between them, like `mesh-2.toml`".to_owned(),
        );
    }
    if name.len() > LONGEST {
        return Some(format!("it has {} letters: {LONGEST} are the maximum", name.len()));
    }
    TAKEN
        .contains(&name)
        .then(|| format!("`{name}` is reserved for the report, the golden values or the tables"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::method_words::parts;
    use crate::study::check::Study;
    use oedometer_problem::method::Method;
    use std::collections::BTreeSet;

    #[test]
    fn every_study_in_the_folder_ships() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
        for entry in std::fs::read_dir(folder).expect("studies/") {
            let entry = entry.expect("an entry");
            // Studies of other people's solvers need files beside them, and programs that are not here.
            if entry.path().is_dir() {
                continue;
            }
            let file = entry.file_name().into_string().expect("a name");
            let name = format!("studies/{file}");
            assert!(SHIPPED.iter().any(|(shipped, _)| *shipped == name), "{name} is not in SHIPPED");
        }
    }

    /// A method that is neither published nor shown in a study has no place in the program.
    #[test]
    fn every_part_of_a_method_has_a_source_or_a_study() {
        let studied: BTreeSet<(&str, &str)> = shipped_studies()
            .iter()
            .flat_map(|source| Study::check(source).expect("sound").planned)
            .filter_map(|planned| planned.case.method.built_in())
            .flat_map(|method| parts(&method))
            .map(|part| (part.choice, part.word))
            .collect();
        for name in Method::names() {
            for part in parts(&Method::named(&name).expect("a method")) {
                let is_published = !["", "this program"].contains(&part.source);
                let is_studied = studied.contains(&(part.choice, part.word));
                assert!(is_published || is_studied, "{name}: {} {}", part.choice, part.word);
            }
        }
    }

    #[test]
    fn the_titles_are_those_of_the_checked_studies() {
        for ((name, title), source) in shipped_titles().zip(shipped_studies()).step_by(9) {
            let study = Study::check(&source).expect("sound");
            assert_eq!((name, title), (study.name, study.title));
        }
    }

    #[test]
    fn a_name_is_the_file_without_folders_and_extension() {
        assert_eq!(name_of("studies/a.b.toml"), "a.b");
        assert_eq!(name_of("c:\\studies\\mesh.toml"), "mesh");
        assert_eq!(name_of("Results/My  Study - 2.toml"), "my-study-2");
        assert_eq!(name_of("..toml"), ".");
        assert_eq!(name_of("...toml"), "..");
        assert_eq!(name_of("/dev/stdin"), "stdin");
    }

    #[test]
    fn plain_names_are_taken_and_others_refused() {
        for name in ["terzaghi-mesh", "a", "63", "v1.2_b"] {
            assert_eq!(refused_name(name), None, "{name}");
        }
        let plain = "use letters and digits, with single `-`, `_` or `.` between them, like `mesh-2.toml`";
        let others = [
            "", ".", "..", ".hidden", "-a", "a-", "a.", "MyStudy", "ä", "a b", "a/b", "a\\b", "a\n", "a--b",
            "con:", "_a", "a-.b--c",
        ];
        for name in others {
            assert_eq!(refused_name(name).as_deref(), Some(plain), "{name}");
        }
        assert_eq!(refused_name(&"a".repeat(100)), None);
        assert_eq!(
            refused_name(&"a".repeat(101)).as_deref(),
            Some("it has 101 letters: 100 are the maximum")
        );
        for name in ["findings", "survival", "how", "profiles", "history", "columns"] {
            let why = format!("`{name}` is reserved for the report, the golden values or the tables");
            assert_eq!(refused_name(name), Some(why));
            assert_eq!(refused_name(&format!("{name}2")), None);
        }
    }
}
