//! `R`: from the sites of the divergence, cells or points, to the points (docs/theory.md, section 3).
//!
//! Every way has its file with the same verbs: `fit` where it has to look at all sites first, `value` at a point
//! in place, and `row` or `rows`: the sites that a point recovers its value from, with their weights. Which way
//! a method takes is chosen here and nowhere else.

pub mod constant;
pub mod nodal;
pub mod nodal_field;
pub mod null_space;
pub mod patch;
pub mod points_in_cells;

use crate::method::{Method, Recovery};
use crate::operators::recovery::nodal::NodalMeans;
use crate::operators::recovery::nodal_field::NodalField;
use crate::operators::recovery::null_space::CellPlanes;
use crate::operators::recovery::patch::PatchRows;
use crate::operators::recovery::points_in_cells::PointsInCells;
use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::wide::wide;

/// `R` of a method, with what it keeps from step to step.
#[derive(Clone, Debug)]
pub enum RecoveryOperator<const D: usize> {
    /// The sites are the points.
    Own,
    /// [`constant`].
    Constant,
    /// [`patch`].
    Patch(PatchRows<D>),
    /// [`nodal`].
    Nodal(NodalMeans),
    /// [`nodal_field`]; the sites are the points.
    NodalField(NodalField),
    /// [`null_space`]; the sites are the points.
    NullSpace(CellPlanes<D>),
}

impl<const D: usize> RecoveryOperator<D> {
    /// The operator of a method, with room for a grid and so many points.
    pub fn of(method: Method, grid: &Grid<D>, points: usize) -> Self {
        match (method.pressure.is_by_cells(), method.recovery) {
            (false, Recovery::NullSpace) => Self::NullSpace(CellPlanes::with_cells(grid.cell_count())),
            (false, Recovery::Nodal) => Self::NodalField(NodalField::with_nodes(grid.node_count())),
            (false, Recovery::Constant | Recovery::Patch) => Self::Own,
            (true, Recovery::Constant | Recovery::NullSpace) => Self::Constant,
            (true, Recovery::Patch) => Self::Patch(PatchRows::with_points(points, grid)),
            (true, Recovery::Nodal) => Self::Nodal(NodalMeans::with_nodes(grid.node_count())),
        }
    }

    /// Brings the operator up to the points' places.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        if let Self::Patch(rows) = self {
            rows.build(grid, cells);
        }
    }

    /// Recovers values at the points from those at the sites and puts each into its place of `out`.
    #[inline]
    pub fn recover(
        &mut self,
        at: &PointsInCells<'_, D>,
        sites: &[f64],
        out: &mut [f64],
        put: impl Fn(&mut f64, f64),
    ) {
        match self {
            Self::Own => each(out, put, |point| sites[point]),
            Self::Constant => each(out, put, |point| constant::value(at, point, sites)),
            Self::Patch(rows) => {
                wide!(rows.recover(at.grid, sites, out, put));
            }
            Self::Nodal(means) => {
                means.fit(at, sites);
                each(out, put, |point| means.value(at, point));
            }
            Self::NodalField(field) => {
                field.fit(at, sites);
                each(out, put, |point| field.value(at, point));
            }
            Self::NullSpace(planes) => {
                planes.fit(at, |point| sites[point]);
                each(out, put, |point| planes.value(at, point));
            }
        }
    }

    /// Whether a point's value is that of a few sites around it, and nothing is fitted first.
    pub fn is_local(&self) -> bool {
        match self {
            Self::Own | Self::Constant | Self::Patch(_) => true,
            Self::Nodal(_) | Self::NodalField(_) | Self::NullSpace(_) => false,
        }
    }

    /// The same as rows, `[point][entry]` of site and weight.
    pub fn rows(&self, at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
        let points = 0..at.positions.len();
        match self {
            Self::Own => points.map(|point| vec![(point, 1.0)]).collect(),
            Self::Constant => points.map(|point| constant::row(at, point)).collect(),
            Self::Patch(rows) => points.map(|point| rows.row(at.grid, point)).collect(),
            Self::Nodal(_) => nodal::rows(at),
            Self::NodalField(_) => nodal_field::rows(at),
            Self::NullSpace(_) => null_space::rows(at),
        }
    }
}

/// Puts the value of each point into its place.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn each(out: &mut [f64], put: impl Fn(&mut f64, f64), value: impl Fn(usize) -> f64) {
    for (point, place) in out.iter_mut().enumerate() {
        put(place, value(point));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::method::Basis;
    use crate::operators::stencil::PointStencils;
    use crate::state::nodes::{Nodes, Support};
    use crate::state::points::Points;

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
            let points = Points::lattice(cell_size, extent, per_cell);
            let mut cells = Cells::new(&grid, points.len());
            cells.locate(&grid, &points, 0.3);
            let mut nodes = Nodes::new(&grid, &Support::free(), 1.0);
            nodes.solid_mass.fill(1.0);
            nodes.finish_masses();
            let mut basis = Basis::Cpgimp.stencils(points.len());
            let places = [&cells.place[..], &points.half_length[..]];
            Basis::Cpgimp.build(&mut basis, &grid, &Support::free(), places);
            Self { grid, cells, nodes, basis, points }
        }

        pub(crate) fn at(&self) -> PointsInCells<'_, 2> {
            crate::operators::recovery::points_in_cells::points_in_cells!(self)
        }
    }

    /// A row applied to values.
    pub(crate) fn applied(row: &[(usize, f64)], values: &[f64]) -> f64 {
        row.iter().map(|(place, weight)| weight * values[*place]).sum()
    }

    #[test]
    fn every_way_is_one_in_place_and_as_rows() {
        let block = SiteBlock::new(0.25, [4, 3], 2);
        let at = block.at();
        for name in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GIMP-SRI-nodal", "GIMP-null-space", "VP"] {
            let method = Method::named(name).expect("a known method");
            let mut operator = RecoveryOperator::of(method, at.grid, at.positions.len());
            operator.build(at.grid, at.cells);
            let count = if method.pressure.is_by_cells() { at.grid.cell_count() } else { at.positions.len() };
            let sites: Vec<f64> = (0..count).map(|site| (2.3 * site as f64).cos()).collect();
            let mut in_place = vec![0.0; at.positions.len()];
            operator.recover(&at, &sites, &mut in_place, |place, value| *place = value);
            for (row, value) in operator.rows(&at).iter().zip(&in_place) {
                assert!((applied(row, &sites) - value).abs() < 1e-13, "{name}");
            }
        }
    }
}
