//! The state of a body at one time, sampled at points, cell centres and nodes.

use serde::{Deserialize, Serialize};

/// Fields at one kind of places. Stresses and displacements are the vertical ones; in two
/// dimensions the places along the layer and the horizontal displacements stand beside them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Samples {
    /// Initial height of each place above the base, m.
    pub initial_height: Vec<f64>,
    /// Initial height of the places of the displacement, m, where they are not the same.
    pub displacement_height: Option<Vec<f64>>,
    /// Volume that each place stands for, m^D.
    pub volume: Vec<f64>,
    /// Excess pore pressure, Pa, compression positive: without the hydrostatic one where the soil has a weight.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, Pa, tension positive.
    pub effective_stress: Vec<f64>,
    /// Vertical displacement of the skeleton, m, upward positive.
    pub displacement: Vec<f64>,
    /// Components along the layer, in two dimensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneSamples>,
    /// Samples of the water points; `pressure` is then that of the nearest of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub water: Option<WaterSamples>,
}

impl Samples {
    /// Pressures, Pa, and the volumes that they stand for, m^D: of the water's own points where there are such.
    pub fn pressures(&self) -> (&[f64], &[f64]) {
        match &self.water {
            Some(water) => (&water.pressure, &water.volume),
            None => (&self.pressure, &self.volume),
        }
    }
}

/// The pressure where the water has points of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WaterSamples {
    /// Initial height above the base of the soil that is there now, m.
    pub initial_height: Vec<f64>,
    /// Its initial distance along the layer, m, in two dimensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_distance: Option<Vec<f64>>,
    /// Volume that each place stands for, m^D.
    pub volume: Vec<f64>,
    /// Pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
}

/// Components along the layer, which samples of two dimensions have beside those of a column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PlaneSamples {
    /// Initial distance of each place along the layer, m.
    pub initial_distance: Vec<f64>,
    /// Initial distance of the places of the displacement, m, where they are not the same.
    pub displacement_distance: Option<Vec<f64>>,
    /// Horizontal displacement of the skeleton, m.
    pub horizontal_displacement: Vec<f64>,
}

/// State at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// Settlement of the loaded surface, m. The result of another program may have none: then it is no number,
    /// and left out on disk.
    #[serde(default = "unknown", skip_serializing_if = "is_unknown")]
    pub settlement: f64,
    /// Force, N, upward positive, of the soil on a plate that is pushed into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate_force: Option<f64>,
    /// Values at the material points.
    pub points: Samples,
    /// Volume-weighted means over the points of each cell, at their mean initial place.
    pub centres: Samples,
    /// Values projected to the nodes with weights times volume, at the mean initial place that
    /// belongs to the projection: a linear field is exact at boundary nodes too.
    pub nodes: Samples,
    /// Mass and momentum at this time.
    pub totals: Totals,
}

fn unknown() -> f64 {
    f64::NAN
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_unknown(value: &f64) -> bool {
    value.is_nan()
}

/// Conserved quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Totals {
    /// Volume of the mixture, m^D.
    pub volume: f64,
    /// Mass of the grains as the grid sees it, kg: what a point outside its weights would lose.
    pub solid_mass: f64,
    /// Volume of mixture that passed the loaded surface since the start,
    /// `∫ v_s + n(v_w − v_s) dt`, m a unit area.
    pub surface_flux: f64,
    /// Expansion of the pore water since the start, `Σ n V (p_0 − p)/K_w`, m^D. Continuity says
    /// that it is what passed the surface.
    pub water_expansion: f64,
    /// Sum of the internal forces on all nodes over the sum of their sizes: zero to round-off by
    /// the partition of unity.
    pub internal_force_imbalance: f64,
    /// Largest force on a free node that nothing balances, N.
    pub unbalanced_force: f64,
    /// Largest nodal velocity of either phase, m/s.
    #[serde(default)]
    pub largest_velocity: f64,
    /// Pores and water, where both are counted apart: in double-point MPM, where points move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub double_point: Option<WaterTotals>,
}

/// Pores and water of double-point MPM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WaterTotals {
    /// Volume of the pores, `Σ n_s V_s`, m^D.
    pub pore_volume: f64,
    /// Volume of the water in the soil, `Σ m_w/ρ_w`, m^D.
    pub water_volume: f64,
    /// Share of the water's mass that has left the soil.
    pub water_left: f64,
    /// Water points that are in the soil still.
    pub water_points: usize,
    /// Largest size of the pressure of any water point since the start, between outputs too, Pa.
    #[serde(default)]
    pub largest_pressure: f64,
}
