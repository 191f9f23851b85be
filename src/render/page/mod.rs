//! A page as plain data, and its two writers: one self-contained HTML file, or Markdown with its
//! figures beside it. Both come from the very same description.
//!
//! Running text is lightly marked: `` `code` ``, `**strong**`, `*stressed*`, `[words](target)`; a
//! blank line ends a paragraph. Symbols such as `T_v` get their subscripts by themselves.

pub mod html_page;
pub mod links;
pub mod markdown_page;
pub mod marked_text;

use crate::render::chart::describe::Chart;
use crate::render::number;
use crate::render::render_error::RenderError;
use crate::render::table::{Mood, Table};
use std::borrow::Cow;
use std::sync::OnceLock;

/// A page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Heading of the whole.
    pub title: String,
    /// What the reader should know first.
    pub lead: String,
    /// What must not be overlooked, below the lead.
    pub callout: Option<Callout>,
    /// The sections, in order.
    pub sections: Vec<Section>,
    /// Small print at the end: what made the page, out of what.
    pub footer: String,
    /// Whether it takes the width of a screen, without a list of its sections beside it.
    pub is_wide: bool,
    /// Words of a box that hides the rows of tables which do not have what is typed; none for no box.
    pub filter: Option<String>,
    /// Name of its files: its tables and figures are then to be had as files, and the page links to them.
    pub files: Option<String>,
}

/// A sentence that must not be overlooked, lightly marked.
pub type Callout = (Mood, String);

/// A section with a heading and an anchor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// The anchor: lower-case letters, digits, `-`, `_` and `.`.
    pub id: String,
    /// A mark at the heading and in the table of contents: how the section ended.
    pub mood: Option<Mood>,
    /// What stands in it.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// Running text, lightly marked.
    Paragraph(String),
    /// A smaller heading.
    Heading(String),
    /// Points, each lightly marked.
    List(Vec<String>),
    /// A table.
    Table(Table),
    /// A figure.
    Figure(Figure),
    /// Figures side by side, where there is room.
    Figures(Vec<Figure>),
    /// A sentence that must not be overlooked, lightly marked.
    Callout(Mood, String),
    /// What only some readers want to see.
    Details {
        /// The line that is always seen.
        summary: String,
        /// What it opens.
        blocks: Vec<Block>,
    },
}

/// A figure on a page.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name of its file, without an ending: lower-case letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// What it shows, drawn when the page is written.
    pub chart: Box<Chart>,
    /// What is said below it, lightly marked.
    pub caption: String,
    /// The chart as drawn, once it is.
    drawn: OnceLock<String>,
}

impl Figure {
    /// A figure of a chart.
    pub fn new(name: impl Into<String>, chart: Chart, caption: impl Into<String>) -> Self {
        let (name, caption) = (name.into(), caption.into());
        Self { name, chart: Box::new(chart), caption, drawn: OnceLock::new() }
    }

    /// The chart as SVG: drawn once, for the page and for the file beside it.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn svg(&self) -> Result<&str, RenderError> {
        if let Some(drawn) = self.drawn.get() {
            return Ok(drawn);
        }
        let drawn = self.chart.svg()?;
        Ok(self.drawn.get_or_init(|| drawn))
    }

    /// The same figure of another chart.
    #[must_use]
    pub fn with_chart(mut self, change: impl FnOnce(&mut Chart)) -> Self {
        change(&mut self.chart);
        self.drawn = OnceLock::new();
        self
    }
}

/// The figures of a page: file name (without a folder) and SVG.
///
/// # Errors
/// If a name is unusable or used twice, or a figure cannot be drawn.
pub fn figures(page: &Page) -> Result<Vec<(String, String)>, RenderError> {
    check(page)?;
    all_figures(page)
        .into_iter()
        .map(|figure| Ok((format!("{}.svg", figure.name), figure.svg()?.to_owned())))
        .collect()
}

/// Every figure of a page, in order.
pub(crate) fn all_figures(page: &Page) -> Vec<&Figure> {
    fn collect<'a>(blocks: &'a [Block], out: &mut Vec<&'a Figure>) {
        for block in blocks {
            match block {
                Block::Figure(figure) => out.push(figure),
                Block::Figures(figures) => out.extend(figures),
                Block::Details { blocks, .. } => collect(blocks, out),
                _ => {}
            }
        }
    }
    let mut out = Vec::new();
    page.sections.iter().for_each(|s| collect(&s.blocks, &mut out));
    out
}

/// The tables of a page with the names of their files, without an ending, in order.
pub fn tables(page: &Page) -> Vec<(String, &Table)> {
    fn collect<'a>(blocks: &'a [Block], out: &mut Vec<&'a Table>) {
        for block in blocks {
            match block {
                Block::Table(table) => out.push(table),
                Block::Details { blocks, .. } => collect(blocks, out),
                _ => {}
            }
        }
    }
    let mut out = Vec::new();
    page.sections.iter().for_each(|section| collect(&section.blocks, &mut out));
    let name = page.files.as_deref().unwrap_or("page");
    out.into_iter().enumerate().map(|(place, table)| (table_file(name, place + 1), table)).collect()
}

/// Rows of a table that a page shows where the table is to be had as a file too: more of them nobody reads, and a study
/// of ten thousand cases must not make a page that no browser opens.
const MOST_ROWS: usize = 200;

/// What a page shows of a table whose file has the given name, and what it says of the rest.
pub(crate) fn shown_rows<'a>(table: &'a Table, file: Option<&str>) -> (Cow<'a, Table>, Option<String>) {
    let Some(file) = file.filter(|_| table.rows.len() > MOST_ROWS) else {
        return (Cow::Borrowed(table), None);
    };
    let all = number::count(table.rows.len() as u64);
    let rest = format!("The first {MOST_ROWS} of {all} rows: [the whole table](tables/{file}.csv).");
    (table.first_rows(MOST_ROWS), Some(rest))
}

/// The name of the file of a page's table, counted from one.
pub(crate) fn table_file(page: &str, number: usize) -> String {
    format!("{page}-table-{number}")
}

/// Names become files and anchors: they must be safe, and each its own.
pub(crate) fn check(page: &Page) -> Result<(), RenderError> {
    let ids: Vec<&str> = page.sections.iter().map(|s| s.id.as_str()).collect();
    let names: Vec<&str> = all_figures(page).iter().map(|f| f.name.as_str()).collect();
    for list in [&ids, &names] {
        for (i, &name) in list.iter().enumerate() {
            let usable = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
            if name.is_empty() || name.starts_with('.') || !name.chars().all(usable) {
                return Err(RenderError::Name { name: name.to_owned() });
            }
            if list[..i].contains(&name) {
                return Err(RenderError::Duplicate { title: page.title.clone(), name: name.to_owned() });
            }
        }
    }
    Ok(())
}

/// A text as a usable name: `GC-SRI-patch, T_v = 0.1` becomes `gc-sri-patch-t_v-0.1`.
pub fn slug(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().flat_map(char::to_lowercase) {
        if c.is_ascii_alphanumeric() || matches!(c, '_' | '.') {
            out.push(c);
        } else if !out.is_empty() && !out.ends_with('-') {
            out.push('-');
        }
    }
    out.trim_matches(['-', '.']).to_owned()
}

#[cfg(test)]
mod tests;
