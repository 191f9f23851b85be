//! Every number of an answer in words is a fact: with another number in each fact every number of its sentences is another, and a
//! fact that moves alone moves a sentence, or it says nothing.

use crate::questions::QUESTIONS;
use crate::questions::finding::Finding;
use crate::tests::whole_pages::every_finding;
use regex_lite::Regex;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

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

/// The numbers of a text.
fn numbers_in(text: &str) -> Vec<String> {
    let number = Regex::new(r"[-−]?\d+(\.\d+)?([eE]-?\d+)?").expect("a pattern");
    number.find_iter(text).map(|found| found.as_str().to_owned()).collect()
}

/// An answer in words.
fn words_of(finding: &Finding, facts: &Value) -> String {
    Finding { facts: facts.clone(), ..finding.clone() }.sentence().expect("a sentence")
}

/// Answers of the studies of whole pages, and of the examples of templates, which take every branch.
fn answers() -> Vec<Finding> {
    let examples: Vec<Value> =
        serde_json::from_str(include_str!("../questions/examples.json")).expect("examples");
    let of_example = |example: &Value| {
        let question = QUESTIONS.iter().find(|one| example["template"] == one.id)?;
        Some(Finding { facts: example["findings"].clone(), ..question.answer([], &()) })
    };
    every_finding().into_iter().chain(examples.iter().filter_map(of_example)).collect()
}

#[test]
fn every_number_of_a_sentence_moves_with_its_fact() {
    let mut count = 0;
    for finding in answers() {
        let mut facts = finding.facts.clone();
        let before = numbers_in(&words_of(&finding, &facts));
        changed(&mut facts);
        let after = numbers_in(&words_of(&finding, &facts));
        assert_eq!(before.len(), after.len(), "{finding:?}");
        // Nothing is still nothing.
        for (one, other) in before.iter().zip(&after).filter(|(one, _)| *one != "0") {
            assert_ne!(one, other, "{}: {before:?}", finding.question.id);
        }
        count += before.len();
    }
    assert!(count > 150, "{count} numbers");
}

/// The pointers to numbers of a value.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at.to_owned()),
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(place, one)| pointers(one, &format!("{at}/{place}"), found));
        }
        Value::Object(all) => all.iter().for_each(|(key, one)| pointers(one, &format!("{at}/{key}"), found)),
        _ => {}
    }
}

/// Facts that are no number of a sentence: the answers on methods, whose problems and families stand in tables, and how many names a
/// sentence has.
const IN_TABLES: [&str; 2] = ["choice", "most_named"];

#[test]
fn a_fact_that_moves_alone_moves_a_sentence() {
    let place = Regex::new(r"/\d+").expect("a pattern");
    let mut moves: BTreeMap<String, bool> = BTreeMap::new();
    for finding in answers() {
        let mut all = Vec::new();
        pointers(&finding.facts, "", &mut all);
        let before = words_of(&finding, &finding.facts);
        for pointer in all {
            let mut facts = finding.facts.clone();
            changed(facts.pointer_mut(&pointer).expect("a number"));
            let name = format!("{}{}", finding.question.id, place.replace_all(&pointer, ""));
            *moves.entry(name).or_default() |= words_of(&finding, &facts) != before;
        }
    }
    let is_idle =
        |(name, moves): &(&String, &bool)| !**moves && IN_TABLES.iter().all(|part| !name.contains(part));
    let idle: BTreeSet<&String> = moves.iter().filter(is_idle).map(|(name, _)| name).collect();
    assert!(idle.is_empty(), "facts that no sentence has: {idle:?}");
    assert!(moves.len() > 40, "{} facts", moves.len());
}
