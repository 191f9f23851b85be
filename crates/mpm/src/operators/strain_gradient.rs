//! The strain gradient `G`: from nodal velocities to the strain rate of the effective stress.
//!
//! `∇v(x_p) = Σ_i v_i ⊗ ∇N_i(x_p)`, `[component][direction]`, with the gradients of the basis, of the Lagrange
//! interpolant through the nodes of the cell and its neighbours (composite MPM), or of that interpolant between
//! the ends of the point's domain.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::operators::row::Row;
use crate::operators::stencil::{Block, PointStencils, Stencils};
use crate::state::cells::Cells;
use crate::state::grid::{Grid, SIXTH, cell_below, power};
use crate::wide::{LANES, some_mut, wide};
use oedometer_problem::method::StrainGradient;
use oedometer_soil::tensor::{Tensor, Vector};
use std::hint::black_box;

/// Nodes per direction between the ends of a domain: four at either end, at most one cell apart.
pub const ENDS_WIDTH: usize = 5;
/// Ends are looked up this far inside their domain, in cells: an end on a face belongs to its own
/// domain's cell.
const INSET: f64 = 1e-9;

/// `G` of a method, with its stencils where they are not those of the basis.
#[derive(Clone, Debug, Default)]
pub enum StrainOperator<const D: usize> {
    /// The gradient of the basis.
    #[default]
    Basis,
    /// The gradient of the composite MPM.
    Composite(Stencils<D, 4>),
    /// The composite MPM's interpolant between the ends of the domains, which also carries the points.
    BetweenEnds(Stencils<D, ENDS_WIDTH>),
}

impl<const D: usize> StrainOperator<D> {
    /// The operator of a strain gradient, sized for `points` points.
    pub fn new(strain: StrainGradient, points: usize) -> Self {
        match strain {
            StrainGradient::Standard | StrainGradient::Bbar => Self::Basis,
            StrainGradient::Cmpm | StrainGradient::CmpmBbar => Self::Composite(Stencils::new(points, 1)),
            StrainGradient::CmpmEnds => Self::BetweenEnds(Stencils::new(points, 1)),
        }
    }

    /// Updates the stencils to the points' places; half-lengths of the domains in m, `[point][direction]`.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>, half_length: &[Vector<D>]) {
        let (places, per_cell) = (cells.place.iter().enumerate(), grid.inverse_cell_size());
        match self {
            Self::Basis => {}
            Self::Composite(stencils) => wide!({
                let rows = CompositeRows::new(grid, cells, half_length.len());
                for point in 0..half_length.len() {
                    stencils.put(point, &rows.block(point));
                }
            }),
            Self::BetweenEnds(stencils) => {
                for (point, place) in places {
                    let cell = grid.cell_at(place);
                    let rows = std::array::from_fn(|d| {
                        let half = (half_length[point][d] * per_cell).min(0.5);
                        let end = |side: f64| {
                            let at = place[d] + side * half;
                            let mut home = cell;
                            home[d] = cell_below(at - side * INSET).clamp(cell[d] - 1, cell[d] + 1);
                            let (flat, stride) = (grid.flat_cell(&home), grid.cell_stride()[d]);
                            let sides = [cells.is_reached(flat - stride), cells.is_reached(flat + stride)];
                            let [values, gradients] = composite(at - home[d] as f64, sides);
                            Row { first: home[d] - 1, values, gradients }
                        };
                        Row::between(&end(-1.0), &end(1.0), 2.0 * half)
                    });
                    stencils.set(grid, point, &rows);
                }
            }
        }
    }

    /// Which nodes each point's stencil reaches, as [`Stencils::reach`], where it is not that of the basis.
    pub fn reach(&self) -> Vec<usize> {
        match self {
            Self::Basis => Vec::new(),
            Self::Composite(stencils) => stencils.reach().collect(),
            Self::BetweenEnds(stencils) => stencils.reach().collect(),
        }
    }

    /// Whether the stencils reach those nodes; nothing is allocated.
    pub fn reaches(&self, known: &[usize]) -> bool {
        match self {
            Self::Basis => known.is_empty(),
            Self::Composite(stencils) => stencils.reach().eq(known.iter().copied()),
            Self::BetweenEnds(stencils) => stencils.reach().eq(known.iter().copied()),
        }
    }

    /// Weights of the velocity that carries the points where it is not the value of the basis: the mean of the ends of their
    /// domains, where the strain is the difference of these ends.
    pub(crate) fn carrier(&self) -> Option<&Stencils<D, ENDS_WIDTH>> {
        match self {
            Self::BetweenEnds(stencils) => Some(stencils),
            Self::Basis | Self::Composite(_) => None,
        }
    }

    /// Visits the nodes that a point's strain depends on, with their gradients, 1/m.
    pub fn visit(
        &self,
        basis: &PointStencils<D>,
        stride: &[usize; D],
        point: usize,
        mut node_visitor: impl FnMut(usize, &Vector<D>),
    ) {
        let visitor = |node: usize, _: f64, gradient: &Vector<D>| node_visitor(node, gradient);
        match self {
            Self::Basis => basis.visit(stride, point, visitor),
            Self::Composite(stencils) => stencils.of_point(point).visit(stride, visitor),
            Self::BetweenEnds(stencils) => stencils.of_point(point).visit(stride, visitor),
        }
    }
}

/// Inputs of the rows of the composite gradient, as slices of one length.
#[derive(Clone, Copy)]
pub(crate) struct CompositeRows<'a, const D: usize> {
    cells: &'a [usize],
    within: &'a [Vector<D>],
    sides: &'a [[[bool; 2]; D]],
    first_nodes: &'a [usize],
    /// From the lowest node of a row's nodes to that of its cell.
    below: usize,
    per_cell: f64,
}

impl<'a, const D: usize> CompositeRows<'a, D> {
    /// The composite gradient at `points` points, whose cells are known.
    #[inline(always)]
    pub fn new(grid: &Grid<D>, cells: &'a Cells<D>, points: usize) -> Self {
        Self {
            cells: &cells.of_point[..points],
            within: &cells.within[..points],
            sides: cells.reached_sides(),
            first_nodes: cells.first_nodes(),
            below: grid.node_stride().iter().sum(),
            per_cell: grid.inverse_cell_size(),
        }
    }

    /// Gradients of a point's nodes.
    #[inline(always)]
    pub fn block(&self, point: usize) -> Block<D, 4> {
        let (cell, within) = (self.cells[point], &self.within[point]);
        let sides = &self.sides[cell];
        let mut rows = [[[0.0; 4]; 2]; D];
        for d in 0..D {
            rows[d] = composite(within[d], sides[d]);
            if D == 1 {
                // Values are factors of the gradients of other directions: on a line there are none.
                rows[d][0] = [0.0; 4];
            }
        }
        Block::from_lines(self.first_nodes[cell] - self.below, &rows, self.per_cell)
    }

    /// Gradients of a nodal vector field, `[point][component][direction]`, at [`LANES`] neighbours from one on, side by side
    /// where all are in one cell; the same bits as by the block of each.
    #[inline(always)]
    fn gradients(
        &self,
        first: usize,
        stride: &[usize; D],
        field: &[Vector<D>],
    ) -> Option<[Tensor<D>; LANES]> {
        let (cells, within) = (&self.cells[first..first + LANES], &self.within[first..first + LANES]);
        let cell = cells[0];
        if *cells != [cell; LANES] {
            return None;
        }
        let mut rows = [[[[0.0; LANES]; 4]; 2]; D];
        for d in 0..D {
            let mut place = [0.0; LANES];
            for p in 0..LANES {
                place[p] = within[p][d];
            }
            rows[d] = composite_of_each(&place, self.sides[cell][d]);
            for slope in rows[d][1].as_flattened_mut() {
                *slope *= self.per_cell;
            }
        }
        // `[direction][component][point]`.
        let mut slopes = [[[0.0; LANES]; D]; D];
        let lowest = self.first_nodes[cell] - self.below;
        for run in 0..power(4, D - 1) {
            let nodes = &field[lowest + run * stride[D - 1]..][..4];
            // The slope along the run, and the value.
            let mut sums = [[[0.0; LANES]; D]; 2];
            for d in 0..D {
                for p in 0..LANES {
                    sums[0][d][p] = rows[0][1][0][p] * nodes[0][d];
                    sums[1][d][p] = rows[0][0][0][p] * nodes[0][d];
                }
                for k in 1..4 {
                    for p in 0..LANES {
                        sums[0][d][p] += rows[0][1][k][p] * nodes[k][d];
                    }
                    for p in 0..LANES {
                        sums[1][d][p] += rows[0][0][k][p] * nodes[k][d];
                    }
                }
            }
            if D == 1 {
                slopes[0] = sums[0];
                continue;
            }
            for direction in 0..D {
                for d in 0..D {
                    for p in 0..LANES {
                        slopes[direction][d][p] += rows[D - 1][direction][run][p] * sums[direction][d][p];
                    }
                }
            }
        }
        // In memory point beside point: otherwise the compiler sums tensor by tensor, and shuffles every factor.
        let slopes = black_box(slopes);
        let mut gradients = [[[0.0; D]; D]; LANES];
        for p in 0..LANES {
            for d in 0..D {
                for direction in 0..D {
                    gradients[p][d][direction] = slopes[direction][d][p];
                }
            }
        }
        Some(gradients)
    }

    /// Gradients of a nodal vector field at all points, `[point][component][direction]`.
    #[inline(always)]
    pub fn take_gradients(self, stride: &[usize; D], field: &[Vector<D>], gradients: &mut [Tensor<D>]) {
        let mut point = 0;
        while point < gradients.len() {
            let together =
                if point + LANES <= gradients.len() { self.gradients(point, stride, field) } else { None };
            if let Some(together) = together {
                *some_mut(gradients, point) = together;
                point += LANES;
            } else {
                gradients[point] = self.block(point).stencil().gradient(stride, field);
                point += 1;
            }
        }
    }
}

/// [`composite`] at places within one cell, side by side.
#[inline(always)]
fn composite_of_each<const N: usize>(places: &[f64; N], neighbours: [bool; 2]) -> [[[f64; N]; 4]; 2] {
    // Each a loop without a branch.
    match neighbours {
        [true, true] => rows_of_each(places, [true, true]),
        [true, false] => rows_of_each(places, [true, false]),
        [false, true] => rows_of_each(places, [false, true]),
        [false, false] => rows_of_each(places, [false, false]),
    }
}

#[inline(always)]
fn rows_of_each<const N: usize>(places: &[f64; N], neighbours: [bool; 2]) -> [[[f64; N]; 4]; 2] {
    let mut rows = [[[0.0; N]; 4]; 2];
    for p in 0..N {
        let [values, gradients] = composite(places[p], neighbours);
        for k in 0..4 {
            (rows[0][k][p], rows[1][k][p]) = (values[k], gradients[k]);
        }
    }
    rows
}

/// Lagrange interpolation through the nodes of a cell and of its neighbours, where those are there, for the composite
/// MPM (González Acosta, Vardon & Hicks 2017): cubic with both neighbours, quadratic with the lower or the upper one,
/// linear with none. Values and gradients at a place within the cell, in cells, always of four nodes from the one below
/// the cell.
#[inline(always)]
fn composite(x: f64, neighbours: [bool; 2]) -> [[f64; 4]; 2] {
    match neighbours {
        [true, true] => [
            [
                -SIXTH * x * (x - 1.0) * (x - 2.0),
                0.5 * (x + 1.0) * (x - 1.0) * (x - 2.0),
                -0.5 * (x + 1.0) * x * (x - 2.0),
                SIXTH * (x + 1.0) * x * (x - 1.0),
            ],
            [
                x - 0.5 * x * x - 2.0 * SIXTH,
                0.5 * (3.0 * x * x - 4.0 * x - 1.0),
                -0.5 * (3.0 * x * x - 2.0 * x - 2.0),
                0.5 * x * x - SIXTH,
            ],
        ],
        [true, false] => [
            [x * (x - 1.0) / 2.0, (1.0 + x) * (1.0 - x), x * (x + 1.0) / 2.0, 0.0],
            [x - 0.5, -2.0 * x, x + 0.5, 0.0],
        ],
        [false, true] => [
            [0.0, (x - 1.0) * (x - 2.0) / 2.0, x * (2.0 - x), x * (x - 1.0) / 2.0],
            [0.0, x - 1.5, 2.0 - 2.0 * x, x - 0.5],
        ],
        [false, false] => [[0.0, 1.0 - x, x, 0.0], [0.0, -1.0, 1.0, 0.0]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::basis::moments;
    use crate::state::points::Points;
    use oedometer_soil::material::Material;
    use proptest::prelude::*;

    fn assert_same_side_by_side<const D: usize>() {
        let (grid, soils) = (Grid::new(0.5, [3; D]), [Material::default()]);
        let mut points = Points::<D>::lattice(0.5, [3; D], 4);
        points.take_soils(&soils);
        points.position.iter_mut().flatten().for_each(|place| *place *= 0.93);
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, &soils);
        cells.find_reached(&grid, &points);
        let wave = |node: usize| std::array::from_fn(|d| (1.3 * node as f64 + d as f64).sin());
        let field: Vec<Vector<D>> = (0..grid.node_count()).map(wave).collect();
        let (rows, stride) = (CompositeRows::new(&grid, &cells, points.len()), grid.node_stride());
        let mut together = 0;
        for first in 0..=points.len() - LANES {
            let Some(gradients) = rows.gradients(first, stride, &field) else { continue };
            together += 1;
            for p in 0..LANES {
                let alone = rows.block(first + p).stencil().gradient(stride, &field);
                assert_eq!(gradients[p], alone, "point {}", first + p);
            }
        }
        assert!(together > 0 && together < points.len() - LANES, "{together} lie in one cell");
    }

    #[test]
    fn gradients_side_by_side_are_those_of_each_block() {
        assert_same_side_by_side::<1>();
        assert_same_side_by_side::<2>();
    }

    #[test]
    fn a_domain_longer_than_a_cell_reaches_as_far_as_one_of_a_cell() {
        let (grid, soils) = (Grid::new(0.5, [4]), [Material::default()]);
        let mut points = Points::<1>::lattice(0.5, [4], 2);
        points.take_soils(&soils);
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, &soils);
        cells.find_reached(&grid, &points);
        let between_ends = |half: f64| {
            let mut operator = StrainOperator::new(StrainGradient::CmpmEnds, points.len());
            operator.build(&grid, &cells, &vec![[half]; points.len()]);
            operator.carrier().expect("ends").clone()
        };
        assert_eq!(between_ends(0.3), between_ends(0.25));
        assert_ne!(between_ends(0.2), between_ends(0.25));
    }

    proptest! {
        #[test]
        fn a_row_between_ends_adds_up_to_the_field(low in 3.0..8.0f64, length in 0.05..0.9f64) {
            // Cubic fields are met exactly at both ends, so their difference is too.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let row_at = |x: f64| {
                let cell = x as usize;
                let [values, gradients] = composite(x - cell as f64, [true, true]);
                Row { first: cell - 1, values, gradients }
            };
            let row = Row::between::<6>(&row_at(low), &row_at(low + length), length);
            let cubic = |x: f64| x * x * x - 4.0 * x;
            let (mean, slope) = moments(&row, cubic);
            prop_assert!((mean - 0.5 * (cubic(low) + cubic(low + length))).abs() < 1e-10);
            prop_assert!((slope - (cubic(low + length) - cubic(low)) / length).abs() < 1e-9);
        }

        #[test]
        fn composite_gradient_is_exact_for_its_degree(x in 0.0..1.0f64, lower: bool, upper: bool) {
            let [values, gradients] = composite(x, [lower, upper]);
            let row = Row { first: 4, values, gradients };
            let degree = 1 + i32::from(lower) + i32::from(upper);
            for power in 0..=degree {
                let (value, gradient) = moments(&row, |node| (node - 5.0).powi(power));
                let exact = if power == 0 { 0.0 } else { f64::from(power) * x.powi(power - 1) };
                prop_assert!((value - x.powi(power)).abs() < 1e-13);
                prop_assert!((gradient - exact).abs() < 1e-12, "power {power}: {gradient} for {exact}");
            }
        }
    }
}
