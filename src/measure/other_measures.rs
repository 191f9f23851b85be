//! Measures of a run besides errors of fields: the peak of a pressure, spurious velocities at rest, balances of two
//! point sets, and of a footing its load against that of collapse and how the pressure under it jumps.

use crate::case::{Case, Norm, Quantity, Sample};
use crate::record::{Balance, ErrorRow, MeasureRow};
use oedometer_exact::Reference;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_problem::snapshot::{Samples, Snapshot};
use oedometer_soil::elementary;

/// Name of the largest nodal velocity over the hydraulic conductivity, of a column at rest.
pub const SPURIOUS_VELOCITY: &str = "spurious_velocity";

/// The measures of a run, with the exact values of the scene's own reference; at every output, or of the whole run.
///
/// Of double-point runs: water in the soil over its pores, less one; the share of the water that left less the settlement over
/// `n_0 H`; and the largest pressure of any water point since the start over the load, which exceeds one only by an
/// error where all of the load acts at once.
pub fn measures_of(
    case: &Case,
    reference: Option<&Reference>,
    balance: &[Balance],
    snapshots: &[Snapshot],
) -> Vec<MeasureRow> {
    let Some(reference) = reference else { return Vec::new() };
    if case.scene.measures(Quantity::LoadFactor) {
        return measures_of_footing(case, reference, snapshots);
    }
    let mut measures = Vec::new();
    if let (Some(found), Some((time_factor, height))) =
        (pressure_peak(case, snapshots), reference.pressure_peak())
    {
        measures.push(row(reference, "peak_time_factor", None, found.time_factor, time_factor));
        measures.push(row(reference, "peak_pressure", None, found.height, height));
    }
    for output in balance {
        let layers = output.layers.as_ref();
        let values = [
            (SPURIOUS_VELOCITY, output.spurious_velocity, 0.0),
            ("pore_water", layers.map(|measured| measured.pore_water), 0.0),
            ("water_left_error", layers.map(|measured| measured.water_left_error), 0.0),
            ("largest_pressure", layers.and_then(|measured| measured.largest_pressure), 1.0),
        ];
        let time = Some(output.time_factor);
        measures.extend(
            values
                .into_iter()
                .filter_map(|(name, found, exact)| Some(row(reference, name, time, found?, exact))),
        );
    }
    measures
}

/// A measure against the exact value of a reference.
fn row(reference: &Reference, name: &str, time_factor: Option<f64>, found: f64, exact: f64) -> MeasureRow {
    MeasureRow { name: name.to_owned(), time_factor, reference: reference.name().to_owned(), found, exact }
}

/// Time and height of the highest pressure at an impermeable end, as of Mandel and of Cryer, where it rises before it
/// falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressurePeak {
    /// Time factor.
    pub time_factor: f64,
    /// Excess pressure over the load.
    pub height: f64,
}

/// The peak at the base of a column, or in the middle of a slab: the parabola in `ln T_v` through the highest of the
/// outputs and its neighbours. `None` where the highest is the first or the last output.
pub fn pressure_peak(case: &Case, snapshots: &[Snapshot]) -> Option<PressurePeak> {
    let outputs = case.time_factors.iter().zip(snapshots);
    let rows: Vec<(f64, f64)> = outputs
        .filter(|(time_factor, _)| **time_factor > 0.0)
        .map(|(time_factor, snapshot)| {
            let centres = &snapshot.centres;
            let end = pressure_at_the_end(&centres.initial_height, &centres.pressure);
            (elementary::ln(*time_factor), end / case.column.pressure_scale())
        })
        .collect();
    let highest = (0..rows.len()).max_by(|a, b| rows[*a].1.total_cmp(&rows[*b].1))?;
    let (before, after) = (rows.get(highest.checked_sub(1)?)?, rows.get(highest + 1)?);
    let (time, height) = rows[highest];
    // Newton's form about the highest: slopes to both sides, and how they change.
    let slopes = [(height - before.1) / (time - before.0), (after.1 - height) / (after.0 - time)];
    let bend = (slopes[1] - slopes[0]) / (after.0 - before.0);
    let slope = slopes[0] + bend * (time - before.0);
    let shift = -0.5 * slope / bend;
    // Written so that NaN is not a peak.
    (bend < 0.0).then(|| PressurePeak {
        time_factor: elementary::exp(time + shift),
        height: height + 0.5 * slope * shift,
    })
}

/// Pressure at the height 0 from the means of the lowest two rows of cells: nothing flows there, so that the
/// pressure is even in the height, `p_1 − (p_2 − p_1)/8`.
pub fn pressure_at_the_end(heights: &[f64], pressures: &[f64]) -> f64 {
    let row_above = |floor: f64| {
        let lowest = heights.iter().copied().filter(|height| *height > floor).fold(f64::INFINITY, f64::min);
        let reach = 1e-6 * lowest;
        let in_row = heights.iter().zip(pressures).filter(|(height, _)| (**height - lowest).abs() <= reach);
        let (count, sum) =
            in_row.fold((0.0, 0.0), |(count, sum), (_, pressure)| (count + 1.0, sum + pressure));
        (lowest + reach, sum / count)
    };
    let (first_height, first) = row_above(f64::NEG_INFINITY);
    let (_, second) = row_above(first_height);
    first - (second - first) / 8.0
}

/// Load factor `F/(B c_u)` of the force, N/m, on half of a plate; none in other scenes.
pub fn load_factor(case: &Case, force: f64) -> Option<f64> {
    let half = 0.5 * case.column.footing.width * case.material.undrained_strength;
    (case.scene.measures(Quantity::LoadFactor)).then(|| force / half)
}

/// The error of the load factor of a state.
pub fn load_error(
    case: &Case,
    reference: &Reference,
    time_factor: f64,
    snapshot: &Snapshot,
) -> Option<ErrorRow> {
    let found = load_factor(case, snapshot.plate_force?)?;
    Some(ErrorRow {
        time_factor,
        quantity: Quantity::LoadFactor,
        sample: Sample::Surface,
        norm: Norm::Relative,
        reference: reference.name().to_owned(),
        value: found / LOAD_FACTOR - 1.0,
        absolute: found - LOAD_FACTOR,
    })
}

/// The load factor at every output; between the last two how it grows with the settlement over the width, which is nothing
/// where nothing locks; and the oscillation of the pressure at the last one.
fn measures_of_footing(case: &Case, reference: &Reference, snapshots: &[Snapshot]) -> Vec<MeasureRow> {
    let outputs = case.time_factors.iter().zip(snapshots);
    let loads: Vec<(f64, f64)> = outputs
        .filter_map(|(time, snapshot)| Some((*time, load_factor(case, snapshot.plate_force?)?)))
        .collect();
    let name = Quantity::LoadFactor.name();
    let mut measures: Vec<MeasureRow> =
        loads.iter().map(|(time, load)| row(reference, name, Some(*time), *load, LOAD_FACTOR)).collect();
    if let [.., (before, lower), (after, upper)] = loads[..] {
        measures.push(row(reference, "plateau_slope", None, (upper - lower) / (after - before), 0.0));
    }
    if let Some(last) = snapshots.last() {
        let across = case.column.cells_across(case.cells).unwrap_or(1) * case.points_per_cell;
        let of_strength = oscillation(&last.points, across) / case.material.undrained_strength;
        measures.push(row(reference, "pressure_oscillation", None, of_strength, 0.0));
    }
    measures
}

/// Mean over all points of the second difference of the pressure to the neighbours along a row, Pa: nothing where it goes
/// straight, and four times the amplitude of a pressure that alternates from point to point.
fn oscillation(points: &Samples, across: usize) -> f64 {
    let bend = |three: &[f64]| (three[0] - 2.0 * three[1] + three[2]).abs();
    let bends: Vec<f64> = points.pressure.chunks(across).flat_map(|row| row.windows(3).map(bend)).collect();
    bends.iter().sum::<f64>() / bends.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_exact::reference::ReferenceKind;
    use oedometer_scenes::FOOTING;
    use oedometer_scenes::column::column_parameters;

    #[test]
    fn a_pressure_that_alternates_oscillates_by_four_amplitudes_and_a_slope_by_nothing() {
        let of = |pressure: Vec<f64>| oscillation(&Samples { pressure, ..Samples::default() }, 4);
        assert_eq!(of(vec![1.0, 2.0, 3.0, 4.0, 7.0, 5.0, 3.0, 1.0]), 0.0);
        assert_eq!(of(vec![0.5, -0.5, 0.5, -0.5, -0.5, 0.5, -0.5, 0.5]), 2.0);
    }

    #[test]
    fn the_slope_of_a_plateau_is_that_of_the_last_two_loads_in_time() {
        let mut case = Case::seed(Task::Solve, &FOOTING);
        case.time_factors = vec![0.5, 1.0, 1.25].into();
        let half = 0.5 * case.column.footing.width * case.material.undrained_strength;
        let snapshots =
            [3.0, 4.0, 4.5].map(|load| Snapshot { plate_force: Some(load * half), ..Snapshot::default() });
        let parameters = column_parameters(&case.column, &case.material);
        let own = Reference::new(ReferenceKind::Footing, &parameters, &[]).expect("the seed footing");
        let measures = measures_of_footing(&case, &own, &snapshots);
        let of = |name: &str| -> Vec<(Option<f64>, f64)> {
            measures.iter().filter(|row| row.name == name).map(|row| (row.time_factor, row.found)).collect()
        };
        let near = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12, "{measures:?}");
        near(of("plateau_slope")[0].1, 2.0);
        for ((time, found), (wanted, load)) in
            of(Quantity::LoadFactor.name()).into_iter().zip([(0.5, 3.0), (1.0, 4.0), (1.25, 4.5)])
        {
            assert_eq!(time, Some(wanted));
            near(found, load);
        }
    }
}
