//! Files as finite-element programs of the field write them by default, scored to the error that an independent series gives
//! (numpy on the values of the file), and files that are not read, by name.

use crate::program::{Told, call};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn files() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign")
}

/// Scores files of a seed column against Terzaghi's series, for incompressible water but in `formats/`, with a mapping or
/// without.
fn score(mapping: &str, arguments: &[&str]) -> Told {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("map.toml");
    let head = "units.stress = 'Pa'\nsign = { p = 'compression-positive', u_y = 'up', effective_stress = 'tension-positive' }\n";
    fs::write(&path, format!("{head}{mapping}")).expect("a file");
    let path = path.display().to_string();
    let named = if mapping.is_empty() { vec![] } else { vec!["--mapping", &path] };
    let scene = if arguments.contains(&"--scene") {
        &[][..]
    } else if arguments[0].starts_with("formats/") {
        &["--scene", "terzaghi", "--reference", "terzaghi"]
    } else {
        &["--scene", "terzaghi", "--reference", "terzaghi-incompressible"]
    };
    call(&files(), &[&["score"], arguments, scene, &named, &["--format", "csv"]].concat())
}

/// The main errors of a quantity at a kind of places, by time.
fn errors(told: &Told, row: &str) -> Vec<f64> {
    assert_eq!(told.code, 0, "{}", told.err);
    let column =
        told.out.lines().next().and_then(|header| header.split(',').position(|name| name == "value"));
    let rows = told.out.lines().filter(|line| line.contains(row));
    rows.map(|line| line.split(',').nth(column.expect("values")).expect("one").parse().expect("a number"))
        .collect()
}

const NODES: &str = "sample = 'nodes'\n";
/// Relative errors of Taylor–Hood elements, backward Euler, at `T_v` = 0.05, 0.1, 0.2, 0.5 and the nodes.
const TAYLOR_HOOD: [f64; 4] = [3.348_115e-3, 2.762_56e-3, 2.513_467e-3, 1.663_81e-3];

#[test]
fn programs_are_read_as_they_write_by_default() {
    let exact = &[0.0; 4][..];
    let pressure = "columns = { y = 'coordinates[1]', p = 'p', u_y = '' }";
    let geos = "sample = 'centres'\ncolumns = { t = 'pressure Time', y = 'pressure elementCenter[1]', p = 'pressure', u_y = '' }";
    let spelled = geos.replace("p = 'pressure'", "p = 'pressure[time, cell]'");
    let pflotran = "sample = 'centres'\norigin.p = 101325.0\n\
                    columns = { t = 'Time', y = 'Coordinates/Z [m]', p = 'Liquid_Pressure [Pa]', u_y = '' }";
    let pylith = "sample = 'nodes'\ncolumns = { t = 'time', y = 'geometry/vertices[1]', p = 'vertex_fields/pressure', u_y = '' }";
    let layout = "sample = 'nodes'\ncolumns = { y = 'coordinates[1]', p = 'pressure', u_y = '' }";
    let corners = format!("{layout}\nrows.corners = true");
    let one_time = format!("{layout}\n[time]\nlist = [4.0875]");
    let rows = "columns = { t = 't', y = 'y', p = 'p', u_y = '' }";
    let vtk_list = "sample = 'nodes'\ncolumns = { y = 'coordinates[1]', p = 'pressure', u_y = '' }\n[time]\nlist = [8.175]";
    for (mapping, arguments, sample, wanted) in [
        (&*format!("{NODES}{pressure}"), &["dolfinx/column.xdmf"][..], "nodes", &TAYLOR_HOOD[..]),
        (&*format!("{NODES}{pressure}"), &["dolfinx/all.pvd"], "nodes", &TAYLOR_HOOD),
        (layout, &["mfem/column.pvd"], "nodes", &TAYLOR_HOOD),
        (
            &*format!("{layout}\n[time]\nlist = [4.0875, 8.175, 16.35, 40.875]"),
            &["mfem/Cycle*/proc000000.vtu", "--cells", "8"],
            "nodes",
            &TAYLOR_HOOD,
        ),
        (vtk_list, &["getfem/p_1.vtu"], "nodes", &[2.778_004e-3]),
        (vtk_list, &["getfem/p_1.vtk"], "nodes", &[2.778_004e-3]),
        // Six digits per value.
        (vtk_list, &["getfem/p_1.pos"], "nodes", &[2.778_074e-3]),
        ("", &["formats/col.nc"], "points", exact),
        ("", &["formats/times.nc"], "points", exact),
        ("", &["formats/series.xdmf"], "nodes", exact),
        ("", &["formats/fenics.xdmf"], "nodes", exact),
        (geos, &["geos/pressure_history.hdf5"], "centres", exact),
        (&*spelled, &["geos/pressure_history.hdf5"], "centres", exact),
        (pflotran, &["geos/pflotran.h5"], "centres", exact),
        (pylith, &["pylith/step.h5"], "nodes", exact),
        (layout, &["pylith/step.xmf"], "nodes", exact),
        (rows, &["npz/moving.npz"], "points", &exact[..3]),
        (&*corners, &["celltypes/lag_1.vtu", "--set-time-step", "8.175"], "nodes", &exact[..1]),
        (layout, &["celltypes/bez_1.vtu", "--set-time-step", "8.175", "--strict"], "nodes", &exact[..1]),
        (&*corners, &["celltypes/pixel_1.vtu", "--set-time-step", "8.175"], "nodes", &exact[..1]),
        (&*one_time, &["formats/col_0.e"], "nodes", &exact[..1]),
        (&*one_time, &["formats/col_0.vtkhdf"], "nodes", &exact[..1]),
        (&*one_time, &["formats/col_0.msh"], "nodes", &exact[..1]),
        (&*one_time, &["formats/col_0_22.msh"], "nodes", &exact[..1]),
    ] {
        let told = score(mapping, arguments);
        let found = errors(&told, &format!(",pressure,{sample},l2,"));
        assert_eq!(found.len(), wanted.len(), "{arguments:?}: {}", told.err);
        for (error, wanted) in found.iter().zip(wanted) {
            // Times in single precision, absolute pressures to the last digit of theirs, and round-off.
            let room = if arguments[0].contains("pflotran") { 1e-10 } else { 1e-14 };
            let near = if *wanted == 0.0 { room } else { 1e-5 * wanted };
            assert!((error - wanted).abs() <= near, "{arguments:?}: {found:?}");
        }
    }
    let single = errors(&score(layout, &["formats/transient.vtkhdf"]), ",pressure,nodes,l2,");
    assert!(
        single.len() == 4 && single.iter().all(|error| *error < 2e-8),
        "times in single precision: {single:?}"
    );
}

#[test]
fn triangles_with_their_borders_and_a_table_of_colours() {
    let layer = ["--scene", "cosine-layer", "--reference", "cosine-layer"];
    let stress = "sample = 'centres'\ncolumns = { x = 'coordinates[0]', y = 'coordinates[1]', p = '', u_y = '', \
                  effective_stress = 'cells:sigma_eff_yy' }\nsign.x = 'right'\n[time]\nlist = [4.0875, 8.175, 16.35]";
    let told = score(
        &stress.replace("sign.x = 'right'\n", ""),
        &[&["freefem/step_?.vtu", "--without", "pressure,displacement"][..], &layer].concat(),
    );
    let found = errors(&told, ",effective_stress,centres,l2,");
    assert!((found[0] - 6.39e-3).abs() < 1e-5, "128 triangles without 32 lines: {found:?}");
    assert!(!told.err.contains("not-covered"), "{}", told.err);
    let nodes = "sample = 'nodes'\ncolumns = { x = 'coordinates[0]', y = 'coordinates[1]', p = 'pressure', u_y = '' }\n\
                 [time]\nlist = [8.175]";
    let of = |file: &str| errors(&score(nodes, &[&[file][..], &layer].concat()), ",pressure,nodes,l2,");
    let [xml, text, binary] = ["freefem/step_1.vtu", "freefem/ascii_1.vtk", "freefem/bin_1.vtk"].map(of);
    assert!((text[0] - 1.29e-2).abs() < 5e-5 && text == binary, "{text:?} {binary:?}");
    assert!((xml[0] - text[0]).abs() < 1e-6, "places in single precision");
}

#[test]
fn nodal_pressures_and_stresses_in_cells_are_scored_from_one_file() {
    let mapping = "sample = 'nodes'\ncolumns = { y = 'coordinates[1]', p = 'p', u_y = 'u[1]', effective_stress = 'sigma_eff_yy' }";
    let told = score(mapping, &["dolfinx/column.xdmf", "--strict"]);
    let (p, s) = (errors(&told, ",pressure,nodes,l2,"), errors(&told, ",effective_stress,centres,l2,"));
    assert!((p[1] - 2.762_56e-3).abs() < 1e-8 && s.len() == 4 && s[3] < 2e-3, "{p:?} {s:?}");
    assert_eq!(errors(&told, ",settlement,surface,").len(), 4);
}

#[test]
fn a_table_with_a_column_per_probe_is_the_same_turned_by_hand() {
    let columns = |name: fn(usize) -> String| {
        (0..11).map(|place| format!("{} = {place}.0", name(place))).collect::<Vec<_>>().join(", ")
    };
    let wide = columns(|place| if place == 10 { "p99".to_owned() } else { format!("p{place}") });
    let text = fs::read_to_string(files().join("moose/terzaghi_constM.csv")).expect("a file");
    let mut long = "t;z;p\n".to_owned();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        for place in 0..11 {
            let _ = writeln!(
                long,
                "{};{place};{}",
                fields[0].replace('.', ","),
                fields[1 + place].replace('.', ",")
            );
        }
    }
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("long.csv");
    fs::write(&path, long).expect("a file");
    let column = &["--set", "column.height=10", "--set", "column.load=1e6"];
    let mapping =
        format!("sample = 'nodes'\ncolumns = {{ t = 'time', p = {{ {wide} }}, u_y = {{ zdisp = 10.0 }} }}");
    let told = score(&mapping, &[&["moose/terzaghi_constM.csv"][..], column].concat());
    let by_probe = errors(&told, ",pressure,nodes,l2,");
    let by_row = "sample = 'nodes'\ncolumns = { y = 'z', p = 'p', u_y = '', t = 't' }";
    let by_row = errors(
        &score(by_row, &[&[path.to_str().expect("a path")][..], column].concat()),
        ",pressure,nodes,l2,",
    );
    assert!(by_probe.len() > 4 && by_probe == by_row, "{by_probe:?} {by_row:?}");
    assert_eq!(errors(&told, ",settlement,surface,").len(), by_probe.len());
}

#[test]
fn a_settlement_curve_alone_is_scored() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("curve.csv");
    // 1 − (8/π²) Σ exp(−M² T_v) … of the final q H/E_oed: U(0.2) = 0.50409, U(0.5) = 0.76395.
    let settled = [0.504_09, 0.763_95].map(|degree| degree / 1.2e6);
    fs::write(&path, format!("t,s\n16.35,{}\n40.875,{}\n", settled[0], settled[1])).expect("a file");
    let mapping = "columns = { p = '', u_y = '' }\n[settlement]\n";
    let told = score(mapping, &[path.to_str().expect("a path"), "--below", "1e-4"]);
    let found = errors(&told, ",settlement,surface,");
    assert!(found.len() == 2 && found.iter().all(|error| error.abs() < 1e-5), "{found:?} {}", told.err);
    // A modulus without dimension, said once.
    let odd = score(mapping, &[path.to_str().expect("a path"), "--set", "material.youngs_modulus=7.2"]);
    assert_eq!(odd.err.matches("7.2 Pa").count(), 1, "{}", odd.err);
}

#[test]
fn a_list_of_times_is_never_cut_and_where_two_axes_fit_it_is_asked() {
    let square = [[1.0, 2.0], [3.0, 4.0]];
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("a.h5");
    let mut store = hdf5_pure::FileBuilder::new();
    store.create_dataset("t").with_f64_data(&[8.175, 16.35]).with_shape(&[2]);
    store.create_dataset("y").with_f64_data(&[0.25, 0.75]).with_shape(&[2]);
    store.create_dataset("p").with_f64_data(&square.concat()).with_shape(&[2, 2]);
    store.write(&path).expect("a file");
    let path = path.to_str().expect("a path");
    let asked = |p: &str| score(&format!("columns = {{ t = 't', y = 'y', p = '{p}', u_y = '' }}"), &[path]);
    for p in ["p", "p[0]"] {
        let told = asked(p);
        assert!(
            told.code != 0 && told.err.contains("`p[time, node]` or `p[node, time]`"),
            "{p}: {}",
            told.err
        );
    }
    let [by_time, by_node] =
        ["p[time, node]", "p[node, time]"].map(|p| errors(&asked(p), ",pressure,points,l2,"));
    assert!(by_time.len() == 2 && by_node.len() == 2 && by_time != by_node, "{by_time:?} {by_node:?}");
}

#[test]
fn what_is_not_read_is_named_with_what_to_do_instead() {
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("a.bp")).expect("a folder");
    for (name, content, told) in [
        (
            "a.vtu",
            &b"version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 12\n"[..],
            "git lfs pull",
        ),
        ("b.csv", b"", "it is empty"),
        ("c.vtu", b"<!DOCTYPE html><html></html>", "a web page"),
        ("d.e", b"CDF\x01\0\0\0\0", "nccopy -k nc4"),
        ("e.frd", b"    1C                         \n    1UUSER\n", "CalculiX's FRD"),
        ("f.dat", b"TITLE = \"a\"\nVARIABLES = \"x\" \"p\"\n", "Tecplot"),
        ("g.parquet", b"PAR1\x15\x04\0\0", "Parquet"),
        ("a.bp", b"", "ADIOS2"),
    ] {
        let path = folder.path().join(name);
        if !path.is_dir() {
            fs::write(&path, content).expect("a file");
        }
        let found = score("", &[path.to_str().expect("a path")]);
        assert!(found.code != 0 && found.err.contains(told), "{name}: {}", found.err);
    }
    let binary = score("", &["formats/binary_0.msh"]);
    assert!(binary.err.contains("Mesh.Binary = 0"), "{}", binary.err);
}
