//! A rigid strip footing that is pushed into undrained soil: half of it by symmetry, at small strain, from rest.
//!
//! The plate settles by its own width in the time of `T_v = 1`, so that time factors are settlements over the width; the
//! soil is without inertia, and how fast it goes makes no difference.

use crate::scene::definition::{SceneBody, SceneDefinition};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static FOOTING: SceneDefinition = SceneDefinition {
    summary: "strip footing on undrained soil that yields: its load shows what locks",
    references: &[ReferenceKind::Footing],
    body: SceneBody::Footing,
    ..SceneDefinition::UNLOADED
};
