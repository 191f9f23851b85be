//! The frozen step: accelerations, kick and drift; and its action on unloaded states, for stability analysis.

#![expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]

use crate::drag::{NodalBalance, NodalDrag};
use crate::entries::of_dimension;
use crate::integrate::assembled::constraints::{SlidingRows, TiedRows};
use crate::integrate::assembled::operators::FrozenOperators;
use crate::integrate::assembled::rows::{BandsWithin, REACH, RowStorage, Rows};
use crate::integrate::assembled::state::{
    Displacements, FIELDS, FrozenState, LANES, Lanes, MARGIN, SOLID, WATER, lanes, set_lanes,
};
use crate::kernel::body::Body;
use crate::kernel::volumetric::VolumetricRows;
use crate::state::grid::{GHOST_LAYERS, Grid};
use crate::wide::wide;
use nalgebra::DMatrix;
use oedometer_problem::settings::ExplicitSettings;
use oedometer_soil::tensor::{Vector, dot};

/// The unknown that is the mirror image of another, and the sign that its value turns with.
pub(crate) type Image = (usize, f64);

/// A frozen body with its step assembled.
#[derive(Clone, Debug)]
pub struct AssembledStep<const D: usize> {
    /// Node of each row: those that are free in some component.
    pub(crate) nodes: Vec<usize>,
    /// Nodes of the body.
    node_count: usize,
    /// Row of the mirror image of each row's node across the middle of the first direction, where that is not vertical.
    images: Vec<Option<usize>>,
    pub(crate) rows: RowStorage<D>,
    /// Constants of the rows, block by block.
    pub(crate) constants: Vec<BlockConstants<D>>,
    volumetric: VolumetricRows<D>,
    /// Rows whose displacements are the settlement, with their weights and its sign turned.
    settling: Vec<(usize, Vector<D>)>,
    /// Rows that go together under a rigid plate.
    tied: TiedRows,
    /// Rows where the water slides past a skeleton that is held.
    sliding: SlidingRows,
    /// Rows that carry the load, with the force of all else and of the whole load.
    loaded: Vec<LoadedRow<D>>,
    pub(crate) state: FrozenState<D>,
    entries: &'static Entries<D>,
}

/// What other crates call of it.
#[derive(Debug)]
struct Entries<const D: usize> {
    new: fn(&Body<D>) -> AssembledStep<D>,
    kick_and_drift: fn(&mut AssembledStep<D>, f64, f64, &ExplicitSettings),
}

static LINE: Entries<1> = Entries::TABLE;
static PLANE: Entries<2> = Entries::TABLE;

impl<const D: usize> Entries<D> {
    const TABLE: Self = Self { new: AssembledStep::of, kick_and_drift: AssembledStep::take_step };
}

/// A row that carries a part of the load.
#[derive(Clone, Copy, Debug)]
struct LoadedRow<const D: usize> {
    row: usize,
    unloaded_force: Vector<D>,
    load_force: Vector<D>,
}

/// Everything constant about the rows of a block, `[component][row of the block]`; all zero beyond the
/// last row, which keeps it at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockConstants<const D: usize> {
    mixture_force: [Lanes; D],
    water_force: [Lanes; D],
    /// 1 where a component of a phase is free, else 0.
    pub(crate) free: [[Lanes; D]; 2],
    porosity: Lanes,
    /// Inverse of the mass of the grains, where the skeleton is free, 1/kg.
    per_solid_mass: [Lanes; D],
    /// Mass of the water over that of the grains, where the skeleton is free.
    water_share: [Lanes; D],
    /// `ρ_w V`, kg.
    water_inertia: Lanes,
    /// Mass of the water over that of the grains.
    full_water_share: Lanes,
    drag: Lanes,
    /// Acceleration of the water over its force for one kick and drag, 1/kg.
    per_water_inertia: [Lanes; D],
    /// `w Δt D` of the drag at the new velocities, kg (`NodalDrag::implicit`).
    implicit_drag: Lanes,
}

impl<const D: usize> AssembledStep<D> {
    /// Assembles the step of a body on its present operators, velocities and forces.
    pub fn new(body: &Body<D>) -> Self {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.new)(body)
    }

    fn of(body: &Body<D>) -> Self {
        let mut body = body.clone();
        body.map_velocities();
        body.map_forces();
        let (operators, fields) = (FrozenOperators::new(&body), &body.nodes);
        let count = operators.nodes.len();
        let mut step = Self {
            images: mirrored_rows(&body.grid, &operators.nodes),
            rows: RowStorage::new(&operators),
            constants: vec![BlockConstants::zero(); count.div_ceil(LANES)],
            loaded: Vec::new(),
            state: FrozenState::zero(count, operators.volumetric.divergence.len()),
            nodes: operators.nodes,
            node_count: operators.node_count,
            volumetric: operators.volumetric,
            settling: operators.settling,
            tied: operators.tied,
            sliding: operators.sliding,
            entries: of_dimension(&LINE, &PLANE),
        };
        for row in 0..count {
            let node = step.nodes[row];
            step.constants[row / LANES].set(row % LANES, &body, node);
            step.state.velocity[SOLID][MARGIN + row] = fields.solid_velocity[node];
            step.state.velocity[WATER][MARGIN + row] = fields.water_velocity[node];
            let load_force = fields.external_force[node];
            if load_force != [0.0; D] {
                let unloaded_force = std::array::from_fn(|d| fields.mixture_force[node][d] - load_force[d]);
                step.loaded.push(LoadedRow { row, unloaded_force, load_force });
            }
        }
        step
    }

    /// Fixes the duration of a kick and the drag. Call before a step.
    pub fn set_step(&mut self, kick: f64, settings: &ExplicitSettings) {
        for block in &mut self.constants {
            for i in (0..LANES).filter(|i| block.water_inertia[*i] > 0.0) {
                let (inertia, share) = (block.water_inertia[i], block.full_water_share[i]);
                let drag = NodalDrag::new(settings.drag, kick, block.drag[i], share, inertia);
                block.implicit_drag[i] = drag.implicit;
                for d in 0..D {
                    let (share, free) = (block.water_share[d][i], block.free[WATER][d][i]);
                    block.per_water_inertia[d][i] = free / drag.inertia(inertia, share);
                }
            }
        }
    }

    /// Applies a share of the load of the assembly.
    pub fn set_load_share(&mut self, share: f64) {
        for node in &self.loaded {
            let block = &mut self.constants[node.row / LANES];
            for d in 0..D {
                block.mixture_force[d][node.row % LANES] =
                    node.unloaded_force[d] + share * node.load_force[d];
            }
        }
    }

    /// Forgets loads, stresses, velocities and displacements: what a step makes of a state is linear then.
    pub(crate) fn forget_loads(&mut self) {
        self.loaded.clear();
        for block in &mut self.constants {
            block.mixture_force = [[0.0; LANES]; D];
            block.water_force = [[0.0; LANES]; D];
        }
        self.come_to_rest();
    }

    /// Forgets velocities and displacements.
    pub(crate) fn come_to_rest(&mut self) {
        self.state = FrozenState::zero(self.nodes.len(), self.volumetric.divergence.len());
    }

    /// One step of `dt` seconds; nothing is allocated.
    pub fn step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    #[inline]
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        (self.entries.kick_and_drift)(self, kick, dt, settings);
    }

    fn take_step(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        wide!(self.kick_and_drift_by_rows(kick, dt, settings));
    }

    #[inline(always)]
    fn kick_and_drift_by_rows(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        let Self { rows, constants, state, tied, sliding, .. } = self;
        match rows {
            RowStorage::Banded(bands) => {
                match bands.force_reach {
                    0 | 1 => accelerate(&BandsWithin::<D, 1>(bands), constants, state, kick),
                    2 => accelerate(&BandsWithin::<D, 2>(bands), constants, state, kick),
                    _ => accelerate(&BandsWithin::<D, REACH>(bands), constants, state, kick),
                }
                // On a regular lattice a node shares points with its neighbours only.
                if bands.projection_reach <= 1 {
                    advance(&BandsWithin::<D, 1>(bands), constants, state, [kick, dt], settings);
                } else {
                    advance(&BandsWithin::<D, REACH>(bands), constants, state, [kick, dt], settings);
                }
            }
            RowStorage::Sparse(rows) => {
                rows.dilate(&state.flux_displacement, &mut state.dilation);
                accelerate(rows, constants, state, kick);
                sliding.keep_accelerations(state);
                tied.tie_accelerations(state, kick);
                advance(rows, constants, state, [kick, dt], settings);
                sliding.keep_velocities(state, dt, settings.mapping_back);
                tied.tie_velocities(state, dt, settings.mapping_back);
            }
        }
    }

    /// Largest nodal velocity, m/s: infinite where one is not finite.
    pub fn largest_velocity(&self) -> f64 {
        self.state.velocity.iter().flatten().flatten().fold(0.0, |largest: f64, velocity| {
            if velocity.is_finite() { largest.max(velocity.abs()) } else { f64::INFINITY }
        })
    }

    /// Displacement of the loaded surface, or of the plate, since the assembly, m, as its own settlement is measured.
    pub fn surface_displacement(&self) -> f64 {
        let moved = |(row, weight): &(usize, Vector<D>)| dot(weight, &self.state.displacement[MARGIN + row]);
        self.settling.iter().map(moved).sum()
    }

    /// The body at the present state, from the body that was assembled: stresses, pressures and
    /// displacements of the points from the grid's. Velocities are known at the nodes only.
    pub fn body_now(&self, initial: &Body<D>) -> Body<D> {
        let mut body = initial.clone();
        let spread = |field: &[Vector<D>]| {
            let mut nodal = vec![[0.0; D]; self.node_count];
            for (node, value) in self.nodes.iter().zip(&field[MARGIN..]) {
                nodal[*node] = *value;
            }
            nodal
        };
        let flux = spread(&self.state.flux_displacement);
        let strained = spread(&self.state.strain_displacement);
        body.displace_points(&self.volumetric, &strained, &flux, &spread(&self.state.displacement));
        for (row, node) in self.nodes.iter().enumerate() {
            body.nodes.solid_velocity[*node] = self.state.velocity[SOLID][MARGIN + row];
            body.nodes.water_velocity[*node] = self.state.velocity[WATER][MARGIN + row];
        }
        body.surface_flux += body.outflow_of(&flux);
        body
    }
}

/// Row of the mirror image of each row's node; none in one dimension.
fn mirrored_rows<const D: usize>(grid: &Grid<D>, nodes: &[usize]) -> Vec<Option<usize>> {
    if D == 1 {
        return vec![None; nodes.len()];
    }
    let (along, last) = (grid.node_stride()[1], grid.cells[0] + 2 * GHOST_LAYERS);
    // The nodes are in order.
    nodes.iter().map(|node| nodes.binary_search(&(node - node % along + last - node % along)).ok()).collect()
}

impl<const D: usize> BlockConstants<D> {
    fn zero() -> Self {
        let (zero, zeros) = ([0.0; LANES], [[0.0; LANES]; D]);
        Self {
            mixture_force: zeros,
            water_force: zeros,
            free: [zeros; 2],
            porosity: zero,
            per_solid_mass: zeros,
            water_share: zeros,
            water_inertia: zero,
            full_water_share: zero,
            drag: zero,
            per_water_inertia: zeros,
            implicit_drag: zero,
        }
    }

    /// Whether there is a row.
    pub(crate) fn holds_row(&self, i: usize) -> bool {
        self.water_inertia[i] > 0.0
    }

    /// Masses of skeleton and water of a row, kg.
    pub(crate) fn masses(&self, i: usize) -> [f64; 2] {
        let water = self.porosity[i] * self.water_inertia[i];
        [water / self.full_water_share[i], water]
    }

    /// Porosity at a row.
    pub(crate) fn porosity(&self, i: usize) -> f64 {
        self.porosity[i]
    }

    /// Constant forces on mixture and water of a component of a row, N.
    pub(crate) fn given_forces(&self, d: usize, i: usize) -> [f64; 2] {
        [self.mixture_force[d][i], self.water_force[d][i]]
    }

    /// The balance of a component of a row, for the kick and drag last set.
    #[inline(always)]
    fn balance(&self, d: usize, i: usize) -> NodalBalance {
        NodalBalance {
            per_solid_mass: self.per_solid_mass[d][i],
            water_share: self.water_share[d][i],
            per_water_inertia: self.per_water_inertia[d][i],
            drag: NodalDrag { coefficient: self.drag[i], implicit: self.implicit_drag[i] },
        }
    }

    /// Copies the constants of a node.
    fn set(&mut self, i: usize, body: &Body<D>, node: usize) {
        let fields = &body.nodes;
        let water_share = fields.water_mass[node] * fields.per_solid_mass[node];
        for d in 0..D {
            let free = fields.free[node][d];
            self.free[SOLID][d][i] = free;
            self.free[WATER][d][i] = fields.water_free[node][d];
            self.per_solid_mass[d][i] = free * fields.per_solid_mass[node];
            self.water_share[d][i] = free * water_share;
            self.mixture_force[d][i] = fields.mixture_force[node][d];
            self.water_force[d][i] = fields.water_force[node][d];
        }
        self.porosity[i] = fields.porosity[node];
        self.water_inertia[i] = body.material.water_density * fields.volume[node];
        self.full_water_share[i] = water_share;
        self.drag[i] = fields.drag[node];
    }
}

/// Accelerations of skeleton and water, and the velocities that they lead to within `kick` seconds.
#[inline(always)]
fn accelerate<const D: usize>(
    rows: &impl Rows<D>,
    constants: &[BlockConstants<D>],
    state: &mut FrozenState<D>,
    kick: f64,
) {
    let displacements = Displacements {
        strained: &state.strain_displacement,
        flux: &state.flux_displacement,
        dilation: &state.dilation,
    };
    let [solid_velocity, water_velocity] = state.velocity.each_ref().map(|field| &field[..]);
    let [solid_acceleration, water_acceleration] = state.acceleration.each_mut().map(|field| &mut field[..]);
    let [solid_after, water_after] = state.trial.each_mut().map(|field| &mut field[..]);
    for (block, nodes) in constants.iter().enumerate() {
        let [pressure, skeleton] = rows.forces(block, displacements);
        for d in 0..D {
            let solid = lanes(solid_velocity, block, d);
            let water = lanes(water_velocity, block, d);
            let (mut solid_rate, mut water_rate) = ([0.0; LANES], [0.0; LANES]);
            let (mut solid_trial, mut water_trial) = ([0.0; LANES], [0.0; LANES]);
            for i in 0..LANES {
                let mixture_force = nodes.mixture_force[d][i] - skeleton[d][i] - pressure[d][i];
                let water_force = nodes.water_force[d][i] - pressure[d][i];
                let balance = nodes.balance(d, i);
                [solid_rate[i], water_rate[i]] =
                    balance.accelerations(mixture_force, water_force, [solid[i], water[i]]);
                solid_trial[i] = solid[i] + kick * solid_rate[i];
                water_trial[i] = water[i] + kick * water_rate[i];
            }
            set_lanes(solid_acceleration, block, d, solid_rate);
            set_lanes(water_acceleration, block, d, water_rate);
            set_lanes(solid_after, block, d, solid_trial);
            set_lanes(water_after, block, d, water_trial);
        }
    }
}

/// Velocities mapped back after a kick, and the displacements that they make in a drift, both s.
#[inline(always)]
fn advance<const D: usize>(
    rows: &impl Rows<D>,
    constants: &[BlockConstants<D>],
    state: &mut FrozenState<D>,
    [kick, dt]: [f64; 2],
    settings: &ExplicitSettings,
) {
    let (flip, pic) = (settings.flip, 1.0 - settings.flip);
    let velocity = state.velocity.each_mut().map(|field| &mut field[..]);
    let acceleration = state.acceleration.each_ref().map(|field| &field[..]);
    let trial = state.trial.each_ref().map(|field| &field[..]);
    let (strained, flux) = (&mut state.strain_displacement[..], &mut state.flux_displacement[..]);
    let moved = &mut state.displacement[..];
    for (block, nodes) in constants.iter().enumerate() {
        let mut mapped = rows.projected(block, acceleration);
        for phase in [SOLID, WATER] {
            for d in 0..D {
                let before = lanes(velocity[phase], block, d);
                for i in 0..LANES {
                    mapped[phase][d][i] = flip * (before[i] + kick * mapped[phase][d][i]);
                }
            }
        }
        if pic > 0.0 {
            let interpolated = rows.projected(block, trial);
            for phase in [SOLID, WATER] {
                for d in 0..D {
                    for i in 0..LANES {
                        mapped[phase][d][i] += pic * interpolated[phase][d][i];
                    }
                }
            }
        }
        for d in 0..D {
            let mapped = [mapped[SOLID][d], mapped[WATER][d]];
            let kicked = trial.map(|field| lanes(field, block, d));
            let [solid, water] = if settings.mapping_back { mapped } else { kicked };
            let mut strain_displacement = lanes(strained, block, d);
            let mut flux_displacement = lanes(flux, block, d);
            let mut displacement = lanes(moved, block, d);
            for i in 0..LANES {
                strain_displacement[i] += dt * solid[i];
                flux_displacement[i] += dt * (solid[i] + nodes.porosity[i] * (water[i] - solid[i]));
                displacement[i] += dt * kicked[SOLID][i];
            }
            set_lanes(velocity[SOLID], block, d, mapped[SOLID]);
            set_lanes(velocity[WATER], block, d, mapped[WATER]);
            set_lanes(strained, block, d, strain_displacement);
            set_lanes(flux, block, d, flux_displacement);
            set_lanes(moved, block, d, displacement);
        }
    }
}

impl<const D: usize> AssembledStep<D> {
    /// Rows and components that are free in some phase, in order: the unknowns of the step operator.
    fn free_components(&self) -> Vec<(usize, usize)> {
        let is_free = |row: usize, d: usize| {
            self.constants[row / LANES].free.iter().any(|free| free[d][row % LANES] > 0.0)
        };
        let components = (0..self.nodes.len()).flat_map(|row| (0..D).map(move |d| (row, d)));
        components.filter(|(row, d)| is_free(*row, *d)).collect()
    }

    /// The mirror image of each unknown of the step operator across the middle of the body; none at all where one has none.
    pub(crate) fn images(&self) -> Vec<Image> {
        let free = self.free_components();
        let image = |(row, d): &(usize, usize)| {
            let place = free.binary_search(&(self.images[*row]?, *d)).ok()?;
            Some((place, if *d == 0 { -1.0 } else { 1.0 }))
        };
        let of_field: Option<Vec<Image>> = free.iter().map(image).collect();
        let (images, count) = (of_field.unwrap_or_default(), free.len());
        let of_field = |field: usize| images.iter().map(move |(place, sign)| (field * count + place, *sign));
        (0..FIELDS).flat_map(of_field).collect()
    }

    /// Number of unknowns of the step operator.
    pub fn unknowns(&self) -> usize {
        FIELDS * self.free_components().len()
    }

    /// The step as a matrix, loads removed: velocities of both phases, straining and flux displacement of
    /// every free component, displacements in units of what a unit velocity makes in a step.
    pub fn operator(&self, dt: f64, settings: &ExplicitSettings) -> DMatrix<f64> {
        let mut step = self.clone();
        step.forget_loads();
        step.set_step(dt, settings);
        let free = step.free_components();
        // For a balanced matrix.
        let unit = |field: usize| if field < 2 { 1.0 } else { dt };
        let size = FIELDS * free.len();
        let mut operator = DMatrix::zeros(size, size);
        for (column, mut image) in operator.column_iter_mut().enumerate() {
            let (field, (row, d)) = (column / free.len(), free[column % free.len()]);
            step.come_to_rest();
            step.state.field_mut(field)[MARGIN + row][d] = unit(field);
            step.step(dt, settings);
            for target in 0..FIELDS {
                let values = step.state.field_mut(target);
                for (place, (row, d)) in free.iter().enumerate() {
                    image[target * free.len() + place] = values[MARGIN + row][*d] / unit(target);
                }
            }
        }
        operator
    }

    /// Bits of all that a step maps to itself.
    pub(crate) fn bits(&mut self) -> Vec<u64> {
        let mut bits = Vec::new();
        for field in 0..FIELDS {
            bits.extend(self.state.field_mut(field).as_flattened().iter().map(|value| value.to_bits()));
        }
        bits
    }

    /// Forgets loads, stresses and displacements and sets every node in some motion: any growth
    /// from there on is that of the step alone.
    pub fn disturb(&mut self) {
        self.forget_loads();
        // A fixed sequence without a pattern on any grid (Knuth's multiplicative hash).
        let mut seed = 1_u32;
        for row in 0..self.nodes.len() {
            for phase in [SOLID, WATER] {
                for d in 0..D {
                    seed = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
                    let free = self.constants[row / LANES].free[phase][d][row % LANES];
                    self.state.velocity[phase][MARGIN + row][d] =
                        free * (f64::from(seed) / f64::from(u32::MAX) - 0.5);
                }
            }
        }
    }
}
