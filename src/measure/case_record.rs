//! From a run to its record: errors against every reference, start checks, balances, groups.

use crate::case::Case;
use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::elementary;
use crate::exact::cosine_layer::{LayerFields, LayerState};
use crate::exact::error::ExactError;
use crate::exact::reference::{Reference, ReferenceKind};
use crate::measure::norms;
use crate::mpm::critical_step::formula;
use crate::mpm::critical_step::observed::CriticalStep;
use crate::mpm::run::integrator::Formulation;
use crate::mpm::run::outcome::{Counters, Failure, FailureKind, Outcome, RunStatus, StepSizes};
use crate::mpm::run::snapshot::{PlaneSamples, Samples, Snapshot};
use crate::record::provenance::Provenance;
use crate::record::{
    Balance, ErrorRow, Groups, HistoryRow, Record, ReferenceUse, SCHEMA, StartChecks, Status,
};
use crate::scene::column::column_parameters;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Norms of a field's error.
const FIELD_NORMS: [Norm; 3] = [Norm::L1, Norm::L2, Norm::Linf];

/// The record of a run; wall times are added by who measured them.
///
/// # Errors
/// When a reference refuses the case's parameters.
pub fn record_of(case: &Case, references: &[ReferenceKind], outcome: Outcome) -> Result<Record, ExactError> {
    let parameters = column_parameters(&case.column, &case.material);
    let mut prepared = case.time_factors.clone();
    prepared.push(LONG_AFTER);
    let references: Vec<Reference> = references
        .iter()
        .map(|kind| Reference::new(kind.of_soil(&case.material), &parameters, &prepared))
        .collect::<Result<_, _>>()?;
    let mut errors = Vec::new();
    for (time_factor, snapshot) in case.time_factors.iter().zip(&outcome.snapshots) {
        // Nothing is held against a theory that leaves out what rules here.
        for reference in references.iter().filter(|one| inertia_rules(case, one.kind()).is_none()) {
            errors.extend(snapshot_errors(case, reference, *time_factor, snapshot)?);
        }
    }
    let final_settlement = references.first().map_or(Ok(f64::NAN), |own| own.settlement(LONG_AFTER))?;
    let history: Vec<HistoryRow> = outcome
        .history
        .iter()
        .map(|point| HistoryRow {
            time_factor: parameters.time_factor(point.time),
            degree_of_consolidation: point.settlement / final_settlement,
        })
        .collect();
    let balance = case
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
        start: Some(start_checks(case, &references, &outcome.start)?),
        balance,
        errors,
        history,
        references: references.iter().map(|one| reference_use(case, one)).collect::<Result<_, _>>()?,
        snapshots: outcome.snapshots,
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
        history: Vec::new(),
        references: Vec::new(),
        snapshots: Vec::new(),
        stability: Some(found),
        provenance: Provenance::of_this_program(),
        digest: String::new(),
    }
}

/// The record of a case whose search for the critical step was stopped from outside.
pub fn record_of_stopped_search(case: &Case) -> Record {
    let none = CriticalStep {
        predicted: 0.0,
        creeping_from: None,
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

/// Time factor by which every column is consolidated to round-off.
const LONG_AFTER: f64 = 50.0;

/// Which field of which sample is held against which reference.
#[derive(Clone, Copy, Debug)]
pub struct FieldError<'a> {
    /// Time factor.
    pub time_factor: f64,
    /// Quantity.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// Name of the reference.
    pub reference: &'a str,
    /// What absolute errors are divided by, in the unit of the field.
    pub scale: f64,
    /// Share of the scale down to which the reference tells a field from zero: see [`resolution`].
    pub resolution: f64,
}

/// Exact values below this share of their scale are lost in the round-off of a run, whose pressures
/// and displacements are of the size of the scale: an error relative to them means nothing.
pub const UNRESOLVED: f64 = 1e4 * f64::EPSILON;

/// Share of the load, or of the final settlement, below which a reference has no value to hold an
/// error against: its own accuracy at that time, and round-off at least.
pub fn resolution(reference: &Reference, time_factor: f64) -> f64 {
    let accuracy = reference.accuracy(time_factor).map_or(0.0, |accuracy| accuracy.tail_bound);
    accuracy.max(UNRESOLVED)
}

impl FieldError<'_> {
    /// The error in every norm of fields in which it is defined; in none where the exact field is zero
    /// or too small to be told from it.
    pub fn rows(self, computed: &[f64], exact: &[f64], volume: &[f64]) -> impl Iterator<Item = ErrorRow> {
        let largest = exact.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let is_lost = largest <= self.resolution * self.scale.abs();
        FIELD_NORMS.into_iter().filter(move |_| !is_lost).filter_map(move |norm| {
            Some(ErrorRow {
                time_factor: self.time_factor,
                quantity: self.quantity,
                sample: self.sample,
                norm,
                reference: self.reference.to_owned(),
                value: norms::relative_error(norm, computed, exact, volume).ok()?,
                absolute: norms::absolute_error(norm, computed, exact, volume).ok()? / self.scale,
            })
        })
    }
}

/// The signed error of a settlement, m, where it is defined and the exact one is no round-off;
/// absolute over a scale, m.
///
/// # Errors
/// When the reference refuses the time factor.
pub fn settlement_error(
    reference: &Reference,
    time_factor: f64,
    settlement: f64,
    scale: f64,
) -> Result<Option<ErrorRow>, ExactError> {
    let exact = reference.settlement(time_factor)?;
    if exact.abs() <= resolution(reference, time_factor) * scale.abs() {
        return Ok(None);
    }
    let value = settlement / exact - 1.0;
    Ok(value.is_finite().then(|| ErrorRow {
        time_factor,
        quantity: Quantity::Settlement,
        sample: Sample::Surface,
        norm: Norm::Relative,
        reference: reference.name().to_owned(),
        value,
        absolute: (settlement - exact) / scale,
    }))
}

/// Every error of a snapshot against a reference; where a relative error is not defined, for the
/// exact field is zero or below round-off, there is no row.
fn snapshot_errors(
    case: &Case,
    reference: &Reference,
    time_factor: f64,
    snapshot: &Snapshot,
) -> Result<Vec<ErrorRow>, ExactError> {
    let load = case.column.load;
    let final_settlement = reference.settlement(LONG_AFTER)?;
    let resolution = resolution(reference, time_factor);
    let mut rows = Vec::new();
    for (sample, samples) in [
        (Sample::Points, &snapshot.points),
        (Sample::Centres, &snapshot.centres),
        (Sample::Nodes, &snapshot.nodes),
    ] {
        let exact = exact_samples(case, reference, time_factor, samples)?;
        let displacements = (displacement_components(samples), displacement_components(&exact));
        let volumes = samples.volume.repeat(if samples.plane.is_some() { 2 } else { 1 });
        for (quantity, computed, exact, volume, scale) in [
            (Quantity::Pressure, &samples.pressure, &exact.pressure, &samples.volume, load),
            (
                Quantity::EffectiveStress,
                &samples.effective_stress,
                &exact.effective_stress,
                &samples.volume,
                load,
            ),
            (Quantity::Displacement, &displacements.0, &displacements.1, &volumes, final_settlement),
        ] {
            let reference = reference.name();
            let field = FieldError { time_factor, quantity, sample, reference, scale, resolution };
            rows.extend(field.rows(computed, exact, volume));
        }
    }
    rows.extend(settlement_error(reference, time_factor, snapshot.settlement, final_settlement)?);
    Ok(rows)
}

/// The exact fields at the Lagrangian places of the samples.
///
/// # Errors
/// When the reference refuses the time factor.
pub fn exact_samples(
    case: &Case,
    reference: &Reference,
    time_factor: f64,
    samples: &Samples,
) -> Result<Samples, ExactError> {
    let depth = |height: f64| (1.0 - height / case.column.height).clamp(0.0, 1.0);
    if let (Some(plane), Some(state)) = (&samples.plane, reference.plane_state(time_factor)?) {
        return exact_plane_samples(case, &state, samples, plane);
    }
    let mut exact = Samples { initial_height: samples.initial_height.clone(), ..Samples::default() };
    let displaced = samples.displacement_height.as_ref().unwrap_or(&samples.initial_height);
    for (height, displaced) in samples.initial_height.iter().zip(displaced) {
        let fields = reference.fields(time_factor, depth(*height))?;
        exact.pressure.push(fields.pressure);
        exact.effective_stress.push(fields.effective_stress);
        exact.displacement.push(reference.fields(time_factor, depth(*displaced))?.displacement);
    }
    // A column strains vertically only.
    exact.plane = samples.plane.as_ref().map(|plane| PlaneSamples {
        horizontal_displacement: vec![0.0; plane.horizontal_displacement.len()],
        ..plane.clone()
    });
    Ok(exact)
}

/// The exact fields of a layer at the places of the samples: one evaluation a height.
fn exact_plane_samples(
    case: &Case,
    state: &LayerState,
    samples: &Samples,
    plane: &PlaneSamples,
) -> Result<Samples, ExactError> {
    let mut amplitudes: BTreeMap<u64, LayerFields> = BTreeMap::new();
    let mut fields_at = |distance: f64, height: f64| {
        let height = height.clamp(0.0, case.column.height);
        let found = match amplitudes.entry(height.to_bits()) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => *new.insert(state.amplitudes(height)?),
        };
        Ok::<_, ExactError>(found.at(state.wave_number() * distance))
    };
    let mut exact = Samples { initial_height: samples.initial_height.clone(), ..Samples::default() };
    for (distance, height) in plane.initial_distance.iter().zip(&samples.initial_height) {
        let fields = fields_at(*distance, *height)?;
        exact.pressure.push(fields.pressure);
        exact.effective_stress.push(fields.effective_stress[1]);
    }
    let mut horizontal_displacement = Vec::with_capacity(samples.displacement.len());
    let displaced_height = samples.displacement_height.as_ref().unwrap_or(&samples.initial_height);
    let displaced_distance = plane.displacement_distance.as_ref().unwrap_or(&plane.initial_distance);
    for (distance, height) in displaced_distance.iter().zip(displaced_height) {
        let [horizontal, vertical] = fields_at(*distance, *height)?.displacement;
        horizontal_displacement.push(horizontal);
        exact.displacement.push(vertical);
    }
    exact.plane = Some(PlaneSamples { horizontal_displacement, ..plane.clone() });
    Ok(exact)
}

/// Every component of the displacement in one list: its L2 norm is that of the vectors.
fn displacement_components(samples: &Samples) -> Vec<f64> {
    let mut components = samples.displacement.clone();
    if let Some(plane) = &samples.plane {
        components.extend(&plane.horizontal_displacement);
    }
    components
}

fn groups(case: &Case, step_over_limit: f64) -> Groups {
    let soil = &case.material;
    Groups {
        storage: soil.oedometric_modulus() / soil.coupling_modulus(),
        finite_strain: case.column.load / soil.oedometric_modulus(),
        inertia: soil.coefficient_of_consolidation()
            / (case.column.height * formula::undrained_wave_speed(soil)),
        step_over_limit,
    }
}

fn start_checks(case: &Case, references: &[Reference], start: &Snapshot) -> Result<StartChecks, ExactError> {
    let soil = &case.material;
    let load = case.column.load;
    let found = (&*start.points.initial_height, &*start.points.pressure);
    let expected = case.scene.expected_start_pressures(&case.column, soil, references.first(), found)?;
    let off = found.1.iter().zip(&expected).map(|(pressure, expected)| (pressure - expected).abs() / load);
    Ok(StartChecks {
        points: start.points.pressure.len(),
        points_expected: case.expected_points(),
        volume_error: start.totals.volume / case.column.volume() - 1.0,
        undrained_pressure_error: off.fold(0.0, f64::max),
        unbalanced_force: start.totals.unbalanced_force / load,
    })
}

fn balance(case: &Case, time_factor: f64, start: &Snapshot, now: &Snapshot) -> Balance {
    let load = case.column.load;
    let applied = if case.scene.is_loaded() { load } else { 0.0 };
    let stresses = now.points.effective_stress.iter().zip(&now.points.pressure);
    let squares: f64 =
        stresses.map(|(stress, pressure)| elementary::powi((stress - pressure + applied) / load, 2)).sum();
    // What the load presses out in the end: of what leaves up to now nothing may be left, as at the start
    // or under a cosine.
    let pressed_out = load / case.material.oedometric_modulus() * case.column.height;
    let surface = case.column.volume() / case.column.height;
    let excess = now.totals.surface_flux - now.totals.water_expansion / surface;
    Balance {
        time_factor,
        solid_mass_drift: now.totals.solid_mass / start.totals.solid_mass - 1.0,
        water_imbalance: excess / pressed_out,
        internal_force_imbalance: now.totals.internal_force_imbalance,
        // Above one dimension the vertical stress alone is in no balance with the load: the nodes are.
        equilibrium_residual: if case.scene.needs_two_dimensions() {
            now.totals.unbalanced_force / (load * case.cell_size())
        } else {
            (squares / now.points.pressure.len() as f64).sqrt()
        },
        settlement_curve_gap: 0.0,
    }
}

/// How far the settlement at an output lies from the settlement curve, beyond what interpolation
/// explains: the curve is taken cubic in `ln T_v` through its four nearest rows, and allowed its
/// distance from the straight line.
fn curve_gap(curve: &[HistoryRow], time_factor: f64, degree: f64) -> f64 {
    let after = curve.partition_point(|row| row.time_factor <= time_factor);
    if after == 0 || after == curve.len() {
        return 0.0;
    }
    let through = |rows: &[HistoryRow]| -> f64 {
        let at = |row: &HistoryRow| elementary::ln(row.time_factor / time_factor);
        let lagrange = |row: &HistoryRow| -> f64 {
            let others = rows.iter().filter(|other| other.time_factor != row.time_factor);
            others.map(|other| at(other) / (at(other) - at(row))).product()
        };
        rows.iter().map(|row| row.degree_of_consolidation * lagrange(row)).sum()
    };
    let straight = through(&curve[after - 1..=after]);
    let cubic = through(&curve[after.saturating_sub(2)..(after + 2).min(curve.len())]);
    ((degree - cubic).abs() - (cubic - straight).abs()).max(0.0)
}

/// Change of the slowest rate of consolidation by the skeleton's inertia beyond which the quasi-static
/// references do not hold. Terzaghi's settlement at `T_v = 0.05` is then 2 in a thousand off that of the
/// column with its inertia (both exact), and the gap grows in proportion.
const MOST_INERTIA: f64 = 1e-3;

/// Why a quasi-static reference does not hold for a case that is solved with its inertia, where it does
/// not. A scene of waves is about that difference and measures it.
fn inertia_rules(case: &Case, reference: ReferenceKind) -> Option<String> {
    // The undrained start is an equilibrium, whatever comes after it.
    let moves = case.time_factors.iter().any(|time_factor| *time_factor > 0.0);
    let has_inertia = moves && case.formulation != Formulation::QuasiStatic;
    let change = skeleton_inertia(case);
    let holds = change <= MOST_INERTIA;
    (has_inertia && !case.scene.has_waves() && !holds).then(|| {
        format!(
            "`{}` is quasi-static and does not hold: the skeleton's inertia changes the rate of consolidation by \
             {change:.1e}, more than {MOST_INERTIA:.0e}",
            reference.name()
        )
    })
}

/// Relative change of the slowest rate of consolidation by the inertia of the skeleton.
///
/// Water that cannot be compressed moves against the skeleton: a mode of wave number `κ = π/(2H)` has
/// `m ü + (γ_w/k) u̇ + κ² E_oed u = 0` with `m = (1−n)ρ_s + (1−n)²/n ρ_w`, and its slower rate is
/// `c_v κ² (1 + δ + …)` with `δ = (κ c_v)² m/E_oed`.
pub fn skeleton_inertia(case: &Case) -> f64 {
    let soil = &case.material;
    let n = soil.porosity;
    let inertia = (1.0 - n) * soil.grain_density + (1.0 - n) * (1.0 - n) / n * soil.water_density;
    let wave_number = std::f64::consts::FRAC_PI_2 / case.column.height;
    elementary::powi(wave_number * soil.coefficient_of_consolidation(), 2) * inertia
        / soil.oedometric_modulus()
}

fn reference_use(case: &Case, reference: &Reference) -> Result<ReferenceUse, ExactError> {
    let does_not_hold = inertia_rules(case, reference.kind());
    let mut entry =
        ReferenceUse { name: reference.name().to_owned(), terms: 0, tail_bound: 0.0, does_not_hold };
    for time_factor in &case.time_factors {
        let accuracy = reference.accuracy(*time_factor)?;
        entry.terms = entry.terms.max(accuracy.terms);
        entry.tail_bound = entry.tail_bound.max(accuracy.tail_bound);
    }
    Ok(entry)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::parameters::ColumnParameters;

    /// `U = a √T_v` at seven rows from 0.01 to 0.64.
    fn curve() -> Vec<HistoryRow> {
        let row = |step: i32| {
            let time_factor = 0.01 * 2_f64.powi(step);
            HistoryRow { time_factor, degree_of_consolidation: time_factor.sqrt() }
        };
        (0..7).map(row).collect()
    }

    #[test]
    fn a_settlement_off_its_curve_has_a_gap_on_either_side() {
        let curve = curve();
        for time_factor in [0.015, 0.03, 0.1, 0.5] {
            let on_curve = f64::sqrt(time_factor);
            assert_eq!(curve_gap(&curve, time_factor, on_curve), 0.0, "{time_factor}");
            for off in [0.1, -0.1] {
                let gap = curve_gap(&curve, time_factor, on_curve + off);
                // What interpolation explains, the cubic's distance from the straight line, is let go.
                assert!(gap > 0.075 && gap <= 0.1 + 1e-3, "{gap} at {time_factor} for {off}");
            }
        }
        // At a row of the curve nothing is left to interpolation.
        assert!((curve_gap(&curve, 0.04, 0.2 + 0.01) - 0.01).abs() < 1e-9);
        assert_eq!(curve_gap(&curve, 0.005, 5.0), 0.0, "before the first row there is no curve");
        assert_eq!(curve_gap(&curve, 0.9, 5.0), 0.0, "nor beyond the last");
    }

    fn field(scale: f64, resolution: f64) -> FieldError<'static> {
        let (quantity, sample) = (Quantity::Pressure, Sample::Points);
        FieldError { time_factor: 1.0, quantity, sample, reference: "terzaghi", scale, resolution }
    }

    #[test]
    fn an_exact_field_below_the_resolution_has_no_relative_error() {
        let rows = |exact: f64, resolution: f64| {
            field(100.0, resolution).rows(&[1e-11, 2e-11], &[exact, 0.5 * exact], &[1.0, 1.0]).count()
        };
        assert_eq!(rows(1e-50, UNRESOLVED), 0);
        assert_eq!(rows(0.9 * 100.0 * UNRESOLVED, UNRESOLVED), 0);
        assert_eq!(rows(1.1 * 100.0 * UNRESOLVED, UNRESOLVED), FIELD_NORMS.len());
        // A reference that is good to 1e-6 of the load resolves no pressure of 1e-7 of it.
        assert_eq!(rows(1e-5, 1e-6), 0);
        assert_eq!(rows(1e-3, 1e-6), FIELD_NORMS.len());
    }

    #[test]
    fn long_after_the_end_pressures_have_no_error_and_the_settlement_has() {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[50.0]).expect("the seed column");
        assert_eq!(resolution(&reference, 50.0), UNRESOLVED);
        assert!(reference.fields(50.0, 1.0).expect("inside").pressure < 1e-40 * column.load);
        let settled = column.final_settlement();
        let row = settlement_error(&reference, 50.0, 1.01 * settled, settled).expect("a time");
        assert!((row.expect("an error").value - 0.01).abs() < 1e-9);
        // A settlement that round-off could have made has none.
        let nothing = settlement_error(&reference, 50.0, settled, 1e13 * settled).expect("a time");
        assert_eq!(nothing, None);
    }
}
