//! Checks of single values: inputs by the table of keys, methods, step rules, numbers in their range.

use crate::case::keys::{KEYS, Range};
use crate::case::{Case, Key, Kind, SolverName, Value};
use crate::study::check::Checker;
use crate::study::check::doubts::Basis;
use crate::study::diagnostic::one_of;
use crate::study::file::StudyFile;
use crate::study::inputs::{Inputs, MethodTable, One, TimeStepTable, TypedInput};
use crate::study::reading::Placed;
use crate::study::solver::ExternalSolver;
use oedometer_problem::method::{FULL_PROJECTION, Method, PressureIntegration, Recovery};
use oedometer_problem::time_step::{STEP_KINDS, StepKind, TimeStep};
use oedometer_scenes::Scene;
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::law::Law;
use std::ops::RangeInclusive;

/// A place in the text.
type TextSpan = std::ops::Range<usize>;

/// Methods that left the program, and what does their work.
const GONE: [(&str, &str); 2] = [("PPP-step", "PPP"), ("PPP-monotone", "PPP")];

impl Checker<'_> {
    /// The value of an input, called by its name in the file; `seed` has the values to compare it with.
    pub(super) fn input(&mut self, key: &Key, typed: &One, name: &str, seed: &Case) -> Option<Value> {
        let (span, scene) = (typed.span(), seed.scene);
        match &**typed {
            TypedInput::MethodName(name) => self.method_named(name, span, scene).map(Value::Method),
            TypedInput::MethodChoices(table) => self.method_of(table, span, scene).map(Value::Method),
            TypedInput::TimeStep(table) => self.time_step(table, span).map(Value::TimeStep),
            TypedInput::Word(word) => self.word_fits(word, span, key, scene).then_some(Value::Word(word)),
            TypedInput::Flag(flag) => Some(Value::Flag(*flag)),
            TypedInput::Count(count) => {
                let Kind::Count(most) = key.kind else { return None };
                self.count(Some(&Placed::new(span, *count)), name, 1..=most).map(Value::Count)
            }
            TypedInput::Number(number) => {
                let Kind::Number(range) = key.kind else { return None };
                let usual = key.get(seed).to_string();
                self.number(*number, span, &format!("`{name}`"), range, &usual, key.unit).map(Value::Number)
            }
            TypedInput::List(_) => None,
        }
    }

    /// Every input of a table that the study shares, by the key.
    pub(super) fn inputs(&mut self, table: &str, inputs: &Inputs, seed: &Case) -> Vec<(&'static Key, Value)> {
        let value = |(key, typed): &(&'static Key, One)| {
            self.input(key, typed, &format!("{table}.{}", key.name), seed).map(|value| (*key, value))
        };
        inputs.0.iter().filter_map(value).collect()
    }

    /// Refuses a quantity that is given twice, by a key and by the one that stands in its place, at both places.
    pub(super) fn given_once(&mut self, file: &StudyFile) {
        let blocks: Vec<&Inputs> = file.sweep.iter().map(|block| &block.inputs).collect();
        let mut complaints = Vec::new();
        for key in KEYS.iter().filter(|key| !key.in_place_of.is_empty()) {
            let of_study = |name: &str| file.material.inputs.span(name);
            let anywhere = |name: &str| {
                of_study(name).into_iter().chain(blocks.iter().filter_map(|block| block.span(name))).next()
            };
            if let (Some(place), Some(other)) = (anywhere(key.name), anywhere(key.in_place_of)) {
                complaints.push((place, key.name, key.in_place_of));
                complaints.push((other, key.in_place_of, key.name));
            }
        }
        for (place, name, other) in complaints {
            let message = format!("`{name}` and `{other}` are both given, but stand for the same");
            self.complain(place, message, "leave one of the two out");
        }
    }

    /// Index of a word among its choices.
    pub(super) fn word(&mut self, typed: &Placed<String>, name: &str, choices: &[&str]) -> Option<usize> {
        let index = choices.iter().position(|choice| **choice == **typed);
        if index.is_none() {
            self.complain(typed.span(), format!("no {name} is called `{}`", **typed), one_of(typed, choices));
        }
        index
    }

    fn method_named(&mut self, name: &str, span: TextSpan, scene: &'static Scene) -> Option<SolverName> {
        let of_study = self.solvers.iter().find(|solver| solver.name() == name).map(ExternalSolver::method);
        let Some(method) = Method::named(name).map(SolverName::Own).or(of_study) else {
            if self.refused_solvers.iter().any(|refused| refused == name) {
                return None;
            }
            let mut names = Method::names();
            names.extend(self.solvers.iter().map(|solver| solver.name().to_owned()));
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let gone = GONE.iter().find(|(old, _)| name.ends_with(old));
            let help = gone.map_or_else(
                || one_of(name, &names),
                |(old, new)| format!("version 0.3 removed it: use `{}`", name.replace(old, new)),
            );
            self.complain(span, format!("no method is called `{name}`"), help);
            return None;
        };
        self.method_fits(method, span, scene)
    }

    fn method_of(
        &mut self,
        table: &MethodTable,
        span: TextSpan,
        scene: &'static Scene,
    ) -> Option<SolverName> {
        let MethodTable { basis, strain, pressure, memory, quadrature, .. } = *table;
        let recovery = match &table.recovery {
            Some(word) => **word,
            None if pressure == PressureIntegration::Points => Recovery::Constant,
            None => {
                let help = format!("it can be {}", Recovery::NAMES.join(", "));
                self.complain(span, "the method names no `recovery`", help);
                return None;
            }
        };
        if let (Some(why), Some(word)) = (recovery.refuses(pressure, strain), &table.recovery) {
            self.complain(word.span(), why, "leave the key out, or choose another");
            return None;
        }
        if let Some(why) = quadrature.refuses(basis) {
            self.complain(span, why, "use the basis \"hat\", or leave `quadrature` out");
            return None;
        }
        let projection = self.projection_of(table, recovery)?;
        let configuration = table.configuration.as_deref().copied();
        let place = table.configuration.as_ref().map_or(span, Placed::span);
        let method =
            Method { basis, strain, pressure, recovery, memory, quadrature, projection, configuration };
        self.method_fits(SolverName::Own(method), place, scene)
    }

    /// An input of a method, where the scene allows it.
    pub(super) fn entered(&mut self, value: Value, span: TextSpan, scene: &'static Scene) -> Option<Value> {
        let Value::Method(method) = value else { return Some(value) };
        self.method_fits(method, span, scene).map(Value::Method)
    }

    /// Parameter of a method's projection over that of its source, in thousandths.
    fn projection_of(&mut self, table: &MethodTable, recovery: Recovery) -> Option<u32> {
        let Some(typed) = &table.projection else { return Some(FULL_PROJECTION) };
        let refusal = if !recovery.is_projected() {
            ("this recovery has no projection", "leave `projection` out, or use the recovery \"ppp\"")
        } else if !(0.001..=1000.0).contains(&**typed) {
            (
                "the parameter of a projection is between 0.001 and 1000 times the published value",
                "use 1, or leave it out",
            )
        } else {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "at most a million"
            )]
            return Some((1000.0 * **typed).round() as u32);
        };
        self.complain(typed.span(), refusal.0, refusal.1);
        None
    }

    /// The method, where its scene allows it.
    fn method_fits(
        &mut self,
        method: SolverName,
        span: TextSpan,
        scene: &'static Scene,
    ) -> Option<SolverName> {
        let configuration = method.built_in().and_then(|method| method.configuration);
        let refusal = if let Some(why) = configuration.and_then(|kind| scene.refuses_configuration(kind)) {
            (why, "use \"updated\" or \"total\", or leave the key out")
        } else if method.built_in().is_none() && scene.motion.is_some() {
            (
                "an attached solver does not receive the body forces and the source of a manufactured solution",
                "use a method of this program",
            )
        } else if let Some(why) = method.built_in().and_then(|method| scene.refuses_method(method)) {
            let help = if method.built_in().is_some_and(|method| method.has_projection()) {
                "use \"GIMP-SRI-patch\", whose pressure follows from the strains of the cells"
            } else {
                "use \"GIMP-SRI-patch\", or another method without `TL-`"
            };
            (why, help)
        } else {
            return Some(method);
        };
        self.complain(span, refusal.0, refusal.1);
        None
    }

    /// The one rule that a table names.
    fn time_step(&mut self, table: &TimeStepTable, span: TextSpan) -> Option<TimeStep> {
        let typed = [&table.stable, &table.courant, &table.seconds, &table.growth, &table.tolerance];
        let given = STEP_KINDS.iter().zip(typed).filter_map(|(kind, typed)| Some((kind, typed.as_ref()?)));
        let given: Vec<_> = given.collect();
        let [(StepKind { word, make, least, why }, value)] = given.as_slice() else {
            self.complain(
                span,
                format!("a time step with {} rules", given.len()),
                "give exactly one: { stable = 0.5 }, { courant = 0.5 }, { seconds = 1e-6 }, { growth = 0.05 } or \
                 { tolerance = 1e-4 }",
            );
            return None;
        };
        let number = ***value;
        let (message, help) = if number > 0.0 && number < *least {
            (format!("a time step with `{word} = {number:e}`"), format!("{why}: at least {least:e}"))
        } else if *word == "growth" && number.is_finite() && number > 1.0 {
            let message = format!("a step of {number} times the elapsed time");
            (message, "a growth is a fraction: 0.05 is 5 %, and 1 is the maximum".to_owned())
        } else if number.is_finite() && number > 0.0 {
            return Some(make(number));
        } else {
            (format!("a time step of {number}"), "it must be positive and finite".to_owned())
        };
        self.complain(value.span(), message, help);
        None
    }

    /// Whether a scene takes a word where it is a law or a mean of the conductivity.
    fn word_fits(&mut self, word: &str, span: TextSpan, key: &Key, scene: &'static Scene) -> bool {
        let refused = |law: Law| scene.refuses_law(law);
        let law = Law::named(word).filter(|_| key.name == "law");
        let is_chord = key.name == "conductivity_mean" && word == ConductivityMean::Chord.name();
        if let Some(why) = law.and_then(refused) {
            let fit = Law::ALL.into_iter().filter(|law| refused(*law).is_none());
            let names: Vec<&str> = fit.map(Law::name).collect();
            self.complain(span, why, format!("the problem `{}` takes {}", scene.name, names.join(", ")));
        } else if is_chord && scene.motion.is_some() {
            self.complain(
                span,
                "the chord mean is for a flux out of a drained surface, and a manufactured solution has none",
                "leave it out",
            );
        } else {
            return true;
        }
        false
    }

    /// A whole number in a range.
    pub(super) fn count(
        &mut self,
        typed: Option<&Placed<i64>>,
        name: &str,
        range: RangeInclusive<i64>,
    ) -> Option<usize> {
        let (count, place) = typed.map(|typed| (**typed, typed.span()))?;
        if !range.contains(&count) {
            let help = format!("it must lie between {} and {}", range.start(), range.end());
            self.complain_by(Basis::Text, place, format!("`{name}` is {count}"), help);
            return None;
        }
        usize::try_from(count).ok()
    }

    /// A positive number, or the default.
    pub(super) fn positive(
        &mut self,
        typed: Option<&Placed<f64>>,
        name: &str,
        unit: &str,
        default: f64,
    ) -> f64 {
        let Some(typed) = typed else { return default };
        let (name, usual) = (format!("`{name}`"), default.to_string());
        self.number(**typed, typed.span(), &name, Range::Positive, &usual, unit).unwrap_or(default)
    }

    /// A number in a range; a diagnostic where it is not in it.
    fn number(
        &mut self,
        value: f64,
        span: TextSpan,
        name: &str,
        range: Range,
        usual: &str,
        unit: &str,
    ) -> Option<f64> {
        let mut message = format!("{name} is {value} {unit}");
        let (fits, help) = match range {
            Range::Positive => (
                value.is_finite() && value > 0.0,
                format!("it must be positive and finite; the default column has {usual} {unit}"),
            ),
            Range::NotNegative => {
                (value.is_finite() && value >= 0.0, "it must be 0 or positive, and finite".to_owned())
            }
            Range::Between(least, most) => (
                value > least && value < most,
                format!(
                    "it must lie between {least} and {most}, both excluded; the default column has {usual}"
                ),
            ),
            Range::Within(least, most, wording, help) => {
                message = wording.replace("{}", &value.to_string());
                ((least..=most).contains(&value), help.to_owned())
            }
        };
        if !fits {
            self.complain_by(Basis::Text, span, message.trim_end(), help.trim_end());
        }
        // A zero with a sign is the same zero.
        fits.then_some(value + 0.0)
    }
}
