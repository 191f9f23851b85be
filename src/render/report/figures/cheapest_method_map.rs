//! A map of soils: the colour of each is the method that is the cheapest for one percent there.

use crate::judge::comparison::cheapest_method::{MappedSoil, TOLERANCE, Way, mapped_soils};
use crate::measure::statistics::median;
use crate::render::chart::describe::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};
use std::collections::{BTreeMap, BTreeSet};

/// Soils from which on there is something to draw.
const LEAST_SOILS: usize = 4;

/// Map and table of a study that varies conductivity and stiffness; nothing for others.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let Some(reference) = results.study.references.first() else { return Vec::new() };
    let soils = mapped_soils(results.records, reference.name());
    if soils.len() < LEAST_SOILS {
        return Vec::new();
    }
    let mut blocks = vec![Block::Heading("Which method is cheapest where".to_owned())];
    let mut figures = vec![results.figure("cheapest method", winners(&soils), CAPTION)];
    figures.extend(broken(&soils).map(|chart| results.figure("where runs break", chart, CAPTION_OF_BROKEN)));
    blocks.push(Block::Figures(figures));
    blocks.push(Block::Table(table_of(&soils)));
    blocks
}

const CAPTION: &str = "Error of the pore pressure at the points; time by the steps that were taken and what one costs, the same on \
                       any machine.";
const CAPTION_OF_BROKEN: &str = "Soils on which some run of an integrator failed, whatever its method: with the steps that the \
                                 study tried.";

/// What stands for soils on which every run came to its end.
const NONE_FAILED: &str = "no run failed";

fn place(soil: &MappedSoil) -> (f64, f64) {
    (soil.conductivity, soil.stiffness)
}

/// Soils by names as a figure: a colour a name.
fn map_of(title: String, names: BTreeMap<&str, Vec<(f64, f64)>>) -> Chart {
    let x = ChartAxis::log10("hydraulic conductivity k (m/s)");
    let mut chart = Chart::new(title, x, ChartAxis::log10("Young's modulus E (Pa)"));
    chart.size = Size::PANEL;
    for (slot, (name, points)) in names.into_iter().enumerate() {
        chart.series.push(Series::new(name, points).style(Style::Markers).slot(slot));
    }
    chart
}

/// Who is the cheapest on every soil.
fn winners(soils: &[MappedSoil]) -> Chart {
    let mut names: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    for soil in soils {
        let name = soil.cheapest().map_or("none comes to it", |way| way.name.as_str());
        names.entry(name).or_default().push(place(soil));
    }
    map_of(format!("The cheapest way to {} %", 100.0 * TOLERANCE), names)
}

/// Where runs of an integrator failed, beside the soils on which none did; none where no run failed at all.
fn broken(soils: &[MappedSoil]) -> Option<Chart> {
    if soils.iter().all(|soil| soil.broken.is_empty()) {
        return None;
    }
    let mut names: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    for soil in soils {
        if soil.broken.is_empty() {
            names.entry(NONE_FAILED).or_default().push(place(soil));
        }
        for name in &soil.broken {
            let integrator = name.rsplit_once(' ').map_or(name.as_str(), |(_, integrator)| integrator);
            let places = names.entry(integrator).or_default();
            if places.last() != Some(&place(soil)) {
                places.push(place(soil));
            }
        }
    }
    Some(map_of("Where runs break".to_owned(), names))
}

/// Every method and integrator over the soils: where it was tried, comes to the tolerance, wins, what it costs over
/// the winner, and where it breaks.
fn table_of(soils: &[MappedSoil]) -> Table {
    let names: BTreeSet<&str> = soils.iter().flat_map(|soil| &soil.tried).map(String::as_str).collect();
    let rows = names.into_iter().map(|name| {
        let count = |is: &dyn Fn(&MappedSoil) -> bool| {
            Cell::Count(soils.iter().filter(|soil| is(soil)).count() as u64)
        };
        let ways: Vec<(&Way, &Way)> =
            soils.iter().filter_map(|soil| Some((soil.way_of(name)?, soil.cheapest()?))).collect();
        let over: Vec<f64> = ways.iter().map(|(own, best)| own.seconds / best.seconds).collect();
        let cells: Vec<f64> = ways.iter().map(|(own, _)| own.cells as f64).collect();
        vec![
            Cell::Code(name.to_owned()),
            count(&|soil| soil.tried.iter().any(|tried| tried == name)),
            Cell::Count(ways.len() as u64),
            count(&|soil| soil.cheapest().is_some_and(|way| way.name == name)),
            Cell::of(median(&over), Cell::Number, "never within the tolerance"),
            Cell::of(median(&cells), Cell::Number, "never within the tolerance"),
            count(&|soil| soil.broken.iter().any(|broken| broken == name)),
        ]
    });
    let header = format!(
        "method and integrator | > soils tried | > within {} % on | > cheapest on | > its cost over the cheapest, median | > \
         its cells, median | > a run failed on",
        100.0 * TOLERANCE
    );
    Table::of("Methods over the map", columns(&header), rows).note(format!("of {} soils", soils.len()))
}
