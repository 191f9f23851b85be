//! Where the error of one case comes from: which norm and place carries it, how it stands among
//! the other levels of its study, and what changed against the golden values.

use crate::case::Case;
use crate::case::norm::Norm;
use crate::golden::compare::{Difference, compare};
use crate::golden::{GoldenFile, measure_name, values_of};
use crate::judge::error_place::{ErrorPlace, place_of};
use crate::judge::paths::{level_size, paths};
use crate::record::{ErrorRow, Record};
use crate::study::expectation::Axis;
use oedometer_convergence::class::Context;
use oedometer_convergence::class::classify::classify;
use oedometer_convergence::series::{ErrorSeries, SeriesLevel};
use oedometer_exact::exact_error::ExactError;

/// The error of one quantity at one kind of places, at the output where it is largest.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Carrier {
    /// Its L2 error, or the relative one of a settlement.
    pub row: ErrorRow,
    /// Mean and largest error at the same output.
    pub l1: Option<f64>,
    /// Largest error at the same output.
    pub linf: Option<f64>,
    /// The place that carries most of it; none where the quantity has one place only.
    pub place: Option<ErrorPlace>,
}

/// The error of the case among its neighbours along one axis.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LevelSeries {
    /// What is refined.
    pub axis: Axis,
    /// Labels of the levels from coarse to fine.
    pub labels: Vec<String>,
    /// Errors, where they are known: this case's own, the others' golden ones.
    pub errors: Vec<Option<f64>>,
    /// Place of this case among them.
    pub own: usize,
    /// Class of the series.
    pub class: &'static str,
    /// Its reason.
    pub reason: String,
}

/// Everything said of a case.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Explanation {
    /// Carriers, the largest error first.
    pub carriers: Vec<Carrier>,
    /// Series of the first carrier's error, one an axis that the study refines.
    pub levels: Vec<LevelSeries>,
    /// What differs from the golden values of this case.
    pub differences: Vec<Difference>,
    /// Golden values of this case that agree.
    pub agreeing: usize,
    /// Whether there are golden values to hold against.
    pub has_golden: bool,
}

/// Explains a record. `focus` puts the carrier of a golden value's name first.
///
/// # Errors
/// When a reference refuses the case.
pub fn explain(
    record: &Record,
    siblings: &[&Case],
    golden: Option<&GoldenFile>,
    focus: Option<&str>,
) -> Result<Explanation, ExactError> {
    let mut carriers = carriers_of(record)?;
    carriers.sort_by(|a, b| b.row.value.abs().total_cmp(&a.row.value.abs()));
    if let Some(focus) = focus {
        carriers.sort_by_key(|carrier| !same_measure(&measure_name(&carrier.row), focus));
    }
    let levels = match (carriers.first(), golden) {
        (Some(first), Some(golden)) => levels_of(record, siblings, golden, &first.row),
        _ => Vec::new(),
    };
    let (differences, agreeing) = golden.map_or((Vec::new(), 0), |golden| differences_of(record, golden));
    Ok(Explanation { carriers, levels, differences, agreeing, has_golden: golden.is_some() })
}

/// Whether two names are of one quantity and place, whatever norm and time.
fn same_measure(a: &str, b: &str) -> bool {
    let words = |name: &str| name.split(' ').take(2).map(str::to_owned).collect::<Vec<_>>();
    words(a) == words(b)
}

/// Against the first reference, the output with the largest error of every quantity and place.
fn carriers_of(record: &Record) -> Result<Vec<Carrier>, ExactError> {
    let Some(own) = record.references.first() else { return Ok(Vec::new()) };
    let mut largest: Vec<&ErrorRow> = Vec::new();
    let main = |row: &&ErrorRow| row.reference == own.name && matches!(row.norm, Norm::L2 | Norm::Relative);
    for row in record.errors.iter().filter(main) {
        match largest.iter_mut().find(|other| (other.quantity, other.sample) == (row.quantity, row.sample)) {
            Some(other) if row.value.abs() > other.value.abs() => *other = row,
            Some(_) => {}
            None => largest.push(row),
        }
    }
    largest
        .into_iter()
        .map(|row| {
            let norm = |norm| {
                record
                    .error(row.quantity, row.sample, norm, &row.reference, row.time_factor)
                    .map(|row| row.value)
            };
            let place = place_of(record, row)?;
            Ok(Carrier { row: row.clone(), l1: norm(Norm::L1), linf: norm(Norm::Linf), place })
        })
        .collect()
}

/// The case's error among the golden ones of the cases that differ from it along one axis only.
fn levels_of(record: &Record, siblings: &[&Case], golden: &GoldenFile, row: &ErrorRow) -> Vec<LevelSeries> {
    // Paths sort and group records; a sibling that was not run is one with nothing measured.
    let empty = |case: &&Case| Record {
        case: (*case).clone(),
        hash: case.hash(),
        errors: Vec::new(),
        snapshots: Vec::new(),
        ..record.clone()
    };
    let mut records: Vec<Record> = siblings.iter().filter(|case| **case != &record.case).map(empty).collect();
    records.push(record.clone());
    let mut all = Vec::new();
    for axis in Axis::REFINEMENTS.into_iter().filter(|axis| *axis != Axis::TimeStep) {
        let path = paths(&records, axis)
            .into_iter()
            .find(|path| path.records.iter().any(|other| other.hash == record.hash));
        let Some(path) = path else { continue };
        let error = |other: &&Record| {
            if other.hash == record.hash {
                return Some(row.value.abs());
            }
            let name = format!("{} | {}", other.case.label(), measure_name(row));
            golden.values.get(&name).map(|value| value.abs())
        };
        let errors: Vec<Option<f64>> = path.records.iter().map(error).collect();
        let known = path.records.iter().zip(&errors).filter(|(_, error)| error.is_some());
        let level = |(other, error): (&&Record, &Option<f64>)| SeriesLevel {
            size: level_size(other, axis),
            error: *error,
        };
        let found = classify(&ErrorSeries::new(known.map(level).collect()), &Context::default());
        all.push(LevelSeries {
            axis,
            labels: path.records.iter().map(|other| level_label(&other.case, axis)).collect(),
            own: path.records.iter().position(|other| other.hash == record.hash).unwrap_or(0),
            errors,
            class: found.class.name(),
            reason: found.reason,
        });
    }
    all
}

fn level_label(case: &Case, axis: Axis) -> String {
    match axis {
        Axis::PointsPerCell => format!("{} points a cell", case.points_per_cell),
        _ => format!("{} cells", case.cells),
    }
}

/// Differences from the golden values of this case alone, and how many agree.
fn differences_of(record: &Record, golden: &GoldenFile) -> (Vec<Difference>, usize) {
    let prefix = format!("{} | ", record.case.label());
    let mut of_case = golden.clone();
    of_case.values.retain(|name, _| name.starts_with(&prefix));
    let differences = compare(&of_case, &values_of(std::slice::from_ref(record)));
    let there = differences.iter().filter(|one| one.golden.is_some()).count();
    let agreeing = of_case.values.len() - there;
    (differences, agreeing)
}
