//! What is gone, cut, another mesh's or beyond all bounds in somebody else's result: told by name, and never passed.

use crate::program::{Told, call};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Seconds at which `T_v = 1` in the seed column.
const SECONDS: f64 = 81.75;

/// The files of `OpenGeoSys`, with the pressure under another name in those that a test holds of.
fn ogs(is_renamed: &dyn Fn(&str) -> bool) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign/ogs");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        let mut bytes = fs::read(&path).expect("a file");
        if path.extension().is_some_and(|extension| extension == "vtu") && is_renamed(&name) {
            let known = b"Name=\"pressure\"";
            let at = bytes.windows(known.len()).position(|part| part == known).expect("the array");
            bytes[at + 6..at + 14].copy_from_slice(b"pressurx");
        }
        fs::write(folder.path().join(name), bytes).expect("a file");
    }
    folder
}

fn score(at: &Path, more: &[&str]) -> Told {
    let common = ["score", "col.pvd", "--preset", "ogs", "--scene", "terzaghi", "--reference", "terzaghi"];
    call(at, &[&common, more].concat())
}

#[test]
fn a_quantity_that_is_gone_fails_a_gate_whichever_states_lack_it() {
    let times = ["4.087500", "8.175000", "16.350000", "40.875000", "81.750000"];
    let loaded = |name: &str| !name.contains("t_0.000000");
    let whole = ogs(&|_| false);
    assert_eq!(score(whole.path(), &["--strict"]).code, 0);
    let all = ogs(&|_| true);
    let of_loaded = ogs(&loaded);
    for (folder, words) in
        [(&of_loaded, "there is no `p` at any time"), (&all, "there is no `p` at any time")]
    {
        for gate in [&["--strict", "--below", "5e-3"][..], &["--strict"], &["--below", "0.9"]] {
            let told = score(folder.path(), gate);
            assert!(
                told.code == 1 && told.err.contains("quantity-missing") && told.err.contains(words),
                "{}",
                told.err
            );
        }
        let told = score(folder.path(), &[]);
        assert!(told.code == 0 && told.err.contains("warning: quantity-missing"), "{}", told.err);
        fs::write(folder.path().join("map.toml"), "[columns]\np = \"\"\n").expect("a file");
        let told = score(folder.path(), &["--mapping", "map.toml", "--strict"]);
        assert_eq!(told.code, 0, "taken out on purpose: {}", told.err);
    }
    for time in [times[0], times[2], times[4]] {
        let one = ogs(&|name| name.contains(&format!("_t_{time}")));
        let told = score(one.path(), &["--strict"]);
        assert!(told.code == 1 && told.err.contains("and other states have it"), "{time}: {}", told.err);
        fs::write(
            one.path().join("ogs.toml"),
            "title = \"Files\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.05, 0.1, 0.2, 0.5, 1.0] }\n\
             [[result]]\nname = \"ogs\"\nfiles = [\"col.pvd\"]\ncells = [10]\npreset = \"ogs\"\n",
        )
        .expect("a file");
        let told = call(one.path(), &["run", "ogs.toml"]);
        assert!(told.code == 3 && told.err.contains("there is no `p` at T_v ="), "{time}: {}", told.err);
    }
}

/// A table of the exact pressures at the nodes of some cells.
fn table(at: &Path, cells: usize) -> String {
    let depths: Vec<String> =
        (0..=cells).map(|node| (1.0 - node as f64 / cells as f64).to_string()).collect();
    let told = call(at, &["exact", "terzaghi", "--time-factor", "0.1,0.5", "--zeta", &depths.join(",")]);
    let mut text = "t,y,p,u_y\n".to_owned();
    for row in told.out.lines().skip(1) {
        let row: Vec<f64> = row.split(',').take(4).map(|typed| typed.parse().expect("a number")).collect();
        writeln!(text, "{},{},{},{}", row[0] * SECONDS, 1.0 - row[1], row[2], 0.0).expect("a line");
    }
    text
}

const NODES: &str = "sample = \"nodes\"\nunits = { stress = \"Pa\" }\nsign = { p = \"compression-positive\", u_y = \"up\" }\n";

/// What is said of a table as the result of a study, and as a gate by hand.
fn both(at: &Path, text: &str, cells: usize) -> [Told; 2] {
    fs::write(at.join("a.csv"), text).expect("a file");
    let study = format!(
        "title = \"A table\"\nscene = \"terzaghi\"\noutput = {{ time_factors = [0.1, 0.5] }}\n[[result]]\n\
         name = \"table\"\nfiles = [\"a.csv\"]\ncells = [{cells}]\nmapping = \"map.toml\"\n"
    );
    fs::write(at.join("table.toml"), study).expect("a file");
    let gate = ["score", "a.csv", "--scene", "terzaghi", "--mapping", "map.toml", "--strict"];
    [call(at, &["run", "table.toml"]), call(at, &gate)]
}

#[test]
fn what_is_cut_another_meshs_or_beyond_the_load_is_no_result() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("map.toml"), NODES).expect("a file");
    let sound = table(at, 5);
    for told in both(at, &sound, 5) {
        assert_eq!(told.code, 0, "{}", told.err);
    }
    let second = sound.lines().nth(2).expect("a row");
    let with = |pressure: &str| {
        let mut entries: Vec<&str> = second.split(',').collect();
        entries[2] = pressure;
        sound.replace(second, &entries.join(","))
    };
    for (text, of_study, of_gate) in [
        (sound.trim_end().to_owned(), "a.csv does not end with a line break", "end-missing"),
        (with("1e308"), "more than 100 times the load", "value-impossible"),
        (with("-2e9"), "a pressure is -2.000e9 Pa", "value-impossible: pressure of 2.000e9 at T_v = 0.1"),
    ] {
        let [study, gate] = both(at, &text, 5);
        assert!(study.code == 3 && study.err.contains(of_study), "{of_study}: {}", study.err);
        assert!(gate.code == 1 && gate.err.contains(of_gate), "{of_gate}: {}", gate.err);
    }
    let [study, _] = both(at, &table(at, 10), 5);
    assert!(
        study.code == 3 && study.err.contains("nodes of the result lie at 11 heights, but 5 cells have 6"),
        "{}",
        study.err
    );
    // A settlement curve that is cut inside its last number.
    let curve = format!("{NODES}[settlement]\nfile = \"curve.csv\"\n");
    fs::write(at.join("map.toml"), curve).expect("a file");
    for (end, code) in [("\n", [0, 0]), ("", [3, 1])] {
        fs::write(at.join("curve.csv"), format!("t,s\n8.175,3e-7\n40.875,6.4e-7{end}")).expect("a file");
        let told = both(at, &sound, 5);
        assert_eq!([told[0].code, told[1].code], code, "{}{}", told[0].err, told[1].err);
        assert_eq!(told[0].err.contains("curve.csv does not end"), end.is_empty(), "{}", told[0].err);
    }
}

#[test]
fn orders_and_classes_stand_in_what_programs_read() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for cells in [10, 20, 40] {
        let mut text = String::new();
        for (number, line) in table(at, cells).lines().enumerate() {
            let mut entries: Vec<String> = line.split(',').map(str::to_owned).collect();
            if number > 0 {
                let pressure: f64 = entries[2].parse().expect("a number");
                entries[2] = (pressure * (1.0 + 1.0 / (cells * cells) as f64)).to_string();
            }
            writeln!(text, "{}", entries.join(",")).expect("a line");
        }
        fs::write(at.join(format!("{cells}.csv")), text).expect("a file");
    }
    let common =
        ["score", "10.csv", "20.csv", "40.csv", "--cells", "10,20,40", "--scene", "terzaghi", "--reference"];
    let told = |format: &str| call(at, &[&common[..], &["terzaghi", "--format", format]].concat());
    let csv = told("csv").out;
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("result,time_factor,quantity,sample,norm,reference,value,cells,order,class"),
        "the errors' columns stay first"
    );
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let main: Vec<&Vec<&str>> = rows.iter().filter(|row| row[2] == "pressure" && row[4] == "l2").collect();
    assert_eq!(main.iter().map(|row| row[7]).collect::<Vec<_>>(), ["10", "10", "20", "20", "40", "40"]);
    for row in &main {
        let order: f64 = row[8].parse().expect("a number");
        assert!((order - 2.0).abs() < 0.01 && row[9] == "asymptotic", "{row:?}");
    }
    assert!(rows.iter().filter(|row| row[4] == "linf").all(|row| row[7..] == ["", "", ""]), "{csv}");
    let json: serde_json::Value = serde_json::from_str(&told("json").out).expect("JSON");
    assert_eq!(json.as_array().map(Vec::len), Some(3), "one a result, as before");
    let series = &json[2]["series"][0];
    assert_eq!(
        (series["class"].as_str(), series["cells"].to_string().as_str()),
        (Some("asymptotic"), "[10,20,40]")
    );
    assert!((series["order"].as_f64().expect("an order") - 2.0).abs() < 0.01);
    let alone = call(at, &["score", "10.csv", "--scene", "terzaghi", "--format", "csv"]).out;
    assert!(alone.starts_with("time_factor,quantity,sample,norm,reference,value\n"), "{alone}");
}

#[cfg(unix)]
#[test]
fn pipes_and_endless_lines_are_refused_in_a_few_words() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let made = std::process::Command::new("mkfifo").arg(at.join("pipe")).status().expect("mkfifo");
    assert!(made.success());
    fs::write(at.join("a.csv"), table(at, 5)).expect("a file");
    fs::write(at.join("curve.toml"), format!("{NODES}[settlement]\nfile = \"pipe\"\n")).expect("a file");
    let long = format!("secret = {}", "s".repeat(1_000_000));
    fs::write(at.join("long.toml"), &long).expect("a file");
    fs::write(at.join("long.csv"), &long).expect("a file");
    let score =
        |file: &str, mapping: &str| call(at, &["score", file, "--scene", "terzaghi", "--mapping", mapping]);
    for told in [
        score("a.csv", "pipe"),
        score("a.csv", "curve.toml"),
        score("pipe", "curve.toml"),
        score("a.csv", "/dev/zero"),
    ] {
        assert!(told.code == 2 && told.err.contains("a device or a pipe may never end"), "{}", told.err);
    }
    fs::write(at.join("map.toml"), NODES).expect("a file");
    for told in [call(at, &["plan", "long.toml"]), score("a.csv", "long.toml"), score("long.csv", "map.toml")]
    {
        assert!(told.code == 2 && told.err.len() < 8000, "{} letters", told.err.len());
        assert!(told.err.lines().all(|line| line.len() < 2500), "{}", told.err);
    }
}
