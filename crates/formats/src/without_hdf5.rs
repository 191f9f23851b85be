//! What stands for HDF5 where this program was built without it.

use crate::frame::{Frame, Wanted};
use std::path::Path;

/// A file that could be opened: there is none.
pub enum Store {}

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

    /// Never called, for nothing can be opened.
    pub fn renew_budget(&mut self) {
        match *self {}
    }

    /// The same.
    ///
    /// # Errors
    /// None.
    pub fn numbers(&mut self, _: &str, _: Option<(u64, u64)>) -> Result<(Vec<u64>, Vec<f64>), String> {
        match *self {}
    }

    /// The same.
    ///
    /// # Errors
    /// None.
    pub fn times(&mut self) -> Result<Vec<f64>, String> {
        match *self {}
    }

    /// The same.
    ///
    /// # Errors
    /// None.
    pub fn frame(&mut self, _: usize, _: Wanted) -> Result<Frame, String> {
        match *self {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_asks_for_hdf5_is_told_what_is_missing_and_what_to_do() {
        let told = Store::open(Path::new("a.h5")).map(|_| ()).expect_err("refused");
        assert!(
            told.contains("feature `hdf5`") && told.contains("build it with its default features"),
            "{told}"
        );
    }
}
