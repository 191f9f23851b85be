//! What stands for HDF5 where this program was built without it.

use crate::import::formats::frame::{Frame, Wanted};
use std::path::Path;

/// No file can be opened.
pub struct Store;

const ABSENT: &str = "it is HDF5, or its numbers are in HDF5, and this program was built without its feature `hdf5`: build \
                      it with its default features, or write VTU";

impl Store {
    /// Refuses.
    ///
    /// # Errors
    /// Always.
    pub fn open(_: &Path) -> Result<Self, String> {
        Err(ABSENT.to_owned())
    }

    /// Refuses.
    ///
    /// # Errors
    /// Always.
    pub fn numbers(&mut self, _: &str, _: Option<(u64, u64)>) -> Result<(Vec<u64>, Vec<f64>), String> {
        Err(ABSENT.to_owned())
    }

    /// Refuses.
    ///
    /// # Errors
    /// Always.
    pub fn times(&mut self) -> Result<Vec<f64>, String> {
        Err(ABSENT.to_owned())
    }

    /// Refuses.
    ///
    /// # Errors
    /// Always.
    pub fn frame(&mut self, _: usize, _: Wanted) -> Result<Frame, String> {
        Err(ABSENT.to_owned())
    }
}
