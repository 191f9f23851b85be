//! Sparse operators between points and nodes: one small tensor-product block of nodes a point.

use super::grid::{Grid, Vector, power};
use super::shape::Row;

/// Weights and gradients of every point over a block of `W` nodes in each direction.
///
/// The block of a point is the tensor product of one row a direction, which is what is stored:
/// `2 D W` numbers a point whatever the dimension.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stencils<const D: usize, const W: usize> {
    /// Flat index of the lowest node of each point's block.
    pub first: Vec<usize>,
    /// Weights a direction.
    pub weights: Vec<[[f64; W]; D]>,
    /// Gradients a direction, 1/m.
    pub gradients: Vec<[[f64; W]; D]>,
}

impl<const D: usize, const W: usize> Stencils<D, W> {
    /// Room for `points` points, all rows zero.
    pub fn with_points(points: usize) -> Self {
        Self {
            first: vec![0; points],
            weights: vec![[[0.0; W]; D]; points],
            gradients: vec![[[0.0; W]; D]; points],
        }
    }

    /// Sets the block of a point from one row a direction.
    #[inline]
    pub fn set(&mut self, grid: &Grid<D>, point: usize, rows: &[Row<W>; D]) {
        let per_metre = grid.inverse_cell_size();
        let mut first = 0;
        for direction in 0..D {
            first += rows[direction].first * grid.node_stride()[direction];
            self.weights[point][direction] = rows[direction].weights;
            self.gradients[point][direction] = rows[direction].gradients.map(|g| g * per_metre);
        }
        self.first[point] = first;
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
        let weights = &self.weights[point];
        let gradients = &self.gradients[point];
        for flat in 0..power(W, D) {
            let mut rest = flat;
            let mut node = self.first[point];
            let mut weight = 1.0;
            let mut gradient = [1.0; D];
            for direction in 0..D {
                let k = rest % W;
                rest /= W;
                node += k * stride[direction];
                weight *= weights[direction][k];
                for component in 0..D {
                    gradient[component] *=
                        if component == direction { gradients[direction][k] } else { weights[direction][k] };
                }
            }
            node_visitor(node, weight, &gradient);
        }
    }

    /// Sum of a nodal vector field with the weights: its value at the point.
    #[inline]
    pub fn value(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Vector<D> {
        let mut value = [0.0; D];
        self.visit(stride, point, |node, weight, _| {
            for component in 0..D {
                value[component] += weight * field[node][component];
            }
        });
        value
    }

    /// Gradient of a nodal vector field at the point, `[component][direction]`.
    #[inline]
    pub fn gradient(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> [[f64; D]; D] {
        let mut gradient = [[0.0; D]; D];
        self.visit(stride, point, |node, _, node_gradient| {
            for component in 0..D {
                for direction in 0..D {
                    gradient[component][direction] += field[node][component] * node_gradient[direction];
                }
            }
        });
        gradient
    }

    /// Divergence of a nodal vector field at the point.
    #[inline]
    pub fn divergence(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> f64 {
        let mut divergence = 0.0;
        self.visit(stride, point, |node, _, node_gradient| {
            for direction in 0..D {
                divergence += field[node][direction] * node_gradient[direction];
            }
        });
        divergence
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::shape;

    #[test]
    fn a_block_in_two_dimensions_reproduces_a_linear_field_and_its_gradient() {
        let grid = Grid::new(0.5, [6, 5]);
        let position = [1.37, 0.81];
        let mut stencils = Stencils::<2, 3>::with_points(1);
        let rows = position.map(|x| shape::gimp(grid.in_cells(x), 0.2));
        stencils.set(&grid, 0, &rows);
        let field: Vec<Vector<2>> = (0..grid.node_count())
            .map(|node| {
                let [x, y] = grid.node_position(node);
                [1.0 + 2.0 * x - y, 3.0 - x + 4.0 * y]
            })
            .collect();
        let value = stencils.value(grid.node_stride(), 0, &field);
        assert!((value[0] - (1.0 + 2.0 * 1.37 - 0.81)).abs() < 1e-13);
        let gradient = stencils.gradient(grid.node_stride(), 0, &field);
        for (got, exact) in gradient.iter().flatten().zip([2.0, -1.0, -1.0, 4.0]) {
            assert!((got - exact).abs() < 1e-12, "{got} for {exact}");
        }
        assert!((stencils.divergence(grid.node_stride(), 0, &field) - 6.0).abs() < 1e-12);
    }
}
