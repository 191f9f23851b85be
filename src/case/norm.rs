//! Norms by name, with their formulas.

use oedometer_soil::wording::words;

use std::fmt;

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
