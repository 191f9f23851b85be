//! A study as it was typed: every value with its place in the text, nothing judged yet.

use crate::case::Task;
use crate::case::keys::{KEYS, Key};
use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::study::choice_tables::{Named, Placed, Typed, TypedList};
use crate::study::diagnostic::{Diagnostic, StudyError, nearest};
use crate::study::expectation::{Axis, NEXT_FINER, NO_REFERENCE};
use crate::study::inputs::{InputTable, List, One, OwnKeys};
use crate::study::reading::{grammar, mistakes, toml_tree};
use crate::study::result_table::ResultTable;
use crate::study::solver_table::SolverTable;
use oedometer_convergence::Class;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::SceneKind;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;

/// Text of a study with a name for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudySource {
    /// File name, or what stands for it.
    pub name: String,
    /// TOML.
    pub text: String,
}

/// A study file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// What the study is about, in one line.
    pub title: Placed<String>,
    /// The question that it answers.
    pub summary: Option<String>,
    /// Physical problem.
    pub scene: Placed<Named<SceneKind>>,
    /// Geometry and load of a column.
    #[serde(default)]
    pub column: InputTable<One, ColumnKeys>,
    /// Geometry and load of a layer.
    pub layer: Typed<InputTable<One, LayerKeys>>,
    /// Motion and pressure of a square that are chosen.
    pub manufactured: Typed<InputTable<One, ManufacturedKeys>>,
    /// Where the points lie in their cells.
    #[serde(default)]
    pub points: InputTable<One, PointsKeys>,
    /// What is done with the cases.
    pub task: Typed<Named<Task>>,
    /// Longest wall time of a case, s.
    pub case_seconds: Typed<f64>,
    /// What the soil is made of.
    #[serde(default)]
    pub material: InputTable<One, MaterialKeys>,
    /// Choices of the integrators that a sweep may vary.
    #[serde(default)]
    pub integrator: InputTable<One, IntegratorKeys>,
    /// When results are kept, and what they are held against.
    #[serde(default)]
    pub output: OutputTable,
    /// Somebody else's solvers, whose names then stand among the methods of a sweep.
    #[serde(default)]
    pub solver: Vec<Placed<SolverTable>>,
    /// Results that somebody else's solvers have left already, whose names stand among the methods too.
    #[serde(default)]
    pub result: Vec<Placed<ResultTable>>,
    /// Blocks of cases: the product of the lists, or a path.
    #[serde(default)]
    pub sweep: Vec<Placed<SweepTable>>,
    /// What must be found; judged by `check`.
    #[serde(default)]
    pub expect: Vec<Placed<ExpectTable>>,
    /// What single cases must do; judged by `check`.
    #[serde(default)]
    pub expect_case: Vec<Placed<ExpectCaseTable>>,
    /// How the cases are timed.
    #[serde(default)]
    pub timing: TimingTable,
}

/// Tables that hold inputs of a case and nothing else.
macro_rules! tables_of_inputs {
    ($($keys:ident: $table:literal),+ $(,)?) => { $(
        #[derive(Debug, Default, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        #[doc = "Inputs of a case."]
        pub struct $keys {}
        impl OwnKeys for $keys {
            const TABLE: &'static str = $table;
        }
    )+ };
}

tables_of_inputs!(
    LayerKeys: "layer",
    ManufacturedKeys: "manufactured",
    PointsKeys: "points",
    MaterialKeys: "material",
    IntegratorKeys: "integrator",
);

/// Geometry and load of a column.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnKeys {
    /// Vertical strain at the end, in place of the load that brings it about: 0.3 is a column that gets 30 % shorter.
    pub strain: Typed<f64>,
}
impl OwnKeys for ColumnKeys {
    const TABLE: &'static str = "column";
}

/// When results are kept, and what they are held against.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputTable {
    /// Outputs `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factors: TypedList<f64>,
    /// Exact solutions to hold the result against.
    #[serde(default)]
    #[schemars(schema_with = "references")]
    pub references: TypedList<String>,
}

/// How the cases are timed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimingTable {
    /// Runs of each case alone for its wall time.
    pub repeats: Typed<i64>,
}

/// One block of cases: lists of inputs, and the keys of the block.
pub type SweepTable = InputTable<List, SweepKeys>;

/// Keys of a sweep beside inputs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepKeys {
    /// Outputs `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factors: TypedList<f64>,
    /// Axes that step together instead of being multiplied out.
    #[serde(default)]
    #[schemars(schema_with = "axes")]
    pub path: TypedList<String>,
    /// Smallest tier that has it.
    pub tier: Typed<Named<Tier>>,
}

/// What must be found of the series of the cases that its inputs name.
pub type ExpectTable = InputTable<One, ExpectKeys>;

/// Keys of an expectation of series beside inputs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectKeys {
    /// What is measured.
    pub quantity: Typed<Named<Quantity>>,
    /// How the error becomes one number.
    pub norm: Typed<Named<Norm>>,
    /// Where it is measured.
    pub sample: Typed<Named<Sample>>,
    /// `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factor: Typed<f64>,
    /// Exact solution to hold the result against.
    #[serde(default)]
    #[schemars(schema_with = "reference")]
    pub reference: Typed<String>,
    /// What is refined along the series.
    pub axis: Typed<Named<Axis>>,
    /// Two-sided band about the order on the finest three levels.
    pub order: Typed<OrderTable>,
    /// Bounds on the error at a named level.
    pub at: Typed<LevelTable>,
    /// Bound on the spread of the errors from a named level on: the largest over the smallest, minus one.
    pub spread: Typed<LevelTable>,
    /// Class of the series.
    pub class: Typed<Named<Class>>,
    /// Bounds on the floor under the errors.
    pub floor: Typed<RangeTable>,
    /// Bound on the wiggle of the profile.
    pub oscillation: Typed<BelowTable>,
    /// Bound on the numerical uncertainty of a value without a reference, over that value.
    pub uncertainty: Typed<BelowTable>,
    /// Depth of the one place of a field without a reference, from 0 (surface) to 1 (base).
    pub probe: Typed<f64>,
    /// Marks a known failure, which must then fail.
    pub xfail: Typed<XfailTable>,
    /// Smallest tier that has it.
    pub tier: Typed<Named<Tier>>,
}

/// What the single cases that its inputs name must do.
pub type ExpectCaseTable = InputTable<One, ExpectCaseKeys>;

/// Keys of an expectation of cases beside inputs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectCaseKeys {
    /// How the case must end: `ok`, or the name of a failure.
    pub status: Typed<String>,
    /// Largest relative difference of the observed from the predicted critical step.
    pub critical_step_within: Typed<f64>,
    /// Largest relative drift of the mass of solids at any output.
    pub solid_drift_below: Typed<f64>,
    /// Largest imbalance of the water at any output, over what the load presses out.
    pub water_drift_below: Typed<f64>,
    /// Bounds on the largest size, at any output, of the water in the soil over its pores, less one: of two layers.
    pub pore_water: Typed<RangeTable>,
    /// Largest difference, at any output, of the share of the water that left from the settlement over `n_0 H`.
    pub water_left_within: Typed<f64>,
    /// Bounds on the largest pressure of any water point of two layers, between outputs too, over the load.
    pub largest_pressure: Typed<RangeTable>,
    /// Largest difference of any error from that of the same case in one layer.
    pub one_layer_within: Typed<f64>,
    /// Bounds on the largest velocity at any output of a column at rest, over the hydraulic conductivity.
    pub spurious_velocity: Typed<RangeTable>,
    /// Bounds on the time factor at which the pressure at the impermeable end is highest.
    pub peak_time_factor: Typed<RangeTable>,
    /// Bounds on that pressure over the load.
    pub peak_pressure: Typed<RangeTable>,
    /// Bounds on one error.
    pub error: Typed<RangeTable>,
    /// What is measured.
    pub quantity: Typed<Named<Quantity>>,
    /// How the error becomes one number.
    pub norm: Typed<Named<Norm>>,
    /// Where it is measured.
    pub sample: Typed<Named<Sample>>,
    /// `T_v = c_v t/H²`, with the drained `c_v`.
    pub time_factor: Typed<f64>,
    /// Exact solution to hold the result against.
    #[serde(default)]
    #[schemars(schema_with = "reference")]
    pub reference: Typed<String>,
    /// Smallest tier that has it.
    pub tier: Typed<Named<Tier>>,
}

impl OwnKeys for SweepKeys {
    const TABLE: &'static str = "sweep";
}
impl OwnKeys for ExpectKeys {
    const TABLE: &'static str = "sweep";
}
impl OwnKeys for ExpectCaseKeys {
    const TABLE: &'static str = "sweep";
}

/// Two bounds.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeTable {
    /// Lower bound.
    pub above: Typed<f64>,
    /// Upper bound.
    pub below: Typed<f64>,
}

/// A band about an order.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrderTable {
    /// The order.
    pub value: Placed<f64>,
    /// How far below it may lie.
    pub minus: Typed<f64>,
    /// How far above it may lie.
    pub plus: Typed<f64>,
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
    pub seconds: Typed<f64>,
    /// Bulk modulus of the water, Pa.
    pub water_bulk_modulus: Typed<f64>,
    /// Upper bound.
    pub below: Typed<f64>,
    /// Lower bound.
    pub above: Typed<f64>,
}

/// An upper bound.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BelowTable {
    /// Upper bound.
    pub below: Placed<f64>,
}

/// A known failure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct XfailTable {
    /// Whether an unexpected pass is a failure.
    pub strict: Typed<bool>,
    /// Why.
    pub reason: Placed<String>,
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

fn axes(_: &mut SchemaGenerator) -> Schema {
    let names: Vec<&str> = Key::of("sweep").map(|key| key.name).collect();
    json_schema!({ "type": "array", "items": { "enum": names } })
}

impl StudySource {
    /// Reads TOML into tables, refusing unknown keys and wrong types at their place.
    ///
    /// # Errors
    /// What the parser refuses, with the nearest key.
    pub fn read<T: serde::de::DeserializeOwned>(&self) -> Result<T, StudyError> {
        toml_tree::read(&self.text).map_err(|refusal| self.error(vec![explained(refusal, &self.text)]))
    }

    /// One complaint about the whole text.
    pub fn complaint(&self, message: String, help: String) -> StudyError {
        self.error(vec![Diagnostic { message, span: None, help: Some(help) }])
    }

    /// An error of this study.
    pub fn error(&self, diagnostics: Vec<Diagnostic>) -> StudyError {
        StudyError { name: self.name.clone(), source: self.text.clone(), diagnostics }
    }
}

/// A refusal with the nearest key, where the key is unknown.
fn explained(refusal: toml_tree::Refusal, text: &str) -> Diagnostic {
    let message = refusal.message.trim().replace('\n', "; ");
    let span = refusal.place;
    if let Some((message, help)) = mistakes::explained(&message, span.as_ref(), text) {
        return Diagnostic { message, span, help: Some(help) };
    }
    if let Some(diagnostic) = grammar::explained(&message, span.as_ref(), text) {
        return diagnostic;
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (message, help) = match quoted.split_first() {
        Some((word, candidates)) if message.starts_with("unknown field") => {
            let help = match nearest(word, candidates.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => {
                    table_of(word).unwrap_or_else(|| format!("the keys here are {}", candidates.join(", ")))
                }
            };
            (format!("unknown key `{word}`"), help)
        }
        Some((word, choices)) if message.starts_with("unknown variant") => {
            let help = match nearest(word, choices.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the words here are {}", choices.join(", ")),
            };
            (format!("`{word}` is none of the words that stand here"), help)
        }
        _ => grammar::in_short(&message),
    };
    Diagnostic { message, span, help: Some(help) }
}

/// Where a key belongs that stands outside its table.
fn table_of(word: &str) -> Option<String> {
    let key = KEYS.iter().find(|key| key.name == word)?;
    let (table, is_block) =
        key.tables.iter().find(|table| **table != "sweep").map_or(("sweep", true), |t| (t, false));
    let header = if is_block { format!("[[{table}]]") } else { format!("[{table}]") };
    Some(format!("`{word}` belongs to {header}: `{table}.{word}`"))
}
