//! Error against work, and the wall times that were measured fairly.

use crate::case::quantity::{Quantity, Sample};
use crate::measure::statistics::median;
use crate::record::{Record, Status};
use crate::render::chart::describe::{Chart, ChartAxis, Series};
use crate::render::page::Block;
use crate::render::report::figures::drawn_paths::{DrawnPaths, drawn};
use crate::render::report::{StudyResults, labels};
use crate::render::table::{Cell, Table, columns};
use crate::study::expectation::{Axis, Measure};

/// Error over point updates, and over wall time where runs had the machine to themselves.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let mut along_mesh = results.paths.along(Axis::Cells).to_vec();
    // Nobody counts the work of an attached solver.
    along_mesh.retain(|path| path.records.iter().all(|record| !record.case.is_attached()));
    let mut blocks = Vec::new();
    let Some(measure) = measure_of(results) else { return blocks };
    if along_mesh.len() > 1 {
        let mut chart = Chart::new(
            "Error against work",
            ChartAxis::log10("point updates (points × steps)"),
            ChartAxis::log10(labels::error_axis(&measure)),
        );
        let DrawnPaths { paths: along_mesh, note } = drawn(&along_mesh);
        let labels = labels::path_labels(&along_mesh);
        let (words, end) = (labels::measure(&measure), labels.subtitle_end());
        chart.subtitle = Some(format!("{words}, T_v = {}{end}", measure.time_factor));
        for (path, label) in along_mesh.iter().zip(&labels.each) {
            let points = path
                .records
                .iter()
                .filter_map(|record| Some((record.counters.point_updates as f64, error(record, &measure)?)));
            chart.series.push(Series::new(label.clone(), points.collect()));
        }
        let caption = "Work to the last output, counted and not timed: every step visits every point once, or does \
                       the same by one banded map of the grid. Order p in h costs e ~ W^(−p/2): a mesh twice as fine \
                       has twice the points and twice the steps.";
        blocks.push(Block::Heading("Error against work".to_owned()));
        blocks.push(Block::Figure(results.figure("work", chart, caption)));
        blocks.extend(note.map(Block::Paragraph));
    }
    let timed: Vec<&Record> = results
        .records
        .iter()
        .filter(|record| !record.wall_alone().is_empty() && record.status == Status::Ok)
        .collect();
    if timed.len() > 1 && results.study.timing_repeats > 0 {
        blocks.push(Block::Table(timing_table(&timed, &measure)));
    }
    blocks
}

/// Pressure at the points against the scene's own reference at the last output.
fn measure_of(results: &StudyResults<'_>) -> Option<Measure> {
    let record = results.records.first()?;
    let reference = results.study.references.first()?.name();
    let last = *record.case.time_factors.last()?;
    Some(labels::first_measure(Quantity::Pressure, Sample::Points, reference, last))
}

fn error(record: &Record, measure: &Measure) -> Option<f64> {
    let sample = if measure.sample == Sample::Points { record.main_sample() } else { measure.sample };
    record
        .error(measure.quantity, sample, measure.norm, &measure.reference, measure.time_factor)
        .map(|row| row.value.abs())
}

fn timing_table(timed: &[&Record], measure: &Measure) -> Table {
    let rows = timed.iter().map(|record| {
        let wall = record.wall_alone();
        let middle = median(&wall).unwrap_or(f64::NAN);
        let least = wall.iter().copied().fold(f64::INFINITY, f64::min);
        let most = wall.iter().copied().fold(0.0, f64::max);
        let counted = (record.counters.point_updates > 0).then_some(record.counters.point_updates as f64);
        vec![
            Cell::Code(record.case.label()),
            Cell::of(error(record, measure), Cell::Error, "no error was measured"),
            labels::counted(record, record.counters.steps),
            labels::counted(record, record.counters.point_updates),
            Cell::Seconds(middle),
            Cell::Text(format!("{least:.3} … {most:.3} s, {} runs", wall.len())),
            Cell::of(counted.map(|updates| 1e9 * middle / updates), Cell::Number, "of an attached solver"),
        ]
    });
    Table::of(
        format!("Cost, with the error of the {} at T_v = {}", labels::measure(measure), measure.time_factor),
        columns(
            "case | > error | > steps | > point updates | > wall, median | spread | > a point and step \
                 [ns]",
        ),
        rows,
    )
    .note("wall times only of runs that had the machine to themselves, taken in rounds over all cases")
}
