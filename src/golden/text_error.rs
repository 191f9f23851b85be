//! Why a text is not a golden file.

use crate::golden::LAYOUT;
use crate::golden::measure::UnknownMeasure;

/// Why a text is not a golden file, or a golden file is not text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GoldenTextError {
    /// The last line has no end.
    #[error("line {line}: the file ends within this line")]
    CutOff {
        /// Counted from 1.
        line: usize,
    },
    /// The first line is wrong.
    #[error("line 1: it does not begin with `# golden {LAYOUT} · STUDY`")]
    Title,
    /// The second line is wrong.
    #[error("line 2: it is not `# reason: WHY`")]
    Reason,
    /// The header of an older layout is wrong.
    #[error("line {line}: {}", source.message())]
    Header {
        /// Counted from 1.
        line: usize,
        /// What TOML says.
        source: toml::de::Error,
    },
    /// The layout is another one.
    #[error("it has layout {0}; this program reads layouts 2 to {LAYOUT}")]
    Layout(String),
    /// The table has other columns.
    #[error("its table does not begin with the columns `{}`", .0.join("`, `"))]
    Columns(&'static [&'static str]),
    /// A column is of nothing that is kept.
    #[error(transparent)]
    Column(#[from] UnknownMeasure),
    /// The table is none.
    #[error(transparent)]
    Table(#[from] csv::Error),
    /// A row of the table is wrong.
    #[error("line {line}: {source}")]
    Row {
        /// Counted from 1.
        line: u64,
        /// What is wrong with it.
        source: CellError,
    },
    /// The values cannot be written.
    #[error(transparent)]
    Unwritten(Box<dyn std::error::Error + Send + Sync>),
}

impl GoldenTextError {
    pub(super) fn unwritten(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Unwritten(Box::new(error))
    }
}

/// What is wrong with a cell of the table of golden values.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CellError {
    /// It has no number.
    #[error("`{cell}` under `{title}` is not a number")]
    NoNumber {
        /// What it has instead.
        cell: String,
        /// Title of the column.
        title: String,
    },
    /// Another column has the same title.
    #[error("`{title}` occurs twice for this case and time factor")]
    Twice {
        /// The title.
        title: String,
    },
}
