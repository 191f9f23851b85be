//! Patterns of samples: places at which nothing was written, and pressures that alternate from sample to sample.

use super::NOTABLE;
use super::given::{Column, Given};
use super::readings::Reading;
use crate::score::coverage::lines;
use oedometer_soil::elementary::powi;
use oedometer_soil::wording::short;

/// Most samples in a row that have one sign of an alternating pressure: those of a cell.
const LONGEST: usize = 4;
/// Fewest lines of samples that show an alternation.
const FEWEST: usize = 6;
/// Share of the error that an alternation must be.
const ALTERNATES: f64 = 0.5;

/// Places inside at which nothing was written: mid-side nodes of elements that have the pressure at their corners.
pub fn zeros(column: &Column, exact: &[f64], are_picked: bool) -> Option<Reading> {
    let is_inside = |place: usize| exact[place].abs() > NOTABLE * column.scale;
    let is_zero = |place: usize| column.computed[place] == 0.0 && is_inside(place);
    let inside = (0..exact.len()).filter(|place| is_inside(*place)).count();
    let zeros = (0..exact.len()).filter(|place| is_zero(*place)).count();
    if zeros < 2 || 4 * zeros > 3 * inside {
        return None;
    }
    let left = column.misfit(exact, |place, value| if is_zero(place) { exact[place] } else { value });
    let looked = if are_picked { " looked at" } else { "" };
    let begin = format!(
        "is exactly 0 at {zeros} of {inside} samples{looked} where it should not be, and right at the others"
    );
    let asked = vec!["are they mid-side nodes without a value?".to_owned()];
    Some(Reading { begin, asked, count: 1, is_fitted: false, left })
}

/// Values that are too large and too small in turn, from line to line of samples or from cell to cell.
pub fn checkerboard(column: &Column, exact: &[f64], given: &Given<'_>) -> Option<Reading> {
    if !column.field.is_stress() || given.are_picked {
        return None;
    }
    let up = rank(&column.heights, given.parameters.height);
    let along = rank(&column.distances, given.parameters.length);
    let most = up.iter().copied().max()? + 1;
    if most < FEWEST {
        return None;
    }
    let before = column.misfit_as_given(exact);
    let is_wide = along.iter().any(|number| *number > 0);
    let mut found: Option<Reading> = None;
    for (row, both) in (1..=LONGEST).flat_map(|row| [(row, false), (row, is_wide)]) {
        let sign = |place: usize| {
            let across = if both { along[place] / row } else { 0 };
            if (up[place] / row + across).is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        for of_field in [true, false] {
            // An alternation has a share of the pressure, or of the load.
            let size = |place: usize| if of_field { exact[place] } else { column.scale };
            let amplitudes =
                amplitudes(column, exact, given.states.len(), &|place| sign(place) * size(place));
            let left = column.misfit(exact, |place, value| {
                value - amplitudes[column.states[place]] * sign(place) * size(place)
            });
            let is_better = found.as_ref().is_none_or(|best| left < best.left);
            if left > ALTERNATES * before || !is_better {
                continue;
            }
            let largest = amplitudes.iter().copied().map(f64::abs).fold(0.0, f64::max);
            let of = if of_field { "of the exact one" } else { "of the load" };
            let begin = format!(
                "alternates from sample to sample by ± {} % {of} around the exact one, a checkerboard",
                short(rounded_percent(largest))
            );
            let asked = vec![
                "does its interpolation fit that of the displacement (inf-sup), or does it need a stabilisation?".to_owned(),
            ];
            found = Some(Reading { begin, asked, count: 1, is_fitted: false, left });
        }
    }
    found
}

/// Numbers of the lines of places on which values stand, counted from 0.
fn rank(places: &[f64], extent: f64) -> Vec<usize> {
    let lines = lines(places, extent);
    let near = 1e-6 * extent;
    places.iter().map(|place| lines.partition_point(|line| *line < place - near)).collect()
}

/// Of each state the amplitude of a pattern in the difference between computed and exact values.
fn amplitudes(column: &Column, exact: &[f64], states: usize, pattern: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let mut sums = vec![[0.0, 0.0]; states];
    for (place, computed) in column.computed.iter().enumerate() {
        let pattern = pattern(place) / column.scale;
        let [both, own] = &mut sums[column.states[place]];
        *both += column.weights[place] * pattern * (computed - exact[place]) / column.scale;
        *own += column.weights[place] * powi(pattern, 2);
    }
    sums.into_iter().map(|[both, own]| if own > 0.0 { both / own } else { 0.0 }).collect()
}

/// A share in percent, to two digits.
fn rounded_percent(share: f64) -> f64 {
    format!("{:.1e}", 100.0 * share).parse().unwrap_or(100.0 * share)
}
