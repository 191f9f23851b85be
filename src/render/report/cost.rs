//! Error against work, and against wall time over every integrator: the front, the cheapest run within a tolerance, and
//! other programs.

use crate::case::IntegratorKind;
use crate::judge::blocks::timing::{TimingFinding, error_of, timed_measure};
use crate::judge::comparison::peers::{self, Comparison, Peer};
use crate::judge::comparison::work_precision::WorkPrecision;
use crate::judge::path_labels::path_labels;
use crate::judge::paths::distinct;
use crate::judge::study_results::StudyResults;
use crate::record::Record;
use crate::render::chart::{Chart, ChartAxis, Naming, PointName, Series, Size};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::figure_of;
use crate::render::report::labels;
use crate::render::report::labels::{DrawnPaths, drawn};
use crate::render::table::{Cell, Table, columns};
use crate::study::expectation::{Axis, Measure};

/// Error over point updates, and the wall times of runs that had the machine to themselves.
pub fn work_blocks(results: &StudyResults<'_>, timing: &[TimingFinding]) -> Vec<Block> {
    let mut blocks = Vec::new();
    let Some(measure) = timed_measure(results) else { return blocks };
    let mut along_mesh = results.paths.along(Axis::Cells).to_vec();
    along_mesh.retain(|path| path.records.iter().all(|record| record.case.counts_work()));
    if along_mesh.len() > 1 {
        let mut chart = Chart::new(
            "Error against work",
            ChartAxis::log10("point updates (points × steps)"),
            ChartAxis::log10(labels::error_axis(&measure)),
        );
        let DrawnPaths { paths, note } = drawn(&along_mesh);
        let labels = path_labels(&paths);
        let (words, end) = (labels::measure(&measure), labels.subtitle_end());
        chart.subtitle = Some(format!("{words}, T_v = {}{end}", number::time_factor(measure.time_factor)));
        for (path, label) in paths.iter().zip(labels.each) {
            let point =
                |record: &&Record| Some((record.counters.point_updates as f64, error_of(record, &measure)?));
            chart.series.push(Series::new(label, path.records.iter().filter_map(point).collect()));
        }
        let caption = "Work up to the last output, counted and not timed: every step visits every point once, or does the \
                       same by one banded map of the grid. Order p in h gives e ~ W^(−p/2), because a mesh twice as fine \
                       has twice the points and twice the steps.";
        blocks.push(Block::Heading("Error against work".to_owned()));
        blocks.push(Block::Figure(figure_of(results, "work", chart, caption)));
        blocks.extend(note.map(Block::Paragraph));
    }
    if !timing.is_empty() {
        blocks.push(Block::Table(timing_table(timing, &measure)));
    }
    blocks
}

fn timing_table(timing: &[TimingFinding], measure: &Measure) -> Table {
    let counted = |work: Option<u64>| work.map_or(Cell::missing(labels::NOT_COUNTED), Cell::Count);
    let rows = timing.iter().map(|run| {
        vec![
            Cell::Code(run.case.clone()),
            Cell::of(run.error, Cell::Error, "no error was measured"),
            counted(run.steps),
            counted(run.point_updates),
            Cell::Seconds(run.median),
            format!("{:.3} … {:.3} s, {} runs", run.least, run.most, run.runs).into(),
            Cell::of(run.nanoseconds_per_update, Cell::Number, labels::NOT_COUNTED),
        ]
    });
    let title = format!(
        "Cost, with the error of the {} at T_v = {}",
        labels::measure(measure),
        number::time_factor(measure.time_factor)
    );
    let header =
        "case | > error | > steps | > point updates | > wall, median | spread | > a point and step [ns]";
    Table::of(title, columns(header), rows)
        .note("wall times only of runs that had the machine to themselves, taken in rounds over all cases")
}

/// Error against wall time, for a study with timed runs of several integrators.
pub fn wall_time_blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let reference = results.study.references.first();
    let precision = reference.and_then(|reference| WorkPrecision::of(results.records, reference.name()));
    let Some(precision) = precision else { return Vec::new() };
    if distinct(precision.runs.iter().map(|run| run.record.case.integrator)).len() < 2 {
        return Vec::new();
    }
    let mut blocks = vec![
        Block::Heading("Error against wall time".to_owned()),
        Block::Figure(figure_of(results, "wall-time", chart_of(&precision), caption(&precision))),
        Block::Table(cheapest_table(&precision)),
    ];
    if peers::solve_their_column(&precision.runs) {
        blocks.push(Block::Table(peers_table(&precision)));
        blocks.push(Block::Table(peer_series_table()));
    }
    blocks
}

/// Factor on the longest time up to which the axis goes.
const ROOM_FOR_NAMES: f64 = 5.0;
/// Slot of other programs, which no method has.
const PEERS_SLOT: usize = 6;

/// A line per method and integrator over its best runs, and a grey one per other program on the same column; names stand at
/// the ends of the lines.
pub fn chart_of(precision: &WorkPrecision<'_>) -> Chart {
    let mut chart = Chart::new(
        "Error against wall time",
        ChartAxis::log10("wall time (s)"),
        ChartAxis::log10("error of the pore pressure, worst of the outputs (–)"),
    );
    chart.size = Size { width: 1000.0, plot_height: 460.0, equal_units: false };
    chart.naming = Naming::Hover;
    let fronts = precision.fronts();
    let methods = distinct(fronts.iter().map(|front| front.method));
    for front in &fronts {
        let slot = methods.iter().position(|method| *method == front.method).unwrap_or_default();
        let marker = IntegratorKind::ALL.iter().position(|kind| *kind == front.integrator);
        let points = front.runs.iter().map(|run| (run.wall.median, run.error)).collect();
        let series = Series::new(format!("{}, {}", front.method, front.integrator.name()), points);
        add_named(&mut chart, series.slot(slot).marker(marker.unwrap_or_default()));
    }
    if peers::solve_their_column(&precision.runs) {
        for (program, peers) in peers::by_program_and_scheme() {
            let points = peers.iter().map(|peer| (peer.seconds, peer.worst_error())).collect();
            add_named(&mut chart, Series::new(program, points).slot(PEERS_SLOT));
        }
    }
    // Room for the names right of the last points.
    let times = || chart.series.iter().flat_map(|series| &series.points).map(|(seconds, _)| *seconds);
    let (least, most) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    if least < most {
        chart.x = chart.x.between(0.8 * least, ROOM_FOR_NAMES * most);
    }
    chart
}

/// Adds a series with its name at the end of its line.
fn add_named(chart: &mut Chart, series: Series) {
    let last = series.points.last().copied();
    chart.names.extend(last.map(|at| PointName { at, name: series.name.clone() }));
    chart.series.push(series);
}

/// The caption of the chart of wall times.
pub fn caption(precision: &WorkPrecision<'_>) -> String {
    let noise = precision.noise_floor.map_or(String::new(), |noise| {
        format!(" Timed twice in this session, the same run differs by {:.0} %.", 100.0 * noise)
    });
    let others = if peers::solve_their_column(&precision.runs) {
        " Grey: other programs, timed on another day."
    } else {
        ""
    };
    format!(
        "Colour: method; marker: integrator. Each line joins the runs that no other run of the same two beats in both time and \
         error. Wall time: median over repeats.{noise}{others}"
    )
}

fn cheapest_table(precision: &WorkPrecision<'_>) -> Table {
    let rows = precision.cheapest.iter().map(|cheapest| {
        let mut row = vec![Cell::Percent(cheapest.tolerance)];
        row.extend(cheapest.run.iter().flat_map(|run| {
            [
                Cell::Code(run.record.case.label()),
                Cell::Error(run.error),
                Cell::Number(1e3 * run.wall.median),
                Cell::Number(1e3 * run.wall.deviation),
                labels::counted(run.record, run.record.counters.steps),
                labels::counted(run.record, run.record.counters.point_updates),
            ]
        }));
        row.resize(7, Cell::missing("no timed run is within the tolerance"));
        row
    });
    let header =
        "> tolerance | run | > error | > wall, median [ms] | > ± deviation [ms] | > steps | > point updates";
    Table::of("The cheapest run within a tolerance", columns(header), rows).note(
        "error of the pore pressure at the points, relative L2, the worst of the outputs; wall times of runs that had the \
         machine to themselves, in rounds over all runs",
    )
}

/// The errors that other programs pin in convergence tests of their own, judged as series of this program are.
fn peer_series_table() -> Table {
    let rows = peers::PEER_SERIES.iter().map(|one| {
        let errors =
            one.levels.iter().map(|(_, error)| number::error(*error)).collect::<Vec<_>>().join(" → ");
        let orders = one.orders().into_iter().map(|order| order.map_or("–".to_owned(), number::order));
        let found = one.classified();
        vec![
            one.name.as_str().into(),
            one.quantity.as_str().into(),
            errors.into(),
            orders.collect::<Vec<_>>().join(", ").into(),
            found.class.name().into(),
            found.reason.into(),
        ]
    });
    let heads = columns(
        "program and test | of | errors, coarse to fine | orders between neighbours | class | because",
    );
    Table::of("Convergence tests of other programs", heads, rows).note(
        "the errors are those that the test of the program expects, without an order; the classes are those of this report",
    )
}

/// Each other program beside the cheapest run here that is nowhere worse.
pub fn peers_table(precision: &WorkPrecision<'_>) -> Table {
    let rows = peers::compare(&precision.runs).into_iter().map(|Comparison { peer, ahead }| {
        let Peer { name, kind, cells, time_scheme, samples, .. } = peer;
        let mut row: Vec<Cell> = vec![
            format!("{name}: {kind}, {cells} cells, {time_scheme}, at {samples}").into(),
            peer.day.as_str().into(),
        ];
        row.extend(peer.errors().map(Cell::Error));
        row.push(Cell::Number(peer.seconds));
        if let Some((run, errors)) = ahead {
            row.push(Cell::Code(run.record.case.label()));
            row.extend(errors.map(|error| Cell::of(error, Cell::Error, "not measured")));
            row.push(Cell::Number(run.wall.median));
        }
        row.resize(11, Cell::missing("every run here has a larger error at some of the times"));
        row
    });
    let times = peers::TIME_FACTORS.map(|factor| format!("> T_v = {factor}")).join(" | ");
    Table::of(
        "Other programs on this column, and the cheapest run here whose errors are no larger at any of the times",
        columns(&format!("program | measured on | {times} | > time [s] | run here | {times} | > wall [s]")),
        rows,
    )
    .note(
        "evidence: the output of these programs, run by examples/adapters/run.py on another day; their time is the smaller of the \
         processor time of the whole run and the wall time that they report for the solution; steps of 0.1 h²/H² in T_v make the error of backward Euler \
         fall like that of the mesh, and on Q2–P1 elements they all but cancel at T_v = 1",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::judge::comparison::work_precision::{Cheapest, TimedRun};
    use crate::measure::statistics::WallSpread;

    #[test]
    fn every_number_of_the_wall_times_stands_under_its_name() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['GIMP', 'MPM']\n\
             integrator = ['implicit']\ncells = [4]\n",
        );
        let run = |place: usize, median: f64, error: f64| TimedRun {
            record: &records[place],
            error,
            wall: WallSpread { count: 5, median, deviation: 0.0013, minimum: 0.009, maximum: 0.041 },
        };
        let (best, other) = (run(0, 0.011, 0.0071), run(1, 0.023, 0.0092));
        let precision = WorkPrecision {
            cheapest: vec![
                Cheapest { tolerance: 1e-2, run: Some(best.clone()) },
                Cheapest { tolerance: 1e-3, run: None },
            ],
            runs: vec![best, other],
            noise_floor: Some(0.07),
        };
        let table = cheapest_table(&precision);
        let (label, counters) = (records[0].case.label(), &records[0].counters);
        let expected = [
            Cell::Percent(1e-2),
            Cell::Code(label),
            Cell::Error(0.0071),
            Cell::Number(11.0),
            Cell::Number(1.3),
            Cell::Count(counters.steps),
            Cell::Count(counters.point_updates),
        ];
        assert_eq!(table.rows[0], expected);
        assert!(matches!(table.rows[1][1..], [Cell::Missing(_), ..]), "{:?}", table.rows[1]);
        let chart = chart_of(&precision);
        let series =
            |place: usize| (chart.series[place].name.as_str(), chart.series[place].points.as_slice());
        assert_eq!(series(0), ("GIMP, implicit", &[(0.011, 0.0071)][..]));
        assert_eq!(series(1), ("MPM, implicit", &[(0.023, 0.0092)][..]));
        assert_ne!(chart.series[0].slot, chart.series[1].slot, "a colour per method");
        assert_eq!(chart.series[0].marker, chart.series[1].marker, "a marker per integrator");
        assert!(caption(&precision).contains("differs by 7 %"));
        assert!(caption(&precision).ends_with(" Grey: other programs, timed on another day."));
        let first = &peers::PEERS[0];
        assert_eq!(
            (series(2).0, series(2).1[0]),
            (format!("{}, SDIRK2", first.name).as_str(), (first.seconds, first.worst_error()))
        );
        let ends: Vec<_> = chart.series.iter().map(|series| (series.points.last(), &series.name)).collect();
        let names: Vec<_> = chart.names.iter().map(|named| (Some(&named.at), &named.name)).collect();
        assert_eq!(names, ends, "a name at the end of each line");
        let alone = WorkPrecision { noise_floor: None, ..precision };
        assert!(!caption(&alone).contains("Timed twice"), "{}", caption(&alone));
    }
}
