//! A table as plain data, and its writers: text, Markdown, HTML, CSV and JSON.

mod writers;

use crate::case::grouping::distinct;
use crate::render::{RenderError, number};
use oedometer_wording::count_of;

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
    /// Name of its file, without that of its page and without an ending; a number where it has none.
    pub file: Option<String>,
    /// Rows that a page or a terminal shows; its file has all.
    pub shown: Option<usize>,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableColumn {
    /// The name of the quantity.
    pub header: String,
    /// The unit, if the numbers have one.
    pub unit: Option<String>,
    /// How the cells are aligned.
    pub align: Align,
}

/// Alignment of the cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// For words.
    Left,
    /// For numbers.
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

    /// Sets the unit.
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

/// Columns from a header such as `case | > predicted [s] | verdict`: separated by `|`, with `>` before a column of
/// numbers and its unit in brackets.
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

/// A cell. Each kind of number has one format in all reports.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A name as the user types it: a method, a key, a command.
    Code(String),
    /// An error: `5.62e-3`.
    Error(f64),
    /// An order: `2.00`.
    Order(f64),
    /// A number of things.
    Count(u64),
    /// A share, shown as a percentage.
    Percent(f64),
    /// A share that someone set, as a percentage without more digits than it has: `0.1 %`.
    Bound(f64),
    /// A quantity as it is given: `0.25`.
    Number(f64),
    /// A quantity that was measured, or a ratio of such, in the form of its own size: `1.00`, `2.40e-13`.
    Measured(f64),
    /// A judgement.
    Verdict(Mood, String),
    /// A link.
    Link {
        /// Its text.
        words: String,
        /// Its target: a path or an address.
        target: String,
    },
    /// One of many small cells on a background that says how good it is, with a link to what it comes from.
    Shaded {
        /// The background.
        shade: Shade,
        /// Its text, a few letters.
        words: String,
        /// The number that it is sorted by.
        value: Option<f64>,
        /// What is shown of it on request.
        title: String,
        /// The target of the link: a path or an address.
        target: String,
    },
    /// A missing value and the reason for it.
    Missing(String),
}

/// The background of a cell: how good it is beside the others of its row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shade {
    /// The best, or as good as the best.
    Best,
    /// Nearly as good.
    Good,
    /// Less good.
    Middling,
    /// Far from the best.
    Poor,
    /// Without a usable result.
    Failed,
    /// Not applicable, or not measured.
    Empty,
}

impl Shade {
    /// The shade of a ratio to the best of a row.
    pub fn of_ratio(ratio: f64) -> Self {
        match ratio {
            ratio if ratio <= 1.0 => Self::Best,
            ratio if ratio <= 2.0 => Self::Good,
            ratio if ratio <= 10.0 => Self::Middling,
            _ => Self::Poor,
        }
    }

    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Best => "s1",
            Self::Good => "s2",
            Self::Middling => "s3",
            Self::Poor => "s4",
            Self::Failed => "s5",
            Self::Empty => "s6",
        }
    }
}

/// How a judgement is to be read.
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
    /// The mood of a judgement that is met or not.
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

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl Cell {
    /// A missing value and the reason for it.
    pub fn missing(why: &str) -> Self {
        Self::Missing(why.to_owned())
    }

    /// The value, or the reason why it is missing.
    pub fn of(value: Option<f64>, kind: fn(f64) -> Self, why: &str) -> Self {
        value.map_or_else(|| Self::missing(why), kind)
    }

    /// The number that a cell is sorted by, if it has one.
    pub(crate) fn value(&self) -> Option<f64> {
        match self {
            Self::Error(v)
            | Self::Order(v)
            | Self::Percent(v)
            | Self::Bound(v)
            | Self::Number(v)
            | Self::Measured(v) => Some(*v),
            Self::Count(n) => Some(*n as f64),
            Self::Shaded { value, .. } => *value,
            _ => None,
        }
    }

    /// The cell as text; the reason for a missing value is left to the footnotes.
    pub(crate) fn show(&self) -> String {
        match self {
            Self::Text(text)
            | Self::Code(text)
            | Self::Link { words: text, .. }
            | Self::Shaded { words: text, .. } => text.clone(),
            Self::Error(v) => number::error(*v),
            Self::Order(v) => number::order(*v),
            Self::Count(n) => number::count(*n),
            Self::Percent(v) => number::percent(*v),
            Self::Bound(v) => number::bound(*v),
            Self::Number(v) => number::rounded(*v),
            Self::Measured(v) => number::significant(*v, 3),
            Self::Verdict(mood, text) => format!("{} {text}", mood.mark()),
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
        Self {
            title: title.into(),
            columns,
            rows: rows.into_iter().collect(),
            notes: Vec::new(),
            file: None,
            shown: None,
        }
    }

    /// The table, if it has rows.
    pub fn unless_empty(self) -> Option<Self> {
        (!self.rows.is_empty()).then_some(self)
    }

    /// Names the file of the table.
    #[must_use]
    pub fn file(mut self, name: impl Into<String>) -> Self {
        self.file = Some(name.into());
        self
    }

    /// Sets how many rows a page or a terminal shows.
    #[must_use]
    pub fn shown(mut self, rows: usize) -> Self {
        self.shown = Some(self.shown.map_or(rows, |shown| shown.min(rows)));
        self
    }

    /// The rows that are shown.
    pub(crate) fn shown_rows(&self) -> &[Vec<Cell>] {
        &self.rows[..self.shown.unwrap_or(self.rows.len()).min(self.rows.len())]
    }

    /// Adds a line below the table.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds lines below the table.
    #[must_use]
    pub fn notes(mut self, notes: impl IntoIterator<Item = String>) -> Self {
        self.notes.extend(notes);
        self
    }

    /// Whether it is a matrix of many small cells.
    pub(crate) fn is_dense(&self) -> bool {
        self.rows.iter().flatten().any(|cell| matches!(cell, Cell::Shaded { .. }))
    }

    /// Per column whether all of its errors have a power of ten, as one of them needs it.
    pub(crate) fn powers(&self) -> Vec<bool> {
        let needs = |cell: &Cell| matches!(cell, Cell::Error(value) if number::error(*value).contains('e'));
        let rows = self.shown_rows();
        (0..self.columns.len()).map(|place| rows.iter().filter_map(|row| row.get(place)).any(needs)).collect()
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

    /// The lines below the table: how many rows are not shown, footnotes with their marks, then notes without.
    pub(crate) fn lines_below(&self) -> Vec<(Option<String>, String)> {
        let more = self.rows.len() - self.shown_rows().len();
        let rest = (more > 0).then(|| (None, format!("and {}", count_of(more, "more row", "more rows"))));
        let footnotes = self.footnotes().into_iter().enumerate();
        let footnotes = footnotes.map(|(i, note)| (Some(mark(i)), note.to_owned()));
        rest.into_iter().chain(footnotes).chain(self.notes.iter().map(|note| (None, note.clone()))).collect()
    }

    /// The reasons for missing values, each once, in the order of their first appearance.
    pub(crate) fn footnotes(&self) -> Vec<&str> {
        let reasons = self.shown_rows().iter().flatten().filter_map(|cell| match cell {
            Cell::Missing(reason) if !reason.is_empty() => Some(reason.as_str()),
            _ => None,
        });
        distinct(reasons)
    }
}

/// The mark of a footnote: a, b, … z, then numbers.
fn mark(i: usize) -> String {
    match u8::try_from(i) {
        Ok(n) if n < 26 => char::from(b'a' + n).to_string(),
        _ => (i + 1).to_string(),
    }
}

/// A cell as text, an error with a power of ten if its column has them, and the mark of its footnote, if it has one.
pub(crate) fn marked(cell: &Cell, footnotes: &[&str], has_power: bool) -> (String, Option<String>) {
    let place = match cell {
        Cell::Missing(reason) => footnotes.iter().position(|f| f == reason),
        _ => None,
    };
    let text = match cell {
        Cell::Error(value) if has_power => number::error_with_power(*value),
        cell => cell.show(),
    };
    (text, place.map(mark))
}

#[cfg(test)]
mod tests;
