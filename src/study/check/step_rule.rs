//! Checks of the rules of step sizes.

use crate::study::check::checker::Checker;
use crate::study::choice_tables::TimeStepTable;
use oedometer_mpm::run::TimeStepRule;
use std::ops::Range;

/// A rule of the step size: its name in study files, what it makes of a number, and the least number that a run
/// comes to an end with, with the reason.
type Rule = (&'static str, fn(f64) -> TimeStepRule, f64, &'static str);

/// What steps that are too small for their share of a limit show.
const NOTHING: &str = "no error in time is left that smaller steps would show";

/// The rules in the order of a table's keys.
const RULES: [Rule; 5] = [
    ("stable", TimeStepRule::Stable, 1e-9, NOTHING),
    ("courant", TimeStepRule::Courant, 1e-9, NOTHING),
    ("seconds", TimeStepRule::Seconds, 0.0, ""),
    ("growth", TimeStepRule::Growth, 1e-9, "steps that grow by less are too many for any run"),
    ("tolerance", TimeStepRule::Tolerance, 1e-12, "round-off is an error of that size"),
];

impl Checker<'_> {
    /// The one rule that a table names.
    pub(crate) fn time_step(&mut self, table: &TimeStepTable, span: Range<usize>) -> Option<TimeStepRule> {
        let typed = [&table.stable, &table.courant, &table.seconds, &table.growth, &table.tolerance];
        let given = RULES.iter().zip(typed).filter_map(|(rule, typed)| Some((rule, typed.as_ref()?)));
        let given: Vec<_> = given.collect();
        let [((name, rule, least, why), value)] = given.as_slice() else {
            self.complain(
                span,
                format!("a time step by {} rules", given.len()),
                "give exactly one: { stable = 0.5 }, { courant = 0.5 }, { seconds = 1e-6 }, { growth = 0.05 } or \
                 { tolerance = 1e-4 }",
            );
            return None;
        };
        let number = *value.get_ref();
        let (message, help) = if number > 0.0 && number < *least {
            (format!("a time step by `{name} = {number:e}`"), format!("{why}: at least {least:e}"))
        } else if *name == "growth" && number.is_finite() && number > 1.0 {
            let message = format!("a step of {number} times the time that has passed");
            (message, "a growth is a share: 0.05 is five percent, and 1 the most".to_owned())
        } else if number.is_finite() && number > 0.0 {
            return Some(rule(number));
        } else {
            (format!("a time step of {number}"), "it must be positive and finite".to_owned())
        };
        self.complain(value.span(), message, help);
        None
    }
}
