//! What the first page of a report owes its reader, whatever the records: every question answered or left open, a
//! sentence first, tables of ten rows, few words, no riddles; and the page of a study that fails says why.

use crate::program::{call, folder_with};
use oedometer::{
    Answers, Block, Making, Page, RaceFindings, Record, RunOptions, Study, StudyResults, StudySource, Table,
    Tier, answer_page, matrix_page, render_html, render_markdown, run_study,
};
use std::fs;
use std::sync::LazyLock;

/// Twelve methods on three meshes: more than a table of the page has rows.
const MANY_METHODS: &str = r#"
title = "Many methods"
scene = "terzaghi"
[output]
time_factors = [0.1]
[[sweep]]
method = ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "GIMP-mean", "GIMP-SRI-nodal", "GC-Bbar-patch",
  "CE-SRI-patch-cells", "CPDI-SRI-patch", "CE-SRI-patch", "GIMP-null-space"]
integrator = ["implicit"]
cells = [4, 6, 8]
time_step = [{ growth = 0.2 }]
[[sweep]]
method = ["MPM", "GC-SRI-patch", "GIMP-SRI"]
integrator = ["implicit"]
cells = [4]
time_step = [{ growth = 0.2 }]
jitter = [0.05]
"#;

/// Every contender on three small meshes.
const RACED: &str = r#"
title = "Race: a plate"
scene = "mandel"
[output]
time_factors = [0.1]
[[sweep]]
method = ["race"]
integrator = ["implicit"]
cells = [10, 20, 30]
time_step = [{ growth = 0.2 }]
"#;

/// Pairings of law and continuity at large strain.
const PAIRINGS: &str = r#"
title = "Pairings"
scene = "xie-leo"
column.load = 200e3
[output]
time_factors = [0.1, 0.3]
[[sweep]]
method = ["TL-GIMP-SRI-patch"]
law = ["log-linear", "porosity-dependent"]
continuity = ["conservative", "constant-porosity-gradient"]
integrator = ["implicit"]
cells = [4, 8, 16]
time_step = [{ growth = 0.1 }]
"#;

/// Words of generated sentences that make a reader stop.
const RIDDLES: [&str; 8] = [
    "nobody",
    "nowhere",
    "somewhere worse",
    "whoever",
    "as they like",
    "who stands",
    "is ahead of",
    "weights may stay",
];

fn study_of(name: &str, text: &str) -> (Study, Vec<Record>) {
    let study = Study::check(&StudySource { name: format!("{name}.toml"), text: text.to_owned() })
        .expect("a sound study");
    let records = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records;
    (study, records)
}

/// Run once for all tests.
static MANY: LazyLock<(Study, Vec<Record>)> = LazyLock::new(|| study_of("many", MANY_METHODS));
static RACE: LazyLock<(Study, Vec<Record>)> = LazyLock::new(|| study_of("race-plate", RACED));
static PAIRED: LazyLock<(Study, Vec<Record>)> = LazyLock::new(|| study_of("pairings", PAIRINGS));

fn page_of(all: &[&(Study, Vec<Record>)]) -> Page {
    let results: Vec<StudyResults<'_>> =
        all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
    let answers = Answers::new(&results, Some(Vec::new())).expect("sound cases");
    answer_page(&answers, &Making::default()).expect("a page")
}

fn tables(page: &Page) -> Vec<&Table> {
    let blocks = page.sections.iter().flat_map(|section| &section.blocks);
    blocks.filter_map(|block| if let Block::Table(table) = block { Some(table) } else { None }).collect()
}

#[test]
fn every_question_is_answered_by_a_sentence_and_a_short_table_or_not_put() {
    let page = page_of(&[&MANY, &PAIRED, &RACE]);
    let markdown = render_markdown(&page).expect("a page");
    for question in [
        "How was it made?",
        "Which method should I use?",
        "Does it converge, how fast, and to what?",
        "What changed?",
    ] {
        assert!(markdown.contains(question), "{question}\n{markdown}");
    }
    for question in ["What does accuracy cost?", "Which methods lock?"] {
        assert!(!markdown.contains(question), "nothing was run for it: {question}\n{markdown}");
    }
    for section in &page.sections {
        // The sentences on the race are the lead of the page.
        let Some(Block::Paragraph(sentence)) = section.blocks.first().filter(|_| section.id != "choice")
        else {
            continue;
        };
        assert!(sentence.ends_with(['.', ':']), "{}: {sentence}", section.heading);
    }
    for table in tables(&page) {
        let shown = table.shown.unwrap_or(table.rows.len()).min(table.rows.len());
        assert!(shown <= 10, "{shown} rows: {:?}", table.title);
    }
    let is_it = |table: &&Table| table.file.as_deref() == Some("convergence");
    let converges = tables(&page).into_iter().find(is_it).expect("a table");
    assert_eq!(converges.rows.len(), 5 * 3, "five methods with three errors each: {converges:?}");
}

#[test]
fn the_race_has_a_cell_for_every_contender_in_every_situation_and_says_why_one_cannot_run() {
    let page = page_of(&[&RACE]);
    let choice = page.sections.first().filter(|section| section.id == "choice").expect("answered first");
    let Some(Block::Switch(views)) = choice.blocks.first() else { panic!("{choice:?}") };
    let words: Vec<&str> = views.iter().map(|(word, _)| word.as_str()).collect();
    assert_eq!(words, ["Sampled at the points", "Averaged over cells"]);
    for (word, blocks) in views {
        let [Block::Beside(main, aside)] = blocks.as_slice() else { panic!("{word}: {blocks:?}") };
        let ([Block::Figure(figure)], [Block::Table(families), ..]) = (main.as_slice(), aside.as_slice())
        else {
            panic!("{word}: {main:?} {aside:?}")
        };
        let rows = figure.chart.rows.as_ref().map(|rows| rows.rows.len());
        assert_eq!((rows, families.rows.len()), (Some(1), 1), "a row per problem and per family");
    }
    let race = RaceFindings::from_studies([(&RACE.0, RACE.1.as_slice())]).expect("a race");
    let matrix = render_html(&matrix_page(&race)).expect("a page");
    // Splines hold no plate; each of the two read-outs has their cell, with the reason.
    let reason = "a rigid plate holds the nodes of a face";
    assert_eq!(matrix.matches(reason).count(), 2, "{matrix}");
}

#[test]
fn the_first_page_is_short_and_free_of_riddles() {
    let page = page_of(&[&MANY, &PAIRED]);
    let html = render_html(&page).expect("a page");
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    let markdown = render_markdown(&page).expect("a page");
    let raced = render_markdown(&page_of(&[&RACE, &MANY])).expect("a page");
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/report/README.md");
    let committed = fs::read_to_string(committed).expect("the report of this repository");
    // The rules of tables are no words.
    let words_of =
        |text: &str| text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count();
    for text in [&markdown, &raced, &committed] {
        let words = words_of(text);
        assert!(words <= 2500, "{words} words");
    }
    for text in [&raced, &committed] {
        let before = text.split("![").next().map_or(0, words_of);
        assert!(before <= 250, "{before} words before the first picture");
    }
    for riddle in RIDDLES {
        assert!(!markdown.to_lowercase().contains(riddle), "{riddle}:\n{markdown}");
        assert!(!html.to_lowercase().contains(riddle), "{riddle}");
    }
}

const OWN: &str = r#"title = "A study of one's own"
scene = "terzaghi"
[output]
time_factors = [0.1]
[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 8]
time_step = [{ growth = 0.05 }]
[[expect_case]]
cells = 8
time_factor = 0.1
quantity = "pressure"
error = { above = 0.5, below = 0.9 }
"#;

#[test]
fn a_failing_expectation_stands_open_in_the_red_box_and_what_is_not_answered_in_one_list() {
    let folder = folder_with(OWN);
    let at = folder.path();
    assert_eq!(call(at, &["report", "short.toml", "--out", "made"]).code, 0);
    let page = fs::read_to_string(at.join("made/index.html")).expect("a page");
    let red = page
        .split("class=\"callout fail\"")
        .nth(1)
        .expect("a red box")
        .split("</aside>")
        .next()
        .expect("its end");
    assert!(red.contains("0 of 1 expectations are met") && red.contains("cells=8"), "{red}");
    assert!(red.contains("outside 0.5 … 0.9"), "{red}");
    let page = fs::read_to_string(at.join("made/README.md")).expect("a page");
    assert!(!page.contains("What does accuracy cost?"), "what was not studied is not asked: {page}");
    assert!(page.split_whitespace().count() < 900, "a small study makes a small page: {page}");
}

#[test]
fn a_shipped_study_is_reported_by_name_with_a_command_that_runs_it_there() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    let told = call(at, &["report", "any-soil", "--out", "made"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let page = fs::read_to_string(at.join("made/README.md")).expect("a page");
    assert!(page.contains("`oedometer run any-soil`"), "{page}");
    assert!(!page.contains("study:") && !page.contains("page:"), "{page}");
    // Rendered again: nothing is run, and the files are whole.
    let again = call(at, &["report", "any-soil", "--out", "again", "--from-records"]);
    assert_eq!(again.code, 0, "{}", again.err);
    for file in ["index.html", "README.md", "findings.json"] {
        let text = fs::read_to_string(at.join("again").join(file)).expect(file);
        assert!(!text.is_empty() && !text.contains("study:"), "{file}");
    }
}

#[test]
fn a_sweep_of_poisson_s_ratio_in_the_plane_says_who_locks_and_from_where() {
    let study = "title = \"t\"\nscene = \"cosine-layer\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
                 method = [\"GIMP\", \"GIMP-Bbar-patch\"]\nintegrator = [\"implicit\"]\ncells = [8]\n\
                 poissons_ratio = [0.25, 0.49, 0.4999]\n";
    let folder = folder_with(study);
    let told = call(folder.path(), &["report", "short.toml", "--out", "made"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let page = fs::read_to_string(folder.path().join("made/README.md")).expect("a page");
    let answer = page.split("## Which methods lock?").nth(1).expect(&page);
    assert!(
        answer.contains("On 8 cells, 1 of 2 methods keeps displacement and pressure within 10 % up to ν = 0.4999 at T_v = 0.1: `GIMP-Bbar-patch`"),
        "{answer}"
    );
    assert!(answer.contains("| `GIMP` | ✗ from ν = 0.25 |"), "{answer}");
}
