//! The slowest mode of an unloaded column, with the inertia that it has.

use crate::scene::definition::{SceneDefinition, SceneStart, StartPressure};
use crate::scene::single_mode::mode_without_inertia;
use oedometer_exact::reference::ReferenceKind;

pub(crate) static DYNAMIC_SINGLE_MODE: SceneDefinition = SceneDefinition {
    summary: "slowest consolidation mode with its inertia, no load: smooth",
    references: &[ReferenceKind::DynamicSingleMode, ReferenceKind::SingleMode],
    model_difference: |reference, _| (reference == ReferenceKind::SingleMode).then_some("the inertia"),
    has_waves: true,
    start: SceneStart::OverDepth(mode_without_inertia),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};
