//! What of one result contradicts itself: two states closer in time than any step, two runs at places of their own, times that
//! go back.
//!
//! All of it is judged on rows in the order in which they were read, so that tables, curves, arrays and lists of files follow
//! the same rules.

use crate::import::origins::Origins;
use crate::import::samples::{SAME_PLACE, SAME_VALUE, SampleRow};
use oedometer_wording::typed;
use std::collections::HashMap;

/// Largest relative distance of two states that may stand for one requested time.
const NEAR: f64 = 1e-3;
/// Share of the step beside it below which a distance in time is none between steps.
const NO_STEP: f64 = 0.1;
/// Relative change of a quantity per relative change of time: consolidation stays below 0.5 of its scale.
const RATE: f64 = 10.0;
/// Multiple of the rate of change beside two states that their own may have: waves turn round.
const RATE_BESIDE: f64 = 3.0;
/// Multiple of their own roughness by which samples may be off the profile of others.
const ROUGHNESS: f64 = 2.0;
/// Fewest samples that are a profile.
const PROFILE: usize = 3;
/// Most contradictions that are told of a result.
const MOST: usize = 4;

/// A place of a kind of samples, rounded.
type Place = (u8, u64, u64);

/// How two states differ.
enum Difference {
    /// By no more than the time between them explains; or by nothing.
    Explained { are_equal: bool },
    /// By more, in a sentence.
    Contradiction(String),
}

/// All rows of a result by time.
pub struct Course<'a> {
    rows: &'a [SampleRow],
    /// Rows of each time, in rising order; times that differ by round-off are one.
    pub instants: Vec<Vec<usize>>,
    origins: &'a Origins,
    /// Largest size of each quantity.
    scales: [f64; 4],
    /// Step to which places are rounded, m.
    step: f64,
    /// The rows in the order of their source, and the place of each in it.
    order: Vec<usize>,
    rank: Vec<usize>,
}

impl<'a> Course<'a> {
    /// The course of rows, with the places of those of each time in the list.
    pub fn new(rows: &'a [SampleRow], instants: Vec<Vec<usize>>, origins: &'a Origins) -> Self {
        let largest = |value: &dyn Fn(&SampleRow) -> f64| {
            rows.iter().map(|row| value(row).abs()).filter(|size| size.is_finite()).fold(0.0, f64::max)
        };
        let scales = [0, 1, 2, 3].map(|quantity| largest(&|row| row.values()[quantity]));
        let extent = largest(&|row| row.initial_height).max(largest(&|row| row.initial_distance));
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by_key(|at| rows[*at].origin);
        let mut rank = vec![0; rows.len()];
        order.iter().enumerate().for_each(|(place, at)| rank[*at] = place);
        Self { rows, instants, origins, scales, step: SAME_PLACE * extent, order, rank }
    }

    /// Leaves out states that repeat another one, and returns a sentence for each contradiction.
    pub fn settle(&mut self) -> Vec<String> {
        let mut sentences = self.near_states();
        sentences.extend(self.mixed_runs());
        if sentences.is_empty() {
            sentences.extend(self.times_that_go_back());
        }
        sentences.truncate(MOST);
        sentences
    }

    fn time(&self, instant: usize) -> f64 {
        self.rows[self.instants[instant][0]].time
    }

    /// Pairs of states closer in time than a step: equal ones become one, others are told.
    fn near_states(&mut self) -> Vec<String> {
        let count = self.instants.len();
        let gap = |at: usize| (at + 1 < count).then(|| self.time(at + 1) - self.time(at));
        let is_near = |at: &usize| {
            let own = self.time(at + 1) - self.time(*at);
            let widest =
                [at.checked_sub(1).and_then(gap), gap(at + 1)].into_iter().flatten().reduce(f64::max);
            own <= NEAR * self.time(at + 1) && widest.is_none_or(|widest| own <= NO_STEP * widest)
        };
        let near: Vec<usize> = (0..count.saturating_sub(1)).filter(is_near).collect();
        let (mut sentences, mut repeated) = (Vec::new(), Vec::new());
        for at in near {
            let [first, second] = [at, at + 1].map(|at| self.time(at));
            let (share, rates) = ((second - first) / second, self.rates_beside(at));
            let allowed = [0, 1, 2, 3].map(|quantity| {
                let scale = self.scales[quantity];
                let beside = RATE_BESIDE * rates[quantity] * (second - first);
                (RATE * share * scale).max(beside) + SAME_VALUE * scale
            });
            match self.difference(&self.instants[at], &self.instants[at + 1], allowed) {
                Difference::Explained { are_equal } => repeated.extend(are_equal.then_some(at + 1)),
                Difference::Contradiction(values) => sentences.push(format!(
                    "two states have the same time, t = {} s and {} s, and contradict each other{values}: \
                     keep the right run",
                    typed(first),
                    typed(second),
                )),
            }
        }
        for at in repeated.into_iter().rev() {
            self.instants.remove(at);
        }
        sentences
    }

    /// How fast each quantity changes from the state before two, and to the one after them.
    fn rates_beside(&self, at: usize) -> [f64; 4] {
        let mut rates = [0.0_f64; 4];
        let pairs = [at.checked_sub(1).map(|before| [before, at]), Some([at + 1, at + 2])];
        for [one, other] in pairs.into_iter().flatten().filter(|pair| pair[1] < self.instants.len()) {
            let [before, after] = [one, other].map(|at| self.by_place(&self.instants[at]));
            let step = self.time(other) - self.time(one);
            for (place, rows) in &before {
                let Some(later) = after.get(place) else { continue };
                for (quantity, rate) in rates.iter_mut().enumerate() {
                    let change = self.apart(quantity, rows, later).map_or(0.0, |(change, _)| change);
                    *rate = rate.max(change / step);
                }
            }
        }
        rates
    }

    /// The rows of a state by their rounded place.
    fn by_place(&self, rows: &[usize]) -> HashMap<Place, Vec<usize>> {
        let rounded = |at: f64| if self.step > 0.0 { (at / self.step).round() + 0.0 } else { at + 0.0 };
        let mut places: HashMap<Place, Vec<usize>> = HashMap::new();
        for at in rows {
            let SampleRow { set, initial_height, initial_distance, .. } = &self.rows[*at];
            let place = (set.0, rounded(*initial_height).to_bits(), rounded(*initial_distance).to_bits());
            places.entry(place).or_default().push(*at);
        }
        places
    }

    /// How far apart the values of two lists of rows lie, as ranges, and the rows at the ends that face each other.
    fn apart(&self, quantity: usize, one: &[usize], other: &[usize]) -> Option<(f64, [usize; 2])> {
        let value = |at: &usize| self.rows[*at].values()[quantity];
        let there = |rows: &[usize]| -> Option<[usize; 2]> {
            let mut sorted: Vec<usize> = rows.iter().copied().filter(|at| !value(at).is_nan()).collect();
            sorted.sort_by(|a, b| value(a).total_cmp(&value(b)));
            Some([*sorted.first()?, *sorted.last()?])
        };
        let ([least, most], [other_least, other_most]) = (there(one)?, there(other)?);
        let (above, below) = (value(&other_least) - value(&most), value(&least) - value(&other_most));
        Some(if above >= below {
            (above.max(0.0), [most, other_least])
        } else {
            (below.max(0.0), [least, other_most])
        })
    }

    /// How two states differ beyond what is allowed for each quantity; states without a common place are compared as profiles.
    fn difference(&self, one: &[usize], other: &[usize], allowed: [f64; 4]) -> Difference {
        let [before, after] = [one, other].map(|rows| self.by_place(rows));
        let common: Vec<(&Vec<usize>, &Vec<usize>)> =
            before.iter().filter_map(|(place, rows)| Some((rows, after.get(place)?))).collect();
        if 2 * common.len() < before.len().min(after.len()) {
            let misfit = (0..4).find_map(|quantity| self.misfit(quantity, one, other, allowed[quantity]));
            return misfit.map_or(Difference::Explained { are_equal: false }, |misfit| {
                Difference::Contradiction(format!(": {misfit}"))
            });
        }
        let mut are_equal = before.len() == common.len() && after.len() == common.len();
        let mut worst: Option<(f64, usize, [usize; 2])> = None;
        for quantity in 0..4 {
            for (rows, later) in &common {
                let Some((apart, ends)) = self.apart(quantity, rows, later) else { continue };
                are_equal &= apart <= SAME_VALUE * self.scales[quantity];
                let times_allowed = apart / allowed[quantity];
                if apart > allowed[quantity] && worst.is_none_or(|(known, ..)| times_allowed > known) {
                    worst = Some((times_allowed, quantity, ends));
                }
            }
        }
        match worst {
            Some((_, quantity, ends)) => Difference::Contradiction(format!(
                " at {}",
                self.origins.two_values(quantity, ends.map(|at| &self.rows[at]))
            )),
            None => Difference::Explained { are_equal },
        }
    }

    /// Runs of one time that were read apart from each other and do not lie on one profile.
    fn mixed_runs(&self) -> Vec<String> {
        let mut instant_of = vec![usize::MAX; self.rows.len()];
        for (instant, rows) in self.instants.iter().enumerate() {
            for at in rows {
                instant_of[*at] = instant;
            }
        }
        let mut passes: Vec<Vec<Vec<usize>>> = vec![Vec::new(); self.instants.len()];
        let mut before = None;
        for at in self.order.iter().copied() {
            let Some(of_time) = passes.get_mut(instant_of[at]) else { continue };
            let own = Some((instant_of[at], self.rows[at].origin.part));
            match of_time.last_mut().filter(|_| before == own) {
                Some(pass) => pass.push(at),
                None => of_time.push(vec![at]),
            }
            before = own;
        }
        let of_time = |(instant, mut passes): (usize, Vec<Vec<usize>>)| {
            passes.retain(|pass| pass.len() >= PROFILE);
            let first = passes.first()?;
            let misfit = passes[1..].iter().find_map(|pass| {
                (0..4).find_map(|quantity| {
                    self.misfit(quantity, first, pass, SAME_VALUE * self.scales[quantity])
                })
            })?;
            let time = typed(self.time(instant));
            Some(format!(
                "at t = {time} s it holds two runs: {misfit}, and no single profile fits both: keep the right run"
            ))
        };
        passes.into_iter().enumerate().filter_map(of_time).collect()
    }

    /// The samples of a quantity by height, where a column's fields depend on nothing else; rows at one height are one.
    fn profile(&self, quantity: usize, rows: &[usize]) -> Vec<(f64, f64, usize)> {
        let is_sample = |at: &&usize| {
            let row = &self.rows[**at];
            row.initial_distance.is_nan()
                && row.set.0 == self.rows[rows[0]].set.0
                && !row.values()[quantity].is_nan()
        };
        let sample = |at: &usize| (self.rows[*at].initial_height, self.rows[*at].values()[quantity], *at);
        let mut samples: Vec<(f64, f64, usize)> = rows.iter().filter(is_sample).map(sample).collect();
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        let of_height = samples.chunk_by(|a, b| b.0 - a.0 <= self.step);
        of_height
            .map(|same| (same[0].0, same.iter().map(|one| one.1).sum::<f64>() / same.len() as f64, same[0].2))
            .collect()
    }

    /// The sample of a second profile that is farthest off a first one, with the one beside it, where they differ by more than
    /// the roughness of either and what is allowed.
    fn misfit(&self, quantity: usize, one: &[usize], other: &[usize], allowed: f64) -> Option<String> {
        let [first, second] = [one, other].map(|rows| self.profile(quantity, rows));
        let between = |at: f64, [(from, low, _), (to, high, _)]: [(f64, f64, usize); 2]| {
            low + (high - low) * (at - from) / (to - from)
        };
        let roughness = |samples: &[(f64, f64, usize)]| {
            mean_square(
                samples.windows(3).map(|three| three[1].1 - between(three[1].0, [three[0], three[2]])),
            )
        };
        let off: Vec<(f64, usize, usize)> = second
            .iter()
            .filter_map(|(height, value, at)| {
                let above = first.partition_point(|sample| sample.0 <= *height);
                let pair = [*first.get(above.checked_sub(1)?)?, *first.get(above)?];
                // Samples at one place are no profile: they repeat each other.
                let is_between = *height - pair[0].0 > self.step && pair[1].0 - *height > self.step;
                is_between.then(|| (*value - between(*height, pair), *at, pair[0].2))
            })
            .collect();
        let rough = roughness(&first).max(roughness(&second));
        if off.len() < PROFILE || mean_square(off.iter().map(|one| one.0)) <= ROUGHNESS * rough + allowed {
            return None;
        }
        let (_, at, beside) = off.into_iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        Some(self.origins.two_places(quantity, [&self.rows[beside], &self.rows[at]]))
    }

    /// A state whose time falls behind that of one listed before it, at the same places: a restart. States that fall all
    /// through are sorted the other way round, and columns that are written place by place return to the start each time.
    fn times_that_go_back(&self) -> Vec<String> {
        let mut listed: Vec<&Vec<usize>> =
            self.instants.iter().filter(|rows| self.is_one_block(rows)).collect();
        let first = |rows: &[usize]| rows.iter().map(|at| self.rank[*at]).min();
        listed.sort_by_key(|rows| first(rows));
        let row = |rows: &[usize]| first(rows).map(|place| &self.rows[self.order[place]]);
        let mut sentences = Vec::new();
        for source in 0..self.origins.sources() {
            let of_source: Vec<&Vec<usize>> = (listed.iter().copied())
                .filter(|rows| {
                    row(rows).is_some_and(|row| self.origins.source_of(row.origin) == Some(source))
                })
                .collect();
            let pairs = || of_source.windows(2).filter_map(|pair| Some((row(pair[0])?, row(pair[1])?, pair)));
            if pairs().all(|(before, after, _)| after.time <= before.time) {
                continue;
            }
            let back = pairs()
                .find(|(before, after, pair)| after.time < before.time && self.overlap(pair[0], pair[1]));
            sentences.extend(back.map(|(before, after, _)| {
                format!(
                    "its times decrease: t = {} s ({}) comes after t = {} s ({}): keep one run if a restart \
                     or another run was appended, or sort the states by time",
                    typed(after.time),
                    self.origins.place(after.origin),
                    typed(before.time),
                    self.origins.place(before.origin),
                )
            }));
        }
        sentences
    }

    /// Whether the rows of a state follow each other.
    fn is_one_block(&self, rows: &[usize]) -> bool {
        let ranks = || rows.iter().map(|at| self.rank[*at]);
        ranks().min().zip(ranks().max()).is_some_and(|(first, last)| last - first + 1 == rows.len())
    }

    /// Whether two states are at the same heights, or between each other's.
    fn overlap(&self, one: &[usize], other: &[usize]) -> bool {
        let ends = |rows: &[usize]| {
            let heights = rows.iter().map(|at| self.rows[*at].initial_height);
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        let ([low, high], [other_low, other_high]) = (ends(one), ends(other));
        let common = high.min(other_high) - low.max(other_low);
        common > self.step || (high - low).max(other_high - other_low) <= self.step && common >= -self.step
    }
}

/// Root of the mean of squares; 0 of none.
fn mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value * value, count + 1));
    if count == 0 { 0.0 } else { (sum / count as f64).sqrt() }
}
