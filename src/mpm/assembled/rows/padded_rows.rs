//! Rows as lists of entries, one row after another.
//!
//! The pressure stays in two factors, `D` to the sites and `Q R` back to the nodes: their product would
//! be five times as long in a plane.

use crate::mpm::assembled::operators::FrozenOperators;
use crate::mpm::assembled::rows::block_products::Rows;
use crate::mpm::assembled::state::{FrozenState, LANES, Lanes, MARGIN};
use crate::soil::tensor::{Tensor, Vector};

/// Rows that reach anywhere.
#[derive(Clone, Debug)]
pub struct SparseStorage<const D: usize> {
    divergence: SparseMap<Vector<D>>,
    pressure_force: SparseMap<Vector<D>>,
    skeleton_force: SparseMap<Tensor<D>>,
    projection: SparseMap<f64>,
    /// One where a component of a phase is free, else zero, by row.
    free: Vec<[Vector<D>; 2]>,
}

/// Rows of entries, each with its place in the array that it is multiplied with.
#[derive(Clone, Debug)]
struct SparseMap<T> {
    starts: Vec<usize>,
    entries: Vec<(u32, T)>,
}

impl<T: Copy> SparseMap<T> {
    /// Takes rows whose columns begin at `offset` in the array, and fills their last block up with empty
    /// ones.
    fn of(rows: &[Vec<(usize, T)>], offset: usize) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for row in rows {
            let placed =
                |(column, value): &(usize, T)| (u32::try_from(column + offset).unwrap_or(u32::MAX), *value);
            entries.extend(row.iter().map(placed));
            starts.push(entries.len());
        }
        starts.resize(rows.len().next_multiple_of(LANES) + 1, entries.len());
        Self { starts, entries }
    }

    fn bytes(&self) -> usize {
        std::mem::size_of_val(&self.entries[..]) + std::mem::size_of_val(&self.starts[..])
    }

    #[inline]
    fn row(&self, row: usize) -> &[(u32, T)] {
        &self.entries[self.starts[row]..self.starts[row + 1]]
    }
}

impl<const D: usize> SparseStorage<D> {
    /// Takes the rows of a frozen body.
    pub fn of(operators: &FrozenOperators<D>) -> Self {
        let mut free: Vec<_> = operators.constants.iter().map(|node| node.free).collect();
        free.resize(free.len().next_multiple_of(LANES), [[0.0; D]; 2]);
        Self {
            divergence: SparseMap::of(&operators.divergence, MARGIN),
            pressure_force: SparseMap::of(&operators.pressure_force, 0),
            skeleton_force: SparseMap::of(&operators.skeleton_force, MARGIN),
            projection: SparseMap::of(&operators.projection, MARGIN),
            free,
        }
    }

    /// Dilation at the sites, `D U_f`.
    pub fn dilate(&self, flux_displacement: &[Vector<D>], dilation: &mut [f64]) {
        for (site, dilation) in dilation.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (column, coefficients) in self.divergence.row(site) {
                let moved = &flux_displacement[*column as usize];
                for d in 0..D {
                    sum += coefficients[d] * moved[d];
                }
            }
            *dilation = sum;
        }
    }

    /// Size of the rows, bytes.
    pub fn bytes(&self) -> usize {
        self.divergence.bytes()
            + self.pressure_force.bytes()
            + self.skeleton_force.bytes()
            + self.projection.bytes()
    }

    /// Multiply-adds of a step by the rows, with FLIP.
    pub fn products(&self) -> usize {
        D * (self.divergence.entries.len() + self.pressure_force.entries.len())
            + D * D * self.skeleton_force.entries.len()
            + 2 * D * self.projection.entries.len()
    }
}

impl<const D: usize> Rows<D> for SparseStorage<D> {
    #[inline]
    fn forces(&self, block: usize, state: &FrozenState<D>) -> [[Lanes; D]; 2] {
        let (mut pressures, mut skeletons) = ([[0.0; LANES]; D], [[0.0; LANES]; D]);
        for i in 0..LANES {
            let (mut pressure, mut skeleton) = ([0.0; D], [0.0; D]);
            for (site, force) in self.pressure_force.row(block * LANES + i) {
                let dilation = state.dilation[*site as usize];
                for d in 0..D {
                    pressure[d] += force[d] * dilation;
                }
            }
            for (column, stiffness) in self.skeleton_force.row(block * LANES + i) {
                let moved = &state.strain_displacement[*column as usize];
                for d in 0..D {
                    for e in 0..D {
                        skeleton[d] += stiffness[d][e] * moved[e];
                    }
                }
            }
            for d in 0..D {
                pressures[d][i] = pressure[d];
                skeletons[d][i] = skeleton[d];
            }
        }
        [pressures, skeletons]
    }

    #[inline]
    fn projected(&self, block: usize, fields: &[Vec<Vector<D>>; 2]) -> [[Lanes; D]; 2] {
        let [solid, water] = fields;
        // Of one length, so that one check of a place serves both.
        let water = &water[..solid.len()];
        let mut projected = [[[0.0; LANES]; D]; 2];
        for i in 0..LANES {
            let mut sums = [[0.0; D]; 2];
            for (column, weight) in self.projection.row(block * LANES + i) {
                let place = *column as usize;
                for d in 0..D {
                    sums[0][d] += weight * solid[place][d];
                    sums[1][d] += weight * water[place][d];
                }
            }
            let free = &self.free[block * LANES + i];
            for d in 0..D {
                for phase in 0..2 {
                    projected[phase][d][i] = free[phase][d] * sums[phase][d];
                }
            }
        }
        projected
    }
}
