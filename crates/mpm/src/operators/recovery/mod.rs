//! `R`: from the sites of the divergence, cells or points, to the points (docs/theory.md, section 3).
//!
//! Every recovery that has to look at all sites first has a `fit`; `value` is what a point recovers, and `row` or
//! `rows` are the sites that it recovers its value from, with their shares. Which one a method takes is chosen here and
//! nowhere else.

mod nodal;
mod null_space;
mod patch;
pub mod points_in_cells;

use crate::operators::recovery::nodal::{NodalMeans, Sites};
use crate::operators::recovery::null_space::CellPlanes;
use crate::operators::recovery::patch::PatchRows;
use crate::operators::recovery::points_in_cells::PointsInCells;
use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::wide::wide;
use oedometer_problem::method::{Method, Recovery};

/// `R` of a method, with what it keeps from step to step.
#[derive(Clone, Debug)]
pub enum RecoveryOperator<const D: usize> {
    /// The sites are the points, and each keeps its own value.
    Own,
    /// Each point takes the value of its cell.
    Constant,
    /// A plane fitted to the cells around each point.
    Patch(PatchRows<D>),
    /// Means at the nodes.
    Nodal(NodalMeans),
    /// Values at the points without the part that no nodal force feels.
    NullSpace(CellPlanes<D>),
    /// The sites are the nodes, whose values are interpolated.
    Interpolated,
}

impl<const D: usize> RecoveryOperator<D> {
    /// The operator of a method, sized for a grid and `points` points.
    pub fn new(method: Method, grid: &Grid<D>, points: usize) -> Self {
        match (method.pressure.is_by_cells(), method.recovery) {
            (false, Recovery::NullSpace) => Self::NullSpace(CellPlanes::with_cells(grid.cell_count())),
            (false, Recovery::Nodal) => Self::Nodal(NodalMeans::new(Sites::Points, grid.node_count())),
            (false, Recovery::Constant | Recovery::Patch | Recovery::PatchSoils) => Self::Own,
            (false, Recovery::Ppp) => Self::Interpolated,
            (true, Recovery::Patch | Recovery::PatchSoils) => Self::Patch(PatchRows::new(points, grid)),
            (true, Recovery::Nodal) => Self::Nodal(NodalMeans::new(Sites::Cells, grid.node_count())),
            (true, Recovery::Constant | Recovery::NullSpace | Recovery::Ppp) => Self::Constant,
        }
    }

    /// Updates the operator to the points' places.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        if let Self::Patch(rows) = self {
            wide!(rows.build(grid, cells));
        }
    }

    /// Updates the operator to the points' places for a step that uses every row once: each row is made where it is used.
    pub fn look_around(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        if let Self::Patch(rows) = self {
            rows.look_around(grid, cells);
        }
    }

    /// Fits patches anew to the cells that hold the soil of each point, the number of which is given.
    pub fn keep_to_soils(&mut self, grid: &Grid<D>, cells: &Cells<D>, soils: &[u8]) {
        if let Self::Patch(rows) = self {
            rows.keep_to_soils(grid, cells, soils);
        }
    }

    /// Recovers values at the points from those at the sites and puts each into its place of `out`.
    pub fn recover(
        &mut self,
        at: &PointsInCells<'_, D>,
        sites: &[f64],
        out: &mut [f64],
        put: impl Fn(&mut f64, f64),
    ) {
        match self {
            Self::Own => each(out, put, |point| sites[point]),
            Self::Constant => each(out, put, |point| sites[at.cells.of_point[point]]),
            Self::Patch(rows) => {
                wide!(rows.recover(at.grid, at.cells, sites, out, put));
            }
            Self::Nodal(means) => {
                means.fit(at, sites);
                each(out, put, |point| means.value(at, point));
            }
            Self::NullSpace(planes) => {
                planes.fit(at, |point| sites[point]);
                each(out, put, |point| planes.value(at, point));
            }
            Self::Interpolated => each(out, put, |point| {
                at.around(point).iter().map(|(node, value)| value * sites[*node]).sum()
            }),
        }
    }

    /// Whether a point's value is that of a few sites around it, and nothing is fitted first.
    pub fn is_local(&self) -> bool {
        matches!(self, Self::Own | Self::Constant | Self::Patch(_))
    }

    /// The sites that each point recovers its value from, `[point][entry]`, with their shares.
    pub fn rows(&self, at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
        let points = 0..at.positions.len();
        match self {
            Self::Own => points.map(|point| vec![(point, 1.0)]).collect(),
            Self::Constant => points.map(|point| vec![(at.cells.of_point[point], 1.0)]).collect(),
            Self::Patch(rows) => points.map(|point| rows.row(at.grid, at.cells, point)).collect(),
            Self::Nodal(means) => means.rows(at),
            Self::NullSpace(_) => null_space::rows(at),
            Self::Interpolated => points.map(|point| at.around(point)).collect(),
        }
    }
}

/// Writes the value of each point to its place.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the innermost loops of the step")]
fn each(out: &mut [f64], put: impl Fn(&mut f64, f64), value: impl Fn(usize) -> f64) {
    for (point, place) in out.iter_mut().enumerate() {
        put(place, value(point));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::operators::basis::Shapes;
    use crate::operators::recovery::points_in_cells::points_in_cells;
    use crate::operators::stencil::PointStencils;
    use crate::state::nodes::{Nodes, Support};
    use crate::state::points::Points;
    use oedometer_problem::method::Basis;
    use oedometer_soil::material::Material;

    /// A lattice of points in free cells.
    pub(crate) struct SiteBlock {
        grid: Grid<2>,
        pub(crate) cells: Cells<2>,
        pub(crate) nodes: Nodes<2>,
        basis: PointStencils<2>,
        points: Points<2>,
    }

    impl SiteBlock {
        pub(crate) fn new(cell_size: f64, extent: [usize; 2], per_cell: usize) -> Self {
            let grid = Grid::new(cell_size, extent);
            let mut points = Points::lattice(cell_size, extent, per_cell);
            points.take_soils(&[Material::default()]);
            let mut cells = Cells::new(&grid, points.len());
            cells.locate(&grid, &points, &[Material::default()]);
            let mut nodes = Nodes::new(&grid, &Support::free(), 1.0);
            nodes.sums.masses.fill([[1.0; 4]]);
            nodes.take_masses(&Material::default(), false);
            let mut basis = Basis::Cpgimp.stencils(points.len());
            let places = [&cells.place[..], &points.half_length[..]];
            Basis::Cpgimp.build(&mut basis, &grid, &Support::free(), places);
            Self { grid, cells, nodes, basis, points }
        }

        pub(crate) fn at(&self) -> PointsInCells<'_, 2> {
            points_in_cells!(self, self.basis)
        }
    }

    /// A row applied to values.
    pub(crate) fn applied(row: &[(usize, f64)], values: &[f64]) -> f64 {
        row.iter().map(|(place, weight)| weight * values[*place]).sum()
    }

    #[test]
    fn every_recovery_is_the_same_in_place_and_as_rows() {
        let block = SiteBlock::new(0.25, [4, 3], 2);
        let at = block.at();
        for name in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GIMP-SRI-nodal", "GIMP-null-space", "VP", "PPP"] {
            let method = Method::named(name).expect("a known method");
            let mut operator = RecoveryOperator::new(method, at.grid, at.positions.len());
            operator.build(at.grid, at.cells);
            let count = if method.pressure.is_by_cells() { at.grid.cell_count() } else { at.positions.len() };
            let count = if method.has_projection() { at.grid.node_count() } else { count };
            let sites: Vec<f64> = (0..count).map(|site| (2.3 * site as f64).cos()).collect();
            let mut in_place = vec![0.0; at.positions.len()];
            operator.recover(&at, &sites, &mut in_place, |place, value| *place = value);
            for (row, value) in operator.rows(&at).iter().zip(&in_place) {
                assert!((applied(row, &sites) - value).abs() < 1e-13, "{name}");
            }
        }
    }
}
