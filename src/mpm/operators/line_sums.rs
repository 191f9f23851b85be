//! Sums from the points of a line to its nodes.
//!
//! Neighbours in a line give to the same few nodes. What they give is summed in registers for as long as the nodes are
//! the same, and then added to the nodes at once: a sum in memory would have to be stored and loaded again for every
//! point.

use crate::mpm::operators::pairs::add_weighted;
use crate::mpm::operators::stencil::{Blocks, LaneRows};
use crate::mpm::state::lanes::{LANES, Lanes};
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

impl<const D: usize, const W: usize> Blocks<'_, D, W> {
    /// Adds what each point of a block gives, by its place in the block, to its nodes, `N` numbers a node: times the
    /// weights or the gradients of its rows. Of one dimension alone.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn add_in_line<const N: usize>(
        &self,
        block: Range<usize>,
        sums: &mut [f64],
        rows_of: impl Fn(&LaneRows<W>) -> &[Lanes; W],
        given: impl Fn(usize) -> [f64; N],
    ) {
        let nodes = sums.as_chunks_mut::<N>().0;
        let rows = rows_of(&self.rows[block.start / LANES][0]);
        let mut add = |first: usize, window: &[[f64; N]; W]| {
            for (node, sum) in nodes[first..first + W].iter_mut().zip(window) {
                for i in 0..N {
                    node[i] += sum[i];
                }
            }
        };
        let (mut window, mut first) = ([[0.0; N]; W], self.first[block.start]);
        for (lane, own) in self.first[block].iter().enumerate().take(LANES) {
            if *own != first {
                add(first, &window);
                (window, first) = ([[0.0; N]; W], *own);
            }
            let given = given(lane);
            for k in 0..W {
                add_weighted(&mut window[k], rows[k][lane], &given);
            }
        }
        add(first, &window);
    }
}

#[cfg(test)]
mod tests {
    use crate::mpm::operators::row::Row;
    use crate::mpm::operators::stencil::Stencils;
    use crate::mpm::state::grid::Grid;
    use crate::mpm::state::lanes::LANES;

    #[test]
    fn every_point_gives_to_its_own_nodes() {
        let (grid, count) = (Grid::new(0.5, [12]), LANES + 9);
        let mut stencils = Stencils::<1, 3>::with_points(count);
        let first_of = |point: usize| [2, 2, 2, 3, 3, 7, 5][point % 7] + point / 7;
        for point in 0..count {
            let weights = [0.25, 0.5, 0.25 + point as f64];
            let row = Row { first: first_of(point), weights, gradients: [-1.0, 0.25, 0.75] };
            stencils.set(&grid, point, &[row]);
        }
        let mut expected = vec![[0.0; 2]; grid.node_count()];
        let (mut sums, mut slopes) = (vec![0.0; 2 * grid.node_count()], vec![0.0; 2 * grid.node_count()]);
        for point in 0..count {
            for (k, weight) in [0.25, 0.5, 0.25 + point as f64].into_iter().enumerate() {
                expected[first_of(point) + k][0] += weight * point as f64;
                expected[first_of(point) + k][1] += weight;
            }
        }
        let blocks = stencils.blocks();
        for start in (0..count).step_by(LANES) {
            let block = start..count.min(start + LANES);
            let given = |lane: usize| [(start + lane) as f64, 1.0];
            blocks.add_in_line(block.clone(), &mut sums, super::weights_of, given);
            blocks.add_in_line(block, &mut slopes, super::gradients_of, given);
        }
        for (got, expected) in sums.iter().zip(expected.as_flattened()) {
            assert!((got - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{got} for {expected}");
        }
        let all: f64 = slopes.iter().sum();
        assert!(all.abs() < 1e-9, "gradients of a point add up to nothing: {all}");
    }
}
