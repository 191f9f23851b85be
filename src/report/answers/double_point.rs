//! One set of material points, or two? A row per situation and method.

use crate::questions::answers::double_point::{DoublePointFinding, DoublePointSituation};
use crate::questions::sentence;
use crate::render::RenderError;
use crate::render::page::{Block, Section};
use crate::render::table::{Cell, Table, columns};
use crate::report::answers::{Question, short};

const QUESTION: Question = Question { heading: "One set of material points, or two?", id: "double-point" };

/// Error, endings and cost of double-point MPM beside single-point MPM.
pub fn section(found: &DoublePointFinding) -> Result<Section, RenderError> {
    let table = Block::Table(short(table(found), "in `findings.json`"));
    let studies = found.studies.iter().map(String::as_str);
    Ok(QUESTION.answered(&sentence::sentence("double-point", found)?, studies, vec![table]))
}

fn table(found: &DoublePointFinding) -> Table {
    let rows = found.situations.iter().map(|row| {
        let ratio = |place: usize| {
            Cell::of(row.error_ratios.map(|all| all[place]), Cell::Number, "no pair has an error")
        };
        vec![
            row.situation.name().into(),
            row.method.clone().map_or_else(|| Cell::Text(others(found, row)), Cell::Code),
            Cell::Count(row.pairs as u64),
            ratio(0),
            ratio(1),
            ratio(2),
            Cell::of(row.time_ratio, Cell::Number, "not timed"),
        ]
    });
    let header = "situation | method | > pairs | > error ratio: least | > median | > largest | > time ratio";
    Table::of("", columns(header), rows)
        .note("double-point over single-point; error of the pressure at the points, at every output")
}

/// The name of a row of all methods with the same errors.
fn others(found: &DoublePointFinding, row: &DoublePointSituation) -> String {
    let is_differing =
        |other: &DoublePointSituation| other.situation == row.situation && other.method.is_some();
    if found.situations.iter().any(is_differing) { "every other method" } else { "every method" }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::questions::comparison::twins::Situation;

    #[test]
    fn a_row_of_several_methods_says_whether_others_have_rows_of_their_own() {
        let row = |situation: Situation, method: Option<&str>| DoublePointSituation {
            situation,
            method: method.map(str::to_owned),
            pairs: 2,
            error_ratios: Some([0.5, 1.0, 2.0]),
            time_ratio: None,
        };
        let (usual, waves) = (Situation::Usual, Situation::Waves);
        let found = DoublePointFinding {
            studies: Vec::new(),
            pairs: 6,
            error_ratios: None,
            time_ratios: None,
            failed: [0; 2],
            bursts: Vec::new(),
            situations: vec![row(usual, Some("MPM")), row(usual, None), row(waves, None)],
        };
        let names: Vec<String> = table(&found).rows.iter().map(|row| row[1].show()).collect();
        assert_eq!(names, ["MPM", "every other method", "every method"]);
        assert_eq!(table(&found).rows[0][3..6], [0.5, 1.0, 2.0].map(Cell::Number));
    }
}
