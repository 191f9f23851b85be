//! Error against work, and against wall time over every integrator: the front, the cheapest run within a tolerance, and
//! other programs.

use crate::case::IntegratorKind;
use crate::case::grouping::distinct;
use crate::questions::blocks::timing::TimingFinding;
use crate::questions::blocks::work::{NamedLine, PeerRow, PeersFinding, WallTimeFinding, WorkFinding};
use crate::questions::sentence;
use crate::questions::study_findings::StudyFindings;
use crate::questions::words;
use crate::render::chart::{Chart, ChartAxis, Naming, PointName, Series, Size, slots};
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use crate::render::{RenderError, number};
use crate::report::blocks::figure_of;

/// Error over point updates and over wall time, with the runs that had the machine to themselves.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let found = &study.plain.blocks;
    let mut blocks = Vec::new();
    if study.is_stability_alone {
        return Ok(blocks);
    }
    if let Some(work) = &found.work {
        blocks.extend(work_blocks(&study.name, work, &found.timing)?);
    }
    if let Some(wall_time) = &found.wall_time {
        blocks.extend(wall_time_blocks(&study.name, wall_time)?);
    }
    Ok(blocks)
}

/// Error over point updates, and the wall times of runs that had the machine to themselves.
///
/// # Errors
/// If a template cannot be filled.
pub fn work_blocks(
    study: &str,
    found: &WorkFinding,
    timing: &[TimingFinding],
) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    if !found.lines.is_empty() {
        let mut chart = Chart::new(
            "Error against work",
            ChartAxis::log10("point updates (points × steps)"),
            ChartAxis::log10(words::error_axis(found.quantity)),
        );
        let words = words::measured(found.quantity, found.sample);
        let (time, end) = (number::time_factor(found.time_factor), words::subtitle_end(&found.shared));
        chart.subtitle = Some(format!("{words}, T_v = {time}{end}"));
        let line = |line: &NamedLine| Series::new(line.name.clone(), line.points.clone());
        chart.series.extend(found.lines.iter().map(line));
        let caption = sentence::sentence("work", found)?;
        blocks.push(Block::Heading("Error against work".to_owned()));
        blocks.push(Block::Figure(figure_of(study, "work", chart, caption)));
        if let Some(series) = &found.drawn {
            blocks.push(Block::Paragraph(words::drawn(series)?));
        }
    }
    if !timing.is_empty() {
        blocks.push(Block::Table(timing_table(timing, found)));
    }
    Ok(blocks)
}

fn timing_table(timing: &[TimingFinding], measured: &WorkFinding) -> Table {
    let rows = timing.iter().map(|run| {
        vec![
            Cell::Code(run.case.clone()),
            Cell::of(run.error, Cell::Error, "no error was measured"),
            words::counted(run.steps),
            words::counted(run.point_updates),
            Cell::Seconds(run.median),
            format!("{:.3} … {:.3} s, {} runs", run.least, run.most, run.runs).into(),
            Cell::of(run.nanoseconds_per_update, Cell::Number, words::NOT_COUNTED),
        ]
    });
    let title = format!(
        "Cost, with the error of the {} at T_v = {}",
        words::measured(measured.quantity, measured.sample),
        number::time_factor(measured.time_factor)
    );
    let header =
        "case | > error | > steps | > point updates | > wall, median | spread | > a point and step [ns]";
    Table::of(title, columns(header), rows)
        .note("wall times only of runs that had the machine to themselves, taken in rounds over all cases")
}

/// Error against wall time, for a study with timed runs of several integrators.
fn wall_time_blocks(study: &str, found: &WallTimeFinding) -> Result<Vec<Block>, RenderError> {
    let figure = figure_of(study, "wall-time", chart_of(found), caption(found)?);
    let mut blocks = vec![
        Block::Heading("Error against wall time".to_owned()),
        Block::Figure(figure),
        Block::Table(cheapest_table(found)),
    ];
    if let Some(peers) = &found.peers {
        blocks.push(Block::Table(peers_table(peers)));
        blocks.push(Block::Table(peer_series_table(peers)));
    }
    Ok(blocks)
}

/// Factor on the longest time up to which the axis goes.
const ROOM_FOR_NAMES: f64 = 5.0;
/// Slot of other programs, which no method has.
const PEERS_SLOT: usize = 6;

/// A line per method and integrator over its best runs, and a grey one per other program on the same column; names stand at
/// the ends of the lines.
pub fn chart_of(found: &WallTimeFinding) -> Chart {
    let mut chart = Chart::new(
        "Error against wall time",
        ChartAxis::log10("wall time (s)"),
        ChartAxis::log10("error of the pore pressure, worst of the outputs (–)"),
    );
    chart.size = Size { width: 1000.0, plot_height: 460.0, equal_units: false };
    chart.naming = Naming::Hover;
    let methods = distinct(found.fronts.iter().map(|front| front.method.as_str()));
    let slots = slots(&methods);
    for front in &found.fronts {
        let place = methods.iter().position(|method| *method == front.method).unwrap_or_default();
        let marker = IntegratorKind::ALL.iter().position(|kind| *kind == front.integrator);
        let name = format!("{}, {}", front.method, front.integrator.name());
        let series = Series::new(name, front.points.clone());
        add_named(&mut chart, series.slot(slots[place]).marker(marker.unwrap_or_default()));
    }
    for line in found.peers.iter().flat_map(|peers| &peers.lines) {
        add_named(&mut chart, Series::new(line.name.clone(), line.points.clone()).slot(PEERS_SLOT));
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
///
/// # Errors
/// If the template cannot be filled.
pub fn caption(found: &WallTimeFinding) -> Result<String, RenderError> {
    sentence::sentence("wall-time", found)
}

fn cheapest_table(found: &WallTimeFinding) -> Table {
    let rows = found.cheapest.iter().map(|cheapest| {
        let mut row = vec![Cell::Percent(cheapest.tolerance)];
        row.extend(cheapest.run.iter().flat_map(|run| {
            [
                Cell::Code(run.case.clone()),
                Cell::Error(run.error),
                Cell::Number(1e3 * run.seconds),
                Cell::Number(1e3 * run.deviation),
                words::counted(run.steps),
                words::counted(run.point_updates),
                if cheapest.is_confirmed { "yes" } else { "no" }.into(),
            ]
        }));
        row.resize(8, Cell::missing("no timed run reaches the tolerance"));
        row
    });
    let header = "> tolerance | run | > error | > wall, median [ms] | > ± deviation [ms] | > steps | > point updates | finer mesh within it";
    Table::of("The cheapest run within a tolerance", columns(header), rows).note(
        "error of the pore pressure at the points, relative L2, the worst of the outputs; wall times of runs that had the \
         machine to themselves, in rounds over all runs",
    )
}

/// The errors that other programs pin in convergence tests of their own, judged as series of this program are.
fn peer_series_table(found: &PeersFinding) -> Table {
    let rows = found.series.iter().map(|one| {
        let errors = one.errors.iter().map(|error| number::error(*error)).collect::<Vec<_>>().join(" → ");
        let orders = one.orders.iter().map(|order| order.map_or("–".to_owned(), number::order));
        vec![
            one.name.as_str().into(),
            one.quantity.as_str().into(),
            errors.into(),
            orders.collect::<Vec<_>>().join(", ").into(),
            one.class.name().into(),
            one.reason.as_str().into(),
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
fn peers_table(found: &PeersFinding) -> Table {
    let rows = found.rows.iter().map(|peer| {
        let PeerRow { program, kind, cells, time_scheme, samples, .. } = peer;
        let mut row: Vec<Cell> = vec![
            format!("{program}: {kind}, {cells} cells, {time_scheme}, at {samples}").into(),
            peer.day.as_str().into(),
        ];
        row.extend(peer.errors.map(Cell::Error));
        row.push(Cell::Number(peer.seconds));
        if let Some(ahead) = &peer.ahead {
            row.push(Cell::Code(ahead.case.clone()));
            row.extend(ahead.errors.map(|error| Cell::of(error, Cell::Error, "not measured")));
            row.push(Cell::Number(ahead.seconds));
        }
        row.resize(11, Cell::missing("every run here has a larger error at some of the times"));
        row
    });
    let times = found.time_factors.map(|factor| format!("> T_v = {factor}")).join(" | ");
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
    use crate::measure::statistics::WallSpread;
    use crate::questions::comparison::peers;
    use crate::questions::comparison::work_precision::{Cheapest, TimedRun, WorkPrecision};

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
                Cheapest { tolerance: 1e-2, run: Some(best.clone()), is_confirmed: true },
                Cheapest { tolerance: 1e-3, run: None, is_confirmed: false },
            ],
            runs: vec![best, other],
            noise_floor: Some(0.07),
        };
        let found = WallTimeFinding::new(&precision);
        let table = cheapest_table(&found);
        let (label, counters) = (records[0].case.label(), &records[0].counters);
        let expected = [
            Cell::Percent(1e-2),
            Cell::Code(label),
            Cell::Error(0.0071),
            Cell::Number(11.0),
            Cell::Number(1.3),
            Cell::Count(counters.steps),
            Cell::Count(counters.point_updates),
            "yes".into(),
        ];
        assert_eq!(table.rows[0], expected);
        assert!(matches!(table.rows[1][1..], [Cell::Missing(_), ..]), "{:?}", table.rows[1]);
        let chart = chart_of(&found);
        let series =
            |place: usize| (chart.series[place].name.as_str(), chart.series[place].points.as_slice());
        assert_eq!(series(0), ("GIMP, implicit", &[(0.011, 0.0071)][..]));
        assert_eq!(series(1), ("MPM, implicit", &[(0.023, 0.0092)][..]));
        assert_ne!(chart.series[0].slot, chart.series[1].slot, "a colour per method");
        assert_eq!(chart.series[0].marker, chart.series[1].marker, "a marker per integrator");
        let told = caption(&found).expect("filled");
        assert!(told.contains("differs by 7 %"), "{told}");
        assert!(told.ends_with(" Grey: other programs, timed on another day."), "{told}");
        let first = &peers::PEERS[0];
        assert_eq!(
            (series(2).0, series(2).1[0]),
            (format!("{}, SDIRK2", first.name).as_str(), (first.seconds, first.worst_error()))
        );
        let ends: Vec<_> = chart.series.iter().map(|series| (series.points.last(), &series.name)).collect();
        let names: Vec<_> = chart.names.iter().map(|named| (Some(&named.at), &named.name)).collect();
        assert_eq!(names, ends, "a name at the end of each line");
        let alone = WallTimeFinding { noise: None, peers: None, ..found };
        let told = caption(&alone).expect("filled");
        assert!(!told.contains("Timed twice") && !told.contains("Grey"), "{told}");
    }
}
