//! Error against cost: timed runs by error and wall time.

use crate::case::Quantity;
use crate::judge::paths::first_error;
use crate::measure::statistics::{WallSpread, largest, median, noise_floor, paired_ratio, spread};
use crate::record::{Record, Status};
use oedometer_convergence::{CostPoint, front};

/// Tolerances of the comparison.
pub const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// A timed run.
#[derive(Clone, Debug)]
pub struct TimedRun<'a> {
    /// The run.
    pub record: &'a Record,
    /// Error of the pore pressure at the points, the worst of all outputs.
    pub error: f64,
    /// Wall time over the repeats, s.
    pub wall: WallSpread,
    /// Whether no other run is both cheaper and better.
    pub on_front: bool,
}

/// The cheapest run within a tolerance.
#[derive(Clone, Debug)]
pub struct Cheapest<'a> {
    /// The tolerance.
    pub tolerance: f64,
    /// The run with the least wall time whose error is within it, where one is.
    pub run: Option<TimedRun<'a>>,
}

/// Timed runs of one study.
#[derive(Clone, Debug)]
pub struct WorkPrecision<'a> {
    /// Every run that was timed alone, the cheapest first.
    pub runs: Vec<TimedRun<'a>>,
    /// The cheapest run within each tolerance.
    pub cheapest: Vec<Cheapest<'a>>,
    /// How far from 1 the ratio of a run to itself was in this session, the median over
    /// the runs; `None` for fewer than two repeats.
    pub noise_floor: Option<f64>,
}

impl<'a> WorkPrecision<'a> {
    /// Compares the timed runs among records by the error against a reference; `None` where fewer
    /// than two were timed.
    pub fn of(records: &'a [Record], reference: &str) -> Option<Self> {
        let mut runs: Vec<_> = records.iter().filter_map(|record| timed(record, reference)).collect();
        if runs.len() < 2 {
            return None;
        }
        runs.sort_by(|a, b| a.wall.median.total_cmp(&b.wall.median));
        let points: Vec<_> = runs.iter().map(TimedRun::point).collect();
        for (run, on_front) in runs.iter_mut().zip(front(&points)) {
            run.on_front = on_front;
        }
        let cheapest = TOLERANCES.map(|tolerance| Cheapest {
            tolerance,
            run: runs.iter().find(|run| run.error <= tolerance).cloned(),
        });
        Some(Self { cheapest: cheapest.to_vec(), noise_floor: session_noise(&runs), runs })
    }
}

impl TimedRun<'_> {
    fn point(&self) -> CostPoint {
        CostPoint { cost: self.wall.median, error: self.error }
    }
}

fn timed<'a>(record: &'a Record, reference: &str) -> Option<TimedRun<'a>> {
    let wall = spread(&record.wall_alone())?;
    let error = worst_error(record, reference).filter(|_| record.status == Status::Ok)?;
    Some(TimedRun { record, error, wall, on_front: false })
}

/// Error of the pore pressure at the points in its first norm, the worst of all outputs.
pub fn worst_error(record: &Record, reference: &str) -> Option<f64> {
    let later = record.case.time_factors.iter().filter(|factor| **factor > 0.0);
    let sample = record.main_sample();
    let errors = later.map(|factor| first_error(record, Quantity::Pressure, sample, reference, *factor));
    largest(errors.collect::<Option<Vec<_>>>()?)
}

/// A run compared with itself: even rounds with odd ones.
fn session_noise(runs: &[TimedRun<'_>]) -> Option<f64> {
    let floors: Vec<f64> = runs
        .iter()
        .filter_map(|run| {
            let wall = run.record.wall_alone();
            let half = wall.len() / 2;
            let every_other =
                |first: usize| wall.iter().skip(first).step_by(2).take(half).copied().collect::<Vec<_>>();
            paired_ratio(&every_other(0), &every_other(1)).map(|ratio| noise_floor(&ratio))
        })
        .collect();
    median(&floors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    const STUDY: &str = r#"title = "Costs"
scene = "terzaghi"

[output]
time_factors = [0.05, 0.2]

[[sweep]]
method = ["GC-SRI-patch", "MPM"]
integrator = ["implicit"]
cells = [5, 10, 20, 40, 80]
time_step = [{ growth = 0.005 }]
"#;

    #[test]
    fn the_cheapest_run_within_a_tight_tolerance_is_of_second_order() {
        let mut records = records_of(STUDY);
        for record in &mut records {
            // A cost that is the same on every machine.
            let seconds = 1e-9 * record.counters.point_updates as f64;
            record.wall = vec![WallSample { seconds, alone: true, ..WallSample::default() }; 2];
        }
        let precision = WorkPrecision::of(&records, "terzaghi").expect("timed runs");
        // Within the tightest tolerance that both reach, the cheapest is the method of second order.
        let cheapest = precision.cheapest[1].run.as_ref().expect("within 0.1 %");
        assert!(cheapest.record.case.label().starts_with("GC-SRI-patch"), "{}", cheapest.record.case.label());
    }

    #[test]
    fn the_noise_of_a_session_is_how_far_a_run_is_off_itself() {
        let mut records = records_of(&STUDY.replace("[5, 10, 20, 40, 80]", "[5, 10]"));
        for record in &mut records {
            // Every other time is a quarter longer.
            record.wall = [1.0, 1.25, 1.0, 1.25, 1.0, 1.25, 7.0]
                .map(|seconds| WallSample { seconds, alone: true, ..WallSample::default() })
                .to_vec();
        }
        let noise = WorkPrecision::of(&records, "terzaghi").expect("timed runs").noise_floor;
        assert!((noise.expect("six rounds") - 0.2).abs() < 1e-12, "{noise:?}");
    }
}
