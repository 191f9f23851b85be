//! Checks of how time is stepped: the table `[integrator]` and the rules of step sizes.

use crate::mpm::explicit::scheme::Scheme;
use crate::mpm::explicit::{Drag, ExplicitSettings};
use crate::mpm::run::TimeStepRule;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::study::check::Checker;
use crate::study::file::{IntegratorTable, TimeStepTable};
use toml::Spanned;

impl Checker<'_> {
    pub(crate) fn settings(&mut self, table: &IntegratorTable) -> ExplicitSettings {
        let default = ExplicitSettings::default();
        ExplicitSettings {
            scheme: table.scheme.as_ref().and_then(|word| self.scheme(word)).unwrap_or(default.scheme),
            drag: table.drag.as_ref().and_then(|word| self.drag(word)).unwrap_or(default.drag),
            flip: table.flip.as_ref().map_or(default.flip, |flip| self.flip(flip)),
            mapping_back: table.mapping_back.as_ref().map_or(default.mapping_back, |typed| *typed.get_ref()),
        }
    }

    pub(crate) fn integrator(&mut self, word: &Spanned<String>) -> Option<IntegratorKind> {
        let index = self.word(word, "integrator", &IntegratorKind::ALL.map(IntegratorKind::name))?;
        Some(IntegratorKind::ALL[index])
    }

    pub(crate) fn formulation(&mut self, word: &Spanned<String>) -> Option<Formulation> {
        let index = self.word(word, "formulation", &Formulation::ALL.map(Formulation::name))?;
        Some(Formulation::ALL[index])
    }

    pub(crate) fn drag(&mut self, word: &Spanned<String>) -> Option<Drag> {
        Some(Drag::ALL[self.word(word, "drag", &Drag::ALL.map(Drag::name))?])
    }

    pub(crate) fn scheme(&mut self, word: &Spanned<String>) -> Option<Scheme> {
        Some(Scheme::ALL[self.word(word, "scheme", &Scheme::ALL.map(Scheme::name))?])
    }

    pub(crate) fn flip(&mut self, typed: &Spanned<f64>) -> f64 {
        let flip = *typed.get_ref();
        if !(0.0..=1.0).contains(&flip) {
            self.complain(
                typed.span(),
                format!("a FLIP share of {flip}"),
                "it lies between 0 (PIC) and 1 (FLIP)",
            );
        }
        flip + 0.0
    }

    pub(crate) fn time_step(&mut self, typed: &Spanned<TimeStepTable>) -> Option<TimeStepRule> {
        let table = typed.get_ref();
        let given = [
            table.stable.as_ref().map(|value| (TimeStepRule::Stable(*value.get_ref()), value)),
            table.courant.as_ref().map(|value| (TimeStepRule::Courant(*value.get_ref()), value)),
            table.seconds.as_ref().map(|value| (TimeStepRule::Seconds(*value.get_ref()), value)),
            table.growth.as_ref().map(|value| (TimeStepRule::Growth(*value.get_ref()), value)),
            table.tolerance.as_ref().map(|value| (TimeStepRule::Tolerance(*value.get_ref()), value)),
        ];
        let given: Vec<_> = given.into_iter().flatten().collect();
        let [(rule, value)] = given.as_slice() else {
            self.complain(
                typed.span(),
                format!("a time step by {} rules", given.len()),
                "give exactly one: { stable = 0.5 }, { courant = 0.5 }, { seconds = 1e-6 }, { growth = 0.05 } or \
                 { tolerance = 1e-4 }",
            );
            return None;
        };
        let least = least_of(rule).filter(|(least, _)| (0.0..*least).contains(value.get_ref()));
        if let Some((least, why)) = least.filter(|_| *value.get_ref() > 0.0) {
            self.complain(
                value.span(),
                format!("a time step by `{} = {:e}`", name_of(rule), value.get_ref()),
                format!("{why}: at least {least:e}"),
            );
            return None;
        }
        if value.get_ref().is_finite() && *value.get_ref() > 0.0 {
            return Some(*rule);
        }
        self.complain(
            value.span(),
            format!("a time step of {}", value.get_ref()),
            "it must be positive and finite",
        );
        None
    }
}

/// Least number of a rule that a run comes to an end with, and why.
fn least_of(rule: &TimeStepRule) -> Option<(f64, &'static str)> {
    match rule {
        TimeStepRule::Growth(_) => Some((1e-9, "steps that grow by less are too many for any run")),
        TimeStepRule::Tolerance(_) => Some((1e-12, "round-off is an error of that size")),
        TimeStepRule::Stable(_) | TimeStepRule::Courant(_) => {
            Some((1e-9, "no error in time is left that smaller steps would show"))
        }
        TimeStepRule::Seconds(_) => None,
    }
}

/// Name of a rule in study files.
fn name_of(rule: &TimeStepRule) -> &'static str {
    match rule {
        TimeStepRule::Stable(_) => "stable",
        TimeStepRule::Courant(_) => "courant",
        TimeStepRule::Seconds(_) => "seconds",
        TimeStepRule::Growth(_) => "growth",
        TimeStepRule::Tolerance(_) => "tolerance",
    }
}
