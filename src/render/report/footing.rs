//! A footing: the load-settlement curves of all methods.

use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::report::labels::grouped;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_mpm::scene::SceneKind;

/// Curves on the finest mesh that every method has run, the first run of each method, all kept undrained as in the study's
/// first case; empty for other scenes.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let Some(first) = results.records.first() else { return Vec::new() };
    let undrained = first.case.column.footing.undrained;
    let is_drawn = |record: &&Record| {
        results.study.scene == SceneKind::Footing
            && record.status == Status::Ok
            && record.case.column.footing.undrained == undrained
    };
    let sound = results.records.iter().filter(is_drawn);
    let of_methods = grouped(sound.map(|record| (record.case.method, record)));
    let finest = |own: &[&Record]| own.iter().map(|record| record.case.cells).max();
    let Some(cells) = of_methods.iter().filter_map(|(_, own)| finest(own)).min() else { return Vec::new() };
    let mut chart = Chart::new(
        "Load and settlement of the plate",
        ChartAxis::linear("settlement over the width u/B (–)"),
        ChartAxis::log10("load factor F/(B c_u) (–)"),
    );
    chart.size = Size::PANEL;
    let mut end: f64 = 0.0;
    for (slot, (method, own)) in of_methods.iter().enumerate() {
        let Some(record) = own.iter().find(|record| record.case.cells == cells) else { continue };
        let curve: Vec<(f64, f64)> =
            record.history.iter().filter_map(|row| Some((row.time_factor, row.load_factor?))).collect();
        end = curve.iter().fold(end, |end, (settlement, _)| end.max(*settlement));
        chart.series.push(Series::new(method.to_string(), curve).style(Style::Line).slot(slot));
    }
    chart.series.push(Series::theory("2 + π", vec![(0.0, LOAD_FACTOR), (end, LOAD_FACTOR)]));
    let caption = format!(
        "{cells} cells under the plate, undrained by {}. A method that locks never comes to a plateau.",
        undrained.name().replace('-', " ")
    );
    vec![
        Block::Heading("Load and settlement".to_owned()),
        Block::Figures(vec![results.figure("load-settlement", chart, caption)]),
    ]
}
