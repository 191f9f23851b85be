//! A point's strain and the logarithm of its stretch, kept from one residual of a step to the next.

use oedometer_soil::elementary::ln;
use oedometer_soil::tensor::Tensor;

/// Change of a stretch from one whose logarithm is known below which a series has its logarithm: what four terms leave out is
/// less than round-off.
const NEAR: f64 = 1e-4;

/// The strain that a point has, since the anchor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointStrain<const D: usize> {
    /// Gradient of the displacement, and its trace of a B-bar method.
    pub gradient: Tensor<D>,
    pub trace: f64,
}

impl<const D: usize> PointStrain<D> {
    /// A strain that no strain is equal to.
    pub const UNKNOWN: Self = Self { gradient: [[f64::NAN; D]; D], trace: f64::NAN };
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
    pub fn ln(&mut self, stretch: f64) -> f64 {
        let [known, logarithm] = self.0;
        let change = (stretch - known) / known;
        if change.abs() < NEAR {
            return logarithm + change * (1.0 - change * (0.5 - change * (1.0 / 3.0 - 0.25 * change)));
        }
        self.0 = [stretch, ln(stretch)];
        self.0[1]
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
