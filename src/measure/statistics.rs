//! Statistics of samples: largest values that keep NaN; medians, spreads, and ratios of interleaved pairs of wall times.
//!
//! On a busy machine medians of the *same* code taken one after the other differ by up to 26 %,
//! medians of interleaved paired ratios by 4 %: so variants are timed in rounds, every sample is
//! kept, and a difference counts only beyond what the code shows against itself.

use statrs::distribution::{Binomial, DiscreteCDF};
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
    /// Median absolute deviation from the median, times 1.4826: the standard deviation where the
    /// samples are normal, and hardly moved by outliers.
    pub deviation: f64,
    /// Smallest sample.
    pub minimum: f64,
    /// Largest sample.
    pub maximum: f64,
}

/// The ratio of two variants timed in rounds, one of each a round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedRatio {
    /// Spread of the ratios first over second, round by round.
    pub ratios: WallSpread,
    /// Distribution-free interval of the median of at least 95 % (order statistics); `None` below
    /// six rounds.
    pub interval: Option<(f64, f64)>,
}

/// Median of samples, the mean of the middle two for an even number; `None` for no samples, or where one is not finite.
pub fn median(samples: &[f64]) -> Option<f64> {
    let is_sound = !samples.is_empty() && samples.iter().all(|sample| sample.is_finite());
    is_sound.then(|| Data::new(samples.to_vec()).median())
}

/// Median, deviation and extremes of samples; `None` for no samples, or where one is not finite.
pub fn spread(samples: &[f64]) -> Option<WallSpread> {
    let median_of_all = median(samples)?;
    let deviations: Vec<_> = samples.iter().map(|sample| (sample - median_of_all).abs()).collect();
    let data = Data::new(samples.to_vec());
    Some(WallSpread {
        count: samples.len(),
        median: median_of_all,
        deviation: 1.4826 * median(&deviations)?,
        minimum: data.min(),
        maximum: data.max(),
    })
}

/// Ratios of times first over second, paired by round; `None` where the lists cannot be paired or a time is not
/// positive.
pub fn paired_ratio(first: &[f64], second: &[f64]) -> Option<PairedRatio> {
    let is_time = |time: &f64| time.is_finite() && *time > 0.0;
    let are_times = first.len() == second.len() && first.iter().chain(second).all(is_time);
    let ratios: Vec<_> = first.iter().zip(second).map(|(a, b)| a / b).collect();
    let spread = spread(&ratios).filter(|_| are_times)?;
    let mut data = Data::new(ratios);
    let interval = median_rank(spread.count)
        .map(|rank| (data.order_statistic(rank), data.order_statistic(spread.count + 1 - rank)));
    Some(PairedRatio { ratios: spread, interval })
}

/// How far from 1 the ratio of a code to itself may lie: the far end of the median's
/// interval, or for fewer than six rounds the furthest ratio seen.
pub fn noise_floor(against_itself: &PairedRatio) -> f64 {
    let ratios = against_itself.ratios;
    let (low, high) = against_itself.interval.unwrap_or((ratios.minimum, ratios.maximum));
    (1.0 - low).abs().max((high - 1.0).abs())
}

/// Rank `k` such that the `k`-th smallest and `k`-th largest of `count` samples enclose the median
/// with at least 95 %: the largest with `P(Binomial(count, ½) < k) ≤ 2.5 %`.
fn median_rank(count: usize) -> Option<usize> {
    let below_median = Binomial::new(0.5, u64::try_from(count).ok()?).ok()?;
    let rank = usize::try_from(below_median.inverse_cdf(0.025)).ok()?;
    (rank > 0).then_some(rank)
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
        assert!((found.deviation - 1.4826).abs() < 1e-12);
    }

    #[test]
    fn ranks_are_those_of_the_table() {
        // Ranks of the 95 % interval of the median, from any table of the sign test.
        for (count, rank) in [(6, 1), (8, 1), (9, 2), (11, 2), (12, 3), (15, 4), (20, 6), (50, 18)] {
            assert_eq!(median_rank(count), Some(rank), "{count}");
        }
        assert_eq!(median_rank(5), None);
        assert_eq!(median_rank(0), None);
    }

    /// Times of two rounds-interleaved variants on a machine whose speed drifts by half.
    fn rounds(factor: f64) -> (Vec<f64>, Vec<f64>) {
        let drift = |round: i32| 1.0 + 0.5 * (f64::from(round) * 0.4).sin();
        let jitter = |round: i32| 1.0 + 0.02 * (f64::from(round) * 7.3).sin();
        let first = (0..20).map(|round| factor * drift(round) * jitter(round)).collect();
        let second = (0..20).map(|round| drift(round) * jitter(round + 100)).collect();
        (first, second)
    }

    #[test]
    fn pairs_see_through_a_drifting_machine() {
        let ratio = |factor| {
            let (first, second) = rounds(factor);
            paired_ratio(&first, &second).unwrap()
        };
        let noise = noise_floor(&ratio(1.0));
        assert!(noise > 0.0 && noise < 0.03, "{noise}");
        // The ratios of other codes stand out of it, with their whole interval.
        let (low, high) = (ratio(1.1).interval.unwrap().0, ratio(0.9).interval.unwrap().1);
        assert!(low > 1.0 + noise && high < 1.0 / (1.0 + noise), "{low} {high}");
        let (mut first, second) = rounds(1.0);
        first.iter_mut().step_by(2).for_each(|time| *time *= 1.5);
        let torn = paired_ratio(&first, &second).unwrap();
        assert!(torn.ratios.median > 1.1 && torn.interval.unwrap().0 < 1.0, "{torn:?}");
        let few = paired_ratio(&[2.0; 3], &[1.0; 3]).unwrap();
        assert_eq!(few.interval, None);
        assert_eq!(noise_floor(&few), 1.0);
    }

    #[test]
    fn what_are_no_times_have_no_statistic() {
        assert_eq!(median(&[]), None);
        assert_eq!(spread(&[1.0, f64::NAN]), None);
        for (first, second) in [(1.0, 0.0), (-1.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert_eq!(paired_ratio(&[first], &[second]), None, "{first} {second}");
        }
        assert_eq!(paired_ratio(&[1.0], &[]), None);
        assert_eq!(paired_ratio(&[], &[]), None);
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

    #[test]
    fn noise_is_what_lies_farther_from_one_on_either_side() {
        let ratios = spread(&[0.7, 1.0, 1.2]).expect("ratios");
        for (interval, noise) in [(Some((0.8, 1.1)), 0.2), (Some((0.95, 1.3)), 0.3), (None, 0.3)] {
            assert!((noise_floor(&PairedRatio { ratios, interval }) - noise).abs() < 1e-12, "{interval:?}");
        }
    }

    #[test]
    fn the_interval_of_a_ratio_lies_between_ranks_that_are_as_far_from_either_end() {
        for (count, low, high) in
            [(6, 1, 6), (8, 1, 8), (9, 2, 8), (12, 3, 10), (15, 4, 12), (20, 6, 15), (50, 18, 33)]
        {
            let mut ratios: Vec<f64> = (1..=count).map(f64::from).collect();
            // The order of the rounds does not count.
            for _ in 0..3 {
                ratios.rotate_left(2);
                ratios.swap(0, 3);
                let found = paired_ratio(&ratios, &vec![1.0; ratios.len()]).expect("times");
                assert_eq!(found.interval, Some((f64::from(low), f64::from(high))), "{count}");
                // Turned over, the fast one is the slow one.
                let turned = paired_ratio(&vec![1.0; ratios.len()], &ratios).expect("times");
                assert_eq!(turned.interval, Some((1.0 / f64::from(high), 1.0 / f64::from(low))), "{count}");
            }
        }
    }
}
