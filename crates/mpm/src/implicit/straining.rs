//! From trial displacements at the nodes to deformation and effective stress of the points.
//!
//! Some neighbouring points are taken side by side, as in explicit steps: each line is a loop over them, without a
//! branch, that the compiler turns into one over registers.

use crate::implicit::trial::Trial;
use crate::operators::block_rows::Blocks;
use crate::operators::stencil::with_stencils;
use crate::operators::strain_gradient::StrainOperator;
use crate::state::lanes::{LANES, block_of, blocks_of, put_block};
use crate::wide::wide;
use oedometer_soil::elementary::ln_of_each;
use oedometer_soil::tensor::{Tensor, Vector, identity, inverse, product, strain_between};
use std::ops::Range;

/// What some points undergo since the anchor.
struct Increments<const D: usize> {
    /// Gradients of their displacements.
    gradients: [Tensor<D>; LANES],
    /// What B-bar adds to their volumes.
    dilations: [f64; LANES],
}

impl<const D: usize> Trial<D> {
    /// Deformation and effective stress of all points under the present displacement of the nodes; with B-bar, what
    /// it has in the place of the trace of each point's gradient.
    pub(super) fn strain_points(&mut self, traces: &[f64]) {
        for block in blocks_of(self.anchor.len()) {
            let mut increments = Increments { gradients: self.gradients_of(&block), dilations: [0.0; LANES] };
            for (lane, trace) in traces.iter().skip(block.start).take(block.len()).enumerate() {
                let gradient = &mut increments.gradients[lane];
                let dilation = trace - (0..D).map(|d| gradient[d][d]).sum::<f64>();
                for d in 0..D {
                    gradient[d][d] += dilation / D as f64;
                }
                increments.dilations[lane] = dilation;
            }
            wide!(self.strain_block(&block, &increments));
        }
    }

    /// Gradients of the displacement at a block of points.
    fn gradients_of(&self, block: &Range<usize>) -> [Tensor<D>; LANES] {
        let stride = self.body.grid.node_stride();
        match &self.body.strain {
            StrainOperator::Basis => with_stencils!(&self.body.basis, stencils => {
                wide!(gradients(stencils.blocks(), stride, block, &self.displacement))
            }),
            StrainOperator::Composite(stencils) => {
                wide!(gradients(stencils.blocks(), stride, block, &self.displacement))
            }
            StrainOperator::BetweenEnds(stencils) => {
                wide!(gradients(stencils.blocks(), stride, block, &self.displacement))
            }
        }
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn strain_block(&mut self, block: &Range<usize>, increments: &Increments<D>) {
        let (law, stiffness) = (self.body.material.law, self.body.stiffness);
        let (mut strains, mut moduli) = (increments.gradients, [1.0; LANES]);
        if self.body.configuration.deforms() {
            let (before, after, stretches) = self.deform_block(block, &increments.gradients);
            let start = block_of(&self.anchor.volume_ratio, block, 1.0);
            let mut ratios = start;
            for lane in 0..LANES {
                ratios[lane] *= stretches[lane];
            }
            put_block(&mut self.body.points.volume_ratio, block, &ratios);
            if law.is_hyperelastic() {
                let carried = block_of(&self.carried, block, identity());
                let logarithms = ln_of_each(&ratios);
                for lane in 0..LANES {
                    let whole = product(&after[lane], &carried[lane]);
                    strains[lane] = stiffness.neo_hookean_stress(&whole, ratios[lane], logarithms[lane]);
                }
                put_block(&mut self.body.points.effective_stress, block, &strains);
                return;
            }
            let logarithms = ln_of_each(&stretches);
            for lane in 0..LANES {
                strains[lane] = strain_between(&before[lane], &after[lane], logarithms[lane]);
                moduli[lane] = law.modulus_ratio(start[lane], ratios[lane]);
            }
        }
        let mut stresses = block_of(&self.anchor.effective_stress, block, [[0.0; D]; D]);
        for lane in 0..LANES {
            let mut change = stiffness.stress(&strains[lane]);
            for i in 0..D {
                change[i][i] += stiffness.shared_dilation_stress::<D>(increments.dilations[lane]);
            }
            for i in 0..D {
                for j in 0..D {
                    stresses[lane][i][j] += moduli[lane] * change[i][j];
                }
            }
        }
        put_block(&mut self.body.points.effective_stress, block, &stresses);
    }

    /// Deformation gradients of a block of points in the anchored state and now, and how much the volumes grew
    /// between; the points keep the inverse of the present one.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn deform_block(
        &mut self,
        block: &Range<usize>,
        gradients: &[Tensor<D>; LANES],
    ) -> ([Tensor<D>; LANES], [Tensor<D>; LANES], [f64; LANES]) {
        let before = block_of(&self.anchor_deformation, block, identity());
        let (mut after, mut inverses, mut stretches) = (before, before, [1.0; LANES]);
        for lane in 0..LANES {
            for i in 0..D {
                for j in 0..D {
                    after[lane][i][j] += gradients[lane][i][j];
                }
            }
            let (inverse_after, volume) = inverse(&after[lane]);
            inverses[lane] = inverse_after;
            stretches[lane] = volume / inverse(&before[lane]).1;
        }
        put_block(&mut self.body.points.inverse_deformation, block, &inverses);
        (before, after, stretches)
    }
}

/// Gradients of a nodal field at a block of points; zero in the place of those that there are not.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn gradients<const D: usize, const W: usize>(
    stencils: Blocks<'_, D, W>,
    stride: &[usize; D],
    block: &Range<usize>,
    field: &[Vector<D>],
) -> [Tensor<D>; LANES] {
    let rows = stencils.block(block.start / LANES);
    let mut gradients = [[[0.0; D]; D]; LANES];
    for (lane, gradient) in gradients.iter_mut().take(block.len()).enumerate() {
        *gradient = rows.gradient(stride, lane, field);
    }
    gradients
}
