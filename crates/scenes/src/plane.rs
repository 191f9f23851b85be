//! Scenes of a layer or a slab in the plane; `manufactured` has those of a square.

use crate::definition::{SceneBody, SceneDefinition, SceneLoad, StartPressure};
use oedometer_exact::reference::ReferenceKind;

/// A plane layer loaded at once by a cosine and drained at its top, at small strain, from the undrained
/// equilibrium.
pub(super) static COSINE_LAYER: SceneDefinition = SceneDefinition {
    summary: "plane layer under a cosine load, drained at its top: where locking shows",
    references: &[ReferenceKind::CosineLayer, ReferenceKind::CosineLayerIncompressible],
    model_difference: |reference, _| {
        (reference == ReferenceKind::CosineLayerIncompressible).then_some("the water's storage")
    },
    body: SceneBody::Layer,
    load: SceneLoad::Cosine,
    // Of a cosine only the mean is known.
    start_pressure: StartPressure::ZeroMean,
    ..SceneDefinition::LOADED
};

/// Mandel's problem: a slab loaded at once between rigid plates and drained at its sides, at small strain, from
/// the undrained equilibrium.
///
/// A quarter of it, on its side: the base of a column is the middle of the slab and its drained surface the
/// slab's drained side, so that `cells` count over the half width `a` and `ζ` runs from the drained side to the
/// middle; the plate presses across, at half the distance of the plates. The settlement is the plate's.
pub(super) static MANDEL: SceneDefinition = SceneDefinition {
    summary: "slab between rigid plates, drained at its sides: the pressure in its middle rises before it falls",
    references: &[ReferenceKind::Mandel],
    body: SceneBody::Slab,
    load: SceneLoad::Plates,
    // Skempton's: of the mean total stress of an undrained body in plane strain, (1 + ν_u) q/3, the water takes
    // the share B. Written out here, and not taken from the solver or the reference: this is the check.
    start_pressure: StartPressure::Uniform(|column, soil| {
        let (nu, stiffness) = (soil.poissons_ratio, soil.youngs_modulus);
        let bulk = stiffness / (3.0 * (1.0 - 2.0 * nu));
        let coupling = soil.coupling_modulus();
        let share = coupling / (bulk + coupling);
        let shear = stiffness / (2.0 * (1.0 + nu));
        let undrained_bulk = bulk + coupling;
        let undrained_nu = (3.0 * undrained_bulk - 2.0 * shear) / (2.0 * (3.0 * undrained_bulk + shear));
        column.load * share * (1.0 + undrained_nu) / 3.0
    }),
    ..SceneDefinition::LOADED
};

/// A rigid strip footing that is pushed into undrained soil: half of it by symmetry, at small strain, from rest.
///
/// The plate settles by its own width in the time of `T_v = 1`, so that time factors are settlements over the width; the
/// soil is without inertia, and how fast it goes makes no difference.
pub(super) static FOOTING: SceneDefinition = SceneDefinition {
    summary: "strip footing on undrained soil that yields: its collapse load reveals locking",
    references: &[ReferenceKind::Footing],
    body: SceneBody::Footing,
    ..SceneDefinition::UNLOADED
};
