//! From trial displacements at the nodes to deformation and effective stress of the points.

use crate::implicit::trial::Trial;
use crate::operators::stencil::{Stencils, with_stencils};
use crate::operators::strain_gradient::StrainOperator;
use crate::wide::wide;
use oedometer_soil::elementary;
use oedometer_soil::law::StrainIncrement;
use oedometer_soil::tensor::{identity, inverse, product, strain_between};

impl<const D: usize> Trial<D> {
    /// Deformation and effective stress of all points under the present displacement of the nodes; with B-bar, what
    /// it has in the place of the trace of each point's gradient.
    pub(super) fn strain_points(&mut self, traces: &[f64]) {
        let body = &mut self.body;
        let (basis, strain) = (std::mem::take(&mut body.basis), std::mem::take(&mut body.strain));
        match &strain {
            StrainOperator::Basis => {
                with_stencils!(&basis, stencils => wide!(self.strain_points_by(stencils, traces)));
            }
            StrainOperator::Composite(stencils) => wide!(self.strain_points_by(stencils, traces)),
            StrainOperator::BetweenEnds(stencils) => wide!(self.strain_points_by(stencils, traces)),
        }
        (self.body.basis, self.body.strain) = (basis, strain);
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loop of an implicit step")]
    fn strain_points_by<const W: usize>(&mut self, stencils: &Stencils<D, W>, traces: &[f64]) {
        let (stride, laws) = (*self.body.grid.node_stride(), &self.body.stress_laws[..]);
        let is_hyperelastic = self.body.material.law.is_hyperelastic();
        let (deforms, points) = (self.body.configuration.deforms(), &mut self.body.points);
        for point in 0..self.anchor.len() {
            let mut gradient = stencils.of_point(point).gradient(&stride, &self.displacement);
            let mut dilation = 0.0;
            if let Some(trace) = traces.get(point) {
                dilation = trace - (0..D).map(|d| gradient[d][d]).sum::<f64>();
                for d in 0..D {
                    gradient[d][d] += dilation / D as f64;
                }
            }
            let start = self.anchor.volume_ratio[point];
            let mut strain = StrainIncrement { gradient, dilation, volume_ratio: [start; 2] };
            let mut deformation = identity();
            if deforms {
                let before = &self.anchor_deformation[point];
                let after = std::array::from_fn(|i| std::array::from_fn(|j| before[i][j] + gradient[i][j]));
                let (inverse_after, volume) = inverse(&after);
                let stretch = volume / inverse(before).1;
                points.inverse_deformation[point] = inverse_after;
                points.volume_ratio[point] = start * stretch;
                strain.volume_ratio[1] = start * stretch;
                deformation = after;
                if !is_hyperelastic {
                    strain.gradient = strain_between(before, &after, elementary::ln(stretch));
                }
            }
            let mut stress = self.anchor.effective_stress[point];
            let mut history = self.anchor.history.get(point).copied().unwrap_or_default();
            let law = &laws[usize::from(points.soil[point])];
            law.update(&mut stress, &mut history, &strain, || product(&deformation, &self.carried[point]));
            points.effective_stress[point] = stress;
            if let Some(kept) = points.history.get_mut(point) {
                *kept = history;
            }
        }
    }
}
