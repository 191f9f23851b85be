//! The table of measured spreads.

use crate::judge::scatter::ValueScatter;
use crate::render::table::{Cell, Table, TableColumn};

/// One row a study and source.
pub fn table_of(spreads: &[ValueScatter]) -> Table {
    let rows = spreads.iter().map(|spread| {
        vec![
            spread.study.as_str().into(),
            spread.source.as_str().into(),
            Cell::Count(spread.values as u64),
            Cell::Count(spread.unpaired as u64),
            Cell::Count(spread.differing as u64),
            Cell::Error(spread.absolute),
            Cell::Error(spread.relative),
            Cell::Error(spread.tolerance()),
            match &spread.place {
                Some(place) => Cell::Code(place.clone()),
                None => Cell::Missing("every bit is equal".to_owned()),
            },
        ]
    });
    Table {
        title: "spread of results that should be equal".to_owned(),
        columns: vec![
            TableColumn::text("study"),
            TableColumn::text("against"),
            TableColumn::number("values"),
            TableColumn::number("unpaired"),
            TableColumn::number("differing"),
            TableColumn::number("largest difference"),
            TableColumn::number("relative"),
            TableColumn::number("tolerance from it"),
            TableColumn::text("widest at"),
        ],
        rows: rows.collect(),
        notes: vec![
            "a tolerance is ten times the spread; a golden value takes that of its own quantity, case and time".to_owned(),
        ],
    }
}
