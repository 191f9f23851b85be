//! Every number of a study's page comes from its `findings.json`: those of its tables stand there to the last bit, and with
//! other numbers in the findings every number of the page is another, but for those of fixed words.

use crate::campaign::runner::solved;
use crate::case::Tier;
use crate::questions::finding::Finding;
use crate::questions::findings::Findings;
use crate::questions::list::QUESTIONS;
use crate::questions::study_findings::StudyFindings;
use crate::questions::study_results::StudyResults;
use crate::render::page::{Block, all_figures};
use crate::render::table::{Cell, Table};
use crate::tests::assert_snapshot;
use crate::{render_markdown, study_page};
use regex_lite::Regex;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt::Write;

/// All numbers of a JSON value, without their signs.
fn collect(value: &Value, numbers: &mut Vec<u64>) {
    match value {
        Value::Number(number) => numbers.extend(number.as_f64().map(|number| number.abs().to_bits())),
        Value::Array(all) => all.iter().for_each(|one| collect(one, numbers)),
        Value::Object(all) => all.values().for_each(|one| collect(one, numbers)),
        _ => {}
    }
}

fn numbers_of(cell: &Cell) -> Vec<f64> {
    match cell {
        Cell::Error(value)
        | Cell::Number(value)
        | Cell::Percent(value)
        | Cell::Seconds(value)
        | Cell::Order(value) => vec![*value],
        Cell::OrderWithin(order, half) => vec![*order, *half],
        Cell::Count(count) => vec![*count as f64],
        _ => Vec::new(),
    }
}

fn tables<'a>(blocks: &'a [Block], found: &mut Vec<&'a Table>) {
    for block in blocks {
        match block {
            Block::Table(table) => found.push(table),
            Block::Details { blocks, .. } => tables(blocks, found),
            Block::Switch(views) => views.iter().for_each(|(_, blocks)| tables(blocks, found)),
            _ => {}
        }
    }
}

/// Numbers of the tables, and those that the findings lack, each with its table.
fn lacking(text: &str, change: impl Fn(&mut Value)) -> (usize, Vec<String>) {
    let (study, records) = solved("s", text);
    let results = StudyResults::new(&study, &records, Tier::Full);
    let found = results.findings().expect("sound cases");
    let mut findings = serde_json::to_value(&found.plain).expect("plain data");
    change(&mut findings);
    let mut known = Vec::new();
    collect(&findings, &mut known);
    known.sort_unstable();
    let page = study_page(&found).expect("a page");
    let mut found = Vec::new();
    page.sections.iter().for_each(|section| tables(&section.blocks, &mut found));
    let numbers: Vec<(&Table, f64)> = found
        .iter()
        .flat_map(|table| table.rows.iter().flatten().flat_map(numbers_of).map(|number| (*table, number)))
        .collect();
    let lacks = |number: &f64| known.binary_search(&number.abs().to_bits()).is_err();
    let lacking = numbers.iter().filter(|(_, number)| number.is_finite() && lacks(number));
    (numbers.len(), lacking.map(|(table, number)| format!("{}: {number:e}", table.title)).collect())
}

const COLUMN: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
    method = ['GIMP-SRI', 'GC-SRI-patch']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n";

const STEP: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
    integrator = ['implicit']\ncells = [4]\ntime_step = [{ seconds = 0.2 }, { seconds = 0.1 }, { seconds = 0.05 }]\n";
const LAYER: &str = "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1]\n[[sweep]]\n\
    method = ['GIMP-SRI', 'GIMP']\nintegrator = ['implicit']\ncells = [2, 4, 8]\n\
    time_step = [{ growth = 0.5 }]\n[[sweep]]\nmethod = ['GIMP']\nintegrator = ['implicit']\ncells = [8]\n\
    time_step = [{ growth = 0.5 }]\npoissons_ratio = [0.3, 0.4, 0.49]\n";
const PEAK: &str = "title = 't'\nscene = 'mandel'\noutput.time_factors = [0.0645, 0.07]\n[[sweep]]\n\
    method = ['GIMP-SRI']\nintegrator = ['implicit']\ncells = [20]\n[[expect_case]]\nstatus = 'ok'\n";

#[test]
fn every_number_of_a_table_stands_in_the_findings() {
    for (text, least) in [(COLUMN, 40), (STEP, 10), (LAYER, 40), (PEAK, 10)] {
        let (count, lacking) = lacking(text, |_| ());
        assert!(lacking.is_empty(), "{} of {count}:\n{}", lacking.len(), lacking.join("\n"));
        assert!(count >= least, "{count} numbers");
    }
}

#[test]
fn a_number_that_the_findings_lack_is_named() {
    let (_, lacking) = lacking(COLUMN, |findings| findings["findings"] = Value::Null);
    assert!(lacking.iter().any(|one| one.starts_with("Start checks")), "{lacking:?}");
}

/// Keys of places in other lists and of what is no number of a page.
const KEPT: [&str; 4] = ["line", "place", "norm", "most_named"];

/// The findings with another number in place of each: rising, so that what is sorted stays so. Digits in names too.
fn changed(value: &mut Value) {
    match value {
        Value::Number(number) => {
            let other = |whole: u64| if whole == 0 { 0 } else { 3 * whole + 2 };
            let whole = number.as_u64().map(|whole| Value::from(other(whole)));
            *value = whole.unwrap_or_else(|| Value::from(0.6 * number.as_f64().unwrap_or_default()));
        }
        Value::String(text) => {
            let next =
                |letter: char| letter.to_digit(10).and_then(|digit| char::from_digit((digit + 1) % 10, 10));
            *text = text.chars().map(|letter| next(letter).unwrap_or(letter)).collect();
        }
        Value::Array(all) => all.iter_mut().for_each(changed),
        Value::Object(all) => {
            all.iter_mut().filter(|(key, _)| !KEPT.contains(&key.as_str())).for_each(|(_, one)| changed(one));
        }
        _ => {}
    }
}

/// A page in Markdown with the data of its figures, line by line.
fn lines_of(found: &StudyFindings) -> Vec<String> {
    let page = study_page(found).expect("a page");
    let figures = all_figures(&page);
    let data = figures.iter().map(|figure| figure.chart.data_csv()).collect::<String>();
    let text = render_markdown(&page).expect("Markdown") + &data;
    // Files of figures, anchors and the list of sections are no words.
    let is_link = |line: &&str| ["![", "<a ", "- ["].iter().any(|start| line.starts_with(start));
    text.lines().filter(|line| !is_link(line)).map(str::to_owned).collect()
}

/// Numbers that are the same on the page of the findings and on that of changed ones, with the words about them.
fn unmoved(text: &str) -> (usize, BTreeSet<String>) {
    let (study, records) = solved("s", text);
    let mut found = StudyResults::new(&study, &records, Tier::Full).findings().expect("sound cases");
    let mut json = serde_json::to_value(&found.plain).expect("plain data");
    changed(&mut json);
    let mut plain: Findings = serde_json::from_value(json).expect("findings");
    // Tables of questions have their numbers from nowhere else.
    found.plain.findings.iter_mut().for_each(|finding| finding.parts.clear());
    plain.findings = found.plain.findings.clone();
    plain.findings.iter_mut().for_each(|finding| changed(&mut finding.facts));
    let other = StudyFindings { plain, ..found.clone() };
    let (before, after) = (lines_of(&found), lines_of(&other));
    assert_eq!(before.len(), after.len(), "{}\n{}", before.join("\n"), after.join("\n"));
    let number = Regex::new(r"[-−]?\d+(\.\d+)?([eE]-?\d+)?").expect("a pattern");
    let (mut count, mut same) = (0, BTreeSet::new());
    for (line, other) in before.iter().zip(&after) {
        let [mut numbers, mut others] = [line, other].map(|line| number.find_iter(line));
        let mut end = 0;
        while let (Some(one), Some(two)) = (numbers.next(), others.next()) {
            count += 1;
            let is_zero = one.as_str().parse::<f64>().is_ok_and(|value| value == 0.0);
            if one.as_str() == two.as_str() && !is_zero {
                let about: String = line[end..one.end()].chars().rev().take(30).collect();
                same.insert(about.chars().rev().collect());
            }
            end = one.end();
        }
        assert_eq!(numbers.count(), others.count(), "{line}\n{other}");
    }
    (count, same)
}

/// The numbers of a text.
fn numbers_in(text: &str) -> Vec<String> {
    let number = Regex::new(r"[-−]?\d+(\.\d+)?([eE]-?\d+)?").expect("a pattern");
    number.find_iter(text).map(|found| found.as_str().to_owned()).collect()
}

/// Sentences of the examples: with another number in each fact every number of the sentence is another.
#[test]
fn every_number_of_a_sentence_moves_with_its_fact() {
    let examples: Vec<Value> =
        serde_json::from_str(include_str!("../../templates/examples.json")).expect("examples");
    let mut count = 0;
    for example in &examples {
        let Some(question) = QUESTIONS.iter().find(|one| example["template"] == one.id) else { continue };
        let told = |facts: Value| {
            let finding = Finding { facts, ..question.answer([], &()) };
            numbers_in(&finding.sentence().expect("a sentence"))
        };
        let mut facts = example["findings"].clone();
        let before = told(facts.clone());
        changed(&mut facts);
        let after = told(facts);
        assert_eq!(before.len(), after.len(), "{example}");
        // Nothing is still nothing.
        for (one, other) in before.iter().zip(&after).filter(|(one, _)| *one != "0") {
            assert_ne!(one, other, "{example}");
        }
        count += before.len();
    }
    assert!(count > 40, "{count} numbers");
}

#[test]
fn every_number_of_a_page_is_another_with_other_findings() {
    let column = COLUMN.replace("cells = [5, 10, 20]", "cells = [4, 8, 16]");
    let mut told = String::new();
    for (name, text, least) in
        [("column", column.as_str(), 30), ("step", STEP, 15), ("layer", LAYER, 35), ("peak", PEAK, 15)]
    {
        let (count, same) = unmoved(text);
        assert!(count >= least, "{count} numbers of {name}");
        let same: Vec<String> = same.into_iter().collect();
        let _ = writeln!(told, "{name}: numbers of fixed words\n  {}", same.join("\n  "));
    }
    assert_snapshot("fixed_numbers_of_pages", &told);
}
