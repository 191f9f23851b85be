//! A plane layer: pressure fields beside the exact one, and errors and oscillation against the stiffness of the water and
//! of the skeleton; of a footing the load-settlement curves of all methods.

use crate::judge::comparison::stiffness_sweep::{Showing, StiffnessSweep, SweptStiffness};
use crate::measure::fields::PlaneField;
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, ColourField, Rule, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use crate::render::report::labels::grouped;
use crate::render::table::{Cell, Table, TableColumn, columns};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_mpm::scene::SceneKind;

/// Cells over the height of the runs whose fields are drawn.
const SHOWN_CELLS: usize = 8;

/// Fields and sweeps of a study of a layer; empty for a column.
pub fn blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    let scene = results.study.scene;
    if !scene.has_plane_fields() || scene == SceneKind::Footing {
        return Ok(Vec::new());
    }
    let mut blocks = Vec::new();
    let shown = shown_records(results.records);
    if let Some(first) = shown.first() {
        let ratio = first.case.material.poissons_ratio;
        blocks.push(Block::Heading(format!(
            "Pressure at the points, {SHOWN_CELLS} cells over the height, ν = {ratio}"
        )));
        let time_factor = first.case.time_factors[0];
        let mut figures = Vec::new();
        if let Some(field) = PlaneField::of(first, time_factor)? {
            figures.push(figure(results, "Exact", &field, &field.exact, time_factor, None));
        }
        for record in shown {
            if let Some(field) = PlaneField::of(record, time_factor)? {
                let name = record.case.method.to_string();
                let index = field.oscillation_index();
                figures.push(figure(results, &name, &field, &field.computed, time_factor, Some(index)));
            }
        }
        blocks.push(Block::Figures(figures));
    }
    blocks.extend(sweep_blocks(results)?);
    Ok(blocks)
}

/// The first sound run of each method on the shown mesh, in the undisturbed soil.
fn shown_records(records: &[Record]) -> Vec<&Record> {
    let mut shown: Vec<&Record> = Vec::new();
    for record in records {
        let case = &record.case;
        if case.cells == SHOWN_CELLS
            && record.status == Status::Ok
            && case.has_usual_compressibility()
            && shown.iter().all(|other| other.case.method != case.method)
        {
            shown.push(record);
        }
    }
    shown
}

fn figure(
    results: &StudyResults<'_>,
    name: &str,
    field: &PlaneField,
    values: &[f64],
    time_factor: f64,
    oscillation: Option<f64>,
) -> Figure {
    // All fields share their colours, which reach a little beyond the exact values, and one bar.
    let is_exact = oscillation.is_none();
    let largest_of = |values: &[f64]| values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let reach = REACH * largest_of(&field.exact);
    let mut chart = Chart::new(
        name.to_owned(),
        ChartAxis::linear("x/H (–)"),
        ChartAxis::linear("height above the base y/H (–)"),
    );
    chart.field = Some(ColourField {
        label: "p/q (–)".to_owned(),
        has_bar: is_exact,
        reach: Some(reach),
        x_edges: field.x_edges.clone(),
        y_edges: field.y_edges.clone(),
        values: values.to_vec(),
    });
    chart.size = Size { width: if is_exact { 380.0 } else { 300.0 }, plot_height: 240.0, equal_units: true };
    let largest = largest_of(values);
    let beyond = if largest > reach {
        format!(" Values reach {}, beyond the common scale.", number::number(largest))
    } else {
        String::new()
    };
    let caption = match oscillation {
        None => format!("Theory at T_v = {time_factor}. All these fields share one scale."),
        Some(index) => {
            format!("{name} at T_v = {time_factor}: oscillation index {}.{beyond}", number::fixed(index, 2))
        }
    };
    results.figure(&format!("field-{name}"), chart, caption)
}

/// Reach of the colours over the largest exact value.
const REACH: f64 = 1.25;

/// Figures of the last output and, behind a click, every number.
fn sweep_blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    let mut blocks = Vec::new();
    for stiffness in SweptStiffness::ALL {
        let Some(sweep) = StiffnessSweep::of(results.study, results.records, stiffness)? else { continue };
        let Some(last) = sweep.time_factors.last().copied() else { continue };
        blocks.push(Block::Heading(words_of(stiffness).0.to_owned()));
        blocks.push(Block::Paragraph(format!(
            "{} cells over the height, T_v = {last}. The line of a method that the stiffness does not affect is level. Methods \
             that agree hide each other; the tables have them all.",
            sweep.cells
        )));
        let figures =
            Showing::ALL.iter().map(|showing| sweep_figure(results, &sweep, last, *showing)).collect();
        blocks.push(Block::Figures(figures));
        let tables = sweep.time_factors.iter().flat_map(|time_factor| {
            Showing::ALL.iter().map(|showing| Block::Table(sweep_table(&sweep, *time_factor, *showing)))
        });
        blocks.push(Block::Details {
            summary: "All numbers at all times".to_owned(),
            blocks: tables.collect(),
        });
    }
    Ok(blocks)
}

/// The heading of the figures of a stiffness, and one word for the names of their files.
fn words_of(stiffness: SweptStiffness) -> (&'static str, &'static str) {
    match stiffness {
        SweptStiffness::Water => ("Stiff water, through consolidation", "water"),
        SweptStiffness::Skeleton => ("Nearly incompressible skeleton, through consolidation", "skeleton"),
    }
}

/// The subject of a figure, and one word for the name of its file.
fn subject(showing: Showing) -> (&'static str, &'static str) {
    match showing {
        Showing::Displacement => ("Displacement at the nodes", "displacement"),
        Showing::Pressure => ("Pressure at the points", "pressure"),
        Showing::Oscillation => ("Oscillation of the pressure", "oscillation"),
    }
}

fn sweep_figure(
    results: &StudyResults<'_>,
    sweep: &StiffnessSweep,
    time_factor: f64,
    showing: Showing,
) -> Figure {
    let x = match sweep.stiffness {
        SweptStiffness::Water => ChartAxis::log10("K_w/E (–)"),
        SweptStiffness::Skeleton => ChartAxis::log10("Poisson's ratio ν (–), spaced as 1 − 2ν")
            .inverted()
            .with_labelled_ticks(sweep.values.iter().map(|ratio| (1.0 - 2.0 * ratio, ratio.to_string()))),
    };
    let (subject, word) = subject(showing);
    let title = format!("{subject}, T_v = {time_factor}");
    let label = match showing {
        Showing::Displacement | Showing::Pressure => "relative L_2 error (–)",
        Showing::Oscillation => "total variation over the exact one's (–)",
    };
    let mut chart = Chart::new(title.clone(), x, ChartAxis::log10(label));
    chart.size = Size::PANEL;
    for row in sweep.at(time_factor) {
        let points = sweep.values.iter().zip(&row.found).filter_map(|(value, found)| {
            let found = found[showing as usize]?;
            // An oscillation shows as a ratio of variations above one.
            let found = if showing == Showing::Oscillation { 1.0 + found } else { found };
            let is_skeleton = sweep.stiffness == SweptStiffness::Skeleton;
            Some((if is_skeleton { 1.0 - 2.0 * value } else { *value }, found))
        });
        chart.series.push(Series::new(row.method.to_string(), points.collect()));
    }
    if showing == Showing::Oscillation {
        chart.rules.push(Rule { at: 1.0, label: "theory".to_owned() });
    }
    let name = format!("{word}-{}", words_of(sweep.stiffness).1);
    results.figure(&name, chart, format!("{title}."))
}

fn sweep_table(sweep: &StiffnessSweep, time_factor: f64, showing: Showing) -> Table {
    let header = |value: &f64| match sweep.stiffness {
        SweptStiffness::Water => format!("K_w/E = {value}"),
        SweptStiffness::Skeleton => format!("ν = {value}"),
    };
    let mut columns = columns("method");
    columns.extend(sweep.values.iter().map(|value| TableColumn::number(header(value))));
    let cell = |value: Option<f64>| match (value, showing) {
        (None, _) => Cell::missing("not run"),
        (Some(value), Showing::Oscillation) => Cell::Number(value),
        (Some(value), _) => Cell::Error(value),
    };
    let rows = sweep.at(time_factor).map(|row| {
        let cells = row.found.iter().map(|found| cell(found[showing as usize]));
        std::iter::once(Cell::Code(row.method.to_string())).chain(cells).collect()
    });
    let note = (showing == Showing::Oscillation)
        .then(|| "Total variation over the exact one's, minus one.".to_owned());
    Table::of(format!("{}, T_v = {time_factor}", subject(showing).0), columns, rows).notes(note)
}

/// Curves on the finest mesh that every method has run, the first run of each method, all kept undrained as in the study's
/// first case; empty for other scenes.
pub fn load_settlement(results: &StudyResults<'_>) -> Vec<Block> {
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
