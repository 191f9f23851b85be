//! What a study expects of single cases: how they end, where their critical step lies, how large an
//! error or a drift may be. Hard cases are judged by this, not by series.

use crate::case::tier::Tier;
use crate::record::Record;
use crate::study::expectation::{Measure, Selection};
use oedometer_mpm::run::results::outcome::FailureKind;

/// A range of values: the lower end belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest value.
    pub above: f64,
    /// Values are smaller than this.
    pub below: f64,
}

/// Bounds on one error of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorRange {
    /// Which error.
    pub measure: Measure,
    /// It must be smaller than this.
    pub below: f64,
    /// It must be at least this.
    pub above: f64,
}

/// What is wanted of a case; everything asked is judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseDemand {
    /// Name of its end: `ok`, or a failure's.
    pub status: Option<String>,
    /// Largest relative difference of the observed from the predicted critical step.
    pub critical_step_within: Option<f64>,
    /// Bounds on an error.
    pub error: Option<ErrorRange>,
    /// Largest drift of the mass of solids at any output, relative.
    pub solid_drift_below: Option<f64>,
    /// Largest imbalance of the water at any output, over what the load presses out.
    pub water_drift_below: Option<f64>,
    /// Bounds on the largest size, at any output, of the water in the soil over its pores, less one: of two layers.
    pub pore_water: Option<[f64; 2]>,
    /// Largest difference, at any output, of the share of the water that left from the settlement over `n_0 H`.
    pub water_left_within: Option<f64>,
    /// Bounds on the largest pressure of any water point of two layers, between outputs too, over the load.
    pub largest_pressure: Option<Bounds>,
    /// Largest difference of any error from that of the same case in one layer.
    pub one_layer_within: Option<f64>,
    /// Bounds on the largest velocity at any output of a column at rest, over the hydraulic conductivity.
    pub spurious_velocity: Option<Bounds>,
    /// Bounds on the time factor at which the pressure at the impermeable end is highest.
    pub peak_time_factor: Option<Bounds>,
    /// Bounds on that pressure over the load.
    pub peak_pressure: Option<Bounds>,
}

/// An expectation of single cases.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseExpectation {
    /// Which cases.
    pub selection: Selection,
    /// What of each.
    pub demand: CaseDemand,
    /// Smallest tier whose cases can answer it.
    pub tier: Tier,
    /// The file's line, for messages.
    pub line: usize,
}

impl CaseExpectation {
    /// Whether it is about an attached solver that is not here.
    pub fn asks_for_a_skip(&self) -> bool {
        self.demand.status.as_deref() == Some(FailureKind::Skipped.name())
    }

    /// Whether it says how a record is to end.
    pub fn foresees(&self, record: &Record) -> bool {
        self.selection.fits(&record.case)
            && self.demand.status.as_ref().is_some_and(|status| *status == record.status.name())
    }
}
