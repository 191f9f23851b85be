//! The search: the explanation, a world with a reading of each column, that leaves least for the fewest mistakes.

use super::columns::{Column, Given, MOST};
use super::hypotheses::{Cause, NAME, ONE_STATE, READINGS, Scale, WORLDS};
use super::readings::{Exact, Reading, of_row};
use super::world::World;
use super::{patterns, shown};
use oedometer_soil::elementary::{exp, ln};

/// Multiple of its residual that a right column may have in another world, and the least that it may have.
const SPOILT: [f64; 2] = [3.0, 3e-4];
/// Errors below it do not tell explanations apart, and what is left below the other is next to nothing.
pub const FLOOR: f64 = 1e-5;
const CLEAR: f64 = 1e-3;
/// Logarithm of how much better an explanation must be for a mistake more, and for a fitted number more.
const PER_MISTAKE: f64 = 1.1;
const PER_FIT: f64 = 1.2;
/// Multiple of the least error up to which another explanation is as good, and of its residual that a column which stays
/// wrong may have in another world.
const AS_WELL: f64 = 1.5;
/// Trials of a number over its range, and halvings of the step around the best.
const TRIALS: usize = 50;
const HALVINGS: usize = 16;
/// Factor by which a mistake of a column must lessen the error in a fit.
const PENALTY: f64 = 3.0;
/// Most names and alternatives that a sentence offers.
const MOST_NAMES: usize = 3;

/// The world of a cause, with the number that fits best, if that is clear.
fn world_of(cause: &Cause, given: &Given<'_>, in_units: bool) -> Option<(World, Reading)> {
    let of = |number: f64| (cause.of)(given, given.own.clone(), number);
    let with = |number: f64, asked: &str, fitted: usize| {
        let [side, late] = if number < 0.0 { ["before", "late"] } else { ["after", "early"] };
        let filled = |text: &str| {
            text.replace("{}", &shown(number.abs())).replace("{side}", side).replace("{late}", late)
        };
        let (said, asked) = (filled(cause.said), vec![filled(asked)]);
        Some((of(number), Reading { said, asked, count: 1, fitted, ..Reading::default() }))
    };
    let Some(range) = cause.range else {
        return with(0.0, cause.asked, 0);
    };
    let range = range(given);
    let is_log = range[0] > 0.0;
    let number = |at: f64| if is_log { exp(at) } else { at };
    let value = |at: f64| left(&of(number(at)), given, in_units);
    let ends = if is_log { range.map(ln) } else { range };
    let (at, least) = minimum(&value, ends);
    let (fitted, bound) = (number(at), least + ln(AS_WELL));
    if [value(ends[0]), value(ends[1]), left(&given.own, given, in_units)].iter().any(|other| *other <= bound)
    {
        return None;
    }
    let mut names = (cause.names)(given);
    names.retain(|(name, _)| {
        (name / fitted - 1.0).abs() <= NAME || ln(name / fitted).abs() < 1.0 && value(ln(*name)) <= bound
    });
    names.sort_by(|a, b| (a.0 - fitted).abs().total_cmp(&(b.0 - fitted).abs()));
    let asked: Vec<&str> = names.iter().take(MOST_NAMES).map(|(_, asked)| &**asked).collect();
    match names.first() {
        Some((name, _)) => with(*name, &asked.join(", or "), 0),
        None => with(fitted, &(cause.asked.to_owned() + &(cause.asked_of)(given, fitted)), 1),
    }
}

/// The time at which one output matches best, s, with the error that is left.
pub fn one_time(given: &Given<'_>) -> Option<(f64, f64)> {
    let (world, _) = world_of(&ONE_STATE, given, false)?;
    Some((world.clock[1], exp(left(&world, given, false))))
}

/// Logarithm of the error that a world leaves, the mean of all columns, each as it is or in its best unit and sign: a column
/// that no world explains does not hide what explains the others.
fn left(world: &World, given: &Given<'_>, in_units: bool) -> f64 {
    let Some(predicted) = world.predict(given, &given.times) else {
        return f64::INFINITY;
    };
    let of_column = |column: &Column| {
        let itself = column.itself(&column.of_itself(&predicted));
        let as_it_is = column.misfit(&itself, 1.0, None).min(1.0);
        let of = |scale: &Scale| {
            let penalty: f64 = scale.asked.iter().map(|_| PENALTY).product();
            penalty * column.misfit(&itself, scale.factor, None)
        };
        let others = column.scales.iter().filter(|scale| in_units && !scale.is_alone);
        ln(others.map(of).fold(as_it_is, f64::min) + FLOOR)
    };
    given.columns.iter().map(of_column).sum::<f64>() / given.columns.len() as f64
}

/// The place of the least value of a function over a range, with that value.
pub fn minimum(value: &dyn Fn(f64) -> f64, [low, high]: [f64; 2]) -> (f64, f64) {
    let better = |best: (f64, f64), at: f64| {
        let here = value(at);
        if here < best.1 { (at, here) } else { best }
    };
    let mut step = (high - low) / TRIALS as f64;
    let mut best = (0..=TRIALS).map(|trial| low + step * trial as f64).fold((low, f64::INFINITY), better);
    for _ in 0..HALVINGS {
        step *= 0.5;
        best = [best.0 - step, best.0 + step].map(|at| at.clamp(low, high)).into_iter().fold(best, better);
    }
    best
}

/// A world with the reading of each column in it; none of one that is not explained.
pub struct Explanation {
    world: World,
    pub of: Reading,
    pub readings: Vec<Option<Reading>>,
    /// All mistakes of the world and of columns, with the largest error that is left of a column that was wrong.
    sum: Reading,
    open: usize,
}

impl Explanation {
    /// The best readings in a world; `None` where it spoils a column that is right, or explains too little.
    fn of((world, of): (World, Reading), given: &Given<'_>, whole: &Given<'_>) -> Option<Self> {
        let is_own = of.count == 0;
        let predicted = world.predict(given, &given.times)?;
        let said = "matches the exact one";
        let as_exact = |left: f64| vec![Reading { said: said.to_owned(), left, ..Reading::default() }];
        let rows = if is_own { READINGS } else { &READINGS[..1] };
        let (mut all, mut plain, mut kept) = (Vec::new(), 0, 0);
        for (column, whole_column) in given.columns.iter().zip(&whole.columns) {
            let x = Exact::new(given, &world, column, &predicted);
            let itself = column.itself(&x.own);
            let residual = column.misfit(&itself, 1.0, None);
            let as_it_is = column.accepts(&itself, 1.0).filter(|_| !is_own);
            if column.is_right() && !is_own && residual > SPOILT[1].max(SPOILT[0] * column.residual) {
                return None;
            }
            all.push(if column.is_right() {
                as_exact(residual)
            } else if let Some(left) = as_it_is {
                plain += 1;
                as_exact(left)
            } else {
                kept += usize::from(column.residual <= MOST && residual <= AS_WELL * column.residual);
                let rows = rows.iter().filter(|_| !column.is_zero());
                let mut readings: Vec<Reading> = rows.flat_map(|row| of_row(&x, row, is_own)).collect();
                if is_own && !column.is_zero() {
                    readings.extend(patterns::of(whole_column, whole));
                }
                readings
            });
        }
        let open = all.iter().filter(|readings| readings.is_empty()).count();
        // Of a world that leaves a column open, others match as they are.
        let is_of_most = plain > 0 && kept == open || plain > 1 && open == 1;
        if !is_own && open > 0 && !is_of_most {
            return None;
        }
        let readings: Vec<Option<Reading>> = all.iter().map(|readings| chosen(readings)).collect();
        let wrong = readings.iter().zip(&given.columns).filter(|(_, column)| !column.is_right());
        let left = wrong.filter_map(|(reading, _)| Some(reading.as_ref()?.left)).reduce(f64::max);
        // What columns share is one mistake.
        let mut once: Vec<&Reading> = readings.iter().flatten().collect();
        once.sort_by_key(|reading| &reading.key);
        once.dedup_by_key(|reading| &reading.key);
        let mut sum = Reading { left: left.unwrap_or(1.0), ..of.clone() };
        for reading in once {
            sum.count += reading.count;
            sum.fitted += reading.fitted;
            sum.asked.extend(reading.asked.iter().filter(|_| is_own).cloned());
        }
        Some(Self { world, of, readings, sum, open })
    }
}

/// What it costs, without what round-off tells apart.
fn cost(reading: &Reading) -> f64 {
    let mistakes = PER_MISTAKE * reading.count as f64 + PER_FIT * reading.fitted as f64;
    (1e6 * (ln(reading.left + FLOOR) + mistakes)).round()
}

/// The questions of others that are as good, with as many mistakes.
fn as_good<'a>(best: &Reading, others: impl Iterator<Item = &'a Reading>) -> Vec<String> {
    let is_tied = |other: &&Reading| {
        (other.count, other.fitted) == (best.count, best.fitted)
            && other.left <= AS_WELL * (best.left + FLOOR)
            && other.asked != best.asked
    };
    let mut asked: Vec<String> = others.filter(is_tied).map(|other| other.asked.join(", and ")).collect();
    asked.dedup();
    asked.truncate(MOST_NAMES - 1);
    asked
}

/// The best explanation of some of the samples; `whole` has all of them, for patterns. Of outputs that are only some of
/// the file the soil and the load are those of the others.
pub fn explanation(given: &Given<'_>, whole: &Given<'_>, is_part: bool) -> Option<Explanation> {
    let mut all = vec![Explanation::of((given.own.clone(), Reading::default()), given, whole)?];
    // No number of all columns is wrong where one column is right.
    let is_any_right = given.columns.iter().any(Column::is_right);
    // Of zeros alone nothing is told by another world.
    let is_told = !matches!(&given.columns[..], [column] if column.is_zero());
    let is_possible =
        |cause: &&Cause| is_told && (!is_part || cause.is_of_times) && (cause.is_possible)(given);
    for cause in WORLDS.iter().filter(is_possible) {
        let Explanation { world, sum, open, .. } = &all[0];
        let is_enough = *open == 0 && sum.left <= CLEAR && sum.count <= 1 && world.clock[0] > 0.0;
        if cause.range.is_none() || !(is_any_right || is_enough) {
            // Times go with other units.
            let in_units = || cause.is_of_times.then(|| world_of(cause, given, true)).flatten();
            let world = world_of(cause, given, false).or_else(in_units);
            let world = world.filter(|(world, _)| !whole.is_clock_of_mesh(world));
            all.extend(world.and_then(|world| Explanation::of(world, given, whole)));
            all.sort_by(|a, b| a.open.cmp(&b.open).then(cost(&a.sum).total_cmp(&cost(&b.sum))));
        }
    }
    let mut all = all.into_iter();
    let mut best = all.next()?;
    // Of worlds that leave a column open, none is an alternative to what explains each column by itself.
    let is_alike =
        |other: &Explanation| other.open == best.open && (other.open == 0 || other.of.count == best.of.count);
    let others: Vec<Reading> = all.filter(is_alike).map(|other| other.sum).collect();
    best.of.or = as_good(&best.sum, others.iter());
    Some(best)
}

/// The best of the readings of a column, with the questions of others that are as good.
fn chosen(readings: &[Reading]) -> Option<Reading> {
    let best = readings.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    Some(Reading { or: as_good(best, readings.iter()), ..best.clone() })
}
