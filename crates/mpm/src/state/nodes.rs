//! Nodal fields: lumped masses, forces, velocities and accelerations of both phases.

use crate::state::grid::Grid;
use crate::wide::wide;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Vector;

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
    /// `v_s + n (v_w − v_s)` with the nodal porosity, m/s: its divergence drives the pressure.
    pub flux: Vec<Vector<D>>,
    /// What carries the points through a step, side by side: velocity and acceleration of the skeleton, velocity and
    /// acceleration of the water.
    pub motion: Vec<[Vector<D>; 4]>,
    /// Displacement of the skeleton where the grid is frozen, m.
    pub displacement: Vec<Vector<D>>,
    /// One where a component of the skeleton's velocity is free, zero where it is fixed or nothing
    /// is there.
    pub free: Vec<Vector<D>>,
    /// Fixed components of the water's velocity: water slides along a rough base.
    pub water_free: Vec<Vector<D>>,
    /// One where the water slides past a skeleton that sticks to the base, else zero: there the node itself remembers the
    /// water's velocity, for the points around move with a skeleton that the base does not hold (docs/theory.md,
    /// Eq. 36).
    pub sliding: Vec<Vector<D>>,
    /// Nodes of a drained base, with their shares of its width; none of a base that no water passes.
    pub drained_base: Vec<(usize, f64)>,
    /// The skeleton's supports alone.
    supports: Vec<Vector<D>>,
    /// The water's supports alone.
    water_supports: Vec<Vector<D>>,
    /// Nodes that carry mass, in index order.
    pub active: Vec<usize>,
    /// Whether each node carries mass.
    carries: Vec<bool>,
    mass_cut_off: f64,
}

/// What the points give to the nodes, while it is summed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalSums<const D: usize> {
    /// Volume of the grains and of the pores (m^D), drag (N s/m), and nothing.
    pub masses: Vec<[[f64; 4]; 1]>,
    /// Volume times velocity of the grains and of the pores, m^D m/s.
    pub momenta: Vec<[Vector<D>; 2]>,
    /// Forces on the mixture and on the water, N.
    pub forces: Vec<[Vector<D>; 2]>,
    /// Forces of the flow potential and of the stress, and the size of the latter, where the drag is of
    /// their ratio.
    pub chords: Vec<[f64; 3]>,
}

/// Faces of the grid whose normal velocity is zero for both phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<const D: usize> {
    /// Fixed at the lower face of a direction, and beyond it.
    pub lower: [bool; D],
    /// Fixed at the upper face of a direction, and beyond it.
    pub upper: [bool; D],
    /// Whether the skeleton sticks to the base: no displacement along it either.
    pub rough_base: bool,
    /// Whether the water passes the base.
    pub drained_base: bool,
    /// Rigid plate on the upper face, from the lower side on, that moves as it is told to.
    pub plate: Option<PlateOnTop>,
    /// Last node below the free surface that has enough of the material to stand alone, where splines
    /// reach beyond the surface: those above it follow its line.
    pub outermost: Option<usize>,
}

/// A rigid plate on the upper face of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateOnTop {
    /// Extent along the first direction, from the lower side on, m.
    pub extent: f64,
    /// Height of the face, m.
    pub height: f64,
    /// Whether the soil sticks to it.
    pub is_rough: bool,
}

impl PlateOnTop {
    /// Whether a node of a grid lies on it: the node under its edge does.
    pub fn holds<const D: usize>(&self, grid: &Grid<D>, node: usize) -> bool {
        let (position, tolerance) = (grid.node_position(node), 1e-6 * grid.cell_size);
        (position[D - 1] - self.height).abs() < tolerance
            && (-tolerance..self.extent + tolerance).contains(&position[0])
    }
}

impl<const D: usize> Support<D> {
    /// An oedometer: rollers at the sides, fixed base, free top.
    pub fn oedometer() -> Self {
        let mut upper = [true; D];
        upper[D - 1] = false;
        Self { lower: [true; D], upper, rough_base: false, drained_base: false, plate: None, outermost: None }
    }

    /// Rollers on every face.
    pub fn closed() -> Self {
        Self {
            lower: [true; D],
            upper: [true; D],
            rough_base: false,
            drained_base: false,
            plate: None,
            outermost: None,
        }
    }

    /// Nothing held at all.
    pub fn free() -> Self {
        Self {
            lower: [false; D],
            upper: [false; D],
            rough_base: false,
            drained_base: false,
            plate: None,
            outermost: None,
        }
    }

    /// These faces with an upper side that a plate moves.
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

    /// These faces on a base that lets the water out.
    #[must_use]
    pub fn on_drained_base(self) -> Self {
        Self { drained_base: true, ..self }
    }

    /// These faces on a base that the skeleton sticks to.
    #[must_use]
    pub fn on_rough_base(self) -> Self {
        Self { rough_base: true, ..self }
    }
}

/// Nodes on the base of a body that is drained there, with their shares of its width: of a node at a side half of a cell.
fn drained_base_of<const D: usize>(
    grid: &Grid<D>,
    support: &Support<D>,
    tolerance: f64,
) -> Vec<(usize, f64)> {
    if !support.drained_base {
        return Vec::new();
    }
    let width = |d: usize| grid.cells[d] as f64 * grid.cell_size;
    let share = |node: usize| {
        let position = grid.node_position(node);
        let of_cells = |d: usize| {
            let (place, cells) = (position[d], grid.cells[d] as f64);
            let is_inside = (-tolerance..=width(d) + tolerance).contains(&place);
            let is_side = place < tolerance || place > width(d) - tolerance;
            f64::from(u8::from(is_inside)) * if is_side { 0.5 } else { 1.0 } / cells
        };
        let is_base = position[D - 1].abs() < tolerance;
        if is_base { (0..D - 1).map(of_cells).product() } else { 0.0 }
    };
    (0..grid.node_count()).map(|node| (node, share(node))).filter(|(_, share)| *share > 0.0).collect()
}

impl<const D: usize> Nodes<D> {
    /// Zero fields on a grid, with the supports of its faces; `cell_mass` is the mass of a full
    /// cell, kg.
    pub fn new(grid: &Grid<D>, support: &Support<D>, cell_mass: f64) -> Self {
        let count = grid.node_count();
        let tolerance = 1e-6 * grid.cell_size;
        let mut water_supports: Vec<Vector<D>> = (0..count)
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
        if let Some(plate) = &support.plate {
            for node in (0..count).filter(|node| plate.holds(grid, *node)) {
                supports[node][D - 1] = 0.0;
                if plate.is_rough {
                    supports[node] = [0.0; D];
                }
            }
        }
        let drained_base = drained_base_of(grid, support, tolerance);
        for (node, _) in &drained_base {
            water_supports[*node][D - 1] = 1.0;
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
                masses: vec![[[0.0; 4]; 1]; count],
                momenta: vec![[[0.0; D]; 2]; count],
                forces: vec![[[0.0; D]; 2]; count],
                chords: vec![[0.0; 3]; count],
            },
            external_force: vectors.clone(),
            mixture_force: vectors.clone(),
            water_force: vectors.clone(),
            solid_velocity: vectors.clone(),
            water_velocity: vectors.clone(),
            solid_acceleration: vectors.clone(),
            water_acceleration: vectors.clone(),
            flux: vectors.clone(),
            motion: vec![[[0.0; D]; 4]; count],
            displacement: vectors.clone(),
            // Nothing is there yet.
            free: vectors.clone(),
            water_free: vectors,
            sliding,
            drained_base,
            supports,
            water_supports,
            active: Vec::with_capacity(count),
            carries: vec![false; count],
            mass_cut_off: MASS_CUT_OFF * cell_mass,
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.solid_mass.len()
    }

    /// Whether the mesh is empty.
    pub fn is_empty(&self) -> bool {
        self.solid_mass.is_empty()
    }

    /// Turns the points' [`sums`](Self::sums) into masses, volumes, porosities and drag of the soil, that of layers with
    /// the porosity of the node. Nodes without mass are silenced: what they had would otherwise reach the points.
    pub fn take_masses(&mut self, soil: &Material, is_layered: bool) {
        self.list_active(soil);
        let count = self.len();
        let masses = &self.sums.masses[..count];
        let [water_mass, per_solid_mass, per_water_mass, volume, porosity, drag] = [
            &mut self.water_mass,
            &mut self.per_solid_mass,
            &mut self.per_water_mass,
            &mut self.volume,
            &mut self.porosity,
            &mut self.drag,
        ]
        .map(|field| &mut field[..count]);
        let (solid_mass, cut_off) = (&self.solid_mass[..count], self.mass_cut_off);
        // Every node, without a branch: a wide register divides four numbers at once.
        wide!(for node in 0..count {
            let [[grain_volume, pore_volume, resistance, _]] = masses[node];
            let of_active = |value: f64| if solid_mass[node] > cut_off { value } else { 0.0 };
            let mixture = grain_volume + pore_volume;
            let (share, mass) = (pore_volume / mixture, soil.water_density * pore_volume);
            water_mass[node] = of_active(mass);
            per_solid_mass[node] = of_active(1.0 / solid_mass[node]);
            per_water_mass[node] = of_active(1.0 / mass);
            (volume[node], porosity[node]) = (of_active(mixture), of_active(share));
            drag[node] = of_active(if is_layered { share * resistance } else { resistance });
        });
    }

    /// Takes the masses of the grains, lists the nodes that have some, and silences those that have lost theirs.
    fn list_active(&mut self, soil: &Material) {
        self.active.clear();
        for (mass, [[grain_volume, ..]]) in self.solid_mass.iter_mut().zip(&self.sums.masses) {
            *mass = soil.grain_density * grain_volume;
        }
        for node in 0..self.len() {
            let is_active = self.is_active(node);
            if is_active {
                self.active.push(node);
            }
            if is_active != self.carries[node] {
                if is_active {
                    self.carries[node] = true;
                    (self.free[node], self.water_free[node]) =
                        (self.supports[node], self.water_supports[node]);
                } else {
                    self.silence(node);
                }
            }
        }
    }

    /// Storage of the water around a node of layers, `n/K_w`, 1/Pa: the mean over its points.
    pub fn storage(&self, node: usize) -> f64 {
        let [[.., storage]] = self.sums.masses[node];
        storage / self.volume[node]
    }

    /// Velocities from the points' [`sums`](Self::sums) of momenta; zero where a node is held, and those that
    /// the nodes have where the water slides.
    pub fn take_velocities(&mut self, soil: &Material) {
        let count = self.len();
        let momenta = &self.sums.momenta[..count];
        let [per_solid_mass, per_water_mass] =
            [&self.per_solid_mass, &self.per_water_mass].map(|field| &field[..count]);
        let [free, water_free, sliding] =
            [&self.free, &self.water_free, &self.sliding].map(|field| &field[..count]);
        let [solid_velocity, water_velocity] =
            [&mut self.solid_velocity, &mut self.water_velocity].map(|field| &mut field[..count]);
        for &node in &self.active {
            let [solid, water] = &momenta[node];
            let per_grains = soil.grain_density * per_solid_mass[node];
            let per_pores = soil.water_density * per_water_mass[node];
            for d in 0..D {
                solid_velocity[node][d] = solid[d] * (free[node][d] * per_grains);
                if sliding[node][d] == 0.0 {
                    water_velocity[node][d] = water[d] * (water_free[node][d] * per_pores);
                }
            }
        }
    }

    /// Forces from the points' [`sums`](Self::sums) and from what acts from outside.
    pub fn take_forces(&mut self) {
        let count = self.len();
        let (forces, external) = (&self.sums.forces[..count], &self.external_force[..count]);
        let [mixture_force, water_force] =
            [&mut self.mixture_force, &mut self.water_force].map(|field| &mut field[..count]);
        for &node in &self.active {
            let [mixture, water] = forces[node];
            for d in 0..D {
                mixture_force[node][d] = external[node][d] + mixture[d];
            }
            water_force[node] = water;
        }
    }

    /// `v_s + n (v_w − v_s)` with the nodal porosity: what docs/theory.md, Eq. 4 takes the divergence of.
    pub fn take_flux(&mut self) {
        let count = self.len();
        let (flux, porosity) = (&mut self.flux[..count], &self.porosity[..count]);
        let [solid_velocity, water_velocity] =
            [&self.solid_velocity, &self.water_velocity].map(|field| &field[..count]);
        for &node in &self.active {
            let (solid, water) = (&solid_velocity[node], &water_velocity[node]);
            for d in 0..D {
                flux[node][d] = solid[d] + porosity[node] * (water[d] - solid[d]);
            }
        }
    }

    /// Takes everything from a node that has lost its mass.
    fn silence(&mut self, node: usize) {
        self.carries[node] = false;
        self.motion[node] = [[0.0; D]; 4];
        let masses = [&mut self.water_mass, &mut self.per_solid_mass, &mut self.per_water_mass];
        let others = [&mut self.volume, &mut self.porosity, &mut self.drag];
        for field in masses.into_iter().chain(others) {
            field[node] = 0.0;
        }
        for field in [
            &mut self.free,
            &mut self.water_free,
            &mut self.solid_velocity,
            &mut self.water_velocity,
            &mut self.solid_acceleration,
            &mut self.water_acceleration,
            &mut self.mixture_force,
            &mut self.water_force,
            &mut self.flux,
        ] {
            field[node] = [0.0; D];
        }
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
    fn each_support_holds_its_faces_and_leaves_the_others_free() {
        let grid = Grid::new(0.1, [1, 10]);
        // At the corner of the base, on the upper side, on top of it, and below the base.
        for (support, free) in [
            (Support::oedometer(), [[0.0, 0.0], [0.0, 1.0], [0.0, 1.0], [0.0, 0.0]]),
            (Support::oedometer().with_movable_side(), [[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 0.0]]),
            (Support::closed(), [[0.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0]]),
            (Support::free(), [[1.0, 1.0]; 4]),
        ] {
            let mut nodes = Nodes::new(&grid, &support, 1.0);
            nodes.sums.masses.fill([[1.0; 4]]);
            nodes.take_masses(&Material::default(), false);
            let places = [[2, 2], [3, 7], [3, 12], [2, 1]];
            assert_eq!(places.map(|place| nodes.free[grid.flat_node(&place)]), free, "{support:?}");
        }
    }

    #[test]
    fn a_drained_base_holds_the_skeleton_and_lets_the_water_out() {
        let grid = Grid::new(0.1, [2, 3]);
        let support = Support::oedometer().on_drained_base();
        let mut nodes = Nodes::new(&grid, &support, 1.0);
        nodes.sums.masses.fill([[1.0; 4]]);
        nodes.take_masses(&Material::default(), false);
        let at = |x: usize, y: usize| grid.flat_node(&[x + 2, y + 2]);
        assert_eq!(nodes.drained_base, [(at(0, 0), 0.25), (at(1, 0), 0.5), (at(2, 0), 0.25)]);
        assert_eq!((nodes.free[at(1, 0)], nodes.water_free[at(1, 0)]), ([1.0, 0.0], [1.0, 1.0]));
        assert_eq!(nodes.water_free[grid.flat_node(&[3, 1])], [1.0, 0.0], "below the base");
    }

    #[test]
    fn a_rough_base_holds_the_skeleton_and_lets_the_water_slide() {
        let grid = Grid::new(0.1, [3, 3]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer().on_rough_base(), 1.0);
        nodes.sums.masses.fill([[1.0; 4]]);
        nodes.take_masses(&Material::default(), false);
        let base = grid.flat_node(&[3, 2]);
        assert_eq!((nodes.free[base], nodes.water_free[base]), ([0.0, 0.0], [1.0, 0.0]));
        let above = grid.flat_node(&[3, 3]);
        assert_eq!(nodes.free[above], [1.0, 1.0]);
    }

    #[test]
    fn water_that_slides_along_a_rough_base_keeps_the_velocity_of_its_node() {
        let (grid, soil) = (Grid::new(0.1, [3, 3]), Material::default());
        let mut nodes = Nodes::new(&grid, &Support::oedometer().on_rough_base(), 1.0);
        for (masses, momenta) in nodes.sums.masses.iter_mut().zip(&mut nodes.sums.momenta) {
            *masses = [[2.0, 0.5, 0.0, 0.0]];
            // Velocities 3 and 5 m/s of the skeleton, 3.25 and 7 m/s of the water.
            *momenta = [[6.0, 10.0], [1.625, 3.5]];
        }
        nodes.water_velocity.fill([0.25, 0.5]);
        nodes.take_masses(&soil, false);
        nodes.take_velocities(&soil);
        let velocities = |row: usize| {
            let node = grid.flat_node(&[3, row]);
            [nodes.solid_velocity[node], nodes.water_velocity[node]]
        };
        let [at_base, above] = [velocities(2), velocities(3)];
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
            nodes.sums.masses.fill([[0.0; 4]]);
            for node in [3, 4, 6] {
                let share = if node == 4 && !has_mass { 0.0 } else { 1.0 };
                nodes.sums.masses[node] = [[2.0 * share, share, 5.0 * share, 0.0]];
                nodes.sums.momenta[node] = [[6.0 * share], [4.0 * share]];
            }
            nodes.take_masses(&soil, false);
            nodes.take_velocities(&soil);
            assert_eq!(nodes.active, if has_mass { vec![3, 4, 6] } else { vec![3, 6] });
            let of_node = [nodes.solid_velocity[4][0], nodes.water_velocity[4][0], nodes.porosity[4]];
            let expected = if has_mass { [3.0, 4.0, 1.0 / 3.0] } else { [0.0; 3] };
            for (got, expected) in of_node.iter().zip(expected) {
                assert!((got - expected).abs() < 1e-14, "{got} for {expected}");
            }
            let expected = if has_mass { 1.0 } else { 0.0 };
            assert_eq!((nodes.free[4], nodes.water_free[4]), ([expected], [expected]));
            assert_eq!(
                (nodes.volume[4], nodes.drag[4], nodes.water_mass[4] > 0.0),
                (3.0 * expected, 5.0 * expected, has_mass)
            );
        }
    }

    #[test]
    fn a_node_with_a_ghost_of_mass_is_silent() {
        let grid = Grid::new(0.1, [4]);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        nodes.sums.masses[4] = [[1e-33; 4]];
        nodes.sums.masses[5] = [[1e-6; 4]];
        nodes.take_masses(&Material::default(), false);
        assert_eq!((nodes.free[4], nodes.free[5]), ([0.0], [1.0]));
    }
}
