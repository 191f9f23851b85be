//! Conservation checks of a run: the state at its start, masses, forces, and its settlement curve.

use crate::case::Case;
use crate::measure::statistics::largest;
use crate::record::{Balance, HistoryRow, LayerBalance, StartChecks};
use oedometer_exact::{ExactError, Reference};
use oedometer_problem::snapshot::Snapshot;
use oedometer_scenes::column::column_parameters;
use oedometer_scenes::scene::{Body, Question};
use oedometer_soil::elementary;

/// The start against what the scene expects of it.
///
/// # Errors
/// When the scene's own reference refuses a depth.
pub fn start_checks(
    case: &Case,
    reference: Option<&Reference>,
    start: &Snapshot,
) -> Result<StartChecks, ExactError> {
    let soil = &case.material;
    let load = case.column.pressure_scale();
    let samples = &start.points;
    let places_and_pressures =
        samples.water.as_ref().map_or((&*samples.initial_height, &*samples.pressure), |water| {
            (&*water.initial_height, &*water.pressure)
        });
    let expected =
        case.scene.expected_start_pressures(&case.column, soil, reference, places_and_pressures)?;
    let off = places_and_pressures
        .1
        .iter()
        .zip(&expected)
        .map(|(pressure, expected)| (pressure - expected).abs() / load);
    Ok(StartChecks {
        points: samples.pressure.len() + samples.water.as_ref().map_or(0, |water| water.pressure.len()),
        points_expected: case.expected_points(),
        volume_error: start.totals.volume / case.column.volume(case.cells) - 1.0,
        undrained_pressure_error: largest(off).unwrap_or(0.0),
        // Of the load on a cell's width, in the plane.
        unbalanced_force: start.totals.unbalanced_force
            / if case.column.dimensions == 1 { load } else { load * case.cell_size() },
    })
}

/// Masses and forces at an output against those of the start.
pub fn balance(case: &Case, time_factor: f64, start: &Snapshot, now: &Snapshot) -> Balance {
    let load = case.column.pressure_scale();
    let loading_time = case.column.loading_time;
    let grown = if now.time < loading_time { now.time / loading_time } else { 1.0 };
    let applied = if case.scene.is_loaded() { grown * load } else { 0.0 };
    let parameters = column_parameters(&case.column, &case.material);
    let stresses = now.points.effective_stress.iter().zip(&now.points.pressure);
    let squares: f64 = stresses
        .zip(&now.points.initial_height)
        .map(|((stress, pressure), height)| {
            let of_weight = parameters.initial_stress(1.0 - height / parameters.height);
            elementary::powi((stress - pressure + applied - of_weight) / load, 2)
        })
        .sum();
    // What the load expels in the end: of what leaves up to now nothing may be left, as at the start
    // or under a cosine.
    let pressed_out = load / case.material.oedometric_modulus() * case.column.height;
    let surface = case.column.volume(case.cells) / case.column.height;
    let excess = now.totals.surface_flux - now.totals.water_expansion / surface;
    Balance {
        time_factor,
        solid_mass_drift: now.totals.solid_mass / start.totals.solid_mass - 1.0,
        water_imbalance: excess / pressed_out,
        internal_force_imbalance: now.totals.internal_force_imbalance,
        // Above one dimension the vertical stress alone is in no balance with the load: the nodes are.
        equilibrium_residual: if case.scene.body == Body::Column {
            (squares / now.points.pressure.len() as f64).sqrt()
        } else {
            now.totals.unbalanced_force / (load * case.cell_size())
        },
        settlement_curve_gap: 0.0,
        layers: now.totals.double_point.map(|layers| {
            let pressed_out = now.settlement / (case.material.porosity * case.column.height);
            LayerBalance {
                pore_water: layers.water_volume / layers.pore_volume - 1.0,
                water_left: layers.water_left,
                water_left_error: layers.water_left - pressed_out,
                water_points: layers.water_points,
                largest_pressure: Some(layers.largest_pressure / load),
            }
        }),
        spurious_velocity: (case.scene.question == Question::Rest)
            .then(|| now.totals.largest_velocity / case.material.hydraulic_conductivity),
    }
}

/// How far the settlement at an output lies from the settlement curve, beyond what interpolation
/// explains: the curve is taken cubic in `ln T_v` through its four nearest rows, and allowed its
/// distance from the straight line.
pub fn curve_gap(curve: &[HistoryRow], time_factor: f64, degree: f64) -> f64 {
    // The start has no logarithm.
    let curve = &curve[curve.partition_point(|row| row.time_factor <= 0.0)..];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_problem::snapshot::{Samples, Totals, WaterSamples, WaterTotals};
    use oedometer_scenes::{AT_REST, COSINE_LAYER, TERZAGHI};

    /// `U = a √T_v` at seven rows from 0.01 to 0.64.
    fn curve() -> Vec<HistoryRow> {
        let row = |step: i32| {
            let time_factor = 0.01 * 2_f64.powi(step);
            HistoryRow {
                time_factor,
                degree_of_consolidation: time_factor.sqrt(),
                load_factor: None,
                energy: None,
            }
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

    #[test]
    fn an_unbalanced_force_is_a_share_of_the_load_and_in_the_plane_of_that_on_a_cell() {
        for scene in [&TERZAGHI, &COSINE_LAYER] {
            let case = Case { cells: 5, ..Case::seed(Task::Solve, scene) };
            let load = case.column.pressure_scale();
            let on = if scene == &TERZAGHI { load } else { load * case.column.height / 5.0 };
            let parameters = column_parameters(&case.column, &case.material);
            let own = Reference::new(case.scene.references[0].kind, &parameters, &[]).expect("a seed");
            let mut start = Snapshot::default();
            start.totals.unbalanced_force = 0.3 * on;
            let found = start_checks(&case, Some(&own), &start).expect("a seed").unbalanced_force;
            assert!((found - 0.3).abs() < 1e-12, "{scene:?}: {found}");
        }
    }

    #[test]
    fn balances_are_those_of_now_against_the_start_by_hand() {
        let samples = Samples {
            initial_height: vec![0.25, 0.75],
            pressure: vec![30.0, 10.0],
            effective_stress: vec![-14.0, -27.0],
            ..Samples::default()
        };
        let totals = |solid_mass: f64, surface_flux: f64, water_expansion: f64| Totals {
            solid_mass,
            surface_flux,
            water_expansion,
            internal_force_imbalance: 0.125,
            unbalanced_force: 6.0,
            largest_velocity: 5e-4,
            double_point: Some(WaterTotals {
                pore_volume: 0.4,
                water_volume: 0.5,
                water_left: 0.2,
                water_points: 7,
                largest_pressure: 50.0,
            }),
            ..Totals::default()
        };
        let start = Snapshot { totals: totals(4.0, 9.0, 9.0), ..Snapshot::default() };
        let now = Snapshot {
            settlement: 0.06,
            points: samples,
            totals: totals(5.0, 3e-5, 2e-5),
            ..Snapshot::default()
        };
        for (scene, height, width) in [(&TERZAGHI, 2.0, 1.0), (&COSINE_LAYER, 2.0, 3.0)] {
            let mut case = Case { cells: 4, ..Case::seed(Task::Solve, scene) };
            (case.column.height, case.column.load) = (height, 40.0);
            *case.column = case.column.with_extent(3.0);
            let found = balance(&case, 0.3, &start, &now);
            let near = |found: f64, wanted: f64| {
                assert!((found - wanted).abs() < 1e-12, "{scene:?}: {found} for {wanted}");
            };
            assert_eq!((found.time_factor, found.internal_force_imbalance), (0.3, 0.125));
            near(found.solid_mass_drift, 0.25);
            // The load of 40 Pa presses 40/1.2e6 of 2 m out.
            near(found.water_imbalance, (3e-5 - 2e-5 / width) / (40.0 / 1.2e6 * 2.0));
            // Of the stresses −4 and 3 Pa are left; of the nodes 6 N on 40 Pa and half a metre.
            let left = if width == 1.0 { (12.5_f64).sqrt() / 40.0 } else { 6.0 / (40.0 * 0.5) };
            near(found.equilibrium_residual, left);
            let layers = found.layers.expect("two point sets");
            near(layers.pore_water, 0.25);
            near(layers.water_left, 0.2);
            near(layers.water_left_error, 0.2 - 0.06 / (0.3 * 2.0));
            assert_eq!((layers.water_points, layers.largest_pressure), (7, Some(1.25)));
            assert_eq!((found.spurious_velocity, found.settlement_curve_gap), (None, 0.0));
        }
        // At rest nothing is applied and what moves counts, over the conductivity of 1e-4 m/s.
        let rest = Case { cells: 4, ..Case::seed(Task::Solve, &AT_REST) };
        assert!((balance(&rest, 0.3, &start, &now).spurious_velocity.expect("at rest") - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_start_is_held_against_the_points_the_volume_and_the_pressures_of_its_scene() {
        let mut case = Case { cells: 4, ..Case::seed(Task::Solve, &TERZAGHI) };
        (case.column.height, case.column.load) = (2.0, 40.0);
        case.column.points.water_per_cell = 3;
        let undrained = 40.0 / (1.0 + 0.3 * 1.2e6 / 2.2e9);
        let mut start = Snapshot::default();
        start.totals.volume = 2.5;
        start.points.pressure = vec![undrained, undrained - 10.0, undrained + 5.0];
        let found = |start: &Snapshot| start_checks(&case, None, start).expect("the seed column");
        assert_eq!((found(&start).points, found(&start).points_expected), (3, 8 + 12));
        assert!((found(&start).volume_error - 0.25).abs() < 1e-12);
        assert!((found(&start).undrained_pressure_error - 0.25).abs() < 1e-9);
        // The water's own points are counted too, and theirs are the pressures.
        let pressure = vec![undrained + 2.0; 5];
        start.points.water = Some(WaterSamples { pressure, ..WaterSamples::default() });
        assert_eq!(found(&start).points, 8);
        assert!((found(&start).undrained_pressure_error - 0.05).abs() < 1e-9);
    }
}
