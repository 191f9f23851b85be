//! Does it reproduce the paper? Figs 3a, 3b, 4a and 4b of Zheng et al. (2021), on the paper's axes.

use crate::case::Case;
use crate::case::contender::PAPERS;
use crate::case::quantity::{Quantity, Sample};
use crate::record::{Record, Status};
use crate::render::answers::{Answer, Question};
use crate::render::chart::{Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::labels::{self, QUOTED_CELLS, first_measure};
use crate::render::report::{StudyResults, theory_lines};
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::Column;
use oedometer_soil::material::Material;

const QUESTION: Question = Question { heading: "Does it reproduce the paper?", id: "paper" };

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
pub fn answer(results: &[StudyResults<'_>]) -> Result<Answer, ExactError> {
    let runs: Vec<(u32, PaperRun<'_>)> = [(3, false), (4, true)]
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
        figures.push(quarter(theory_lines::isochrones(run.results, run.record)?, &format!("{number}a")));
        let shown = beside(run);
        figures.push(quarter(theory_lines::consolidation(run.results, &shown)?, &format!("{number}b")));
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
    Ok(Some(QUESTION.told(&sentences.join(" "), studies, vec![Block::Figures(figures)])))
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

/// Load of the paper's column at large strain, Pa.
const LARGE_STRAIN_LOAD: f64 = 200e3;

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
fn quarter(mut figure: Figure, number: &str) -> Figure {
    figure.name = format!("readme-fig-{number}");
    figure.with_chart(|chart| {
        chart.title = format!("Fig. {number}: {}", chart.title);
        chart.size = QUARTER;
        for series in chart.series.iter_mut().filter(|series| series.style == Style::Theory) {
            "theory".clone_into(&mut series.name);
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
    use crate::campaign::runner::records_of;
    use crate::case::planned::Tier;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    #[test]
    fn only_the_papers_column_is_said_to_reproduce_the_paper() {
        let answered = |scene: &str, inputs: &str| {
            let text = format!(
                "title = 't'\nscene = '{scene}'\n{inputs}\n[output]\ntime_factors = [0.1]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n"
            );
            let source = StudySource { name: "s.toml".to_owned(), text: text.clone() };
            let study = Study::check(&source).expect("a sound study");
            let records = records_of(&text);
            let results = [StudyResults::new(&study, &records, Tier::Full)];
            answer(&results).expect("an answer").is_some()
        };
        assert!(answered("terzaghi", ""));
        assert!(answered("xie-leo", "[column]\nload = 200e3"));
        assert!(!answered("terzaghi", "[material]\nyoungs_modulus = 2e6"));
        assert!(!answered("terzaghi", "[column]\nheight = 5.0"));
        assert!(!answered("xie-leo", "[column]\nload = 100e3"));
    }
}
