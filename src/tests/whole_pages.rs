//! Whole pages, verdicts and figures of studies of every kind, from records whose numbers are all different: a wrong column, sign,
//! unit, word, order or choice of a run shows as a difference.

use crate::campaign::runner::records_of;
use crate::golden::{GoldenError, GoldenFile};
use crate::judge::study_check::StudyCheck;
use crate::judge::verdict::differing_repeats;
use crate::questions::study_findings::AllStudies;
use crate::record::{Record, WallSample};
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::tests::assert_snapshot;
use crate::{
    Answers, Making, ReportFindings, StudyResults, Tier, answer_page, figures, index_page, junit, measures,
};
use crate::{check_page, render_html, render_markdown, study_page};
use oedometer_soil::wording::short;
use regex_lite::Regex;
use std::fmt::Write as _;

/// A study by its name, and the text after its title.
type Text = (&'static str, &'static str);

const MESH: Text = (
    "mesh",
    r#"scene = "terzaghi"
summary = "Which order?"
column = { height = 2.5, load = 40.0 }
material = { youngs_modulus = 3.2e6, porosity = 0.37 }
timing.repeats = 3
output = { time_factors = [0.07, 0.3] }
[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 6, 11, 16]
points_per_cell = [2, 3]
[[expect]]
method = "MPM"
points_per_cell = 2
time_factor = 0.07
order = { value = 1.0, minus = 0.5, plus = 0.5 }
at = { cells = 6, below = 0.2 }
[[expect]]
method = "GC-SRI-patch"
time_factor = 0.3
order = { value = 3.0 }
at = { cells = 6, below = 1e-5 }
[[expect]]
method = "GC-SRI-patch"
quantity = "displacement"
norm = "linf"
sample = "nodes"
time_factor = 0.3
class = "asymptotic"
xfail = { reason = "another one is right", strict = false }
[[expect]]
method = "MPM"
points_per_cell = 3
quantity = "settlement"
reference = "none"
time_factor = 0.3
uncertainty = { below = 0.1 }
[[expect]]
method = "MPM"
points_per_cell = 3
time_factor = 0.07
spread = { cells = 6, below = 0.01 }
oscillation = { below = 0.01 }
floor = { above = 0.1 }
[[expect_case]]
status = "ok"
solid_drift_below = 1e-9
water_drift_below = 1e-30
[[expect_case]]
method = "MPM"
cells = 11
time_factor = 0.3
quantity = "settlement"
error = { below = 1e-6 }
"#,
);

const STEP: Text = (
    "step",
    r#"scene = "terzaghi"
output.time_factors = [0.1]
[[sweep]]
method = ["GIMP-SRI"]
integrator = ["implicit", "semi-implicit"]
cells = [5]
time_step = [{ seconds = 0.04 }, { seconds = 0.02 }, { seconds = 0.01 }, { seconds = 0.005 }]
[[expect]]
method = "GIMP-SRI"
integrator = "implicit"
axis = "time_step"
reference = "next-finer"
time_factor = 0.1
order = { value = 1.0 }
"#,
);

const MAP: Text = (
    "soils",
    r#"scene = "terzaghi"
timing.repeats = 2
output.time_factors = [0.1]
[[sweep]]
method = ["GIMP-SRI", "GC-SRI-patch"]
integrator = ["implicit", "semi-implicit"]
cells = [4, 8]
hydraulic_conductivity = [1e-5, 1e-3]
youngs_modulus = [1e6, 1e7]
"#,
);

const STIFF: Text = (
    "stiff-water",
    r#"scene = "terzaghi"
output = { time_factors = [0.1], references = ["terzaghi", "terzaghi-incompressible"] }
[[sweep]]
method = ["GIMP-SRI"]
integrator = ["implicit"]
cells = [8]
water_bulk_modulus = [1e7, 1e8, 1e9, 1e10]
[[expect]]
method = "GIMP-SRI"
axis = "water_bulk_modulus"
reference = "terzaghi-incompressible"
time_factor = 0.1
class = "floor-limited"
"#,
);

const STABILITY: Text = (
    "stability",
    r#"scene = "terzaghi"
task = "stability"
[[sweep]]
method = ["GIMP-SRI", "MPM"]
cells = [4]
porosity = [0.2, 0.3, 0.5]
[[expect_case]]
critical_step_within = 0.02
[[expect_case]]
critical_step_within = 1e-9
"#,
);

const LAYER: Text = (
    "layer",
    r#"scene = "cosine-layer"
layer = { length = 2.0, load = 30.0 }
output.time_factors = [0]
[[sweep]]
method = ["GIMP", "GIMP-SRI"]
integrator = ["implicit"]
cells = [2, 4, 8]
poissons_ratio = [0.3, 0.4999]
time_step = [{ seconds = 0.16 }]
[[expect]]
method = "GIMP"
poissons_ratio = 0.4999
time_factor = 0
class = "locked"
"#,
);

const FOOTING: Text = (
    "footing",
    r#"scene = "footing"
[[sweep]]
method = ["GIMP-SRI", "GIMP"]
integrator = ["implicit"]
cells = [2, 4]
time_step = [{ growth = 0.2 }]
"#,
);

const LARGE: Text = (
    "large-strain",
    r#"scene = "xie-leo"
column.strain = 0.2
output.time_factors = [0.1, 0.5]
[[sweep]]
method = ["GIMP-SRI-patch", "TL-GIMP-SRI-patch"]
integrator = ["implicit"]
cells = [4, 8, 16]
time_step = [{ growth = 0.1 }]
"#,
);

const SETS: Text = (
    "two-sets",
    r#"scene = "terzaghi"
material.hydraulic_conductivity = 1e-3
integrator.drag = "implicit"
output.time_factors = [0.01]
[[sweep]]
method = ["GIMP-SRI", "GIMP"]
sets = [1, 2]
cells = [4, 8]
time_step = [{ stable = 0.8 }]
[[expect_case]]
sets = 2
water_left_within = 1e-2
one_set_within = 1e-9
"#,
);

const FAILING: Text = (
    "failing",
    r#"scene = "terzaghi"
material.hydraulic_conductivity = 1e-3
output.time_factors = [0.01]
[[sweep]]
method = ["MPM"]
cells = [4, 8, 16]
time_step = [{ stable = 3.0 }, { stable = 0.9 }]
[[expect_case]]
status = "unstable"
"#,
);

const RACE: Text = (
    "race",
    r#"scene = "terzaghi"
output.time_factors = [0.1]
[[sweep]]
method = ["race"]
integrator = ["implicit"]
cells = [4, 8]
time_step = [{ growth = 0.1 }]
"#,
);

fn study((name, text): Text) -> Study {
    let text = format!("title = \"The {name}\"\n{text}");
    Study::check(&StudySource { name: format!("{name}.toml"), text }).expect("a sound study")
}

/// Records of a study with times that are another each, the middle one neither first nor last.
fn records((name, text): Text) -> Vec<Record> {
    let mut records = records_of(&format!("title = \"The {name}\"\n{text}"));
    for (number, record) in records.iter_mut().enumerate() {
        let seconds = 0.001 * ((37 * number) % 23 + 3) as f64 + 1e-4 * number as f64;
        let of_run = |factor: f64| WallSample {
            seconds: factor * seconds,
            alone: true,
            cpu_seconds: Some(0.9 * factor * seconds),
            ..WallSample::default()
        };
        record.wall = [1.5, 1.0, 1.125].map(of_run).to_vec();
    }
    records
}

/// A text with the digits that every machine has in common: numbers of round-off are one word, long ones are short.
fn without_round_off(text: &str) -> String {
    let tiny = Regex::new(r"-?\d(\.\d+)?(e-1[1-9]|e-[23]\d|·10⁻¹[¹²³⁴⁵⁶⁷⁸⁹]|·10⁻[²³][⁰¹²³⁴⁵⁶⁷⁸⁹])");
    let long = Regex::new(r"\d+\.\d{11,}(e-?\d+)?").expect("a pattern");
    let text = tiny.expect("a pattern").replace_all(text, "≈0").into_owned();
    let shorter =
        |found: &regex_lite::Captures| found[0].parse::<f64>().map_or_else(|_| String::new(), short);
    long.replace_all(&text, shorter).into_owned()
}

/// Words of a figure where they stand, and where its lines and marks lie.
fn figure_told(svg: &str) -> String {
    let tag = Regex::new(r"<(text|polyline|path|circle|polygon|rect)([^>]*)>([^<]*)").expect("a pattern");
    let number = Regex::new(r"\d+\.\d+").expect("a pattern");
    let mut lines = Vec::new();
    for found in tag.captures_iter(svg) {
        // The white rims of marks.
        if found[2].contains("fill=\"#FFFFFF\"") {
            continue;
        }
        let whole = number.replace_all(&found[2], |number: &regex_lite::Captures| {
            number[0].parse::<f64>().map_or_else(|_| String::new(), |number| format!("{number:.0}"))
        });
        let about: String =
            whole.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(160).collect();
        lines.push(format!("{} {about} {}", &found[1], found[3].trim()));
    }
    lines.join("\n")
}

fn page_told(results: &StudyResults<'_>) -> String {
    let page = study_page(&results.findings().expect("sound cases")).expect("a page");
    let mut text = render_markdown(&page).expect("Markdown");
    for (name, svg) in figures(&page).expect("figures") {
        writeln!(text, "\n### {name}\n{}", figure_told(&svg)).expect("memory");
    }
    without_round_off(&text)
}

#[test]
fn pages_of_studies_are_what_they_were() {
    for text in [MESH, STEP, MAP, STIFF, STABILITY, LAYER, FOOTING, LARGE, SETS, FAILING, RACE] {
        let (study, records) = (study(text), records(text));
        let results =
            StudyResults::new(&study, &records, Tier::Ci).from_file(format!("tables/{}.toml", text.0));
        assert_snapshot(&format!("page_{}", text.0.replace('-', "_")), &page_told(&results));
    }
}

#[test]
fn the_page_in_html_has_what_the_page_in_markdown_has() {
    let (study, records) = (study(MESH), records(MESH));
    let results = StudyResults::new(&study, &records, Tier::Ci);
    let page = study_page(&results.findings().expect("sound cases")).expect("a page");
    let html = render_html(&page).expect("HTML");
    let svg = Regex::new(r"(?s)<svg.*?</svg>").expect("a pattern");
    assert_snapshot("page_html", &without_round_off(&svg.replace_all(&html, "<svg/>")));
}

#[test]
fn the_first_pages_are_what_they_were() {
    let texts = [MESH, STEP, MAP, STIFF, STABILITY, LAYER, LARGE, SETS, FAILING, RACE];
    let all: Vec<(Study, Vec<Record>)> = texts.iter().map(|text| (study(*text), records(*text))).collect();
    let results: Vec<StudyResults<'_>> =
        all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Ci)).collect();
    let findings = ReportFindings::new(&results).expect("sound cases");
    let making = Making {
        date: "2026-11-22".to_owned(),
        processor: "a processor (2 threads)".to_owned(),
        command: "oedometer report".to_owned(),
        seconds: 83.0,
        cases_run: 17,
        left_out: 5,
    };
    let all = AllStudies::new(&results).expect("sound cases");
    let answers = Answers { all: &all, changes: Some(&[]), making: &making, findings: &findings };
    let front = answer_page(&answers).expect("a page");
    let mut text = render_markdown(&index_page(&all)).expect("Markdown");
    text += &render_markdown(&front).expect("Markdown");
    for (name, svg) in figures(&front).expect("figures") {
        writeln!(text, "\n### {name}\n{}", figure_told(&svg)).expect("memory");
    }
    // What made it is another with every build.
    let build =
        Regex::new(r"oedometer \d+\.\d+\.\d+(, sources [^\n]*| · [^\n]*? profile)").expect("a pattern");
    assert_snapshot("first_pages", &without_round_off(&build.replace_all(&text, "oedometer VERSION")));
}

/// Golden values of records, of which some are better, worse, missing or of other inputs.
fn golden(study: &Study, records: &[Record]) -> GoldenFile {
    let mut older = records.to_vec();
    let count = older.len();
    for (number, record) in older.iter_mut().enumerate() {
        let kept = record.errors.iter_mut().filter(|row| row.norm == row.quantity.first_norm());
        match number % 5 {
            0 => kept.step_by(3).for_each(|row| row.value *= 0.5),
            1 => kept.step_by(4).for_each(|row| row.value *= 1.75),
            2 => record.counters.steps += 3,
            _ => {}
        }
    }
    older.remove(count / 2);
    GoldenFile::of(&study.name, &older, "as it was")
}

#[test]
fn checks_of_studies_are_told_as_they_were() {
    let mut text = String::new();
    let mut checks = Vec::new();
    let terminal = check_page::Terminal { width: 80, is_whole: false };
    for study_text in [MESH, STEP, STIFF, STABILITY, LAYER, LARGE, FOOTING, SETS, FAILING] {
        let (study, mut records) = (study(study_text), records(study_text));
        let golden = golden(&study, &records);
        if study_text.0 == "mesh" {
            records[3].balance[0].settlement_curve_gap = 0.25;
            records[5].start.as_mut().expect("a start").volume_error = 0.5;
        }
        let file = format!("studies/{}.toml", study_text.0);
        for golden in [Ok(golden), Err(GoldenError::Missing("golden/t.csv".into()))] {
            let check = StudyCheck::new(&study, &records, Tier::Ci, golden);
            // Where a line is broken depends on how many digits a number has.
            let told = check_page::text_of(&check, Some(&file), &[], terminal)
                .expect("a text")
                .replace("\n    ", " ");
            let objections = check_page::objections_of(&check, 80).map(|text| text.lines().count());
            writeln!(text, "{told}{:?}, {objections:?} lines of objections\n", check.end()).expect("memory");
            checks.push(check);
        }
        // What it is proposed to expect where a study expects nothing.
        let bare = study_text.1.split("[[expect").next().expect("a text");
        let bare = self::study((study_text.0, bare));
        let check =
            StudyCheck::new(&bare, &records, Tier::Ci, Err(GoldenError::Missing("golden/t.csv".into())));
        writeln!(text, "proposed:\n{}", check.proposals.join("\n")).expect("memory");
        writeln!(text, "repeats: {:?}\n", differing_repeats(&records)).expect("memory");
    }
    checks.retain(|check| ["mesh", "step", "failing"].contains(&check.study.as_str()));
    let file_of = |name: &str| (name != "step").then(|| format!("studies/{name}.toml"));
    text += &check_page::markdown_of(&checks, file_of).expect("Markdown");
    text += &check_page::all_judgements(&checks).to_text(200).expect("a table");
    text += &junit(&checks).expect("JUnit");
    assert_snapshot("checks_of_studies", &without_round_off(&text));
}

#[test]
fn measures_of_single_runs_are_told_as_they_were() {
    let mut text = String::new();
    for study_text in [MESH, STEP, STIFF, LAYER, FOOTING, LARGE, SETS, FAILING] {
        for record in records(study_text).iter().step_by(5) {
            let label = record.case.label();
            writeln!(text, "## {label}\n{}", measures::table_of(record, 80).expect("a table"))
                .expect("memory");
        }
    }
    assert_snapshot("measures_of_runs", &without_round_off(&text));
}
