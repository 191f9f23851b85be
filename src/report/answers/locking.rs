//! Who locks? A row per method, those that keep their result first.

use crate::questions::answers::locking::{LockingFinding, LockingMethod, LockingResult};
use crate::render::page::{Block, Section};
use crate::render::table::{Cell, Mood, Table, columns};
use crate::render::{RenderError, number};
use crate::report::answers::Question;
use crate::report::templates;
use oedometer_soil::wording::typed;

const QUESTION: Question = Question { heading: "Who locks?", id: "locking" };

/// Who keeps the result, and the errors of all.
pub fn section(locking: &LockingFinding) -> Result<Section, RenderError> {
    let table = Block::Table(table(locking));
    Ok(QUESTION.answered(&templates::sentence("locking", locking)?, [locking.study.as_str()], vec![table]))
}

/// The errors of all methods at the smallest and the largest ratio.
pub fn table(locking: &LockingFinding) -> Table {
    let rows = locking.methods.iter().map(|method| {
        let error = |error: Option<f64>| Cell::of(error, Cell::Error, "no result");
        let LockingMethod { displacement, pressure, .. } = method;
        vec![
            Cell::Code(method.method.clone()),
            result(&method.result),
            error(displacement[0]),
            error(displacement[1]),
            error(pressure[0]),
            error(pressure[1]),
        ]
    });
    let [first, last] = locking.poissons_ratios.map(typed);
    let limit = number::number(100.0 * locking.kept_within);
    let header = format!(
        "method | above {limit} % | > displacement, ν = {first} | > ν = {last} | > pressure, ν = {first} | > ν = {last}"
    );
    Table::of("Errors over Poisson's ratio", columns(&header), rows).note(format!(
        "relative L2 errors of the nodal displacement and of the pressure at the points; above {limit} %: either of them"
    ))
}

/// What becomes of a result, in a few words.
fn result(result: &LockingResult) -> Cell {
    match result {
        LockingResult::Kept => Cell::Verdict(Mood::Pass, "never".to_owned()),
        LockingResult::Lost { from } => Cell::Verdict(Mood::Fail, format!("from ν = {}", typed(*from))),
        LockingResult::Failed { at, ending } => {
            Cell::Verdict(Mood::Fail, format!("failed at ν = {}: {ending}", typed(*at)))
        }
        LockingResult::Unknown => Cell::missing("not run at the largest ratio"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_of_the_table_stands_under_its_quantity_and_ratio() {
        let method = |result: LockingResult| LockingMethod {
            method: "MPM".to_owned(),
            result,
            displacement: [Some(0.01), Some(0.02)],
            pressure: [Some(0.03), None],
        };
        let locking = LockingFinding {
            study: "s".to_owned(),
            cells: 4,
            time_factor: 0.1,
            kept_within: 0.1,
            poissons_ratios: [0.2, 0.49],
            methods: vec![
                method(LockingResult::Kept),
                method(LockingResult::Lost { from: 0.4 }),
                method(LockingResult::Failed { at: 0.49, ending: "unstable at step 3".to_owned() }),
            ],
        };
        let table = table(&locking);
        let results: Vec<String> = table.rows.iter().map(|row| row[1].show()).collect();
        assert_eq!(results, ["✓ never", "✗ from ν = 0.4", "✗ failed at ν = 0.49: unstable at step 3"]);
        assert_eq!(table.rows[0][2..5], [0.01, 0.02, 0.03].map(Cell::Error));
        assert_eq!(table.rows[0][5], Cell::missing("no result"));
    }
}
