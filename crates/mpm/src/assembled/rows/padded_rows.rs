//! Rows as lists of entries, one row after another.
//!
//! The pressure stays in two factors, `D` to the sites and `Q R` back to the nodes: their product would
//! be five times as long in a plane.

use crate::assembled::assembled_state::{LANES, Lanes, MARGIN};
use crate::assembled::operators::FrozenOperators;
use crate::assembled::rows::block_products::{Displacements, Rows};
use crate::operators::sparse_rows::SparseRows;
use oedometer_soil::tensor::{Tensor, Vector};

/// Rows that reach anywhere.
#[derive(Clone, Debug)]
pub struct SparseStorage<const D: usize> {
    divergence: SparseRows<Vector<D>>,
    pressure_force: SparseRows<Vector<D>>,
    skeleton_force: SparseRows<Tensor<D>>,
    projection: SparseRows<f64>,
    /// One where a component of a phase is free, else zero, by row.
    free: Vec<[Vector<D>; 2]>,
}

/// Rows whose columns begin at `offset` in the array that they are multiplied with; their last block is filled
/// up with empty ones.
fn placed<T: Copy>(rows: &[Vec<(usize, T)>], offset: usize) -> SparseRows<T> {
    let row = |row: &Vec<(usize, T)>| row.iter().map(|(column, value)| (column + offset, *value)).collect();
    let missing = rows.len().next_multiple_of(LANES) - rows.len();
    SparseRows::of(rows.iter().map(row).chain(std::iter::repeat_n(Vec::new(), missing)))
}

impl<const D: usize> SparseStorage<D> {
    /// Takes the rows of a frozen body.
    pub fn of(operators: &FrozenOperators<D>) -> Self {
        let mut free: Vec<_> = operators.constants.iter().map(|node| node.free).collect();
        free.resize(free.len().next_multiple_of(LANES), [[0.0; D]; 2]);
        Self {
            divergence: placed(&operators.divergence, MARGIN),
            pressure_force: placed(&operators.pressure_force, 0),
            skeleton_force: placed(&operators.skeleton_force, MARGIN),
            projection: placed(&operators.projection, MARGIN),
            free,
        }
    }

    /// Dilation at the sites, `D U_f`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
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
        D * (self.divergence.entry_count() + self.pressure_force.entry_count())
            + D * D * self.skeleton_force.entry_count()
            + 2 * D * self.projection.entry_count()
    }
}

impl<const D: usize> Rows<D> for SparseStorage<D> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn forces(&self, block: usize, displacements: Displacements<'_, D>) -> [[Lanes; D]; 2] {
        let (mut pressures, mut skeletons) = ([[0.0; LANES]; D], [[0.0; LANES]; D]);
        for i in 0..LANES {
            let (mut pressure, mut skeleton) = ([0.0; D], [0.0; D]);
            for (site, force) in self.pressure_force.row(block * LANES + i) {
                let dilation = displacements.dilation[*site as usize];
                for d in 0..D {
                    pressure[d] += force[d] * dilation;
                }
            }
            for (column, stiffness) in self.skeleton_force.row(block * LANES + i) {
                let moved = &displacements.strained[*column as usize];
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

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2] {
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
