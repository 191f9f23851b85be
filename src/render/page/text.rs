//! Blocks for a terminal: wrapped, without marks and figures.

use crate::render::RenderError;
use crate::render::marked_text::{paragraphs, to_plain, wrapped};
use crate::render::page::walk::{Group, Walk, Writer};
use crate::render::page::{Block, Figure};
use crate::render::table::Table;

/// Blocks in lines of a width, an empty line between them. What a reader of a page opens by a click is left out, unless the whole
/// is wanted; of several views the first is shown.
///
/// # Errors
/// If a table is ragged.
pub fn text_of(blocks: &[Block], width: usize, is_whole: bool) -> Result<String, RenderError> {
    let mut text = Text { parts: Vec::new(), width, is_whole };
    Walk::default().blocks(blocks, &mut text)?;
    Ok(text.parts.join("\n"))
}

struct Text {
    parts: Vec<String>,
    width: usize,
    is_whole: bool,
}

impl<'a> Writer<'a> for Text {
    fn paragraph(&mut self, marked: &'a str) {
        let lines = paragraphs(marked).into_iter().map(|one| wrapped(&to_plain(&one), "", "  ", self.width));
        self.parts.extend(lines);
    }

    fn code(&mut self, lines: &'a str) {
        self.parts.push(lines.trim_end().to_owned() + "\n");
    }

    fn heading(&mut self, words: &'a str) {
        self.parts.push(words.to_owned() + "\n");
    }

    fn list(&mut self, points: &'a [String]) {
        let lines = points.iter().map(|one| wrapped(&to_plain(one), "", "    ", self.width));
        self.parts.push(lines.collect());
    }

    fn table(&mut self, table: &'a Table, _: Option<String>) -> Result<(), RenderError> {
        self.parts.push(table.to_text(self.width)?);
        Ok(())
    }

    fn figure(&mut self, _: &'a Figure, _: Option<usize>) -> Result<(), RenderError> {
        Ok(())
    }

    fn open(&mut self, group: &Group<'a>) -> bool {
        match group {
            Group::Details(summary) if self.is_whole => self.parts.push((*summary).to_owned()),
            Group::Details(_) => return false,
            Group::View(place, _) => return *place == 0,
            _ => {}
        }
        true
    }
}
