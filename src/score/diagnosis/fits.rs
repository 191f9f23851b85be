//! Fits of one number of all columns: a factor or an offset of the times, a ramp, a stiffness, a load; and their names.

use super::columns::Given;
use super::hypotheses::{Family, Fitted, NAME, Scale, scales};
use super::search::{FLOOR, spoils};
use super::world::World;
use oedometer_exact::Reference;
use oedometer_exact::row::Axis;
use oedometer_soil::elementary::{exp, ln};
use oedometer_soil::wording::short;

/// Factors of the time that are searched, and time factors beyond which nothing changes.
const FACTORS: [f64; 2] = [1e-13, 1e13];
const EDGES: [f64; 2] = [1e-9, 40.0];
/// Factors of the stiffness and of the load that are searched.
const OTHERS: [f64; 2] = [1e-6, 1e6];
/// Ramps of the load that are searched, over the first and the last time.
const RAMPS: [f64; 2] = [0.05, 10.0];
/// Latest moment, over the first time.
const LATEST: f64 = 0.95;
/// Trials per decade before the golden section.
const PER_DECADE: f64 = 5.0;
/// Trials of a moment.
const MOMENTS: f64 = 24.0;
/// Steps of a golden section, and halvings of a border.
const SECTIONS: usize = 22;
const HALVINGS: usize = 6;
/// Minima of a scan that are followed.
const FOLLOWED: usize = 3;
/// Multiple of the least error up to which a number fits as well.
pub const AS_WELL: f64 = 1.5;
/// Factors closer than this to 1 are an inaccurate solver's.
const NEAR_ONE: f64 = 4e-3;
/// Largest relative difference of one factor in several columns.
const COMMON: f64 = 0.05;
/// Most names that a sentence offers.
const MOST_NAMES: usize = 4;
/// What a mistake of a column must gain in a fit.
const PENALTY: f64 = 1.2;
/// Small changes of a number that a column which is right would show.
const SMALL: f64 = 0.02;

/// A result with the factors of units and signs of each column, for many trials.
struct Trial<'a> {
    given: &'a Given<'a>,
    scales: Vec<Vec<Scale>>,
}

impl Trial<'_> {
    /// The mean logarithm of the errors that a world leaves, each column in its best unit and sign: a column that no world
    /// explains does not hide what explains the others.
    fn left(&self, world: &World, solution: Option<&Reference>) -> f64 {
        let predicted = match solution {
            Some(solution) => world.predict_by(solution, self.given, &self.given.times),
            None => world.predict(self.given),
        };
        let Some(predicted) = predicted else { return f64::INFINITY };
        let of_column = |(column, scales): (&super::columns::Column, &Vec<Scale>)| {
            let exact = column.exact(&predicted);
            if column.is_right() {
                return ln(column.own_residual(&exact).max(spoils(column.residual)) + FLOOR);
            }
            let of = |scale: &Scale| {
                let penalty =
                    oedometer_soil::elementary::powi(PENALTY, i32::try_from(scale.asked.len()).unwrap_or(2));
                penalty
                    * column
                        .misfit(&exact, &exact, scale.factor, true)
                        .min(column.own_residual(&exact).max(1.0))
            };
            ln(scales.iter().map(of).fold(f64::INFINITY, f64::min) + FLOOR)
        };
        let columns = self.given.columns.iter().zip(&self.scales);
        columns.map(of_column).sum::<f64>() / self.scales.len() as f64
    }
}

/// A number that fits, with the ends between which others fit as well, and whether those are open.
struct Fit {
    number: f64,
    left: f64,
    from: f64,
    to: f64,
    is_open: [bool; 2],
}

impl Fit {
    /// Whether a number fits as well.
    fn allows(&self, number: f64) -> bool {
        (number / self.number - 1.0).abs() <= NAME || (self.from..=self.to).contains(&number)
    }
}

/// The worlds of a family: its number where it fits, with its names; columns as they are, or each in its best unit.
pub fn worlds(family: &Family, given: &Given<'_>, base: &World, in_units: bool) -> Vec<World> {
    let Some([first, last]) = given.span().filter(|_| (family.is_possible)(given, base)) else {
        return Vec::new();
    };
    let of = |number: f64| (family.of)(given, base.clone(), number);
    let is_moment = family.kind == Fitted::Moment;
    let small = match family.kind {
        Fitted::Moment => [SMALL * first, -SMALL * first],
        Fitted::Ramp => [SMALL * first; 2],
        _ => [1.0 + SMALL, 1.0 - SMALL],
    };
    let is_excluded = |number: &f64| {
        let predicted = of(*number).predict(given);
        predicted.is_some_and(|predicted| {
            let mut right = given.columns.iter().filter(|column| column.is_right());
            right.any(|column| column.own_residual(&column.exact(&predicted)) > spoils(column.residual))
        })
    };
    if given.columns.iter().any(super::columns::Column::is_right) && small.iter().any(is_excluded) {
        return Vec::new();
    }
    let units = |column: &super::columns::Column| {
        let mut all = scales(column.field, given);
        all.truncate(if in_units { all.len() } else { 1 });
        all
    };
    let trial = Trial { given, scales: given.columns.iter().map(units).collect() };
    let names = (family.names)(given);
    let is_stepped = given.kind.row().is_prepared;
    if family.kind == Fitted::Load || (is_stepped && family.kind == Fitted::Stiffness) {
        let of_name =
            |(factor, asked): &(f64, String)| of(*factor).with(&said(family, given, *factor), asked.clone());
        let common = common_factor(given)
            .filter(|factor| !names.iter().any(|(name, _)| (factor / name - 1.0).abs() <= NAME));
        let load = |factor: f64| {
            let asked = format!("is the load {} × that of the problem?", shown(rounded(factor)));
            of(factor).fitted(&said(family, given, factor), asked)
        };
        let is_load = family.kind == Fitted::Load;
        let few = [3.0, 4.0, 5.0].into_iter().flat_map(|factor| [factor, 1.0 / factor]);
        let few = few.filter(|_| is_load && !given.is_linear()).map(load);
        return names.iter().map(of_name).chain(common.filter(|_| is_load).map(load)).chain(few).collect();
    }
    let times = |factor: f64| given.parameters.time_factor(factor);
    let range = match family.kind {
        Fitted::Clock => [FACTORS[0].max(EDGES[0] / times(last)), FACTORS[1].min(EDGES[1] / times(first))],
        Fitted::Ramp => [RAMPS[0] * first, RAMPS[1] * last],
        Fitted::Moment => [-LATEST * first, last],
        _ => OTHERS,
    };
    let is_timed = is_moment || family.kind == Fitted::Clock;
    let ready = if is_timed && !is_stepped { base.solution(given, &given.times, &[1.0]) } else { None };
    let number = |at: f64| if is_moment { at } else { exp(at) };
    let range = if is_moment { range } else { range.map(ln) };
    if range[1] <= range[0] {
        return Vec::new();
    }
    let steps = if is_moment { MOMENTS } else { ((range[1] - range[0]) / ln(10.0) * PER_DECADE).ceil() };
    let value = |at: f64| trial.left(&of(number(at)), ready.as_ref());
    let step = (range[1] - range[0]) / steps;
    let followed =
        minima(&value, range, steps).into_iter().take(if is_timed && !is_moment { FOLLOWED } else { 1 });
    let fit = |(at, left): (f64, f64)| {
        let edge = |end: f64| edge_of(at, end, step, left + ln(AS_WELL), &value);
        let [from, to] = range.map(edge);
        let is_open = [from <= range[0] + NAME, to >= range[1] - NAME];
        Fit { number: number(at), left, from: number(from), to: number(to), is_open }
    };
    followed
        .map(fit)
        .filter(|fit| fit.left.is_finite())
        .filter_map(|fit| match family.kind {
            Fitted::Clock => clock(given, base, &fit, &names),
            Fitted::Stiffness => stiffness(given, base, &fit, names.clone()),
            Fitted::Moment => moment(base, fit.number, first),
            _ => ramp(base, &fit),
        })
        .collect()
}

/// The minima of a function over a range, the least first.
fn minima(value: &dyn Fn(f64) -> f64, [low, high]: [f64; 2], steps: f64) -> Vec<(f64, f64)> {
    let step = (high - low) / steps;
    let places =
        std::iter::successors(Some(0.0), |place| Some(place + 1.0)).take_while(|place| *place <= steps);
    let all: Vec<(f64, f64)> = places.map(|place| low + step * place).map(|at| (at, value(at))).collect();
    let is_least = |place: &usize| {
        let before = place.checked_sub(1).map(|before| all[before].1);
        let after = all.get(place + 1).map(|after| after.1);
        let here = all[*place].1;
        // Of a plateau the first.
        here.is_finite()
            && before.is_none_or(|before| here < before)
            && after.is_none_or(|after| here <= after)
    };
    let mut least: Vec<usize> = (0..all.len()).filter(is_least).collect();
    least.sort_by(|a, b| all[*a].1.total_cmp(&all[*b].1));
    let refined = |place: usize| {
        let (at, here) = all[place];
        let around = [(at - step).max(low), (at + step).min(high)];
        let best = golden_section(around, value);
        let there = value(best);
        if there < here { (best, there) } else { (at, here) }
    };
    let mut minima: Vec<(f64, f64)> = least.into_iter().take(FOLLOWED).map(refined).collect();
    minima.sort_by(|a, b| a.1.total_cmp(&b.1));
    minima
}

/// Where a function is least in a range.
pub fn least(value: &dyn Fn(f64) -> f64, range: [f64; 2], steps: f64) -> Option<f64> {
    minima(value, range, steps).first().map(|(at, _)| *at)
}

/// How far from a minimum towards an end a function stays below a bound.
fn edge_of(at: f64, end: f64, step: f64, bound: f64, value: &dyn Fn(f64) -> f64) -> f64 {
    let sense = if end < at { -1.0 } else { 1.0 };
    let (mut inside, mut reach) = (at, NAME);
    // Ever wider steps to the first place outside, and then the border by halving.
    let mut outside = loop {
        let next = at + sense * reach;
        if (end - next) * sense <= 0.0 {
            if value(end) <= bound {
                return end;
            }
            break end;
        }
        if value(next) > bound {
            break next;
        }
        inside = next;
        reach = (2.0 * reach).min(reach + 4.0 * step);
    };
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(inside, outside);
        if value(middle) <= bound { inside = middle } else { outside = middle }
    }
    inside
}

/// Where a function is least between two ends.
fn golden_section([mut low, mut high]: [f64; 2], value: &dyn Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let (mut left, mut right) = (high - SECTION * (high - low), low + SECTION * (high - low));
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..SECTIONS {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - SECTION * (high - low);
            at_left = value(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + SECTION * (high - low);
            at_right = value(right);
        }
    }
    f64::midpoint(low, high)
}

/// The world of a factor of the time, with what it may be.
fn clock(given: &Given<'_>, base: &World, fit: &Fit, names: &[(f64, String)]) -> Option<World> {
    let at = |factor: f64| World { clock: [factor, 0.0], ..base.clone() };
    // The names of some factors, the nearest to one first.
    let named = |is_meant: &dyn Fn(f64) -> bool, near: f64| -> Vec<&(f64, String)> {
        let off = |factor: f64| ln(factor / near).abs();
        let mut named: Vec<&(f64, String)> = names.iter().filter(|(factor, _)| is_meant(*factor)).collect();
        named.sort_by(|a, b| off(a.0).total_cmp(&off(b.0)));
        named
    };
    let few = |is_meant: &dyn Fn(f64) -> bool, near: f64| -> String {
        let named = named(is_meant, near)
            .into_iter()
            .filter(|(_, asked)| !asked.contains("E_oed") && !asked.contains("of ten"));
        named.take(MOST_NAMES).flat_map(|(_, asked)| [" Or ", &**asked]).collect()
    };
    match fit.is_open {
        [true, true] => None,
        [_, true] => {
            let from = shown(rounded(fit.from));
            let said = format!(
                " of the end: everything has drained before the first time, at {from} × the time or more"
            );
            let or = if !given.has_pressure() {
                " Or does the skeleton carry the load at once, because the pore pressure is missing from the momentum balance?"
            } else if given.moves() {
                " Or does the strain not enter the mass balance, so that no pressure arises?"
            } else {
                ""
            };
            let few = few(&|factor| factor >= fit.from, fit.from);
            Some(at(fit.to).fitted(&said, format!("is k, or are the times, far too large?{few}{or}")))
        }
        [true, false] => {
            let most = shown(rounded(fit.to));
            let few = few(&|factor| factor <= fit.to, fit.to);
            let asked = format!("is k, or are the times, far too small, {most} × at most?{few}");
            Some(at(fit.number).with(" of the start: nothing has drained at the last time", asked))
        }
        [false, false] if (fit.number - 1.0).abs() < NEAR_ONE => None,
        [false, false] => {
            let named = named(&|factor| fit.allows(factor), fit.number);
            let Some((factor, _)) = named.first() else {
                let said = format!(" at {} × the time", shown(three_digits(fit.number)));
                return Some(at(fit.number).fitted(&said, generic(given, fit.number)));
            };
            let asked: Vec<&str> = named.iter().take(MOST_NAMES).map(|(_, asked)| &**asked).collect();
            let said = format!(" at {} × the time", shown(three_digits(*factor)));
            Some(at(*factor).with(&said, asked.join(" Or ")))
        }
    }
}

/// The inputs of which each alone would make the time run faster by a factor, with the numbers that they would be.
fn generic(given: &Given<'_>, factor: f64) -> String {
    let soil = &given.parameters.soil;
    if !given.parameters.soils.is_empty() {
        let stiffness = if given.moves() { "" } else { ", or its stiffness," };
        let factor = shown(rounded(factor));
        return format!(
            "is k of each layer{stiffness} {factor} × that of the problem, or are the times off?"
        );
    }
    let pair = |number: f64, unit: &str| {
        format!("{} {unit} for {}", short(three_digits(factor * number)), short(three_digits(number)))
    };
    let modulus = if given.moves() {
        String::new()
    } else {
        format!(", or E_oed {}", pair(soil.oedometric_modulus(), "Pa"))
    };
    let (k, c_v) = (soil.hydraulic_conductivity, soil.coefficient_of_consolidation());
    format!("is k {} (c_v {}){modulus}, or are the times off?", pair(k, "m/s"), pair(c_v, "m²/s"))
}

/// The world of times that count from another moment.
fn moment(base: &World, moment: f64, first: f64) -> Option<World> {
    let seconds = short(rounded(moment.abs()));
    let (side, late) = if moment < 0.0 { ("before", "late") } else { ("after", "early") };
    let asked = format!("do your times start at another moment, so that all are {seconds} s too {late}?");
    let world = World { clock: [1.0, moment], ..base.clone() }.fitted(&format!(" {seconds} s {side}"), asked);
    (moment.abs() >= NEAR_ONE * first).then_some(world)
}

/// The world of a load that rises evenly, where that of the scene is there at once.
fn ramp(base: &World, fit: &Fit) -> Option<World> {
    let seconds = short(three_digits(fit.number));
    let asked =
        format!("does your load rise over {seconds} s, in a ramp, whereas that of the problem is sudden?");
    let said = format!(" under a load that rises over {seconds} s");
    let world = World { ramp: fit.number, ..base.clone() }.fitted(&said, asked);
    (fit.is_open == [false, false]).then_some(world)
}

/// The world of a stiffness that fits, where displacements tell it from a permeability.
fn stiffness(given: &Given<'_>, base: &World, fit: &Fit, mut names: Vec<(f64, String)>) -> Option<World> {
    if (fit.number - 1.0).abs() < NEAR_ONE || fit.is_open.contains(&true) {
        return None;
    }
    names.retain(|(ratio, _)| fit.allows(*ratio));
    let off = |factor: f64| ln(factor / fit.number).abs();
    names.sort_by(|a, b| off(a.0).total_cmp(&off(b.0)));
    let Some((ratio, _)) = names.first().cloned() else {
        let said = format!(" with a stiffness {} × as large", shown(rounded(fit.number)));
        let asked = match modulus_told(given, fit.number) {
            Some((told, ratio)) => {
                format!("is {told}{}?", ratio.map_or(String::new(), |told| format!(", as of {told}")))
            }
            None if given.parameters.soils.is_empty() => {
                let modulus = given.parameters.soil.oedometric_modulus();
                let [number, modulus] = [fit.number * modulus, modulus].map(|number| short(rounded(number)));
                format!("is E_oed {number} Pa for {modulus}?")
            }
            None => "is the stiffness of each layer off?".to_owned(),
        };
        return Some(base.clone().stiffer(fit.number).fitted(&said, asked));
    };
    let family_said = match modulus_told(given, ratio) {
        Some((told, _)) => format!(" with {told}"),
        None => format!(" with a stiffness {} × as large", shown(rounded(ratio))),
    };
    let poisson = modulus_told(given, ratio).and_then(|(_, poisson)| poisson);
    let or = poisson.map_or(String::new(), |poisson| format!(" Or is {poisson}?"));
    let asked: Vec<String> = names.into_iter().take(MOST_NAMES).map(|(_, asked)| asked).collect();
    Some(base.clone().stiffer(ratio).with(&family_said, format!("{}{or}", asked.join(" Or "))))
}

/// How a sentence goes on about a number of a family.
fn said(family: &Family, given: &Given<'_>, factor: f64) -> String {
    match family.kind {
        Fitted::Load => format!(" of {} × the load", shown(rounded(factor))),
        _ => modulus_told(given, factor)
            .map_or(" of another stiffness".to_owned(), |(told, _)| format!(" with {told}")),
    }
}

/// A stiffness of so many times the right one as numbers, and as Poisson's ratio; none in layers and in planes.
fn modulus_told(given: &Given<'_>, ratio: f64) -> Option<(String, Option<String>)> {
    let soil = &given.parameters.soil;
    let is_plane = given.is_plane() || given.kind.row().axis == Axis::AlongSlab;
    if is_plane || !given.parameters.soils.is_empty() {
        return None;
    }
    let modulus = soil.oedometric_modulus();
    let [number, right] = [ratio * modulus, modulus].map(|number| short(rounded(number)));
    // E_oed/E = (1 − ν)/((1 + ν)(1 − 2ν)).
    let beyond = ratio * modulus / soil.youngs_modulus - 1.0;
    let root = (beyond * beyond + 8.0 * (beyond + 1.0) * beyond).sqrt();
    let poisson = (root - beyond) / (4.0 * (beyond + 1.0));
    let [told, right_one] = [poisson, soil.poissons_ratio].map(|number| short(three_digits(number)));
    let is_other = poisson.is_finite() && told != right_one;
    Some((format!("E_oed {number} Pa for {right}"), is_other.then(|| format!("ν {told} for {right_one}"))))
}

/// The factor that all columns have, where stresses and displacements agree on it.
fn common_factor(given: &Given<'_>) -> Option<f64> {
    if !(given.moves() && given.is_stressed()) {
        return None;
    }
    let of = |column: &super::columns::Column| column.factor(&column.values, &column.exact(&given.own));
    let factors: Vec<f64> = given.columns.iter().map(of).collect();
    let first = *factors.first()?;
    let are_one = factors.iter().all(|factor| (factor / first - 1.0).abs() <= COMMON);
    (are_one && first > 0.0).then(|| factors.iter().sum::<f64>() / factors.len() as f64)
}

/// A factor in words: −1.00, 0.001, 60.
pub fn shown(factor: f64) -> String {
    let digits = if factor.abs() == 1.0 { format!("{factor:.2}") } else { short(factor) };
    digits.replace('-', "−")
}

/// A number rounded to four digits.
pub fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

/// A number rounded to three digits: a fit gives no more.
fn three_digits(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}
