//! Parts of a mapping: which rows count, where times come from, and what is derived from columns.

use crate::import::mapping::units::VerticalSense;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Which rows count.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RowFilter {
    /// Only points at corners of cells: programs write 0 or meaningless values at mid-side nodes.
    pub corners: bool,
    /// Only rows at this place along `x`, in the file's unit: selects one of several columns of nodes.
    pub x: Option<f64>,
    /// Only rows in which a column has this value, like a material.
    pub equals: BTreeMap<String, f64>,
}

/// Where the time comes from if it is not a column.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Time of each file with one step, by its file name.
    pub files: BTreeMap<String, f64>,
    /// Times of the files, in the order in which they are given.
    pub list: Vec<f64>,
    /// Seconds from one numbered step to the next, if file names have the number of the step.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub step: Option<f64>,
    /// The file name with `{step}` where the number of the step stands and `*` for what differs; the last number of
    /// the name by default.
    pub pattern: Option<String>,
}

/// Where the displacement comes from.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementSource {
    /// What is subtracted from the current place.
    pub from: ZeroState,
    /// Column that identifies each point; the order of the rows by default.
    pub id: Option<String>,
}

/// Places that displacements count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ZeroState {
    /// Those of the first state.
    FirstFrame,
}

/// Water at rest.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hydrostatic {
    /// Its unit weight, Pa per m.
    #[schemars(extend("type" = ["number", "string"], "unit" = "N/m³"))]
    pub unit_weight: f64,
    /// Height of its table over the base, m; the surface by default.
    #[schemars(extend("type" = ["number", "string"], "unit" = "m"))]
    pub surface: Option<f64>,
}

/// What a column of stress contains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StressMeaning {
    /// The effective stress, or the total one.
    pub is: StressKind,
}

/// A stress of a soil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StressKind {
    /// Stress of the skeleton.
    #[default]
    Effective,
    /// Stress of skeleton and water together.
    Total,
}

/// A settlement curve.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettlementSeries {
    /// CSV file, relative to the results or to the current folder.
    pub file: String,
    /// Column of the time, in the unit of [units]; `t` by default.
    #[serde(default = "time_column")]
    pub t: String,
    /// Column of the settlement, in the unit of displacements; `s` by default.
    #[serde(default = "settlement_column")]
    pub s: String,
    /// `down` if settlement is positive, `up` if the displacement of the surface is given.
    #[serde(default = "downward")]
    pub sign: VerticalSense,
}

fn time_column() -> String {
    "t".to_owned()
}

fn settlement_column() -> String {
    "s".to_owned()
}

fn downward() -> VerticalSense {
    VerticalSense::Down
}
