//! What do other programs reach? Measurements of other programs on Terzaghi's column, by `examples/adapters/run.py`, beside the
//! paper's method on as many cells.

use crate::case::contender::PAPERS;
use crate::case::{Quantity, Sample};
use crate::judge::paths::first_error;
use crate::judge::study_results::StudyResults;
use crate::questions::cost::timed_study;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::work_precision::CostedRun;
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use oedometer_exact::{ExactError, ReferenceKind};
use serde::Deserialize;
use std::sync::LazyLock;

/// What do other programs reach?
pub static PEERS: Question = Question {
    id: "peers",
    heading: "How accurate are other programs?",
    template: include_str!("peers.md"),
    places: &[Place::Study, Place::Report],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// The paper's method.
    method: String,
    /// Runs of other programs whose steps are of the same order, on as many cells.
    compared: usize,
    /// Those of which an error of the pressure is the smaller one.
    ahead: usize,
}

/// Time factors of the comparison.
const TIME_FACTORS: [f64; 3] = [0.05, 0.2, 1.0];

/// Another program on a mesh, as `examples/adapters/run.py` measured it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
struct Peer {
    /// Its name and version.
    #[serde(rename = "program")]
    name: String,
    /// Cells over the height.
    cells: usize,
    /// How it steps through time.
    #[serde(rename = "time scheme")]
    time_scheme: String,
    #[serde(rename = "error at T_v=0.05")]
    early: f64,
    #[serde(rename = "error at T_v=0.2")]
    middle: f64,
    #[serde(rename = "error at T_v=1")]
    late: f64,
    /// Day of the measurement.
    #[serde(rename = "measured on")]
    day: String,
}

impl Peer {
    /// Errors at the time factors.
    fn errors(&self) -> [f64; 3] {
        [self.early, self.middle, self.late]
    }
}

/// Every program that was measured.
static PROGRAMS: LazyLock<Vec<Peer>> = LazyLock::new(|| {
    let text = include_str!("../../examples/adapters/results.csv");
    read(text).expect("a test reads the table of the sources")
});

fn read(text: &str) -> Result<Vec<Peer>, csv::Error> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().collect()
}

fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let timed = timed_study(studies)?;
    Ok(timed.and_then(|(one, precision)| answer(&one.study.name, &precision.runs)))
}

/// Runs of other programs that a page shows, those that are compared first.
const SHOWN_ROWS: usize = 4;

/// `None` where no run of the paper's method can be compared.
fn answer(study: &str, runs: &[CostedRun<'_>]) -> Option<Finding> {
    let mut beside: Vec<(&Peer, [Option<f64>; 3])> =
        PROGRAMS.iter().filter_map(|peer| Some((peer, on_cells(runs, peer.cells)?))).collect();
    // Those that the sentence counts first, then the most accurate: a page shows no more than the first rows.
    let is_compared = |peer: &Peer| peer.time_scheme.starts_with("SDIRK");
    let largest = |peer: &Peer| peer.errors().into_iter().fold(0.0, f64::max);
    beside.sort_by(|(a, _), (b, _)| {
        is_compared(b).cmp(&is_compared(a)).then(largest(a).total_cmp(&largest(b)))
    });
    let compared: Vec<_> = beside.iter().filter(|(peer, _)| is_compared(peer)).collect();
    if compared.is_empty() {
        return None;
    }
    let is_ahead = |peer: &Peer, papers: &[Option<f64>; 3]| {
        peer.errors().iter().zip(papers).any(|(theirs, papers)| papers.is_some_and(|papers| *theirs < papers))
    };
    let ahead = compared.iter().filter(|(peer, papers)| is_ahead(peer, papers)).count();
    let facts = Facts { method: PAPERS.to_owned(), compared: compared.len(), ahead };
    Some(PEERS.answer([study], &facts).with(Block::Table(table(&beside))))
}

/// The errors of the best implicit run of the paper's method on a mesh, measured like those of the other programs.
fn on_cells(runs: &[CostedRun<'_>], cells: usize) -> Option<[Option<f64>; 3]> {
    let fits = |run: &&CostedRun<'_>| {
        let case = &run.record.case;
        case.cells == cells && case.method.to_string() == PAPERS && !case.is_explicit()
    };
    let best = runs.iter().filter(fits).min_by(|a, b| a.error.total_cmp(&b.error))?;
    let reference = ReferenceKind::Terzaghi.name();
    let errors = TIME_FACTORS
        .map(|factor| first_error(best.record, Quantity::Pressure, Sample::Points, reference, factor));
    errors.iter().any(Option::is_some).then_some(errors)
}

fn table(beside: &[(&Peer, [Option<f64>; 3])]) -> Table {
    let rows = beside.iter().map(|(peer, papers)| {
        let mut row = vec![
            Cell::from(peer.name.as_str()),
            Cell::Count(peer.cells as u64),
            peer.time_scheme.as_str().into(),
            peer.day.as_str().into(),
        ];
        row.extend(peer.errors().map(Cell::Error));
        row.extend(papers.map(|error| Cell::of(error, Cell::Error, "not measured")));
        row
    });
    let times = |of: &str| TIME_FACTORS.map(|factor| format!("> {of} at T_v = {factor}")).join(" | ");
    let header =
        format!("program | > cells | time scheme | measured on | {} | {}", times("its error"), times(PAPERS));
    Table::of("Errors of the pressure on Terzaghi's column", columns(&header), rows).file("peers").shown(SHOWN_ROWS).note(
        "the output of these programs, run by examples/adapters/run.py; their times are in examples/adapters/results.csv: \
         clocks of another day, and no counted work",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::SolverName;
    use crate::record::Record;
    use oedometer_problem::integrator::IntegratorKind;
    use oedometer_problem::method::Method;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.2, 1.0]\n[[sweep]]\n\
        method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n";

    fn costed<'a>(records: &'a [Record], errors: &[f64]) -> Vec<CostedRun<'a>> {
        records
            .iter()
            .zip(errors)
            .map(|(record, error)| CostedRun { record, error: *error, work: 1.0 })
            .collect()
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
        let runs = costed(&records, &errors);
        assert_eq!(on_cells(&runs, 10), Some([Some(0.02); 3]));
        assert_eq!(on_cells(&runs, 20), Some([Some(1e-7); 3]));
        assert_eq!(on_cells(&runs, 40), None);
        assert_eq!(on_cells(&costed(&others, &errors), 10), None, "none of the others is comparable");
        let found = answer("s", &runs).expect("runs to compare");
        let alike = |cells: usize| {
            let is = |peer: &&Peer| peer.time_scheme.starts_with("SDIRK") && peer.cells == cells;
            PROGRAMS.iter().filter(is).count()
        };
        // On twenty cells nothing is smaller than 1e-7.
        let counts = ["compared", "ahead"].map(|key| found.facts[key].as_u64());
        assert_eq!(counts, [alike(10) + alike(20), alike(10)].map(|count| Some(count as u64)));
        assert_eq!(found.tables()[0].rows[0][2].show(), PROGRAMS[0].time_scheme, "the counted ones first");
        let of_ten = found.tables()[0].rows.iter().find(|row| row[1] == Cell::Count(10)).expect("ten cells");
        assert_eq!(of_ten[7..], [0.02; 3].map(Cell::Error));
        assert_eq!(
            answer("s", &costed(&others[..2], &errors)),
            None,
            "nothing is said of what was not compared"
        );
    }

    #[test]
    fn every_column_of_the_table_is_the_field_of_its_name_and_a_broken_one_is_refused_with_its_line() {
        let text = include_str!("../../examples/adapters/results.csv");
        let head = text.lines().next().expect("a head");
        let line = "a program,what,20,nodes,steps,0.3,0.5,0.2,1.9,+0.1,4.5,2026-01-02";
        let [peer] = &read(&format!("{head}\n{line}\n")).expect("a table")[..] else { panic!("one peer") };
        assert_eq!((peer.errors(), peer.cells), ([0.3, 0.5, 0.2], 20));
        assert_eq!([&peer.name, &peer.time_scheme, &peer.day], ["a program", "steps", "2026-01-02"]);
        let is_one = |error: &f64| (0.0..1.0).contains(error);
        assert!(PROGRAMS.iter().all(|peer| peer.errors().iter().all(is_one)));
        let broken = read(&text.replacen(",10,", ",many,", 1)).expect_err("no number").to_string();
        assert!(broken.contains("line: 2"), "{broken}");
    }
}
