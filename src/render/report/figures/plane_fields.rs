//! What a plane layer shows: pressure fields beside the exact one, and the ranking of the methods.

use crate::judge::comparison::locking::{Standing, standings};
use crate::measure::fields::PlaneField;
use crate::record::{Record, Status};
use crate::render::chart::describe::{Chart, ChartAxis, Size};
use crate::render::chart::field::ColourField;
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::{StudyResults, stiffness_sweeps};
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_convergence::Class;
use oedometer_exact::exact_error::ExactError;

/// Cells over the height of the runs whose fields are drawn.
const SHOWN_CELLS: usize = 8;

/// Fields and ranking of a study of a layer; nothing for a column's.
pub fn blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    if !results.study.scene.has_plane_fields() {
        return Ok(Vec::new());
    }
    let mut blocks = Vec::new();
    let shown = shown_records(results.records);
    if let Some(first) = shown.first() {
        blocks.push(Block::Heading(format!("Pressure at the points, {SHOWN_CELLS} cells over the height")));
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
    let standings = standings(results.study, results.records)?;
    // One row says nothing about who stands where; nor do rows without a start.
    if standings.iter().filter(|one| one.displacement.is_some()).count() > 1 {
        blocks.push(Block::Heading("Which methods stand incompressible water and soil".to_owned()));
        blocks.push(Block::List(verdicts(&standings)));
        blocks.push(Block::Table(accuracy(&standings)));
        blocks.push(Block::Table(robustness(&standings)));
    }
    blocks.extend(stiffness_sweeps::blocks(results)?);
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
    let reach = shared_reach(field);
    let mut chart = Chart::new(
        name.to_owned(),
        ChartAxis::linear("x/H (–)"),
        ChartAxis::linear("height above the base y/H (–)"),
    );
    chart.field = Some(ColourField {
        label: "p/q (–)".to_owned(),
        reach: Some(reach),
        x_edges: field.x_edges.clone(),
        y_edges: field.y_edges.clone(),
        values: values.to_vec(),
    });
    chart.size = Size { width: 380.0, plot_height: 240.0, equal_units: true };
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let beyond = if largest > reach {
        format!(" Values reach {}, beyond the scale that all these fields share.", number::number(largest))
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

/// Colours reach this far beyond the largest exact value.
const REACH: f64 = 1.25;

/// How far the colours of all fields reach: a little beyond the exact one.
fn shared_reach(field: &PlaneField) -> f64 {
    REACH * field.exact.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

/// The findings in sentences, each from the numbers; of what was not swept there is none.
fn verdicts(standings: &[Standing]) -> Vec<String> {
    let names = |is: &dyn Fn(&Standing) -> bool| -> String {
        let found: Vec<String> =
            standings.iter().filter(|one| is(one)).map(|one| one.method.to_string()).collect();
        if found.is_empty() { "none".to_owned() } else { found.join(", ") }
    };
    let is_independent =
        |one: &Standing| one.spread.is_some_and(|spread| spread < 0.02) && one.class != Some(Class::Locked);
    let mut sentences = vec![format!(
        "**Locked under the water's incompressibility** (less than half of the displacement on every mesh): {}.",
        names(&|one| one.class == Some(Class::Locked))
    )];
    if standings.iter().any(|one| one.spread.is_some()) {
        sentences.push(format!(
            "**Displacement error independent of the water's stiffness** (within 2 % from K_w/E = 10³ on, and not \
             locked): {}.",
            names(&is_independent)
        ));
    }
    if standings.iter().any(|one| one.stiff_skeleton.is_some()) {
        sentences.push(format!(
            "**Holds where the skeleton is nearly incompressible too** (of those, no more than twice the errors of \
             displacement and pressure at ν = 0.25): {}.",
            names(&|one| {
                let keeps = |stiff: Option<f64>, plain: Option<f64>| {
                    stiff.zip(plain).is_some_and(|(stiff, plain)| stiff < 2.0 * plain)
                };
                is_independent(one)
                    && keeps(one.stiff_skeleton, one.displacement)
                    && keeps(one.stiff_skeleton_pressure, one.pressure)
            })
        ));
    }
    sentences
}

/// Errors and orders at the start, the best mean rank first.
fn accuracy(standings: &[Standing]) -> Table {
    let rows = standings.iter().map(|one| {
        let class = match one.class {
            Some(Class::Locked) => Cell::Verdict(Mood::Fail, Class::Locked.name().to_owned()),
            Some(class) => Cell::Text(class.name().to_owned()),
            None => Cell::missing(UNMEASURED),
        };
        vec![
            Cell::Code(one.method.to_string()),
            rounded(Some(one.rank), 1),
            class,
            measured(one.displacement, Cell::Error),
            measured(one.displacement_order, Cell::Order),
            measured(one.pressure, Cell::Error),
            measured(one.pressure_order, Cell::Order),
            measured(one.consolidated, Cell::Error),
            rounded(one.oscillation, 3),
        ]
    });
    Table::of(
        "Methods by their mean rank: accuracy",
        columns(
            "method | > mean rank | class | > u at T_v = 0 | > order | > p at T_v = 0 | > order | > p \
             at the last output | > oscillation",
        ),
        rows,
    )
    .note(
        "u: relative L2 error of the nodal displacement; p: of the pressure at the points; both \
                     against Biot's exact solution on the finest mesh that every method ran. Oscillation: \
                     total variation of the pressure over the exact one's, minus one. The rank is the mean \
                     over the columns of both tables.",
    )
    .note(
        "B-bar (Hughes 1980; by cells in the material point method: Coombs et al. 2018) sends the \
                      skeleton's volumetric strain the way of the water's; mean: cell means of the points' \
                      divergence (Mast et al. 2012); nodal: averages at the nodes (Detournay & Dzik 2006); \
                      null-space: filter by cells (Gritton & Berzins 2017; Tran & Sołowski 2019); bspline2, \
                      bspline3: quadratic and cubic B-splines (Steffen, Kirby & Berzins 2008).",
    )
}

/// What stiffness and time cost, in the same order.
fn robustness(standings: &[Standing]) -> Table {
    let rows = standings.iter().map(|one| {
        vec![
            Cell::Code(one.method.to_string()),
            measured(one.spread, Cell::Percent),
            measured(one.stiff_skeleton, Cell::Error),
            measured(one.stiff_skeleton_pressure, Cell::Error),
            measured(one.critical_step, Cell::Number),
            measured(one.seconds, Cell::Seconds),
        ]
    });
    Table::of(
        "Methods by their mean rank: stiffness and cost",
        columns(
            "method | > spread of u over K_w | > u at the largest ν | > p at the largest ν | > \
                 explicit limit [h/c] | > implicit run",
        ),
        rows,
    )
    .note("Spread: of the displacement error at T_v = 0 over K_w/E from 10³ on.")
}

/// Why a cell is empty.
const UNMEASURED: &str = "not measured, or of no meaning for a locked body";

fn measured(value: Option<f64>, kind: fn(f64) -> Cell) -> Cell {
    Cell::of(value, kind, UNMEASURED)
}

fn rounded(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or_else(|| Cell::missing(UNMEASURED), |value| Cell::Text(number::fixed(value, decimals)))
}
