//! Mandel's problem: a slab loaded at once between rigid plates and drained at its sides, at small strain, from the undrained
//! equilibrium.
//!
//! A quarter of it, on its side: the base of a column is the middle of the slab and its drained surface the slab's drained
//! side, so that `cells` count over the half width `a` and `ζ` runs from the drained side to the middle; the plate presses
//! across, at half the distance of the plates. The settlement is the plate's.

use crate::column::Column;
use crate::limit::PLATE_HOLDS_NODES;
use crate::scene::{Body, LoadKind, Question, Scene, SceneReference, StartPressure};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::material::Material;

/// The scene `mandel`.
pub static MANDEL: Scene = Scene {
    name: "mandel",
    summary: "slab between rigid plates, drained at its sides: the pressure at mid-slab rises before it falls",
    axes: "x is measured from the middle of the slab, without flow or motion along x, to its drained, free \
           side, at `height`; y from the middle between the plates to the plate, at `width`, which is rigid, \
           smooth and impermeable and applies the mean stress `load`; cells are counted along x; the settlement is the plate's",
    question: Question::Locking,
    body: Body::Slab,
    load: LoadKind::Plates,
    column: Column::slab,
    methods: &[PLATE_HOLDS_NODES],
    references: &[SceneReference::own(ReferenceKind::Mandel)],
    start_pressure: StartPressure::Uniform(skempton),
    ..Scene::LOADED
};

/// Skempton's: of the mean total stress of an undrained body in plane strain, `(1 + ν_u) q/3`, the water takes the share B.
/// Written out here, and not taken from the solver or the reference: this is the check.
fn skempton(column: &Column, soil: &Material) -> f64 {
    let (nu, stiffness) = (soil.poissons_ratio, soil.youngs_modulus);
    let bulk = stiffness / (3.0 * (1.0 - 2.0 * nu));
    let coupling = soil.coupling_modulus();
    let share = coupling / (bulk + coupling);
    let shear = stiffness / (2.0 * (1.0 + nu));
    let undrained_bulk = bulk + coupling;
    let undrained_nu = (3.0 * undrained_bulk - 2.0 * shear) / (2.0 * (3.0 * undrained_bulk + shear));
    column.load * share * (1.0 + undrained_nu) / 3.0
}
