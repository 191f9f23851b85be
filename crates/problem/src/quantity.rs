//! What is measured, where, and in which norm.

use crate::snapshot::{Samples, Snapshot};
use oedometer_wording::words;
use std::fmt;

/// A measured quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Excess pore pressure.
    #[default]
    Pressure,
    /// Vertical effective stress.
    EffectiveStress,
    /// Vertical displacement of the skeleton.
    Displacement,
    /// Settlement of the surface.
    Settlement,
    /// Load of a footing over its width and the strength of the soil.
    LoadFactor,
}

words!(
    Quantity:
    Pressure "pressure", EffectiveStress "effective_stress", Displacement "displacement",
    Settlement "settlement", LoadFactor "load_factor",
);

impl Quantity {
    /// Whether it is one number, of the surface.
    pub fn is_of_surface(self) -> bool {
        matches!(self, Self::Settlement | Self::LoadFactor)
    }

    /// The norm in which it is reported first.
    pub fn first_norm(self) -> Norm {
        if self.is_of_surface() { Norm::Relative } else { Norm::L2 }
    }

    /// Its field among samples; `None` for what is of the surface.
    pub fn field(self, samples: &Samples) -> Option<&[f64]> {
        match self {
            Self::Pressure => Some(&samples.pressure),
            Self::EffectiveStress => Some(&samples.effective_stress),
            Self::Displacement => Some(&samples.displacement),
            Self::Settlement | Self::LoadFactor => None,
        }
    }
}

/// Where a quantity is sampled: it decides the order that is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sample {
    /// At the material points.
    Points,
    /// Means of cells at their centres.
    Centres,
    /// At the nodes.
    Nodes,
    /// At the loaded surface.
    Surface,
}

words!(Sample: Points "points", Centres "centres", Nodes "nodes", Surface "surface");

impl Sample {
    /// The samples of a state; the surface has none but its settlement.
    pub fn samples(self, snapshot: &Snapshot) -> Option<&Samples> {
        match self {
            Self::Points => Some(&snapshot.points),
            Self::Centres => Some(&snapshot.centres),
            Self::Nodes => Some(&snapshot.nodes),
            Self::Surface => None,
        }
    }
}

/// How the error of a field is turned into one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Norm {
    /// Mean of the absolute error over the volume.
    L1,
    /// Root of the mean squared error over the volume.
    L2,
    /// Largest absolute error among the samples; weights only decide which samples count.
    Linf,
    /// Relative error of a single number, such as a settlement.
    Relative,
}

words!(Norm: L1 "l1", L2 "l2", Linf "linf", Relative "relative");

impl Norm {
    /// Formula of the relative form, for reports; `x` computed, `x̂` exact, `V` volume.
    pub const fn formula(self) -> &'static str {
        match self {
            Self::L1 => "Σ V|x − x̂| / Σ V|x̂|",
            Self::L2 => "√(Σ V(x − x̂)²) / √(Σ V x̂²)",
            Self::Linf => "max|x − x̂| / max|x̂|",
            Self::Relative => "|x − x̂| / |x̂|",
        }
    }
}

impl fmt::Display for Norm {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_norm_has_the_formula_of_its_name() {
        let of_l2 = "√(Σ V(x − x̂)²) / √(Σ V x̂²)";
        let formulas = ["Σ V|x − x̂| / Σ V|x̂|", of_l2, "max|x − x̂| / max|x̂|", "|x − x̂| / |x̂|"];
        assert_eq!(Norm::ALL.map(Norm::formula), formulas);
        assert_eq!(Norm::ALL.map(|norm| format!("{norm:>5}")), ["   l1", "   l2", " linf", "relative"]);
        assert_eq!(Quantity::ALL.map(Quantity::is_of_surface), [false, false, false, true, true]);
    }
}
