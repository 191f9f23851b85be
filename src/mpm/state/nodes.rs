//! Nodal fields: lumped masses, forces, velocities and accelerations of both phases.

use crate::mpm::state::grid::Grid;
use crate::soil::material::Material;
use crate::soil::tensor::Vector;
use std::ops::Range;

/// Nodes with less than this share of a full cell's mass carry nothing: a point on a cell face
/// leaves ghosts of 1e-30 behind.
const MASS_CUT_OFF: f64 = 1e-14;

/// Nodal fields, structure of arrays; index = flat node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nodes<const D: usize> {
    /// Mass of the grains, kg.
    pub solid_mass: Vec<f64>,
    /// Mass of the pore water `n ρ_w V`, kg.
    pub water_mass: Vec<f64>,
    /// One over the mass of the grains, zero where nothing is, 1/kg.
    pub per_solid_mass: Vec<f64>,
    /// One over the mass of the pore water, zero where nothing is, 1/kg.
    pub per_water_mass: Vec<f64>,
    /// Volume of the mixture, m^D.
    pub volume: Vec<f64>,
    /// Porosity `Σ w V n / Σ w V`.
    pub porosity: Vec<f64>,
    /// Drag `n γ_w V/k`, N s/m.
    pub drag: Vec<f64>,
    /// What the points give to each node, while it is summed.
    pub sums: NodalSums<D>,
    /// External force on the mixture, N.
    pub external_force: Vec<Vector<D>>,
    /// Internal and external force on the mixture, N.
    pub mixture_force: Vec<Vector<D>>,
    /// Force of the pressure gradient on the water, per volume of water times mixture volume, N.
    pub water_force: Vec<Vector<D>>,
    /// Velocity of the skeleton, m/s.
    pub solid_velocity: Vec<Vector<D>>,
    /// Velocity of the water, m/s.
    pub water_velocity: Vec<Vector<D>>,
    /// Acceleration of the skeleton, m/s².
    pub solid_acceleration: Vec<Vector<D>>,
    /// Acceleration of the water, m/s².
    pub water_acceleration: Vec<Vector<D>>,
    /// Velocities of skeleton and water and their accelerations, side by side for the points that take all of them.
    pub motion: Vec<[Vector<D>; 4]>,
    /// `v_s + n (v_w − v_s)` with the nodal porosity, m/s: its divergence drives the pressure.
    pub flux: Vec<Vector<D>>,
    /// Displacement of the skeleton where the grid is frozen, m.
    pub displacement: Vec<Vector<D>>,
    /// One where a component of the skeleton's velocity is free, zero where it is fixed or nothing
    /// is there.
    pub free: Vec<Vector<D>>,
    /// The same for the water: it slides along a rough base.
    pub water_free: Vec<Vector<D>>,
    /// The skeleton's supports alone.
    supports: Vec<Vector<D>>,
    /// The water's supports alone.
    water_supports: Vec<Vector<D>>,
    /// Runs of neighbouring nodes that carry mass, in index order; of a narrow column's nodes many are ghosts. A
    /// loop over the nodes of a run takes its slices of the fields, whose bounds are checked once.
    pub runs: Vec<Range<usize>>,
    /// Whether each node carries mass: what the runs were found from.
    carries: Vec<bool>,
    /// Whether the fields of masses are zero between the runs.
    is_empty_between: bool,
    mass_cut_off: f64,
}

/// What the points give to the nodes, while it is summed.
///
/// What a pass sums side by side lies side by side and in pairs: the next point's run may begin a node
/// later and still finds the last one's sums whole, where it would wait for halves of two stores.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalSums<const D: usize> {
    /// Volume of the grains and of the pores (m^D), drag (N s/m), and nothing.
    pub masses: Vec<[f64; 4]>,
    /// Volume times velocity of the grains and of the pores (m^D m/s), and forces on the mixture and on the water (N).
    pub balances: Vec<[Vector<D>; 4]>,
    /// Forces of the flow potential and of the stress, and the size of the latter, where the drag is of
    /// their ratio.
    pub chords: Vec<[f64; 3]>,
}

/// Faces of the grid whose normal velocity is zero for both phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Support<const D: usize> {
    /// Fixed at the lower face of a direction, and beyond it.
    pub lower: [bool; D],
    /// Fixed at the upper face of a direction, and beyond it.
    pub upper: [bool; D],
    /// Whether the skeleton sticks to the base: no displacement along it either.
    pub rough_base: bool,
    /// Last node below the free surface that has enough of the material to stand alone, where splines
    /// reach beyond the surface: those above it follow its line.
    pub outermost: Option<usize>,
}

impl<const D: usize> Support<D> {
    /// An oedometer: rollers at the sides, fixed base, free top.
    pub fn oedometer() -> Self {
        let mut upper = [true; D];
        upper[D - 1] = false;
        Self { lower: [true; D], upper, rough_base: false, outermost: None }
    }

    /// Rollers on every face.
    pub fn closed() -> Self {
        Self { lower: [true; D], upper: [true; D], rough_base: false, outermost: None }
    }

    /// Nothing held at all.
    pub fn free() -> Self {
        Self { lower: [false; D], upper: [false; D], rough_base: false, outermost: None }
    }

    /// The same faces with an upper side that a plate moves.
    #[must_use]
    pub fn with_movable_side(mut self) -> Self {
        self.upper[0] = false;
        self
    }

    /// Whether a node lies beyond a held face, by more than a tolerance, m.
    fn is_beyond(&self, grid: &Grid<D>, node: usize, tolerance: f64) -> bool {
        let position = grid.node_position(node);
        (0..D).any(|d| {
            let top = grid.cells[d] as f64 * grid.cell_size;
            self.lower[d] && position[d] < -tolerance || self.upper[d] && position[d] > top + tolerance
        })
    }

    /// The same faces on a base that the skeleton sticks to.
    #[must_use]
    pub fn on_rough_base(self) -> Self {
        Self { rough_base: true, ..self }
    }
}

impl<const D: usize> Nodes<D> {
    /// Zero fields on a grid, with the supports of its faces; `cell_mass` is the mass of a full
    /// cell, kg.
    pub fn new(grid: &Grid<D>, support: &Support<D>, cell_mass: f64) -> Self {
        let count = grid.node_count();
        let tolerance = 1e-6 * grid.cell_size;
        let water_supports: Vec<Vector<D>> = (0..count)
            .map(|node| {
                let position = grid.node_position(node);
                std::array::from_fn(|d| {
                    let top = grid.cells[d] as f64 * grid.cell_size;
                    let fixed = support.lower[d] && position[d] < tolerance
                        || support.upper[d] && position[d] > top - tolerance;
                    if fixed { 0.0 } else { 1.0 }
                })
            })
            .collect();
        let mut supports = water_supports.clone();
        // A domain that a face has let through by a round-off finds no stiffness behind it, in no direction.
        for node in (0..count).filter(|node| support.is_beyond(grid, *node, tolerance)) {
            supports[node] = [0.0; D];
        }
        for node in (0..count).filter(|_| support.rough_base) {
            if grid.node_position(node)[D - 1] < tolerance {
                supports[node] = [0.0; D];
            }
        }
        let (scalars, vectors) = (vec![0.0; count], vec![[0.0; D]; count]);
        Self {
            solid_mass: scalars.clone(),
            water_mass: scalars.clone(),
            per_solid_mass: scalars.clone(),
            per_water_mass: scalars.clone(),
            volume: scalars.clone(),
            porosity: scalars.clone(),
            drag: scalars,
            sums: NodalSums {
                masses: vec![[0.0; 4]; count],
                balances: vec![[[0.0; D]; 4]; count],
                chords: vec![[0.0; 3]; count],
            },
            external_force: vectors.clone(),
            mixture_force: vectors.clone(),
            water_force: vectors.clone(),
            solid_velocity: vectors.clone(),
            water_velocity: vectors.clone(),
            solid_acceleration: vectors.clone(),
            water_acceleration: vectors.clone(),
            motion: vec![[[0.0; D]; 4]; count],
            flux: vectors.clone(),
            displacement: vectors,
            free: supports.clone(),
            water_free: water_supports.clone(),
            supports,
            water_supports,
            runs: Vec::with_capacity(count.div_ceil(2)),
            carries: vec![false; count],
            is_empty_between: false,
            mass_cut_off: MASS_CUT_OFF * cell_mass,
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.solid_mass.len()
    }

    /// Whether there is no node at all.
    pub fn is_empty(&self) -> bool {
        self.solid_mass.is_empty()
    }

    /// Begins new [`sums`](Self::sums) of masses, of momenta and of forces; those of the forces begin with what acts
    /// from outside.
    pub fn clear_sums(&mut self, masses: bool, momenta: bool, forces: bool) {
        if masses {
            self.sums.masses.fill([0.0; 4]);
        }
        match (momenta, forces) {
            (true, true) => {
                for (sums, external) in self.sums.balances.iter_mut().zip(&self.external_force) {
                    *sums = [[0.0; D], [0.0; D], *external, [0.0; D]];
                }
            }
            (true, false) => {
                for [solid, water, ..] in &mut self.sums.balances {
                    (*solid, *water) = ([0.0; D], [0.0; D]);
                }
            }
            (false, true) => {
                for ([.., mixture, water], external) in
                    self.sums.balances.iter_mut().zip(&self.external_force)
                {
                    (*mixture, *water) = (*external, [0.0; D]);
                }
            }
            (false, false) => {}
        }
    }

    /// Turns the points' [`sums`](Self::sums) into masses, volumes, porosities and drag of the soil.
    pub fn take_masses(&mut self, soil: &Material) {
        self.take_grains(soil.grain_density);
        let count = self.len();
        let masses = &self.sums.masses[..count];
        let (solid_mass, per_solid_mass) = (&self.solid_mass[..count], &mut self.per_solid_mass[..count]);
        let (water_mass, per_water_mass) = (&mut self.water_mass[..count], &mut self.per_water_mass[..count]);
        let (volumes, porosity) = (&mut self.volume[..count], &mut self.porosity[..count]);
        let drags = &mut self.drag[..count];
        for run in &self.runs {
            for node in run.start..run.end.min(count) {
                let [grain_volume, pore_volume, drag, _] = masses[node];
                let (water, volume) = (soil.water_density * pore_volume, grain_volume + pore_volume);
                // The divisions side by side: one takes as long as all of them.
                let [n, per_solid, per_water] =
                    [[pore_volume, volume], [1.0, solid_mass[node]], [1.0, water]]
                        .map(|[over, under]| over / under);
                (water_mass[node], volumes[node], drags[node]) = (water, volume, drag);
                (porosity[node], per_solid_mass[node], per_water_mass[node]) = (n, per_solid, per_water);
            }
        }
    }

    /// Mass of the grains, and the runs of the nodes that carry some: found anew only where they have changed.
    fn take_grains(&mut self, grain_density: f64) {
        let mut stand = self.is_empty_between;
        let found = self.solid_mass.iter_mut().zip(&self.sums.masses).zip(&self.carries);
        for ((solid_mass, [grain_volume, ..]), carries) in found {
            *solid_mass = grain_density * grain_volume;
            stand &= (*solid_mass > self.mass_cut_off) == *carries;
        }
        if stand {
            return;
        }
        self.find_runs();
        for field in [&mut self.water_mass, &mut self.volume, &mut self.drag] {
            for (mass, carries) in field.iter_mut().zip(&self.carries) {
                if !carries {
                    *mass = 0.0;
                }
            }
        }
        self.is_empty_between = true;
    }

    /// Velocities from the points' [`sums`](Self::sums) of momenta; zero where a node is held or empty.
    pub fn take_velocities(&mut self, soil: &Material) {
        let count = self.len();
        let sums = &self.sums.balances[..count];
        let (per_solid_mass, free) = (&self.per_solid_mass[..count], &self.free[..count]);
        let (per_water_mass, water_free) = (&self.per_water_mass[..count], &self.water_free[..count]);
        let (solid_velocity, water_velocity) =
            (&mut self.solid_velocity[..count], &mut self.water_velocity[..count]);
        for run in &self.runs {
            for node in run.start..run.end.min(count) {
                let [solid, water, ..] = sums[node];
                let per_grain_volume = soil.grain_density * per_solid_mass[node];
                let per_pore_volume = soil.water_density * per_water_mass[node];
                for d in 0..D {
                    solid_velocity[node][d] = solid[d] * (free[node][d] * per_grain_volume);
                    water_velocity[node][d] = water[d] * (water_free[node][d] * per_pore_volume);
                }
            }
        }
    }

    /// Forces from the points' [`sums`](Self::sums).
    pub fn take_forces(&mut self) {
        let count = self.len();
        let sums = &self.sums.balances[..count];
        let (mixture, water) = (&mut self.mixture_force[..count], &mut self.water_force[..count]);
        for run in &self.runs {
            for node in run.start..run.end.min(count) {
                [_, _, mixture[node], water[node]] = sums[node];
            }
        }
    }

    /// Velocities of skeleton and water and their accelerations, `[node]`, side by side for the points that take all of
    /// them.
    pub fn gather_motion(&mut self) {
        let count = self.len();
        let (solid, water) = (&self.solid_velocity[..count], &self.water_velocity[..count]);
        let (solid_rate, water_rate) = (&self.solid_acceleration[..count], &self.water_acceleration[..count]);
        let motion = &mut self.motion[..count];
        for run in &self.runs {
            for node in run.start..run.end.min(count) {
                motion[node] = [solid[node], water[node], solid_rate[node], water_rate[node]];
            }
        }
    }

    /// Finishes what was summed: porosities, reciprocals, and which components are free. Nodes without mass
    /// are silenced: what they had would otherwise reach the points.
    pub fn finish_masses(&mut self) {
        self.find_runs();
        self.is_empty_between = false;
        for node in self.runs.iter().cloned().flatten() {
            self.porosity[node] /= self.volume[node];
            self.per_solid_mass[node] = 1.0 / self.solid_mass[node];
            self.per_water_mass[node] = 1.0 / self.water_mass[node];
        }
    }

    /// Finds the runs of nodes that carry mass and frees what no support holds of them; silences the others.
    fn find_runs(&mut self) {
        self.runs.clear();
        for node in 0..self.len() {
            let carries = self.is_active(node);
            self.carries[node] = carries;
            if !carries {
                self.silence(node);
                continue;
            }
            (self.free[node], self.water_free[node]) = (self.supports[node], self.water_supports[node]);
            match self.runs.last_mut().filter(|run| run.end == node) {
                Some(run) => run.end = node + 1,
                None => self.runs.push(node..node + 1),
            }
        }
    }

    /// Takes everything from a node that has lost its mass.
    fn silence(&mut self, node: usize) {
        for field in [&mut self.porosity, &mut self.per_solid_mass, &mut self.per_water_mass] {
            field[node] = 0.0;
        }
        for field in [
            &mut self.free,
            &mut self.water_free,
            &mut self.solid_velocity,
            &mut self.water_velocity,
            &mut self.solid_acceleration,
            &mut self.water_acceleration,
            &mut self.flux,
        ] {
            field[node] = [0.0; D];
        }
        self.motion[node] = [[0.0; D]; 4];
    }

    /// Whether a node carries mass.
    #[inline]
    pub fn is_active(&self, node: usize) -> bool {
        self.solid_mass[node] > self.mass_cut_off
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supports_hold_the_base_and_the_sides_and_leave_the_top_free() {
        let grid = Grid::new(0.1, [1, 10]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        nodes.solid_mass.fill(1.0);
        nodes.finish_masses();
        let at = |x: usize, y: usize| nodes.free[grid.flat_node(&[x + 2, y + 2])];
        assert_eq!(at(0, 0), [0.0, 0.0]);
        assert_eq!(at(1, 5), [0.0, 1.0]);
        assert_eq!(at(1, 10), [0.0, 1.0]);
        assert_eq!(nodes.free[grid.flat_node(&[2, 1])], [0.0, 0.0], "below the base");
    }

    #[test]
    fn a_rough_base_holds_the_skeleton_and_lets_the_water_slide() {
        let grid = Grid::new(0.1, [3, 3]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer().on_rough_base(), 1.0);
        nodes.solid_mass.fill(1.0);
        nodes.finish_masses();
        let base = grid.flat_node(&[3, 2]);
        assert_eq!((nodes.free[base], nodes.water_free[base]), ([0.0, 0.0], [1.0, 0.0]));
        let above = grid.flat_node(&[3, 3]);
        assert_eq!(nodes.free[above], [1.0, 1.0]);
    }

    #[test]
    fn a_node_that_loses_its_mass_is_silent_and_free_again_with_it() {
        let grid = Grid::new(0.1, [4]);
        let (mut nodes, soil) = (Nodes::new(&grid, &Support::oedometer(), 1.0), Material::default());
        for has_mass in [true, true, false, false, true] {
            nodes.clear_sums(true, true, false);
            for node in [3, 4, 6] {
                let share = if node == 4 && !has_mass { 0.0 } else { 1.0 };
                nodes.sums.masses[node] = [2.0 * share, share, 5.0 * share, 0.0];
                nodes.sums.balances[node] = [[6.0 * share], [4.0 * share], [0.0], [0.0]];
            }
            nodes.take_masses(&soil);
            nodes.take_velocities(&soil);
            assert_eq!(nodes.runs, if has_mass { vec![3..5, 6..7] } else { vec![3..4, 6..7] });
            let of_node = [nodes.solid_velocity[4][0], nodes.water_velocity[4][0], nodes.porosity[4]];
            let expected = if has_mass { [3.0, 4.0, 1.0 / 3.0] } else { [0.0; 3] };
            for (got, expected) in of_node.iter().zip(expected) {
                assert!((got - expected).abs() < 1e-14, "{got} for {expected}");
            }
            let whole = if has_mass { 1.0 } else { 0.0 };
            assert_eq!((nodes.free[4], nodes.water_free[4]), ([whole], [whole]));
            assert_eq!(
                (nodes.volume[4], nodes.drag[4], nodes.water_mass[4] > 0.0),
                (3.0 * whole, 5.0 * whole, has_mass)
            );
        }
    }

    #[test]
    fn a_node_with_a_ghost_of_mass_is_silent() {
        let grid = Grid::new(0.1, [4]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        nodes.solid_mass[4] = 1e-30;
        nodes.solid_mass[5] = 1e-3;
        nodes.finish_masses();
        assert_eq!((nodes.free[4], nodes.free[5]), ([0.0], [1.0]));
    }
}
