//! Performance profiles (Dolan & Moré 2002) of a table of costs, and the methods to take by them. Families of situations weigh
//! the same, and so do the situations of a family.

/// Multiple of the least cost up to which a method is nearly as good as the cheapest.
pub const NEARLY: f64 = 2.0;
/// Multiples of the least cost at which every profile has a value.
pub const TAUS: [f64; 7] = [1.0, 1.3, 2.0, 5.0, 10.0, 100.0, 1000.0];
/// Sums of two shares that differ by less are a tie.
pub const TIE: f64 = 0.03;
/// Resamples of a bootstrap, and how many of them lie below an interval, and above it: a twentieth.
const RESAMPLES: usize = 2000;
const OUTSIDE: usize = RESAMPLES / 20;

/// Costs of every method in one situation.
#[derive(Clone, Debug, PartialEq)]
pub struct CostRow {
    /// Its family.
    pub family: String,
    /// Per method; `None` where it does not reach the tolerance.
    pub costs: Vec<Option<f64>>,
}

/// Costs of every method in every situation of a group, on the same terms.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CostTable {
    /// The methods.
    pub methods: Vec<String>,
    /// The situations.
    pub rows: Vec<CostRow>,
}

/// The profile of a method: a staircase.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The method.
    pub method: String,
    /// Multiples of the least cost with the share of situations in which it reaches the tolerance within each, rising.
    pub steps: Vec<(f64, f64)>,
}

/// What a method is chosen by.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// The method.
    pub method: String,
    /// Situations in which it reaches the tolerance.
    pub count: usize,
    /// Their share, families weighing the same.
    pub reached: f64,
    /// Share in which it reaches the tolerance within twice the least cost.
    pub within_two: f64,
    /// Nine tenths of the resampled shares of both kinds lie between these.
    pub intervals: [[f64; 2]; 2],
}

impl Shares {
    /// The criterion: a method that always reaches it at great cost is no better than one that sometimes does not.
    pub fn sum(&self) -> f64 {
        self.reached + self.within_two
    }

    /// Whether the situations do not tell it from another: intervals of both shares overlap.
    pub fn is_like(&self, other: &Self) -> bool {
        self.intervals.iter().zip(&other.intervals).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1])
    }
}

impl CostTable {
    fn weights(rows: &[&CostRow]) -> Vec<f64> {
        let mut families: Vec<&str> = rows.iter().map(|row| row.family.as_str()).collect();
        families.sort_unstable();
        families.dedup();
        let alike = |row: &&CostRow| rows.iter().filter(|other| other.family == row.family).count() as f64;
        rows.iter().map(|row| 1.0 / (families.len() as f64 * alike(row))).collect()
    }

    /// Share of rows in which a method reaches the tolerance within a multiple of the least cost; from a positive zero, for the sum of
    /// nothing would be a negative one.
    fn share(rows: &[&CostRow], weights: &[f64], method: usize, tau: f64) -> f64 {
        let is_in = |row: &CostRow| row.ratio(method).is_some_and(|ratio| ratio <= tau);
        let weighed = rows.iter().zip(weights).filter(|(row, _)| is_in(row));
        weighed.fold(0.0, |sum, (_, weight)| sum + weight).min(1.0)
    }

    /// The profile of every method.
    pub fn profiles(&self) -> Vec<Profile> {
        let rows: Vec<&CostRow> = self.rows.iter().collect();
        let weights = Self::weights(&rows);
        let profile = |method: usize| {
            let ratios = rows.iter().filter_map(|row| row.ratio(method));
            let mut taus: Vec<f64> = TAUS.into_iter().chain(ratios).collect();
            taus.sort_by(f64::total_cmp);
            taus.dedup();
            let steps = taus.into_iter().map(|tau| (tau, Self::share(&rows, &weights, method, tau)));
            Profile { method: self.methods[method].clone(), steps: steps.collect() }
        };
        (0..self.methods.len()).map(profile).collect()
    }

    /// Both shares of every method: all that reach the tolerance, and within twice the least cost.
    fn both(rows: &[&CostRow], methods: usize) -> Vec<[f64; 2]> {
        let weights = Self::weights(rows);
        let shares = |method| [f64::INFINITY, NEARLY].map(|tau| Self::share(rows, &weights, method, tau));
        (0..methods).map(shares).collect()
    }

    /// The methods by the sum of both shares, the largest first, of equals the one that comes first.
    pub fn ranked(&self) -> Vec<Shares> {
        let methods = self.methods.len();
        let resampled: Vec<Vec<[f64; 2]>> = resamples(self.rows.len())
            .map(|places| {
                Self::both(&places.iter().map(|place| &self.rows[*place]).collect::<Vec<_>>(), methods)
            })
            .collect();
        let interval = |method: usize, kind: usize| {
            let mut shares: Vec<f64> = resampled.iter().map(|one| one[method][kind]).collect();
            shares.sort_by(f64::total_cmp);
            [OUTSIDE, RESAMPLES - 1 - OUTSIDE].map(|place| shares[place])
        };
        let of_method = |(method, [reached, within_two]): (usize, [f64; 2])| Shares {
            method: self.methods[method].clone(),
            count: self.rows.iter().filter(|row| row.costs[method].is_some()).count(),
            reached,
            within_two,
            intervals: [0, 1].map(|kind| interval(method, kind)),
        };
        let both = Self::both(&self.rows.iter().collect::<Vec<_>>(), methods);
        let mut all: Vec<Shares> = both.into_iter().enumerate().map(of_method).collect();
        // Equal to round-off is equal.
        let rank = |one: &Shares| (1e9 * one.sum()).round();
        all.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        all
    }

    /// The names of the methods to take: the best and those that tie with it; none where no method reaches the tolerance.
    pub fn best(&self) -> Vec<&str> {
        let both = Self::both(&self.rows.iter().collect::<Vec<_>>(), self.methods.len());
        let sums: Vec<f64> = both.iter().map(|[reached, within_two]| reached + within_two).collect();
        let largest = sums.iter().copied().fold(0.0, f64::max);
        let is_best = |sum: f64| largest > 0.0 && sum >= largest - TIE - 1e-9;
        self.methods
            .iter()
            .zip(sums)
            .filter(|(_, sum)| is_best(*sum))
            .map(|(name, _)| name.as_str())
            .collect()
    }
}

impl CostRow {
    /// Cost of a method over the least; `None` where it does not reach the tolerance.
    pub fn ratio(&self, method: usize) -> Option<f64> {
        let least = self.costs.iter().copied().flatten().min_by(f64::total_cmp)?;
        Some(self.costs[method]? / least)
    }
}

/// Places drawn with replacement, the same on every machine (splitmix64).
fn resamples(count: usize) -> impl Iterator<Item = Vec<usize>> {
    let mut state = 0_u64;
    let mut draw = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((mixed ^ (mixed >> 31)) % count.max(1) as u64).unwrap_or(0)
    };
    (0..RESAMPLES).map(move |_| (0..count).map(|_| draw()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEVER: f64 = f64::INFINITY;

    /// Three methods; the family is the first letter of a situation.
    fn table(rows: &[(&str, [f64; 3])]) -> CostTable {
        let row = |(situation, costs): &(&str, [f64; 3])| CostRow {
            family: situation[..1].to_owned(),
            costs: costs.map(|cost| cost.is_finite().then_some(cost)).to_vec(),
        };
        CostTable {
            methods: ["a", "b", "c"].map(str::to_owned).to_vec(),
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn a_profile_is_the_share_of_families_within_a_multiple_of_the_least_cost() {
        // Two near-duplicates in family p weigh as much as one situation in q.
        let table = table(&[("p1", [1.0, 1.05, 3.0]), ("p2", [1.0, 1.5, NEVER]), ("q", [40.0, NEVER, 10.0])]);
        let steps = |method: usize| table.profiles()[method].steps.clone();
        let share = |method: usize, tau: f64| {
            steps(method).iter().take_while(|one| one.0 <= tau).last().map(|one| one.1)
        };
        assert_eq!([1.0, 2.0, 4.0, 1e9].map(|tau| share(0, tau)), [0.5, 0.5, 1.0, 1.0].map(Some));
        assert_eq!([1.0, 1.05, 1.5, 1e9].map(|tau| share(1, tau)), [0.0, 0.25, 0.5, 0.5].map(Some));
        // Sums: a 1 + 0.5, b 0.5 + 0.5, c 0.75 + 0.5.
        let told: Vec<(String, usize, f64)> =
            table.ranked().into_iter().map(|one| (one.method.clone(), one.count, one.sum())).collect();
        assert_eq!(
            told,
            [("a", 3, 1.5), ("c", 2, 1.25), ("b", 2, 1.0)].map(|one| (one.0.to_owned(), one.1, one.2))
        );
        assert_eq!(table.best().len(), 1);
    }

    #[test]
    fn equals_are_all_named_and_where_nobody_arrives_nobody_is() {
        assert!(table(&[("p", [NEVER; 3])]).best().is_empty() && table(&[]).best().is_empty());
        // A situation in which no method reaches the tolerance counts for the share of all.
        let half = table(&[("p", [NEVER; 3]), ("q", [1.0, 2.0, 2.1])]);
        assert_eq!(half.best(), ["a", "b"]);
        let [a, b, c] = &half.ranked()[..] else { panic!("three methods") };
        // Drawn twice from two: nothing, half, or all.
        assert_eq!((a.intervals, c.intervals[1]), ([[0.0, 1.0]; 2], [0.0, 0.0]));
        assert!(a.is_like(b) && a.is_like(c));
        let clear = table(&[("p", [1.0, NEVER, NEVER]), ("q", [1.0, 2.0, NEVER])]).ranked();
        assert!(!clear[0].is_like(&clear[2]));
    }
}
