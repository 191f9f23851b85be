//! Every page that the program writes, from studies of every kind whose numbers are all different: a wrong column, sign, unit, word,
//! order or choice of a run shows as a difference. And what HTML, Markdown and text make of one page is the same.

use crate::campaign::runner::records_of;
use crate::case::Tier;
use crate::golden::{GoldenError, GoldenFile};
use crate::judge::study_check::StudyCheck;
use crate::judge::study_results::StudyResults;
use crate::judge::verdict::differing_repeats;
use crate::questions::answers;
use crate::questions::finding::{Finding, Place};
use crate::record::{Record, WallSample};
use crate::render::chart::Chart;
use crate::render::page::{Page, all_figures, render_html, render_markdown, text_of};
use crate::report::annotations::annotations_of;
use crate::report::answers::{Answers, Making, answer_page, matrix_page};
use crate::report::check_page::{self, Terminal};
use crate::report::junit::junit;
use crate::report::studies_page::studies_page;
use crate::report::study_page::{among_others, study_page};
use crate::report::tables::measures;
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::tests::assert_snapshot;
use oedometer_wording::rounded;
use regex_lite::Regex;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::sync::LazyLock;

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

/// Pairings of law and continuity at large strain.
const PAIRINGS: Text = (
    "pairings",
    r#"scene = "xie-leo"
column.load = 200e3
output.time_factors = [0.1, 0.3]
[[sweep]]
method = ["TL-GIMP-SRI-patch"]
law = ["log-linear", "porosity-dependent"]
continuity = ["conservative", "constant-porosity-gradient"]
integrator = ["implicit"]
cells = [4, 8, 16]
time_step = [{ growth = 0.1 }]
"#,
);

/// The paper's method on the columns of its figures, timed.
const PAPER: Text = (
    "paper",
    r#"scene = "terzaghi"
timing.repeats = 3
output.time_factors = [0.05, 0.2, 1.0]
[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [10]
time_step = [{ growth = 0.1 }, { growth = 0.2 }]
"#,
);

const PAPER_LARGE: Text = (
    "paper-large",
    r#"scene = "xie-leo"
column.load = 200e3
output.time_factors = [0.1, 1.0]
[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [10]
time_step = [{ growth = 0.2 }]
"#,
);

const DATES: Text = (
    "dates",
    r#"scene = "terzaghi"
output.times = ["10 s", "1 min"]
[[sweep]]
method = ["GIMP-SRI"]
integrator = ["implicit"]
cells = [5, 10]
time_step = [{ growth = 0.1 }]
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
        |found: &regex_lite::Captures| found[0].parse::<f64>().map_or_else(|_| String::new(), rounded);
    long.replace_all(&text, shorter).into_owned()
}

/// All studies with their records, run once for all tests; the first is that of a page whole.
static ALL: LazyLock<Vec<(Study, Vec<Record>)>> = LazyLock::new(|| {
    let texts = [
        MESH,
        STEP,
        STIFF,
        STABILITY,
        LAYER,
        FOOTING,
        LARGE,
        SETS,
        FAILING,
        PAIRINGS,
        PAPER,
        PAPER_LARGE,
        DATES,
        RACE,
    ];
    texts.map(|text| (study(text), records(text))).into()
});

fn results() -> Vec<StudyResults<'static>> {
    let of = |(study, records): &'static (Study, Vec<Record>)| {
        let file = format!("tables/{}.toml", study.name);
        StudyResults { file, ..StudyResults::new(study, records, Tier::Ci) }
    };
    ALL.iter().map(of).collect()
}

/// What studies answer, each alone and all together.
pub(super) fn every_finding() -> Vec<Finding> {
    let results = results();
    let of_one = |one| answers(std::slice::from_ref(one), Place::Study).expect("sound cases");
    let mut all: Vec<Finding> = results.iter().flat_map(of_one).collect();
    all.extend(answers(&results, Place::Report).expect("sound cases"));
    all
}

fn page_of(one: &StudyResults<'_>) -> Page {
    let findings = answers(std::slice::from_ref(one), Place::Study).expect("sound cases");
    study_page(one, &findings).expect("a page")
}

/// The front page, the list of the studies, and the page of the race.
fn first_pages(results: &[StudyResults<'_>]) -> [Page; 3] {
    let answers = Answers::new(results, Some(Vec::new())).expect("sound cases");
    let making = Making {
        date: "2026-11-22".to_owned(),
        processor: "a processor (2 threads)".to_owned(),
        command: "oedometer report".to_owned(),
        seconds: 83.0,
        cases_run: 17,
        left_out: 5,
    };
    let race = answers.race.as_ref().expect("a race");
    [answer_page(&answers, &making).expect("a page"), studies_page(results), matrix_page(race)]
}

/// A figure in a line: its axes, and of each series the number of its points with the first and the last.
fn figure_told(name: &str, chart: &Chart) -> String {
    let mut text = format!("{name}: {}; {} over {}", chart.title, chart.y.label, chart.x.label);
    let _ = chart.subtitle.iter().try_for_each(|line| write!(text, "; {line}"));
    let point = |(x, y): (f64, f64)| format!("({}, {})", rounded(x), rounded(y));
    for one in &chart.series {
        let ends = one.points.first().zip(one.points.last()).map(|(first, last)| [*first, *last].map(point));
        let ends = ends.map_or(String::new(), |[first, last]| format!(" {first} … {last}"));
        let _ = write!(text, "\n  {:?} {}: {}{ends}", one.style, one.name, one.points.len());
    }
    for rule in &chart.rules {
        let _ = write!(text, "\n  at {}: {}", rounded(rule.at), rule.label);
    }
    for row in chart.rows.iter().flat_map(|rows| &rows.rows) {
        let _ = write!(text, "\n  {}: {}, {}", row.name, row.without.join("|"), row.words.join("|"));
    }
    text
}

/// A page in Markdown with its figures.
fn page_told(page: &Page) -> String {
    let mut text = render_markdown(page).expect("Markdown");
    for figure in all_figures(page) {
        let _ = writeln!(text, "\n{}", figure_told(&figure.name, &figure.chart));
    }
    // What made it is another with every build.
    let build =
        Regex::new(r"oedometer \d+\.\d+\.\d+(, sources [^\n]*| · [^\n]*? profile)").expect("a pattern");
    without_round_off(&build.replace_all(&text, "oedometer VERSION"))
}

#[test]
fn the_report_is_what_it_was() {
    assert_snapshot("report", &first_pages(&results()).map(|page| page_told(&page)).join("\n"));
}

/// The page of a study that fails, and of others the answers that no page before them has.
#[test]
fn pages_of_studies_are_what_they_were() {
    let mut text = String::new();
    let mut told = BTreeSet::new();
    for one in &results() {
        let mut page = page_of(one);
        if told.is_empty() {
            page = among_others(page);
        } else {
            (page.callout, page.links) = (None, Vec::new());
            page.sections.retain(|section| !told.contains(&section.id));
        }
        told.extend(page.sections.iter().map(|section| section.id.clone()));
        let _ = writeln!(text, "{}", page_told(&page));
    }
    assert_snapshot("study", &text);
}

/// Letters and digits of a text, without tags and marks.
fn letters(text: &str) -> String {
    let tags =
        Regex::new(r"(?s)<svg.*?</svg>|<[a-zA-Z/!][^>]*>|&[a-z#0-9]+;|\]\([^)]*\)").expect("a pattern");
    let raised = |letter: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|one| one == letter);
    let plain = |letter: char| match raised(letter) {
        Some(digit) => char::from_digit(u32::try_from(digit).unwrap_or_default(), 10).unwrap_or(letter),
        None if letter == 'ⁿ' => 'n',
        None => letter,
    };
    tags.replace_all(text, "").chars().map(plain).filter(|letter| letter.is_alphanumeric()).collect()
}

/// Lines of a text that are not in another one.
fn missing(lines: &str, whole: &str) -> Vec<String> {
    let whole = letters(whole);
    let is_there = |line: &&str| whole.contains(&letters(line));
    lines.lines().filter(|line| !is_there(line)).map(str::to_owned).collect()
}

#[test]
fn html_markdown_and_text_say_the_same() {
    let results = results();
    let pages = results.iter().map(page_of).chain(first_pages(&results));
    for page in pages {
        let (html, markdown) = (render_html(&page).expect("HTML"), render_markdown(&page).expect("Markdown"));
        // Images are drawn, anchors and kinds of boxes are marks, and a wide page has no list of its sections.
        let is_mark = |line: &&str| {
            ["![", "<a id", "- [", "> [!", "| :", "| -"].iter().any(|mark| line.starts_with(mark))
        };
        let said: Vec<&str> = markdown.lines().filter(|line| !is_mark(line)).collect();
        assert_eq!(missing(&said.join("\n"), &html), [""; 0], "{}: Markdown, not HTML", page.title);
        for section in &page.sections {
            let text = text_of(&section.blocks, usize::MAX, true).expect("text");
            // How many rows a terminal leaves out, and a page counts otherwise.
            let text: Vec<&str> = text.lines().filter(|line| !line.starts_with("and ")).collect();
            let other = missing(&text.join("\n"), &markdown);
            let shown = section.blocks.iter().all(|block| !format!("{block:?}").contains("shown: Some"));
            assert!(other.is_empty() || !shown, "{}: text, not Markdown: {other:#?}", page.title);
        }
        let figures = all_figures(&page);
        assert_eq!(html.matches("<figure").count(), figures.len(), "{}", page.title);
        for figure in figures {
            assert!(markdown.contains(&format!("](figures/{}.svg)", figure.name)), "{}", figure.name);
            assert!(!figure.svg().expect("drawn").contains("NaN"), "{}", figure.name);
        }
    }
    assert_eq!(missing("| a | b_c |", "<td>a</td><td>b<sub>c</sub></td>"), [""; 0]);
    assert_eq!(missing("a 1\nb 2", "<p>a 1</p><p>b 3</p>"), ["b 2"], "what differs is named");
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
fn checks_are_told_as_they_were() {
    let terminal = Terminal { width: 80, is_whole: false };
    let mut text = String::new();
    let mut checks = Vec::new();
    for text_of_study in [MESH, STEP, FAILING] {
        let (study, mut records) = (study(text_of_study), records(text_of_study));
        let golden = golden(&study, &records);
        if study.name == "mesh" {
            records[3].balance[0].settlement_curve_gap = 0.25;
            records[5].start.as_mut().expect("a start").volume_error = 0.5;
        }
        let file = format!("studies/{}.toml", study.name);
        for golden in [Ok(golden), Err(GoldenError::Missing("golden/t.csv".into()))] {
            let results = StudyResults::compared(&study, &records, Tier::Ci, golden);
            let answers = answers(std::slice::from_ref(&results), Place::Terminal).expect("sound cases");
            let check = results.check;
            let told = check_page::text_of(&check, Some(&file), &answers, terminal).expect("a text");
            let objections = check_page::objections_of(&check, 80).map(|text| text.lines().count());
            let _ = writeln!(text, "{told}{:?}, {objections:?} lines of objections\n", check.end());
            checks.push(check);
        }
        // What it is proposed to expect where a study expects nothing.
        let bare = text_of_study.1.split("[[expect").next().expect("a text");
        let bare = self::study((text_of_study.0, bare));
        let check =
            StudyCheck::new(&bare, &records, Tier::Ci, Err(GoldenError::Missing("golden/t.csv".into())));
        let _ = writeln!(text, "proposed:\n{}", check.proposals.join("\n"));
        let _ = writeln!(text, "repeats: {:?}\n", differing_repeats(&records));
    }
    let file_of = |name: &str| (name != "step").then(|| format!("studies/{name}.toml"));
    text += &check_page::markdown_of(&checks, file_of).expect("Markdown");
    text += &check_page::all_judgements(&checks).to_text(200).expect("a table");
    text += &annotations_of(&checks, file_of).join("\n");
    text += &junit(&checks).expect("JUnit");
    assert_snapshot("checks", &without_round_off(&text));
}

#[test]
fn measures_of_single_runs_are_told_as_they_were() {
    let mut text = String::new();
    for (_, records) in &ALL[..9] {
        for record in records.iter().step_by(5) {
            let label = record.case.label();
            let _ = writeln!(text, "## {label}\n{}", measures::table_of(record, 80).expect("a table"));
        }
    }
    assert_snapshot("measures_of_runs", &without_round_off(&text));
}
