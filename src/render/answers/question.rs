//! What the sections of the answer page share: links to studies, and what is said where there is nothing
//! to answer from.

use crate::render::page::{Block, Section};
use crate::render::table::Cell;

/// From the name of a study to where its page is.
pub type Links<'a> = &'a dyn Fn(&str) -> String;

/// A question with its answer.
pub fn section(heading: &str, id: &str, blocks: Vec<Block>) -> Section {
    Section { heading: heading.to_owned(), id: id.to_owned(), mood: None, blocks }
}

/// A question that the records do not answer: what would.
pub fn unanswered(heading: &str, id: &str, needed: &str) -> Section {
    section(heading, id, vec![Block::Paragraph(format!("Not in these records: {needed}."))])
}

/// A link to the page of a study, in running text.
pub fn link(links: Links<'_>, study: &str) -> String {
    format!("[`{study}`]({})", links(study))
}

/// Links to the pages of studies, each once, in running text.
pub fn links_to<'a>(links: Links<'_>, studies: impl IntoIterator<Item = &'a str>) -> String {
    let mut seen: Vec<&str> = Vec::new();
    for study in studies {
        if !seen.contains(&study) {
            seen.push(study);
        }
    }
    seen.iter().map(|study| link(links, study)).collect::<Vec<_>>().join(", ")
}

/// A link to the page of a study, in a table.
pub fn link_cell(links: Links<'_>, study: &str) -> Cell {
    Cell::Link { words: study.to_owned(), target: links(study) }
}
