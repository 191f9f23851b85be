//! A body under its own weight, with a free water level that stands where the surface was at the start.
//!
//! Points then carry total pressures. The hydrostatic one, `ρ_w g (H − y)` at the present height `y`, is not
//! taken out of the balances: forces of weight and of pressure meet at every node, and only what is sampled is
//! the excess. Pore water that leaves does not raise the free level, for over an impermeable base the mixture
//! does not move, `(1 − n) v_s + n v_w = 0`: a surface that has settled lies under the free water of that depth,
//! which presses on mixture and pore water alike. Where nothing deforms, the surface stays in the level.

use crate::actions::self_weight::SelfWeight;
use crate::kernel::body::Body;
use oedometer_problem::method::Configuration;
use oedometer_soil::tensor::{Tensor, Vector};

impl<const D: usize> Body<D> {
    /// Hydrostatic pressure at a point, Pa, at its present height; zero where nothing weighs.
    pub fn hydrostatic_pressure(&self, point: usize) -> f64 {
        let Some(weight) = self.actions.weight else { return 0.0 };
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
        if self.actions.weight.is_some() {
            for point in 0..self.points.len() {
                self.points.pressure[point] += self.hydrostatic_pressure(point);
            }
        }
    }

    /// The body with excess pressures in place of total ones, where the two differ: what is sampled.
    pub(crate) fn in_excess(&self) -> Option<Self> {
        self.actions.weight?;
        let mut body = self.clone();
        for point in 0..body.points.len() {
            body.points.pressure[point] -= self.hydrostatic_pressure(point);
        }
        Some(body)
    }

    /// Adds the weight of both phases, and the free water above a surface that has settled, to the forces on the
    /// nodes.
    pub(crate) fn add_weight(&mut self) {
        let Some(weight) = self.actions.weight else { return };
        let up = D - 1;
        let water_density = self.material.water_density;
        let nodes = &mut self.nodes;
        for node in 0..nodes.len() {
            let mass = nodes.solid_mass[node] + nodes.water_mass[node];
            nodes.mixture_force[node][up] -= mass * weight.gravity;
            nodes.water_force[node][up] -= water_density * nodes.volume[node] * weight.gravity;
        }
        for (node, [mixture, water]) in self.actions.weight_carried.iter().enumerate() {
            let mass = nodes.solid_mass[node] + nodes.water_mass[node];
            for d in 0..D {
                nodes.mixture_force[node][d] += mass * mixture[d];
                nodes.water_force[node][d] += water_density * nodes.volume[node] * water[d];
            }
        }
        let free_water = water_density * weight.gravity * self.settled_under(weight);
        if free_water != 0.0 {
            self.actions.surface.press(free_water, &self.grid, &self.points, &mut self.nodes);
        }
        // Under a drained base stands water of the same level.
        let below = water_density * weight.gravity * weight.level;
        let width: f64 = (0..up).map(|d| self.grid.cells[d] as f64 * self.grid.cell_size).product();
        for (node, share) in &self.nodes.drained_base {
            self.nodes.water_force[*node][up] += below * share * width;
        }
    }

    /// Lets the nodes carry what the stresses of the weight and the hydrostatic pressure leave unbalanced of it: domains off
    /// their lattice overlap, and splines are integrated by few points, so that a soil at rest would flow from the start.
    /// The start is in balance then, as after a geostatic step; what is carried is kept as a share of gravity, and goes
    /// with the masses of the nodes.
    pub(crate) fn carry_what_weight_leaves(&mut self, stresses: Vec<Tensor<D>>) {
        let mut resting = self.clone();
        resting.actions.surface.load = 0.0;
        resting.apply_loads();
        resting.points.effective_stress = stresses;
        for point in 0..resting.points.len() {
            resting.points.pressure[point] = self.hydrostatic_pressure(point);
        }
        resting.map_forces();
        let nodes = &resting.nodes;
        let shares = |node: usize| -> [Vector<D>; 2] {
            let (free, water_free) = (nodes.free[node], nodes.water_free[node]);
            let mass = nodes.solid_mass[node] + nodes.water_mass[node];
            let water = self.material.water_density * nodes.volume[node];
            // A node without mass is free of nothing.
            let share = |free: f64, force: f64, mass: f64| if free > 0.0 { -force / mass } else { 0.0 };
            [
                std::array::from_fn(|d| share(free[d], nodes.mixture_force[node][d], mass)),
                std::array::from_fn(|d| share(water_free[d], nodes.water_force[node][d], water)),
            ]
        };
        self.actions.weight_carried = (0..nodes.len()).map(shares).collect();
    }

    /// Depth of the surface under the free water level, m.
    fn settled_under(&self, weight: SelfWeight) -> f64 {
        match self.configuration {
            Configuration::Frozen => 0.0,
            Configuration::Updated => weight.level - self.actions.surface.height(&self.points) - weight.rise,
            Configuration::Total => {
                let field = &self.nodes.displacement;
                -self.actions.surface.amplitude_of(&self.grid, &self.points, field) - weight.rise
            }
        }
    }
}

#[cfg(test)]
mod tests;
