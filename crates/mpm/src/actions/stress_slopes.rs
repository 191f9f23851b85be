//! Stress slopes. Own invention; the best of the race in a box of shear in the plane (docs/methods.md).
//!
//! ```text
//! f_i = Σ_p ∫_Ωp [τ_p + g_c·(x − x_p)]·∇N_i dx,   τ = p I − σ'
//! ```
//!
//! With one stress over its domain a point whose domain a line of nodes cuts gives its force as if the stress of its
//! middle were that of both parts. Where points lie alike about all nodes the errors of neighbouring nodes cancel; where
//! they have moved they do not, and what is left is a share of the force that does not fall with the cells. The slope
//! `g_c` is that of the plane through the means of a cell and its neighbours. The kernel calls it before it
//! takes the forces on the nodes.

use crate::operators::stencil::{PointStencils, with_stencils};
use crate::state::cells::Cells;
use crate::state::grid::{GHOST_LAYERS, Grid, SIXTH};
use crate::state::points::Points;
use oedometer_soil::tensor::{Tensor, Vector, inverse};

/// Means over a domain of the distance from its middle times the hat of a node, and times its gradient, along one
/// direction.
#[derive(Clone, Copy, Debug)]
struct Levers {
    /// Mean lever of the hat, m.
    value: f64,
    /// Mean lever of its gradient.
    gradient: f64,
}

impl Levers {
    /// The levers of a domain of half-length `half` in cells, whose middle is at a `distance` from the node, m, and has the
    /// shape function `value` there; `cell_size` in m.
    fn new(distance: f64, half: f64, value: f64, cell_size: f64) -> Self {
        let middle = distance / cell_size;
        let (low, high) = (middle - half, middle + half);
        let ends = 0.5 * (hat(low) + hat(high));
        let once = 0.5 * (hat_integral(low) + hat_integral(high));
        let twice = 0.5 / half * (hat_second_integral(high) - hat_second_integral(low));
        Self { value: cell_size * (once - twice), gradient: ends - value }
    }
}

/// The hat function, cells from its node.
fn hat(place: f64) -> f64 {
    let near = 1.0 - place.abs();
    if near > 0.0 { near } else { 0.0 }
}

/// Its integral from below.
fn hat_integral(place: f64) -> f64 {
    let near = hat(place);
    let beyond = 0.5 * near * near;
    if place > 0.0 { 1.0 - beyond } else { beyond }
}

/// The integral of that from below.
fn hat_second_integral(place: f64) -> f64 {
    let near = hat(place);
    let beyond = SIXTH * near * near * near;
    if place > 0.0 { place + beyond } else { beyond }
}

impl<const D: usize> StressPlanes<D> {
    /// Adds what the slopes of the stresses give to the sums of forces at the nodes.
    pub fn add_forces(
        &mut self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        points: &Points<D>,
        basis: &PointStencils<D>,
        forces: &mut [[Vector<D>; 2]],
    ) {
        self.fit(grid, cells, points);
        let (stride, cell_size) = (*grid.node_stride(), grid.cell_size);
        with_stencils!(basis, stencils => for (point, in_cells) in cells.place.iter().enumerate() {
            let place = in_cells.map(|coordinate| (coordinate - GHOST_LAYERS as f64) * cell_size);
            let half = points.half_length[point].map(|length| (length / cell_size).min(0.5));
            let volume = points.volume(point) * points.stressed_share[point];
            let given = given_by(&self.slopes[cells.of_point[point]], volume);
            stencils.of_point(point).visit_runs(&stride, |run| {
                for (k, (value, gradient)) in run.values.iter().zip(&run.gradients).enumerate() {
                    let node = grid.node_position(run.first + k);
                    let levers = |d: usize, value: f64| {
                        Levers::new(place[d] - node[d], half[d], value, cell_size)
                    };
                    let along = levers(0, *value);
                    let mut means = [[0.0; D]; D];
                    means[0][0] = along.gradient * run.across[0];
                    if D > 1 {
                        let up = levers(D - 1, run.across[0]);
                        means[0][D - 1] = along.value * run.across[D - 1];
                        means[D - 1][0] = up.value * gradient;
                        means[D - 1][D - 1] = up.gradient * value;
                    }
                    let [mixture, water] = &mut forces[run.first + k];
                    for d in 0..D {
                        for e in 0..D {
                            for c in 0..D {
                                mixture[c] += means[d][e] * given[d].effective[c][e];
                            }
                            water[e] += means[d][e] * given[d].pressure;
                        }
                    }
                }
            });
        });
    }
}

/// Slopes of the forces on the mixture, `(p I − σ') V`, and on the water, `p V`, by distance.
#[inline]
fn given_by<const D: usize>(slopes: &[Stresses<D>; D], volume: f64) -> [Stresses<D>; D] {
    slopes.map(|slope| {
        let pressure = volume * slope.pressure;
        let mut effective = slope.effective;
        for c in 0..D {
            for e in 0..D {
                effective[c][e] *= -volume;
            }
            effective[c][c] += pressure;
        }
        Stresses { effective, pressure }
    })
}

/// Effective stress, Pa, and pressure, Pa; or their sums, or their slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stresses<const D: usize> {
    /// Effective stress, tension positive.
    effective: Tensor<D>,
    /// Pressure, compression positive.
    pressure: f64,
}

impl<const D: usize> Stresses<D> {
    const NONE: Self = Self { effective: [[0.0; D]; D], pressure: 0.0 };

    /// Adds a share of others.
    #[inline]
    fn add(&mut self, share: f64, other: &Self) {
        for (sum, number) in self.effective.as_flattened_mut().iter_mut().zip(other.effective.as_flattened())
        {
            *sum += share * number;
        }
        self.pressure += share * other.pressure;
    }
}

/// Means over the points of each cell, and the planes through them; flat index = cell.
#[derive(Clone, Debug, PartialEq)]
pub struct StressPlanes<const D: usize> {
    /// Mean place of the cell's points, by volume, m.
    middles: Vec<Vector<D>>,
    /// Means of their stresses, Pa.
    means: Vec<Stresses<D>>,
    /// Slopes of the stresses along each direction, Pa/m.
    slopes: Vec<[Stresses<D>; D]>,
}

impl<const D: usize> StressPlanes<D> {
    /// Room for the cells of a grid.
    pub fn new(grid: &Grid<D>) -> Self {
        let count = grid.cell_count();
        Self {
            middles: vec![[0.0; D]; count],
            means: vec![Stresses::NONE; count],
            slopes: vec![[Stresses::NONE; D]; count],
        }
    }

    /// Fits the planes to the stresses of the points in the cells that they were last located in.
    fn fit(&mut self, grid: &Grid<D>, cells: &Cells<D>, points: &Points<D>) {
        for cell in cells.occupied() {
            (self.middles[cell], self.means[cell]) = ([0.0; D], Stresses::NONE);
        }
        for (point, cell) in cells.of_point.iter().enumerate() {
            let share = points.volume(point) / cells.volume(*cell);
            for d in 0..D {
                self.middles[*cell][d] += share * points.position[point][d];
            }
            let stresses =
                Stresses { effective: points.effective_stress[point], pressure: points.pressure[point] };
            self.means[*cell].add(share, &stresses);
        }
        for cell in cells.occupied() {
            self.slopes[cell] = self.slopes_of(grid, cells, cell);
        }
    }

    /// Slopes between both neighbours of a cell, or to the only one, along each direction: exact for planes wherever the
    /// middles of the cells' points are. None along a direction without neighbours.
    fn slopes_of(&self, grid: &Grid<D>, cells: &Cells<D>, cell: usize) -> [Stresses<D>; D] {
        let (mut apart, mut differences) = ([[0.0; D]; D], [Stresses::NONE; D]);
        for d in 0..D {
            let stride = grid.cell_stride()[d];
            let occupied_or_cell = |other: usize| if cells.is_occupied(other) { other } else { cell };
            let (lower, upper) = (occupied_or_cell(cell - stride), occupied_or_cell(cell + stride));
            if lower == upper {
                apart[d][d] = 1.0;
                continue;
            }
            apart[d] = std::array::from_fn(|e| self.middles[upper][e] - self.middles[lower][e]);
            differences[d] = self.means[upper];
            differences[d].add(-1.0, &self.means[lower]);
        }
        let (back, _) = inverse(&apart);
        let mut slopes = [Stresses::NONE; D];
        for d in 0..D {
            for e in 0..D {
                slopes[d].add(back[d][e], &differences[e]);
            }
        }
        slopes
    }
}

#[cfg(test)]
mod tests;
