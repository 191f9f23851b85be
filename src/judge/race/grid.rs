//! Scores of contenders in situations: ratios to the best, ranks, and conclusions. Numbers only.
//!
//! Scores of different situations have no common unit, so that only ranks and ratios are compared. Scores that differ by
//! less than their scatter are equal.

/// Relative difference up to which two scores are equal, whatever their scatter.
const TIE: f64 = 0.02;
/// Scores below this are round-off and equal.
const ROUND_OFF: f64 = 1e-9;
/// Ratio to the best up to which a contender is nearly as good.
const NEARLY: f64 = 2.0;

/// The score of a contender in a situation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Score {
    /// Smaller is better.
    Value {
        /// The score, positive.
        value: f64,
        /// Its relative scatter.
        scatter: f64,
    },
    /// There is no usable result.
    Failed,
    /// The method cannot do it by its definition.
    NotApplicable,
}

/// One situation.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRow {
    /// Its name.
    pub situation: String,
    /// Its group.
    pub group: String,
    /// One score per contender.
    pub scores: Vec<Score>,
}

/// Every contender in every situation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Names of the contenders.
    pub contenders: Vec<String>,
    /// The situations.
    pub rows: Vec<GridRow>,
}

/// A contender over several situations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overall {
    /// The contender, by its place.
    pub contender: usize,
    /// Situations that it gives no usable result in, or cannot run in.
    pub without: usize,
    /// Largest ratio to the best of a situation, among those with a result.
    pub worst_ratio: f64,
    /// The situation of that ratio, by its place.
    pub worst_at: Option<usize>,
    /// Situations in which it is within a factor of two of the best.
    pub nearly_best: usize,
    /// Mean of its ranks over the situations that it can run in; the last rank where it failed.
    pub mean_rank: f64,
    /// The situations that the rank rests on.
    pub ranked_in: usize,
}

impl GridRow {
    fn value(&self, contender: usize) -> Option<(f64, f64)> {
        match self.scores[contender] {
            Score::Value { value, scatter } => Some((value.abs().max(ROUND_OFF), scatter)),
            _ => None,
        }
    }

    /// Whether one contender is better than another by more than both scatter.
    fn is_better(&self, one: usize, other: usize) -> bool {
        match (self.value(one), self.value(other)) {
            (Some((own, scatter)), Some((theirs, their_scatter))) => {
                own * (1.0 + TIE.max(scatter + their_scatter)) < theirs
            }
            (one, other) => one.is_some() && other.is_none(),
        }
    }

    /// The contender with the smallest score.
    pub fn best(&self) -> Option<usize> {
        let values = (0..self.scores.len()).filter_map(|one| Some((one, self.value(one)?.0)));
        values.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(one, _)| one)
    }

    /// Ratio of a contender's score to the best, 1 where they are tied; `None` without a score.
    pub fn ratio(&self, contender: usize) -> Option<f64> {
        let best = self.best()?;
        let (own, least) = (self.value(contender)?.0, self.value(best)?.0);
        Some(if self.is_better(best, contender) { own / least } else { 1.0 })
    }

    /// Rank from 1, shared by ties; `None` where the contender cannot run.
    pub fn rank(&self, contender: usize) -> Option<usize> {
        if self.scores[contender] == Score::NotApplicable {
            return None;
        }
        let others = (0..self.scores.len()).filter(|other| self.scores[*other] != Score::NotApplicable);
        Some(1 + others.filter(|other| self.is_better(*other, contender)).count())
    }
}

impl Grid {
    /// A contender over the situations at some places.
    pub fn overall(&self, contender: usize, places: &[usize]) -> Overall {
        let mut found = Overall {
            contender,
            without: 0,
            worst_ratio: 1.0,
            worst_at: None,
            nearly_best: 0,
            mean_rank: f64::INFINITY,
            ranked_in: 0,
        };
        let mut ranks = 0;
        for place in places {
            let row = &self.rows[*place];
            let ratio = row.ratio(contender);
            found.without += usize::from(ratio.is_none());
            found.nearly_best += usize::from(ratio.is_some_and(|ratio| ratio <= NEARLY));
            if let Some(ratio) = ratio.filter(|ratio| found.worst_at.is_none() || *ratio > found.worst_ratio)
            {
                (found.worst_ratio, found.worst_at) = (ratio, Some(*place));
            }
            if let Some(rank) = row.rank(contender) {
                ranks += rank;
                found.ranked_in += 1;
            }
        }
        if found.ranked_in > 0 {
            found.mean_rank = ranks as f64 / found.ranked_in as f64;
        }
        found
    }

    /// Places of all situations.
    pub fn everywhere(&self) -> Vec<usize> {
        (0..self.rows.len()).collect()
    }

    /// The contenders by their mean rank, the best first; of equals the one with the smaller worst ratio.
    pub fn by_rank(&self) -> Vec<Overall> {
        let places = self.everywhere();
        let mut all: Vec<Overall> =
            (0..self.contenders.len()).map(|one| self.overall(one, &places)).collect();
        all.sort_by(|a, b| a.mean_rank.total_cmp(&b.mean_rank).then(a.worst_ratio.total_cmp(&b.worst_ratio)));
        all
    }

    /// The one to take for some situations if there may be only one: the fewest situations without a result, then the
    /// smallest worst ratio, then the best mean rank.
    pub fn one_for(&self, places: &[usize]) -> Option<Overall> {
        let all = (0..self.contenders.len()).map(|one| self.overall(one, places));
        all.filter(|one| one.without < places.len()).min_by(|a, b| {
            let ratios = a.worst_ratio.total_cmp(&b.worst_ratio);
            a.without.cmp(&b.without).then(ratios).then(a.mean_rank.total_cmp(&b.mean_rank))
        })
    }

    /// The groups in their order, each with the places of its situations.
    pub fn groups(&self) -> Vec<(&str, Vec<usize>)> {
        let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
        for (place, row) in self.rows.iter().enumerate() {
            match groups.iter_mut().find(|(known, _)| *known == row.group) {
                Some((_, places)) => places.push(place),
                None => groups.push((&row.group, vec![place])),
            }
        }
        groups
    }

    /// The situations without which another contender would be the one to take, with that contender.
    pub fn deciding_situations(&self) -> Vec<(usize, usize)> {
        let all = self.everywhere();
        let winner = self.one_for(&all).map(|one| one.contender);
        let without = |place: &usize| {
            let rest: Vec<usize> = all.iter().copied().filter(|other| other != place).collect();
            let other = self.one_for(&rest)?.contender;
            (Some(other) != winner).then_some((*place, other))
        };
        all.iter().filter_map(without).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAILED: f64 = f64::INFINITY;
    const NEVER: f64 = f64::NAN;

    /// A grid of three contenders; each score scatters by a tenth.
    fn grid(rows: &[[f64; 3]]) -> Grid {
        let score = |value: &f64| match *value {
            value if value.is_nan() => Score::NotApplicable,
            value if value.is_infinite() => Score::Failed,
            value => Score::Value { value, scatter: 0.1 },
        };
        let row = |(place, scores): (usize, &[f64; 3])| GridRow {
            situation: format!("s{place}"),
            group: if place < 2 { "early".to_owned() } else { "late".to_owned() },
            scores: scores.iter().map(score).collect(),
        };
        Grid {
            contenders: ["a", "b", "c"].map(str::to_owned).to_vec(),
            rows: rows.iter().enumerate().map(row).collect(),
        }
    }

    #[test]
    fn ties_share_a_rank_and_what_cannot_run_has_none() {
        let grid = grid(&[[0.10, 0.11, 0.30], [0.1, FAILED, NEVER], [1e-15, 4e-14, 2.0]]);
        let ranks = |place: usize| [0, 1, 2].map(|one| grid.rows[place].rank(one));
        assert_eq!(ranks(0), [Some(1), Some(1), Some(3)]);
        assert_eq!(ranks(1), [Some(1), Some(2), None]);
        assert_eq!(ranks(2), [Some(1), Some(1), Some(3)], "round-off is round-off");
        assert_eq!(
            [0, 1, 2].map(|one| grid.rows[0].ratio(one).map(f64::round)),
            [Some(1.0), Some(1.0), Some(3.0)]
        );
        assert_eq!(grid.rows[1].ratio(1), None);
        assert_eq!(grid.groups(), [("early", vec![0, 1]), ("late", vec![2])]);
    }

    #[test]
    fn the_one_to_take_has_a_result_everywhere_before_it_is_ever_best() {
        let of = |rows: &[[f64; 3]]| grid(rows).one_for(&grid(rows).everywhere()).map(|one| one.contender);
        assert_eq!(of(&[[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]), Some(0));
        // `a` fails once, `b` cannot run once: `c` is left, for all that it is never best.
        assert_eq!(of(&[[FAILED, 1.0, 9.0], [1.0, NEVER, 9.0]]), Some(2));
        // Nobody has a result everywhere: of those that fail once the smallest worst ratio.
        assert_eq!(of(&[[FAILED, 1.0, 3.0], [1.0, 4.0, FAILED], [1.0, FAILED, 3.0]]), Some(0));
        assert_eq!(of(&[[FAILED, FAILED, NEVER]]), None);
        let overall = grid(&[[1.0, 2.0, 3.0], [1.0, 8.0, 1.0]]).overall(1, &[0, 1]);
        assert_eq!((overall.nearly_best, overall.worst_at, overall.worst_ratio), (1, Some(1), 8.0));
        assert_eq!((overall.mean_rank, overall.ranked_in), (2.5, 2));
    }

    #[test]
    fn a_situation_that_decides_is_named_with_the_winner_without_it() {
        // `a` wins by the last row alone.
        let decided = grid(&[[2.0, 1.0, 9.0], [2.0, 1.0, 9.0], [1.0, 5.0, 9.0]]);
        assert_eq!(decided.one_for(&decided.everywhere()).map(|one| one.contender), Some(0));
        assert_eq!(decided.deciding_situations(), [(2, 1)]);
        assert_eq!(grid(&[[1.0, 5.0, 9.0], [1.0, 5.0, 9.0]]).deciding_situations(), []);
    }

    #[test]
    fn what_differs_by_less_than_two_percent_is_equal_and_twice_the_best_is_nearly_as_good() {
        let exact = |values: [f64; 3]| GridRow {
            scores: values.map(|value| Score::Value { value, scatter: 0.0 }).to_vec(),
            ..grid(&[[1.0; 3]]).rows.remove(0)
        };
        let row = exact([1.019, 1.0, 1.021]);
        assert_eq!((row.best(), [0, 1, 2].map(|one| row.rank(one))), (Some(1), [Some(1), Some(1), Some(2)]));
        assert_eq!([0, 1, 2].map(|one| row.ratio(one)), [Some(1.0), Some(1.0), Some(1.021)]);
        // The sum of both scatters counts: 1 and 1.21 are apart, 1 and 1.19 are not.
        let scattered = grid(&[[1.0, 1.19, 1.21]]);
        assert_eq!([0, 1, 2].map(|one| scattered.rows[0].rank(one)), [Some(1), Some(1), Some(2)]);
        let nearly = Grid { rows: vec![exact([1.0, 2.0, 2.001]); 2], ..grid(&[]) };
        assert_eq!([0, 1, 2].map(|one| nearly.overall(one, &[0, 1]).nearly_best), [2, 2, 0]);
        assert_eq!(nearly.overall(2, &[1]).worst_at, Some(1));
        // Of equal ranks the smaller worst ratio, and of equal ratios the better rank, wherever they stand.
        let turned = grid(&[[9.0, 1.0, 3.0], [1.0, 3.0, 2.0], [NEVER, 2.0, 1.0]]);
        let order: Vec<usize> = turned.by_rank().iter().map(|one| one.contender).collect();
        assert_eq!(order, [2, 1, 0]);
        assert_eq!(
            grid(&[[2.0, 3.0, 1.0], [3.0, 1.0, 3.0]]).one_for(&[0, 1]).map(|one| one.contender),
            Some(2)
        );
        let never = grid(&[[NEVER, FAILED, 1.0]]);
        let of = |one: usize| (never.overall(one, &[0]).without, never.overall(one, &[0]).mean_rank);
        assert_eq!([of(0), of(1), of(2)], [(1, f64::INFINITY), (1, 2.0), (0, 1.0)]);
    }
}
