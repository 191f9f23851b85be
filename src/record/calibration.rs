//! What counted work costs: nanoseconds per step, point and unknown of a front, for each method and kind of step, measured
//! once and committed. With it a cost is the same on every machine.

use crate::case::Task;
use crate::case::work_estimate::StepKind;
use crate::record::{Record, Status};
use oedometer_soil::elementary;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::LazyLock;

/// The committed calibration, which `oedometer report race --calibrate FILE` makes.
const COMMITTED: &str = include_str!("calibration.csv");
/// A method, the kind of its steps, and the dimensions of the scene.
pub type WorkKind = (String, &'static str, usize);

/// What a kind of work costs: a time for the set-up, and a factor on the nominal time of what is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Before the first step, s.
    pub setup: f64,
    /// Over the program's estimate of a step.
    pub factor: f64,
    /// Standard deviation of the logarithm of measured over fitted seconds.
    pub scatter: f64,
    /// Runs it rests on.
    pub runs: usize,
}

/// Set-up, s, and factor by method, kind of step and dimensions.
type Rates = BTreeMap<(String, String, usize), (f64, f64)>;

static RATES: LazyLock<Rates> = LazyLock::new(|| {
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [method, kind, dimensions, setup, factor, ..] = fields[..] else { return None };
        let key = (method.to_owned(), kind.to_owned(), dimensions.parse().ok()?);
        Some((key, (setup.parse().ok()?, factor.parse().ok()?)))
    };
    COMMITTED.lines().filter_map(line).collect()
});

/// Cost of a run by its counted work, s.
pub fn cost_of(record: &Record) -> f64 {
    let (method, kind, dimensions) = work_kind(record);
    let (setup, factor) = RATES.get(&(method, kind.to_owned(), dimensions)).copied().unwrap_or((0.0, 1.0));
    setup + factor * nominal_seconds(record)
}

/// A plane's steps share a few factorisations, which are most of what it costs. Per point, ns: a step, the assembly of a
/// factorisation, and its front per cell of width; fitted to layers of 4 to 24 cells and slabs of 10 to 50.
const PLANE: (f64, f64, f64) = (60.0, 600.0, 140.0);

/// What a run is calibrated with.
fn work_kind(record: &Record) -> WorkKind {
    let case = &record.case;
    let kind = match StepKind::for_case(case) {
        // The undrained start alone.
        _ if record.counters.steps == 0 => "start",
        StepKind::Assembled => "assembled",
        StepKind::PointWise => "point-wise",
        // Nothing moves, and soil that yields asks for iterations.
        StepKind::Linear if record.counters.iterations > 0 => "iterated",
        StepKind::Linear => "linear",
        StepKind::Inertial => "inertial",
        StepKind::Newton => "newton",
    };
    (case.method.to_string(), kind, case.column.dimensions)
}

/// Counted work by the nominal costs of the program's estimates, s.
fn nominal_seconds(record: &Record) -> f64 {
    let (case, counters) = (&record.case, &record.counters);
    let kind = StepKind::for_case(case);
    let cost = kind.cost(case.column.dimensions);
    let is_plane = kind == StepKind::Linear && case.column.dimensions > 1;
    let (step, assembly, front) = if is_plane { PLANE } else { (cost.point, 0.0, cost.front) };
    let points = counters.points as f64;
    let width =
        case.column.cells_across(case.cells).unwrap_or(1).min(case.column.cells_up(case.cells)) as f64;
    // The undrained start, before any step, is one solve.
    let solves = counters.steps.max(counters.iterations).max(counters.factorisations).max(1) as f64;
    let factorisations = counters.factorisations.max(1) as f64;
    1e-9 * (solves * (cost.fixed + points * step) + factorisations * points * (assembly + front * width))
}

/// The rates that the measured seconds of records give.
pub fn calibrate(records: &[Record]) -> BTreeMap<WorkKind, Rate> {
    let mut samples: BTreeMap<WorkKind, Vec<(f64, f64)>> = BTreeMap::new();
    for record in
        records.iter().filter(|record| record.status == Status::Ok && record.case.task == Task::Solve)
    {
        let seconds = record.wall.iter().filter_map(|sample| sample.cpu_seconds).min_by(f64::total_cmp);
        let Some(seconds) = seconds.filter(|seconds| *seconds > 0.0) else { continue };
        samples.entry(work_kind(record)).or_default().push((nominal_seconds(record), seconds));
    }
    samples.into_iter().map(|(kind, samples)| (kind, rate_of(&samples))).collect()
}

/// Set-up and factor by least squares of the relative errors; neither is negative.
fn rate_of(samples: &[(f64, f64)]) -> Rate {
    let sum = |term: fn(f64, f64) -> f64| {
        samples.iter().map(|(work, seconds)| term(1.0 / seconds, work / seconds)).sum::<f64>()
    };
    let [xx, xy, yy, x, y] =
        [sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y), sum(|x, _| x), sum(|_, y| y)];
    let determinant = xx * yy - xy * xy;
    let is_settled = samples.len() > 2 && determinant > 1e-6 * xx * yy;
    let both = ((x * yy - y * xy) / determinant, (y * xx - x * xy) / determinant);
    let (setup, factor) = match both {
        (setup, factor) if is_settled && setup >= 0.0 && factor >= 0.0 => both,
        (_, factor) if is_settled && factor < 0.0 => (x / xx, 0.0),
        _ => (0.0, y / yy),
    };
    let squares = samples.iter().map(|(work, seconds)| {
        let logarithm = elementary::ln(seconds / (setup + factor * work));
        logarithm * logarithm
    });
    let scatter = (squares.sum::<f64>() / samples.len() as f64).sqrt();
    Rate { setup, factor, scatter, runs: samples.len() }
}

/// The file of a calibration.
pub fn calibration_csv(rates: &BTreeMap<WorkKind, Rate>) -> String {
    let mut out = "method,kind,dimensions,setup_seconds,factor,scatter,runs\n".to_owned();
    for ((method, kind, dimensions), Rate { setup, factor, scatter, runs }) in rates {
        let _ = writeln!(out, "{method},{kind},{dimensions},{setup:.3e},{factor:.3},{scatter:.3},{runs}");
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
        for record in &mut records {
            let seconds = 0.01 + 3.0 * nominal_seconds(record);
            record.wall = vec![WallSample { cpu_seconds: Some(seconds), ..WallSample::default() }];
        }
        let rates = calibrate(&records);
        let rate = rates[&("GIMP".to_owned(), "linear", 1)];
        assert!((rate.setup - 0.01).abs() < 1e-9 && (rate.factor - 3.0).abs() < 1e-6, "{rate:?}");
        assert!(rate.scatter < 1e-6 && rate.runs == 3, "{rate:?}");
        assert!(calibration_csv(&rates).contains("GIMP,linear,1,1.000e-2,3.000,0.000,3\n"));
        // Two runs give a factor alone: the mean over relative errors.
        let two = rate_of(&[(1.0, 2.0), (1.0, 4.0)]);
        assert_eq!((two.setup, two.factor), (0.0, 0.75 / 0.3125));
        // What takes as long whatever the work is set-up.
        let setup = rate_of(&[(1.0, 2.0), (2.0, 2.0), (3.0, 1.9)]);
        assert!(setup.factor == 0.0 && (setup.setup - 1.96).abs() < 0.01, "{setup:?}");
        let before = cost_of(&records[2]);
        records[2].wall.clear();
        assert_eq!(cost_of(&records[2]), before, "no clock is asked");
        assert!(cost_of(&records[2]) > cost_of(&records[0]));
    }

    /// A front costs once a factorisation, whatever the number of solves; points cost once a solve.
    #[test]
    fn factorisations_and_solves_are_counted_apart() {
        let records = records_of(
            "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [2]\n",
        );
        let cost = StepKind::for_case(&records[0].case).cost(2);
        let seconds = |steps, factorisations| {
            let mut record = records[0].clone();
            (record.counters.steps, record.counters.iterations) = (steps, 0);
            record.counters.factorisations = factorisations;
            1e9 * nominal_seconds(&record)
        };
        let points = records[0].counters.points as f64;
        let (step, assembly, front) = PLANE;
        let (factored, solved) = (seconds(9, 5) - seconds(9, 2), seconds(9, 5) - seconds(7, 5));
        assert!((factored / (3.0 * points * (assembly + 2.0 * front)) - 1.0).abs() < 1e-9, "{factored}");
        assert!((solved / (2.0 * (cost.fixed + points * step)) - 1.0).abs() < 1e-9, "{solved}");
    }
}
