//! Rank-one updates of an old tangent from the corrections of Newton's iteration (Broyden 1965).
//!
//! ```text
//! H ← (I + w cᵀ/(c·c − c·w)) H,   c = H F before a correction by c,   w = H F after it
//! ```
//!
//! `H` is the inverse that the factors represent. The updated one maps the change of `F` exactly to the step that was taken.
//! The update costs a few vectors and no residual, instead of new factors: points that moved to other cells change a few rows of
//! the tangent, and a few corrections make up for them. On large-strain columns of 10 and 40 cells
//! most runs with cell pressures take 14 to 63 % more iterations without them.

use crate::direct_solver::dot;
use crate::wide::wide;

/// Corrections that are kept: more would cost more than the iterations that they save.
const MOST_PAIRS: usize = 12;
/// Least `(c·c − c·w)/(c·c)` of a correction that is used: one that changed nothing would ask for an infinite step.
const LEAST_CHANGE: f64 = 0.2;

/// The corrections since the factors were made.
#[derive(Clone, Debug, Default)]
pub struct Secants {
    /// `w/(c·c − c·w)` and `c` of each, the oldest first.
    pairs: Vec<[Vec<f64>; 2]>,
    /// Number of pairs in use; the others are kept as room.
    count: usize,
}

impl Secants {
    /// Forgets all corrections, for new factors.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Applies the updates to a solution by the factors.
    pub fn apply(&self, values: &mut [f64]) {
        for [along, before] in &self.pairs[..self.count] {
            let share = dot(before, values);
            wide!({
                for (value, along) in values.iter_mut().zip(along) {
                    *value += share * along;
                }
            });
        }
    }

    /// Adds the update from a correction `before` and the following one, and applies it to the latter.
    pub fn learn(&mut self, before: &[f64], next: &mut [f64]) {
        let (size, left) = (dot(before, before), dot(before, next));
        let change = size - left;
        // Also false for NaN.
        let is_useful = change > LEAST_CHANGE * size && change.is_finite();
        if !is_useful {
            return;
        }
        if self.count == MOST_PAIRS {
            self.count = 0;
        }
        if self.count == self.pairs.len() {
            self.pairs.push([Vec::new(), Vec::new()]);
        }
        let [along, kept] = &mut self.pairs[self.count];
        self.count += 1;
        kept.clear();
        kept.extend_from_slice(before);
        along.clear();
        along.extend(next.iter().map(|value| value / change));
        for value in next {
            *value *= size / change;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 8;

    /// `A x − b`; the factors are those of the unit matrix, from which two rows of `A` differ.
    fn residual(x: &[f64]) -> Vec<f64> {
        let values = [1.0, -2.0, 3.0, 0.5, -1.0, 2.0, 0.25, 4.0];
        let mut residual: Vec<f64> = x.iter().zip(values).map(|(x, value)| x - value).collect();
        residual[3] += 0.3 * x[2] + 0.5 * x[3] + 0.4 * x[4];
        residual[4] += -0.4 * x[3] - 0.3 * x[4];
        residual
    }

    /// Size of the last of so many corrections, with secants learnt from each or without.
    fn left(corrections: usize, secants: Option<&mut Secants>) -> f64 {
        let (mut x, mut before, mut nothing) = (vec![0.0; COUNT], Vec::new(), Secants::default());
        let learns = secants.is_some();
        let secants = secants.unwrap_or(&mut nothing);
        for _ in 0..corrections {
            let mut next = residual(&x);
            secants.apply(&mut next);
            if learns && !before.is_empty() {
                secants.learn(&before, &mut next);
            }
            for (x, next) in x.iter_mut().zip(&next) {
                *x -= next;
            }
            before = next;
        }
        before.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()))
    }

    #[test]
    fn corrections_with_secants_converge_where_others_crawl() {
        let mut secants = Secants::default();
        assert!(left(6, None) > 1e-3, "{}", left(6, None));
        // Twice as many as rows that differ, and two (Gay 1979).
        let remainder = left(6, Some(&mut secants));
        assert!(remainder < 1e-14, "{remainder}");
        // The secants serve until the rows change.
        let known = left(2, Some(&mut secants));
        assert!(known < 0.1, "{known}");
        secants.clear();
        let unknown = left(2, Some(&mut secants));
        assert!(unknown > 0.7, "{unknown}");
    }

    #[test]
    fn secants_map_the_last_change_of_the_residual_to_the_last_step() {
        let mut secants = Secants::default();
        let before = residual(&[0.0; COUNT]);
        let after = residual(&before.iter().map(|entry| -entry).collect::<Vec<_>>());
        let mut next = after.clone();
        secants.learn(&before, &mut next);
        let mut change: Vec<f64> = before.iter().zip(&after).map(|(before, after)| before - after).collect();
        secants.apply(&mut change);
        let mut applied = after;
        secants.apply(&mut applied);
        for i in 0..COUNT {
            assert!((change[i] - before[i]).abs() < 1e-14, "{change:?} for {before:?}");
            assert!((applied[i] - next[i]).abs() < 1e-14);
        }
    }

    #[test]
    fn corrections_of_zero_and_nan_are_not_learnt() {
        let mut secants = Secants::default();
        for next in [[0.9, 0.0], [f64::NAN, 0.0], [f64::NEG_INFINITY, 0.0]] {
            let mut corrected = next;
            secants.learn(&[1.0, 0.0], &mut corrected);
            assert_eq!(secants.count, 0, "{next:?}");
            assert_eq!(corrected.map(f64::to_bits), next.map(f64::to_bits));
        }
        // No more of them are kept than there is room for.
        for _ in 0..=MOST_PAIRS {
            secants.learn(&[1.0, 0.0], &mut [0.1, 0.0]);
        }
        assert_eq!(secants.count, 1);
    }
}
