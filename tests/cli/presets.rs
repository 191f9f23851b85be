//! Files as other codes write them, scored with the preset of each.
//!
//! Written by the program: Kratos 10.4.4 (`tests/foreign/kratos-poro`, `kratos-mpm`). Written by VTK 9 and HDF5 with the calls
//! of the program's sources: CB-Geo (`tests/foreign/cb-geo`; `src/io/vtk_writer.cc` at 061c4a6 and
//! `src/hdf5_particle_twophase.cc` at 98b7763 of `github.com/cb-geo/mpm`). Made here after the program's sources: `Anura3D`
//! (`src/WriteVTKOutput.FOR` at 0ebf4e3 and `src/WriteVTKASCII.FOR` at 0fc0b5e of `github.com/Anura3D/Anura3D_OpenSource`) and
//! MPM-Geomechanics (`src/Output.cpp` at 002af18 of `github.com/fabricix/MPM-Geomechanics`).

use crate::program::{Told, call};
use oedometer_exact::{ColumnParameters, FieldValues, Reference, ReferenceKind};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Cells of two points across and one over the height.
const ROWS: usize = 20;
/// Steps that are written, of 0.8175 s each: `T_v` = 0.05, 0.1 and 0.5 of the default column.
const STEPS: [usize; 3] = [5, 10, 50];
const SECONDS: f64 = 0.8175;
/// Load, Pa.
const LOAD: f64 = 1e4;

/// A point: its initial place and its fields.
struct Point {
    place: [f64; 2],
    fields: FieldValues,
}

impl Point {
    /// Its present place.
    fn now(&self) -> [f64; 2] {
        [self.place[0], self.place[1] + self.fields.displacement]
    }
}

fn points(step: usize) -> Vec<Point> {
    let column = ColumnParameters { load: LOAD, ..ColumnParameters::default() };
    let exact = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the default column");
    let time = column.time_factor(step as f64 * SECONDS);
    let at = |row: usize, x: f64| {
        let y = (row as f64 + 0.5) / ROWS as f64;
        Point { place: [x, y], fields: exact.fields(time, 1.0 - y).expect("inside") }
    };
    (0..ROWS).flat_map(|row| [at(row, 0.025), at(row, 0.075)]).collect()
}

fn score(folder: &Path, files: &[&str], more: &[&str]) -> Told {
    let scene = ["--scene", "terzaghi", "--reference", "terzaghi", "--set", "column.load=1e4"];
    call(folder, &[&["score"], files, &scene, more].concat())
}

/// Scores to round-off of the digits written, without a warning.
fn agrees(folder: &Path, files: &[&str], preset: &str, below: &str) {
    let step = SECONDS.to_string();
    let told = score(folder, files, &["--preset", preset, "--set-time-step", &step, "--below", below]);
    assert_eq!(told.code, 0, "{preset}: {}{}", told.out, told.err);
    for quantity in ["pressure", "displacement", "effective_stress"] {
        let lines = told.out.lines().filter(|line| line.contains(quantity)).count();
        assert!(lines >= STEPS.len(), "{preset}: {quantity}\n{}{}", told.out, told.err);
    }
}

/// The head of a legacy VTK file of points, as Fortran's list-directed output has it.
fn vtk_head(places: &[[f64; 2]]) -> String {
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

fn write_anura3d(folder: &Path, without: &str) {
    for step in STEPS {
        let points = points(step);
        let [mut scalars, mut vectors, mut tensors] =
            [(); 3].map(|()| vtk_head(&points.iter().map(Point::now).collect::<Vec<_>>()));
        scalars.push_str("SCALARS virtual_material_point int 1\nLOOKUP_TABLE default\n");
        scalars.push_str(&"           0\n".repeat(points.len()));
        scalars.push_str("SCALARS pressure_liquid float 1\nLOOKUP_TABLE default\n");
        vectors.push_str("VECTORS velocity_solid float\n");
        vectors.push_str(&" 0.0 0.0 0.0\n".repeat(points.len()));
        vectors.push_str("VECTORS displacement_solid float\n");
        tensors.push_str("TENSORS strain float\n");
        tensors.push_str(&"  0.0 0.0 0.0\n".repeat(3 * points.len()));
        tensors.push_str("TENSORS eff_stress_solid float\n");
        for Point { fields, .. } in &points {
            // kPa; tension is positive, of the water too.
            writeln!(scalars, "  {:.16E}", -fields.pressure / 1e3).expect("text");
            writeln!(vectors, "  0.0  {:.16E}  0.0", fields.displacement).expect("text");
            let stress = fields.effective_stress / 1e3;
            writeln!(tensors, "  {0:.16E} 0.0 0.0\n 0.0 {stress:.16E} 0.0\n 0.0 0.0 {0:.16E}", stress / 3.0)
                .expect("text");
        }
        for (kind, text) in [("Scalar", scalars), ("Vector", vectors), ("Tensor", tensors)] {
            if kind != without {
                fs::write(folder.join(format!("column_MP{kind}_{step:03}.vtk")), text).expect("a file");
            }
        }
    }
}

#[test]
fn the_three_files_of_anura3d_are_one_state_in_kilopascals_with_suction_positive() {
    let folder = TempDir::new().expect("a folder");
    write_anura3d(folder.path(), "");
    agrees(folder.path(), &["column_MP*.vtk"], "anura3d", "1e-9");
    // Earlier releases number load steps and, behind three digits, time steps.
    let steps = TempDir::new().expect("a folder");
    for file in fs::read_dir(folder.path()).expect("files").flatten() {
        let name = file.file_name().to_string_lossy().replace("_0", "_001000").replace(".vtk", "");
        fs::copy(file.path(), steps.path().join(format!("{name}.vtk"))).expect("a file");
    }
    fs::write(steps.path().join("map.toml"), "time.pattern = \"*_???{step}.vtk\"\n").expect("a file");
    let more =
        ["--preset", "anura3d", "--mapping", "map.toml", "--set-time-step", "0.8175", "--below", "1e-9"];
    let told = score(steps.path(), &["column_MP*.vtk"], &more);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    // One of the three brings the others along.
    agrees(folder.path(), &["column_MPVector_*.vtk"], "anura3d", "1e-9");
    let mapping = "[columns]\np = \"pressure_liquid\"\nu_y = \"displacement_solid[1]\"\ny = \"coordinates[1]\"\n\
        [units]\nstress = \"kPa\"\n[sign]\np = \"tension-positive\"\nu_y = \"up\"\n[position]\ny = \"current\"\n";
    let own = |join: &str| {
        fs::write(folder.path().join("map.toml"), format!("{join}\n{mapping}")).expect("a file");
        let more = ["--mapping", "map.toml", "--set-time-step", "0.8175", "--below", "1e-9"];
        score(folder.path(), &["column_MPScalar_*.vtk"], &more)
    };
    let told = own("join = [\"*_MPScalar_*.vtk\", \"*_MPVector_*.vtk\"]");
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    let told = own("join = [\"*_MPScalar_*.vtk\", \"*_MP*_*.vtk\"]");
    assert!(told.code == 2 && told.err.contains("same number of `*`"), "{}", told.err);
}

#[test]
fn what_a_preset_promises_fails_the_gate_by_name_unless_it_is_left_out_by_name() {
    let folder = TempDir::new().expect("a folder");
    write_anura3d(folder.path(), "Scalar");
    let gate = ["--preset", "anura3d", "--set-time-step", "0.8175", "--below", "1e-9"];
    let told = score(folder.path(), &["column_MP*.vtk"], &gate);
    assert!(told.code == 1 && told.err.contains(": quantity-missing: there is no `p`"), "{}", told.err);
    assert!(told.err.contains("--without pressure"), "{}", told.err);
    let without = [&gate[..], &["--without", "pressure"]].concat();
    let told = score(folder.path(), &["column_MP*.vtk"], &without);
    assert!(told.code == 0 && !told.out.contains("pressure"), "{}{}", told.out, told.err);
    let told = score(folder.path(), &["column_MP*.vtk"], &[&gate[..], &["--without", "p"]].concat());
    assert!(told.code == 2 && told.err.contains("expected one of pressure"), "{}", told.err);
}

#[test]
fn mpm_geomechanics_writes_five_digits_z_upward_and_a_pore_pressure_that_is_zero_with_two_phases() {
    let folder = TempDir::new().expect("a folder");
    let mut series = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\" \
         compressor=\"vtkZLibDataCompressor\">\n\t<Collection>\n",
    );
    for (place, step) in STEPS.into_iter().enumerate() {
        let points = points(step);
        let count = points.len();
        let array = |name: &str, components: usize, of: &dyn Fn(&Point) -> String| {
            let name = if name.is_empty() { String::new() } else { format!(" Name=\"{name}\"") };
            let mut text = format!(
                "<DataArray type=\"Float64\"{name} NumberOfComponents=\"{components}\" Format=\"ascii\">\n"
            );
            text.extend(points.iter().map(|point| of(point) + "\n"));
            text + "</DataArray>\n"
        };
        let whole = |name: &str, of: &dyn Fn(usize) -> usize| {
            let numbers: String = (0..count).map(|point| of(point).to_string() + "\n").collect();
            format!("<DataArray type=\"UInt64\" Name=\"{name}\" Format=\"ascii\">\n{numbers}</DataArray>\n")
        };
        let text = [
            format!(
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
                 <UnstructuredGrid>\n<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">\n<Points>\n"
            ),
            array("", 3, &|point| format!("{:.4e} 0.0000e+00 {:.4e}", point.now()[0], point.now()[1])),
            "</Points>\n<PointData>\n".to_owned(),
            array("Pressure", 1, &|point| format!("{:.4e}", point.fields.pressure)),
            array("Pore Pressure", 1, &|_| "0.0000e+00".to_owned()),
            array("Displacement", 3, &|point| format!("0.0 0.0 {:.4e}", point.fields.displacement)),
            array("Stress_ZZ", 1, &|point| format!("{:.4e}", point.fields.effective_stress)),
            "</PointData>\n<Cells>\n".to_owned(),
            whole("connectivity", &|point| point),
            whole("offsets", &|point| point + 1),
            whole("types", &|_| 1),
            "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n".to_owned(),
        ];
        let name = format!("particles_{}.vtu", place + 1);
        fs::write(folder.path().join(&name), text.concat()).expect("a file");
        let time = step as f64 * SECONDS;
        writeln!(series, "\t\t<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{name}\"/>")
            .expect("text");
    }
    fs::write(folder.path().join("particleTimeSerie.pvd"), series + "\t</Collection>\n</VTKFile>\n")
        .expect("a file");
    let gate = ["--preset", "mpm-geomechanics", "--below", "1e-3"];
    let told = score(folder.path(), &["particleTimeSerie.pvd"], &gate);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    assert!(told.out.contains("effective_stress") && told.out.contains("pressure"), "{}", told.out);
}

fn foreign(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign").join(folder)
}

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
    assert!(told.err.contains("your p is 0 everywhere: is it another array"), "{}", told.err);
}

/// Places of single precision, packed arrays, a stress of nine components.
#[test]
fn cb_geos_vtp_files_have_an_array_each_and_are_joined() {
    agrees(&foreign("cb-geo"), &["*.vtp"], "cb-geo", "1e-6");
}

#[test]
fn kratos_poromechanics_counts_compression_positive() {
    // Of four-node elements with backward Euler steps; the other application's preset knows another name.
    let of = |preset: &str| {
        let more = ["--preset", preset, "--set-time-step", "0.08175", "--below", "5e-2"];
        score(&foreign("kratos-poro"), &["*.vtk"], &more)
    };
    let told = of("kratos-poro");
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    for quantity in ["pressure", "displacement", "settlement"] {
        assert_eq!(
            told.out.lines().filter(|line| line.split_whitespace().nth(1) == Some(quantity)).count(),
            4
        );
    }
    let told = of("kratos");
    assert!(told.code == 1 && told.err.contains("there is no `p`"), "{}{}", told.out, told.err);
    assert!(told.err.contains("--preset kratos-poro"), "{}", told.err);
}

/// A drained column of 1000 kg/m³ under its weight: the stress at the end of a consolidation under the same buoyant weight.
#[test]
fn kratos_mpm_has_its_arrays_on_vertices_in_text_and_packed() {
    for file in ["column_0_2.vtk", "binary_0_2.vtk"] {
        let told = call(
            &foreign("kratos-mpm"),
            &[
                "score",
                file,
                "--scene",
                "terzaghi",
                "--preset",
                "kratos-mpm",
                "--set-time-step",
                "1e4",
                "--set",
                "column.load=1e-3",
                "--set",
                "column.self_weight=true",
                "--set",
                "material.grain_density=2428.5714285714284",
                "--format",
                "csv",
            ],
        );
        assert_eq!(told.code, 0, "{file}: {}", told.err);
        // A stress that is constant in each of five cells is a tenth off a linear one. The scene's displacement is that
        // of the load alone.
        let row = told.out.lines().find(|line| line.contains("effective_stress") && line.contains(",l2,"));
        let row = row.unwrap_or_else(|| panic!("{file}: {}{}", told.out, told.err));
        let error: f64 = row.rsplit(',').next().expect("a value").parse().expect("a number");
        assert!(error < 0.11, "{file}: {row}");
        assert!(told.err.contains("u_y = MP_DISPLACEMENT[1] on cells"), "{}", told.err);
        assert!(!told.out.contains("pressure"), "it has none");
    }
}
