//! Readers of the result files of other programs: VTU, PVTU, PVD and legacy VTK, XDMF and HDF5, Exodus II, gmsh, NPZ and NPY.
//!
//! A file is recognised by its content ([`Kind::of`]), its states are listed ([`steps_of`]), and each state is read into
//! one form, a [`Frame`] ([`read_states`]). Every reader refuses damaged files with a sentence and bounds the memory by
//! the size of the file.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bytes;
mod cells;
mod collections;
mod exodus;
mod frame;
mod gmsh;
mod hdf5;
pub mod input_file;
mod legacy_vtk;
mod named_files;
mod numpy;
mod pflotran;
mod steps;
mod times;
mod unread;
mod vtk_data;
mod vtkhdf;
mod vtu;
mod xdmf;
mod xdmf_states;
mod xml;
mod xpath;

pub use bytes::{bare_number, excerpt, with_exponent};
pub use cells::Cells;
pub use collections::collection_of;
pub use frame::{Array, Association, Frame, OtherPoints, Wanted};
pub use hdf5::linked;
pub use named_files::with_named;
pub use steps::{Kind, Step, read_states, steps_of};
pub use times::{Axis, States, Use, states_by_time};

use std::path::{Path, PathBuf};

#[cfg(test)]
mod tests;

/// Longest reason in an error, bytes.
const LONGEST_REASON: usize = 4000;

/// Why a result cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file cannot be opened or read.
    #[error("cannot read {path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The content of the file is damaged, incomplete or not what its mapping says.
    #[error("{place}: {reason}")]
    Content {
        /// The file, and the line where it is a table.
        place: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
}

impl ImportError {
    /// An error about the content of a file.
    pub fn content(path: &Path, reason: impl Into<String>) -> Self {
        Self::at(path.display().to_string(), reason.into())
    }

    /// An error about one line of a file, counted from 1.
    pub fn line(path: &Path, line: u64, reason: impl Into<String>) -> Self {
        Self::at(format!("{}:{line}", path.display()), reason.into())
    }

    /// An error about a place in a result. Reasons quote the file, which may be one long line, so they are truncated.
    fn at(place: String, mut reason: String) -> Self {
        if reason.len() > LONGEST_REASON {
            let end = (0..=LONGEST_REASON).rfind(|end| reason.is_char_boundary(*end));
            reason.truncate(end.unwrap_or(0));
            reason.push('…');
        }
        Self::Content { place, reason }
    }

    /// Adds the path to an error of the system.
    pub fn io(path: &Path) -> impl Fn(std::io::Error) -> Self + '_ {
        |source| Self::Io { path: path.to_owned(), source }
    }
}
