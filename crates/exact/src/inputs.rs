//! Which keys of a study file each problem reads. Other keys would have no effect and are refused.
//!
//! Each problem lists its keys as `INPUTS`, from the sets below and keys that no other problem has;
//! [`ReferenceKind::inputs`] (`crate::reference::ReferenceKind::inputs`) joins them.

use crate::parameters::TextbookParameters;

/// The body, its load and the parameters that convert a time factor to a time.
pub(crate) const COLUMN_KEYS: &[&str] = &[
    "height",
    "load",
    "youngs_modulus",
    "poissons_ratio",
    "hydraulic_conductivity",
    "water_density",
    "gravity",
];
/// Compressible water.
pub(crate) const WATER_KEYS: &[&str] = &["porosity", "water_bulk_modulus"];
/// A soil of Biot's full equations.
pub(crate) const BIOT_KEYS: &[&str] =
    &["porosity", "water_bulk_modulus", "biot_coefficient", "grain_bulk_modulus"];
/// The law; scenes whose solution holds for a single law accept no other.
pub(crate) const LAW_KEY: &[&str] = &["law"];
/// Which ends let the water out.
pub(crate) const DRAINAGE_KEY: &[&str] = &["drainage"];
/// Whether skeleton and water have weight.
pub(crate) const WEIGHT_KEY: &[&str] = &["self_weight"];
/// Parameters of the stresses due to self-weight.
pub(crate) const WEIGHT_STRESS_KEYS: &[&str] =
    &["height", "load", "porosity", "grain_density", "water_density", "gravity"];

/// A command-line key for an input of a problem that no scene has.
#[derive(Clone, Copy, Debug)]
pub struct AddedKey {
    /// Dotted name, as for other keys.
    pub key: &'static str,
    /// SI unit, empty if dimensionless.
    pub unit: &'static str,
    /// Sets the value.
    pub set: fn(&mut TextbookParameters, f64),
}

impl AddedKey {
    /// All added keys.
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

    /// Name in the lists of inputs, without the table.
    pub fn name(&self) -> &'static str {
        self.key.rsplit('.').next().unwrap_or(self.key)
    }
}
