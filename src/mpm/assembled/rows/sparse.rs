//! Rows as lists of entries, one row after another.
//!
//! The pressure stays in two factors, `D` to the sites and `Q R` back to the nodes: their product would
//! be five times as long in a plane.

use crate::mpm::assembled::operators::FrozenOperators;
use crate::mpm::assembled::rows::{LANES, Lanes, REACH, Rows};
use crate::soil::tensor::{Tensor, Vector};

/// Rows that reach anywhere.
#[derive(Clone, Debug)]
pub struct SparseStorage<const D: usize> {
    divergence: SparseMap<Vector<D>>,
    pressure_force: SparseMap<Vector<D>>,
    skeleton_force: SparseMap<Tensor<D>>,
    projection: SparseMap<f64>,
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
        Self {
            divergence: SparseMap::of(&operators.divergence, REACH),
            pressure_force: SparseMap::of(&operators.pressure_force, 0),
            skeleton_force: SparseMap::of(&operators.skeleton_force, REACH),
            projection: SparseMap::of(&operators.projection, REACH),
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
    fn pressure_forces(
        &self,
        block: usize,
        _flux_displacement: &[Vector<D>],
        dilation: &[f64],
    ) -> [Lanes; D] {
        by_row(block, |row| {
            let mut sum = [0.0; D];
            for (site, force) in self.pressure_force.row(row) {
                let dilation = dilation[*site as usize];
                for d in 0..D {
                    sum[d] += force[d] * dilation;
                }
            }
            sum
        })
    }

    #[inline]
    fn skeleton_forces(&self, block: usize, strain_displacement: &[Vector<D>]) -> [Lanes; D] {
        by_row(block, |row| {
            let mut sum = [0.0; D];
            for (column, stiffness) in self.skeleton_force.row(row) {
                let moved = &strain_displacement[*column as usize];
                for d in 0..D {
                    for e in 0..D {
                        sum[d] += stiffness[d][e] * moved[e];
                    }
                }
            }
            sum
        })
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
            for d in 0..D {
                projected[0][d][i] = sums[0][d];
                projected[1][d][i] = sums[1][d];
            }
        }
        projected
    }
}

/// Vectors of the rows of a block, component by component.
#[inline]
fn by_row<const D: usize>(block: usize, of_row: impl Fn(usize) -> Vector<D>) -> [Lanes; D] {
    let mut lanes = [[0.0; LANES]; D];
    for i in 0..LANES {
        let value = of_row(block * LANES + i);
        for d in 0..D {
            lanes[d][i] = value[d];
        }
    }
    lanes
}
