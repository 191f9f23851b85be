//! Settlements by date in mm, for a terminal and for a page.

use crate::questions::findings::settlement::{SettlementRow, SettlementTable};
use crate::render::number;
use crate::render::table::{Cell, Table, columns};
use crate::report::blocks::labels;
use oedometer_soil::wording::clock_time;

const HEADER: &str = "> time | > T_v | > share of final | > exact, mm | > this run, mm | > error";

/// The tables with their headings: one per run, or, where each run has a single output, one with a row per run.
pub fn tables_of(all: &[SettlementTable]) -> Vec<(String, Table)> {
    match all {
        [first, _, ..]
            if all.iter().all(|of_run| of_run.rows.len() == 1 && of_run.reference == first.reference) =>
        {
            vec![one_table_of(all, &first.reference)]
        }
        _ => all.iter().map(|of_run| (heading(of_run), table_of(of_run))).collect(),
    }
}

/// One table with a row per run: the heading has the words that the labels of all runs share, a row has the others.
fn one_table_of(all: &[SettlementTable], reference: &str) -> (String, Table) {
    let is_shared = |part: &&str| all.iter().all(|of_run| parts_of(&of_run.run).contains(part));
    let shared: Vec<&str> = parts_of(&all[0].run).into_iter().filter(is_shared).collect();
    let rows = all.iter().flat_map(|of_run| {
        let others: Vec<&str> =
            parts_of(&of_run.run).into_iter().filter(|part| !shared.contains(part)).collect();
        let with_run = move |row: &SettlementRow| {
            let mut cells = vec![Cell::from(others.join(", "))];
            cells.extend(cells_of(row));
            cells
        };
        of_run.rows.iter().map(with_run).collect::<Vec<_>>()
    });
    let table = Table::of("", columns(&format!("problem | {HEADER}")), rows);
    (format!("Settlement of {}, against {}", shared.join(" "), labels::solution(reference)), table)
}

/// The parts of a label: its words, and what stands in parentheses, which commas separate.
fn parts_of(label: &str) -> Vec<&str> {
    let (words, variant) = label.split_once(" (").unwrap_or((label, ""));
    let variant = variant.trim_end_matches(')').split(", ").filter(|part| !part.is_empty());
    words.split(' ').chain(variant).collect()
}

/// A row per output: date, time factor, degree of consolidation, settlement exact and of the run.
pub fn table_of(found: &SettlementTable) -> Table {
    Table::of("", columns(HEADER), found.rows.iter().map(cells_of))
}

fn cells_of(row: &SettlementRow) -> Vec<Cell> {
    let millimetres = |metres: f64| number::number(1e3 * metres).into();
    vec![
        clock_time(row.seconds).into(),
        number::time_factor(row.time_factor).into(),
        Cell::of(row.degree, Cell::Percent, "the exact solution has no end"),
        millimetres(row.exact),
        Cell::of(row.computed, millimetres, "no settlement of this run"),
        Cell::of(row.error, Cell::Percent, "no settlement of this run"),
    ]
}

/// What the table is of.
pub fn heading(found: &SettlementTable) -> String {
    format!("Settlement of {}, against {}", found.run, labels::solution(&found.reference))
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
        assert_eq!(heading(&found), "Settlement of MPM, against Terzaghi's solution with compressible water");
    }

    #[test]
    fn runs_of_one_output_share_a_table_with_what_tells_them_apart() {
        let row = |time_factor: f64| SettlementRow {
            seconds: 86400.0,
            time_factor,
            degree: None,
            exact: 0.0338,
            computed: Some(0.0338 * 1.01),
            error: Some(0.01),
        };
        let of_run = |ratio: &str, outputs: &[f64]| SettlementTable {
            run: format!("MPM implicit cells=16 (u-p, ν {ratio})"),
            reference: "terzaghi".to_owned(),
            rows: outputs.iter().copied().map(row).collect(),
        };
        let tables = tables_of(&[of_run("0.3", &[0.1]), of_run("0.4", &[0.1])]);
        let [(heading, table)] = &tables[..] else { panic!("{} tables", tables.len()) };
        assert_eq!(
            heading,
            "Settlement of MPM implicit cells=16 u-p, against Terzaghi's solution with compressible water"
        );
        let shown: Vec<Vec<String>> =
            table.rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        assert_eq!(shown[0], ["ν 0.3", "1 day", "0.1", "–", "33.8", "34.14", "1.00 %"]);
        assert_eq!((shown.len(), shown[1][0].as_str()), (2, "ν 0.4"));
        // Two outputs of a run, and a single run, keep a table of their own.
        assert_eq!(tables_of(&[of_run("0.3", &[0.1, 0.2]), of_run("0.4", &[0.1])]).len(), 2);
        assert_eq!(
            tables_of(&[of_run("0.3", &[0.1])])[0].0,
            "Settlement of MPM implicit cells=16 (u-p, ν 0.3), against Terzaghi's solution with compressible water"
        );
        assert!(tables_of(&[]).is_empty());
    }
}
