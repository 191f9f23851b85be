//! The layers of a column, from the base up.

use crate::material::Material;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// Most layers of a column.
pub const MOST_LAYERS: usize = 8;

/// Share of a column's height by which its layers may miss it: thicknesses are typed in decimals.
const GAP: f64 = 1e-9;

/// A layer of soil: its thickness, and what of its soil differs from that of the column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoilLayer {
    /// Thickness, m; those of all layers add up to the height of the column.
    pub thickness: f64,
    /// Young's modulus of the skeleton, Pa.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio of the skeleton.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poissons_ratio: Option<f64>,
    /// Porosity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub porosity: Option<f64>,
    /// Bulk modulus of the water, Pa.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub water_bulk_modulus: Option<f64>,
    /// Hydraulic conductivity, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hydraulic_conductivity: Option<f64>,
}

impl SoilLayer {
    /// Soil of the layer, with the values of the column's soil for those that the layer does not set.
    pub fn soil(&self, column_soil: &Material) -> Material {
        Material {
            youngs_modulus: self.youngs_modulus.unwrap_or(column_soil.youngs_modulus),
            poissons_ratio: self.poissons_ratio.unwrap_or(column_soil.poissons_ratio),
            porosity: self.porosity.unwrap_or(column_soil.porosity),
            water_bulk_modulus: self.water_bulk_modulus.unwrap_or(column_soil.water_bulk_modulus),
            hydraulic_conductivity: self.hydraulic_conductivity.unwrap_or(column_soil.hydraulic_conductivity),
            ..*column_soil
        }
    }
}

/// The layers of a column, as plain data; empty for a homogeneous column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "Vec<SoilLayer>", try_from = "Vec<SoilLayer>")]
pub struct SoilLayers {
    count: usize,
    layers: [SoilLayer; MOST_LAYERS],
}

impl SoilLayers {
    /// The layers of a slice, from the base up; `None` if there are more than [`MOST_LAYERS`].
    pub fn from_slice(list: &[SoilLayer]) -> Option<Self> {
        let mut layers = Self { count: list.len(), ..Self::default() };
        layers.layers.get_mut(..list.len())?.copy_from_slice(list);
        Some(layers)
    }

    /// Sum of the thicknesses, m, if it differs from the height of a column.
    pub fn misses(&self, height: f64) -> Option<f64> {
        let sum: f64 = self.iter().map(|layer| layer.thickness).sum();
        let fills = self.is_empty() || (sum - height).abs() <= GAP * height;
        (!fills).then_some(sum)
    }

    /// Index of the layer at a height, m, over the base; of the lower layer on an interface.
    pub fn number_at(&self, height: f64) -> usize {
        let mut top = 0.0;
        let below = |layer: &&SoilLayer| {
            top += layer.thickness;
            height > top * (1.0 + GAP)
        };
        self.iter().take_while(below).count().min(self.len().saturating_sub(1))
    }
}

impl Deref for SoilLayers {
    type Target = [SoilLayer];
    fn deref(&self) -> &[SoilLayer] {
        &self.layers[..self.count]
    }
}

impl From<SoilLayers> for Vec<SoilLayer> {
    fn from(layers: SoilLayers) -> Self {
        layers.to_vec()
    }
}

/// More layers of soil than a column may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} layers of soil: {MOST_LAYERS} are the most")]
pub struct TooManyLayers(pub usize);

impl TryFrom<Vec<SoilLayer>> for SoilLayers {
    type Error = TooManyLayers;
    fn try_from(list: Vec<SoilLayer>) -> Result<Self, TooManyLayers> {
        Self::from_slice(&list).ok_or(TooManyLayers(list.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_belongs_to_the_layer_that_holds_it() {
        let layer = |thickness: f64| SoilLayer { thickness, ..SoilLayer::default() };
        let layers = SoilLayers::from_slice(&[layer(0.3), layer(0.4), layer(0.3)]).expect("three are few");
        for (height, number) in [(0.0, 0), (0.3, 0), (0.31, 1), (0.7, 1), (0.71, 2), (1.0, 2), (1.1, 2)] {
            assert_eq!(layers.number_at(height), number, "{height}");
        }
        assert_eq!((layers.misses(1.0), layers.misses(1.5)), (None, Some(1.0)));
        assert!(SoilLayers::from_slice(&[layer(0.1); 9]).is_none());
    }

    #[test]
    fn a_layer_has_each_value_of_its_own_and_all_others_of_the_column() {
        let column = Material::default();
        let values = |soil: &Material| {
            [
                soil.youngs_modulus,
                soil.poissons_ratio,
                soil.porosity,
                soil.water_bulk_modulus,
                soil.hydraulic_conductivity,
            ]
        };
        let overrides = [7e6, 0.21, 0.37, 5e7, 3e-6];
        // Bit `i` of the number says whether the layer has the value `i`.
        for number in 0..32_usize {
            let has = |place: usize| (number >> place & 1 == 1).then_some(overrides[place]);
            let layer = SoilLayer {
                thickness: 0.5,
                youngs_modulus: has(0),
                poissons_ratio: has(1),
                porosity: has(2),
                water_bulk_modulus: has(3),
                hydraulic_conductivity: has(4),
            };
            let wanted: [f64; 5] = std::array::from_fn(|place| has(place).unwrap_or(values(&column)[place]));
            assert_eq!(values(&layer.soil(&column)), wanted, "{layer:?}");
        }
    }
}
