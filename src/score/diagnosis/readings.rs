//! Readings of one column: what it would hold by each row of the table, in each unit and with either sign.

use super::columns::{CLEAN, Column, FEW, Field, Given, Held, about_mean};
use super::hypotheses::{Number, Row, SIGN, Scale, Units, WHERE_WRITTEN, is_load};
use super::search::minimum;
use super::shown;
use super::world::{Fields, World, early_parts};
use oedometer_exact::ColumnParameters;
use oedometer_soil::elementary::{exp, ln};

/// Relative half of the step over which a rate is taken.
const NEAR: f64 = 1e-3;

/// What a row may look at: exact fields at the places of a column.
pub struct Exact<'a> {
    pub given: &'a Given<'a>,
    pub world: &'a World,
    pub column: &'a Column,
    /// Those of the scene.
    pub parameters: &'a ColumnParameters,
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
        let parameters = &given.own.parameters;
        Self { given, world, column, parameters, own: column.of_itself(predicted), pressure, stress, up }
    }

    /// A value for every place.
    pub fn each(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        (0..self.own.len()).map(value).collect()
    }

    /// The strain of one soil, of which the stress is a multiple.
    pub fn strain(&self, at: usize) -> f64 {
        self.stress[at] / self.parameters.soil.oedometric_modulus()
    }

    /// Unit weight of the water, Pa/m.
    pub fn weight(&self) -> f64 {
        self.parameters.soil.unit_weight_of_water()
    }

    /// The weight of the water between a place and the surface, Pa.
    pub fn weight_above(&self, at: usize) -> f64 {
        self.weight() * (self.parameters.height - self.column.heights[at])
    }

    /// The exact values less others, but for some outputs.
    pub fn less(&self, others: &[f64], is_kept: impl Fn(usize) -> bool) -> Vec<f64> {
        self.each(|at| self.own[at] - if is_kept(self.column.outputs[at]) { 0.0 } else { others[at] })
    }

    /// The exact values of a world at times of the outputs; not numbers where it has no solution.
    pub fn of_world(&self, world: &World, times: &[f64]) -> Vec<f64> {
        let predicted = world.predict(self.given, times);
        predicted.map_or_else(|| self.each(|_| f64::NAN), |predicted| self.column.of_itself(&predicted))
    }

    /// The exact values at other times of the outputs.
    pub fn at(&self, time: impl Fn(usize) -> f64) -> Vec<f64> {
        let times: Vec<f64> = (0..self.given.times.len()).map(time).collect();
        self.of_world(self.world, &times)
    }

    /// The mean since the start, times a measure of the time.
    pub fn mean(&self, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut sum = self.each(|_| 0.0);
        for (place, weight) in early_parts() {
            let values = self.at(|output| place * self.given.times[output]);
            for ((sum, value), output) in sum.iter_mut().zip(values).zip(&self.column.outputs) {
                *sum += weight * value * of(self.given.times[*output]);
            }
        }
        sum
    }

    pub fn rate(&self) -> Vec<f64> {
        let near = |factor: f64| self.at(|output| factor * self.given.times[output]);
        let (before, after) = (near(1.0 - NEAR), near(1.0 + NEAR));
        let step = |at: usize| 2.0 * NEAR * self.given.times[self.column.outputs[at]];
        self.each(|at| (after[at] - before[at]) / step(at))
    }

    /// What a row holds with a number. What is added to the exact solution does not vary as it does, and where that is a level
    /// or fitted, nor does its mean.
    fn held(&self, row: &Row, number: f64) -> Held {
        let mut varying = (row.holds)(self, number);
        let mut values = varying.clone();
        if let Some(plus) = row.plus {
            let added = self.each(|at| plus(self, at, number));
            values.iter_mut().zip(&added).for_each(|(value, added)| *value += added);
            if row.number != Number::None || added.iter().all(|other| *other == added[0]) {
                varying = about_mean(&varying);
            }
        }
        Held { values, varying, floor: 0.0 }
    }

    /// The numbers of a row: those with a name, or the one that fits best with a factor of the file.
    fn numbers(&self, row: &Row, factor: f64) -> Vec<f64> {
        let column = self.column;
        let off = |number: f64| column.beyond(&self.held(row, number).values, factor);
        match row.number {
            Number::None => vec![1.0],
            Number::Named(numbers) => numbers.to_vec(),
            _ if column.values.len() < FEW / 2 => Vec::new(),
            Number::Linear => {
                let (none, one) = (off(0.0), off(1.0));
                vec![column.factor(&none, &self.each(|at| none[at] - one[at]), None)]
            }
            Number::Time => {
                let left = |power: f64| column.size(&off(exp(power)), None);
                let [first, last] = self.given.span();
                vec![exp(minimum(&left, [ln(1e-3 * first), ln(3.0 * last)]).0)]
            }
        }
    }
}

/// Whether a column has several outputs, and other times are computed at no great cost.
pub fn is_timed(x: &Exact<'_>) -> bool {
    x.column.own_outputs().len() > 1 && x.world.is_slow() && !x.world.kind.row().is_prepared
}

/// A column, or all of them in a world, as it would be right.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What the columns do; of a world how that goes on after "the exact one".
    pub said: String,
    /// What to ask, and what of others that are as good.
    pub asked: Vec<String>,
    pub or: Vec<String>,
    /// Number of single mistakes, and of numbers that were fitted.
    pub count: usize,
    pub fitted: usize,
    /// What columns share as one mistake.
    pub key: String,
    /// The error that is left.
    pub left: f64,
}

/// The readings of a row, one for each unit, sign and number that are accepted.
pub fn of_row(x: &Exact<'_>, row: &Row, is_own: bool) -> Vec<Reading> {
    let (column, mut all) = (x.column, Vec::new());
    if !row.of.contains(&column.field) || !(row.is_possible)(x) {
        return all;
    }
    let is_tried = |scale: &&Scale| {
        (!scale.is_alone || is_own && row.asked.is_empty())
            && (scale.asked.is_empty() || row.units != Units::Own)
    };
    // Several mistakes are told where another column is right, or next to nothing is left.
    let is_sure = |left: &f64| row.count == 1 || column.is_other_right || *left <= CLEAN * column.residual;
    for scale in column.scales.iter().filter(is_tried) {
        for number in x.numbers(row, scale.factor) {
            let left = column.accepts(&x.held(row, number), scale.factor).filter(is_sure);
            let Some(left) = left else {
                continue;
            };
            let shown_number = shown(number);
            if shown_number == "1" && matches!(row.number, Number::Linear) && row.plus.is_none() {
                continue;
            }
            let filled = |text: &str| text.replace("{}", &shown_number);
            let mut asked = [&[filled(row.asked)][..], &scale.asked].concat();
            asked.retain(|asked| !(asked.is_empty() || row.units == Units::AnySign && asked == SIGN));
            if asked.is_empty() {
                continue;
            }
            // At small strain one column alone cannot tell the load from a factor of its own.
            if asked[0].ends_with(WHERE_WRITTEN) && x.given.columns.len() == 1 {
                asked[0] = format!("{}, or {}", is_load(scale.factor.abs() * number), asked[0]);
            }
            let said = match scale.factor {
                1.0 => format!("matches {}", filled(row.said)),
                factor => format!("is {} × {}", shown(factor), filled(row.said)),
            };
            // What any column may have is of each by itself.
            let is_alone = scale.is_alone || !row.asked.is_empty() && row.of.len() == Field::ALL.len();
            all.push(Reading {
                key: format!("{said} {asked:?} {}", if is_alone { column.name } else { "" }),
                said,
                count: asked.len() + row.count - 1,
                asked,
                fitted: usize::from(matches!(row.number, Number::Linear | Number::Time)),
                or: Vec::new(),
                left,
            });
        }
    }
    all
}
