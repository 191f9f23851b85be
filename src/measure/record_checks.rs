//! Start checks and balances of a record, each with its bound; tables mark what fails here.

use crate::record::{Balance, Record};
use oedometer_problem::arrangement::Arrangement;
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_scenes::scene::{Body, Check, LoadKind, Question};
use oedometer_soil::continuity::Continuity;
use oedometer_wording::{rounded, typed};

/// The check whose warning names numbers of points.
const POINTS_MISSING: &str = "points missing at the start";
/// The check of the growth that the eigenvalues of the step promise.
const GROWN_MODE: &str = "growth of a mode until the last output, from the eigenvalues of the step";
/// The check of steps beyond the critical one, shown where it fails.
const TOO_FEW_STEPS: &str = "largest step (the run is too short to show instability), over the predicted \
                             critical one";
/// Share of the critical step beyond which a run is unstable: the prediction is within 2 % of what is observed.
const MOST_OF_THE_LIMIT: f64 = 1.05;
/// Round-off of sums of numbers of similar size.
const ROUND_OFF: f64 = 1e-9;
/// Unbalanced force over the load that a direct solver may leave.
const UNBALANCED: f64 = 1e-6;
/// Added to [`UNBALANCED`] for each spacing that points are off their lattice, because a node then receives from them
/// what its neighbour lacks.
const SHIFTED: f64 = 2.0;
/// Residual of the equilibrium of points that do not move, on the coarsest meshes: a larger one means a pressure or a
/// stress that is wrong by the load.
const OUT_OF_BALANCE: f64 = 1.0;
/// Bound on the residual of the equilibrium where points move. In 400 random runs at 15 to 50 % strain the pressures beyond it
/// were 3 % of the load off, or more; of linear shape functions, whose stresses jump as points cross cells, the settlement was 10 % off.
const OUT_OF_BALANCE_MOVING: f64 = 0.1;
/// Wave time over consolidation time up to which a column is in balance except for its first waves.
const LITTLE_INERTIA: f64 = 1e-3;
/// Why the points of a moving plane and of two point sets are not judged.
const MOVING: &str =
    "stresses jump at points that cross cells; the forces during the run are checked instead";
/// Why splines are not judged.
const SPLINES: &str = "points do not integrate splines exactly, and the error does not scale with a load";
/// Gap between outputs and settlement curve that a smooth curve explains.
const CURVE_GAP: f64 = 2e-3;
/// Velocity over the hydraulic conductivity that round-off causes in a column at rest; about 1e-12 is observed.
const AT_REST: f64 = 1e-9;
/// Water imbalance over what the load expels, on a lattice at rest: ten times that of the methods on
/// ten cells (3e-6 for a patch at `T_v = 0.05`, 3e-5 within the first steps of an explicit run).
const WATER_AT_REST: f64 = 3e-4;
/// [`WATER_AT_REST`] where points move or deform: twice the worst of the methods at half the height lost,
/// where operators and the storage of cells follow the points.
const WATER_MOVING: f64 = 5e-2;

/// Water in the soil over its pores, less one, where both are counted separately, times the square of the number of
/// cells: twice the error of the cut at the surface (0.2 on ten cells with two points).
const WATER_IN_PORES: f64 = 0.5;
/// Pressure over the load that consolidation cannot reach: it starts at most at the load, and the first front overshoots
/// by a quarter on coarse meshes. A pressure above this is a burst: the forces of the water and of the skeleton end in
/// domains that are cut differently.
const NO_BURST: f64 = 1.5;
/// Bounds of the pressure over the load in a column or slab: without waves the load, a fifth more between plates, and the
/// overshoot of a front on a mesh; with waves, which double the load where they are thrown back, as much again.
const MOST_PRESSURE: [f64; 2] = [1.6, 3.0];
/// Bound of the pressure over the undrained strength under a plate: the mean stress of Prandtl's mechanism (1920) is at most
/// 1 + π there, pressures that oscillate on four cells reach 11, and those of a method that locks go into the hundreds.
const MOST_PRESSURE_UNDER_A_PLATE: f64 = 20.0;
/// Factor by which a mode may grow until the last output: null modes of FLIP double under stable steps, and a short wave that
/// is a hundredth of what moves becomes 2 % of it.
const MOST_GROWTH: f64 = 2.0;
/// Poisson's ratio above which the skeleton of a layer keeps its volume too.
const LOCKING: f64 = 0.495;
/// Least bound by [`WATER_IN_PORES`], on meshes so fine that other errors dominate; a wrong continuity causes fifty times
/// as much.
const LEAST_WATER_IN_PORES: f64 = 1e-3;

/// A value of a record, and its bound.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordCheck {
    /// Its name in a row of a table.
    pub what: &'static str,
    /// Value.
    pub value: f64,
    /// Largest size that passes; `None` where a value is shown and not judged.
    pub bound: Option<f64>,
    /// Why it is not judged, where that is so.
    pub unjudged: &'static str,
}

impl RecordCheck {
    fn of(what: &'static str, value: f64, bound: impl Into<Option<f64>>) -> Self {
        Self { what, value, bound: bound.into(), unjudged: "" }
    }

    /// A check with its bound, or the reason why it has no bound.
    fn judged(what: &'static str, value: f64, bound: Result<f64, &'static str>) -> Self {
        Self { what, value, bound: bound.ok(), unjudged: bound.err().unwrap_or_default() }
    }

    /// Whether it is within its bound; NaN never is. A check that is not judged holds.
    pub fn holds(&self) -> bool {
        self.bound.is_none_or(|bound| self.value.abs() <= bound)
    }
}

/// Checks of the start; empty where the start was not reached.
pub fn start_checks(record: &Record) -> Vec<RecordCheck> {
    let Some(start) = &record.start else { return Vec::new() };
    let missing = start.points_expected as f64 - start.points as f64;
    let mut checks = vec![
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
    ];
    let over = record.groups.step_over_limit;
    let settings = &record.case.settings;
    let is_predicted = record.case.is_explicit() && !settings.affine && !settings.stress_slopes;
    if is_predicted && over > MOST_OF_THE_LIMIT {
        checks.push(RecordCheck::of(TOO_FEW_STEPS, over, 1.0));
    }
    // Where nothing grows there is nothing to show.
    let growth = record.step_sizes.growth;
    checks.extend(growth.map(|growth| RecordCheck::of(GROWN_MODE, growth, MOST_GROWTH)));
    checks
}

/// Checks of the balances at an output.
pub fn balance_checks(record: &Record, balance: &Balance) -> Vec<RecordCheck> {
    let spurious = balance.spurious_velocity.map(|velocity| {
        // Points do not integrate splines exactly: the unbalanced rest of the start moves.
        let bound = if record.case.is_spline() { Err(SPLINES) } else { Ok(AT_REST) };
        RecordCheck::judged("spurious velocity at rest, over the conductivity", velocity, bound)
    });
    let mut checks = vec![
        RecordCheck::of("mass of solids, drift", balance.solid_mass_drift, ROUND_OFF),
        RecordCheck::judged(
            "water-mass error / expelled water",
            balance.water_imbalance,
            water_bound(record),
        ),
        RecordCheck::of("sum of internal forces, relative", balance.internal_force_imbalance, ROUND_OFF),
        RecordCheck::of("final settlement against settlement curve", balance.settlement_curve_gap, CURVE_GAP),
        // With constant recovery both stresses have the same error: a zero difference proves nothing.
        RecordCheck::judged(
            "equilibrium (σ' − p + q)/q, rms",
            balance.equilibrium_residual,
            equilibrium_bound(record),
        ),
    ];
    if let Some(snapshot) = record.snapshot(balance.time_factor) {
        let largest = snapshot.points.pressures().0.iter().fold(0.0, |most: f64, pressure| {
            if most > pressure.abs() || most.is_nan() { most } else { pressure.abs() }
        });
        let over_load = largest / record.case.column.pressure_scale();
        checks.push(RecordCheck::judged("largest pressure, over the load", over_load, most_pressure(record)));
    }
    if let Some(layers) = &balance.layers {
        let is_exact = record.case.material.continuity == Continuity::Conservative;
        let cells = record.case.cells as f64;
        let bound = is_exact.then_some((WATER_IN_PORES / (cells * cells)).max(LEAST_WATER_IN_PORES));
        checks.extend([
            RecordCheck::of("water in the soil over its pores, minus one", layers.pore_water, bound),
            RecordCheck::of(
                "water that left, minus the settlement over n_0 H",
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

/// Where volumes follow the deformation, the undrained start has compressed the column by
/// `q/(E_oed + Q)`, a tenth more than that under any law.
fn volume_bound(record: &Record) -> f64 {
    let (case, soil) = (&record.case, &record.case.material);
    let compression =
        1.1 * case.column.pressure_scale() / (soil.oedometric_modulus() + soil.coupling_modulus());
    ROUND_OFF + if deforms(record) { compression } else { 0.0 }
}

/// Error of the pressure over the load by round-off: that of strains, times the stiffness of the water over that of the
/// skeleton where a solver has found them.
fn pressure_bound(record: &Record) -> f64 {
    let (case, soil) = (&record.case, &record.case.material);
    let stiffness = soil.coupling_modulus() / soil.oedometric_modulus();
    // A cell that an interface cuts has one pressure, and its soils start from several: a patch prolongs the difference.
    let shares =
        case.soils().into_iter().map(|(_, soil)| soil.oedometric_modulus() / soil.coupling_modulus());
    let (least, most) =
        shares.fold((f64::INFINITY, 0.0_f64), |(least, most), share| (least.min(share), most.max(share)));
    let of_interfaces = (2.0 * (most - least)).max(0.0);
    let of_solver = if case.scene.start_is_solved() { 100.0 * f64::EPSILON * stiffness } else { 0.0 };
    ROUND_OFF + of_interfaces + of_solver
}

/// Whether the shape functions follow the points or their deformation.
fn deforms(record: &Record) -> bool {
    record.case.configuration().deforms()
}

/// Unbalanced force that a start may have, over the force of the load on a cell.
fn unbalanced_bound(record: &Record) -> Result<f64, &'static str> {
    let (case, soil) = (&record.case, &record.case.material);
    if let Some(why) = case.scene.unjudged(Check::Unbalanced) {
        return Err(why);
    }
    let is_spline = case.is_spline() && !case.scene.start_is_solved();
    if is_spline && case.scene.question == Question::Rest {
        return Err(SPLINES);
    }
    if case.scene.waves || case.column.loading_time > 0.0 || is_spline {
        // At most the load itself is unbalanced.
        return Ok(1.0 + ROUND_OFF);
    }
    // Points that have moved by the undrained strain lie off their lattice by as much: in the plane by a shear strain, which
    // the water does not hinder.
    let water = if case.scene.body == Body::Column { soil.coupling_modulus() } else { 0.0 };
    let strain = case.column.pressure_scale() / (soil.oedometric_modulus() + water);
    let moved = if deforms(record) { strain * (case.cells * case.points_per_cell) as f64 } else { 0.0 };
    Ok(UNBALANCED + SHIFTED * (shift(record) + moved))
}

/// Residual of the equilibrium that a sound run stays within.
fn equilibrium_bound(record: &Record) -> Result<f64, &'static str> {
    let case = &record.case;
    if let Some(why) = case.scene.unjudged(Check::Equilibrium) {
        return Err(why);
    }
    if case.scene.waves && case.formulation != Formulation::QuasiStatic {
        return Err("waves are not errors; the energy during the run is checked instead");
    }
    if case.is_spline() {
        return Err(SPLINES);
    }
    if deforms(record) {
        let unjudged = if case.scene.body != Body::Column || case.column.points.has_two_sets() {
            Some(MOVING)
        } else if record.groups.inertia > LITTLE_INERTIA {
            Some("inertia carries part of the load")
        } else {
            None
        };
        return unjudged.map_or(Ok(OUT_OF_BALANCE_MOVING + SHIFTED * shift(record)), Err);
    }
    if case.scene.body != Body::Column && case.integrator == IntegratorKind::Implicit {
        // The residual of the nodes, which the solver balances.
        return Ok(UNBALANCED);
    }
    Ok(OUT_OF_BALANCE + SHIFTED * shift(record))
}

/// Pressure over the load that consolidation and waves can reach on a mesh, or why there is no bound.
fn most_pressure(record: &Record) -> Result<f64, &'static str> {
    let case = &record.case;
    if let Some(why) = case.scene.unjudged(Check::Pressure) {
        return Err(why);
    }
    let is_full = case.method.built_in().is_some_and(|method| !method.pressure.is_by_cells());
    let is_pushed = case.scene.load == LoadKind::Pushed;
    let is_stiff = case.scene.locks && !is_pushed && case.material.poissons_ratio > LOCKING;
    if is_stiff || is_full && case.scene.locks {
        return Err("methods lock under a load at constant volume");
    }
    if is_pushed {
        return Ok(MOST_PRESSURE_UNDER_A_PLATE);
    }
    let has_waves = case.scene.waves || record.groups.inertia > LITTLE_INERTIA;
    Ok(MOST_PRESSURE[usize::from(has_waves)])
}

/// Largest shift of a point off its lattice, in spacings.
fn shift(record: &Record) -> f64 {
    let points = &record.case.column.points;
    points.offset.abs() + points.jitter.abs()
}

/// Share of the water that may be missing, over what the load expels; or why the equations or the points do not
/// conserve water.
fn water_bound(record: &Record) -> Result<f64, &'static str> {
    let case = &record.case;
    if let Some(why) = case.scene.unjudged(Check::Water) {
        return Err(why);
    }
    if case.material.continuity == Continuity::ConstantPorosityGradient {
        return Err("this form of the continuity does not conserve water");
    }
    if case.column.points.jitter != Arrangement::default().jitter {
        return Err("domains of scattered points overlap: their volumes do not add up to those of the cells");
    }
    if case.scene.question == Question::Rest && case.is_spline() {
        return Err(SPLINES);
    }
    if case.scene.load == LoadKind::Cosine && !deforms(record) {
        // Both sides of the balance vanish.
        return Ok(ROUND_OFF);
    }
    let discretisation = if deforms(record) { WATER_MOVING } else { WATER_AT_REST };
    // A patch conserves pressures and not their storage: at worst all of the storage is missing.
    let storage = record.groups.storage;
    Ok(discretisation + storage / (1.0 + storage))
}

/// The result of every check nearest to its bound, or farthest beyond it, in the order of a record's checks; the largest
/// of those that are not judged.
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

/// Whether a check is worse than another of the same kind; a judged one is worse than one that is not judged, and NaN is
/// worst.
fn is_worse(check: &RecordCheck, other: &RecordCheck) -> bool {
    let size = |check: &RecordCheck| match check.bound {
        _ if check.value.is_nan() => (check.bound.is_some(), f64::INFINITY),
        Some(bound) if bound > 0.0 => (true, check.value.abs() / bound),
        Some(_) => (true, if check.holds() { 0.0 } else { f64::INFINITY }),
        None => (false, check.value.abs()),
    };
    size(check) > size(other)
}

/// Sentences on everything beyond its bound.
pub fn complaints(record: &Record) -> Vec<String> {
    let complaint = |check: RecordCheck, when: &str| {
        let bound = check.bound.filter(|_| !check.holds())?;
        if check.what == POINTS_MISSING {
            return record.start.map(|start| {
                format!("{} points at the start instead of {}", start.points, start.points_expected)
            });
        }
        if check.what == GROWN_MODE {
            return Some(format!(
                "a mode grows by a factor of {} until the last output, from the eigenvalues of the step, \
                 more than {bound}: an earlier last output or another pressure recovery keeps it small",
                rounded(check.value)
            ));
        }
        Some(format!("{} is {:.2e}{when}, more than {bound:.1e}", check.what, check.value))
    };
    let at_start = start_checks(record).into_iter().filter_map(|check| complaint(check, ""));
    let at_outputs = record.balance.iter().flat_map(|balance| {
        let when = format!(" at T_v = {}", typed(balance.time_factor));
        balance_checks(record, balance).into_iter().filter_map(move |check| complaint(check, &when))
    });
    at_start.chain(at_outputs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use oedometer_problem::method::Method;

    #[test]
    fn a_pressure_may_reach_what_fronts_or_waves_make_of_the_load_and_is_not_judged_where_methods_lock() {
        use oedometer_scenes::{
            AT_REST, COSINE_LAYER, DYNAMIC_COLUMN, FOOTING, MANDEL, MANUFACTURED_BOX, TERZAGHI, XIE_LEO,
        };
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                    integrator = ['implicit']\ncells = [2]\n";
        let mut record = records_of(text).remove(0);
        let locks = Err("methods lock under a load at constant volume");
        let (little, more, usual) = (LITTLE_INERTIA, 1.001 * LITTLE_INERTIA, 0.25);
        for (scene, method, inertia, ratio, bound) in [
            (&TERZAGHI, "GIMP", 0.0, usual, Ok(1.6)),
            (&TERZAGHI, "GIMP", little, 0.499, Ok(1.6)),
            (&TERZAGHI, "GIMP", more, usual, Ok(3.0)),
            (&XIE_LEO, "GIMP", 1.0, usual, Ok(3.0)),
            (&MANDEL, "GIMP", little, usual, Ok(1.6)),
            (&DYNAMIC_COLUMN, "GIMP", 0.0, usual, Ok(3.0)),
            (&DYNAMIC_COLUMN, "GIMP", more, usual, Ok(3.0)),
            (&COSINE_LAYER, "GIMP-SRI", little, LOCKING, Ok(1.6)),
            (&COSINE_LAYER, "GIMP-SRI", more, LOCKING, Ok(3.0)),
            (&COSINE_LAYER, "GIMP-SRI", little, 0.496, locks),
            (&COSINE_LAYER, "GIMP", little, usual, locks),
            (&FOOTING, "GIMP-SRI", more, 0.499, Ok(20.0)),
            (&FOOTING, "GIMP", little, usual, locks),
            (&AT_REST, "GIMP", more, usual, Err("the pressures are those of self-weight")),
            (&MANUFACTURED_BOX, "GIMP-SRI", more, usual, Err("body forces cause the pressure")),
        ] {
            record.case.scene = scene;
            record.case.method = Method::named(method).expect("a method").into();
            (record.groups.inertia, record.case.material.poissons_ratio) = (inertia, ratio);
            assert_eq!(most_pressure(&record), bound, "{scene:?} {method} {inertia} {ratio}");
        }
    }

    #[test]
    fn the_water_that_may_be_missing_is_that_of_the_discretisation_and_the_storage() {
        let of = |scene: &str, more: &str| {
            let text = format!(
                "title = 't'\nscene = '{scene}'\n{more}\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                 integrator = ['implicit']\ncells = [4]\n"
            );
            let mut record = records_of(&text).remove(0);
            record.groups.storage = 0.25;
            water_bound(&record)
        };
        let is =
            |found: Result<f64, &str>, bound: f64| found.is_ok_and(|found| (found - bound).abs() < 1e-15);
        // A fifth is all of a storage of a quarter.
        assert!(is(of("terzaghi", ""), 3e-4 + 0.2), "{:?}", of("terzaghi", ""));
        assert!(is(of("xie-leo", ""), 5e-2 + 0.2), "{:?}", of("xie-leo", ""));
        assert!(is(of("cosine-layer", ""), 1e-9), "{:?}", of("cosine-layer", ""));
        let jittered = of("terzaghi", "points.jitter = 0.1");
        assert!(jittered.is_err_and(|why| why.contains("scattered points overlap")));
    }

    #[test]
    fn the_worst_check_is_the_one_nearest_to_its_bound() {
        let check = |value: f64, bound: Option<f64>| RecordCheck::of("a number", value, bound);
        // From best to worst; each is worse than all before it, and none is worse than itself.
        let order = [
            check(0.0, None),
            check(-9.0, None),
            check(f64::NAN, None),
            check(0.0, Some(0.0)),
            check(-1.0, Some(10.0)),
            check(0.5, Some(1.0)),
            check(-3.0, Some(1.0)),
            check(f64::NAN, Some(1.0)),
        ];
        for (place, one) in order.iter().enumerate() {
            for (other_place, other) in order.iter().enumerate() {
                assert_eq!(is_worse(one, other), place > other_place, "{one:?} {other:?}");
            }
        }
        assert!(is_worse(&check(1.0, Some(0.0)), &order[6]), "beyond a bound of nothing");
        let holds =
            [check(-1.0, Some(1.0)), check(-1.1, Some(1.0)), check(f64::NAN, Some(1.0)), check(9.0, None)];
        assert_eq!(holds.map(|one| one.holds()), [true, false, false, true]);
    }
}
