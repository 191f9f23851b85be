//! From nodal velocities to the stresses of the points: strains, volumes, domains, and what the law makes of them.
//!
//! Some neighbouring points are taken side by side: each line of the algorithm is a loop over them, without a branch,
//! that the compiler turns into one over registers.

use crate::elementary::ln_of_each;
use crate::mpm::body::Body;
use crate::mpm::explicit::deformation::{
    Following, middle_gradient, relaxed, rotated, stretch_of, stretches_of,
};
use crate::mpm::method::Configuration;
use crate::mpm::operators::block_rows::Blocks;
use crate::mpm::operators::stencil::with_stencils;
use crate::mpm::operators::strain_gradient::StrainOperator;
use crate::mpm::state::lanes::{LANES, Lanes, block_of, blocks_of, put_block};
use crate::mpm::state::points::Points;
use crate::mpm::wide::wide;
use crate::soil::law::{Law, Stiffness};
use crate::soil::tensor::{Tensor, identity, inverse, product};
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
        for block in blocks_of(self.points.len()) {
            let (rows, count) = (stencils.block(block.start / LANES), block.len().min(LANES));
            let mut gradients = [[[0.0; D]; D]; LANES];
            for lane in 0..count {
                gradients[lane] = rows.gradient(&stride, lane, field);
            }
            if is_total {
                let inverse = block_of(&self.points.inverse_deformation, &block, [[0.0; D]; D]);
                for lane in 0..LANES {
                    gradients[lane] = product(&gradients[lane], &inverse[lane]);
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
                let mut of_points = block_of(rates, &block, 0.0);
                for lane in 0..LANES {
                    let trace: f64 = (0..D).map(|d| gradients[lane][d][d]).sum();
                    of_points[lane] = dt * (of_points[lane] - trace);
                }
                dilations = Some(of_points);
            }
            update.apply(&mut self.points, &block, increments, dilations);
        }
    }

    /// Volume ratio, exact in the logarithmic strain, and the domain where it follows.
    pub(crate) fn deform(&mut self, point: usize, increment: &Tensor<D>) {
        let mut increments = [[[0.0; D]; D]; LANES];
        increments[0] = *increment;
        let (following, block) = (self.following(), point..point + 1);
        let mut ratios = block_of(&self.points.volume_ratio, &block, 1.0);
        deform(&mut self.points, &block, following, &increments, &mut ratios);
        put_block(&mut self.points.volume_ratio, &block, &ratios);
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
        block: &Range<usize>,
        mut increments: [Tensor<D>; LANES],
        dilations: Option<[f64; LANES]>,
    ) {
        let before = block_of(&points.volume_ratio, block, 1.0);
        let mut ratios = before;
        if self.deforms {
            deform(points, block, self.following, &increments, &mut ratios);
        }
        if self.law.is_hyperelastic() {
            put_block(&mut points.volume_ratio, block, &ratios);
            let logarithms = ln_of_each(&ratios);
            let mut stresses = block_of(&points.inverse_deformation, block, identity());
            for lane in 0..LANES {
                let deformation = inverse(&stresses[lane]).0;
                stresses[lane] =
                    self.stiffness.neo_hookean_stress(&deformation, ratios[lane], logarithms[lane]);
            }
            put_block(&mut points.effective_stress, block, &stresses);
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
                for (ratio, dilation) in ratios.iter_mut().zip(&dilations) {
                    *ratio *= stretch_of(*dilation);
                }
            }
        }
        put_block(&mut points.volume_ratio, block, &ratios);
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
        let mut stresses = block_of(&points.effective_stress, block, [[0.0; D]; D]);
        if self.deforms && D > 1 {
            for (stress, increment) in stresses.iter_mut().zip(&increments) {
                *stress = rotated(stress, increment);
            }
        }
        for lane in 0..LANES {
            let modulus = self.law.modulus_ratio(before[lane], ratios[lane]);
            for d in 0..D {
                for e in 0..D {
                    stresses[lane][d][e] += modulus * changes[lane][d][e];
                }
            }
        }
        put_block(&mut points.effective_stress, block, &stresses);
    }
}

/// Volume ratios of a block of points, exact in the logarithmic strain, and what follows them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn deform<const D: usize>(
    points: &mut Points<D>,
    block: &Range<usize>,
    following: Following,
    increments: &[Tensor<D>; LANES],
    ratios: &mut Lanes,
) {
    let mut strains = [[0.0; D]; LANES];
    for (strain, increment) in strains.iter_mut().zip(increments) {
        for d in 0..D {
            strain[d] = increment[d][d];
        }
    }
    let stretches = stretches_of(&strains);
    if following.takes_domain() {
        let mut half_lengths = block_of(&points.half_length, block, [0.0; D]);
        for (half_length, stretch) in half_lengths.iter_mut().zip(&stretches) {
            for d in 0..D {
                half_length[d] *= stretch[d];
            }
        }
        put_block(&mut points.half_length, block, &half_lengths);
    }
    if following.takes_inverse() {
        for (inverse, increment) in points.inverse_deformation[block.clone()].iter_mut().zip(increments) {
            *inverse = relaxed(inverse, increment);
        }
    }
    for (ratio, stretch) in ratios.iter_mut().zip(&stretches) {
        *ratio *= stretch.iter().product::<f64>();
    }
}
