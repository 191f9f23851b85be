//! From nodal velocities to the stresses of the points: strains, volumes, domains, and what the law makes of them.
//!
//! Some neighbouring points are taken side by side: each line of the algorithm is a loop over them, without a branch,
//! that the compiler turns into one over registers.

use crate::mpm::body::Body;
use crate::mpm::explicit::deformation::{
    Following, middle_gradient, relaxed, rotated, stretch_of, stretches_of,
};
use crate::mpm::method::Configuration;
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::mpm::operators::strain_gradient::StrainOperator;
use crate::mpm::state::lanes::LANES;
use crate::mpm::state::points::Points;
use crate::mpm::wide::wide;
use crate::soil::law::{Law, Stiffness};
use crate::soil::tensor::{Tensor, inverse, product};
use std::ops::Range;

impl<const D: usize> Body<D> {
    /// Step 6: effective stress by the method's strain gradient; at finite strain also volume and
    /// domain.
    pub(crate) fn update_effective_stress(&mut self, dt: f64) {
        if self.method.strain.is_bbar() {
            self.recover_dilation_rates();
        }
        let (basis, strain) = (std::mem::take(&mut self.basis), std::mem::take(&mut self.strain));
        match &strain {
            StrainOperator::Basis => with_stencils!(&basis, stencils => {
                wide!(self.strain_points(stencils.blocks(), dt));
            }),
            StrainOperator::Composite(stencils) => {
                wide!(self.strain_points(stencils.blocks(), dt));
            }
            StrainOperator::BetweenEnds(stencils) => {
                wide!(self.strain_points(stencils.blocks(), dt));
            }
        }
        (self.basis, self.strain) = (basis, strain);
        self.turn_domains();
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn strain_points<const W: usize>(&mut self, stencils: Blocks<'_, D, W>, dt: f64) {
        let stride = *self.grid.node_stride();
        let field = &self.nodes.solid_velocity[..];
        let is_total = self.configuration == Configuration::Total;
        // A motion that is held against exact fields is followed at the middle of the step, to second order.
        let is_at_middle = self.forcing.is_some();
        let dilation_rates = self.method.strain.is_bbar().then_some(&self.dilation_rates[..]);
        let update = StressUpdate {
            deforms: self.configuration.deforms(),
            following: self.following(),
            law: self.material.law,
            stiffness: self.stiffness,
        };
        let count = self.points.len();
        let mut gradients = [[[0.0; D]; D]; LANES];
        for first in (0..count).step_by(LANES) {
            let block = first..count.min(first + LANES);
            for (gradient, point) in gradients.iter_mut().zip(block.clone()) {
                *gradient = stencils.gradient(&stride, point, field);
            }
            if is_total {
                for (gradient, point) in gradients.iter_mut().zip(block.clone()) {
                    *gradient = product(gradient, &self.points.inverse_deformation[point]);
                }
            }
            if is_at_middle {
                for gradient in &mut gradients {
                    *gradient = middle_gradient(gradient, dt);
                }
            }
            let mut increments = gradients;
            for increment in increments.as_flattened_mut().as_flattened_mut() {
                *increment *= dt;
            }
            let mut dilations = None;
            if let Some(rates) = dilation_rates {
                let mut of_points = [0.0; LANES];
                for ((dilation, gradient), rate) in
                    of_points.iter_mut().zip(&gradients).zip(&rates[block.clone()])
                {
                    let trace: f64 = (0..D).map(|d| gradient[d][d]).sum();
                    *dilation = dt * (rate - trace);
                }
                dilations = Some(of_points);
            }
            update.apply(&mut self.points, block, increments, dilations);
        }
    }

    /// Volume ratio, exact in the logarithmic strain, and the domain where it follows.
    pub(crate) fn deform(&mut self, point: usize, increment: &Tensor<D>) {
        let mut increments = [[[0.0; D]; D]; LANES];
        increments[0] = *increment;
        let following = self.following();
        deform(&mut self.points, point..point + 1, following, &increments);
    }

    #[inline]
    fn following(&self) -> Following {
        // A hyperelastic law asks for the whole deformation, and so do domains that turn.
        let is_whole = self.material.law.is_hyperelastic() || self.domains.is_some();
        match self.configuration {
            Configuration::Updated if self.method.domains_follow() && is_whole => Following::Both,
            Configuration::Updated if self.method.domains_follow() => Following::Domain,
            Configuration::Updated if is_whole => Following::InverseDeformation,
            Configuration::Total => Following::InverseDeformation,
            Configuration::Updated | Configuration::Frozen => Following::Nothing,
        }
    }
}

/// What a strain does to a point.
#[derive(Clone, Copy)]
struct StressUpdate {
    /// Whether volumes follow.
    deforms: bool,
    following: Following,
    law: Law,
    stiffness: Stiffness,
}

impl StressUpdate {
    /// Volumes, domains and stresses of a block of points from their increments of the displacement gradient, and
    /// from what B-bar adds to their volumes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn apply<const D: usize>(
        &self,
        points: &mut Points<D>,
        block: Range<usize>,
        mut increments: [Tensor<D>; LANES],
        dilations: Option<[f64; LANES]>,
    ) {
        let mut before = [1.0; LANES];
        before[..block.len()].copy_from_slice(&points.volume_ratio[block.clone()]);
        if self.deforms {
            deform(points, block.clone(), self.following, &increments);
        }
        if self.law.is_hyperelastic() {
            for point in block {
                let deformation = inverse(&points.inverse_deformation[point]).0;
                points.effective_stress[point] =
                    self.stiffness.neo_hookean_stress(&deformation, points.volume_ratio[point]);
            }
            return;
        }
        if let Some(dilations) = dilations {
            // Of the kinematics only the volume goes the way of the water's.
            for (increment, dilation) in increments.iter_mut().zip(&dilations) {
                for d in 0..D {
                    increment[d][d] += dilation / D as f64;
                }
            }
            if self.deforms {
                for (ratio, dilation) in points.volume_ratio[block.clone()].iter_mut().zip(&dilations) {
                    *ratio *= stretch_of(*dilation);
                }
            }
        }
        let mut changes = increments;
        for change in &mut changes {
            *change = self.stiffness.stress(change);
        }
        if let Some(dilations) = dilations {
            for (change, dilation) in changes.iter_mut().zip(&dilations) {
                let shared = self.stiffness.shared_dilation_stress::<D>(*dilation);
                for d in 0..D {
                    change[d][d] += shared;
                }
            }
        }
        let (ratios, stresses) = (&points.volume_ratio[block.clone()], &mut points.effective_stress[block]);
        if self.deforms && D > 1 {
            for (stress, increment) in stresses.iter_mut().zip(&increments) {
                *stress = rotated(stress, increment);
            }
        }
        let after = ratios.iter().zip(&before);
        for ((stress, change), (ratio, before)) in stresses.iter_mut().zip(&changes).zip(after) {
            let modulus = self.law.modulus_ratio(*before, *ratio);
            for d in 0..D {
                for e in 0..D {
                    stress[d][e] += modulus * change[d][e];
                }
            }
        }
    }
}

/// Volume ratios of a block of points, exact in the logarithmic strain, and what follows them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn deform<const D: usize>(
    points: &mut Points<D>,
    block: Range<usize>,
    following: Following,
    increments: &[Tensor<D>; LANES],
) {
    let mut strains = [[0.0; D]; LANES];
    for (strain, increment) in strains.iter_mut().zip(increments) {
        for d in 0..D {
            strain[d] = increment[d][d];
        }
    }
    let stretches = stretches_of(&strains);
    if following.takes_domain() {
        for (half_length, stretch) in points.half_length[block.clone()].iter_mut().zip(&stretches) {
            for d in 0..D {
                half_length[d] *= stretch[d];
            }
        }
    }
    if following.takes_inverse() {
        for (inverse, increment) in points.inverse_deformation[block.clone()].iter_mut().zip(increments) {
            *inverse = relaxed(inverse, increment);
        }
    }
    for (ratio, stretch) in points.volume_ratio[block].iter_mut().zip(&stretches) {
        *ratio *= stretch.iter().product::<f64>();
    }
}
