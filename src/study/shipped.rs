//! The studies that ship, inside the program: it makes its report wherever it is run.

use super::file::StudySource;

/// Every shipped study, in the order of the report.
pub fn shipped_studies() -> Vec<StudySource> {
    const SHIPPED: &[(&str, &str)] = &[
        ("studies/terzaghi-mesh.toml", include_str!("../../studies/terzaghi-mesh.toml")),
        ("studies/terzaghi-floor.toml", include_str!("../../studies/terzaghi-floor.toml")),
        ("studies/terzaghi-points.toml", include_str!("../../studies/terzaghi-points.toml")),
        ("studies/terzaghi-time-step.toml", include_str!("../../studies/terzaghi-time-step.toml")),
        ("studies/terzaghi-methods.toml", include_str!("../../studies/terzaghi-methods.toml")),
        ("studies/terzaghi-integrators.toml", include_str!("../../studies/terzaghi-integrators.toml")),
        ("studies/work-precision.toml", include_str!("../../studies/work-precision.toml")),
        ("studies/terzaghi-moving.toml", include_str!("../../studies/terzaghi-moving.toml")),
        ("studies/single-mode.toml", include_str!("../../studies/single-mode.toml")),
        ("studies/dynamic-column.toml", include_str!("../../studies/dynamic-column.toml")),
        ("studies/dynamic-ramp.toml", include_str!("../../studies/dynamic-ramp.toml")),
        ("studies/dynamic-mode.toml", include_str!("../../studies/dynamic-mode.toml")),
        ("studies/standing-wave-mesh.toml", include_str!("../../studies/standing-wave-mesh.toml")),
        ("studies/standing-wave-step.toml", include_str!("../../studies/standing-wave-step.toml")),
        ("studies/large-strain-mesh.toml", include_str!("../../studies/large-strain-mesh.toml")),
        ("studies/large-strain-implicit.toml", include_str!("../../studies/large-strain-implicit.toml")),
        ("studies/large-strain-models.toml", include_str!("../../studies/large-strain-models.toml")),
        ("studies/large-strain-points.toml", include_str!("../../studies/large-strain-points.toml")),
    ];
    SHIPPED
        .iter()
        .map(|(name, text)| StudySource { name: (*name).to_owned(), text: (*text).to_owned() })
        .collect()
}
