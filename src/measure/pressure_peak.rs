//! The peak of the pressure at an impermeable end over time: of Mandel and of Cryer, where it rises before it falls.

use crate::case::Case;
use crate::record::MeasureRow;
use oedometer_exact::reference::Reference;
use oedometer_mpm::run::results::snapshot::Snapshot;
use oedometer_soil::elementary;

/// Name of the measure of its time factor.
pub const PEAK_TIME_FACTOR: &str = "peak_time_factor";
/// Name of the measure of its height over the load.
pub const PEAK_PRESSURE: &str = "peak_pressure";

/// When and how high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressurePeak {
    /// Time factor.
    pub time_factor: f64,
    /// Excess pressure over the load.
    pub height: f64,
}

/// The peak at the base of a column, or in the middle of a slab: the parabola in `ln T_v` through the highest of the
/// outputs and its neighbours. None where the highest is the first or the last, or the start.
pub fn pressure_peak(case: &Case, snapshots: &[Snapshot]) -> Option<PressurePeak> {
    let outputs = case.time_factors.iter().zip(snapshots);
    let rows: Vec<(f64, f64)> = outputs
        .filter(|(time_factor, _)| **time_factor > 0.0)
        .map(|(time_factor, snapshot)| {
            let centres = &snapshot.centres;
            let end = pressure_at_the_end(&centres.initial_height, &centres.pressure);
            (elementary::ln(*time_factor), end / case.column.load)
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
    // What is no number is no peak.
    (bend < 0.0).then(|| PressurePeak {
        time_factor: elementary::exp(time + shift),
        height: height + 0.5 * slope * shift,
    })
}

/// Time and height of the peak against those of a reference that has one; nothing where either has none.
pub fn peak_measures(case: &Case, reference: &Reference, snapshots: &[Snapshot]) -> Vec<MeasureRow> {
    let (Some(found), Some((time_factor, height))) =
        (pressure_peak(case, snapshots), reference.pressure_peak())
    else {
        return Vec::new();
    };
    [(PEAK_TIME_FACTOR, found.time_factor, time_factor), (PEAK_PRESSURE, found.height, height)]
        .map(|(name, found, exact)| MeasureRow {
            name: name.to_owned(),
            time_factor: None,
            reference: reference.name().to_owned(),
            found,
            exact,
        })
        .into()
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
