//! Makes the record of a case from the outcome that its solver left.

use crate::case::outcome::{Inside, Outcome};
use crate::case::{Case, Task};
use crate::measure::balances::{balance, curve_gap, start_checks};
use crate::measure::dimensionless_groups::{groups, inertia_rules};
use crate::measure::fields::snapshot_errors;
use crate::measure::other_measures::{load_factor, measures_of};
use crate::measure::statistics::larger;
use crate::measure::theory::known_reference;
use crate::record::{
    AttachedRun, Balance, ErrorRow, HistoryRow, Provenance, Record, ReferenceUse, SCHEMA, Status,
};
use oedometer_exact::solution::ROUND_OFF;
use oedometer_exact::{ExactError, Reference, ReferenceKind};
use oedometer_problem::outcome::{Counters, Energy, HistoryPoint, StepSizes};
use oedometer_problem::snapshot::Snapshot;
use oedometer_scenes::column::column_parameters;
use std::sync::Arc;

/// A record without results.
fn empty_record(case: &Case, status: Status, step_sizes: StepSizes, step_over_limit: f64) -> Record {
    Record {
        schema: SCHEMA,
        hash: case.hash(),
        case: case.clone(),
        status,
        counters: Counters::default(),
        step_sizes,
        wall: Vec::new(),
        stability: None,
        groups: groups(case, step_over_limit),
        start: None,
        balance: Vec::new(),
        errors: Vec::new(),
        measures: Vec::new(),
        history: Vec::new(),
        references: Vec::new(),
        snapshots: Vec::new(),
        outside: None,
        provenance: Provenance::of_this_program(),
        digest: String::new(),
    }
}

/// The record of a case of what its solver left. States of a solver within this program are those of the outputs; any
/// other is compared with the exact solutions at its own time.
///
/// # Errors
/// When a reference refuses the case's parameters.
pub fn record_of(case: &Case, references: &[ReferenceKind], outcome: Outcome) -> Result<Record, ExactError> {
    let Outcome { status, snapshots, sample, steps, inside, foreign, wall, .. } = outcome;
    let Some(inside) = inside else {
        let of_places = || AttachedRun { sample, ..AttachedRun::default() };
        let record = Record { wall, ..empty_record(case, status, steps, 0.0) };
        let record = record.made_outside(foreign.unwrap_or_else(of_places));
        return results_outside(case, snapshots).added_to(record, references);
    };
    let share = match &inside.critical_step {
        Some(critical) => critical.observed.map_or(1.0, |observed| observed / critical.predicted),
        None if case.task == Task::Stability => 1.0,
        None => steps.largest / steps.predicted_critical,
    };
    let Inside { counters, start, history, critical_step } = inside;
    let record = Record { counters, wall, ..empty_record(case, status, steps, share) };
    if case.task == Task::Stability {
        return Ok(Record { stability: critical_step, ..record });
    }
    let parameters = column_parameters(&case.column, &case.material);
    let point = |point: &HistoryPoint| {
        (parameters.time_factor(point.time), point.settlement, point.plate_force, point.energy)
    };
    let results = Results {
        times: case.time_factors.to_vec(),
        curve: history.iter().map(point).collect(),
        start: start.as_ref(),
        snapshots,
    };
    results.added_to(record, references)
}

/// States of a solver outside of this program, one for each output.
fn results_outside(case: &Case, snapshots: Vec<Snapshot>) -> Results<'static> {
    let parameters = column_parameters(&case.column, &case.material);
    let times: Vec<f64> = snapshots.iter().map(|snapshot| parameters.time_factor(snapshot.time)).collect();
    let settled = snapshots.iter().map(|snapshot| (snapshot.settlement, snapshot.plate_force));
    let curve = times
        .iter()
        .zip(settled)
        .map(|(time, (settlement, force))| (*time, settlement, force, None))
        .collect();
    Results { times, curve, start: None, snapshots }
}

/// Time factor, settlement, m, force on the plate, N, and energy.
type CurvePoint = (f64, f64, Option<f64>, Option<Energy>);

/// What a run computed.
struct Results<'a> {
    /// Time factors of the snapshots.
    times: Vec<f64>,
    curve: Vec<CurvePoint>,
    /// The state at the start, where it is known.
    start: Option<&'a Snapshot>,
    snapshots: Vec<Snapshot>,
}

impl Results<'_> {
    /// The record with everything that is measured of the results.
    fn added_to(self, record: Record, kinds: &[ReferenceKind]) -> Result<Record, ExactError> {
        let case = &record.case;
        let mut prepared = case.time_factors.to_vec();
        if record.outside_run().is_some() {
            prepared.extend(&self.times);
        }
        let references: Vec<Arc<Reference>> = kinds
            .iter()
            .map(|kind| known_reference(case, kind.for_soil(&case.material), &prepared))
            .collect::<Result<_, _>>()?;
        let primary = references.first().map(|primary| &**primary);
        let mut errors = Vec::new();
        for ((asked, time), snapshot) in case.time_factors.iter().zip(&self.times).zip(&self.snapshots) {
            // Runs of this program are not compared with a theory that leaves out the inertia they have.
            let hold = references.iter().filter(|reference| {
                record.outside_run().is_some() || inertia_rules(case, reference.kind()).is_none()
            });
            for reference in hold {
                let rows = snapshot_errors(case, reference, *time, snapshot)?;
                errors.extend(rows.into_iter().map(|row| ErrorRow { time_factor: *asked, ..row }));
            }
        }
        let final_settlement = match primary {
            None => f64::NAN,
            // Where nothing settles, the settlement that a load of the same size would cause.
            Some(primary) if primary.kind() == ReferenceKind::AtRest || primary.kind().is_manufactured() => {
                column_parameters(&case.column, &case.material).final_settlement()
            }
            Some(primary) if primary.kind() == ReferenceKind::Footing => primary.settlement(1.0)?,
            Some(primary) => primary.displacement_scale()?,
        };
        let degree = |(time_factor, settlement, force, energy): &CurvePoint| HistoryRow {
            time_factor: *time_factor,
            degree_of_consolidation: settlement / final_settlement,
            load_factor: force.and_then(|force| load_factor(case, force)),
            energy: *energy,
        };
        let history: Vec<HistoryRow> = self.curve.iter().map(degree).collect();
        let balance = self.start.map_or_else(Vec::new, |start| {
            let outputs = case.time_factors.iter().zip(&self.snapshots);
            let balance_at = |(time_factor, snapshot): (&f64, &Snapshot)| Balance {
                settlement_curve_gap: curve_gap(
                    &history,
                    *time_factor,
                    snapshot.settlement / final_settlement,
                ),
                ..balance(case, *time_factor, start, snapshot)
            };
            outputs.map(balance_at).collect()
        });
        Ok(Record {
            start: self.start.map(|start| start_checks(case, primary, start)).transpose()?,
            measures: measures_of(case, primary, &balance, &self.snapshots),
            balance,
            errors,
            history: history.into_iter().filter(|row| row.degree_of_consolidation.is_finite()).collect(),
            references: references
                .iter()
                .map(|reference| reference_use(case, reference))
                .collect::<Result<_, _>>()?,
            snapshots: self.snapshots,
            ..record
        })
    }
}

/// How far a reference can be trusted for a case, over all of its outputs.
///
/// # Errors
/// When it refuses a time.
fn reference_use(case: &Case, reference: &Reference) -> Result<ReferenceUse, ExactError> {
    let does_not_hold = inertia_rules(case, reference.kind());
    let (mut terms, mut tail_bound, mut tail_bounds) = (0, 0.0, Vec::new());
    for time_factor in case.time_factors.iter() {
        let accuracy = reference.accuracy(*time_factor)?;
        terms = terms.max(accuracy.terms);
        tail_bound = larger(tail_bound, accuracy.bound());
        tail_bounds.push(accuracy.bound());
    }
    if tail_bound <= ROUND_OFF || tail_bounds.iter().all(|bound| *bound == tail_bound) {
        tail_bounds.clear();
    }
    Ok(ReferenceUse { name: reference.name().to_owned(), terms, tail_bound, tail_bounds, does_not_hold })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_is_as_accurate_as_at_its_worst_output_wherever_that_stands() {
        let mut case = Case::seed(crate::case::Task::Solve, &oedometer_scenes::DYNAMIC_COLUMN);
        let mut times = [1e-5, 1e-4, 1e-2];
        let bounds = |case: &Case| -> (Vec<f64>, ReferenceUse) {
            let parameters = column_parameters(&case.column, &case.material);
            let reference = Reference::new(ReferenceKind::DynamicColumn, &parameters, &case.time_factors)
                .expect("a theory");
            let bound = |time: &f64| reference.accuracy(*time).expect("a time").bound();
            (
                case.time_factors.iter().map(bound).collect(),
                reference_use(case, &reference).expect("a theory"),
            )
        };
        for _ in 0..3 {
            case.time_factors = times.to_vec().into();
            let (each, used) = bounds(&case);
            assert!(each.iter().any(|bound| *bound < used.tail_bound), "{each:?}");
            assert_eq!(used.tail_bound, each.iter().copied().fold(0.0, f64::max), "{times:?}");
            let at_each = times.map(|time| used.bound_at(&case, time));
            assert_eq!(at_each[..], each);
            times.rotate_left(1);
        }
    }
}
