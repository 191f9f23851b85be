//! A body under its own weight: total pressures in its points, weight and free water in its nodes' forces.

use crate::mpm::body::Body;
use crate::mpm::method::Configuration;
use crate::mpm::operators::self_weight::SelfWeight;

impl<const D: usize> Body<D> {
    /// Hydrostatic pressure at a point, Pa, at its present height; zero where nothing weighs.
    pub fn hydrostatic_pressure(&self, point: usize) -> f64 {
        let Some(weight) = self.weight else { return 0.0 };
        let points = &self.points;
        let height = match self.configuration {
            Configuration::Frozen => points.initial_position[point][D - 1],
            Configuration::Updated => points.position[point][D - 1],
            Configuration::Total => points.initial_position[point][D - 1] + points.displacement[point][D - 1],
        };
        self.material.water_density * weight.gravity * (weight.level - height)
    }

    /// Makes total pressures of the points' pressures beyond the hydrostatic one.
    pub(crate) fn add_hydrostatic_pressure(&mut self) {
        if self.weight.is_some() {
            for point in 0..self.points.len() {
                self.points.pressure[point] += self.hydrostatic_pressure(point);
            }
        }
    }

    /// The body with excess pressures in place of total ones, where the two differ: what is sampled.
    pub(crate) fn in_excess(&self) -> Option<Self> {
        self.weight?;
        let mut body = self.clone();
        for point in 0..body.points.len() {
            body.points.pressure[point] -= self.hydrostatic_pressure(point);
        }
        Some(body)
    }

    /// Adds the weight of both phases, and the free water above a surface that has settled, to the forces on the
    /// nodes.
    pub(crate) fn add_weight(&mut self) {
        let Some(weight) = self.weight else { return };
        let up = D - 1;
        let water_density = self.material.water_density;
        let nodes = &mut self.nodes;
        for node in 0..nodes.len() {
            let mass = nodes.solid_mass[node] + nodes.water_mass[node];
            nodes.mixture_force[node][up] -= mass * weight.gravity;
            nodes.water_force[node][up] -= water_density * nodes.volume[node] * weight.gravity;
        }
        let free_water = water_density * weight.gravity * self.settled_under(weight);
        if free_water != 0.0 {
            self.surface.press(free_water, &self.grid, &self.points, &mut self.nodes);
        }
    }

    /// Depth of the surface under the free water level, m.
    fn settled_under(&self, weight: SelfWeight) -> f64 {
        match self.configuration {
            Configuration::Frozen => 0.0,
            Configuration::Updated => weight.level - self.surface.height(&self.points) - weight.rise,
            Configuration::Total => {
                let field = &self.nodes.displacement;
                -self.surface.amplitude_of(&self.grid, &self.points, field) - weight.rise
            }
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mpm_self_weight.rs"]
mod tests;
