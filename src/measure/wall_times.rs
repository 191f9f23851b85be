//! Statistics of wall times: medians, spreads, ratios of interleaved pairs, and their noise.
//!
//! On a busy machine medians of the *same* code taken one after the other differ by up to 26 %,
//! medians of interleaved paired ratios by 4 %: so variants are timed in rounds, every sample is
//! kept, and a difference counts only beyond what the code shows against itself.

use oedometer_soil::elementary;

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

/// Median of samples, the mean of the middle two for an even number; none for none, or what is no number.
pub fn median(samples: &[f64]) -> Option<f64> {
    Some(middle(&sorted(samples)?))
}

/// Median, deviation and extremes of samples; none for none, or what is no number.
pub fn spread(samples: &[f64]) -> Option<WallSpread> {
    let ordered = sorted(samples)?;
    let median = middle(&ordered);
    let deviations: Vec<_> = ordered.iter().map(|sample| (sample - median).abs()).collect();
    Some(WallSpread {
        count: ordered.len(),
        median,
        deviation: 1.4826 * middle(&sorted(&deviations)?),
        minimum: ordered[0],
        maximum: ordered[ordered.len() - 1],
    })
}

/// Ratios of times first over second, paired by round; none where the lists cannot be paired or hold what is no
/// positive time.
pub fn paired_ratio(first: &[f64], second: &[f64]) -> Option<PairedRatio> {
    let is_time = |time: &f64| time.is_finite() && *time > 0.0;
    let are_times = first.len() == second.len() && first.iter().chain(second).all(is_time);
    let ratios: Vec<_> = first.iter().zip(second).map(|(a, b)| a / b).collect();
    let ordered = sorted(&ratios).filter(|_| are_times)?;
    let interval = median_rank(ordered.len()).map(|rank| (ordered[rank - 1], ordered[ordered.len() - rank]));
    Some(PairedRatio { ratios: spread(&ratios)?, interval })
}

/// How far from 1 the ratio of the same code against itself may lie: the far end of the median's
/// interval, or for fewer than six rounds the furthest ratio seen.
pub fn noise_floor(against_itself: &PairedRatio) -> f64 {
    let ratios = against_itself.ratios;
    let (low, high) = against_itself.interval.unwrap_or((ratios.minimum, ratios.maximum));
    (1.0 - low).abs().max((high - 1.0).abs())
}

/// Rank `k` such that the `k`-th smallest and `k`-th largest of `count` samples enclose the median
/// with at least 95 %: the largest with `P(Binomial(count, ½) < k) ≤ 2.5 %`.
fn median_rank(count: usize) -> Option<usize> {
    let mut term = elementary::powi(0.5, i32::try_from(count).ok()?);
    let (mut below, mut rank) = (0.0, 0);
    while below + term <= 0.025 && rank < count {
        below += term;
        term *= (count - rank) as f64 / (rank + 1) as f64;
        rank += 1;
    }
    // For thousands of samples the first term underflows; nobody times that many rounds.
    (rank > 0 && rank < count.div_ceil(2)).then_some(rank)
}

fn middle(ordered: &[f64]) -> f64 {
    let half = ordered.len() / 2;
    if ordered.len() % 2 == 1 { ordered[half] } else { f64::midpoint(ordered[half - 1], ordered[half]) }
}

/// The samples in order; they are at least one, and finite.
fn sorted(samples: &[f64]) -> Option<Vec<f64>> {
    let mut ordered = samples.to_vec();
    ordered.sort_by(f64::total_cmp);
    (!ordered.is_empty() && ordered.iter().all(|sample| sample.is_finite())).then_some(ordered)
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
}
