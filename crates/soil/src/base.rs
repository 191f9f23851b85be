//! The contact of a body of soil with what is under it.

use oedometer_wording::words;

/// How a layer rests on its impermeable base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Base {
    /// No displacement.
    #[default]
    Rough,
    /// No vertical displacement and no shear.
    Smooth,
}

words!(Base: Rough "rough", Smooth "smooth");

/// Which ends of a column let the water out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Drainage {
    /// The top only, on an impermeable base.
    #[default]
    Top,
    /// Top and base.
    Both,
}

words!(Drainage: Top "top", Both "both");
