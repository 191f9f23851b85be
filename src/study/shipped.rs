//! The studies that ship, inside the program: it makes its report wherever it is run.

use crate::study::file::StudySource;
use crate::study::name::name_of;

/// The studies by their names, each with its text.
macro_rules! shipped {
    ($($name:literal)+) => {
        &[$((concat!("studies/", $name, ".toml"), include_str!(concat!("../../studies/", $name, ".toml")))),+]
    };
}

/// The names in the order of the report, and the texts.
const SHIPPED: &[(&str, &str)] = shipped! {
    "terzaghi-mesh" "terzaghi-floor" "terzaghi-points" "terzaghi-time-step" "step-control"
    "value-uncertainty" "terzaghi-methods" "terzaghi-integrators" "any-soil" "any-column" "jittered-points" "work-precision" "terzaghi-moving"
    "single-mode" "dynamic-column" "dynamic-ramp" "dynamic-growth" "dynamic-mode" "standing-wave-mesh"
    "standing-wave-step" "column-in-the-plane" "column-in-the-plane-steps" "layer-locking" "layer-mesh"
    "layer-smooth" "mandel" "self-weight" "self-weight-large" "self-weight-options" "self-weight-plane"
    "self-weight-waves" "at-rest" "stability-conductivity" "stability-stiffness" "stability-porosity" "stability-points"
    "stability-offset" "stability-flip" "stability-slow-growth" "hard-undrained" "hard-stiff-water"
    "hard-tiny-porosity" "hard-large-porosity" "hard-one-point" "hard-faces" "hard-jitter" "hard-empty-top"
    "hard-tiny" "hard-huge" "hard-early" "hard-strain" "hard-long" "large-strain-column" "large-strain-mesh"
    "large-strain-explicit" "large-strain-implicit" "large-strain-integrators" "large-strain-models"
    "large-strain-points" "large-strain-crossing" "large-strain-plane" "large-strain-small"
    "large-strain-half" "large-strain-start" "large-strain-chord" "large-strain-chord-plane" "large-strain-ramp" "large-strain-ramp-half"
    "large-strain-ramp-steps" "large-strain-limit" "nodal-pressure" "large-strain-nodal" "two-layers"
    "two-layers-large-strain" "two-layers-plane" "stability-layers" "manufactured-box" "manufactured-shear"
    "manufactured-vortex" "map"
};

/// The shipped study of a name.
pub fn shipped_study(name: &str) -> Option<StudySource> {
    shipped_studies().into_iter().find(|source| name_of(&source.name) == name)
}

/// The names of the shipped studies.
pub fn shipped_names() -> Vec<String> {
    shipped_studies().iter().map(|source| name_of(&source.name).to_owned()).collect()
}

/// Every shipped study.
pub fn shipped_studies() -> Vec<StudySource> {
    let study =
        |(name, text): &(&str, &str)| StudySource { name: (*name).to_owned(), text: (*text).to_owned() };
    SHIPPED.iter().map(study).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
