//! A page as plain data. One walk over it feeds three writers: HTML, Markdown and text say the same in the same order.
//!
//! Running text is lightly marked: `` `code` ``, `**strong**`, `*stressed*`, `[words](target)`; a
//! blank line ends a paragraph. Symbols such as `T_v` get their subscripts by themselves.

mod contents;
mod html;
mod markdown;
mod text;
mod walk;

pub(crate) use contents::{all_figures, tables_in};
pub use contents::{figures, tables};
pub use html::render_html;
pub use markdown::{markdown_of, render_markdown};
pub use text::text_of;

use crate::render::chart::Chart;
use crate::render::table::{Mood, Table};
use crate::render::{RenderError, number, palette};
use std::borrow::Cow;
use std::sync::OnceLock;

/// A page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Heading of the whole.
    pub title: String,
    /// Links at the top, each with its words and target; the first leads back to the front page.
    pub links: Vec<(String, String)>,
    /// Text before the sections.
    pub lead: String,
    /// The main result, below the lead.
    pub callout: Option<Callout>,
    /// The sections, in order.
    pub sections: Vec<Section>,
    /// Small print at the end.
    pub footer: String,
    /// Whether it takes the whole width of a screen, without a list of its sections beside it.
    pub is_wide: bool,
    /// Hint in the box that filters the rows of tables; no box if `None`.
    pub filter: Option<String>,
    /// Name of its files. If set, the page links to its tables and figures as files.
    pub files: Option<String>,
}

/// A highlighted sentence, lightly marked.
pub type Callout = (Mood, String);

/// A section with a heading and an anchor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// The anchor: lower-case letters, digits, `-`, `_` and `.`.
    pub id: String,
    /// A mark at the heading and in the table of contents.
    pub mood: Option<Mood>,
    /// Its content.
    pub blocks: Vec<Block>,
}

impl Section {
    /// A section without a mark.
    pub fn new(heading: impl Into<String>, id: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self { heading: heading.into(), id: id.into(), mood: None, blocks }
    }
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// Running text, lightly marked.
    Paragraph(String),
    /// Lines to be copied as they are.
    Code(String),
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
    /// Blocks with others beside them, where there is room.
    Beside(Vec<Self>, Vec<Self>),
    /// Blocks of which one is shown at a time, the first one first, each with the word that shows it.
    Switch(Vec<(String, Vec<Block>)>),
    /// Blocks that the reader opens.
    Details {
        /// The visible line.
        summary: String,
        /// The hidden blocks.
        blocks: Vec<Block>,
    },
}

/// A figure on a page.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name of its file, without an ending: lower-case letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// The chart, drawn when the page is written.
    pub chart: Box<Chart>,
    /// The caption, lightly marked.
    pub caption: String,
    /// The SVG, once drawn, and that for a phone, where it does not fit one.
    drawn: OnceLock<(String, Option<String>)>,
}

impl Figure {
    /// A figure of a chart.
    pub fn new(name: impl Into<String>, chart: Chart, caption: impl Into<String>) -> Self {
        let (name, caption) = (name.into(), caption.into());
        Self { name, chart: Box::new(chart), caption, drawn: OnceLock::new() }
    }

    /// The chart as SVG, drawn once for the page and its file.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn svg(&self) -> Result<&str, RenderError> {
        Ok(&self.both()?.0)
    }

    /// The chart for the screen of a phone, where it does not fit one.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn narrow_svg(&self) -> Result<Option<&str>, RenderError> {
        Ok(self.both()?.1.as_deref())
    }

    fn both(&self) -> Result<&(String, Option<String>), RenderError> {
        if let Some(drawn) = self.drawn.get() {
            return Ok(drawn);
        }
        let drawn = (self.chart.svg()?, self.chart.narrow_svg()?);
        Ok(self.drawn.get_or_init(|| drawn))
    }

    /// The chart as an SVG that stands alone: dark where the reader's screen is.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn standalone_svg(&self) -> Result<String, RenderError> {
        let dark = format!("<style>{}</style>", palette::dark_rules(":root"));
        Ok(self.svg()?.replacen('>', &format!(">\n{dark}"), 1))
    }

    /// Changes the chart.
    #[must_use]
    pub fn with_chart(mut self, change: impl FnOnce(&mut Chart)) -> Self {
        change(&mut self.chart);
        self.drawn = OnceLock::new();
        self
    }
}

/// Rows that a page shows of a table that also has a file, so that a study of ten thousand cases makes a page that
/// browsers open.
const MOST_ROWS: usize = 200;

/// The part of a table that a page shows if the table has a file, and a sentence on the rest.
pub(crate) fn shown_rows<'a>(table: &'a Table, file: Option<&str>) -> (Cow<'a, Table>, Option<String>) {
    let most = table.shown.unwrap_or(MOST_ROWS).min(MOST_ROWS);
    let Some(file) = file.filter(|_| table.rows.len() > most) else {
        return (Cow::Borrowed(table), None);
    };
    let all = number::count(table.rows.len() as u64);
    let rest = format!("The first {most} of {all} rows: [the whole table](tables/{file}.csv).");
    let shown = Table { rows: table.rows[..most].to_vec(), shown: None, ..table.clone() };
    (Cow::Owned(shown), Some(rest))
}

/// The name of the file of a page's table: its own name, or its number among those without one.
pub(crate) fn table_file(page: &str, number: usize, table: &Table) -> String {
    match &table.file {
        Some(name) => format!("{page}-{name}"),
        None => format!("{page}-table-{number}"),
    }
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
