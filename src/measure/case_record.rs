//! From a run to its record.

use crate::case::Case;
use crate::measure::balances::{balance, curve_gap, start_checks};
use crate::measure::dimensionless_groups::{groups, inertia_rules};
use crate::measure::fields::field_errors::{LONG_AFTER, snapshot_errors};
use crate::measure::known_references::known_reference;
use crate::measure::other_measures::measures_of;
use crate::record::provenance::Provenance;
use crate::record::{Balance, HistoryRow, Record, ReferenceUse, SCHEMA, Status};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::critical_step::observed::CriticalStep;
use oedometer_mpm::run::results::outcome::{Counters, Failure, FailureKind, Outcome, RunStatus, StepSizes};
use oedometer_mpm::scene::column::column_parameters;
use std::sync::Arc;

/// The record of a run; wall times are added by who measured them.
///
/// # Errors
/// When a reference refuses the case's parameters.
pub fn record_of(case: &Case, references: &[ReferenceKind], outcome: Outcome) -> Result<Record, ExactError> {
    let parameters = column_parameters(&case.column, &case.material);
    let mut prepared = case.time_factors.clone();
    prepared.push(LONG_AFTER);
    let references: Vec<Arc<Reference>> = references
        .iter()
        .map(|kind| known_reference(case, kind.of_soil(&case.material), &prepared))
        .collect::<Result<_, _>>()?;
    let mut errors = Vec::new();
    for (time_factor, snapshot) in case.time_factors.iter().zip(&outcome.snapshots) {
        // Nothing is held against a theory that leaves out what rules here.
        for reference in references.iter().filter(|one| inertia_rules(case, one.kind()).is_none()) {
            errors.extend(snapshot_errors(case, reference, *time_factor, snapshot)?);
        }
    }
    let own = references.first().map(|own| &**own);
    let final_settlement = match own {
        None => f64::NAN,
        // What a load of the scale would make, where nothing settles.
        Some(own) if own.kind() == ReferenceKind::AtRest || own.kind().is_manufactured() => {
            parameters.final_settlement()
        }
        Some(own) => own.settlement(LONG_AFTER)?,
    };
    let history: Vec<HistoryRow> = outcome
        .history
        .iter()
        .map(|point| HistoryRow {
            time_factor: parameters.time_factor(point.time),
            degree_of_consolidation: point.settlement / final_settlement,
        })
        .collect();
    let balance: Vec<Balance> = case
        .time_factors
        .iter()
        .zip(&outcome.snapshots)
        .map(|(time_factor, snapshot)| Balance {
            settlement_curve_gap: curve_gap(&history, *time_factor, snapshot.settlement / final_settlement),
            ..balance(case, *time_factor, &outcome.start, snapshot)
        })
        .collect();
    Ok(Record {
        schema: SCHEMA,
        hash: case.hash(),
        case: case.clone(),
        status: match outcome.status {
            RunStatus::Ok => Status::Ok,
            RunStatus::Failed(failure) => Status::Failed(failure),
        },
        counters: outcome.counters,
        step_sizes: outcome.step_sizes,
        wall: Vec::new(),
        stability: None,
        groups: groups(case, outcome.step_sizes.largest / outcome.step_sizes.predicted_critical),
        start: Some(start_checks(case, own, &outcome.start)?),
        measures: measures_of(case, own, &balance, &outcome.snapshots),
        balance,
        errors,
        history,
        references: references.iter().map(|one| reference_use(case, one)).collect::<Result<_, _>>()?,
        snapshots: outcome.snapshots,
        attached: None,
        provenance: Provenance::of_this_program(),
        digest: String::new(),
    })
}

/// The record of a case whose critical step was searched.
pub fn record_of_critical_step(case: &Case, found: CriticalStep) -> Record {
    let share = found.observed.map_or(1.0, |observed| observed / found.predicted);
    Record {
        schema: SCHEMA,
        hash: case.hash(),
        case: case.clone(),
        status: Status::Ok,
        counters: Counters {
            points: case.cells * case.points_per_cell,
            steps: found.probes.iter().map(|probe| probe.steps).sum(),
            ..Counters::default()
        },
        step_sizes: StepSizes {
            predicted_critical: found.predicted,
            target: found.predicted,
            largest: found.observed.unwrap_or(found.predicted),
        },
        wall: Vec::new(),
        groups: groups(case, share),
        start: None,
        balance: Vec::new(),
        errors: Vec::new(),
        measures: Vec::new(),
        history: Vec::new(),
        references: Vec::new(),
        snapshots: Vec::new(),
        stability: Some(found),
        attached: None,
        provenance: Provenance::of_this_program(),
        digest: String::new(),
    }
}

/// The record of a case whose search for the critical step was stopped from outside.
pub fn record_of_stopped_search(case: &Case) -> Record {
    let none = CriticalStep {
        predicted: 0.0,
        creeping_from: None,
        unknown: None,
        observed: None,
        wave_limit: 0.0,
        drag_limit: 0.0,
        combined_limit: 0.0,
        probes: Vec::new(),
    };
    let failure = Failure {
        kind: FailureKind::Stopped,
        step: 0,
        time: 0.0,
        growth: None,
        reason: "stopped from outside".to_owned(),
    };
    Record { status: Status::Failed(failure), stability: None, ..record_of_critical_step(case, none) }
}

/// How far a reference can be trusted for a case, at all of its outputs.
///
/// # Errors
/// When it refuses a time.
pub fn reference_use(case: &Case, reference: &Reference) -> Result<ReferenceUse, ExactError> {
    let does_not_hold = inertia_rules(case, reference.kind());
    let mut entry =
        ReferenceUse { name: reference.name().to_owned(), terms: 0, tail_bound: 0.0, does_not_hold };
    for time_factor in case.time_factors.iter() {
        let accuracy = reference.accuracy(*time_factor)?;
        entry.terms = entry.terms.max(accuracy.terms);
        entry.tail_bound = entry.tail_bound.max(accuracy.bound());
    }
    Ok(entry)
}
