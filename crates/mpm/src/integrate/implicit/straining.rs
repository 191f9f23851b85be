//! From trial displacements at the nodes to deformation and effective stress of the points.

use crate::integrate::implicit::point_strain::PointStrain;
use crate::integrate::implicit::trial::Trial;
use crate::kernel::stresses::assumed;
use crate::operators::stencil::{Stencils, with_stencils};
use crate::operators::strain_gradient::StrainOperator;
use crate::wide::wide;
use oedometer_soil::law::StrainIncrement;
use oedometer_soil::tensor::{Tensor, identity, inverse, product, strain_between};

impl<const D: usize> Trial<D> {
    /// Deformation and effective stress of all points under the present displacement of the nodes; with B-bar, what
    /// it has in the place of the trace of each point's gradient. Whether any strain has changed since the last call.
    pub(super) fn strain_points(&mut self, traces: &[f64]) -> bool {
        let body = &mut self.body;
        let (basis, strain) =
            (std::mem::take(&mut body.operators.basis), std::mem::take(&mut body.operators.strain));
        let has_changed = match &strain {
            StrainOperator::Basis => {
                with_stencils!(&basis, stencils => wide!(self.strain_points_by(stencils, traces)))
            }
            StrainOperator::Composite(stencils) => wide!(self.strain_points_by(stencils, traces)),
            StrainOperator::BetweenEnds(stencils) => wide!(self.strain_points_by(stencils, traces)),
        };
        (self.body.operators.basis, self.body.operators.strain) = (basis, strain);
        has_changed
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loop of an implicit step")]
    fn strain_points_by<const W: usize>(&mut self, stencils: &Stencils<D, W>, traces: &[f64]) -> bool {
        let (stride, laws) = (*self.body.grid.node_stride(), &self.body.stress_laws[..]);
        let is_hyperelastic = self.body.material.law.is_hyperelastic();
        let (deforms, moves) = (self.body.configuration.deforms(), self.body.configuration.moves_points());
        let points = &mut self.body.points;
        let count = self.anchor.len();
        let stencils = stencils.slices(count);
        let (anchor_ratio, anchor_stress) =
            (&self.anchor.volume_ratio[..count], &self.anchor.effective_stress[..count]);
        let (anchor_deformation, carried) = (&self.anchor_deformation[..count], &self.carried[..count]);
        let (strained_for, stretches) = (&mut self.strained[..count], &mut self.stretches[..count]);
        let (inverse_deformation, volume_ratio) =
            (&mut points.inverse_deformation[..count], &mut points.volume_ratio[..count]);
        let (effective_stress, soil) = (&mut points.effective_stress[..count], &points.soil[..count]);
        // Of the kinematics of a B-bar method only the volume goes the way of the water's, as in the explicit step. A domain
        // that did so would keep its length where points move apart, and nothing would resist that (docs/methods.md).
        let splits_motion = moves && !traces.is_empty();
        let mut has_changed = false;
        for point in 0..count {
            let mut gradient = stencils.of_point(point).gradient(&stride, &self.displacement);
            let mut dilation = 0.0;
            let trace = traces.get(point);
            let strained = PointStrain { gradient, trace: trace.copied().unwrap_or(0.0) };
            if strained_for[point] == strained {
                continue;
            }
            strained_for[point] = strained;
            has_changed = true;
            let motion = gradient;
            if let Some(trace) = trace {
                dilation = trace - (0..D).map(|d| gradient[d][d]).sum::<f64>();
                for d in 0..D {
                    gradient[d][d] += dilation / D as f64;
                }
            }
            let start = anchor_ratio[point];
            let mut strain = StrainIncrement { gradient, dilation, volume_ratio: [start; 2] };
            let (mut deformation, mut moved) = (identity(), identity());
            if deforms {
                let before = &anchor_deformation[point];
                let after = sum(before, &gradient);
                let volume;
                if splits_motion {
                    moved = sum(before, &motion);
                    inverse_deformation[point] = inverse(&moved).0;
                    volume = inverse(&after).1;
                } else {
                    (inverse_deformation[point], volume) = inverse(&after);
                }
                let stretch = volume / inverse(before).1;
                volume_ratio[point] = start * stretch;
                strain.volume_ratio[1] = start * stretch;
                deformation = after;
                if !is_hyperelastic {
                    strain.gradient = strain_between(before, &after, stretches[point].ln(stretch));
                }
            }
            let mut stress = anchor_stress[point];
            let mut history = self.anchor.history.get(point).copied().unwrap_or_default();
            let law = &laws[usize::from(soil[point])];
            law.update(&mut stress, &mut history, &strain, || {
                if !splits_motion {
                    return product(&deformation, &carried[point]);
                }
                let whole = product(&moved, &carried[point]);
                assumed(&whole, volume_ratio[point] / inverse(&whole).1)
            });
            effective_stress[point] = stress;
            if let Some(kept) = points.history.get_mut(point) {
                *kept = history;
            }
        }
        has_changed
    }
}

fn sum<const D: usize>(a: &Tensor<D>, b: &Tensor<D>) -> Tensor<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j]))
}
