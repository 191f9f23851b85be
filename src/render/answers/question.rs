//! What the sections of the answer page share: how a question is answered or left open, links to studies, and
//! tables that are read and not searched.

use crate::render::page::{Block, Section};
use crate::render::table::{Cell, Table};

/// From the name of a study to where its page is.
pub type Links<'a> = &'a dyn Fn(&str) -> String;

/// Rows of a table that is read and not searched.
pub const MOST_ROWS: usize = 10;

/// What a reader asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Question {
    /// The question, a heading.
    pub heading: &'static str,
    /// Its anchor.
    pub id: &'static str,
}

/// What the records say to a question.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// A section: a sentence first, then a short table or figures.
    Told(Section),
    /// Nothing, and what would answer it: a noun, lightly marked.
    Open {
        /// The question.
        question: Question,
        /// What the records lack.
        needed: String,
    },
}

impl Question {
    /// The answer: a sentence, and what shows it.
    pub fn told(self, sentence: impl Into<String>, mut shown: Vec<Block>) -> Answer {
        shown.insert(0, Block::Paragraph(sentence.into()));
        Answer::Told(Section {
            heading: self.heading.to_owned(),
            id: self.id.to_owned(),
            mood: None,
            blocks: shown,
        })
    }

    /// No answer, and what would give one.
    pub fn open(self, needed: impl Into<String>) -> Answer {
        Answer::Open { question: self, needed: needed.into() }
    }
}

/// The table cut to what is read, with a line on where the other rows are.
pub fn short(mut table: Table, elsewhere: &str) -> Table {
    let more = table.rows.len().saturating_sub(MOST_ROWS);
    table.rows.truncate(MOST_ROWS);
    if more > 0 { table.note(format!("{more} more: {elsewhere}")) } else { table }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::table::columns;

    #[test]
    fn a_table_of_the_answers_ends_after_ten_rows_and_says_where_the_others_are() {
        let table =
            |rows: usize| Table::of("", columns("a"), (0..rows).map(|row| vec![Cell::Count(row as u64)]));
        let cut = short(table(12), "in the studies");
        assert_eq!((cut.rows.len(), cut.notes.as_slice()), (10, &["2 more: in the studies".to_owned()][..]));
        assert_eq!(short(table(10), "in the studies"), table(10));
    }
}
