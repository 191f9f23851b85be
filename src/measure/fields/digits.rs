//! How many digits the numbers of a written field have.

use oedometer_soil::elementary::powi;

/// Fewest different numbers that show their digits: a few round ones prove nothing.
const FEWEST: usize = 4;

/// Most decimal digits that differ from all digits of a double.
const MOST: usize = 12;

/// How near a number must lie to its rounded self, relative, after a change of units.
const NEAR: f64 = 1e-13;

/// Units in which single precision is looked for: a field may have been read in kilopascals or millimetres.
const UNITS: [f64; 5] = [1.0, 1e3, 1e6, 1e-3, 1e-6];

/// Half a unit in the last digit of the numbers of a field over the numbers, where all are written with few decimal
/// digits or in single precision; 0 where they have all digits of a double, or are too few to tell.
///
/// Numbers of equal decimals after the point have most digits where they are largest, so the largest number of digits is
/// that of the norm.
pub fn half_a_digit(values: &[f64]) -> f64 {
    let mut different: Vec<f64> =
        values.iter().map(|value| value.abs()).filter(|value| value.is_normal()).collect();
    different.sort_by(f64::total_cmp);
    different.dedup();
    if different.len() < FEWEST {
        return 0.0;
    }
    let is_near = |value: f64, rounded: f64| (value - rounded).abs() <= NEAR * value;
    let has_digits = |digits: usize| {
        let rounded = |value: f64| format!("{value:.*e}", digits - 1).parse().unwrap_or(f64::NAN);
        different.iter().all(|value| is_near(*value, rounded(*value)))
    };
    let is_single = |unit: &f64| {
        let rounded = |value: f64| single(value / unit) * unit;
        different.iter().all(|value| is_near(*value, rounded(*value)))
    };
    if let Some(digits) = (1..=MOST).find(|digits| has_digits(*digits)) {
        return 0.5 * powi(10.0, 1 - i32::try_from(digits).unwrap_or(0));
    }
    if UNITS.iter().any(is_single) { 0.5 * f64::from(f32::EPSILON) } else { 0.0 }
}

/// A value in single precision.
#[expect(clippy::cast_possible_truncation, reason = "to lose digits is what it is for")]
fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_seen_through_units_and_not_in_a_few_round_numbers() {
        let exact: Vec<f64> = (1..40).map(|place| 9.87e4 * (f64::from(place) * 0.0371).sin()).collect();
        let map =
            |of: &dyn Fn(f64) -> f64| half_a_digit(&exact.iter().map(|value| of(*value)).collect::<Vec<_>>());
        let written = |value: f64| -> f64 { format!("{value:.5e}").parse().expect("a number") };
        assert_eq!(map(&|value| value), 0.0);
        assert_eq!(map(&single), 0.5 * f64::from(f32::EPSILON));
        assert_eq!(map(&|value| -1e3 * single(value / 1e3)), 0.5 * f64::from(f32::EPSILON));
        assert_eq!(map(&written), 0.5e-5);
        assert_eq!(map(&|value| 1e3 * written(value / 1e3)), 0.5e-5);
        // Three decimals of numbers up to 9.9e4 are eight digits.
        assert_eq!(map(&|value| (value * 1e3).round() / 1e3), 0.5e-7);
        assert_eq!(half_a_digit(&[0.5, 1.0, 0.25]), 0.0);
        assert_eq!(half_a_digit(&[0.0; 9]), 0.0);
    }
}
