//! The paper for the Journal of Open Source Software: every number of its example is one of the committed findings.

use crate::render::number::{rounded_percent, short};
use serde_json::Value;

#[test]
fn every_number_of_the_paper_s_example_is_one_of_the_committed_findings() {
    let paper = include_str!("../../paper/paper.md");
    let (_, example) = paper.split_once("# Example").expect("an example");
    let (example, _) = example.split_once("\n# ").expect("more sections");
    let mut example = example.split_whitespace().collect::<Vec<_>>().join(" ");
    let findings: Value = serde_json::from_str(include_str!("../../report/findings.json")).expect("JSON");
    let [moving, total] = [0, 1].map(|place| &findings["answers"][place]);
    let percent = |value: &Value| rounded_percent(value.as_f64().expect("a share"));
    let trades = findings["trades"].as_array().expect("trades");
    let composite = trades.iter().find(|trade| trade["operator"] == "CMPM").expect("the composite gradient");
    let effect = |place: usize| short(composite["effects"][place]["error_ratio"].as_f64().expect("a ratio"));
    let method = moving["method"].as_str().expect("a name");
    assert_eq!(total["method"], format!("TL-{method}"), "its total Lagrangian form");
    for told in [
        format!("Over {} situations in {} families", moving["situations"], moving["families"]),
        format!(
            "(`{method}`) arrives in {} of the situations, and in {} at no more than twice the cost of the fastest of {} methods",
            percent(&moving["reached"]),
            percent(&moving["within_two"]),
            moving["contenders"]
        ),
        format!("its total Lagrangian form arrives in {}.", percent(&total["reached"])),
        format!(
            "the error of the effective stress by {} and that of the settlement by {}.",
            effect(1),
            effect(2)
        ),
    ] {
        assert!(example.contains(&told), "{told}\nis not in\n{example}");
        example = example.replace(&told, "");
    }
    let cited: String = example.split('[').map(|part| part.rsplit(']').next().unwrap_or(part)).collect();
    assert!(!cited.contains(|letter: char| letter.is_ascii_digit()), "a number of no finding: {cited}");
}
