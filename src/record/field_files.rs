//! The fields of a run as files for `ParaView`: a VTU of the material points for each output, and a PVD that lists them with
//! their times. Numbers are written with all their digits, so that `score` reads back what was solved.

use crate::case::Case;
use crate::record::Record;
use oedometer_problem::snapshot::Snapshot;
use oedometer_scenes::scene::{Body, LoadKind};
use std::fmt::{Display, Write};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Name of the list of all states.
const LIST: &str = "fields.pvd";
/// Name of the file that says what the arrays mean.
const MEANING: &str = "mapping.toml";

/// Writes the states of a run into a folder, which is made where it is missing; the PVD that lists them.
///
/// The files hold the material points at their current places with `x` and `y` (the initial ones, m), `u_x` and `u_y` (m),
/// `p` (Pa, compression positive), `effective_stress` (Pa, tension positive) and `volume` (m³ of a metre's thickness).
///
/// # Errors
/// Those of the file system.
pub fn write_fields(record: &Record, folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let mut sets = String::new();
    for (number, state) in record.snapshots.iter().enumerate() {
        let name = format!("fields_{number:04}.vtu");
        fs::write(folder.join(&name), vtu_of(&record.case, state))?;
        writeln!(sets, "<DataSet timestep=\"{}\" file=\"{name}\"/>", state.time).map_err(io::Error::other)?;
    }
    let list = folder.join(LIST);
    let kind = "type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\"";
    fs::write(
        &list,
        format!("<?xml version=\"1.0\"?>\n<VTKFile {kind}>\n<Collection>\n{sets}</Collection>\n</VTKFile>\n"),
    )?;
    // The fields of a footing have no exact solution.
    if record.case.scene.load != LoadKind::Pushed {
        fs::write(folder.join(MEANING), meaning_of(&record.case))?;
    }
    Ok(list)
}

/// The mapping with which `score` reads the files.
fn meaning_of(case: &Case) -> String {
    // A slab moves along x, a column along y.
    let (is_slab, is_plane) = (case.scene.body == Body::Slab, case.scene.body.is_plane());
    let columns = match (is_slab, is_plane) {
        (true, _) => ["x", "u_x"].as_slice(),
        (false, true) => &["x", "u_x", "u_y"],
        (false, false) => &["u_y"],
    };
    let names = columns.iter().map(|name| format!("{name} = \"{name}\"\n")).collect::<Vec<_>>().concat();
    let sense = |name: &str| if name.ends_with('x') { "right" } else { "up" };
    let senses =
        columns.iter().map(|name| format!("{name} = \"{}\"\n", sense(name))).collect::<Vec<_>>().concat();
    format!(
        "# oedometer score fields.pvd --scene {} --mapping mapping.toml\nsample = \"points\"\n\n[columns]\ny = \"y\"\n\
         p = \"p\"\n{names}effective_stress = \"effective_stress\"\nvolume = \"volume\"\n\n[units]\nlength = \"m\"\n\
         displacement = \"m\"\nstress = \"Pa\"\n\n[sign]\ny = \"up\"\np = \"compression-positive\"\n{senses}\
         effective_stress = \"tension-positive\"\n",
        case.scene.name
    )
}

/// A state of the material points, each a cell of its own.
fn vtu_of(case: &Case, state: &Snapshot) -> String {
    let points = &state.points;
    let count = points.pressure.len();
    let zeros = vec![0.0; count];
    let mut up = [&points.initial_height, &points.displacement];
    let mut across = points
        .plane
        .as_ref()
        .map_or([&zeros, &zeros], |plane| [&plane.initial_distance, &plane.horizontal_displacement]);
    // A slab drains along x.
    if case.scene.body == Body::Slab {
        (up, across) = (across, up);
    }
    let place = |point: usize| {
        let moved = |[start, displacement]: [&Vec<f64>; 2]| start[point] + displacement[point];
        format!("{} {} 0", moved(across), moved(up))
    };
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">\n<PointData>\n"
    );
    for (name, values) in [
        ("x", across[0]),
        ("y", up[0]),
        ("u_x", across[1]),
        ("u_y", up[1]),
        ("p", &points.pressure),
        ("effective_stress", &points.effective_stress),
        ("volume", &points.volume),
    ] {
        text += &array("type=\"Float64\"", name, values);
    }
    text += "</PointData>\n<Points>\n";
    text += &array("type=\"Float64\" NumberOfComponents=\"3\"", "places", (0..count).map(place));
    text += "</Points>\n<Cells>\n";
    text += &array("type=\"Int64\"", "connectivity", 0..count);
    text += &array("type=\"Int64\"", "offsets", 1..=count);
    // VTK_VERTEX.
    text += &array("type=\"UInt8\"", "types", std::iter::repeat_n(1, count));
    text + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
}

fn array<T: Display>(kind: &str, name: &str, values: impl IntoIterator<Item = T>) -> String {
    let numbers: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
    format!("<DataArray {kind} Name=\"{name}\" format=\"ascii\">\n{}\n</DataArray>\n", numbers.join("\n"))
}
