//! Runs of a study by error and counted work: the fronts of methods, and the cheapest within each tolerance.

use crate::case::grouping::grouped;
use crate::case::{Quantity, SolverName};
use crate::judge::paths::first_error;
use crate::judge::recommendation::QuotedRuns;
use crate::measure::statistics::largest;
use crate::record::calibration::cost_of;
use crate::record::{Record, Status};
use crate::study::expectation::CaseExpectation;
use oedometer_convergence::{CostPoint, front};

/// Tolerances of the comparison.
const TOLERANCES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// A run with what it costs.
#[derive(Clone, Debug)]
pub struct CostedRun<'a> {
    /// The run.
    pub record: &'a Record,
    /// Error of the pore pressure at the points, the worst of all outputs.
    pub error: f64,
    /// Counted work, s.
    pub work: f64,
}

/// The cheapest run within a tolerance.
#[derive(Clone, Debug)]
pub struct Cheapest<'a> {
    /// The tolerance.
    pub tolerance: f64,
    /// The run with the least work of those that reach it, where one does.
    pub run: Option<CostedRun<'a>>,
    /// Whether a finer mesh stays within it too.
    pub is_confirmed: bool,
    /// Each method's least work within it, the cheapest first.
    pub methods: Vec<(SolverName, f64)>,
}

/// Runs of one study by their costs.
#[derive(Clone, Debug)]
pub struct WorkPrecision<'a> {
    /// Every sound run of which the work is counted, the cheapest first.
    pub runs: Vec<CostedRun<'a>>,
    /// The cheapest run within each tolerance.
    pub cheapest: Vec<Cheapest<'a>>,
}

impl<'a> WorkPrecision<'a> {
    /// Compares the runs among records by the error against a reference, with what is expected of their cases; `None` for fewer
    /// than two.
    pub fn of(records: &'a [Record], reference: &str, expectations: &[CaseExpectation]) -> Option<Self> {
        let mut runs: Vec<_> = records.iter().filter_map(|record| costed(record, reference)).collect();
        if runs.len() < 2 {
            return None;
        }
        runs.sort_by(|a, b| a.work.total_cmp(&b.work));
        let quoted = QuotedRuns::new(records, expectations, |record| worst_error(record, reference));
        let cheapest = TOLERANCES.map(|tolerance| {
            let reaching = quoted.reaching(tolerance);
            let within = || runs.iter().filter(|run| reaching.contains_key(run.record.hash.as_str()));
            let run = within().next();
            let is_confirmed = run.is_some_and(|run| reaching[run.record.hash.as_str()]);
            let of_method = grouped(within(), |run| run.record.case.method.to_string()).into_iter();
            let methods = of_method.map(|(_, runs)| (runs[0].record.case.method, runs[0].work)).collect();
            Cheapest { tolerance, run: run.cloned(), is_confirmed, methods }
        });
        Some(Self { cheapest: cheapest.to_vec(), runs })
    }
}

impl<'a> WorkPrecision<'a> {
    /// Of each method with each integrator the runs that no other of them beats in both work and error, the cheapest first.
    pub fn fronts(&self) -> Vec<Vec<&CostedRun<'a>>> {
        let groups = grouped(&self.runs, |run| {
            (run.record.case.method.to_string(), run.record.case.integrator.name())
        });
        let fronts = groups.into_iter().map(|(_, runs)| {
            let point = |run: &&CostedRun<'_>| CostPoint { cost: run.work, error: run.error };
            let points: Vec<_> = runs.iter().map(point).collect();
            runs.into_iter()
                .zip(front(&points))
                .filter(|(_, on_front)| *on_front)
                .map(|(run, _)| run)
                .collect()
        });
        fronts.collect()
    }
}

fn costed<'a>(record: &'a Record, reference: &str) -> Option<CostedRun<'a>> {
    let error = worst_error(record, reference).filter(|_| {
        record.status == Status::Ok && record.stability.is_none() && record.case.has_integrator()
    })?;
    Some(CostedRun { record, error, work: cost_of(record) })
}

/// Error of the pore pressure at the points in its first norm, the worst of all outputs.
pub fn worst_error(record: &Record, reference: &str) -> Option<f64> {
    let later = record.case.time_factors.iter().filter(|factor| **factor > 0.0);
    let sample = record.main_sample();
    let errors = later.map(|factor| first_error(record, Quantity::Pressure, sample, reference, *factor));
    largest(errors.collect::<Option<Vec<_>>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

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
        let records = records_of(STUDY);
        let precision = WorkPrecision::of(&records, "terzaghi", &[]).expect("runs");
        // Within the tightest tolerance that both reach, the cheapest is the method of second order.
        let cheapest = precision.cheapest[1].run.as_ref().expect("within 0.1 %");
        assert!(cheapest.record.case.label().starts_with("GC-SRI-patch"), "{}", cheapest.record.case.label());
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
            let runs = [plain, plain, changed(None)].map(with);
            let precision = WorkPrecision::of(&runs, "terzaghi", &[]).expect("two runs");
            assert_eq!(precision.runs.len(), 2, "{place}");
        }
    }

    #[test]
    fn cost_is_counted_work_on_the_front_and_within_a_tolerance() {
        let mut records = records_of(&STUDY.replace("[5, 10, 20, 40, 80]", "[5, 10, 20]"));
        records.truncate(3);
        // The dearest of three meshes is the most accurate, the cheapest next; the middle one is off the front.
        for (record, error) in records.iter_mut().zip([8e-3, 2e-2, 8e-4]) {
            record.errors.iter_mut().for_each(|row| row.value = error);
        }
        let work: Vec<f64> = records.iter().map(cost_of).collect();
        assert!(work[0] < work[1] && work[1] < work[2], "{work:?}");
        let precision = WorkPrecision::of(&records, "terzaghi", &[]).expect("runs");
        let fronts = precision.fronts();
        let best = fronts.iter().flatten().map(|run| (run.work, run.error));
        assert_eq!(best.collect::<Vec<_>>(), [(work[0], 8e-3), (work[2], 8e-4)]);
        let cheapest =
            precision.cheapest.iter().map(|one| (one.run.as_ref().map(|run| run.work), one.methods.len()));
        // The first mesh is undone by the second.
        assert_eq!(cheapest.collect::<Vec<_>>(), [(Some(work[2]), 1), (Some(work[2]), 1), (None, 0)]);
        records[1].status = crate::campaign::runner::failed_at(1);
        records[2].wall.clear();
        assert_eq!(
            WorkPrecision::of(&records, "terzaghi", &[]).map(|found| found.runs.len()),
            Some(2),
            "no clock is asked"
        );
    }
}
