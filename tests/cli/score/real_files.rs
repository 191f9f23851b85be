//! Files that other programs have written (`tests/foreign`), and their scores.

use crate::program::{Told, call};
use std::path::{Path, PathBuf};

pub fn files() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign")
}

/// Scores files of a seed column against Terzaghi's solution.
pub fn score(arguments: &[&str]) -> Told {
    let common = ["--scene", "terzaghi", "--reference", "terzaghi", "--format", "csv"];
    call(&files(), &[&["score"], arguments, &common].concat())
}

/// Values of the rows of a quantity and norm, by time; of several results one after the other.
pub fn values(told: &Told, row: &str) -> Vec<f64> {
    assert_eq!(told.code, 0, "{}", told.err);
    let header = told.out.lines().next().expect("a header");
    let column = header.split(',').position(|name| name == "value").expect("a column of values");
    let rows = told.out.lines().filter(|line| line.contains(row));
    rows.map(|line| line.split(',').nth(column).expect("a value").parse().expect("a number")).collect()
}

/// Whether numbers are those of a table, to the half of its last digit; a sign counts.
pub fn are(found: &[f64], table: &[&str]) -> bool {
    let as_shown = |(value, shown): (&f64, &&str)| {
        let digits = shown.split('e').next().unwrap_or_default().split('.').nth(1).map_or(0, str::len);
        let number: f64 = shown.parse().expect("a number");
        let unit =
            10_f64.powf(number.abs().log10().floor()) * 10_f64.powi(-i32::try_from(digits).expect("few"));
        (value - number).abs() <= 0.501 * unit
    };
    found.len() == table.len() && found.iter().zip(table).all(as_shown)
}

pub const PRESSURE: &str = ",pressure,nodes,l2,";

/// Q2–P1 elements in backward Euler steps of 0.001, computed with another program (scikit-fem).
pub const TEN: [&str; 5] = ["2.24e-3", "1.85e-3", "1.66e-3", "1.04e-3", "2.70e-5"];
