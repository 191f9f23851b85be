//! Sparse operators between points and nodes: one small tensor-product block of nodes a point.

use crate::operators::block_rows::{Blocks, LaneRows, RowBlock};
use crate::operators::row::Row;
use crate::state::grid::{GHOST_LAYERS, Grid, index_of, power};
use crate::state::lanes::{LANES, Lanes, lanes_of};
use oedometer_soil::tensor::{Tensor, Vector};

/// Weights and gradients of every point over a block of `W` nodes in each direction.
///
/// The block of a point is the tensor product of one row a direction, which is what is stored:
/// `2 D W` numbers a point whatever the dimension, those of neighbouring points side by side. A point whose weights
/// are no product has several blocks, of which they are the sum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stencils<const D: usize, const W: usize> {
    /// Flat index of the lowest node of each point's block, or of each of its blocks; as many as there are rows.
    pub first: Vec<usize>,
    rows: Vec<RowBlock<D, W>>,
    /// Blocks per point.
    parts: usize,
}

impl<const D: usize, const W: usize> Stencils<D, W> {
    /// Room for `points` points, all rows zero.
    pub fn with_points(points: usize) -> Self {
        Self::with_parts(points, 1)
    }

    /// Room for `points` points of so many blocks each, all rows zero; of one on a line.
    pub fn with_parts(points: usize, parts: usize) -> Self {
        let empty = LaneRows { weights: [[0.0; LANES]; W], gradients: [[0.0; LANES]; W] };
        let rows = vec![[empty; D]; (points * parts).div_ceil(LANES)];
        Self { first: vec![0; LANES * rows.len()], rows, parts }
    }

    /// Sets the block of a point from one row a direction.
    #[inline]
    pub fn set(&mut self, grid: &Grid<D>, point: usize, rows: &[Row<W>; D]) {
        let mut first = 0;
        for direction in 0..D {
            first += rows[direction].first * grid.node_stride()[direction];
            self.set_row(grid, point, direction, &rows[direction]);
        }
        self.first[point] = first;
    }

    /// Sets one of the blocks of a point.
    #[inline]
    pub fn set_part(&mut self, grid: &Grid<D>, point: usize, part: usize, rows: &[Row<W>; D]) {
        self.set(grid, point * self.parts + part, rows);
    }

    /// Sets the row of a point along a direction where the lowest node is known already.
    #[inline]
    pub fn set_row(&mut self, grid: &Grid<D>, point: usize, direction: usize, row: &Row<W>) {
        let (rows, lane) = (&mut self.rows[point / LANES][direction], point % LANES);
        for k in 0..W {
            rows.weights[k][lane] = row.weights[k];
            rows.gradients[k][lane] = row.gradients[k] * grid.inverse_cell_size();
        }
    }

    /// Sets the rows of all points block by block: `fill` is given some neighbouring points' places (in cells) along
    /// a direction, and the number of the first of them, and says which node each row begins with.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn set_lanes(
        &mut self,
        grid: &Grid<D>,
        places: &[Vector<D>],
        mut fill: impl FnMut(usize, usize, &Lanes, &mut LaneRows<W>) -> Lanes,
    ) {
        let firsts = self.first.as_chunks_mut::<LANES>().0;
        for (block, (rows, (firsts, places))) in
            self.rows.iter_mut().zip(firsts.iter_mut().zip(places.chunks(LANES))).enumerate()
        {
            // Whole numbers, which loops over lanes multiply and add as they do others.
            let mut nodes = [0.0; LANES];
            for direction in 0..D {
                let place = lanes_of(places, direction, GHOST_LAYERS as f64);
                let lowest = fill(block * LANES, direction, &place, &mut rows[direction]);
                let stride = grid.node_stride()[direction] as f64;
                for (node, lowest) in nodes.iter_mut().zip(&lowest) {
                    *node += stride * lowest;
                }
            }
            for (first, node) in firsts.iter_mut().zip(&nodes) {
                *first = index_of(*node);
            }
        }
    }

    /// The blocks of all points, borrowed once for a loop over them.
    #[inline]
    pub fn blocks(&self) -> Blocks<'_, D, W> {
        Blocks::of(self.first.as_chunks().0, &self.rows, self.parts)
    }

    /// Visits the nodes of a point's block with weight and gradient (1/m).
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn visit(
        &self,
        stride: &[usize; D],
        point: usize,
        mut node_visitor: impl FnMut(usize, f64, &Vector<D>),
    ) {
        self.blocks().visit_runs(
            stride,
            point,
            #[inline(always)]
            |run| {
                for k in 0..W {
                    let mut gradient = [0.0; D];
                    for d in 0..D {
                        gradient[d] = run.across[d] * if d == 0 { run.gradients[k] } else { run.weights[k] };
                    }
                    node_visitor(run.first + k, run.across[0] * run.weights[k], &gradient);
                }
            },
        );
    }

    /// Divergence of a nodal vector field at the point.
    #[inline]
    pub fn divergence(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> f64 {
        let gradient = self.blocks().gradient(stride, point, field);
        (0..D).map(|d| gradient[d][d]).sum()
    }
}

/// [`Stencils`] of the width of a basis, known once a loop: what walks them is compiled by width, and nothing else.
#[derive(Clone, Debug, PartialEq)]
pub enum PointStencils<const D: usize> {
    /// Two nodes per direction.
    Two(Stencils<D, 2>),
    /// Three.
    Three(Stencils<D, 3>),
    /// Four.
    Four(Stencils<D, 4>),
}

/// Evaluates an expression with the [`Stencils`] of a [`PointStencils`], of whatever width, under a name.
macro_rules! with_stencils {
    ($point_stencils:expr, $name:ident => $result:expr) => {
        match $point_stencils {
            $crate::operators::stencil::PointStencils::Two($name) => $result,
            $crate::operators::stencil::PointStencils::Three($name) => $result,
            $crate::operators::stencil::PointStencils::Four($name) => $result,
        }
    };
}
pub(crate) use with_stencils;

impl<const D: usize> Default for PointStencils<D> {
    fn default() -> Self {
        Self::Two(Stencils::default())
    }
}

impl<const D: usize> PointStencils<D> {
    /// Lowest node of each point's block.
    pub fn first(&self) -> &[usize] {
        with_stencils!(self, stencils => &stencils.first)
    }

    /// Visits the nodes of a point's block with weight and gradient (1/m).
    #[inline]
    pub fn visit(&self, stride: &[usize; D], point: usize, visitor: impl FnMut(usize, f64, &Vector<D>)) {
        with_stencils!(self, stencils => stencils.visit(stride, point, visitor));
    }

    /// Value of a nodal vector field at the point.
    #[inline]
    pub fn value(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Vector<D> {
        with_stencils!(self, stencils => stencils.blocks().value(stride, point, field))
    }

    /// Gradient of a nodal vector field at the point, `[component][direction]`.
    #[inline]
    pub fn gradient(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Tensor<D> {
        with_stencils!(self, stencils => stencils.blocks().gradient(stride, point, field))
    }

    /// Divergence of a nodal vector field at the point.
    #[inline]
    pub fn divergence(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> f64 {
        with_stencils!(self, stencils => stencils.divergence(stride, point, field))
    }

    /// The nodes of a point's blocks with their gradients (1/m), where they are not zero: the
    /// divergence at the point as a functional of a nodal field.
    pub fn gradient_row(&self, grid: &Grid<D>, point: usize) -> Vec<(usize, Vector<D>)> {
        let mut row: Vec<(usize, Vector<D>)> = Vec::new();
        self.visit(grid.node_stride(), point, |node, _, gradient| {
            if *gradient == [0.0; D] {
                return;
            }
            match row.iter_mut().find(|(other, _)| *other == node) {
                Some((_, sum)) => (0..D).for_each(|d| sum[d] += gradient[d]),
                None => row.push((node, *gradient)),
            }
        });
        row
    }
}

/// Visits the nodes of a tensor product of rows with their weights.
#[inline]
pub(crate) fn visit_block<const D: usize, const W: usize>(
    grid: &Grid<D>,
    rows: &[Row<W>; D],
    mut node_visitor: impl FnMut(usize, f64),
) {
    for corner in 0..power(W, D) {
        let (mut node, mut weight, mut rest) = (0, 1.0, corner);
        for direction in 0..D {
            let k = rest % W;
            rest /= W;
            node += (rows[direction].first + k) * grid.node_stride()[direction];
            weight *= rows[direction].weights[k];
        }
        node_visitor(node, weight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::basis::{Gimp, ShapeFunction};

    #[test]
    fn a_block_in_two_dimensions_reproduces_a_linear_field_and_its_gradient() {
        let grid = Grid::new(0.5, [6, 5]);
        let position = [1.37, 0.81];
        let mut stencils = Stencils::<2, 3>::with_points(1);
        let rows = position.map(|x| Gimp::row(grid.in_cells(x), 0, 0.2));
        stencils.set(&grid, 0, &rows);
        let field: Vec<Vector<2>> = (0..grid.node_count())
            .map(|node| {
                let [x, y] = grid.node_position(node);
                [1.0 + 2.0 * x - y, 3.0 - x + 4.0 * y]
            })
            .collect();
        let value = stencils.blocks().value(grid.node_stride(), 0, &field);
        assert!((value[0] - (1.0 + 2.0 * 1.37 - 0.81)).abs() < 1e-13);
        let gradient = stencils.blocks().gradient(grid.node_stride(), 0, &field);
        for (got, exact) in gradient.iter().flatten().zip([2.0, -1.0, -1.0, 4.0]) {
            assert!((got - exact).abs() < 1e-12, "{got} for {exact}");
        }
        assert!((stencils.divergence(grid.node_stride(), 0, &field) - 6.0).abs() < 1e-12);
    }
}
