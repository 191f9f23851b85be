//! Sentences from templates, files beside what fills them: facts are numbers and names, templates words.

use crate::case::Quantity;
use crate::questions::words;
use crate::render::marked_text::paragraphs;
use crate::render::{RenderError, number};
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};
use oedometer_convergence::Class;
use oedometer_wording::{clock_time, count_of, duration, typed};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// An environment that knows the filters of all templates.
static ENVIRONMENT: LazyLock<Environment<'static>> = LazyLock::new(|| {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("amount", |value: f64, unit: String| number::with_unit(value, &unit));
    environment.add_filter("amounts", |all: Serde<Vec<Amount>>| amounts(&all.0));
    environment.add_filter("layers", |all: Serde<Vec<Layer>>| layers(&all.0));
    environment.add_filter("bound", number::bound);
    environment.add_filter("quantity", |quantity: Serde<Quantity>| words::quantity(quantity.0));
    environment.add_filter("order_or", |order: Option<f64>, class: Option<Serde<Class>>| match class {
        Some(class) => words::order_with_class(class.0, order),
        None => order.map_or_else(
            || "too few levels for an order".to_owned(),
            |order| format!("order {}", number::order(order)),
        ),
    });
    environment.add_filter("count", |count: usize, singular: String, plural: String| {
        count_of(count, &singular, &plural)
    });
    environment.add_filter("clock_time", clock_time);
    environment.add_filter("duration", duration);
    environment.add_filter("error_percent", number::percent);
    environment.add_filter("fine_percent", |share: f64| format!("{:.2} %", 100.0 * share));
    environment.add_filter("millimetres", |metres: f64| number::with_unit(1e3 * metres, "mm"));
    environment.add_filter("names", |names: Vec<String>, most: Option<usize>| in_words(&names, most));
    environment.add_filter("number", number::rounded);
    environment.add_filter("percent", number::rounded_percent);
    environment.add_filter("short", number::two_digits);
    environment.add_filter("signed_percent", |share: f64| {
        let sign = if share < 0.0 { "−" } else { "+" };
        format!("{sign}{:.1} %", 100.0 * share.abs())
    });
    environment.add_filter("solution", |reference: String| words::solution(&reference));
    environment.add_filter("time_factor", number::time_factor);
    environment.add_filter("typed", typed);
    environment
});

/// A template filled with facts: lightly marked, one line a paragraph.
///
/// # Errors
/// If the template needs what is no fact.
pub fn filled(template: &str, facts: &impl Serialize) -> Result<String, RenderError> {
    let text = ENVIRONMENT.render_str(template, Value::from(Serde(facts)))?;
    Ok(paragraphs(&text).join("\n\n"))
}

/// Names in a sentence, as code: all of them, or so many and the number of the others.
fn in_words(names: &[String], most: Option<usize>) -> String {
    let shown = &names[..most.unwrap_or(names.len()).min(names.len())];
    let list = shown.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match names.len() - shown.len() {
        0 => list,
        others => format!("{list} and {}", count_of(others, "other", "others")),
    }
}

/// A quantity with its symbol and its least and largest value in SI; the unit of a number is empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Amount {
    /// Its symbol.
    pub symbol: String,
    /// Its unit.
    pub unit: String,
    /// The least.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// A layer with what it does not share with the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Thickness, m.
    pub thickness: f64,
    /// What is its own.
    pub stated: Vec<Amount>,
}

fn amounts(all: &[Amount]) -> String {
    let amount = |Amount { symbol, unit, least, most }: &Amount| {
        let end =
            if least == most { String::new() } else { format!(" … {}", number::with_unit(*most, unit)) };
        format!("*{symbol}* = {}{end}", number::with_unit(*least, unit))
    };
    all.iter().map(amount).collect::<Vec<_>>().join(", ")
}

fn layers(all: &[Layer]) -> String {
    let layer = |layer: &Layer| {
        format!("{} with {}", number::with_unit(layer.thickness, "m"), amounts(&layer.stated))
    };
    all.iter().map(layer).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::questions::QUESTIONS;
    use regex_lite::Regex;

    #[test]
    fn a_template_without_its_facts_is_an_error() {
        for (name, template) in every_template() {
            let told = filled(template, &()).expect_err(name).to_string();
            assert!(told.starts_with("a sentence of the page cannot be written: "), "{told}");
        }
    }

    /// Findings with the sentence that their template makes of them.
    #[derive(serde::Deserialize)]
    struct Example {
        template: String,
        findings: serde_json::Value,
        sentence: String,
    }

    fn examples() -> Vec<Example> {
        serde_json::from_str(include_str!("examples.json")).expect("examples")
    }

    /// Every template by its name, those of the questions among them.
    fn every_template() -> Vec<(&'static str, &'static str)> {
        let of_report = [
            ("changes", include_str!("../report/answers/changes.md")),
            ("proposed", include_str!("../report/proposed.md")),
            ("race-headline", include_str!("../report/answers/race-headline.md")),
            ("race-lead", include_str!("../report/answers/race-lead.md")),
            ("race-rules", include_str!("../report/answers/race-rules.md")),
        ];
        of_report.into_iter().chain(QUESTIONS.iter().map(|one| (one.id, one.template))).collect()
    }

    fn template(name: &str) -> &'static str {
        every_template().into_iter().find(|(known, _)| *known == name).expect(name).1
    }

    #[test]
    fn every_example_reads_as_its_sentence() {
        for (place, Example { template: name, findings, sentence: wanted }) in
            examples().into_iter().enumerate()
        {
            let told = filled(template(&name), &findings).expect(&name);
            assert_eq!(told, paragraphs(&wanted).join("\n\n"), "example {}", place + 1);
        }
    }

    /// A template with a mark in each of its branches, that of a condition that does not hold among them, and their number.
    fn marked(template: &str) -> (String, usize) {
        let tag = Regex::new(r"(?s)\{%-?\s*(\w+).*?%\}").expect("a pattern");
        let (mut text, mut marks, mut end) = (String::new(), 0, 0);
        // Whether each open condition has had an `else`; a loop has none.
        let mut open: Vec<Option<bool>> = Vec::new();
        let mut mark = || {
            marks += 1;
            format!("⟦{marks}⟧")
        };
        for found in tag.captures_iter(template) {
            let whole = found.get(0).expect("a tag");
            text += &template[end..whole.start()];
            end = whole.end();
            match &found[1] {
                "if" => open.push(Some(false)),
                "for" => open.push(None),
                "else" => open.last_mut().expect("a condition").iter_mut().for_each(|had| *had = true),
                "endif" if open.pop() == Some(Some(false)) => text += &("{% else %}".to_owned() + &mark()),
                "endfor" => drop(open.pop()),
                _ => {}
            }
            text += whole.as_str();
            if ["if", "elif", "else", "for"].contains(&&found[1]) {
                text += &mark();
            }
        }
        (text + &template[end..], marks)
    }

    /// Branches of a template that none of its examples takes, by what stands in them.
    fn untaken(name: &str, template: &str) -> Vec<String> {
        let (text, marks) = marked(template);
        let examples = examples().into_iter().filter(|example| example.template == name);
        let told: String = examples.map(|one| filled(&text, &one.findings).expect(name)).collect();
        let is_untaken = |mark: &String| !told.contains(mark);
        let around = |mark: String| {
            let place = text.find(&mark).unwrap_or_default();
            let after: String = text[place..].chars().take(60).collect();
            format!("{name}: {after}")
        };
        (1..=marks).map(|mark| format!("⟦{mark}⟧")).filter(is_untaken).map(around).collect()
    }

    #[test]
    fn an_example_takes_every_branch_of_every_template() {
        let untaken: Vec<String> =
            every_template().into_iter().flat_map(|(name, text)| untaken(name, text)).collect();
        assert!(untaken.is_empty(), "{}", untaken.join("\n"));
        let all = examples();
        let is_lacking = |(name, _): &(&str, &str)| all.iter().all(|example| example.template != *name);
        let lacking: Vec<_> = every_template().into_iter().filter(is_lacking).map(|(name, _)| name).collect();
        assert!(lacking.is_empty(), "without an example: {lacking:?}");
        let (text, marks) = marked("{% if a %}x{% elif b %}y{% endif %}{%- for c in d -%}z{% endfor %}");
        let whole =
            "{% if a %}⟦1⟧x{% elif b %}⟦2⟧y{% else %}⟦3⟧{% endif %}{%- for c in d -%}⟦4⟧z{% endfor %}";
        assert_eq!((text.as_str(), marks), (whole, 4));
    }

    #[test]
    fn a_list_of_names_ends_with_the_number_of_those_that_are_left_out() {
        let names = ["a", "b", "c"].map(str::to_owned);
        for (most, told) in
            [(None, "`a`, `b`, `c`"), (Some(3), "`a`, `b`, `c`"), (Some(2), "`a`, `b` and 1 other")]
        {
            assert_eq!(in_words(&names, most), told);
        }
    }

    /// What is wrong with a template: long lines, many conditions, and digits that are no fact.
    fn complaints(template: &str) -> Vec<String> {
        let tags = Regex::new(r"(?s)\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}").expect("a pattern");
        let words = tags.replace_all(template, "");
        // Names that have a digit.
        let words = ["L_2", "L2"].iter().fold(words.into_owned(), |words, name| words.replace(name, ""));
        let long = template.lines().filter(|line| line.chars().count() > 120).map(str::to_owned);
        let numbers = words.lines().filter(|line| line.contains(|c: char| c.is_ascii_digit()));
        let many = (template.matches("{% if").count() > 3).then(|| "more than three conditions".to_owned());
        long.chain(numbers.map(str::to_owned)).chain(many).collect()
    }

    #[test]
    fn templates_are_short_and_have_no_number_of_their_own() {
        for (name, template) in every_template() {
            assert_eq!(complaints(template), [""; 0], "{name}");
        }
        let planted = format!("at 12 cells {{{{ cells }}}}\n{}", "x".repeat(121));
        assert_eq!(complaints(&planted).len(), 2);
        assert_eq!(complaints(&"{% if a %}{% endif %}".repeat(4)).len(), 1);
        assert_eq!(complaints("{{ a[0]|order }} of L_2"), [""; 0]);
    }
}
