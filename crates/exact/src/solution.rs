//! What every exact solution answers: its fields at a place and time, how far it has settled, and how exact it is.

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

/// What round-off leaves of fields over the load at least: at most 7.5e-15 was seen against values of 40 digits.
pub const ROUND_OFF: f64 = 1e-14;

/// How far a reference itself can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Number of terms (modes, images, unknowns) used.
    pub terms: usize,
    /// Bound on the truncation error of the pressure over the load, the worst over the depth.
    pub tail_bound: f64,
    /// Bound on what round-off leaves of pressures over the load and of displacements over the final one, where it is more
    /// than [`ROUND_OFF`]: of the phases of waves that have run for long, of sums whose terms cancel.
    pub phase_bound: f64,
}

impl Accuracy {
    /// So many terms, and what the others may add.
    pub fn of(terms: usize, tail_bound: f64) -> Self {
        Self { terms, tail_bound, phase_bound: 0.0 }
    }

    /// What round-off leaves of fields over the load, at most.
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

    /// Settlement when nothing moves any more, m, or what settlements are measured by where that never is.
    ///
    /// # Errors
    /// When it has no solution.
    fn final_settlement(&self) -> Result<f64, ExactError>;

    /// Degree of consolidation by settlement, `s(t)/s(∞)`; an immediate settlement counts.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.settlement(time_factor)? / self.final_settlement()?)
    }

    /// Whether that degree means anything: not where nothing consolidates, or waves move the surface to and fro.
    fn has_degree(&self) -> bool {
        true
    }

    /// Least porosity of all places and times, where the porosity bounds what is possible and no field depends on it.
    fn least_porosity(&self) -> Option<f64> {
        None
    }

    /// Terms used at a time factor, and the bound on what the others may add, the worst over the depth.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError>;

    /// What displacements are measured by, m.
    ///
    /// # Errors
    /// As for [`final_settlement`](Self::final_settlement).
    fn displacement_scale(&self) -> Result<f64, ExactError> {
        self.final_settlement().map(f64::abs)
    }

    /// Strain across the body, uniform in it: that of rigid plates, and none in a column.
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
