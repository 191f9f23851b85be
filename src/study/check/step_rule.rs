//! Checks of the rules of step sizes.

use crate::mpm::run::TimeStepRule;
use crate::study::check::checker::Checker;
use crate::study::choice_tables::TimeStepTable;
use std::ops::Range;

impl Checker<'_> {
    /// The one rule that a table names.
    pub(crate) fn time_step(&mut self, table: &TimeStepTable, span: Range<usize>) -> Option<TimeStepRule> {
        let given = [
            (&table.stable, TimeStepRule::Stable as fn(f64) -> TimeStepRule),
            (&table.courant, TimeStepRule::Courant),
            (&table.seconds, TimeStepRule::Seconds),
            (&table.growth, TimeStepRule::Growth),
            (&table.tolerance, TimeStepRule::Tolerance),
        ];
        let given = given.into_iter().filter_map(|(typed, rule)| typed.as_ref().map(|typed| (rule, typed)));
        let given: Vec<_> = given.map(|(rule, typed)| (rule(*typed.get_ref()), typed)).collect();
        let [(rule, value)] = given.as_slice() else {
            self.complain(
                span,
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
