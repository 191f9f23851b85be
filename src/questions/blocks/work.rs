//! Error over counted work, and over wall time: the fronts of methods, the cheapest run within each tolerance, and other
//! programs on the same column.

use crate::case::quantity::{Quantity, Sample};
use crate::case::{IntegratorKind, grouping::distinct};
use crate::judge::path_labels::path_labels;
use crate::questions::blocks::Point;
use crate::questions::blocks::drawn::{DrawnSeries, drawn};
use crate::questions::blocks::timing::{error_of, timed_measure};
use crate::questions::comparison::peers::{self, Comparison, Peer};
use crate::questions::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::questions::study_results::StudyResults;
use crate::record::Record;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The error of the pressure over counted work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorkFinding {
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Time factor: that of the last output.
    pub time_factor: f64,
    /// What all runs share.
    pub shared: String,
    /// Which series are drawn, where not all.
    pub drawn: Option<DrawnSeries>,
    /// Point updates and error along each path over the mesh; empty where there is one path alone.
    pub lines: Vec<NamedLine>,
}

/// Points under a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NamedLine {
    /// Its name.
    pub name: String,
    /// Its points.
    pub points: Vec<Point>,
}

impl WorkFinding {
    /// What a study measures over its work; `None` without runs or references.
    pub fn new(results: &StudyResults<'_>) -> Option<Self> {
        let measure = timed_measure(results)?;
        let mut along_mesh = results.paths.along(Axis::Cells).to_vec();
        along_mesh.retain(|path| path.records.iter().all(|record| record.case.counts_work()));
        if along_mesh.len() < 2 {
            along_mesh.clear();
        }
        let (paths, drawn) = drawn(&along_mesh);
        let labels = path_labels(&paths);
        let point =
            |record: &&Record| Some((record.counters.point_updates as f64, error_of(record, &measure)?));
        let lines = paths.iter().zip(labels.each).map(|(path, name)| NamedLine {
            name,
            points: path.records.iter().filter_map(point).filter(|(_, error)| error.is_finite()).collect(),
        });
        Some(Self {
            lines: lines.collect(),
            quantity: measure.quantity,
            sample: measure.sample,
            time_factor: measure.time_factor,
            shared: labels.shared,
            drawn,
        })
    }
}

/// The timed runs of a study by error and wall time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct WallTimeFinding {
    /// The runs of each method with each integrator that no other of them beats in both time and error.
    pub fronts: Vec<WallTimeFront>,
    /// The cheapest run within each tolerance.
    pub cheapest: Vec<CheapestTimed>,
    /// How far the same run, timed twice, differs in this session.
    pub noise: Option<f64>,
    /// Other programs, where the runs solve their column.
    pub peers: Option<PeersFinding>,
}

/// The best runs of a method with an integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WallTimeFront {
    /// Method.
    pub method: String,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Wall time, s, and error, the cheapest first.
    pub points: Vec<Point>,
}

/// The cheapest run within a tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheapestTimed {
    /// The tolerance.
    pub tolerance: f64,
    /// The run, where one reaches it.
    pub run: Option<TimedRunFinding>,
    /// Whether a finer mesh stays within it too.
    #[serde(default)]
    pub is_confirmed: bool,
}

/// A timed run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimedRunFinding {
    /// Label of the case.
    pub case: String,
    /// Error of the pressure at the points, the worst of the outputs.
    pub error: f64,
    /// Median of its wall times, s.
    pub seconds: f64,
    /// Their standard deviation, s.
    pub deviation: f64,
    /// Steps, where they are counted.
    pub steps: Option<u64>,
    /// Points times steps, where they are counted.
    pub point_updates: Option<u64>,
}

/// Other programs beside the runs of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeersFinding {
    /// Time factors of their errors.
    pub time_factors: [f64; 3],
    /// Each program with each time scheme: time, s, and the worst of its errors.
    pub lines: Vec<NamedLine>,
    /// Each program on each mesh beside the cheapest run that is nowhere worse.
    pub rows: Vec<PeerRow>,
    /// The convergence tests of other programs, judged like series of this one.
    pub series: Vec<PeerSeriesFinding>,
}

/// Another program on a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeerRow {
    /// Its name and version.
    pub program: String,
    /// What it is.
    pub kind: String,
    /// Cells over the height.
    pub cells: usize,
    /// How it steps through time.
    pub time_scheme: String,
    /// Where its errors were sampled.
    pub samples: String,
    /// Day of the measurement.
    pub day: String,
    /// Its errors at the time factors.
    pub errors: [f64; 3],
    /// Its time, s.
    pub seconds: f64,
    /// The cheapest run that is nowhere worse; `None` where every run is somewhere worse.
    pub ahead: Option<AheadOfPeer>,
}

/// A run that is nowhere worse than another program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AheadOfPeer {
    /// Label of the case.
    pub case: String,
    /// Its errors at the time factors.
    pub errors: [Option<f64>; 3],
    /// Median of its wall times, s.
    pub seconds: f64,
}

/// A convergence test of another program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeerSeriesFinding {
    /// The program and its test.
    pub name: String,
    /// What the errors are of.
    pub quantity: String,
    /// Errors from coarse to fine.
    pub errors: Vec<f64>,
    /// Orders between neighbours.
    pub orders: Vec<Option<f64>>,
    /// Class.
    pub class: Class,
    /// Why it is of that class.
    pub reason: String,
}

impl WallTimeFinding {
    /// The timed runs of a study of several integrators; `None` for others.
    pub fn of_study(results: &StudyResults<'_>) -> Option<Self> {
        let reference = results.study.references.first()?;
        let precision =
            WorkPrecision::of(results.records, reference.name(), &results.study.case_expectations)?;
        let integrators = distinct(precision.runs.iter().map(|run| run.record.case.integrator));
        (integrators.len() > 1).then(|| Self::new(&precision))
    }

    /// What timed runs come to.
    pub fn new(precision: &WorkPrecision<'_>) -> Self {
        let fronts = precision.fronts().into_iter().map(|front| WallTimeFront {
            method: front.method.to_string(),
            integrator: front.integrator,
            points: front.runs.iter().map(|run| (run.wall.median, run.error)).collect(),
        });
        let cheapest = precision.cheapest.iter().map(|cheapest| CheapestTimed {
            tolerance: cheapest.tolerance,
            run: cheapest.run.as_ref().map(TimedRunFinding::new),
            is_confirmed: cheapest.is_confirmed,
        });
        Self {
            fronts: fronts.collect(),
            cheapest: cheapest.collect(),
            noise: precision.noise_floor,
            peers: peers::solve_their_column(&precision.runs).then(|| PeersFinding::new(&precision.runs)),
        }
    }
}

impl TimedRunFinding {
    fn new(run: &TimedRun<'_>) -> Self {
        let (case, counters) = (&run.record.case, &run.record.counters);
        let counted = |work: u64| Some(work).filter(|_| case.counts_work());
        Self {
            case: case.label(),
            error: run.error,
            seconds: run.wall.median,
            deviation: run.wall.deviation,
            steps: counted(counters.steps),
            point_updates: counted(counters.point_updates),
        }
    }
}

impl PeersFinding {
    fn new(runs: &[TimedRun<'_>]) -> Self {
        let line = |(name, peers): (String, Vec<&Peer>)| NamedLine {
            name,
            points: peers.iter().map(|peer| (peer.seconds, peer.worst_error())).collect(),
        };
        let series = peers::PEER_SERIES.iter().map(|series| {
            let found = series.classified();
            PeerSeriesFinding {
                name: series.name.clone(),
                quantity: series.quantity.clone(),
                errors: series.levels.iter().map(|(_, error)| *error).collect(),
                orders: series.orders().into_iter().map(Result::ok).collect(),
                class: found.class,
                reason: found.reason,
            }
        });
        Self {
            time_factors: peers::TIME_FACTORS,
            lines: peers::by_program_and_scheme().into_iter().map(line).collect(),
            rows: peers::compare(runs).iter().map(PeerRow::new).collect(),
            series: series.collect(),
        }
    }
}

impl PeerRow {
    fn new(Comparison { peer, ahead }: &Comparison<'_, '_>) -> Self {
        Self {
            program: peer.name.clone(),
            kind: peer.kind.clone(),
            cells: peer.cells,
            time_scheme: peer.time_scheme.clone(),
            samples: peer.samples.clone(),
            day: peer.day.clone(),
            errors: peer.errors(),
            seconds: peer.seconds,
            ahead: ahead.as_ref().map(|(run, errors)| AheadOfPeer {
                case: run.record.case.label(),
                errors: *errors,
                seconds: run.wall.median,
            }),
        }
    }
}
