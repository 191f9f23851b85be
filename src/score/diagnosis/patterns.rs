//! Patterns of samples, and what a column holds or where its residual is when nothing explains it.

use super::columns::{Column, FEW, Given, Held, about_mean};
use super::hypotheses::{END, START};
use super::readings::Reading;
use super::search::FLOOR;
use super::{NO_MISTAKE, digits, listed, shown};
use crate::import::nodes::levels;
use oedometer_wording::rounded;

/// Most samples in a row that have one sign of an alternating pressure: those of a cell.
const LONGEST: usize = 4;
/// Fewest parts of one sign that show an alternation: fewer are any smooth error.
const FEWEST_PARTS: usize = 6;
/// Share of the error of every output that an alternation may leave.
const ALTERNATES: f64 = 0.5;
/// Values below this share of a column's size are as good as zero, and the share by which one is wrong.
const NOTABLE: f64 = 0.01;
const WRONG: f64 = 3e-3;
/// Size, SI, below which the decimals that programs print by default show little of a field.
const FEW_DECIMALS: f64 = 1e-4;
/// Share of the error that another order may leave.
const ORDERED: f64 = 0.2;
/// Share of an error that sits in one place.
const IN_ONE_PLACE: f64 = 0.9;
/// Correlation below which a column does not vary as the exact one.
const UNLIKE: f64 = 0.5;
const STABILISATION: &str =
    "does its interpolation fit that of the displacement (inf-sup), or does it need a stabilisation";
const MID_SIDE: &str = "are they mid-side nodes without a value, or is a value missing there";
const OUTSIDE: &str = "does a probe lie outside, or is a value missing there";

/// The patterns of a column in the scene's own world.
pub fn of(column: &Column, given: &Given<'_>) -> Vec<Reading> {
    [blank(column, given), checkerboard(column, given), order(column)].into_iter().flatten().collect()
}

fn reading(said: String, asked: &str, [count, fitted]: [usize; 2], left: f64, column: &Column) -> Reading {
    let key = format!("{said} {}", column.name);
    Reading { said, asked: vec![asked.to_owned()], count, fitted, key, left, or: Vec::new() }
}

/// One number at places where nothing was written: an output, a place, here and there.
fn blank(column: &Column, given: &Given<'_>) -> Option<Reading> {
    let (values, exact, height) = (&column.values, &column.exact, given.own.parameters.height);
    let size = column.size(exact, None);
    let seen: Vec<usize> = (0..exact.len()).filter(|at| exact[*at].abs() > NOTABLE * size).collect();
    // The number that stands most often where values are wrong.
    let is_wrong = |at: &&usize| (values[**at] - exact[**at]).abs() > WRONG * size;
    let mut wrong: Vec<f64> = seen.iter().filter(is_wrong).map(|at| values[*at]).collect();
    wrong.sort_unstable_by(f64::total_cmp);
    let blank = *wrong.chunk_by(|a, b| a == b).max_by_key(|same| same.len())?.first()?;
    let blanks: Vec<usize> = seen.iter().copied().filter(|at| values[*at] == blank).collect();
    let filled = values.iter().zip(exact).map(|(value, exact)| if *value == blank { blank } else { *exact });
    let held = Held { values: filled.collect(), ..column.itself(exact) };
    let are_some = blanks.len() > 1 && 4 * (seen.len() - blanks.len()) >= seen.len();
    let left = column.accepts(&held, 1.0).filter(|_| are_some)?;
    // The groups of which all values are blank, if these are all blanks.
    let whole = |groups: &[usize]| {
        let mut all: Vec<usize> = blanks.iter().map(|at| groups[*at]).collect();
        all.sort_unstable();
        all.dedup();
        seen.iter().all(|at| (values[*at] == blank) == all.contains(&groups[*at])).then_some(all)
    };
    let all_of = |name: &str, groups: Vec<usize>, list: &[f64], unit: &str| {
        format!(", all of {name} = {} {unit},", listed(groups.into_iter().map(|group| list[group])))
    };
    let missing = if blank == 0.0 { OUTSIDE } else { "is it a fill value" };
    let (place, asked) = match (whole(&column.outputs), whole(&rank(&column.heights, height))) {
        (Some(outputs), _) => (all_of("t", outputs, &given.times, "s"), "was this output not written"),
        (_, Some(rows)) if rows.len() < 3 => {
            (all_of("y", rows, &levels(&column.heights, height), "m"), missing)
        }
        _ => (String::new(), if blank == 0.0 { MID_SIDE } else { missing }),
    };
    let [value, blanks, seen] = [rounded(blank), blanks.len().to_string(), seen.len().to_string()];
    let said = format!(
        "is exactly {value} at {blanks} of {seen} samples looked at{place} where it should not be, and right at the others"
    );
    Some(reading(said, asked, [1, 0], left, column))
}

/// Values that are too large and too small in turn, from line to line of samples or from cell to cell, by a share of the exact
/// values.
fn checkerboard(column: &Column, given: &Given<'_>) -> Option<Reading> {
    let up = rank(&column.heights, given.own.parameters.height);
    let along = rank(&column.distances, given.own.parameters.length);
    let lines = up.iter().max()? + 1;
    if !column.field.is_stress() {
        return None;
    }
    let exact = &column.exact;
    let off = column.beyond(exact, 1.0);
    let of = |(row, is_across): (usize, bool)| {
        let part = |at: usize| {
            let across = if is_across { along.get(at).map_or(0, |number| number / row) } else { 0 };
            if (up[at] / row + across).is_multiple_of(2) { exact[at] } else { -exact[at] }
        };
        let pattern: Vec<f64> = (0..exact.len()).map(part).collect();
        let (mut rest, mut largest, mut is_halved) = (off.clone(), 0.0_f64, true);
        for output in column.own_outputs() {
            let share = column.factor(&off, &pattern, Some(output));
            let here = (0..exact.len()).filter(|at| share.is_finite() && column.outputs[*at] == output);
            here.for_each(|at| rest[at] -= share * pattern[at]);
            largest = largest.max(share.abs());
            is_halved &= column.size(&rest, Some(output)) <= ALTERNATES * column.size(&off, Some(output));
        }
        let (percent, left) = (shown(100.0 * largest), column.size(&rest, None) / column.size(exact, None));
        let said =
            format!("alternates from sample to sample by ± {percent} % around the exact one, a checkerboard");
        is_halved.then(|| reading(said, STABILISATION, [1, 1], left, column))
    };
    let all =
        (1..=LONGEST).filter(|row| lines >= FEWEST_PARTS * row).flat_map(|row| [(row, false), (row, true)]);
    all.filter_map(of).min_by(|a, b| a.left.total_cmp(&b.left))
}

/// Numbers of the lines of places on which values stand, counted from 0.
fn rank(places: &[f64], extent: f64) -> Vec<usize> {
    let lines = levels(places, extent);
    places.iter().map(|place| lines.partition_point(|line| *line < place - 1e-6 * extent)).collect()
}

/// Outputs that have the right values in another order.
fn order(column: &Column) -> Option<Reading> {
    let exact = &column.exact;
    let mut held = column.itself(exact);
    for output in column.own_outputs() {
        let here: Vec<usize> = (0..exact.len()).filter(|at| column.outputs[*at] == output).collect();
        let sorted = |values: &[f64]| {
            let mut places = here.clone();
            places.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
            places
        };
        for (own, right) in sorted(&column.values).into_iter().zip(sorted(exact)) {
            held.values[own] = exact[right];
        }
    }
    let left = column.accepts(&held, 1.0).filter(|left| *left <= FLOOR.max(ORDERED * column.residual))?;
    let said = "has the right values of every output in another order".to_owned();
    Some(reading(said, "are they numbered differently (a permutation)", [2, 0], left, column))
}

/// What a column is that nothing explains: zeros, a constant, numbers in order; or beside one that is right the same at all
/// outputs, or unlike the exact one.
pub fn unexplained(column: &Column, given: &Given<'_>) -> Option<String> {
    let (first, values, outputs) = (column.values[0], &column.values, column.own_outputs());
    let counts = |output: &usize| {
        let here = column.at_output(*output);
        here.len() > 2 && first.fract() == 0.0 && here.windows(2).all(|pair| (pair[1] - pair[0]).abs() == 1.0)
    };
    let (varying, exact) = (about_mean(values), about_mean(&column.exact));
    let alike =
        column.factor(&varying, &exact, None) * column.size(&exact, None) / column.size(&varying, None);
    let is_unlike = values.len() >= FEW && alike.abs() < UNLIKE && place(column, given).is_none();
    let is_small = column.size(&column.exact, None) < FEW_DECIMALS;
    let array = ["is it the wrong array", "is it the wrong array, or written with too few decimals"]
        [usize::from(is_small)];
    let fault = if column.is_zero() {
        let cause = if column.field.is_stress() { END } else { START };
        let or = format!(", or {}", cause.asked);
        format!("is 0 everywhere: {array}{}", if given.columns.len() == 1 { &or } else { "" })
    } else if values.len() > 1 && values.iter().all(|value| (value / first - 1.0).abs() <= 1e-9) {
        format!("is {} at all places and times: {array}", rounded(first))
    } else if outputs.iter().all(counts) {
        format!("counts from {} by ones: are these node or cell numbers", rounded(first))
    } else if column.is_other_right && (is_unlike || column.stands_still()) {
        format!("does not vary as the exact one: {array}")
    } else {
        return None;
    };
    Some(format!("your {} {fault}?", column.name))
}

/// Where a residual without a cause sits, if it sits in one place.
pub fn place(column: &Column, given: &Given<'_>) -> Option<String> {
    let off = column.beyond(&column.exact, 1.0);
    let height = given.own.parameters.height;
    let rows = levels(&column.heights, height);
    let mut squares = vec![0.0; rows.len()];
    off.iter().zip(rank(&column.heights, height)).for_each(|(off, row)| squares[row] += off * off);
    let most = IN_ONE_PLACE * IN_ONE_PLACE * squares.iter().sum::<f64>();
    let is_seen = off.len() >= FEW && rows.len() > 1;
    let row = rows.iter().zip(squares).find(|(_, square)| is_seen && *square > most)?.0;
    let percent = digits((100.0 * column.residual).round());
    let at = rounded(*row);
    Some(format!(
        "your {} is off by {percent} %, and {NO_MISTAKE}: nearly all of it sits at y = {at} m",
        column.name
    ))
}
