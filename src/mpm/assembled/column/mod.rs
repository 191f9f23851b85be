//! The frozen column as one banded map between grid arrays.
//!
//! Where weights are frozen and the material is linear, stresses are linear in the nodal
//! displacements that strained them, and velocities mapped to the grid are all that the points'
//! velocities are needed for:
//!
//! - `F_w = F_w0 − K_p U_f`, `F_m = F_0 − K_σ U_s + (F_w − F_w0)`: forces,
//! - `v⁺ = v + Δt a(F_w, F_m, v)`: nodal velocities by forward Euler,
//! - `v̄ ← φ (v̄ + Δt P a) + (1 − φ) P v⁺` with `P = M⁻¹ Nᵀ m N`: mapped velocities,
//! - `U ← U + Δt v̄`, or `v⁺` without mapping back.
//!
//! The points are visited at outputs only. The point-wise step in `explicit` is the definition;
//! a test holds the two together to round-off. `bands` assembles, `blocks` steps.

pub mod bands;
pub mod blocks;

use crate::mpm::assembled::column::bands::assemble_bands;
use crate::mpm::assembled::column::blocks::{Blocks, LANES};
use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::explicit::ExplicitSettings;
use crate::mpm::run::profile::{Phase, enter};

/// Nodes that couple to one side: basis (1) + patch (1) + centre or composite (1).
const REACH: usize = 3;
/// Width of a band row.
const BAND: usize = 2 * REACH + 1;

type BandRow = [f64; BAND];

/// A frozen one-dimensional body with its step assembled.
#[derive(Clone, Debug)]
pub struct AssembledColumn {
    rows: Vec<NodeRow>,
    /// The nodes that move, from the first to the last that is free, ready for steps of one size.
    blocks: Blocks,
    /// Nodes that span the loaded surface, with the weights there.
    surface: Vec<(usize, f64)>,
    /// Nodes that carry the load, with the force of all else and of the whole load.
    loaded: Vec<LoadedNode>,
    state: State,
}

/// Everything constant about one node.
#[derive(Clone, Copy, Debug, Default)]
struct NodeRow {
    skeleton_stiffness: BandRow,
    pressure_stiffness: BandRow,
    projection: BandRow,
    mixture_force: f64,
    water_force: f64,
    porosity: f64,
    free: f64,
    per_solid_mass: f64,
    water_inertia: f64,
    water_share: f64,
    drag: f64,
    // Accelerations from forces and relative velocity, for one step size and drag.
    water_from_water_force: f64,
    water_from_relative: f64,
    water_from_mixture: f64,
}

/// A node that carries a part of the load.
#[derive(Clone, Copy, Debug)]
struct LoadedNode {
    node: usize,
    unloaded_force: f64,
    load_force: f64,
}

/// Grid arrays with `REACH` empty places below the first node, and room above the last for the
/// reach of a whole block.
#[derive(Clone, Debug, Default)]
struct State {
    solid_velocity: Vec<f64>,
    water_velocity: Vec<f64>,
    /// Displacement that strained the skeleton, m.
    strain_displacement: Vec<f64>,
    /// Time integral of `v_s + n(v_w − v_s)`, m.
    flux_displacement: Vec<f64>,
    /// Displacement of the nodes themselves, m.
    displacement: Vec<f64>,
    solid_acceleration: Vec<f64>,
    water_acceleration: Vec<f64>,
    solid_trial: Vec<f64>,
    water_trial: Vec<f64>,
}

/// The grid arrays that a step maps to themselves, for stability analysis.
pub const STATE_FIELDS: usize = 4;

impl AssembledColumn {
    /// Assembles the step of a body on its present operators; `None` in more than one dimension.
    pub fn new<const D: usize, const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Option<Self> {
        if D != 1 {
            return None;
        }
        let count = body.nodes.len();
        let mut rows = vec![NodeRow::default(); count];
        let water_density = body.material.water_density;
        for node in 0..count {
            if body.nodes.is_active(node) {
                let row = &mut rows[node];
                row.free = body.nodes.free[node][0];
                row.porosity = body.nodes.porosity[node];
                row.per_solid_mass = 1.0 / body.nodes.solid_mass[node];
                row.water_inertia = water_density * body.nodes.volume[node];
                row.water_share = body.nodes.water_mass[node] * row.per_solid_mass;
                row.drag = body.nodes.drag[node];
            }
        }
        assemble_bands(body, &mut rows);
        let surface = body.surface.weights(&body.grid, &body.points);
        let is_free = |row: &NodeRow| row.free > 0.0;
        let first = rows.iter().position(is_free).unwrap_or(0);
        let end = rows.iter().rposition(is_free).map_or(first, |last| last + 1);
        let mut column = Self {
            blocks: Blocks::of(&rows, first..end),
            rows,
            surface,
            loaded: Vec::new(),
            state: State::zero(count),
        };
        column.read(body);
        Some(column)
    }

    /// Takes velocities and forces of the body as the state to go on from.
    fn read<const D: usize, const W: usize, S: ShapeFunction<W>>(&mut self, body: &Body<D, W, S>) {
        let mut mapped = body.clone();
        mapped.map_velocities();
        mapped.map_forces();
        let reference = &mapped.nodes;
        let state = &mut self.state;
        *state = State::zero(self.rows.len());
        for (node, row) in self.rows.iter_mut().enumerate() {
            row.mixture_force = reference.mixture_force[node][0];
            row.water_force = reference.water_force[node][0];
            let load_force = reference.external_force[node][0];
            if load_force != 0.0 {
                let unloaded_force = row.mixture_force - load_force;
                self.loaded.push(LoadedNode { node, unloaded_force, load_force });
            }
            state.solid_velocity[node + REACH] = reference.solid_velocity[node][0];
            state.water_velocity[node + REACH] = reference.water_velocity[node][0];
        }
        self.blocks.fill(&self.rows);
    }

    /// Lets a share of the load act that was there at the assembly.
    pub fn set_load_share(&mut self, share: f64) {
        for one in &self.loaded {
            let force = one.unloaded_force + share * one.load_force;
            self.rows[one.node].mixture_force = force;
            self.blocks.set_mixture_force(one.node, force);
        }
    }

    /// Fixes the duration of a kick and the drag. Call before `step`.
    pub fn set_step(&mut self, kick: f64, settings: &ExplicitSettings) {
        for row in &mut self.rows {
            let decay =
                || kick * row.drag * (1.0 + row.water_share) / row.water_inertia.max(f64::MIN_POSITIVE);
            let implicit = settings.drag.implicit_weight(decay) * kick * row.drag;
            let inertia = row.water_inertia + implicit * (1.0 + row.water_share);
            let per_inertia = if inertia > 0.0 { row.free / inertia } else { 0.0 };
            row.water_from_water_force = per_inertia;
            row.water_from_relative = -row.drag * per_inertia;
            row.water_from_mixture = implicit * row.per_solid_mass * per_inertia;
        }
        self.blocks.fill(&self.rows);
    }

    /// Nodes to one side that the forces on a node come from: what a step multiplies, for benches.
    pub fn force_reach(&self) -> usize {
        self.blocks.force_reach
    }

    /// One step of `dt` seconds; nothing is allocated.
    pub fn step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        enter(Phase::Forces);
        self.blocks.accelerate(&mut self.state, kick);
        enter(Phase::Motion);
        self.blocks.advance(&mut self.state, kick, dt, settings);
    }

    /// Largest nodal velocity, m/s: not finite or absurd when the run has left.
    pub fn largest_velocity(&self) -> f64 {
        let both = self.state.solid_velocity.iter().chain(&self.state.water_velocity);
        both.fold(
            0.0,
            |largest: f64, velocity| {
                if velocity.is_finite() { largest.max(velocity.abs()) } else { f64::INFINITY }
            },
        )
    }

    /// The body at the present state, from the body that was assembled: stresses, pressures and
    /// displacements of the points from the grid's. Velocities are known at the nodes only.
    pub fn body_now<const D: usize, const W: usize, S: ShapeFunction<W>>(
        &self,
        initial: &Body<D, W, S>,
    ) -> Body<D, W, S> {
        let mut body = initial.clone();
        let inner =
            |field: &[f64]| field[REACH..REACH + self.rows.len()].iter().map(|x| [*x; D]).collect::<Vec<_>>();
        let strained = inner(&self.state.strain_displacement);
        let flux = inner(&self.state.flux_displacement);
        let moved = inner(&self.state.displacement);
        let rows = body.volumetric_rows();
        body.displace_points(&rows, &strained, &flux, &moved);
        for node in 0..body.nodes.len() {
            body.nodes.solid_velocity[node][0] = self.state.solid_velocity[node + REACH];
            body.nodes.water_velocity[node][0] = self.state.water_velocity[node + REACH];
        }
        body.surface_flux += body.surface.mean_of(&body.grid, &body.points, &flux);
        body
    }

    /// Vertical displacement of the loaded surface since the assembly, m.
    pub fn surface_displacement(&self) -> f64 {
        self.surface.iter().map(|(node, weight)| weight * self.state.displacement[node + REACH]).sum()
    }

    /// Nodes that are free, in order: the unknowns of the stability analysis.
    pub fn free_nodes(&self) -> Vec<usize> {
        (0..self.rows.len()).filter(|node| self.rows[*node].free > 0.0).collect()
    }

    /// Removes loads and initial stresses, so that a step is linear and not affine.
    #[must_use]
    pub fn without_loads(mut self) -> Self {
        for row in &mut self.rows {
            row.mixture_force = 0.0;
            row.water_force = 0.0;
        }
        self.loaded.clear();
        self.blocks.fill(&self.rows);
        self
    }

    /// Image under one step of the state that is one in one field of one node: velocities of both
    /// phases, straining displacement, flux displacement.
    pub fn column_of_step(
        &mut self,
        field: usize,
        node: usize,
        dt: f64,
        settings: &ExplicitSettings,
        free: &[usize],
        out: &mut [f64],
    ) {
        self.state = State::zero(self.rows.len());
        // Displacements in units of what a unit velocity makes in a step, for a balanced matrix.
        let unit = |field: usize| if field < 2 { 1.0 } else { dt };
        self.state.field_mut(field)[node + REACH] = unit(field);
        self.step(dt, settings);
        for image in 0..STATE_FIELDS {
            let values = self.state.field_mut(image);
            for (place, node) in free.iter().enumerate() {
                out[image * free.len() + place] = values[node + REACH] / unit(image);
            }
        }
    }
}

impl State {
    fn zero(nodes: usize) -> Self {
        let zero = vec![0.0; nodes + 2 * REACH + LANES];
        Self {
            solid_velocity: zero.clone(),
            water_velocity: zero.clone(),
            strain_displacement: zero.clone(),
            flux_displacement: zero.clone(),
            displacement: zero.clone(),
            solid_acceleration: zero.clone(),
            water_acceleration: zero.clone(),
            solid_trial: zero.clone(),
            water_trial: zero,
        }
    }

    fn field_mut(&mut self, field: usize) -> &mut Vec<f64> {
        match field {
            0 => &mut self.solid_velocity,
            1 => &mut self.water_velocity,
            2 => &mut self.strain_displacement,
            _ => &mut self.flux_displacement,
        }
    }
}
