//! Sums from the points of a line to its nodes.
//!
//! Neighbours in a line give to the same few nodes. What they give is summed in registers for as long as the nodes are
//! the same, and then added to the nodes at once: a sum in memory would have to be stored and loaded again for every
//! point.

use crate::mpm::operators::block_rows::{BlockRows, LaneRows};
use crate::mpm::operators::pairs::add_weighted;
use crate::mpm::state::lanes::Lanes;

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
    /// Adds what each of so many points of the block gives, by its place in it, to its nodes, `N` numbers a node: times the
    /// weights or the gradients of its rows. Of one dimension alone.
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
        let (mut window, mut first) = ([[0.0; N]; W], self.first[0]);
        for (lane, own) in self.first.iter().enumerate().take(count) {
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
        let (mut window, mut first) = (Window::<W>::EMPTY, self.first[0]);
        for (lane, own) in self.first.iter().enumerate().take(count) {
            if *own != first {
                window.add_to(&mut sums, first);
                (window, first) = (Window::EMPTY, *own);
            }
            let [masses, balances] = given(lane);
            for k in 0..W {
                let (weight, gradient) = (rows.weights[k][lane], rows.gradients[k][lane]);
                add_weighted(&mut window.masses[k], weight, &masses);
                let along = [weight, weight, gradient, gradient];
                window.balances[k] =
                    std::array::from_fn(|i| window.balances[k][i] + along[i] * balances[i]);
            }
        }
        window.add_to(&mut sums, first);
    }
}

/// What the points of a line give to its nodes, `[node]`.
pub struct LineSums<'a> {
    /// As [`NodalSums::masses`](crate::mpm::state::nodes::NodalSums::masses).
    pub masses: &'a mut [[f64; 4]],
    /// As [`NodalSums::balances`](crate::mpm::state::nodes::NodalSums::balances).
    pub balances: &'a mut [[f64; 4]],
}

/// The same of the few nodes that neighbouring points give to.
#[derive(Clone, Copy)]
struct Window<const W: usize> {
    masses: [[f64; 4]; W],
    balances: [[f64; 4]; W],
}

impl<const W: usize> Window<W> {
    const EMPTY: Self = Self { masses: [[0.0; 4]; W], balances: [[0.0; 4]; W] };

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn add_to(&self, sums: &mut LineSums<'_>, first: usize) {
        add_nodes(&mut sums.masses[first..first + W], &self.masses);
        add_nodes(&mut sums.balances[first..first + W], &self.balances);
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
    use super::LineSums;
    use crate::mpm::operators::row::Row;
    use crate::mpm::operators::stencil::Stencils;
    use crate::mpm::state::grid::Grid;
    use crate::mpm::state::lanes::{LANES, blocks_of};

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
        let mut masses = vec![[0.0; 4]; grid.node_count()];
        let (mut momenta, mut forces) = (vec![0.0; 2 * grid.node_count()], vec![0.0; 2 * grid.node_count()]);
        let (mut sums, mut slopes) = (vec![0.0; 2 * grid.node_count()], vec![0.0; 2 * grid.node_count()]);
        for point in 0..count {
            for (k, weight) in [0.25, 0.5, 0.25 + point as f64].into_iter().enumerate() {
                expected[first_of(point) + k][0] += weight * point as f64;
                expected[first_of(point) + k][1] += weight;
            }
        }
        let blocks = stencils.blocks();
        for block in blocks_of(count) {
            let rows = blocks.block(block.start / LANES);
            let given = |lane: usize| [(block.start + lane) as f64, 1.0];
            rows.add_in_line(block.len(), &mut sums, super::weights_of, given);
            rows.add_in_line(block.len(), &mut slopes, super::gradients_of, given);
            let all = LineSums {
                masses: &mut masses,
                momenta: momenta.as_chunks_mut().0,
                forces: forces.as_chunks_mut().0,
            };
            rows.add_all_in_line(block.len(), all, |lane| {
                ([given(lane)[0], 2.0, 0.0, 0.0], given(lane), given(lane))
            });
        }
        assert_eq!((&sums, &slopes), (&momenta, &forces), "in one walk or in several");
        for (masses, sums) in masses.iter().zip(sums.as_chunks::<2>().0) {
            assert_eq!(*masses, [sums[0], 2.0 * sums[1], 0.0, 0.0]);
        }
        for (got, expected) in sums.iter().zip(expected.as_flattened()) {
            assert!((got - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{got} for {expected}");
        }
        let all: f64 = slopes.iter().sum();
        assert!(all.abs() < 1e-9, "gradients of a point add up to nothing: {all}");
    }
}
