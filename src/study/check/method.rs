//! Checks of methods, by name or choice by choice.

use crate::mpm::method::{
    Basis, Configuration, Memory, Method, PressureIntegration, Recovery, StrainGradient,
};
use crate::scene::SceneKind;
use crate::study::check::Checker;
use crate::study::diagnostic::one_of;
use crate::study::file::{MethodEntry, MethodTable};
use std::ops::Range;
use toml::Spanned;

impl Checker<'_> {
    pub(crate) fn method(&mut self, typed: &Spanned<MethodEntry>) -> Option<Method> {
        match typed.get_ref() {
            MethodEntry::Name(name) => {
                let method = Method::named(name);
                if method.is_none() {
                    let names = Method::names();
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    self.complain(
                        typed.span(),
                        format!("no method is called `{name}`"),
                        one_of(name, &names),
                    );
                }
                method
            }
            MethodEntry::Choices(table) => self.method_of_choices(table, typed.span()),
        }
    }

    /// Whether a scene takes the configuration that a method insists on.
    pub(crate) fn configuration_fits(
        &mut self,
        typed: &Spanned<MethodEntry>,
        scene: SceneKind,
        method: Method,
    ) -> bool {
        let refused =
            method.configuration.and_then(|configuration| scene.refuses_configuration(configuration));
        if let Some(why) = refused {
            let place = match typed.get_ref() {
                MethodEntry::Choices(table) => table.configuration.as_ref().map(Spanned::span),
                MethodEntry::Name(_) => None,
            };
            self.complain(
                place.unwrap_or_else(|| typed.span()),
                why,
                "take \"updated\" or \"total\", or leave the key out",
            );
        }
        refused.is_none()
    }

    fn method_of_choices(&mut self, table: &MethodTable, span: Range<usize>) -> Option<Method> {
        let mut pick = |word: &Option<Spanned<String>>, name: &str, choices: &[&str]| {
            if let Some(word) = word {
                self.word(word, name, choices)
            } else {
                self.complain(
                    span.clone(),
                    format!("the method names no `{name}`"),
                    format!("it can be {}", choices.join(", ")),
                );
                None
            }
        };
        let basis = pick(&table.basis, "basis", &["hat", "ugimp", "cpgimp", "cpdi", "bspline2", "bspline3"]);
        let strain = pick(&table.strain, "strain", &StrainGradient::ALL.map(StrainGradient::name));
        let pressure =
            pick(&table.pressure, "pressure", &PressureIntegration::ALL.map(PressureIntegration::name));
        let recovery = match (&table.recovery, pressure) {
            (None, Some(0)) => Some(0),
            (word, _) => pick(word, "recovery", &Recovery::ALL.map(Recovery::name)),
        };
        let memory = match &table.memory {
            Some(word) => Memory::ALL[self.word(word, "memory", &["points", "cells"])?],
            None => Memory::Points,
        };
        let configuration = match &table.configuration {
            Some(word) => {
                Some(self.word(word, "configuration", &Configuration::ALL.map(Configuration::name))?)
            }
            None => None,
        };
        let (pressure, recovery) = (PressureIntegration::ALL[pressure?], Recovery::ALL[recovery?]);
        if let (Some(why), Some(word)) = (recovery.refuses(pressure), &table.recovery) {
            self.complain(word.span(), why, "leave the key out, or take another");
            return None;
        }
        Some(Method {
            basis: Basis::ALL[basis?],
            strain: StrainGradient::ALL[strain?],
            pressure,
            recovery,
            memory,
            configuration: configuration.map(|index| Configuration::ALL[index]),
        })
    }
}
