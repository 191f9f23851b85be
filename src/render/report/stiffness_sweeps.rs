//! Errors and oscillation against the stiffness of the water and of the skeleton, through
//! consolidation.

use crate::judge::comparison::locking::{Showing, StiffnessSweep, SweptStiffness};
use crate::render::chart::describe::{Chart, ChartAxis, Rule, Series, Size};
use crate::render::page::{Block, Figure};
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, TableColumn, columns};
use oedometer_exact::exact_error::ExactError;

/// Figures of the last output and, behind a click, every number.
pub fn blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    let mut blocks = Vec::new();
    for stiffness in SweptStiffness::ALL {
        let Some(sweep) = StiffnessSweep::of(results.study, results.records, stiffness)? else { continue };
        let Some(last) = sweep.time_factors.last().copied() else { continue };
        blocks.push(Block::Heading(words_of(stiffness).0.to_owned()));
        blocks.push(Block::Paragraph(format!(
            "{} cells over the height, T_v = {last}; what a method does not feel is a level line. Methods that agree hide \
             one another; the tables have them all.",
            sweep.cells
        )));
        let figures = Showing::ALL.iter().map(|showing| figure(results, &sweep, last, *showing)).collect();
        blocks.push(Block::Figures(figures));
        let tables = sweep.time_factors.iter().flat_map(|time_factor| {
            Showing::ALL.iter().map(|showing| Block::Table(table(&sweep, *time_factor, *showing)))
        });
        blocks.push(Block::Details {
            summary: "Every number, from the start on".to_owned(),
            blocks: tables.collect(),
        });
    }
    Ok(blocks)
}

/// A stiffness in words: the heading of its figures, and one word for the names of their files.
fn words_of(stiffness: SweptStiffness) -> (&'static str, &'static str) {
    match stiffness {
        SweptStiffness::Water => ("Stiff water, through consolidation", "water"),
        SweptStiffness::Skeleton => ("A skeleton that hardly compresses, through consolidation", "skeleton"),
    }
}

/// What is shown, in words: the subject of a figure, and one word for the name of its file.
fn subject(showing: Showing) -> (&'static str, &'static str) {
    match showing {
        Showing::Displacement => ("Displacement at the nodes", "displacement"),
        Showing::Pressure => ("Pressure at the points", "pressure"),
        Showing::Oscillation => ("Oscillation of the pressure", "oscillation"),
    }
}

/// What is drawn: a variation that is none of the exact field's shows as a ratio above one.
fn drawn(showing: Showing, found: f64) -> f64 {
    if showing == Showing::Oscillation { 1.0 + found } else { found }
}

/// The abscissa of a value: harder to compress from left to right.
fn place(stiffness: SweptStiffness, value: f64) -> f64 {
    match stiffness {
        SweptStiffness::Water => value,
        SweptStiffness::Skeleton => 1.0 - 2.0 * value,
    }
}

fn figure(results: &StudyResults<'_>, sweep: &StiffnessSweep, time_factor: f64, showing: Showing) -> Figure {
    let x = match sweep.stiffness {
        SweptStiffness::Water => ChartAxis::log10("K_w/E (–)"),
        SweptStiffness::Skeleton => ChartAxis::log10("1 − 2ν (–)").inverted(),
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
            Some((place(sweep.stiffness, *value), drawn(showing, found[showing as usize]?)))
        });
        chart.series.push(Series::new(row.method.to_string(), points.collect()));
    }
    if showing == Showing::Oscillation {
        chart.rules.push(Rule { at: 1.0, label: "theory".to_owned() });
    }
    let name = format!("{word}-{}", words_of(sweep.stiffness).1);
    results.figure(&name, chart, format!("{title}."))
}

fn table(sweep: &StiffnessSweep, time_factor: f64, showing: Showing) -> Table {
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
    let notes = match showing {
        Showing::Oscillation => vec!["Total variation over the exact one's, minus one.".to_owned()],
        Showing::Displacement | Showing::Pressure => Vec::new(),
    };
    Table::of(format!("{}, T_v = {time_factor}", subject(showing).0), columns, rows).notes(notes)
}
