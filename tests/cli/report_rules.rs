//! What the first page of a report owes its reader, whatever the records: every question answered or left open, a
//! sentence first, tables of ten rows, few words, no riddles; and the page of a study that fails says why.

use crate::program::{call, folder_with};
use oedometer::{
    Answers, Block, Ended, Making, Page, Record, RunOptions, Study, StudyResults, StudySource, Table, Tier,
    answer_page, ends_of, render_html, render_markdown, run_study, situations_page,
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
static PAIRED: LazyLock<(Study, Vec<Record>)> = LazyLock::new(|| study_of("pairings", PAIRINGS));

fn page_of(all: &[&(Study, Vec<Record>)]) -> (Page, Page) {
    let results: Vec<StudyResults<'_>> =
        all.iter().map(|(study, records)| StudyResults::new(study, records, Tier::Full)).collect();
    let ends: Vec<Ended<'_>> =
        all.iter().flat_map(|(study, records)| ends_of(study, records).expect("sound")).collect();
    let making = Making::default();
    let answers = Answers { results: &results, changes: Some(&[]), making: &making, ends: &ends };
    (answer_page(&answers).expect("a page"), situations_page(&ends))
}

fn tables(page: &Page) -> Vec<&Table> {
    let blocks = page.sections.iter().flat_map(|section| &section.blocks);
    blocks.filter_map(|block| if let Block::Table(table) = block { Some(table) } else { None }).collect()
}

#[test]
fn every_question_is_answered_by_a_sentence_and_a_short_table_or_left_open_by_name() {
    let (page, detail) = page_of(&[&MANY, &PAIRED]);
    let markdown = render_markdown(&page).expect("a page");
    for question in [
        "How was it made?",
        "Which method should I take?",
        "Does the method converge, and to what?",
        "Does it reproduce the paper?",
        "What does accuracy cost?",
        "Where does it lock, where does it break?",
        "Are the published equations right?",
        "One set of material points, or two?",
        "What changed since the golden values?",
    ] {
        assert!(markdown.contains(question), "{question}\n{markdown}");
    }
    for section in &page.sections {
        let Some(Block::Paragraph(sentence)) = section.blocks.first() else { panic!("{section:?}") };
        assert!(sentence.ends_with(['.', ':']), "{}: {sentence}", section.heading);
    }
    for table in tables(&page) {
        assert!(table.rows.len() <= 10, "{} rows: {:?}", table.rows.len(), table.title);
    }
    let converges =
        tables(&page).into_iter().find(|table| table.title.starts_with("Order")).expect("a table");
    assert!(
        converges.rows.len() == 10 && converges.notes.iter().any(|note| note.starts_with("3 more: ")),
        "{converges:?}"
    );
    // The matrix has a row a situation, and leads to the page that has a row a study.
    let matrix = page.sections.iter().find(|section| section.id == "breaks").expect("the matrix");
    let Some(Block::Table(matrix)) = matrix.blocks.get(1) else { panic!("{matrix:?}") };
    assert_eq!(matrix.rows.len(), 3, "lattice, off the lattice, large strain");
    assert!(markdown.contains("(situations.md)"), "{markdown}");
    assert_eq!(detail.sections.len(), 3);
    assert!(
        render_html(&page).expect("a page").contains("href=\"studies/many.html\">"),
        "every cell leads to its study"
    );
}

#[test]
fn the_audit_shows_several_times_and_meshes_and_names_what_the_paper_prints() {
    let (page, _) = page_of(&[&PAIRED]);
    let audit = page.sections.iter().find(|section| section.id == "audit").expect("answered");
    let [Block::Paragraph(sentence), Block::Figures(figures), Block::Paragraph(mapping_back)] =
        audit.blocks.as_slice()
    else {
        panic!("{audit:?}")
    };
    assert!(
        mapping_back.contains("needs a boundary condition that the paper does not name"),
        "{mapping_back}"
    );
    assert!(sentence.contains("`log-linear, conservative`"), "{sentence}");
    assert!(
        sentence.contains("`porosity-dependent, constant-porosity-gradient (as printed)` (+"),
        "{sentence}"
    );
    assert_eq!(figures.len(), 2);
    for (figure, points) in figures.iter().zip([2, 3]) {
        let csv = figure.chart.data_csv();
        assert_eq!(csv.lines().count(), 1 + 4 * points, "four pairings at every time, on every mesh: {csv}");
    }
}

#[test]
fn the_first_page_is_short_and_free_of_riddles() {
    let (page, _) = page_of(&[&MANY, &PAIRED]);
    let html = render_html(&page).expect("a page");
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    let markdown = render_markdown(&page).expect("a page");
    let words = markdown.split_whitespace().count();
    assert!(words < 4000, "{words} words");
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
    let page = fs::read_to_string(at.join("made/studies/short.html")).expect("a page");
    let red = page
        .split("class=\"callout fail\"")
        .nth(1)
        .expect("a red box")
        .split("</aside>")
        .next()
        .expect("its end");
    assert!(red.contains("0 of 1 expectations are met") && red.contains("cells=8"), "{red}");
    assert!(red.contains("outside 0.5 … 0.9"), "{red}");
    let front = fs::read_to_string(at.join("made/README.md")).expect("a page");
    assert_eq!(front.matches("## Not in these records").count(), 1, "{front}");
    assert!(front.contains("Not as expected: `short`"), "{front}");
    assert!(front.split_whitespace().count() < 400, "a small study makes a small page: {front}");
}

#[test]
fn a_shipped_study_is_reported_by_name_with_a_command_that_runs_it_there() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    let told = call(at, &["report", "any-soil", "--out", "made"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let page = fs::read_to_string(at.join("made/studies/any-soil.md")).expect("a page");
    assert!(page.contains("`oedometer run any-soil`"), "{page}");
    let front = fs::read_to_string(at.join("made/README.md")).expect("a page");
    assert!(
        front.contains("(studies/any-soil.md)") && !front.contains("study:") && !front.contains("page:"),
        "{front}"
    );
    // Rendered again: nothing is run, and the files are whole.
    let again = call(at, &["report", "any-soil", "--out", "again", "--from-records"]);
    assert_eq!(again.code, 0, "{}", again.err);
    for file in ["index.html", "situations.html", "situations.md", "studies/index.html", "studies/README.md"]
    {
        let text = fs::read_to_string(at.join("again").join(file)).expect(file);
        assert!(!text.is_empty() && !text.contains("study:"), "{file}");
    }
}
