//! The interface of every exact solution: its fields at a place and time, its settlement and its accuracy.

use crate::exact_error::ExactError;
use std::fmt::Debug;

/// Fields at one depth and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldValues {
    /// Excess pore pressure, compression positive, Pa.
    pub pressure: f64,
    /// Vertical effective (Cauchy) stress, *tension positive*: `p − q` under a load, Pa.
    pub effective_stress: f64,
    /// Displacement of the solid, upward positive, from the unloaded state before `t = 0`
    /// (single mode: from the state at `t = 0`), m.
    pub displacement: f64,
}

/// Round-off error of fields over the load: the largest seen against values of 40 digits was 7.5e-15.
pub const ROUND_OFF: f64 = 1e-14;

/// Error bounds of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Number of terms (modes, images, unknowns) used.
    pub terms: usize,
    /// Bound on the truncation error of the pressure over the load, the worst over the depth.
    pub tail_bound: f64,
    /// Bound on the round-off error of pressures over the load and of displacements over the final one, if it exceeds
    /// [`ROUND_OFF`]: from phases of waves after many periods, or from sums whose terms cancel.
    pub phase_bound: f64,
}

impl Accuracy {
    /// The accuracy of a sum of `terms` terms with a bound on the omitted ones.
    pub fn new(terms: usize, tail_bound: f64) -> Self {
        Self { terms, tail_bound, phase_bound: 0.0 }
    }

    /// Bound on the round-off error of fields over the load.
    pub fn round_off(&self) -> f64 {
        ROUND_OFF.max(self.phase_bound)
    }

    /// Bound on both errors.
    pub fn bound(&self) -> f64 {
        self.tail_bound + self.phase_bound
    }
}

/// An exact solution, by the time factor and the relative depth `ζ`.
pub trait Solution: Debug + Send + Sync {
    /// Pressure, effective (Cauchy) stress and displacement at a Lagrangian relative depth.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError>;

    /// Settlement of the surface, downward positive, m.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError>;

    /// Final settlement, m; for motions that never end, the scale of settlements.
    ///
    /// # Errors
    /// When the final state has no solution.
    fn final_settlement(&self) -> Result<f64, ExactError>;

    /// Degree of consolidation by settlement, `s(t)/s(∞)`; an immediate settlement counts.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.settlement(time_factor)? / self.final_settlement()?)
    }

    /// Whether the degree of consolidation is meaningful: it is not if nothing consolidates or waves move the surface up and
    /// down.
    fn has_degree(&self) -> bool {
        true
    }

    /// Least porosity of all places and times, for solutions that the porosity limits without entering their fields.
    fn least_porosity(&self) -> Option<f64> {
        None
    }

    /// Number of terms used at a time factor, and a bound on the omitted ones, the largest over the depth.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError>;

    /// Scale of displacements, m.
    ///
    /// # Errors
    /// As for [`final_settlement`](Self::final_settlement).
    fn displacement_scale(&self) -> Result<f64, ExactError> {
        self.final_settlement().map(f64::abs)
    }

    /// Uniform strain across the body: that of rigid plates, and zero in a column.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn strain_across(&self, _time_factor: f64) -> Result<f64, ExactError> {
        Ok(0.0)
    }

    /// Time factor and height, over the load, of the highest pressure at the impermeable end, where it rises before it
    /// falls.
    fn pressure_peak(&self) -> Option<(f64, f64)> {
        None
    }
}
