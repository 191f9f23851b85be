//! `oedometer schema`: JSON Schemas of study files, records and mappings.

use crate::cli::exit::Exit;
use crate::cli::output::json_of;
use crate::cli::stream::print_data;
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
    print_data(&json_of(&schema_of(arguments.document))?)?;
    Ok(Exit::Pass)
}
