//! Checks of single values: inputs by the table of keys, words among their choices, numbers in their range.

use crate::case::Case;
use crate::case::keys::{Choice, Key, Kind, Range, Value};
use crate::study::check::checker::Checker;
use crate::study::choice_tables::Named;
use crate::study::diagnostic::one_of;
use crate::study::inputs::{One, TypedInput};
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::conductivity_mean::ConductivityMean;
use oedometer_soil::law::Law;
use std::ops::RangeInclusive;
use toml::Spanned;

/// A place in the text.
type TextSpan = std::ops::Range<usize>;

impl Checker<'_> {
    /// The value of an input, called by its name in the file; `seed` has the values to compare it with.
    pub(crate) fn input(&mut self, key: &Key, typed: &One, name: &str, seed: &Case) -> Option<Value> {
        let span = typed.span();
        match (typed.get_ref(), key.kind) {
            (TypedInput::Method(entry), _) => self.method(entry, span, seed.scene).map(Value::Method),
            (TypedInput::TimeStep(table), _) => self.time_step(table, span).map(Value::TimeStep),
            (TypedInput::Word(word), Kind::Word(words)) => {
                let words = words();
                let word = words[self.word_at(span.clone(), word, key.name, &words)?];
                (self.law_fits(word, span.clone(), key, seed.scene)
                    && self.mean_fits(word, span, key, seed.scene))
                .then_some(Value::Word(word))
            }
            (TypedInput::Flag(flag), _) => Some(Value::Flag(*flag)),
            (TypedInput::Count(count), Kind::Count(most)) => {
                self.count(Some(&Spanned::new(span, *count)), name, 1..=most).map(Value::Count)
            }
            (TypedInput::Number(number), Kind::Number(range)) => {
                let usual = key.get(seed).to_string();
                self.number(*number, span, &format!("`{name}`"), range, &usual, key.unit).map(Value::Number)
            }
            _ => None,
        }
    }

    /// Every input of a table that the study shares, by the key.
    pub(crate) fn inputs(
        &mut self,
        table: &str,
        typed: &[(&'static Key, One)],
        seed: &Case,
    ) -> Vec<(&'static Key, Value)> {
        let value = |(key, one): &(&'static Key, One)| {
            self.input(key, one, &format!("{table}.{}", key.name), seed).map(|value| (*key, value))
        };
        typed.iter().filter_map(value).collect()
    }

    /// The choice that a word names, or the default where there is none.
    pub(crate) fn choice<T: Choice>(
        &mut self,
        typed: Option<&Spanned<Named<T>>>,
        name: &str,
        default: T,
    ) -> Option<T> {
        typed.map_or(Some(default), |word| self.named(word, name))
    }

    /// The choice that a word names.
    pub(crate) fn named<T: Choice>(&mut self, typed: &Spanned<Named<T>>, name: &str) -> Option<T> {
        let index = self.word_at(typed.span(), typed.get_ref().word(), name, &T::words())?;
        Some(T::all()[index])
    }

    /// Index of a word among its choices.
    pub(crate) fn word(&mut self, typed: &Spanned<String>, name: &str, choices: &[&str]) -> Option<usize> {
        self.word_at(typed.span(), typed.get_ref(), name, choices)
    }

    fn word_at(&mut self, span: TextSpan, word: &str, name: &str, choices: &[&str]) -> Option<usize> {
        let index = choices.iter().position(|choice| *choice == word);
        if index.is_none() {
            self.complain(span, format!("no {name} is called `{word}`"), one_of(word, choices));
        }
        index
    }

    /// Whether a scene takes a word where it is a law.
    fn law_fits(&mut self, word: &str, span: TextSpan, key: &Key, scene: SceneKind) -> bool {
        let refused = |law: &Law| scene.refuses_law(*law);
        let law = Law::ALL.into_iter().find(|law| key.name == "law" && law.name() == word);
        let Some(why) = law.as_ref().and_then(refused) else { return true };
        let fit = Law::ALL.into_iter().filter(|law| refused(law).is_none());
        let names: Vec<&str> = fit.map(Law::name).collect();
        self.complain(span, why, format!("the scene `{}` takes {}", scene.name(), names.join(", ")));
        false
    }

    /// Whether a scene takes a word where it is a mean of the conductivity.
    fn mean_fits(&mut self, word: &str, span: TextSpan, key: &Key, scene: SceneKind) -> bool {
        let is_chord = key.name == "conductivity_mean" && word == ConductivityMean::Chord.name();
        if is_chord && scene.is_manufactured() {
            self.complain(
                span,
                "the chord mean is of a flux that a surface under a load lets out, and a manufactured motion has none",
                "leave it out",
            );
            return false;
        }
        let fits = !is_chord || scene.is_large_strain();
        if !fits {
            self.complain(
                span,
                "at small strain the conductivity is the same everywhere, and so is every mean of it",
                format!(
                    "leave it out, or take a scene of large strain: the scene `{}` has none",
                    scene.name()
                ),
            );
        }
        fits
    }

    /// A whole number in a range.
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

    /// A positive number, or the default where there is none.
    pub(crate) fn positive(
        &mut self,
        typed: Option<&Spanned<f64>>,
        name: &str,
        unit: &str,
        default: f64,
    ) -> f64 {
        let Some(typed) = typed else { return default };
        let (name, usual) = (format!("`{name}`"), default.to_string());
        self.number(*typed.get_ref(), typed.span(), &name, Range::Positive, &usual, unit).unwrap_or(default)
    }

    /// A number in a range; a complaint where it is not in it.
    fn number(
        &mut self,
        value: f64,
        span: TextSpan,
        name: &str,
        range: Range,
        usual: &str,
        unit: &str,
    ) -> Option<f64> {
        let told = || format!("{name} is {value} {unit}");
        let (fits, message, help) = match range {
            Range::Positive => (
                value.is_finite() && value > 0.0,
                told(),
                format!("it must be positive and finite; the seed column has {usual} {unit}"),
            ),
            Range::NotNegative => {
                (value.is_finite() && value >= 0.0, told(), "it must be 0 or positive, and finite".to_owned())
            }
            Range::Between(least, most) => (
                value > least && value < most,
                told(),
                format!("it must lie between {least} and {most}, both excluded; the seed column has {usual}"),
            ),
            Range::Within(least, most, message, help) => {
                ((least..=most).contains(&value), message.replace("{}", &value.to_string()), help.to_owned())
            }
        };
        if !fits {
            self.complain(span, message.trim_end(), help.trim_end());
        }
        // A zero with a sign is the same zero.
        fits.then_some(value + 0.0)
    }
}
