//! The definition of a scene: one table per scene, each in its own file.

use crate::column::Column;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::problem::{Start, Strain};
use oedometer_soil::material::Material;

/// A scene as data and a few functions.
pub struct SceneDefinition {
    /// Description in one line.
    pub summary: &'static str,
    /// References that hold, the one whose equations the solver solves first.
    pub references: &'static [ReferenceKind],
    /// Why a reference is not the scene's own, where it is a second one.
    pub model_difference: fn(ReferenceKind, &Material) -> Option<&'static str>,
    /// Kind of body: whether a study describes it in the table of a column or of a layer.
    pub body: SceneBody,
    /// Size of the strains that its theory holds for.
    pub strain: Strain,
    /// Load on the surface.
    pub load: SceneLoad,
    /// Whether waves run in it.
    pub has_waves: bool,
    /// State from which it starts.
    pub start: SceneStart,
    /// Pore pressure at the start, written out independently of the solver.
    pub start_pressure: StartPressure,
}

impl SceneDefinition {
    /// A column without load, at rest and at small strain. A scene names how it differs from this or from
    /// [`LOADED`](Self::LOADED).
    pub(crate) const UNLOADED: Self = Self {
        summary: "",
        references: &[],
        model_difference: |_, _| None,
        body: SceneBody::Column,
        strain: Strain::Small,
        load: SceneLoad::None,
        has_waves: false,
        start: SceneStart::OverDepth(|_, _| Ok(Start::unloaded())),
        start_pressure: StartPressure::Uniform(|_, _| 0.0),
    };
    /// The same column under a sudden load, from the undrained equilibrium of its own operators.
    pub(crate) const LOADED: Self = Self {
        load: SceneLoad::Sudden,
        start: SceneStart::Solved,
        start_pressure: StartPressure::OfReference,
        ..Self::UNLOADED
    };
}

/// The body of soil.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SceneBody {
    /// A column, in one dimension or in two.
    Column,
    /// A plane layer, in two dimensions only; its soils show locking.
    Layer,
    /// A slab between two rigid plates, in two dimensions only; its fields vary as a column's do.
    Slab,
    /// A plane layer, in two dimensions only, whose cells are counted over the plate on it.
    Footing,
    /// A square between rollers on all sides, in two dimensions only, whose motion is chosen.
    Square,
}

/// Load on the surface.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SceneLoad {
    /// None.
    None,
    /// Uniform, at once.
    Sudden,
    /// Uniform, at once or growing over a time, for which these references hold.
    SuddenOrGrowing(&'static [ReferenceKind]),
    /// Uniform, at once, by rigid plates across the body: its surface is free.
    Plates,
    /// At once, a cosine along the surface: its mean is zero.
    Cosine,
}

/// Origin of the points' state at the start.
pub enum SceneStart {
    /// A function of the depth.
    OverDepth(fn(&Column, &Material) -> Result<Start, ExactError>),
    /// The undrained equilibrium that the body finds by its own operators.
    Solved,
}

/// Pore pressure expected at the start.
pub enum StartPressure {
    /// A uniform pressure, Pa.
    Uniform(fn(&Column, &Material) -> f64),
    /// Its mean is zero, and nothing else is known.
    ZeroMean,
    /// The pressure of the scene's own reference.
    OfReference,
}
