//! The studies that ship, inside the program: it makes its report wherever it is run.

use crate::study::file::StudySource;

/// Every shipped study, in the order of the report.
pub fn shipped_studies() -> Vec<StudySource> {
    const SHIPPED: &[(&str, &str)] = &[
        ("studies/terzaghi-mesh.toml", include_str!("../../studies/terzaghi-mesh.toml")),
        ("studies/terzaghi-floor.toml", include_str!("../../studies/terzaghi-floor.toml")),
        ("studies/terzaghi-points.toml", include_str!("../../studies/terzaghi-points.toml")),
        ("studies/terzaghi-time-step.toml", include_str!("../../studies/terzaghi-time-step.toml")),
        ("studies/step-control.toml", include_str!("../../studies/step-control.toml")),
        ("studies/value-uncertainty.toml", include_str!("../../studies/value-uncertainty.toml")),
        ("studies/terzaghi-methods.toml", include_str!("../../studies/terzaghi-methods.toml")),
        ("studies/terzaghi-integrators.toml", include_str!("../../studies/terzaghi-integrators.toml")),
        ("studies/work-precision.toml", include_str!("../../studies/work-precision.toml")),
        ("studies/terzaghi-moving.toml", include_str!("../../studies/terzaghi-moving.toml")),
        ("studies/single-mode.toml", include_str!("../../studies/single-mode.toml")),
        ("studies/dynamic-column.toml", include_str!("../../studies/dynamic-column.toml")),
        ("studies/dynamic-ramp.toml", include_str!("../../studies/dynamic-ramp.toml")),
        ("studies/dynamic-growth.toml", include_str!("../../studies/dynamic-growth.toml")),
        ("studies/dynamic-mode.toml", include_str!("../../studies/dynamic-mode.toml")),
        ("studies/standing-wave-mesh.toml", include_str!("../../studies/standing-wave-mesh.toml")),
        ("studies/standing-wave-step.toml", include_str!("../../studies/standing-wave-step.toml")),
        ("studies/column-in-the-plane.toml", include_str!("../../studies/column-in-the-plane.toml")),
        (
            "studies/column-in-the-plane-steps.toml",
            include_str!("../../studies/column-in-the-plane-steps.toml"),
        ),
        ("studies/layer-locking.toml", include_str!("../../studies/layer-locking.toml")),
        ("studies/layer-mesh.toml", include_str!("../../studies/layer-mesh.toml")),
        ("studies/layer-smooth.toml", include_str!("../../studies/layer-smooth.toml")),
        ("studies/stability-conductivity.toml", include_str!("../../studies/stability-conductivity.toml")),
        ("studies/stability-stiffness.toml", include_str!("../../studies/stability-stiffness.toml")),
        ("studies/stability-porosity.toml", include_str!("../../studies/stability-porosity.toml")),
        ("studies/stability-points.toml", include_str!("../../studies/stability-points.toml")),
        ("studies/stability-offset.toml", include_str!("../../studies/stability-offset.toml")),
        ("studies/stability-flip.toml", include_str!("../../studies/stability-flip.toml")),
        ("studies/stability-slow-growth.toml", include_str!("../../studies/stability-slow-growth.toml")),
        ("studies/hard-undrained.toml", include_str!("../../studies/hard-undrained.toml")),
        ("studies/hard-stiff-water.toml", include_str!("../../studies/hard-stiff-water.toml")),
        ("studies/hard-tiny-porosity.toml", include_str!("../../studies/hard-tiny-porosity.toml")),
        ("studies/hard-large-porosity.toml", include_str!("../../studies/hard-large-porosity.toml")),
        ("studies/hard-one-point.toml", include_str!("../../studies/hard-one-point.toml")),
        ("studies/hard-faces.toml", include_str!("../../studies/hard-faces.toml")),
        ("studies/hard-jitter.toml", include_str!("../../studies/hard-jitter.toml")),
        ("studies/hard-empty-top.toml", include_str!("../../studies/hard-empty-top.toml")),
        ("studies/hard-tiny.toml", include_str!("../../studies/hard-tiny.toml")),
        ("studies/hard-huge.toml", include_str!("../../studies/hard-huge.toml")),
        ("studies/hard-early.toml", include_str!("../../studies/hard-early.toml")),
        ("studies/hard-strain.toml", include_str!("../../studies/hard-strain.toml")),
        ("studies/hard-long.toml", include_str!("../../studies/hard-long.toml")),
        ("studies/large-strain-column.toml", include_str!("../../studies/large-strain-column.toml")),
        ("studies/large-strain-mesh.toml", include_str!("../../studies/large-strain-mesh.toml")),
        ("studies/large-strain-explicit.toml", include_str!("../../studies/large-strain-explicit.toml")),
        ("studies/large-strain-implicit.toml", include_str!("../../studies/large-strain-implicit.toml")),
        (
            "studies/large-strain-integrators.toml",
            include_str!("../../studies/large-strain-integrators.toml"),
        ),
        ("studies/large-strain-models.toml", include_str!("../../studies/large-strain-models.toml")),
        ("studies/large-strain-points.toml", include_str!("../../studies/large-strain-points.toml")),
        ("studies/large-strain-crossing.toml", include_str!("../../studies/large-strain-crossing.toml")),
        ("studies/large-strain-plane.toml", include_str!("../../studies/large-strain-plane.toml")),
        ("studies/large-strain-small.toml", include_str!("../../studies/large-strain-small.toml")),
        ("studies/large-strain-half.toml", include_str!("../../studies/large-strain-half.toml")),
        ("studies/large-strain-start.toml", include_str!("../../studies/large-strain-start.toml")),
        ("studies/large-strain-ramp.toml", include_str!("../../studies/large-strain-ramp.toml")),
        ("studies/large-strain-ramp-half.toml", include_str!("../../studies/large-strain-ramp-half.toml")),
        ("studies/large-strain-ramp-steps.toml", include_str!("../../studies/large-strain-ramp-steps.toml")),
        ("studies/large-strain-limit.toml", include_str!("../../studies/large-strain-limit.toml")),
    ];
    SHIPPED
        .iter()
        .map(|(name, text)| StudySource { name: (*name).to_owned(), text: (*text).to_owned() })
        .collect()
}
