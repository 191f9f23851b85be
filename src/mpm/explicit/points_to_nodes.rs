//! From points to nodes: masses, velocities and forces, each one pass over the points.
//!
//! Where points move, these passes are most of a step: the step takes masses, velocities and forces in one, right
//! after the weights were made. It takes a point's run of nodes as one slice, so that its bounds are checked once,
//! takes what belongs across the run into what the point gives, and sums side by side what belongs to one node.

use crate::mpm::body::Body;
use crate::mpm::operators::line_sums::{gradients_of, weights_of};
use crate::mpm::operators::pairs::add_weighted;
use crate::mpm::operators::stencil::{Blocks, Run, with_stencils};
use crate::mpm::state::lanes::LANES;
use crate::mpm::state::points::Points;
use crate::mpm::wide::wide;
use crate::soil::conductivity_mean::ConductivityMean;
use crate::soil::tensor::{Tensor, Vector, product_with_transpose};
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

    fn map_points<const MASSES: bool, const VELOCITIES: bool, const FORCES: bool>(&mut self) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => {
            wide!(self.sum_points::<MASSES, VELOCITIES, FORCES, _>(stencils.blocks()));
        });
        self.basis = basis;
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
        let (soil, sums) = (&self.material, &mut self.nodes.sums);
        let (masses, momenta, forces) = (&mut sums.masses[..], &mut sums.momenta[..], &mut sums.forces[..]);
        let (solid_fraction, unit_weight) = (1.0 - soil.porosity, soil.unit_weight_of_water());
        // Slices of one length: the bounds of all are checked here and not at every point.
        let count = self.points.len();
        let points = PointSlices::of(&self.points, count);
        let (stride, is_total) = (*self.grid.node_stride(), self.is_pushed_forward);
        let (mut given_masses, mut given_momenta) = ([[0.0; 4]; LANES], [[[0.0; D]; 2]; LANES]);
        let mut given_stresses = [[[[0.0; D]; 2]; D]; LANES];
        for first in (0..count).step_by(LANES) {
            let block = first..count.min(first + LANES);
            for (lane, point) in block.clone().enumerate().take(LANES) {
                let (initial, ratio) = (points.initial_volume[point], points.volume_ratio[point]);
                let volumes = volumes_of(initial, ratio, solid_fraction);
                if MASSES {
                    let [grain_volume, pore_volume] = volumes;
                    let drag = pore_volume * unit_weight / soil.hydraulic_conductivity_at(ratio);
                    given_masses[lane] = [grain_volume, pore_volume, drag, 0.0];
                }
                if VELOCITIES {
                    given_momenta[lane] =
                        momenta_of(volumes, &points.solid_velocity[point], &points.water_velocity[point]);
                }
                if FORCES {
                    given_stresses[lane] = points.stresses(point, is_total);
                }
            }
            if D == 1 {
                // The same, summed over neighbours first.
                if MASSES {
                    basis.add_in_line(
                        block.clone(),
                        masses.as_flattened_mut(),
                        weights_of,
                        #[inline(always)]
                        |lane| given_masses[lane],
                    );
                }
                if VELOCITIES {
                    add_momenta_in_line(basis, block.clone(), momenta, &given_momenta);
                }
                if FORCES {
                    let forces = forces.as_flattened_mut().as_flattened_mut();
                    basis.add_in_line(
                        block,
                        forces,
                        gradients_of,
                        #[inline(always)]
                        |lane| [given_stresses[lane][0][0][0], given_stresses[lane][0][1][0]],
                    );
                }
                continue;
            }
            for (lane, point) in block.enumerate().take(LANES) {
                basis.visit_runs(
                    &stride,
                    point,
                    #[inline(always)]
                    |run| {
                        if MASSES {
                            add_masses(masses, run, &given_masses[lane]);
                        }
                        if VELOCITIES {
                            add_momenta(momenta, run, &given_momenta[lane]);
                        }
                        if FORCES {
                            add_forces(forces, run, &given_stresses[lane]);
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

/// Adds a point's volumes and drag to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn add_masses<const D: usize, const W: usize>(masses: &mut [[f64; 4]], run: &Run<D, W>, given: &[f64; 4]) {
    let mut given = *given;
    for mass in &mut given {
        *mass *= run.across[0];
    }
    for (node, weight) in masses[run.first..run.first + W].iter_mut().zip(&run.weights) {
        add_weighted(node, *weight, &given);
    }
}

/// Adds a point's momenta to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn add_momenta<const D: usize, const W: usize>(
    momenta: &mut [[Vector<D>; 2]],
    run: &Run<D, W>,
    given: &[Vector<D>; 2],
) {
    let mut given = *given;
    for momentum in given.as_flattened_mut() {
        *momentum *= run.across[0];
    }
    for (node, weight) in momenta[run.first..run.first + W].iter_mut().zip(&run.weights) {
        add_weighted(node.as_flattened_mut(), *weight, given.as_flattened());
    }
}

/// Adds the momenta of the points of a block of a line to their nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub(crate) fn add_momenta_in_line<const D: usize, const W: usize>(
    basis: Blocks<'_, D, W>,
    block: Range<usize>,
    momenta: &mut [[Vector<D>; 2]],
    given: &[[Vector<D>; 2]; LANES],
) {
    let momenta = momenta.as_flattened_mut().as_flattened_mut();
    basis.add_in_line(
        block,
        momenta,
        weights_of,
        #[inline(always)]
        |lane| [given[lane][0][0], given[lane][1][0]],
    );
}

/// Adds the forces of what each unit of gradient gives to the mixture and to the water, `[direction][phase][component]`,
/// to a run of nodes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn add_forces<const D: usize, const W: usize>(
    forces: &mut [[Vector<D>; 2]],
    run: &Run<D, W>,
    given: &[[Vector<D>; 2]; D],
) {
    let mut given = *given;
    for e in 0..D {
        for stress in given[e].as_flattened_mut() {
            *stress *= run.across[e];
        }
    }
    for (k, node) in forces[run.first..run.first + W].iter_mut().enumerate() {
        let mut sum = *node;
        for e in 0..D {
            let along = if e == 0 { run.gradients[k] } else { run.weights[k] };
            add_weighted(sum.as_flattened_mut(), along, given[e].as_flattened());
        }
        *node = sum;
    }
}

/// What the points give to the nodes, slices of one length.
struct PointSlices<'a, const D: usize> {
    initial_volume: &'a [f64],
    volume_ratio: &'a [f64],
    stressed_share: &'a [f64],
    inverse_deformation: &'a [Tensor<D>],
    solid_velocity: &'a [Vector<D>],
    water_velocity: &'a [Vector<D>],
    effective_stress: &'a [Tensor<D>],
    pressure: &'a [f64],
}

impl<'a, const D: usize> PointSlices<'a, D> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn of(points: &'a Points<D>, count: usize) -> Self {
        Self {
            initial_volume: &points.initial_volume[..count],
            volume_ratio: &points.volume_ratio[..count],
            stressed_share: &points.stressed_share[..count],
            inverse_deformation: &points.inverse_deformation[..count],
            solid_velocity: &points.solid_velocity[..count],
            // None where the water has points of its own: nobody takes it from these then.
            water_velocity: points.water_velocity.get(..count).unwrap_or_default(),
            effective_stress: &points.effective_stress[..count],
            pressure: &points.pressure[..count],
        }
    }

    /// What each unit of gradient gives to the mixture, `(p I − σ') V`, and to the water, `p V I`,
    /// `[direction][phase][component]`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn stresses(&self, point: usize, is_total: bool) -> [[Vector<D>; 2]; D] {
        let volume = self.initial_volume[point] * self.volume_ratio[point] * self.stressed_share[point];
        let pressure = volume * self.pressure[point];
        let mut mixture = self.effective_stress[point].map(|row| row.map(|stress| -(volume * stress)));
        let mut water = [[0.0; D]; D];
        for d in 0..D {
            mixture[d][d] += pressure;
            water[d][d] = pressure;
        }
        if is_total {
            // Gradients on the initial configuration meet `σ F⁻ᵀ`.
            let inverse = &self.inverse_deformation[point];
            (mixture, water) =
                (product_with_transpose(&mixture, inverse), product_with_transpose(&water, inverse));
        }
        let along = |stress: &Tensor<D>, e: usize| std::array::from_fn(|d| stress[d][e]);
        std::array::from_fn(|e| [along(&mixture, e), along(&water, e)])
    }
}
