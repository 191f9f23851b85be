//! Fits of one number: a factor of all times, an offset of all times, a factor of the stiffness; and the names of factors.
//!
//! The exact solution's own dependence on the time factor is the yardstick, for pressure and displacement together.

use super::given::{Column, Given};
use super::readings::{Scale, rounded, scales, short_factor};
use super::world::{Ends, World, with_soils};
use super::{ROUND_OFF, powered};
use crate::import::mapping::units::TimeUnit;
use oedometer_exact::{Reference, ReferenceKind};
use oedometer_soil::elementary::{exp, ln, powi};
use oedometer_soil::wording::short;

/// Factors of the time that are searched: nine decades to either side.
const FACTORS: [f64; 2] = [1e-9, 1e9];
/// Factors of the stiffness that are searched.
const STIFFNESSES: [f64; 2] = [1e-6, 1e6];
/// Time factor after which nothing changes, for the bounds of the search.
const LAST: f64 = 40.0;
/// Trials per decade before the golden section, of a stiffness and of the time.
const PER_DECADE: [f64; 2] = [3.0, 5.0];
/// Steps of a golden section, of solutions in closed form and of those computed step by step.
const SECTIONS: [usize; 2] = [22, 14];
/// Minima of a scan that are followed.
const FOLLOWED: usize = 3;
/// Multiple of the least error up to which a factor fits as well.
const AS_WELL: f64 = 1.5;
/// Relative distance from which on a named factor is another one, however well the data fit.
const NAME: f64 = 2e-3;
/// Factors closer than this to 1 are an inaccurate solver's.
const NEAR_ONE: f64 = 4e-3;
/// Viscosity of water at 20 °C, Pa s.
const VISCOSITY: f64 = 1.0e-3;
/// Ramps of the load that are searched, over the first and the last time.
const SHORTEST_RAMP: f64 = 0.05;
const LONGEST_RAMP: f64 = 10.0;
/// Most names that a sentence offers.
const MOST_NAMES: usize = 4;

/// A result with the factors of units and signs of each column, for many trials.
struct Trial<'a> {
    given: &'a Given<'a>,
    scales: Vec<Vec<Scale>>,
}

impl<'a> Trial<'a> {
    fn of(given: &'a Given<'a>) -> Self {
        let of = |column: &Column| scales(column, given);
        Self { given, scales: given.columns.iter().map(of).collect() }
    }

    /// The error that a world leaves over all columns, each in its best unit and sign.
    fn left(&self, world: &World, solution: Option<&Reference>) -> f64 {
        let predicted = match solution {
            Some(solution) => world.predict_by(solution, self.given),
            None => world.predict(self.given),
        };
        let Some(predicted) = predicted else { return f64::INFINITY };
        let of_column = |(column, scales): (&Column, &Vec<Scale>)| {
            let exact: Vec<f64> = column.exact(&predicted).collect();
            let of = |scale: &Scale| match scale.count {
                0 => column.misfit_as_given(&exact),
                count => powered(count) * column.misfit(&exact, |_, value| scale.factor * value),
            };
            let least = scales.iter().map(of).fold(f64::INFINITY, f64::min);
            powi(least, 2)
        };
        let shown = self.given.columns.iter().zip(&self.scales).filter(|(column, _)| !column.shows_nothing());
        shown.map(of_column).sum::<f64>().sqrt()
    }
}

/// A factor that fits, with the ends between which others fit as well.
struct Fit {
    factor: f64,
    left: f64,
    from: f64,
    to: f64,
    /// Ends of the search.
    searched: [f64; 2],
}

impl Fit {
    /// Whether a factor fits as well.
    fn allows(&self, factor: f64) -> bool {
        let is_near = (factor / self.factor - 1.0).abs() <= NAME;
        is_near || (self.from..=self.to).contains(&factor)
    }

    /// Whether every larger factor, or every smaller one, fits as well.
    fn is_open(&self) -> [bool; 2] {
        [self.from <= self.searched[0] * (1.0 + NAME), self.to >= self.searched[1] * (1.0 - NAME)]
    }
}

/// The worlds of a wrong clock or a wrong permeability: a factor with its names, or an offset.
pub fn clocks(given: &Given<'_>, base: &World) -> Vec<World> {
    let times: Vec<f64> = given.states.iter().map(|state| given.parameters.time_factor(state.time)).collect();
    let positive = || times.iter().copied().filter(|time| *time > 0.0);
    let (first, last) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
    if !(base.is_slow() && first.is_finite() && last > 0.0) {
        return Vec::new();
    }
    let trial = Trial::of(given);
    let ends = [FACTORS[0], FACTORS[1].min(LAST / first)];
    let world = |factor: f64| World { clock: [factor, 0.0], ..base.clone() };
    let mut all: Vec<World> = Vec::new();
    for fit in fits(&trial, ends, &world, true) {
        all.extend(named_clock(given, base, &fit));
    }
    let distinct = positive().any(|time| time > first * (1.0 + NAME));
    if distinct && base.ends == Ends::Own {
        all.extend(offset(&trial, base, [first, last]));
    }
    all
}

/// The minima of the error over a factor.
fn fits(trial: &Trial<'_>, ends: [f64; 2], world: &dyn Fn(f64) -> World, is_time: bool) -> Vec<Fit> {
    let [low, high] = ends.map(ln);
    let count = (((high - low) / ln(10.0)) * PER_DECADE[usize::from(is_time)]).ceil().max(2.0);
    let step = (high - low) / count;
    let places =
        std::iter::successors(Some(0.0), |place| Some(place + 1.0)).take_while(|place| *place <= count);
    let powers: Vec<f64> = places.map(|place| low + step * place).collect();
    let factors: Vec<f64> = powers.iter().map(|power| exp(*power)).collect();
    // One solution for all of them; one that is computed step by step holds for the times that it was asked for alone.
    let ready = if is_time { world(1.0).solution(trial.given, &factors) } else { None };
    let is_stepped = matches!(trial.given.kind, ReferenceKind::LargeStrain(_));
    let lefts = scanned(trial, &factors, world, ready.as_ref());
    let is_least = |place: &usize| {
        let (left, right) = (place.checked_sub(1).map(|before| lefts[before]), lefts.get(place + 1));
        // Of a plateau the first.
        lefts[*place].is_finite()
            && left.is_none_or(|left| lefts[*place] < left * (1.0 - ROUND_OFF))
            && right.is_none_or(|right| lefts[*place] <= right * (1.0 + ROUND_OFF))
    };
    let mut least: Vec<usize> = (0..lefts.len()).filter(is_least).collect();
    least.sort_by(|a, b| lefts[*a].total_cmp(&lefts[*b]));
    let ready = ready.filter(|_| !is_stepped);
    let value = |power: f64| trial.left(&world(exp(power)), ready.as_ref());
    let sections = SECTIONS[usize::from(is_stepped)];
    let follow = |place: &usize| {
        let around = [(powers[*place] - step).max(low), (powers[*place] + step).min(high)];
        let power = golden_section(around, sections, &value);
        let (power, left) = [(power, value(power)), (powers[*place], lefts[*place])]
            .into_iter()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((power, f64::INFINITY));
        let as_well = AS_WELL * left + ROUND_OFF;
        let edge = |towards: f64| edge_of(power, towards, step, as_well, &value);
        Fit { factor: exp(power), left, from: exp(edge(low)), to: exp(edge(high)), searched: ends }
    };
    least.iter().take(if is_time { FOLLOWED } else { 1 }).map(follow).collect()
}

/// The errors that worlds of several factors leave; where no time moves from one factor to the next, the error does not.
fn scanned(
    trial: &Trial<'_>,
    factors: &[f64],
    world: &dyn Fn(f64) -> World,
    ready: Option<&Reference>,
) -> Vec<f64> {
    let mut before: Option<(Vec<f64>, f64)> = None;
    let of = |factor: &f64| {
        let world = world(*factor);
        let times = world.time_factors(trial.given);
        let left = match before.take() {
            Some((same, left)) if ready.is_some() && same == times => left,
            _ => trial.left(&world, ready),
        };
        before = Some((times, left));
        left
    };
    factors.iter().map(of).collect()
}

/// How far from a minimum towards an end the error stays below a bound.
fn edge_of(power: f64, end: f64, step: f64, bound: f64, value: &dyn Fn(f64) -> f64) -> f64 {
    const HALVINGS: usize = 6;
    let sense = if end < power { -1.0 } else { 1.0 };
    let (mut inside, mut reach) = (power, NAME);
    // Ever wider steps to the first place outside, and then the border by halving.
    let mut outside = loop {
        let next = power + sense * reach;
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
fn golden_section([mut low, mut high]: [f64; 2], sections: usize, value: &dyn Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let (mut left, mut right) = (high - SECTION * (high - low), low + SECTION * (high - low));
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..sections {
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
fn named_clock(given: &Given<'_>, base: &World, fit: &Fit) -> Option<World> {
    let at = |factor: f64| World { clock: [factor, 0.0], ..base.clone() };
    match fit.is_open() {
        [true, true] => None,
        [_, true] => {
            let from = short_factor(rounded(fit.from));
            let said =
                format!(" of the end: all has drained before the first time, at {from} × the time or more");
            let or = if !given.has_pressure() {
                " Or does the skeleton carry the load at once, because the pore pressure is missing from the momentum balance?"
            } else if given.moves() {
                " Or does the strain not enter the mass balance, so that no pressure arises?"
            } else {
                ""
            };
            let few = far_names(given, |factor| factor >= fit.from, false);
            let asked = format!("is k, or are the times, too large by far{few}?{or}");
            Some(World { is_fitted: true, ..at(fit.to).with(&said, asked) })
        }
        [true, false] => {
            let said = " of the start: nothing has drained at the last time";
            let few = far_names(given, |factor| 1.0 / factor <= fit.to, true);
            let most = short_factor(rounded(fit.to));
            let asked = format!(
                "is k, or are the times, too small by far, {most} × at most{few}? Or does nothing drain, because the surface \
                 is closed?"
            );
            Some(World { is_fitted: true, ..at(fit.factor).with(said, asked) })
        }
        [false, false] if (fit.factor - 1.0).abs() < NEAR_ONE => None,
        [false, false] => {
            let mut named: Vec<(f64, String)> =
                names(given).into_iter().filter(|(factor, _)| fit.allows(*factor)).collect();
            let off = |factor: f64| ln(factor / fit.factor).abs();
            named.sort_by(|a, b| off(a.0).total_cmp(&off(b.0)));
            let Some((factor, _)) = named.first().cloned() else {
                let said = format!(" at {} × the time", short_factor(three_digits(fit.factor)));
                let world = at(fit.factor).with(&said, generic(given, fit.factor));
                return Some(World { count: base.count + 2, is_fitted: true, ..world });
            };
            let asked: Vec<String> = named.into_iter().take(MOST_NAMES).map(|(_, asked)| asked).collect();
            let said = format!(" at {} × the time", short_factor(three_digits(factor)));
            Some(at(factor).with(&said, asked.join(" Or ")))
        }
    }
}

/// Named factors beyond a bound, as examples; of slow times their reciprocals.
fn far_names(given: &Given<'_>, is_beyond: impl Fn(f64) -> bool, is_slow: bool) -> String {
    let weight = given.parameters.soil.unit_weight_of_water();
    let all = [
        (60.0, "s and min, or m/s and m/min"),
        (3600.0, "s and h, or m/s and m/hour"),
        (86_400.0, "s and days, or m/s and m/day"),
        (365.25 * 86_400.0, "s and years, or m/s and m/year"),
        (weight, "k and k/γ_w"),
        (1.0 / VISCOSITY, "k and k/μ"),
    ];
    let far = all.into_iter().filter(|(factor, _)| is_beyond(*factor));
    let part = if is_slow { "1/" } else { "" };
    let names: Vec<String> = far.map(|(factor, what)| format!("{part}{} ({what})", short(factor))).collect();
    if names.is_empty() { String::new() } else { format!(", as by {}", names.join(", ")) }
}

/// Factors of the time that have a name, each with its question.
fn names(given: &Given<'_>) -> Vec<(f64, String)> {
    let soil = &given.parameters.soil;
    let (weight, gravity) = (soil.unit_weight_of_water(), soil.gravity);
    let declared = given.mapping.units.time;
    let per_time_factor = given.parameters.time(1.0);
    let seconds = |unit: TimeUnit| unit.seconds(1.0, per_time_factor);
    let mut all: Vec<(f64, String)> = Vec::new();
    for unit in TimeUnit::ALL.into_iter().filter(|unit| *unit != declared) {
        let factor = seconds(unit) / seconds(declared);
        let is_time = declared != TimeUnit::S || factor > 1.0 || unit == TimeUnit::TimeFactor;
        if is_time {
            all.push((
                factor,
                format!("are times in {} where {} is declared?", unit.name(), declared.name()),
            ));
        }
    }
    for (unit, word) in
        [(TimeUnit::Min, "min"), (TimeUnit::H, "hour"), (TimeUnit::D, "day"), (TimeUnit::A, "year")]
    {
        let factor = seconds(unit) / seconds(TimeUnit::S);
        all.push((factor, format!("is k in m/{word} taken for m/s?")));
        all.push((1.0 / factor, format!("is k in m/s taken for m/{word}?")));
    }
    // With a porosity of a half both mistakes look alike.
    let [divided, multiplied] = if (soil.porosity - 0.5).abs() < 0.01 {
        [
            "is k twice too large, or divided by the porosity?",
            "is k half as large, or multiplied by the porosity?",
        ]
    } else {
        ["is k divided by the porosity?", "is k multiplied by the porosity?"]
    };
    let others = [
        (gravity, "is γ_w taken as ρ_w, without g?"),
        (1.0 / gravity, "is γ_w multiplied by g once too often?"),
        (1.0 / VISCOSITY, "is k/μ taken for the hydraulic conductivity k?"),
        (VISCOSITY, "is k divided by μ where it should not be?"),
        (weight, "is k taken for k/γ_w?"),
        (1.0 / weight, "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k?"),
        (1.0 / soil.porosity, divided),
        (soil.porosity, multiplied),
    ];
    all.extend(others.map(|(factor, asked)| (factor, asked.to_owned())));
    if !given.moves() {
        // A stiffness shows in displacements, too; without any it may be meant.
        let stiff = moduli(given).into_iter().map(|(ratio, asked)| (ratio, asked.to_owned()));
        all.extend(stiff);
    }
    // A stiffness could be meant too, where no displacement tells it.
    let or_stiffness = if given.moves() { ", or c_v," } else { ", or c_v or E_oed," };
    for decades in (1..=9).flat_map(|power| [power, -power]) {
        let factor = exp(f64::from(decades) * ln(10.0));
        all.push((factor, format!("is k{or_stiffness} off by a power of ten?")));
    }
    all
}

/// A number rounded to three digits: a fit gives no more.
fn three_digits(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}

/// The inputs of which each alone would make the time run faster by a factor, with the numbers that they would be.
fn generic(given: &Given<'_>, factor: f64) -> String {
    let soil = &given.parameters.soil;
    if !given.parameters.soils.is_empty() {
        return format!(
            "is k of each layer{} {} × that of the scene, or are the times off?",
            if given.moves() { "" } else { ", or its stiffness," },
            short_factor(rounded(factor))
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
    format!(
        "is k {} (c_v {}){modulus}, or are the times off?",
        pair(soil.hydraulic_conductivity, "m/s"),
        pair(soil.coefficient_of_consolidation(), "m²/s")
    )
}

/// The world of times that count from another moment.
fn offset(trial: &Trial<'_>, base: &World, [first, last]: [f64; 2]) -> Option<World> {
    const STEPS: u32 = 24;
    if matches!(base.kind, ReferenceKind::LargeStrain(_)) {
        return None;
    }
    let parameters = trial.given.parameters;
    let world = |offset: f64| World { clock: [1.0, parameters.time(offset)], ..base.clone() };
    let ready = world(-0.95 * first).solution(trial.given, &[1.0]);
    let value = |offset: f64| trial.left(&world(offset), ready.as_ref());
    let (from, to) = (-0.95 * first, last);
    let width = (to - from) / f64::from(STEPS);
    let at = |step: u32| from + width * f64::from(step);
    let best = (0..=STEPS).map(|step| (value(at(step)), at(step))).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let offset = golden_section([(best.1 - width).max(from), (best.1 + width).min(to)], SECTIONS[0], &value);
    if offset.abs() < NEAR_ONE * first {
        return None;
    }
    let seconds = short(rounded(parameters.time(offset.abs())));
    let (side, late) = if offset < 0.0 { ("before", "late") } else { ("after", "early") };
    let said = format!(" {seconds} s {side}");
    // A load that rises before the first time looks like a late one, halfway.
    let rise = parameters.time(-2.0 * offset);
    let rising = World { ramp: rise, ..base.clone() };
    let rises_as_well =
        offset < 0.0 && base.adds_up() && trial.left(&rising, None) <= AS_WELL * value(offset) + ROUND_OFF;
    let rises = if rises_as_well {
        format!(" Or does the load rise over {} s, in a ramp?", short(three_digits(rise)))
    } else {
        String::new()
    };
    let asked =
        format!("do your times count from another moment, so that all are {seconds} s too {late}?{rises}");
    let world = world(offset).with(&said, asked);
    Some(World { count: base.count + 2, is_fitted: true, ..world })
}

/// The world of a load that rises evenly, where that of the scene is there at once.
pub fn ramp(given: &Given<'_>, base: &World) -> Option<World> {
    let times = || given.states.iter().map(|state| state.time).filter(|time| *time > 0.0);
    let (first, last) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    if !(base.adds_up() && first.is_finite() && !base.parameters.self_weight) {
        return None;
    }
    let trial = Trial::of(given);
    let world = |seconds: f64| World { ramp: seconds, ..base.clone() };
    let fit = fits(&trial, [SHORTEST_RAMP * first, LONGEST_RAMP * last], &world, false).into_iter().next()?;
    if fit.is_open().contains(&true) || !fit.left.is_finite() {
        return None;
    }
    let seconds = short(three_digits(fit.factor));
    let said = format!(" under a load that rises over {seconds} s");
    let late = World { clock: [1.0, -0.5 * fit.factor], ..base.clone() };
    let is_late = fit.factor < 2.0 * first && trial.left(&late, None) <= AS_WELL * fit.left + ROUND_OFF;
    let or = if is_late { " Or do your times count from another moment, half of that earlier?" } else { "" };
    let asked = format!(
        "does your load rise over {seconds} s, in a ramp, where that of the scene is there at once?{or}"
    );
    let world = world(fit.factor).with(&said, asked);
    Some(World { count: base.count + 2, is_fitted: true, ..world })
}

/// How a sentence goes on about a stiffness of so many times the right one, and the further question whether it is ν.
pub fn with_modulus(given: &Given<'_>, ratio: f64) -> (String, String) {
    let Some((said, ratio_of_poisson)) = modulus_told(given, ratio) else {
        return (" of another stiffness".to_owned(), String::new());
    };
    (format!(" with {said}"), ratio_of_poisson.map_or(String::new(), |ratio| format!(" Or is {ratio}?")))
}

/// A stiffness of so many times the right one as numbers, and as Poisson's ratio; none in layers and in planes.
fn modulus_told(given: &Given<'_>, ratio: f64) -> Option<(String, Option<String>)> {
    let soil = &given.parameters.soil;
    let is_plane = given.kind_is_plane() || given.kind == ReferenceKind::Mandel;
    if is_plane || !given.parameters.soils.is_empty() {
        return None;
    }
    let own = soil.oedometric_modulus();
    let [number, right] = [ratio * own, own].map(|number| short(rounded(number)));
    // E_oed/E = (1 − ν)/((1 + ν)(1 − 2ν)).
    let over = ratio * own / soil.youngs_modulus;
    let root = (powi(over - 1.0, 2) + 8.0 * over * (over - 1.0)).sqrt();
    let poisson = (root - (over - 1.0)) / (4.0 * over);
    let [poisson_told, poisson_right] =
        [poisson, soil.poissons_ratio].map(|number| short(three_digits(number)));
    let is_other = poisson.is_finite() && poisson_told != poisson_right;
    let ratio = is_other.then(|| format!("ν {poisson_told} for {poisson_right}"));
    Some((format!("E_oed {number} Pa for {right}"), ratio))
}

/// Ratios of moduli that people take for one another, over the right one.
pub fn moduli(given: &Given<'_>) -> Vec<(f64, &'static str)> {
    let soil = &given.parameters.soil;
    let (young, nu, oedometric) = (soil.youngs_modulus, soil.poissons_ratio, soil.oedometric_modulus());
    let bulk = young / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + nu));
    let lame = bulk - 2.0 * shear / 3.0;
    let is_plane = given.kind_is_plane() || given.kind == ReferenceKind::Mandel;
    let all = [
        (oedometric / young, "is E_oed given as E?", true),
        (young / oedometric, "is E taken for E_oed?", !is_plane),
        (bulk / oedometric, "is the bulk modulus K taken for E_oed?", !is_plane),
        ((shear + 2.0 * lame) / (lame + 2.0 * shear), "are λ and μ exchanged?", !is_plane),
        (
            young / (1.0 - nu * nu) / oedometric,
            "is the modulus of plane stress, E/(1 − ν²), taken for E_oed?",
            !is_plane,
        ),
        (shear / oedometric, "is the shear modulus G taken for E_oed?", !is_plane),
        (2.0 * shear / oedometric, "is 2G taken for E_oed?", !is_plane),
    ];
    let is_other =
        |(ratio, _, is_meant): &(f64, &str, bool)| *is_meant && *ratio > 0.0 && (ratio - 1.0).abs() > NAME;
    all.into_iter().filter(is_other).map(|(ratio, asked, _)| (ratio, asked)).collect()
}

/// The world of a skeleton that is stiffer by a factor: slower to move, and less.
pub fn stiffer(base: &World, factor: f64) -> World {
    let change = |layer: &mut oedometer_soil::layers::SoilLayer| {
        layer.youngs_modulus = layer.youngs_modulus.map(|modulus| factor * modulus);
    };
    World { parameters: with_soils(&base.parameters, change), ..base.clone() }
}

/// The world of a stiffness that fits, where displacements tell it from a permeability.
pub fn stiffness(given: &Given<'_>, base: &World) -> Option<World> {
    if !(given.moves() && base.is_slow()) || matches!(base.kind, ReferenceKind::LargeStrain(_)) {
        return None;
    }
    let trial = Trial::of(given);
    let fit = fits(&trial, STIFFNESSES, &|factor| stiffer(base, factor), false).into_iter().next()?;
    if (fit.factor - 1.0).abs() < NEAR_ONE || fit.is_open().contains(&true) || !fit.left.is_finite() {
        return None;
    }
    if moduli(given).iter().any(|(ratio, _)| fit.allows(*ratio)) {
        return None;
    }
    let power = (ln(fit.factor) / ln(10.0)).round();
    let ten = exp(power * ln(10.0));
    if power != 0.0 && fit.allows(ten) {
        let said = format!(" with a stiffness {} × as large", short_factor(rounded(ten)));
        return Some(stiffer(base, ten).with(&said, "is E off by a power of ten, or in another unit?"));
    }
    let said = format!(" with a stiffness {} × as large", short_factor(rounded(fit.factor)));
    let asked = match modulus_told(given, fit.factor) {
        Some((told, ratio)) => {
            format!("is {told}{}?", ratio.map_or(String::new(), |told| format!(", as of {told}")))
        }
        None if given.parameters.soils.is_empty() => {
            let own = given.parameters.soil.oedometric_modulus();
            let [number, own] = [fit.factor * own, own].map(|number| short(rounded(number)));
            format!("is E_oed {number} Pa for {own}?")
        }
        None => "is the stiffness of each layer off?".to_owned(),
    };
    let world = stiffer(base, fit.factor).with(&said, asked);
    Some(World { count: base.count + 2, is_fitted: true, ..world })
}
