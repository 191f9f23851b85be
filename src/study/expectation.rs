//! What a study expects of its own results: which series, and what of it.

use crate::case::Case;
use crate::case::keys::{Choice, Key, Value};
use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::record::{ErrorRow, Record};
use oedometer_convergence::SeriesDemand as Demand;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::method::Method;
use oedometer_soil::wording::typed;
use oedometer_soil::wording::words;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What is refined along a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// Cell size, by the number of cells.
    Cells,
    /// Size of the time step.
    TimeStep,
    /// Spacing of the points in a cell.
    PointsPerCell,
    /// Compressibility of the water: not a refinement, and what does not lock does not change with it.
    WaterBulkModulus,
}

words!(
    Axis:
    Cells "cells", TimeStep "time_step", PointsPerCell "points_per_cell",
    WaterBulkModulus "water_bulk_modulus",
);

impl Choice for Axis {
    fn all() -> Vec<Self> {
        Self::ALL.to_vec()
    }
    fn word(self) -> &'static str {
        self.name()
    }
}

impl Axis {
    /// Those along which a discretisation gets finer.
    pub const REFINEMENTS: [Self; 3] = [Self::Cells, Self::TimeStep, Self::PointsPerCell];
}

/// The reference that is no other theory: the same run at the next finer level. Differences of
/// neighbours have no floor but round-off, whatever the exact solution.
pub const NEXT_FINER: &str = "next-finer";

/// No reference at all: what is judged is a value, its differences from the next finer level, and the
/// numerical uncertainty that refinement leaves it.
pub const NO_REFERENCE: &str = "none";

/// Which error of a run: what, where, in which norm, against which reference, when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Norm.
    pub norm: Norm,
    /// Name of the reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// Depth `ζ`, from 0 at the surface to 1 at the base, of the one place of a field that has no
    /// reference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probe: Option<f64>,
}

impl Measure {
    /// The error of a record, where it was measured.
    pub fn error<'a>(&self, record: &'a Record) -> Option<&'a ErrorRow> {
        record.error(self.quantity, self.sample, self.norm, &self.reference, self.time_factor)
    }
}

impl fmt::Display for Measure {
    /// In words, as subjects of verdicts have it.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, norm, sample, reference, time_factor, probe } = self;
        match (reference.as_str(), probe) {
            (NO_REFERENCE, None) => write!(out, "{} without reference", quantity.name())?,
            (NO_REFERENCE, Some(depth)) => {
                write!(out, "{} at ζ = {depth} without reference", quantity.name())?;
            }
            _ => write!(out, "{} {norm} {} against {reference}", quantity.name(), sample.name())?,
        }
        write!(out, " at T_v = {}", typed(*time_factor))
    }
}

/// Which cases an expectation is about, by the values of their inputs; what is not named fits every case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection(pub Vec<(&'static Key, Value)>);

impl Selection {
    /// Whether it names a case.
    pub fn fits(&self, case: &Case) -> bool {
        self.fits_along("", case)
    }

    /// Whether it names a case of a series along a key, whose own values do not count.
    pub fn fits_along(&self, axis: &str, case: &Case) -> bool {
        self.0.iter().all(|(key, value)| key.name == axis || key.get(case) == *value)
    }

    /// The method, where one is named.
    pub fn method(&self) -> Option<Method> {
        self.0
            .iter()
            .find_map(|(_, value)| if let Value::Method(method) = value { Some(*method) } else { None })
    }
}

/// An expectation of a series of cases.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesExpectation {
    /// Which cases.
    pub selection: Selection,
    /// Which error.
    pub measure: Measure,
    /// Reference, typed; none where a series is held against itself or against nothing.
    pub reference: Option<ReferenceKind>,
    /// Axis of the series.
    pub axis: Axis,
    /// What is wanted of the series.
    pub demand: Demand,
    /// Smallest tier whose cases can answer it.
    pub tier: Tier,
    /// The file's line, for messages.
    pub line: usize,
}
