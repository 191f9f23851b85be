//! What the runs that had the machine to themselves cost, with the error of their pressure.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_measure;
use crate::measure::statistics::spread;
use crate::questions::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::study::expectation::Measure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cost and error of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimingFinding {
    /// Label of the case.
    pub case: String,
    /// Size of the error of the pressure at the last output.
    pub error: Option<f64>,
    /// Steps, where they are counted.
    pub steps: Option<u64>,
    /// Points times steps, where they are counted.
    pub point_updates: Option<u64>,
    /// Median of the wall times, s.
    pub median: f64,
    /// Shortest, s.
    pub least: f64,
    /// Longest, s.
    pub most: f64,
    /// Runs that were timed.
    pub runs: usize,
    /// Wall time of a point and step, ns.
    pub nanoseconds_per_update: Option<f64>,
}

/// Pressure at the points against the scene's own reference at the last output.
pub fn timed_measure(results: &StudyResults<'_>) -> Option<Measure> {
    let reference = results.study.references.first()?.name();
    let last = *results.records.first()?.case.time_factors.last()?;
    Some(first_measure(Quantity::Pressure, Sample::Points, reference, last))
}

/// The size of an error of a record, where its program measures it.
pub fn error_of(record: &Record, measure: &Measure) -> Option<f64> {
    let own = Measure { sample: record.main_sample(), ..measure.clone() };
    Some(own.error(record)?.value.abs())
}

/// The timed runs of a study that repeats its runs; empty for fewer than two.
pub fn timed_runs(results: &StudyResults<'_>) -> Vec<TimingFinding> {
    let Some(measure) = timed_measure(results).filter(|_| results.study.timing_repeats > 0) else {
        return Vec::new();
    };
    let is_timed = |record: &&Record| !record.wall_alone().is_empty() && record.status == Status::Ok;
    let timed = results.records.iter().filter(is_timed);
    let found: Vec<TimingFinding> = timed.filter_map(|record| timing_of(record, &measure)).collect();
    if found.len() > 1 { found } else { Vec::new() }
}

fn timing_of(record: &Record, measure: &Measure) -> Option<TimingFinding> {
    let wall = spread(&record.wall_alone())?;
    let counters = &record.counters;
    let counted = |work: u64| Some(work).filter(|_| record.case.counts_work());
    let updates = Some(counters.point_updates as f64).filter(|updates| *updates > 0.0);
    Some(TimingFinding {
        case: record.case.label(),
        error: error_of(record, measure),
        steps: counted(counters.steps),
        point_updates: counted(counters.point_updates),
        median: wall.median,
        least: wall.minimum,
        most: wall.maximum,
        runs: wall.count,
        nanoseconds_per_update: updates.map(|updates| 1e9 * wall.median / updates),
    })
}
