//! A body under its loads: forces on its surface or plate, its settlement, and the water that leaves it.
//!
//! The plate is rigid, smooth and impermeable and lies on the upper face of the first direction: a constraint.
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

use crate::body::Body;
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
    pub fn of<const D: usize>(
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

    /// Puts the force on the plate beside what acts on the nodes already.
    pub fn apply<const D: usize>(&self, nodes: &mut Nodes<D>) {
        if let Some(lead) = self.nodes.first() {
            nodes.external_force[*lead][NORMAL] -= self.force;
        }
    }

    /// Gives the nodes of the plate the one acceleration that their masses have under all forces.
    pub fn tie_accelerations<const D: usize>(&self, nodes: &mut Nodes<D>) {
        let Nodes { solid_mass, water_mass, solid_acceleration, water_acceleration, .. } = nodes;
        self.tie([solid_mass, water_mass], [solid_acceleration, water_acceleration]);
    }

    /// Gives the nodes of the plate the one velocity that keeps their momentum.
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

/// A load that grows linearly to its full value, or acts at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GrowingLoad {
    /// Whole load, Pa, and the time over which it grows, s.
    load: f64,
    loading_time: f64,
    /// Share of it that acts.
    share: f64,
}

impl GrowingLoad {
    /// The load of a body, which grows over a time, s.
    pub fn of<const D: usize>(body: &Body<D>, loading_time: f64) -> Self {
        Self { load: body.surface.load, loading_time, share: 1.0 }
    }

    /// Whether it still grows.
    pub fn grows(&self) -> bool {
        self.share < 1.0
    }

    /// Share of it that acts.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Puts the load of a time, s, on the surface, where it grows.
    pub fn act_at<const D: usize>(&mut self, body: &mut Body<D>, time: f64) {
        if self.loading_time > 0.0 {
            self.share = (time / self.loading_time).min(1.0);
            body.surface.load = self.share * self.load;
            body.apply_loads();
        }
    }
}

impl<const D: usize> Body<D> {
    /// Whether a component of a node goes with a rigid plate.
    #[inline]
    pub fn is_tied(&self, node: usize, component: usize) -> bool {
        self.plate.as_ref().is_some_and(|plate| plate.ties(node, component))
    }

    /// Puts all loads on the nodes as the external force of the mixture.
    pub fn apply_loads(&mut self) {
        self.surface.apply(&self.grid, &self.points, &mut self.nodes);
        if let Some(plate) = &self.plate {
            plate.apply(&mut self.nodes);
        }
    }

    /// Nodes whose displacements, times these weights and with the sign turned, are the settlement: those of
    /// the plate where there is one, of the loaded surface elsewhere.
    pub fn settling_weights(&self) -> Vec<(usize, Vector<D>)> {
        match self.plate.as_ref().and_then(|plate| plate.nodes.first()) {
            Some(lead) => vec![(*lead, along(NORMAL, 1.0))],
            None => upward(self.surface.weights(&self.grid, &self.points)),
        }
    }

    /// Nodes whose fluxes, times these weights, are what passes the surface and goes before the plate, per area
    /// of the surface.
    pub fn outflow_weights(&self) -> Vec<(usize, Vector<D>)> {
        let mut weights = upward(self.surface.mean_weights(&self.grid, &self.points));
        if let Some((plate, lead)) = self.plate.as_ref().and_then(|plate| Some((plate, plate.nodes.first()?)))
        {
            weights.push((*lead, along(NORMAL, plate.face_over_surface)));
        }
        weights
    }

    /// What of a nodal flux passes the surface and goes before the plate, per area of the surface.
    pub fn outflow_of(&self, field: &[Vector<D>]) -> f64 {
        let before_plate = self.plate.as_ref().map_or(0.0, |plate| {
            plate.nodes.first().map_or(0.0, |lead| plate.face_over_surface * field[*lead][NORMAL])
        });
        self.surface.mean_of(&self.grid, &self.points, field) + before_plate
    }

    /// Largest force on a free node or on the plate that nothing balances, N.
    pub fn unbalanced_force(&self) -> f64 {
        let mut body = self.clone();
        body.map_forces();
        if let Some(plate) = &self.plate {
            return plate.largest_force(&body.nodes.mixture_force, &body.nodes.free);
        }
        largest_free_force(&body.nodes)
    }
}

/// Largest force on a free component of a node, N.
pub(crate) fn largest_free_force<const D: usize>(nodes: &Nodes<D>) -> f64 {
    let forces = nodes.mixture_force.iter().flatten().zip(nodes.free.iter().flatten());
    forces.fold(0.0, |largest: f64, (force, free)| largest.max((force * free).abs()))
}

/// A vector along one direction.
fn along<const D: usize>(direction: usize, length: f64) -> Vector<D> {
    std::array::from_fn(|d| if d == direction { length } else { 0.0 })
}

fn upward<const D: usize>(weights: Vec<(usize, f64)>) -> Vec<(usize, Vector<D>)> {
    weights.into_iter().map(|(node, weight)| (node, along(D - 1, weight))).collect()
}

#[cfg(test)]
mod tests;
