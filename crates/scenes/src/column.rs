//! Geometry and load of the body of soil that a scene is about.

use oedometer_exact::parameters::ColumnParameters;
use oedometer_problem::arrangement::{Arrangement, is_single_set, single_set};
use oedometer_soil::base::{Base, Drainage};
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;
use oedometer_soil::motion::MotionParameters;
use oedometer_wording::{is_default, words};
use serde::{Deserialize, Serialize};

/// Geometry and load of a column, or of another body that drains at its top.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Column {
    /// Initial height `H`, m.
    pub height: f64,
    /// Kind of the body, with the inputs of that kind.
    #[serde(flatten)]
    #[schemars(with = "ShapeKeys")]
    pub shape: Shape,
    /// Load `q` on the surface, Pa; the amplitude of the initial pressure in scenes without a load.
    pub load: f64,
    /// Directions that are solved, 1 or 2. Left out of the identity of a case where it is 1: older
    /// records keep theirs.
    #[serde(default = "single_set", skip_serializing_if = "is_single_set")]
    pub dimensions: usize,
    /// Time over which the load grows linearly, s; 0 where it acts at once.
    #[serde(default, skip_serializing_if = "is_default")]
    pub loading_time: f64,
    /// Whether skeleton and water have a weight, under a water level that stands in the surface at the start.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub self_weight: bool,
    /// Which ends let the water out.
    #[serde(default, skip_serializing_if = "is_default")]
    pub drainage: Drainage,
    /// Where the points lie in their cells.
    #[serde(default, skip_serializing_if = "is_default")]
    pub points: Arrangement,
    /// Layers of soil from the base up, where they are of several kinds.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(with = "Vec<SoilLayer>")]
    pub soils: SoilLayers,
    /// Vertical effective stress of the start, compression positive, Pa, that other stresses are counted from.
    #[serde(default, skip_serializing_if = "is_default")]
    pub initial_stress: f64,
    /// Plate that is pushed into a layer.
    #[serde(default, skip_serializing_if = "is_default")]
    pub footing: Footing,
}

/// A rigid strip footing on a layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Footing {
    /// Width `B`, m, half of which lies on the layer that is solved; 0 where there is no plate.
    pub width: f64,
    /// Whether the soil sticks to it.
    pub contact: Base,
    /// Model of the undrained soil below.
    pub undrained: Undrained,
}

impl Footing {
    /// Whether there is no plate.
    fn is_none(&self) -> bool {
        self.width == 0.0
    }
}

/// Model of an undrained soil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Undrained {
    /// One phase of total stress, whose Poisson's ratio is near ½.
    #[default]
    TotalStress,
    /// Skeleton and water, which does not leave.
    TwoPhase,
}

words!(Undrained: TotalStress "total-stress", TwoPhase "two-phase");

/// A kind of body with its own inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Shape {
    /// A plane layer.
    Layer {
        /// Length, m.
        length: f64,
        /// Contact with the base.
        base: Base,
    },
    /// The unit square in a prescribed motion.
    Square {
        /// Amplitudes and frequency of the motion.
        motion: MotionParameters,
        /// Amplitude of the prescribed pressure, Pa.
        pressure: f64,
    },
    /// A column, or half of a slab on its side.
    Column {
        /// Width in two dimensions, m.
        width: f64,
    },
}

/// The keys of every shape, for the schema.
#[derive(schemars::JsonSchema)]
#[expect(dead_code, reason = "only its schema is used")]
struct ShapeKeys {
    /// Width of a column in two dimensions, m.
    width: Option<f64>,
    /// Length of a layer, m.
    length: Option<f64>,
    /// Contact of a layer with its base.
    base: Option<Base>,
    /// Prescribed motion of a square.
    motion: Option<MotionParameters>,
    /// Amplitude of the prescribed pressure of a square, Pa.
    pressure: Option<f64>,
}

/// Share of a cell by which a width may miss a whole number of cells.
const WIDTH_TOLERANCE: f64 = 1e-9;

impl Default for Column {
    /// The seed column under 1 Pa, in one dimension.
    fn default() -> Self {
        Self {
            height: 1.0,
            shape: Shape::Column { width: 0.1 },
            load: 1.0,
            dimensions: 1,
            loading_time: 0.0,
            self_weight: false,
            drainage: Drainage::Top,
            points: Arrangement::default(),
            soils: SoilLayers::default(),
            initial_stress: 0.0,
            footing: Footing::default(),
        }
    }
}

impl Column {
    /// The seed layer: as long as it is high, on a rough base.
    pub fn layer() -> Self {
        Self { shape: Shape::Layer { length: 1.0, base: Base::Rough }, dimensions: 2, ..Self::default() }
    }

    /// The seed slab, on its side: its half width stands as a column's height, and half the distance of its
    /// plates is the width.
    pub fn slab() -> Self {
        Self { dimensions: 2, ..Self::default() }
    }

    /// The layer under half of a footing of 1 m: 2.5 m long and 2 m deep.
    pub fn under_footing() -> Self {
        Self {
            height: 2.0,
            load: 1e4,
            footing: Footing { width: 1.0, ..Footing::default() },
            ..Self::layer().with_extent(2.5)
        }
    }

    /// The body with another width or length, m; a square stays as it is.
    #[must_use]
    pub fn with_extent(mut self, extent: f64) -> Self {
        match &mut self.shape {
            Shape::Column { width: side } | Shape::Layer { length: side, .. } => *side = extent,
            Shape::Square { .. } => {}
        }
        self
    }

    /// Horizontal extent, m: the width of a column, the length of a layer.
    pub fn extent(&self) -> f64 {
        match self.shape {
            Shape::Column { width: side } | Shape::Layer { length: side, .. } => side,
            Shape::Square { .. } => 1.0,
        }
    }

    /// Pressure, Pa, by which pressures and stresses are measured: the load, or the prescribed pressure of a square.
    pub fn pressure_scale(&self) -> f64 {
        match self.shape {
            Shape::Square { pressure, .. } => pressure,
            Shape::Column { .. } | Shape::Layer { .. } => self.load,
        }
    }

    /// Contact of a layer with its base.
    pub fn base(&self) -> Option<Base> {
        if let Shape::Layer { base, .. } = self.shape { Some(base) } else { None }
    }

    /// Cell size, m, with `cells` cells over the height, or wholly under a footing: its edges lie half a cell beyond its
    /// outermost nodes, in the middle of the way on which the surface leaves it.
    pub fn cell_size(&self, cells: usize) -> f64 {
        if self.footing.is_none() {
            // A top cell that is filled in part makes every cell larger.
            self.points.cell_size(self.height, cells)
        } else {
            self.footing.width / (cells + 1) as f64
        }
    }

    /// Square cells over the width with `cells` over the height; `None` where they do not fill it. One dimension has one. A
    /// layer under a footing is at least as long as it is said to be.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
    pub fn cells_across(&self, cells: usize) -> Option<usize> {
        if self.dimensions == 1 {
            return Some(1);
        }
        let across = self.extent() / self.cell_size(cells);
        if !self.footing.is_none() {
            return Some(cells_within(across));
        }
        let columns = across.round();
        (columns >= 1.0 && (across - columns).abs() <= WIDTH_TOLERANCE * columns).then_some(columns as usize)
    }

    /// Cells over the height; a layer under a footing is at least as deep as it is said to be.
    pub fn cells_up(&self, cells: usize) -> usize {
        if self.footing.is_none() { cells } else { cells_within(self.height / self.cell_size(cells)) }
    }

    /// Volume of the soil, m^D, on so many cells.
    pub fn volume(&self, cells: usize) -> f64 {
        if self.footing.is_none() {
            return if self.dimensions == 1 { self.height } else { self.height * self.extent() };
        }
        let size = self.cell_size(cells);
        size * size * (self.cells_across(cells).unwrap_or(1) * self.cells_up(cells)) as f64
    }
}

/// Whole cells that hold a length in cells.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
fn cells_within(length: f64) -> usize {
    (length * (1.0 - WIDTH_TOLERANCE)).ceil() as usize
}

/// The column as the exact solutions take it.
pub fn column_parameters(column: &Column, soil: &Material) -> ColumnParameters {
    ColumnParameters {
        height: column.height,
        load: column.pressure_scale(),
        soil: *soil,
        length: column.extent(),
        base: column.base().unwrap_or_default(),
        loading_time: column.loading_time,
        self_weight: column.self_weight,
        drainage: column.drainage,
        motion: match column.shape {
            Shape::Square { motion, .. } => motion,
            Shape::Column { .. } | Shape::Layer { .. } => MotionParameters::default(),
        },
        soils: column.soils,
        uniform_stress: column.initial_stress,
        plate_width: column.footing.width,
        ..ColumnParameters::default()
    }
}
