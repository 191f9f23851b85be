//! From points to nodes: masses, momenta and forces, in one pass over the points or in one each.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::kernel::body::Body;
use crate::operators::basis::{ShapeFunction, build_blocks, with_shape};
use crate::operators::corners::build_corners;
use crate::operators::stencil::{Line, Run, Stencil, Stencils, with_stencils};
use crate::state::cells::Locating;
use crate::state::grid::Grid;
use crate::state::nodes::{NodalSums, Support};
use crate::state::points::Points;
use crate::wide::{LANES, are_alike, some_mut, some_of, wide};
use oedometer_problem::wave_speeds::drags_of_points;
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector, product_with_transpose};
use std::hint::black_box;
use std::marker::PhantomData;

impl<const D: usize> Body<D> {
    /// Sums masses, volumes and drag of the points to the nodes.
    pub fn map_masses(&mut self) {
        self.sum_points::<Masses>();
        self.take_masses();
    }

    /// Maps the velocities of both phases from the points to the nodes, weighted with mass.
    pub fn map_velocities(&mut self) {
        self.sum_points::<Momenta>();
        self.take_velocities();
    }

    /// Forces on the mixture and on the water from the points' stresses (weak form, drained
    /// surface natural), and from what acts from outside.
    pub fn map_forces(&mut self) {
        self.sum_points::<Forces>();
        self.take_forces();
    }

    /// [`map_masses`](Self::map_masses) and [`map_forces`](Self::map_forces) in one pass.
    pub(crate) fn map_masses_and_forces(&mut self) {
        self.sum_points::<(Masses, Forces)>();
        self.take_masses();
        self.take_forces();
    }

    /// Sums masses, momenta and forces of the points by the shape functions that stand.
    pub(crate) fn sum_points<G: Gives>(&mut self) {
        let giving = Giving::new(&self.points, &self.soils, self.is_pushed_forward);
        let (stride, sums) = (*self.grid.node_stride(), &mut self.nodes.sums);
        with_stencils!(&self.operators.basis, stencils => wide!({
            let mut sums = ToNodes::<D, _, G>::new(sums, stride);
            let stencils = stencils.slices(giving.count());
            for point in 0..giving.count() {
                let shares = giving.shares::<1, G>(point);
                let given = giving.given::<1, G>(point, 0, &shares);
                sums.add(stencils.of_point(point), &given);
            }
            sums.close();
        }));
    }

    /// Builds the shape functions of points that have moved, and sums their masses, momenta and forces right away.
    pub(crate) fn build_basis_and_sum_points(&mut self) {
        let mut basis = std::mem::take(&mut self.operators.basis);
        if let Some(domains) = &self.operators.domains {
            self.cells.locate(&self.grid, &self.points, &self.soils);
            build_corners(&mut basis, &self.grid, &self.cells.place, &domains.half_edges);
            self.operators.basis = basis;
            self.sum_points::<All>();
            return;
        }
        with_shape!(self.method.basis, &mut basis, S, stencils => {
            wide!(self.build_and_sum::<_, S>(stencils));
        });
        self.operators.basis = basis;
        self.cells.end_locating(&self.points, &self.soils);
    }

    #[inline(always)]
    fn build_and_sum<const W: usize, S: ShapeFunction<W>>(&mut self, stencils: &mut Stencils<D, W>) {
        let giving = Giving::new(&self.points, &self.soils, false);
        let count = giving.count();
        let mut building = Building {
            giving,
            grid: &self.grid,
            support: &self.support(),
            positions: &self.points.position[..count],
            half_lengths: &self.points.half_length[..count],
            cells: self.cells.begin_locating(count),
            blocks: stencils.blocks_mut(count),
            sums: ToNodes::new(&mut self.nodes.sums, *self.grid.node_stride()),
        };
        let mut point = 0;
        while point < count {
            if are_alike(giving.soil, point) {
                building.build_and_add::<LANES, S>(point);
                point += LANES;
            } else {
                building.build_and_add::<1, S>(point);
                point += 1;
            }
        }
        building.sums.close();
    }

    /// Masses of the nodes from what the points have given.
    pub(crate) fn take_masses(&mut self) {
        self.nodes.take_masses(&self.material, self.is_layered());
        if self.material.conductivity_mean == ConductivityMean::Chord {
            self.take_chord_drag();
        }
    }

    /// Velocities of the nodes from the momenta that the points have given.
    pub(crate) fn take_velocities(&mut self) {
        if let Some(gradients) = &self.actions.velocity_gradients {
            let momenta = &mut self.nodes.sums.momenta;
            gradients.add_momenta(&self.grid, &self.cells, &self.points, &self.operators.basis, momenta);
        }
        self.nodes.take_velocities(&self.material);
        if let Some(plate) = &self.actions.plate {
            plate.tie_velocities(&mut self.nodes);
        }
    }

    /// Forces on the nodes from what the points have given, and from what acts from outside.
    pub(crate) fn take_forces(&mut self) {
        if let Some(planes) = &mut self.actions.stress_planes {
            let forces = &mut self.nodes.sums.forces;
            planes.add_forces(&self.grid, &self.cells, &self.points, &self.operators.basis, forces);
        }
        self.nodes.take_forces();
        if self.actions.weight.is_some() {
            self.add_weight();
        }
        if self.actions.forcing.is_some() {
            self.add_body_forces();
        }
    }
}

/// What the points of a pass give.
pub(crate) trait Gives {
    /// Volumes of grains and pores, and drag.
    const MASSES: bool;
    /// Volumes times velocities.
    const MOMENTA: bool;
    /// Stresses times volumes.
    const FORCES: bool;
}

/// Nothing.
pub(crate) struct Nothing;
/// Masses alone.
pub(crate) struct Masses;
/// Momenta alone.
pub(crate) struct Momenta;
/// Forces alone.
pub(crate) struct Forces;
/// Everything.
pub(crate) type All = ((Masses, Momenta), Forces);

impl Gives for Nothing {
    const MASSES: bool = false;
    const MOMENTA: bool = false;
    const FORCES: bool = false;
}

impl Gives for Masses {
    const MASSES: bool = true;
    const MOMENTA: bool = false;
    const FORCES: bool = false;
}

impl Gives for Momenta {
    const MASSES: bool = false;
    const MOMENTA: bool = true;
    const FORCES: bool = false;
}

impl Gives for Forces {
    const MASSES: bool = false;
    const MOMENTA: bool = false;
    const FORCES: bool = true;
}

impl<A: Gives, B: Gives> Gives for (A, B) {
    const MASSES: bool = A::MASSES || B::MASSES;
    const MOMENTA: bool = A::MOMENTA || B::MOMENTA;
    const FORCES: bool = A::FORCES || B::FORCES;
}

/// Points whose shape functions are built, and what they give summed.
struct Building<'a, const D: usize, const W: usize> {
    giving: Giving<'a, D>,
    grid: &'a Grid<D>,
    support: &'a Support<D>,
    positions: &'a [Vector<D>],
    half_lengths: &'a [Vector<D>],
    cells: Locating<'a, D>,
    blocks: (&'a mut [usize], &'a mut [[Line<W>; D]]),
    sums: ToNodes<'a, D, W, All>,
}

impl<const D: usize, const W: usize> Building<'_, D, W> {
    /// Finds `N` neighbours of one soil in their cells, builds their shape functions, and adds what they give: all but
    /// the sums are loops over them.
    #[inline(always)]
    fn build_and_add<const N: usize, S: ShapeFunction<W>>(&mut self, first: usize) {
        let shares = self.giving.shares::<N, All>(first);
        let (positions, volumes) = (some_of(self.positions, first), [&shares.grains, &shares.pores]);
        let (cells, places) = self.cells.locate::<N>(self.grid, first, positions, volumes);
        let domains = [&places, some_of(self.half_lengths, first), &cells];
        let (lowest, lines) = (some_mut(self.blocks.0, first), some_mut(self.blocks.1, first));
        build_blocks::<D, W, N, S>(self.grid, self.support, domains, lowest, lines);
        for p in 0..N {
            let given = self.giving.given::<N, All>(first, p, &shares);
            self.sums.add(Stencil::of_block(&lowest[p], &lines[p]), &given);
        }
    }
}

/// What the points give, as slices of one length.
#[derive(Clone, Copy)]
struct Giving<'a, const D: usize> {
    soils: &'a [Material],
    soil: &'a [u8],
    initial_volume: &'a [f64],
    grain_volume: &'a [f64],
    volume_ratio: &'a [f64],
    stressed_share: &'a [f64],
    solid_velocity: &'a [Vector<D>],
    /// None where the water has points of its own.
    water_velocity: &'a [Vector<D>],
    effective_stress: &'a [Tensor<D>],
    pressure: &'a [f64],
    /// Of points whose gradients are pushed forward.
    inverse_deformation: Option<&'a [Tensor<D>]>,
}

/// What a point gives to its nodes.
#[derive(Clone, Copy)]
pub(crate) struct Given<const D: usize> {
    /// Volumes of grains and pores, m^D, and drag, N s/m; in layers that over the point's porosity, which the node's
    /// replaces (docs/theory.md, Eq. 44), and the storage of the pores, m^D/Pa.
    pub masses: [f64; 4],
    /// Volume times velocity of both phases, m^D m/s.
    pub momenta: [Vector<D>; 2],
    /// What each unit of gradient gives to the mixture, `(p I − σ') V`, and to the water, `p V I`,
    /// `[direction][phase][component]`.
    pub stresses: [[Vector<D>; 2]; D],
}

impl<const D: usize> Given<D> {
    /// Nothing.
    pub const NOTHING: Self = Self { masses: [0.0; 4], momenta: [[0.0; D]; 2], stresses: [[[0.0; D]; 2]; D] };
}

impl<'a, const D: usize> Giving<'a, D> {
    #[inline(always)]
    fn new(points: &'a Points<D>, soils: &'a [Material], is_pushed_forward: bool) -> Self {
        let count = points.len();
        Self {
            soils,
            soil: &points.soil[..count],
            initial_volume: &points.initial_volume[..count],
            grain_volume: &points.grain_volume[..count],
            volume_ratio: &points.volume_ratio[..count],
            stressed_share: &points.stressed_share[..count],
            solid_velocity: &points.solid_velocity[..count],
            water_velocity: &points.water_velocity,
            effective_stress: &points.effective_stress[..count],
            pressure: &points.pressure[..count],
            inverse_deformation: is_pushed_forward.then(|| &points.inverse_deformation[..count]),
        }
    }

    #[inline(always)]
    fn count(&self) -> usize {
        self.pressure.len()
    }

    /// Volumes and drag of `N` neighbours of one soil, from one on.
    #[inline(always)]
    fn shares<const N: usize, G: Gives>(&self, first: usize) -> Shares<N> {
        let (ratios, soil) = (some_of::<_, N>(self.volume_ratio, first), usize::from(self.soil[first]));
        let mut shares = Shares {
            volumes: *some_of(self.initial_volume, first),
            grains: *some_of(self.grain_volume, first),
            pores: [0.0; N],
            drags: [0.0; N],
            storage: [0.0; N],
        };
        for p in 0..N {
            shares.volumes[p] *= ratios[p];
            // n V = V − (1 − n_0) V_0
            shares.pores[p] = shares.volumes[p] - shares.grains[p];
        }
        if G::MASSES {
            let (soil, is_layered) = (&self.soils[soil], self.soils.len() > 1);
            let mut resisting = shares.pores;
            if is_layered {
                for p in 0..N {
                    resisting[p] = shares.grains[p] + shares.pores[p];
                    shares.storage[p] = shares.pores[p] / soil.water_bulk_modulus;
                }
            }
            shares.drags = drags_of_points(soil, &resisting, ratios);
        }
        // In memory point beside point: otherwise the compiler works point by point.
        if N > 1 { black_box(shares) } else { shares }
    }

    /// What a point gives of masses, momenta and forces, the one of a place among neighbours from a first one on.
    #[inline(always)]
    fn given<const N: usize, G: Gives>(&self, first: usize, p: usize, shares: &Shares<N>) -> Given<D> {
        let (mut given, point) = (Given::NOTHING, first + p);
        let (grains, pores) = (shares.grains[p], shares.pores[p]);
        if G::MASSES {
            given.masses = [grains, pores, shares.drags[p], shares.storage[p]];
        }
        if G::MOMENTA {
            let water = self.water_velocity.get(point).unwrap_or(&[0.0; D]);
            given.momenta = scaled(&[self.solid_velocity[point], *water], [grains, pores]);
        }
        if G::FORCES {
            let inverse = self.inverse_deformation.map(|inverse| &inverse[point]);
            given.stresses = stresses_of(
                shares.volumes[p] * self.stressed_share[point],
                self.pressure[point],
                &self.effective_stress[point],
                inverse,
            );
        }
        given
    }
}

/// Volumes of some neighbours, m^D, with the drag, N s/m, and the storage, m^D/Pa, of what they hold.
#[derive(Clone, Copy)]
struct Shares<const N: usize> {
    volumes: [f64; N],
    grains: [f64; N],
    pores: [f64; N],
    drags: [f64; N],
    storage: [f64; N],
}

/// Velocities of both phases, each times a volume.
#[inline(always)]
pub(crate) fn scaled<const D: usize>(velocities: &[Vector<D>; 2], volumes: [f64; 2]) -> [Vector<D>; 2] {
    let mut momenta = *velocities;
    for phase in 0..2 {
        for d in 0..D {
            momenta[phase][d] *= volumes[phase];
        }
    }
    momenta
}

/// What each unit of gradient gives to the mixture, `(p I − σ') V`, and to the water, `p V I`,
/// `[direction][phase][component]`.
#[inline(always)]
fn stresses_of<const D: usize>(
    volume: f64,
    pressure: f64,
    effective_stress: &Tensor<D>,
    inverse: Option<&Tensor<D>>,
) -> [[Vector<D>; 2]; D] {
    let pressure = volume * pressure;
    let (mut mixture, mut water) = (*effective_stress, [[0.0; D]; D]);
    for stress in mixture.as_flattened_mut() {
        *stress *= -volume;
    }
    for d in 0..D {
        mixture[d][d] += pressure;
        water[d][d] = pressure;
    }
    if let Some(inverse) = inverse {
        // Gradients on the initial configuration meet `σ F⁻ᵀ`.
        (mixture, water) =
            (product_with_transpose(&mixture, inverse), product_with_transpose(&water, inverse));
    }
    let mut given = [[[0.0; D]; 2]; D];
    for e in 0..D {
        for d in 0..D {
            given[e][0][d] = mixture[d][e];
            given[e][1][d] = water[d][e];
        }
    }
    given
}

/// Sums of what points give to their nodes; of masses, momenta and forces those that are asked for.
///
/// On a line neighbours give to the same few nodes. What they give is summed in registers for as long as the nodes stay
/// the same: a sum in memory would have to be stored and loaded again for every point.
pub(crate) struct ToNodes<'a, const D: usize, const W: usize, G> {
    stride: [usize; D],
    masses: &'a mut [[[f64; 4]; 1]],
    momenta: &'a mut [[Vector<D>; 2]],
    forces: &'a mut [[Vector<D>; 2]],
    /// The lowest of the nodes that the last points of a line gave to, and what each of them got.
    first: usize,
    line: [Share; W],
    gives: PhantomData<G>,
}

/// What a node of a line gets, each four side by side.
#[derive(Clone, Copy)]
struct Share {
    masses: [f64; 4],
    /// Momenta of both phases, forces on the mixture and on the water.
    balances: [f64; 4],
}

impl Share {
    const NOTHING: Self = Self { masses: [0.0; 4], balances: [0.0; 4] };
}

impl<'a, const D: usize, const W: usize, G: Gives> ToNodes<'a, D, W, G> {
    /// Nothing is given yet.
    #[inline(always)]
    pub fn new(sums: &'a mut NodalSums<D>, stride: [usize; D]) -> Self {
        let count = sums.masses.len();
        if G::MASSES {
            sums.masses.fill([[0.0; 4]]);
        }
        if G::MOMENTA {
            sums.momenta.fill([[0.0; D]; 2]);
        }
        if G::FORCES {
            sums.forces.fill([[0.0; D]; 2]);
        }
        Self {
            stride,
            // Of one length, whose bounds are checked once.
            masses: &mut sums.masses[..count],
            momenta: &mut sums.momenta[..count],
            forces: &mut sums.forces[..count],
            first: 0,
            line: [Share::NOTHING; W],
            gives: PhantomData,
        }
    }

    /// Adds what a point gives, times its shape functions and their gradients.
    #[inline(always)]
    pub fn add(&mut self, stencil: Stencil<'_, D, W>, given: &Given<D>) {
        let stride = self.stride;
        stencil.visit_runs(
            &stride,
            #[inline(always)]
            |run| {
                if D == 1 {
                    self.add_on_line(run, given);
                    return;
                }
                if G::MASSES {
                    run.add_values(&[given.masses], self.masses);
                }
                if G::MOMENTA {
                    run.add_values(&given.momenta, self.momenta);
                }
                if G::FORCES {
                    run.add_gradients(&given.stresses, self.forces);
                }
            },
        );
    }

    #[inline(always)]
    fn add_on_line(&mut self, run: &Run<D, W>, given: &Given<D>) {
        if run.first != self.first {
            self.close();
            (self.first, self.line) = (run.first, [Share::NOTHING; W]);
        }
        let ([solid, water], [mixture, flow]) = (given.momenta, given.stresses[0]);
        let balances = [solid[0], water[0], mixture[0], flow[0]];
        for k in 0..W {
            let (share, value, gradient) = (&mut self.line[k], run.values[k], run.gradients[k]);
            if G::MASSES {
                for i in 0..4 {
                    share.masses[i] += value * given.masses[i];
                }
            }
            let along = [value, value, gradient, gradient];
            for i in 0..4 {
                share.balances[i] += along[i] * balances[i];
            }
        }
    }

    /// Adds what is left in the registers.
    #[inline(always)]
    pub fn close(&mut self) {
        if D > 1 {
            return;
        }
        // Indices, and not iterators: those of two slices at once cost more than the sums.
        if G::MASSES {
            let masses = &mut self.masses[self.first..][..W];
            for k in 0..W {
                for i in 0..4 {
                    masses[k][0][i] += self.line[k].masses[i];
                }
            }
        }
        if G::MOMENTA {
            let momenta = &mut self.momenta[self.first..][..W];
            for k in 0..W {
                for phase in 0..2 {
                    momenta[k][phase][0] += self.line[k].balances[phase];
                }
            }
        }
        if G::FORCES {
            let forces = &mut self.forces[self.first..][..W];
            for k in 0..W {
                for phase in 0..2 {
                    forces[k][phase][0] += self.line[k].balances[2 + phase];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::All;
    use crate::kernel::body::Body;
    use crate::operators::basis::Shapes;
    use crate::tests::column_problem;
    use oedometer_problem::method::{Configuration, Method};
    use oedometer_scenes::XIE_LEO;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    fn assert_same_side_by_side<const D: usize>(name: &str) {
        let method = Method::named(name).expect("a known method");
        let method = Method { configuration: Some(Configuration::Updated), ..method };
        let (column, soil) = (Column { dimensions: D, ..Column::default() }, Material::default());
        let problem = column_problem::<D>(&XIE_LEO, &column, &soil, method, 5, 3).expect("a column");
        let mut body = Body::new(problem);
        for point in 0..body.points.len() {
            let share = (1.3 * point as f64).sin();
            body.points.position[point].iter_mut().for_each(|place| *place *= 0.93 + 0.01 * share);
            body.points.solid_velocity[point] = [share; D];
            body.points.water_velocity[point] = [1.0 - share; D];
            body.points.effective_stress[point][0] = [-share; D];
            body.points.pressure[point] = 2.0 + share;
            body.points.volume_ratio[point] = 1.0 - 0.1 * share;
        }
        body.build_basis_and_sum_points();
        let mut alone = body.clone();
        alone.cells.locate(&alone.grid, &alone.points, &alone.soils);
        let places = [&alone.cells.place[..], &alone.points.half_length[..]];
        let support = alone.support();
        alone.method.basis.build(&mut alone.operators.basis, &alone.grid, &support, places);
        alone.sum_points::<All>();
        assert_eq!(body.cells, alone.cells, "{name}");
        assert_eq!(body.operators.basis, alone.operators.basis, "{name}");
        assert_eq!(body.nodes.sums, alone.nodes.sums, "{name}");
    }

    #[test]
    fn points_side_by_side_give_what_each_gives_alone() {
        for name in ["MPM", "GIMP", "B2", "B3-SRI-patch"] {
            assert_same_side_by_side::<1>(name);
            assert_same_side_by_side::<2>(name);
        }
    }
}
