//! Errors, rates and classes over the meshes, for a terminal and for Markdown.

use crate::case::Quantity;
use crate::questions::findings::convergence::{ConvergenceColumn, ConvergenceTable, FinestMeshes};
use crate::questions::words;
use crate::render::number;
use crate::render::table::{Cell, Table, TableColumn};
use oedometer_soil::wording::clock_time;

/// Meshes that a class needs.
const MESHES_OF_A_CLASS: usize = 3;

/// A row per mesh, an error and a rate per quantity.
pub fn table_of(found: &ConvergenceTable) -> Table {
    let mut columns = vec![TableColumn::text("cells")];
    for column in &found.columns {
        columns.push(TableColumn::number(words::quantity(column.quantity)));
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

/// A row per series: on its finest mesh, and the rate to it from the mesh before.
pub fn table_of_finest(found: &FinestMeshes) -> Table {
    let mut quantities: Vec<Quantity> = Vec::new();
    for column in found.series.iter().flat_map(|(_, table)| &table.columns) {
        if !quantities.contains(&column.quantity) {
            quantities.push(column.quantity);
        }
    }
    let mut columns = vec![TableColumn::text("series"), TableColumn::number("cells")];
    columns.extend(quantities.iter().map(|quantity| TableColumn::number(words::quantity(*quantity))));
    let row = |(label, table): &(String, ConvergenceTable)| {
        let cells = table.cells.last().map_or(String::new(), usize::to_string);
        let of = |quantity: &Quantity| {
            let column = table.columns.iter().find(|column| column.quantity == *quantity);
            column.map_or(Cell::missing("some mesh of the series has no error of it"), finest_of)
        };
        [label.as_str().into(), cells.into()].into_iter().chain(quantities.iter().map(of)).collect()
    };
    let rows: Vec<Vec<Cell>> = found.series.iter().map(row).collect();
    let mut table = Table::of("", columns, rows);
    if found.more > 0 {
        table = table.note(format!("and {} more series, which `report` shows", found.more));
    }
    table
}

/// The error on the finest mesh, with the rate in brackets.
fn finest_of(column: &ConvergenceColumn) -> Cell {
    let error = column.errors.last().map_or(String::new(), |error| number::error(*error));
    match column.rates.last().copied().flatten() {
        Some(rate) => format!("{error} ({})", number::order(rate)).into(),
        None => error.into(),
    }
}

/// What the series share, and when and with what they are compared.
pub fn heading_of_finest(found: &FinestMeshes) -> String {
    let shared = if found.shared.is_empty() { String::new() } else { format!(", all with {}", found.shared) };
    let reference = found.series.first().map_or("", |(_, table)| table.reference.as_str());
    format!(
        "finest mesh of each series, with the rate to it in brackets, at the last output, against {}{shared}",
        words::solution(reference)
    )
}

/// What the runs share, and at which time they are compared with what.
pub fn heading(found: &ConvergenceTable) -> String {
    let (time, clock) = (number::time_factor(found.time_factor), clock_time(found.seconds));
    format!("{}, T_v = {time} ({clock}), against {}", found.runs, words::solution(&found.reference))
}

/// The class of each series in words.
pub fn classes(found: &ConvergenceTable) -> String {
    if found.cells.len() < MESHES_OF_A_CLASS {
        return format!("class: {MESHES_OF_A_CLASS} meshes are needed for one");
    }
    let class =
        |column: &ConvergenceColumn| format!("{} {}", words::quantity(column.quantity), column.class.name());
    format!("class: {}", found.columns.iter().map(class).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Sample;
    use oedometer_convergence::Class;

    #[test]
    fn every_rate_stands_beside_the_finer_of_its_two_meshes() {
        let column = |quantity, sample, errors: [f64; 3], rates: [Option<f64>; 2], class| ConvergenceColumn {
            quantity,
            sample,
            errors: errors.to_vec(),
            rates: rates.to_vec(),
            class,
        };
        let found = ConvergenceTable {
            runs: "MPM implicit".to_owned(),
            reference: "terzaghi".to_owned(),
            time_factor: 0.25,
            seconds: 7200.0,
            cells: vec![5, 10, 20],
            columns: vec![
                column(
                    Quantity::Pressure,
                    Sample::Points,
                    [0.8, 0.2, 0.1],
                    [Some(2.0), Some(1.0)],
                    Class::Asymptotic,
                ),
                column(
                    Quantity::Settlement,
                    Sample::Surface,
                    [0.3, 0.0, 0.4],
                    [None, Some(-3.0)],
                    Class::Divergent,
                ),
            ],
        };
        let rows: Vec<Vec<String>> =
            table_of(&found).rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        let right = [
            ["5", "8.00e-1", "", "3.00e-1", ""],
            ["10", "2.00e-1", "2.00", "0", "–"],
            ["20", "1.00e-1", "1.00", "4.00e-1", "-3.00"],
        ];
        assert_eq!(rows, right.map(|row| row.map(str::to_owned)));
        let other = ConvergenceTable { columns: found.columns[..1].to_vec(), ..found.clone() };
        let series = vec![("MPM".to_owned(), found.clone()), ("GIMP".to_owned(), other)];
        let finest = FinestMeshes { shared: "implicit".to_owned(), series, more: 2 };
        let table = table_of_finest(&finest);
        let rows: Vec<Vec<String>> =
            table.rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        let right =
            [["MPM", "20", "1.00e-1 (1.00)", "4.00e-1 (-3.00)"], ["GIMP", "20", "1.00e-1 (1.00)", "–"]];
        assert_eq!(rows, right.map(|row| row.map(str::to_owned)));
        assert_eq!(table.notes, ["and 2 more series, which `report` shows"]);
        let told = "finest mesh of each series, with the rate to it in brackets, at the last output, against Terzaghi's \
                    solution with compressible water, all with implicit";
        assert_eq!(heading_of_finest(&finest), told);
        assert_eq!(
            heading(&found),
            "MPM implicit, T_v = 0.25 (2 h), against Terzaghi's solution with compressible water"
        );
        assert_eq!(classes(&found), "class: pore pressure asymptotic, settlement divergent");
    }
}
