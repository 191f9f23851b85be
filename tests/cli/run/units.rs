//! The same soil in other units of length, time and mass: every number of a record, of its tables and of a score changes by
//! its own dimension, and what is a share changes by nothing.
//!
//! A column of one metre under one pascal hides a settlement in metres told as a share, or a pressure told over the load.

use crate::program::{call, folder_with};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Powers of two, so that no digit is rounded in another way.
const LENGTH: f64 = 4.0;
const TIME: f64 = 0.5;
const MASS: f64 = 16.0;

/// Exponents of length, time and mass of a number, by the key that names it in a record or the column of a table; what is
/// not named here is a share, a count or a choice.
#[expect(clippy::match_same_arms, reason = "a line has no width, whatever the next arm says of planes")]
fn dimension(key: &str, dimensions: i32) -> [i32; 3] {
    match key {
        // A line has no width.
        "length" | "width" if dimensions == 1 => [0; 3],
        "height"
        | "length"
        | "width"
        | "cell_size"
        | "distance"
        | "settlement"
        | "initial_height"
        | "displacement_height"
        | "initial_distance"
        | "displacement_distance"
        | "displacement"
        | "horizontal_displacement" => [1, 0, 0],
        "volume" | "water_expansion" => [dimensions, 0, 0],
        "surface_flux" => [1, 0, 0],
        "time" | "seconds" | "predicted_critical" | "target" | "largest" | "largest_step_seconds" => {
            [0, 1, 0]
        }
        "hydraulic_conductivity" | "largest_velocity" => [1, -1, 0],
        "coefficient_of_consolidation" => [2, -1, 0],
        "gravity" => [1, -2, 0],
        "load" | "pressure" | "effective_stress" | "youngs_modulus" | "oedometric_modulus"
        | "water_bulk_modulus" => [-1, -2, 1],
        "grain_density" | "water_density" => [-3, 0, 1],
        "solid_mass" => [dimensions - 3, 0, 1],
        "kinetic" | "strain" => [dimensions - 1, -2, 1],
        // Of the checks of the start it is a share of the load.
        "totals.unbalanced_force" => [dimensions - 2, -2, 1],
        _ => [0, 0, 0],
    }
}

fn factor_of([length, time, mass]: [i32; 3]) -> f64 {
    LENGTH.powi(length) * TIME.powi(time) * MASS.powi(mass)
}

/// A soil and a body in which no number is one; `factor` is that of a key's dimension.
fn settings(table: &str, factor: impl Fn(&str) -> f64) -> Vec<(String, f64)> {
    let mut keys = vec![
        (format!("{table}.height"), 2.3),
        (format!("{table}.load"), 37.0),
        ("material.youngs_modulus".to_owned(), 1.3e6),
        ("material.poissons_ratio".to_owned(), 0.22),
        ("material.porosity".to_owned(), 0.43),
        ("material.grain_density".to_owned(), 2710.0),
        ("material.water_density".to_owned(), 1030.0),
        ("material.water_bulk_modulus".to_owned(), 1.7e8),
        ("material.hydraulic_conductivity".to_owned(), 4.1e-4),
        ("material.gravity".to_owned(), 9.7),
    ];
    if table == "layer" {
        keys.push(("layer.length".to_owned(), 2.3 * 1.25));
    }
    for (key, value) in &mut keys {
        *value *= factor(key.rsplit('.').next().expect("a key"));
    }
    keys
}

struct Case {
    scene: &'static str,
    load: f64,
    sweep: &'static str,
}

const CASES: [Case; 5] = [
    Case {
        scene: "terzaghi",
        load: 1.0,
        sweep: "method = [\"GC-SRI-patch\", \"MPM\"]\nintegrator = [\"implicit\"]\ncells = [6]\ntime_factors = [0.03, 0.4]\n",
    },
    Case {
        scene: "terzaghi",
        load: 1.0,
        sweep: "method = [\"GIMP-SRI-patch\"]\nintegrator = [\"explicit\"]\ncells = [5]\ntime_factors = [0.003, 0.02]\n",
    },
    Case {
        scene: "xie-leo",
        load: 4e3,
        sweep: "method = [\"GC-SRI-patch\", \"TL-GIMP-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [6]\ntime_factors = [0.03, 0.4]\n",
    },
    Case {
        scene: "cosine-layer",
        load: 1.0,
        sweep: "method = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [4]\ntime_factors = [0.03, 0.1]\n",
    },
    Case {
        scene: "dynamic-column",
        load: 1.0,
        sweep: "method = [\"GC-SRI-patch\"]\nintegrator = [\"explicit\"]\ncells = [7]\ntime_factors = [1.0e-4, 6.0e-4]\n",
    },
];

impl Case {
    fn table(&self) -> &'static str {
        if self.scene == "cosine-layer" { "layer" } else { "column" }
    }

    fn dimensions(&self) -> i32 {
        if self.scene == "cosine-layer" { 2 } else { 1 }
    }

    /// Keys and values, in the units of the test or in others.
    fn settings(&self, is_scaled: bool) -> Vec<(String, f64)> {
        let mut keys = settings(self.table(), |key| {
            if is_scaled { factor_of(dimension(key, self.dimensions())) } else { 1.0 }
        });
        keys[1].1 *= self.load;
        keys
    }

    fn study(&self, is_scaled: bool) -> String {
        let mut text = format!("title = \"Units\"\nscene = \"{}\"\n", self.scene);
        for (key, value) in self.settings(is_scaled) {
            writeln!(text, "{key} = {value:e}").expect("memory");
        }
        text + "[[sweep]]\n" + self.sweep
    }

    /// Records of the cases by method, and the rows of the study's table.
    fn run(&self, is_scaled: bool) -> (BTreeMap<String, Value>, Vec<BTreeMap<String, String>>) {
        let folder = folder_with(&self.study(is_scaled));
        let told = call(folder.path(), &["run", "short.toml", "--out", "out"]);
        assert_eq!(told.code, 0, "{}", told.err);
        let listed = call(folder.path(), &["records", "out/short"]);
        let mut records = BTreeMap::new();
        for row in rows_of(&listed.out) {
            let told = call(folder.path(), &["records", "out/short", &row["case"]]);
            let mut record: Value = serde_json::from_str(&told.out).expect("a record");
            record["wall"].take();
            records.insert(row["method"].clone(), record);
        }
        let table = fs::read_to_string(folder.path().join("out/short/short.csv")).expect("a table");
        let mut rows = rows_of(&table);
        rows.sort_by_key(|row| row["method"].clone());
        (records, rows)
    }
}

fn rows_of(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

/// Every number of a record with the way to it, and the key that names it.
fn numbers_of(value: &Value, path: &str, key: &str, numbers: &mut Vec<(String, String, f64)>) {
    match value {
        Value::Number(number) => {
            numbers.push((path.to_owned(), key.to_owned(), number.as_f64().expect("a number")));
        }
        Value::Array(values) => {
            for (place, value) in values.iter().enumerate() {
                numbers_of(value, &format!("{path}[{place}]"), key, numbers);
            }
        }
        Value::Object(fields) => {
            for (name, value) in fields {
                let is_force = key == "totals" && name == "unbalanced_force";
                let key = if is_force { "totals.unbalanced_force" } else { name };
                numbers_of(value, &format!("{path}.{name}"), key, numbers);
            }
        }
        _ => {}
    }
}

/// Compares numbers by their keys; of a field that vanishes, over its largest value anywhere.
fn assert_scaled(
    what: &str,
    base: &[(String, String, f64)],
    scaled: &[(String, String, f64)],
    dimensions: i32,
) {
    assert_eq!(base.len(), scaled.len(), "{what}");
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (_, key, value) in base {
        let largest = largest.entry(key).or_default();
        *largest = largest.max(value.abs());
    }
    for ((path, key, one), (other_path, _, other)) in base.iter().zip(scaled) {
        assert_eq!(path, other_path, "{what}");
        let factor = factor_of(dimension(key, dimensions));
        // A share of round-off is another one.
        let allowed = 1e-9 * one.abs() + 1e-11 * if factor == 1.0 { 1.0 } else { largest[&**key] };
        assert!(
            (other / factor - one).abs() <= allowed,
            "{what}, {path}: {other:e} for {factor} times {one:e}"
        );
    }
}

#[test]
fn every_number_of_a_record_and_of_its_table_scales_by_its_dimension() {
    for case in &CASES {
        let ((base, base_rows), (scaled, scaled_rows)) = (case.run(false), case.run(true));
        assert!(!base.is_empty() && base.len() == scaled.len());
        let mut with_dimension = 0;
        for ((method, one), (_, other)) in base.iter().zip(&scaled) {
            let what = format!("{} {method}", case.scene);
            assert_eq!(one["status"], "ok", "{what}");
            let [mut a, mut b] = [Vec::new(), Vec::new()];
            numbers_of(one, "", "", &mut a);
            numbers_of(other, "", "", &mut b);
            with_dimension += a.iter().filter(|one| dimension(&one.1, 1) != [0; 3]).count();
            assert_scaled(&what, &a, &b, case.dimensions());
        }
        assert!(with_dimension > 100, "{with_dimension}");
        let numbers = |rows: &[BTreeMap<String, String>]| -> Vec<(String, String, f64)> {
            let mut numbers = Vec::new();
            for (place, row) in rows.iter().enumerate() {
                for (key, cell) in row {
                    let is_ours = !matches!(&**key, "case" | "sources" | "wall_seconds" | "cpu_seconds");
                    if let Some(number) = cell.parse().ok().filter(|_| is_ours) {
                        numbers.push((format!("[{place}].{key}"), key.clone(), number));
                    }
                }
            }
            numbers
        };
        assert_scaled(case.scene, &numbers(&base_rows), &numbers(&scaled_rows), case.dimensions());
    }
}

/// A result of the column as somebody else's tables: what the nodes have, and the settlement of the surface.
fn write_result(folder: &Path, record: &Value) {
    let (mut text, mut settlements) = ("t,y,p,u_y\n".to_owned(), "t,s\n".to_owned());
    for snapshot in record["snapshots"].as_array().expect("outputs") {
        let of = |name: &str| snapshot[name].as_f64().expect("a number");
        writeln!(settlements, "{:e},{:e}", of("time"), of("settlement")).expect("memory");
        let nodes = &snapshot["nodes"];
        for place in 0..nodes["pressure"].as_array().expect("nodes").len() {
            let of = |name: &str| nodes[name][place].as_f64().expect("a number");
            let (y, p, u) = (of("initial_height"), of("pressure"), of("displacement"));
            writeln!(text, "{:e},{y:e},{p:e},{u:e}", snapshot["time"].as_f64().expect("a time"))
                .expect("memory");
        }
    }
    fs::write(folder.join("result.csv"), text).expect("a file");
    fs::write(folder.join("settlement.csv"), settlements).expect("a file");
    let mapping = "[settlement]\nfile = \"settlement.csv\"\nt = \"t\"\ns = \"s\"\n";
    fs::write(folder.join("map.toml"), mapping).expect("a file");
}

#[test]
fn a_score_knows_no_units() {
    let case = &CASES[0];
    let scores = [false, true].map(|is_scaled| {
        let (records, _) = case.run(is_scaled);
        let folder = tempfile::TempDir::new().expect("a folder");
        write_result(folder.path(), &records["MPM"]);
        let mut arguments: Vec<String> =
            ["score", "result.csv", "--mapping", "map.toml", "--scene", "terzaghi", "--format", "csv"]
                .map(str::to_owned)
                .to_vec();
        for (key, value) in case.settings(is_scaled) {
            arguments.extend(["--set".to_owned(), format!("{key}={value:e}")]);
        }
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let told = call(folder.path(), &arguments);
        assert_eq!(told.code, 0, "{}", told.err);
        rows_of(&told.out)
    });
    let [one, other] = &scores;
    assert_eq!(one.len(), other.len());
    let settlements = one.iter().filter(|row| row["quantity"] == "settlement").count();
    assert!(one.len() > 8 && settlements > 0, "{one:?}");
    for (one, other) in one.iter().zip(other) {
        for (key, cell) in one {
            match (cell.parse::<f64>(), other[key].parse::<f64>()) {
                (Ok(a), Ok(b)) => assert!((a - b).abs() <= 1e-9 * a.abs(), "{key}: {a} and {b}"),
                _ => assert_eq!(cell, &other[key], "{key}"),
            }
        }
    }
}
