//! A body under its loads: forces on its surface or plate, its settlement, and the water that leaves it.

use crate::actions::rigid_plate::NORMAL;
use crate::kernel::body::Body;
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

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
    pub fn new<const D: usize>(body: &Body<D>, loading_time: f64) -> Self {
        Self { load: body.actions.surface.load, loading_time, share: 1.0 }
    }

    /// Whether the load still grows.
    pub fn grows(&self) -> bool {
        self.share < 1.0
    }

    /// Share of it that acts.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Sets the load on the surface to that of a time, s, where it grows.
    pub fn act_at<const D: usize>(&mut self, body: &mut Body<D>, time: f64) {
        if self.loading_time > 0.0 {
            self.share = (time / self.loading_time).min(1.0);
            body.actions.surface.load = self.share * self.load;
            body.apply_loads();
        }
    }
}

impl<const D: usize> Body<D> {
    /// Whether a component of a node goes with a rigid plate.
    #[inline]
    pub fn is_tied(&self, node: usize, component: usize) -> bool {
        self.actions.plate.as_ref().is_some_and(|plate| plate.ties(node, component))
    }

    /// Adds all loads to the external force of the mixture at the nodes.
    pub fn apply_loads(&mut self) {
        self.actions.surface.apply(&self.grid, &self.points, &mut self.nodes);
        if let Some(plate) = &self.actions.plate {
            plate.apply(&mut self.nodes);
        }
    }

    /// Nodes whose displacements, times these weights and with the sign turned, are the settlement: those of
    /// the plate where there is one, of the loaded surface elsewhere.
    pub fn settling_weights(&self) -> Vec<(usize, Vector<D>)> {
        match self.actions.plate.as_ref().and_then(|plate| plate.nodes.first()) {
            Some(lead) => vec![(*lead, along(NORMAL, 1.0))],
            None => upward(self.actions.surface.weights(&self.grid, &self.points)),
        }
    }

    /// Nodes whose fluxes, times these weights, are what passes the surface and a drained base and goes before the plate, per
    /// area of the surface.
    pub fn outflow_weights(&self) -> Vec<(usize, Vector<D>)> {
        let mut weights = upward(self.actions.surface.mean_weights(&self.grid, &self.points));
        if let Some((plate, lead)) =
            self.actions.plate.as_ref().and_then(|plate| Some((plate, plate.nodes.first()?)))
        {
            weights.push((*lead, along(NORMAL, plate.face_over_surface)));
        }
        weights.extend(self.nodes.drained_base.iter().map(|(node, share)| (*node, along(D - 1, -share))));
        weights
    }

    /// Outflow of a nodal flux through the surface, a drained base and at the plate, per area of the surface.
    pub fn outflow_of(&self, field: &[Vector<D>]) -> f64 {
        let before_plate = self.actions.plate.as_ref().map_or(0.0, |plate| {
            plate.nodes.first().map_or(0.0, |lead| plate.face_over_surface * field[*lead][NORMAL])
        });
        let through_base: f64 =
            self.nodes.drained_base.iter().map(|(node, share)| share * field[*node][D - 1]).sum();
        self.actions.surface.mean_of(&self.grid, &self.points, field) + before_plate - through_base
    }

    /// Largest force on a free node or on the plate that nothing balances, N.
    pub fn unbalanced_force(&self) -> f64 {
        let mut body = self.clone();
        body.map_forces();
        if let Some(plate) = &self.actions.plate {
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
