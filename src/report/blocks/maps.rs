//! Maps over inputs: the cheapest method for one percent on each soil, and critical steps, predicted and observed.

use crate::questions::blocks::soil_map::MapFinding;
use crate::questions::blocks::stability::StabilityFinding;
use crate::questions::comparison::stability_map::{MapScale, StabilityMap};
use crate::questions::sentence;
use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Table, columns};
use crate::report::blocks::figure_of;
use crate::report::tables::runs;
use std::collections::BTreeMap;

/// Map and table of a study that varies conductivity and stiffness; empty for others.
///
/// # Errors
/// If a template cannot be filled.
pub fn cheapest_methods(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let Some(map) = &study.plain.blocks.map else { return Ok(Vec::new()) };
    let mut blocks = vec![Block::Heading("Which method is cheapest where".to_owned())];
    let cheapest = winners(map);
    let mut figures = Vec::new();
    match cheapest.series.as_slice() {
        // A map of one colour is a sentence.
        [_] => blocks.push(Block::Paragraph(sentence::sentence("cheapest", map)?)),
        _ => figures.push(figure_of(&study.name, "cheapest method", cheapest, CAPTION)),
    }
    let broken = broken(map);
    figures.extend(broken.map(|chart| figure_of(&study.name, "where runs break", chart, CAPTION_OF_BROKEN)));
    if !figures.is_empty() {
        blocks.push(Block::Figures(figures));
    }
    blocks.push(Block::Table(methods_table(map)));
    Ok(blocks)
}

const CAPTION: &str = "Error of the pore pressure at the points; time from the number of steps and the cost of one, which is \
                       the same on any machine.";
const CAPTION_OF_BROKEN: &str =
    "Soils on which some run of an integrator failed with the steps that the study tried.";

/// End of the name of an integrator on the soils where it has no run.
const NOT_TRIED: &str = ": not tried";
/// Grey, and the first of the hollow markers.
const UNTRIED: (usize, usize) = (6, 7);
/// Name of the soils on which every run reached its end.
const NONE_FAILED: &str = "no run failed";

/// Soils by name, one colour per name.
fn map_of(title: String, names: BTreeMap<&str, Vec<(f64, f64)>>) -> Chart {
    let x = ChartAxis::log10("hydraulic conductivity k (m/s)");
    let mut chart = Chart::new(title, x, ChartAxis::log10("Young's modulus E (Pa)"));
    chart.size = Size::PANEL;
    for (slot, (name, points)) in names.into_iter().enumerate() {
        chart.series.push(Series::new(name, points).style(Style::Markers).slot(slot));
    }
    chart
}

/// The cheapest way on every soil.
fn winners(map: &MapFinding) -> Chart {
    let mut names: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    for soil in &map.places {
        names.entry(soil.cheapest.as_deref().unwrap_or("none reaches it")).or_default().push(soil.at);
    }
    map_of(format!("The cheapest way to {} %", 100.0 * map.tolerance), names)
}

/// Soils where runs of an integrator failed, beside those where one was not tried and those where none failed; `None` if no
/// run failed at all.
fn broken(map: &MapFinding) -> Option<Chart> {
    if map.places.iter().all(|soil| soil.broken.is_empty()) {
        return None;
    }
    let mut names: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    for soil in &map.places {
        let untried = soil.untried.iter().map(|integrator| format!("{integrator}{NOT_TRIED}"));
        let broken = soil.broken.iter().map(|integrator| format!("{integrator}: a run failed"));
        let mut states: Vec<String> = broken.chain(untried).collect();
        if states.is_empty() {
            states.push(NONE_FAILED.to_owned());
        }
        for state in states {
            names.entry(state).or_default().push(soil.at);
        }
    }
    let names = names.iter().map(|(name, places)| (name.as_str(), places.clone())).collect();
    let mut chart = map_of("Where runs break".to_owned(), names);
    // What was not tried is no result: hollow and grey.
    for (place, series) in
        chart.series.iter_mut().filter(|series| series.name.ends_with(NOT_TRIED)).enumerate()
    {
        (series.slot, series.marker) = (Some(UNTRIED.0), Some(UNTRIED.1 + place));
    }
    Some(chart)
}

/// Every method and integrator over the soils: where it was tried, reaches the tolerance, is cheapest, its cost over the
/// cheapest, and where it fails.
fn methods_table(map: &MapFinding) -> Table {
    let rows = map.methods.iter().map(|method| {
        vec![
            Cell::Code(method.name.clone()),
            Cell::Count(method.tried as u64),
            Cell::Count(method.within as u64),
            Cell::Count(method.unconfirmed as u64),
            Cell::Count(method.cheapest as u64),
            Cell::of(method.cost_over_cheapest, Cell::Number, "never within the tolerance"),
            Cell::of(method.cells, Cell::Number, "never within the tolerance"),
            Cell::Count(method.broken as u64),
        ]
    });
    let header = format!(
        "method and integrator | > soils tried | > within {} % on | > unconfirmed by a finer mesh on | > cheapest on | > its cost over the cheapest, median | > \
         its cells, median | > a run failed on",
        100.0 * map.tolerance
    );
    Table::of("Methods over the map", columns(&header), rows).note(format!("of {} soils", map.soils))
}

/// Ratio of the largest to the smallest step from which a map has a logarithmic axis.
const WIDE: f64 = 20.0;

/// Maps and table of a study whose task is stability.
///
/// # Errors
/// If a template cannot be filled.
pub fn critical_steps(study: &str, found: &StabilityFinding) -> Result<Vec<Block>, RenderError> {
    let figures = found.maps.iter().map(|map| stability_figure(study, map)).collect::<Result<_, _>>()?;
    Ok(vec![
        Block::Heading("Critical step, predicted and observed".to_owned()),
        Block::Figures(figures),
        Block::Details {
            summary: "Every case with the runs just below and above its limit".to_owned(),
            blocks: vec![Block::Table(runs::critical_steps(&found.steps))],
        },
    ])
}

fn stability_figure(study: &str, map: &StabilityMap) -> Result<Figure, RenderError> {
    let steps = || map.curves.iter().flat_map(|curve| &curve.points).map(|point| point.predicted);
    let (least, most) = (steps().fold(f64::INFINITY, f64::min), steps().fold(0.0, f64::max));
    let label = "critical step over h/c (–)";
    let y = if most > WIDE * least { ChartAxis::log10(label) } else { ChartAxis::linear(label) };
    let mut chart = Chart::new(format!("Critical step, {}", map.shared), axis_of(map), y);
    chart.size = Size::PANEL;
    for (slot, curve) in map.curves.iter().enumerate() {
        let predicted = curve.points.iter().map(|point| (point.at, point.predicted)).collect();
        let observed = curve.points.iter().filter_map(|point| Some((point.at, point.observed?))).collect();
        let lines = [("predicted", predicted, Style::Line), ("observed", observed, Style::Markers)];
        chart.series.extend(lines.map(|(what, points, style)| {
            Series::new(format!("{}, {what}", curve.name), points).style(style).slot(slot)
        }));
    }
    Ok(figure_of(study, &map.shared, chart, sentence::sentence("critical-steps", map)?))
}

fn axis_of(map: &StabilityMap) -> ChartAxis {
    match map.scale {
        MapScale::Counts => ChartAxis::linear(map.over.as_str()).with_ticks((1..=5).map(f64::from).collect()),
        MapScale::Linear => ChartAxis::linear(map.over.as_str()),
        MapScale::Log => ChartAxis::log10(map.over.as_str()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::questions::comparison::work_precision::{MappedSoil, Way};

    #[test]
    fn every_soil_has_its_winner_every_method_its_counts_and_every_integrator_that_broke_its_places() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let way = |name: &str, cells: usize, seconds: f64| Way {
            name: name.to_owned(),
            cells,
            seconds,
            error: 0.005,
            is_confirmed: name.starts_with('A'),
        };
        let soil = |place: (f64, f64), ways: Vec<Way>, broken: &[&str]| MappedSoil {
            conductivity: place.0,
            stiffness: place.1,
            tried: names(&["A implicit", "B explicit", "C explicit"]),
            ways,
            broken: names(broken),
        };
        let places = [(1e-5, 1e6), (1e-5, 1e7), (1e-3, 1e6), (1e-3, 1e7)];
        let (a, b) = (way("A implicit", 8, 2.0), way("B explicit", 16, 8.0));
        let soils = [
            soil(places[0], vec![a.clone(), b.clone()], &[]),
            soil(
                places[1],
                vec![way("B explicit", 4, 1.0), way("A implicit", 10, 3.0)],
                &["B explicit", "C explicit"],
            ),
            soil(places[2], vec![a, way("B explicit", 20, 14.0)], &["C explicit"]),
            MappedSoil { tried: names(&["A implicit"]), ..soil(places[3], Vec::new(), &["A implicit"]) },
        ];
        let series = |chart: &Chart| {
            chart.series.iter().map(|one| (one.name.clone(), one.points.clone())).collect::<Vec<_>>()
        };
        let at = |name: &str, at: &[usize]| {
            (name.to_owned(), at.iter().map(|place| places[*place]).collect::<Vec<_>>())
        };
        let won = [at("A implicit", &[0, 2]), at("B explicit", &[1]), at("none reaches it", &[3])];
        let map = MapFinding::new(&soils).expect("soils");
        assert_eq!(series(&winners(&map)), won);
        let chart = broken(&map).expect("some broke");
        assert_eq!(
            series(&chart),
            [
                at("explicit: a run failed", &[1, 2]),
                at("explicit: not tried", &[3]),
                at("implicit: a run failed", &[3]),
                at("no run failed", &[0])
            ]
        );
        let looks: Vec<_> = chart.series.iter().map(|series| (series.slot, series.marker)).collect();
        assert_eq!(looks[1], (Some(UNTRIED.0), Some(UNTRIED.1)), "grey and hollow");
        assert!(looks.iter().filter(|look| **look == looks[1]).count() == 1);
        assert_eq!(broken(&MapFinding::new(&soils[..1]).expect("a soil")), None);
        let table = methods_table(&map);
        let shown: Vec<Vec<String>> =
            table.rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        // Medians of 1, 3, 1 and of 4, 1, 7 times the cheapest; of 8, 10, 8 and of 16, 4, 20 cells.
        assert_eq!(shown[0], ["A implicit", "4", "3", "0", "2", "1", "8", "1"]);
        assert_eq!(shown[1], ["B explicit", "3", "3", "3", "1", "4", "16", "1"]);
        assert_eq!(shown[2], ["C explicit", "3", "0", "0", "0", "–", "–", "2"]);
        assert_eq!(table.notes, ["of 4 soils"]);
    }
}
