//! Which keys of a study file each problem reads: what it does not read changes nothing, and is refused.
//!
//! Each problem lists its own as `INPUTS`, of the sets below and of what is its alone; [`ReferenceKind::inputs`]
//! (`crate::reference::ReferenceKind::inputs`) joins them.

use crate::parameters::ShelfParameters;

/// The body, its load and what makes a time of a time factor.
pub(crate) const OF_COLUMN: &[&str] = &[
    "height",
    "load",
    "youngs_modulus",
    "poissons_ratio",
    "hydraulic_conductivity",
    "water_density",
    "gravity",
];
/// Water that can be compressed.
pub(crate) const OF_WATER: &[&str] = &["porosity", "water_bulk_modulus"];
/// A soil of Biot's full equations.
pub(crate) const OF_BIOT: &[&str] =
    &["porosity", "water_bulk_modulus", "biot_coefficient", "grain_bulk_modulus"];
/// The law, where scenes take that of the solution alone: the checker of studies refuses others.
pub(crate) const LAW: &[&str] = &["law"];
/// Whether skeleton and water have weight.
pub(crate) const WEIGHT: &[&str] = &["self_weight"];
/// What the stresses of weight follow from.
pub(crate) const OF_WEIGHT: &[&str] =
    &["height", "load", "porosity", "grain_density", "water_density", "gravity"];

/// A key of a problem's own input that no scene has, for command lines.
#[derive(Clone, Copy, Debug)]
pub struct AddedKey {
    /// Dotted, as other keys are.
    pub key: &'static str,
    /// SI unit, empty where it has none.
    pub unit: &'static str,
    /// Sets it.
    pub set: fn(&mut ShelfParameters, f64),
}

impl AddedKey {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self {
            key: "material.biot_coefficient",
            unit: "",
            set: |added, value| added.biot_coefficient = Some(value),
        },
        Self {
            key: "material.grain_bulk_modulus",
            unit: "Pa",
            set: |added, value| added.grain_bulk_modulus = Some(value),
        },
        Self { key: "drain.radius", unit: "m", set: |added, value| added.drain_radius = value },
        Self { key: "wave.period", unit: "s", set: |added, value| added.wave_period = value },
        Self {
            key: "column.initial_stress",
            unit: "Pa",
            set: |added, value| added.initial_stress = Some(value),
        },
    ];

    /// Its name in the lists of inputs.
    pub fn name(&self) -> &'static str {
        self.key.rsplit('.').next().unwrap_or(self.key)
    }
}
