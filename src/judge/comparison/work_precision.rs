//! Error against cost: timed runs by error and wall time.

use crate::case::Quantity;
use crate::judge::paths::{Path, first_error, first_measure, paths};
use crate::measure::statistics::{WallSpread, largest, median, noise_floor, paired_ratio, spread};
use crate::record::{Record, Status};
use crate::study::expectation::Axis;
use oedometer_convergence::{CostLevel, CostPoint, LevelPrediction, front, predict_next};

/// Tolerances of the comparison.
pub const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Ratio of the cell size of one more level.
const REFINEMENT: f64 = 2.0;

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

/// One more level of a path over the mesh, as its last levels predict it.
#[derive(Clone, Debug)]
pub struct NextLevel {
    /// Label of the path.
    pub label: String,
    /// Wall time, s, and error of its finest level.
    pub finest: CostPoint,
    /// Wall time and error of the next.
    pub next: LevelPrediction,
    /// The finest level as the coarser ones predict it: shows how far such predictions can be trusted.
    pub finest_predicted: Option<LevelPrediction>,
}

/// Timed runs of one study.
#[derive(Clone, Debug)]
pub struct WorkPrecision<'a> {
    /// Every run that was timed alone, the cheapest first.
    pub runs: Vec<TimedRun<'a>>,
    /// The cheapest run within each tolerance.
    pub cheapest: Vec<Cheapest<'a>>,
    /// One more level of each path.
    pub next_levels: Vec<NextLevel>,
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
        Some(Self {
            cheapest: cheapest.to_vec(),
            next_levels: next_levels(records, reference),
            noise_floor: session_noise(&runs),
            runs,
        })
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

fn next_levels(records: &[Record], reference: &str) -> Vec<NextLevel> {
    let of_path = |path: Path<'_>| {
        let levels: Vec<CostLevel> = path
            .records
            .iter()
            .filter_map(|record| {
                let run = timed(record, reference)?;
                Some(CostLevel { size: record.case.cell_size(), point: run.point() })
            })
            .collect();
        let last = *path.records.last()?.case.time_factors.last()?;
        let class_of = |path: &Path<'_>| {
            let sample = path.records[0].main_sample();
            path.summary(&first_measure(Quantity::Pressure, sample, reference, last)).classification
        };
        let next = predict_next(&levels, &class_of(&path), REFINEMENT)?;
        let (finest, coarser) = levels.split_last()?;
        let records = path.records[..path.records.len() - 1].to_vec();
        let coarser_path = Path { axis: path.axis, records };
        let ratio = coarser.last()?.size / finest.size;
        let finest_predicted = predict_next(coarser, &class_of(&coarser_path), ratio);
        Some(NextLevel { label: path.label(), finest: finest.point, next, finest_predicted })
    };
    paths(records, Axis::Cells)
        .into_iter()
        .filter(|path| path.records.len() > 2)
        .filter_map(of_path)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    const STUDY: &str = r#"title = "One more level"
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
    fn the_coarser_levels_predict_cost_and_error_of_the_finest() {
        let mut records = records_of(STUDY);
        for record in &mut records {
            // A cost that is the same on every machine.
            let seconds = 1e-9 * record.counters.point_updates as f64;
            record.wall = vec![WallSample { seconds, alone: true, ..WallSample::default() }; 2];
        }
        let precision = WorkPrecision::of(&records, "terzaghi").expect("timed runs");
        assert_eq!(precision.next_levels.len(), 2);
        for level in &precision.next_levels {
            let predicted = level.finest_predicted.expect("four coarser levels");
            let cost = predicted.cost / level.finest.cost;
            let error = predicted.error.expect("it converges") / level.finest.error;
            assert!((cost - 1.0).abs() < 0.15, "{}: cost {cost} of the measured one", level.label);
            assert!((error - 1.0).abs() < 0.1, "{}: error {error} of the measured one", level.label);
        }
        // Within the tightest tolerance that both reach, the cheapest is the method of second order.
        let cheapest = precision.cheapest[1].run.as_ref().expect("within 0.1 %");
        assert!(cheapest.record.case.label().starts_with("GC-SRI-patch"), "{}", cheapest.record.case.label());
    }
}
