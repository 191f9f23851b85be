//! The hydraulic conductivity as a function of the volume, and its mean for the drag of a node: add another `k(n)`
//! here.

use crate::elementary;
use crate::law::Law;
use crate::wording::words;

/// Mean of the hydraulic conductivity at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ConductivityMean {
    /// Every point gives its own drag `n γ_w V/k` (Zheng et al.): a harmonic mean, which errs by 39 % in the
    /// first flux at the surface of a soil that a load at once shortens by half.
    #[default]
    Points,
    /// The chord mean of Kirchhoff's potential, docs/theory.md, Eq. 17: a flux that is a difference of
    /// potentials is exact, and a load at once keeps second order.
    Chord,
}

words!(ConductivityMean: Points "points", Chord "chord");

impl Law {
    /// Hydraulic conductivity, m/s, at volume ratio `J` from the initial one (docs/theory.md, section 2).
    #[inline]
    pub fn conductivity(self, initial: f64, volume_ratio: f64) -> f64 {
        match self {
            Self::Linear | Self::Preconsolidated | Self::VonMises => initial,
            Self::LogLinear | Self::PorosityDependent | Self::Engineering | Self::NeoHookean => {
                initial * volume_ratio * volume_ratio
            }
        }
    }

    /// `κ(J) = k/J` over the initial conductivity: the flux that a pressure gradient with respect to the initial
    /// coordinates drives.
    #[inline]
    pub fn mobility_ratio(self, volume_ratio: f64) -> f64 {
        self.conductivity(1.0, volume_ratio) / volume_ratio
    }

    /// Kirchhoff's potential `Φ` at the engineering strain `J − 1`, `dΦ = κ dσ'` over `k_0 E_oed`, zero in the
    /// initial state; in closed form for every law for columns, NaN for others.
    #[inline]
    pub fn flow_potential(self, strain: f64) -> f64 {
        match self {
            // κ = 1/J, dσ' = dJ/J
            Self::Linear | Self::Preconsolidated | Self::VonMises => strain / (1.0 + strain),
            // κ = J, dσ' = dJ/J
            Self::LogLinear | Self::Engineering => strain,
            // κ = J, dσ' = dJ/J²
            Self::PorosityDependent => elementary::ln_1p(strain),
            Self::NeoHookean => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `∫ κ dσ'` by Gauss's rule of two points on many intervals of the stress.
    fn potential_by_quadrature(law: Law, compression: f64) -> f64 {
        let intervals = 400;
        let width = compression / f64::from(intervals);
        let mut sum = 0.0;
        for interval in 0..intervals {
            for along in [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8] {
                let stress = (f64::from(interval) + 0.5 + 0.5 * along) * width;
                sum -= 0.5 * width * law.mobility_ratio(1.0 + law.strain_under(stress));
            }
        }
        sum
    }

    #[test]
    fn the_potential_is_the_integral_of_the_mobility_over_the_stress() {
        for law in Law::for_columns() {
            for compression in [-0.2, 1e-6, 0.1, 0.7] {
                let strain = law.strain_under(compression);
                assert!((law.uniaxial_stress_ratio(strain) + compression).abs() < 1e-15, "{law:?}");
                let exact = potential_by_quadrature(law, compression);
                assert!(
                    (law.flow_potential(strain) - exact).abs() < 1e-12 * exact.abs(),
                    "{law:?} {compression}"
                );
            }
        }
    }

    #[test]
    fn the_chord_of_the_published_material_is_the_logarithmic_mean() {
        // J from 1 to 1/2: 0.721 where the mean of the drags is 0.667.
        let law = Law::LogLinear;
        let chord = law.flow_potential(-0.5) / law.uniaxial_stress_ratio(-0.5);
        assert!((chord - 0.721_347_520_444_481_7).abs() < 1e-15);
    }
}
