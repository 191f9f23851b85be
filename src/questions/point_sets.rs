//! One set of material points, or two? Runs of single-point and double-point MPM that differ in nothing else, by study and
//! method.

use crate::case::keys::{Key, Value};
use crate::case::{Quantity, Sample};
use crate::judge::paths::{first_error, grouped};
use crate::judge::study_results::StudyResults;
use crate::measure::record_checks::has_burst;
use crate::measure::statistics::median;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::words::COUNTED_WORK;
use crate::record::calibration::cost_of;
use crate::record::{Record, Status};
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};
use std::collections::HashMap;

/// One set of material points, or two?
pub static POINT_SETS: Question = Question {
    id: "point-sets",
    heading: "One set of material points, or two?",
    template: include_str!("point_sets.md"),
    places: &[Place::Study, Place::Report],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence; ratios are of two sets over one.
#[derive(serde::Serialize)]
struct Facts {
    /// Pairs of runs that differ in the point sets alone.
    pairs: usize,
    /// Least and largest ratio of the errors of the pressure at the points, at every output.
    error_ratios: Option<[f64; 2]>,
    /// Least and largest of the rows' ratios of the counted work.
    work_ratios: Option<[f64; 2]>,
    /// Runs that ended before their last output, with one set and with two.
    failed: [usize; 2],
    /// Runs with two sets in which the pressure exceeded what the load can cause.
    bursts: usize,
}

/// Rows that a page shows.
const SHOWN_ROWS: usize = 5;

/// Runs that are equal in everything but the point sets.
struct Pair<'a> {
    study: &'a str,
    with_one: &'a Record,
    with_two: &'a Record,
}

/// Pairs of a study and method.
struct Row {
    study: String,
    method: String,
    pairs: usize,
    /// Least, median and largest ratio of the errors.
    errors: Option<[f64; 3]>,
    /// Median ratio of the counted work.
    work: Option<f64>,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let pairs: Vec<Pair<'_>> =
        studies.iter().flat_map(|one| pairs_of(&one.study.name, one.records)).collect();
    if pairs.is_empty() {
        return None;
    }
    let groups = grouped(&pairs, |pair| (pair.study, pair.with_one.case.method.to_string()));
    let rows: Vec<Row> =
        groups.into_iter().map(|((study, method), pairs)| Row::new(study, method, &pairs)).collect();
    let failed = |of: for<'a> fn(&'a Pair<'a>) -> &'a Record| {
        pairs.iter().filter(|pair| of(pair).status != Status::Ok).count()
    };
    let facts = Facts {
        pairs: pairs.len(),
        error_ratios: ends(
            rows.iter().filter_map(|row| row.errors).flat_map(|[least, _, most]| [least, most]),
        ),
        work_ratios: ends(rows.iter().filter_map(|row| row.work)),
        failed: [failed(|pair| pair.with_one), failed(|pair| pair.with_two)],
        bursts: studies.iter().flat_map(|one| one.records).filter(|record| has_burst(record)).count(),
    };
    let named = grouped(&pairs, |pair| pair.study).into_iter().map(|(study, _)| study);
    Some(POINT_SETS.answer(named, &facts).with(Block::Table(table(&rows))))
}

/// The runs with two sets that have a twin with one.
fn pairs_of<'a>(study: &'a str, records: &'a [Record]) -> Vec<Pair<'a>> {
    let Some(key) = Key::named("sets", "points") else { return Vec::new() };
    let with = |sets: usize| records.iter().filter(move |record| key.get(&record.case) == Value::Count(sets));
    let mut twos = with(2).peekable();
    if twos.peek().is_none() {
        return Vec::new();
    }
    let ones: HashMap<&str, &Record> = with(1).map(|record| (record.hash.as_str(), record)).collect();
    let pair = |with_two: &'a Record| {
        let mut case = with_two.case.clone();
        key.set(&mut case, Value::Count(1));
        Some(Pair { study, with_one: ones.get(case.hash().as_str())?, with_two })
    };
    twos.filter_map(pair).collect()
}

impl Row {
    fn new(study: &str, method: String, pairs: &[&Pair<'_>]) -> Self {
        let mut errors: Vec<f64> = pairs.iter().flat_map(|pair| error_ratios(pair)).collect();
        errors.sort_by(f64::total_cmp);
        let work: Vec<f64> =
            pairs.iter().map(|pair| cost_of(pair.with_two) / cost_of(pair.with_one)).collect();
        let ends = errors.first().copied().zip(errors.last().copied());
        Self {
            study: study.to_owned(),
            method,
            pairs: pairs.len(),
            errors: ends.zip(median(&errors)).map(|((least, most), middle)| [least, middle, most]),
            work: median(&work),
        }
    }
}

/// Error of the pressure at the points with two sets over that with one, at every output that both have.
fn error_ratios(pair: &Pair<'_>) -> Vec<f64> {
    let error = |record: &Record, time: f64| {
        let reference = &record.references.first()?.name;
        first_error(record, Quantity::Pressure, Sample::Points, reference, time)
    };
    let times = pair.with_one.case.time_factors.iter();
    let both = times.filter_map(|time| Some((error(pair.with_one, *time)?, error(pair.with_two, *time)?)));
    both.filter(|(one, _)| *one > 0.0).map(|(one, two)| two / one).collect()
}

/// The least and the largest of some ratios; `None` without any.
fn ends(ratios: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    Some([ratios.clone().reduce(f64::min)?, ratios.reduce(f64::max)?])
}

fn table(rows: &[Row]) -> Table {
    let cells = rows.iter().map(|row| {
        let error =
            |place: usize| Cell::of(row.errors.map(|all| all[place]), Cell::Number, "no pair has an error");
        vec![
            Cell::Code(row.study.clone()),
            Cell::Code(row.method.clone()),
            Cell::Count(row.pairs as u64),
            error(0),
            error(1),
            error(2),
            Cell::of(row.work, Cell::Number, "not counted"),
        ]
    });
    let header = "study | method | > pairs | > error ratio: least | > median | > largest | > work ratio";
    Table::of("Two point sets relative to one", columns(header), cells)
        .file("point-sets")
        .shown(SHOWN_ROWS)
        .note(format!("error of the pressure at the points, at every output; work: {COUNTED_WORK}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;
    use oedometer_problem::outcome::Counters;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [1e-4, 2e-4]\n[[sweep]]\n\
        method = ['GIMP-SRI-patch', 'MPM']\ncells = [4, 8]\nsets = [1, 2]\n";

    #[test]
    fn each_method_has_its_ratios_and_each_side_its_failures() {
        let (study, mut records) = solved("s", STUDY);
        for record in &mut records {
            let is_mpm = record.case.method.to_string() == "MPM";
            let has_two = record.case.column.points.has_two_sets();
            let error = match (is_mpm, record.case.cells, has_two) {
                (_, _, false) => 0.2,
                (true, 4, true) => 0.1,
                (true, _, true) => 0.8,
                (false, _, true) => 0.3,
            };
            record.errors.iter_mut().for_each(|row| row.value = error);
            // Twice as many points for as many steps.
            record.counters =
                Counters { steps: 1000, points: if has_two { 1600 } else { 800 }, ..record.counters };
            if is_mpm && record.case.cells == 8 {
                record.status = failed_at(3);
            }
        }
        let found = |records: &[Record]| ask(&[StudyResults::new(&study, records, Tier::Full)]);
        let work = |method: &str, sets: usize| {
            let is_it = |one: &&Record| {
                one.case.method.to_string() == method && one.case.column.points.has_two_sets() == (sets == 2)
            };
            cost_of(records.iter().find(is_it).expect("a run"))
        };
        let ratios = ["GIMP-SRI-patch", "MPM"].map(|method| work(method, 2) / work(method, 1));
        let [least, most] = ends(ratios.into_iter()).expect("two").map(|ratio| format!("{ratio:.2}"));
        let answer = found(&records).expect("four pairs");
        assert_eq!(
            answer.sentence().expect("a sentence"),
            format!(
                "4 pairs of runs differ only in the number of point sets: with two sets the pressure error \
                 is 0.50 to 4.00 times that with one. 1 single-point run and 1 double-point run ended \
                 before the last output; in 0 double-point runs \
             the pressure exceeded what the load can cause. Two sets take {least} to {most} times the work."
            )
        );
        assert!(ratios.into_iter().all(|ratio| ratio > 1.0), "{ratios:?}");
        let shown: Vec<Vec<String>> =
            answer.tables()[0].rows.iter().map(|row| row.iter().map(Cell::show).collect()).collect();
        assert_eq!(shown[0][..6], ["s", "GIMP-SRI-patch", "2", "1.5", "1.5", "1.5"]);
        assert_eq!(shown[1][..6], ["s", "MPM", "2", "0.5", "2.25", "4"]);
        // A run without its twin is in no pair.
        records.retain(|record| record.case.column.points.has_two_sets() || record.case.cells == 4);
        assert_eq!(found(&records).expect("two pairs").facts["pairs"], 2);
        records.retain(|record| record.case.column.points.has_two_sets());
        assert_eq!(found(&records), None);
    }
}
