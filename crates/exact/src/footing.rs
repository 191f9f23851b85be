//! A rigid strip footing on weightless undrained soil: the load at which it collapses.
//!
//! Under a rigid strip of width `B`, rough or smooth, a soil of the shear strength `c_u` collapses at
//!
//! ```text
//! F = (2 + π) B c_u
//! ```
//!
//! (Prandtl 1920): the fan of slip lines between the wedge under the strip and those beside it turns the principal stresses
//! by a right angle, which adds `π c_u` to the `2 c_u` of the surface, and the stress field goes on into the soil without
//! yielding (Shield 1954; Bishop 1953), so that bounds from both sides meet. The fields under it are not unique.

use crate::exact_error::{ExactError, checked_time_factor, positive};
use crate::inputs::LAW_KEY;
use crate::parameters::ColumnParameters;
use crate::row::{Changes, Row};
use crate::solution::{Accuracy, FieldValues, Solution};

/// The row of the solution.
pub(crate) static FOOTING: Row = Row {
    name: "footing",
    words: "Prandtl's load at collapse",
    inputs: &[LAW_KEY, &["plate_width"]],
    changes: Changes::Still,
    ..Row::COLUMN
};

/// `F/(B c_u)` at collapse.
pub const LOAD_FACTOR: f64 = 2.0 + std::f64::consts::PI;

/// A footing that settles by its own width in the time of `T_v = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footing {
    width: f64,
}

impl Footing {
    /// The footing of a layer.
    ///
    /// # Errors
    /// When the layer's numbers are impossible.
    pub fn new(layer: &ColumnParameters) -> Result<Self, ExactError> {
        layer.validate()?;
        positive("width of the plate", layer.plate_width)?;
        Ok(Self { width: layer.plate_width })
    }
}

impl Solution for Footing {
    /// None: the load is unique at collapse, the fields are not.
    fn fields(&self, _: f64, _: f64) -> Result<FieldValues, ExactError> {
        Err(ExactError::NoFields)
    }

    /// Settlement of the plate, m.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|factor| factor * self.width)
    }

    /// Width of the plate as the scale of settlements: a footing at collapse settles without limit.
    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.width)
    }

    /// Exact.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        checked_time_factor(time_factor).map(|_| Accuracy::new(0, 0.0))
    }
}
