//! The frozen step above one dimension as sparse maps between grid arrays.
//!
//! What `assembled` is to a column: where weights are frozen and the material is linear, stresses
//! are linear in the nodal displacements that strained them, so that the points need no visit
//! between outputs. The pressure stays in two factors, `D` to the sites and `Q R` back to the nodes:
//! their product would be five times as long.

use crate::mpm::assembled::stiffness::NodeBlocks;
use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::explicit::ExplicitSettings;
use crate::mpm::operators::volumetric::VolumetricRows;
use crate::mpm::run::profile::{Phase, enter};
use crate::soil::tensor::{Tensor, Vector};

/// Both phases at a node: skeleton, water.
type Phases<const D: usize> = [Vector<D>; 2];

/// A frozen body with its step assembled.
#[derive(Clone, Debug)]
pub struct AssembledPlane<const D: usize> {
    /// Node of each row: those that carry mass and are free in some component.
    nodes: Vec<usize>,
    /// Nodes of the body.
    node_count: usize,
    constants: Vec<NodeConstants<D>>,
    divergence: SparseMap<Vector<D>>,
    pressure_force: SparseMap<Vector<D>>,
    skeleton_force: SparseMap<Tensor<D>>,
    projection: SparseMap<f64>,
    rows: VolumetricRows<D>,
    /// Rows that span the loaded surface, with the weights there.
    surface: Vec<(usize, f64)>,
    /// Rows that carry the load, with the force of all else and of the whole load.
    loaded: Vec<LoadedNode<D>>,
    state: State<D>,
}

/// A node that carries a part of the load.
#[derive(Clone, Copy, Debug)]
struct LoadedNode<const D: usize> {
    row: usize,
    unloaded_force: Vector<D>,
    load_force: Vector<D>,
}

/// Everything constant about one node.
#[derive(Clone, Copy, Debug)]
struct NodeConstants<const D: usize> {
    mixture_force: Vector<D>,
    water_force: Vector<D>,
    free: Phases<D>,
    porosity: f64,
    per_solid_mass: f64,
    water_inertia: f64,
    water_share: f64,
    drag: f64,
    /// Acceleration of the water over its force for one step size and drag, 1/kg.
    water_from_force: Vector<D>,
    /// What the drag at the new velocities makes of the mixture's force.
    water_from_mixture: f64,
}

#[derive(Clone, Debug, Default)]
struct State<const D: usize> {
    velocity: Vec<Phases<D>>,
    trial: Vec<Phases<D>>,
    acceleration: Vec<Phases<D>>,
    /// Displacement that strained the skeleton, m.
    strain_displacement: Vec<Vector<D>>,
    /// Time integral of `v_s + n(v_w − v_s)`, m.
    flux_displacement: Vec<Vector<D>>,
    /// Displacement of the nodes themselves, m.
    displacement: Vec<Vector<D>>,
    /// Dilation at the sites.
    dilation: Vec<f64>,
}

/// Sparse rows, one after another.
#[derive(Clone, Debug, Default)]
struct SparseMap<T> {
    starts: Vec<usize>,
    entries: Vec<(u32, T)>,
}

impl<T: Copy> SparseMap<T> {
    fn of(rows: impl IntoIterator<Item = Vec<(usize, T)>>) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for row in rows {
            entries.extend(
                row.into_iter().map(|(column, value)| (u32::try_from(column).unwrap_or(u32::MAX), value)),
            );
            starts.push(entries.len());
        }
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

impl<const D: usize> AssembledPlane<D> {
    /// Assembles the step of a body on its present operators.
    pub fn new<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        let fields = &body.nodes;
        let is_free = |node: &usize| fields.free[*node] != [0.0; D] || fields.water_free[*node] != [0.0; D];
        let nodes: Vec<usize> = (0..fields.len()).filter(is_free).collect();
        let mut number = vec![None; fields.len()];
        for (row, node) in nodes.iter().enumerate() {
            number[*node] = Some(row);
        }
        let rows = body.volumetric_rows();
        let sites = rows.divergence.len();
        let divergence = rows.divergence.iter().map(|row| numbered(row, &number));
        let mut forces = vec![Vec::new(); nodes.len()];
        for (site, row) in body.pressure_forces(&rows).iter().enumerate() {
            for (row, force) in numbered(row, &number) {
                forces[row].push((site, force.map(|component| rows.coupling[site] * component)));
            }
        }
        let skeleton = body.skeleton_stiffness(&rows);
        let projection = projection(body);
        let mut plane = Self {
            constants: nodes.iter().map(|node| NodeConstants::of(body, *node)).collect(),
            divergence: SparseMap::of(divergence),
            pressure_force: SparseMap::of(forces),
            skeleton_force: SparseMap::of(nodes.iter().map(|node| numbered(&skeleton.rows[*node], &number))),
            projection: SparseMap::of(nodes.iter().map(|node| {
                numbered(&projection.rows[*node], &number)
                    .into_iter()
                    .map(|(row, block)| (row, block[0][0]))
                    .collect()
            })),
            surface: numbered(&body.surface.weights(&body.grid, &body.points), &number),
            loaded: Vec::new(),
            state: State::zero(nodes.len(), sites),
            node_count: fields.len(),
            rows,
            nodes,
        };
        plane.read(body);
        plane
    }

    /// Takes velocities and forces of the body as the state to go on from.
    fn read<const W: usize, S: ShapeFunction<W>>(&mut self, body: &Body<D, W, S>) {
        let mut mapped = body.clone();
        mapped.map_velocities();
        mapped.map_forces();
        for (row, node) in self.nodes.iter().enumerate() {
            self.constants[row].mixture_force = mapped.nodes.mixture_force[*node];
            let load_force = mapped.nodes.external_force[*node];
            if load_force != [0.0; D] {
                let all = mapped.nodes.mixture_force[*node];
                let unloaded_force = std::array::from_fn(|d| all[d] - load_force[d]);
                self.loaded.push(LoadedNode { row, unloaded_force, load_force });
            }
            self.constants[row].water_force = mapped.nodes.water_force[*node];
            self.state.velocity[row] =
                [mapped.nodes.solid_velocity[*node], mapped.nodes.water_velocity[*node]];
        }
    }

    /// Coefficients of the maps that a step reads once, bytes: what bounds its speed once they no longer
    /// fit into the nearest cache.
    pub fn bytes_a_step(&self) -> usize {
        self.divergence.bytes()
            + self.pressure_force.bytes()
            + self.skeleton_force.bytes()
            + self.projection.bytes()
            + std::mem::size_of_val(&self.constants[..])
    }

    /// Multiply-adds of a step by its maps, with FLIP.
    pub fn products_a_step(&self) -> usize {
        D * (self.divergence.entries.len() + self.pressure_force.entries.len())
            + D * D * self.skeleton_force.entries.len()
            + 2 * D * self.projection.entries.len()
    }

    /// Fixes the duration of a kick and the drag. Call before `step`.
    pub fn set_step(&mut self, kick: f64, settings: &ExplicitSettings) {
        for node in &mut self.constants {
            let decay = || kick * node.drag * (1.0 + node.water_share) / node.water_inertia;
            let implicit = settings.drag.implicit_weight(decay) * kick * node.drag;
            node.water_from_mixture = implicit;
            node.water_from_force = std::array::from_fn(|d| {
                node.free[1][d] / (node.water_inertia + implicit * (1.0 + node.free[0][d] * node.water_share))
            });
        }
    }

    /// Lets a share of the load act that was there at the assembly.
    pub fn set_load_share(&mut self, share: f64) {
        for one in &self.loaded {
            let target = &mut self.constants[one.row].mixture_force;
            *target = std::array::from_fn(|d| one.unloaded_force[d] + share * one.load_force[d]);
        }
    }

    /// One step of `dt` seconds; nothing is allocated.
    pub fn step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        enter(Phase::Recovery);
        self.dilations();
        enter(Phase::Forces);
        self.accelerations(kick);
        enter(Phase::Motion);
        let (flip, pic) = (settings.flip, 1.0 - settings.flip);
        let state = &mut self.state;
        for (row, node) in self.constants.iter().enumerate() {
            let rate = projected(self.projection.row(row), &state.acceleration);
            let mut mapped = state.velocity[row];
            for phase in 0..2 {
                for d in 0..D {
                    mapped[phase][d] =
                        flip * (mapped[phase][d] + kick * node.free[phase][d] * rate[phase][d]);
                }
            }
            if pic > 0.0 {
                let interpolated = projected(self.projection.row(row), &state.trial);
                for phase in 0..2 {
                    for d in 0..D {
                        mapped[phase][d] += pic * node.free[phase][d] * interpolated[phase][d];
                    }
                }
            }
            state.velocity[row] = mapped;
            let [solid, water] = if settings.mapping_back { mapped } else { state.trial[row] };
            for d in 0..D {
                state.strain_displacement[row][d] += dt * solid[d];
                state.flux_displacement[row][d] += dt * (solid[d] + node.porosity * (water[d] - solid[d]));
                state.displacement[row][d] += dt * state.trial[row][0][d];
            }
        }
    }

    fn dilations(&mut self) {
        let state = &mut self.state;
        for (site, dilation) in state.dilation.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (column, coefficients) in self.divergence.row(site) {
                let moved = &state.flux_displacement[*column as usize];
                for d in 0..D {
                    sum += coefficients[d] * moved[d];
                }
            }
            *dilation = sum;
        }
    }

    fn accelerations(&mut self, kick: f64) {
        let state = &mut self.state;
        for (row, node) in self.constants.iter().enumerate() {
            let mut pressure = [0.0; D];
            for (site, force) in self.pressure_force.row(row) {
                let dilation = state.dilation[*site as usize];
                for d in 0..D {
                    pressure[d] += force[d] * dilation;
                }
            }
            let mut skeleton = [0.0; D];
            for (column, block) in self.skeleton_force.row(row) {
                let moved = &state.strain_displacement[*column as usize];
                for d in 0..D {
                    for e in 0..D {
                        skeleton[d] += block[d][e] * moved[e];
                    }
                }
            }
            let [solid, water] = state.velocity[row];
            for d in 0..D {
                let free = node.free[0][d];
                let mixture =
                    free * (node.mixture_force[d] - skeleton[d] - pressure[d]) * node.per_solid_mass;
                let force = node.water_force[d] - pressure[d] - node.drag * (water[d] - solid[d])
                    + node.water_from_mixture * mixture;
                let water_rate = node.water_from_force[d] * force;
                let solid_rate = mixture - free * node.water_share * water_rate;
                state.acceleration[row][0][d] = solid_rate;
                state.acceleration[row][1][d] = water_rate;
                state.trial[row][0][d] = solid[d] + kick * solid_rate;
                state.trial[row][1][d] = water[d] + kick * water_rate;
            }
        }
    }

    /// Largest nodal velocity, m/s: infinite where one is not finite.
    pub fn largest_velocity(&self) -> f64 {
        self.state.velocity.iter().flatten().flatten().fold(0.0, |largest: f64, velocity| {
            if velocity.is_finite() { largest.max(velocity.abs()) } else { f64::INFINITY }
        })
    }

    /// Displacement of the loaded surface since the assembly, m, as its own settlement is measured.
    pub fn surface_displacement(&self) -> f64 {
        self.surface.iter().map(|(row, weight)| weight * self.state.displacement[*row][D - 1]).sum()
    }

    /// The body at the present state, from the body that was assembled.
    pub fn body_now<const W: usize, S: ShapeFunction<W>>(&self, initial: &Body<D, W, S>) -> Body<D, W, S> {
        let mut body = initial.clone();
        let spread = |field: &[Vector<D>]| {
            let mut whole = vec![[0.0; D]; self.node_count];
            for (node, value) in self.nodes.iter().zip(field) {
                whole[*node] = *value;
            }
            whole
        };
        let flux = spread(&self.state.flux_displacement);
        let strained = spread(&self.state.strain_displacement);
        body.displace_points(&self.rows, &strained, &flux, &spread(&self.state.displacement));
        for (node, velocity) in self.nodes.iter().zip(&self.state.velocity) {
            body.nodes.solid_velocity[*node] = velocity[0];
            body.nodes.water_velocity[*node] = velocity[1];
        }
        body.surface_flux += body.surface.mean_of(&body.grid, &body.points, &flux);
        body
    }

    /// Forgets loads, stresses and displacements and sets every node in some motion: what grows
    /// from there on grows by the step alone.
    pub fn disturb(&mut self) {
        let (nodes, sites) = (self.nodes.len(), self.rows.divergence.len());
        self.state = State::zero(nodes, sites);
        self.loaded.clear();
        // A fixed sequence without a pattern on any grid (Knuth's multiplicative hash).
        let mut seed = 1_u32;
        for (node, velocity) in self.constants.iter_mut().zip(&mut self.state.velocity) {
            node.mixture_force = [0.0; D];
            node.water_force = [0.0; D];
            for phase in 0..2 {
                for d in 0..D {
                    seed = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
                    velocity[phase][d] = node.free[phase][d] * (f64::from(seed) / f64::from(u32::MAX) - 0.5);
                }
            }
        }
    }
}

impl<const D: usize> NodeConstants<D> {
    fn of<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>, node: usize) -> Self {
        let fields = &body.nodes;
        Self {
            mixture_force: [0.0; D],
            water_force: [0.0; D],
            free: [fields.free[node], fields.water_free[node]],
            porosity: fields.porosity[node],
            per_solid_mass: fields.per_solid_mass[node],
            water_inertia: body.material.water_density * fields.volume[node],
            water_share: fields.water_mass[node] * fields.per_solid_mass[node],
            drag: fields.drag[node],
            water_from_force: [0.0; D],
            water_from_mixture: 0.0,
        }
    }
}

impl<const D: usize> State<D> {
    fn zero(nodes: usize, sites: usize) -> Self {
        let (phases, vectors) = (vec![[[0.0; D]; 2]; nodes], vec![[0.0; D]; nodes]);
        Self {
            velocity: phases.clone(),
            trial: phases.clone(),
            acceleration: phases,
            strain_displacement: vectors.clone(),
            flux_displacement: vectors.clone(),
            displacement: vectors,
            dilation: vec![0.0; sites],
        }
    }
}

/// Entries of a row with the numbers of their nodes; those of held nodes fall away.
fn numbered<T: Copy>(row: &[(usize, T)], number: &[Option<usize>]) -> Vec<(usize, T)> {
    row.iter().filter_map(|(node, value)| Some((number[*node]?, *value))).collect()
}

#[inline]
fn projected<const D: usize>(row: &[(u32, f64)], field: &[Phases<D>]) -> Phases<D> {
    let mut sum = [[0.0; D]; 2];
    for (column, weight) in row {
        let value = &field[*column as usize];
        for phase in 0..2 {
            for d in 0..D {
                sum[phase][d] += weight * value[phase][d];
            }
        }
    }
    sum
}

/// `P = M⁻¹ Σ N m ⊗ N`: nodal velocities to the points and back, in the first component.
fn projection<const D: usize, const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> NodeBlocks<D> {
    let mut blocks = NodeBlocks::zero(body.nodes.len());
    let stride = body.grid.node_stride();
    let soil = &body.material;
    for point in 0..body.points.len() {
        let mass = body.points.initial_volume[point] * (1.0 - soil.porosity) * soil.grain_density;
        let mut weights = Vec::with_capacity(9);
        body.basis.visit(stride, point, |node, weight, _| {
            if weight != 0.0 {
                weights.push((node, weight));
            }
        });
        for (row, to) in &weights {
            for (column, from) in &weights {
                blocks.block(*row, *column)[0][0] += to * mass * from * body.nodes.per_solid_mass[*row];
            }
        }
    }
    blocks
}
