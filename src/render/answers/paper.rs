//! Does it reproduce the paper? Figs 3a, 3b, 4a and 4b of Zheng et al. (2021), on the paper's axes.

use crate::case::Case;
use crate::case::contender::PAPERS;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::published_equations::{LARGE_STRAIN_LOAD, PublishedEquations};
use crate::judge::study_results::StudyResults;
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question};
use crate::render::chart::{Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::labels::{self, QUOTED_CELLS, first_measure};
use crate::render::report::theory_lines;
use crate::render::{RenderError, templates};
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::Column;
use oedometer_soil::material::Material;

const QUESTION: Question = Question { heading: "Does it reproduce the paper?", id: "paper" };

/// Number of the figure at large strain.
const LARGE_STRAIN_FIGURE: u32 = 4;

/// Methods of a figure of consolidation, the paper's first.
const MOST_METHODS: usize = 3;

/// The size of one figure of four in a row.
const QUARTER: Size = Size { width: 400.0, plot_height: 300.0, equal_units: false };

/// The paper's column at small or at large strain: its run of the paper's method on ten cells.
struct PaperRun<'a> {
    results: &'a StudyResults<'a>,
    record: &'a Record,
}

/// Four figures with the theory line, and how far the runs are from it.
pub fn answer(results: &[StudyResults<'_>]) -> Result<Answer, RenderError> {
    let runs: Vec<(u32, PaperRun<'_>)> = [(3, false), (LARGE_STRAIN_FIGURE, true)]
        .into_iter()
        .filter_map(|(number, is_large)| Some((number, run_of(results, is_large)?)))
        .collect();
    if runs.is_empty() {
        return Ok(None);
    }
    let mut figures = Vec::new();
    let mut sentences = Vec::new();
    for (number, run) in &runs {
        let own = run.results.study.references[0];
        figures.push(quarter(
            theory_lines::isochrones(run.results, run.record)?,
            &format!("{number}a"),
            own.name(),
        ));
        let shown = beside(run);
        figures.push(quarter(
            theory_lines::consolidation(run.results, &shown)?,
            &format!("{number}b"),
            own.name(),
        ));
        if let Some((error, at)) = largest_error(run.record, own.name()) {
            sentences.push(format!(
                "Figs {number}a and {number}b: on {QUOTED_CELLS} cells the pressure of `{PAPERS}` is within {} of {} at every \
                 output (relative L_2 error at the points; the largest at T_v = {at}).",
                number::percent(error),
                labels::solution(own.name())
            ));
        }
    }
    let studies = runs.iter().map(|(_, run)| run.results.study.name.as_str());
    let mut shown = vec![Block::Figures(figures)];
    if runs.iter().any(|(number, _)| *number == LARGE_STRAIN_FIGURE) {
        let printed = PublishedEquations::new()?;
        shown.push(Block::Paragraph(templates::render(&templates::environment()?, "paper", &printed)?));
    }
    Ok(Some(QUESTION.told(&sentences.join(" "), studies, shown)))
}

/// The sound run of the paper's method on the paper's mesh with most outputs.
fn run_of<'a>(results: &'a [StudyResults<'a>], is_large: bool) -> Option<PaperRun<'a>> {
    let fits = |record: &&Record| {
        let case = &record.case;
        record.status == Status::Ok
            && record.stability.is_none()
            && case.method.to_string() == PAPERS
            && case.cells == QUOTED_CELLS
            && is_papers_column(case, is_large)
            && case.variant().is_empty()
    };
    let all = results
        .iter()
        .flat_map(|one| one.records.iter().filter(fits).map(move |record| PaperRun { results: one, record }));
    // The first of those with most outputs.
    all.reduce(|best, next| {
        if next.record.case.time_factors.len() > best.record.case.time_factors.len() { next } else { best }
    })
}

/// Whether a case is of the soil, height and, at large strain, load of Figs 3 and 4.
fn is_papers_column(case: &Case, is_large: bool) -> bool {
    let (scene, load) = if is_large {
        (SceneKind::XieLeo, LARGE_STRAIN_LOAD)
    } else {
        (SceneKind::Terzaghi, case.column.load)
    };
    let papers = Column { load, points: case.column.points, ..Column::default() };
    let soil =
        Material { law: case.material.law, continuity: case.material.continuity, ..Material::default() };
    case.scene == scene && *case.column == papers && *case.material == soil
}

/// The paper's run with those of other methods that differ in nothing else.
fn beside<'a>(run: &PaperRun<'a>) -> Vec<&'a Record> {
    let mut shown = vec![run.record];
    for record in run.results.records {
        let mut same = record.case.clone();
        same.method = run.record.case.method;
        let is_new = shown.iter().all(|other| other.case.method != record.case.method);
        if is_new && same == run.record.case && record.status == Status::Ok && shown.len() < MOST_METHODS {
            shown.push(record);
        }
    }
    shown
}

/// A figure of the report as one of the four.
fn quarter(mut figure: Figure, number: &str, theory: &str) -> Figure {
    figure.name = format!("readme-fig-{number}");
    figure.with_chart(|chart| {
        chart.title = format!("Fig. {number}: {}", chart.title);
        chart.size = QUARTER;
        for series in chart.series.iter_mut().filter(|series| series.style == Style::Theory) {
            labels::solution(theory).clone_into(&mut series.name);
        }
    })
}

/// The largest error of the pressure at the points over all outputs, and its time factor.
pub(crate) fn largest_error(record: &Record, reference: &str) -> Option<(f64, f64)> {
    let times = record.case.time_factors.iter();
    let errors = times.filter_map(|time| {
        let measure = first_measure(Quantity::Pressure, Sample::Points, reference, *time);
        Some((measure.error(record)?.value.abs(), *time))
    });
    errors.max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;
    use crate::study::check::Study;

    #[test]
    fn only_the_papers_column_is_said_to_reproduce_the_paper() {
        let answered = |scene: &str, inputs: &str| {
            let text = format!(
                "title = 't'\nscene = '{scene}'\n{inputs}\n[output]\ntime_factors = [0.1]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n"
            );
            let (study, records) = solved("s", &text);
            let results = [StudyResults::new(&study, &records, Tier::Full)];
            answer(&results).expect("an answer").is_some()
        };
        assert!(answered("terzaghi", ""));
        assert!(answered("xie-leo", "[column]\nload = 200e3"));
        assert!(!answered("terzaghi", "[material]\nyoungs_modulus = 2e6"));
        assert!(!answered("terzaghi", "[column]\nheight = 5.0"));
        assert!(!answered("xie-leo", "[column]\nload = 100e3"));
    }

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

    #[test]
    fn the_figures_and_the_sentence_are_of_the_papers_sound_run_with_most_outputs() {
        let methods = "['MPM', 'GC-SRI-patch', 'GIMP', 'GIMP-SRI', 'GIMP-mean']";
        let small = |name: &str, outputs: &str| with_errors(name, "scene = 'terzaghi'", outputs, methods);
        let mut all = [
            small("few", "[0.2]"),
            small("most", "[0.1, 0.2]"),
            small("as-many", "[0.2, 0.3]"),
            with_errors("large", "scene = 'xie-leo'\ncolumn.load = 200e3", "[0.1]", "['GC-SRI-patch']"),
        ];
        let failed = failed_at(1);
        for record in all[1].1.iter_mut().filter(|one| one.case.method.to_string() == "MPM") {
            record.status = failed.clone();
        }
        let answered = |all: &[(Study, Vec<Record>)]| {
            let results: Vec<_> =
                all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
            answer(&results).expect("an answer")
        };
        let section = answered(&all).expect("answered");
        let [Block::Paragraph(sentence), Block::Figures(figures), Block::Paragraph(printed)] =
            &section.blocks[..]
        else {
            panic!("three")
        };
        assert!(
            printed.contains("settlement +7.8 %, +7.7 %, +6.8 %, +3.2 %, −2.7 %, −3.9 % and pressure 3 %, 7 %, 11 %, 20 %, 36 %, 41 % at")
                && printed.contains("final settlement −6.9 %."),
            "{printed}"
        );
        assert_eq!(
            *sentence,
            "Figs 3a and 3b: on 10 cells the pressure of `GC-SRI-patch` is within 3.00 % of Terzaghi's solution with \
             compressible water at every output (relative L_2 error at the points; the largest at T_v = 0.2). Figs 4a and \
             4b: on 10 cells the pressure of `GC-SRI-patch` is within 2.00 % of the exact large-strain solution of its own \
             equations at every output (relative L_2 error at the points; the largest at T_v = 0.1). Evidence: \
             [`most`](studies/most.html), [`large`](studies/large.html)."
        );
        let told = |figure: &Figure| {
            let series =
                figure.chart.series.iter().map(|one| one.name.as_str()).collect::<Vec<_>>().join(" | ");
            format!("{}: {}: {series}", figure.name, figure.chart.title)
        };
        let told: Vec<String> = figures.iter().map(told).collect();
        // The theory by its name.
        let (small_strain, large_strain) = (
            "Terzaghi's solution with compressible water",
            "the exact large-strain solution of its own equations",
        );
        assert_eq!(
            told[..3],
            [
                &*format!(
                    "readme-fig-3a: Fig. 3a: Isochrones, GC-SRI-patch: {small_strain} | T_v = 0.1 | {small_strain} | T_v = 0.2"
                ),
                // That of MPM failed, and three are enough.
                &*format!(
                    "readme-fig-3b: Fig. 3b: Degree of consolidation: {small_strain} | GC-SRI-patch | GIMP | GIMP-SRI"
                ),
                &*format!(
                    "readme-fig-4a: Fig. 4a: Isochrones, GC-SRI-patch: {large_strain} | T_v = 0.100, U = 36 %"
                ),
            ]
        );
        assert_eq!(
            told[3],
            format!("readme-fig-4b: Fig. 4b: Degree of consolidation: {large_strain} | GC-SRI-patch")
        );
        assert!(figures.iter().all(|figure| figure.chart.size == QUARTER));
        for (_, records) in &mut all {
            records.retain(|record| record.case.method.to_string() != PAPERS || record.case.cells != 10);
        }
        assert_eq!(answered(&all), None, "on other meshes and with other methods nothing is reproduced");
        let mut lost = [with_errors("lost", "scene = 'terzaghi'", "[0.1]", "['GC-SRI-patch']")];
        lost[0].1.iter_mut().for_each(|record| record.status = failed.clone());
        assert_eq!(answered(&lost), None, "nor by a run that failed");
    }
}
