//! CB-Geo: files written by VTK 9 and HDF5 with the calls of the program's sources (`src/io/vtk_writer.cc` at 061c4a6 and
//! `src/hdf5_particle_twophase.cc` at 98b7763 of `github.com/cb-geo/mpm`).

use crate::score::written_files::{agrees, foreign, score};
use std::fs;
use tempfile::TempDir;

#[test]
fn cb_geos_hdf5_has_its_pore_pressure_in_a_state_variable_of_the_liquid() {
    agrees(&foreign("cb-geo"), &["particles*.h5"], "cb-geo", "1e-6");
    // The solid's pressure is 0 everywhere, and is named as such.
    let folder = TempDir::new().expect("a folder");
    let mapping = folder.path().join("map.toml");
    fs::write(&mapping, "[columns]\np = \"pressure\"\n").expect("a file");
    let mapping = mapping.to_str().expect("UTF-8");
    let more = ["--preset", "cb-geo", "--mapping", mapping, "--set-time-step", "0.8175"];
    let told = score(&foreign("cb-geo"), &["particles*.h5"], &more);
    assert!(told.err.contains("your p is 0 everywhere: is it the wrong array"), "{}", told.err);
}

/// Places of single precision, packed arrays, a stress of nine components.
#[test]
fn cb_geos_vtp_files_have_an_array_each_and_are_joined() {
    agrees(&foreign("cb-geo"), &["*.vtp"], "cb-geo", "1e-6");
}
