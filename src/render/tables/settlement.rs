//! Settlements by date in mm, for a terminal and for a page.

use crate::judge::findings::settlement::{SettlementRow, SettlementTable};
use crate::render::number;
use crate::render::table::{Cell, Table, columns};
use oedometer_soil::wording::clock_time;

/// A row per output: date, time factor, degree of consolidation, settlement exact and of the run.
pub fn table_of(found: &SettlementTable) -> Table {
    let millimetres = |metres: f64| number::number(1e3 * metres).into();
    let row = |row: &SettlementRow| {
        vec![
            clock_time(row.seconds).into(),
            number::time_factor(row.time_factor).into(),
            Cell::of(row.degree, Cell::Percent, "the exact solution has no end"),
            millimetres(row.exact),
            Cell::of(row.computed, millimetres, "no settlement of this run"),
            Cell::of(row.error, Cell::Percent, "no settlement of this run"),
        ]
    };
    let header = "> time | > T_v | > consolidated | > exact, mm | > this run, mm | > error";
    Table::of("", columns(header), found.rows.iter().map(row))
}

/// What the table is of.
pub fn heading(found: &SettlementTable) -> String {
    format!("Settlement of {}, against {}", found.run, found.reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_date_has_its_settlement_in_millimetres() {
        let row = |days: f64, degree: Option<f64>, error: Option<f64>| SettlementRow {
            seconds: 86400.0 * days,
            time_factor: 0.085_36,
            degree,
            exact: 0.0338,
            computed: error.map(|error| 0.0338 * (1.0 + error)),
            error,
        };
        let rows = vec![row(365.0, Some(0.4567), Some(-0.01)), row(40.0, None, None)];
        let found = SettlementTable { run: "MPM".to_owned(), reference: "terzaghi".to_owned(), rows };
        let shown: Vec<Vec<String>> =
            table_of(&found).rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        assert_eq!(shown[0], ["365 days", "0.08536", "45.7 %", "33.8", "33.46", "-1.00 %"]);
        assert_eq!(shown[1], ["40 days", "0.08536", "–", "33.8", "–", "–"]);
        assert_eq!(heading(&found), "Settlement of MPM, against terzaghi");
    }
}
