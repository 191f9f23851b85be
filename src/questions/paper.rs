//! Does it reproduce the paper? The runs of the paper's method on the columns of Figs 3 and 4 of Zheng et al. (2021), and how
//! far they and the printed equations are from the exact solutions.

use crate::case::contender::PAPERS;
use crate::case::{Case, Quantity, Sample};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::profiles::{consolidation, consolidation_title, isochrones, largest_error, off_theory};
use crate::questions::published_equations::{END, LARGE_STRAIN_LOAD, PublishedEquations, QUOTED_CELLS};
use crate::questions::words;
use crate::record::{Record, Status};
use crate::render::chart::Size;
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Table, columns};
use oedometer_exact::ExactError;
use oedometer_scenes::column::Column;
use oedometer_scenes::{TERZAGHI, XIE_LEO};
use oedometer_soil::material::Material;

/// Does it reproduce the paper?
pub static PAPER: Question = Question {
    id: "paper",
    heading: "Does it reproduce the paper?",
    template: include_str!("paper.md"),
    places: &[Place::Report],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Method: the paper's.
    method: String,
    /// Cells over the height: the paper's.
    cells: usize,
    /// Largest relative L2 error of the pressure at the points over all outputs of all figures.
    error: Option<f64>,
    /// Load of the column at large strain, Pa.
    load: f64,
    /// Final settlement of the equations as printed over Xie & Leo's, less one; with the figure at large strain.
    printed_settlement: Option<f64>,
    /// Largest relative L2 difference of their pressures.
    printed_pressure: Option<f64>,
}

fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    // Fig. 3 is at small strain.
    let figures = [3, LARGE_STRAIN_FIGURE].into_iter();
    let runs: Vec<_> = figures.filter_map(|number| PaperRun::new(number, studies)).collect();
    if runs.is_empty() {
        return Ok(None);
    }
    let is_large = runs.iter().any(|run| run.number == LARGE_STRAIN_FIGURE);
    let printed = is_large.then(PublishedEquations::new).transpose()?;
    let departures = printed.iter().flat_map(|printed| &printed.departures);
    let facts = Facts {
        method: PAPERS.to_owned(),
        cells: QUOTED_CELLS,
        error: runs.iter().filter_map(PaperRun::error).map(|(error, _)| error).reduce(f64::max),
        load: LARGE_STRAIN_LOAD,
        printed_settlement: printed.as_ref().map(|printed| printed.final_settlement),
        printed_pressure: departures.map(|departure| departure.pressure).reduce(f64::max),
    };
    let header = "Figs | method | > largest error of the pressure | > at T_v";
    let rows = runs.iter().flat_map(PaperRun::rows);
    let against = runs.iter().map(|run| words::solution(run.results.study.references[0].name()));
    let note = format!("relative L_2 error at the points against {}", against.collect::<Vec<_>>().join("; "));
    let table = Table::of("The paper's method and others on its columns", columns(header), rows);
    let mut figures = Vec::new();
    for run in &runs {
        figures.extend(run.figures()?);
    }
    let finding = PAPER
        .answer(runs.iter().map(|run| run.results.study.name.as_str()), &facts)
        .with(Block::Figures(figures))
        .with(Block::Table(table.file("paper").note(note)));
    Ok(Some(match &printed {
        Some(printed) => finding.with(Block::Table(table_of_equations(printed))),
        None => finding,
    }))
}

/// The equations as they are printed beside Xie & Leo's solution, exact against exact.
fn table_of_equations(printed: &PublishedEquations) -> Table {
    let rows = printed
        .departures
        .iter()
        .map(|departure| [departure.time_factor, departure.settlement, departure.pressure]);
    let rows = rows.map(|[time, settlement, pressure]| {
        vec![Cell::Number(time), Cell::Percent(settlement), Cell::Percent(pressure)]
    });
    let settled = Cell::Percent(printed.final_settlement);
    let rows = rows.chain([vec![Cell::Number(END), settled, Cell::missing("no pressure is left")]]);
    let header = "> T_v | > settlement, difference | > pressure, relative L_2 difference";
    Table::of(
        "The equations as printed, before any discretisation, against Xie & Leo's",
        columns(header),
        rows,
    )
    .file("printed-equations")
    .note("porosity-dependent law, constant porosity gradient; the last row is final: nothing moves any more")
}

/// The size of one figure of four in a row, which a phone shows too.
const QUARTER: Size = Size { width: 368.0, plot_height: 300.0 };

/// A figure as one of the four.
fn quarter(mut figure: Figure, number: &str, finding: &str) -> Figure {
    figure.name = format!("paper-fig-{number}");
    figure.with_chart(|chart| {
        chart.title = format!("Fig. {number}: {finding}");
        chart.size = QUARTER;
    })
}

/// The run of one of the paper's figures.
struct PaperRun<'b, 'a> {
    number: u32,
    results: &'b StudyResults<'a>,
    record: &'a Record,
}

/// Methods beside each other in a figure and in the table, the paper's first.
const MOST_METHODS: usize = 5;
const MOST_ROWS: usize = 3;

/// Number of the figure at large strain.
const LARGE_STRAIN_FIGURE: u32 = 4;

impl<'b, 'a> PaperRun<'b, 'a> {
    /// The sound run of the paper's method on the paper's mesh with most outputs, the first of equals.
    fn new(number: u32, results: &'b [StudyResults<'a>]) -> Option<Self> {
        let fits = |record: &&Record| {
            let case = &record.case;
            record.status == Status::Ok
                && record.stability.is_none()
                && case.method.to_string() == PAPERS
                && case.cells == QUOTED_CELLS
                && is_papers_column(case, number == LARGE_STRAIN_FIGURE)
                && case.variant().is_empty()
        };
        let of_study = |results: &'b StudyResults<'a>| {
            results.records.iter().filter(fits).map(move |record| Self { number, results, record })
        };
        let outputs = |run: &Self| run.record.case.time_factors.len();
        let all = results.iter().flat_map(of_study);
        all.reduce(|best, next| if outputs(&next) > outputs(&best) { next } else { best })
    }

    /// The run with those of other methods that differ in nothing else.
    fn beside(&self) -> Vec<&'a Record> {
        let mut shown = vec![self.record];
        for record in self.results.records {
            let mut same = record.case.clone();
            same.method = self.record.case.method;
            let is_new = shown.iter().all(|other| other.case.method != record.case.method);
            let is_sound = record.status == Status::Ok;
            if is_new && is_sound && same == self.record.case && shown.len() < MOST_METHODS {
                shown.push(record);
            }
        }
        shown
    }

    /// The largest error of the pressure at the points over all outputs, and its time factor.
    fn error(&self) -> Option<(f64, f64)> {
        largest_pressure_error(self.record, self.results.study.references[0].name())
    }

    /// The isochrones of the run, and the consolidation beside other methods.
    fn figures(&self) -> Result<[Figure; 2], ExactError> {
        let own = self.results.study.references[0];
        let settlement = consolidation(&self.beside(), own)?;
        let of_papers = consolidation_title(&[self.record], &settlement.chart.series[0].points);
        let [a, b] = ["a", "b"].map(|letter| format!("{}{letter}", self.number));
        Ok([
            quarter(isochrones(self.record, own)?, &a, &off_theory("pressure", PAPERS, self.error())),
            quarter(settlement, &b, &of_papers),
        ])
    }

    /// A row for the paper's method, and for those that come nearest and differ in nothing else.
    fn rows(&self) -> Vec<Vec<Cell>> {
        let reference = self.results.study.references[0].name();
        let row = |record: &Record| {
            let error = largest_pressure_error(record, reference);
            vec![
                format!("{0}a, {0}b", self.number).into(),
                Cell::Code(record.case.method.to_string()),
                Cell::of(error.map(|(error, _)| error), Cell::Percent, "no error was measured"),
                Cell::of(error.map(|(_, time)| time), Cell::Number, "no error was measured"),
            ]
        };
        let mut shown = self.beside();
        let error =
            |record: &Record| largest_pressure_error(record, reference).map_or(f64::INFINITY, |one| one.0);
        shown[1..].sort_by(|a, b| error(a).total_cmp(&error(b)));
        shown.truncate(MOST_ROWS);
        shown.into_iter().map(row).collect()
    }
}

/// The largest error of the pressure at the points over all outputs, and its time factor.
pub(crate) fn largest_pressure_error(record: &Record, reference: &str) -> Option<(f64, f64)> {
    largest_error(record, Quantity::Pressure, Sample::Points, reference)
}

/// Whether a case is of the soil, height and, at large strain, load of Figs 3 and 4.
fn is_papers_column(case: &Case, is_large: bool) -> bool {
    let (scene, load) = if is_large { (&XIE_LEO, LARGE_STRAIN_LOAD) } else { (&TERZAGHI, case.column.load) };
    let papers = Column { load, points: case.column.points, ..Column::default() };
    let soil =
        Material { law: case.material.law, continuity: case.material.continuity, ..Material::default() };
    case.scene == scene && *case.column == papers && *case.material == soil
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;
    use crate::study::check::Study;

    /// A study with the pressure errors of the paper's method on ten cells, by time; all others are larger.
    fn with_errors(name: &str, head: &str, outputs: &str, methods: &str) -> (Study, Vec<Record>) {
        let text = format!(
            "title = 't'\n{head}\noutput.time_factors = {outputs}\n[[sweep]]\nmethod = {methods}\n\
             integrator = ['implicit']\ncells = [8, 10]\ntime_step = [{{ growth = 0.3 }}]\n"
        );
        let (study, mut records) = solved(name, &text);
        let own = study.references[0].name();
        for record in &mut records {
            let is_papers = record.case.cells == 10 && record.case.method.to_string() == PAPERS;
            for row in &mut record.errors {
                let is_meant = (row.quantity, row.sample) == (Quantity::Pressure, Sample::Points);
                let error = if row.time_factor == 0.2 { -0.03 } else { 0.02 };
                row.value = if is_papers && is_meant && row.reference == own { error } else { 0.7 };
            }
        }
        (study, records)
    }

    /// Three studies of the small column, of which the second has most outputs and a failed run, and one of the large.
    fn columns() -> [(Study, Vec<Record>); 4] {
        let methods = "['MPM', 'GC-SRI-patch', 'GIMP', 'GIMP-SRI', 'GIMP-mean']";
        let small = |name: &str, outputs: &str| with_errors(name, "scene = 'terzaghi'", outputs, methods);
        let mut all = [
            small("few", "[0.2]"),
            small("most", "[0.1, 0.2]"),
            small("as-many", "[0.2, 0.3]"),
            with_errors("large", "scene = 'xie-leo'\ncolumn.load = 200e3", "[0.1]", "['GC-SRI-patch']"),
        ];
        for record in all[1].1.iter_mut().filter(|one| one.case.method.to_string() == "MPM") {
            record.status = failed_at(1);
        }
        all
    }

    #[test]
    fn the_figures_and_the_sentence_are_of_the_papers_sound_run_with_most_outputs() {
        let all = columns();
        let answered = |all: &[(Study, Vec<Record>)]| {
            let results: Vec<_> =
                all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
            ask(&results).expect("sound")
        };
        let found = answered(&all).expect("answered");
        let [Block::Figures(figures), Block::Table(runs), Block::Table(equations)] = &found.parts[..] else {
            panic!("{found:?}")
        };
        let shown = |table: &Table| -> Vec<String> {
            let row = |row: &Vec<Cell>| row.iter().map(Cell::show).collect::<Vec<_>>().join(" | ");
            table.rows.iter().map(row).collect()
        };
        assert_eq!(
            shown(runs),
            [
                "3a, 3b | GC-SRI-patch | 3.00 % | 0.2",
                "3a, 3b | GIMP | 70.0 % | 0.2",
                "3a, 3b | GIMP-SRI | 70.0 % | 0.2",
                "4a, 4b | GC-SRI-patch | 2.00 % | 0.1"
            ]
        );
        assert_eq!(
            shown(equations)[..2],
            ["0.0079 | 7.85 % | 2.79 %", "0.1 | 7.67 % | 6.90 %"],
            "settlement, then pressure"
        );
        assert_eq!(shown(equations)[6], "10 | -6.94 % | –", "the final one that the sentence quotes");
        let told = found.sentence().expect("a sentence");
        assert!(
            told.contains("on 10 cells the pressure of `GC-SRI-patch` is within 3.00 % of them"),
            "{told}"
        );
        assert!(
            told.contains("at 200 kPa their final settlement is −6.9 % and their pressure up to 41 % off"),
            "{told}"
        );
        assert_eq!(found.studies, ["most", "large"]);
        let drawn = |figure: &Figure| {
            let series =
                figure.chart.series.iter().map(|one| one.name.as_str()).collect::<Vec<_>>().join(" | ");
            format!("{}: {}: {series}", figure.name, figure.chart.title)
        };
        let drawn: Vec<String> = figures.iter().map(drawn).collect();
        // The theory by its name.
        let (small_strain, large_strain) = (
            "Terzaghi's solution with compressible water",
            "Exact large-strain solution of its own equations",
        );
        assert_eq!(
            drawn[..3],
            [
                &*format!(
                    "paper-fig-3a: Fig. 3a: pressure of GC-SRI-patch is up to 3.00 % off, at T_v = 0.2: {small_strain} | T_v = 0.1 | {small_strain} | T_v = 0.2"
                ),
                // That of MPM failed.
                &*format!(
                    "paper-fig-3b: Fig. 3b: U of GC-SRI-patch is up to 0.018 off, at T_v = 0.001119: {small_strain} | \
                     GC-SRI-patch | GIMP | GIMP-SRI | GIMP-mean"
                ),
                &*format!(
                    "paper-fig-4a: Fig. 4a: pressure of GC-SRI-patch is up to 2.00 % off, at T_v = 0.1: {large_strain} | T_v = 0.100, U = 36 %"
                ),
            ]
        );
        assert_eq!(
            drawn[3],
            format!(
                "paper-fig-4b: Fig. 4b: U of GC-SRI-patch is up to 0.015 off, at T_v = 0.001: {large_strain} | GC-SRI-patch"
            )
        );
        assert!(figures.iter().all(|figure| figure.chart.size == QUARTER));
    }

    #[test]
    fn on_other_meshes_with_other_methods_and_by_failed_runs_nothing_is_reproduced() {
        let (study, records) = with_errors("s", "scene = 'terzaghi'", "[0.1]", "['GC-SRI-patch', 'MPM']");
        let answered = |change: fn(&mut Record)| {
            let mut records = records.clone();
            records.iter_mut().filter(|record| record.case.method.to_string() == PAPERS).for_each(change);
            ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("sound")
        };
        assert!(answered(|_| ()).is_some());
        assert_eq!(answered(|record| record.case.cells = 8), None);
        assert_eq!(answered(|record| record.status = failed_at(1)), None);
    }

    #[test]
    fn only_the_papers_column_reproduces_the_paper() {
        for (scene, inputs, is_papers) in [
            ("terzaghi", "", true),
            ("xie-leo", "[column]\nload = 200e3", true),
            ("terzaghi", "[material]\nyoungs_modulus = 2e6", false),
            ("terzaghi", "[column]\nheight = 5.0", false),
            ("xie-leo", "[column]\nload = 100e3", false),
        ] {
            let text = format!(
                "title = 't'\nscene = '{scene}'\n{inputs}\n[output]\ntime_factors = [0.1]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n"
            );
            let (study, records) = solved("s", &text);
            let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]);
            assert_eq!(found.expect("sound").is_some(), is_papers, "{scene} {inputs}");
        }
    }
}
