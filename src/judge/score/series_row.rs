//! A series of errors over meshes as programs read it.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};

/// A series as programs read it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SeriesRow {
    /// Time factor of the group.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// In which norm.
    pub norm: Norm,
    /// Against which reference.
    pub reference: String,
    /// Cells over the height, coarsest first.
    pub cells: Vec<usize>,
    /// Errors on these meshes; none where a result lacks it.
    pub errors: Vec<Option<f64>>,
    /// Order, where the class allows one.
    pub order: Option<f64>,
    /// Class.
    pub class: &'static str,
    /// Why.
    pub reason: String,
}
