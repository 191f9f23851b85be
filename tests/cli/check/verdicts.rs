//! `check`, `accept` and `report` through the program: exit codes, what is named and what is not,
//! what is written and what is left alone.

use crate::program::{Told, assert_words, call_with, folder_with};
use oedometer::{
    GoldenFile, GoldenKey, Measure, Provenance, Record, RunOptions, Study, StudySource, Tier, run_study,
};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Three levels that take a fraction of a second, with an expectation that is met.
const STUDY: &str = r#"title = "A short study"
scene = "terzaghi"
integrator.drag = "implicit"

[output]
time_factors = [0.1, 0.2]

[[sweep]]
method = ["GIMP-SRI"]
cells = [3, 6, 12]

[[expect]]
method = "GIMP-SRI"
time_factor = 0.2
order = { value = 1.0, minus = 0.2, plus = 0.2 }
at = { cells = 6, below = 0.1 }
"#;

/// The value that the tests disturb.
const VALUE: &str =
    "GIMP-SRI explicit cells=6 points=2 stable=0.8 (implicit drag) | pressure points terzaghi T_v=0.2";

/// A folder with a study and its golden values.
struct Place(TempDir);

impl Place {
    fn with(study: &str) -> Self {
        Self(folder_with(study))
    }

    /// The same with golden values of its records, changed as a test wants.
    fn golden(study: &str, change: impl FnOnce(&mut GoldenFile)) -> Self {
        let place = Self::with(study);
        let mut golden = GoldenFile::of("short", &records(study), "for a test");
        change(&mut golden);
        golden.write(&place.path().join("golden")).expect("written");
        place
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn call(&self, variables: &[(&str, &str)], arguments: &[&str]) -> Told {
        call_with(self.path(), variables, arguments)
    }

    fn check(&self, options: &[&str]) -> Told {
        self.call(&[], &[&["check", "short.toml"], options].concat())
    }
}

fn records(study: &str) -> Vec<Record> {
    let source = StudySource { name: "short.toml".to_owned(), text: study.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    let options = RunOptions::whole(Tier::Ci, 1);
    run_study(&study, &options, None, &|_| {}).records
}

/// A golden value ten times its tolerance away, towards a larger error or a smaller one.
fn disturb(golden: &mut GoldenFile, sign: f64) {
    let key = key_of_value(golden);
    let tolerance = golden.tolerance(&key, golden.values[&key].abs());
    *golden.values.get_mut(&key).expect("the value is measured") += sign * 10.0 * tolerance;
}

/// The key of the value that the tests disturb.
fn key_of_value(golden: &GoldenFile) -> GoldenKey {
    golden.values.keys().find(|key| key.to_string() == VALUE).expect("the value is measured").clone()
}

/// Kinds of golden values that differ, each with what happened on one line.
fn differing(told: &Told) -> Vec<String> {
    let is_list = |block: &&str| block.starts_with("golden values: ");
    let list = told.out.split("\n\n").find(is_list).unwrap_or_default();
    let mut items: Vec<String> = Vec::new();
    for line in list.lines() {
        match items.last_mut() {
            Some(item) if line.starts_with("    ") => {
                item.push(' ');
                item.push_str(line.trim());
            }
            _ => items.push(line.trim().to_owned()),
        }
    }
    items
}

#[test]
fn a_study_with_its_golden_values_passes_and_nothing_is_written() {
    let place = Place::golden(STUDY, |_| {});
    let told = place.check(&[]);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    assert!(told.out.starts_with("✓ short: 1 of 1 expectations met, "), "{}", told.out);
    assert!(!told.out.contains('\x1b'), "no colours but on a terminal");
    let mut entries: Vec<_> = fs::read_dir(place.path())
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    entries.sort();
    assert_eq!(entries, ["golden", "short.toml"]);
}

#[test]
fn one_disturbed_value_is_named_with_its_place_and_nothing_else() {
    // The golden value is smaller: the present one is worse.
    let told = Place::golden(STUDY, |golden| disturb(golden, -1.0)).check(&[]);
    assert_eq!(told.code, 1, "{}", told.out);
    let rows = differing(&told);
    assert_eq!(rows.len(), 1, "{}", told.out);
    assert!(rows[0].contains(VALUE) && rows[0].contains("moved"), "{}", rows[0]);
    assert!(told.out.contains("1 of 1 expectations met"), "the expectation is still met");
}

#[test]
fn a_better_value_is_a_stale_golden_and_no_failure() {
    let told = Place::golden(STUDY, |golden| disturb(golden, 1.0)).check(&[]);
    assert_eq!(told.code, 5, "{}", told.out);
    let rows = differing(&told);
    assert_eq!(rows.len(), 1);
    assert!(rows[0].contains("1 value improved: the golden values are stale"), "{}", rows[0]);
}

#[test]
fn a_trade_of_cost_for_accuracy_is_stale_and_a_dearer_run_fails() {
    let steps = |golden: &mut GoldenFile, factor: f64| {
        let mut of_case = golden.values.iter_mut().filter(|(key, _)| key.case.contains("cells=6"));
        *of_case.find(|(key, _)| key.measure == Measure::Steps).expect("steps").1 *= factor;
    };
    let traded = Place::golden(STUDY, |golden| {
        steps(golden, 2.0);
        disturb(golden, -1.0);
    });
    let told = traded.check(&[]);
    assert_eq!(told.code, 5, "{}", told.out);
    assert!(
        differing(&told).iter().any(|row| row.contains("1 value fell where others of their case rose")),
        "{}",
        told.out
    );
    assert_words("accuracy_and_cost", &told.out);
    let dearer = Place::golden(STUDY, |golden| steps(golden, 0.5));
    let told = dearer.check(&[]);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(differing(&told)[0].contains("1 value moved") && told.out.contains("| steps"), "{}", told.out);
}

#[test]
fn missing_extra_and_renamed_values_and_a_missing_file_are_no_pass() {
    assert_eq!(Place::with(STUDY).check(&[]).code, 5, "no golden file");
    let fewer = Place::golden(STUDY, |golden| {
        golden.values.remove(&key_of_value(golden)).expect("it is measured");
    });
    let told = fewer.check(&[]);
    assert_eq!((told.code, differing(&told).len()), (5, 1), "{}", told.out);
    assert!(told.words().contains("is not in the golden file"), "{}", told.out);
    let renamed = Place::golden(STUDY, |golden| {
        let key = key_of_value(golden);
        let value = golden.values.remove(&key).expect("it is measured");
        golden.values.insert(GoldenKey { case: format!("{}x", key.case).into(), ..key }, value);
    });
    let told = renamed.check(&[]);
    assert_eq!((told.code, differing(&told).len()), (5, 2), "{}", told.out);
    let spoilt = Place::with(STUDY);
    fs::create_dir(spoilt.path().join("golden")).expect("a folder");
    fs::write(spoilt.path().join("golden/short.csv"), "# schema = 2\n# study ").expect("a file");
    let told = spoilt.check(&[]);
    assert_eq!(told.code, 5);
    assert!(told.words().contains("cannot be read"), "{}", told.out);
}

#[test]
fn a_golden_file_that_allows_anything_is_refused_with_a_sentence() {
    let place = Place::golden(STUDY, |_| {});
    let path = place.path().join("golden/short.csv");
    let sound = fs::read_to_string(&path).expect("a golden file");
    for (from, to, told) in [
        ("# reason: for a test", "# reason:", "its `reason` is empty"),
        ("case,hash,T_v,steps", "case,hash,T_v,point updates", "`point updates` is no measure"),
        ("cells=6 points=2", "cells=3 points=2", "occurs twice for this case and time factor"),
    ] {
        assert!(sound.contains(from), "{sound}");
        fs::write(&path, sound.replace(from, to)).expect("written");
        let found = place.check(&[]);
        assert_eq!(found.code, 5, "{}", found.out);
        assert!(found.words().contains(told), "{}", found.out);
    }
}

#[test]
fn what_moved_is_told_by_kind_and_the_worst_first() {
    let place = Place::golden(STUDY, |golden| {
        for (key, value) in &mut golden.values {
            let name = key.to_string();
            let is = |cells: &str, end: &str| name.contains(cells) && name.ends_with(end);
            *value *= match () {
                () if name == VALUE => 0.5,
                () if is("cells=6", "pressure points terzaghi T_v=0.1") => 0.9,
                () if is("cells=6", "pressure nodes terzaghi T_v=0.1") => 0.95,
                () if is("cells=6", "surface terzaghi T_v=0.1") => 1.5,
                () if is("cells=12", "surface terzaghi T_v=0.1") => 1.01,
                () if is("cells=12", "surface terzaghi T_v=0.2") => 1.02,
                () => 1.0,
            };
        }
    });
    let told = place.check(&[]);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(told.out.lines().all(|line| line.chars().count() <= 80 || line.starts_with("next: ")));
    let rows = differing(&told);
    assert!(rows[0].contains(&format!(": {VALUE}, ")), "{rows:?}");
    let words = told.words();
    assert!(words.contains("all with cells=6, all of pressure, terzaghi"), "{words}");
    assert!(words.contains(&format!("next: oedometer explain \"{VALUE}\" short.toml")), "{words}");
    // Its settlement fell while its pressure grew: that is nothing better. That of the finer mesh is.
    assert!(words.contains("1 value fell where others of their case rose"), "{words}");
    assert!(words.contains("improved: the golden values are stale, in 1 case, all with cells=12"), "{words}");
    // Every other way out leads with the same value.
    let summary = place.check(&["--format", "markdown", "--junit", "junit.xml", "--annotate"]);
    let first = summary.out.lines().find(|line| line.contains("T_v=")).expect("a value");
    assert!(first.replace('\\', "").contains(&format!(": {VALUE}, ")), "{first}");
    let junit = fs::read_to_string(place.path().join("junit.xml")).expect("a report");
    let message = junit.split("<failure message=\"").nth(1).expect("a failure").replace("&apos;", "'");
    assert!(message.split("T_v=").next().is_some_and(|first| first.contains("cells=6")), "{message}");
    assert!(message.contains(&format!(": {VALUE}, ")), "{message}");
    let annotation = summary.err.lines().find(|line| line.starts_with("::error ")).expect("an annotation");
    assert!(annotation.contains(VALUE), "{annotation}");
}

#[test]
fn variables_of_a_ci_that_are_empty_or_say_off_are_none() {
    let place = Place::golden(STUDY, |golden| disturb(golden, -1.0));
    let annotated = |value: &str| {
        let variables = [("GITHUB_ACTIONS", value), ("GITHUB_STEP_SUMMARY", "")];
        let told = place.call(&variables, &["check", "short.toml"]);
        assert_eq!(told.code, 1, "GITHUB_ACTIONS={value}: {}{}", told.out, told.err);
        told.err.contains("::error ")
    };
    assert!(annotated("true") && annotated("1"));
    assert!(!annotated("") && !annotated("false") && !annotated("0"));
}

#[test]
fn a_summary_that_cannot_be_written_hides_no_verdict() {
    let options = ["--summary", "no/such/folder/summary.md", "--junit", "short.toml/junit.xml"];
    for (place, code) in [
        (Place::golden(STUDY, |_| {}), 3),
        (Place::golden(STUDY, |golden| disturb(golden, -1.0)), 1),
        (Place::golden(STUDY, |golden| disturb(golden, 1.0)), 5),
    ] {
        let told = place.check(&options);
        assert_eq!(told.code, code, "{}{}", told.out, told.err);
        assert!(told.out.contains("short: 1 of 1 expectations met"), "{}", told.out);
        assert!(told.err.contains("error: cannot write no/such/folder/summary.md: "), "{}", told.err);
        assert!(told.err.contains("error: cannot write short.toml/junit.xml: "), "{}", told.err);
    }
}

#[test]
fn an_expectation_that_is_not_met_fails_everywhere_it_is_told() {
    let study = STUDY.replace("order = { value = 1.0", "order = { value = 2.0");
    let place = Place::golden(&study, |_| {});
    let summary = place.path().join("summary.md");
    fs::write(&summary, "before\n").expect("a file");
    let variables = [("GITHUB_ACTIONS", "true"), ("GITHUB_STEP_SUMMARY", summary.to_str().expect("a path"))];
    let told = place.call(&variables, &["check", "short.toml", "--junit", "junit.xml"]);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(told.out.contains("0 of 1 expectations met"), "{}", told.out);
    let annotation = told.err.lines().find(|line| line.starts_with("::error ")).expect("an annotation");
    assert!(annotation.starts_with("::error file=short.toml,line=12,title=short%3A "), "{annotation}");
    let summary = fs::read_to_string(summary).expect("a summary");
    assert!(summary.starts_with("before\n## oedometer check\n"), "appended: {summary}");
    let junit = fs::read_to_string(place.path().join("junit.xml")).expect("a report");
    assert!(junit.contains("name=\"short/GIMP-SRI, 2 points per cell"), "{junit}");
    assert!(junit.contains("/order\"") && junit.contains("<failure"), "{junit}");
    let names: Vec<&str> =
        junit.split("<testcase name=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut unique = names.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), names.len(), "names are unique: {names:?}");
}

#[test]
fn an_oscillation_is_measured_where_a_study_bounds_it() {
    let asked = |bound: &str| {
        let study = STUDY.replace("at = {", &format!("oscillation = {{ below = {bound} }}\nat = {{"));
        Place::golden(&study, |_| {}).check(&["--format", "json"])
    };
    let told = asked("1e-6");
    assert_eq!(told.code, 0, "constant recovery makes a staircase and no oscillation: {}", told.out);
    let json: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    let checks = json[0]["judgements"][0]["verdict"]["checks"].as_array().expect("checks");
    let found = checks.iter().find(|check| check["name"] == "oscillation").expect("it is judged");
    assert_eq!(found["measured"], 0.0, "{found}");
    assert_eq!(asked("-1.0").code, 1, "and a bound that cannot be met is not");
}

#[test]
fn the_oscillation_of_a_plane_is_measured_along_its_rows_and_columns() {
    let study = |method: &str, bound: &str| {
        let text = format!(
            "title = \"A layer\"\nscene = \"cosine-layer\"\noutput.time_factors = [0]\n\n[[sweep]]\nmethod = [\"{method}\"]\n\
             integrator = [\"implicit\"]\ncells = [2, 4, 8]\ntime_step = [{{ seconds = 1.0 }}]\n\n[[expect]]\n\
             time_factor = 0\noscillation = {{ below = {bound} }}\n"
        );
        Place::golden(&text, |_| {}).check(&["--format", "json"])
    };
    let index = |told: &Told| {
        let json: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
        let checks = json[0]["judgements"][0]["verdict"]["checks"].as_array().expect("checks").clone();
        checks.iter().find(|check| check["name"] == "oscillation").expect("it is judged")["measured"].as_f64()
    };
    let (patched, checkerboard) = (study("GIMP-SRI-patch", "0.01"), study("GIMP", "0.01"));
    assert_eq!((patched.code, checkerboard.code), (0, 1), "{}{}", patched.out, checkerboard.out);
    assert!(index(&patched).expect("a number").abs() < 0.01);
    assert!(index(&checkerboard).expect("a number") > 10.0);
}

/// A settlement that is held against nothing but itself.
const VALUE_STUDY: &str = r#"title = "A value"
scene = "terzaghi"
output.time_factors = [0.1]

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 8, 16, 32]
time_step = [{ seconds = 0.1 }]

[[expect]]
quantity = "settlement"
reference = "none"
time_factor = 0.1
order = { value = 2.0 }
uncertainty = { below = 3e-3 }
"#;

#[test]
fn a_value_without_a_reference_is_judged_by_what_refinement_tells() {
    let told = Place::golden(VALUE_STUDY, |_| {}).check(&[]);
    assert_eq!(told.code, 0, "{}", told.out);
    assert_words("uncertainties", &told.out);
    let strict = VALUE_STUDY.replace("below = 3e-3", "below = 2e-5");
    let told = Place::golden(&strict, |_| {}).check(&[]);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(told.words().contains("by least squares not below 2e-5"), "{}", told.out);
    // Three levels have an index, two have nothing to go by and are refused before anything runs.
    let three = VALUE_STUDY.replace("[4, 8, 16, 32]", "[8, 16, 32]").replace("order = { value = 2.0 }\n", "");
    let told = Place::golden(&three, |_| {}).check(&["--format", "json"]);
    assert_eq!(told.code, 0, "{}", told.out);
    assert!(told.out.contains("grid-convergence-index"), "{}", told.out);
    let two = Place::with(&three.replace("[8, 16, 32]", "[16, 32]"));
    for command in ["plan", "check"] {
        let told = two.call(&[], &[command, "short.toml"]);
        assert_eq!(told.code, 2, "{}", told.out);
        assert!(told.err.contains("needs 3 levels: its cases have 2"), "{}", told.err);
    }
}

#[test]
fn a_known_failure_must_fail() {
    let known = STUDY
        .replace("order = { value = 1.0", "order = { value = 2.0")
        .replace("at = { cells = 6, below = 0.1 }", "xfail = { reason = \"constant recovery\" }");
    assert_eq!(Place::golden(&known, |_| {}).check(&[]).code, 0);
    let met = STUDY.replace("at = { cells = 6, below = 0.1 }", "xfail = { reason = \"constant recovery\" }");
    let told = Place::golden(&met, |_| {}).check(&[]);
    assert_eq!(told.code, 1);
    assert!(told.words().contains("passes although it is marked as a known failure"), "{}", told.out);
}

#[test]
fn a_case_that_fails_is_exit_code_three_and_an_empty_tier_four() {
    let unstable = STUDY.replace("cells = [3, 6, 12]\n", "cells = [3]\ntime_step = [{ stable = 1.3 }]\n");
    let unstable = unstable.split("[[expect]]").next().expect("a head").to_owned();
    let told = Place::golden(&unstable, |_| {}).check(&[]);
    assert_eq!(told.code, 3, "{}", told.out);
    assert!(
        told.words().contains("1 case failed") && told.words().contains("unstable at step"),
        "{}",
        told.out
    );
    let full = STUDY.replace("[[sweep]]\n", "[[sweep]]\ntier = \"full\"\n");
    assert_eq!(Place::with(&full).check(&[]).code, 4);
}

#[test]
fn every_format_has_the_verdicts() {
    let place = Place::golden(STUDY, |golden| disturb(golden, -1.0));
    let json: serde_json::Value =
        serde_json::from_str(&place.check(&["--format", "json"]).out).expect("JSON");
    assert_eq!(json[0]["end"], "failed");
    assert_eq!(json[0]["differences"][0]["name"], VALUE);
    assert_eq!(json[0]["judgements"][0]["verdict"]["pass"], true);
    assert_eq!(json[0]["accuracy_and_cost"][0]["change"], "dominated");
    let told = place.check(&["--format", "csv"]);
    let mut rows = csv::Reader::from_reader(told.out.as_bytes());
    assert_eq!(rows.records().count(), 2, "{}", told.out);
    assert!(place.check(&["--format", "markdown"]).out.starts_with("## oedometer check\n"));
}

#[test]
fn golden_values_are_taken_with_a_reason_from_a_clean_tree_and_never_in_ci() {
    let place = Place::with(STUDY);
    let accept = ["accept", "short.toml", "--reason", "a test"];
    let told = place.call(&[("CI", "true")], &accept);
    assert_eq!(told.code, 2);
    assert!(told.err.contains("not accepted in CI"), "{}", told.err);
    let told = place.call(&[], &["accept", "short.toml", "--reason", "  "]);
    assert_eq!(told.code, 2);
    assert!(told.err.contains("need a reason"), "{}", told.err);
    assert_eq!(place.call(&[], &["accept", "short.toml"]).code, 2, "no reason at all");
    assert!(!place.path().join("golden").exists(), "nothing is written by a refusal");
    let told = place.call(&[], &accept);
    if Provenance::of_this_program().dirty {
        assert_eq!(told.code, 2);
        assert!(told.err.contains("uncommitted changes"), "{}", told.err);
        assert!(!place.path().join("golden").exists());
    } else {
        assert_eq!(told.code, 0, "{}", told.err);
        let golden = GoldenFile::read(&place.path().join("golden"), "short").expect("golden values");
        assert_eq!(golden.reason, "a test");
        assert_eq!(place.check(&[]).code, 0);
    }
}

#[test]
fn a_report_shows_verdicts_and_does_not_gate_on_them() {
    let study = STUDY.replace("order = { value = 1.0", "order = { value = 2.0");
    let place = Place::with(&study);
    let told = place.call(&[], &["report", "short.toml", "--out", "made"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let read = |file: &str| fs::read_to_string(place.path().join("made").join(file)).expect(file);
    // The page of one study is the report.
    let (html, markdown) = (read("index.html"), read("README.md"));
    for page in [&html, &markdown] {
        assert!(page.contains("GIMP-SRI") && page.contains("0 of 1 expectations are met"), "{page}");
        assert!(!page.contains("What does accuracy cost?"), "what was not studied is not asked");
        assert!(page.contains("oedometer report short.toml --out made"), "how it was made stands at the end");
        assert!(page.contains("oedometer run short.toml"), "the path that was given");
        assert!(!page.contains(place.path().to_str().expect("a path")), "no absolute path");
    }
    assert!(!place.path().join("made/studies").exists());
    let failing = html.split("<nav aria-label=\"Contents\"").next().expect("the head of the page");
    assert!(
        failing.contains("callout fail") && failing.contains("pressure"),
        "the red box says why: {failing}"
    );
    // Of several studies each has its page, behind a front page and a list.
    fs::write(place.path().join("other.toml"), STUDY).expect("a study");
    let told = place.call(&[], &["report", "short.toml", "other.toml", "--out", "both"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let of_both = |file: &str| fs::read_to_string(place.path().join("both").join(file)).expect(file);
    let (front, list) = (of_both("index.html"), of_both("studies/index.html"));
    assert!(front.contains("Not as expected:") && list.contains("short.html"), "{front}");
    // Every file that a page leads to is there.
    for (folder, page) in [
        ("made/", &html),
        ("both/", &front),
        ("both/studies/", &list),
        ("both/studies/", &of_both("studies/short.html")),
    ] {
        let targets = page.split("<a href=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for target in targets.filter(|target| !target.starts_with('#')) {
            let file = target.split('#').next().unwrap_or_default();
            assert!(place.path().join(folder).join(file).is_file(), "{folder}{target}");
        }
    }
    assert!(place.path().join("out/short/records").is_dir(), "records are kept");
    let again = place.call(&[], &["report", "short.toml", "--out", "made"]);
    assert!(again.err.contains("3 cases (3 reused"), "{}", again.err);
    let kept = place.call(&[], &["report", "short.toml", "--out", "other", "--from-records"]);
    assert_eq!(kept.code, 0, "{}", kept.err);
    let none = place.call(&[], &["report", "short.toml", "--from-records", "--records", "nowhere"]);
    assert!(none.code == 4 && none.err.contains("there are no records"), "{}", none.err);
}
