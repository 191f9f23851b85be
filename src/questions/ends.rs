//! How did each case end? Of a study that expects how its cases end.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_error;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};

/// How did each case end?
pub static ENDS: Question = Question {
    id: "ends",
    heading: "How did each case end?",
    template: include_str!("ends.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cases with a record.
    cases: usize,
    /// Those that reached their last output.
    ended: usize,
    /// Those of them with an error as large as the answer.
    useless: usize,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let mut expected = one.study.case_expectations.iter();
    if expected.all(|expectation| expectation.demand.status.is_none()) {
        return None;
    }
    let ended = || one.records.iter().filter(|record| record.status == Status::Ok);
    let useless = ended().filter(|record| error_of(record).is_some_and(|error| !is_useful(error)));
    let facts = Facts { cases: one.records.len(), ended: ended().count(), useless: useless.count() };
    let each =
        Block::Details { summary: "Every case".to_owned(), blocks: vec![Block::Table(table(one.records))] };
    Some(ENDS.answer([one.study.name.as_str()], &facts).with(each))
}

/// Whether an error is smaller than the answer.
fn is_useful(error: f64) -> bool {
    error < 1.0
}

/// Error of the pressure at the points at the last output.
fn error_of(record: &Record) -> Option<f64> {
    let (own, at) = record.references.first().zip(record.case.time_factors.last())?;
    first_error(record, Quantity::Pressure, Sample::Points, &own.name, *at)
}

/// A row a case.
fn table(records: &[Record]) -> Table {
    let rows = records.iter().map(|record| vec![record.case.label().into(), end_cell(record)]);
    Table::of("How each case ended", columns("case | how it ended"), rows).file("ends").note(
        "a number is the relative L_2 error of the pressure at the points at the last output, with ✗ if it \
         is as large as the solution; a failed case has ✗, the name of the failure and its step",
    )
}

fn end_cell(record: &Record) -> Cell {
    match (record.status.failure(), error_of(record)) {
        (Some(failure), _) => Cell::Verdict(Mood::Fail, failure.name_with_step()),
        (None, None) => Cell::Verdict(Mood::Pass, "ran".to_owned()),
        (None, Some(error)) if is_useful(error) => Cell::Verdict(Mood::Pass, number::error(error)),
        (None, Some(error)) => Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.4]\n[[sweep]]\n\
        method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [8, 4]\n\
        time_step = [{ growth = 0.3 }, { growth = 0.6 }]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
        integrator = ['implicit']\ncells = [8]\ntime_step = [{ growth = 0.3 }]\n\
        [[expect_case]]\nmethod = 'MPM'\nstatus = 'ok'\n";

    #[test]
    fn every_case_has_its_row_with_its_error_at_the_last_output_or_its_failure() {
        let (study, mut records) = solved("s", STUDY);
        for (place, record) in records.iter_mut().enumerate() {
            let last = 0.125 * (place + 1) as f64;
            record
                .errors
                .iter_mut()
                .for_each(|row| row.value = if row.time_factor == 0.4 { last } else { 3.0 });
        }
        records[2].status = failed_at(7);
        let table = table(&records);
        assert_eq!(table.rows.len(), records.len());
        for (place, row) in table.rows.iter().enumerate() {
            let error = number::error(0.125 * (place + 1) as f64);
            let wanted = match place {
                2 => "✗ unstable at step 7".to_owned(),
                0..7 => format!("✓ {error}"),
                _ => format!("✗ ran, error {error}"),
            };
            let shown: Vec<String> = row.iter().map(Cell::show).collect();
            assert_eq!(shown, [records[place].case.label(), wanted]);
        }
        let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("it expects ends");
        let told = "8 of 9 cases reached the last output, 2 of them with an error as large as the solution.";
        assert_eq!(found.sentence().expect("a sentence"), told);
    }
}
