//! Start checks and balances of a record, each with the bound that it is held to: what shows a mark
//! in a table is judged here, and nowhere else.

use crate::mpm::run::results::outcome::FailureKind;
use crate::record::{Balance, Record, Status};
use crate::scene::arrangement::Arrangement;
use crate::soil::continuity::Continuity;
use crate::wording::typed;

/// The check that is told in numbers of points.
const POINTS_MISSING: &str = "points missing at the start";
/// What sums of numbers of like size leave.
const ROUND_OFF: f64 = 1e-9;
/// Force over the load that a direct solver may leave of an equilibrium.
const UNBALANCED: f64 = 1e-6;
/// Gap between outputs and settlement curve that a smooth curve explains.
const CURVE_GAP: f64 = 2e-3;
/// Velocity over the hydraulic conductivity that round-off leaves of a column at rest: some 1e-12 are seen.
const AT_REST: f64 = 1e-9;
/// Water over what the load presses out, on a lattice at rest: ten times what the methods leave on
/// ten cells (3e-6 for a patch at `T_v = 0.05`, 3e-5 within the first steps of an explicit run).
const WATER_AT_REST: f64 = 3e-4;
/// The same where points move or deform: twice the worst of the methods at half the height lost,
/// where operators follow the points and the storage of cells with them.
const WATER_MOVING: f64 = 5e-2;

/// Water in the soil over its pores, less one, where both are counted apart, times the square of the number of cells:
/// twice what the cut at the surface leaves of it (0.2 on ten cells with two points).
const WATER_IN_PORES: f64 = 0.5;
/// Pressure over the load that consolidation cannot reach: it begins at most at the load, the first front overshoots that by
/// a quarter on coarse meshes, and what is beyond half of it is a burst, where forces of the water and of the skeleton end in domains that are cut differently.
const NO_BURST: f64 = 1.5;
/// What `WATER_IN_PORES` is on meshes so fine that other errors rule; a wrong continuity makes fifty times as much.
const LEAST_WATER_IN_PORES: f64 = 1e-3;

/// A value of a record, and what it is held to.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordCheck {
    /// What it is, as a row of a table names it.
    pub what: &'static str,
    /// Value.
    pub value: f64,
    /// Largest size that passes; none where a value is told and not judged.
    pub bound: Option<f64>,
}

impl RecordCheck {
    fn of(what: &'static str, value: f64, bound: impl Into<Option<f64>>) -> Self {
        Self { what, value, bound: bound.into() }
    }

    /// Whether it is within its bound; what is no number never is. What is not judged holds.
    pub fn holds(&self) -> bool {
        self.bound.is_none_or(|bound| self.value.abs() <= bound)
    }
}

/// Checks of the start; none where there was none.
pub fn start_checks(record: &Record) -> Vec<RecordCheck> {
    let Some(start) = &record.start else { return Vec::new() };
    let case = &record.case;
    let missing = start.points_expected as f64 - start.points as f64;
    let column = &case.column;
    // Waves start out of balance, points off the lattice take their share of the forces, operators that
    // follow points err in them from the start, and points integrate no spline exactly: of those a layer
    // alone, whose start is an equilibrium of its own operators, is judged.
    let rests = !case.scene.has_waves() && column.loading_time == 0.0 && column.points.is_lattice();
    let is_exact = case.scene.start_is_solved() || !case.method.basis.is_spline();
    let is_judged = rests && is_exact && !deforms(record);
    vec![
        RecordCheck::of(POINTS_MISSING, missing, 0.0),
        RecordCheck::of("volume at the start, relative error", start.volume_error, volume_bound(record)),
        RecordCheck::of(
            "undrained pressure at the start, relative error",
            start.undrained_pressure_error,
            pressure_bound(record),
        ),
        RecordCheck::of(
            "unbalanced force at the start, over the load",
            start.unbalanced_force,
            is_judged.then_some(UNBALANCED),
        ),
    ]
}

/// Checks of the balances at an output.
pub fn balance_checks(record: &Record, balance: &Balance) -> Vec<RecordCheck> {
    let spurious = balance.spurious_velocity.map(|velocity| {
        // Points integrate no spline exactly: what its start leaves unbalanced moves.
        let bound = (!record.case.method.basis.is_spline()).then_some(AT_REST);
        RecordCheck::of("spurious velocity at rest, over the conductivity", velocity, bound)
    });
    let mut checks = vec![
        RecordCheck::of("mass of solids, drift", balance.solid_mass_drift, ROUND_OFF),
        RecordCheck::of(
            "water balance, over what the load presses out",
            balance.water_imbalance,
            water_bound(record),
        ),
        RecordCheck::of("sum of internal forces, relative", balance.internal_force_imbalance, ROUND_OFF),
        RecordCheck::of("settlement off the settlement curve", balance.settlement_curve_gap, CURVE_GAP),
        // Constant recovery leaves both stresses wrong alike: zero is no evidence, and waves are no fault.
        RecordCheck::of("equilibrium (σ' − p + q)/q, rms", balance.equilibrium_residual, None),
    ];
    if let Some(layers) = &balance.layers {
        let is_exact = record.case.material.continuity == Continuity::Conservative;
        let cells = record.case.cells as f64;
        let bound = is_exact.then_some((WATER_IN_PORES / (cells * cells)).max(LEAST_WATER_IN_PORES));
        checks.extend([
            RecordCheck::of("water in the soil over its pores, less one", layers.pore_water, bound),
            RecordCheck::of(
                "water that left, less the settlement over n_0 H",
                layers.water_left_error,
                bound,
            ),
        ]);
        let burst = is_exact.then_some(NO_BURST);
        checks.extend(layers.largest_pressure.map(|largest| {
            RecordCheck::of("burst: largest pressure of the water so far, over the load", largest, burst)
        }));
    }
    checks.extend(spurious);
    checks
}

/// Whether a pressure burst in a run of two layers of points that move, whose continuity holds: between outputs, or at the
/// end of a run that left what its scene can reach.
pub fn has_burst(record: &Record) -> bool {
    let case = &record.case;
    let is_sound = case.material.continuity == Continuity::Conservative;
    if !(is_sound && case.column.points.has_two_layers() && deforms(record)) {
        return false;
    }
    let mut seen = record.balance.iter().filter_map(|balance| balance.layers.as_ref()?.largest_pressure);
    let has_left = matches!(&record.status, Status::Failed(failure)
        if matches!(failure.kind, FailureKind::Unstable | FailureKind::PoresClosed));
    has_left || seen.any(|largest| largest > NO_BURST || largest.is_nan())
}

/// Where volumes follow the deformation, the undrained start has compressed the column by
/// `q/(E_oed + Q)`, a tenth more than that under any law.
fn volume_bound(record: &Record) -> f64 {
    let (case, soil) = (&record.case, &record.case.material);
    let compression = 1.1 * case.column.load / (soil.oedometric_modulus() + soil.coupling_modulus());
    ROUND_OFF + if deforms(record) { compression } else { 0.0 }
}

/// Pressure over the load that round-off leaves: of strains, times the water's stiffness over the
/// skeleton's where a solver has found them.
fn pressure_bound(record: &Record) -> f64 {
    let (case, soil) = (&record.case, &record.case.material);
    let stiffness = soil.coupling_modulus() / soil.oedometric_modulus();
    ROUND_OFF + if case.scene.start_is_solved() { 100.0 * f64::EPSILON * stiffness } else { 0.0 }
}

/// Whether the weights follow the points, or their deformation.
fn deforms(record: &Record) -> bool {
    record.case.method.configuration_or(record.case.scene.configuration()).deforms()
}

/// Share of the water that may be missing, over what the load presses out; none where the equations or
/// the points conserve none.
fn water_bound(record: &Record) -> Option<f64> {
    let case = &record.case;
    let is_jittered = case.column.points.jitter != Arrangement::default().jitter;
    // What a spline's start leaves unbalanced of the weight is no share of a load.
    let is_adrift = case.scene.is_at_rest() && case.method.basis.is_spline();
    if case.material.continuity == Continuity::ConstantPorosityGradient || is_jittered || is_adrift {
        return None;
    }
    if case.scene.presses_out_no_water() && !deforms(record) {
        // Both sides of the balance vanish.
        return Some(ROUND_OFF);
    }
    let discretisation = if deforms(record) { WATER_MOVING } else { WATER_AT_REST };
    // A patch conserves pressures and not their storage: at worst it misplaces all of that.
    let storage = record.groups.storage;
    Some(discretisation + storage / (1.0 + storage))
}

/// Of every check the one nearest to its bound, or the farthest beyond it, in the order of a record's;
/// of those that no run judges the largest.
pub fn worst_of<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<RecordCheck> {
    let mut worst: Vec<RecordCheck> = Vec::new();
    for record in records {
        let at_outputs = record.balance.iter().flat_map(|balance| balance_checks(record, balance));
        for check in start_checks(record).into_iter().chain(at_outputs) {
            match worst.iter_mut().find(|other| other.what == check.what) {
                Some(other) if is_worse(&check, other) => *other = check,
                Some(_) => {}
                None => worst.push(check),
            }
        }
    }
    worst
}

/// Whether a check says more against its run than another of the same kind; what is judged says more
/// than what is not, and what is no number most of all.
fn is_worse(one: &RecordCheck, other: &RecordCheck) -> bool {
    let size = |check: &RecordCheck| match check.bound {
        _ if check.value.is_nan() => (check.bound.is_some(), f64::INFINITY),
        Some(bound) if bound > 0.0 => (true, check.value.abs() / bound),
        Some(_) => (true, if check.holds() { 0.0 } else { f64::INFINITY }),
        None => (false, check.value.abs()),
    };
    size(one) > size(other)
}

/// Sentences on all that is beyond its bound.
pub fn complaints(record: &Record) -> Vec<String> {
    let told = |check: RecordCheck, when: &str| {
        let bound = check.bound.filter(|_| !check.holds())?;
        if check.what == POINTS_MISSING {
            return record.start.map(|start| {
                format!("{} points at the start instead of {}", start.points, start.points_expected)
            });
        }
        Some(format!("{} is {:.2e}{when}, more than {bound:.0e}", check.what, check.value))
    };
    let at_start = start_checks(record).into_iter().filter_map(|check| told(check, ""));
    let at_outputs = record.balance.iter().flat_map(|balance| {
        let when = format!(" at T_v = {}", typed(balance.time_factor));
        balance_checks(record, balance).into_iter().filter_map(move |check| told(check, &when))
    });
    at_start.chain(at_outputs).collect()
}
