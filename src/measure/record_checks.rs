//! Start checks and balances of a record, each with the bound that it is held to: what shows a mark
//! in a table is judged here, and nowhere else.

use crate::record::{Balance, Record, Status};
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_mpm::run::results::outcome::FailureKind;
use oedometer_mpm::scene::arrangement::Arrangement;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::wording::typed;

/// The check that is told in numbers of points.
const POINTS_MISSING: &str = "points missing at the start";
/// What sums of numbers of like size leave.
const ROUND_OFF: f64 = 1e-9;
/// Force over the load that a direct solver may leave of an equilibrium.
const UNBALANCED: f64 = 1e-6;
/// The same, a spacing that points are off their lattice: each gives a node what its neighbour there does not.
const SHIFTED: f64 = 2.0;
/// Residual of the equilibrium of points that stay where they are, on the coarsest meshes: one beyond it is of a pressure or
/// a stress that is wrong by the load.
const OUT_OF_BALANCE: f64 = 1.0;
/// Why splines are let go.
const SPLINES: &str = "points integrate no spline exactly, and what that leaves is no share of a load";
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
    /// Why it is not judged, where it is not.
    pub unjudged: &'static str,
}

impl RecordCheck {
    fn of(what: &'static str, value: f64, bound: impl Into<Option<f64>>) -> Self {
        Self { what, value, bound: bound.into(), unjudged: "" }
    }

    /// A check with its bound, or the reason why there is none.
    fn judged(what: &'static str, value: f64, bound: Result<f64, &'static str>) -> Self {
        Self { what, value, bound: bound.ok(), unjudged: bound.err().unwrap_or_default() }
    }

    /// Whether it is within its bound; what is no number never is. What is not judged holds.
    pub fn holds(&self) -> bool {
        self.bound.is_none_or(|bound| self.value.abs() <= bound)
    }
}

/// Checks of the start; none where there was none.
pub fn start_checks(record: &Record) -> Vec<RecordCheck> {
    let Some(start) = &record.start else { return Vec::new() };
    let missing = start.points_expected as f64 - start.points as f64;
    vec![
        RecordCheck::of(POINTS_MISSING, missing, 0.0),
        RecordCheck::of("volume at the start, relative error", start.volume_error, volume_bound(record)),
        RecordCheck::of(
            "undrained pressure at the start, relative error",
            start.undrained_pressure_error,
            pressure_bound(record),
        ),
        RecordCheck::judged(
            "unbalanced force at the start, over the load",
            start.unbalanced_force,
            unbalanced_bound(record),
        ),
    ]
}

/// Checks of the balances at an output.
pub fn balance_checks(record: &Record, balance: &Balance) -> Vec<RecordCheck> {
    let spurious = balance.spurious_velocity.map(|velocity| {
        // Points integrate no spline exactly: what its start leaves unbalanced moves.
        let bound = if record.case.is_spline() { Err(SPLINES) } else { Ok(AT_REST) };
        RecordCheck::judged("spurious velocity at rest, over the conductivity", velocity, bound)
    });
    let mut checks = vec![
        RecordCheck::of("mass of solids, drift", balance.solid_mass_drift, ROUND_OFF),
        RecordCheck::judged(
            "water balance, over what the load presses out",
            balance.water_imbalance,
            water_bound(record),
        ),
        RecordCheck::of("sum of internal forces, relative", balance.internal_force_imbalance, ROUND_OFF),
        RecordCheck::of("settlement off the settlement curve", balance.settlement_curve_gap, CURVE_GAP),
        // Constant recovery leaves both stresses wrong alike: zero is no evidence.
        RecordCheck::judged(
            "equilibrium (σ' − p + q)/q, rms",
            balance.equilibrium_residual,
            equilibrium_bound(record),
        ),
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
    if !(is_sound && case.column.points.has_two_sets() && deforms(record)) {
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
    let compression =
        1.1 * case.column.pressure_scale() / (soil.oedometric_modulus() + soil.coupling_modulus());
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
    record.case.configuration().deforms()
}

/// Force over that of the load on a cell that a start may leave unbalanced.
fn unbalanced_bound(record: &Record) -> Result<f64, &'static str> {
    let (case, soil) = (&record.case, &record.case.material);
    if case.scene.is_manufactured() {
        return Err("the body forces that make the motion begin at once");
    }
    let is_spline = case.is_spline() && !case.scene.start_is_solved();
    if is_spline && case.scene.is_at_rest() {
        return Err(SPLINES);
    }
    if case.scene.has_waves() || case.column.loading_time > 0.0 || is_spline {
        // What sets out is no more than the load itself.
        return Ok(1.0 + ROUND_OFF);
    }
    // Points that have moved by the undrained strain lie off their lattice by as much: in the plane by a shear strain, which
    // the water does not hinder.
    let water = if case.scene.needs_two_dimensions() { 0.0 } else { soil.coupling_modulus() };
    let strain = case.column.pressure_scale() / (soil.oedometric_modulus() + water);
    let moved = if deforms(record) { strain * (case.cells * case.points_per_cell) as f64 } else { 0.0 };
    Ok(UNBALANCED + SHIFTED * (shift(record) + moved))
}

/// Residual of the equilibrium that a sound run stays within.
fn equilibrium_bound(record: &Record) -> Result<f64, &'static str> {
    let case = &record.case;
    if case.scene.is_manufactured() {
        return Err("a motion that is made by body forces is in no balance with a load");
    }
    if case.scene.has_waves() || case.column.loading_time > 0.0 {
        return Err("waves are no fault; the energy of the run is watched");
    }
    if deforms(record) {
        return Err("stresses of points that cross cells jump; the forces of the run are watched");
    }
    if case.is_spline() {
        return Err(SPLINES);
    }
    if case.scene.needs_two_dimensions() && case.integrator == IntegratorKind::Implicit {
        // Of the nodes, which the solver balances.
        return Ok(UNBALANCED);
    }
    Ok(OUT_OF_BALANCE + SHIFTED * shift(record))
}

/// Largest shift of a point off its lattice, in spacings.
fn shift(record: &Record) -> f64 {
    let points = &record.case.column.points;
    points.offset.abs() + points.jitter.abs()
}

/// Share of the water that may be missing, over what the load presses out; or why the equations or the points conserve
/// none.
fn water_bound(record: &Record) -> Result<f64, &'static str> {
    let case = &record.case;
    if case.material.continuity == Continuity::ConstantPorosityGradient {
        return Err("this form of the continuity conserves no water");
    }
    if case.column.points.jitter != Arrangement::default().jitter {
        return Err("domains of scattered points overlap: their volumes are not those of the cells");
    }
    if case.scene.is_at_rest() && case.is_spline() {
        return Err(SPLINES);
    }
    if case.scene.presses_out_no_water() && !deforms(record) {
        // Both sides of the balance vanish.
        return Ok(ROUND_OFF);
    }
    let discretisation = if deforms(record) { WATER_MOVING } else { WATER_AT_REST };
    // A patch conserves pressures and not their storage: at worst it misplaces all of that.
    let storage = record.groups.storage;
    Ok(discretisation + storage / (1.0 + storage))
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
