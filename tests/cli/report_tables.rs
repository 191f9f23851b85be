//! Tables and pages of a small study, from its records, as text and as Markdown.
//!
//! Snapshots hold the wording and the layout; what the numbers must be is for expectations and
//! golden values to judge.

use crate::program::assert_snapshot;
use oedometer::{
    AllStudies, Answers, Block, GoldenFile, GoldenKey, Making, Page, Provenance, Record, ReportFindings,
    RunOptions, Study, StudyCheck, StudyResults, StudySource, Table, Tier, WallSample, answer_page,
    check_page, figures, junit, measures, render_html, render_markdown, run_study, study_page, values_of,
};

const TERMINAL: check_page::Terminal = check_page::Terminal { width: 80, is_whole: false };

const STUDY: &str = r#"
title = "A small study"
summary = "Coarse meshes to an early time: quick to run."
scene = "terzaghi"
integrator.drag = "implicit"

[output]
time_factors = [0.1, 0.2]

[[sweep]]
method = ["GIMP-SRI", "GC-SRI-patch"]
cells = [4, 8, 16]

[[expect]]
method = "GC-SRI-patch"
time_factor = 0.2
order = { value = 2.0, minus = 0.2, plus = 0.3 }
at = { cells = 8, below = 1.0e-2 }

[[expect]]
method = "GIMP-SRI"
time_factor = 0.2
order = { value = 2.0 }
"#;

fn small_study() -> (Study, Vec<Record>) {
    let source = StudySource { name: "small.toml".to_owned(), text: STUDY.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    let options = RunOptions::whole(Tier::Full, 1);
    let mut records = run_study(&study, &options, None, &|_| {}).records;
    for record in &mut records {
        // What changes from day to day does not belong in a snapshot.
        record.wall = vec![WallSample { seconds: 0.5, alone: true, ..WallSample::default() }];
        record.provenance = Provenance {
            version: "VERSION".to_owned(),
            sources: "SOURCES".to_owned(),
            compiler: "COMPILER".to_owned(),
            target: "TARGET".to_owned(),
            profile: "PROFILE".to_owned(),
            commit: "COMMIT".to_owned(),
            dirty: false,
        };
    }
    (study, records)
}

fn page_of_small() -> Page {
    let (study, records) = small_study();
    let results = StudyResults::new(&study, &records, Tier::Full);
    study_page(&results.findings().expect("sound cases")).expect("a page")
}

fn tables(blocks: &[Block]) -> Vec<&Table> {
    blocks
        .iter()
        .flat_map(|block| match block {
            Block::Table(table) => vec![table],
            Block::Details { blocks, .. } => tables(blocks),
            _ => Vec::new(),
        })
        .collect()
}

#[test]
fn every_table_of_the_report_reads_as_it_did() {
    let page = page_of_small();
    let all = page.sections.iter().flat_map(|section| tables(&section.blocks));
    let text: Vec<String> = all.map(|table| table.to_text(200).expect("a table")).collect();
    assert_snapshot("report_tables_text", &text.join("\n\n"));
}

#[test]
fn the_markdown_page_reads_as_it_did() {
    assert_snapshot("report_markdown", &render_markdown(&page_of_small()).expect("a page"));
}

#[test]
fn html_and_markdown_come_from_the_same_page_with_all_figures() {
    let page = page_of_small();
    let html = render_html(&page).expect("a page");
    let drawn = figures(&page).expect("figures");
    assert!(drawn.len() >= 5, "{} figures", drawn.len());
    assert_eq!(html.matches("<figure").count(), drawn.len(), "every figure is in the page itself");
    assert!(!html.contains("http://") || !html.contains("<link"), "nothing is fetched from elsewhere");
    let markdown = render_markdown(&page).expect("a page");
    for (name, svg) in drawn {
        assert!(markdown.contains(&format!("figures/{name}")), "{name}");
        assert!(!svg.contains("NaN"), "{name}");
    }
}

fn making() -> Making {
    Making {
        date: "2026-11-22".to_owned(),
        processor: "2 × PROCESSOR".to_owned(),
        command: "oedometer report".to_owned(),
        seconds: 1.0,
        cases_run: 0,
        left_out: 0,
    }
}

#[test]
fn the_answer_page_answers_from_records_and_asks_nothing_else() {
    let (study, records) = small_study();
    let results = [StudyResults::new(&study, &records, Tier::Full)];
    let making = making();
    let findings = ReportFindings::new(&results).expect("sound cases");
    let all = AllStudies::new(&results).expect("sound cases");
    let answers = Answers { all: &all, changes: Some(&[]), making: &making, findings: &findings };
    let page = answer_page(&answers).expect("a page");
    let markdown = render_markdown(&page).expect("a page");
    assert!(markdown.contains("[`small`](studies/small.md)"), "{markdown}");
    assert!(render_html(&page).expect("a page").contains("<a href=\"studies/small.html\">"));
    assert_snapshot("answers_markdown", &markdown);
    // Without records of several methods nothing is recommended.
    let alone: Vec<Record> = records.iter().take(1).cloned().collect();
    let results = [StudyResults::new(&study, &alone, Tier::Full)];
    let findings = ReportFindings::new(&results).expect("sound cases");
    let all = AllStudies::new(&results).expect("sound cases");
    let answers = Answers { all: &all, changes: None, findings: &findings, ..answers };
    let page = answer_page(&answers).expect("a page");
    assert!(page.sections.is_empty(), "nothing is asked without runs to answer from");
}

#[test]
fn the_table_of_one_case_reads_as_it_did() {
    let (_, records) = small_study();
    assert_snapshot("solve_table", &measures::table_of(&records[4], 80).expect("a table"));
}

#[test]
fn a_check_tells_what_is_not_met_and_what_moved() {
    let (study, records) = small_study();
    let mut golden = GoldenFile::of(&study.name, &records, "as measured");
    let untouched = StudyCheck::new(&study, &records, Tier::Full, Ok(golden.clone()));
    assert!(untouched.differences().is_empty() && untouched.agreeing == values_of(&records).len());
    let is_pressure = |key: &&GoldenKey| key.measure.to_string().starts_with("pressure points");
    let key = golden.values.keys().find(is_pressure).expect("a pressure").clone();
    let tolerance = golden.tolerance(&key, golden.values[&key]);
    if let Some(value) = golden.values.get_mut(&key) {
        *value -= 10.0 * tolerance;
    }
    let moved = StudyCheck::new(&study, &records, Tier::Full, Ok(golden));
    let keys: Vec<&GoldenKey> = moved.differences().iter().map(|one| &one.key).collect();
    assert_eq!(keys, [&key], "ten times the tolerance in one place, and nothing else");
    let text = check_page::text_of(&moved, None, &[], TERMINAL).expect("a text");
    assert!(text.contains("1 of 2 expectations met") && text.contains("moved"), "{text}");
    assert_snapshot(
        "check_unmet",
        &check_page::text_of(&untouched, Some("small.toml"), &[], TERMINAL).expect("a text"),
    );
    assert_snapshot(
        "check_markdown",
        &check_page::markdown_of(std::slice::from_ref(&untouched), |_| Some("small.toml".to_owned()))
            .expect("a text"),
    );
    assert_snapshot("check_junit", &junit(&[untouched]).expect("a document"));
}
