//! Problems that `oedometer exact` knows and no scene solves: layered soil, a yield front, a sealed element.
//!
//! Keys and their defaults are those of a study's `[column]` and `[material]`, and the few that these problems add.

use crate::cli::exit::Ended;
use oedometer_exact::layered::LayeredColumn;
use oedometer_exact::yield_front::{YieldFront, YieldingColumn};
use oedometer_exact::{Accuracy, ColumnParameters, ExactError};
use oedometer_soil::material::Material;
use serde::Deserialize;

/// Names of the problems.
pub const NAMES: [&str; 3] = ["layered", "yield-front", "sealed-element"];

/// Share of the height by which layers may miss it: their thicknesses are typed in decimals.
const GAP: f64 = 1e-9;

/// A problem by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A column of layers.
    Layered,
    /// A front of yielding that runs into a column.
    YieldFront,
    /// One undrained element.
    SealedElement,
}

/// The problem of a name.
pub fn named(name: &str) -> Option<Problem> {
    let all = [Problem::Layered, Problem::YieldFront, Problem::SealedElement];
    NAMES.iter().position(|one| *one == name).map(|at| all[at])
}

/// What may be typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Typed {
    column: TypedColumn,
    material: TypedSoil,
}

/// Geometry and load.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TypedColumn {
    height: f64,
    load: f64,
    initial_stress: f64,
    soils: Vec<TypedSoil>,
}

impl Default for TypedColumn {
    fn default() -> Self {
        let ColumnParameters { height, load, .. } = ColumnParameters::default();
        Self { height, load, initial_stress: 0.0, soils: Vec::new() }
    }
}

/// A soil, or what of it differs from `[material]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TypedSoil {
    thickness: Option<f64>,
    law: Option<String>,
    youngs_modulus: Option<f64>,
    poissons_ratio: Option<f64>,
    porosity: Option<f64>,
    water_density: Option<f64>,
    water_bulk_modulus: Option<f64>,
    hydraulic_conductivity: Option<f64>,
    gravity: Option<f64>,
    reload_modulus: Option<f64>,
    preconsolidation: Option<f64>,
}

impl TypedSoil {
    /// The soil, with the values of another where it has none.
    fn over(&self, other: Material) -> Material {
        Material {
            youngs_modulus: self.youngs_modulus.unwrap_or(other.youngs_modulus),
            poissons_ratio: self.poissons_ratio.unwrap_or(other.poissons_ratio),
            porosity: self.porosity.unwrap_or(other.porosity),
            water_density: self.water_density.unwrap_or(other.water_density),
            water_bulk_modulus: self.water_bulk_modulus.unwrap_or(other.water_bulk_modulus),
            hydraulic_conductivity: self.hydraulic_conductivity.unwrap_or(other.hydraulic_conductivity),
            gravity: self.gravity.unwrap_or(other.gravity),
            ..other
        }
    }
}

/// Refuses keys that have no effect in a problem.
fn refuse(keys: &[(&str, bool)], problem: &str) -> anyhow::Result<()> {
    match keys.iter().find(|(_, is_given)| *is_given) {
        Some((key, _)) => Err(Ended::usage(format!("`{key}` has no effect in {problem}: leave it out"))),
        None => Ok(()),
    }
}

/// A solution with what its ratios refer to.
pub struct Solution {
    kind: Kind,
    height: f64,
    load: f64,
    /// Seconds per unit of the time factor, by the coefficient of consolidation of `[material]`.
    seconds: f64,
}

enum Kind {
    Layered(LayeredColumn),
    YieldFront(YieldFront),
    /// Pressure over the load, and settlement over the height.
    SealedElement([f64; 2]),
}

impl Problem {
    /// The solution of typed keys.
    ///
    /// # Errors
    /// A sentence about a key that is unknown, has no effect, is missing or is impossible.
    pub fn of(self, table: toml::Table) -> anyhow::Result<Solution> {
        let typed: Typed =
            table.try_into().map_err(|error: toml::de::Error| Ended::usage(error.message()))?;
        let Typed { column, material } = typed;
        let soil = checked(&material.over(Material::default()), &column)?;
        let yields = [
            ("material.reload_modulus", material.reload_modulus.is_some()),
            ("material.preconsolidation", material.preconsolidation.is_some()),
            ("material.law", material.law.as_deref().is_some_and(|law| law != "linear")),
            ("column.initial_stress", column.initial_stress != 0.0),
        ];
        let layers = [
            ("column.soils", !column.soils.is_empty()),
            ("material.thickness", material.thickness.is_some()),
        ];
        let kind = match self {
            Self::Layered => {
                refuse(&yields, "a layered column")?;
                Kind::Layered(layered(&column, soil)?)
            }
            Self::YieldFront => {
                refuse(&layers, "the column of a yield front")?;
                Kind::YieldFront(yield_front(&column, &material, &soil)?)
            }
            Self::SealedElement => {
                refuse(&yields, "a sealed element")?;
                refuse(&layers, "a sealed element")?;
                let modulus = soil.oedometric_modulus();
                let pressure = 1.0 / (1.0 + soil.porosity * modulus / soil.water_bulk_modulus);
                // 1 − p/q without cancellation.
                let share = modulus / (soil.coupling_modulus() + modulus);
                Kind::SealedElement([pressure, column.load * share / modulus])
            }
        };
        let seconds = column.height * column.height / soil.coefficient_of_consolidation();
        Ok(Solution { kind, height: column.height, load: column.load, seconds })
    }
}

/// A soil whose parameters are possible in the column.
fn checked(soil: &Material, column: &TypedColumn) -> Result<Material, ExactError> {
    let parameters = ColumnParameters {
        height: column.height,
        load: column.load,
        youngs_modulus: soil.youngs_modulus,
        poissons_ratio: soil.poissons_ratio,
        porosity: soil.porosity,
        water_density: soil.water_density,
        water_bulk_modulus: soil.water_bulk_modulus,
        hydraulic_conductivity: soil.hydraulic_conductivity,
        gravity: soil.gravity,
        ..ColumnParameters::default()
    };
    parameters.validate().map(|()| *soil)
}

/// The column of its layers; one of the soil itself where none is named.
fn layered(column: &TypedColumn, soil: Material) -> anyhow::Result<LayeredColumn> {
    let mut layers = Vec::with_capacity(column.soils.len().max(1));
    for (at, typed) in column.soils.iter().enumerate() {
        let Some(thickness) = typed.thickness else {
            return Err(Ended::usage(format!("layer {} from the base has no `thickness`", at + 1)));
        };
        layers.push((thickness, checked(&typed.over(soil), column)?));
    }
    if layers.is_empty() {
        layers.push((column.height, soil));
    }
    let sum: f64 = layers.iter().map(|(thickness, _)| thickness).sum();
    if (sum - column.height).abs() > GAP * column.height {
        return Err(ExactError::LayersDoNotFill { sum, height: column.height }.into());
    }
    Ok(LayeredColumn::new(column.load, &layers)?)
}

fn yield_front(column: &TypedColumn, typed: &TypedSoil, soil: &Material) -> anyhow::Result<YieldFront> {
    if let Some(law) = typed.law.as_deref().filter(|law| *law != "preconsolidated") {
        return Err(Ended::usage(format!("the law of a yield front is `preconsolidated`, not `{law}`")));
    }
    let needed = |value: Option<f64>, key: &str, what: &str| {
        value.ok_or_else(|| Ended::usage(format!("a yield front needs `material.{key}`, {what} in Pa")))
    };
    Ok(YieldFront::new(YieldingColumn {
        height: column.height,
        load: column.load,
        initial_stress: column.initial_stress,
        preconsolidation: needed(
            typed.preconsolidation,
            "preconsolidation",
            "the largest effective stress so far",
        )?,
        virgin_modulus: soil.oedometric_modulus(),
        reload_modulus: needed(
            typed.reload_modulus,
            "reload_modulus",
            "the oedometric modulus of reloading",
        )?,
        porosity: soil.porosity,
        water_bulk_modulus: soil.water_bulk_modulus,
        mobility: soil.hydraulic_conductivity / soil.unit_weight_of_water(),
    })?)
}

impl Solution {
    /// `p/q` at a depth, `s/H`, and the degree of consolidation by settlement.
    ///
    /// # Errors
    /// When the time factor is negative or not finite, or `zeta` outside [0, 1].
    pub fn ratios(&self, time_factor: f64, zeta: f64) -> Result<[f64; 3], ExactError> {
        let seconds = self.seconds * time_factor;
        let (pressure, settlement, last) = match &self.kind {
            Kind::Layered(column) => {
                let fields = column.fields(seconds, (1.0 - zeta) * self.height)?;
                (fields.pressure / self.load, column.settlement(seconds)?, column.final_settlement())
            }
            Kind::YieldFront(front) => {
                let pressure = front.fields(seconds, zeta)?.pressure / self.load;
                (pressure, front.settlement(seconds)?, front.final_settlement())
            }
            Kind::SealedElement([pressure, strain]) => return Ok([*pressure, *strain, 1.0]),
        };
        Ok([pressure, settlement / self.height, settlement / last])
    }

    /// Terms used at a time factor, and what bounds the pressure's error over the load.
    ///
    /// # Errors
    /// When the time factor is negative or not finite.
    pub fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let seconds = self.seconds * time_factor;
        match &self.kind {
            Kind::Layered(column) => column.accuracy(seconds),
            Kind::YieldFront(front) => front.accuracy(seconds),
            Kind::SealedElement(_) => Ok(Accuracy::of(1, 0.0)),
        }
    }
}
