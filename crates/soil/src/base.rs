//! The contact of a body of soil with what is under it.

use crate::wording::words;

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
