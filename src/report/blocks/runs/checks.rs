//! The runs of a study: how each ended, what is measured beside errors of fields, critical steps, and runs of other programs.

use crate::case::grouping::distinct;
use crate::questions::blocks::checks::{EndFinding, GroupFinding, MeasureFinding, WorstCheck};
use crate::questions::sentence;
use crate::questions::study_findings::StudyFindings;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::blocks::maps;
use crate::report::tables::measures::bound_cell;
use crate::report::tables::{runs, uncertainties};
use std::collections::HashMap;

/// Tables of all runs under their heading.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let found = &study.plain.blocks;
    let mut blocks = vec![Block::Heading("Runs".to_owned())];
    blocks.extend(survival(&found.ends).map(|table| Block::Details {
        summary: "How each case ended".to_owned(),
        blocks: vec![Block::Table(table)],
    }));
    blocks.extend(uncertainties::table_of(&study.judgements).map(Block::Table));
    blocks.extend(measures(&found.measures));
    if let Some(found) = &found.stability {
        blocks.extend(maps::critical_steps(&study.name, found)?);
    }
    if let Some(table) = runs::attached_table(&found.outside_runs) {
        blocks.push(Block::Heading("Attached solvers".to_owned()));
        blocks.extend(study.taken_over.iter().map(|sentence| Block::Paragraph(format!("{sentence}."))));
        blocks.push(Block::Table(table.notes(study.diagnoses.clone())));
    }
    Ok(blocks)
}

/// One row per case and measure, of its worst output; empty where nothing is measured so.
fn measures(found: &[MeasureFinding]) -> Vec<Block> {
    let rows: Vec<Vec<Cell>> = found.iter().map(cells_of).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let header = "case | measure | > T_v | > found | > exact | > error";
    let table = Table::of("Measures beside the errors", columns(header), rows)
        .note("the worst output of each run; `T_v` is empty where a measure is of the whole run")
        .note(
            "spurious_velocity: largest nodal velocity over the hydraulic conductivity; pore_water: water in the soil over \
             its pores, less one; largest_pressure: of any water point since the start, over the load, where 1 is what \
             consolidation begins with at most; the error is relative where the exact value is not zero",
        );
    vec![Block::Heading("Measures".to_owned()), Block::Table(table)]
}

/// The worst of every check over the runs of a study, and the largest of every dimensionless group; empty where no run went
/// on beyond its critical step.
///
/// # Errors
/// If a template cannot be filled.
pub fn balances(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let found = &study.plain.blocks;
    if study.is_stability_alone {
        return Ok(Vec::new());
    }
    let note = sentence::sentence("balances", &())?;
    let table = worst_checks(&found.checks, &found.groups).note(note);
    Ok(vec![Block::Details {
        summary: "Start checks, balances and dimensionless groups".to_owned(),
        blocks: vec![Block::Table(table)],
    }])
}

fn worst_checks(checks: &[WorstCheck], groups: &[GroupFinding]) -> Table {
    let of_check = |check: &WorstCheck| {
        vec![check.what.as_str().into(), Cell::Error(check.value.0.abs()), bound_cell(check)]
    };
    let of_group =
        |group: &GroupFinding| vec![group.what.as_str().into(), Cell::Error(group.value), "".into()];
    let rows: Vec<Vec<Cell>> = checks.iter().map(of_check).chain(groups.iter().map(of_group)).collect();
    Table::of("Start checks, balances and groups", columns("what | > worst of all runs | bound"), rows)
}

/// A measure as a row: found, exact, and the error.
fn cells_of(row: &MeasureFinding) -> Vec<Cell> {
    let number =
        |value: f64| if row.exact == 0.0 { Cell::Error(value) } else { Cell::Text(format!("{value:.7}")) };
    vec![
        row.case.as_str().into(),
        Cell::Code(row.name.clone()),
        row.time_factor.map_or(String::new(), |factor| factor.to_string()).into(),
        number(row.found.0),
        number(row.exact),
        Cell::Error(row.error.0),
    ]
}

/// Why a cell is empty.
const NOT_TRIED: &str = "not tried";

/// An error as large as the result, which is then useless.
const MEANINGLESS: f64 = 1.0;

/// The ends of all cases of a study that expects how its cases end; `None` for others.
fn survival(ends: &[EndFinding]) -> Option<Table> {
    if ends.is_empty() {
        return None;
    }
    let methods = distinct(ends.iter().map(|end| end.runner.as_str()));
    let mut columns = columns("case");
    columns.extend(methods.iter().map(|method| TableColumn::text(*method)));
    // A row a setup, found by its name: there may be thousands.
    let mut rows: Vec<([usize; 2], Vec<Cell>)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for end in ends {
        let place = *places.entry(setup_of(end)).or_insert_with_key(|setup| {
            let not_tried = methods.iter().map(|_| Cell::missing(NOT_TRIED));
            let mesh = [end.cells, end.points_per_cell];
            rows.push((mesh, std::iter::once(setup.as_str().into()).chain(not_tried).collect()));
            rows.len() - 1
        });
        let column = methods.iter().position(|method| *method == end.runner).map(|column| column + 1);
        // Of several runs of a setup the first is shown.
        if let Some(cell) = column.and_then(|column| rows[place].1.get_mut(column))
            && matches!(cell, Cell::Missing(_))
        {
            *cell = end_cell(end);
        }
    }
    rows.sort_by_key(|(mesh, _)| *mesh);
    let rows = rows.into_iter().map(|(_, row)| row);
    Some(Table::of("How each case ended", columns, rows).note(
        "a number is the relative L_2 error of the pressure at the points at the last output, ✗ where it is as large \
         as the answer; ✗ with the name of a failure and its step",
    ))
}

fn setup_of(end: &EndFinding) -> String {
    let EndFinding { cells, points_per_cell, variant, .. } = end;
    let comma = if variant.is_empty() { "" } else { ", " };
    format!("{cells} cells, {points_per_cell} points{comma}{variant}")
}

fn end_cell(end: &EndFinding) -> Cell {
    match (&end.failure, end.error) {
        (Some(failure), _) => Cell::Verdict(Mood::Fail, failure.clone()),
        (None, None) => Cell::Verdict(Mood::Pass, "ran".to_owned()),
        (None, Some(error)) if error < MEANINGLESS => Cell::Verdict(Mood::Pass, number::error(error)),
        (None, Some(error)) => Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, solved};
    use crate::case::planned::Tier;
    use crate::questions::blocks::checks::{self, end_of};
    use crate::questions::findings::Findings;
    use crate::questions::study_results::StudyResults;
    use crate::record::{MeasureRow, Record};

    #[test]
    fn a_peak_stands_beside_the_exact_one_and_of_outputs_the_worst() {
        let text = "title = \"t\"\nscene = \"mandel\"\noutput = { time_factors = [0.0645, 0.068, 0.0717] }\n[[sweep]]\n\
                    method = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\ncells = [10]\ntime_step = [{ growth = 0.02 }]\n";
        let (_, mut records) = solved("s", text);
        let told = |records: &[Record]| {
            let blocks = measures(&checks::measures(records));
            let Some(Block::Table(table)) = blocks.last() else { return String::new() };
            table.to_text().expect("a table")
        };
        let text = told(&records);
        // 0.54606 at T = 0.06802, less the error of ten cells.
        assert!(text.contains("| peak_pressure    |     | 0.54") && text.contains("| 0.5460597 |"), "{text}");
        assert!(text.contains("| peak_time_factor |     | 0.06") && text.contains("| 0.0680287 |"), "{text}");
        let at = |time_factor: f64, found: f64| MeasureRow {
            name: "spurious_velocity".to_owned(),
            time_factor: Some(time_factor),
            reference: "at-rest".to_owned(),
            found,
            exact: 0.0,
        };
        records[0].measures = vec![at(0.1, 1e-14), at(0.2, -3e-13), at(0.3, 2e-13)];
        assert!(told(&records).contains("| 0.2 | -3.00e-13 |     0 |"), "{}", told(&records));
        records[0].measures[0].found = f64::NAN;
        assert!(told(&records).contains("| 0.1 |"), "{}", told(&records));
        records[0].measures.clear();
        assert_eq!(told(&records), "");
    }

    #[test]
    fn each_group_of_all_runs_is_the_largest_wherever_it_stands() {
        let text = "title = \"t\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.2] }\n[[sweep]]\n\
                    method = [\"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [2, 3, 4]\n";
        let (_, mut records) = solved("s", text);
        for (record, [storage, strain, inertia]) in
            records.iter_mut().zip([[0.3, 0.02, 0.001], [0.1, 0.05, 0.004], [0.2, 0.03, 0.007]])
        {
            let groups = &mut record.groups;
            (groups.storage, groups.finite_strain, groups.inertia) = (storage, strain, inertia);
        }
        let table = worst_checks(&checks::worst_checks(&records), &checks::largest_groups(&records));
        let last: Vec<&Cell> = table.rows.iter().rev().take(3).map(|row| &row[1]).collect();
        assert_eq!(last, [&Cell::Error(0.007), &Cell::Error(0.05), &Cell::Error(0.3)]);
    }

    #[test]
    fn a_value_that_is_infinite_is_shown_as_that_and_stands_in_the_findings_as_a_word() {
        let text = "title = \"t\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.2] }\n[[sweep]]\n\
                    method = [\"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [2]\n";
        let (study, mut records) = solved("s", text);
        for (value, shown, word) in [(f64::NEG_INFINITY, "inf", "-inf"), (f64::NAN, "NaN", "nan")] {
            records[0].balance[0].water_imbalance = value;
            let name = "spurious_velocity".to_owned();
            let reference = "at-rest".to_owned();
            records[0].measures =
                vec![MeasureRow { name, time_factor: None, reference, found: value, exact: 0.0 }];
            let results = StudyResults::new(&study, &records, Tier::Full);
            let found = results.findings().expect("sound cases").plain;
            let table = worst_checks(&found.blocks.checks, &found.blocks.groups);
            assert_eq!(table.rows.iter().filter(|row| row[1].show() == shown).count(), 1, "{table:?}");
            let blocks = measures(&found.blocks.measures);
            let Some(Block::Table(table)) = blocks.last() else { panic!("{blocks:?}") };
            assert_eq!(table.rows[0][3].show().trim_start_matches('-'), shown);
            let json = serde_json::to_string(&found).expect("plain data");
            assert!(json.matches(&format!("\"{word}\"")).count() >= 2, "{json}");
            assert_eq!(serde_json::from_str::<Findings>(&json).expect("what was written"), found);
        }
    }

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\n\
        method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\n\
        time_step = [{ growth = 0.3 }, { growth = 0.6 }]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
        integrator = ['implicit']\ncells = [8]\ntime_step = [{ growth = 0.3 }]\n\
        [[expect_case]]\nmethod = 'MPM'\nstatus = 'ok'\n";

    #[test]
    fn every_setup_has_its_row_every_method_its_column_and_the_first_of_several_runs_is_shown() {
        let (study, records) = solved("s", STUDY);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let table = survival(&checks::ends(&results)).expect("a table");
        assert_eq!((table.columns.len(), table.rows.len()), (4, 2));
        let shown = |method: &str, cells: usize| {
            let fits = |one: &&Record| one.case.cells == cells && one.case.method.to_string() == method;
            end_cell(&end_of(records.iter().find(fits).expect("a record")))
        };
        for (row, cells) in table.rows.iter().zip([4, 8]) {
            assert_eq!(row[0], Cell::Text(format!("{cells} cells, 2 points")));
            assert_eq!([&row[1], &row[2]], [&shown("MPM", cells), &shown("GIMP", cells)]);
        }
        assert_eq!(
            (&table.rows[0][3], &table.rows[1][3]),
            (&Cell::missing(NOT_TRIED), &shown("GC-SRI-patch", 8))
        );
    }

    #[test]
    fn a_run_is_told_by_its_error_at_the_last_output() {
        let text = STUDY.replace("[0.05]", "[0.05, 0.1, 0.4]");
        let mut record = records_of(&text).remove(0);
        for row in &mut record.errors {
            row.value = if row.time_factor == 0.4 { 0.25 } else { 3.0 };
        }
        assert_eq!(end_cell(&end_of(&record)), Cell::Verdict(Mood::Pass, number::error(0.25)));
        record.errors.iter_mut().for_each(|row| row.value = 1.0);
        assert_eq!(
            end_cell(&end_of(&record)),
            Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(1.0)))
        );
    }
}
