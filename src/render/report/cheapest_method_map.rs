//! A map of soils: the colour of each is the method that is the cheapest for one percent there.

use crate::judge::comparison::cheapest_method::{MappedSoil, TOLERANCE, mapped_soils};
use crate::render::chart::describe::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Table, TableColumn};
use std::collections::BTreeMap;

/// Soils from which on there is something to draw.
const LEAST_SOILS: usize = 4;

/// Map and table of a study that varies conductivity and stiffness; nothing for others.
pub fn blocks(results: &StudyResults<'_>) -> Vec<Block> {
    let Some(reference) = results.study.references.first() else { return Vec::new() };
    let soils = mapped_soils(results.records, reference.name());
    if soils.len() < LEAST_SOILS {
        return Vec::new();
    }
    let place = |soil: &MappedSoil| (soil.conductivity, soil.stiffness);
    let mut cheapest: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    let mut broken: BTreeMap<&str, usize> = BTreeMap::new();
    for soil in &soils {
        if let Some(way) = &soil.cheapest {
            cheapest.entry(&way.name).or_default().push(place(soil));
        }
        for name in &soil.broken {
            *broken.entry(name).or_default() += 1;
        }
    }
    let x = ChartAxis::log10("hydraulic conductivity k (m/s)");
    let mut chart = Chart::new(
        format!("The cheapest way to {} %", 100.0 * TOLERANCE),
        x,
        ChartAxis::log10("Young's modulus E (Pa)"),
    );
    chart.size = Size::PANEL;
    for (slot, (name, points)) in cheapest.iter().enumerate() {
        chart.series.push(Series::new(*name, points.clone()).style(Style::Markers).slot(slot));
    }
    let out_of_reach: Vec<(f64, f64)> =
        soils.iter().filter(|soil| soil.cheapest.is_none()).map(place).collect();
    if !out_of_reach.is_empty() {
        chart
            .series
            .push(Series::new("none comes to it", out_of_reach).style(Style::Markers).slot(cheapest.len()));
    }
    let caption =
        "Error of the pore pressure at the points; time by the steps that were taken and what one costs.";
    let names: std::collections::BTreeSet<&str> = cheapest.keys().chain(broken.keys()).copied().collect();
    let rows = names.into_iter().map(|name| {
        let of = |count: usize| format!("{count} of {}", soils.len());
        let won = cheapest.get(name).map_or(0, Vec::len);
        let failed = broken.get(name).copied().unwrap_or(0);
        vec![name.into(), of(won).as_str().into(), of(failed).as_str().into()]
    });
    let columns = vec![
        TableColumn::text("method and integrator"),
        TableColumn::text("cheapest on soils"),
        TableColumn::text("a case failed on soils"),
    ];
    vec![
        Block::Heading("Which method is cheapest where".to_owned()),
        Block::Figures(vec![results.figure("cheapest method", chart, caption.to_owned())]),
        Block::Table(Table::of("Methods over the map", columns, rows)),
    ]
}
