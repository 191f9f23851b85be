//! The mean of the hydraulic conductivity for the drag of a node.

use oedometer_wording::words;

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
