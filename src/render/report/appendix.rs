//! How the numbers were made: norms, references with their truncation, provenance.

use crate::case::norm::Norm;
use crate::render::page::{Block, Section};
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};
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
        Block::Table(
            Table::of("Norms", columns("norm | formula: x computed, x̂ exact, V volume of a sample"), norms)
                .note("the exact field is evaluated at the Lagrangian place of the sample"),
        ),
        Block::Table(
            Table::of(
                "References",
                columns("reference | > terms at most | > tail bound, over the load"),
                references,
            )
            .note(
                "terzaghi: with the water's compressibility; terzaghi-incompressible: the textbook's; \
                 single-mode: slowest mode, with the water's compressibility",
            ),
        ),
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
