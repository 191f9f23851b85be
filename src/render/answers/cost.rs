//! What does accuracy cost? One figure of error over wall time with the front named, other programs'
//! measured points on it, and the same cells held against each other.

use crate::case::IntegratorKind;
use crate::judge::comparison::peers::{self, Peer};
use crate::judge::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::render::answers::question::{Answer, Links, Question, link, short};
use crate::render::answers::regime::PAPERS;
use crate::render::chart::describe::{Chart, ChartAxis, PointName, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};

/// The question.
pub const QUESTION: Question = Question { heading: "What does accuracy cost?", id: "cost" };

/// Slot of the other programs' markers, apart from those of the integrators.
const PEERS_SLOT: usize = 6;

/// Sentence, figure and the other programs.
pub fn answer(results: &[StudyResults<'_>], links: Links<'_>) -> Answer {
    let compared = results.iter().filter(|one| one.study.timing_repeats > 1).filter_map(|one| {
        let precision = WorkPrecision::of(one.records, one.study.references.first()?.name())?;
        Some((one, precision))
    });
    let Some((one, precision)) = compared.max_by_key(|(_, precision)| precision.runs.len()) else {
        return QUESTION.open("runs that were timed alone: a study with `[timing] repeats = 12`");
    };
    let evidence = format!("Evidence: {}.", link(links, &one.study.name));
    let has_peers = peers::solve_their_column(&precision.runs);
    let figure = Figure::new("readme-cost", chart_of(&precision, has_peers), caption(has_peers));
    let mut blocks = vec![Block::Figure(figure)];
    if has_peers {
        blocks.push(Block::Paragraph(equal_cells(&precision)));
        blocks.push(Block::Table(short(peers_table(&precision), "on the page of the study")));
    }
    QUESTION.told(format!("{} {evidence}", sentence(&precision)), blocks)
}

/// The cheapest way to each tolerance.
fn sentence(precision: &WorkPrecision<'_>) -> String {
    let ways = precision.cheapest.iter().map(|cheapest| match &cheapest.run {
        Some(run) => format!(
            "{} costs {} (`{}`)",
            number::percent(cheapest.tolerance),
            number::seconds(run.wall.median),
            run.record.case.label()
        ),
        None => format!("no timed run is within {}", number::percent(cheapest.tolerance)),
    });
    format!("An error of the pressure within {}.", ways.collect::<Vec<_>>().join("; "))
}

fn point(run: &TimedRun<'_>) -> (f64, f64) {
    (run.wall.median, run.error)
}

/// Runs by their integrator, the front with its names, and the other programs.
fn chart_of(precision: &WorkPrecision<'_>, has_peers: bool) -> Chart {
    let mut chart = Chart::new(
        "Error against wall time",
        ChartAxis::log10("wall time, s"),
        ChartAxis::log10("error of the pore pressure, worst of the outputs (–)"),
    );
    chart.size = Size { width: 1000.0, plot_height: 460.0, equal_units: false };
    for kind in IntegratorKind::ALL {
        let runs = precision.runs.iter().filter(|run| run.record.case.integrator == kind);
        let points: Vec<_> = runs.map(point).collect();
        if !points.is_empty() {
            chart.series.push(Series::new(kind.name(), points).style(Style::Markers));
        }
    }
    let front: Vec<&TimedRun<'_>> = precision.runs.iter().filter(|run| run.on_front).collect();
    chart.series.push(Series::theory(
        "no run is both cheaper and more accurate",
        front.iter().map(|run| point(run)).collect(),
    ));
    chart.names.extend(front.iter().map(|run| PointName { at: point(run), name: short_name(run) }));
    if has_peers {
        let known =
            peers::PEERS.iter().filter_map(|peer| Some((peer, (peer.wall_seconds?, peer.worst_error()?))));
        let known: Vec<(&Peer, (f64, f64))> = known.collect();
        let points = known.iter().map(|(_, at)| *at).collect();
        chart.series.push(Series::new("other programs", points).style(Style::Markers).slot(PEERS_SLOT));
        chart.names.extend(known.iter().map(|(peer, at)| PointName { at: *at, name: name_of_peer(peer) }));
    }
    chart
}

/// What tells a run on the front from its neighbours: method and mesh.
fn short_name(run: &TimedRun<'_>) -> String {
    format!("{}, {}", run.record.case.method, run.record.case.cells)
}

fn name_of_peer(peer: &Peer) -> String {
    peer.cells.map_or_else(|| peer.name.clone(), |cells| format!("{}, {cells}", peer.name))
}

fn caption(has_peers: bool) -> String {
    let own = "Each point is a run, named by method and number of cells. Wall time is the median over repeats taken in rounds over \
               all runs. The line joins the runs than which no other run is both cheaper and more accurate.";
    let others = " Other programs were timed in one sitting of another day, on two cores under load; their error is against \
                  the solution for incompressible water, which differs by 2e-4.";
    format!("{own}{}", if has_peers { others } else { "" })
}

/// The best implicit run of the paper's method on a mesh, and its errors as the peers' were measured.
fn on_cells<'b, 'a>(
    precision: &'b WorkPrecision<'a>,
    cells: usize,
) -> Option<(&'b TimedRun<'a>, [Option<f64>; 3])> {
    let runs = precision.runs.iter().filter(|run| {
        run.record.case.cells == cells
            && run.record.case.method.to_string() == PAPERS
            && !run.record.case.is_explicit()
    });
    let best = runs.min_by(|a, b| a.error.total_cmp(&b.error))?;
    Some((best, peers::comparable_errors(best)))
}

/// Where the other programs are ahead on the same number of cells.
fn equal_cells(precision: &WorkPrecision<'_>) -> String {
    let mut ahead = Vec::new();
    for peer in peers::PEERS.iter() {
        let Some((_, own)) = peer.cells.and_then(|cells| on_cells(precision, cells)) else { continue };
        let better: Vec<String> = peers::TIME_FACTORS
            .iter()
            .zip(peer.errors.iter().zip(own))
            .filter_map(|(time, (theirs, own))| Some((time, (*theirs)?, own?)))
            .filter(|(_, theirs, own)| theirs < own)
            .map(|(time, theirs, own)| {
                format!("{} against {} at T_v = {time}", number::error(theirs), number::error(own))
            })
            .collect();
        if !better.is_empty() && peer.time_scheme.starts_with("SDIRK") {
            let cells = peer.cells.unwrap_or_default();
            ahead.push(format!("{}, {} on {cells} cells: {}", peer.name, peer.kind, better.join(", ")));
        }
    }
    if ahead.is_empty() {
        return format!(
            "On equal cells no other program measured has a smaller pressure error than `{PAPERS}`."
        );
    }
    format!(
        "**On equal cells mixed elements are ahead of `{PAPERS}` where both step alike**, in the error of the pressure: {}. \
         The time to an error is another matter: the figure shows it.",
        ahead.join("; ")
    )
}

fn peers_table(precision: &WorkPrecision<'_>) -> Table {
    let rows = peers::PEERS.iter().map(|peer| {
        let own = peer.cells.and_then(|cells| on_cells(precision, cells));
        let measured = |value: Option<f64>, kind| Cell::of(value, kind, "not measured");
        let mut row: Vec<Cell> = vec![
            peer.name.as_str().into(),
            peer.cells.map_or(Cell::missing("not measured"), |cells| Cell::Count(cells as u64)),
            peer.samples.as_str().into(),
            peer.time_scheme.replace("BE", "backward Euler").as_str().into(),
        ];
        row.extend(peer.errors.map(|error| measured(error, Cell::Error)));
        row.push(measured(peer.seconds, Cell::Seconds));
        row.push(measured(peer.wall_seconds, Cell::Seconds));
        row.push(Cell::of(
            own.as_ref().and_then(|(_, errors)| errors[0]),
            Cell::Error,
            "no run here on as many cells",
        ));
        row.push(Cell::of(
            own.map(|(run, _)| run.wall.median),
            Cell::Seconds,
            "no run here on as many cells",
        ));
        row
    });
    let times = peers::TIME_FACTORS.map(|factor| format!("> p, T_v = {factor}")).join(" | ");
    let header = format!(
        "program | > cells | samples | time scheme | {times} | > CPU | > wall | > {PAPERS} on as many cells, T_v = {} | > its wall time",
        peers::TIME_FACTORS[0]
    );
    Table::of("Other programs on the same column", columns(&header), rows).note(
        "Their CPU and wall times: two cores under load, so that wall is about doubled. Backward Euler: 1000 steps of 0.001 in \
         T_v, whose error in time is all that is left from 20 cells on.",
    )
}
