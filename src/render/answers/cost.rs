//! What does accuracy cost? Error over wall time with the front named, other programs' measured points, and a comparison
//! on the same number of cells.

use crate::case::contender::PAPERS;
use crate::judge::comparison::peers;
use crate::judge::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::render::answers::{Answer, Question, short, study_with_most};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::{StudyResults, cost};

const QUESTION: Question = Question { heading: "What does accuracy cost?", id: "cost" };

/// Sentence, figure and the other programs.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let (one, precision) = study_with_most(results, |one| {
        let own = one.study.references.first().filter(|_| one.study.timing_repeats > 1)?;
        let precision = WorkPrecision::of(one.records, own.name())?;
        Some((precision.runs.len(), precision))
    })?;
    let figure = Figure::new("readme-cost", cost::chart_of(&precision), cost::caption(&precision));
    let mut blocks = vec![Block::Figure(figure)];
    if peers::solve_their_column(&precision.runs) {
        blocks.push(Block::Paragraph(equal_cells(&precision)));
        blocks.push(Block::Table(short(cost::peers_table(&precision), "on the page of the study")));
    }
    Some(QUESTION.told(&sentence(&precision), [one.study.name.as_str()], blocks))
}

/// The cheapest way to each tolerance.
fn sentence(precision: &WorkPrecision<'_>) -> String {
    let ways = precision.cheapest.iter().map(|cheapest| {
        let tolerance = number::percent(cheapest.tolerance);
        cheapest.run.as_ref().map_or(format!("no timed run is within {tolerance}"), |run| {
            let seconds = number::seconds(run.wall.median);
            format!("{tolerance} costs {seconds} (`{}`)", run.record.case.label())
        })
    });
    format!("Cost of an error of the pressure: {}.", ways.collect::<Vec<_>>().join("; "))
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

/// Where the other programs are ahead on the same number of cells and with a time scheme of the same kind.
fn equal_cells(precision: &WorkPrecision<'_>) -> String {
    let ahead = peers::PEERS.iter().filter(|peer| peer.time_scheme.starts_with("SDIRK")).filter_map(|peer| {
        let cells = peer.cells;
        let pairs = peer.errors().into_iter().zip(on_cells(precision, cells)?).zip(peers::TIME_FACTORS);
        let better = pairs.filter_map(|((theirs, own), time)| {
            let own = own.filter(|own| theirs < *own)?;
            Some(format!("{} against {} at T_v = {time}", number::error(theirs), number::error(own)))
        });
        let better = better.collect::<Vec<_>>().join(", ");
        (!better.is_empty()).then(|| format!("{}, {} on {cells} cells: {better}", peer.name, peer.kind))
    });
    let ahead = ahead.collect::<Vec<_>>().join("; ");
    if ahead.is_empty() {
        return format!("On equal cells no other program has a smaller pressure error than `{PAPERS}`.");
    }
    format!(
        "**On equal cells and with like time steps mixed elements have a smaller pressure error than `{PAPERS}`**: {ahead}. \
         The figure shows the time that an error costs."
    )
}
