//! How every case of a hard study ended, and what a study measures beside errors of fields: peaks, quantities that must not
//! move, start checks, balances and dimensionless groups.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_measure;
use crate::measure::record_checks;
use crate::measure::record_checks::RecordCheck;
use crate::measure::soundness;
use crate::questions::blocks::number::Number;
use crate::questions::study_results::StudyResults;
use crate::record::{MeasureRow, Record, Status};
use oedometer_problem::outcome::Failure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A measure of a run at its worst output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasureFinding {
    /// Label of the case.
    pub case: String,
    /// Name of the measure.
    pub name: String,
    /// Time factor; `None` for a measure of the whole run.
    pub time_factor: Option<f64>,
    /// What was found.
    pub found: Number,
    /// What is exact.
    pub exact: f64,
    /// The error, relative where the exact value is not zero.
    pub error: Number,
}

/// The worst of a check over the runs of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstCheck {
    /// What is checked.
    pub what: String,
    /// Value.
    pub value: Number,
    /// Largest size that passes.
    pub bound: Option<f64>,
    /// Whether it is within its bound; a check without one holds.
    pub holds: bool,
    /// Why it is not judged, where that is so.
    pub unjudged: String,
}

/// The largest of a dimensionless group over the runs of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroupFinding {
    /// Name and formula.
    pub what: String,
    /// Largest value.
    pub value: f64,
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EndFinding {
    /// Cells over the height.
    pub cells: usize,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// What else is not the study's.
    pub variant: String,
    /// Method, with the integrator where it is not the explicit one.
    pub runner: String,
    /// Kind and step of the failure.
    pub failure: Option<String>,
    /// Error of the pressure at the points at the last output.
    pub error: Option<f64>,
}

/// One finding per case and measure.
pub fn measures(records: &[Record]) -> Vec<MeasureFinding> {
    let of_record = |record: &Record| {
        let case = record.case.label();
        let finding = |row: &MeasureRow| MeasureFinding {
            case: case.clone(),
            name: row.name.clone(),
            time_factor: row.time_factor,
            found: Number(row.found),
            exact: row.exact,
            error: Number(row.error()),
        };
        worst_of(record).into_iter().map(finding).collect::<Vec<_>>()
    };
    records.iter().flat_map(of_record).collect()
}

/// The row with the largest error of every measure of a record, in the order of the record; NaN is worst.
fn worst_of(record: &Record) -> Vec<&MeasureRow> {
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

impl WorstCheck {
    fn new(check: &RecordCheck) -> Self {
        Self {
            what: check.what.to_owned(),
            value: Number(check.value),
            bound: check.bound,
            holds: check.holds(),
            unjudged: check.unjudged.to_owned(),
        }
    }
}

/// The worst of every check of some records, in the order of the checks.
fn checks_of<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<WorstCheck> {
    record_checks::worst_of(records).iter().map(WorstCheck::new).collect()
}

/// The worst of every check over all sound runs: those that failed have no result to check.
pub fn worst_checks(records: &[Record]) -> Vec<WorstCheck> {
    checks_of(records.iter().filter(|record| record.status == Status::Ok))
}

/// The checks and groups of one record, and what they object to.
pub struct RecordChecks {
    /// Every check, at its worst output.
    pub checks: Vec<WorstCheck>,
    /// Dimensionless groups.
    pub groups: Vec<GroupFinding>,
    /// What cannot be right, in sentences.
    pub complaints: Vec<String>,
}

impl RecordChecks {
    /// Those of a record.
    pub fn new(record: &Record) -> Self {
        Self {
            checks: checks_of([record]),
            groups: largest_groups(std::slice::from_ref(record)),
            complaints: soundness::complaints_of_run(record),
        }
    }
}

/// The dimensionless groups of a record.
fn groups_of(record: &Record) -> [(&'static str, f64); 3] {
    let groups = &record.groups;
    [
        ("storage n E_oed/K_w", groups.storage),
        ("finite strain m_vl q", groups.finite_strain),
        ("inertia c_v/(H V)", groups.inertia),
    ]
}

/// The largest of each group over all runs.
pub fn largest_groups(records: &[Record]) -> Vec<GroupFinding> {
    let largest = records.iter().map(groups_of).reduce(|mut largest, groups| {
        for (largest, group) in largest.iter_mut().zip(groups) {
            largest.1 = largest.1.max(group.1);
        }
        largest
    });
    let finding = |(what, value): (&str, f64)| GroupFinding { what: what.to_owned(), value };
    largest.into_iter().flatten().map(finding).collect()
}

/// How each case ended, for a study that expects how its cases end; empty for others.
pub fn ends(results: &StudyResults<'_>) -> Vec<EndFinding> {
    if results.study.case_expectations.iter().all(|expectation| expectation.demand.status.is_none()) {
        return Vec::new();
    }
    results.records.iter().map(end_of).collect()
}

/// How a case ended.
pub fn end_of(record: &Record) -> EndFinding {
    let case = &record.case;
    let runner = if case.is_explicit() {
        case.method.to_string()
    } else {
        format!("{}, {}", case.method, case.integrator.name())
    };
    let own = record.references.first().zip(case.time_factors.last());
    let error = own.and_then(|(own, at)| {
        first_measure(Quantity::Pressure, Sample::Points, &own.name, *at).error(record).map(|row| row.value)
    });
    EndFinding {
        cells: case.cells,
        points_per_cell: case.points_per_cell,
        variant: case.variant(),
        runner,
        failure: record.status.failure().map(Failure::name_with_step),
        error: error.filter(|_| record.status == Status::Ok),
    }
}
