//! Timed runs of a study by error and wall time: the fronts of methods, the cheapest within each tolerance, and the noise of the
//! session.

use crate::case::{IntegratorKind, Quantity, SolverName};
use crate::judge::paths::{first_error, grouped};
use crate::judge::reaching::QuotedRuns;
use crate::measure::statistics::{WallSpread, largest, median, noise_floor, paired_ratio, spread};
use crate::record::{Record, Status};
use crate::study::expectation::CaseExpectation;
use oedometer_convergence::{CostPoint, front};

/// Tolerances of the comparison.
const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// A timed run.
#[derive(Clone, Debug)]
pub struct TimedRun<'a> {
    /// The run.
    pub record: &'a Record,
    /// Error of the pore pressure at the points, the worst of all outputs.
    pub error: f64,
    /// Wall time over the repeats, s.
    pub wall: WallSpread,
}

/// The cheapest run within a tolerance.
#[derive(Clone, Debug)]
pub struct Cheapest<'a> {
    /// The tolerance.
    pub tolerance: f64,
    /// The run with the least wall time of those that reach it, where one does.
    pub run: Option<TimedRun<'a>>,
    /// Whether a finer mesh stays within it too.
    pub is_confirmed: bool,
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
    /// Compares the timed runs among records by the error against a reference, with what is expected of their cases; `None` where fewer
    /// than two were timed.
    pub fn of(records: &'a [Record], reference: &str, expectations: &[CaseExpectation]) -> Option<Self> {
        let mut runs: Vec<_> = records.iter().filter_map(|record| timed(record, reference)).collect();
        if runs.len() < 2 {
            return None;
        }
        runs.sort_by(|a, b| a.wall.median.total_cmp(&b.wall.median));
        let quoted = QuotedRuns::new(records, expectations, |record| worst_error(record, reference));
        let cheapest = TOLERANCES.map(|tolerance| {
            let reaching = quoted.reaching(tolerance);
            let run = runs.iter().find(|run| reaching.contains_key(run.record.hash.as_str()));
            let is_confirmed = run.is_some_and(|run| reaching[run.record.hash.as_str()]);
            Cheapest { tolerance, run: run.cloned(), is_confirmed }
        });
        Some(Self { cheapest: cheapest.to_vec(), noise_floor: session_noise(&runs), runs })
    }
}

/// The runs of a method with an integrator that no other of them beats in both time and error.
#[derive(Clone, Debug)]
pub struct MethodFront<'b, 'a> {
    /// Method.
    pub method: SolverName,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// The runs, the cheapest first.
    pub runs: Vec<&'b TimedRun<'a>>,
}

impl<'a> WorkPrecision<'a> {
    /// The front of each method with each integrator.
    pub fn fronts(&self) -> Vec<MethodFront<'_, 'a>> {
        let groups = grouped(&self.runs, |run| {
            (run.record.case.method.to_string(), run.record.case.integrator.name())
        });
        let fronts = groups.into_iter().map(|(_, runs)| {
            let point = |run: &&TimedRun<'_>| CostPoint { cost: run.wall.median, error: run.error };
            let points: Vec<_> = runs.iter().map(point).collect();
            let best = runs.iter().zip(front(&points)).filter(|(_, on_front)| *on_front);
            MethodFront {
                method: runs[0].record.case.method,
                integrator: runs[0].record.case.integrator,
                runs: best.map(|(run, _)| *run).collect(),
            }
        });
        fronts.collect()
    }
}

fn timed<'a>(record: &'a Record, reference: &str) -> Option<TimedRun<'a>> {
    let wall = spread(&record.wall_alone())?;
    let error = worst_error(record, reference).filter(|_| record.status == Status::Ok)?;
    Some(TimedRun { record, error, wall })
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
        let precision = WorkPrecision::of(&records, "terzaghi", &[]).expect("timed runs");
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
        let noise = WorkPrecision::of(&records, "terzaghi", &[]).expect("timed runs").noise_floor;
        assert!((noise.expect("six rounds") - 0.2).abs() < 1e-12, "{noise:?}");
    }

    #[test]
    fn the_worst_error_is_that_of_all_later_outputs_and_none_where_one_is_missing() {
        let record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0, 0.05, 0.1, 0.2]\n[[sweep]]\n\
             method = ['MPM']\nintegrator = ['implicit']\ncells = [5]\ntime_step = [{ growth = 0.2 }]\n",
        )
        .remove(0);
        let times = [0.0, 0.05, 0.1, 0.2];
        let with = |errors: [Option<f64>; 4]| {
            let (mut record, sample) = (record.clone(), record.main_sample());
            record.errors.retain_mut(|row| {
                let is_asked = (row.quantity, row.sample, row.reference.as_str())
                    == (Quantity::Pressure, sample, "terzaghi");
                let given =
                    errors[times.iter().position(|time| *time == row.time_factor).expect("an output")];
                row.value = given.filter(|_| is_asked).unwrap_or(row.value);
                !is_asked || given.is_some()
            });
            record
        };
        let worst = |errors: [Option<f64>; 4]| worst_error(&with(errors), "terzaghi");
        // The undrained start does not count.
        let plain = [Some(9.0), Some(0.01), Some(-0.02), Some(0.015)];
        assert_eq!(worst(plain), Some(0.02));
        assert_eq!(worst([None, plain[1], plain[2], plain[3]]), Some(0.02));
        assert_eq!(worst_error(&with(plain), "another"), None);
        for place in 1..4 {
            let changed = |error: Option<f64>| {
                let mut errors = plain;
                errors[place] = error;
                errors
            };
            assert_eq!([Some(0.5), Some(-0.5)].map(|error| worst(changed(error))), [Some(0.5); 2]);
            assert!(worst(changed(Some(f64::NAN))).is_some_and(f64::is_nan), "{place}");
            assert_eq!(worst(changed(None)), None, "{place}");
            // Such a run takes no part in a comparison.
            let mut runs = [plain, plain, changed(None)].map(with);
            for run in &mut runs {
                run.wall = vec![WallSample { seconds: 1.0, alone: true, ..WallSample::default() }; 2];
            }
            let precision = WorkPrecision::of(&runs, "terzaghi", &[]).expect("two timed runs");
            assert_eq!(precision.runs.len(), 2, "{place}");
        }
    }

    #[test]
    fn cost_is_the_median_on_the_front_and_within_a_tolerance() {
        let mut records = records_of(&STUDY.replace("[5, 10, 20, 40, 80]", "[5, 10]"));
        records.truncate(3);
        // By the shortest times the first would be on the front, by the longest the second would cost most.
        let given = [([1.0, 10.0, 10.0], 2e-2), ([4.0, 5.0, 60.0], 8e-3), ([6.0, 6.0, 6.0], 8e-4)];
        for (record, (times, error)) in records.iter_mut().zip(given) {
            record.errors.iter_mut().for_each(|row| row.value = error);
            let sample = |seconds: f64, alone: bool| WallSample { seconds, alone, ..WallSample::default() };
            record.wall = times.map(|seconds| sample(seconds, true)).to_vec();
            record.wall.extend(vec![sample(0.1, false); 9]);
        }
        let precision = WorkPrecision::of(&records, "terzaghi", &[]).expect("timed runs");
        let found: Vec<_> = precision.runs.iter().map(|run| (run.wall.median, run.error)).collect();
        assert_eq!(found, [(5.0, 8e-3), (6.0, 8e-4), (10.0, 2e-2)]);
        let fronts = precision.fronts();
        let best = fronts.iter().flat_map(|front| &front.runs).map(|run| run.wall.median);
        assert_eq!(best.collect::<Vec<_>>(), [5.0, 6.0]);
        let cheapest =
            precision.cheapest.iter().map(|one| (one.tolerance, one.run.as_ref().map(|run| run.wall.median)));
        let expected = [(1e-2, Some(5.0)), (1e-3, Some(6.0)), (1e-4, None)];
        assert_eq!(cheapest.collect::<Vec<_>>(), expected);
        for record in &mut records[1..] {
            record.wall.retain(|sample| !sample.alone);
        }
        assert!(WorkPrecision::of(&records, "terzaghi", &[]).is_none(), "one run was timed alone");
    }
}
