//! A table as plain data, and its writers: text, Markdown, HTML, CSV and LaTeX.

pub mod csv_table;
pub mod html_table;
pub mod latex_table;
pub mod markdown_table;
pub mod text_table;

use crate::render::number;
use crate::render::render_error::RenderError;
use std::borrow::Cow;

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// One line above the table.
    pub title: String,
    /// The columns, from left to right.
    pub columns: Vec<TableColumn>,
    /// The rows, each with a cell for every column.
    pub rows: Vec<Vec<Cell>>,
    /// Lines below the table.
    pub notes: Vec<String>,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableColumn {
    /// What stands in the column.
    pub header: String,
    /// The unit, if the numbers have one.
    pub unit: Option<String>,
    /// How the cells are aligned.
    pub align: Align,
}

/// Where a cell's text stands in its column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// At the left: words.
    Left,
    /// At the right: numbers.
    Right,
}

impl TableColumn {
    /// A column of words.
    pub fn text(header: impl Into<String>) -> Self {
        Self { header: header.into(), unit: None, align: Align::Left }
    }

    /// A column of numbers without a unit.
    pub fn number(header: impl Into<String>) -> Self {
        Self { align: Align::Right, ..Self::text(header) }
    }

    /// The same column with a unit.
    #[must_use]
    pub fn unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Header and unit on one line.
    pub(crate) fn heading(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.header),
            None => self.header.clone(),
        }
    }
}

/// Columns from a header as it reads: parted by `|`, `>` before one of numbers, its unit in brackets, as in
/// `case | > predicted [s] | verdict`.
pub fn columns(header: &str) -> Vec<TableColumn> {
    let column = |cell: &str| match cell.trim().strip_prefix('>').map(str::trim) {
        None => TableColumn::text(cell.trim()),
        Some(number) => match number.strip_suffix(']').and_then(|number| number.split_once(" [")) {
            Some((name, unit)) => TableColumn::number(name).unit(unit),
            None => TableColumn::number(number),
        },
    };
    header.split('|').map(column).collect()
}

/// A cell. Every kind of number is spelled in one way throughout all reports.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A name as it is typed: a method, a key, a command.
    Code(String),
    /// An error: `5.62e-3`.
    Error(f64),
    /// An order: `2.00`.
    Order(f64),
    /// An order and the half-width of its interval: `1.98 ± 0.03`.
    OrderWithin(f64, f64),
    /// A number of things.
    Count(u64),
    /// A share, shown as a percentage.
    Percent(f64),
    /// A time.
    Seconds(f64),
    /// Any other quantity.
    Number(f64),
    /// A judgement.
    Verdict(Mood, String),
    /// Words that lead to a page.
    Link {
        /// What is read.
        words: String,
        /// Where it leads: a path or an address.
        target: String,
    },
    /// A judgement that leads to the page that carries it.
    Evidence {
        /// The judgement.
        mood: Mood,
        /// What is read.
        words: String,
        /// Where it leads: a path or an address.
        target: String,
    },
    /// Nothing, and why.
    Missing(String),
}

/// What a judgement means to the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    /// As expected.
    Pass,
    /// Not as expected.
    Fail,
    /// Neither: to be known.
    Note,
}

impl Mood {
    /// What a judgement that is met or not means.
    pub fn of(is_met: bool) -> Self {
        if is_met { Self::Pass } else { Self::Fail }
    }

    /// A mark that reads without colours.
    pub(crate) fn mark(self) -> &'static str {
        match self {
            Self::Pass => "✓",
            Self::Fail => "✗",
            Self::Note => "•",
        }
    }

    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Note => "note",
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl Cell {
    /// Nothing, and why.
    pub fn missing(why: &str) -> Self {
        Self::Missing(why.to_owned())
    }

    /// A value where there is one, else why there is none.
    pub fn of(value: Option<f64>, kind: fn(f64) -> Self, why: &str) -> Self {
        value.map_or_else(|| Self::missing(why), kind)
    }

    /// The number that a cell is sorted by, where its words do not tell it.
    pub(crate) fn value(&self) -> Option<f64> {
        match self {
            Self::Error(v)
            | Self::Order(v)
            | Self::OrderWithin(v, _)
            | Self::Percent(v)
            | Self::Seconds(v)
            | Self::Number(v) => Some(*v),
            Self::Count(n) => Some(*n as f64),
            _ => None,
        }
    }

    /// What the cell says; why something is missing is left to the footnotes.
    pub(crate) fn show(&self) -> String {
        match self {
            Self::Text(text) | Self::Code(text) | Self::Link { words: text, .. } => text.clone(),
            Self::Error(v) => number::error(*v),
            Self::Order(v) => number::order(*v),
            Self::OrderWithin(v, half) => {
                format!("{} ± {}", number::order(*v), number::order(*half))
            }
            Self::Count(n) => number::count(*n),
            Self::Percent(v) => number::percent(*v),
            Self::Seconds(v) => number::seconds(*v),
            Self::Number(v) => number::number(*v),
            Self::Verdict(mood, text) | Self::Evidence { mood, words: text, .. } => {
                format!("{} {text}", mood.mark())
            }
            Self::Missing(_) => "–".to_owned(),
        }
    }
}

impl Table {
    /// A table of rows under a title.
    pub fn of(
        title: impl Into<String>,
        columns: Vec<TableColumn>,
        rows: impl IntoIterator<Item = Vec<Cell>>,
    ) -> Self {
        Self { title: title.into(), columns, rows: rows.into_iter().collect(), notes: Vec::new() }
    }

    /// The same table with one more line below it.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The same table with more lines below it.
    #[must_use]
    pub fn notes(mut self, notes: impl IntoIterator<Item = String>) -> Self {
        self.notes.extend(notes);
        self
    }

    /// The table with its first rows only, where it has more than so many.
    pub(crate) fn first_rows(&self, most: usize) -> Cow<'_, Self> {
        if self.rows.len() <= most {
            return Cow::Borrowed(self);
        }
        let Self { title, columns, rows, notes } = self;
        Cow::Owned(Self {
            title: title.clone(),
            columns: columns.clone(),
            rows: rows[..most].to_vec(),
            notes: notes.clone(),
        })
    }

    /// Refuses a row with too few or too many cells.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let expected = self.columns.len();
        match self.rows.iter().position(|row| row.len() != expected) {
            None => Ok(()),
            Some(i) => Err(RenderError::Ragged {
                title: self.title.clone(),
                row: i + 1,
                found: self.rows[i].len(),
                expected,
            }),
        }
    }

    /// The lines below the table: footnotes with their marks, then notes without.
    pub(crate) fn lines_below(&self) -> Vec<(Option<String>, &str)> {
        let footnotes = self.footnotes().into_iter().enumerate().map(|(i, note)| (Some(mark(i)), note));
        footnotes.chain(self.notes.iter().map(|note| (None, note.as_str()))).collect()
    }

    /// The reasons for what is missing, each once, in the order of their first appearance.
    pub(crate) fn footnotes(&self) -> Vec<&str> {
        let mut reasons: Vec<&str> = Vec::new();
        for cell in self.rows.iter().flatten() {
            if let Cell::Missing(reason) = cell
                && !reason.is_empty()
                && !reasons.contains(&reason.as_str())
            {
                reasons.push(reason);
            }
        }
        reasons
    }
}

/// The mark of a footnote: a, b, … z, then numbers.
fn mark(i: usize) -> String {
    match u8::try_from(i) {
        Ok(n) if n < 26 => char::from(b'a' + n).to_string(),
        _ => (i + 1).to_string(),
    }
}

/// What a cell says with the mark of its footnote, if it has one.
pub(crate) fn marked(cell: &Cell, footnotes: &[&str]) -> (String, Option<String>) {
    let place = match cell {
        Cell::Missing(reason) => footnotes.iter().position(|f| f == reason),
        _ => None,
    };
    (cell.show(), place.map(mark))
}

#[cfg(test)]
mod tests;
