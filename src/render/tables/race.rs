//! The table of the race: one row per situation and contender, for programs.

use crate::judge::race::{RaceCell, RaceRow};
use crate::render::table::{Cell, Table, columns};

/// The columns of the table, for everybody who reads it by name.
const HEADER: &str = "situation|method|cells|error_pressure|error_stress|error_settlement|order|class|cost_1_percent|\
                      cost_tenth_percent|oscillation|locking|step_ratio|ended|reason";

/// Every cell of the race.
pub fn table_of(situations: &[RaceRow<'_>]) -> Table {
    let rows = situations.iter().flat_map(|one| one.contenders.iter().map(|cell| row(one, cell)));
    Table::of("", columns(HEADER), rows)
}

fn row(situation: &RaceRow<'_>, cell: &RaceCell) -> Vec<Cell> {
    let number = |value: Option<f64>| Cell::of(value, Cell::Number, "");
    let (ended, reason) = cell.ending();
    let mut row: Vec<Cell> =
        vec![situation.name().into(), cell.name.into(), Cell::Count(situation.cells as u64)];
    row.extend(cell.errors.map(number));
    row.push(number(cell.order));
    row.push(cell.class.map_or("", |class| class.name()).into());
    row.extend(cell.cost.map(number));
    row.extend([cell.oscillation, cell.locking, cell.step_ratio].map(number));
    row.extend([ended.into(), reason.into()]);
    row
}
