//! Does it reproduce the paper? Figs 3a, 3b, 4a and 4b of Zheng et al. (2021), on the paper's axes.

use crate::questions::answers::paper::{PaperCurves, PaperFinding};
use crate::questions::sentence;
use crate::questions::words;
use crate::render::RenderError;
use crate::render::chart::{Size, Style};
use crate::render::page::{Block, Figure, Section};
use crate::report::answers::Question;
use crate::report::blocks::fields::theory_lines;

const QUESTION: Question = Question { heading: "Does it reproduce the paper?", id: "paper" };

/// The size of one figure of four in a row.
const QUARTER: Size = Size { width: 400.0, plot_height: 300.0, equal_units: false };

/// How far the runs are from theory, the figures with the theory's lines, and how far the printed equations are from it.
pub fn section(paper: &PaperFinding) -> Result<Section, RenderError> {
    let mut figures = Vec::new();
    for curves in &paper.curves {
        let PaperCurves { number, isochrones, consolidation } = curves;
        let pair = [
            (theory_lines::isochrones("paper", isochrones), 'a'),
            (theory_lines::consolidation("paper", consolidation), 'b'),
        ];
        for (figure, letter) in pair {
            figures.push(quarter(figure, &format!("{number}{letter}"), &isochrones.reference));
        }
    }
    let mut blocks = vec![Block::Figures(figures)];
    if let Some(printed) = &paper.printed {
        blocks.push(Block::Paragraph(sentence::sentence("printed-equations", printed)?));
    }
    let studies = paper.figures.iter().map(|figure| figure.study.as_str());
    Ok(QUESTION.answered(&sentence::sentence("paper", paper)?, studies, blocks))
}

/// A figure of the report as one of the four.
fn quarter(mut figure: Figure, number: &str, theory: &str) -> Figure {
    figure.name = format!("readme-fig-{number}");
    figure.with_chart(|chart| {
        chart.title = format!("Fig. {number}: {}", chart.title);
        chart.size = QUARTER;
        for series in chart.series.iter_mut().filter(|series| series.style == Style::Theory) {
            series.name = words::theory(theory);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::contender::PAPERS;
    use crate::case::planned::Tier;
    use crate::case::{Quantity, Sample};
    use crate::questions::study_results::StudyResults;
    use crate::record::Record;
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
            let paper = PaperFinding::new(&results).expect("sound")?;
            Some(section(&paper).expect("a section"))
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
            "Compared are exact solutions, not the published curves, which are not digitised. Figs 3a and 3b of Zheng et al. (2021): on 10 cells the pressure of `GC-SRI-patch` is within 3.00 % of Terzaghi's solution with \
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
            "Exact large-strain solution of its own equations",
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
