//! Statistics of samples: largest values that keep NaN; medians and spreads of wall times.

use statrs::statistics::{Data, Max, Min, OrderStatistics};

/// The larger of two numbers; NaN is larger than any. `f64::max` drops NaN, so that a run without an answer would
/// pass.
pub fn larger(first: f64, second: f64) -> f64 {
    if first > second || first.is_nan() { first } else { second }
}

/// The largest of numbers, or NaN where one of them is; `None` for no numbers.
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    numbers.into_iter().reduce(larger)
}

/// A list of samples in a few numbers, in their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallSpread {
    /// Number of samples.
    pub count: usize,
    /// Median.
    pub median: f64,
    /// Smallest sample.
    pub minimum: f64,
    /// Largest sample.
    pub maximum: f64,
}

/// Median of samples, the mean of the middle two for an even number; `None` for no samples, or where one is not finite.
pub fn median(samples: &[f64]) -> Option<f64> {
    let is_sound = !samples.is_empty() && samples.iter().all(|sample| sample.is_finite());
    is_sound.then(|| Data::new(samples.to_vec()).median())
}

/// Median and extremes of samples; `None` for no samples, or where one is not finite.
pub fn spread(samples: &[f64]) -> Option<WallSpread> {
    let median_of_all = median(samples)?;
    let data = Data::new(samples.to_vec());
    Some(WallSpread { count: samples.len(), median: median_of_all, minimum: data.min(), maximum: data.max() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_spreads_are_those_of_the_definition() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        let found = spread(&[1.0, 2.0, 3.0, 4.0, 100.0]).unwrap();
        assert_eq!((found.median, found.minimum, found.maximum, found.count), (3.0, 1.0, 100.0, 5));
    }

    #[test]
    fn what_are_no_times_have_no_statistic() {
        assert_eq!(median(&[]), None);
        assert_eq!(spread(&[1.0, f64::NAN]), None);
    }

    #[test]
    fn the_largest_and_what_is_no_number_are_found_wherever_they_stand() {
        for worst in [9.0, f64::INFINITY, f64::NAN] {
            for place in 0..3 {
                let mut numbers = [1.0, -20.0, 3.0];
                numbers[place] = worst;
                let found = largest(numbers).expect("three numbers");
                assert!(found == worst || found.is_nan() && worst.is_nan(), "{numbers:?}: {found}");
            }
        }
        assert_eq!(largest([]), None);
    }
}
