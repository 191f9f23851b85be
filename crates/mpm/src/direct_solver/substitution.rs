//! Right-hand sides on their way through the factors of the fronts, part by part.
//!
//! Values are in the order of elimination. Going forward, a part adds up what it changes behind itself on its own,
//! and its parent adds that up, part after part; going back, it is told the solution there. So parts may go side by
//! side, and the bits are those of one after the other.

use crate::direct_solver::banded::less_products;
use crate::direct_solver::branch::Branch;
use crate::direct_solver::desk::Desk;
use crate::direct_solver::elimination::FrontShape;
use crate::wide::wide;

/// The factors of all fronts.
#[derive(Clone, Copy, Debug)]
pub struct Substitution<'a> {
    /// The fronts.
    pub fronts: &'a [FrontShape],
    /// First entry of each among the factors.
    pub starts: &'a [usize],
    /// Their factors.
    pub factors: &'a [f64],
    /// Row that took the place of each row.
    pub pivots: &'a [usize],
}

impl Substitution<'_> {
    /// `b ← L⁻¹ b` in a branch, by so many threads; `values` are those of its own places.
    pub fn go_forward(&self, branch: &mut Branch, values: &mut [f64], threads: usize) {
        branch.behind.fill(0.0);
        if let Some(halves) = &mut branch.halves {
            let [low, high] = &mut **halves;
            let (low_values, rest) = values.split_at_mut(low.places.len());
            let high_values = &mut rest[..high.places.len()];
            let of_others = threads / 2;
            if of_others == 0 {
                self.go_forward(low, low_values, threads);
                self.go_forward(high, high_values, threads);
            } else {
                std::thread::scope(|scope| {
                    scope.spawn(|| self.go_forward(high, high_values, of_others));
                    self.go_forward(low, low_values, threads - of_others);
                });
            }
            let (first, end) = (branch.places.start, branch.places.end);
            for half in halves.iter() {
                let Some(top) = half.top() else { continue };
                for place in &self.fronts[top].boundary {
                    let change = half.behind[place - half.first_behind];
                    if *place < end {
                        values[place - first] += change;
                    } else {
                        branch.behind[place - branch.first_behind] += change;
                    }
                }
            }
        }
        wide!(self.fronts_forward(branch, values));
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn fronts_forward(&self, branch: &mut Branch, values: &mut [f64]) {
        let end = branch.places.end;
        for number in branch.fronts.clone() {
            let (front, start) = (&self.fronts[number], self.starts[number]);
            let count = front.count;
            let (within, behind) = self.factors[start..][..front.lower_entries()].split_at(front.within());
            let (own, inside) = values[front.first - branch.places.start..].split_at_mut(count);
            for (row, pivot) in self.pivots[front.first..][..count].iter().enumerate() {
                own.swap(row, *pivot);
            }
            let mut next = 0;
            for row in 1..count {
                let (known, rest) = own.split_at_mut(row);
                rest[0] = less_products(rest[0], &within[next..][..row], known);
                next += row;
            }
            for (place, lower) in front.boundary.iter().zip(behind.chunks_exact(count.max(1))) {
                let value = if *place < end {
                    &mut inside[place - front.first - count]
                } else {
                    &mut branch.behind[place - branch.first_behind]
                };
                *value = less_products(*value, lower, own);
            }
        }
    }

    /// `b ← U⁻¹ b` in a branch that knows the solution behind itself, by as many threads as there are desks.
    pub fn go_back(&self, branch: &mut Branch, values: &mut [f64], desks: &mut [Desk]) {
        wide!(self.fronts_back(branch, values, &mut desks[0].gathered));
        let Some(halves) = &mut branch.halves else { return };
        let (first, end) = (branch.places.start, branch.places.end);
        for half in halves.iter_mut() {
            let Some(top) = half.top() else { continue };
            for place in &self.fronts[top].boundary {
                half.behind[place - half.first_behind] = if *place < end {
                    values[place - first]
                } else {
                    branch.behind[place - branch.first_behind]
                };
            }
        }
        let [low, high] = &mut **halves;
        let (low_values, rest) = values.split_at_mut(low.places.len());
        let high_values = &mut rest[..high.places.len()];
        let (desks, others) = desks.split_at_mut(desks.len().div_ceil(2));
        if others.is_empty() {
            self.go_back(low, low_values, desks);
            self.go_back(high, high_values, desks);
        } else {
            std::thread::scope(|scope| {
                scope.spawn(|| self.go_back(high, high_values, others));
                self.go_back(low, low_values, desks);
            });
        }
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn fronts_back(&self, branch: &Branch, values: &mut [f64], gathered: &mut [f64]) {
        let (first, end) = (branch.places.start, branch.places.end);
        for number in branch.fronts.clone().rev() {
            let (front, start) = (&self.fronts[number], self.starts[number]);
            let (count, size) = (front.count, front.size());
            let gathered = &mut gathered[..size];
            for (value, place) in gathered[count..].iter_mut().zip(&front.boundary) {
                *value = if *place < end {
                    values[place - first]
                } else {
                    branch.behind[place - branch.first_behind]
                };
            }
            let mut upper = &self.factors[start..][front.lower_entries()..front.factor_entries()];
            for row in (0..count).rev() {
                let (entries, rest) = upper.split_at(size - row);
                let own = front.first - first + row;
                let value = less_products(values[own], &entries[1..], &gathered[row + 1..]) / entries[0];
                gathered[row] = value;
                values[own] = value;
                upper = rest;
            }
        }
    }
}
