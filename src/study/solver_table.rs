//! A solver of somebody else's as it was typed.

use crate::study::choice_tables::{Placed, Typed, TypedList};
use crate::study::solver::PRESETS;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::collections::BTreeMap;

/// A program that solves a case of the study and leaves a result.
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
    /// The result that it leaves, below `{out}`; `*` and `?` stand for several files.
    pub result: Placed<String>,
    /// File beside the study that says what the result's columns or arrays mean.
    pub mapping: Typed<String>,
    /// Program whose files are known; a mapping goes over it.
    #[serde(default)]
    #[schemars(schema_with = "presets")]
    pub preset: Typed<String>,
    /// Command that prints its version; its first line is kept in the record.
    pub version: TypedList<String>,
    /// Longest wall time of one run, s; `case_seconds` of the study where it is left out.
    pub timeout: Typed<f64>,
    /// Runs of each case that are timed, 1 where it is left out; their results must agree.
    pub repeats: Typed<i64>,
    /// Whether a run goes before the timed ones; where it is left out, it does before several.
    pub warm_up: Typed<bool>,
    /// How many of its runs may go on at the same time, 1 where it is left out.
    pub at_once: Typed<i64>,
    /// Variables of its environment beside those of this program.
    #[serde(default)]
    pub env: BTreeMap<String, Placed<String>>,
    /// Further files of the adapter beside the study: they belong to the identity of its cases.
    pub files: TypedList<String>,
    /// Regular expression whose first group is the time in its output that it says it took, s.
    pub solve_seconds: Typed<String>,
}

fn presets(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": PRESETS })
}
