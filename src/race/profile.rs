//! Performance profiles (Dolan & Moré 2002): the share of situations in which a contender arrives within a multiple of the
//! best cost. Families of situations weigh the same, and so do the situations of a family.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// Costs up to this multiple of the best are as good: what measured seconds scatter about the calibration.
pub const TIE: f64 = 1.25;
/// Multiple of the best cost up to which a contender is nearly as good.
pub const NEARLY: f64 = 2.0;
/// Multiples of the best cost at which every profile has a value.
pub const TAUS: [f64; 7] = [1.0, 1.3, 2.0, 5.0, 10.0, 100.0, 1000.0];

/// Costs of every contender in one situation.
#[derive(Clone, Debug, PartialEq)]
pub struct CostRow {
    /// Its family.
    pub family: String,
    /// Its name.
    pub situation: String,
    /// Per contender; `None` where it does not arrive.
    pub costs: Vec<Option<f64>>,
}

/// Costs of every contender in every situation, to one threshold of one quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CostTable {
    /// The contenders.
    pub contenders: Vec<String>,
    /// The situations.
    pub rows: Vec<CostRow>,
}

/// The profile of a contender: a staircase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Profile {
    /// The contender.
    pub contender: String,
    /// Multiples of the best cost with the share of situations in which it arrives within each, rising.
    pub steps: Vec<(f64, f64)>,
}

impl Profile {
    /// Share of situations in which it arrives within a multiple of the best cost.
    pub fn share(&self, tau: f64) -> f64 {
        self.steps.iter().take_while(|(known, _)| *known <= tau).last().map_or(0.0, |(_, share)| *share)
    }
}

/// A contender with what it is chosen by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Choice {
    /// The contender.
    pub method: String,
    /// Share of situations in which it arrives.
    pub reached: f64,
    /// Share in which it arrives within twice the best cost.
    pub within_two: f64,
}

impl Choice {
    /// Mean of both shares: whoever always arrives late is no better than who sometimes does not arrive.
    pub fn score(&self) -> f64 {
        0.5 * (self.reached + self.within_two)
    }
}

impl CostTable {
    /// The same for some contenders, whose best is taken among themselves.
    #[must_use]
    pub fn only(&self, is_kept: impl Fn(&str) -> bool) -> Self {
        let kept: Vec<usize> =
            (0..self.contenders.len()).filter(|place| is_kept(&self.contenders[*place])).collect();
        let row = |row: &CostRow| CostRow {
            costs: kept.iter().map(|place| row.costs[*place]).collect(),
            ..row.clone()
        };
        Self {
            contenders: kept.iter().map(|place| self.contenders[*place].clone()).collect(),
            rows: self.rows.iter().map(row).collect(),
        }
    }

    /// The same for some families.
    #[must_use]
    pub fn of_families(&self, is_kept: impl Fn(&str) -> bool) -> Self {
        let rows = self.rows.iter().filter(|row| is_kept(&row.family)).cloned().collect();
        Self { contenders: self.contenders.clone(), rows }
    }

    /// The families, each once, in their order.
    pub fn families(&self) -> Vec<&str> {
        let mut families: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !families.contains(&row.family.as_str()) {
                families.push(&row.family);
            }
        }
        families
    }

    /// The weight of each situation; together 1.
    fn weights(&self) -> Vec<f64> {
        let families = self.families().len() as f64;
        let alike =
            |row: &CostRow| self.rows.iter().filter(|other| other.family == row.family).count() as f64;
        self.rows.iter().map(|row| 1.0 / (families * alike(row))).collect()
    }

    /// The profile of every contender.
    pub fn profiles(&self) -> Vec<Profile> {
        let weights = self.weights();
        (0..self.contenders.len()).map(|contender| self.profile(contender, &weights)).collect()
    }

    fn profile(&self, contender: usize, weights: &[f64]) -> Profile {
        let ratios = self.rows.iter().map(|row| row.ratio(contender));
        let reached: Vec<(f64, f64)> =
            ratios.zip(weights).filter_map(|(ratio, weight)| Some((ratio?, *weight))).collect();
        let mut taus: Vec<f64> = TAUS.into_iter().chain(reached.iter().map(|(ratio, _)| *ratio)).collect();
        taus.sort_by(f64::total_cmp);
        taus.dedup();
        let share = |tau: f64| {
            // From a positive zero: the sum of nothing would be a negative one.
            reached.iter().filter(|(ratio, _)| *ratio <= tau).fold(0.0, |sum, (_, weight)| sum + weight)
        };
        let steps = taus.into_iter().map(|tau| (tau, share(tau).min(1.0))).collect();
        Profile { contender: self.contenders[contender].clone(), steps }
    }

    /// The contenders by their score, the best first; of equals the one that arrives more often, then the one that is more
    /// often the fastest, then the one that comes first. Shares are sums of weights: equal to round-off is equal.
    pub fn ranked(&self) -> Vec<Choice> {
        let choice = |profile: Profile| {
            let fastest = profile.share(1.0);
            let choice = Choice {
                reached: profile.steps.last().map_or(0.0, |(_, share)| *share),
                within_two: profile.share(NEARLY),
                method: profile.contender,
            };
            let rank = [choice.score(), choice.reached, fastest].map(|share| (1e9 * share).round());
            (rank, choice)
        };
        let mut all: Vec<([f64; 3], Choice)> = self.profiles().into_iter().map(choice).collect();
        all.sort_by(|(a, _), (b, _)| b.partial_cmp(a).unwrap_or(Ordering::Equal));
        all.into_iter().map(|(_, choice)| choice).collect()
    }

    /// The contender to take; none where nobody arrives anywhere.
    pub fn best(&self) -> Option<Choice> {
        self.ranked().into_iter().next().filter(|best| best.reached > 0.0)
    }

    /// The situations in which a contender does not arrive.
    pub fn missed(&self, contender: &str) -> Vec<&str> {
        let Some(place) = self.contenders.iter().position(|name| name == contender) else {
            return Vec::new();
        };
        self.rows.iter().filter(|row| row.costs[place].is_none()).map(|row| row.situation.as_str()).collect()
    }
}

impl CostRow {
    /// Cost of a contender over the least, 1 for a tie; `None` where it does not arrive.
    pub fn ratio(&self, contender: usize) -> Option<f64> {
        let least = self.costs.iter().copied().flatten().min_by(f64::total_cmp)?;
        let ratio = self.costs[contender]? / least;
        Some(if ratio <= TIE { 1.0 } else { ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEVER: f64 = f64::INFINITY;

    /// Three contenders; the family is the first letter of a situation.
    fn table(rows: &[(&str, [f64; 3])]) -> CostTable {
        let row = |(situation, costs): &(&str, [f64; 3])| CostRow {
            family: situation[..1].to_owned(),
            situation: (*situation).to_owned(),
            costs: costs.map(|cost| cost.is_finite().then_some(cost)).to_vec(),
        };
        CostTable {
            contenders: ["a", "b", "c"].map(str::to_owned).to_vec(),
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn a_profile_is_the_share_of_families_within_a_multiple_of_the_best() {
        // Two near-duplicates in family p weigh as much as one situation in q.
        let table = table(&[("p1", [1.0, 1.05, 3.0]), ("p2", [1.0, 1.5, NEVER]), ("q", [40.0, NEVER, 10.0])]);
        let shares = |contender: usize| {
            let profile = &table.profiles()[contender];
            [0.99, 1.0, 1.3, 2.0, 3.0, 5.0, 1e9].map(|tau| profile.share(tau))
        };
        assert_eq!(shares(0), [0.0, 0.5, 0.5, 0.5, 0.5, 1.0, 1.0]);
        assert_eq!(shares(1), [0.0, 0.25, 0.25, 0.5, 0.5, 0.5, 0.5], "1.05 times the best is a tie");
        assert_eq!(shares(2), [0.0, 0.5, 0.5, 0.5, 0.75, 0.75, 0.75]);
        let profile = &table.profiles()[1];
        assert_eq!(profile.steps[..4], [(1.0, 0.25), (1.3, 0.25), (1.5, 0.5), (2.0, 0.5)]);
        // Scores: a (1 + 0.5)/2, b (0.5 + 0.5)/2, c (0.75 + 0.5)/2.
        let order: Vec<String> = table.ranked().into_iter().map(|one| one.method).collect();
        assert_eq!(order, ["a", "c", "b"]);
        assert_eq!(table.missed("c"), ["p2"]);
        // Without a the best is taken among the others.
        let rest = table.only(|name| name != "a");
        assert_eq!(rest.profiles()[0].steps[0], (1.0, 0.5));
        assert_eq!(rest.best(), Some(Choice { method: "c".to_owned(), reached: 0.75, within_two: 0.5 }));
        assert_eq!(
            table.of_families(|family| family == "p").best().map(|one| one.method),
            Some("a".to_owned())
        );
    }

    #[test]
    fn where_nobody_arrives_nobody_is_taken() {
        let none = table(&[("p", [NEVER; 3])]);
        assert_eq!(none.best(), None);
        assert_eq!(none.profiles()[0].share(1e9), 0.0);
        assert_eq!(table(&[]).best(), None);
        // A situation in which nobody arrives counts for the share of all.
        let half = table(&[("p", [NEVER; 3]), ("q", [1.0, 2.0, 2.1])]);
        assert_eq!(half.best(), Some(Choice { method: "a".to_owned(), reached: 0.5, within_two: 0.5 }));
        assert_eq!(half.profiles()[1].share(2.0), 0.5);
        // Of equal scores the one that arrives more often: b 1 and 0, a twice 0.5.
        let tied = table(&[("p", [1.0, 5.0, NEVER]), ("q", [NEVER, 5.0, 1.0])]);
        assert_eq!(tied.best(), Some(Choice { method: "b".to_owned(), reached: 1.0, within_two: 0.0 }));
        assert_eq!(half.profiles()[2].share(2.0), 0.0);
        // Of equal scores and arrivals the faster: both within twice, b the first.
        let close = table(&[("p", [1.5, 1.0, NEVER]), ("q", [1.5, 1.0, NEVER])]);
        assert_eq!(close.best().map(|best| best.method), Some("b".to_owned()));
    }
}
