//! From trial displacements at the nodes to deformation and effective stress of the points.

use crate::integrate::implicit::trial::Trial;
use crate::operators::stencil::{Stencils, with_stencils};
use crate::operators::strain_gradient::StrainOperator;
use crate::wide::wide;
use oedometer_soil::elementary::ln;
use oedometer_soil::law::StrainIncrement;
use oedometer_soil::tensor::{Tensor, identity, inverse, product, strain_between};

/// Change of a stretch from one whose logarithm is known below which a series has its logarithm: what four terms leave out is
/// less than round-off.
const NEAR: f64 = 1e-4;

/// The strain that a point has, since the anchor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointStrain<const D: usize> {
    /// Gradient of the displacement, and its trace of a B-bar method.
    gradient: Tensor<D>,
    trace: f64,
}

/// A stretch and its logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KnownStretch([f64; 2]);

impl Default for KnownStretch {
    fn default() -> Self {
        Self([1.0, 0.0])
    }
}

impl KnownStretch {
    /// Logarithm of a stretch: by a series where it is near the one that is known, which it replaces elsewhere.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the innermost loop of an implicit step")]
    fn ln(&mut self, stretch: f64) -> f64 {
        let [known, logarithm] = self.0;
        let change = (stretch - known) / known;
        if change.abs() < NEAR {
            return logarithm + change * (1.0 - change * (0.5 - change * (1.0 / 3.0 - 0.25 * change)));
        }
        self.0 = [stretch, ln(stretch)];
        self.0[1]
    }
}

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
        let (deforms, points) = (self.body.configuration.deforms(), &mut self.body.points);
        let mut has_changed = false;
        for point in 0..self.anchor.len() {
            let mut gradient = stencils.of_point(point).gradient(&stride, &self.displacement);
            let mut dilation = 0.0;
            let trace = traces.get(point);
            let strained = Some(PointStrain { gradient, trace: trace.copied().unwrap_or(0.0) });
            if self.strained[point] == strained {
                continue;
            }
            self.strained[point] = strained;
            has_changed = true;
            if let Some(trace) = trace {
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
                    strain.gradient = strain_between(before, &after, self.stretches[point].ln(stretch));
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
        has_changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_near_a_known_one_are_those_of_the_library() {
        let mut known = KnownStretch::default();
        for stretch in [1.0, 1.0 + 9e-5, 1.0 - 9.9e-5, 0.4, 0.4 + 1e-7, 0.4 - 3.9e-5, 1.7, 1.7 + 1.6e-4] {
            let (got, exact) = (known.ln(stretch), ln(stretch));
            assert!((got - exact).abs() <= 2.5e-16 * exact.abs().max(1.0), "{stretch}: {got} for {exact}");
        }
        assert_eq!(known.0[0], 1.7, "a stretch nearby is not kept");
    }
}
