//! Checks of single values: words among their choices, counts and numbers in their range.

use crate::study::check::Checker;
use crate::study::diagnostic::one_of;
use std::ops::RangeInclusive;
use toml::Spanned;

impl Checker<'_> {
    /// Index of an optional word, or that of the default.
    pub(crate) fn choice(
        &mut self,
        typed: Option<&Spanned<String>>,
        name: &str,
        choices: &[&str],
        default: usize,
    ) -> Option<usize> {
        typed.map_or(Some(default), |word| self.word(word, name, choices))
    }

    /// Index of a word among its choices.
    pub(crate) fn word(&mut self, typed: &Spanned<String>, name: &str, choices: &[&str]) -> Option<usize> {
        let word = typed.get_ref();
        let index = choices.iter().position(|choice| choice == word);
        if index.is_none() {
            self.complain(typed.span(), format!("no {name} is called `{word}`"), one_of(word, choices));
        }
        index
    }

    pub(crate) fn count(
        &mut self,
        typed: Option<&Spanned<i64>>,
        name: &str,
        range: RangeInclusive<i64>,
    ) -> Option<usize> {
        let typed = typed?;
        let count = *typed.get_ref();
        if !range.contains(&count) {
            let (least, most) = (range.start(), range.end());
            self.complain(
                typed.span(),
                format!("`{name}` is {count}"),
                format!("it must lie between {least} and {most}"),
            );
            return None;
        }
        usize::try_from(count).ok()
    }

    pub(crate) fn positive(
        &mut self,
        typed: Option<&Spanned<f64>>,
        name: &str,
        unit: &str,
        default: f64,
    ) -> f64 {
        let Some(typed) = typed else { return default };
        let value = *typed.get_ref();
        if !(value.is_finite() && value > 0.0) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value} {unit}"),
                format!("it must be positive and finite; the seed column has {default} {unit}"),
            );
        }
        value
    }

    pub(crate) fn not_negative(&mut self, typed: Option<&Spanned<f64>>, name: &str, unit: &str) -> f64 {
        let Some(typed) = typed else { return 0.0 };
        let value = *typed.get_ref();
        if !(value.is_finite() && value >= 0.0) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value} {unit}"),
                "it must be 0 or positive, and finite",
            );
        }
        // A zero with a sign is the same zero.
        value + 0.0
    }

    pub(crate) fn between(
        &mut self,
        typed: Option<&Spanned<f64>>,
        name: &str,
        least: f64,
        most: f64,
        default: f64,
    ) -> f64 {
        let Some(typed) = typed else { return default };
        let value = *typed.get_ref();
        if !(value > least && value < most) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value}"),
                format!(
                    "it must lie between {least} and {most}, both excluded; the seed column has {default}"
                ),
            );
        }
        value + 0.0
    }
}
