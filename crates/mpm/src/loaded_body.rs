//! A body under its loads: what acts on its surface or on its plate, what the settlement is, and what leaves it.

use crate::body::Body;
use crate::operators::rigid_plate::NORMAL;
use oedometer_soil::tensor::Vector;

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
        let (forces, free) = (&body.nodes.mixture_force, &body.nodes.free);
        if let Some(plate) = &self.plate {
            return plate.largest_force(forces, free);
        }
        let forces = forces.iter().flatten().zip(free.iter().flatten());
        forces.fold(0.0, |largest: f64, (force, free)| largest.max((force * free).abs()))
    }
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
