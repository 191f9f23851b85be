//! Storage of the rows of a frozen step, chosen by their structure: as bands where rows reach only their nearest
//! neighbours, as those of a column do, and as lists of entries elsewhere. Both answer the same questions about a block of
//! rows that lie side by side: the forces on its nodes, and the projection of velocities onto them.

#![expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]

use crate::integrate::assembled::operators::FrozenOperators;
use crate::integrate::assembled::state::{Displacements, LANES, Lanes, MARGIN};
use crate::integrate::assembled::stiffness::pressure_stiffness;
use crate::kernel::projection::ProjectedStorage;
use crate::operators::sparse_rows::SparseRows;
use oedometer_soil::tensor::{Tensor, Vector};

/// Operators by which a step multiplies grid arrays. Arrays hold `[MARGIN + row][component]`.
pub trait Rows<const D: usize> {
    /// Forces of the pressures, `K_p U_f`, and of the effective stresses, `K_σ U_s`, on the nodes of a
    /// block with their signs turned, N.
    fn forces(&self, block: usize, displacements: Displacements<'_, D>) -> [[Lanes; D]; 2];

    /// Fields of both phases mapped to the points and back, `P v`, at the nodes of a block; zero where a
    /// component is held.
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2];
}

/// Rows in the way that suits them.
#[derive(Clone, Debug)]
pub enum RowStorage<const D: usize> {
    /// Every row reaches its nearest neighbours only.
    Banded(BandedStorage<D>),
    /// Rows reach anywhere.
    Sparse(SparseStorage<D>),
}

impl<const D: usize> RowStorage<D> {
    /// Takes the rows of a frozen body.
    pub fn new(operators: &FrozenOperators<D>) -> Self {
        BandedStorage::from_operators(operators)
            .map_or_else(|| Self::Sparse(SparseStorage::from_operators(operators)), Self::Banded)
    }
}

/// Rows to either side that a band reaches: basis (1) + patch (1) + centre or composite (1).
pub const REACH: usize = 3;
/// Width of a band.
const BAND: usize = 2 * REACH + 1;

/// Bands `[offset + REACH][row of the block]`.
type Band = [Lanes; BAND];

/// Rows as bands that reach `REACH` rows to either side, several rows side by side: what a block reads of a neighbour lies
/// beside what the next row reads of its own, and the compiler makes one instruction of what is done to each.
#[derive(Clone, Debug)]
pub struct BandedStorage<const D: usize> {
    blocks: Vec<BandBlock<D>>,
    /// Rows to either side that forces come from.
    pub force_reach: usize,
    /// Rows to either side that the projection comes from.
    pub projection_reach: usize,
}

/// Bands of a few rows, by component of the force and of the displacement; zero beyond the last row.
#[derive(Clone, Copy, Debug)]
struct BandBlock<const D: usize> {
    skeleton_stiffness: [[Band; D]; D],
    pressure_stiffness: [[Band; D]; D],
    projection: Band,
}

/// Banded rows whose bands are zero beyond `R`.
#[derive(Clone, Copy, Debug)]
pub struct BandsWithin<'a, const D: usize, const R: usize>(pub &'a BandedStorage<D>);

impl<const D: usize> BandedStorage<D> {
    /// Takes the rows of a frozen body; `None` where one reaches beyond the band, a component of its node is held, a
    /// projection of pressures reaches everywhere, or skeleton and water are projected each in its own way.
    pub fn from_operators(operators: &FrozenOperators<D>) -> Option<Self> {
        if operators.storage.is_some() || operators.free.iter().any(|free| *free != [[1.0; D]; 2]) {
            return None;
        }
        if operators.projection.iter().flatten().any(|(_, [solid, water])| solid != water) {
            return None;
        }
        let projection_reach = reach(&operators.projection, |[weight, _]| *weight != 0.0)?;
        let is_coupled = |block: &Tensor<D>| *block != [[0.0; D]; D];
        let skeleton_reach = reach(&operators.skeleton_force, is_coupled)?;
        let pressure = pressure_stiffness(&operators.pressure_force, &operators.divergence).rows;
        let pressure_reach = reach(&pressure, is_coupled)?;
        let empty = [[[[0.0; LANES]; BAND]; D]; D];
        let empty = BandBlock {
            skeleton_stiffness: empty,
            pressure_stiffness: empty,
            projection: [[0.0; LANES]; BAND],
        };
        let mut blocks = vec![empty; operators.nodes.len().div_ceil(LANES)];
        put(&operators.skeleton_force, |block, k, i, entry| {
            put_tensor(&mut blocks[block].skeleton_stiffness, k, i, entry);
        });
        put(&pressure, |block, k, i, entry| {
            put_tensor(&mut blocks[block].pressure_stiffness, k, i, entry);
        });
        put(&operators.projection, |block, k, i, entry| blocks[block].projection[k][i] = entry[0]);
        Some(Self { blocks, force_reach: skeleton_reach.max(pressure_reach), projection_reach })
    }
}

/// Largest distance of an entry that counts from its row; `None` beyond the band.
fn reach<T>(rows: &[Vec<(usize, T)>], counts: impl Fn(&T) -> bool) -> Option<usize> {
    let distances = rows.iter().enumerate().flat_map(|(row, entries)| {
        entries.iter().filter(|entry| counts(&entry.1)).map(move |entry| entry.0.abs_diff(row))
    });
    Some(distances.max().unwrap_or(0)).filter(|reach| *reach <= REACH)
}

/// Hands every entry within the band to a setter: block, place in the band, lane, value.
fn put<T>(rows: &[Vec<(usize, T)>], mut set: impl FnMut(usize, usize, usize, &T)) {
    for (row, entries) in rows.iter().enumerate() {
        for (column, entry) in entries.iter().filter(|entry| entry.0.abs_diff(row) <= REACH) {
            set(row / LANES, column + REACH - row, row % LANES, entry);
        }
    }
}

fn put_tensor<const D: usize>(bands: &mut [[Band; D]; D], k: usize, i: usize, entry: &Tensor<D>) {
    for d in 0..D {
        for e in 0..D {
            bands[d][e][k][i] = entry[d][e];
        }
    }
}

impl<const D: usize, const R: usize> Rows<D> for BandsWithin<'_, D, R> {
    #[inline(always)]
    fn forces(&self, block: usize, displacements: Displacements<'_, D>) -> [[Lanes; D]; 2] {
        let rows = &self.0.blocks[block];
        [
            forces::<D, R>(&rows.pressure_stiffness, displacements.flux, block),
            forces::<D, R>(&rows.skeleton_stiffness, displacements.strained, block),
        ]
    }

    #[inline(always)]
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2] {
        let band = &self.0.blocks[block].projection;
        // Not by a closure, which is not always inlined where registers are wide.
        let [solid, water] = fields;
        [projected::<D, R>(band, solid, block), projected::<D, R>(band, water, block)]
    }
}

/// Entries of a field that the rows of a block reach.
#[inline(always)]
fn window<const D: usize, const R: usize>(field: &[Vector<D>], block: usize) -> &[Vector<D>] {
    let first = block * LANES + MARGIN - R;
    &field[first..first + 2 * R + LANES]
}

/// Products of a band that is zero beyond `R` with each component of a field.
#[inline(always)]
fn projected<const D: usize, const R: usize>(band: &Band, field: &[Vector<D>], block: usize) -> [Lanes; D] {
    let window = window::<D, R>(field, block);
    let mut sums = [[0.0; LANES]; D];
    for (d, sums) in sums.iter_mut().enumerate() {
        for k in 0..=2 * R {
            for i in 0..LANES {
                sums[i] += band[k + REACH - R][i] * window[k + i][d];
            }
        }
    }
    sums
}

/// Products of bands that are zero beyond `R` with a field.
#[inline(always)]
fn forces<const D: usize, const R: usize>(
    bands: &[[Band; D]; D],
    field: &[Vector<D>],
    block: usize,
) -> [Lanes; D] {
    let window = window::<D, R>(field, block);
    let mut forces = [[0.0; LANES]; D];
    for d in 0..D {
        for e in 0..D {
            let band = &bands[d][e];
            for i in 0..LANES {
                let term = |k: usize| band[k][i] * window[k + R - REACH + i][e];
                // Two short chains of additions and not one long one: a step waits for their latency.
                let sum = match R {
                    1 => (term(2) + term(4)) + term(3),
                    2 => (term(2) + term(4)) + ((term(1) + term(3)) + term(5)),
                    _ => ((term(0) + term(2)) + (term(4) + term(6))) + ((term(1) + term(3)) + term(5)),
                };
                forces[d][i] = if e == 0 { sum } else { forces[d][i] + sum };
            }
        }
    }
    forces
}

/// Rows as lists of entries, one after another. The pressure stays in two factors, `D` to the sites and `Q R` back to the
/// nodes: their product would be five times as long in a plane.
#[derive(Clone, Debug)]
pub struct SparseStorage<const D: usize> {
    divergence: SparseRows<Vector<D>>,
    pressure_force: SparseRows<Vector<D>>,
    skeleton_force: SparseRows<Tensor<D>>,
    projection: SparseRows<[f64; 2]>,
    /// The linear system between the two factors where the storage is projected, and the moduli `Q` of the sites, Pa.
    storage: Option<Box<(ProjectedStorage, Vec<f64>)>>,
    /// 1 where a component of a phase is free, else 0, by row.
    free: Vec<[Vector<D>; 2]>,
}

/// Rows whose columns begin at `offset` in the array that they are multiplied with; their last block is filled
/// up with empty ones.
fn placed<T: Copy>(rows: &[Vec<(usize, T)>], offset: usize) -> SparseRows<T> {
    let row = |row: &Vec<(usize, T)>| row.iter().map(|(column, value)| (column + offset, *value)).collect();
    let missing = rows.len().next_multiple_of(LANES) - rows.len();
    SparseRows::from_rows(rows.iter().map(row).chain(std::iter::repeat_n(Vec::new(), missing)))
}

impl<const D: usize> SparseStorage<D> {
    /// Takes the rows of a frozen body.
    pub fn from_operators(operators: &FrozenOperators<D>) -> Self {
        let mut free = operators.free.clone();
        free.resize(free.len().next_multiple_of(LANES), [[0.0; D]; 2]);
        Self {
            divergence: placed(&operators.divergence, MARGIN),
            pressure_force: placed(&operators.pressure_force, 0),
            skeleton_force: placed(&operators.skeleton_force, MARGIN),
            projection: placed(&operators.projection, MARGIN),
            storage: operators
                .storage
                .clone()
                .map(|storage| Box::new((storage, operators.volumetric.coupling.clone()))),
            free,
        }
    }

    /// Dilation at the sites, `D U_f`; of a projected storage that which makes its pressures.
    #[inline(always)]
    pub fn dilate(&mut self, flux_displacement: &[Vector<D>], dilation: &mut [f64]) {
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
        if let Some(projected) = &mut self.storage {
            let (storage, coupling) = &mut **projected;
            dilation.iter_mut().zip(&*coupling).for_each(|(dilation, coupling)| *dilation *= coupling);
            storage.project(dilation);
            dilation.iter_mut().zip(&*coupling).for_each(|(dilation, coupling)| *dilation /= coupling);
        }
    }
}

impl<const D: usize> Rows<D> for SparseStorage<D> {
    #[inline(always)]
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
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2] {
        let [solid, water] = fields;
        // Of one length, so that one check of a place serves both.
        let water = &water[..solid.len()];
        let mut projected = [[[0.0; LANES]; D]; 2];
        for i in 0..LANES {
            let mut sums = [[0.0; D]; 2];
            for (column, [of_solid, of_water]) in self.projection.row(block * LANES + i) {
                let place = *column as usize;
                for d in 0..D {
                    sums[0][d] += of_solid * solid[place][d];
                    sums[1][d] += of_water * water[place][d];
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
