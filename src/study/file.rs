//! A study as typed: every value with its place in the text, before any check.

use crate::case::{Key, Norm, Quantity, Sample, Task, Tier};
use crate::study::expectation::{Axis, NEXT_FINER, NO_REFERENCE};
use crate::study::inputs::{Inputs, add_inputs, add_units, take_inputs};
use crate::study::reading::{Placed, Typed};
use crate::study::solver::PRESETS;
use oedometer_convergence::Class;
use oedometer_exact::reference::ReferenceKind;
use oedometer_input::mending::Unread;
pub use oedometer_input::source::StudySource;
use oedometer_scenes::Scene;
use oedometer_soil::layers::SoilLayer;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::Deserializer;

/// Name of the study that a command line describes.
pub const COMMAND_LINE: &str = "command line";

/// A study file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Title, one line.
    pub title: String,
    /// Question that the study answers.
    #[serde(default)]
    pub summary: String,
    /// Physical problem.
    pub scene: Placed<&'static Scene>,
    /// Geometry and load of a column.
    #[serde(default)]
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "column", false))]
    pub column: ColumnTable,
    /// Geometry and load of a layer.
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "layer", false))]
    pub layer: Typed<InputTable>,
    /// Motion and pressure of a square that are prescribed.
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "manufactured", false))]
    pub manufactured: Typed<InputTable>,
    /// Where the points lie in their cells.
    #[serde(default)]
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "points", false))]
    pub points: InputTable,
    /// What to do with the cases.
    pub task: Typed<Task>,
    /// Longest wall time of a case, s; beyond it the case is `timed-out`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub case_seconds: Typed<f64>,
    /// What the soil is made of.
    #[serde(default)]
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "material", false))]
    pub material: InputTable,
    /// Choices of the integrators that a sweep may vary.
    #[serde(default)]
    #[schemars(transform = |schema: &mut Schema| add_inputs(schema, "integrator", false))]
    pub integrator: InputTable,
    /// Output times, and the exact solutions to compare with.
    #[serde(default)]
    pub output: OutputTable,
    /// External solvers, whose names can then be methods of a sweep.
    #[serde(default)]
    pub solver: Vec<SolverTable>,
    /// Existing results of external solvers, whose names count as methods too.
    #[serde(default)]
    pub result: Vec<ResultTable>,
    /// Blocks of cases: the product of the lists, or zipped lists.
    #[serde(default)]
    pub sweep: Vec<Placed<SweepTable>>,
    /// What series must show; judged by `check`.
    #[serde(default)]
    pub expect: Vec<Placed<ExpectTable>>,
    /// What single cases must do; judged by `check`.
    #[serde(default)]
    pub expect_case: Vec<Placed<ExpectCaseTable>>,
    /// How the cases are timed.
    #[serde(default)]
    pub timing: TimingTable,
    /// Golden values: `"none"` if only expectations judge, or a table with the tolerance of all values.
    #[serde(default)]
    #[schemars(schema_with = "golden")]
    pub golden: Typed<GoldenRule>,
}

impl StudyFile {
    /// Reads a study; the inputs of its tables by the table of keys, all else by serde.
    ///
    /// # Errors
    /// Keys that are not known and values of a wrong kind, all at their places, with what the text says but for these.
    pub fn read(source: &StudySource) -> Result<Self, Box<Unread<Self>>> {
        source.read_by(|mut root| {
            let mut take = |table: &str, of: &str| take_inputs(root.as_mut(), table, of, table == "sweep");
            let single = ["column", "points", "material", "integrator", "layer", "manufactured"];
            let single = single.map(|table| take(table, table));
            let [sweep, expect, expect_case] =
                ["sweep", "expect", "expect_case"].map(|table| take(table, "sweep"));
            let mut file = Self::deserialize(Deserializer::from(root))?;
            let [column, points, material, integrator, layer, manufactured] =
                single.map(|inputs| inputs.map(|tables| tables.into_iter().next().unwrap_or_default()));
            file.column.inputs = column?;
            file.points.inputs = points?;
            file.material.inputs = material?;
            file.integrator.inputs = integrator?;
            for (table, inputs) in [(&mut file.layer, layer?), (&mut file.manufactured, manufactured?)] {
                if let Some(table) = table {
                    table.get_mut().inputs = inputs;
                }
            }
            for (block, inputs) in file.sweep.iter_mut().zip(sweep?) {
                block.get_mut().inputs = inputs;
            }
            for (block, inputs) in file.expect.iter_mut().zip(expect?) {
                block.get_mut().inputs = inputs;
            }
            for (block, inputs) in file.expect_case.iter_mut().zip(expect_case?) {
                block.get_mut().inputs = inputs;
            }
            Ok(file)
        })
    }
}

/// A table that has inputs of a case and no other keys.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputTable {
    #[serde(skip)]
    pub inputs: Inputs,
}

/// Geometry and load of a column.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnTable {
    #[serde(skip)]
    pub inputs: Inputs,
    /// Final vertical strain, instead of `load`; 0.3 shortens the column by 30 %.
    pub strain: Typed<f64>,
    /// Layers of soil from the base up: `thickness`, and keys that differ from `[material]`.
    #[serde(default)]
    #[schemars(transform = add_units)]
    pub soils: Vec<Placed<SoilLayer>>,
}

/// Output times, and the exact solutions to compare with.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    /// Outputs `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factors: Typed<Vec<Placed<f64>>>,
    /// Outputs as times, s, beside `time_factors`.
    #[serde(default)]
    #[schemars(schema_with = "times")]
    pub times: Typed<Vec<Placed<f64>>>,
    /// Exact solutions to compare with.
    #[schemars(schema_with = "references")]
    #[serde(default)]
    pub references: Typed<Vec<Placed<String>>>,
}

/// How the cases are timed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimingTable {
    /// Number of runs of each case, alone, for its wall time.
    pub repeats: Typed<i64>,
}

/// Whether values are compared with golden ones, and how closely.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GoldenRule {
    /// Within the tolerances that were measured when they were accepted.
    #[default]
    Measured,
    /// The same, and a change of each value, and of the part of 1 that it is, that always passes.
    Within(f64),
    /// There are none: the expectations judge.
    None,
}

impl<'de> Deserialize<'de> for GoldenRule {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(GoldenRuleVisitor)
    }
}

/// Reads `"none"` or `{ tolerance = 1e-6 }`.
struct GoldenRuleVisitor;

impl<'de> serde::de::Visitor<'de> for GoldenRuleVisitor {
    type Value = GoldenRule;

    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("\"none\", or a table [golden] with `tolerance`")
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<GoldenRule, E> {
        match word {
            "none" => Ok(GoldenRule::None),
            _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
        }
    }

    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<GoldenRule, A::Error> {
        let mut rule = GoldenRule::Measured;
        while let Some(key) = map.next_key::<String>()? {
            if key != "tolerance" {
                return Err(serde::de::Error::unknown_field(&key, &["tolerance"]));
            }
            rule = GoldenRule::Within(map.next_value()?);
        }
        Ok(rule)
    }
}

/// One block of cases: lists of inputs, and the keys of the block.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = |schema: &mut Schema| add_inputs(schema, "sweep", true))]
pub struct SweepTable {
    #[serde(skip)]
    pub inputs: Inputs,
    /// Outputs `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factors: Typed<Vec<Placed<f64>>>,
    /// Outputs as times, s, beside `time_factors`.
    #[serde(default)]
    #[schemars(schema_with = "times")]
    pub times: Typed<Vec<Placed<f64>>>,
    /// Lists combined element by element, not as a Cartesian product.
    #[serde(default)]
    #[schemars(schema_with = "axes")]
    pub path: Typed<Vec<Placed<String>>>,
    /// Lowest test level that includes it.
    #[serde(default)]
    pub tier: Tier,
}

/// What the series of the cases that its inputs select must show.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = |schema: &mut Schema| add_inputs(schema, "sweep", false))]
pub struct ExpectTable {
    #[serde(skip)]
    pub inputs: Inputs,
    /// Measured quantity.
    #[serde(default)]
    pub quantity: Quantity,
    /// Norm of the error.
    pub norm: Typed<Norm>,
    /// Places where it is measured.
    pub sample: Typed<Sample>,
    /// `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factor: Typed<f64>,
    /// Time of an output, s, instead of `time_factor`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub time: Typed<f64>,
    /// Exact solution.
    #[serde(default)]
    #[schemars(schema_with = "reference")]
    pub reference: Typed<String>,
    /// Input that is refined along the series.
    #[serde(default)]
    pub axis: Axis,
    /// Bounds on the order on the finest three levels.
    pub order: Typed<OrderTable>,
    /// Bounds on the error at a named level.
    pub at: Typed<LevelTable>,
    /// Bound on the largest over the smallest error from a named level on, minus one.
    pub spread: Typed<LevelTable>,
    /// Class of the series.
    pub class: Option<Class>,
    /// Bounds on the error plateau.
    pub floor: Typed<RangeTable>,
    /// Bound on the oscillation of the profile.
    pub oscillation: Typed<BelowTable>,
    /// Bound on the relative numerical uncertainty of a value without a reference.
    pub uncertainty: Typed<BelowTable>,
    /// Depth of a field value without a reference, from 0 (surface) to 1 (base).
    pub probe: Typed<f64>,
    /// Known failure: the expectation must fail.
    pub xfail: Typed<XfailTable>,
    /// Lowest test level that includes it.
    #[serde(default)]
    pub tier: Tier,
}

impl ExpectTable {
    /// Where the table of a demand stands.
    pub fn place_of(&self, key: &str) -> Option<Range<usize>> {
        match key {
            "order" => self.order.as_ref().map(Placed::span),
            "at" => self.at.as_ref().map(Placed::span),
            "spread" => self.spread.as_ref().map(Placed::span),
            "floor" => self.floor.as_ref().map(Placed::span),
            "oscillation" => self.oscillation.as_ref().map(Placed::span),
            "uncertainty" => self.uncertainty.as_ref().map(Placed::span),
            "xfail" => self.xfail.as_ref().map(Placed::span),
            _ => None,
        }
    }
}

/// What the single cases that its inputs select must do.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = |schema: &mut Schema| add_inputs(schema, "sweep", false))]
pub struct ExpectCaseTable {
    #[serde(skip)]
    pub inputs: Inputs,
    /// Required end of the case: `ok`, `unsound` (a check of it fails), or the name of a failure.
    pub status: Typed<String>,
    /// Largest relative difference of observed and predicted critical step.
    pub critical_step_within: Typed<f64>,
    /// Largest relative drift of the solid mass.
    pub solid_drift_below: Typed<f64>,
    /// Largest water-mass error, over the water that the load expels.
    pub water_drift_below: Typed<f64>,
    /// Bounds on the largest volume of the water over that of the pores, minus one, with two point sets.
    pub pore_water: Typed<RangeTable>,
    /// Largest difference of the share of the water that left and the settlement over `n_0 H`.
    pub water_left_within: Typed<f64>,
    /// Bounds on the largest pressure of any water point over the load, between outputs too, with two point sets.
    pub largest_pressure: Typed<RangeTable>,
    /// Largest difference of any error from that with one point set.
    pub one_set_within: Typed<f64>,
    /// Bounds on the largest velocity of a column at rest, over the hydraulic conductivity.
    pub spurious_velocity: Typed<RangeTable>,
    /// Bounds on the time factor of the highest pressure at the impermeable end.
    pub peak_time_factor: Typed<RangeTable>,
    /// Bounds on the highest pressure at the impermeable end, over the load.
    pub peak_pressure: Typed<RangeTable>,
    /// Bounds on one error.
    pub error: Typed<RangeTable>,
    /// Measured quantity.
    #[serde(default)]
    pub quantity: Quantity,
    /// Norm of the error.
    pub norm: Typed<Norm>,
    /// Places where it is measured.
    pub sample: Typed<Sample>,
    /// `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factor: Typed<f64>,
    /// Time of an output, s, instead of `time_factor`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub time: Typed<f64>,
    /// Exact solution.
    #[serde(default)]
    #[schemars(schema_with = "reference")]
    pub reference: Typed<String>,
    /// Lowest test level that includes it.
    #[serde(default)]
    pub tier: Tier,
}

/// Two bounds.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeTable {
    /// Lower bound: a number, or a percentage like `"1 %"`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "%"))]
    pub above: Option<f64>,
    /// Upper bound: a number, or a percentage like `"1 %"`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "%"))]
    pub below: Option<f64>,
}

/// A band about an order.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrderTable {
    /// The order.
    pub value: f64,
    /// How far below it may lie.
    pub minus: Option<f64>,
    /// How far above it may lie.
    pub plus: Option<f64>,
}

/// Bounds at a level, which is named in the words of its axis.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelTable {
    /// Cells over the height.
    pub cells: Typed<i64>,
    /// Material points per cell and direction.
    pub points_per_cell: Typed<i64>,
    /// Step, s.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub seconds: Option<f64>,
    /// Bulk modulus of the water, Pa.
    #[schemars(extend("type" = ["number", "string"], "unit" = "Pa"))]
    pub water_bulk_modulus: Option<f64>,
    /// Upper bound: a number, or a percentage like `"1 %"`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "%"))]
    pub below: Option<f64>,
    /// Lower bound: a number, or a percentage like `"1 %"`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "%"))]
    pub above: Option<f64>,
}

/// An upper bound.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BelowTable {
    /// Upper bound: a number, or a percentage like `"1 %"`.
    #[schemars(extend("type" = ["number", "string"], "unit" = "%"))]
    pub below: f64,
}

/// A known failure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct XfailTable {
    /// Whether an unexpected pass is a failure.
    pub strict: Option<bool>,
    /// Why.
    pub reason: String,
}

/// A program that solves a case of the study and writes a result.
///
/// `{case}`, `{out}`, `{study}`, `{cells}`, `{points_per_cell}`, `{time_step}` and `{end_time}` stand for values of
/// the case in `command`, `result` and `env`. A word that names a file beside the study stands for that file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolverTable {
    /// Its name among the methods of a sweep.
    pub name: Placed<String>,
    /// The program and its arguments, word by word; no shell reads them.
    pub command: Placed<Vec<Placed<String>>>,
    /// The result that it writes, below `{out}`; `*` and `?` stand for several files.
    pub result: Placed<String>,
    /// File beside the study that says what the result's columns or arrays mean.
    pub mapping: Typed<String>,
    /// Program whose files are known; a mapping overrides it.
    #[serde(default)]
    #[schemars(schema_with = "presets")]
    pub preset: Typed<String>,
    /// Command that prints its version; the first line is kept in the record.
    pub version: Typed<Vec<Placed<String>>>,
    /// `version`: results are reused while the output of the version command and the content of the command's files and
    /// of those in `known_by` stay the same. Without it, the program always runs.
    #[schemars(extend("enum" = ["version"]))]
    pub reuse: Typed<String>,
    /// Files and folders that the program is made of, relative to the folder of the study; with `reuse`.
    pub known_by: Typed<Vec<Placed<String>>>,
    /// Longest wall time of one run, s; `case_seconds` of the study by default.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub timeout: Typed<f64>,
    /// Timed runs of each case, 1 by default; their results must agree.
    pub repeats: Typed<i64>,
    /// Whether an untimed run precedes the timed ones; by default only before several.
    pub warm_up: Option<bool>,
    /// Number of its simultaneous runs, 1 by default.
    pub at_once: Typed<i64>,
    /// Environment variables in addition to those of this program.
    #[serde(default)]
    pub env: BTreeMap<String, Placed<String>>,
    /// Further files of the adapter, beside the study: they belong to the identity of its cases.
    pub files: Typed<Vec<Placed<String>>>,
    /// Regular expression whose first group is the run time that the program reports in its output.
    pub solve_seconds: Typed<String>,
    /// Unit of that time: `s` by default, or `ms`, `min`, `h`.
    pub solve_unit: Typed<String>,
    /// Seconds from one numbered step to the next, where file names have the number of the step.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub time_step: Typed<f64>,
}

/// Existing files of an external solver, on one mesh or on several; nothing runs.
///
/// Its name then stands where expectations name a method. The scene, its column and soil are those of the study.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResultTable {
    /// Its name among the methods.
    pub name: Placed<String>,
    /// Files of one mesh, relative to the folder of the study: `{cells}` stands for the mesh, `*` and `?` for several
    /// files.
    pub files: Placed<Vec<Placed<String>>>,
    /// Cells over the height of each mesh.
    pub cells: Placed<Vec<Placed<i64>>>,
    /// Program whose files are known; a mapping goes over it.
    #[serde(default)]
    #[schemars(schema_with = "presets")]
    pub preset: Typed<String>,
    /// File beside the study that says what columns or arrays mean.
    pub mapping: Typed<String>,
    /// Seconds from one numbered step to the next, where file names have the number of the step.
    #[schemars(extend("type" = ["number", "string"], "unit" = "s"))]
    pub time_step: Typed<f64>,
    /// Lowest test level that includes it.
    #[serde(default)]
    pub tier: Tier,
}

fn names_of_references() -> Vec<&'static str> {
    ReferenceKind::ALL.iter().map(|kind| kind.name()).collect()
}

fn reference(_: &mut SchemaGenerator) -> Schema {
    let names = [names_of_references(), vec![NEXT_FINER, NO_REFERENCE]].concat();
    json_schema!({ "enum": names })
}

fn references(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": { "enum": names_of_references() } })
}

fn times(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": { "type": ["number", "string"], "unit": "s" } })
}

fn axes(_: &mut SchemaGenerator) -> Schema {
    let names: Vec<&str> = Key::in_table("sweep").map(|key| key.name).collect();
    json_schema!({ "type": "array", "items": { "enum": names } })
}

fn golden(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "anyOf": [
        { "enum": ["none"] },
        { "type": "object", "additionalProperties": false, "properties": { "tolerance": {
            "type": "number",
            "description": "Absolute and relative change of a value that always passes: for solvers that do \
             not reproduce their last digits"
        } } },
    ] })
}

fn presets(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": PRESETS.map(|preset| preset.name) })
}
