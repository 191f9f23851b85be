//! Sentences from templates: files in `templates/`, filled with findings. Findings hold numbers and names, templates words.

use crate::render::{RenderError, number};
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};
use serde::Serialize;

/// The templates by their names.
const TEMPLATES: [(&str, &str); 4] = [
    ("paper", include_str!("../../templates/paper.md")),
    ("race-answers", include_str!("../../templates/race-answers.md")),
    ("race-limits", include_str!("../../templates/race-limits.md")),
    ("within", include_str!("../../templates/within.md")),
];

/// An environment that knows every template and the filters that all share.
pub(crate) fn environment() -> Result<Environment<'static>, RenderError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("percent", |share: f64| number::rounded_percent(share));
    environment.add_filter("signed_percent", |share: f64| {
        let sign = if share < 0.0 { "−" } else { "+" };
        format!("{sign}{:.1} %", 100.0 * share.abs())
    });
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
    Ok(environment.get_template(name)?.render(Value::from(Serde(findings)))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_without_its_finding_is_an_error() {
        let environment = environment().expect("templates of this program");
        for name in TEMPLATES.map(|(name, _)| name).into_iter().chain(["no such template"]) {
            let told = render(&environment, name, &()).expect_err(name).to_string();
            assert!(told.starts_with("a sentence of the page cannot be written: "), "{told}");
        }
    }
}
