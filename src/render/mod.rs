//! Tables, charts and pages made from plain data. Nothing here computes results or knows a solver, and the same
//! description always gives the same bytes.

pub(crate) mod chart;
pub mod escape;
pub(crate) mod marked_text;
pub(crate) mod number;
pub mod page;
pub(crate) mod palette;
pub(crate) mod script;
pub mod table;

/// A description that cannot be drawn or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The drawing library refused a figure.
    #[error("figure `{title}` cannot be drawn: {reason}")]
    Draw {
        /// Title of the figure.
        title: String,
        /// What the drawing library said.
        reason: String,
    },
    /// A template cannot be filled with what was found.
    #[error("a sentence of the page cannot be written: {0}")]
    Template(#[from] minijinja::Error),
    /// Two figures of one page would be written to the same file, or two sections share an anchor.
    #[error("page `{title}` uses the name `{name}` twice")]
    Duplicate {
        /// Title of the page.
        title: String,
        /// The name in question.
        name: String,
    },
    /// A name that cannot be a file name or an anchor.
    #[error("`{name}` is not a usable name: lower-case letters, digits, `-`, `_` and `.` only")]
    Name {
        /// The name in question.
        name: String,
    },
    /// A row of a table has another number of cells than the table has columns.
    #[error("table `{title}`: row {row} has {found} cells for {expected} columns")]
    Ragged {
        /// Title of the table.
        title: String,
        /// Row, counted from one.
        row: usize,
        /// Cells of that row.
        found: usize,
        /// Columns of the table.
        expected: usize,
    },
    /// The CSV writer failed.
    #[error("table `{title}` cannot be written as CSV: {source}")]
    Csv {
        /// Title of the table.
        title: String,
        /// What the writer said.
        source: csv::Error,
    },
}
