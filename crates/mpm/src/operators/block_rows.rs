//! [`Stencils`](crate::operators::stencil::Stencils) as loops take them: rows of some neighbouring points at a
//! time, and of a point run by run.

use crate::operators::pairs::{add_weighted, weighted_sum};
use crate::state::grid::power;
use crate::state::lanes::{FOUR, LANES, Lanes, some_of};
use oedometer_soil::tensor::{Tensor, Vector};

/// Rows of some neighbouring points, `[direction]`.
pub type RowBlock<const D: usize, const W: usize> = [LaneRows<W>; D];

/// Rows of some neighbouring points along one direction; no register of them straddles two lines of the cache.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct LaneRows<const W: usize> {
    /// Weights, `[node][point]`.
    pub weights: [Lanes; W],
    /// Gradients, 1/m, `[node][point]`.
    pub gradients: [Lanes; W],
}

/// Stencils as slices: a loop that writes nodal fields reads their places once, and not anew after
/// every store.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'a, const D: usize, const W: usize> {
    first: &'a [[usize; LANES]],
    rows: &'a [RowBlock<D, W>],
    parts: usize,
}

impl<'a, const D: usize, const W: usize> Blocks<'a, D, W> {
    /// Of the lowest nodes of the points' blocks, of their rows, and of how many blocks a point has.
    #[inline]
    pub fn of(first: &'a [[usize; LANES]], rows: &'a [RowBlock<D, W>], parts: usize) -> Self {
        Self { first, rows, parts }
    }

    /// Rows of the points of one block of [`LANES`].
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn block(&self, number: usize) -> BlockRows<'a, D, W> {
        BlockRows { all: *self, rows: &self.rows[number], first: &self.first[number], block: number, from: 0 }
    }

    /// Rows of up to four points from one on whose number is a multiple of four.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn four(&self, start: usize) -> BlockRows<'a, D, W> {
        BlockRows { from: start % LANES, ..self.block(start / LANES) }
    }

    /// Visits a point's block run by run. A run is one slice of a nodal field, so that its bounds are checked once.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn visit_runs(&self, stride: &[usize; D], point: usize, run_visitor: impl FnMut(&Run<D, W>)) {
        self.block(point / LANES).visit_runs(stride, point % LANES, run_visitor);
    }

    /// The same, but for runs whose weights and gradients are all zero.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn visit_filled_runs(&self, stride: &[usize; D], point: usize, run_visitor: impl FnMut(&Run<D, W>)) {
        self.block(point / LANES).visit_filled_runs(stride, point % LANES, run_visitor);
    }

    /// Sum of a nodal vector field with the weights: its value at the point.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn value(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Vector<D> {
        self.block(point / LANES).value(stride, point % LANES, field)
    }

    /// Gradient of a nodal vector field at the point, `[component][direction]`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn gradient(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Tensor<D> {
        self.block(point / LANES).gradient(stride, point % LANES, field)
    }
}

/// Rows of some neighbouring points, by their places among them; what is beyond the last point is of no matter.
#[derive(Clone, Copy, Debug)]
pub struct BlockRows<'a, const D: usize, const W: usize> {
    all: Blocks<'a, D, W>,
    /// Rows of the points, but of those with several blocks.
    pub rows: &'a RowBlock<D, W>,
    /// Flat index of the lowest node of each of their blocks.
    first: &'a [usize; LANES],
    block: usize,
    /// The first of the points among those of the block, a multiple of four.
    from: usize,
}

impl<const D: usize, const W: usize> BlockRows<'_, D, W> {
    /// Place of a point among those of the block.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn place(&self, lane: usize) -> usize {
        // What the compiler knows of it spares the bounds.
        (self.from & (LANES - FOUR)) + lane
    }

    /// Flat index of the lowest node of a point's block.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn first(&self, lane: usize) -> usize {
        self.first[self.place(lane)]
    }

    /// Weight of a point's node along a line, by its number in the row.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn weight(&self, node: usize, lane: usize) -> f64 {
        self.rows[0].weights[node][self.place(lane)]
    }

    /// Gradient of its weight, 1/m.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn gradient_along(&self, node: usize, lane: usize) -> f64 {
        self.rows[0].gradients[node][self.place(lane)]
    }

    /// Visits the blocks of a point run by run.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn visit_runs(&self, stride: &[usize; D], lane: usize, mut run_visitor: impl FnMut(&Run<D, W>)) {
        // On a line a point has one block, and the compiler knows.
        if D == 1 || self.all.parts == 1 {
            visit_rows(stride, self.rows, self.first(lane), self.place(lane), &mut run_visitor);
            return;
        }
        let point = self.block * LANES + self.place(lane);
        for block in point * self.all.parts..(point + 1) * self.all.parts {
            let (number, lane) = (block / LANES, block % LANES);
            visit_rows(stride, &self.all.rows[number], self.all.first[number][lane], lane, &mut run_visitor);
        }
    }

    /// The same, but for runs whose weights and gradients are all zero: those beyond a domain that lies within a cell.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn visit_filled_runs(
        &self,
        stride: &[usize; D],
        lane: usize,
        mut run_visitor: impl FnMut(&Run<D, W>),
    ) {
        self.visit_runs(
            stride,
            lane,
            #[inline(always)]
            |run| {
                if run.across != [0.0; D] {
                    run_visitor(run);
                }
            },
        );
    }

    /// Sum of a nodal vector field with the weights: its value at the point.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn value(&self, stride: &[usize; D], lane: usize, field: &[Vector<D>]) -> Vector<D> {
        let [value] = self.values(stride, lane, field.as_chunks().0);
        value
    }

    /// The same of several vectors that lie side by side at each node.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn values<const M: usize>(
        &self,
        stride: &[usize; D],
        lane: usize,
        fields: &[[Vector<D>; M]],
    ) -> [Vector<D>; M] {
        let mut values = [[0.0; D]; M];
        self.visit_filled_runs(
            stride,
            lane,
            #[inline(always)]
            |run| {
                let sum = weighted_sum(&run.weights, &fields[run.first..run.first + W]);
                if D == 1 {
                    values = sum;
                } else {
                    add_weighted(values.as_flattened_mut(), run.across[0], sum.as_flattened());
                }
            },
        );
        values
    }

    /// Gradients of a nodal vector field at some points, from a lane on, `[point][component][direction]`: side by side
    /// where they have the same nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn gradients<const N: usize>(
        &self,
        stride: &[usize; D],
        lane: usize,
        field: &[Vector<D>],
    ) -> [Tensor<D>; N] {
        let mut gradients = [[[0.0; D]; D]; N];
        let first = self.first(lane);
        let is_together = (1..N).all(|other| self.first(lane + other) == first);
        if N == 1 || D > 2 || !is_together || (D > 1 && self.all.parts > 1) {
            for (other, gradient) in gradients.iter_mut().enumerate() {
                *gradient = self.gradient(stride, lane + other, field);
            }
            return gradients;
        }
        let slopes: [[[f64; N]; D]; 2] = if D == 1 {
            self.slopes_on_a_line(lane, &field[first..first + W])
        } else {
            self.slopes_in_the_plane(lane, first, stride[D - 1], field)
        };
        for point in 0..N {
            for d in 0..D {
                for direction in 0..D {
                    gradients[point][d][direction] = slopes[direction][d][point];
                }
            }
        }
        gradients
    }

    /// Slopes at points of the same nodes of a line, `[direction][component][point]`: each number of a node is read once
    /// for all of them.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn slopes_on_a_line<const N: usize>(&self, lane: usize, nodes: &[Vector<D>]) -> [[[f64; N]; D]; 2] {
        let (lane, mut slopes) = (self.place(lane), [[[0.0; N]; D]; 2]);
        for k in 0..W {
            let gradient = some_of::<_, N>(&self.rows[0].gradients[k], lane);
            for point in 0..N {
                slopes[0][0][point] += gradient[point] * nodes[k][0];
            }
        }
        slopes
    }

    /// The same in the plane, from the lowest of the nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn slopes_in_the_plane<const N: usize>(
        &self,
        lane: usize,
        first: usize,
        up: usize,
        field: &[Vector<D>],
    ) -> [[[f64; N]; D]; 2] {
        let lane = self.place(lane);
        let row = |rows: &[Lanes; W], k: usize| *some_of::<_, N>(&rows[k], lane);
        let (along, across) = (&self.rows[0], &self.rows[D - 1]);
        // In a direction of one cell two of the nodes have no part in anything.
        let mut is_used = [true; W];
        for k in 0..W {
            is_used[k] = row(&along.weights, k) != [0.0; N] || row(&along.gradients, k) != [0.0; N];
        }
        let mut slopes = [[[0.0; N]; D]; 2];
        for run in 0..W {
            let nodes = &field[first + run * up..first + run * up + W];
            // The slope along the run, and the value.
            let mut sums = [[[0.0; N]; D]; 2];
            for k in 0..W {
                if !is_used[k] {
                    continue;
                }
                let (gradient, weight) = (row(&along.gradients, k), row(&along.weights, k));
                for d in 0..D {
                    for point in 0..N {
                        sums[0][d][point] += gradient[point] * nodes[k][d];
                    }
                    for point in 0..N {
                        sums[1][d][point] += weight[point] * nodes[k][d];
                    }
                }
            }
            let across = [row(&across.weights, run), row(&across.gradients, run)];
            for direction in 0..2 {
                for d in 0..D {
                    for point in 0..N {
                        slopes[direction][d][point] += across[direction][point] * sums[direction][d][point];
                    }
                }
            }
        }
        slopes
    }

    /// Gradient of a nodal vector field at the point, `[component][direction]`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn gradient(&self, stride: &[usize; D], lane: usize, field: &[Vector<D>]) -> Tensor<D> {
        // `[direction][component]`: components lie side by side at the nodes.
        let mut slopes = [[0.0; D]; D];
        self.visit_runs(
            stride,
            lane,
            #[inline(always)]
            |run| {
                let nodes = &field[run.first..run.first + W];
                if D == 1 {
                    [slopes[0]] = weighted_sum(&run.gradients, nodes.as_chunks().0);
                    return;
                }
                // The slope along the run, and the value for all directions but the first, side by side.
                let mut sums = [[0.0; D]; 2];
                for k in 0..W {
                    let along = [run.gradients[k], run.weights[k]];
                    for (sum, along) in sums.iter_mut().zip(along) {
                        for d in 0..D {
                            sum[d] += along * nodes[k][d];
                        }
                    }
                }
                for direction in 0..D {
                    let sum = sums[direction.min(1)];
                    for d in 0..D {
                        slopes[direction][d] += run.across[direction] * sum[d];
                    }
                }
            },
        );
        std::array::from_fn(|component| std::array::from_fn(|direction| slopes[direction][component]))
    }
}

/// `W` neighbouring nodes along the first direction in the block of a point, whose weights and gradients are products
/// of what is along the run and what is across it: sums over the nodes are taken along first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<const D: usize, const W: usize> {
    /// The first of the nodes.
    pub first: usize,
    /// Weights along the run.
    pub weights: [f64; W],
    /// Gradients along the run, 1/m.
    pub gradients: [f64; W],
    /// What the other directions give: to the weights and to the first component of the gradients, and to each of the
    /// others, 1/m.
    pub across: Vector<D>,
}

/// Visits the runs of one block of nodes from its lowest, with the rows of a place among some points.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn visit_rows<const D: usize, const W: usize>(
    stride: &[usize; D],
    rows: &RowBlock<D, W>,
    lowest: usize,
    lane: usize,
    run_visitor: &mut impl FnMut(&Run<D, W>),
) {
    let mut run = Run { first: 0, weights: [0.0; W], gradients: [0.0; W], across: [1.0; D] };
    for k in 0..W {
        run.weights[k] = rows[0].weights[k][lane];
        run.gradients[k] = rows[0].gradients[k][lane];
    }
    for number in 0..power(W, D - 1) {
        let mut rest = number;
        run.first = lowest;
        run.across = [1.0; D];
        for direction in 1..D {
            let k = rest % W;
            rest /= W;
            run.first += k * stride[direction];
            let (weight, gradient) = (rows[direction].weights[k][lane], rows[direction].gradients[k][lane]);
            for component in 0..D {
                run.across[component] *= if component == direction { gradient } else { weight };
            }
        }
        run_visitor(&run);
    }
}
