//! Results that are there already, in a study of their own: verdicts, golden values and every report of `check` on the
//! real files of another program, and on the same files with a fault of one per cent.

use crate::program::{Told, call, call_with};
use oedometer::api::exact::exact;
use oedometer::{GoldenFile, RunOptions, Study, StudySource, Tier, run_study};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Times of the files of Kratos: the step in the name, and `T_v`.
const STEPS: [(usize, f64); 5] = [(50, 0.05), (100, 0.1), (200, 0.2), (500, 0.5), (1000, 1.0)];

const STUDY: &str = r#"title = "Kratos on ten cells"
scene = "terzaghi"
output = { time_factors = [0.05, 0.1, 0.2, 0.5, 1.0], references = ["terzaghi"] }

[[result]]
name = "kratos"
files = ["run-{cells}/*.vtk"]
cells = [10]
preset = "kratos"
time_step = 0.08175

[[expect_case]]
method = "kratos"
quantity = "pressure"
sample = "nodes"
time_factor = 0.5
error = { below = 2e-3, above = 5e-4 }

[[expect_case]]
method = "kratos"
status = "ok"
"#;

fn foreign() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign")
}

fn file_of(step: usize) -> String {
    format!("porous_computational_model_part_0_{step}.vtk")
}

/// Exact pressure at a height and time factor.
fn pressure(time_factor: f64, height: f64) -> f64 {
    exact("terzaghi", &[time_factor], &[1.0 - height], &[], &[]).expect("inside its range").pressure[0]
}

/// A file of Kratos whose soil is more permeable by a share: everything happens so much earlier.
fn with_permeability(text: &str, time_factor: f64, share: f64) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let begins =
        |word: &str| lines.iter().position(|line| line.trim_start().starts_with(word)).expect("a section");
    let points = begins("POINTS");
    let field = begins("WATER_PRESSURE");
    let count: usize = lines[points].split_whitespace().nth(1).expect("a count").parse().expect("a number");
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
    };
    let mut changed: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
    for place in 0..count {
        let height = numbers(lines[points + 1 + place])[1];
        let line = &mut changed[field + 1 + place];
        let value = numbers(line)[0];
        // Only the corners hold a pressure that counts; suction is positive.
        let earlier = pressure((1.0 + share) * time_factor, height) - pressure(time_factor, height);
        *line = format!("{:e}", value - earlier);
    }
    changed.join("\n") + "\n"
}

/// What a page prints under a mark, on one line.
fn printed(mark: &str) -> String {
    let page = fs::read_to_string(foreign().join("../../docs/gate.md")).expect("a page");
    let (_, rest) = page.split_once(&format!("<!-- printed: {mark} -->")).expect("the mark");
    let block = rest.split("```").nth(1).expect("a block");
    block.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A folder with the study, and the files of a soil more permeable by a share.
fn folder(share: f64) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("run-10")).expect("a folder");
    for (step, time_factor) in STEPS {
        let text = fs::read_to_string(foreign().join("kratos-vtk").join(file_of(step))).expect("a file");
        let text = if share == 0.0 { text } else { with_permeability(&text, time_factor, share) };
        fs::write(folder.path().join("run-10").join(file_of(step)), text).expect("a file");
    }
    fs::write(folder.path().join("kratos.toml"), STUDY).expect("a file");
    folder
}

/// Golden values of the sound files.
fn accept(sound: &Path) -> GoldenFile {
    let name = sound.join("kratos.toml").display().to_string();
    let study = Study::check(&StudySource { name, text: STUDY.to_owned() }).expect("a sound study");
    let report = run_study(&study, &RunOptions::whole(Tier::Ci, 1), None, &|_| {});
    GoldenFile::of("kratos", &report.records, "as the files are")
}

fn check(at: &Path, study: &str, options: &[&str]) -> Told {
    call(at, &[&["check", study], options].concat())
}

#[test]
fn a_permeability_that_is_off_by_one_per_cent_is_caught_with_quantity_time_and_place() {
    let (sound, faulty) = (folder(0.0), folder(0.01));
    let golden = accept(sound.path());
    for at in [&sound, &faulty] {
        golden.write(&at.path().join("golden")).expect("written");
    }
    let told = check(sound.path(), "kratos.toml", &[]);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    assert!(told.words().contains("2 of 2 expectations met"), "{}", told.out);
    let told = check(faulty.path(), "kratos.toml", &["--junit", "j.xml", "--summary", "s.md", "--annotate"]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    let of_file = |name: &str| fs::read_to_string(faulty.path().join(name)).expect("written");
    let (junit, summary) = (of_file("j.xml"), of_file("s.md"));
    for (where_told, text) in [
        ("terminal", told.words()),
        ("annotations", told.err.clone()),
        ("JUnit", junit),
        ("summary", summary),
    ] {
        for part in ["kratos cells=10", "pressure", "T_v = 0.5", "lies at ζ = ", "% of the squared error"] {
            let text = text.replace("%25", "%");
            assert!(text.contains(part), "{where_told} does not say `{part}`: {text}");
        }
    }
    assert!(told.words().contains(&printed("one per cent")), "{}", told.out);
    // A tenth of that is caught by the golden values alone.
    let slight = folder(0.001);
    golden.write(&slight.path().join("golden")).expect("written");
    let told = check(slight.path(), "kratos.toml", &[]);
    assert!(told.code == 1 && told.words().contains(" moved, in 1 case"), "{}", told.out);
}

#[test]
fn a_result_that_is_not_there_or_lacks_a_time_fails_its_case_and_says_what_to_do() {
    let folder = folder(0.0);
    let at = folder.path();
    accept(at).write(&at.join("golden")).expect("written");
    fs::remove_file(at.join("run-10").join(file_of(200))).expect("it was there");
    let told = check(at, "kratos.toml", &[]);
    assert!(told.code == 1 && told.words().contains("there is no state at T_v = 0.2"), "{}", told.out);
    for (step, _) in STEPS.into_iter().filter(|(step, _)| *step != 200) {
        fs::remove_file(at.join("run-10").join(file_of(step))).expect("it was there");
    }
    let told = check(at, "kratos.toml", &[]);
    assert!(told.words().contains("there is no file run-10/*.vtk: the solver did not run"), "{}", told.out);
    // A mesh that is none of the study's.
    let other = self::folder(0.0);
    let mut from = "run-10".to_owned();
    for (cells, wanted) in [
        (20, "10 cells over the height, but the case asks for 20"),
        (5, "10 cells over the height, but the case asks for 5"),
    ] {
        let to = format!("run-{cells}");
        fs::rename(other.path().join(&from), other.path().join(&to)).expect("moved");
        from = to;
        let study = STUDY.replace("cells = [10]", &format!("cells = [{cells}]"));
        fs::write(other.path().join("kratos.toml"), study).expect("a file");
        let told = check(other.path(), "kratos.toml", &[]);
        assert!(told.code == 1 && told.words().contains(wanted), "{}", told.out);
        assert!(!told.words().contains(&*other.path().to_string_lossy()), "no absolute path: {}", told.out);
    }
}

#[test]
fn a_given_result_is_explained_reported_and_planned_like_a_case() {
    let folder = folder(0.0);
    let at = folder.path();
    let told = call(at, &["explain", "kratos cells=10", "kratos.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.out.contains("pressure") && told.out.contains("nodes"), "{}", told.out);
    let told = call(at, &["plan", "kratos.toml"]);
    assert!(told.code == 0 && told.out.contains("kratos cells=10"), "{}{}", told.out, told.err);
    let told = call(at, &["run", "kratos.toml", "--out", "out"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let told = call(at, &["run", "kratos.toml", "--out", "out", "--resume"]);
    assert!(told.code == 0, "{}", told.err);
    let told = call(at, &["report", "kratos.toml", "--records", "out", "--out", "page"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let page = fs::read_to_string(at.join("page/index.html")).expect("a page");
    assert!(page.contains("2 of 2 expectations are met"), "{}", &page[..500]);
    // Nobody said which units the mapping has: a gate does not guess.
    fs::write(at.join("map.toml"), "columns = { p = \"WATER_PRESSURE\", y = \"coordinates[1]\" }\n")
        .expect("a file");
    fs::write(at.join("kratos.toml"), STUDY.replace("preset = \"kratos\"", "mapping = \"map.toml\""))
        .expect("a file");
    let told = check(at, "kratos.toml", &[]);
    assert!(told.code == 2 && told.err.contains("does not declare the unit of stresses"), "{}", told.err);
}

/// The command that the page gives for CI.
fn recipe() -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/gate.md");
    let page = fs::read_to_string(page).expect("a page");
    let (_, rest) = page.split_once("In CI run ").expect("the recipe");
    let command = rest.split('`').find(|code| code.starts_with("oedometer ")).expect("a command");
    command.to_owned()
}

#[test]
fn the_recipe_for_a_forge_runs_as_it_stands() {
    let command = recipe();
    let words: Vec<&str> = command.split_whitespace().skip(1).collect();
    for variable in ["GITHUB_ACTIONS", "CI"] {
        for (share, code) in [(0.0, 0), (0.01, 1)] {
            let folder = folder(share);
            let at = folder.path();
            fs::create_dir(at.join("verification")).expect("a folder");
            for name in ["kratos.toml", "run-10"] {
                fs::rename(at.join(name), at.join("verification").join(name)).expect("moved");
            }
            let sound = self::folder(0.0);
            accept(sound.path()).write(&at.join("verification/golden")).expect("written");
            let summary = at.join("summary.md").display().to_string();
            let given = [(variable, "true"), ("GITHUB_STEP_SUMMARY", &summary)];
            let told = call_with(at, &given, &words);
            let said = format!("{command}: {} {}{}", told.code, told.out, told.err);
            assert_eq!(told.code, code, "{variable}, {share}: {said}");
            assert!(at.join("oedometer.xml").is_file(), "{said}");
            if variable == "GITHUB_ACTIONS" && code == 1 {
                assert!(said.contains("::error ") && at.join("summary.md").is_file(), "{said}");
            }
        }
    }
}

/// The exact column of another soil, as a result on 20 and 40 cells and as what a solver leaves.
const OTHER_SOIL: &str = r#"title = "Another soil"
scene = "terzaghi"
output = { time_factors = [0.05, 0.2, 0.5], references = ["terzaghi"] }

[[result]]
name = "theirs"
files = ["column-{cells}.csv"]
cells = [20, 40]
mapping = "map.toml"

[[solver]]
name = "mine"
command = ["cp", "column-40.csv", "{out}"]
result = "{out}/column-40.csv"
mapping = "map.toml"

[[sweep]]
method = ["mine"]
cells = [40]
"#;

#[test]
fn what_seems_to_be_wrong_with_a_result_stands_in_the_check_and_in_the_report() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let mapping =
        "sample = \"points\"\n[units]\nstress = \"Pa\"\n[sign]\np = \"compression-positive\"\nu_y = \"up\"\n";
    fs::write(at.join("map.toml"), mapping).expect("a file");
    fs::write(at.join("soil.toml"), OTHER_SOIL).expect("a file");
    // The factor on the permeability is the factor of the time; mm of a displacement have none.
    for (permeability, factor, expected) in [
        (1.0, 1.0, None),
        (1.02, 1.0, Some("at 1.02 × the time: is k 1.02e-4 m/s for 1e-4, or are")),
        (1.0, 1e3, Some("your u_y is 1000 × the exact one: is it in mm where m is declared?")),
    ] {
        let mut text = "t,y,p,u_y\n".to_owned();
        let depths: Vec<f64> = (0..40).map(|point| (f64::from(point) + 0.5) / 40.0).collect();
        for time_factor in [0.05, 0.2, 0.5] {
            let fields = exact("terzaghi", &[permeability * time_factor], &depths, &[], &[]).expect("inside");
            let seconds = time_factor * 9810.0 / (1e-4 * 1.2e6);
            for (place, depth) in depths.iter().enumerate() {
                let (p, u) = (fields.pressure[place], factor * fields.displacement[place]);
                writeln!(text, "{seconds},{},{p},{u}", 1.0 - depth).expect("a line");
            }
        }
        for cells in [20, 40] {
            fs::write(at.join(format!("column-{cells}.csv")), &text).expect("a file");
        }
        let told = check(at, "soil.toml", &[]);
        let said = told.words();
        let Some(expected) = expected else {
            assert!(!said.contains("your "), "{said}");
            continue;
        };
        for case in ["theirs cells=40: ", "mine cells=40: "] {
            let is_told =
                ["your ", "each of your "].iter().any(|words| said.contains(&format!("{case}{words}")));
            assert!(is_told && said.contains(expected), "{case}{expected}: {said}");
        }
        assert!(!said.contains("theirs cells=20"), "the finest mesh says it: {said}");
        assert_eq!(call(at, &["report", "soil.toml", "--out", "pages"]).code, 0);
        let page = fs::read_to_string(at.join("pages/index.html")).expect("a page");
        let part =
            if factor == 1.0 { "is k 1.02e-4 m/s for 1e-4" } else { "is it in mm where m is declared?" };
        assert!(page.contains(part), "{part}");
    }
}
