//! The exact column as files of other programs, written here after their sources, and their scores.

use crate::program::{Told, call};
use oedometer_exact::{ColumnParameters, FieldValues, Reference, ReferenceKind};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Cells of two points across and one over the height.
pub const ROWS: usize = 20;

/// Steps that are written, of 0.8175 s each: `T_v` = 0.05, 0.1 and 0.5 of the default column.
pub const STEPS: [usize; 3] = [5, 10, 50];

pub const SECONDS: f64 = 0.8175;

/// Load, Pa.
pub const LOAD: f64 = 1e4;

/// A point: its initial place and its fields.
pub struct Point {
    pub place: [f64; 2],
    pub fields: FieldValues,
}

impl Point {
    /// Its present place.
    pub fn now(&self) -> [f64; 2] {
        [self.place[0], self.place[1] + self.fields.displacement]
    }
}

pub fn points(step: usize) -> Vec<Point> {
    let column = ColumnParameters { load: LOAD, ..ColumnParameters::default() };
    let exact = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the default column");
    let time = column.time_factor(step as f64 * SECONDS);
    let at = |row: usize, x: f64| {
        let y = (row as f64 + 0.5) / ROWS as f64;
        Point { place: [x, y], fields: exact.fields(time, 1.0 - y).expect("inside") }
    };
    (0..ROWS).flat_map(|row| [at(row, 0.025), at(row, 0.075)]).collect()
}

pub fn score(folder: &Path, files: &[&str], more: &[&str]) -> Told {
    let scene = ["--scene", "terzaghi", "--reference", "terzaghi", "--set", "column.load=1e4"];
    call(folder, &[&["score"], files, &scene, more].concat())
}

/// Scores to round-off of the digits written, without a warning.
pub fn agrees(folder: &Path, files: &[&str], preset: &str, below: &str) {
    let step = SECONDS.to_string();
    let told = score(folder, files, &["--preset", preset, "--set-time-step", &step, "--below", below]);
    assert_eq!(told.code, 0, "{preset}: {}{}", told.out, told.err);
    for quantity in ["pressure", "displacement", "effective_stress"] {
        let lines = told.out.lines().filter(|line| line.contains(quantity)).count();
        assert!(lines >= STEPS.len(), "{preset}: {quantity}\n{}{}", told.out, told.err);
    }
}

/// The head of a legacy VTK file of points, as Fortran's list-directed output has it.
pub fn vtk_head(places: &[[f64; 2]]) -> String {
    let count = places.len();
    let mut text = format!(
        "# vtk DataFile Version 3.0\ncolumn\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count:8} float\n"
    );
    for [x, y] in places {
        writeln!(text, "  {x:.16E}  {y:.16E}  0.0000000000000000").expect("text");
    }
    writeln!(text, "CELLS {count:8}{:8}", 2 * count).expect("text");
    (0..count).for_each(|point| writeln!(text, "1{point:8}").expect("text"));
    writeln!(text, "CELL_TYPES {count:8}").expect("text");
    (0..count).for_each(|_| text.push_str(" 1\n"));
    writeln!(text, "POINT_DATA {count:8}").expect("text");
    text
}

pub fn foreign(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign").join(folder)
}
