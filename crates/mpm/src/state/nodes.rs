//! Nodal fields: lumped masses, forces, velocities and accelerations of both phases.

use crate::state::grid::Grid;
use crate::state::lanes::{some_mut, some_of};
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Vector;
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
    /// One where the water slides past a skeleton that sticks to the base, else zero: there the node itself remembers the
    /// water's velocity, for the points around move with a skeleton that the base does not hold (docs/theory.md,
    /// Eq. 36).
    pub sliding: Vec<Vector<D>>,
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

/// Does a work for all nodes that carry mass, four or two side by side where as many follow each other: from a first one
/// on, for a number that the compiler knows. What one work leaves at a node is at hand for the next.
macro_rules! each_of_runs {
    ($nodes:expr, |$first:ident, $count:ident| $work:expr) => {
        let runs = std::mem::take(&mut $nodes.runs);
        $crate::wide::wide!({
            for run in &runs {
                let mut $first = run.start;
                while $first + 4 <= run.end {
                    const $count: usize = 4;
                    $work;
                    $first += 4;
                }
                while $first + 2 <= run.end {
                    const $count: usize = 2;
                    $work;
                    $first += 2;
                }
                if $first < run.end {
                    const $count: usize = 1;
                    $work;
                }
            }
        });
        $nodes.runs = runs;
    };
}
pub(crate) use each_of_runs;

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
        let mut sliding = vec![[0.0; D]; count];
        for node in (0..count).filter(|_| support.rough_base) {
            if grid.node_position(node)[D - 1] < tolerance {
                supports[node] = [0.0; D];
                // Nodes beyond a face have next to no mass: what they remembered would have no bound.
                if !support.is_beyond(grid, node, tolerance) {
                    sliding[node] = water_supports[node];
                }
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
            sliding,
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

    /// Begins new [`sums`](Self::sums) of masses, and of momenta and forces or of one of them.
    pub fn clear_sums(&mut self, masses: bool, momenta: bool, forces: bool) {
        if masses {
            self.sums.masses.fill([0.0; 4]);
        }
        if momenta && forces {
            self.sums.balances.fill([[0.0; D]; 4]);
        } else if momenta || forces {
            let which = if momenta { 0..2 } else { 2..4 };
            for of_node in &mut self.sums.balances {
                of_node[which.clone()].fill([0.0; D]);
            }
        }
    }

    /// Turns the points' [`sums`](Self::sums) into masses, volumes, porosities and drag of the soil.
    pub fn take_masses(&mut self, soil: &Material) {
        self.take_grains(soil.grain_density);
        each_of_runs!(self, |first, N| self.masses_of::<N>(first, soil));
    }

    /// The same of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn masses_of<const N: usize>(&mut self, first: usize, soil: &Material) {
        let sums = some_of::<_, N>(&self.sums.masses, first);
        let (mut water_mass, mut volume, mut drag) = ([0.0; N], [0.0; N], [0.0; N]);
        let (mut porosity, mut per_solid, mut per_water) = ([0.0; N], [0.0; N], [0.0; N]);
        let solid_mass = some_of::<_, N>(&self.solid_mass, first);
        for node in 0..N {
            let [grain_volume, pore_volume, drag_of_node, _] = sums[node];
            water_mass[node] = soil.water_density * pore_volume;
            volume[node] = grain_volume + pore_volume;
            porosity[node] = pore_volume;
            drag[node] = drag_of_node;
        }
        for node in 0..N {
            porosity[node] /= volume[node];
        }
        for node in 0..N {
            per_solid[node] = 1.0 / solid_mass[node];
        }
        for node in 0..N {
            per_water[node] = 1.0 / water_mass[node];
        }
        *some_mut(&mut self.water_mass, first) = water_mass;
        *some_mut(&mut self.volume, first) = volume;
        *some_mut(&mut self.drag, first) = drag;
        *some_mut(&mut self.porosity, first) = porosity;
        *some_mut(&mut self.per_solid_mass, first) = per_solid;
        *some_mut(&mut self.per_water_mass, first) = per_water;
    }

    /// Mass of the grains, and the runs of the nodes that carry some: found anew only where they have changed.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn take_grains(&mut self, grain_density: f64) {
        let (mut stand, cut_off) = (self.is_empty_between, self.mass_cut_off);
        let (of_nodes, rest) = self.solid_mass.as_chunks_mut::<4>();
        let (sums, rest_of_sums) = self.sums.masses.as_chunks::<4>();
        let (carry, rest_carry) = self.carries.as_chunks::<4>();
        for ((masses, sums), carry) in of_nodes.iter_mut().zip(sums).zip(carry) {
            for node in 0..4 {
                masses[node] = grain_density * sums[node][0];
            }
            for node in 0..4 {
                stand &= (masses[node] > cut_off) == carry[node];
            }
        }
        for ((mass, [grain_volume, ..]), carries) in rest.iter_mut().zip(rest_of_sums).zip(rest_carry) {
            *mass = grain_density * grain_volume;
            stand &= (*mass > cut_off) == *carries;
        }
        if stand {
            return;
        }
        self.find_grains();
    }

    /// The runs of the nodes that carry grains.
    #[cold]
    #[inline(never)]
    fn find_grains(&mut self) {
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

    /// Velocities from the points' [`sums`](Self::sums) of momenta; zero where a node is held or empty, and those that
    /// the nodes have where the water slides.
    pub fn take_velocities(&mut self, soil: &Material) {
        each_of_runs!(self, |first, N| self.velocities_of::<N>(first, soil));
    }

    /// The same of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn velocities_of<const N: usize>(&mut self, first: usize, soil: &Material) {
        let sums = some_of::<_, N>(&self.sums.balances, first);
        let (per_solid, free) =
            (some_of::<_, N>(&self.per_solid_mass, first), some_of::<_, N>(&self.free, first));
        let (per_water, water_free) =
            (some_of::<_, N>(&self.per_water_mass, first), some_of::<_, N>(&self.water_free, first));
        let [mut solid, mut water] = [[[0.0; D]; N]; 2];
        for node in 0..N {
            for d in 0..D {
                solid[node][d] = sums[node][0][d] * (free[node][d] * (soil.grain_density * per_solid[node]));
            }
        }
        for node in 0..N {
            for d in 0..D {
                water[node][d] =
                    sums[node][1][d] * (water_free[node][d] * (soil.water_density * per_water[node]));
            }
        }
        // A line has no direction along its base.
        if D > 1 {
            let sliding = some_of::<_, N>(&self.sliding, first);
            let present = some_of::<_, N>(&self.water_velocity, first);
            for node in 0..N {
                for d in 0..D {
                    water[node][d] = if sliding[node][d] > 0.0 { present[node][d] } else { water[node][d] };
                }
            }
        }
        *some_mut(&mut self.solid_velocity, first) = solid;
        *some_mut(&mut self.water_velocity, first) = water;
    }

    /// `v_s + n (v_w − v_s)` of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn flux_of<const N: usize>(&mut self, first: usize) {
        let (solid, water) =
            (some_of::<_, N>(&self.solid_velocity, first), some_of::<_, N>(&self.water_velocity, first));
        let porosity = some_of::<_, N>(&self.porosity, first);
        let mut flux = [[0.0; D]; N];
        for node in 0..N {
            for d in 0..D {
                flux[node][d] = solid[node][d] + porosity[node] * (water[node][d] - solid[node][d]);
            }
        }
        *some_mut(&mut self.flux, first) = flux;
    }

    /// Forces from the points' [`sums`](Self::sums) and from what acts from outside.
    pub fn take_forces(&mut self) {
        each_of_runs!(self, |first, N| self.forces_of::<N>(first));
    }

    /// The same of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn forces_of<const N: usize>(&mut self, first: usize) {
        let sums = some_of::<_, N>(&self.sums.balances, first);
        let [mut mixture, mut water] = [[[0.0; D]; N]; 2];
        let external = some_of::<_, N>(&self.external_force, first);
        for node in 0..N {
            for d in 0..D {
                mixture[node][d] = external[node][d] + sums[node][2][d];
            }
        }
        for node in 0..N {
            water[node] = sums[node][3];
        }
        *some_mut(&mut self.mixture_force, first) = mixture;
        *some_mut(&mut self.water_force, first) = water;
    }

    /// Velocities of skeleton and water and their accelerations, `[node]`, side by side for the points that take all of
    /// them.
    pub fn gather_motion(&mut self) {
        each_of_runs!(self, |first, N| self.motion_of::<N>(first));
    }

    /// The same of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub(crate) fn motion_of<const N: usize>(&mut self, first: usize) {
        let (solid, water) =
            (some_of::<_, N>(&self.solid_velocity, first), some_of::<_, N>(&self.water_velocity, first));
        let (solid_rate, water_rate) = (
            some_of::<_, N>(&self.solid_acceleration, first),
            some_of::<_, N>(&self.water_acceleration, first),
        );
        let motion = some_mut::<_, N>(&mut self.motion, first);
        for node in 0..N {
            motion[node] = [solid[node], water[node], solid_rate[node], water_rate[node]];
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
    fn water_that_slides_along_a_rough_base_keeps_the_velocity_of_its_node() {
        let (grid, soil) = (Grid::new(0.1, [3, 3]), Material::default());
        let mut nodes = Nodes::new(&grid, &Support::oedometer().on_rough_base(), 1.0);
        for (masses, balances) in nodes.sums.masses.iter_mut().zip(&mut nodes.sums.balances) {
            *masses = [2.0, 0.5, 0.0, 0.0];
            // Velocities 3 and 5 m/s of the skeleton, 3.25 and 7 m/s of the water.
            [balances[0], balances[1]] = [[6.0, 10.0], [1.625, 3.5]];
        }
        nodes.water_velocity.fill([0.25, 0.5]);
        nodes.take_masses(&soil);
        nodes.take_velocities(&soil);
        let of = |row: usize| {
            let node = grid.flat_node(&[3, row]);
            [nodes.solid_velocity[node], nodes.water_velocity[node]]
        };
        let [at_base, above] = [of(2), of(3)];
        let expected = [[[0.0, 0.0], [0.25, 0.0]], [[3.0, 5.0], [3.25, 7.0]]];
        for (got, expected) in [at_base, above].as_flattened().iter().zip(expected.as_flattened()) {
            assert!((0..2).all(|d| (got[d] - expected[d]).abs() < 1e-14), "{got:?} for {expected:?}");
        }
        let sliding = nodes.sliding.iter().flatten().filter(|slides| **slides > 0.0).count();
        assert_eq!(sliding, 2, "neither at the corners nor below the base");
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
    fn nodes_side_by_side_are_what_they_are_one_by_one() {
        let (grid, soil) = (Grid::new(0.1, [7, 3]), Material::default());
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1e-3);
        for (node, (masses, balances)) in
            nodes.sums.masses.iter_mut().zip(&mut nodes.sums.balances).enumerate()
        {
            let seed = node as f64;
            // Runs of one, two, three and seven nodes.
            let is_there = node % 12 < 7 && node / 12 % 2 == 0 || [18, 19, 21].contains(&(node % 24));
            if is_there {
                *masses = [1.5 + seed.sin(), 1.2 + (0.7 * seed).cos(), 2.0 + (1.3 * seed).sin(), 0.0];
            }
            for (i, number) in balances.as_flattened_mut().iter_mut().enumerate() {
                *number = (seed + 0.37 * i as f64).sin();
            }
            nodes.external_force[node] = [seed.cos(), 0.5];
        }
        nodes.take_masses(&soil);
        nodes.take_velocities(&soil);
        nodes.take_forces();
        let lengths: std::collections::BTreeSet<usize> =
            nodes.runs.iter().map(ExactSizeIterator::len).collect();
        assert_eq!(lengths.into_iter().collect::<Vec<_>>(), [1, 2, 7]);
        let runs = nodes.runs.clone();
        let together = nodes.clone();
        nodes.runs = runs.into_iter().flatten().map(|node| node..node + 1).collect();
        let one_by_one = nodes.runs.clone();
        for field in [&mut nodes.volume, &mut nodes.porosity, &mut nodes.drag, &mut nodes.per_water_mass] {
            field.fill(f64::NAN);
        }
        for node in one_by_one {
            nodes.masses_of::<1>(node.start, &soil);
            nodes.velocities_of::<1>(node.start, &soil);
            nodes.forces_of::<1>(node.start);
            let at = node.start;
            for (field, same) in [
                (&nodes.volume, &together.volume),
                (&nodes.porosity, &together.porosity),
                (&nodes.drag, &together.drag),
                (&nodes.per_water_mass, &together.per_water_mass),
                (&nodes.per_solid_mass, &together.per_solid_mass),
            ] {
                assert_eq!(field[at].to_bits(), same[at].to_bits());
            }
            assert_eq!(nodes.mixture_force[at], together.mixture_force[at]);
            assert_eq!(nodes.water_force[at], together.water_force[at]);
            assert_eq!(nodes.solid_velocity[at], together.solid_velocity[at]);
            let [_, _, mixture, _] = nodes.sums.balances[at];
            assert_eq!(
                nodes.mixture_force[at][1],
                0.5 + mixture[1],
                "what acts from outside is among the forces"
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
