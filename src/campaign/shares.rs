//! Splits the cases between several machines, by hash or by estimated cost.

use crate::case::Case;
use crate::case::work_estimate::{estimated_seconds, estimated_work};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// By what the cases are parted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parting {
    /// The hash of the case alone: a case stays in its share whatever the others are.
    #[default]
    Hash,
    /// Estimated seconds, the longest case first, each to the share that has least so far.
    Cost,
}

/// A share `index/count` of the cases: the same whatever machine asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `count`.
    pub index: u64,
    /// How many shards there are.
    pub count: u64,
    /// By what the cases are parted.
    pub parting: Parting,
}

/// The share of each case, from 0 to `count` − 1.
pub fn shares_of(cases: &[&Case], count: u64, parting: Parting) -> Vec<u64> {
    match parting {
        Parting::Hash => cases.iter().map(|case| case.number() % count).collect(),
        Parting::Cost => {
            let works: Vec<u64> = cases.iter().map(|case| estimated_work(case)).collect();
            balanced(&works, count)
        }
    }
}

/// Parts works so that each next one, the largest first, goes to the share with the least so far (Graham 1969: no
/// share has more than 4/3 of what the best parting has); the first of several alike.
fn balanced(works: &[u64], count: u64) -> Vec<u64> {
    let mut order: Vec<usize> = (0..works.len()).collect();
    order.sort_by_key(|place| (Reverse(works[*place]), *place));
    // More shares than cases stay empty without being kept.
    let kept = count.min(works.len() as u64);
    let mut loads: BinaryHeap<Reverse<(u64, u64)>> = (0..kept).map(|share| Reverse((0, share))).collect();
    let mut shares = vec![0; works.len()];
    for place in order {
        if let Some(Reverse((load, share))) = loads.pop() {
            shares[place] = share;
            loads.push(Reverse((load.saturating_add(works[place]), share)));
        }
    }
    shares
}

/// What shares come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Seconds of the share that takes longest.
    pub largest: f64,
    /// Seconds of a share in the mean.
    pub mean: f64,
    /// Seconds of the longest case.
    pub longest_case: f64,
    /// Shares without a case.
    pub empty: u64,
}

/// What shares of cases come to, by estimated seconds.
pub fn balance_of(cases: &[&Case], shares: &[u64], count: u64) -> Balance {
    let used = shares.iter().max().map_or(0, |most| most + 1).min(count);
    let mut loads = vec![0.0; usize::try_from(used).unwrap_or(0)];
    let mut longest_case = 0.0;
    for (case, share) in cases.iter().zip(shares) {
        let seconds = estimated_seconds(case);
        longest_case = f64::max(longest_case, seconds);
        if let Some(load) = usize::try_from(*share).ok().and_then(|share| loads.get_mut(share)) {
            *load += seconds;
        }
    }
    let occupied = loads.iter().filter(|load| **load > 0.0).count() as u64;
    Balance {
        largest: loads.iter().copied().fold(0.0, f64::max),
        mean: loads.iter().sum::<f64>() / count.max(1) as f64,
        longest_case,
        empty: count.saturating_sub(occupied),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn largest_over_mean(works: &[u64], count: u64) -> f64 {
        let mut loads = vec![0_u64; usize::try_from(count).expect("few")];
        for (work, share) in works.iter().zip(balanced(works, count)) {
            loads[usize::try_from(share).expect("few")] += work;
        }
        let sum: u64 = loads.iter().sum();
        loads.iter().copied().max().unwrap_or(0) as f64 * count as f64 / sum as f64
    }

    #[test]
    fn the_longest_go_first_and_no_share_is_far_above_the_mean() {
        // Works of six decades, none larger than a share.
        let works: Vec<u64> =
            (0..2000_u64).map(|i| 1000 + (i * 2_654_435_761 % 1_000_003).pow(2) / 1_000_000).collect();
        for count in [2, 4, 8, 32, 64] {
            let ratio = largest_over_mean(&works, count);
            assert!((1.0..1.1).contains(&ratio), "{ratio} of {count} shares");
        }
        // By hand: 7, 6, 5 | 4, 3, 2 go to 7+2, 6+3, 5+4.
        assert_eq!(balanced(&[2, 3, 4, 5, 6, 7], 3), [0, 1, 2, 2, 1, 0]);
    }

    #[test]
    fn more_shares_than_cases_are_empty_and_work_beyond_counting_stays_it() {
        assert_eq!(balanced(&[1, 1], u64::MAX), [0, 1]);
        assert_eq!(balanced(&[], 4), Vec::<u64>::new());
        assert_eq!(balanced(&[u64::MAX, u64::MAX, u64::MAX], 2), [0, 1, 0]);
    }

    #[test]
    fn a_balance_is_over_all_shares_the_empty_ones_too() {
        let records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2, 3, 5]\n",
        );
        let cases: Vec<&Case> = records.iter().map(|record| &record.case).collect();
        let seconds: Vec<f64> = cases.iter().map(|case| estimated_seconds(case)).collect();
        let balance = balance_of(&cases, &[1, 0, 1], 4);
        assert!((balance.largest - seconds[0] - seconds[2]).abs() < 1e-15, "{balance:?}");
        assert!((balance.mean - seconds.iter().sum::<f64>() / 4.0).abs() < 1e-15, "{balance:?}");
        assert_eq!((balance.longest_case, balance.empty), (seconds[2], 2));
    }
}
