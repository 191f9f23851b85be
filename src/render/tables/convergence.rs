//! Errors, rates and classes over the meshes, for a terminal and for Markdown.

use crate::judge::findings::convergence::ConvergenceTable;
use crate::render::number;
use crate::render::report::labels;
use crate::render::table::{Cell, Table, TableColumn};
use oedometer_soil::wording::duration;

/// A row per mesh, an error and a rate per quantity, and the classes at the end.
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
    let classes = found.columns.iter().flat_map(|column| [column.class.name().into(), "".into()]);
    rows.push(std::iter::once("class".into()).chain(classes).collect());
    let time = number::time_factor(found.time_factor);
    let title =
        format!("{}, T_v = {time} ({}), against {}", found.runs, duration(found.seconds), found.reference);
    Table::of(title, columns, rows)
}
