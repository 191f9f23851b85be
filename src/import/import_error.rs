//! Why an external result cannot be taken, in sentences.

use std::path::PathBuf;

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
    /// A column is missing.
    #[error("{path}: there is no column `{name}`; the header has {header}")]
    NoColumn {
        /// Which file.
        path: PathBuf,
        /// Name of the column.
        name: String,
        /// The header.
        header: String,
    },
    /// A layer's table says nothing of the place along it.
    #[error(
        "{path}: there is no column `x`, and a layer's fields depend on it: write the distance of each sample from \
         the crest of the load, m, to a column `x`, or name another with --mapping; the header has {header}"
    )]
    NoDistance {
        /// Which file.
        path: PathBuf,
        /// The header.
        header: String,
    },
    /// A component stands in some files of a result only.
    #[error("`{name}` is a column of some files and not of others: give it in all of them, or in none")]
    NotInAll {
        /// Name of the column.
        name: &'static str,
    },
    /// A file's time is declared nowhere.
    #[error("{path}: its time is declared nowhere; add \"{name}\" = … to [time] files")]
    NoTime {
        /// Which file.
        path: PathBuf,
        /// Its name.
        name: String,
    },
    /// A field is no finite number.
    #[error("{path}:{line}: `{typed}` in the column `{column}` is no finite number")]
    NoNumber {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column.
        column: String,
        /// What stands there.
        typed: String,
    },
    /// A place is outside the column.
    #[error(
        "{path}:{line}: the initial height {height} m is outside the column of {column} m: look at the unit and the \
         sign of `y`, and at whose places they are"
    )]
    Outside {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Height, m.
        height: f64,
        /// Height of the column, m.
        column: f64,
    },
    /// A place is beyond the ends of the layer.
    #[error(
        "{path}:{line}: the initial distance {distance} m from the crest is outside the layer of {length} m: look at \
         the unit, the sign and the origin of `x`, and at whose places they are"
    )]
    Beyond {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Distance, m.
        distance: f64,
        /// Length of the layer, m.
        length: f64,
    },
    /// A weight or a time is negative.
    #[error("{path}:{line}: {what} is negative")]
    Negative {
        /// Which file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What.
        what: &'static str,
    },
    /// There are no rows.
    #[error("{path}: there are no rows")]
    Empty {
        /// Which file.
        path: PathBuf,
    },
}
