//! The search: the explanation, a world with a reading of each column, that leaves least for the fewest mistakes.

use super::columns::{Column, Given, MOST};
use super::hypotheses::{CLOCK, Cause, NAME, ONE_STATE, Scale, UPSIDE_DOWN, WORLDS};
use super::readings::{Exact, Reading, accepted};
use super::world::World;
use super::{patterns, shown};
use oedometer_soil::elementary::{exp, ln, powi};

/// Multiple of its residual that a right column may have in another world, and the least that it may have.
const SPOILT: [f64; 2] = [3.0, 3e-4];
/// Multiple of its residual that a column which is not explained may have in another world.
const KEPT: f64 = 1.5;
/// Errors below it do not tell explanations apart, and what is left below the other is next to nothing.
pub const FLOOR: f64 = 1e-5;
const CLEAR: f64 = 1e-3;
/// Logarithm of how much better an explanation must be for a mistake more, and for a fitted number more.
const PER_MISTAKE: f64 = 1.1;
const PER_FIT: f64 = 1.2;
/// Multiple of the least error up to which another explanation is as good.
const AS_WELL: f64 = 1.5;
/// Trials of a number over its range, and halvings of the step around the best.
const TRIALS: usize = 60;
const HALVINGS: usize = 14;
/// What a mistake of a column must gain in a fit.
const PENALTY: f64 = 1.2;
/// Most names and alternatives that a sentence offers.
const MOST_NAMES: usize = 3;

/// The world of a cause in another world, with the number that fits best, if that is clear.
fn world_of(
    cause: &Cause,
    (base, before): &(World, Reading),
    given: &Given<'_>,
    in_units: bool,
) -> Option<(World, Reading)> {
    let of = |number: f64| (cause.of)(given, base.clone(), number);
    let with = |number: f64, asked: &str, fitted: usize| {
        let side = if number < 0.0 { "before" } else { "after" };
        let said = cause.said.replace("{}", &shown(number.abs())).replace("{side}", side);
        let said = format!("{}{said}", before.said);
        let asked = [&before.asked[..], &[asked.to_owned()]].concat();
        let (count, fitted) = (before.count + 1, before.fitted + fitted);
        Some((of(number), Reading { said, asked, count, fitted, ..Reading::default() }))
    };
    let Some(range) = cause.range else {
        return with(0.0, cause.asked, 0);
    };
    let range = range(given, given.span());
    let is_log = range[0] > 0.0;
    let number = |at: f64| if is_log { exp(at) } else { at };
    let value = |at: f64| left(&of(number(at)), given, in_units);
    let ends = if is_log { range.map(ln) } else { range };
    let (at, least) = minimum(&value, ends, TRIALS);
    let (fitted, bound) = (number(at), least + ln(AS_WELL));
    if [value(ends[0]), value(ends[1]), left(base, given, in_units)].iter().any(|other| *other <= bound) {
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
        None => with(fitted, &(cause.asked_of)(given, fitted), 1),
    }
}

/// The time at which one output matches best, s, with the error that is left.
pub fn one_time(given: &Given<'_>) -> Option<(f64, f64)> {
    let (world, _) = world_of(&ONE_STATE, &(given.own.clone(), Reading::default()), given, false)?;
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
            let mistakes = i32::from(!scale.asked.is_empty());
            let [own, turned] = [1.0, -1.0].map(|sign| column.misfit(&itself, sign * scale.factor, None));
            powi(PENALTY, mistakes) * own.min(PENALTY * turned)
        };
        let others = column.scales.iter().filter(|scale| in_units && !scale.is_alone);
        ln(others.map(of).fold(as_it_is, f64::min) + FLOOR)
    };
    given.columns.iter().map(of_column).sum::<f64>() / given.columns.len() as f64
}

/// The place of the least value of a function over a range, with that value.
pub fn minimum(value: &dyn Fn(f64) -> f64, [low, high]: [f64; 2], trials: usize) -> (f64, f64) {
    let better = |best: (f64, f64), at: f64| {
        let here = value(at);
        if here < best.1 { (at, here) } else { best }
    };
    let mut step = (high - low) / trials as f64;
    let mut best = (0..=trials).map(|trial| low + step * trial as f64).fold((low, f64::INFINITY), better);
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
    /// What others that are as good ask.
    pub alternatives: Vec<String>,
    /// The largest error that is left of a column that was wrong.
    left: f64,
    mistakes: usize,
    fitted: usize,
    open: usize,
}

impl Explanation {
    /// The best readings in a world; `None` where it spoils a column that is right, or explains too little.
    fn of((world, of): (World, Reading), given: &Given<'_>, whole: &Given<'_>) -> Option<Self> {
        let is_own = of.count == 0;
        let predicted = world.predict(given, &given.times)?;
        // A displacement that has a factor of its own, and a stiffness, cancel.
        let is_stiff = world.parameters.soil.youngs_modulus != given.own.parameters.soil.youngs_modulus;
        let (mut all, mut plain, mut kept) = (Vec::new(), 0, 0);
        for (column, whole_column) in given.columns.iter().zip(&whole.columns) {
            let x = Exact::new(given, &world, column, &predicted);
            let (itself, residual) = (column.itself(&x.own), column.own_residual(&x.own));
            let as_it_is = column.accepts(&itself, 1.0).filter(|_| !is_own);
            if column.is_right() && !is_own && residual > SPOILT[1].max(SPOILT[0] * column.residual) {
                return None;
            }
            all.push(if column.is_right() {
                vec![Reading::plain(residual)]
            } else if let Some(left) = as_it_is {
                plain += 1;
                vec![Reading::plain(left)]
            } else {
                let is_near = column.misfit(&itself, 1.0, None) <= KEPT * column.residual;
                kept += usize::from(column.residual <= MOST && is_near);
                let is_read = !(column.is_zero() || is_stiff && !column.field.is_stress());
                let mut readings = if is_read { accepted(&x, is_own) } else { Vec::new() };
                if is_own && !column.is_zero() {
                    readings.extend(patterns::of(whole_column, whole, readings.is_empty()));
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
        let readings: Vec<Option<Reading>> = (0..all.len()).map(|place| chosen(&all, place)).collect();
        let wrong = readings.iter().zip(&given.columns).filter(|(_, column)| !column.is_right());
        let left = wrong.filter_map(|(reading, _)| Some(reading.as_ref()?.left)).reduce(f64::max);
        // What columns share is one mistake.
        let mut once: Vec<&Reading> = readings.iter().flatten().collect();
        once.sort_by_key(|reading| &reading.key);
        once.dedup_by_key(|reading| &reading.key);
        let mistakes = of.count + once.iter().map(|reading| reading.count).sum::<usize>();
        let fitted = of.fitted + once.iter().map(|reading| reading.fitted).sum::<usize>();
        let left = left.unwrap_or(1.0);
        Some(Self { world, of, readings, alternatives: Vec::new(), left, mistakes, fitted, open })
    }

    /// Its cost, without what round-off tells apart.
    fn cost(&self) -> f64 {
        (1e6 * cost(self.left, self.mistakes, self.fitted)).round()
    }

    /// Whether nothing is left to be explained.
    fn is_enough(&self) -> bool {
        self.open == 0 && self.left <= CLEAR && self.mistakes <= 1 && self.world.clock[0] > 0.0
    }

    /// Whether another one is as good, with as many mistakes: of worlds that leave a column open, none is an alternative to
    /// what explains each column by itself.
    fn is_tied(&self, other: &Self) -> bool {
        (other.open, other.mistakes, other.fitted) == (self.open, self.mistakes, self.fitted)
            && (other.open == 0 || other.of.count == self.of.count)
            && other.left <= AS_WELL * (self.left + FLOOR)
    }

    /// What it asks of all columns; of the scene's own world, of the readings.
    fn asked(&self) -> String {
        let readings = self.readings.iter().flatten();
        let all: Vec<&Reading> = if self.of.count > 0 { vec![&self.of] } else { readings.collect() };
        let mut asked: Vec<&str> = all.iter().flat_map(|of| &of.asked).map(|asked| &**asked).collect();
        asked.dedup();
        asked.join(", and ")
    }
}

fn cost(left: f64, mistakes: usize, fitted: usize) -> f64 {
    ln(left + FLOOR) + PER_MISTAKE * mistakes as f64 + PER_FIT * fitted as f64
}

/// The best explanation of some of the samples; `whole` has all of them, for patterns. Of outputs that are only some of
/// the file the soil and the load are those of the others.
pub fn explanation(given: &Given<'_>, whole: &Given<'_>, is_part: bool) -> Option<Explanation> {
    let own = (given.own.clone(), Reading::default());
    let mut all: Vec<Explanation> = Vec::new();
    let add = |all: &mut Vec<Explanation>, world: Option<(World, Reading)>| {
        all.extend(world.and_then(|world| Explanation::of(world, given, whole)));
        all.sort_by(|a, b| a.open.cmp(&b.open).then(a.cost().total_cmp(&b.cost())));
    };
    add(&mut all, Some(own.clone()));
    // No number of all columns is wrong where one column is right.
    let is_any_right = given.columns.iter().any(Column::is_right);
    let is_possible = |cause: &&Cause| (!is_part || cause.is_of_times) && (cause.is_possible)(given);
    let causes: Vec<&Cause> = WORLDS.iter().filter(is_possible).collect();
    for (in_units, cause) in
        [false, true].into_iter().flat_map(|units| causes.iter().map(move |cause| (units, cause)))
    {
        let is_wanted = |best: &Explanation| match in_units {
            true => cause.is_of_times && (best.open > 0 || best.mistakes > 1),
            false => !best.is_enough(),
        };
        let is_fitted = !is_any_right && all.first().is_none_or(is_wanted);
        if if cause.range.is_some() { is_fitted } else { !in_units } {
            add(&mut all, world_of(cause, &own, given, in_units));
        }
    }
    if !is_part && all.first().is_none_or(|best| best.open > 0) {
        let turned = world_of(&UPSIDE_DOWN, &own, given, true);
        add(&mut all, turned.and_then(|turned| world_of(&CLOCK, &turned, given, true)));
    }
    let wrong = given.columns.iter().filter(|column| !column.is_right()).count();
    let mut all = all.into_iter();
    let mut best = all.next().filter(|best| best.open < wrong)?;
    let mut asked: Vec<String> = all.filter(|other| best.is_tied(other)).map(|other| other.asked()).collect();
    let own = best.asked();
    asked.retain(|other| !other.is_empty() && *other != own);
    asked.dedup();
    asked.truncate(MOST_NAMES - 1);
    best.alternatives = asked;
    Some(best)
}

/// The best of the readings of a column, with the questions of others that are as good. What another column has too
/// counts half, since both are one mistake.
fn chosen(all: &[Vec<Reading>], place: usize) -> Option<Reading> {
    let is_shared = |reading: &Reading| {
        let others = all.iter().enumerate().filter(|(other, _)| *other != place);
        others.flat_map(|(_, readings)| readings).any(|other| other.key == reading.key)
    };
    let cost_of = |reading: &Reading| {
        let weight = if is_shared(reading) { 0.5 } else { 1.0 };
        ln(reading.left + FLOOR) + weight * (cost(1.0, reading.count, reading.fitted) - cost(1.0, 0, 0))
    };
    let mut best = all[place].iter().min_by(|a, b| cost_of(a).total_cmp(&cost_of(b)))?.clone();
    let rank = |reading: &Reading| (reading.count, reading.fitted, is_shared(reading));
    let is_tied =
        |other: &&Reading| rank(other) == rank(&best) && other.left <= AS_WELL * (best.left + FLOOR);
    let mut asked: Vec<String> =
        all[place].iter().filter(is_tied).map(|other| other.asked.join(", and ")).collect();
    let own = best.asked.join(", and ");
    asked.retain(|other| *other != own);
    if !asked.is_empty() {
        asked.truncate(MOST_NAMES - 1);
        best.asked = vec![format!("{own}, or {}", asked.join(", or "))];
    }
    Some(best)
}
