//! Files of other programs: recognised by their content, each format read by its own file into one form.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod appended;
pub mod bytes;
pub mod collections;
pub mod frame;
#[cfg(feature = "hdf5")]
pub mod hdf5;
#[cfg(not(feature = "hdf5"))]
#[path = "without_hdf5.rs"]
pub mod hdf5;
pub mod hints;
pub mod import_error;
pub mod input_file;
pub mod legacy_vtk;
pub mod numpy;
pub mod steps;
pub mod vtk_data;
pub mod vtu;
#[cfg(all(test, feature = "hdf5"))]
#[expect(dead_code, reason = "only what refuses is tried here; a build without the feature uses all of it")]
mod without_hdf5;
pub mod xdmf;
pub mod xdmf_states;
pub mod xml;

#[cfg(test)]
mod tests;
