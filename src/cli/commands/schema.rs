//! `oedometer schema`: JSON Schemas of study files, records, mappings, cases and findings.

use crate::cli::exit::Exit;
use crate::cli::output::{json_of, print_data};
use crate::foreign::case_file::CaseFile;
use crate::import::mapping::Mapping;
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
    /// The answers of a report or of a study: findings.json
    Findings,
}

/// The JSON Schema of a document.
pub fn schema_of(document: Document) -> Value {
    let (mut schema, title) = match document {
        Document::Study => (schema_of_toml::<StudyFile>(), "oedometer study"),
        Document::Record => (plain_schema_of::<PrintedRecord<'_>>(), "oedometer record"),
        Document::Case => (plain_schema_of::<CaseFile>(), "oedometer case"),
        Document::Findings => (findings_schema(), "oedometer findings"),
        Document::Mapping => (schema_of_toml::<Mapping>(), "oedometer mapping"),
    };
    schema["title"] = title.into();
    closed(schema)
}

/// What every answer has; its facts are those of its question.
fn findings_schema() -> Value {
    let list = |of: &str, description: &str| json!({ "type": "array", "items": { "type": of }, "description": description });
    let text = |description: &str| json!({ "type": "string", "description": description });
    let table = json!({ "type": "object", "properties": {
        "file": { "type": ["string", "null"], "description": "Name of its file." },
        "title": text("What it is of."),
        "columns": list("string", "Headings."),
        "rows": list("array", "Numbers, words, or null where there is nothing."),
    }, "required": ["file", "title", "columns", "rows"] });
    let answer = json!({ "type": "object", "properties": {
        "question": text("Its name, as in src/questions."),
        "studies": list("string", "Studies that show it."),
        "answer": text("The answer in words."),
        "facts": { "description": "Every number and name of the words, by its key." },
        "tables": { "type": "array", "items": table, "description": "What shows it." },
    }, "required": ["question", "studies", "answer", "facts", "tables"] });
    json!({ "type": "object", "properties": {
        "schema": { "type": "integer", "description": "Version of the layout." },
        "findings": { "type": "array", "items": answer, "description": "The answers, in the order of a page." },
    }, "required": ["schema", "findings"] })
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
