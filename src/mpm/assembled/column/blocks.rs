//! The step of a frozen column, several nodes side by side: what it reads of a node lies beside the
//! same of its neighbours, and the compiler makes one instruction of what is done to each.

use crate::mpm::assembled::column::{BAND, BandRow, NodeRow, REACH, State};
use crate::mpm::explicit::ExplicitSettings;
use std::ops::Range;

/// Nodes in a block.
pub(crate) const LANES: usize = 4;

/// A value a node of a block.
type Lanes = [f64; LANES];

/// The nodes that move, in blocks, with all that steps of one size and drag need of them.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    several: Vec<Block>,
    /// First node of the first block, and the end of those that move.
    moving: Range<usize>,
    /// Nodes to one side that forces come from.
    pub(crate) force_reach: usize,
    /// Nodes to one side that the projection comes from.
    projection_reach: usize,
}

/// [`NodeRow`] of a few nodes; all zero beyond the last one that moves, which keeps it at rest.
#[derive(Clone, Debug, Default)]
struct Block {
    skeleton_stiffness: [Lanes; BAND],
    pressure_stiffness: [Lanes; BAND],
    projection: [Lanes; BAND],
    mixture_force: Lanes,
    water_force: Lanes,
    porosity: Lanes,
    /// One over the mass of the grains, where the node is free.
    per_solid_mass: Lanes,
    /// Mass of the water over that of the grains, where the node is free.
    water_share: Lanes,
    water_from_water_force: Lanes,
    water_from_relative: Lanes,
    water_from_mixture: Lanes,
}

impl Blocks {
    /// Blocks of the nodes that move.
    pub(crate) fn of(rows: &[NodeRow], moving: Range<usize>) -> Self {
        let reach_of = |bands: &dyn Fn(&NodeRow) -> BandRow| {
            let of_row = |row: &NodeRow| {
                let entries = bands(row);
                let reaches = (0..BAND).filter(|k| entries[*k] != 0.0).map(|k| k.abs_diff(REACH));
                reaches.max().unwrap_or(0)
            };
            rows.iter().map(of_row).max().unwrap_or(0)
        };
        let mut blocks = Self {
            several: vec![Block::default(); moving.len().div_ceil(LANES)],
            moving,
            force_reach: reach_of(&|row| row.skeleton_stiffness).max(reach_of(&|row| row.pressure_stiffness)),
            projection_reach: reach_of(&|row| row.projection),
        };
        blocks.fill(rows);
        blocks
    }

    /// Takes over all that is constant about the nodes.
    pub(crate) fn fill(&mut self, rows: &[NodeRow]) {
        for (place, row) in rows[self.moving.clone()].iter().enumerate() {
            let block = &mut self.several[place / LANES];
            let lane = place % LANES;
            for k in 0..BAND {
                block.skeleton_stiffness[k][lane] = row.skeleton_stiffness[k];
                block.pressure_stiffness[k][lane] = row.pressure_stiffness[k];
                block.projection[k][lane] = row.projection[k];
            }
            block.mixture_force[lane] = row.mixture_force;
            block.water_force[lane] = row.water_force;
            block.porosity[lane] = row.porosity;
            block.per_solid_mass[lane] = row.free * row.per_solid_mass;
            block.water_share[lane] = row.free * row.water_share;
            block.water_from_water_force[lane] = row.water_from_water_force;
            block.water_from_relative[lane] = row.water_from_relative;
            block.water_from_mixture[lane] = row.water_from_mixture;
        }
    }

    /// Changes the force on the mixture at a node.
    pub(crate) fn set_mixture_force(&mut self, node: usize, force: f64) {
        if self.moving.contains(&node) {
            let place = node - self.moving.start;
            self.several[place / LANES].mixture_force[place % LANES] = force;
        }
    }

    /// Accelerations, and the velocities that they lead to within `kick` seconds.
    #[inline]
    pub(crate) fn accelerate(&self, state: &mut State, kick: f64) {
        match self.force_reach {
            0 | 1 => self.forces_and_trial_velocities::<1>(state, kick),
            2 => self.forces_and_trial_velocities::<2>(state, kick),
            _ => self.forces_and_trial_velocities::<REACH>(state, kick),
        }
    }

    /// Velocities after `kick` seconds, and all that they carry within `dt`.
    #[inline]
    pub(crate) fn advance(&self, state: &mut State, kick: f64, dt: f64, settings: &ExplicitSettings) {
        // On a regular lattice a node shares points with its neighbours only.
        if self.projection_reach <= 1 {
            self.advance_velocities::<1>(state, kick, dt, settings);
        } else {
            self.advance_velocities::<REACH>(state, kick, dt, settings);
        }
    }

    fn forces_and_trial_velocities<const R: usize>(&self, state: &mut State, kick: f64) {
        for (number, block) in self.several.iter().enumerate() {
            let at = self.moving.start + number * LANES + REACH;
            let pressure = forces::<R>(&block.pressure_stiffness, &state.flux_displacement, at);
            let skeleton = forces::<R>(&block.skeleton_stiffness, &state.strain_displacement, at);
            let solid = lanes(&state.solid_velocity, at);
            let water = lanes(&state.water_velocity, at);
            let (mut solid_acceleration, mut water_acceleration) = ([0.0; LANES], [0.0; LANES]);
            let (mut solid_trial, mut water_trial) = ([0.0; LANES], [0.0; LANES]);
            for i in 0..LANES {
                let water_force = block.water_force[i] - pressure[i];
                let mixture_force = block.mixture_force[i] - skeleton[i] - pressure[i];
                water_acceleration[i] = block.water_from_water_force[i] * water_force
                    + block.water_from_relative[i] * (water[i] - solid[i])
                    + block.water_from_mixture[i] * mixture_force;
                solid_acceleration[i] =
                    mixture_force * block.per_solid_mass[i] - block.water_share[i] * water_acceleration[i];
                solid_trial[i] = solid[i] + kick * solid_acceleration[i];
                water_trial[i] = water[i] + kick * water_acceleration[i];
            }
            put(&mut state.solid_acceleration, at, solid_acceleration);
            put(&mut state.water_acceleration, at, water_acceleration);
            put(&mut state.solid_trial, at, solid_trial);
            put(&mut state.water_trial, at, water_trial);
        }
    }

    /// Velocities mapped back over the projection's reach `R`, and the displacements they make.
    fn advance_velocities<const R: usize>(
        &self,
        state: &mut State,
        kick: f64,
        dt: f64,
        settings: &ExplicitSettings,
    ) {
        let (flip, pic) = (settings.flip, 1.0 - settings.flip);
        for (number, block) in self.several.iter().enumerate() {
            let at = self.moving.start + number * LANES + REACH;
            let solid_rate = mapped::<R>(&block.projection, &state.solid_acceleration, at);
            let water_rate = mapped::<R>(&block.projection, &state.water_acceleration, at);
            let solid_trial = lanes(&state.solid_trial, at);
            let water_trial = lanes(&state.water_trial, at);
            let mut solid = lanes(&state.solid_velocity, at);
            let mut water = lanes(&state.water_velocity, at);
            for i in 0..LANES {
                solid[i] = flip * (solid[i] + kick * solid_rate[i]);
                water[i] = flip * (water[i] + kick * water_rate[i]);
            }
            if pic > 0.0 {
                let solid_mean = forces::<REACH>(&block.projection, &state.solid_trial, at);
                let water_mean = forces::<REACH>(&block.projection, &state.water_trial, at);
                for i in 0..LANES {
                    solid[i] += pic * solid_mean[i];
                    water[i] += pic * water_mean[i];
                }
            }
            put(&mut state.solid_velocity, at, solid);
            put(&mut state.water_velocity, at, water);
            let (strain_solid, strain_water) =
                if settings.mapping_back { (solid, water) } else { (solid_trial, water_trial) };
            let mut strain_displacement = lanes(&state.strain_displacement, at);
            let mut flux_displacement = lanes(&state.flux_displacement, at);
            let mut displacement = lanes(&state.displacement, at);
            for i in 0..LANES {
                strain_displacement[i] += dt * strain_solid[i];
                flux_displacement[i] +=
                    dt * (strain_solid[i] + block.porosity[i] * (strain_water[i] - strain_solid[i]));
                displacement[i] += dt * solid_trial[i];
            }
            put(&mut state.strain_displacement, at, strain_displacement);
            put(&mut state.flux_displacement, at, flux_displacement);
            put(&mut state.displacement, at, displacement);
        }
    }
}

#[inline]
fn lanes(field: &[f64], at: usize) -> Lanes {
    let mut values = [0.0; LANES];
    values.copy_from_slice(&field[at..at + LANES]);
    values
}

#[inline]
fn put(field: &mut [f64], at: usize, values: Lanes) {
    field[at..at + LANES].copy_from_slice(&values);
}

/// Products of band rows with a padded field, whose entries beyond `R` to either side are zero.
#[inline]
fn forces<const R: usize>(band: &[Lanes; BAND], field: &[f64], at: usize) -> Lanes {
    let window = &field[at - R..at + R + LANES];
    let term = |k: usize, i: usize| band[k][i] * window[k + R - REACH + i];
    let mut sums = [0.0; LANES];
    for i in 0..LANES {
        // Two short chains of additions and not one long one: it is their latency that a step waits for.
        sums[i] = match R {
            1 => (term(2, i) + term(4, i)) + term(3, i),
            2 => (term(2, i) + term(4, i)) + ((term(1, i) + term(3, i)) + term(5, i)),
            _ => {
                ((term(0, i) + term(2, i)) + (term(4, i) + term(6, i)))
                    + ((term(1, i) + term(3, i)) + term(5, i))
            }
        };
    }
    sums
}

/// The same summed from one end to the other.
#[inline]
fn mapped<const R: usize>(band: &[Lanes; BAND], field: &[f64], at: usize) -> Lanes {
    let window = &field[at - R..at + R + LANES];
    let mut sums = [0.0; LANES];
    for k in 0..=2 * R {
        for i in 0..LANES {
            sums[i] += band[k + REACH - R][i] * window[k + i];
        }
    }
    sums
}
