//! Sentences from templates: files in `templates/`, filled with findings. Findings hold numbers and names, templates words.

use crate::case::Quantity;
use crate::render::report::labels;
use crate::render::{RenderError, number};
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};
use oedometer_soil::wording::{clock_time, count_of, duration, typed};
use serde::Serialize;

/// The templates by their names.
const TEMPLATES: [(&str, &str); 27] = [
    ("audit", include_str!("../../templates/audit.md")),
    ("balances", include_str!("../../templates/balances.md")),
    ("changes", include_str!("../../templates/changes.md")),
    ("cheapest", include_str!("../../templates/cheapest.md")),
    ("converges", include_str!("../../templates/converges.md")),
    ("cost", include_str!("../../templates/cost.md")),
    ("critical-steps", include_str!("../../templates/critical-steps.md")),
    ("double-point", include_str!("../../templates/double-point.md")),
    ("drawn", include_str!("../../templates/drawn.md")),
    ("locking", include_str!("../../templates/locking.md")),
    ("mapping-back", include_str!("../../templates/mapping-back.md")),
    ("paper", include_str!("../../templates/paper.md")),
    ("peers", include_str!("../../templates/peers.md")),
    ("printed-equations", include_str!("../../templates/printed-equations.md")),
    ("proposed", include_str!("../../templates/proposed.md")),
    ("race-answers", include_str!("../../templates/race-answers.md")),
    ("race-limits", include_str!("../../templates/race-limits.md")),
    ("race-situation", include_str!("../../templates/race-situation.md")),
    ("race-table", include_str!("../../templates/race-table.md")),
    ("sampling", include_str!("../../templates/sampling.md")),
    ("setting", include_str!("../../templates/setting.md")),
    ("sweep", include_str!("../../templates/sweep.md")),
    ("time-step", include_str!("../../templates/time-step.md")),
    ("verdict", include_str!("../../templates/verdict.md")),
    ("wall-time", include_str!("../../templates/wall-time.md")),
    ("within", include_str!("../../templates/within.md")),
    ("work", include_str!("../../templates/work.md")),
];

/// An environment that knows every template and the filters that all share.
pub(crate) fn environment() -> Result<Environment<'static>, RenderError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("amount", |value: f64, unit: String| number::with_unit(value, &unit));
    environment.add_filter("bound", |bound: f64| format!("{} %", number::number(100.0 * bound)));
    environment.add_filter("capital_quantity", |quantity: Serde<Quantity>| {
        labels::capitalised(labels::quantity(quantity.0))
    });
    environment.add_filter("count", |count: usize, singular: String, plural: String| {
        count_of(count, &singular, &plural)
    });
    environment.add_filter("clock_time", clock_time);
    environment.add_filter("duration", duration);
    environment.add_filter("error", number::error);
    environment.add_filter("error_percent", number::percent);
    environment.add_filter("fine_percent", |share: f64| format!("{:.2} %", 100.0 * share));
    environment.add_filter("millimetres", |metres: f64| number::with_unit(1e3 * metres, "mm"));
    environment.add_filter("order", number::order);
    environment.add_filter("percent", number::rounded_percent);
    environment.add_filter("ratio", |ratio: f64| number::fixed(ratio, 2));
    environment.add_filter("seconds", number::seconds);
    environment.add_filter("signed_percent", |share: f64| {
        let sign = if share < 0.0 { "−" } else { "+" };
        format!("{sign}{:.1} %", 100.0 * share.abs())
    });
    environment.add_filter("solution", |reference: String| labels::solution(&reference));
    environment.add_filter("step", |label: String| {
        let seconds = label.strip_prefix("seconds=").and_then(|text| text.parse().ok());
        seconds.map_or(label, |seconds| format!("Δt = {} s", number::number(seconds)))
    });
    environment.add_filter("time_factor", number::time_factor);
    environment.add_filter("typed", typed);
    for (name, text) in TEMPLATES {
        environment.add_template(name, text)?;
    }
    Ok(environment)
}

/// A template filled with findings: lightly marked paragraphs.
pub(crate) fn render(
    environment: &Environment<'_>,
    name: &str,
    findings: &impl Serialize,
) -> Result<String, RenderError> {
    Ok(environment.get_template(name)?.render(Value::from(Serde(findings)))?.trim().to_owned())
}

/// A template that needs no more than the shared filters.
pub(crate) fn sentence(name: &str, findings: &impl Serialize) -> Result<String, RenderError> {
    render(&environment()?, name, findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_without_its_finding_is_an_error() {
        let environment = environment().expect("templates of this program");
        // What needs no finding says the same on every page.
        let fixed = ["balances", "mapping-back", "proposed", "work"];
        let filled = TEMPLATES.map(|(name, _)| name).into_iter().filter(|name| !fixed.contains(name));
        for name in filled.chain(["no such template"]) {
            let told = render(&environment, name, &()).expect_err(name).to_string();
            assert!(told.starts_with("a sentence of the page cannot be written: "), "{told}");
        }
    }

    /// `templates/examples.json` holds findings for every branch of these templates, with the sentences that they make.
    #[test]
    fn every_branch_of_a_template_reads_as_a_sentence() {
        #[derive(serde::Deserialize)]
        struct Example {
            template: String,
            findings: serde_json::Value,
            sentence: String,
        }
        let examples = include_str!("../../templates/examples.json");
        let examples: Vec<Example> = serde_json::from_str(examples).expect("examples");
        for (place, Example { template, findings, sentence: wanted }) in examples.into_iter().enumerate() {
            assert_eq!(sentence(&template, &findings).expect(&template), wanted, "example {}", place + 1);
        }
    }
}
