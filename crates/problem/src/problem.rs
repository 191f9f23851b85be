//! A problem to solve: body, soil, load, start and operators, before anything is discretised.

use crate::arrangement::Arrangement;
use crate::forcing::Forcing;
use crate::method::{Configuration, Method};
use oedometer_soil::layers::SoilLayers;
use oedometer_soil::material::Material;
use std::error::Error;
use std::sync::Arc;

/// Why a start has no state at a depth.
pub type StartError = Box<dyn Error + Send + Sync>;
/// State at a relative depth from 0, the surface, to 1, the base.
pub type FieldsOverDepth = Arc<dyn Fn(f64) -> Result<StartFields, StartError> + Send + Sync>;
/// What acts on a body whose points are at initial places, m, at the start.
pub type MakeForcing = Arc<dyn Fn(&[[f64; 2]]) -> Arc<dyn Forcing<2>> + Send + Sync>;

/// A problem of one dimension or of two.
#[derive(Clone)]
pub struct Problem {
    /// Directions that are solved, 1 or 2.
    pub dimensions: usize,
    /// Edge of the square cells, m.
    pub cell_size: f64,
    /// Cells along the body and up.
    pub cells: [usize; 2],
    /// Height of the surface, m: of the whole cells, or less where the top ones are filled in part.
    pub height: f64,
    /// Places of the points in their cells.
    pub points: Arrangement,
    /// Points a cell and direction.
    pub points_per_cell: usize,
    /// Faces that are held.
    pub faces: Faces,
    /// What acts on the body.
    pub load: Load,
    /// Time over which the load grows linearly, s; 0 where it acts at once.
    pub loading_time: f64,
    /// Soil that scales are made of, and that layers differ from.
    pub material: Material,
    /// Layers from the base up; none where the body is of one soil.
    pub layers: SoilLayers,
    /// Vertical effective stress of the start, compression positive, Pa, that other stresses are counted from.
    pub initial_stress: f64,
    /// State at the start.
    pub start: Start,
    /// Size of the strains.
    pub strain: Strain,
    /// Weight of skeleton and water, where they have one.
    pub weight: Option<Weight>,
    /// Body forces and source of water of a motion that was chosen; in two dimensions.
    pub forcing: Option<MakeForcing>,
    /// Pressure, Pa, that the problem is about: what leaves it a thousandfold has blown up.
    pub pressure_scale: f64,
    /// Operators.
    pub method: Method,
}

/// Faces that are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// Rollers at the sides, a smooth base, a free top.
    Oedometer,
    /// The same on a base that lets the water out.
    DrainedBase,
    /// The same on a base that the skeleton sticks to.
    RoughBase,
    /// The same with an upper side that a plate moves.
    MovableSide,
    /// Rollers on every face.
    Closed,
}

/// What acts on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Nothing.
    None,
    /// A pressure on the surface, Pa.
    Uniform(f64),
    /// A pressure on the surface that varies as `cos(πx/L)`.
    Cosine {
        /// Amplitude, Pa.
        amplitude: f64,
        /// Half a wave's length `L`, m.
        length: f64,
    },
    /// Mean pressure, Pa, of a rigid plate on the upper side.
    Plate(f64),
    /// A rigid plate that is pushed into the surface.
    Push {
        /// Its part on the body, m.
        extent: f64,
        /// Velocity, downward positive, m/s.
        velocity: f64,
        /// Whether the soil sticks to it.
        is_rough: bool,
        /// Whether the soil is skeleton and water that stays where it is, and not one phase of total stress.
        has_water: bool,
    },
}

/// Size of strains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strain {
    /// Infinitesimal: nothing moves.
    Small,
    /// Finite.
    Large,
}

impl Strain {
    /// Configuration of the weights where a method leaves it open: small strain moves nothing.
    pub fn configuration(self) -> Configuration {
        match self {
            Self::Small => Configuration::Frozen,
            Self::Large => Configuration::Updated,
        }
    }
}

/// Origin of the points' state at the start.
#[derive(Clone)]
pub enum Start {
    /// Fields over the depth.
    OverDepth {
        /// Vertical displacement gradient that was reached before any water moved.
        gradient: f64,
        /// The fields.
        fields: FieldsOverDepth,
    },
    /// The undrained equilibrium that the body finds by its own operators.
    Undrained,
}

impl Start {
    /// A uniform state at every depth.
    pub fn uniform(gradient: f64, fields: StartFields) -> Self {
        Self::OverDepth { gradient, fields: Arc::new(move |_| Ok(fields)) }
    }

    /// At rest, without stress.
    pub fn unloaded() -> Self {
        Self::uniform(0.0, StartFields::default())
    }
}

/// State at a depth.
#[derive(Clone, Copy, Debug, Default)]
pub struct StartFields {
    /// Pore pressure, Pa.
    pub pressure: f64,
    /// Vertical effective stress, Pa.
    pub vertical_stress: f64,
    /// Lateral effective stress, Pa.
    pub lateral_stress: f64,
    /// Vertical velocity of the skeleton, m/s.
    pub solid_velocity: f64,
    /// Vertical velocity of the water, m/s.
    pub water_velocity: f64,
}

impl StartFields {
    /// The stresses of an oedometer at rest: `ν/(1 − ν)` of the vertical one to the sides.
    pub fn at_rest(soil: &Material, pressure: f64, vertical_stress: f64) -> Self {
        let lateral_stress = soil.poissons_ratio / (1.0 - soil.poissons_ratio) * vertical_stress;
        Self { pressure, vertical_stress, lateral_stress, ..Self::default() }
    }
}

/// The weight of skeleton and water.
#[derive(Clone)]
pub struct Weight {
    /// Gravity, m/s².
    pub gravity: f64,
    /// Vertical effective stress, Pa, that the weight has made at a relative depth before the start.
    pub stress: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
    /// Whether the start is to be in balance with it where points integrate it inexactly.
    pub is_balanced: bool,
}
