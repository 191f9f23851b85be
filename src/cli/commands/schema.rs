//! `oedometer schema`: JSON Schemas of study files, records, mappings, cases and findings.

use crate::cli::exit::Exit;
use crate::cli::output::{json_of, print_data};
use crate::foreign::case_file::CaseFile;
use crate::import::mapping::Mapping;
use crate::questions::answers::ReportFindings;
use crate::questions::findings::Findings;
use crate::record::printed::PrintedRecord;
use crate::study::file::StudyFile;
use crate::study::reading::{each_part, plain_schema_of, schema_of as schema_of_toml};
use serde_json::{Value, json};

/// Arguments of `schema`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Document to describe
    #[arg(value_enum, default_value_t = Document::Study)]
    document: Document,
}

/// Prints the schema.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    print_data(&json_of(&schema_of(arguments.document))?)?;
    Ok(Exit::Pass)
}

/// What there is a schema of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Document {
    /// A study file
    Study,
    /// The record of a case
    Record,
    /// The mapping of another program's result
    Mapping,
    /// The case file that an attached solver receives
    Case,
    /// The findings of a report: findings.json beside the front page
    Findings,
    /// The findings of a study: NAME.findings.json beside its page
    StudyFindings,
}

/// The JSON Schema of a document.
pub fn schema_of(document: Document) -> Value {
    let (mut schema, title) = match document {
        Document::Study => (schema_of_toml::<StudyFile>(), "oedometer study"),
        Document::Record => (plain_schema_of::<PrintedRecord<'_>>(), "oedometer record"),
        Document::Case => (plain_schema_of::<CaseFile>(), "oedometer case"),
        Document::Findings => (plain_schema_of::<ReportFindings>(), "oedometer findings"),
        Document::StudyFindings => (plain_schema_of::<Findings>(), "oedometer study findings"),
        Document::Mapping => (schema_of_toml::<Mapping>(), "oedometer mapping"),
    };
    schema["title"] = title.into();
    closed(schema)
}

/// A schema whose objects have no other properties than those named, with descriptions of one line.
fn closed(mut schema: Value) -> Value {
    if let Some(object) = schema.as_object_mut() {
        if object.contains_key("properties") {
            object.insert("additionalProperties".to_owned(), false.into());
            object.entry("required").or_insert(json!([]));
        }
        if let Some(Value::String(text)) = object.get_mut("description") {
            *text = text.replace('\n', " ");
        }
    }
    each_part(schema, closed)
}

#[cfg(test)]
mod tests;
