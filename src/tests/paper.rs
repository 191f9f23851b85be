//! The paper for the Journal of Open Source Software: its sections, and its numbers, which are those of the committed findings.

use crate::render::number::two_digits;
use serde_json::Value;

#[test]
fn every_number_of_the_paper_s_example_is_one_of_the_committed_findings() {
    let paper = include_str!("../../paper/paper.md");
    let (_, example) = paper.split_once("# Example").expect("an example");
    let (example, _) = example.split_once("\n# ").expect("more sections");
    let mut example = example.split_whitespace().collect::<Vec<_>>().join(" ");
    let findings: Value = serde_json::from_str(include_str!("../../report/findings.json")).expect("JSON");
    let mut answers = findings["findings"].as_array().expect("answers").iter();
    let audit = answers.find(|one| one["question"] == "audit").expect("an audit");
    let number = |key: &str| audit["facts"][key].as_f64().expect(key);
    let mut pairings = audit["tables"][0]["rows"].as_array().expect("pairings").iter();
    let conservative = pairings.find(|row| row[0] == "log-linear, conservative").expect("a pairing");
    for sentence in [
        format!(
            "Xie and Leo by {:+.1} % at $T_v = {}$",
            100.0 * number("printed_error"),
            number("printed_time_factor")
        ),
        format!("agrees within {} %.", two_digits(100.0 * conservative[1].as_f64().expect("an error").abs())),
    ] {
        assert!(example.contains(&sentence), "{sentence}\nis not in\n{example}");
        example = example.replace(&sentence, "");
    }
    assert_eq!(numbers_outside_citations(&example), "", "a number of no finding");
    // The other sections have no numbers, which nothing would keep true.
    let (_, text) = paper.rsplit_once("---\n").expect("a head");
    let (before, rest) = text.split_once("# Example").expect("an example");
    let (_, after) = rest.split_once("\n# ").expect("more sections");
    assert_eq!(numbers_outside_citations(before) + &numbers_outside_citations(after), "");
}

/// The digits of a text outside `[@…]` and outside names, as in `Anura3D`.
fn numbers_outside_citations(text: &str) -> String {
    let outside = text.split('[').map(|part| part.rsplit(']').next().unwrap_or(part));
    let numbers =
        outside.flat_map(str::split_whitespace).filter(|word| !word.starts_with(char::is_alphabetic));
    numbers.flat_map(str::chars).filter(char::is_ascii_digit).collect()
}

#[test]
fn the_paper_has_the_sections_and_the_length_that_the_journal_asks() {
    let paper = include_str!("../../paper/paper.md");
    let (_, text) = paper.rsplit_once("---\n").expect("a head");
    let sections: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# ")).collect();
    let asked = [
        "Summary",
        "Statement of need",
        "State of the field",
        "Software design",
        "Example",
        "Research impact statement",
        "AI usage disclosure",
        "Acknowledgements",
        "References",
    ];
    assert_eq!(sections, asked);
    let words = text.split_whitespace().count();
    assert!((750..=1750).contains(&words), "{words} words");
    let bibliography = include_str!("../../paper/paper.bib");
    for key in text.split('@').skip(1).filter_map(|part| part.split([']', ';']).next()) {
        assert!(bibliography.contains(&format!("{{{key},")), "{key} is not in paper.bib");
    }
}
