//! Grid arrays of a frozen step.

#![expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]

use oedometer_soil::tensor::Vector;

/// Rows in a block.
pub const LANES: usize = 4;
/// Empty places at both ends of a grid array: a band reaches there. As long as a block, so that blocks do
/// not straddle cache lines.
pub const MARGIN: usize = LANES;

/// One value per row of a block.
pub type Lanes = [f64; LANES];

/// Place of the skeleton in a pair of phases.
pub const SOLID: usize = 0;
/// Place of the water in a pair of phases.
pub const WATER: usize = 1;
/// The grid arrays that a step maps to themselves, for stability analysis.
pub const FIELDS: usize = 4;

/// Grid arrays `[MARGIN + row][component]`: empty places below the first row and above the last block are
/// what a band reaches there.
#[derive(Clone, Debug)]
pub struct FrozenState<const D: usize> {
    /// Velocity of both phases, m/s.
    pub velocity: [Vec<Vector<D>>; 2],
    /// Acceleration of both phases, m/s².
    pub acceleration: [Vec<Vector<D>>; 2],
    /// Velocity by forward Euler of both phases, m/s.
    pub trial: [Vec<Vector<D>>; 2],
    /// Displacement that strained the skeleton, m.
    pub strain_displacement: Vec<Vector<D>>,
    /// Time integral of `v_s + n(v_w − v_s)`, m.
    pub flux_displacement: Vec<Vector<D>>,
    /// Displacement of the nodes themselves, m.
    pub displacement: Vec<Vector<D>>,
    /// Dilation at the sites, where rows need it.
    pub dilation: Vec<f64>,
}

impl<const D: usize> FrozenState<D> {
    /// A state at rest.
    pub fn zero(rows: usize, sites: usize) -> Self {
        let zero = vec![[0.0; D]; rows.next_multiple_of(LANES) + 2 * MARGIN];
        let phases = [zero.clone(), zero.clone()];
        Self {
            velocity: phases.clone(),
            acceleration: phases.clone(),
            trial: phases,
            strain_displacement: zero.clone(),
            flux_displacement: zero.clone(),
            displacement: zero,
            dilation: vec![0.0; sites],
        }
    }

    /// One of the arrays that a step maps to themselves: velocities of both phases, straining and flux
    /// displacement.
    pub fn field_mut(&mut self, field: usize) -> &mut [Vector<D>] {
        match field {
            SOLID | WATER => &mut self.velocity[field],
            2 => &mut self.strain_displacement,
            _ => &mut self.flux_displacement,
        }
    }
}

/// One component of a field at the rows of a block.
#[inline(always)]
pub fn lanes<const D: usize>(field: &[Vector<D>], block: usize, component: usize) -> Lanes {
    let first = block * LANES + MARGIN;
    let some = &field[first..first + LANES];
    std::array::from_fn(|i| some[i][component])
}

/// Sets one component of a field at the rows of a block.
#[inline(always)]
pub fn set_lanes<const D: usize>(field: &mut [Vector<D>], block: usize, component: usize, values: Lanes) {
    let first = block * LANES + MARGIN;
    for (vector, value) in field[first..first + LANES].iter_mut().zip(values) {
        vector[component] = value;
    }
}

/// Displacements that cause forces, as slices taken once per step: a vector's place would be looked up after every store.
#[derive(Clone, Copy, Debug)]
pub struct Displacements<'a, const D: usize> {
    /// Displacement that strained the skeleton, m, `[MARGIN + row][component]`.
    pub strained: &'a [Vector<D>],
    /// Displacement of the flux, m, by row too.
    pub flux: &'a [Vector<D>],
    /// Dilation at the sites, where rows need it.
    pub dilation: &'a [f64],
}
