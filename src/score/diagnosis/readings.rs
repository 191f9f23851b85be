//! Readings of one column: what it would hold by each row of the table, in each unit and with either sign.

use super::columns::{Column, Field, Given};
use super::fits;
use super::hypotheses::{Need, Number, READINGS, Row, Scale, is_named_constant, scales};
use super::search::Limit;
use super::world::{Ends, GAUSS, Predicted, World};
use oedometer_soil::elementary::{exp, ln, powi};

/// Constants below this share of the weight of the water in the column are none.
const NO_CONSTANT: f64 = 5e-3;
/// Relative half of the step over which a rate is taken.
const NEAR: f64 = 1e-3;
/// Fewest values on which a number may be fitted.
const FEWEST: usize = 4;

/// What a file would hold, and what of it varies as the exact solution does: the yardstick of its error.
pub struct Held {
    pub values: Vec<f64>,
    pub varying: Vec<f64>,
}

impl Held {
    /// The exact values themselves.
    pub fn itself(exact: &[f64]) -> Self {
        Self { values: exact.to_vec(), varying: exact.to_vec() }
    }
}

/// Values that vary as a whole, where there are any.
pub fn whole(values: impl Into<Option<Vec<f64>>>) -> Option<Held> {
    let values = values.into()?;
    Some(Held { varying: values.clone(), values })
}

/// Values with the other sign.
pub fn negative(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| -value).collect()
}

/// What a row may look at.
pub struct Exact<'a> {
    pub given: &'a Given<'a>,
    pub world: &'a World,
    pub predicted: &'a Predicted,
    pub column: &'a Column,
    /// The exact values of the column itself.
    pub own: Vec<f64>,
}

impl Exact<'_> {
    pub fn pressure(&self) -> Vec<f64> {
        self.column.of_field(self.predicted, Field::Pressure)
    }

    pub fn stress(&self) -> Vec<f64> {
        self.column.of_field(self.predicted, Field::EffectiveStress)
    }

    /// The total stress, compression positive.
    pub fn total(&self) -> Vec<f64> {
        self.pressure().iter().zip(self.stress()).map(|(p, stress)| p - stress).collect()
    }

    /// The strain of one soil, of which the stress is a multiple.
    pub fn strain(&self) -> Vec<f64> {
        let modulus = self.given.parameters.soil.oedometric_modulus();
        self.stress().iter().map(|stress| stress / modulus).collect()
    }

    pub fn porosity(&self) -> f64 {
        self.given.parameters.soil.porosity
    }

    /// Unit weight of the water, Pa/m.
    pub fn weight(&self) -> f64 {
        self.given.parameters.soil.unit_weight_of_water()
    }

    /// The pressure over the load.
    pub fn dimensionless(&self) -> Vec<f64> {
        self.own.iter().map(|own| own / self.given.parameters.load).collect()
    }

    /// Depth of a value below the surface, m, at first and at present.
    pub fn depth(&self, place: usize) -> f64 {
        self.given.parameters.height - self.column.heights[place]
    }

    pub fn present_depth(&self, place: usize) -> f64 {
        self.depth(place) - self.column.of_field(self.predicted, Field::Up)[place]
    }

    /// Time of a value, s.
    pub fn time(&self, place: usize) -> f64 {
        self.given.times[self.column.outputs[place]]
    }

    /// A multiple of the exact values.
    pub fn times(&self, factor: f64) -> Vec<f64> {
        self.own.iter().map(|own| factor * own).collect()
    }

    /// A multiple of what varies about its mean, on a constant.
    pub fn offset(&self, factor: f64, constant: f64, of: &[f64]) -> Held {
        let mean = self.column.mean(of);
        let values = of.iter().map(|value| factor * value + constant).collect();
        Held { values, varying: of.iter().map(|value| factor * (value - mean)).collect() }
    }

    /// The exact values with an offset; where it is constant in place or time, what varies is about their mean.
    pub fn beside(&self, offset: impl Fn(usize) -> f64, is_about_mean: bool) -> Held {
        let mean = if is_about_mean { self.column.mean(&self.own) } else { 0.0 };
        let values = self.own.iter().enumerate().map(|(place, own)| own + offset(place)).collect();
        Held { values, varying: self.own.iter().map(|own| own - mean).collect() }
    }

    /// The exact values less others, but for some outputs.
    pub fn less(&self, others: &[f64], is_kept: impl Fn(usize) -> bool) -> Vec<f64> {
        let at = |place: usize| if is_kept(self.column.outputs[place]) { 0.0 } else { others[place] };
        self.own.iter().enumerate().map(|(place, own)| own - at(place)).collect()
    }

    /// The exact values at other times of the outputs.
    pub fn at(&self, time: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
        let times: Vec<f64> = (0..self.given.times.len()).map(time).collect();
        let mut values = self.column.exact(&self.world.predict_at(self.given, &times)?);
        // At the start a drained surface has the pressure of before or of after.
        let is_torn = |place: usize| {
            self.column.field == Field::Pressure
                && times[self.column.outputs[place]] <= 0.0
                && self.column.heights[place] >= self.given.parameters.height
        };
        for place in (0..values.len()).filter(|place| is_torn(*place)) {
            values[place] = self.column.values[place];
        }
        Some(values)
    }

    /// The integral over time; most happens early, as the root of the time.
    pub fn integral(&self) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; self.own.len()];
        for (place, weight) in GAUSS {
            let values = self.at(|output| place * place * self.given.times[output])?;
            for (at, (sum, value)) in sum.iter_mut().zip(values).enumerate() {
                *sum += 2.0 * place * weight * self.time(at) * value;
            }
        }
        Some(sum)
    }

    pub fn mean_over_time(&self) -> Option<Vec<f64>> {
        Some(self.integral()?.iter().enumerate().map(|(place, sum)| sum / self.time(place)).collect())
    }

    pub fn rate(&self) -> Option<Vec<f64>> {
        let near = |factor: f64| self.at(|output| factor * self.given.times[output]);
        let (before, after) = (near(1.0 - NEAR)?, near(1.0 + NEAR)?);
        let rate = |(place, (before, after)): (usize, (&f64, &f64))| {
            (after - before) / (2.0 * NEAR * self.time(place))
        };
        Some(before.iter().zip(&after).enumerate().map(rate).collect())
    }

    pub fn turned(&self) -> Option<Vec<f64>> {
        let world = World { ends: Ends::UpsideDown, ..self.world.clone() };
        Some(self.column.exact(&world.predict(self.given)?))
    }
}

/// A column as it would be right.
#[derive(Clone, Debug)]
pub struct Reading {
    /// What columns share as one mistake.
    pub key: String,
    /// What it is, as "is 0.001 × the exact one".
    pub begin: String,
    /// The questions to ask.
    pub asked: Vec<String>,
    /// Number of single mistakes in it, of numbers that were fitted, and of signs, which are free beside others.
    pub count: usize,
    pub fitted: usize,
    pub signs: usize,
    /// A factor that may be the load's where there is no other column.
    pub factor: Option<f64>,
    /// The error that is left.
    pub left: f64,
}

impl Reading {
    /// A column that matches the exact one.
    pub fn plain(left: f64) -> Self {
        Self {
            key: String::new(),
            begin: "matches the exact one".to_owned(),
            asked: Vec::new(),
            count: 0,
            fitted: 0,
            signs: 0,
            factor: None,
            left,
        }
    }
}

/// All readings of a column that are accepted in a world; in the scene's own one also those with a fitted number and of
/// other times, of which the slow ones only where they are wanted.
pub fn accepted(x: &Exact<'_>, limit: &Limit, is_own: bool, is_slow_wanted: bool) -> Vec<Reading> {
    let column = x.column;
    let all = scales(column.field, x.given);
    let mut readings = Vec::new();
    let is_possible = |row: &&Row| {
        let is_timed = row.needs.contains(&Need::AnyTime);
        let is_fitted = !matches!(row.number, Number::None | Number::Named(_));
        row.of.contains(&column.field)
            && (is_own || !(is_timed || is_fitted))
            && (is_slow_wanted || !is_timed)
            && row.needs.iter().all(|need| is_met(*need, x, limit))
    };
    for row in READINGS.iter().filter(is_possible) {
        let of_row = all.iter().filter(|scale| match scale.asked.len() {
            0 => !row.needs.iter().any(|need| [Need::Head, Need::Scale].contains(need)),
            _ if row.needs.contains(&Need::Scale) => true,
            _ if row.needs.contains(&Need::NoScale) => false,
            _ if row.needs.contains(&Need::Head) => scale.is_head,
            _ if scale.is_head => row.of == [Field::Pressure] && row.needs.is_empty(),
            _ => matches!(row.number, Number::None | Number::Named(_) | Number::Constant),
        });
        for scale in of_row {
            readings.extend(accepted_row(x, row, scale, limit));
        }
    }
    readings
}

fn is_met(need: Need, x: &Exact<'_>, limit: &Limit) -> bool {
    match need {
        Need::OtherRight => limit.is_other_right,
        Need::TwoOutputs => x.column.own_outputs().len() > 1,
        Need::AnyTime => x.world.is_slow() && !x.given.kind.row().is_prepared,
        Need::Still => x.column.stands_still(),
        Need::OneSoil => x.world.is_a_column() && x.given.parameters.soils.is_empty(),
        Need::Large => !x.given.is_linear(),
        Need::Head | Need::Scale | Need::NoScale | Need::MaybeLoad | Need::AnySign => true,
    }
}

/// The readings of a row in a unit and with a sign, one for each of its numbers.
fn accepted_row(x: &Exact<'_>, row: &Row, scale: &Scale, limit: &Limit) -> Vec<Reading> {
    let is_fitted = !matches!(row.number, Number::None | Number::Named(_));
    let numbers = match row.number {
        Number::None => vec![(0.0, row.asked.to_owned())],
        Number::Named(names) => names(x.given, x.column.field),
        _ if x.column.values.len() < FEWEST => Vec::new(),
        _ => fitted(x, row, scale.factor).map(|number| (number, row.asked.to_owned())).into_iter().collect(),
    };
    let is_any_sign = row.needs.contains(&Need::AnySign) && scale.factor < 0.0;
    let mut all = Vec::new();
    for (number, asked) in numbers {
        let held = (row.holds)(x, number).filter(|held| held.values.iter().all(|value| value.is_finite()));
        let Some(left) = held.and_then(|held| limit.accepts(x.column, &held, scale.factor, false)) else {
            continue;
        };
        // A factor without a name in all columns is the load's, or an inaccurate solver's.
        if matches!(row.number, Number::Factor) && !limit.is_other_right && left > limit.clean {
            continue;
        }
        let shown = fits::rounded(number);
        let filled = |text: &str| text.replace("{}", &fits::shown(shown));
        let mut questions: Vec<String> =
            Some(filled(&asked)).filter(|asked| !asked.is_empty()).into_iter().collect();
        questions
            .extend(scale.asked.iter().filter(|asked| !(is_any_sign && asked.contains("sign"))).cloned());
        let sign = if is_any_sign { " with the other sign" } else { "" };
        let is_alone = row.needs.iter().any(|need| [Need::NoScale, Need::OtherRight].contains(need));
        let of = if is_alone { x.column.name } else { "" };
        let signs = usize::from(scale.factor < 0.0 && !is_any_sign);
        all.push(Reading {
            key: format!("{} {shown} {} {of}", row.name, scale.key),
            begin: begin_of(scale, &format!("{}{sign}", filled(row.said))),
            count: row.count.max(1) - 1 + questions.len(),
            asked: questions,
            fitted: usize::from(is_fitted),
            signs,
            factor: Some(shown).filter(|_| row.needs.contains(&Need::MaybeLoad)),
            left,
        });
    }
    all
}

/// What a column is, before a colon: its factor, and what a row says.
fn begin_of(scale: &Scale, said: &str) -> String {
    let of_scale = format!("is {} × the exact one", fits::shown(fits::rounded(scale.factor)));
    match (scale.asked.is_empty() || said.ends_with("sign"), said) {
        (_, "") => of_scale,
        (true, said) => said.to_owned(),
        (false, said) => format!("{of_scale} and {said}"),
    }
}

/// The number of a row that fits best, with a factor of the file; `None` where it has a name, or is none.
fn fitted(x: &Exact<'_>, row: &Row, factor: f64) -> Option<f64> {
    let column = x.column;
    let file: Vec<f64> = column.values.iter().map(|value| value / factor).collect();
    let off = |number: f64| -> Option<Vec<f64>> {
        let held = (row.holds)(x, number)?.values;
        Some(file.iter().zip(held).map(|(value, held)| value - held).collect())
    };
    let number = match row.number {
        Number::Constant => {
            let constant = column.mean(&off(0.0)?);
            let is_none = constant.abs() <= NO_CONSTANT * x.weight() * x.given.parameters.height;
            let is_none = is_none && row.name.starts_with("hydrostatic");
            Some(constant).filter(|constant| !(is_none || is_named_constant(*constant)))
        }
        Number::Slope => {
            let arm: Vec<f64> = column.heights.iter().map(|y| y / x.given.parameters.height).collect();
            Some(column.factor(&off(0.0)?, &arm))
        }
        Number::Factor => Some(column.factor(&file, &x.own)).filter(|factor| factor.is_normal()),
        Number::Time => {
            let [first, last] = x.given.span()?;
            let left = |power: f64| {
                off(exp(power)).map_or(f64::INFINITY, |off| powi(column.size(&off) / column.scale, 2))
            };
            fits::least(&left, [ln(1e-3 * first), ln(3.0 * last)], 40.0).map(exp)
        }
        Number::None | Number::Named(_) => None,
    };
    number.filter(|number| number.is_finite())
}
