//! Records of small runs of every scene, whole: every error, balance, group and measure, as they are on disk. And the tables
//! that are made of them.

use crate::campaign::runner::records_of;
use crate::measure::record_checks::{balance_checks, start_checks};
use crate::measure::soundness;
use crate::record::csv::long_tables::{LongTable, columns_csv};
use crate::record::csv::tidy;
use crate::record::{Record, WallSample};
use crate::tests::{assert_snapshot, told};
use oedometer_wording::rounded;
use regex_lite::Regex;
use serde_json::Value;
use std::fmt::Write as _;

/// A run: its scene, what its study says of the body, its outputs, and its sweep.
const RUNS: [(&str, &str, &str, &str); 22] = [
    (
        "terzaghi",
        "column = { height = 2.5, load = 40.0 }",
        "0, 0.1, 0.5",
        "method = ['GIMP-SRI-patch']\nintegrator = ['implicit', 'semi-implicit']",
    ),
    (
        "terzaghi",
        "material.hydraulic_conductivity = 1e-3",
        "0.01",
        "method = ['MPM']\ntime_step = [{ stable = 0.9 }]",
    ),
    (
        "terzaghi",
        "material.hydraulic_conductivity = 1e-3",
        "0.01",
        "method = ['MPM']\ntime_step = [{ stable = 3.0 }]",
    ),
    (
        "terzaghi",
        "column = { dimensions = 2, width = 0.25, load = 40.0 }",
        "0.1",
        "method = ['GC-SRI-patch']\nintegrator = ['implicit']",
    ),
    (
        "terzaghi",
        "column = { load = 1e3, self_weight = true }",
        "0.1",
        "method = ['GIMP-SRI']\nintegrator = ['implicit']",
    ),
    (
        "terzaghi",
        "points = { sets = 2, water_per_cell = 3 }\nmaterial.hydraulic_conductivity = 1e-3\nintegrator.drag = 'implicit'",
        "0.01",
        "method = ['GIMP-SRI']\ntime_step = [{ stable = 0.8 }]",
    ),
    (
        "terzaghi",
        "points = { jitter = 0.2, filling = 0.5 }",
        "0.2",
        "method = ['GIMP-null-space']\nintegrator = ['implicit']",
    ),
    ("terzaghi", "task = 'stability'", "0.1", "method = ['GIMP-SRI']\nporosity = [0.3, 0.5]"),
    ("single-mode", "", "0.1, 0.3", "method = ['GIMP-SRI-patch']\nintegrator = ['implicit']"),
    (
        "xie-leo",
        "column.strain = 0.2",
        "0.1, 0.5",
        "method = ['GIMP-SRI-patch', 'TL-GIMP-SRI']\nintegrator = ['implicit']",
    ),
    (
        "xie-leo",
        "column = { load = 5e4, loading_time = 2.0 }",
        "0.1",
        "method = ['GIMP-SRI']\nintegrator = ['implicit']",
    ),
    ("dynamic-column", "", "1e-4", "method = ['GIMP-SRI']"),
    ("dynamic-single-mode", "", "1e-4", "method = ['GIMP-SRI']"),
    ("standing-wave", "", "1e-5", "method = ['GIMP-SRI']"),
    (
        "cosine-layer",
        "layer = { length = 2.0, base = 'smooth', load = 30.0 }",
        "0",
        "method = ['GIMP-SRI', 'GIMP']\nintegrator = ['implicit']",
    ),
    ("mandel", "column = { width = 0.5 }", "0.1", "method = ['GIMP-SRI']\nintegrator = ['implicit']"),
    ("footing", "", "0.5, 1.0", "method = ['GIMP-SRI']\nintegrator = ['implicit']"),
    (
        "layered",
        "column.soils = [{ thickness = 0.5 }, { thickness = 0.5, porosity = 0.5 }]",
        "0.1",
        "method = ['GIMP-SRI-patch']\nintegrator = ['implicit']",
    ),
    ("yield-front", "", "0.0002", "method = ['GIMP-SRI']\nintegrator = ['implicit']"),
    (
        "sealed-element",
        "integrator.drag = 'implicit'",
        "0.1",
        "method = ['GIMP-SRI']\nintegrator = ['implicit']",
    ),
    ("at-rest", "", "0.1", "method = ['GIMP-SRI']\nintegrator = ['implicit']"),
    ("manufactured-shear", "", "0.375, 0.75", "method = ['GIMP-SRI-patch']\ntime_step = [{ courant = 0.4 }]"),
];

fn study((scene, body, times, sweep): (&str, &str, &str, &str)) -> String {
    let step = if sweep.contains("time_step") || body.contains("stability") || !sweep.contains("integrator") {
        ""
    } else {
        "time_step = [{ growth = 0.2 }]\n"
    };
    format!(
        "title = 't'\nscene = '{scene}'\n{body}\n[output]\ntime_factors = [{times}]\n[[sweep]]\n{sweep}\ncells = [4]\n{step}"
    )
}

/// A record line by line, without what differs from run to run and from machine to machine.
fn record_told(record: &Record) -> String {
    let Value::Object(mut whole) = serde_json::to_value(record).expect("plain data") else {
        panic!("no object")
    };
    for name in ["provenance", "wall", "hash", "case"] {
        whole.remove(name);
    }
    let mut text = format!("{}\n", record.case.label());
    for (name, value) in whole {
        match value {
            Value::Array(rows) if name != "history" => {
                for row in rows {
                    writeln!(text, "  {name} {}", told(&row)).expect("memory");
                }
            }
            value => writeln!(text, "  {name} {}", told(&value)).expect("memory"),
        }
    }
    text
}

#[test]
fn records_of_small_runs_are_what_they_were() {
    let mut text = String::new();
    for run in RUNS {
        let [scene, body, ..] = [run.0, run.1];
        writeln!(text, "## {scene} {body}").expect("memory");
        for record in records_of(&study(run)) {
            text += &record_told(&record);
        }
    }
    assert_snapshot("records_of_small_runs", &text);
}

/// A table without its last digits.
fn with_rounded_cells(table: &str) -> String {
    let mut text = String::new();
    for line in table.lines() {
        let cell = |cell: &str| match cell.parse::<f64>() {
            Ok(tiny) if tiny.abs() < 1e-11 => "0".to_owned(),
            Ok(number) if cell.len() > 8 => rounded(number),
            _ => cell.to_owned(),
        };
        text += &line.split(',').map(cell).collect::<Vec<_>>().join(",");
        text.push('\n');
    }
    text
}

#[test]
fn tables_of_records_are_what_they_were() {
    let mut text = String::new();
    for place in [0, 2, 5, 7, 9, 14, 16, 21] {
        let mut records = records_of(&study(RUNS[place]));
        for (number, record) in records.iter_mut().enumerate() {
            let seconds = 3.25 + number as f64;
            record.wall =
                vec![WallSample { seconds, cpu_seconds: Some(0.5 * seconds), ..WallSample::default() }];
            record.hash = "hash".to_owned();
            record.provenance.sources = "sources".to_owned();
        }
        let rows: String = records.iter().map(|one| tidy::rows_of("the study", one).expect("rows")).collect();
        let rows: Vec<&str> = rows.lines().step_by(7).collect();
        let rows = rows.join("\n");
        writeln!(text, "## {}\n{}", RUNS[place].0, with_rounded_cells(&(tidy::header_line() + &rows)))
            .expect("memory");
        for long in [LongTable::Profiles, LongTable::History] {
            let rows: String = records.iter().map(|one| long.rows_of(one).expect("rows")).collect();
            let rows: Vec<&str> = rows.lines().collect();
            let ends = [&rows[..rows.len().min(4)], &rows[rows.len().saturating_sub(2)..]].concat();
            writeln!(
                text,
                "{} rows\n{}",
                rows.len(),
                with_rounded_cells(&(long.header_line() + &ends.join("\n")))
            )
            .expect("memory");
        }
    }
    text += &columns_csv().expect("a table");
    assert_snapshot("tables_of_records", &text);
}

#[test]
fn every_check_of_every_scene_has_its_bound_and_its_sentence() {
    let mut text = String::new();
    for run in RUNS {
        writeln!(text, "## {} {}", run.0, run.1).expect("memory");
        let record = records_of(&study(run)).remove(0);
        let start = start_checks(&record);
        let balances = record.balance.iter().flat_map(|balance| balance_checks(&record, balance));
        for check in start.into_iter().chain(balances) {
            let bound = check.bound.map_or("none".to_owned(), rounded);
            let value = if check.value.abs() < 1e-11 { 0.0 } else { check.value };
            writeln!(
                text,
                "{}: {}, bound {bound}, {} {}",
                check.what,
                rounded(value),
                check.unjudged,
                check.holds()
            )
            .expect("memory");
        }
        // Each number of a check a thousand times beyond what any bound allows, one at a time.
        let Value::Object(start) = serde_json::to_value(record.start).expect("plain data") else { continue };
        for name in start.keys() {
            let mut other = serde_json::to_value(&record).expect("plain data");
            let size = if other["start"][name].is_u64() { 7.into() } else { 1e3.into() };
            other["start"][name] = size;
            tell_complaints(&mut text, name, other);
        }
        for place in 0..record.balance.len() {
            let Value::Object(balance) = serde_json::to_value(record.balance[place]).expect("plain data")
            else {
                continue;
            };
            for (name, value) in &balance {
                let mut other = serde_json::to_value(&record).expect("plain data");
                let Value::Object(layers) = value else {
                    other["balance"][place][name] = 1e3.into();
                    tell_complaints(&mut text, name, other);
                    continue;
                };
                for part in layers.keys().filter(|part| *part != "water_points") {
                    let mut other = other.clone();
                    other["balance"][place][name][part] = 1e3.into();
                    tell_complaints(&mut text, part, other);
                }
            }
        }
    }
    assert_snapshot("checks_of_scenes", &text);
}

/// What is said of a record with another number under a name.
fn tell_complaints(text: &mut String, name: &str, other: Value) {
    let other: Record = serde_json::from_value(other).expect("a record");
    let number = Regex::new(r"-?\d+(\.\d+)?e-(1[1-9]|[23]\d)").expect("a pattern");
    for complaint in soundness::complaints(&other) {
        writeln!(text, "  {name}: {}", number.replace_all(&complaint, "≈0")).expect("memory");
    }
}
