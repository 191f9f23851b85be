//! From nodal velocities to the stresses of the points: strains, volumes, domains, and what the law makes of them.
//!
//! Some neighbouring points are taken side by side: each line of the algorithm is a loop over them, without a branch,
//! that the compiler turns into one over registers.

use crate::body::Body;
use crate::explicit::deformation::{Following, middle_gradient, relaxed, rotated, stretch_of, stretches_of};
use crate::method::Configuration;
use crate::operators::block_rows::{BlockRows, Blocks};
use crate::operators::stencil::with_stencils;
use crate::operators::strain_gradient::StrainOperator;
use crate::state::lanes::{FOUR, some_mut, some_of};
use crate::state::points::Points;
use crate::wide::wide;
use oedometer_soil::elementary::ln_of_each;
use oedometer_soil::law::{Law, Stiffness};
use oedometer_soil::tensor::{Tensor, Vector, inverse, product};

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
        let strained = Strained { stride, field, dt, is_total, is_at_middle, dilation_rates, update };
        let count = self.points.len();
        let whole = count / FOUR * FOUR;
        for first in (0..whole).step_by(FOUR) {
            strained.strain::<FOUR, W>(stencils.four(first), 0, first, &mut self.points);
        }
        for point in whole..count {
            strained.strain::<1, W>(stencils.four(whole), point - whole, point, &mut self.points);
        }
    }

    /// Volume ratio, exact in the logarithmic strain, and the domain where it follows.
    pub(crate) fn deform(&mut self, point: usize, increment: &Tensor<D>) {
        let mut ratio = [self.points.volume_ratio[point]];
        let following = self.following();
        deform(&mut self.points, point, following, &[*increment], &mut ratio);
        [self.points.volume_ratio[point]] = ratio;
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

/// What strains the points.
struct Strained<'a, const D: usize> {
    stride: [usize; D],
    /// Nodal velocity of the skeleton, m/s.
    field: &'a [Vector<D>],
    dt: f64,
    is_total: bool,
    is_at_middle: bool,
    dilation_rates: Option<&'a [f64]>,
    update: StressUpdate,
}

impl<const D: usize> Strained<'_, D> {
    /// Strains `N` points from a first one on, which is a lane of the rows.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn strain<const N: usize, const W: usize>(
        &self,
        rows: BlockRows<'_, D, W>,
        lane: usize,
        first: usize,
        points: &mut Points<D>,
    ) {
        let dt = self.dt;
        let mut gradients = rows.gradients::<N>(&self.stride, lane, self.field);
        if self.is_total {
            let inverse = some_of::<_, N>(&points.inverse_deformation, first);
            for point in 0..N {
                gradients[point] = product(&gradients[point], &inverse[point]);
            }
        }
        if self.is_at_middle {
            for gradient in &mut gradients {
                *gradient = middle_gradient(gradient, dt);
            }
        }
        let mut increments = gradients;
        for increment in increments.as_flattened_mut().as_flattened_mut() {
            *increment *= dt;
        }
        let mut dilations = None;
        if let Some(rates) = self.dilation_rates {
            let mut of_points = *some_of::<_, N>(rates, first);
            for point in 0..N {
                let trace: f64 = (0..D).map(|d| gradients[point][d][d]).sum();
                of_points[point] = dt * (of_points[point] - trace);
            }
            dilations = Some(of_points);
        }
        self.update.apply(points, first, increments, dilations);
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
    /// Volumes, domains and stresses of some points, from a first one on, from their increments of the displacement gradient, and
    /// from what B-bar adds to their volumes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn apply<const D: usize, const N: usize>(
        &self,
        points: &mut Points<D>,
        first: usize,
        mut increments: [Tensor<D>; N],
        dilations: Option<[f64; N]>,
    ) {
        let before = *some_of::<_, N>(&points.volume_ratio, first);
        let mut ratios = before;
        if self.deforms {
            deform(points, first, self.following, &increments, &mut ratios);
        }
        if self.law.is_hyperelastic() {
            *some_mut(&mut points.volume_ratio, first) = ratios;
            let logarithms = ln_of_each(&ratios);
            let inverses = some_of::<_, N>(&points.inverse_deformation, first);
            let stresses = some_mut::<_, N>(&mut points.effective_stress, first);
            for point in 0..N {
                let deformation = inverse(&inverses[point]).0;
                stresses[point] =
                    self.stiffness.neo_hookean_stress(&deformation, ratios[point], logarithms[point]);
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
                for (ratio, dilation) in ratios.iter_mut().zip(&dilations) {
                    *ratio *= stretch_of(*dilation);
                }
            }
        }
        *some_mut(&mut points.volume_ratio, first) = ratios;
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
        let stresses = some_mut::<_, N>(&mut points.effective_stress, first);
        if self.deforms && D > 1 {
            *stresses = rotated(stresses, &increments);
        }
        for point in 0..N {
            let modulus = self.law.modulus_ratio(before[point], ratios[point]);
            for d in 0..D {
                for e in 0..D {
                    stresses[point][d][e] += modulus * changes[point][d][e];
                }
            }
        }
    }
}

/// Volume ratios of some points, exact in the logarithmic strain, and what follows them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn deform<const D: usize, const N: usize>(
    points: &mut Points<D>,
    first: usize,
    following: Following,
    increments: &[Tensor<D>; N],
    ratios: &mut [f64; N],
) {
    let mut strains = [[0.0; D]; N];
    for (strain, increment) in strains.iter_mut().zip(increments) {
        for d in 0..D {
            strain[d] = increment[d][d];
        }
    }
    let stretches = stretches_of(&strains);
    if following.takes_domain() {
        let half_lengths = some_mut::<_, N>(&mut points.half_length, first);
        for (half_length, stretch) in half_lengths.iter_mut().zip(&stretches) {
            for d in 0..D {
                half_length[d] *= stretch[d];
            }
        }
    }
    if following.takes_inverse() {
        for (inverse, increment) in points.inverse_deformation[first..first + N].iter_mut().zip(increments) {
            *inverse = relaxed(inverse, increment);
        }
    }
    for (ratio, stretch) in ratios.iter_mut().zip(&stretches) {
        *ratio *= stretch.iter().product::<f64>();
    }
}
