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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    const SMALL: &str = "title = 'Race: small'\nscene = 'mandel'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [10, 20, 40]\ntime_step = [{ growth = 0.2 }]\n";

    #[test]
    fn the_header_is_that_of_the_contract_and_every_cell_has_a_row() {
        let source = StudySource { name: "race-layer-small.toml".to_owned(), text: SMALL.to_owned() };
        let (study, records) = (Study::check(&source).expect("sound"), records_of(SMALL));
        let row = RaceRow::of(&study, &records).expect("a race");
        let csv = table_of(&[row]).to_plain_csv().expect("a table");
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(
            lines[0],
            "situation,method,cells,error_pressure,error_stress,error_settlement,order,class,cost_1_percent,\
             cost_tenth_percent,oscillation,locking,step_ratio,ended,reason"
        );
        assert_eq!(lines.len(), 1 + crate::case::contender::CONTENDERS.len());
        let of = |method: &str| {
            let start = format!("layer-small,{method},");
            *lines.iter().find(|line| line.starts_with(&start)).expect("a row")
        };
        assert!(of("GC-SRI-patch").starts_with("layer-small,GC-SRI-patch,40,"), "{}", of("GC-SRI-patch"));
        assert!(of("GC-SRI-patch").ends_with(",ok,"), "{}", of("GC-SRI-patch"));
        assert!(of("B2").contains(",n/a,\"a rigid plate holds the nodes of a face"), "{}", of("B2"));
        // At small strain a method on the initial configuration is the one without the prefix, to the bit.
        let numbers = |method: &str| of(method).splitn(9, ',').skip(2).take(6).collect::<Vec<_>>().join(",");
        assert_eq!(numbers("TL-GC-SRI-patch"), numbers("GC-SRI-patch"));
    }
}
