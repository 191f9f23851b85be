//! Maps of the critical step: the predicted line with the observed marks, a method a colour.

use crate::judge::comparison::stability_map::{MapScale, maps_of};
use crate::render::chart::describe::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::tables::critical_steps::table_of;

/// Height over which a map needs a logarithmic axis.
const WIDE: f64 = 20.0;

/// Maps and table of a study whose task is stability; nothing for others.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    if results.records.iter().all(|record| record.stability.is_none()) {
        return Vec::new();
    }
    let mut figures = Vec::new();
    for map in maps_of(results.records) {
        let steps = || map.curves.iter().flat_map(|curve| &curve.points).map(|point| point.predicted);
        let most = steps().fold(0.0, f64::max);
        let least = steps().fold(f64::INFINITY, f64::min);
        let label = "critical step over h/c (–)";
        let x = match map.axis.scale {
            MapScale::Counts => {
                ChartAxis::linear(map.axis.label).with_ticks((1..=5).map(f64::from).collect())
            }
            MapScale::Linear => ChartAxis::linear(map.axis.label),
            MapScale::Log => ChartAxis::log10(map.axis.label),
        };
        let y = if most > WIDE * least { ChartAxis::log10(label) } else { ChartAxis::linear(label) };
        let mut chart = Chart::new(format!("Critical step, {}", map.shared), x, y);
        chart.size = Size::PANEL;
        for (slot, curve) in map.curves.iter().enumerate() {
            let predicted = curve.points.iter().map(|point| (point.at, point.predicted)).collect();
            let observed =
                curve.points.iter().filter_map(|point| Some((point.at, point.observed?))).collect();
            chart.series.push(
                Series::new(format!("{}, predicted", curve.name), predicted).style(Style::Line).slot(slot),
            );
            chart.series.push(
                Series::new(format!("{}, observed", curve.name), observed).style(Style::Markers).slot(slot),
            );
        }
        let caption = format!(
            "Lines: spectral radius of the step operator. Marks: bisection of runs. Largest difference {:.2} %.",
            100.0 * map.largest_deviation
        );
        figures.push(results.figure(&map.shared, chart, caption));
    }
    vec![
        Block::Heading("Critical step, predicted and observed".to_owned()),
        Block::Figures(figures),
        Block::Details {
            summary: "Every case with the runs beside its limit".to_owned(),
            blocks: vec![Block::Table(table_of(results.records))],
        },
    ]
}
