//! Runs of other programs: how each ended, what it took, and whether its repeats agree.

use crate::measure::statistics::{WallSpread, spread};
use crate::record::{Record, WallSample};
use serde::{Deserialize, Serialize};

/// Ratio of wall to processor time from which the machine was busy or the solver waited.
pub const BUSY: f64 = 2.0;

/// A run of another program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutsideRunFinding {
    /// Label of the case.
    pub case: String,
    /// Name of its end.
    pub status: String,
    /// Whether it failed.
    pub failed: bool,
    /// Whether it was left out.
    pub skipped: bool,
    /// Who made it.
    pub made_by: String,
    /// Runs that were timed.
    #[serde(default)]
    pub timed: usize,
    /// Shortest wall time, s.
    pub least_wall: Option<f64>,
    /// Median of the wall times, s.
    pub median_wall: Option<f64>,
    /// Median of the processor times, s.
    pub processor: Option<f64>,
    /// Largest memory, MB.
    pub memory: Option<f64>,
    /// Median of the times that the program reports, s.
    pub reported: Option<f64>,
    /// Largest load of the machine beside it.
    #[serde(default)]
    pub load: Option<f64>,
    /// Largest relative difference among its repeats.
    pub repeats_differ_by: Option<f64>,
    /// Whether it took so much longer than its processor time that the machine was busy or it waited.
    pub busy: bool,
}

/// Every run of another program.
pub fn outside_runs(records: &[Record]) -> Vec<OutsideRunFinding> {
    records.iter().filter_map(OutsideRunFinding::new).collect()
}

impl OutsideRunFinding {
    /// How the run of a record went; `None` for a run of this program.
    pub fn new(record: &Record) -> Option<Self> {
        let about = record.outside_run()?;
        let wall = over(&record.wall, |sample| Some(sample.seconds));
        let median = |field| over(&record.wall, field).map(|spread| spread.median);
        Some(Self {
            case: record.case.label(),
            status: record.status.name(),
            failed: record.status.failure().is_some(),
            skipped: record.status.is_skipped(),
            made_by: about.made_by().replace('`', ""),
            timed: wall.map_or(0, |wall| wall.count),
            least_wall: wall.map(|wall| wall.minimum),
            median_wall: wall.map(|wall| wall.median),
            processor: median(|sample| sample.cpu_seconds),
            memory: over(&record.wall, megabytes).map(|memory| memory.maximum),
            reported: median(|sample| sample.own_seconds),
            load: over(&record.wall, |sample| sample.load).map(|load| load.maximum),
            repeats_differ_by: about.repeats_differ_by,
            busy: is_busy(&record.wall),
        })
    }
}

/// The spread of a quantity over the samples that have it.
fn over(samples: &[WallSample], field: fn(&WallSample) -> Option<f64>) -> Option<WallSpread> {
    spread(&samples.iter().filter_map(field).collect::<Vec<_>>())
}

/// Memory of a run, MB.
fn megabytes(sample: &WallSample) -> Option<f64> {
    sample.peak_memory.map(|bytes| 1e-6 * bytes as f64)
}

/// Whether the wall times of a run are far above its processor times.
fn is_busy(samples: &[WallSample]) -> bool {
    let wall = over(samples, |sample| Some(sample.seconds));
    wall.zip(over(samples, |sample| sample.cpu_seconds))
        .is_some_and(|(wall, cpu)| wall.median > BUSY * cpu.median)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_busy_where_its_wall_time_is_far_above_the_processors() {
        let sample = |seconds: f64, cpu: Option<f64>| WallSample {
            seconds,
            cpu_seconds: cpu,
            ..WallSample::default()
        };
        assert!(is_busy(&[sample(2.1, Some(1.0))]));
        assert!(!is_busy(&[sample(1.9, Some(1.0))]));
        assert!(!is_busy(&[sample(9.0, None)]) && !is_busy(&[]));
    }
}
