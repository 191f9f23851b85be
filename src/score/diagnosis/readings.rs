//! Readings of one column: what it would hold by each row of the table, in each unit and with either sign.

use super::columns::{Column, Field, Given, Held, about_mean};
use super::hypotheses::{AT_OTHER_TIMES, Need, Number, READINGS, Row, Scale, Varies, is_load};
use super::search::{Limit, Mistake, minima};
use super::shown;
use super::world::{Ends, Fields, GAUSS, World};
use oedometer_soil::elementary::{exp, ln};

/// Relative half of the step over which a rate is taken.
const NEAR: f64 = 1e-3;
/// Fewest values on which a number may be fitted, and the trials of a time.
const FEWEST: usize = 4;
const TRIALS: usize = 40;

/// What a row may look at: exact fields at the places of a column.
pub struct Exact<'a> {
    pub given: &'a Given<'a>,
    pub world: &'a World,
    pub column: &'a Column,
    /// The column itself.
    pub own: Vec<f64>,
    pub pressure: Vec<f64>,
    pub stress: Vec<f64>,
    /// The displacement along the height.
    pub up: Vec<f64>,
}

impl<'a> Exact<'a> {
    pub fn new(given: &'a Given<'a>, world: &'a World, column: &'a Column, predicted: &Fields) -> Self {
        let of = |field: Field| column.of_field(predicted, field);
        let [pressure, stress, up] = [Field::Pressure, Field::EffectiveStress, Field::Up].map(of);
        Self { given, world, column, own: column.exact(predicted), pressure, stress, up }
    }

    /// A value for every place.
    #[expect(clippy::unnecessary_wraps, reason = "what a row holds, which rows of other times may not have")]
    pub fn each(&self, value: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
        Some((0..self.own.len()).map(value).collect())
    }

    pub fn load(&self) -> f64 {
        self.given.own.parameters.load
    }

    pub fn porosity(&self) -> f64 {
        self.given.own.parameters.soil.porosity
    }

    /// The strain of one soil, of which the stress is a multiple.
    pub fn strain(&self, at: usize) -> f64 {
        self.stress[at] / self.given.own.parameters.soil.oedometric_modulus()
    }

    pub fn height(&self) -> f64 {
        self.given.own.parameters.height
    }

    /// Unit weight of the water, Pa/m.
    pub fn weight(&self) -> f64 {
        self.given.own.parameters.soil.unit_weight_of_water()
    }

    /// The weight of the water between a place that has moved and the surface, Pa.
    pub fn weight_above(&self, at: usize, moved: f64) -> f64 {
        self.weight() * (self.height() - self.column.heights[at] - moved)
    }

    /// The exact values less others, but for some outputs.
    pub fn less(&self, others: &[f64], is_kept: impl Fn(usize) -> bool) -> Option<Vec<f64>> {
        self.each(|at| self.own[at] - if is_kept(self.column.outputs[at]) { 0.0 } else { others[at] })
    }

    /// The exact values at other times of the outputs.
    pub fn at(&self, time: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
        let times: Vec<f64> = (0..self.given.times.len()).map(time).collect();
        Some(self.column.exact(&self.world.predict(self.given, &times)?))
    }

    /// The exact values from the other end.
    pub fn turned(&self) -> Option<Vec<f64>> {
        let turned = World { ends: Ends::UpsideDown, ..self.world.clone() };
        Some(self.column.exact(&turned.predict(self.given, &self.given.times)?))
    }

    /// The integral over time, over a measure of the time; most happens early, as the root of the time.
    pub fn integral(&self, over: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; self.own.len()];
        for (place, weight) in GAUSS {
            let values = self.at(|output| place * place * self.given.times[output])?;
            for ((sum, value), output) in sum.iter_mut().zip(values).zip(&self.column.outputs) {
                let seconds = self.given.times[*output];
                *sum += 2.0 * place * weight * seconds * value / over(seconds);
            }
        }
        Some(sum)
    }

    pub fn rate(&self) -> Option<Vec<f64>> {
        let near = |factor: f64| self.at(|output| factor * self.given.times[output]);
        let (before, after) = (near(1.0 - NEAR)?, near(1.0 + NEAR)?);
        let step = |at: usize| 2.0 * NEAR * self.given.times[self.column.outputs[at]];
        self.each(|at| (after[at] - before[at]) / step(at))
    }

    /// What a row holds with a number, and what of it varies.
    fn held(&self, row: &Row, number: f64) -> Option<Held> {
        let values =
            (row.holds)(self, number).filter(|values| values.iter().all(|value| value.is_finite()))?;
        let varying = match row.varies {
            Varies::AsHeld => values.clone(),
            Varies::HeldAboutMean => about_mean(&values),
            Varies::AsExact => self.own.clone(),
            Varies::ExactAboutMean => about_mean(&self.own),
        };
        Some(Held { values, varying, floor: 0.0 })
    }

    /// The numbers of a row: those with a name, or the one that fits best with a factor of the file.
    fn numbers(&self, row: &Row, factor: f64) -> Vec<f64> {
        let column = self.column;
        let off = |number: f64| -> Option<Vec<f64>> {
            let held = (row.holds)(self, number)?;
            Some(column.values.iter().zip(held).map(|(value, held)| value / factor - held).collect())
        };
        match row.number {
            Number::Itself | Number::None => vec![0.0],
            Number::Named(numbers) => numbers.to_vec(),
            _ if column.values.len() < FEWEST => Vec::new(),
            Number::Linear | Number::Factor => {
                let (Some(none), Some(one)) = (off(0.0), off(1.0)) else {
                    return Vec::new();
                };
                let of_one: Vec<f64> = none.iter().zip(&one).map(|(none, one)| none - one).collect();
                vec![column.factor(&none, &of_one, None)]
            }
            Number::Time => {
                let Some([first, last]) = self.given.span() else {
                    return Vec::new();
                };
                let left = |power: f64| off(exp(power)).map_or(f64::INFINITY, |off| column.size(&off, None));
                let least = minima(&left, [ln(1e-3 * first), ln(3.0 * last)], TRIALS);
                least.first().map(|(at, _)| exp(*at)).into_iter().collect()
            }
        }
    }
}

/// A column as it would be right.
#[derive(Clone, Debug)]
pub struct Reading {
    pub of: Mistake,
    /// What columns share as one mistake.
    pub key: String,
    /// The error that is left.
    pub left: f64,
}

impl Reading {
    /// A column that matches the exact one.
    pub fn plain(left: f64) -> Self {
        let said = "matches the exact one".to_owned();
        Self { of: Mistake { said, ..Mistake::default() }, key: String::new(), left }
    }
}

/// All readings of a column that are accepted: of the table in the scene's own world, else units and signs alone; of other
/// times, which ask for the exact fields many times, where there is no other.
pub fn accepted(x: &Exact<'_>, limit: &Limit, is_own: bool) -> Vec<Reading> {
    let rows = if is_own { READINGS } else { &READINGS[..1] };
    let readings: Vec<Reading> = rows.iter().flat_map(|row| of_row(x, row, limit, [is_own, false])).collect();
    let is_timed = is_own && x.world.is_slow() && !x.world.kind.row().is_prepared;
    if !readings.is_empty() || !is_timed {
        return readings;
    }
    AT_OTHER_TIMES.iter().flat_map(|row| of_row(x, row, limit, [true, true])).collect()
}

fn is_met(need: Need, x: &Exact<'_>, limit: &Limit) -> bool {
    let own = &x.given.own;
    match need {
        Need::OtherRight => limit.is_other_right,
        Need::TwoOutputs => x.column.own_outputs().len() > 1,
        Need::OneSoil => own.is_column() && own.parameters.soils.is_empty(),
        Need::LargeStrain => !own.is_linear(),
        Need::OwnUnit | Need::AnySign => true,
    }
}

/// The readings of a row, one for each unit, sign and number that are accepted.
fn of_row(x: &Exact<'_>, row: &Row, limit: &Limit, [is_own, is_timed]: [bool; 2]) -> Vec<Reading> {
    let mut all = Vec::new();
    if !row.of.contains(&x.column.field) || !row.needs.iter().all(|need| is_met(*need, x, limit)) {
        return all;
    }
    let is_factor = row.number == Number::Factor;
    let is_unscaled = is_timed || row.needs.contains(&Need::OwnUnit);
    let is_in_unit = |scale: &&Scale| {
        if scale.is_alone {
            is_own && row.number == Number::Itself
        } else {
            scale.asked.is_empty() || !is_unscaled
        }
    };
    let scales = x.column.scales.iter().filter(is_in_unit);
    let signs = if is_unscaled { &[1.0][..] } else { &[1.0, -1.0] };
    for (scale, sign) in scales.flat_map(|scale| signs.iter().map(move |sign| (scale, *sign))) {
        let factor = sign * scale.factor;
        for number in x.numbers(row, factor) {
            let held = x.held(row, number);
            let Some(left) = held.and_then(|held| limit.accepts(x.column, &held, factor)) else {
                continue;
            };
            // A factor without a name in all columns is the load's, or an inaccurate solver's.
            if is_factor && !limit.is_other_right && left > limit.clean {
                continue;
            }
            let filled = |text: &str| text.replace("{}", &shown(number));
            let is_turned = sign < 0.0 && !row.needs.contains(&Need::AnySign);
            let sign_asked = if is_turned { "is the sign declared wrongly" } else { "" };
            let mut asked = vec![filled(row.asked), scale.asked.clone(), sign_asked.to_owned()];
            asked.retain(|asked| !asked.is_empty());
            if asked.is_empty() {
                continue;
            }
            if is_factor && x.given.columns.len() == 1 {
                asked[0] = format!("{}, or {}", is_load(number), asked[0]);
            }
            let what = filled(row.said);
            let said = match factor {
                1.0 if is_factor => format!("is {what}"),
                1.0 => format!("matches {what}"),
                _ => format!("is {} × {what}", shown(factor)),
            };
            let is_alone = scale.is_alone || is_factor || row.needs.contains(&Need::OtherRight);
            let of = if is_alone { x.column.name } else { "" };
            let fitted = usize::from(matches!(row.number, Number::Linear | Number::Factor | Number::Time));
            all.push(Reading {
                key: format!("{} {number} {} {sign} {of}", row.said, scale.asked),
                of: Mistake { said, count: asked.len() + row.count - 1, asked, fitted },
                left,
            });
        }
    }
    all
}
