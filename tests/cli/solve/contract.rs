//! The contract of `solve` and `exact`: columns, names, digits, exit codes, and the accuracy that
//! the paper's method is known for.

use crate::program::call;
use serde_json::Value;
use std::path::Path;

/// Exit code, standard output and standard error.
fn told(arguments: &[&str]) -> (i32, String, String) {
    let told = call(Path::new("."), arguments);
    (told.code, told.out, told.err)
}

fn json(arguments: &[&str]) -> (i32, Value) {
    let (code, out, err) = told(&[arguments, &["--format", "json"]].concat());
    (code, serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}{err}")))
}

/// One row of the CSV of `solve`.
#[derive(Clone, Debug, serde::Deserialize)]
struct Measure {
    time_factor: f64,
    quantity: String,
    sample: String,
    norm: String,
    reference: String,
    value: f64,
}

fn rows<T: serde::de::DeserializeOwned>(csv_text: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_reader(csv_text.as_bytes());
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

fn measures(arguments: &[&str]) -> Vec<Measure> {
    let (code, out, err) = told(&[&["solve"], arguments, &["--format", "csv"]].concat());
    assert_eq!(code, 0, "{err}");
    rows(&out)
}

fn value(
    measures: &[Measure],
    time_factor: f64,
    quantity: &str,
    sample: &str,
    norm: &str,
    reference: &str,
) -> f64 {
    let fits = |row: &&Measure| {
        row.time_factor == time_factor
            && row.quantity == quantity
            && row.sample == sample
            && row.norm == norm
            && row.reference == reference
    };
    let found: Vec<&Measure> = measures.iter().filter(fits).collect();
    assert_eq!(found.len(), 1, "one row of {time_factor} {quantity} {sample} {norm} {reference}");
    found[0].value
}

/// The implicit drag takes the paper's step at a third of the steps and errs alike.
fn on_cells(method: &str, cells: usize) -> Vec<Measure> {
    let cells = cells.to_string();
    measures(&[
        "terzaghi",
        "--method",
        method,
        "--cells",
        &cells,
        "--time-factor",
        "0.05,0.1",
        "--set",
        "integrator.drag=implicit",
        "--reference",
        "terzaghi",
    ])
}

#[test]
fn the_csv_has_the_contract_s_columns_and_names() {
    let (code, out, err) =
        told(&["solve", "terzaghi", "--cells", "4", "--time-factor", "0.2,0.1", "--format", "csv"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let header = out.lines().next().expect("a header");
    assert_eq!(header, "time_factor,quantity,sample,norm,reference,value");
    let rows: Vec<Measure> = rows(&out);
    for row in &rows {
        assert!(row.time_factor == 0.1 || row.time_factor == 0.2);
        assert!(row.value.is_finite() && row.value.abs() < 0.5, "{row:?}");
        assert!(row.reference == "terzaghi" || row.reference == "terzaghi-incompressible", "{row:?}");
        match row.quantity.as_str() {
            "settlement" => assert_eq!((row.sample.as_str(), row.norm.as_str()), ("surface", "relative")),
            "pressure" | "effective_stress" | "displacement" => {
                assert!(["points", "centres", "nodes"].contains(&row.sample.as_str()), "{row:?}");
                assert!(["l1", "l2", "linf"].contains(&row.norm.as_str()), "{row:?}");
            }
            other => panic!("a quantity called {other}"),
        }
    }
    // 2 times × 2 references × (3 quantities × 3 samples × 3 norms + the settlement).
    assert_eq!(rows.len(), 2 * 2 * (3 * 3 * 3 + 1));
    assert!(rows.windows(2).all(|pair| pair[0].time_factor <= pair[1].time_factor), "times ascend");
}

#[test]
fn the_json_has_the_same_measures_and_what_the_contract_adds() {
    let arguments = ["solve", "terzaghi", "--cells", "4", "--time-factor", "0.1"];
    let (code, json) = json(&arguments);
    assert_eq!(code, 0);
    assert_eq!(json["status"], "ok");
    let (steps, updates) =
        (json["steps"].as_u64().expect("steps"), json["point_updates"].as_u64().expect("updates"));
    assert!(steps > 0);
    assert_eq!(updates, steps * 8, "4 cells of 2 points");
    assert!(json["wall_seconds"].as_f64().expect("a wall time") > 0.0);
    assert!((json["groups"]["storage"].as_f64().expect("storage") - 0.3 * 1.2e6 / 2.2e9).abs() < 1e-12);
    assert!((json["groups"]["finite_strain"].as_f64().expect("strain") * 1.2e6 - 1.0).abs() < 1e-12);
    assert!((json["groups"]["step_over_limit"].as_f64().expect("step") - 0.8).abs() < 1e-3);
    assert_eq!(json["start"]["points"], 8);
    assert_eq!(json["start"]["points_expected"], 8);
    assert!(json["start"]["undrained_pressure_error"].as_f64().expect("start").abs() < 1e-12);
    let balance = &json["balance"][0];
    assert!(balance["internal_force_imbalance"].as_f64().expect("imbalance").abs() < 1e-12);
    assert!(balance["solid_mass_drift"].as_f64().expect("drift").abs() < 1e-12);
    let from_json: Vec<(String, f64)> = json["measures"]
        .as_array()
        .expect("measures")
        .iter()
        .map(|row| {
            let word = |key: &str| row[key].as_str().expect("a word").to_owned();
            let name = [word("quantity"), word("sample"), word("norm"), word("reference")].join(" ");
            (name, row["value"].as_f64().expect("a number"))
        })
        .collect();
    let from_csv: Vec<(String, f64)> = measures(&arguments[1..])
        .into_iter()
        .map(|row| ([row.quantity, row.sample, row.norm, row.reference].join(" "), row.value))
        .collect();
    assert_eq!(from_json, from_csv, "to the last bit");
}

#[test]
fn one_reference_can_be_asked_for() {
    let rows = measures(&[
        "terzaghi",
        "--cells",
        "4",
        "--time-factor",
        "0.1",
        "--reference",
        "terzaghi-incompressible",
    ]);
    assert_eq!(rows.len(), 28);
    assert!(rows.iter().all(|row| row.reference == "terzaghi-incompressible"));
}

#[test]
fn the_undrained_start_is_time_factor_zero() {
    let rows = measures(&["terzaghi", "--cells", "4", "--time-factor", "0"]);
    assert!(value(&rows, 0.0, "pressure", "points", "linf", "terzaghi") < 1e-14);
    // Against incompressible water the start errs by the storage, n E_oed/K_w = 1.636e-4.
    let storage = value(&rows, 0.0, "pressure", "points", "l2", "terzaghi-incompressible");
    assert!((storage - 0.3 * 1.2e6 / (2.2e9 + 0.3 * 1.2e6)).abs() < 1e-12, "{storage}");
}

#[test]
fn point_wise_and_assembled_steps_agree_through_the_door() {
    let arguments = ["terzaghi", "--cells", "5", "--time-factor", "0.05"];
    let assembled = measures(&arguments);
    let point_wise = measures(&[&arguments[..], &["--point-wise"]].concat());
    assert_eq!(assembled.len(), point_wise.len());
    for (a, b) in assembled.iter().zip(&point_wise) {
        assert!((a.value - b.value).abs() <= 1e-8 * b.value.abs() + 1e-12, "{a:?} for {b:?}");
    }
}

#[test]
fn an_unstable_case_is_named_with_its_step_and_time_and_keeps_what_it_reached() {
    let arguments =
        ["solve", "terzaghi", "--cells", "4", "--time-factor", "0,0.1", "--time-step", "stable=1.1"];
    let (code, out, err) = told(&[&arguments[..], &["--format", "csv"]].concat());
    assert_eq!(code, 3, "{err}");
    assert!(err.starts_with("error: ") && !err.contains("panicked"), "{err}");
    for part in ["unstable", "at step ", "t = ", "T_v = ", "of the predicted critical"] {
        assert!(err.contains(part), "`{part}` is missing in {err}");
    }
    let reached: Vec<Measure> = rows(&out);
    assert!(!reached.is_empty() && reached.iter().all(|row| row.time_factor == 0.0), "the start was reached");
    let (code, json) = json(&arguments);
    assert_eq!(code, 3);
    assert_eq!(json["status"], "unstable");
    assert_eq!(json["failure"]["kind"], "unstable");
    assert_eq!(json["failure"]["step"], json["steps"]);
    assert!(json["failure"]["time"].as_f64().expect("a time") > 0.0);
}

#[test]
fn a_step_a_little_below_the_limit_is_sound() {
    let (code, _, err) =
        told(&["solve", "terzaghi", "--cells", "4", "--time-factor", "1", "--time-step", "stable=0.97"]);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn a_dotted_key_reaches_the_case() {
    let (_, json) = json(&[
        "solve",
        "terzaghi",
        "--cells=3",
        "--time-factor=0.1",
        "--set=material.porosity=0.45",
        "--set=column.load=2",
        "--set=integrator.drag=implicit",
        "--time-step=seconds=1e-4",
    ]);
    assert_eq!(json["case"]["material"]["porosity"], 0.45);
    assert_eq!(json["case"]["column"]["load"], 2.0);
    assert_eq!(json["case"]["settings"]["drag"], "implicit");
    assert_eq!(json["case"]["time_step"]["seconds"], 1e-4);
    assert!((json["groups"]["storage"].as_f64().expect("storage") - 0.45 * 1.2e6 / 2.2e9).abs() < 1e-12);
}

#[test]
fn the_table_for_people_names_the_quantities() {
    let (code, out, _) = told(&["solve", "terzaghi", "--cells", "4", "--time-factor", "0.1"]);
    assert_eq!(code, 0);
    for word in ["pressure", "settlement", "terzaghi"] {
        assert!(out.contains(word), "{word} is missing in {out}");
    }
}

/// Issue 2, "What it must show".
#[test]
fn the_paper_s_method_is_as_accurate_as_it_must_be() {
    let levels = [10, 20, 40].map(|cells| on_cells("GC-SRI-patch", cells));
    for (time_factor, at_ten, share) in [(0.05, 5.6e-3, 0.1), (0.1, 3.6e-3, 0.1)] {
        let errors =
            levels.each_ref().map(|rows| value(rows, time_factor, "pressure", "points", "l2", "terzaghi"));
        assert!((errors[0] / at_ten - 1.0).abs() < share, "T_v = {time_factor}: {errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((1.9..=2.15).contains(&order), "T_v = {time_factor}: order {order} of {errors:?}");
        }
    }
    let settlement =
        levels.each_ref().map(|rows| value(rows, 0.05, "settlement", "surface", "relative", "terzaghi"));
    assert!((settlement[0] + 0.012).abs() < 0.001, "−1.2 % on ten cells, got {settlement:?}");
    // 1.2 % is not asymptotic yet; the finer pair is.
    assert!(((settlement[1] / settlement[2]).log2() - 2.0).abs() < 0.1, "{settlement:?}");
    let stress =
        levels.each_ref().map(|rows| value(rows, 0.05, "effective_stress", "points", "l2", "terzaghi"));
    assert!(((stress[1] / stress[2]).log2() - 2.0).abs() < 0.1, "second order by CMPM: {stress:?}");
}

#[test]
fn constant_recovery_is_first_order_at_points_and_second_at_centres() {
    let levels = [10, 20, 40].map(|cells| on_cells("GIMP-SRI", cells));
    let of = |quantity: &str, sample: &str, time_factor: f64| {
        levels.each_ref().map(|rows| value(rows, time_factor, quantity, sample, "l2", "terzaghi"))
    };
    let at_points = of("pressure", "points", 0.05);
    assert!((at_points[0] / 4.0e-2 - 1.0).abs() < 0.1, "{at_points:?}");
    for time_factor in [0.05, 0.1] {
        for pair in of("pressure", "points", time_factor).windows(2) {
            assert!((0.9..=1.1).contains(&(pair[0] / pair[1]).log2()), "points {pair:?}");
        }
        for pair in of("pressure", "centres", time_factor).windows(2) {
            assert!((1.9..=2.15).contains(&(pair[0] / pair[1]).log2()), "centres {pair:?}");
        }
        for pair in of("effective_stress", "points", time_factor).windows(2) {
            assert!((0.9..=1.15).contains(&(pair[0] / pair[1]).log2()), "stress without CMPM {pair:?}");
        }
    }
}

#[test]
fn the_single_mode_shows_the_formal_order() {
    let errors = [5, 10, 20, 40].map(|cells: usize| {
        let cells = cells.to_string();
        let implicit = "integrator.drag=implicit";
        let rows = measures(&["single-mode", "--cells", &cells, "--time-factor", "0.05", "--set", implicit]);
        value(&rows, 0.05, "pressure", "centres", "l2", "single-mode")
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.03, "order {order} of {errors:?}");
    }
}

/// One row of the CSV of `exact`.
#[derive(Clone, Debug, serde::Deserialize)]
struct Exact {
    time_factor: f64,
    zeta: f64,
    pressure_ratio: f64,
    settlement_ratio: f64,
    degree_of_consolidation: f64,
}

fn exact(arguments: &[&str]) -> Vec<Exact> {
    let (code, out, err) = told(&[&["exact"], arguments].concat());
    assert_eq!(code, 0, "{err}");
    rows(&out)
}

/// `T`, `ζ`, `W(ζ, T)`, `U(T)`, from sums in 50 digits.
const SERIES: [(f64, f64, f64, f64); 12] = [
    (1e-6, 0.001, 0.520_499_877_813_046_5, 0.001_128_379_167_095_512_7),
    (0.002, 0.001, 0.012_615_136_977_203_432, 0.050_462_650_440_403_2),
    (0.002, 0.5, 0.999_999_999_999_997_3, 0.050_462_650_440_403_2),
    (0.02, 0.25, 0.788_700_452_666_289_5, 0.159_576_912_160_573_07),
    (0.05, 0.05, 0.125_632_938_228_782_8, 0.252_313_252_177_754_7),
    (0.05, 1.0, 0.996_869_195_483_994_9, 0.252_313_252_177_754_7),
    (0.1, 0.5, 0.735_651_315_244_19, 0.356_823_400_452_454_03),
    (0.2, 0.75, 0.716_227_265_536_152_7, 0.504_087_820_202_548_6),
    (0.5, 0.25, 0.141_898_731_953_271_2, 0.763_950_330_743_848_8),
    (1.0, 1.0, 0.107_977_044_444_109_01, 0.931_259_678_463_333_7),
    (2.0, 0.5, 0.006_474_969_929_149_199, 0.994_170_478_926_160_4),
    (10.0, 0.75, 2.263_281_844_599_644_3e-11, 0.999_999_999_984_404_4),
];

#[test]
fn exact_prints_terzaghi_s_series_to_the_last_digits() {
    for (time_factor, zeta, w, u) in SERIES {
        let (time_text, zeta_text) = (time_factor.to_string(), zeta.to_string());
        let rows = exact(&["terzaghi-incompressible", "--time-factor", &time_text, "--zeta", &zeta_text]);
        assert_eq!(rows.len(), 1);
        let row = &rows[0];
        assert_eq!((row.time_factor, row.zeta), (time_factor, zeta));
        assert!(
            (row.pressure_ratio - w).abs() < 1e-14,
            "W({zeta}, {time_factor}) = {} for {w}",
            row.pressure_ratio
        );
        assert!((row.degree_of_consolidation - u).abs() < 1e-14, "U({time_factor})");
        // s/H = m_v q U with m_v q = 1/1.2e6.
        assert!((row.settlement_ratio * 1.2e6 - u).abs() < 1e-14, "s/H at {time_factor}");
    }
}

#[test]
fn exact_scales_the_series_where_the_water_is_compressible() {
    // p/q = B W(ζ, B T) and U = 1 − B + B U(B T): at T/B the series above is met again.
    let storage_ratio = 2.2e9 / (2.2e9 + 0.3 * 1.2e6);
    for (time_factor, zeta, w, u) in SERIES {
        let (time_text, zeta_text) = ((time_factor / storage_ratio).to_string(), zeta.to_string());
        let row = exact(&["terzaghi", "--time-factor", &time_text, "--zeta", &zeta_text])[0].clone();
        assert!((row.pressure_ratio - storage_ratio * w).abs() < 1e-14, "{time_factor} {zeta}");
        let degree = 1.0 - storage_ratio + storage_ratio * u;
        assert!((row.degree_of_consolidation - degree).abs() < 1e-14, "{time_factor}");
    }
}

#[test]
fn exact_prints_17_significant_digits_and_the_contract_s_columns() {
    let (code, out, err) = told(&["exact", "terzaghi", "--time-factor", "0.05,1", "--zeta", "0,0.3,1"]);
    assert_eq!(code, 0);
    let mut lines = out.lines();
    assert_eq!(
        lines.next(),
        Some("time_factor,zeta,pressure_ratio,settlement_ratio,degree_of_consolidation")
    );
    let mut count = 0;
    for line in lines {
        count += 1;
        for field in line.split(',').skip(2) {
            let mantissa = field.split('e').next().expect("a mantissa");
            assert_eq!(mantissa.chars().filter(char::is_ascii_digit).count(), 17, "{line}");
        }
    }
    assert_eq!(count, 6);
    assert!(err.contains("terms") && err.contains("tail below"), "{err}");
}

#[test]
fn exact_inverts_the_degree_of_consolidation() {
    for scene in ["terzaghi", "terzaghi-incompressible"] {
        let rows = exact(&[scene, "--degree", "0.1,0.5,0.9", "--zeta", "1"]);
        for (row, degree) in rows.iter().zip([0.1, 0.5, 0.9]) {
            assert!((row.degree_of_consolidation - degree).abs() < 1e-12, "{scene} {degree}: {row:?}");
        }
    }
}

#[test]
fn exact_json_says_how_far_it_can_be_trusted() {
    let (code, json) = json(&["exact", "single-mode", "--time-factor", "0.1", "--zeta", "0.5"]);
    assert_eq!(code, 0);
    assert_eq!(json["reference"], "single-mode");
    assert_eq!(json["rows"].as_array().map(Vec::len), Some(1));
    assert!(json["accuracy"][0]["terms"].as_u64().expect("terms") >= 1);
    assert!(json["accuracy"][0]["tail_bound"].as_f64().expect("a bound") < 1e-14);
    // p/q = sin(M ζ) exp(−M² B T) with M = π/2.
    let mode = std::f64::consts::FRAC_PI_2;
    let storage_ratio = 2.2e9 / (2.2e9 + 0.3 * 1.2e6);
    let expected = (0.5 * mode).sin() * (-mode * mode * storage_ratio * 0.1).exp();
    let got = json["rows"][0]["pressure_ratio"].as_f64().expect("a number");
    assert!((got - expected).abs() < 1e-14, "{got} for {expected}");
}

#[test]
fn list_names_what_can_be_chosen() {
    let (code, out, err) = told(&["list", "--all"]);
    assert_eq!((code, err.as_str()), (0, ""));
    for word in ["terzaghi", "single-mode", "MPM", "GC-SRI-patch", "uGIMP-SRI", "explicit", "terzaghi-mesh"] {
        assert!(
            out.lines().any(|line| line.split_whitespace().next() == Some(word)),
            "{word} is missing in\n{out}"
        );
    }
}

#[test]
fn outputs_can_be_set_by_their_key_too_but_not_twice() {
    let by_key =
        ["solve", "terzaghi", "--cells", "3", "--set", "output.time_factors=[0.01]", "--format", "csv"];
    let by_option = ["solve", "terzaghi", "--cells", "3", "--time-factor", "0.01", "--format", "csv"];
    let (code, out, err) = told(&by_key);
    assert_eq!((code, out), (0, told(&by_option).1), "{err}");
    let (code, _, err) = told(&[&by_option[..], &["--set", "output.time_factors=[0.01]"]].concat());
    assert_eq!(code, 2);
    assert!(err.contains("given by `--time-factor` and by `--set`"), "{err}");
    let (code, _, err) = told(&["solve", "terzaghi", "--set", "cells=20"]);
    assert_eq!(code, 2);
    assert!(err.contains("--cells NUMBER"), "{err}");
    let (code, _, err) = told(&["exact", "terzaghi", "--set", "column.load=1.0", "--set", "column.load=2.0"]);
    assert_eq!(code, 2);
    assert!(err.contains("`column.load` is given twice"), "{err}");
}

#[test]
fn a_degree_that_is_never_reached_is_named_as_it_was_typed() {
    for degree in ["1.5", "1", "-0.1"] {
        let (code, out, err) = told(&["exact", "terzaghi", "--degree", degree]);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(err.contains(&format!("a degree of consolidation of {degree} ")), "{err}");
    }
}

#[test]
fn small_strain_scenes_take_no_other_law_and_warn_of_large_loads() {
    for scene in ["terzaghi", "single-mode"] {
        let (code, _, err) = told(&["solve", scene, "--set", "material.law=log-linear"]);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("small strain") && err.contains("takes linear"), "{err}");
    }
    let quick = ["solve", "terzaghi", "--cells", "3", "--time-factor", "0.001"];
    let (code, _, err) = told(&quick);
    assert_eq!((code, err.as_str()), (0, ""));
    let (code, out, err) = told(&[&quick[..], &["--set", "column.load=200e3"]].concat());
    assert_eq!(code, 0);
    assert!(err.starts_with("warning: ") && err.contains("m_vl q = 1.67e-1"), "{err}");
    assert!(err.contains("xie-leo") && !out.is_empty(), "{err}");
}

#[test]
fn a_projection_that_slows_waves_is_warned_of_where_waves_are_what_is_solved() {
    let solve = |scene: &str, method: &str| {
        told(&["solve", scene, "--method", method, "--cells", "8", "--time-factor", "1e-6"])
    };
    for (scene, method, is_warned) in [
        ("standing-wave", "PPP", true),
        ("standing-wave", "VP", false),
        ("terzaghi", "PPP", false),
        ("dynamic-column", "TL-PPP", true),
    ] {
        let (code, _, err) = solve(scene, method);
        assert_eq!(code, 0, "{err}");
        assert_eq!(
            err.contains("on 8 cells the longest wave travels at "),
            is_warned,
            "{scene} {method}: {err}"
        );
    }
}

#[test]
fn several_meshes_are_solved_in_turn_and_a_failed_one_hides_no_other() {
    let line =
        ["solve", "terzaghi", "--integrator", "implicit", "--cells", "5,10,20", "--time-factor", "0.1"];
    let (code, out, err) = told(&line);
    assert_eq!(code, 0, "{err}");
    let rates: Vec<&str> = out.lines().skip_while(|line| !line.contains("5 cells")).skip(1).take(3).collect();
    assert!(rates.iter().all(|line| line.matches("e-").count() == 3 && line.contains("  2.0")), "{out}");
    let within = out.lines().find(|line| line.starts_with("settlement")).expect(&out);
    assert!(within.contains("1 %  GC-SRI-patch") && within.contains(" 10 "), "{out}");
    let (_, all) = json(&line);
    let cells: Vec<_> =
        all.as_array().expect("a list").iter().map(|one| one["case"]["cells"].clone()).collect();
    assert_eq!(cells, [5, 10, 20]);
    let (_, csv, _) = told(&[line.as_slice(), &["--format", "csv"]].concat());
    assert!(csv.starts_with("cells,time_factor,") && csv.contains("\n20,0.1,pressure,"), "{csv}");
    // A step beyond the limit of the finer mesh alone, whichever comes first.
    for cells in ["4,64", "64,4"] {
        let step = ["--time-step", "seconds=4.5e-5", "--time-factor", "0.01"];
        let (code, out, err) = told(&[["solve", "terzaghi", "--cells", cells].as_slice(), &step].concat());
        assert!(code == 3 && err.contains("the case failed (unstable)"), "{code} {out} {err}");
        let on_four =
            |line: &&str| line.contains("✗ GC-SRI-patch") && line.split_whitespace().any(|word| word == "4");
        assert_eq!(out.lines().filter(on_four).count(), 3, "{cells}: {out}");
    }
}

#[test]
fn fields_that_are_written_score_as_the_run_did_to_the_last_digit() {
    // Points that move, a plane, a slab on its side, a weight.
    for scene in [
        &["xie-leo", "--method", "GC-SRI-patch", "--set", "column.strain=0.2"][..],
        &["cosine-layer", "--method", "GIMP-SRI-patch"],
        &["mandel", "--method", "GIMP-SRI-patch", "--set", "column.width=0.25"],
        &["terzaghi", "--set", "column.self_weight=true"],
    ] {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join("fields").join(name).display().to_string();
        let times =
            ["--integrator", "implicit", "--cells", "4", "--time-factor", "0.1,0.4", "--fields", &at("")];
        let solved = measures(&[scene, &times[..]].concat());
        let set: Vec<&str> = scene.iter().copied().skip_while(|word| *word != "--set").collect();
        let files = [at("fields.pvd"), at("mapping.toml")];
        let line = ["score", &files[0], "--scene", scene[0], "--mapping", &files[1], "--format", "csv"];
        let (code, out, err) = told(&[&line[..], &["--time-factor", "0.1,0.4"], &set].concat());
        assert_eq!(code, 0, "{scene:?}: {out}{err}");
        let scored: Vec<Measure> = rows(&out);
        let mut compared = 0;
        for row in scored.iter().filter(|row| row.sample == "points") {
            let is_same = |other: &&Measure| {
                (&other.quantity, &other.sample, &other.norm, &other.reference, other.time_factor)
                    == (&row.quantity, &row.sample, &row.norm, &row.reference, row.time_factor)
            };
            // Of a slab `score` reads the displacement along the way of the water, and a run has both.
            let is_half = scene[0] == "mandel" && row.quantity == "displacement";
            let Some(own) = solved.iter().find(is_same).filter(|_| !is_half) else { continue };
            compared += 1;
            assert_eq!(own.value, row.value, "{scene:?}: {row:?}");
        }
        assert!(compared >= 8, "{scene:?}: {compared} of {out}");
    }
}

#[test]
fn fields_of_several_meshes_have_folders_and_those_of_two_point_sets_are_refused() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let fields = folder.path().display().to_string();
    let line = ["solve", "xie-leo", "--cells", "2,4", "--time-factor", "0.1", "--fields", &fields];
    let (code, _, err) = told(&[&line[..], &["--integrator", "implicit"]].concat());
    assert!(code == 0 && err.contains("1 states"), "{err}");
    assert!(folder.path().join("cells-4/fields_0000.vtu").is_file());
    let (code, out, err) = told(&[&line[..], &["--set", "points.sets=2"]].concat());
    assert!(code == 2 && out.is_empty() && err.contains("the water has separate points"), "{err}");
}
