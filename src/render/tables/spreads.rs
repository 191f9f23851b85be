//! The table of measured spreads.

use crate::judge::scatter::ValueScatter;
use crate::render::table::{Cell, Table, columns};

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
                None => Cell::missing("every bit is equal"),
            },
        ]
    });
    Table::of(
        "spread of results that should be equal",
        columns(
            "study | against | > values | > unpaired | > differing | > largest difference | > relative \
                 | > tolerance from it | widest at",
        ),
        rows,
    )
    .note(
        "a tolerance is ten times the spread; a golden value takes that of its own quantity, case \
             and time",
    )
}
