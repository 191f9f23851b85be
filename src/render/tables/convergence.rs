//! Errors, rates and classes over the meshes, for a terminal and for Markdown.

use crate::judge::findings::convergence::{ConvergenceColumn, ConvergenceTable};
use crate::render::number;
use crate::render::report::labels;
use crate::render::table::{Cell, Table, TableColumn};
use oedometer_soil::wording::clock_time;

/// Meshes that a class needs.
const MESHES_OF_A_CLASS: usize = 3;

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
    let (time, clock) = (number::time_factor(found.time_factor), clock_time(found.seconds));
    format!("{}, T_v = {time} ({clock}), against {}", found.runs, labels::solution(&found.reference))
}

/// The class of each series in words.
pub fn classes(found: &ConvergenceTable) -> String {
    if found.cells.len() < MESHES_OF_A_CLASS {
        return format!("class: {MESHES_OF_A_CLASS} meshes are needed for one");
    }
    let class =
        |column: &ConvergenceColumn| format!("{} {}", labels::quantity(column.quantity), column.class.name());
    format!("class: {}", found.columns.iter().map(class).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Quantity, Sample};
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
        assert_eq!(
            heading(&found),
            "MPM implicit, T_v = 0.25 (2 h), against Terzaghi's solution with compressible water"
        );
        assert_eq!(classes(&found), "class: pore pressure asymptotic, settlement divergent");
    }
}
