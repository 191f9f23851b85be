//! What a study expects of its own results: which series, and what of it.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::convergence::series_expectation::SeriesDemand as Demand;
use crate::exact::reference::ReferenceKind;
use crate::mpm::explicit::Drag;
use crate::mpm::explicit::scheme::Scheme;
use crate::mpm::method::Method;
use crate::mpm::run::integrator::IntegratorKind;
use crate::soil::continuity::Continuity;
use crate::soil::law::Law;
use crate::wording::typed;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What is refined along a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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

impl Axis {
    /// Every axis.
    pub const ALL: [Self; 4] = [Self::Cells, Self::TimeStep, Self::PointsPerCell, Self::WaterBulkModulus];
    /// Those along which a discretisation gets finer.
    pub const REFINEMENTS: [Self; 3] = [Self::Cells, Self::TimeStep, Self::PointsPerCell];

    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cells => "cells",
            Self::TimeStep => "time_step",
            Self::PointsPerCell => "points_per_cell",
            Self::WaterBulkModulus => "water_bulk_modulus",
        }
    }
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

/// One expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Method, where one is named.
    pub method: Option<Method>,
    /// Integrator, where it is named.
    pub integrator: Option<IntegratorKind>,
    /// Cells, where the axis is another.
    pub cells: Option<usize>,
    /// Points a cell, where they are named.
    pub points_per_cell: Option<usize>,
    /// Law of the soil, where it is named.
    pub law: Option<Law>,
    /// Continuity of the water, where it is named.
    pub continuity: Option<Continuity>,
    /// Bulk modulus of the water, Pa, where it is named.
    pub water_bulk_modulus: Option<f64>,
    /// Poisson's ratio, where it is named.
    pub poissons_ratio: Option<f64>,
    /// Scheme of the explicit step, where it is named.
    pub scheme: Option<Scheme>,
    /// Drag, where it is named.
    pub drag: Option<Drag>,
    /// Mapping back, where it is named.
    pub mapping_back: Option<bool>,
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
