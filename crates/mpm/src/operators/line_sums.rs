//! Sums from the points of a line to its nodes.
//!
//! Neighbours in a line give to the same few nodes. What they give is summed in registers for as long as the nodes are
//! the same, and then added to the nodes at once: a sum in memory would have to be stored and loaded again for every
//! point.

use crate::operators::block_rows::{BlockRows, LaneRows};
use crate::operators::pairs::add_weighted;
use crate::state::lanes::Lanes;
use std::ops::Range;

/// Weights of some rows.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn weights_of<const W: usize>(rows: &LaneRows<W>) -> &[Lanes; W] {
    &rows.weights
}

/// Gradients of some rows, 1/m.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn gradients_of<const W: usize>(rows: &LaneRows<W>) -> &[Lanes; W] {
    &rows.gradients
}

impl<const D: usize, const W: usize> BlockRows<'_, D, W> {
    /// Sums what each of so many points of the block gives, by its place in it, to its nodes, `N` numbers a node: times the
    /// weights or the gradients of its rows. `add` is told the lowest of some nodes with what they take. Of one dimension
    /// alone.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn add_in_line<const N: usize>(
        &self,
        count: usize,
        rows_of: impl Fn(&LaneRows<W>) -> &[Lanes; W],
        given: impl Fn(usize) -> [f64; N],
        mut add: impl FnMut(usize, &[[f64; N]; W]),
    ) {
        let rows = rows_of(&self.rows[0]);
        let (mut window, mut first) = ([[0.0; N]; W], self.first(0));
        for (lane, own) in (0..count).map(|lane| (lane, self.first(lane))) {
            if own != first {
                add(first, &window);
                (window, first) = ([[0.0; N]; W], own);
            }
            let given = given(lane);
            for k in 0..W {
                add_weighted(&mut window[k], rows[k][lane], &given);
            }
        }
        add(first, &window);
    }

    /// The same of masses, momenta and forces in one walk along the block: those of the forces times the gradients.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn add_all_in_line(
        &self,
        count: usize,
        mut sums: LineSums<'_>,
        given: impl Fn(usize) -> [[f64; 4]; 2],
    ) {
        let rows = &self.rows[0];
        let (mut window, mut first) = (Windows::<W>::EMPTY, self.first(0));
        for (lane, own) in (0..count).map(|lane| (lane, self.first(lane))) {
            if own != first {
                window.add_to(&mut sums, first);
                (window, first) = (Windows::EMPTY, own);
            }
            let [masses, balances] = given(lane);
            for k in 0..W {
                let (weight, gradient) = (rows.weights[k][lane], rows.gradients[k][lane]);
                add_weighted(&mut window.masses[k], weight, &masses);
                let along = [weight, weight, gradient, gradient];
                window.balances[k] = std::array::from_fn(|i| window.balances[k][i] + along[i] * balances[i]);
            }
        }
        window.add_to(&mut sums, first);
    }
}

/// What the points of a line give to its nodes, `[node]`.
pub struct LineSums<'a> {
    /// As [`NodalSums::masses`](crate::state::nodes::NodalSums::masses).
    pub masses: &'a mut [[f64; 4]],
    /// As [`NodalSums::balances`](crate::state::nodes::NodalSums::balances).
    pub balances: &'a mut [[f64; 4]],
}

/// The same of the few nodes that neighbouring points give to.
#[derive(Clone, Copy)]
struct Windows<const W: usize> {
    masses: [[f64; 4]; W],
    balances: [[f64; 4]; W],
}

impl<const W: usize> Windows<W> {
    const EMPTY: Self = Self { masses: [[0.0; 4]; W], balances: [[0.0; 4]; W] };

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn add_to(&self, sums: &mut LineSums<'_>, first: usize) {
        add_nodes(&mut sums.masses[first..first + W], &self.masses);
        add_nodes(&mut sums.balances[first..first + W], &self.balances);
    }
}

/// What neighbouring points have given to the same few nodes, `N` numbers a node, while points are taken one after the
/// other.
#[derive(Clone, Copy)]
pub struct Window<const W: usize, const N: usize> {
    /// The lowest of the nodes.
    first: usize,
    sums: [[f64; N]; W],
}

impl<const W: usize, const N: usize> Window<W, N> {
    /// Nothing is given yet.
    pub const EMPTY: Self = Self { first: 0, sums: [[0.0; N]; W] };

    /// Takes what a point gives to its nodes, whose lowest is told, times the weight of each. Before it begins with
    /// others, it adds what it holds to those that it was of.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn take(
        &mut self,
        first: usize,
        weight: impl Fn(usize) -> f64,
        given: [f64; N],
        add: impl FnMut(Range<usize>, &[[f64; N]; W]),
    ) {
        if first != self.first {
            self.close(add);
            *self = Self { first, ..Self::EMPTY };
        }
        for k in 0..W {
            add_weighted(&mut self.sums[k], weight(k), &given);
        }
    }

    /// Adds what it holds to its nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn close(&self, mut add: impl FnMut(Range<usize>, &[[f64; N]; W])) {
        add(self.first..self.first + W, &self.sums);
    }
}

/// Adds the numbers of some nodes to others.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn add_nodes<const N: usize>(nodes: &mut [[f64; N]], window: &[[f64; N]]) {
    for (node, sum) in nodes.iter_mut().zip(window) {
        for i in 0..N {
            node[i] += sum[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LineSums, Window, add_nodes};
    use crate::operators::row::Row;
    use crate::operators::stencil::Stencils;
    use crate::state::grid::Grid;
    use crate::state::lanes::{LANES, blocks_of};

    #[test]
    fn every_point_gives_to_its_own_nodes() {
        let (grid, count) = (Grid::new(0.5, [12]), LANES + 9);
        let mut stencils = Stencils::<1, 3>::with_points(count);
        let first_of = |point: usize| [2, 2, 2, 3, 3, 7, 5][point % 7] + point / 7;
        let weights_of = |point: usize| [0.25, 0.5, 0.25 + point as f64];
        let gradients = [-1.0, 0.25, 0.75];
        let (nodes, given) = (grid.node_count(), |point: usize| [point as f64, 1.0]);
        let (mut expected, mut expected_slopes) = (vec![[0.0; 2]; nodes], vec![[0.0; 2]; nodes]);
        for point in 0..count {
            let weights = weights_of(point);
            stencils.set(&grid, point, &[Row { first: first_of(point), weights, gradients }]);
            for k in 0..3 {
                for i in 0..2 {
                    expected[first_of(point) + k][i] += weights[k] * given(point)[i];
                    // Rows are given per cell, of half a metre.
                    expected_slopes[first_of(point) + k][i] += 2.0 * gradients[k] * given(point)[i];
                }
            }
        }
        let [mut sums, mut slopes, mut in_turn] =
            [vec![[0.0; 2]; nodes], vec![[0.0; 2]; nodes], vec![[0.0; 2]; nodes]];
        let (mut masses, mut balances) = (vec![[0.0; 4]; nodes], vec![[0.0; 4]; nodes]);
        let (blocks, mut window) = (stencils.blocks(), Window::<3, 2>::EMPTY);
        for block in blocks_of(count) {
            let rows = blocks.block(block.start / LANES);
            let of_lane = |lane: usize| given(block.start + lane);
            rows.add_in_line(block.len(), super::weights_of, of_lane, |first, window| {
                add_nodes(&mut sums[first..first + 3], window);
            });
            rows.add_in_line(block.len(), super::gradients_of, of_lane, |first, window| {
                add_nodes(&mut slopes[first..first + 3], window);
            });
            let all = LineSums { masses: &mut masses, balances: &mut balances };
            rows.add_all_in_line(block.len(), all, |lane| {
                let [one, other] = of_lane(lane);
                [[one, 2.0 * other, 0.0, 0.0], [one, other, one, other]]
            });
            for lane in 0..block.len() {
                let weight = |node: usize| rows.weight(node, lane);
                window.take(rows.first(lane), weight, of_lane(lane), |nodes, window| {
                    add_nodes(&mut in_turn[nodes], window);
                });
            }
        }
        window.close(|nodes, window| add_nodes(&mut in_turn[nodes], window));
        for node in 0..nodes {
            let ([one, other], [slope, other_slope]) = (sums[node], slopes[node]);
            assert_eq!(masses[node], [one, 2.0 * other, 0.0, 0.0], "in one walk or in several");
            assert_eq!(balances[node], [one, other, slope, other_slope], "in one walk or in several");
            for i in 0..2 {
                for (got, expected) in [
                    (sums[node][i], expected[node][i]),
                    (in_turn[node][i], expected[node][i]),
                    (slopes[node][i], expected_slopes[node][i]),
                ] {
                    assert!((got - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{got} for {expected}");
                }
            }
        }
        let all: f64 = slopes.as_flattened().iter().sum();
        assert!(all.abs() < 1e-9, "gradients of a point add up to nothing: {all}");
    }
}
