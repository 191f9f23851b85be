//! Errors under refinement: figures with slope triangles, and tables of orders.

use crate::case::grouping::grouped;
use crate::case::quantity::Quantity;
use crate::questions::blocks::error_figure::{ErrorFigure, ErrorLine, FloorLine};
use crate::questions::blocks::refinement::{
    LevelFound, LevelKey, OrderFound, OrdersRow, OrdersTable, RefinementFinding,
};
use crate::questions::study_findings::StudyFindings;
use crate::questions::words;
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::blocks::figure_of;
use crate::study::expectation::Axis;

/// Floors that are listed below a table before the rest is only counted.
const MOST_NOTES: usize = 20;

/// Figures and tables of a study along each axis that it refines.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    for found in &study.plain.blocks.refinements {
        blocks.extend(along(&study.name, found)?);
    }
    Ok(blocks)
}

/// Figures and tables along an axis, the table of the figures open.
fn along(study: &str, found: &RefinementFinding) -> Result<Vec<Block>, RenderError> {
    let figures = found.figures.iter().map(|one| figure(study, one));
    let mut blocks = vec![Block::Heading(heading(found.axis).to_owned()), Block::Figures(figures.collect())];
    blocks.extend(found.other_model.iter().map(|one| Block::Figure(figure(study, one))));
    if let Some(series) = &found.drawn {
        blocks.push(Block::Paragraph(words::drawn(series)?));
    }
    let mut tables = found.tables.iter().map(|table| Block::Table(orders_table(table)));
    blocks.extend(tables.next());
    let more: Vec<Block> = tables.collect();
    if !more.is_empty() {
        blocks.push(Block::Details { summary: "The other times and references".to_owned(), blocks: more });
    }
    Ok(blocks)
}

fn heading(axis: Axis) -> &'static str {
    match axis {
        Axis::Cells => "Error against the mesh",
        Axis::TimeStep => "Error against the time step",
        Axis::PointsPerCell => "Error against the points in a cell",
        Axis::WaterBulkModulus => "Error against the compressibility of the water",
    }
}

/// One error of all paths over an axis.
pub fn figure(study: &str, found: &ErrorFigure) -> Figure {
    let ErrorFigure { axis, quantity, sample, reference, .. } = found;
    let ticks = words::ticks(found.sizes.iter().copied());
    let mut chart = Chart::new(
        format!("Error of the {}", words::measured(*quantity, *sample)),
        ChartAxis::log10(words::axis(*axis)).with_ticks(ticks),
        ChartAxis::log10(words::error_axis(*quantity)),
    );
    chart.subtitle = Some(format!(
        "T_v = {}, against {}{}",
        number::time_factor(found.time_factor),
        words::solution(reference),
        words::subtitle_end(&found.shared)
    ));
    chart.size = Size::PANEL;
    let names: Vec<String> = found.lines.iter().map(|line| name_of(line, found)).collect();
    let lines = found.lines.iter().zip(&names);
    chart.series.extend(lines.clone().map(|(line, name)| Series::new(name.clone(), line.points.clone())));
    chart.triangles.extend(
        found.slopes.iter().map(|near| SlopeTriangle { slope: near.slope, beside: names[near.line].clone() }),
    );
    chart.rules.extend(found.floor.as_ref().map(|floor| floor_rule(floor, &names)));
    let name = format!("{}-{}-{}-{reference}", axis.name(), quantity.name(), sample.name());
    let caption = if *axis == Axis::PointsPerCell {
        "More points refine the quadrature, not the mesh: the error tends to that of the mesh.".to_owned()
    } else {
        classes(lines)
    };
    figure_of(study, &name, chart, caption)
}

/// The label of a line, with the places of its errors where they are not those of the figure.
fn name_of(line: &ErrorLine, found: &ErrorFigure) -> String {
    if line.sample == found.sample {
        line.label.clone()
    } else {
        format!("{}, {}", line.label, words::sample(line.sample))
    }
}

fn floor_rule(floor: &FloorLine, names: &[String]) -> Rule {
    let whose = floor.line.map_or("all series", |line| &names[line]);
    let cause = floor.cause.as_ref().map_or_else(String::new, |cause| format!(": {cause}"));
    Rule { at: floor.value, label: format!("floor of {whose}{cause}") }
}

/// Most series of a class that a caption names; the table has all.
const MOST_NAMED: usize = 3;

/// The series of a figure by their class: a few by their names and orders, many by their number.
fn classes<'a>(lines: impl Iterator<Item = (&'a ErrorLine, &'a String)>) -> String {
    let named = |(line, name): &(&ErrorLine, &String)| {
        let order = line.order.map_or(String::new(), |order| format!(" (order {})", number::order(order)));
        format!("{name}{order}")
    };
    let groups = grouped(lines, |(line, _)| line.class.name()).into_iter();
    let parts = groups.map(|(class, lines)| {
        let told = if lines.len() <= MOST_NAMED {
            lines.iter().map(named).collect::<Vec<_>>().join("; ")
        } else {
            format!("{} series{}", lines.len(), orders_of(lines.iter().filter_map(|(line, _)| line.order)))
        };
        format!("*{class}*: {told}")
    });
    parts.collect::<Vec<_>>().join(". ") + "."
}

/// The least and the largest of some orders, in brackets; nothing where there is none.
fn orders_of(orders: impl Iterator<Item = f64>) -> String {
    let ends = orders.fold(None, |ends: Option<(f64, f64)>, order| {
        let (least, most) = ends.unwrap_or((order, order));
        Some((least.min(order), most.max(order)))
    });
    let told = ends.map(|(least, most)| [least, most].map(number::order));
    told.map_or(String::new(), |[least, most]| {
        if least == most { format!(" (order {least})") } else { format!(" (orders {least} to {most})") }
    })
}

/// Errors at every level with pairwise orders, fit, finest window and class.
fn orders_table(found: &OrdersTable) -> Table {
    let has_class = found.axis != Axis::PointsPerCell;
    let mut columns = columns("method | error of");
    columns.extend(found.levels.iter().map(|level| TableColumn::number(level_name(level))));
    if found.has_orders {
        columns.extend(
            ["order from level to level", "order fitted to all, 95 %", "order of the finest 3"]
                .map(TableColumn::number),
        );
    }
    if has_class {
        columns.push(TableColumn::text("class"));
    }
    let floors = found.rows.iter().filter_map(|row| {
        let (floor, advice) = row.floor.as_ref()?;
        let measured = words::measured(row.quantity, row.sample);
        Some(format!("{}, {measured}: floor {floor:.1e}; {advice}", row.label))
    });
    let mut notes: Vec<String> = floors.collect();
    if notes.len() > MOST_NOTES {
        let more = notes.len() - MOST_NOTES;
        notes.truncate(MOST_NOTES);
        notes.push(format!("and {more} floors more, of the series whose class says so"));
    }
    notes.push(format!(
        "{} over the volume; settlement |s/s_exact − 1|",
        Quantity::Pressure.first_norm().formula()
    ));
    if !found.shared.is_empty() {
        notes.insert(0, format!("all with {}", found.shared));
    }
    let reference = words::solution(&found.reference);
    let title = format!("T_v = {}, against {reference}", number::time_factor(found.time_factor));
    let rows = found.rows.iter().map(|row| orders_row(row, found.has_orders));
    Table::of(title, columns, rows).notes(notes)
}

fn orders_row(found: &OrdersRow, has_orders: bool) -> Vec<Cell> {
    let measured = words::measured(found.quantity, found.sample);
    let mut row = vec![Cell::Code(found.label.clone()), measured.into()];
    row.extend(found.errors.iter().map(|error| match error {
        LevelFound::Measured(error) => Cell::Error(error.0),
        LevelFound::NotMeasured => Cell::missing("no error was measured"),
        LevelFound::NotAsked => Cell::missing("not asked for at this time"),
        LevelFound::NoFiner => Cell::missing("no finer level to compare with"),
        LevelFound::NotRun => Cell::missing("not run"),
    }));
    if has_orders {
        let pair = |order: &Option<f64>| order.map_or("–".to_owned(), number::order);
        row.push(found.pairs.iter().map(pair).collect::<Vec<_>>().join(", ").into());
        row.extend([order_cell(&found.fitted), order_cell(&found.finest)]);
    }
    row.extend(found.class.map(|class| class.name().into()));
    row
}

fn order_cell(found: &OrderFound) -> Cell {
    match found {
        OrderFound::Order(order, None) => Cell::Order(*order),
        OrderFound::Order(order, Some(half)) => Cell::OrderWithin(*order, *half),
        OrderFound::Undefined(why) => Cell::Missing(why.clone()),
    }
}

/// The name of a level.
fn level_name(level: &LevelKey) -> String {
    match level {
        LevelKey::Cells(cells) => cells.to_string(),
        LevelKey::Seconds(seconds) => format!("Δt = {} s", number::number(*seconds)),
        LevelKey::StepRule(rule) => rule.clone(),
        LevelKey::PointsPerCell(points) => format!("m = {points}"),
        LevelKey::WaterBulkModulus(modulus) => format!("K_w = {modulus:e} Pa"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::quantity::Sample;
    use oedometer_convergence::Class;

    #[test]
    fn a_caption_names_few_series_of_a_class_and_counts_many() {
        let line = |class: Class, order: Option<f64>| ErrorLine {
            label: String::new(),
            sample: Sample::Points,
            points: Vec::new(),
            class,
            order,
        };
        let told = |lines: &[ErrorLine]| {
            let names: Vec<String> = (0..lines.len()).map(|place| format!("s{place}")).collect();
            classes(lines.iter().zip(&names))
        };
        let settled = |order| line(Class::Asymptotic, Some(order));
        let floor = || line(Class::FloorLimited, None);
        assert_eq!(
            told(&[settled(2.0), floor(), settled(1.5)]),
            "*asymptotic*: s0 (order 2.00); s2 (order 1.50). *floor-limited*: s1."
        );
        assert_eq!(told(&[2.0, 1.0, 1.5, 1.7].map(settled)), "*asymptotic*: 4 series (orders 1.00 to 2.00).");
        assert_eq!(told(&[2.0; 4].map(settled)), "*asymptotic*: 4 series (order 2.00).");
        assert_eq!(told(&[floor(), floor(), floor(), floor()]), "*floor-limited*: 4 series.");
    }

    #[test]
    fn levels_have_the_names_of_their_axis() {
        for (level, name) in [
            (LevelKey::Cells(8), "8"),
            (LevelKey::Seconds(0.05), "Δt = 0.05 s"),
            (LevelKey::StepRule("growth=0.5".to_owned()), "growth=0.5"),
            (LevelKey::PointsPerCell(3), "m = 3"),
            (LevelKey::WaterBulkModulus(2.2e9), "K_w = 2.2e9 Pa"),
        ] {
            assert_eq!(level_name(&level), name);
        }
    }
}
