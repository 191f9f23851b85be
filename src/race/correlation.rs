//! Whether two situations say the same: the correlation of the logarithms of the contenders' errors in them.

use crate::race::finish::NEGLIGIBLE;
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contenders that must have an error in both situations.
const FEWEST: usize = 5;

/// Two situations and how alike they rank the contenders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Correlation {
    /// The names of both.
    pub situations: [String; 2],
    /// Pearson's coefficient of the logarithms of the largest errors.
    pub value: f64,
}

/// A situation's name with the largest error of each contender on its common mesh.
pub type NamedErrors<'a> = (&'a str, Vec<Option<f64>>);

/// Every pair of situations, the most alike first. Errors below the negligible are equal.
pub fn correlations(situations: &[NamedErrors<'_>]) -> Vec<Correlation> {
    let pairs =
        (0..situations.len()).flat_map(|one| (one + 1..situations.len()).map(move |other| (one, other)));
    let mut all: Vec<Correlation> = pairs
        .filter_map(|(one, other)| {
            let value = pearson(&situations[one].1, &situations[other].1)?;
            Some(Correlation { situations: [one, other].map(|place| situations[place].0.to_owned()), value })
        })
        .collect();
    all.sort_by(|a, b| b.value.total_cmp(&a.value));
    all
}

/// Pearson's coefficient of the logarithms of what both have; `None` where that is too little or does not vary.
fn pearson(one: &[Option<f64>], other: &[Option<f64>]) -> Option<f64> {
    let logarithm = |error: f64| elementary::ln(error.max(NEGLIGIBLE));
    let both: Vec<(f64, f64)> =
        one.iter().zip(other).filter_map(|(a, b)| Some((logarithm((*a)?), logarithm((*b)?)))).collect();
    if both.len() < FEWEST {
        return None;
    }
    let count = both.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| both.iter().map(of).sum::<f64>() / count;
    let (mean_a, mean_b) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let sum =
        |of: &dyn Fn(f64, f64) -> f64| both.iter().map(|(a, b)| of(a - mean_a, b - mean_b)).sum::<f64>();
    let value = sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt();
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn situations_that_rank_alike_correlate_and_opposite_ones_do_not() {
        let errors = |powers: [f64; 5]| powers.map(|power| Some(0.01 * 10.0_f64.powf(power))).to_vec();
        let rising = errors([0.0, 0.1, 0.2, 0.3, 0.4]);
        // Each error twice as large: the same ranking.
        let twice = rising.iter().map(|error| error.map(|error| 2.0 * error)).collect();
        let falling = errors([0.4, 0.3, 0.2, 0.1, 0.0]);
        // By hand: deviations (−2 … 2) and (−2, 0, −1, 2, 1) of the powers: 8/10.
        let mixed = errors([0.0, 0.2, 0.1, 0.4, 0.3]);
        let equal = errors([0.0; 5]);
        let mut few = rising.clone();
        few[0] = None;
        let names = [
            ("rising", rising),
            ("twice", twice),
            ("falling", falling),
            ("mixed", mixed),
            ("equal", equal),
            ("few", few),
        ];
        let all = correlations(&names);
        let of = |a: &str, b: &str| {
            let pair = all.iter().find(|one| one.situations == [a, b]);
            pair.map(|one| (1e12 * one.value).round() / 1e12)
        };
        assert_eq!((of("rising", "twice"), of("rising", "falling")), (Some(1.0), Some(-1.0)));
        assert_eq!(of("rising", "mixed"), Some(0.8));
        assert_eq!((of("rising", "equal"), of("rising", "few")), (None, None));
        assert_eq!(all[0].situations, ["rising", "twice"]);
        // Below a thousandth errors are equal.
        let tiny = vec![Some(1e-9), Some(1e-5), Some(1e-4), Some(1e-3), Some(1e-6)];
        assert_eq!(correlations(&[("tiny", tiny.clone()), ("also", tiny)]), []);
    }
}
