//! What a mapping may say of somebody else's files, and what nobody says.

use crate::program::{Told, call};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Seconds at which `T_v = 1` in the seed column: `γ_w H²/(k E_oed)`.
const SECONDS: f64 = 9810.0 / (1e-4 * 1.2e6);
const PLACES: usize = 21;

/// Exact pressures and displacements at places from the base to the surface.
fn exact(folder: &Path, time_factor: f64) -> Vec<[f64; 3]> {
    let depths: Vec<String> = (0..PLACES).map(|place| (1.0 - place as f64 / 20.0).to_string()).collect();
    let told = call(
        folder,
        &["exact", "terzaghi", "--time-factor", &time_factor.to_string(), "--zeta", &depths.join(",")],
    );
    assert_eq!(told.code, 0, "{}", told.err);
    let number = |typed: &str| typed.parse::<f64>().expect("a number");
    let rows = told.out.lines().skip(1).map(|row| row.split(',').map(number).collect::<Vec<f64>>());
    rows.map(|row| [1.0 - row[1], row[2], row[3]]).collect()
}

/// Numbers of a list, as VTK's XML writes them.
fn listed(numbers: impl Iterator<Item = f64>) -> String {
    numbers.map(|number| format!("{number:e}")).collect::<Vec<_>>().join(" ")
}

/// A file of points in XML with named arrays of one component.
fn vtk(kind: &str, places: &[[f64; 2]], arrays: &[(&str, Vec<f64>)]) -> String {
    let data: Vec<String> = arrays
        .iter()
        .map(|(name, values)| {
            let values = listed(values.iter().copied());
            format!("<DataArray type=\"Float64\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>")
        })
        .collect();
    let points = listed(places.iter().flat_map(|place| [place[0], place[1], 0.0]));
    let verts = if kind == "PolyData" { " NumberOfVerts=\"0\"" } else { " NumberOfCells=\"0\"" };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\">\n<{kind}>\
         <Piece NumberOfPoints=\"{}\"{verts}><PointData>{}</PointData><Points><DataArray type=\"Float64\" \
         NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray></Points></Piece></{kind}></VTKFile>\n",
        places.len(),
        data.concat()
    )
}

/// Scores files against Terzaghi's solution with a mapping.
fn score(folder: &Path, mapping: &str, arguments: &[&str]) -> Told {
    fs::write(folder.join("map.toml"), mapping).expect("a file");
    let common =
        ["--scene", "terzaghi", "--reference", "terzaghi", "--mapping", "map.toml", "--format", "csv"];
    call(folder, &[&["score"], arguments, &common].concat())
}

/// The errors of a quantity in its main norm.
fn errors(told: &Told, quantity: &str) -> Vec<f64> {
    assert_eq!(told.code, 0, "{}", told.err);
    let is_main = |row: &&str| row.contains(&format!(",{quantity},")) && row.contains(",l2,");
    let rows = told.out.lines().filter(is_main);
    rows.map(|row| row.rsplit(',').next().expect("a value").parse().expect("a number")).collect()
}

fn are_round_off(found: &[f64], many: usize) -> bool {
    found.len() == many && found.iter().all(|error| *error < 1e-9)
}

const ARRAYS: &str = "[columns]\ny = \"coordinates[1]\"\np = \"p\"\nu_y = \"\"\n[units]\nstress = \"Pa\"\n[sign]\np = \
                      \"compression-positive\"\n";

#[test]
fn rows_of_one_material_count_and_those_of_others_do_not() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let column = exact(at, 0.1);
    // The same column twice: of soil, and of a plate that bears no water.
    let places: Vec<[f64; 2]> = (0..2 * PLACES).map(|row| [0.0, column[row % PLACES][0]]).collect();
    let pressure = (0..2 * PLACES).map(|row| if row < PLACES { column[row][1] } else { 7.0 }).collect();
    let material = (0..2 * PLACES).map(|row| f64::from(u8::from(row >= PLACES))).collect();
    let arrays = [("p", pressure), ("MaterialIDs", material)];
    fs::write(at.join("a.vtu"), vtk("UnstructuredGrid", &places, &arrays)).expect("a file");
    let time = format!("[time]\nlist = [{}]\n", 0.1 * SECONDS);
    let soil = score(at, &format!("{ARRAYS}{time}[rows]\nequals = {{ MaterialIDs = 0 }}\n"), &["a.vtu"]);
    assert!(are_round_off(&errors(&soil, "pressure"), 1), "{}", soil.out);
    let both = score(at, &format!("{ARRAYS}{time}"), &["a.vtu"]);
    assert!(errors(&both, "pressure")[0] > 1.0, "{}", both.out);
    let none = score(at, &format!("{ARRAYS}{time}[rows]\nequals = {{ MaterialIDs = 5 }}\n"), &["a.vtu"]);
    assert!(none.code == 2 && none.err.contains("selects none of its 42 rows"), "{}", none.err);
    let unknown = score(at, &format!("{ARRAYS}{time}[rows]\nequals = {{ Material = 0 }}\n"), &["a.vtu"]);
    assert!(unknown.code == 2 && unknown.err.contains("no array `Material`"), "{}", unknown.err);
    // The same of a table.
    let mut table = "t,y,p,layer\n".to_owned();
    for row in 0..2 * PLACES {
        let [height, pressure, _] = column[row % PLACES];
        let (pressure, layer) = if row < PLACES { (pressure, 1) } else { (7.0, 2) };
        writeln!(table, "{},{height},{pressure},{layer}", 0.1 * SECONDS).expect("in memory");
    }
    fs::write(at.join("a.csv"), table).expect("a file");
    let mapping = "[columns]\nt = \"t\"\np = \"p\"\n[units]\nstress = \"Pa\"\n[sign]\np = \"compression-positive\"\n[rows]\n\
                   equals = { layer = 1 }\n";
    assert!(are_round_off(&errors(&score(at, mapping, &["a.csv"]), "pressure"), 1));
}

#[test]
fn times_come_from_a_list_or_from_a_pattern_of_names() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for (step, time_factor) in [(5, 0.05), (10, 0.1), (20, 0.2)] {
        let column = exact(at, time_factor);
        let places: Vec<[f64; 2]> = column.iter().map(|row| [0.0, row[0]]).collect();
        let pressure = column.iter().map(|row| row[1]).collect();
        let text = vtk("UnstructuredGrid", &places, &[("p", pressure)]);
        fs::write(at.join(format!("run_{step}_of_20.vtu")), text).expect("a file");
    }
    let list = |times: &[f64]| {
        let times: Vec<String> = times.iter().map(|factor| (factor * SECONDS).to_string()).collect();
        format!("{ARRAYS}[time]\nlist = [{}]\n", times.join(", "))
    };
    // A pattern sorts by all numbers of a name: 5 goes before 10.
    let found = score(at, &list(&[0.05, 0.1, 0.2]), &["run_*.vtu"]);
    assert!(are_round_off(&errors(&found, "pressure"), 3), "{}", found.out);
    let told = score(at, &list(&[0.1, 0.2, 0.05]), &["run_*.vtu"]);
    assert!(errors(&told, "pressure").iter().any(|error| *error > 0.01), "the times of others: {}", told.out);
    // A shell puts 10 and 20 before 5.
    let shell = ["run_10_of_20.vtu", "run_20_of_20.vtu", "run_5_of_20.vtu"];
    let refused = score(at, &list(&[0.05, 0.1, 0.2]), &shell);
    assert!(refused.code == 2 && refused.err.contains("it comes after run_20_of_20.vtu"), "{}", refused.err);
    let short = score(at, &list(&[0.05, 0.1]), &["run_*.vtu"]);
    assert!(
        short.code == 2 && short.err.contains("it is file 3 of its run, but [time] list has 2"),
        "{}",
        short.err
    );
    let pattern = format!("{ARRAYS}[time]\nstep = {}\npattern = \"run_{{step}}_of_*.vtu\"\n", 0.01 * SECONDS);
    let found = score(at, &pattern, &["run_*.vtu"]);
    assert!(are_round_off(&errors(&found, "pressure"), 3), "{} {}", found.out, found.err);
    let other = pattern.replace("run_", "step_");
    let refused = score(at, &other, &["run_*.vtu"]);
    assert!(
        refused.code == 2 && refused.err.contains("does not match the pattern `step_{step}_of_*.vtu`"),
        "{}",
        refused.err
    );
}

#[test]
fn displacements_by_id_do_not_mind_the_order_of_the_points() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let column = exact(at, 0.1);
    let settled = 1e-3;
    let write = |name: &str, order: &[usize], moved: f64, ids: &dyn Fn(usize) -> f64| {
        let places: Vec<[f64; 2]> = order.iter().map(|row| [0.0, column[*row][0] * (1.0 - moved)]).collect();
        let pressure = order.iter().map(|row| column[*row][1]).collect();
        let names = order.iter().map(|row| ids(*row)).collect();
        let text = vtk("PolyData", &places, &[("p", pressure), ("id", names)]);
        fs::write(at.join(name), text).expect("a file");
    };
    let forward: Vec<usize> = (0..PLACES).collect();
    let backward: Vec<usize> = (0..PLACES).rev().collect();
    write("a_1.vtp", &forward, 0.0, &|row| row as f64);
    write("a_2.vtp", &backward, settled, &|row| row as f64);
    let by_id = format!(
        "{ARRAYS}[position]\ny = \"current\"\n[displacement]\nfrom = \"first-frame\"\nid = \"id\"\n[time]\nlist = [{}, {}]\n",
        0.05 * SECONDS,
        0.1 * SECONDS
    );
    let found = score(at, &by_id, &["a_1.vtp", "a_2.vtp"]);
    let pressures = errors(&found, "pressure");
    assert!(pressures[1] < 1e-9, "initial places of the first state: {}", found.out);
    // Points that sink in proportion to their heights settle as far as the surface does.
    let told = score(at, &by_id, &["a_1.vtp", "a_2.vtp", "--set", "column.load=1.0"]);
    let settlement = told.out.lines().rfind(|row| row.contains(",settlement,")).expect("a settlement");
    let relative: f64 = settlement.rsplit(',').next().expect("a value").parse().expect("a number");
    let final_settlement = 1.0 / 1.2e6;
    assert!((relative + 1.0) * final_settlement > 0.5 * settled, "{settlement}");
    // An array that numbers the points is taken without a word.
    let by_order = by_id.replace("id = \"id\"\n", "");
    assert!(errors(&score(at, &by_order, &["a_1.vtp", "a_2.vtp"]), "pressure")[1] < 1e-9);
    write("a_2.vtp", &backward, settled, &|row| row as f64 + 1.0);
    let stranger = score(at, &by_id, &["a_1.vtp", "a_2.vtp"]);
    assert!(
        stranger.code == 2 && stranger.err.contains("it is not in the first state, a_1.vtp"),
        "{}",
        stranger.err
    );
}

#[test]
fn units_and_signs_that_nobody_declared_are_warned_of_and_fail_a_gate() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mut table = "t,y,p\n".to_owned();
    for [height, pressure, _] in exact(at, 0.1) {
        writeln!(table, "{},{height},{pressure}", 0.1 * SECONDS).expect("in memory");
    }
    fs::write(at.join("a.csv"), table).expect("a file");
    let bare = "[columns]\nt = \"t\"\np = \"p\"\nu_y = \"\"\n";
    let told = score(at, bare, &["a.csv"]);
    assert!(
        told.code == 0 && told.err.contains("warning: undeclared: the mapping does not declare"),
        "{}",
        told.err
    );
    for asked in [
        "the unit of stresses, taken as Pa where the file states none",
        "the sign of `p`, taken as compression-positive",
    ] {
        assert!(told.err.contains(asked), "{}", told.err);
    }
    for gate in [&["a.csv", "--strict"][..], &["a.csv", "--below", "0.1"]] {
        let told = score(at, bare, gate);
        assert!(told.code == 1 && told.err.contains("fail: undeclared"), "{}", told.err);
    }
    let whole = format!("{bare}[units]\nstress = \"Pa\"\n[sign]\np = \"compression-positive\"\n");
    let told = score(at, &whole, &["a.csv", "--strict"]);
    assert!(told.code == 0 && !told.err.contains("undeclared"), "{}", told.err);
    // Who gives no mapping is told the convention, and asks for it.
    let told = call(at, &["score", "a.csv", "--scene", "terzaghi", "--strict"]);
    assert!(told.err.contains("note: no --mapping") && !told.err.contains("undeclared"), "{}", told.err);
}

#[test]
fn what_cannot_be_is_refused_with_its_file_and_place() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let column = exact(at, 0.1);
    let places: Vec<[f64; 2]> = column.iter().map(|row| [0.0, row[0]]).collect();
    let pressure: Vec<f64> = column.iter().map(|row| row[1]).collect();
    let sound = vtk("UnstructuredGrid", &places, &[("p", pressure.clone())]);
    let mut holed = pressure;
    holed[5] = f64::NAN;
    let with_nan = vtk("UnstructuredGrid", &places, &[("p", holed)]).replace("NaN", "nan");
    let mapping = format!("{ARRAYS}[time]\nlist = [{}]\n", 0.1 * SECONDS);
    for (name, text, told) in [
        ("nan.vtu", with_nan, "nan.vtu: point 5: `p` is NaN"),
        ("more.vtu", sound.replacen("\"21\"", "\"22\"", 1), "it holds 63 numbers, and 66 are declared"),
        ("fewer.vtu", sound.replacen("\"21\"", "\"20\"", 1), "there are more than the 60 numbers declared"),
        ("claim.vtu", sound.replacen("\"21\"", "\"1250000000\"", 1), "and 3750000000 are declared"),
        ("cut.vtu", sound[..sound.len() / 2].to_owned(), "the file is cut"),
        ("image.vti", sound.replace("UnstructuredGrid", "ImageData"), "type `ImageData` is not read"),
    ] {
        fs::write(at.join(name), text).expect("a file");
        let refused = score(at, &mapping, &[name]);
        assert!(
            refused.code == 2 && refused.err.contains(told) && refused.err.contains(name),
            "{}",
            refused.err
        );
    }
    let device = score(at, &mapping, &["/dev/zero"]);
    assert!(device.code == 2 && device.err.contains("a device or a pipe may never end"), "{}", device.err);
    let set = |file: &str, time: &str| format!("<DataSet timestep=\"{time}\" file=\"{file}\"/>");
    let pvd = |sets: &str| format!("<VTKFile type=\"Collection\"><Collection>{sets}</Collection></VTKFile>");
    fs::write(at.join("sound.vtu"), &sound).expect("a file");
    let twice = [set("sound.vtu", "8.175"), set("sound.vtu", "16.35")].concat();
    fs::write(at.join("twice.pvd"), pvd(&twice)).expect("a file");
    let refused = score(at, ARRAYS, &["twice.pvd"]);
    assert!(refused.code == 2 && refused.err.contains("at two times"), "{}", refused.err);
    let again = [set("sound.vtu", "8.175"), set("sound.vtu", "8.175")].concat();
    fs::write(at.join("again.pvd"), pvd(&again)).expect("a file");
    let told = score(at, ARRAYS, &["again.pvd"]);
    assert!(are_round_off(&errors(&told, "pressure"), 1), "{}", told.out);
    assert!(told.err.contains("1 of its 2 files are listed twice"), "{}", told.err);
    // A ring that is spelt anew at every turn, a thousand ways at once.
    fs::create_dir(at.join("x")).expect("a folder");
    let ring: String =
        (0..1000).map(|turn| set(&format!("x/{}../ring.pvd", "./".repeat(turn % 7)), "1")).collect();
    fs::write(at.join("ring.pvd"), pvd(&ring)).expect("a file");
    let refused = score(at, ARRAYS, &["ring.pvd"]);
    assert!(refused.code == 2 && refused.err.contains("refers back to it"), "{}", refused.err);
}
