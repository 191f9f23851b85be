//! Rows as bands, several rows side by side: what a block reads of a neighbour lies beside what the next
//! row reads of its own, and the compiler makes one instruction of what is done to each.

use crate::assembled::assembled_state::{LANES, Lanes, MARGIN};
use crate::assembled::operators::FrozenOperators;
use crate::assembled::rows::block_products::{Displacements, Rows};
use crate::assembled::stiffness::pressure_stiffness;
use oedometer_soil::tensor::{Tensor, Vector};

/// Rows to either side that a band reaches: basis (1) + patch (1) + centre or composite (1).
pub const REACH: usize = 3;
/// Width of a band.
const BAND: usize = 2 * REACH + 1;

/// Bands `[offset + REACH][row of the block]`.
type Band = [Lanes; BAND];

/// Rows that reach `REACH` rows to either side.
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
    /// Takes the rows of a frozen body; `None` where one reaches beyond the band, or a component of its node
    /// is held.
    pub fn of(operators: &FrozenOperators<D>) -> Option<Self> {
        if operators.constants.iter().any(|node| node.free != [[1.0; D]; 2]) {
            return None;
        }
        let projection_reach = reach(&operators.projection, |weight| *weight != 0.0)?;
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
        put(&operators.projection, |block, k, i, entry| blocks[block].projection[k][i] = *entry);
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
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn forces(&self, block: usize, displacements: Displacements<'_, D>) -> [[Lanes; D]; 2] {
        let rows = &self.0.blocks[block];
        [
            forces::<D, R>(&rows.pressure_stiffness, displacements.flux, block),
            forces::<D, R>(&rows.skeleton_stiffness, displacements.strained, block),
        ]
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2] {
        let band = &self.0.blocks[block].projection;
        // Not by a closure, which is not always inlined where registers are wide.
        let [solid, water] = fields;
        [projected::<D, R>(band, solid, block), projected::<D, R>(band, water, block)]
    }
}

/// What the rows of a block reach of a field.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn window<const D: usize, const R: usize>(field: &[Vector<D>], block: usize) -> &[Vector<D>] {
    let first = block * LANES + MARGIN - R;
    &field[first..first + 2 * R + LANES]
}

/// Products of a band that is zero beyond `R` with each component of a field.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
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
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
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
