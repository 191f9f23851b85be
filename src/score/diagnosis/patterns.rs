//! Patterns of samples: one number in place of values, pressures that alternate, values in another order.

use super::columns::{Column, Field, Given};
use super::readings::{Held, Reading};
use super::search::{FLOOR, Limit};
use crate::score::coverage::lines;
use oedometer_soil::elementary::powi;
use oedometer_soil::wording::short;

/// Most samples in a row that have one sign of an alternating pressure: those of a cell.
const LONGEST: usize = 4;
/// Fewest lines of samples that show an alternation.
const FEWEST: usize = 6;
/// Share of the error of every output that an alternation may leave.
const ALTERNATES: f64 = 0.5;
/// Values below this share of a column's size are as good as zero.
const NOTABLE: f64 = 0.01;
/// Share of its size by which a value is wrong.
const WRONG: f64 = 3e-3;
/// Share of the error that another order may leave.
const ORDERED: f64 = 0.2;

/// The patterns of a column in the scene's own world; another order where nothing else explains it.
pub fn of(field: Field, given: &Given<'_>, limit: &Limit, is_open: bool) -> Vec<Reading> {
    let Some(column) = given.columns.iter().find(|column| column.field == field) else { return Vec::new() };
    let exact = column.exact(&given.own);
    let order = || order(column, &exact, limit).filter(|_| is_open && !given.are_picked);
    let all = [blank(column, &exact, given, limit), checkerboard(column, &exact, given), order()];
    all.into_iter().flatten().collect()
}

fn reading(begin: String, asked: &str, [count, fitted]: [usize; 2], left: f64, column: &Column) -> Reading {
    let asked = vec![asked.to_owned()];
    Reading {
        key: format!("{begin} {}", column.name),
        begin,
        asked,
        count,
        fitted,
        signs: 0,
        factor: None,
        left,
    }
}

/// One number at places where nothing was written: an output, a place, every second row.
fn blank(column: &Column, exact: &[f64], given: &Given<'_>, limit: &Limit) -> Option<Reading> {
    let size = column.size(exact);
    let is_seen = |place: usize| exact[place].abs() > NOTABLE * size;
    let is_wrong =
        |place: &usize| (column.values[*place] - exact[*place]).abs() > WRONG * size && is_seen(*place);
    let wrong: Vec<usize> = (0..exact.len()).filter(is_wrong).collect();
    // The number that stands most often where values are wrong.
    let mut values: Vec<f64> = wrong.iter().map(|place| column.values[*place]).collect();
    values.sort_unstable_by(f64::total_cmp);
    let blank = *values.chunk_by(|a, b| a == b).max_by_key(|same| same.len())?.first()?;
    let is_blank = |place: usize| column.values[place] == blank && is_seen(place);
    let places: Vec<usize> = (0..exact.len()).filter(|place| is_blank(*place)).collect();
    let inside = (0..exact.len()).filter(|place| is_seen(*place)).count();
    if places.len() < 2 || 4 * (inside - places.len()) < inside {
        return None;
    }
    let held: Vec<f64> = (0..exact.len()).map(|at| if is_blank(at) { blank } else { exact[at] }).collect();
    let left = limit.accepts(column, &Held { values: held, varying: exact.to_vec() }, 1.0, false)?;
    let (place, asked) = place_of(column, given, &is_seen, &is_blank);
    let asked = match asked {
        "" if blank == 0.0 => "does a probe lie outside, or is a value missing there?",
        "" => "is it a fill value?",
        asked => asked,
    };
    let looked = if given.are_picked { " looked at" } else { "" };
    let begin = format!(
        "is exactly {} at {} of {inside} samples{looked}{place} where it should not be, and right at the others",
        short(blank),
        places.len()
    );
    Some(reading(begin, asked, [1, 0], left, column))
}

/// Where blanks are, and the question if that tells it.
fn place_of(
    column: &Column,
    given: &Given<'_>,
    is_seen: &dyn Fn(usize) -> bool,
    is_blank: &dyn Fn(usize) -> bool,
) -> (String, &'static str) {
    let seen = || (0..column.values.len()).filter(|place| is_seen(*place));
    let rows = rank(&column.heights, given.parameters.height);
    // The groups of which all values are blank, if these are all blanks.
    let whole = |group: &dyn Fn(usize) -> usize| {
        let mut blank: Vec<usize> = seen().filter(|place| is_blank(*place)).map(group).collect();
        blank.sort_unstable();
        blank.dedup();
        let are_whole = seen().all(|place| is_blank(place) == blank.contains(&group(place)));
        are_whole.then_some(blank)
    };
    if let Some(outputs) = whole(&|place| column.outputs[place]) {
        let times: Vec<String> = outputs.iter().map(|output| short(given.times[*output])).collect();
        return (format!(", all of t = {} s,", times.join(", ")), "was this output not written?");
    }
    match whole(&|place| rows[place]) {
        Some(blank) if blank.len() <= 2 => {
            let lines = lines(&column.heights, given.parameters.height);
            let heights: Vec<String> = blank.iter().map(|row| short(lines[*row])).collect();
            (format!(", all of y = {} m,", heights.join(", ")), "")
        }
        Some(blank) if blank.windows(2).all(|pair| pair[1] - pair[0] == 2) => {
            (", every second row,".to_owned(), "are they mid-side nodes without a value?")
        }
        _ => (String::new(), if given.are_picked { "are they mid-side nodes without a value?" } else { "" }),
    }
}

/// Values that are too large and too small in turn, from line to line of samples or from cell to cell.
fn checkerboard(column: &Column, exact: &[f64], given: &Given<'_>) -> Option<Reading> {
    if !column.field.is_stress() || given.are_picked {
        return None;
    }
    let up = rank(&column.heights, given.parameters.height);
    let along = rank(&column.distances, given.parameters.length);
    if up.iter().copied().max()? + 1 < FEWEST {
        return None;
    }
    let is_wide = along.iter().any(|number| *number > 0);
    let outputs = column.own_outputs();
    let mut best_pattern: Option<Reading> = None;
    for (row, both) in (1..=LONGEST).flat_map(|row| [(row, false), (row, is_wide)]) {
        let sign = |place: usize| {
            let across = if both { along[place] / row } else { 0 };
            if (up[place] / row + across).is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        for of_field in [true, false] {
            // An alternation has a share of the pressure, or of the load.
            let pattern: Vec<f64> = (0..exact.len())
                .map(|at| sign(at) * if of_field { exact[at] } else { column.scale })
                .collect();
            let amplitudes = amplitudes(column, exact, &pattern, given.times.len());
            let held: Vec<f64> =
                (0..exact.len()).map(|at| exact[at] + amplitudes[column.outputs[at]] * pattern[at]).collect();
            let is_halved = |output: &usize| {
                let [before, after] =
                    [exact, &held].map(|held| column.misfit_of(*output, held, exact, 1.0, true));
                after <= ALTERNATES * before
            };
            let left = column.misfit(&held, exact, 1.0, false);
            if !outputs.iter().all(is_halved) || best_pattern.as_ref().is_some_and(|best| best.left <= left) {
                continue;
            }
            let largest = amplitudes.iter().copied().map(f64::abs).fold(0.0, f64::max);
            let of = if of_field { "of the exact one" } else { "of the load" };
            let percent: f64 = format!("{:.1e}", 100.0 * largest).parse().unwrap_or(100.0 * largest);
            let begin = format!(
                "alternates from sample to sample by ± {} % {of} around the exact one, a checkerboard",
                short(percent)
            );
            let asked = "does its interpolation fit that of the displacement (inf-sup), or does it need a stabilisation?";
            best_pattern = Some(reading(begin, asked, [1, 1], left, column));
        }
    }
    best_pattern
}

/// Numbers of the lines of places on which values stand, counted from 0.
fn rank(places: &[f64], extent: f64) -> Vec<usize> {
    let lines = lines(places, extent);
    let near = 1e-6 * extent;
    places.iter().map(|place| lines.partition_point(|line| *line < place - near)).collect()
}

/// Of each output the amplitude of a pattern in the difference between values and exact ones.
fn amplitudes(column: &Column, exact: &[f64], pattern: &[f64], outputs: usize) -> Vec<f64> {
    let mut sums = vec![[0.0, 0.0]; outputs];
    for (place, off) in column.beyond(exact, 1.0).iter().enumerate() {
        let [both, own] = &mut sums[column.outputs[place]];
        *both += pattern[place] / column.scale * (off / column.scale);
        *own += powi(pattern[place] / column.scale, 2);
    }
    sums.into_iter().map(|[both, own]| if own > 0.0 { both / own } else { 0.0 }).collect()
}

/// Outputs that have the right values in another order.
fn order(column: &Column, exact: &[f64], limit: &Limit) -> Option<Reading> {
    let mut orders: Vec<Vec<usize>> = Vec::new();
    let mut held = vec![0.0; exact.len()];
    for output in column.own_outputs() {
        let here: Vec<usize> = (0..exact.len()).filter(|place| column.outputs[*place] == output).collect();
        let sorted = |values: &[f64]| {
            let mut places: Vec<usize> = (0..here.len()).collect();
            places.sort_by(|a, b| values[here[*a]].total_cmp(&values[here[*b]]));
            places
        };
        let (own, right) = (sorted(&column.values), sorted(exact));
        for (own, right) in own.iter().zip(right) {
            held[here[*own]] = exact[here[right]];
        }
        orders.push(own);
        if here.len() < FEWEST - 2 {
            return None;
        }
    }
    let left = limit.accepts(column, &Held { values: held, varying: exact.to_vec() }, 1.0, false)?;
    let is_better = left <= (ORDERED * column.residual).max(FLOOR);
    let which = if orders.windows(2).all(|pair| pair[0] == pair[1]) { "the same" } else { "another one" };
    let begin = format!("has the right values in another order, {which} at every output");
    let asked = "are they numbered differently (a permutation)?";
    is_better.then(|| reading(begin, asked, [2, 0], left, column))
}
