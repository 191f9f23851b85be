//! `score` through the program: layers, times of several meshes, results that are not whole, and
//! mistakes that their numbers show.

use crate::program::{Told, call};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Seconds at which `T_v = 1` in the seed column: `γ_w H²/(k E_oed)`.
const SECONDS: f64 = 9810.0 / (1e-4 * 1.2e6);

/// Rows of `exact`, as numbers by column.
fn exact(folder: &Path, arguments: &[&str]) -> Vec<Vec<f64>> {
    let told = call(folder, &[&["exact"], arguments].concat());
    assert_eq!(told.code, 0, "{}", told.err);
    let mut reader = csv::Reader::from_reader(told.out.as_bytes());
    let numbers = |row: csv::StringRecord| row.iter().map(|field| field.parse().expect("a number")).collect();
    reader.records().map(|row| numbers(row.expect("a row"))).collect()
}

/// One sample of a column.
#[derive(Clone, Copy)]
struct Row {
    time: f64,
    height: f64,
    pressure: f64,
    volume: f64,
}

/// The exact column at the points of twenty cells, two a cell, at four times.
fn column(folder: &Path) -> Vec<Row> {
    let depths: Vec<String> = (0..40).map(|point| ((f64::from(point) + 0.5) / 40.0).to_string()).collect();
    let rows = exact(folder, &["terzaghi", "--time-factor", "0.05,0.1,0.2,0.5", "--zeta", &depths.join(",")]);
    let row = |row: &Vec<f64>| Row {
        time: row[0] * SECONDS,
        height: 1.0 - row[1],
        pressure: row[2],
        volume: 1.0 / 40.0,
    };
    rows.iter().map(row).collect()
}

const MAPPING: &str = r#"columns = { t = "t", y = "y", p = "p", volume = "v" }
units = { time = "s", length = "m", stress = "Pa" }
sign = { y = "up", p = "compression-positive" }
position = { y = "reference" }
"#;

/// Scores rows of a column against its own reference.
fn score(folder: &Path, rows: &[Row], options: &[&str]) -> Told {
    let mut text = "t,y,p,v\n".to_owned();
    for row in rows {
        writeln!(text, "{},{},{},{}", row.time, row.height, row.pressure, row.volume).expect("a line");
    }
    fs::write(folder.join("result.csv"), text).expect("a file");
    fs::write(folder.join("map.toml"), MAPPING).expect("a file");
    let common =
        ["score", "result.csv", "--scene", "terzaghi", "--reference", "terzaghi", "--mapping", "map.toml"];
    call(folder, &[&common, options].concat())
}

/// A layer as `exact` prints it at distances over its length, as somebody else's table.
fn write_layer(folder: &Path, name: &str, ratios: &str, header: &str) {
    let rows = exact(
        folder,
        &["cosine-layer", "--x", ratios, "--time-factor", "0.05,0.2", "--set", "layer.length=2.0"],
    );
    let mut text = format!("{header}\n");
    for row in rows {
        let (time, height, pressure) = (row[0] * SECONDS, 1.0 - row[1], row[2]);
        let (distance, horizontal, vertical) = (2.0 * row[5], row[6], row[7]);
        writeln!(text, "{time},{distance},{height},{pressure},{horizontal},{vertical}").expect("a line");
    }
    fs::write(folder.join(name), text).expect("a file");
}

#[test]
fn the_exact_layer_has_no_error_wherever_it_is_sampled() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for ratios in ["0", "0.25", "0.5", "1", "0.1,0.7", "0,0.25,0.5,0.75,1"] {
        write_layer(at, "layer.csv", ratios, "t,x,y,p,u_x,u_y");
        let layer = ["score", "layer.csv", "--scene", "cosine-layer", "--set", "layer.length=2.0"];
        let own = ["--reference", "cosine-layer", "--format", "csv", "--below", "1e-5"];
        let told = call(at, &[&layer[..], &own].concat());
        assert_eq!(told.code, 0, "x/L = {ratios}: {}", told.err);
        let is_profile = ratios.split(',').count() < 4;
        assert_eq!(
            told.err.contains("nothing is known about the rest"),
            is_profile,
            "{ratios}: {}",
            told.err
        );
        for quantity in ["pressure", "displacement"] {
            // Half a wave from the crest nothing presses, and a zero has no relative error.
            let is_zero = quantity == "pressure" && ratios == "0.5";
            let rows = told.out.lines().filter(|line| line.contains(&format!(",{quantity},points,l2,")));
            assert_eq!(rows.count(), if is_zero { 0 } else { 2 }, "{ratios}: {}", told.out);
        }
        assert_eq!(told.out.contains("settlement"), ratios.starts_with("0,") || ratios == "0");
    }
}

#[test]
fn a_table_without_mapping_may_lack_what_is_left_out_by_name() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let (times, depths) = ([0.05, 0.1], [0.1, 0.3, 0.5, 0.7, 0.9]);
    let fields = oedometer::api::exact::exact("terzaghi", &times, &depths, &[], &[]).expect("inside");
    let header = ["t,y,p\n".to_owned(), "t,y,u_y\n".to_owned()];
    let [mut pressures, mut displacements] = header;
    for place in 0..times.len() * depths.len() {
        let [time, height] = [times[place / depths.len()] * SECONDS, 1.0 - depths[place % depths.len()]];
        writeln!(pressures, "{time},{height},{}", fields.pressure[place]).expect("a line");
        writeln!(displacements, "{time},{height},{}", fields.displacement[place]).expect("a line");
    }
    fs::write(at.join("pressures.csv"), pressures).expect("a file");
    fs::write(at.join("displacements.csv"), displacements).expect("a file");
    for (file, lacks, has, column) in [
        ("pressures.csv", "displacement", "pressure", "u_y"),
        ("displacements.csv", "pressure", "displacement", "p"),
    ] {
        let gate = ["score", file, "--scene", "terzaghi", "--reference", "terzaghi", "--below", "1e-9"];
        let told = call(at, &gate);
        let asked = format!("there is no column `{column}` (to leave it out, call `score --without {lacks}`");
        assert!(told.code == 2 && told.err.contains(&asked), "{}", told.err);
        let told = call(at, &[&gate[..], &["--without", lacks]].concat());
        assert!(told.code == 0 && told.out.contains(has) && !told.out.contains(lacks), "{}", told.err);
        let told = call(at, &[&gate[..], &["--without", has]].concat());
        assert!(told.code == 2 && told.err.contains(&asked), "the other one is not excused: {}", told.err);
        // What another column is derived from may not be lacking.
        let current = "[columns]\nt = \"t\"\np = \"p\"\nu_y = \"u_y\"\n[position]\ny = \"current\"\n";
        fs::write(at.join("current.toml"), current).expect("a file");
        let told = call(at, &[&gate[..], &["--without", lacks, "--mapping", "current.toml"]].concat());
        let is_told = told.err.contains("there is no column `u_y`");
        assert_eq!(
            (told.code == 2, is_told),
            (lacks == "displacement", lacks == "displacement"),
            "{}",
            told.err
        );
    }
}

#[test]
fn samples_of_another_layer_are_wrong_or_beyond_its_end() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let shorter = ["score", "layer.csv", "--scene", "cosine-layer", "--below", "1e-2"];
    for (ratios, code, told_of) in [
        ("0.25", 1, "not below"),
        ("1", 2, "the initial distance 2 m from the crest is outside the layer of 1 m"),
    ] {
        write_layer(at, "layer.csv", ratios, "t,x,y,p,u_x,u_y");
        let told = call(at, &shorter);
        assert!(told.code == code && told.err.contains(told_of), "{ratios}: {}", told.err);
    }
}

#[test]
fn a_layer_without_the_place_along_it_is_refused() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    write_layer(at, "layer.csv", "0,0.5", "t,along,y,p,u_x,u_y");
    let told = call(at, &["score", "layer.csv", "--scene", "cosine-layer"]);
    assert_eq!((told.code, told.out.as_str()), (2, ""));
    assert!(told.err.contains("write the distance of each sample from the crest"), "{}", told.err);
    fs::write(at.join("map.toml"), MAPPING.replace(", volume = \"v\"", "")).expect("a file");
    let mapped = ["score", "layer.csv", "--scene", "cosine-layer", "--mapping", "map.toml"];
    let told = call(at, &mapped);
    assert_eq!((told.code, told.out.as_str()), (2, ""));
    assert!(told.err.contains("add `x = \"x\"` to [columns]"), "{}", told.err);
    // With it there is an answer, and from another origin it is another layer's place.
    for (origin, code) in [("0.0", 0), ("2.0", 2)] {
        let named = MAPPING
            .replace(", volume = \"v\"", ", x = \"along\"")
            .replace("sign = {", &format!("origin = {{ x = {origin} }}\nsign = {{ x = \"right\","));
        fs::write(at.join("map.toml"), named).expect("a file");
        let told = call(at, &mapped);
        assert_eq!(told.code, code, "{}", told.err);
        assert_eq!(told.err.contains("outside the layer of 1 m"), code == 2, "{}", told.err);
    }
}

#[test]
fn exact_takes_places_along_a_layer_and_of_nothing_else() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let layer = ["exact", "cosine-layer", "--time-factor", "0.1", "--zeta", "0.5"];
    let told = call(at, &[&layer[..], &["--x", "0,1"]].concat());
    let lines: Vec<&str> = told.out.lines().collect();
    assert!(
        lines[0].starts_with("time_factor,zeta,pressure_ratio,settlement_ratio,degree_of_consolidation,x,")
    );
    let pressure = |line: &str| line.split(',').nth(2).expect("a field").parse::<f64>().expect("a number");
    assert!((pressure(lines[1]) + pressure(lines[2])).abs() < 1e-15, "a cosine: {}", told.out);
    assert!(pressure(lines[1]) > 0.1);
    let without = call(at, &layer);
    assert_eq!(
        without.out.lines().next(),
        Some("time_factor,zeta,pressure_ratio,settlement_ratio,degree_of_consolidation")
    );
    let told = call(at, &["exact", "terzaghi", "--x", "0"]);
    assert_eq!((told.code, told.out.as_str()), (2, ""));
    assert!(told.err.contains("`--x` is for layers"), "{}", told.err);
}

#[test]
fn meshes_that_stop_at_times_of_their_own_are_one_series() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("map.toml"), MAPPING.replace(", volume = \"v\"", "")).expect("a file");
    let meshes = [(10, 4.083_32), (20, 4.083_34), (40, 4.083_3)];
    for (cells, time) in meshes {
        let heights: Vec<String> =
            (0..=cells).map(|node| (f64::from(node) / f64::from(cells)).to_string()).collect();
        let time_factor = (time / SECONDS).to_string();
        let rows = exact(at, &["terzaghi", "--time-factor", &time_factor, "--zeta", &heights.join(",")]);
        let mut text = "t,y,p\n".to_owned();
        for row in rows {
            let error = f64::from(cells).powi(-2);
            writeln!(text, "{time},{},{}", 1.0 - row[1], row[2] + error).expect("a line");
        }
        fs::write(at.join(format!("column-{cells}.csv")), text).expect("a file");
    }
    let files = ["column-10.csv", "column-20.csv", "column-40.csv"];
    let common =
        ["--cells", "10,20,40", "--scene", "terzaghi", "--reference", "terzaghi", "--mapping", "map.toml"];
    let with = |options: &[&str]| call(at, &[&["score"], &files[..], &common, options].concat());
    let told = with(&["--below", "1"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.out.contains("asymptotic") && told.out.contains("  2.0"), "{}", told.out);
    assert!(told.out.contains("times differ between the meshes by up to 4.9e-6"), "{}", told.out);
    let told = with(&["--time-tolerance", "1e-7"]);
    assert!(told.out.contains("not-evaluable") && told.err.contains("time-missing"), "{}", told.err);
    assert_eq!(with(&["--time-tolerance", "1e-7", "--strict"]).code, 1);
    assert_eq!(with(&["--time-tolerance", "2"]).code, 2);
    // 4.0833 s is 0.1 % and a little off T_v = 0.05, which takes 4.0875 s.
    let told = with(&["--time-factor", "0.05"]);
    assert!(told.code == 4 && told.err.contains("1.02e-3 off"), "{}", told.err);
    let told = with(&["--time-factor", "0.05", "--time-tolerance", "2e-3"]);
    assert!(told.code == 0 && told.out.contains("\n0.05  pressure"), "{}{}", told.out, told.err);
    let told = with(&["--time-factor", "0.05,0.1", "--time-tolerance", "2e-3"]);
    assert!(
        told.err.contains("time-missing") && told.err.contains("T_v = 0.1, which was asked for"),
        "{}",
        told.err
    );
}

#[test]
fn a_result_that_is_not_whole_is_told_and_fails_a_gate() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let whole = column(at);
    let told = score(at, &whole, &["--below", "1e-9", "--strict", "--time-factor", "0.05,0.1,0.2,0.5"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(!told.err.contains("warning") && !told.err.contains("fail"), "{}", told.err);
    let keep = |kept: &dyn Fn(usize) -> bool| -> Vec<Row> {
        whole.iter().enumerate().filter(|(place, _)| kept(*place)).map(|(_, row)| *row).collect()
    };
    let lighter = |factor: f64| -> Vec<Row> {
        whole.iter().map(|row| Row { volume: factor * row.volume, ..*row }).collect()
    };
    for (what, rows, lack) in [
        (
            "every second point",
            keep(&|place| place % 2 == 0),
            "volume-differs: at T_v = 0.05, the volumes add up to 0.5",
        ),
        ("1.8 % of the volume", lighter(0.982), "volume-differs: at T_v = 0.05, the volumes add up to 0.982"),
        ("twice the volume", lighter(2.0), "100.00 % are too many"),
        (
            "half the column",
            keep(&|place| place % 40 < 20),
            "height-not-covered: at T_v = 0.05, no sample lies between 0 m and 0.5125 m",
        ),
        ("one point", keep(&|place| place % 40 != 17), "height-not-covered"),
        ("some points by chance", keep(&|place| place * place % 7 > 1), "height-not-covered"),
        ("a file cut in half", keep(&|place| place < 93), "samples-differ: T_v = 0.2 has 13 samples"),
        (
            "the same between times",
            keep(&|place| place < 80),
            "time-missing: there is no T_v = 0.2 (and 1 more)",
        ),
    ] {
        let asked = ["--time-factor", "0.05,0.1,0.2,0.5"];
        let told = score(at, &rows, &asked);
        assert_eq!(told.code, 0, "{what}: {}", told.err);
        assert!(
            told.err.contains(&format!("warning: {lack}"))
                || told.err.contains("warning: volume-differs") && told.err.contains(lack),
            "{what}: {}",
            told.err
        );
        for gate in [&["--strict"][..], &["--below", "0.5"]] {
            let told = score(at, &rows, &[&asked[..], gate].concat());
            assert_eq!(told.code, 1, "{what} {gate:?}: {}", told.err);
            assert!(told.err.contains("fail: ") && told.err.contains(lack), "{what}: {}", told.err);
        }
        let json = score(at, &rows, &[&asked[..], &["--format", "json"]].concat());
        let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
        assert!(value[0]["warnings"][0]["name"].is_string(), "{what}: {}", json.out);
    }
    let told = score(at, &whole, &["--strict"]);
    assert!(
        told.code == 0 && told.err.contains("name the required times with --time-factor"),
        "{}",
        told.err
    );
    let told = score(at, &lighter(40.0), &["--strict"]);
    assert!(told.code == 0 && told.err.contains("are used as weights"), "{}", told.err);
    fs::write(at.join("whole.toml"), format!("whole_volume = 41.0\n{MAPPING}")).expect("a file");
    let declared = ["score", "result.csv", "--scene", "terzaghi", "--mapping", "whole.toml", "--strict"];
    let told = call(at, &declared);
    assert!(told.code == 1 && told.err.contains("2.44 % are missing"), "{}", told.err);
}

#[test]
fn points_that_a_mesh_lacks_show_beside_the_other_meshes() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("map.toml"), MAPPING.replace(", volume = \"v\"", "")).expect("a file");
    let write = |name: &str, points: u32| {
        let depths: Vec<String> =
            (0..points).map(|point| ((f64::from(point) + 0.5) / f64::from(points)).to_string()).collect();
        let mut text = "t,y,p\n".to_owned();
        for row in exact(at, &["terzaghi", "--time-factor", "0.1", "--zeta", &depths.join(",")]) {
            writeln!(text, "{},{},{}", row[0] * SECONDS, 1.0 - row[1], row[2]).expect("a line");
        }
        fs::write(at.join(name), text).expect("a file");
    };
    let gate = || {
        let files = ["score", "a.csv", "b.csv", "c.csv", "--cells", "5,10,20", "--strict"];
        call(at, &[&files[..], &["--scene", "terzaghi", "--mapping", "map.toml"]].concat())
    };
    for (name, points) in [("a.csv", 10), ("b.csv", 20), ("c.csv", 40)] {
        write(name, points);
    }
    assert_eq!(gate().code, 0);
    write("c.csv", 20);
    let told = gate();
    assert!(
        told.code == 1
            && told.err.contains("c.csv: samples-differ: samples lie at 1 heights per cell, and at 2 on"),
        "{}",
        told.err
    );
}

#[test]
fn a_start_passes_on_the_scale_of_the_load_and_a_column_in_the_plane_needs_no_crest() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mapping = "columns = { t = \"t\", x = \"x\", y = \"y\", p = \"p\", u_x = \"u_x\", u_y = \"u_y\" }\n\
        units = { stress = \"Pa\" }\nsign = { p = \"compression-positive\", u_y = \"up\" }\n";
    fs::write(at.join("plane.toml"), mapping).expect("a file");
    let depths: Vec<String> = (0..=20).map(|node| (f64::from(node) / 20.0).to_string()).collect();
    let rows = exact(at, &["terzaghi", "--time-factor", "5", "--zeta", &depths.join(",")]);
    // The scale of displacements is m_v q H, that of their start 1.6e-4 of it.
    let told = |bend: f64, start: f64| {
        let mut text = "t,x,y,p,u_x,u_y\n".to_owned();
        for (row, x) in rows.iter().flat_map(|row| [(row, 0.0), (row, 0.4)]) {
            let height = 1.0 - row[1];
            writeln!(text, "0,{x},{height},{},0,{start}", if row[1] > 0.0 { 1.0 } else { 0.0 })
                .expect("a line");
            let moved = -row[3] * height * (1.0 + bend * x);
            writeln!(text, "{},{x},{height},{},0,{moved}", row[0] * SECONDS, row[2]).expect("a line");
        }
        fs::write(at.join("result.csv"), text).expect("a file");
        // All has drained: the displacement is linear.
        let files = [
            "score",
            "result.csv",
            "--scene",
            "terzaghi",
            "--reference",
            "terzaghi",
            "--mapping",
            "plane.toml",
        ];
        call(at, &[&files[..], &["--below", "1e-3"]].concat())
    };
    let fine = told(0.0, 0.0);
    assert_eq!(fine.code, 0, "{}{}", fine.out, fine.err);
    assert!(!fine.err.contains("crest") && !fine.err.contains("not plane"), "{}", fine.err);
    let moved = told(0.0, -5e-7);
    assert!(
        moved.code == 1
            && moved.err.contains("displacement at T_v = 0 has an error over the final settlement of"),
        "{}",
        moved.err
    );
    let bent = told(0.5, 0.0);
    assert!(bent.err.contains("your top is not plane: at y = 1 m u_y lies between"), "{}", bent.err);
}

#[test]
fn mistakes_that_the_numbers_show_are_named_and_others_are_not() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let whole = column(at);
    let changed = |change: &dyn Fn(&Row) -> Row| whole.iter().map(change).collect::<Vec<Row>>();
    for (rows, told_of) in [
        (
            changed(&|row| Row { pressure: -row.pressure, ..*row }),
            "your p is −1.00 × the exact one: is the sign",
        ),
        (changed(&|row| Row { pressure: 1e-3 * row.pressure, ..*row }), "is it in kPa where Pa is declared"),
        (
            changed(&|row| Row { pressure: row.pressure + 9810.0 * (1.0 - row.height), ..*row }),
            "with the weight of the water: is the hydrostatic part left in?",
        ),
        (changed(&|row| Row { time: row.time / 60.0, ..*row }), "are times in min where s is declared"),
        (
            changed(&|row| Row { height: 1.0 - row.height, ..*row }),
            "upside down: is `y` counted from the other",
        ),
        (changed(&|row| Row { time: row.time / 1.3, ..*row }), "at 1.3 × the time: is k 1.3e-4 m/s for 1e-4"),
        (
            changed(&|row| Row { time: row.time / 1.02, ..*row }),
            "at 1.02 × the time: is k 1.02e-4 m/s for 1e-4",
        ),
        (changed(&|row| Row { pressure: 0.0, ..*row }), "is 0 everywhere: is it the wrong array"),
    ] {
        let told = score(at, &rows, &[]);
        assert_eq!(told.code, 0, "{}", told.err);
        let sentences: Vec<&str> = told.err.lines().filter(|line| line.starts_with("diagnosis: ")).collect();
        assert!(sentences.len() == 1 && sentences[0].contains(told_of), "{told_of}: {}", told.err);
    }
    for rows in [
        whole.clone(),
        changed(&|row| Row { pressure: row.pressure * (1.0 + 0.3 * (9.0 * row.height).sin()), ..*row }),
    ] {
        let told = score(at, &rows, &[]);
        assert!(!told.err.contains("diagnosis"), "{}", told.err);
    }
}

/// What was found by a search of all errors for each took two minutes for as many times.
/// The second run's points lie elsewhere, so that no time and no place repeats.
#[test]
fn two_runs_at_places_of_their_own_are_diagnosed_as_two_and_not_as_a_mixture() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let first = column(at);
    let other =
        |row: &Row| Row { height: (row.height + 0.01).min(0.999), pressure: 0.6 * row.pressure, ..*row };
    let both: Vec<Row> = first.iter().copied().chain(first.iter().map(other)).collect();
    let diagnosed = |rows: &[Row]| -> Vec<String> {
        let told = score(at, rows, &[]);
        told.err.lines().filter(|line| line.starts_with("diagnosis:")).map(str::to_owned).collect()
    };
    assert_eq!(diagnosed(&first), [""; 0]);
    let told = diagnosed(&both);
    let is_named =
        |line: &String| line.contains("it holds two runs") && line.ends_with("was a second run appended?");
    assert!(told.len() == 1 && told.iter().all(is_named), "{told:?}");
}

#[test]
fn many_times_take_as_long_as_their_number() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let times = 10_000;
    let mut text = "t,y,p,u_y\n".to_owned();
    for time in 0..times {
        for node in 0..3 {
            let (time, height) = (1.0 + 1e-3 * f64::from(time), f64::from(node) / 2.0);
            writeln!(text, "{time},{height},0.5,-1e-7").expect("a line");
        }
    }
    fs::write(at.join("long.csv"), text).expect("a file");
    let started = std::time::Instant::now();
    let told = call(at, &["score", "long.csv", "--scene", "terzaghi"]);
    assert_eq!(told.code, 0);
    assert_eq!(
        told.out.lines().filter(|line| line.split_whitespace().any(|word| word == "pressure")).count(),
        10_000
    );
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
}

/// Pressures of a column at its nodes on a mesh, each times a factor, without some of them.
fn nodes(at: &Path, (solution, name): (&str, &str), cells: u32, factor: f64, without: &[u32], set: &[&str]) {
    let depths: Vec<String> =
        (0..=cells).map(|node| (f64::from(node) / f64::from(cells)).to_string()).collect();
    let mut text = "t,y,p,u_y\n".to_owned();
    let depths = depths.join(",");
    let asked = [&[solution, "--time-factor", "0.1,0.5", "--zeta", &depths][..], set].concat();
    for (place, row) in (0..).zip(exact(at, &asked)) {
        if !without.contains(&(place % (cells + 1))) {
            // What all of a column that has drained settles is no matter here: only whether it is there.
            let moved = -row[3] * (1.0 - row[1]);
            writeln!(text, "{},{},{},{moved}", row[0] * SECONDS, 1.0 - row[1], factor * row[2])
                .expect("a line");
        }
    }
    fs::write(at.join(name), text).expect("a file");
}

#[test]
fn what_is_not_judged_is_told_and_strict_does_not_pass_it() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let surface = "no sample lies on the surface (y = 1 m)";
    let base = "on the base (y = 0 m)";
    let declared = "sample = \"nodes\"\nunits = { stress = \"Pa\" }\nsign = { p = \"compression-positive\", u_y = \"up\" }\n";
    fs::write(at.join("nodes.toml"), declared).expect("a file");
    let nodes_declared = ["--mapping", "nodes.toml"];
    let settlement = "the settlement is not judged";
    // At the base alone the exact displacement is 0, and nothing is known about the settlement.
    let above_base: Vec<u32> = (0..20).collect();
    for (without, options, lacks) in [
        (&above_base[..], &[][..], &[settlement][..]),
        (&[], &[], &[]),
        (&[0], &[], &[surface, settlement]),
        (&[0], &["--without", "settlement"], &[surface]),
        (&[20], &[], &[base]),
        (&[0, 20], &[], &[settlement]),
        (&[0, 20], &nodes_declared, &[surface, base, settlement]),
    ] {
        nodes(at, ("terzaghi", "a.csv"), 20, 1.0, without, &[]);
        let gate = |judged: &[&str]| {
            let common = ["score", "a.csv", "--scene", "terzaghi", "--time-factor", "0.1,0.5"];
            call(at, &[&common[..], options, judged].concat())
        };
        let strict = gate(&["--strict"]);
        assert_eq!(strict.code, i32::from(!lacks.is_empty()), "{without:?} {options:?}: {}", strict.err);
        let below = gate(&["--below", "1"]);
        assert_eq!(below.code, 0, "{}", below.err);
        let told = |told: &Told, word: &str, end: &str, lack: &str| {
            told.err.lines().any(|line| line.starts_with(word) && line.contains(lack) && line.ends_with(end))
        };
        for lack in [surface, base, settlement] {
            let is_lacking = lacks.contains(&lack);
            assert_eq!(told(&strict, "fail: a.csv: ", "", lack), is_lacking, "{lack}: {}", strict.err);
            assert_eq!(
                told(&below, "note: a.csv: ", "`--strict` fails on this", lack),
                is_lacking,
                "{}",
                below.err
            );
        }
    }
}

#[test]
fn a_result_of_which_nothing_is_compared_does_not_pass() {
    let folder = TempDir::new().expect("a folder");
    nodes(folder.path(), ("terzaghi", "a.csv"), 20, 1.0, &[], &[]);
    let gate = ["score", "a.csv", "--scene", "terzaghi", "--strict", "--without"];
    for (left_out, code) in [("pressure", 0), ("pressure,displacement,settlement", 1)] {
        let told = call(folder.path(), &[&gate[..], &[left_out]].concat());
        let is_told = told.err.contains("✗ a.csv: nothing of it is compared");
        assert_eq!((told.code, is_told), (code, code == 1), "{left_out}: {}", told.err);
    }
}

#[test]
fn the_water_is_named_where_errors_fall_against_that_of_the_other_kind_alone() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let soft = ["--set", "material.water_bulk_modulus=5e8"];
    let told = |solution: &str, against: &str| {
        for cells in [10, 20, 40, 80] {
            let (factor, name) = (1.0 + 0.8 / f64::from(cells * cells), format!("{cells}.csv"));
            let set = if solution == "terzaghi" { &soft[..] } else { &[] };
            nodes(at, (solution, &name), cells, factor, &[], set);
        }
        let files = ["score", "10.csv", "20.csv", "40.csv", "80.csv", "--cells", "10,20,40,80"];
        let without = ["--without", "displacement,settlement", "--time-factor", "0.1"];
        let scene = ["--scene", "terzaghi", "--reference", against];
        let told = call(at, &[&files[..], &scene, &without, &soft].concat());
        let sentences = told.err.lines().filter_map(|line| line.strip_prefix("diagnosis: 80.csv: "));
        sentences.map(str::to_owned).collect::<Vec<_>>()
    };
    let [stiff, soft] = ["terzaghi-incompressible", "terzaghi"];
    for (solution, against) in [(stiff, stiff), (soft, soft)] {
        assert_eq!(told(solution, against), [""; 0], "{solution} {against}");
    }
    for (solution, against, asked) in [
        (stiff, soft, "is the water of your solver incompressible, n/K_w = 0?"),
        (soft, stiff, "is the water of your solver compressible, n/K_w > 0?"),
    ] {
        let told = told(solution, against);
        let end = format!("{asked} Then `--reference {solution}` is the right one");
        assert!(told.len() == 1 && told[0].ends_with(&end), "{solution} {against}: {told:?}");
    }
}

/// `T_v` = 0.1 of the seed column is 8.175 s.
#[test]
fn times_are_taken_as_a_study_takes_them() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    nodes(at, ("terzaghi", "a.csv"), 20, 1.0, &[], &[]);
    for (command, time, factor) in [
        (&["exact", "terzaghi", "--zeta", "0.5"][..], "0.13625 min,40.875", "0.1,0.5"),
        (&["score", "a.csv", "--scene", "terzaghi", "--format", "csv"], "8175 ms", "0.1"),
        (
            &["solve", "terzaghi", "--integrator", "implicit", "--cells", "4", "--format", "csv"],
            "8.175 s,4.73090277777777778e-4d",
            "0.1,0.5",
        ),
    ] {
        let rows = |option: &str, list: &str| {
            let told = call(at, &[command, &[option, list]].concat());
            assert_eq!(told.code, 0, "{}", told.err);
            let row = |line: &str| {
                line.split(',')
                    .map(|field| {
                        field.parse::<f64>().map_or(field.to_owned(), |number| format!("{number:.6e}"))
                    })
                    .collect::<Vec<_>>()
            };
            told.out.lines().map(row).collect::<Vec<_>>()
        };
        assert_eq!(rows("--time", time), rows("--time-factor", factor), "{command:?}");
    }
    let told = call(at, &["score", "a.csv", "--scene", "terzaghi", "--time", "1 h", "--strict"]);
    assert!(told.code != 0 && told.err.contains("there is no T_v = 44"), "{}", told.err);
}
