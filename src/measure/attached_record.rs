//! The record of a case that somebody else's solver has solved.

use crate::case::Case;
use crate::measure::case_record::reference_use;
use crate::measure::dimensionless_groups::groups;
use crate::measure::fields::field_errors::{LONG_AFTER, snapshot_errors};
use crate::measure::known_references::known_reference;
use crate::measure::other_measures::measures_of;
use crate::record::attached_run::AttachedRun;
use crate::record::provenance::Provenance;
use crate::record::{HistoryRow, Record, SCHEMA, Status};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::run::results::outcome::{Counters, StepSizes};
use oedometer_mpm::run::results::snapshot::Snapshot;
use oedometer_mpm::scene::column::column_parameters;
use std::sync::Arc;

/// The record of a case whose states at its outputs, one an output, came from outside; none where it failed. Each
/// state is held against the solution at its own time. Wall times are added by who measured them.
///
/// # Errors
/// When a reference refuses the case's parameters.
pub fn record_of_attached(
    case: &Case,
    references: &[ReferenceKind],
    status: Status,
    snapshots: Vec<Snapshot>,
    suggested_step: f64,
    attached: AttachedRun,
) -> Result<Record, ExactError> {
    let parameters = column_parameters(&case.column, &case.material);
    let own_times: Vec<f64> =
        snapshots.iter().map(|snapshot| parameters.time_factor(snapshot.time)).collect();
    let mut prepared = [case.time_factors.to_vec(), own_times.clone()].concat();
    prepared.push(LONG_AFTER);
    let references: Vec<Arc<Reference>> = references
        .iter()
        .map(|kind| known_reference(case, kind.of_soil(&case.material), &prepared))
        .collect::<Result<_, _>>()?;
    let mut errors = Vec::new();
    for ((asked, own), snapshot) in case.time_factors.iter().zip(&own_times).zip(&snapshots) {
        for reference in &references {
            let rows = snapshot_errors(case, reference, *own, snapshot)?;
            errors.extend(rows.into_iter().map(|mut row| {
                row.time_factor = *asked;
                row
            }));
        }
    }
    let final_settlement = references.first().map_or(Ok(f64::NAN), |own| own.settlement(LONG_AFTER))?;
    let degrees = own_times.iter().zip(&snapshots).map(|(time_factor, snapshot)| HistoryRow {
        time_factor: *time_factor,
        degree_of_consolidation: snapshot.settlement / final_settlement,
    });
    Ok(Record {
        schema: SCHEMA,
        hash: case.hash(),
        case: case.clone(),
        status,
        counters: Counters::default(),
        step_sizes: StepSizes { predicted_critical: 0.0, target: suggested_step, largest: suggested_step },
        wall: Vec::new(),
        stability: None,
        groups: groups(case, 0.0),
        start: None,
        balance: Vec::new(),
        errors,
        measures: measures_of(case, references.first().map(|own| &**own), &[], &snapshots),
        history: degrees.filter(|row| row.degree_of_consolidation.is_finite()).collect(),
        references: references.iter().map(|one| reference_use(case, one)).collect::<Result<_, _>>()?,
        snapshots,
        attached: Some(attached),
        provenance: Provenance::of_this_program(),
        digest: String::new(),
    })
}
