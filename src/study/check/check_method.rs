//! Checks of methods, by name or choice by choice.

use crate::case::keys::Choice;
use crate::study::check::checker::Checker;
use crate::study::choice_tables::{MethodTable, Named};
use crate::study::diagnostic::one_of;
use crate::study::inputs::MethodEntry;
use oedometer_mpm::method::{Memory, Method, PressureIntegration, Recovery};
use oedometer_mpm::scene::SceneKind;
use std::ops::Range;
use toml::Spanned;

impl Checker<'_> {
    /// The method that an entry names, where its scene takes its configuration.
    pub(crate) fn method(
        &mut self,
        entry: &MethodEntry,
        span: Range<usize>,
        scene: SceneKind,
    ) -> Option<Method> {
        let (method, place) = match entry {
            MethodEntry::Name(name) => {
                let attached = self.solvers.iter().find(|solver| solver.name() == name);
                let attached = attached.map(|solver| Method::of_attached(solver.attached));
                let method = Method::named(name).or(attached);
                if method.is_none() {
                    let mut names = Method::names();
                    names.extend(self.solvers.iter().map(|solver| solver.name().to_owned()));
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    self.complain(
                        span.clone(),
                        format!("no method is called `{name}`"),
                        one_of(name, &names),
                    );
                }
                (method?, None)
            }
            MethodEntry::Choices(table) => {
                (self.method_of_choices(table, &span)?, table.configuration.as_ref().map(|word| word.span()))
            }
        };
        if let Some(why) = method.configuration.and_then(|kind| scene.refuses_configuration(kind)) {
            let help = "take \"updated\" or \"total\", or leave the key out";
            self.complain(place.unwrap_or(span.clone()), why, help);
            return None;
        }
        if let Some(why) = scene.refuses_method(method) {
            let help = if scene.is_manufactured() {
                "take \"GIMP-SRI-patch\", \"TL-GIMP-SRI-patch\", or another method of this program without B-bar"
            } else {
                "take \"GIMP-SRI-patch\", or another method without `TL-`"
            };
            self.complain(span, why, help);
            return None;
        }
        Some(method)
    }

    /// A choice that a method must name.
    fn picked<T: Choice>(
        &mut self,
        typed: Option<&Spanned<Named<T>>>,
        name: &str,
        span: &Range<usize>,
    ) -> Option<T> {
        if typed.is_none() {
            self.names_no(name, &T::words(), span);
        }
        self.named(typed?, name)
    }

    fn names_no(&mut self, name: &str, choices: &[&str], span: &Range<usize>) {
        self.complain(
            span.clone(),
            format!("the method names no `{name}`"),
            format!("it can be {}", choices.join(", ")),
        );
    }

    fn method_of_choices(&mut self, table: &MethodTable, span: &Range<usize>) -> Option<Method> {
        let basis = self.picked(table.basis.as_deref(), "basis", span);
        let strain = self.picked(table.strain.as_deref(), "strain", span);
        let pressure = self.picked(table.pressure.as_deref(), "pressure", span);
        let recovery = match (&table.recovery, pressure) {
            (None, Some(PressureIntegration::Points)) => Some(Recovery::Constant),
            (word, _) => self.picked(word.as_deref(), "recovery", span),
        };
        let memory = match &table.memory {
            Some(word) => self.named(word, "memory")?,
            None => Memory::Points,
        };
        let configuration = match &table.configuration {
            Some(word) => Some(self.named(word, "configuration")?),
            None => None,
        };
        let (pressure, recovery) = (pressure?, recovery?);
        if let (Some(why), Some(word)) = (recovery.refuses(pressure), &table.recovery) {
            self.complain(word.span(), why, "leave the key out, or take another");
            return None;
        }
        let (basis, strain) = (basis?, strain?);
        Some(Method { basis, strain, pressure, recovery, memory, configuration, attached: None })
    }
}
