//! What Mandel's slab depends on, and what its fields are made of.

use crate::parameters::ColumnParameters;

/// What the problem depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Groups {
    /// Poisson's ratio `ν`, drained.
    pub(super) poissons_ratio: f64,
    /// `κ = (ν_u − ν)/(1 − ν)`: between 0, where the skeleton keeps its volume or the water carries
    /// nothing, and 3/4.
    pub(super) kappa: f64,
    /// Pressure at once over the mean stress, `B (1 + ν_u)/3`.
    pub(super) start: f64,
    /// `B_1 = Q/(Q + E_oed)`: what `c` is of `c_v`.
    pub(super) storage_ratio: f64,
}

/// Fields over what makes them pure numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MandelRatios {
    /// `p a/F`.
    pub pressure: f64,
    /// `−σ_yy a/F`, of the total stress across the plates.
    pub stress: f64,
    /// `u_x G/F`, towards the drained sides.
    pub displacement: f64,
    /// `−ε_yy G a/F`, the same everywhere: what the plates have come together.
    pub strain: f64,
}

/// Sums over the roots at one time and place, by whichever way they are found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    /// `Σ sin α cos α/d e^{−α²T}`.
    pub(super) mean: f64,
    /// `Σ sin α/d cos(α x) e^{−α²T}`.
    pub(super) wave: f64,
    /// `Σ cos α/d sin(α x) e^{−α²T}`.
    pub(super) slope: f64,
}

impl Groups {
    /// Written so that nothing cancels: with `m = (1 − 2ν) B_1`, `κ = m/(1 + m)`.
    pub(super) fn of(parameters: &ColumnParameters) -> Self {
        let (nu, storage_ratio) = (parameters.poissons_ratio, parameters.storage_ratio());
        let carried = (1.0 - 2.0 * nu) * storage_ratio;
        Self {
            poissons_ratio: nu,
            kappa: carried / (1.0 + carried),
            start: storage_ratio * (1.0 - nu) / (1.0 + carried),
            storage_ratio,
        }
    }

    /// `1 − ν_u` over `1 − ν`.
    pub(super) fn undrained_share(&self) -> f64 {
        1.0 - self.kappa
    }
}

impl MandelRatios {
    /// The ratios of sums over the roots, docs/theory.md, Eq. 16.
    pub(super) fn of(groups: &Groups, distance: f64, sums: Sums) -> Self {
        let Groups { poissons_ratio: nu, kappa, start, .. } = *groups;
        let undrained = nu + kappa * (1.0 - nu);
        Self {
            pressure: 2.0 * start * (sums.wave - sums.mean),
            stress: 1.0 + 2.0 * kappa * sums.wave - 2.0 * sums.mean,
            displacement: (0.5 * nu - undrained * sums.mean) * distance + sums.slope,
            strain: (1.0 - nu) * (0.5 - groups.undrained_share() * sums.mean),
        }
    }
}
