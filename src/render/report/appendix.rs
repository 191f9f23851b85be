//! How the numbers were made: norms, references with their truncation, provenance.

use crate::case::norm::Norm;
use crate::render::page::{Block, Section};
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, TableColumn};
use std::collections::BTreeMap;

/// Norms, references and provenance.
pub fn section(results: &[StudyResults<'_>]) -> Section {
    let norms = Norm::ALL.iter().map(|norm| vec![Cell::Code(norm.name().to_owned()), norm.formula().into()]);
    let mut used: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for reference in results.iter().flat_map(|one| one.records).flat_map(|record| &record.references) {
        let entry = used.entry(reference.name.as_str()).or_default();
        entry.0 = entry.0.max(reference.terms);
        entry.1 = entry.1.max(reference.tail_bound);
    }
    let references = used.iter().map(|(name, (terms, tail))| {
        vec![Cell::Code((*name).to_owned()), Cell::Count(*terms as u64), Cell::Error(*tail)]
    });
    let blocks = vec![
        Block::Table(Table {
            title: "Norms".to_owned(),
            columns: vec![TableColumn::text("norm"), TableColumn::text("formula: x computed, x̂ exact, V volume of a sample")],
            rows: norms.collect(),
            notes: vec!["the exact field is evaluated at the Lagrangian place of the sample".to_owned()],
        }),
        Block::Table(Table {
            title: "References".to_owned(),
            columns: vec![
                TableColumn::text("reference"),
                TableColumn::number("terms at most"),
                TableColumn::number("tail bound, over the load"),
            ],
            rows: references.collect(),
            notes: vec![
                "terzaghi: with the water's compressibility; terzaghi-incompressible: the textbook's; single-mode: \
                 slowest mode, with the water's compressibility"
                    .to_owned(),
            ],
        }),
    ];
    Section { heading: "How the numbers were made".to_owned(), id: "how".to_owned(), mood: None, blocks }
}

/// What made the page.
pub fn footer(results: &[StudyResults<'_>]) -> String {
    let provenance = results.iter().flat_map(|one| one.records).map(|record| &record.provenance).next();
    provenance.map_or(String::new(), |origin| {
        format!(
            "oedometer {}, sources {}, {}, {}, {} profile",
            origin.version, origin.sources, origin.compiler, origin.target, origin.profile
        )
    })
}
