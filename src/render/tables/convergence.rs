//! Errors, rates and classes over the meshes, for a terminal and for Markdown.

use crate::judge::findings::convergence::{ConvergenceColumn, ConvergenceTable};
use crate::render::number;
use crate::render::report::labels;
use crate::render::table::{Cell, Table, TableColumn};
use oedometer_soil::wording::duration;

/// A row per mesh, an error and a rate per quantity.
pub fn table_of(found: &ConvergenceTable) -> Table {
    let mut columns = vec![TableColumn::text("cells")];
    for column in &found.columns {
        columns.push(TableColumn::number(labels::quantity(column.quantity)));
        columns.push(TableColumn::number("rate"));
    }
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (level, cells) in found.cells.iter().enumerate() {
        let mut row = vec![cells.to_string().into()];
        for column in &found.columns {
            row.push(Cell::Error(column.errors[level]));
            let rate = level.checked_sub(1).map(|before| column.rates.get(before).copied().flatten());
            row.push(match rate {
                Some(Some(rate)) => number::order(rate).into(),
                Some(None) => "–".into(),
                None => "".into(),
            });
        }
        rows.push(row);
    }
    Table::of("", columns, rows)
}

/// What the runs share, and at which time they are compared with what.
pub fn heading(found: &ConvergenceTable) -> String {
    let (time, clock) = (number::time_factor(found.time_factor), duration(found.seconds));
    format!("{}, T_v = {time} ({clock}), against {}", found.runs, found.reference)
}

/// The class of each series in words.
pub fn classes(found: &ConvergenceTable) -> String {
    let class =
        |column: &ConvergenceColumn| format!("{} {}", labels::quantity(column.quantity), column.class.name());
    format!("class: {}", found.columns.iter().map(class).collect::<Vec<_>>().join(", "))
}
