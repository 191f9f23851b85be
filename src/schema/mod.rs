//! JSON Schemas of what this program reads and writes, for editors and for other programs.
//!
//! They are traced from the very types that read the files, so that they cannot fall behind the
//! code; the words of text keys and what keys mean are told here.

pub mod node;
pub mod tracer;

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::convergence::class::Class;
use crate::exact::reference::ReferenceKind;
use crate::import::mapping::Mapping;
use crate::mpm::explicit::Drag;
use crate::mpm::explicit::scheme::Scheme;
use crate::mpm::method::{Configuration, Method};
use crate::mpm::run::integrator::IntegratorKind;
use crate::record::Record;
use crate::scene::SceneKind;
use crate::schema::node::Language;
use crate::schema::tracer::shape_of;
use crate::soil::continuity::Continuity;
use crate::soil::law::Law;
use crate::study::expectation::{Axis, NEXT_FINER, NO_REFERENCE};
use crate::study::file::{MethodTable, StudyFile};
use serde_json::{Value, json};

/// Dialect of the schemas.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// What the tables of a mapping mean.
const MAPPING_KEYS: &[(&str, &str)] = &[
    ("sample", "Kind of the places: a name for tables."),
    ("whole_volume", "What the volumes of all samples add up to, in the unit of their column."),
    ("columns", "Names of the columns, as the header spells them."),
    ("units", "Units of the columns."),
    ("sign", "Directions that count as positive; of x and y with the end from which they count."),
    ("position", "Whether places are initial or present ones, of x as of y."),
    ("origin", "What the file writes at the end from which x and y count, in its unit of length."),
    ("files", "Time of each file that holds one step, by its file name."),
    ("csv", "Layout of the file."),
    ("delimiter", "What parts the columns."),
    ("comment", "What begins a line that is no row."),
];

/// What the keys mean, with their units.
const KEYS: &[(&str, &str)] = &[
    ("title", "What the study is about, in one line."),
    ("summary", "The question that it answers."),
    ("scene", "Physical problem."),
    ("height", "Initial height H, m."),
    ("length", "Length, m."),
    ("width", "Width, m; two dimensions only."),
    ("load", "Load q on the surface, Pa."),
    ("law", "Stress–strain law of the skeleton."),
    ("youngs_modulus", "Young's modulus of the skeleton, Pa."),
    ("poissons_ratio", "Poisson's ratio of the skeleton."),
    ("porosity", "Initial porosity."),
    ("grain_density", "Density of the grains, kg/m³."),
    ("water_density", "Density of the water, kg/m³."),
    ("water_bulk_modulus", "Bulk modulus of the water, Pa."),
    ("hydraulic_conductivity", "Initial hydraulic conductivity, m/s."),
    ("gravity", "Gravity in the drag, m/s²."),
    ("continuity", "Form of the water's continuity."),
    ("drag", "Time level of the drag between the phases."),
    ("scheme", "Time levels of velocities and stresses in the explicit step."),
    ("oscillation", "Bound on the spurious wiggle of the profile."),
    ("flip", "Share of FLIP in the velocities of the points, 0 to 1."),
    ("mapping_back", "Whether stresses see velocities mapped back from the points."),
    ("time_factors", "Outputs T_v = c_v t/H², with the drained c_v."),
    ("time_factor", "T_v = c_v t/H², with the drained c_v."),
    ("references", "Exact solutions to hold the result against."),
    ("reference", "Exact solution to hold the result against."),
    ("sweep", "Blocks of cases: the product of the lists, or a path."),
    ("expect", "What must be found; judged by `check`."),
    ("repeats", "Runs of each case alone for its wall time."),
    ("method", "Method by its name, or by its choices."),
    ("integrator", "Integrator in time."),
    ("cells", "Cells over the height."),
    ("points_per_cell", "Material points a cell and direction."),
    ("time_step", "Rule of the time step."),
    ("stable", "Share of the predicted critical step."),
    ("courant", "Share of a cell that the fastest wave crosses in a step."),
    ("seconds", "Step, s."),
    ("growth", "Step over the time that has passed."),
    ("path", "Axes that step together instead of being multiplied out."),
    ("tier", "Smallest tier that has it."),
    ("order", "Two-sided band about the order on the finest three levels."),
    ("minus", "How far below it may lie."),
    ("plus", "How far above it may lie."),
    ("at", "Bounds on the error at a named level."),
    ("below", "Upper bound."),
    ("above", "Lower bound."),
    ("class", "Class of the series."),
    ("floor", "Bounds on the floor under the errors."),
    ("uncertainty", "Bound on the numerical uncertainty of a value without a reference, over that value."),
    ("probe", "Depth of the one place of a field without a reference, from 0 (surface) to 1 (base)."),
    ("oscillation", "Bound on the wiggle of the profile."),
    ("xfail", "Marks a known failure, which must then fail."),
    ("strict", "Whether an unexpected pass is a failure."),
    ("reason", "Why."),
    ("axis", "What is refined along the series."),
    ("quantity", "What is measured."),
    ("sample", "Where it is measured."),
    ("norm", "How the error becomes one number."),
];

/// What there is a schema of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Document {
    /// A study file
    Study,
    /// The record of a case
    Record,
    /// The mapping of somebody else's result
    Mapping,
}

/// The JSON Schema of a document.
///
/// # Errors
/// When its types refuse to be traced: a fault of this program.
pub fn schema_of(document: Document) -> Result<Value, serde::de::value::Error> {
    let (title, node, language) = match document {
        Document::Study => ("oedometer study", shape_of::<StudyFile>()?, study_language()?),
        Document::Record => {
            ("oedometer record", shape_of::<Record>()?, Language { has_null: true, ..Language::default() })
        }
        Document::Mapping => {
            let language = Language { descriptions: MAPPING_KEYS, ..Language::default() };
            ("oedometer mapping", shape_of::<Mapping>()?, language)
        }
    };
    let mut schema = node.to_schema("", &language);
    if let Some(root) = schema.as_object_mut() {
        root.insert("$schema".to_owned(), DIALECT.into());
        root.insert("title".to_owned(), title.into());
    }
    Ok(schema)
}

/// The words of a study's keys, and the two ways to name a method.
fn study_language() -> Result<Language, serde::de::value::Error> {
    fn owned<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
        names.into_iter().map(str::to_owned).collect()
    }
    let words = vec![
        ("scene", owned(SceneKind::ALL.map(SceneKind::name))),
        ("law", owned(Law::ALL.map(Law::name))),
        ("continuity", owned(Continuity::ALL.map(Continuity::name))),
        ("drag", shape_of::<Drag>()?.words()),
        ("scheme", owned(Scheme::ALL.map(Scheme::name))),
        ("integrator", owned(IntegratorKind::ALL.map(IntegratorKind::name))),
        ("configuration", owned(Configuration::ALL.map(Configuration::name))),
        ("references", owned(ReferenceKind::ALL.iter().map(|kind| kind.name()))),
        (
            "reference",
            owned(ReferenceKind::ALL.iter().map(|kind| kind.name()).chain([NEXT_FINER, NO_REFERENCE])),
        ),
        ("quantity", owned(Quantity::ALL.map(Quantity::name))),
        ("sample", owned(Sample::ALL.map(Sample::name))),
        ("norm", owned(Norm::ALL.map(Norm::name))),
        ("axis", owned(Axis::ALL.map(Axis::name))),
        ("class", owned(Class::ALL.map(Class::name))),
        ("tier", owned(Tier::ALL.map(Tier::name))),
        ("path", owned(crate::study::sweep::AXES)),
    ];
    let choices =
        shape_of::<MethodTable>()?.to_schema("", &Language { words: words.clone(), ..Language::default() });
    let method = json!({ "anyOf": [{ "enum": Method::names() }, choices] });
    Ok(Language { has_null: false, words, descriptions: KEYS, any: vec![("method", method)] })
}

#[cfg(test)]
#[path = "../../tests/unit/schema.rs"]
mod tests;
