//! Critical steps of a study whose task is stability: maps over the parameter that varies, and every case.

use crate::questions::comparison::stability_map::{StabilityMap, maps_of};
use crate::record::{Probe, Record};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Critical steps, predicted and observed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityFinding {
    /// A map per choice of the integrator.
    pub maps: Vec<StabilityMap>,
    /// Every case.
    pub steps: Vec<CriticalStepFinding>,
}

/// The critical step of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CriticalStepFinding {
    /// Label of the case, without its step.
    pub case: String,
    /// Predicted step, s; `None` where no limit is known.
    pub predicted: Option<f64>,
    /// Observed step, s; `None` where no step was stable.
    pub observed: Option<f64>,
    /// Observed over predicted step, less one.
    pub deviation: Option<f64>,
    /// Resolution of the search, where the two do not differ by more.
    pub within: Option<f64>,
    /// The predicted step, or the formula's, over `h/c`.
    pub over_wave_limit: f64,
    /// Step, s, from which on a mode grows slowly.
    pub creeping_from: Option<f64>,
    /// Runs just below and above the limit.
    pub probes: Vec<Probe>,
}

impl StabilityFinding {
    /// The critical steps of records; `None` where none was searched.
    pub fn new(records: &[Record]) -> Option<Self> {
        let steps = critical_steps(records);
        (!steps.is_empty()).then(|| Self { maps: maps_of(records), steps })
    }
}

/// The critical step of every record that has one.
pub fn critical_steps(records: &[Record]) -> Vec<CriticalStepFinding> {
    let finding = |record: &Record| {
        let found = record.stability.as_ref()?;
        Some(CriticalStepFinding {
            case: record.case.label_without_step(),
            predicted: found.known(),
            observed: found.observed,
            deviation: found.known().and(found.deviation()),
            within: found.known().and(found.within()),
            over_wave_limit: found.predicted / found.wave_limit,
            creeping_from: found.creeping_from,
            probes: found.probes.clone(),
        })
    };
    records.iter().filter_map(finding).collect()
}
