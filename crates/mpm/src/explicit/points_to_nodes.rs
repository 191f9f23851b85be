//! From points to nodes: masses, velocities and forces, each one pass over the points.
//!
//! Where points move, these passes are most of a step: the step takes masses, velocities and forces in one, right
//! after the weights were made. It takes a point's run of nodes as one slice, so that its bounds are checked once,
//! takes what belongs across the run into what the point gives, and sums side by side what belongs to one node.

use crate::body::Body;
use crate::operators::block_rows::{Blocks, Run};
use crate::operators::line_sums::{LineSums, add_nodes, gradients_of, weights_of};
use crate::operators::pairs::add_weighted;
use crate::operators::stencil::with_stencils;
use crate::state::lanes::{LANES, Lanes, block_of, blocks_of};
use crate::state::points::Points;
use crate::wide::wide;
use oedometer_soil::conductivity_mean::ConductivityMean;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector, product_with_transpose};
use std::ops::Range;

impl<const D: usize> Body<D> {
    /// Sums masses, volumes and drag of the points to the nodes.
    pub fn map_masses(&mut self) {
        self.map_points::<true, false, false>();
    }

    /// Maps the velocities of both phases from the points to the nodes, weighted with mass.
    pub fn map_velocities(&mut self) {
        self.map_points::<false, true, false>();
    }

    /// Forces on the mixture and on the water from the points' stresses (weak form, drained
    /// surface natural).
    pub fn map_forces(&mut self) {
        self.map_points::<false, false, true>();
    }

    /// All of them in one pass.
    pub fn map_masses_velocities_and_forces(&mut self) {
        self.map_points::<true, true, true>();
    }

    /// What the points give of all of them, and nothing yet of what the nodes make of it.
    pub(crate) fn sum_masses_velocities_and_forces(&mut self) {
        self.sum_all_points::<true, true, true>();
    }

    fn sum_all_points<const MASSES: bool, const VELOCITIES: bool, const FORCES: bool>(&mut self) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => {
            wide!(self.sum_points::<MASSES, VELOCITIES, FORCES, _>(stencils.blocks()));
        });
        self.basis = basis;
    }

    fn map_points<const MASSES: bool, const VELOCITIES: bool, const FORCES: bool>(&mut self) {
        self.sum_all_points::<MASSES, VELOCITIES, FORCES>();
        if MASSES {
            self.nodes.take_masses(&self.material);
            if self.material.conductivity_mean == ConductivityMean::Chord {
                self.take_chord_drag();
            }
        }
        if VELOCITIES {
            self.take_velocities();
        }
        if FORCES {
            self.add_stress_slopes();
            self.nodes.take_forces();
            if self.weight.is_some() {
                self.add_weight();
            }
            if self.forcing.is_some() {
                self.add_body_forces();
            }
        }
    }

    /// Velocities of the nodes from the momenta that the points gave them.
    pub(crate) fn take_velocities(&mut self) {
        self.add_slopes();
        self.nodes.take_velocities(&self.material);
        if let Some(plate) = &self.plate {
            plate.tie_velocities(&mut self.nodes);
        }
    }

    /// The same, some neighbouring points after the others: first what each of them gives, then what its nodes take.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn sum_points<const MASSES: bool, const VELOCITIES: bool, const FORCES: bool, const W: usize>(
        &mut self,
        basis: Blocks<'_, D, W>,
    ) {
        self.nodes.clear_sums(MASSES, VELOCITIES, FORCES);
        let (soil, sums, points) = (&self.material, &mut self.nodes.sums, &self.points);
        let (masses, balances) = (&mut sums.masses[..], &mut sums.balances[..]);
        let (stride, is_total) = (*self.grid.node_stride(), self.is_pushed_forward);
        for block in blocks_of(points.len()) {
            let (rows, count) = (basis.block(block.start / LANES), block.len().min(LANES));
            let given = Given::of(soil, points, &block, is_total);
            if D == 1 && MASSES && VELOCITIES && FORCES {
                let sums = LineSums { masses, balances: fours_of(balances) };
                rows.add_all_in_line(
                    count,
                    sums,
                    #[inline(always)]
                    |lane| {
                        let ([solid, water], [mixture, flow]) =
                            (of_line(&given.momenta(lane)), of_line(&given.stresses(lane)[0]));
                        [given.masses(lane), [solid, water, mixture, flow]]
                    },
                );
                continue;
            }
            if D == 1 {
                if MASSES {
                    rows.add_in_line(
                        count,
                        weights_of,
                        #[inline(always)]
                        |lane| given.masses(lane),
                        #[inline(always)]
                        |first, window| add_nodes(&mut masses[first..first + W], window),
                    );
                }
                if VELOCITIES {
                    rows.add_in_line(
                        count,
                        weights_of,
                        #[inline(always)]
                        |lane| of_line(&given.momenta(lane)),
                        #[inline(always)]
                        |first, window| add_pairs::<_, 0>(&mut balances[first..first + W], window),
                    );
                }
                if FORCES {
                    rows.add_in_line(
                        count,
                        gradients_of,
                        #[inline(always)]
                        |lane| of_line(&given.stresses(lane)[0]),
                        #[inline(always)]
                        |first, window| add_pairs::<_, 2>(&mut balances[first..first + W], window),
                    );
                }
                continue;
            }
            for lane in 0..count {
                let (masses_of_point, stresses_of_point) = (given.masses(lane), given.stresses(lane));
                let momenta_of_point = if VELOCITIES { given.momenta(lane) } else { [[0.0; D]; 2] };
                rows.visit_filled_runs(
                    &stride,
                    lane,
                    #[inline(always)]
                    |run| {
                        if MASSES {
                            add_masses_to_run(masses, run, &masses_of_point);
                        }
                        if VELOCITIES {
                            add_momenta_to_run(balances, run, &momenta_of_point);
                        }
                        if FORCES {
                            add_forces_to_run(balances, run, &stresses_of_point);
                        }
                    },
                );
            }
        }
    }
}

/// Volumes of the grains and of the pores of a point, m^D: grains fill `(1 − n) V = (1 − n_0) V_0`, water `n V`.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn volumes_of(initial: f64, ratio: f64, solid_fraction: f64) -> [f64; 2] {
    [initial * solid_fraction, initial * (ratio - solid_fraction)]
}

/// Volume times velocity of both phases.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn momenta_of<const D: usize>(
    [grain_volume, pore_volume]: [f64; 2],
    solid_velocity: &Vector<D>,
    water_velocity: &Vector<D>,
) -> [Vector<D>; 2] {
    [
        solid_velocity.map(|velocity| grain_volume * velocity),
        water_velocity.map(|velocity| pore_volume * velocity),
    ]
}

/// What some neighbouring points give to the nodes.
struct Given<'a, const D: usize> {
    /// Volumes of grains and pores, and those that the stresses fill, m^D.
    grains: Lanes,
    pores: Lanes,
    stressed: Lanes,
    /// Drag, N s/m.
    drag: Lanes,
    solid_velocity: &'a [Vector<D>],
    water_velocity: &'a [Vector<D>],
    effective_stress: &'a [Tensor<D>],
    pressure: &'a [f64],
    /// Inverse deformations where gradients are those of the initial configuration.
    inverse: Option<&'a [Tensor<D>]>,
}

impl<'a, const D: usize> Given<'a, D> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn of(soil: &Material, points: &'a Points<D>, block: &Range<usize>, is_total: bool) -> Self {
        let initial = block_of(&points.initial_volume, block, 0.0);
        let ratio = block_of(&points.volume_ratio, block, 1.0);
        let share = block_of(&points.stressed_share, block, 1.0);
        let solid_fraction = 1.0 - soil.porosity;
        let resistivity =
            soil.law.resistivities(soil.unit_weight_of_water() / soil.hydraulic_conductivity, &ratio);
        let [mut grains, mut pores, mut stressed, mut drag] = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            [grains[lane], pores[lane]] = volumes_of(initial[lane], ratio[lane], solid_fraction);
        }
        for lane in 0..LANES {
            stressed[lane] = initial[lane] * ratio[lane] * share[lane];
        }
        for lane in 0..LANES {
            drag[lane] = pores[lane] * resistivity[lane];
        }
        Self {
            grains,
            pores,
            stressed,
            drag,
            solid_velocity: &points.solid_velocity[block.clone()],
            // None where the water has points of its own: nobody takes it from these then.
            water_velocity: points.water_velocity.get(block.clone()).unwrap_or_default(),
            effective_stress: &points.effective_stress[block.clone()],
            pressure: &points.pressure[block.clone()],
            inverse: is_total.then(|| &points.inverse_deformation[block.clone()]),
        }
    }

    /// Volumes of grains and pores, m^D, and drag, N s/m, of one of them.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn masses(&self, lane: usize) -> [f64; 4] {
        [self.grains[lane], self.pores[lane], self.drag[lane], 0.0]
    }

    /// Volume times velocity of its phases.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn momenta(&self, lane: usize) -> [Vector<D>; 2] {
        let volumes = [self.grains[lane], self.pores[lane]];
        momenta_of(volumes, &self.solid_velocity[lane], &self.water_velocity[lane])
    }

    /// What each unit of gradient gives to the mixture, `(p I − σ') V`, and to the water, `p V I`,
    /// `[direction][phase][component]`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn stresses(&self, lane: usize) -> [[Vector<D>; 2]; D] {
        let volume = self.stressed[lane];
        let pressure = volume * self.pressure[lane];
        let mut mixture = self.effective_stress[lane].map(|row| row.map(|stress| -(volume * stress)));
        let mut water = [[0.0; D]; D];
        for d in 0..D {
            mixture[d][d] += pressure;
            water[d][d] = pressure;
        }
        if let Some(inverse) = self.inverse {
            // Gradients on the initial configuration meet `σ F⁻ᵀ`.
            (mixture, water) = (
                product_with_transpose(&mixture, &inverse[lane]),
                product_with_transpose(&water, &inverse[lane]),
            );
        }
        let along = |stress: &Tensor<D>, e: usize| std::array::from_fn(|d| stress[d][e]);
        std::array::from_fn(|e| [along(&mixture, e), along(&water, e)])
    }
}

/// What a point of a line has of both phases.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn of_line<const D: usize>([one, two]: &[Vector<D>; 2]) -> [f64; 2] {
    [one[0], two[0]]
}

/// The balances of the nodes of a line.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn fours_of<const D: usize>(balances: &mut [[Vector<D>; 4]]) -> &mut [[f64; 4]] {
    balances.as_flattened_mut().as_flattened_mut().as_chunks_mut().0
}

/// Adds momenta, which are the first of the balances of a line's nodes, or forces, from the third on.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn add_pairs<const D: usize, const FROM: usize>(nodes: &mut [[Vector<D>; 4]], sums: &[[f64; 2]]) {
    for (node, sum) in nodes.iter_mut().zip(sums) {
        for phase in 0..2 {
            node[FROM + phase][0] += sum[phase];
        }
    }
}

/// Adds a point's volumes and drag to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn add_masses_to_run<const D: usize, const W: usize>(
    masses: &mut [[f64; 4]],
    run: &Run<D, W>,
    given: &[f64; 4],
) {
    let given = given.map(|mass| mass * run.across[0]);
    for (node, weight) in masses[run.first..run.first + W].iter_mut().zip(&run.weights) {
        add_weighted(node, *weight, &given);
    }
}

/// Adds a point's momenta to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn add_momenta_to_run<const D: usize, const W: usize>(
    balances: &mut [[Vector<D>; 4]],
    run: &Run<D, W>,
    given: &[Vector<D>; 2],
) {
    let given = given.map(|momentum| momentum.map(|component| component * run.across[0]));
    for (node, weight) in balances[run.first..run.first + W].iter_mut().zip(&run.weights) {
        add_weighted(node[..2].as_flattened_mut(), *weight, given.as_flattened());
    }
}

/// Adds the forces of what each unit of gradient gives to the mixture and to the water, `[direction][phase][component]`,
/// to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn add_forces_to_run<const D: usize, const W: usize>(
    balances: &mut [[Vector<D>; 4]],
    run: &Run<D, W>,
    given: &[[Vector<D>; 2]; D],
) {
    let mut given = *given;
    for e in 0..D {
        for stress in given[e].as_flattened_mut() {
            *stress *= run.across[e];
        }
    }
    for (k, node) in balances[run.first..run.first + W].iter_mut().enumerate() {
        let [.., mixture, water] = node;
        let mut sum = [*mixture, *water];
        for e in 0..D {
            let along = if e == 0 { run.gradients[k] } else { run.weights[k] };
            add_weighted(sum.as_flattened_mut(), along, given[e].as_flattened());
        }
        [*mixture, *water] = sum;
    }
}
