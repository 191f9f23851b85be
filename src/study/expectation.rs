//! What a study expects of its own results, checked and ready to be judged.

use crate::assess::norms::Norm;
use crate::exact::ReferenceKind;
use crate::record::{Quantity, Sample};
use crate::solver::explicit::Drag;
use crate::solver::method::Method;

/// What is refined along a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// Cell size, by the number of cells.
    Cells,
    /// Size of the time step.
    TimeStep,
    /// Spacing of the points in a cell.
    PointsPerCell,
}

impl Axis {
    /// Every axis.
    pub const ALL: [Self; 3] = [Self::Cells, Self::TimeStep, Self::PointsPerCell];

    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cells => "cells",
            Self::TimeStep => "time_step",
            Self::PointsPerCell => "points_per_cell",
        }
    }
}

/// A two-sided band around a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Middle.
    pub value: f64,
    /// How far below it may lie.
    pub minus: f64,
    /// How far above it may lie.
    pub plus: f64,
}

/// A bound on the error at one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelBound {
    /// Cells of the level.
    pub cells: usize,
    /// The error must lie below.
    pub below: Option<f64>,
    /// The error must lie above: a result that is too good is as suspect.
    pub above: Option<f64>,
}

/// A failure that is known and must stay one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StrictFailure {
    /// Why it fails.
    pub reason: String,
}

/// One expectation: which series, and what of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Method, where one is named.
    pub method: Option<Method>,
    /// Cells, where the axis is another.
    pub cells: Option<usize>,
    /// Points a cell, where they are named.
    pub points_per_cell: Option<usize>,
    /// Drag, where it is named.
    pub drag: Option<Drag>,
    /// Mapping back, where it is named.
    pub mapping_back: Option<bool>,
    /// Measured quantity.
    pub quantity: Quantity,
    /// Norm.
    pub norm: Norm,
    /// Places.
    pub sample: Sample,
    /// Time factor.
    pub time_factor: f64,
    /// Reference.
    pub reference: ReferenceKind,
    /// Axis of the series.
    pub axis: Axis,
    /// Order on the finest window.
    pub order: Option<Band>,
    /// Error at a named level.
    pub at: Option<LevelBound>,
    /// Class of the verdict.
    pub class: Option<String>,
    /// Band of the floor that the series must run into.
    pub floor: Option<(f64, f64)>,
    /// Known failure.
    pub xfail: Option<StrictFailure>,
    /// The file's line, for messages.
    pub line: usize,
}
