//! The strain gradient `G`: from nodal velocities to the strain of the effective stress, and what
//! carries the points with it.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::method::StrainGradient;
use crate::mpm::operators::shape;
use crate::mpm::operators::shape::Row;
use crate::mpm::operators::stencil::{Blocks, Stencils};
use crate::mpm::state::cells::Cells;
use crate::mpm::state::grid::Grid;
use crate::soil::tensor::{Tensor, Vector};

/// Nodes a direction between the ends of a domain: four at either end, at most one cell apart.
pub const ENDS_WIDTH: usize = 5;
/// Ends are looked up this far inside their domain, in cells: an end on a face belongs to its own
/// domain's cell.
const INSET: f64 = 1e-9;

/// `G` of all points by the method's choice.
#[derive(Clone, Copy, Debug)]
pub(crate) enum StrainBlocks<'a, const D: usize, const W: usize> {
    Basis(Blocks<'a, D, W>),
    Composite(Blocks<'a, D, 4>),
    BetweenEnds(Blocks<'a, D, ENDS_WIDTH>),
}

impl<'a, const D: usize, const W: usize> StrainBlocks<'a, D, W> {
    /// Those of a choice; only its own stencils are set.
    #[inline]
    pub(crate) fn of(
        strain: StrainGradient,
        basis: &'a Stencils<D, W>,
        composite: &'a Stencils<D, 4>,
        between_ends: &'a Stencils<D, ENDS_WIDTH>,
    ) -> Self {
        match strain {
            StrainGradient::Standard | StrainGradient::Bbar => Self::Basis(basis.blocks()),
            StrainGradient::Cmpm | StrainGradient::CmpmBbar => Self::Composite(composite.blocks()),
            StrainGradient::CmpmEnds => Self::BetweenEnds(between_ends.blocks()),
        }
    }

    /// Gradient of a nodal field at a point.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn gradient(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Tensor<D> {
        match self {
            Self::Basis(blocks) => blocks.gradient(stride, point, field),
            Self::Composite(blocks) => blocks.gradient(stride, point, field),
            Self::BetweenEnds(blocks) => blocks.gradient(stride, point, field),
        }
    }
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Body<D, W, S> {
    /// Gradient of a nodal field at a point, from which the effective stress takes its strain.
    #[inline]
    pub fn strain_gradient(&self, point: usize, field: &[Vector<D>]) -> Tensor<D> {
        StrainBlocks::of(self.method.strain, &self.basis, &self.composite, &self.between_ends).gradient(
            self.grid.node_stride(),
            point,
            field,
        )
    }

    /// Visits the nodes that a point's strain depends on, with their gradients, 1/m.
    pub fn visit_strain(&self, point: usize, mut node_visitor: impl FnMut(usize, &Vector<D>)) {
        let stride = self.grid.node_stride();
        let visitor = |node: usize, _: f64, gradient: &Vector<D>| node_visitor(node, gradient);
        match self.method.strain {
            StrainGradient::Standard | StrainGradient::Bbar => self.basis.visit(stride, point, visitor),
            StrainGradient::Cmpm | StrainGradient::CmpmBbar => self.composite.visit(stride, point, visitor),
            StrainGradient::CmpmEnds => self.between_ends.visit(stride, point, visitor),
        }
    }

    /// What carries a point under a nodal velocity or displacement: the value of the basis, or the
    /// mean of its domain's ends where those are what its strain is taken between.
    #[inline]
    pub fn carrying(&self, point: usize, field: &[Vector<D>], of_basis: Vector<D>) -> Vector<D> {
        match self.method.strain {
            StrainGradient::CmpmEnds => self.between_ends.value(self.grid.node_stride(), point, field),
            _ => of_basis,
        }
    }

    /// Builds `G` of every point where it is not that of the basis.
    pub(crate) fn build_strain_gradients(&mut self) {
        match self.method.strain {
            StrainGradient::Standard | StrainGradient::Bbar => {}
            StrainGradient::Cmpm | StrainGradient::CmpmBbar => {
                let (grid, cells) = (&self.grid, &self.cells);
                for (point, place) in cells.place.iter().enumerate() {
                    let cell = grid.cell_at(place);
                    let rows =
                        std::array::from_fn(|d| composite_row(grid, cells, &cell, d, place[d], cell[d]));
                    self.composite.set_gradients(grid, point, &rows);
                }
            }
            StrainGradient::CmpmEnds => {
                let (grid, cells) = (&self.grid, &self.cells);
                let per_cell = grid.inverse_cell_size();
                for (point, place) in cells.place.iter().enumerate() {
                    let cell = grid.cell_at(place);
                    let rows = std::array::from_fn(|d| {
                        let half = (self.points.half_length[point][d] * per_cell).min(0.5);
                        let end = |side: f64| {
                            let at = place[d] + side * half;
                            let along = grid.cell_below(at - side * INSET).clamp(cell[d] - 1, cell[d] + 1);
                            composite_row(grid, cells, &cell, d, at, along)
                        };
                        Row::between(&end(-1.0), &end(1.0), 2.0 * half)
                    });
                    self.between_ends.set(grid, point, &rows);
                }
            }
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
    shape::composite(at, along, lower, upper)
}
