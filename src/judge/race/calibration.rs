//! What counted work costs: nanoseconds per step, point and unknown of a front, for each method and kind of step, measured
//! once and committed. With it a cost is the same on every machine.

use crate::case::work_estimate::StepKind;
use crate::case::{Case, Task};
use crate::record::{Record, Status};
use oedometer_soil::elementary;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The committed calibration, which `oedometer report race --calibrate FILE` makes.
const COMMITTED: &str = include_str!("calibration.csv");
/// Seconds below which a measured run is noise.
const SHORTEST: f64 = 2e-3;

/// A method, the kind of its steps, and the dimensions of the scene.
pub type WorkKind = (String, &'static str, usize);

/// Times of counted work over the program's estimates, with their scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// Measured over nominal seconds: the geometric mean.
    pub mean: f64,
    /// Standard deviation of its logarithm.
    pub scatter: f64,
    /// Runs it rests on.
    pub runs: usize,
}

static FACTORS: LazyLock<BTreeMap<(String, String, usize), f64>> = LazyLock::new(|| {
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [method, kind, dimensions, mean, ..] = fields[..] else { return None };
        Some(((method.to_owned(), kind.to_owned(), dimensions.parse().ok()?), mean.parse().ok()?))
    };
    COMMITTED.lines().filter_map(line).collect()
});

/// Cost of a run by its counted work, s.
pub fn cost_of(record: &Record) -> f64 {
    let (method, kind, dimensions) = work_kind(&record.case);
    let factor = FACTORS.get(&(method, kind.to_owned(), dimensions)).copied().unwrap_or(1.0);
    factor * nominal_seconds(record)
}

/// What a run is calibrated with.
fn work_kind(case: &Case) -> WorkKind {
    let kind = match StepKind::of(case) {
        StepKind::Assembled => "assembled",
        StepKind::PointWise => "point-wise",
        StepKind::Linear => "linear",
        StepKind::Inertial => "inertial",
        StepKind::Newton => "newton",
    };
    (case.method.to_string(), kind, case.column.dimensions)
}

/// Counted work by the nominal costs of the program's estimates, s.
fn nominal_seconds(record: &Record) -> f64 {
    let (case, counters) = (&record.case, &record.counters);
    let cost = StepKind::of(case).cost(case.column.dimensions);
    let points = counters.points as f64;
    let width = case.column.cells_across(case.cells).unwrap_or(1).min(case.column.cells_up(case.cells)) as f64;
    let solves = counters.steps.max(counters.iterations).max(counters.factorisations) as f64;
    1e-9 * (solves * (cost.fixed + points * cost.point) + counters.factorisations as f64 * points * cost.front * width)
}

/// The factors that records give, of runs long enough to be measured.
pub fn calibrate(records: &[Record]) -> BTreeMap<WorkKind, Factor> {
    let mut logarithms: BTreeMap<WorkKind, Vec<(f64, f64)>> = BTreeMap::new();
    for record in records.iter().filter(|record| record.status == Status::Ok && record.case.task == Task::Solve) {
        let seconds = record.wall.iter().filter_map(|sample| sample.cpu_seconds).min_by(f64::total_cmp);
        let Some(seconds) = seconds.filter(|seconds| *seconds > 0.0) else { continue };
        let logarithm = elementary::ln(seconds / nominal_seconds(record).max(1e-9));
        logarithms.entry(work_kind(&record.case)).or_default().push((seconds, logarithm));
    }
    let factor = |samples: Vec<(f64, f64)>| {
        let long: Vec<f64> = samples.iter().filter(|one| one.0 >= SHORTEST).map(|one| one.1).collect();
        let all = if long.is_empty() { samples.iter().map(|one| one.1).collect() } else { long };
        let count = all.len() as f64;
        let mean = all.iter().sum::<f64>() / count;
        let variance = all.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>() / count;
        Factor { mean: elementary::exp(mean), scatter: variance.sqrt(), runs: all.len() }
    };
    logarithms.into_iter().map(|(kind, samples)| (kind, factor(samples))).collect()
}

/// The file of a calibration.
pub fn calibration_csv(factors: &BTreeMap<WorkKind, Factor>) -> String {
    let mut out = "method,kind,dimensions,factor,scatter,runs\n".to_owned();
    for ((method, kind, dimensions), Factor { mean, scatter, runs }) in factors {
        out += &format!("{method},{kind},{dimensions},{mean:.3},{scatter:.3},{runs}\n");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    #[test]
    fn a_calibration_gives_back_the_seconds_it_was_made_of_and_work_counts_the_same_everywhere() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [8, 16, 32]\n",
        );
        for (record, times) in records.iter_mut().zip([300.0, 300.0, 1200.0]) {
            let seconds = times * nominal_seconds(record);
            record.wall = vec![WallSample { cpu_seconds: Some(seconds), ..WallSample::default() }];
        }
        let factors = calibrate(&records);
        let factor = factors[&("GIMP".to_owned(), "linear", 1)];
        // The mean of 300, 300 and 1200 by powers, and the deviation of ln 1, ln 1 and ln 4.
        assert!((factor.mean / (300.0 * 4.0_f64.cbrt()) - 1.0).abs() < 1e-12, "{factor:?}");
        assert!((factor.scatter - 2.0_f64.sqrt() / 3.0 * 4.0_f64.ln()).abs() < 1e-12, "{factor:?}");
        assert_eq!(factor.runs, 3);
        assert!(calibration_csv(&factors).contains("GIMP,linear,1,476.220,0.654,3\n"), "{}", calibration_csv(&factors));
        let before = cost_of(&records[2]);
        records[2].wall.clear();
        assert_eq!(cost_of(&records[2]), before, "no clock is asked");
        assert!(cost_of(&records[2]) > 2.0 * cost_of(&records[0]));
    }
}
