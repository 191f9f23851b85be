//! Do the balances hold? Start checks, balances and dimensionless groups, the worst of all runs, and what is measured beside
//! errors of fields.

use crate::judge::study_results::StudyResults;
use crate::measure::record_checks::{RecordCheck, worst_of};
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{MeasureRow, Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};

/// Do the balances hold?
pub static CHECKS: Question = Question {
    id: "checks",
    heading: "Do the balances hold?",
    template: include_str!("checks.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Runs that reached their end: the others have no result to check.
    runs: usize,
    /// Checks with a bound.
    judged: usize,
    /// Those that all runs hold.
    held: usize,
    /// The others.
    failing: Vec<String>,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    // A search for the critical step goes on beyond it.
    if one.records.iter().all(|record| record.stability.is_some()) {
        return None;
    }
    let sound: Vec<&Record> = one.records.iter().filter(|record| record.status == Status::Ok).collect();
    let checks = worst_of(sound.iter().copied());
    let judged = || checks.iter().filter(|check| check.bound.is_some());
    let failing = judged().filter(|check| !check.holds()).map(|check| check.what.to_owned());
    let failing: Vec<String> = failing.collect();
    let (runs, judged) = (sound.len(), judged().count());
    let facts = Facts { runs, judged, held: judged - failing.len(), failing };
    let summary = "Start checks, balances and dimensionless groups".to_owned();
    let all = Block::Details { summary, blocks: vec![Block::Table(worst_checks(&checks, one.records))] };
    let finding = CHECKS.answer([one.study.name.as_str()], &facts).with(all);
    Some(match measures(one.records) {
        Some(table) => finding.with(Block::Table(table)),
        None => finding,
    })
}

/// The worst of every check, and the largest of every dimensionless group.
fn worst_checks(checks: &[RecordCheck], records: &[Record]) -> Table {
    let check =
        |check: &RecordCheck| vec![check.what.into(), Cell::Measured(check.value.abs()), bound_cell(check)];
    let largest = records.iter().map(groups_of).reduce(|mut largest, groups| {
        for (largest, group) in largest.iter_mut().zip(groups) {
            largest.1 = largest.1.max(group.1);
        }
        largest
    });
    let group = |(what, value): (&str, f64)| vec![what.into(), Cell::Measured(value), "".into()];
    let rows = checks.iter().map(check).chain(largest.into_iter().flatten().map(group));
    let header = "what | > worst of all runs | bound";
    Table::of("Start checks, balances and groups", columns(header), rows).file("checks")
}

/// The bound of a check with the mark of its judgement.
pub fn bound_cell(check: &RecordCheck) -> Cell {
    match check.bound {
        Some(bound) => Cell::Verdict(Mood::of(check.holds()), format!("≤ {}", number::error(bound))),
        None if check.unjudged.is_empty() => Cell::Text("not judged".to_owned()),
        None => Cell::Text(format!("not judged: {}", check.unjudged)),
    }
}

/// The dimensionless groups of a record.
pub fn groups_of(record: &Record) -> [(&'static str, f64); 3] {
    let groups = &record.groups;
    [
        ("storage n E_oed/K_w", groups.storage),
        ("finite strain m_vl q", groups.finite_strain),
        ("inertia c_v/(H V)", groups.inertia),
    ]
}

/// One row per case and measure, of its worst output; `None` where nothing is measured so.
fn measures(records: &[Record]) -> Option<Table> {
    let rows = records.iter().flat_map(|record| {
        worst_measures(record).into_iter().map(|row| {
            let exact = row.exact;
            let number =
                |value: f64| if exact == 0.0 { Cell::Error(value) } else { format!("{value:.7}").into() };
            vec![
                record.case.label().into(),
                Cell::Code(row.name.clone()),
                row.time_factor.map_or(String::new(), |factor| factor.to_string()).into(),
                number(row.found),
                number(exact),
                Cell::Error(row.error()),
            ]
        })
    });
    let header = "case | measure | > T_v | > found | > exact | > error";
    let table = Table::of("Measures other than errors", columns(header), rows)
        .file("measures")
        .note("the worst output of each run; `T_v` is empty where a measure covers the whole run")
        .note(
            "spurious_velocity: largest nodal velocity over the hydraulic conductivity; pore_water: volume \
             of the water in the soil over that of its pores, minus one; largest_pressure: of any water \
             point since the start, over the load (consolidation begins with at most 1); the error is \
             relative where the exact value is not zero",
        );
    table.unless_empty()
}

/// The row with the largest error of every measure of a record, in the order of the record; NaN is worst.
fn worst_measures(record: &Record) -> Vec<&MeasureRow> {
    let mut worst: Vec<&MeasureRow> = Vec::new();
    for row in &record.measures {
        match worst.iter_mut().find(|other| other.name == row.name) {
            Some(other) if row.error().is_nan() || row.error().abs() > other.error().abs() => *other = row,
            Some(_) => {}
            None => worst.push(row),
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, solved};
    use crate::case::planned::Tier;

    #[test]
    fn a_peak_stands_beside_the_exact_one_and_of_outputs_the_worst() {
        let text = "title = \"t\"\nscene = \"mandel\"\noutput = { time_factors = [0.0645, 0.068, 0.0717] }\n[[sweep]]\n\
                    method = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\ncells = [10]\ntime_step = [{ growth = 0.02 }]\n";
        let mut records = records_of(text);
        let told = |records: &[Record]| -> Vec<String> {
            let rows = measures(records).map_or(Vec::new(), |table| table.rows);
            rows.iter().map(|row| row[1..].iter().map(Cell::show).collect::<Vec<_>>().join(" ")).collect()
        };
        let rows = told(&records);
        // 0.54606 at T = 0.06802, less the error of ten cells.
        assert!(rows[0].starts_with("peak_time_factor  0.06") && rows[0].contains(" 0.0680287 "), "{rows:?}");
        assert!(rows[1].starts_with("peak_pressure  0.54") && rows[1].contains(" 0.5460597 "), "{rows:?}");
        let at = |time_factor: f64, found: f64| MeasureRow {
            name: "spurious_velocity".to_owned(),
            time_factor: Some(time_factor),
            reference: "at-rest".to_owned(),
            found,
            exact: 0.0,
        };
        records[0].measures = vec![at(0.1, 1e-14), at(0.2, -3e-13), at(0.3, 2e-13)];
        assert_eq!(told(&records), ["spurious_velocity 0.2 -3.00e-13 0 -3.00e-13"]);
        records[0].measures[0].found = f64::NAN;
        assert_eq!(told(&records), ["spurious_velocity 0.1 NaN 0 NaN"]);
        records[0].measures.clear();
        assert_eq!(told(&records), [""; 0]);
    }

    #[test]
    fn a_check_beyond_its_bound_is_named_and_each_group_is_the_largest_wherever_it_stands() {
        let text = "title = \"t\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.2] }\n[[sweep]]\n\
                    method = [\"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [2, 3, 4]\n";
        let (study, mut records) = solved("s", text);
        for (record, [storage, strain, inertia]) in
            records.iter_mut().zip([[0.3, 0.02, 0.001], [0.1, 0.05, 0.004], [0.2, 0.03, 0.007]])
        {
            let groups = &mut record.groups;
            (groups.storage, groups.finite_strain, groups.inertia) = (storage, strain, inertia);
        }
        records[1].status = failed_at(1);
        let answer = |records: &[Record]| {
            let found = ask(&[StudyResults::new(&study, records, Tier::Full)]).expect("runs");
            (found.sentence().expect("a sentence"), found)
        };
        let (told, found) = answer(&records);
        let table = found.tables()[0];
        let last: Vec<&Cell> = table.rows.iter().rev().take(3).map(|row| &row[1]).collect();
        assert_eq!(last, [&Cell::Measured(0.007), &Cell::Measured(0.05), &Cell::Measured(0.3)]);
        let judged = table.rows.iter().filter(|row| row[2].show().starts_with('✓')).count();
        assert_eq!(told, format!("In 2 runs, {judged} of {judged} checks are within bounds."));
        for value in [f64::NEG_INFINITY, f64::NAN, -0.5] {
            records[2].balance[0].solid_mass_drift = value;
            let (told, found) = answer(&records);
            let held = judged - 1;
            let named = "Out of bounds: `mass of solids, drift`.";
            assert_eq!(told, format!("In 2 runs, {held} of {judged} checks are within bounds. {named}"));
            let row = found.tables()[0].rows.iter().find(|row| row[2].show().starts_with('✗'));
            assert_eq!(row.expect("a failure")[1].show(), Cell::Measured(value.abs()).show());
        }
    }
}
