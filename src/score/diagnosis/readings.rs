//! Readings of one column: its unit, sign, offset, or another array in its place, each against one prediction.

use super::given::{Column, Field, Given};
use super::patterns;
use super::world::Predicted;
use super::{ONLY, convinces, cost};
use crate::import::mapping::units::{LengthUnit, StressUnit};
use oedometer_exact::ReferenceKind;
use oedometer_soil::elementary::powi;
use oedometer_soil::wording::short;

/// Standard atmosphere, Pa.
const ATMOSPHERE: f64 = 101_325.0;
/// A bar, Pa.
const BAR: f64 = 1e5;
/// Share by which a constant may miss the one that has a name.
const NEAR_NAME: f64 = 2e-3;
/// Constants below this share of the weight of the water in the column are none.
const NO_CONSTANT: f64 = 5e-3;
/// Fewest states that tell a displacement of an earlier stage from one of this load.
const FEWEST: usize = 2;
/// Fewest values on which a factor may be fitted.
const FEWEST_VALUES: usize = 4;

/// A column as it would be right.
#[derive(Clone, Debug)]
pub struct Reading {
    /// What it is, as "is 0.001 × the exact one".
    pub begin: String,
    /// The questions to ask.
    pub asked: Vec<String>,
    /// Number of single mistakes in it.
    pub count: usize,
    pub is_fitted: bool,
    /// The error that is left.
    pub left: f64,
}

impl Reading {
    /// Whether nothing of it is changed.
    pub fn is_plain(&self) -> bool {
        self.count == 0
    }
}

/// A factor by which every value would be multiplied to be right.
#[derive(Clone, Debug)]
pub struct Scale {
    pub factor: f64,
    asked: Vec<String>,
    pub count: usize,
    /// Whether it is a head of water.
    is_head: bool,
}

impl Scale {
    /// What a value is, before a colon.
    fn begin(&self) -> String {
        match 1.0 / self.factor {
            1.0 => "matches the exact one".to_owned(),
            ratio => format!("is {} × the exact one", short_factor(ratio)),
        }
    }
}

/// The best reading of a column; the plain one where no other convinces. Patterns are looked for where wanted, zeros and a
/// factor without a name in the scene's own world alone.
pub fn best(
    column: &Column,
    predicted: &Predicted,
    given: &Given<'_>,
    [with_patterns, is_own]: [bool; 2],
) -> Reading {
    let exact: Vec<f64> = column.exact(predicted).collect();
    let left = column.misfit_as_given(&exact);
    let plain = Reading {
        begin: "matches the exact one".to_owned(),
        asked: Vec::new(),
        count: 0,
        is_fitted: false,
        left,
    };
    if column.shows_nothing() || left.is_nan() || left <= super::NOTICED {
        return plain;
    }
    let mut all = scaled(column, &exact, given);
    all.extend(other_arrays(column, predicted, given));
    all.extend(offsets(column, &exact, predicted, given));
    all.extend(zero(column, given).filter(|_| is_own));
    if with_patterns {
        all.extend(patterns::zeros(column, &exact, given.are_picked));
        all.extend(earlier_stage(column, &exact, given));
    }
    all.retain(|reading| convinces(left, reading.left, reading.is_fitted));
    if with_patterns {
        all.extend(patterns::checkerboard(column, &exact, given));
    }
    if all.is_empty() && is_own && !given.has_common_factor {
        all.extend(constant_factor(column, &exact, given).filter(|one| one.left <= FACTOR_LEFT * left));
    }
    let cost_of = |reading: &Reading| cost(reading.left, reading.count);
    all.into_iter().fold(plain, |best, other| if cost_of(&other) < cost_of(&best) { other } else { best })
}

/// Share of the error that a factor without a name may leave.
const FACTOR_LEFT: f64 = 0.05;

/// The factors of units and signs of a column.
pub fn scales(column: &Column, given: &Given<'_>) -> Vec<Scale> {
    let declared = &given.mapping.units;
    let (units, declared_name): (Vec<(String, f64)>, &str) = if column.field.is_stress() {
        let unit = declared.stress.unwrap_or(StressUnit::Pascal);
        let of = |one: StressUnit| (format!("is it in {}", one.name()), one.pascals() / unit.pascals());
        let mut all = StressUnit::ALL.map(of).to_vec();
        if column.field == Field::Pressure {
            let weight = given.parameters.soil.unit_weight_of_water();
            for (unit_of_head, metres) in [("m", 1.0), ("cm", 0.01)] {
                let asked = format!("is it a head in {unit_of_head}, p/γ_w,");
                all.push((asked, metres * weight / unit.pascals()));
            }
        }
        (all, unit.name())
    } else {
        let unit = declared.displacement.unwrap_or(declared.length);
        let of = |one: LengthUnit| (format!("is it in {}", one.name()), one.metres() / unit.metres());
        (LengthUnit::ALL.map(of).to_vec(), unit.name())
    };
    let of = |(asked, factor): &(String, f64)| {
        let unit = (*factor != 1.0).then(|| format!("{asked} where {declared_name} is declared?"));
        [1.0, -1.0].map(|sign| {
            let turned = (sign < 0.0).then(|| "is the sign declared wrongly?".to_owned());
            let asked: Vec<String> = unit.iter().cloned().chain(turned).collect();
            let count = asked.len();
            Scale {
                factor: sign * factor,
                asked,
                count,
                is_head: unit.as_ref().is_some_and(|unit| unit.contains("head")),
            }
        })
    };
    units.iter().flat_map(of).collect()
}

/// The column in another unit, with another sign, doubled, halved, or by another modulus.
fn scaled(column: &Column, exact: &[f64], given: &Given<'_>) -> Vec<Reading> {
    let is_alone = given.is_one_column();
    let mut all: Vec<Scale> = scales(column, given).into_iter().filter(|scale| scale.count > 0).collect();
    for (factor, word) in [(2.0, "doubled"), (0.5, "halved")] {
        let load = format!("is the load {} × that of the scene? Or is it ", short(factor));
        let begin = if is_alone { load } else { format!("{ONLY}is it ") };
        let asked = vec![format!("{begin}{word} where it is written?")];
        all.push(Scale { factor: 1.0 / factor, asked, count: 1, is_head: false });
    }
    if !column.field.is_stress() && given.parameters.soils.is_empty() {
        let soil = &given.parameters.soil;
        let ratio = soil.youngs_modulus / soil.oedometric_modulus();
        let softer = "is E taken for E_oed where displacements are computed?";
        let stiffer = "is E_oed taken for E where displacements are computed?";
        let both = [(ratio, softer), (1.0 / ratio, stiffer)];
        let far = both.into_iter().filter(|(ratio, _)| (ratio - 1.0).abs() > NEAR_NAME);
        all.extend(far.map(|(factor, asked)| Scale {
            factor,
            asked: vec![asked.to_owned()],
            count: 1,
            is_head: false,
        }));
    }
    let is_plane = given.kind_is_plane();
    let of = |scale: Scale| {
        let left = column.misfit(exact, |_, value| scale.factor * value);
        let begin = scale.begin();
        let mut asked = scale.asked;
        // In a layer under a cosine load the other end looks like the other sign.
        if is_plane && is_alone && scale.factor == -1.0 {
            asked = vec![format!("{} Or does `x` count from the other end?", asked.concat())];
        }
        Reading { begin, asked, count: scale.count, is_fitted: false, left }
    };
    all.into_iter().map(of).collect()
}

/// The effective or the total stress in place of the pressure, the total one in place of the effective one.
fn other_arrays(column: &Column, predicted: &Predicted, given: &Given<'_>) -> Vec<Reading> {
    let pressure = predicted.field(Field::Pressure);
    let stress = predicted.field(Field::EffectiveStress);
    let of = |value: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        column.at.iter().map(|place| value(pressure[*place], stress[*place])).collect()
    };
    let (named, is_pressure) = match column.field {
        Field::Pressure => (vec![("effective", of(&|_, s| -s)), ("total", of(&|p, s| p - s))], true),
        Field::EffectiveStress => (vec![("total", of(&|p, s| s - p))], false),
        _ => return Vec::new(),
    };
    let mut all = Vec::new();
    for (name, exact) in named {
        if column.size(exact.iter().copied()) < super::NOTABLE * column.scale {
            continue;
        }
        for scale in scales(column, given).into_iter().filter(|scale| !scale.is_head) {
            let turned = scale.factor < 0.0;
            let of_sign = if turned { " with the other sign" } else { "" };
            let begin = format!("matches the exact {name} stress{of_sign}");
            let is_sealed = given.kind == ReferenceKind::SealedElement;
            let first = match (is_pressure, name) {
                // Water that does not give way carries the whole load of what is sealed.
                (true, "total") if is_sealed => {
                    "is the storage of the water, n/K_w, missing from the mass balance? Or is the total stress given in place \
                     of the pore pressure?"
                }
                (true, "total") if !given.moves() => {
                    "is it given in place of the pore pressure? Or does nothing drain?"
                }
                (true, _) => "is it given in place of the pore pressure?",
                (false, _) => "is the pore pressure left in?",
            };
            let first = first.to_owned();
            let unit = scale.asked.iter().filter(|asked| !asked.contains("sign")).cloned();
            let asked: Vec<String> = std::iter::once(first).chain(unit).collect();
            let left = column.misfit(&exact, |_, value| scale.factor * value);
            all.push(Reading { begin, count: asked.len(), asked, is_fitted: false, left });
        }
    }
    all
}

/// A hydrostatic part, a constant, or both on top of the pressure, which may be a head or in another unit.
fn offsets(column: &Column, exact: &[f64], predicted: &Predicted, given: &Given<'_>) -> Vec<Reading> {
    if column.field != Field::Pressure {
        return Vec::new();
    }
    let height = given.parameters.height;
    let weight = given.parameters.soil.unit_weight_of_water();
    let up = predicted.field(Field::Up);
    // Where the exact values are all alike, a constant says nothing.
    let middle = mean(column, &|place, _| exact[place]);
    let is_even = column.size(exact.iter().map(|value| value - middle)) < super::NOTABLE * column.scale;
    let mut all = Vec::new();
    for (scale, sense, moves) in offset_kinds(column, given) {
        {
            // Water at rest presses by the present depth; a small strain does not tell it from the initial one.
            let moved = |place: usize| if moves { up[column.at[place]] } else { 0.0 };
            let rest = |place: usize| sense * weight * (height - column.heights[place] - moved(place));
            let off = |place: usize, value: f64| scale.factor * value - rest(place) - exact[place];
            let constant = mean(column, &off);
            let is_none = constant.abs() <= NO_CONSTANT * weight * height && sense != 0.0;
            let (constant, is_fitted) = match constant {
                _ if is_none => (0.0, false),
                near if is_near(near, ATMOSPHERE) => (ATMOSPHERE, false),
                other => (other, true),
            };
            if is_even && is_fitted && sense == 0.0 {
                continue;
            }
            let left = column.misfit(exact, |place, value| scale.factor * value - rest(place) - constant);
            let asked = offset_asked(sense, constant, [weight, height], &scale);
            let Some((begin, mut asked, count)) = asked else { continue };
            asked.extend(scale.asked.iter().cloned());
            let begin = match scale.count {
                0 => begin,
                _ => format!("{} and {}", scale.begin(), begin),
            };
            // A level of the water that differs is no mistake of its own.
            let is_fitted = is_fitted && sense == 0.0;
            all.push(Reading { begin, count: count + scale.count, asked, is_fitted, left });
        }
    }
    all
}

/// The offsets that are tried: a unit, the sense of a hydrostatic part, and whether it is that of the present depth.
fn offset_kinds(column: &Column, given: &Given<'_>) -> Vec<(Scale, f64, bool)> {
    let is_large = matches!(given.kind, ReferenceKind::LargeStrain(_) | ReferenceKind::XieLeo);
    let senses = [(0.0, false), (1.0, false), (-1.0, false), (1.0, true), (-1.0, true)];
    let tried = senses.into_iter().filter(|(_, moves)| is_large || !moves);
    let scales = scales(column, given);
    tried
        .flat_map(|(sense, moves)| scales.clone().into_iter().map(move |scale| (scale, sense, moves)))
        .collect()
}

/// What an offset is, its questions and their number; `None` where there is no offset.
fn offset_asked(
    sense: f64,
    constant: f64,
    [weight, height]: [f64; 2],
    scale: &Scale,
) -> Option<(String, Vec<String>, usize)> {
    let atmosphere = "is it an absolute pressure, with that of the atmosphere left in?";
    let of_constant = if is_near(constant, ATMOSPHERE) || is_near(constant, BAR) {
        atmosphere.to_owned()
    } else {
        format!("is a constant of {} Pa left in?", short(rounded(constant)).replace('-', "−"))
    };
    let is_elevation = scale.is_head && sense < 0.0 && is_near(constant, weight * height);
    let gradient = if sense > 0.0 {
        "is the hydrostatic part left in?"
    } else if is_elevation {
        "is it a total head, with the elevation?"
    } else {
        "is the hydrostatic part taken off twice?"
    };
    let said_constant = format!("a constant of {} Pa", short(rounded(constant)).replace('-', "−"));
    let said_gradient =
        format!("a constant gradient of {} Pa/m", short(rounded(sense * weight)).replace('-', "−"));
    let differs = |what: &str| format!("differs from the exact one by {what}");
    match (sense != 0.0, constant != 0.0) {
        (false, false) => None,
        (false, true) => Some((differs(&said_constant), vec![of_constant], 1)),
        (true, false) => Some((differs(&said_gradient), vec![gradient.to_owned()], 1)),
        (true, true) if is_elevation => Some((differs(&said_gradient), vec![gradient.to_owned()], 1)),
        (true, true) if of_constant == atmosphere => {
            let both = differs(&format!("{said_gradient} and {said_constant}"));
            Some((both, vec![gradient.to_owned(), of_constant], 2))
        }
        (true, true) => {
            let both = differs(&format!("{said_gradient} and {said_constant}"));
            Some((both, vec![gradient.to_owned()], 1))
        }
    }
}

/// The same displacement at all times on top of the exact one.
fn earlier_stage(column: &Column, exact: &[f64], given: &Given<'_>) -> Option<Reading> {
    if column.field != Field::Up || given.states.len() < FEWEST {
        return None;
    }
    let height = given.parameters.height;
    let off = |place: usize, value: f64| value - exact[place];
    let (constant, slope) = line(column, &off, height)?;
    let at = |place: usize| constant + slope * column.heights[place] / height;
    let left = column.misfit(exact, |place, value| value - at(place));
    let top = short(rounded(constant + slope)).replace('-', "−");
    let begin = format!("differs from the exact one by the same at all times, {top} m at the top");
    let asked = vec!["is the displacement of an earlier stage, as of the own weight, left in?".to_owned()];
    Some(Reading { begin, asked, count: 2, is_fitted: true, left })
}

/// A column of zeros.
fn zero(column: &Column, given: &Given<'_>) -> Option<Reading> {
    let or = match column.field {
        Field::Pressure if !given.moves() => {
            " Or has all drained before the first time (is k, or are the times, too large by far)?"
        }
        Field::Up | Field::Settlement if !given.is_stressed() => " Or does nothing drain?",
        _ => "",
    };
    column.is_zero().then(|| Reading {
        begin: "is 0 everywhere".to_owned(),
        asked: vec![format!("is it another array than the one that is meant?{or}")],
        count: 1,
        is_fitted: false,
        left: 0.0,
    })
}

/// A factor without a name that all values have.
fn constant_factor(column: &Column, exact: &[f64], given: &Given<'_>) -> Option<Reading> {
    let (mut both, mut own) = (0.0, 0.0);
    for ((computed, exact), weight) in column.computed.iter().zip(exact).zip(&column.weights) {
        both += weight * computed * exact / powi(column.scale, 2);
        own += weight * exact * exact / powi(column.scale, 2);
    }
    let factor = both / own;
    if !(factor.is_normal() && column.computed.len() >= FEWEST_VALUES) {
        return None;
    }
    let left = column.misfit(exact, |_, value| value / factor);
    let begin = format!("is {} × the exact one at all times and places", short_factor(rounded(factor)));
    let load = if given.is_one_column() {
        format!("is the load {} × that of the scene? Or is ", short_factor(rounded(factor)))
    } else {
        format!("{ONLY}is ")
    };
    let asked = vec![format!("{load}a factor missing where it is written?")];
    Some(Reading { begin, asked, count: 2, is_fitted: true, left })
}

/// Weighted mean over a column.
fn mean(column: &Column, value: &dyn Fn(usize, f64) -> f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (place, (computed, weight)) in column.computed.iter().zip(&column.weights).enumerate() {
        sum += weight * value(place, *computed);
        weights += weight;
    }
    sum / weights
}

/// Constant and slope over the height of the line through values.
fn line(column: &Column, value: &dyn Fn(usize, f64) -> f64, height: f64) -> Option<(f64, f64)> {
    let centre = mean(column, &|place, _| column.heights[place] / height);
    let (mut sum, mut square) = (0.0, 0.0);
    for (place, (computed, weight)) in column.computed.iter().zip(&column.weights).enumerate() {
        let arm = column.heights[place] / height - centre;
        sum += weight * arm * value(place, *computed);
        square += weight * arm * arm;
    }
    let slope = sum / square;
    slope.is_finite().then(|| (mean(column, value) - slope * centre, slope))
}

fn is_near(number: f64, name: f64) -> bool {
    (number / name - 1.0).abs() <= NEAR_NAME
}

/// A factor in words: −1.00, 0.001, 60.
pub fn short_factor(factor: f64) -> String {
    let digits = if factor.abs() == 1.0 { format!("{factor:.2}") } else { short(factor) };
    digits.replace('-', "−")
}

/// A number rounded to four digits.
pub fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}
