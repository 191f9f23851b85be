//! JSON Schemas of what this program reads and writes, for editors and for other programs.
//!
//! They are derived from the very types that read the files, and from the table of keys, so that they cannot
//! fall behind the code.

use crate::foreign::case_file::CaseFile;
use crate::import::mapping::Mapping;
use crate::record::Record;
use crate::study::file::StudyFile;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Value, json};

/// What there is a schema of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Document {
    /// A study file
    Study,
    /// The record of a case
    Record,
    /// The mapping of somebody else's result
    Mapping,
    /// The file that tells an attached solver its case
    Case,
}

/// The JSON Schema of a document.
pub fn schema_of(document: Document) -> Value {
    match document {
        Document::Study => without_null(schema_of_type::<StudyFile>("oedometer study")),
        Document::Record => schema_of_type::<Record>("oedometer record"),
        Document::Case => schema_of_type::<CaseFile>("oedometer case"),
        Document::Mapping => without_null(schema_of_type::<Mapping>("oedometer mapping")),
    }
}

fn schema_of_type<T: JsonSchema>(title: &str) -> Value {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let settings = settings.with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), title.into());
    closed(schema.to_value())
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

/// A schema for TOML, which has no null: a key is left out instead.
fn without_null(mut schema: Value) -> Value {
    if let Some(list) = schema.as_array_mut() {
        list.retain(|one| ![json!(null), json!("null"), json!({ "type": "null" })].contains(one));
    }
    let mut schema = each_part(schema, without_null);
    if let Some(object) = schema.as_object_mut() {
        for word in ["type", "anyOf"] {
            let Some([one]) = object.get(word).and_then(Value::as_array).map(Vec::as_slice) else { continue };
            match one.clone() {
                Value::Object(choice) => {
                    object.remove(word);
                    // What is said of the key goes before what is said of its type.
                    let own = std::mem::replace(object, choice);
                    object.extend(own);
                }
                other => drop(object.insert(word.to_owned(), other)),
            }
        }
    }
    schema
}

/// A value with every part of it changed.
fn each_part(value: Value, change: fn(Value) -> Value) -> Value {
    match value {
        Value::Array(list) => list.into_iter().map(change).collect(),
        Value::Object(object) => object.into_iter().map(|(word, value)| (word, change(value))).collect(),
        other => other,
    }
}

#[cfg(test)]
mod tests;
