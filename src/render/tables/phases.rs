//! The table of where the time of a case went.

use crate::record::{PhaseTime, Record};
use crate::render::table::{Cell, Table, TableColumn};

/// One row a phase, in the order of a run, with its share and what it costs a point and step.
pub fn phases_table(phases: &[PhaseTime], record: &Record) -> Table {
    let updates = record.counters.point_updates.max(1) as f64;
    let rows = phases.iter().map(|time| {
        vec![
            time.phase.name().into(),
            Cell::Percent(time.share),
            Cell::Number(1e3 * time.seconds),
            Cell::Number(1e9 * time.seconds / updates),
            Cell::Count(time.entries),
        ]
    });
    Table {
        title: "where the time went".to_owned(),
        columns: vec![
            TableColumn::text("phase"),
            TableColumn::number("share"),
            TableColumn::number("time").unit("ms"),
            TableColumn::number("a point and step").unit("ns"),
            TableColumn::number("entered"),
        ],
        rows: rows.collect(),
        notes: vec![
            "wall time without that of the clock, which is read where a phase begins; a run without it is faster"
                .to_owned(),
        ],
    }
}
