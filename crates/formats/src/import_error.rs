//! Why an external result cannot be taken, in sentences.

use std::path::{Path, PathBuf};

/// Longest reason that is told, bytes.
const LONGEST: usize = 4000;

/// Why a result cannot be taken.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file cannot be read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A row cannot be parsed.
    #[error("{path}: {source}")]
    Csv {
        /// Which file.
        path: PathBuf,
        /// Why, with the line.
        source: csv::Error,
    },
    /// A table lacks something.
    #[error("{path}: {reason}")]
    Table {
        /// Which file.
        path: PathBuf,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A row holds what no result can.
    #[error("{path}:{line}: {reason}")]
    Row {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A component stands in some files of a result only.
    #[error("`{name}` is a column of some files and not of others: give it in all of them, or in none")]
    NotInAll {
        /// Name of the column.
        name: &'static str,
    },
}

impl ImportError {
    /// An error of a table.
    pub fn table(path: &Path, reason: impl Into<String>) -> Self {
        let mut reason = reason.into();
        // What it quotes of a file may be the whole of it.
        if reason.len() > LONGEST {
            let end = (0..=LONGEST).rev().find(|end| reason.is_char_boundary(*end)).unwrap_or(0);
            reason.truncate(end);
            reason.push('…');
        }
        Self::Table { path: path.to_owned(), reason }
    }
}
