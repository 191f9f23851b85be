//! `Anura3D`: files made after its sources (`src/WriteVTKOutput.FOR` at 0ebf4e3 and `src/WriteVTKASCII.FOR` at 0fc0b5e of
//! `github.com/Anura3D/Anura3D_OpenSource`).

use crate::score::written_files::{Point, STEPS, agrees, points, score, vtk_head};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

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
