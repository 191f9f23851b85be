//! A plate: rigid, smooth and impermeable and on the upper face of the first direction: a constraint.
//!
//! All nodes of the face share one velocity along its normal, of the mixture and of the water alike, and the
//! plate's force is shared by all of them. In a step
//!
//! ```text
//! a = Σ (m_s a_s + m_w a_w)/Σ (m_s + m_w) = Σ f/Σ m
//! ```
//!
//! over the face: what an inelastic impact of all its masses does, for velocities alike. Along the plate
//! nothing is held. A uniform load in its place would be another problem: the face would bend.

use crate::state::grid::Grid;
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

/// Direction of the plate's normal: the first.
pub const NORMAL: usize = 0;

/// A rigid plate and the nodes that go with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidPlate {
    /// Nodes of the face that carry mass, the lowest first: it stands for all of them.
    pub nodes: Vec<usize>,
    /// Whether each node of the grid goes with the plate.
    is_tied: Vec<bool>,
    /// Force on the plate, N, against its normal.
    force: f64,
    /// Area of the plate over that of the drained surface.
    pub face_over_surface: f64,
}

impl RigidPlate {
    /// The plate on a body's upper face under a mean pressure, Pa; masses must have been mapped.
    pub fn new<const D: usize>(
        load: f64,
        grid: &Grid<D>,
        nodes: &Nodes<D>,
        points: impl Iterator<Item = f64>,
    ) -> Self {
        let distance = grid.cells[NORMAL] as f64 * grid.cell_size;
        let is_tied: Vec<bool> = (0..nodes.len())
            .map(|node| {
                let off = grid.node_position(node)[NORMAL] - distance;
                nodes.is_active(node) && off.abs() < 1e-6 * grid.cell_size
            })
            .collect();
        let face = points.sum::<f64>() / distance;
        Self {
            nodes: (0..is_tied.len()).filter(|node| is_tied[*node]).collect(),
            is_tied,
            force: load * face,
            face_over_surface: face / distance,
        }
    }

    /// Whether a component of a node goes with the plate.
    #[inline]
    pub fn ties(&self, node: usize, component: usize) -> bool {
        component == NORMAL && self.is_tied[node]
    }

    /// Adds the force on the plate to those on the nodes.
    pub fn apply<const D: usize>(&self, nodes: &mut Nodes<D>) {
        if let Some(lead) = self.nodes.first() {
            nodes.external_force[*lead][NORMAL] -= self.force;
        }
    }

    /// Sets the accelerations of the plate's nodes to that of their total mass under all forces.
    pub fn tie_accelerations<const D: usize>(&self, nodes: &mut Nodes<D>) {
        let Nodes { solid_mass, water_mass, solid_acceleration, water_acceleration, .. } = nodes;
        self.tie([solid_mass, water_mass], [solid_acceleration, water_acceleration]);
    }

    /// Sets the velocities of the plate's nodes to the one that keeps their momentum.
    pub fn tie_velocities<const D: usize>(&self, nodes: &mut Nodes<D>) {
        let Nodes { solid_mass, water_mass, solid_velocity, water_velocity, .. } = nodes;
        self.tie([solid_mass, water_mass], [solid_velocity, water_velocity]);
    }

    fn tie<const D: usize>(&self, masses: [&[f64]; 2], fields: [&mut [Vector<D>]; 2]) {
        let [solid, water] = fields;
        let (mut sum, mut mass) = (0.0, 0.0);
        for node in &self.nodes {
            sum += masses[0][*node] * solid[*node][NORMAL] + masses[1][*node] * water[*node][NORMAL];
            mass += masses[0][*node] + masses[1][*node];
        }
        for node in &self.nodes {
            solid[*node][NORMAL] = sum / mass;
            water[*node][NORMAL] = sum / mass;
        }
    }

    /// Largest force, N, that a list of forces on free components leaves: those on the plate in one.
    pub fn largest_force<const D: usize>(&self, forces: &[Vector<D>], free: &[Vector<D>]) -> f64 {
        let together: f64 = self.nodes.iter().map(|node| forces[*node][NORMAL]).sum();
        let mut largest = together.abs();
        for (node, (force, free)) in forces.iter().zip(free).enumerate() {
            for d in (0..D).filter(|d| !self.ties(node, *d)) {
                largest = largest.max((force[d] * free[d]).abs());
            }
        }
        largest
    }
}
