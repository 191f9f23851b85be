//! Sliver nodes of double-point MPM, which the surface of the soil has all but left: they take part in the node below. Own
//! invention; without it a column ends in the middle of its consolidation (docs/methods.md).
//!
//! Just above a node that the surface has passed, the next one keeps next to no mass and its whole share of load,
//! stress and pressure. With one set of points these three balance, for their domains end together; with two the pressure's come
//! from other domains, and what is left over the mass has no bound.

use crate::state::grid::{GHOST_LAYERS, Grid};
use crate::state::nodes::Nodes;

/// Share of the grains of a full node below which a topmost node cannot stand alone.
const LEAST_MASS: f64 = 0.1;

/// Topmost nodes that cannot stand alone; found anew at every step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SliverNodes {
    /// Mass of the grains around an inner node, kg; zero where no node is ever merged.
    full_mass: f64,
    /// Sliver nodes, each with the node below it.
    pairs: Vec<(usize, usize)>,
    /// Whether each node is one, `[node]`.
    is_sliver: Vec<bool>,
}

impl SliverNodes {
    /// Room for the nodes of a grid; `full_mass` is that of the grains around an inner node, kg.
    pub fn new<const D: usize>(grid: &Grid<D>, full_mass: f64) -> Self {
        Self {
            full_mass,
            pairs: Vec::with_capacity(grid.node_count()),
            is_sliver: vec![false; grid.node_count()],
        }
    }

    /// Finds them by the mass of the grains at the nodes.
    pub fn find<const D: usize>(&mut self, grid: &Grid<D>, nodes: &Nodes<D>) {
        let up = grid.node_stride()[D - 1];
        self.pairs.clear();
        self.is_sliver.fill(false);
        for node in up..nodes.len() - up {
            let is_top = nodes.is_active(node) && !nodes.is_active(node + up);
            if is_top
                && nodes.is_active(node - up)
                && nodes.solid_mass[node] < LEAST_MASS * self.full_mass * share_of_sides(grid, node)
            {
                self.pairs.push((node, node - up));
                self.is_sliver[node] = true;
            }
        }
    }

    /// Whether all nodes of a cell's top are slivers.
    #[inline]
    pub fn close<const D: usize>(&self, grid: &Grid<D>, first_node: usize) -> bool {
        let top = first_node + grid.node_stride()[D - 1];
        let mut across = grid.corners(first_node).filter(|corner| *corner >= top);
        !self.pairs.is_empty() && across.all(|corner| self.is_sliver[corner])
    }

    /// Adds masses, volumes and drags to those of the node below, which stands for both.
    pub fn merge_masses<const D: usize>(&self, nodes: &mut Nodes<D>, inertia: &mut [f64]) {
        for (sliver, below) in &self.pairs {
            let volume = nodes.volume[*below] + nodes.volume[*sliver];
            let pores: f64 =
                [*below, *sliver].iter().map(|node| nodes.volume[*node] * nodes.porosity[*node]).sum();
            for node in [*below, *sliver] {
                nodes.porosity[node] = pores / volume;
            }
            nodes.volume[*below] = volume;
            for field in [&mut nodes.solid_mass, &mut nodes.water_mass, &mut nodes.drag] {
                field[*below] += field[*sliver];
            }
            inertia[*below] += inertia[*sliver];
            nodes.per_solid_mass[*below] = 1.0 / nodes.solid_mass[*below];
            nodes.per_water_mass[*below] = 1.0 / nodes.water_mass[*below];
        }
    }

    /// Sum of a nodal field without them: the nodes below them have their parts.
    pub fn sum_without(&self, field: &[f64]) -> f64 {
        let standing = field.iter().zip(&self.is_sliver).filter(|(_, is_sliver)| !**is_sliver);
        standing.map(|(value, _)| value).sum()
    }

    /// Gives both nodes the velocities of their momentum together: those of the node below were taken with the mass
    /// of both.
    pub fn merge_velocities<const D: usize>(&self, nodes: &mut Nodes<D>) {
        for (sliver, below) in &self.pairs {
            let solid_share = nodes.solid_mass[*sliver] * nodes.per_solid_mass[*below];
            let water_share = nodes.water_mass[*sliver] * nodes.per_water_mass[*below];
            for d in 0..D {
                let solid = nodes.solid_velocity[*sliver][d] * solid_share;
                let water = nodes.water_velocity[*sliver][d] * water_share;
                nodes.solid_velocity[*below][d] += solid;
                nodes.water_velocity[*below][d] += water;
            }
            nodes.solid_velocity[*sliver] = nodes.solid_velocity[*below];
            nodes.water_velocity[*sliver] = nodes.water_velocity[*below];
        }
    }

    /// Adds forces to those on the node below.
    pub fn merge_forces<const D: usize>(&self, nodes: &mut Nodes<D>) {
        for (sliver, below) in &self.pairs {
            for d in 0..D {
                nodes.mixture_force[*below][d] += nodes.mixture_force[*sliver][d];
                nodes.water_force[*below][d] += nodes.water_force[*sliver][d];
            }
        }
    }

    /// Sets the accelerations of each sliver to those of the node below.
    pub fn follow_accelerations<const D: usize>(&self, nodes: &mut Nodes<D>) {
        for (sliver, below) in &self.pairs {
            nodes.solid_acceleration[*sliver] = nodes.solid_acceleration[*below];
            nodes.water_acceleration[*sliver] = nodes.water_acceleration[*below];
        }
    }
}

/// Share of the cells around a node, across the vertical, that lie in the grid: a half at each side that it is on.
fn share_of_sides<const D: usize>(grid: &Grid<D>, node: usize) -> f64 {
    let mut rest = node % grid.node_stride()[D - 1];
    let mut share = 1.0;
    for direction in (0..D - 1).rev() {
        let index = rest / grid.node_stride()[direction];
        rest %= grid.node_stride()[direction];
        if index == GHOST_LAYERS || index == GHOST_LAYERS + grid.cells[direction] {
            share *= 0.5;
        }
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::nodes::Support;

    /// A plane of two cells across whose topmost nodes have a share of a full node's grains.
    fn plane(share: f64) -> (Grid<2>, Nodes<2>, SliverNodes) {
        let grid = Grid::new(1.0, [2, 4]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 2.0);
        for row in 0..4 {
            for column in 0..3 {
                let node = grid.flat_node(&[column + GHOST_LAYERS, row + GHOST_LAYERS]);
                let side = if column == 1 { 1.0 } else { 0.5 };
                nodes.solid_mass[node] = 2.0 * side * if row == 3 { share } else { 1.0 };
                nodes.volume[node] = 1.0;
                nodes.porosity[node] = if row == 3 { 0.2 } else { 0.4 };
                nodes.water_mass[node] = 1.0;
            }
        }
        let mut slivers = SliverNodes::new(&grid, 2.0);
        slivers.find(&grid, &nodes);
        (grid, nodes, slivers)
    }

    #[test]
    fn a_topmost_node_with_little_mass_is_a_sliver_at_the_sides_too() {
        let (grid, _, slivers) = plane(0.09);
        assert_eq!(slivers.pairs.len(), 3);
        let top = grid.flat_node(&[GHOST_LAYERS, GHOST_LAYERS + 2]);
        assert!(slivers.close(&grid, top) && !slivers.close(&grid, top - grid.node_stride()[1]));
        assert!(plane(0.11).2.pairs.is_empty());
    }

    #[test]
    fn merging_keeps_mass_pores_momentum_and_force() {
        let (grid, mut nodes, slivers) = plane(0.05);
        let mut inertia = vec![1.0; nodes.len()];
        let top = grid.flat_node(&[GHOST_LAYERS + 1, GHOST_LAYERS + 3]);
        let below = top - grid.node_stride()[1];
        let pores = nodes.volume[top] * nodes.porosity[top] + nodes.volume[below] * nodes.porosity[below];
        let (solid, raw) = (nodes.solid_mass[top] + nodes.solid_mass[below], nodes.solid_mass[below]);
        slivers.merge_masses(&mut nodes, &mut inertia);
        assert_eq!((nodes.solid_mass[below], inertia[below]), (solid, 2.0));
        assert!((nodes.volume[below] * nodes.porosity[below] - pores).abs() < 1e-15);
        // Momenta 3 above, and 5 below, which was divided by the mass of both.
        nodes.solid_velocity[top][1] = 3.0 / nodes.solid_mass[top];
        nodes.solid_velocity[below][1] = 5.0 / solid;
        slivers.merge_velocities(&mut nodes);
        assert!((nodes.solid_velocity[below][1] * solid - 8.0).abs() < 1e-13 && raw < solid);
        assert_eq!(nodes.solid_velocity[top], nodes.solid_velocity[below]);
        nodes.mixture_force[top][1] = -2.0;
        nodes.mixture_force[below][1] = 0.5;
        slivers.merge_forces(&mut nodes);
        assert_eq!(nodes.mixture_force[below][1], -1.5);
    }
}
