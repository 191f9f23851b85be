//! Measures other than field errors: the peak of a pressure, spurious velocities at rest, and balances of double-point
//! MPM.

use crate::case::Case;
use crate::measure::footing::measures_of_footing;
use crate::record::{Balance, MeasureRow};
use oedometer_exact::Reference;
use oedometer_mpm::run::results::snapshot::Snapshot;
use oedometer_mpm::scene::SceneKind;
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
    own: Option<&Reference>,
    balance: &[Balance],
    snapshots: &[Snapshot],
) -> Vec<MeasureRow> {
    let Some(own) = own else { return Vec::new() };
    if case.scene == SceneKind::Footing {
        return measures_of_footing(case, own, snapshots);
    }
    let row = |name: &str, time_factor, found, exact| MeasureRow {
        name: name.to_owned(),
        time_factor,
        reference: own.name().to_owned(),
        found,
        exact,
    };
    let mut measures = Vec::new();
    if let (Some(found), Some((time_factor, height))) = (pressure_peak(case, snapshots), own.pressure_peak())
    {
        measures.push(row("peak_time_factor", None, found.time_factor, time_factor));
        measures.push(row("peak_pressure", None, found.height, height));
    }
    for output in balance {
        let layers = output.layers.as_ref();
        let values = [
            (SPURIOUS_VELOCITY, output.spurious_velocity, 0.0),
            ("pore_water", layers.map(|one| one.pore_water), 0.0),
            ("water_left_error", layers.map(|one| one.water_left_error), 0.0),
            ("largest_pressure", layers.and_then(|one| one.largest_pressure), 1.0),
        ];
        let time = Some(output.time_factor);
        measures.extend(
            values.into_iter().filter_map(|(name, found, exact)| Some(row(name, time, found?, exact))),
        );
    }
    measures
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
