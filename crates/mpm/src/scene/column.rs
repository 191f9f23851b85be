//! Geometry and load of columns and layers that drain at their top.

use crate::scene::arrangement::Arrangement;
use oedometer_exact::parameters::{Base, ColumnParameters, MotionParameters};
use oedometer_soil::material::Material;
use serde::{Deserialize, Serialize};

/// Geometry and load of a column, or of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Column {
    /// Initial height `H`, m.
    pub height: f64,
    /// Horizontal extent, m: the width of a column in two dimensions, the length of a layer. One dimension
    /// has none.
    #[serde(rename = "width")]
    pub horizontal_extent: f64,
    /// Load `q` on the surface, Pa; the amplitude of the initial pressure where there is no load.
    pub load: f64,
    /// Directions that are solved, 1 or 2. Left out of the identity of a case where it is 1: older
    /// records keep theirs.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub dimensions: usize,
    /// How a layer rests on its base; a column's base has no say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Base>,
    /// Time over which the load grows linearly, s; 0 where it acts at once.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub loading_time: f64,
    /// Whether skeleton and water have a weight, under a water level that stands in the surface at the start.
    #[serde(default, skip_serializing_if = "is_false")]
    pub self_weight: bool,
    /// Where the points lie in their cells.
    #[serde(default, skip_serializing_if = "Arrangement::is_regular")]
    pub points: Arrangement,
    /// How a square moves whose motion is chosen.
    #[serde(default, skip_serializing_if = "MotionParameters::is_none")]
    pub motion: MotionParameters,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_false(value: &bool) -> bool {
    !*value
}

fn one() -> usize {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_one(dimensions: &usize) -> bool {
    *dimensions == 1
}

/// Share of a cell by which a width may miss a whole number of cells.
const WIDTH_TOLERANCE: f64 = 1e-9;

impl Default for Column {
    /// The seed column under 1 Pa, in one dimension.
    fn default() -> Self {
        Self {
            height: 1.0,
            horizontal_extent: 0.1,
            load: 1.0,
            dimensions: 1,
            base: None,
            loading_time: 0.0,
            self_weight: false,
            points: Arrangement::default(),
            motion: MotionParameters::default(),
        }
    }
}

impl Column {
    /// The seed layer: as long as it is high, on a rough base.
    pub fn layer() -> Self {
        Self { horizontal_extent: 1.0, dimensions: 2, base: Some(Base::Rough), ..Self::default() }
    }

    /// The seed slab, on its side: its half width stands as a column's height, and half the distance of its
    /// plates is the width.
    pub fn slab() -> Self {
        Self { dimensions: 2, ..Self::default() }
    }

    /// Square cells over the width with `cells` over the height; `None` where they do not fill it.
    /// One dimension has one.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
    pub fn cells_across(&self, cells: usize) -> Option<usize> {
        if self.dimensions == 1 {
            return Some(1);
        }
        let across = self.horizontal_extent / self.height * cells as f64;
        let whole = across.round();
        (whole >= 1.0 && (across - whole).abs() <= WIDTH_TOLERANCE * whole).then_some(whole as usize)
    }

    /// Volume of the soil, m^D.
    pub fn volume(&self) -> f64 {
        if self.dimensions == 1 { self.height } else { self.height * self.horizontal_extent }
    }
}

/// The column as the exact solutions take it.
pub fn column_parameters(column: &Column, soil: &Material) -> ColumnParameters {
    ColumnParameters {
        height: column.height,
        length: column.horizontal_extent,
        base: column.base.unwrap_or_default(),
        load: column.load,
        youngs_modulus: soil.youngs_modulus,
        poissons_ratio: soil.poissons_ratio,
        porosity: soil.porosity,
        grain_density: soil.grain_density,
        water_density: soil.water_density,
        water_bulk_modulus: soil.water_bulk_modulus,
        hydraulic_conductivity: soil.hydraulic_conductivity,
        gravity: soil.gravity,
        loading_time: column.loading_time,
        self_weight: column.self_weight,
        motion: column.motion,
    }
}
