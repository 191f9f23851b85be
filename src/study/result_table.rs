//! A result that is there already, as it was typed.

use crate::case::tier::Tier;
use crate::study::choice_tables::{Named, Placed, Typed};
use crate::study::solver::PRESETS;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;

/// Files that somebody else's solver has left, on one mesh or on several; nothing is run for them.
///
/// Its name then stands where expectations name a method. The scene, its column and soil are those of the study.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResultTable {
    /// Its name among the methods.
    pub name: Placed<String>,
    /// Files of one mesh, from the folder of the study: `{cells}` stands for the mesh, `*` and `?` for several files.
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
    pub time_step: Typed<f64>,
    /// Smallest tier that has it.
    pub tier: Typed<Named<Tier>>,
}

fn presets(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": PRESETS })
}
