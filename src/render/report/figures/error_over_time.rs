//! Error against wall time over every integrator: the front, the first way to a tolerance, one more
//! level, and other programs.

use crate::case::IntegratorKind;
use crate::judge::comparison::peers;
use crate::judge::comparison::peers::{Comparison, Peer};
use crate::judge::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::render::chart::describe::{Chart, ChartAxis, Series, Style};
use crate::render::page::Block;
use crate::render::report::{StudyResults, labels};
use crate::render::table::{Cell, Table, TableColumn, columns};

/// The comparison of a study with timed runs of several integrators.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let Some(reference) = results.study.references.first() else { return Vec::new() };
    let Some(precision) = WorkPrecision::of(results.records, reference.name()) else { return Vec::new() };
    let several =
        IntegratorKind::ALL.iter().filter(|kind| runs_of(&precision, **kind).next().is_some()).count() > 1;
    if !several {
        return Vec::new();
    }
    let front: Vec<_> = precision.runs.iter().filter(|run| run.on_front).collect();
    let mut blocks = vec![
        Block::Heading("Error against wall time".to_owned()),
        Block::Figure(results.figure("wall-time", chart_of(&precision), caption(&precision))),
        Block::Table(cheapest_table(&precision)),
        Block::Table(runs_table(
            "Runs than which no other is both cheaper and more accurate",
            &front,
            &precision,
        )),
    ];
    if peers::solve_their_column(&precision.runs) {
        blocks.push(Block::Table(peers_table(&peers::compare(&precision.runs))));
    }
    let all: Vec<&TimedRun<'_>> = precision.runs.iter().collect();
    blocks.push(Block::Details {
        summary: format!("All {} timed runs", all.len()),
        blocks: vec![Block::Table(runs_table("Every timed run, the cheapest first", &all, &precision))],
    });
    blocks
}

fn runs_of<'b, 'a>(
    precision: &'b WorkPrecision<'a>,
    kind: IntegratorKind,
) -> impl Iterator<Item = &'b TimedRun<'a>> {
    precision.runs.iter().filter(move |run| run.record.case.integrator == kind)
}

fn chart_of(precision: &WorkPrecision<'_>) -> Chart {
    let mut chart = Chart::new(
        "Error against wall time",
        ChartAxis::log10("wall time, s"),
        ChartAxis::log10("error of the pore pressure, worst of the outputs"),
    );
    for kind in IntegratorKind::ALL {
        let points: Vec<_> = runs_of(precision, kind).map(point).collect();
        if !points.is_empty() {
            chart.series.push(Series::new(kind.name(), points).style(Style::Markers));
        }
    }
    let front = precision.runs.iter().filter(|run| run.on_front).map(point).collect();
    chart.series.push(Series::theory("no run is both cheaper and more accurate", front));
    chart
}

fn point(run: &TimedRun<'_>) -> (f64, f64) {
    (run.wall.median, run.error)
}

fn caption(precision: &WorkPrecision<'_>) -> String {
    let noise = precision.noise_floor.map_or(String::new(), |noise| {
        format!(" Timed twice in this session, the same run differs by {:.0} %.", 100.0 * noise)
    });
    format!(
        "Each point is a run: its wall time is the median over repeats taken in rounds over all runs. The line joins the \
         runs than which no other run is both cheaper and more accurate.{noise}"
    )
}

fn cheapest_table(precision: &WorkPrecision<'_>) -> Table {
    let rows = precision.cheapest.iter().map(|cheapest| {
        let mut row = vec![Cell::Percent(cheapest.tolerance)];
        match &cheapest.run {
            Some(run) => row.extend(run_cells(run)),
            None => row.push(Cell::missing("no timed run is within it")),
        }
        row.resize_with(1 + run_columns().len(), || Cell::missing("no timed run is within the tolerance"));
        row
    });
    let mut columns = columns("> tolerance");
    columns.extend(run_columns());
    Table::of("The cheapest way to a tolerance", columns, rows)
        .note("error of the pore pressure at the points, relative L2, the worst of the outputs")
}

/// Columns of a run.
fn run_columns() -> Vec<TableColumn> {
    columns("run | > error | > wall, median [ms] | > ± deviation [ms] | > steps | > point updates")
}

fn run_cells(run: &TimedRun<'_>) -> [Cell; 6] {
    [
        Cell::Code(run.record.case.label()),
        Cell::Error(run.error),
        Cell::Number(1e3 * run.wall.median),
        Cell::Number(1e3 * run.wall.deviation),
        labels::counted(run.record, run.record.counters.steps),
        labels::counted(run.record, run.record.counters.point_updates),
    ]
}

fn runs_table(title: &str, runs: &[&TimedRun<'_>], precision: &WorkPrecision<'_>) -> Table {
    let mut notes =
        vec!["wall times of runs that had the machine to themselves, in rounds over all runs".to_owned()];
    notes.extend(
        precision.noise_floor.map(|noise| {
            format!("timed twice in this session, the same run differs by {:.1} %", 100.0 * noise)
        }),
    );
    Table::of(title, run_columns(), runs.iter().map(|run| run_cells(run).to_vec())).notes(notes)
}

/// What a program is, on how many cells, by which steps, and where its errors were sampled.
fn words_of_peer(peer: &Peer) -> String {
    let cells = peer.cells.map_or(String::new(), |cells| format!(", {cells} cells"));
    format!("{}: {}{cells}, {}, at {}", peer.name, peer.kind, peer.time_scheme, peer.samples)
}

fn peers_table(compared: &[Comparison<'_, '_>]) -> Table {
    let measured = |value: Option<f64>, kind| Cell::of(value, kind, "not measured");
    let rows = compared.iter().map(|one| {
        let mut row = vec![Cell::Text(words_of_peer(one.peer))];
        row.extend(one.peer.errors.map(|error| measured(error, Cell::Error)));
        row.push(measured(one.peer.seconds, Cell::Number));
        match &one.ahead {
            Some((run, errors)) => {
                row.push(Cell::Code(run.record.case.label()));
                row.extend(errors.map(|error| measured(error, Cell::Error)));
                row.push(Cell::Number(run.wall.median));
            }
            None => {
                row.resize_with(10, || {
                    Cell::missing("every run here has a larger error at some of the times")
                });
            }
        }
        row
    });
    let times = peers::TIME_FACTORS.map(|factor| format!("> T_v = {factor}")).join(" | ");
    Table::of(
        "Other programs on this column, and the cheapest run here whose errors are no larger at any of the times",
        columns(&format!("program | {times} | > CPU [s] | run here | {times} | > wall [s]")),
        rows,
    )
    .note(
        "errors against Terzaghi's solution for incompressible water, which every run with water's \
                 own stiffness is 2e-4 away from; the other programs' times are of another machine and \
                 session",
    )
}
