//! The strain gradient `G`: from nodal velocities to the strain of the effective stress, and what carries the
//! points with it.
//!
//! `∇v(x_p) = Σ_i v_i ⊗ ∇N_i(x_p)`, `[component][direction]`, with the gradients of the basis, of the Lagrange
//! interpolant through the nodes of the cell and its neighbours (composite MPM), or of that interpolant between
//! the ends of the point's domain.

use crate::method::StrainGradient;
use crate::operators::block_rows::{Blocks, LaneRows};
use crate::operators::row::Row;
use crate::operators::stencil::{PointStencils, Stencils};
use crate::state::cells::Cells;
use crate::state::grid::{Grid, Line, SIXTH, cell_below};
use crate::state::lanes::{LANES, Lanes};
use crate::wide::wide;
use oedometer_soil::tensor::{Tensor, Vector};

/// Nodes per direction between the ends of a domain: four at either end, at most one cell apart.
pub const ENDS_WIDTH: usize = 5;
/// Ends are looked up this far inside their domain, in cells: an end on a face belongs to its own
/// domain's cell.
const INSET: f64 = 1e-9;

/// `G` of a method, with its stencils where they are not those of the basis.
#[derive(Clone, Debug, Default)]
pub enum StrainOperator<const D: usize> {
    /// That of the basis.
    #[default]
    Basis,
    /// That of the composite MPM.
    Composite(Stencils<D, 4>),
    /// The same between the ends of the domains, and what carries the points then.
    BetweenEnds(Stencils<D, ENDS_WIDTH>),
}

impl<const D: usize> StrainOperator<D> {
    /// The operator of a choice, with room for so many points.
    pub fn of(strain: StrainGradient, points: usize) -> Self {
        match strain {
            StrainGradient::Standard | StrainGradient::Bbar => Self::Basis,
            StrainGradient::Cmpm | StrainGradient::CmpmBbar => Self::Composite(Stencils::with_points(points)),
            StrainGradient::CmpmEnds => Self::BetweenEnds(Stencils::with_points(points)),
        }
    }

    /// Brings the stencils up to the points' places; half-lengths of the domains in m, `[point][direction]`.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>, half_length: &[Vector<D>]) {
        let (places, per_cell) = (cells.place.iter().enumerate(), grid.inverse_cell_size());
        match self {
            Self::Basis => {}
            Self::Composite(stencils) => {
                wide!(stencils.set_lanes(
                    grid,
                    &cells.place,
                    #[inline(always)]
                    |_, direction, place, rows| {
                        if grid.cells[direction] == 1 {
                            fill_linear_rows(grid.line(direction), place, rows)
                        } else {
                            fill_composite_rows::<D>(grid.line(direction), place, rows)
                        }
                    },
                ));
                // Where a neighbour is missing, the polynomial is of a lower degree.
                let cut = cells.runs().iter().filter(|(home, _)| !cells.is_reached_around(*home));
                for (home, points) in cut.cloned() {
                    let cell = grid.cell_at(&cells.place[points.start]);
                    for d in 0..D {
                        let stride = grid.cell_stride()[d];
                        let sides = (cells.is_reached(home - stride), cells.is_reached(home + stride));
                        if sides != (true, true) && grid.cells[d] > 1 {
                            for point in points.clone() {
                                let row = composite(cells.place[point][d], cell[d], sides.0, sides.1);
                                stencils.set_row(grid, point, d, &row);
                            }
                        }
                    }
                }
            }
            Self::BetweenEnds(stencils) => {
                for (point, place) in places {
                    let cell = grid.cell_at(place);
                    let rows = std::array::from_fn(|d| {
                        let half = (half_length[point][d] * per_cell).min(0.5);
                        let end = |side: f64| {
                            let at = place[d] + side * half;
                            let along = cell_below(at - side * INSET).clamp(cell[d] - 1, cell[d] + 1);
                            composite_row(grid, cells, &cell, d, at, along)
                        };
                        Row::between(&end(-1.0), &end(1.0), 2.0 * half)
                    });
                    stencils.set(grid, point, &rows);
                }
            }
        }
    }

    /// Lowest node of each point's stencil, where it is not that of the basis.
    pub fn first(&self) -> &[usize] {
        match self {
            Self::Basis => &[],
            Self::Composite(stencils) => &stencils.first,
            Self::BetweenEnds(stencils) => &stencils.first,
        }
    }

    /// What carries the points under a nodal field where it is not the value of the basis: the mean of the ends
    /// of their domains, where those are what the strain is taken between.
    #[inline]
    pub(crate) fn carrier(&self) -> Option<Blocks<'_, D, ENDS_WIDTH>> {
        match self {
            Self::BetweenEnds(stencils) => Some(stencils.blocks()),
            Self::Basis | Self::Composite(_) => None,
        }
    }

    /// Gradient of a nodal field at a point, `[component][direction]`.
    #[inline]
    pub fn gradient(
        &self,
        basis: &PointStencils<D>,
        stride: &[usize; D],
        point: usize,
        field: &[Vector<D>],
    ) -> Tensor<D> {
        match self {
            Self::Basis => basis.gradient(stride, point, field),
            Self::Composite(stencils) => stencils.blocks().gradient(stride, point, field),
            Self::BetweenEnds(stencils) => stencils.blocks().gradient(stride, point, field),
        }
    }

    /// Visits the nodes that a point's strain depends on, with their gradients, 1/m.
    #[inline]
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
            Self::Composite(stencils) => stencils.visit(stride, point, visitor),
            Self::BetweenEnds(stencils) => stencils.visit(stride, point, visitor),
        }
    }
}

/// Composite interpolation at a place of the cell `along` in one direction from `cell`.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn composite_row<const D: usize>(
    grid: &Grid<D>,
    cells: &Cells<D>,
    cell: &[usize; D],
    direction: usize,
    at: f64,
    along: usize,
) -> Row<4> {
    let mut place = *cell;
    place[direction] = along;
    let home = grid.flat_cell(&place);
    let stride = grid.cell_stride()[direction];
    let (lower, upper) = (cells.is_reached(home - stride), cells.is_reached(home + stride));
    composite(at, along, lower, upper)
}

/// Fills the rows of some points along a direction, at places in cells both of whose neighbours are there; returns the
/// lowest node of each.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn fill_composite_rows<const D: usize>(line: Line, place: &Lanes, rows: &mut LaneRows<4>) -> Lanes {
    let mut lowest = [0.0; LANES];
    for lane in 0..LANES {
        let cell = line.cell_at(place[lane]);
        let [weights, gradients] = cubic(place[lane] - cell);
        lowest[lane] = cell - 1.0;
        for k in 0..4 {
            // A line has no use for the weights: of the rows only gradients are asked.
            if D > 1 {
                rows.weights[k][lane] = weights[k];
            }
            rows.gradients[k][lane] = gradients[k] * line.per_cell;
        }
    }
    lowest
}

/// The same in a direction of one cell, which has no neighbours.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn fill_linear_rows(line: Line, place: &Lanes, rows: &mut LaneRows<4>) -> Lanes {
    let mut lowest = [0.0; LANES];
    for lane in 0..LANES {
        let cell = line.cell_at(place[lane]);
        let x = place[lane] - cell;
        (rows.weights[1][lane], rows.weights[2][lane]) = (1.0 - x, x);
        lowest[lane] = cell - 1.0;
    }
    let [none, slope] = [0.0, line.per_cell].map(|slope| [slope; LANES]);
    (rows.weights[0], rows.weights[3]) = (none, none);
    rows.gradients = [none, slope.map(|slope| -slope), slope, none];
    lowest
}

/// The cubic through four nodes at −1, 0, 1 and 2: weights and gradients.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn cubic(x: f64) -> [[f64; 4]; 2] {
    [
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
    ]
}

/// Lagrange interpolation through the nodes of a cell and of its neighbours, for the composite
/// MPM (González Acosta, Vardon & Hicks 2017): cubic with both neighbours, quadratic with one,
/// linear with none. Always written as four weights from the node below the cell.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn composite(place: f64, cell: usize, has_lower: bool, has_upper: bool) -> Row<4> {
    // Local coordinate with the cell's own nodes at 0 and 1.
    let x = place - cell as f64;
    let [weights, gradients] = match (has_lower, has_upper) {
        (true, true) => cubic(x),
        (true, false) => [
            [x * (x - 1.0) / 2.0, (1.0 + x) * (1.0 - x), x * (x + 1.0) / 2.0, 0.0],
            [x - 0.5, -2.0 * x, x + 0.5, 0.0],
        ],
        (false, true) => [
            [0.0, (x - 1.0) * (x - 2.0) / 2.0, x * (2.0 - x), x * (x - 1.0) / 2.0],
            [0.0, x - 1.5, 2.0 - 2.0 * x, x - 0.5],
        ],
        (false, false) => [[0.0, 1.0 - x, x, 0.0], [0.0, -1.0, 1.0, 0.0]],
    };
    Row { first: cell - 1, weights, gradients }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::row::moments;
    use crate::state::lanes::FOUR;
    use crate::state::points::Points;
    use proptest::prelude::*;

    #[test]
    fn rows_of_a_column_of_one_cell_across_are_those_of_its_cells_one_by_one() {
        let (grid, mut points) = (Grid::new(0.5, [1, 4]), Points::<2>::lattice(0.5, [1, 4], 2));
        for (point, place) in points.position.iter_mut().enumerate() {
            let nudge = 0.02 * (1.7 * point as f64).sin();
            *place = [place[0] + nudge, place[1] - nudge];
        }
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, 0.3);
        cells.find_reached(&grid, &points);
        let mut operator = StrainOperator::of(StrainGradient::Cmpm, points.len());
        operator.build(&grid, &cells, &points.half_length);
        let StrainOperator::Composite(built) = operator else { unreachable!("it is composite") };
        let mut expected = Stencils::<2, 4>::with_points(points.len());
        for (point, place) in cells.place.iter().enumerate() {
            let cell = grid.cell_at(place);
            let rows = std::array::from_fn(|d| composite_row(&grid, &cells, &cell, d, place[d], cell[d]));
            expected.set(&grid, point, &rows);
        }
        let field: Vec<Vector<2>> = (0..grid.node_count())
            .map(|node| [(0.7 * node as f64).sin(), (1.3 * node as f64).cos()])
            .collect();
        for point in 0..points.len() {
            let of = |stencils: &Stencils<2, 4>| {
                let (blocks, stride) = (stencils.blocks(), grid.node_stride());
                (blocks.gradient(stride, point, &field), blocks.value(stride, point, &field))
            };
            assert_eq!(of(&built), of(&expected), "point {point}");
        }
        let (blocks, stride) = (built.blocks(), grid.node_stride());
        for first in (0..points.len()).step_by(FOUR) {
            let together = blocks.four(first).gradients::<FOUR>(stride, 0, &field);
            for (point, gradient) in together.iter().enumerate() {
                assert_eq!(*gradient, blocks.gradient(stride, first + point, &field), "with others or alone");
            }
        }
    }

    #[test]
    fn points_of_a_line_have_the_same_gradients_with_others_and_alone() {
        let grid = Grid::new(0.5, [6]);
        let mut stencils = Stencils::<1, 4>::with_points(12);
        let field: Vec<Vector<1>> = (0..grid.node_count()).map(|node| [(1.3 * node as f64).cos()]).collect();
        for point in 0..12 {
            // Four of one cell, four of two, and four of which the last is beside them.
            let cell = [4, 4, 4, 4, 5, 5, 6, 6, 7, 7, 7, 6][point];
            let row = composite(cell as f64 + 0.07 * (1 + point) as f64, cell, true, true);
            stencils.set(&grid, point, &[row]);
        }
        let (blocks, stride) = (stencils.blocks(), grid.node_stride());
        for first in [0, 4, 8] {
            let together = blocks.four(first).gradients::<FOUR>(stride, 0, &field);
            for (point, gradient) in together.iter().enumerate() {
                assert_eq!(*gradient, blocks.gradient(stride, first + point, &field));
            }
        }
    }

    proptest! {
        #[test]
        fn a_row_between_ends_adds_up_to_the_field(low in 3.0..8.0f64, length in 0.05..0.9f64) {
            // Cubic fields are met exactly at both ends, so their difference is too.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let row_at = |x: f64| composite(x, x as usize, true, true);
            let row = Row::between::<6>(&row_at(low), &row_at(low + length), length);
            let cubic = |x: f64| x * x * x - 4.0 * x;
            let (mean, slope) = moments(&row, cubic);
            prop_assert!((mean - 0.5 * (cubic(low) + cubic(low + length))).abs() < 1e-10);
            prop_assert!((slope - (cubic(low + length) - cubic(low)) / length).abs() < 1e-9);
        }

        #[test]
        fn composite_gradient_is_exact_for_its_degree(x in 0.0..1.0f64, lower: bool, upper: bool) {
            let row = composite(5.0 + x, 5, lower, upper);
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
