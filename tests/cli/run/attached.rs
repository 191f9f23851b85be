//! Somebody else's solver in a study: run, told apart, judged beside the methods of this program.

use crate::program::{Told, call};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Every way in which the toy ends, with the status that it must get and words of its message.
const ENDS: [(&str, &str, &str); 9] = [
    ("hang", "timed-out", "exceeded its 2 s"),
    ("abort", "killed", "signal: 6"),
    ("fail", "failed", "matrix is singular in row 7"),
    ("skip", "skipped", "the library that I need is not here"),
    ("no-file", "no-result", "{out} has elsewhere.csv"),
    ("garbage", "unreadable", "result.csv"),
    ("nan", "not-finite", "`nan` in the column `p`"),
    ("half", "incomplete", "no sample lies between the heights 0.5 m and 1 m"),
    ("soft", "ok", ""),
];

/// Says why a test has nothing to do here.
#[expect(clippy::print_stderr, reason = "whoever reads the log of the tests must see it")]
fn skip(why: &str) {
    eprintln!("skipped: {why}");
}

/// A folder with the toy, compiled; none, with a word, where there is no compiler.
fn folder_with_toy() -> Option<TempDir> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign/toy-solver.c");
    let folder = TempDir::new().expect("a folder");
    let toy = folder.path().join("toy");
    match Command::new("cc").args(["-O1", "-o"]).arg(&toy).arg(&source).arg("-lm").status() {
        Ok(status) => {
            assert!(status.success(), "the toy does not compile");
            Some(folder)
        }
        Err(error) => {
            skip(&format!("there is no C compiler `cc` ({error})"));
            None
        }
    }
}

/// A solver that behaves so, on ten cells only.
fn solver(name: &str, mode: &str, more: &str) -> String {
    format!(
        "[[solver]]\nname = \"{name}\"\ncommand = [\"./toy\", \"{{case}}\", \"{{out}}\", \"{mode}\", \"10\"]\n\
         result = \"{{out}}/result.csv\"\nmapping = \"nodes.toml\"\ntimeout = 2.0\n{more}\n"
    )
}

fn write_study(folder: &Path, name: &str, solvers: &str, rest: &str) -> PathBuf {
    fs::write(folder.join("nodes.toml"), "sample = \"nodes\"\n").expect("a file");
    let path = folder.join(name);
    let head = "title = \"A toy beside\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1, 0.5]\n";
    fs::write(&path, format!("{head}{solvers}{rest}")).expect("a file");
    path
}

/// Rows of the tidy table, by their columns.
fn rows(folder: &Path, study: &str) -> Vec<Vec<(String, String)>> {
    let text = fs::read_to_string(folder.join(format!("out/{study}/{study}.csv"))).expect("a table");
    let mut lines = text.lines();
    let header: Vec<String> = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    lines.map(|line| header.iter().cloned().zip(line.split(',').map(str::to_owned)).collect()).collect()
}

fn field<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(column, _)| column == name).unwrap_or_else(|| panic!("no column {name}")).1
}

fn status_of(all: &[Vec<(String, String)>], solver: &str, cells: &str) -> String {
    let own = |row: &&Vec<(String, String)>| field(row, "method") == solver && field(row, "cells") == cells;
    field(all.iter().find(own).unwrap_or_else(|| panic!("{solver} on {cells} cells")), "status").to_owned()
}

#[test]
fn each_end_has_its_status_and_the_rest_of_the_sweep_goes_on() {
    let Some(folder) = folder_with_toy() else { return };
    let mut solvers = String::new();
    let mut names = String::new();
    for (mode, _, _) in ENDS {
        solvers += &solver(mode, mode, "");
        let _ = write!(names, ", \"{mode}\"");
    }
    solvers += "[[solver]]\nname = \"nowhere\"\ncommand = [\"./no-such-solver\"]\nresult = \"{out}/a.csv\"\n";
    let rest = format!(
        "[[sweep]]\nmethod = [\"GC-SRI-patch\", \"nowhere\"{names}]\nintegrator = [\"implicit\"]\n\
         cells = [10, 20]\ntime_step = [{{ growth = 0.05 }}]\n"
    );
    write_study(folder.path(), "ends.toml", &solvers, &rest);
    let told = call(folder.path(), &["run", "ends.toml"]);
    assert_eq!(told.code, 3, "a case failed: {}", told.err);
    let all = rows(folder.path(), "ends");
    for (mode, status, words) in ENDS {
        assert_eq!(status_of(&all, mode, "10"), status, "{mode}");
        assert_eq!(status_of(&all, mode, "20"), "ok", "the rest of {mode} goes on");
        let explained = call(folder.path(), &["explain", &format!("{mode} cells=10"), "ends.toml"]);
        let said = explained.words();
        assert_eq!(explained.code, 0, "{}", explained.err);
        assert!(said.contains(words) && (status == "ok" || said.contains(status)), "{mode}: {said}");
    }
    for cells in ["10", "20"] {
        assert_eq!(status_of(&all, "nowhere", cells), "not-startable");
        assert_eq!(status_of(&all, "GC-SRI-patch", cells), "ok");
    }
    assert!(told.err.contains("skip: 1 case was skipped"), "{}", told.err);
    // A study that is called as its solver: the words of a case are its own before its study's.
    fs::copy(folder.path().join("ends.toml"), folder.path().join("soft.toml")).expect("copied");
    let none = call(folder.path(), &["explain", "soft cells=10", "soft.toml", "--records", "none"]);
    assert!(none.code == 4 && none.err.contains("starts no solver"), "{}", none.err);
    assert_eq!(call(folder.path(), &["run", "soft.toml"]).code, 3);
    let told = call(folder.path(), &["explain", "soft cells=10", "soft.toml"]);
    assert!(told.code == 0 && told.out.contains("soft cells=10"), "{}", told.err);
    // What only this program's integrators take stands in no row of another solver.
    let foreign = all.iter().find(|row| field(row, "method") == "soft").expect("a row");
    assert_eq!((field(foreign, "integrator"), field(foreign, "time_step")), ("", ""));
    assert_eq!(field(foreign, "sample"), "nodes");
}

/// The toy, right on every mesh, beside a method of this program.
///
/// Of the slowest mode, `λ = π²/4`: backward Euler adds `λ² Δt t/2` to the pressure, finite differences `λ t (κh)²/12`
/// and take `(κh)²/12` off its start. With `Δt` = 0.001, `t` = 0.5 and `κh` = π/20 that is 1.52e-3 + 2.54e-3 − 2.06e-3
/// = 2.0e-3.
const BESIDE: &str = r#"
[[sweep]]
method = ["GC-SRI-patch", "toy"]
integrator = ["implicit"]
cells = [10, 20, 40]
time_step = [{ growth = 0.005 }]

[[expect]]
method = "toy"
quantity = "pressure"
sample = "nodes"
reference = "terzaghi"
time_factor = 0.5
order = { value = 2.0, minus = 0.1, plus = 0.1 }
at = { cells = 10, above = 1.9e-3, below = 2.1e-3 }

[[expect]]
method = "toy"
quantity = "settlement"
reference = "terzaghi"
time_factor = 0.5
class = "pre-asymptotic"
at = { cells = 40, below = 5.0e-4 }

[[expect]]
method = "GC-SRI-patch"
quantity = "pressure"
sample = "points"
reference = "terzaghi"
time_factor = 0.5
order = { value = 2.0, minus = 0.2, plus = 0.2 }
"#;

fn verdicts(told: &Told) -> (usize, usize) {
    let count = |word: &str| told.out.lines().filter(|line| line.contains(&format!(",{word},"))).count();
    (count("pass"), count("fail"))
}

#[test]
fn a_solver_is_judged_beside_the_methods_and_a_per_cent_of_permeability_is_seen() {
    let Some(folder) = folder_with_toy() else { return };
    let right = solver("toy", "right", "");
    write_study(folder.path(), "beside.toml", &right, BESIDE);
    let told = call(folder.path(), &["check", "beside.toml", "--format", "csv"]);
    assert_eq!(told.code, 5, "no golden values yet, all else passes: {}\n{}", told.out, told.err);
    let (pass, fail) = verdicts(&told);
    assert_eq!((pass, fail), (3, 1), "one line says that golden values are missing: {}", told.out);
    // The same with 1 % more permeability on every mesh.
    let soft = right.replace("\"right\", \"10\"", "\"soft\"");
    write_study(folder.path(), "beside.toml", &soft, BESIDE);
    let told = call(folder.path(), &["check", "beside.toml"]);
    assert_eq!(told.code, 1, "{}", told.out);
    let said = told.words();
    assert!(said.contains("toy: pressure l2 nodes against terzaghi at T_v = 0.5"), "{said}");
}

#[test]
fn finished_cases_are_taken_up_failed_ones_are_run_again_and_so_are_those_of_another_adapter() {
    let Some(folder) = folder_with_toy() else { return };
    let sweep = "[[sweep]]\nmethod = [\"toy\"]\ncells = [10, 20]\n";
    write_study(folder.path(), "again.toml", &solver("toy", "fail", ""), sweep);
    let run = || call(folder.path(), &["run", "again.toml", "--resume", "--keep-unproven"]);
    assert!(run().err.contains("2 cases (0 reused, 1 failed)"));
    let again = run().err;
    assert!(again.contains("2 cases (1 reused, 1 failed)"), "the failed one ran again: {again}");
    // A file of the adapter that is mended makes other cases.
    let mended = solver("toy", "right", "");
    write_study(folder.path(), "again.toml", &mended, sweep);
    let after = run().err;
    assert!(after.contains("2 cases (0 reused, 0 failed)"), "{after}");
    assert!(run().err.contains("2 cases (2 reused, 0 failed)"));
    let kept = fs::read_dir(folder.path().join("out/again/cases")).expect("cases");
    let whole = kept.flatten().filter(|case| case.path().join("solver/out/result.csv").is_file()).count();
    assert_eq!(whole, 3, "one of the first study, two of the second");
}

#[test]
fn repeats_are_timed_and_the_solver_says_its_version_and_its_own_time() {
    let Some(folder) = folder_with_toy() else { return };
    let more = "repeats = 3\nversion = [\"./toy\", \"--version\"]\nsolve_seconds = \"It took ([0-9.]+) s\"\n\
                env = { TOY = \"{cells}\" }\n";
    let sweep = "[[sweep]]\nmethod = [\"toy\"]\ncells = [10]\n";
    write_study(folder.path(), "timed.toml", &solver("toy", "right", more), sweep);
    assert_eq!(call(folder.path(), &["run", "timed.toml", "--jobs", "1"]).code, 0);
    let said = call(folder.path(), &["explain", "toy cells=10", "timed.toml"]).words();
    for part in
        ["toy-solver 1.2", "results of repeated runs differ by at most 0", "./toy {case} {out} right 10"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    let kept = call(folder.path(), &["records", "out/timed", "--format", "json"]).out;
    assert_eq!(kept.matches("\"own_seconds\": 0.125").count(), 3, "{kept}");
}

#[test]
fn what_is_not_installed_is_skipped_with_a_word_and_fails_nothing() {
    let Some(folder) = folder_with_toy() else { return };
    let absent = solver("toy", "skip", "").replace(", \"10\"]", "]");
    write_study(folder.path(), "absent.toml", &absent, BESIDE);
    let told = call(folder.path(), &["check", "absent.toml", "--format", "csv"]);
    assert_eq!(
        verdicts(&told),
        (1, 1),
        "the method of this program is judged, the solver is not: {}",
        told.out
    );
    let words = call(folder.path(), &["check", "absent.toml"]).words();
    assert!(words.contains("toy: 3 cases were skipped and not judged"), "{words}");
    assert_eq!(call(folder.path(), &["run", "absent.toml"]).code, 0);
}

#[test]
fn a_new_adapter_runs_as_it_is_and_is_of_second_order() {
    for (language, program) in [("python", "python3"), ("shell", "awk")] {
        if Command::new(program).arg("--version").output().is_err() {
            skip(&format!("there is no {program}"));
            continue;
        }
        let folder = TempDir::new().expect("a folder");
        let told = call(folder.path(), &["new-solver", "mine", "--language", language]);
        assert_eq!(told.code, 0, "{}", told.err);
        let told = call(folder.path(), &["check", "mine/mine.toml"]);
        assert!(told.out.contains("2 of 2 expectations met"), "{language}: {}{}", told.out, told.err);
        assert!(!folder.path().join("out").exists(), "a check keeps nothing");
        let again = call(folder.path(), &["new-solver", "mine", "--language", language]);
        assert!(again.code == 2 && again.err.contains("already exists"), "{}", again.err);
    }
    let folder = TempDir::new().expect("a folder");
    assert_eq!(call(folder.path(), &["new-solver", "gimp", "--language", "shell"]).code, 0);
    assert_eq!(call(folder.path(), &["new-solver", "profiles"]).code, 2);
    assert_eq!(call(folder.path(), &["new", "a", "b"]).code, 2);
    assert!(call(folder.path(), &["new", "solver"]).err.contains("solver.toml"), "a study may be called so");
}

#[test]
fn the_plan_prints_case_files_that_a_solver_can_read() {
    let Some(folder) = folder_with_toy() else { return };
    write_study(folder.path(), "beside.toml", &solver("toy", "right", ""), BESIDE);
    let plan = call(folder.path(), &["plan", "beside.toml"]);
    assert!(plan.out.contains(",toy cells=40,"), "{}", plan.out);
    let told = call(folder.path(), &["plan", "beside.toml", "--format", "json", "--case-files", "cases"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let all: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    let all = all.as_array().expect("a list");
    assert_eq!(all.len(), 6);
    let toy = all.iter().find(|case| case["label"] == "toy cells=10").expect("the toy's");
    let file = folder.path().join("cases").join(toy["case"].as_str().expect("a hash")).join("case.json");
    let written: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&file).expect("a file")).expect("JSON");
    assert_eq!(&written, toy);
    assert!((toy["times"][1].as_f64().expect("seconds") - 0.5 * 81.75).abs() < 1e-9);
    // The file is what the solver is given.
    fs::create_dir(folder.path().join("by-hand")).expect("a folder");
    let run = Command::new(folder.path().join("toy"))
        .args([file.as_os_str(), folder.path().join("by-hand").as_os_str(), "right".as_ref()])
        .status();
    assert!(run.expect("it starts").success() && folder.path().join("by-hand/result.csv").is_file());
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_page_on_attaching_has_every_status_placeholder_and_key() {
    let page = fs::read_to_string(root().join("docs/attach.md")).expect("the page");
    for (_, status, _) in ENDS {
        assert!(page.contains(&format!("- `{status}`: ")), "{status}");
    }
    assert!(page.contains("- `not-startable`: "));
    let schema = |document: &str| -> serde_json::Value {
        let told = call(&root(), &["schema", document]);
        serde_json::from_str(&told.out).expect("JSON")
    };
    let names = |value: &serde_json::Value| -> Vec<String> {
        value.as_object().expect("an object").keys().cloned().collect()
    };
    for key in names(&schema("study")["properties"]["solver"]["items"]["properties"]) {
        assert!(page.contains(&format!("- `{key}`: ")), "no line on the key {key}");
    }
    // The case file that the page shows has the keys of the schema, at its top and in each part.
    let shown = page.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let shown: serde_json::Value = serde_json::from_str(shown).expect("JSON");
    let case = schema("case");
    assert_eq!(names(&shown), names(&case["properties"]));
    for part in ["column", "derived"] {
        assert_eq!(names(&shown[part]), names(&case["properties"][part]["properties"]), "{part}");
    }
    // A study with the solver that the page shows is sound, beside the files of the shipped example.
    let block = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("ogs_column.py"), "").expect("written");
    write_study(
        folder.path(),
        "page.toml",
        block,
        "[[sweep]]\nmethod = [\"GC-SRI-patch\", \"ogs\"]\ncells = [10]\n",
    );
    let told = call(folder.path(), &["plan", "page.toml"]);
    assert!(told.code == 0 && told.out.contains(",ogs cells=10,"), "{}{}", told.out, told.err);
}

#[test]
fn the_shipped_adapters_are_sound_and_fail_nothing_where_their_packages_are_missing() {
    let adapters = root().join("examples/adapters");
    let mut planned = Vec::new();
    for folder in fs::read_dir(&adapters).expect("the adapters").flatten().filter(|one| one.path().is_dir()) {
        for study in fs::read_dir(folder.path()).expect("a folder").flatten() {
            let path = study.path();
            // A mapping beside a study has no scene.
            if !fs::read_to_string(&path).is_ok_and(|text| text.contains("\nscene = ")) {
                continue;
            }
            let told = call(&root(), &["plan", path.to_str().expect("UTF-8")]);
            assert_eq!(told.code, 0, "{}: {}", path.display(), told.err);
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            planned.push(name.clone());
            // They meet their expectations alone: no golden values are kept of them yet.
            if ["dealii", "dolfinx", "freefem", "geotaichi", "mfem"].contains(&&*name) {
                continue;
            }
            // Its golden values are of the cases that it plans: a renamed method or mesh shows here.
            let golden = adapters.join("golden").join(&name).with_extension("csv");
            let golden = fs::read_to_string(&golden).unwrap_or_else(|_| panic!("no {}", golden.display()));
            for line in told.out.lines().skip(1) {
                let label = line.split(',').nth(3).expect("a label");
                assert!(
                    golden.lines().any(|one| one.starts_with(label)),
                    "{name}: no golden values of {label}"
                );
            }
        }
    }
    planned.sort();
    assert_eq!(
        planned,
        [
            "dealii",
            "dolfinx",
            "freefem",
            "geotaichi",
            "kratos",
            "layers",
            "mfem",
            "ngsolve",
            "opengeosys",
            "opensees",
            "scikit-fem"
        ]
    );
    // A Python without site packages has none of them.
    if Command::new("python3").arg("--version").output().is_err() {
        skip("there is no python3");
        return;
    }
    let folder = TempDir::new().expect("a folder");
    let own = folder.path().join("scikit-fem");
    fs::create_dir(&own).expect("a folder");
    fs::copy(adapters.join("nodes.toml"), folder.path().join("nodes.toml")).expect("copied");
    fs::copy(adapters.join("scikit-fem/adapter.py"), own.join("adapter.py")).expect("copied");
    let text = fs::read_to_string(adapters.join("scikit-fem/scikit-fem.toml")).expect("a study");
    let text = text.replace("\"python3\", \"adapter", "\"python3\", \"-I\", \"-S\", \"adapter");
    fs::write(own.join("scikit-fem.toml"), text).expect("a study");
    let told = call(&own, &["check", "scikit-fem.toml"]);
    let said = told.words();
    assert!(said.contains("scikit-fem: 3 cases were skipped") && told.code == 5, "{said}");
}
