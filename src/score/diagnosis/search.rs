//! The search: the explanation, a world with a reading of each column, that leaves least for the fewest mistakes.

use super::columns::{Column, Field, Given, Held};
use super::hypotheses::{CLOCK, Cause, NAME, ONE_STATE, Scale, UPSIDE_DOWN, WORLDS};
use super::readings::{Exact, Reading, accepted};
use super::world::World;
use super::{patterns, shown};
use oedometer_soil::elementary::{exp, ln, powi};

/// Share of its residual that a correction may leave; where the mesh explains it, or values are few; and at most.
const SHARE: f64 = 0.1;
const CLEAN: f64 = 0.02;
const MOST: f64 = 0.1;
const FEW: usize = 8;
/// Multiple of the residual of a right column that a correction of another may leave.
const AS_OTHERS: f64 = 30.0;
/// Share of its own residual that another column has that is right beside it: at least, and at most.
const BESIDE: f64 = 0.1;
const RIGHT_BESIDE: [f64; 2] = [1e-3, 0.03];
/// Multiple of the limit of a column that an output may have.
const OF_OUTPUT: f64 = 3.0;
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
/// Minima of a scan that are followed; trials in a decade, and at least and at most; halvings of a step.
const FOLLOWED: usize = 2;
const PER_DECADE: f64 = 5.0;
const TRIALS: usize = 16;
const MOST_TRIALS: usize = 200;
const HALVINGS: usize = 11;
/// What a mistake of a column must gain in a fit.
const PENALTY: f64 = 1.2;
/// Most names and alternatives that a sentence offers.
const MOST_NAMES: usize = 3;

/// What a correction of a column may leave, and the same where it is as good as exact.
pub struct Limit {
    pub of: f64,
    pub clean: f64,
    /// Whether another column is right.
    pub is_other_right: bool,
}

impl Limit {
    pub fn of(column: &Column, given: &Given<'_>) -> Self {
        let others = given.columns.iter().filter(|other| other.name != column.name);
        let least = others.map(|other| other.residual).fold(f64::INFINITY, f64::min);
        let is_fine = column.residual < column.mesh || column.values.len() < FEW;
        let right = given.columns.iter().filter(|column| column.is_right()).map(|column| column.residual);
        let most = right.reduce(f64::max).map_or(MOST, |worst| MOST.min(CLEAN.max(AS_OTHERS * worst)));
        Self {
            of: most.min(if is_fine { CLEAN } else { SHARE } * column.residual),
            clean: CLEAN * column.residual,
            is_other_right: least <= (BESIDE * column.residual).clamp(RIGHT_BESIDE[0], RIGHT_BESIDE[1]),
        }
    }

    /// The error that a hypothesis with a factor of the file leaves, if that is little in all and at every output.
    pub fn accepts(&self, column: &Column, held: &Held, factor: f64) -> Option<f64> {
        let left = column.misfit(held, factor, None);
        let is_even = |output: usize| column.misfit(held, factor, Some(output)) <= OF_OUTPUT * self.of;
        (left <= self.of && column.own_outputs().into_iter().all(is_even)).then_some(left)
    }
}

/// One mistake, or several.
#[derive(Clone, Debug, Default)]
pub struct Mistake {
    /// What the columns do; of a world how that goes on after "the exact one".
    pub said: String,
    /// What to ask.
    pub asked: Vec<String>,
    /// Number of single mistakes, and of numbers that were fitted.
    pub count: usize,
    pub fitted: usize,
}

/// The worlds of a cause in another world, one for each number that fits.
fn worlds(
    cause: &Cause,
    (base, before): &(World, Mistake),
    given: &Given<'_>,
    in_units: bool,
) -> Vec<(World, Mistake)> {
    let of = |number: f64| (cause.of)(given, base.clone(), number);
    let found = |world: f64, number: f64, asked: &str, more: &str, fitted: usize| {
        let side = if number < 0.0 { "before" } else { "after" };
        let said = cause.said.replace("{}", &shown(number.abs())).replace("{side}", side);
        let mistake = Mistake {
            said: format!("{}{said}{more}", before.said),
            asked: before.asked.iter().cloned().chain([asked.to_owned()]).collect(),
            count: before.count + 1,
            fitted: before.fitted + fitted,
        };
        (of(world), mistake)
    };
    let Some(fit) = &cause.fit else {
        return vec![found(0.0, 0.0, cause.asked, "", 0)];
    };
    let Some(range) = given.span().map(|span| (fit.range)(given, span)) else {
        return Vec::new();
    };
    let is_log = range[0] > 0.0;
    let number = |at: f64| if is_log { exp(at) } else { at };
    let value = |at: f64| left(&of(number(at)), given, in_units);
    let [low, high] = if is_log { range.map(ln) } else { range };
    let wanted = PER_DECADE * (high - low) / ln(10.0);
    let trials =
        (TRIALS..MOST_TRIALS).find(|trials| !is_log || *trials as f64 >= wanted).unwrap_or(MOST_TRIALS);
    let names = (fit.names)(given);
    let others = [left(base, given, in_units), value(low), value(high)];
    let of_minimum = |(at, least): (f64, f64)| {
        let (fitted, bound) = (number(at), least + ln(AS_WELL));
        let [is_own, is_low, is_high] = others.map(|other| other <= bound);
        if is_high && !is_own && !is_low && !cause.asked.is_empty() {
            let step = (high - low) / trials as f64;
            let from =
                (0..trials).map(|trial| high - step * trial as f64).take_while(|at| value(*at) <= bound);
            return Some(found(number(high), number(from.last()?), cause.asked, fit.or_more, 0));
        }
        if is_own || is_low || is_high {
            return None;
        }
        let is_name = |(name, _): &&(f64, String)| {
            (name / fitted - 1.0).abs() <= NAME || ln(name / fitted).abs() < 1.0 && value(ln(*name)) <= bound
        };
        let mut named: Vec<&(f64, String)> = names.iter().filter(is_name).collect();
        named.sort_by(|a, b| (a.0 - fitted).abs().total_cmp(&(b.0 - fitted).abs()));
        let asked: Vec<&str> = named.iter().take(MOST_NAMES).map(|(_, asked)| &**asked).collect();
        Some(match named.first() {
            Some((name, _)) => found(*name, *name, &asked.join(", or "), "", 0),
            None => found(fitted, fitted, &(fit.asked)(given, fitted), "", 1),
        })
    };
    minima(&value, [low, high], trials).into_iter().filter_map(of_minimum).collect()
}

/// The time at which one output matches best, s, with the error that is left.
pub fn one_time(given: &Given<'_>) -> Option<(f64, f64)> {
    let range = (ONE_STATE.fit.as_ref()?.range)(given, [0.0; 2]).map(ln);
    let value = |at: f64| left(&(ONE_STATE.of)(given, given.own.clone(), exp(at)), given, false);
    minima(&value, range, 40).first().map(|(at, left)| (exp(*at), exp(*left)))
}

/// Logarithm of the error that a world leaves, the mean of all columns, each as it is or in its best unit and sign: a column
/// that no world explains does not hide what explains the others.
fn left(world: &World, given: &Given<'_>, in_units: bool) -> f64 {
    let Some(predicted) = world.predict(given, &given.times) else {
        return f64::INFINITY;
    };
    let of_column = |column: &Column| {
        let itself = column.itself(&column.exact(&predicted));
        let mut least = 1.0_f64;
        let is_tried = |scale: &&Scale| !scale.is_alone && (in_units || scale.asked.is_empty());
        for scale in column.scales.iter().filter(is_tried) {
            for (sign, mistakes) in
                [(1.0, 0), (-1.0, 1)].into_iter().filter(|(sign, _)| in_units || *sign > 0.0)
            {
                let mistakes = mistakes + i32::from(!scale.asked.is_empty());
                let error = column.misfit(&itself, sign * scale.factor, None);
                least = least.min(powi(PENALTY, mistakes) * error);
            }
        }
        ln(least + FLOOR)
    };
    given.columns.iter().map(of_column).sum::<f64>() / given.columns.len() as f64
}

/// The least minima of a function over a range, with their values.
pub fn minima(value: &dyn Fn(f64) -> f64, [low, high]: [f64; 2], trials: usize) -> Vec<(f64, f64)> {
    let step = (high - low) / trials as f64;
    let all: Vec<(f64, f64)> =
        (0..=trials).map(|trial| low + step * trial as f64).map(|at| (at, value(at))).collect();
    let none = (0.0, f64::INFINITY);
    // Of a plateau the first.
    let is_least = |at: &usize| {
        let before = at.checked_sub(1).map_or(none, |before| all[before]).1;
        let after = all.get(at + 1).copied().unwrap_or(none).1;
        all[*at].1 < before && all[*at].1 <= after
    };
    let refined = |place: usize| {
        let (mut best, mut step) = (all[place], step);
        for _ in 0..HALVINGS {
            step *= 0.5;
            for at in [best.0 - step, best.0 + step].map(|at| at.clamp(low, high)) {
                let here = value(at);
                best = if here < best.1 { (at, here) } else { best };
            }
        }
        best
    };
    let mut places: Vec<usize> = (0..all.len()).filter(is_least).collect();
    places.sort_by(|a, b| all[*a].1.total_cmp(&all[*b].1));
    let mut minima: Vec<(f64, f64)> = places.into_iter().take(FOLLOWED).map(refined).collect();
    minima.sort_by(|a, b| a.1.total_cmp(&b.1));
    minima
}

/// A world with the reading of each column in it; none of one that is not explained.
pub struct Explanation {
    pub world: World,
    pub of: Mistake,
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
    fn of((world, of): (World, Mistake), given: &Given<'_>, whole: &Given<'_>) -> Option<Self> {
        let is_own = of.count == 0;
        let predicted = world.predict(given, &given.times)?;
        // A displacement that has a factor of its own, and a stiffness, cancel.
        let is_stiff = world.parameters.soil.youngs_modulus != given.own.parameters.soil.youngs_modulus;
        let (mut all, mut plain, mut kept) = (Vec::new(), 0, 0);
        for column in &given.columns {
            let x = Exact::new(given, &world, column, &predicted);
            let (here, limit) = (column.own_residual(&x.own), Limit::of(column, given));
            if column.is_right() {
                if !is_own && here > SPOILT[1].max(SPOILT[0] * column.residual) {
                    return None;
                }
                all.push(vec![Reading::plain(here)]);
                continue;
            }
            let itself = column.itself(&x.own);
            if let Some(left) = limit.accepts(column, &itself, 1.0).filter(|_| !is_own) {
                plain += 1;
                all.push(vec![Reading::plain(left)]);
                continue;
            }
            kept += usize::from(
                column.residual <= MOST && column.misfit(&itself, 1.0, None) <= KEPT * column.residual,
            );
            let mut readings = Vec::new();
            if !(column.is_zero() || is_stiff && !column.field.is_stress()) {
                readings = accepted(&x, &limit, is_own);
            }
            if is_own && !column.is_zero() {
                readings.extend(patterns::of(column.field, whole, &limit, readings.is_empty()));
            }
            all.push(readings);
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
        let mistakes = of.count + once.iter().map(|reading| reading.of.count).sum::<usize>();
        let fitted = of.fitted + once.iter().map(|reading| reading.of.fitted).sum::<usize>();
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

    /// Whether another one is as good, with as many mistakes.
    fn is_tied(&self, other: &Self) -> bool {
        // Of worlds that leave a column open, none is an alternative to what explains each column by itself; and two minima
        // of one clock are none.
        let is_as_whole = other.open == 0 || other.of.count == self.of.count;
        let [clock, of_other] = [self, other].map(|one| one.world.clock[0]);
        (other.open, other.mistakes, other.fitted) == (self.open, self.mistakes, self.fitted)
            && is_as_whole
            && (clock == 1.0 || (of_other / clock - 1.0).abs() > 0.05)
            && other.left <= AS_WELL * (self.left + FLOOR)
    }

    /// Whether a column is wrong and not explained.
    pub fn leaves(&self, field: Field, given: &Given<'_>) -> bool {
        let mut columns = self.readings.iter().zip(&given.columns);
        columns.any(|(reading, column)| column.field == field && reading.is_none())
    }

    /// What it asks of all columns; of the scene's own world, of the readings.
    fn asked(&self) -> String {
        let of_readings = self.readings.iter().flatten().map(|reading| &reading.of);
        let mut asked: Vec<&String> = of_readings
            .take(if self.of.count > 0 { 0 } else { usize::MAX })
            .chain([&self.of])
            .flat_map(|of| &of.asked)
            .collect();
        asked.dedup();
        asked.into_iter().cloned().collect::<Vec<_>>().join(", and ")
    }
}

fn cost(left: f64, mistakes: usize, fitted: usize) -> f64 {
    ln(left + FLOOR) + PER_MISTAKE * mistakes as f64 + PER_FIT * fitted as f64
}

/// The best explanation of some of the samples; `whole` has all of them, for patterns. Of outputs that are only some of
/// the file the soil and the load are those of the others.
pub fn explanation(given: &Given<'_>, whole: &Given<'_>, are_all_outputs: bool) -> Option<Explanation> {
    let own = (given.own.clone(), Mistake::default());
    let mut all: Vec<Explanation> = Vec::new();
    let add = |all: &mut Vec<Explanation>, worlds: Vec<(World, Mistake)>| {
        all.extend(worlds.into_iter().filter_map(|world| Explanation::of(world, given, whole)));
        all.sort_by(|a, b| a.open.cmp(&b.open).then(a.cost().total_cmp(&b.cost())));
    };
    add(&mut all, vec![own.clone()]);
    // No number of all columns is wrong where one column is right.
    let is_any_right = given.columns.iter().any(Column::is_right);
    let is_possible = |cause: &&Cause| (are_all_outputs || cause.is_of_times) && (cause.is_possible)(given);
    let causes: Vec<&Cause> = WORLDS.iter().filter(is_possible).collect();
    for (cause, in_units) in
        [false, true].into_iter().flat_map(|units| causes.iter().map(move |cause| (cause, units)))
    {
        let is_wanted = |best: &Explanation| {
            let is_open = best.open > 0 || best.mistakes > 1;
            if in_units { cause.is_of_times && is_open } else { !best.is_enough() }
        };
        let is_fitted = !is_any_right && all.first().is_none_or(is_wanted);
        let is_of_pass = if cause.fit.is_some() { is_fitted } else { !in_units };
        if is_of_pass {
            add(&mut all, worlds(cause, &own, given, in_units));
        }
    }
    if are_all_outputs && all.first().is_none_or(|best| best.open > 0) {
        let turned = worlds(&UPSIDE_DOWN, &own, given, false);
        add(&mut all, turned.iter().flat_map(|turned| worlds(&CLOCK, turned, given, true)).collect());
    }
    let mut all = all.into_iter();
    let mut best = all.next()?;
    let asked = best.asked();
    for other in all.filter(|other| best.is_tied(other)).map(|other| other.asked()).collect::<Vec<_>>() {
        if !other.is_empty() && other != asked && !best.alternatives.contains(&other) {
            best.alternatives.push(other);
        }
    }
    best.alternatives.truncate(MOST_NAMES - 1);
    let wrong = given.columns.iter().filter(|column| !column.is_right()).count();
    (best.open < wrong).then_some(best)
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
        ln(reading.left + FLOOR) + weight * (cost(1.0, reading.of.count, reading.of.fitted) - cost(1.0, 0, 0))
    };
    let mut best = all[place].iter().min_by(|a, b| cost_of(a).total_cmp(&cost_of(b)))?.clone();
    let rank = |reading: &Reading| (reading.of.count, reading.of.fitted, is_shared(reading));
    let is_tied =
        |other: &&Reading| rank(other) == rank(&best) && other.left <= AS_WELL * (best.left + FLOOR);
    let mut asked: Vec<String> =
        all[place].iter().filter(is_tied).map(|other| other.of.asked.join(", and ")).collect();
    asked.retain(|other| *other != best.of.asked.join(", and "));
    if !asked.is_empty() {
        asked.truncate(MOST_NAMES - 1);
        best.of.asked = vec![format!("{}, or {}", best.of.asked.join(", and "), asked.join(", or "))];
    }
    Some(best)
}
