//! An attached solver whole: the file that tells it its case in every scene, the record of what it left, and what is said of
//! results with one planted mistake.

use crate::all_commands::outputs::steady;
use crate::program::{ALLOWED, assert_snapshot, call, call_with};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Studies whose cases a solver can be told: the scene and what it says of the body, all numbers another.
const BODIES: [(&str, &str); 9] = [
    (
        "terzaghi",
        "column = { height = 2.5, load = 40.0 }\nmaterial = { youngs_modulus = 3.2e6, porosity = 0.37 }",
    ),
    ("terzaghi", "column = { height = 2.5, load = 40.0, self_weight = true }"),
    (
        "terzaghi",
        "column = { height = 2.5, width = 0.5, dimensions = 2, load = 40.0 }\npoints = { jitter = 0.1 }",
    ),
    ("xie-leo", "column = { height = 2.5, load = 5e4, loading_time = 7.0 }\nmaterial.law = 'log-linear'"),
    ("cosine-layer", "layer = { length = 3.0, height = 1.5, load = 30.0, base = 'smooth' }"),
    ("mandel", "column = { width = 0.5, load = 30.0 }"),
    ("layered", "column.soils = [{ thickness = 0.4 }, { thickness = 0.6, porosity = 0.5 }]"),
    ("footing", "layer.plate_width = 3.0"),
    ("yield-front", "material = { preconsolidation = 2e4, reload_modulus = 1.3e7 }"),
];

#[test]
fn the_file_of_a_case_says_all_of_it() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mut text = String::new();
    for (number, (scene, body)) in BODIES.iter().enumerate() {
        let name = format!("c{number}");
        let study = format!(
            "title = 't'\nscene = '{scene}'\n{body}\noutput.time_factors = [0.0001, 0.0002]\n[[solver]]\nname = 'theirs'\n\
             command = ['sh', 'a.sh']\nresult = '{{out}}/r.csv'\n[[sweep]]\nmethod = ['theirs']\ncells = [4]\npoints_per_cell = [3]\n"
        );
        fs::write(at.join(format!("{name}.toml")), study).expect("a file");
        fs::write(at.join("a.sh"), "exit 77\n").expect("a file");
        let told = call(at, &["plan", &format!("{name}.toml"), "--case-files", &name]);
        writeln!(text, "## {scene} {body}\n[{}] {}", told.code, steady(told.err.trim_end(), at))
            .expect("memory");
        let below =
            |folder: &Path| fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let mut files: Vec<_> = below(&at.join(&name))
            .flat_map(|path| if path.is_dir() { below(&path).collect() } else { vec![path] })
            .collect();
        files.sort();
        for file in files {
            writeln!(text, "{}", steady(&fs::read_to_string(file).expect("a file"), at)).expect("memory");
        }
    }
    assert_snapshot("attached_cases", &text);
}

/// A solver that says and leaves what the test wants, by the name of its mode.
const SOLVER: &str = r#"set -u
case "$1" in
    sound) cp "$3" "$2/r.csv" ;;
    slow) sleep 9 ;;
    fails) echo "the matrix is singular" >&2; exit 3 ;;
    skips) echo "no library here" >&2; exit 77 ;;
    silent) exit 0 ;;
    half) head -n 3 "$3" > "$2/r.csv" ;;
    wet) sed 's/38.2/wet/' "$3" > "$2/r.csv" ;;
    nan) sed 's/38.2/nan/' "$3" > "$2/r.csv" ;;
esac
echo "words of the output"
echo "It took 0.0125 ms"
echo "words of the errors" >&2
"#;

const RESULT: &str = "t,y,p,u_y\n\
    8.175,0.1,38.2,-1.0e-7\n8.175,0.3,36.5,-3.5e-7\n8.175,0.5,29.1,-8.0e-7\n8.175,0.7,20.2,-1.6e-6\n8.175,0.9,7.3,-2.8e-6\n\
    24.525,0.1,24.1,-1.3e-6\n24.525,0.3,21.8,-4.0e-6\n24.525,0.5,17.5,-7.0e-6\n24.525,0.7,11.3,-1.06e-5\n24.525,0.9,3.7,-1.5e-5\n";

/// The record of the one case of a study, but for what differs from run to run.
fn record(at: &Path, study: &str) -> String {
    let out = at.join("out").join(study);
    let list = call(at, &["records", &out.display().to_string()]).out;
    let hash = list.lines().nth(1).and_then(|line| line.split(',').next()).expect("a case").to_owned();
    let told = call(at, &["records", &out.display().to_string(), &hash]).out;
    let mut whole: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    let record = if whole.is_array() { &mut whole[0] } else { &mut whole };
    for key in ["provenance", "hash", "case", "snapshots", "history"] {
        record.as_object_mut().expect("an object").remove(key);
    }
    if let Some(wall) = record["wall"].as_array_mut() {
        for sample in wall {
            let sample = sample.as_object_mut().expect("an object");
            sample.retain(|key, _| ["own_seconds", "alone"].contains(&key.as_str()));
        }
    }
    steady(&serde_json::to_string_pretty(record).expect("JSON"), at)
}

#[test]
fn records_of_attached_runs_are_what_they_were() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("solver.sh"), SOLVER).expect("a file");
    fs::write(at.join("result.csv"), RESULT).expect("a file");
    let mut text = String::new();
    for mode in ["sound", "slow", "fails", "skips", "silent", "half", "wet", "nan"] {
        let study = format!(
            "title = 't'\nscene = 'terzaghi'\ncolumn.load = 40.0\noutput = {{ time_factors = [0.1, 0.3], references = ['terzaghi'] }}\n\
             [[solver]]\nname = 'theirs'\ncommand = ['sh', 'solver.sh', '{mode}', '{{out}}', 'result.csv']\nresult = '{{out}}/r.csv'\n\
             timeout = 3.0\nrepeats = 2\nversion = ['echo', 'theirs 1.2.3']\nsolve_seconds = 'It took ([0-9.]+)'\nsolve_unit = 'ms'\n\
             [[sweep]]\nmethod = ['theirs']\ncells = [5]\n"
        );
        // The folder of the study is where the solver starts from.
        fs::write(at.join(format!("{mode}.toml")), study).expect("a file");
        let told = call_with(at, &[ALLOWED], &["run", &format!("{mode}.toml")]);
        writeln!(
            text,
            "## {mode} [{}]\n{}\n{}",
            told.code,
            steady(told.err.trim_end(), at),
            record(at, mode)
        )
        .expect("memory");
        let told = call(at, &["check", &format!("{mode}.toml")]);
        writeln!(text, "[{}] {}", told.code, steady(told.out.trim_end(), at)).expect("memory");
    }
    assert_snapshot("attached_records", &text);
}

/// Exact rows of a column at four times, as a table with units of its own, after a change of each row: time, height, pressure,
/// displacement, effective stress.
fn table(rows: &[[f64; 5]], change: impl Fn([f64; 5]) -> [f64; 5]) -> String {
    let mut text = "t,y,p,u_y,s\n".to_owned();
    for row in rows {
        let row = change(*row).map(|number| format!("{number:e}"));
        writeln!(text, "{}", row.join(",")).expect("memory");
    }
    text
}

/// Exact rows of the column of 2 m under 50 kPa.
fn exact_rows() -> Vec<[f64; 5]> {
    let set = ["column.height=2".to_owned(), "column.load=50e3".to_owned()];
    let depths: Vec<f64> = (0..20).map(|point| (f64::from(point) + 0.5) / 20.0).collect();
    let mut rows = Vec::new();
    let folder = TempDir::new().expect("a folder");
    let list: Vec<String> = depths.iter().map(f64::to_string).collect();
    let words = [
        "exact",
        "terzaghi",
        "--time-factor",
        "0.05,0.1,0.2,0.5",
        "--zeta",
        &list.join(","),
        "--set",
        &set[0],
        "--set",
        &set[1],
    ];
    let told = call(folder.path(), &words);
    for line in told.out.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
        let (seconds, pressure) = (numbers[0] * 4.0 * 9810.0 / (1e-4 * 1.2e6), 50e3 * numbers[2]);
        rows.push([seconds, 2.0 * (1.0 - numbers[1]), pressure, 0.0, 50e3 - pressure]);
    }
    // Displacements by the trapezoidal rule over the strains of each time, from the base up.
    for start in (0..rows.len()).step_by(20) {
        let mut sum = 0.0;
        for place in (start..start + 20).rev() {
            sum += 0.1 * rows[place][4] / 1.2e6;
            rows[place][3] = -(sum - 0.05 * rows[place][4] / 1.2e6);
        }
    }
    rows
}

type Mistake = (&'static str, fn([f64; 5]) -> [f64; 5]);

const MISTAKES: [Mistake; 22] = [
    ("none", |row| row),
    ("times in minutes", |[t, y, p, u, s]| [t / 60.0, y, p, u, s]),
    ("times a tenth off", |[t, y, p, u, s]| [1.1 * t, y, p, u, s]),
    ("times later by ten seconds", |[t, y, p, u, s]| [t + 10.0, y, p, u, s]),
    ("depths for heights", |[t, y, p, u, s]| [t, 2.0 - y, p, u, s]),
    ("heights in millimetres", |[t, y, p, u, s]| [t, 1e3 * y, p, u, s]),
    ("heights over the column", |[t, y, p, u, s]| [t, 0.5 * y, p, u, s]),
    ("pressures in kilopascals", |[t, y, p, u, s]| [t, y, 1e-3 * p, u, s]),
    ("pressures with the other sign", |[t, y, p, u, s]| [t, y, -p, u, s]),
    ("pressures a fifth too small", |[t, y, p, u, s]| [t, y, 0.8 * p, u, s]),
    ("pressures of the load", |[t, y, p, u, s]| [t, y, p / 50e3, u, s]),
    ("pressures with the weight of the water", |[t, y, p, u, s]| [t, y, p + 9810.0 * (2.0 - y), u, s]),
    ("displacements with the other sign", |[t, y, p, u, s]| [t, y, p, -u, s]),
    ("displacements in millimetres", |[t, y, p, u, s]| [t, y, p, 1e3 * u, s]),
    ("displacements a third too large", |[t, y, p, u, s]| [t, y, p, 1.33 * u, s]),
    ("displacements zero", |[t, y, p, _, s]| [t, y, p, 0.0, s]),
    ("stresses with the other sign", |[t, y, p, u, s]| [t, y, p, u, -s]),
    ("total stresses", |[t, y, p, u, s]| [t, y, p, u, s + p]),
    ("stresses as pressures", |[t, y, p, u, s]| [t, y, s, u, p]),
    ("a wiggle", |[t, y, p, u, s]| [t, y, p + 500.0 * (40.0 * y).sin(), u, s]),
    ("a wrong base", |[t, y, p, u, s]| [t, y, if y < 0.3 { 0.0 } else { p }, u, s]),
    ("a wrong top", |[t, y, p, u, s]| [t, y, if y > 1.7 { 2.0 * p } else { p }, u, s]),
];

#[test]
fn results_with_one_planted_mistake_are_told_what_it_may_be() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mapping = "columns = { t = \"t\", y = \"y\", p = \"p\", u_y = \"u_y\", effective_stress = \"s\" }\n";
    fs::write(at.join("m.toml"), mapping).expect("a file");
    let rows = exact_rows();
    let score = ["score", "r.csv", "--scene", "terzaghi", "--mapping", "m.toml"];
    let soil = ["--set", "column.height=2", "--set", "column.load=50e3"];
    let mut text = String::new();
    let mut tell = |what: &str, words: &[&str]| {
        let told = call(at, &[&score[..], &soil, words].concat());
        writeln!(
            text,
            "## {what} [{}]\n{}\n{}",
            told.code,
            steady(told.out.trim_end(), at),
            steady(told.err.trim_end(), at)
        )
        .expect("memory");
    };
    for (what, mistake) in MISTAKES {
        fs::write(at.join("r.csv"), table(&rows, mistake)).expect("a file");
        tell(what, &["--reference", "terzaghi"]);
    }
    fs::write(at.join("r.csv"), table(&rows, |row| row)).expect("a file");
    for input in [
        "material.youngs_modulus=2e6",
        "material.hydraulic_conductivity=2e-4",
        "material.porosity=0.4",
        "material.water_bulk_modulus=2.2e7",
        "material.poissons_ratio=0.4",
    ] {
        tell(input, &["--set", input, "--reference", "terzaghi"]);
    }
    for (what, keep) in [("only the upper half", 0..10), ("only the lower half", 10..20), ("one place", 7..8)]
    {
        let kept: Vec<_> = rows
            .iter()
            .enumerate()
            .filter(|(place, _)| keep.contains(&(place % 20)))
            .map(|(_, row)| *row)
            .collect();
        fs::write(at.join("r.csv"), table(&kept, |row| row)).expect("a file");
        tell(what, &["--reference", "terzaghi"]);
    }
    assert_snapshot("planted_mistakes", &text);
}
