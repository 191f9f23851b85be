//! The background grid: square cells of one size, addressed by node and by cell.
//!
//! Two layers of ghost nodes surround the grid, so that no stencil needs a bounds case. The last
//! direction is vertical; a column is `D = 1`, plane strain `D = 2` with `x` first.

use oedometer_soil::tensor::Vector;

/// Layers of nodes beyond the grid on every side.
pub const GHOST_LAYERS: usize = 2;

/// Points closer to a cell face than this share of a cell belong to the upper cell.
const FACE_TOLERANCE: f64 = 1e-10;

/// No division in the step's innermost loops.
pub(crate) const SIXTH: f64 = 1.0 / 6.0;

/// Integer part of a coordinate in cells; 32 bits convert several times faster than 64.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "coordinates in cells are positive, the ghost layers see to it"
)]
pub(crate) fn integer_part(in_cells: f64) -> usize {
    in_cells as u32 as usize
}

/// `base^exponent`, for the nodes or cells of a block.
#[inline]
pub const fn power(base: usize, exponent: usize) -> usize {
    let mut product = 1;
    let mut factor = 0;
    while factor < exponent {
        product *= base;
        factor += 1;
    }
    product
}

/// Index of the cell, in one direction, that holds a coordinate in cells.
#[inline]
pub fn cell_below(in_cells: f64) -> usize {
    integer_part(in_cells + FACE_TOLERANCE)
}

/// A regular grid of square cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<const D: usize> {
    /// Edge of a cell, m.
    pub cell_size: f64,
    /// Cells in each direction, ghosts not counted.
    pub cells: [usize; D],
    inverse_cell_size: f64,
    node_stride: [usize; D],
    cell_stride: [usize; D],
}

impl<const D: usize> Grid<D> {
    /// A grid of `cells` cells of edge `cell_size` (m) with its lowest corner at the origin.
    pub fn new(cell_size: f64, cells: [usize; D]) -> Self {
        let mut node_stride = [1; D];
        let mut cell_stride = [1; D];
        for direction in 1..D {
            let below = cells[direction - 1] + 2 * GHOST_LAYERS;
            node_stride[direction] = node_stride[direction - 1] * (below + 1);
            cell_stride[direction] = cell_stride[direction - 1] * below;
        }
        Self { cell_size, cells, inverse_cell_size: 1.0 / cell_size, node_stride, cell_stride }
    }

    /// Number of nodes, ghosts included.
    pub fn node_count(&self) -> usize {
        self.node_stride[D - 1] * (self.cells[D - 1] + 2 * GHOST_LAYERS + 1)
    }

    /// Number of cells, ghosts included.
    pub fn cell_count(&self) -> usize {
        self.cell_stride[D - 1] * (self.cells[D - 1] + 2 * GHOST_LAYERS)
    }

    /// Steps in the flat node index to the next node of each direction.
    #[inline]
    pub fn node_stride(&self) -> &[usize; D] {
        &self.node_stride
    }

    /// Steps in the flat cell index to the next cell of each direction.
    #[inline]
    pub fn cell_stride(&self) -> &[usize; D] {
        &self.cell_stride
    }

    /// `1 / cell_size`, 1/m.
    #[inline]
    pub fn inverse_cell_size(&self) -> f64 {
        self.inverse_cell_size
    }

    /// Coordinate in cells, counted from the lowest ghost node: always positive inside the grid.
    #[inline]
    pub fn in_cells(&self, coordinate: f64) -> f64 {
        coordinate * self.inverse_cell_size + GHOST_LAYERS as f64
    }

    /// Whether a point lies in the grid or on its rim.
    pub fn holds(&self, position: &Vector<D>) -> bool {
        (0..D).all(|direction| {
            let cells = position[direction] * self.inverse_cell_size;
            cells >= -FACE_TOLERANCE && cells <= self.cells[direction] as f64 + FACE_TOLERANCE
        })
    }

    /// Coordinates in cells, held inside the grid: a run that has left it is ended by name at its
    /// next check, and until then no index may leave the arrays.
    #[inline]
    pub fn held_in_cells(&self, position: &Vector<D>) -> Vector<D> {
        let lowest = GHOST_LAYERS as f64;
        // `max` and `min`, not `clamp`: they turn a NaN into a place.
        let mut place = *position;
        for d in 0..D {
            place[d] = self.in_cells(place[d]).max(lowest).min(lowest + self.cells[d] as f64);
        }
        place
    }

    /// Index, a direction, of the cell that holds a place in cells inside the grid; the upper rim
    /// belongs to the last cell.
    #[inline]
    pub fn cell_at(&self, held_in_cells: &Vector<D>) -> [usize; D] {
        self.whole_cell_at(held_in_cells).map(integer_part)
    }

    /// That index as whole numbers of the kind that wide registers hold.
    #[inline]
    pub fn whole_cell_at(&self, held_in_cells: &Vector<D>) -> Vector<D> {
        let mut cell = *held_in_cells;
        for d in 0..D {
            let last = (self.cells[d] + GHOST_LAYERS - 1) as f64;
            cell[d] = (held_in_cells[d] + FACE_TOLERANCE).floor().min(last);
        }
        cell
    }

    /// Place in a cell of an index, a whole number a direction, from its lowest corner, of a place in cells.
    #[inline]
    pub fn within_cell(&self, index: &Vector<D>, place: &Vector<D>) -> Vector<D> {
        let mut within = *place;
        for d in 0..D {
            within[d] -= index[d];
        }
        within
    }

    /// Index, a direction, of the cell that holds a point.
    #[inline]
    pub fn cell_of(&self, position: &Vector<D>) -> [usize; D] {
        self.cell_at(&self.held_in_cells(position))
    }

    /// Flat index of a cell.
    #[inline]
    pub fn flat_cell(&self, cell: &[usize; D]) -> usize {
        (0..D).map(|d| cell[d] * self.cell_stride[d]).sum()
    }

    /// Index, a direction, of a cell by its flat one.
    #[inline]
    pub fn cell_index(&self, flat: usize) -> [usize; D] {
        let mut rest = flat;
        let mut index = [0; D];
        for direction in (0..D).rev() {
            index[direction] = rest / self.cell_stride[direction];
            rest %= self.cell_stride[direction];
        }
        index
    }

    /// Flat index of a node.
    #[inline]
    pub fn flat_node(&self, node: &[usize; D]) -> usize {
        (0..D).map(|d| node[d] * self.node_stride[d]).sum()
    }

    /// Corners of a cell from its lowest: bit `d` of a corner's number says that it is the upper one in
    /// direction `d`.
    #[inline]
    pub fn corners(&self, first_node: usize) -> impl Iterator<Item = usize> + use<D> {
        let stride = self.node_stride;
        (0..1_usize << D)
            .map(move |corner| first_node + (0..D).map(|d| (corner >> d & 1) * stride[d]).sum::<usize>())
    }

    /// Place of a node, m.
    pub fn node_position(&self, flat: usize) -> Vector<D> {
        let mut rest = flat;
        let mut position = [0.0; D];
        for direction in (0..D).rev() {
            let index = rest / self.node_stride[direction];
            rest %= self.node_stride[direction];
            position[direction] = (index as f64 - GHOST_LAYERS as f64) * self.cell_size;
        }
        position
    }

    /// Centre of a cell, m.
    pub fn cell_centre(&self, flat: usize) -> Vector<D> {
        let mut rest = flat;
        let mut centre = [0.0; D];
        for direction in (0..D).rev() {
            let index = rest / self.cell_stride[direction];
            rest %= self.cell_stride[direction];
            centre[direction] = (index as f64 + 0.5 - GHOST_LAYERS as f64) * self.cell_size;
        }
        centre
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_and_a_cell_are_found_where_they_were_put() {
        let grid = Grid::new(0.25, [3, 4]);
        let node = grid.flat_node(&[GHOST_LAYERS + 2, GHOST_LAYERS + 1]);
        assert_eq!(grid.node_position(node), [0.5, 0.25]);
        let cell = grid.flat_cell(&grid.cell_of(&[0.3, 0.9]));
        assert_eq!(grid.cell_centre(cell), [0.375, 0.875]);
        assert!(cell < grid.cell_count() && node < grid.node_count());
    }

    #[test]
    fn a_point_on_a_face_has_one_cell_whatever_its_last_bit() {
        let grid = Grid::new(0.1, [10]);
        for nudge in [-1e-14, 0.0, 1e-14] {
            assert_eq!(grid.cell_of(&[0.3 + nudge]), [GHOST_LAYERS + 3]);
        }
        assert_eq!(grid.cell_of(&[1.0]), [GHOST_LAYERS + 9], "the rim belongs to the last cell");
        assert!(grid.holds(&[1.0]) && !grid.holds(&[1.01]) && !grid.holds(&[-0.01]));
    }
}
