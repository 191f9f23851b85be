//! `oedometer schema`: JSON Schemas of study files, records and mappings.

use super::exit::Exit;
use crate::schema::{Document, schema_of};

/// Arguments of `schema`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// What the schema is of
    #[arg(value_enum, default_value_t = Document::Study)]
    document: Document,
}

/// Prints the schema.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    println!("{}", serde_json::to_string_pretty(&schema_of(arguments.document)?)?);
    Ok(Exit::Pass)
}
