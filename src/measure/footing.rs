//! Measures of a footing: its load over the collapse load, the slope of its plateau, and jumps of the pressure below
//! it.

use crate::case::{Case, Norm, Quantity, Sample};
use crate::record::{ErrorRow, MeasureRow};
use oedometer_exact::Reference;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_mpm::run::results::snapshot::{Samples, Snapshot};
use oedometer_mpm::scene::SceneKind;

/// Load factor `F/(B c_u)` of the force, N/m, on half of a plate; none in other scenes.
pub fn load_factor(case: &Case, force: f64) -> Option<f64> {
    let half = 0.5 * case.column.footing.width * case.material.undrained_strength;
    (case.scene == SceneKind::Footing).then(|| force / half)
}

/// The error of the load factor of a state.
pub fn load_error(case: &Case, own: &Reference, time_factor: f64, snapshot: &Snapshot) -> Option<ErrorRow> {
    let found = load_factor(case, snapshot.plate_force?)?;
    Some(ErrorRow {
        time_factor,
        quantity: Quantity::LoadFactor,
        sample: Sample::Surface,
        norm: Norm::Relative,
        reference: own.name().to_owned(),
        value: found / LOAD_FACTOR - 1.0,
        absolute: found - LOAD_FACTOR,
    })
}

/// The load factor at every output; between the last two how it grows with the settlement over the width, which is nothing
/// where nothing locks; and the oscillation of the pressure at the last one.
pub fn measures_of_footing(case: &Case, own: &Reference, snapshots: &[Snapshot]) -> Vec<MeasureRow> {
    let row = |name: &str, time_factor, found, exact| MeasureRow {
        name: name.to_owned(),
        time_factor,
        reference: own.name().to_owned(),
        found,
        exact,
    };
    let outputs = case.time_factors.iter().zip(snapshots);
    let loads: Vec<(f64, f64)> = outputs
        .filter_map(|(time, snapshot)| Some((*time, load_factor(case, snapshot.plate_force?)?)))
        .collect();
    let name = Quantity::LoadFactor.name();
    let mut measures: Vec<MeasureRow> =
        loads.iter().map(|(time, load)| row(name, Some(*time), *load, LOAD_FACTOR)).collect();
    if let [.., (before, lower), (after, upper)] = loads[..] {
        measures.push(row("plateau_slope", None, (upper - lower) / (after - before), 0.0));
    }
    if let Some(last) = snapshots.last() {
        let across = case.column.cells_across(case.cells).unwrap_or(1) * case.points_per_cell;
        let of_strength = oscillation(&last.points, across) / case.material.undrained_strength;
        measures.push(row("pressure_oscillation", None, of_strength, 0.0));
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

    #[test]
    fn a_pressure_that_alternates_oscillates_by_four_amplitudes_and_a_slope_by_nothing() {
        let of = |pressure: Vec<f64>| oscillation(&Samples { pressure, ..Samples::default() }, 4);
        assert_eq!(of(vec![1.0, 2.0, 3.0, 4.0, 7.0, 5.0, 3.0, 1.0]), 0.0);
        assert_eq!(of(vec![0.5, -0.5, 0.5, -0.5, -0.5, 0.5, -0.5, 0.5]), 2.0);
    }
}
