//! What does accuracy cost? The cheapest run within each tolerance, and other programs on the same number of cells.

use crate::case::contender::PAPERS;
use crate::questions::answers::study_with_most;
use crate::questions::blocks::work::WallTimeFinding;
use crate::questions::comparison::peers;
use crate::questions::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::questions::study_results::StudyResults;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What accuracy costs, in the study with most timed runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CostFinding {
    /// Study.
    pub study: String,
    /// The cheapest run within each tolerance of the pressure.
    pub cheapest: Vec<CheapestRun>,
    /// Other programs, where they solve the same column.
    pub peers: Option<PeersOnEqualCells>,
    /// Every timed run by error and wall time.
    #[serde(default)]
    pub wall_time: WallTimeFinding,
}

/// The cheapest run within a tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheapestRun {
    /// Relative error of the pressure at the points, the largest of all outputs.
    pub tolerance: f64,
    /// The run; none where no run reaches it.
    pub run: Option<RunCost>,
    /// Whether a finer mesh stays within it too.
    #[serde(default)]
    pub is_confirmed: bool,
}

/// A timed run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunCost {
    /// Method.
    pub method: String,
    /// Integrator.
    pub integrator: String,
    /// Cells over the height.
    pub cells: usize,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// Median wall time, s.
    pub seconds: f64,
}

/// Errors of other programs with time schemes of the same kind beside those of the paper's method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeersOnEqualCells {
    /// The paper's method.
    pub method: String,
    /// The first output of each mesh at which another program has the smaller error of the pressure.
    pub ahead: Vec<PeerAhead>,
}

/// Another program with a smaller error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeerAhead {
    /// Name and version.
    pub program: String,
    /// Cells over the height.
    pub cells: usize,
    /// Time factor.
    pub time_factor: f64,
    /// Its error.
    pub error: f64,
    /// The error of the paper's method.
    pub papers_error: f64,
}

/// The study with most timed runs, and these.
fn timed_study<'b, 'a>(results: &'b [StudyResults<'a>]) -> Option<(&'b StudyResults<'a>, WorkPrecision<'a>)> {
    study_with_most(results, |one| {
        let reference = one.study.references.first().filter(|_| one.study.timing_repeats > 1)?;
        let precision = WorkPrecision::of(one.records, reference.name(), &one.study.case_expectations)?;
        Some((precision.runs.len(), precision))
    })
}

impl CostFinding {
    pub(super) fn new(results: &[StudyResults<'_>]) -> Option<Self> {
        let (one, precision) = timed_study(results)?;
        let cheapest = precision.cheapest.iter().map(|cheapest| CheapestRun {
            tolerance: cheapest.tolerance,
            run: cheapest.run.as_ref().map(RunCost::new),
            is_confirmed: cheapest.is_confirmed,
        });
        let is_shared = peers::solve_their_column(&precision.runs);
        Some(Self {
            study: one.study.name.clone(),
            cheapest: cheapest.collect(),
            wall_time: WallTimeFinding::new(&precision),
            peers: if is_shared { PeersOnEqualCells::new(&precision) } else { None },
        })
    }
}

impl RunCost {
    fn new(run: &TimedRun<'_>) -> Self {
        let case = &run.record.case;
        Self {
            method: case.method.to_string(),
            integrator: case.integrator.name().to_owned(),
            cells: case.cells,
            points_per_cell: case.points_per_cell,
            seconds: run.wall.median,
        }
    }
}

impl PeersOnEqualCells {
    /// `None` where no run of the paper's method can be compared.
    fn new(precision: &WorkPrecision<'_>) -> Option<Self> {
        let (mut is_compared, mut ahead) = (false, Vec::new());
        for peer in peers::PEERS.iter().filter(|peer| peer.time_scheme.starts_with("SDIRK")) {
            let Some(papers) = on_cells(precision, peer.cells) else { continue };
            let pairs = peer.errors().into_iter().zip(papers).zip(peers::TIME_FACTORS);
            let pairs: Vec<_> =
                pairs.filter_map(|((error, papers), time)| Some((error, papers?, time))).collect();
            is_compared |= !pairs.is_empty();
            // One time of each shows it; the page of the study has the others.
            ahead.extend(pairs.iter().find(|(error, papers, _)| error < papers).map(
                |(error, papers_error, time_factor)| PeerAhead {
                    program: peer.name.clone(),
                    cells: peer.cells,
                    time_factor: *time_factor,
                    error: *error,
                    papers_error: *papers_error,
                },
            ));
        }
        is_compared.then(|| Self { method: PAPERS.to_owned(), ahead })
    }
}

/// The errors of the best implicit run of the paper's method on a mesh, measured like those of the other programs.
fn on_cells(precision: &WorkPrecision<'_>, cells: usize) -> Option<[Option<f64>; 3]> {
    let fits = |run: &&TimedRun<'_>| {
        let case = &run.record.case;
        case.cells == cells && case.method.to_string() == PAPERS && !case.is_explicit()
    };
    let best = precision.runs.iter().filter(fits).min_by(|a, b| a.error.total_cmp(&b.error))?;
    Some(peers::comparable_errors(best))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::SolverName;
    use crate::measure::statistics::spread;
    use crate::record::Record;
    use oedometer_problem::integrator::IntegratorKind;
    use oedometer_problem::method::Method;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.2, 1.0]\n[[sweep]]\n\
        method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n";

    fn precision<'a>(records: &'a [Record], errors: &[f64]) -> WorkPrecision<'a> {
        let wall = spread(&[1.0, 1.0]).expect("two samples");
        let run = |(record, error): (&'a Record, &f64)| TimedRun { record, error: *error, wall };
        let runs = records.iter().zip(errors).map(run).collect();
        WorkPrecision { runs, cheapest: Vec::new(), noise_floor: None }
    }

    #[test]
    fn other_programs_stand_beside_the_best_implicit_run_of_the_paper_s_method_on_as_many_cells() {
        let seed = records_of(STUDY).remove(0);
        let with = |change: &dyn Fn(&mut Record), error: f64| {
            let mut record = seed.clone();
            change(&mut record);
            record.errors.iter_mut().for_each(|row| row.value = error);
            record
        };
        let mpm = SolverName::Own(Method::named("MPM").expect("a method"));
        // The smaller the error, the less it may be taken.
        let others = [
            with(&|one| one.case.integrator = IntegratorKind::Explicit, 1e-5),
            with(&|one| one.case.method = mpm, 1e-6),
            with(&|one| one.case.cells = 20, 1e-7),
        ];
        let own = [with(&|_| (), 0.03), with(&|_| (), 0.02), with(&|_| (), 0.04)];
        let records = [others.clone(), own].concat();
        let errors = [1e-5, 1e-6, 1e-7, 0.03, 0.02, 0.04];
        let found = precision(&records, &errors);
        assert_eq!(on_cells(&found, 10), Some([Some(0.02); 3]));
        assert_eq!(on_cells(&found, 20), Some([Some(1e-7); 3]));
        assert_eq!(on_cells(&found, 40), None);
        assert_eq!(on_cells(&precision(&others, &errors), 10), None, "none of the others is comparable");
        // Where the paper's method is worse, the programs that step alike are named with both errors, and no others.
        let ahead = PeersOnEqualCells::new(&found).expect("runs to compare").ahead;
        let like = |peer: &&peers::Peer| peer.time_scheme.starts_with("SDIRK") && peer.cells == 10;
        let like = peers::PEERS.iter().find(like).expect("such a program");
        let first = &ahead[0];
        assert_eq!((&first.program, first.cells, first.time_factor), (&like.name, 10, 0.05));
        assert_eq!((first.error, first.papers_error), (like.errors()[0], 0.02));
        assert!(ahead.iter().all(|peer| peer.cells == 10 && !peer.program.contains("Kratos")), "{ahead:?}");
        let good = [with(&|_| (), 1e-9)];
        let compared = PeersOnEqualCells::new(&precision(&good, &errors)).expect("runs to compare");
        assert_eq!(compared.ahead, []);
        let none = PeersOnEqualCells::new(&precision(&others[..2], &errors));
        assert_eq!(none, None, "nothing is said of what was not compared");
    }
}
