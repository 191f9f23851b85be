//! The verdict on scores: warnings, guesses at their cause, and whether the results pass.

use crate::case::norm::Norm;
use crate::case::quantity::Quantity;
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::judge::score::completeness::Lack;
use crate::judge::score::results::{Results, Scored};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::wording::typed;

/// Prints what the results lack and whether they pass. With `--below` or `--strict`, incomplete results fail.
pub fn judge(
    results: &Results,
    below: Option<f64>,
    strict: bool,
    references: &[ReferenceKind],
) -> anyhow::Result<Exit> {
    let is_gate = strict || below.is_some();
    let mut exit = Exit::Pass;
    let mut is_undeclared_told = false;
    for one in &results.all {
        let name = if results.all.len() > 1 { format!("{}: ", one.name()) } else { String::new() };
        for finding in &one.score.warnings {
            let word = if is_gate { "fail" } else { "warning" };
            let is_of_mapping = finding.name == Lack::Undeclared;
            if !(is_of_mapping && is_undeclared_told) {
                let name = if is_of_mapping { "" } else { &name };
                say!("{word}: {}: {name}{}", finding.name.name(), finding.sentence);
            }
            is_undeclared_told |= is_of_mapping;
            if is_gate {
                exit = Exit::VerdictFailed;
            }
        }
        for sentence in &one.score.diagnosis {
            say!("diagnosis: {name}{sentence}");
        }
        for note in &one.run.notes {
            say!("note: {name}{note}");
        }
    }
    if is_gate && !results.are_times_known() {
        say!("note: missing times were not looked for: give the times that must be there by --time-factor");
    }
    let Some(bound) = below else { return Ok(exit) };
    let reference = references.first().map(|kind| kind.name());
    Ok(exit.max(errors_below(bound, &results.all, reference)?))
}

/// Checks that every main error against the first reference is below a bound; NaN is not.
fn errors_below(bound: f64, results: &[Scored], reference: Option<&str>) -> anyhow::Result<Exit> {
    if !(bound.is_finite() && bound > 0.0) {
        return Err(Ended::usage(format!("`--below {bound}` is invalid: expected a positive number")));
    }
    let judged = results.iter().flat_map(|one| &one.score.errors).filter(|row| {
        matches!(row.norm, Norm::L2 | Norm::Relative) && Some(row.reference.as_str()) == reference
    });
    for one in results.iter().flat_map(|one| &one.score.unresolved) {
        if Some(one.reference.as_str()) == reference {
            say!(
                "note: {} at T_v = {} is not judged: the exact value is zero or below round-off",
                one.quantity.name(),
                typed(one.time_factor)
            );
        }
    }
    let mut any = false;
    let mut exit = Exit::Pass;
    for row in judged {
        any = true;
        // NaN fails.
        let passes = row.value.abs() < bound;
        if !passes {
            let unit = if row.quantity == Quantity::Settlement { "relative" } else { "L2" };
            say!(
                "fail: {} at T_v = {} has a {unit} error of {:.3e}, not below {bound:e}",
                row.quantity.name(),
                typed(row.time_factor),
                row.value
            );
            exit = Exit::VerdictFailed;
        }
    }
    if any {
        Ok(exit)
    } else {
        Err(Ended::with(Exit::NothingSelected, "the result has no error that can be judged"))
    }
}
