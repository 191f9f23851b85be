//! The verdict on scores: warnings, likely causes, and whether the results pass.

use crate::case::quantity::{Norm, Quantity};
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::judge::score::completeness::Lack;
use crate::judge::score::results::{Results, Scored};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::wording::typed;

/// Share of the load, or of the final settlement, below which an exact value all but vanishes and errors are judged on
/// that scale.
const VANISHING: f64 = 1e-3;

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

/// Checks that every main error against the first reference is below a bound; NaN is not. Where the exact value all but
/// vanishes, as a displacement does at `t = 0`, the error is judged on the scale of the load.
fn errors_below(bound: f64, results: &[Scored], reference: Option<&str>) -> anyhow::Result<Exit> {
    if !(bound.is_finite() && bound > 0.0) {
        return Err(Ended::usage(format!("`--below {bound}` is invalid: expected a positive number")));
    }
    let judged = results.iter().flat_map(|one| &one.score.errors).filter(|row| {
        matches!(row.norm, Norm::L2 | Norm::Relative) && Some(row.reference.as_str()) == reference
    });
    let vanished = results.iter().flat_map(|one| &one.score.unresolved);
    let vanished = vanished.filter(|one| Some(one.reference.as_str()) == reference);
    let scaled = |quantity, time_factor, absolute| (quantity, time_factor, absolute, "error over the load");
    let errors = judged.map(|row| {
        // An exact value that all but vanishes: an error relative to it says nothing.
        if row.absolute.abs() < VANISHING * row.value.abs() {
            return scaled(row.quantity, row.time_factor, row.absolute);
        }
        let unit = if row.quantity == Quantity::Settlement { "relative error" } else { "L2 error" };
        (row.quantity, row.time_factor, row.value, unit)
    });
    let mut any = false;
    let mut exit = Exit::Pass;
    for (quantity, time_factor, error, unit) in
        errors.chain(vanished.map(|one| scaled(one.quantity, one.time_factor, one.absolute)))
    {
        any = true;
        // NaN fails.
        let passes = error.abs() < bound;
        if !passes {
            let (name, time) = (quantity.name(), typed(time_factor));
            let scale = match (unit, quantity) {
                ("error over the load", Quantity::Displacement | Quantity::Settlement) => {
                    "error over the final settlement"
                }
                _ => unit,
            };
            let article = if scale.starts_with('e') || scale.starts_with('L') { "an" } else { "a" };
            say!("fail: {name} at T_v = {time} has {article} {scale} of {error:.3e}, not below {bound:e}");
            exit = Exit::VerdictFailed;
        }
    }
    if any {
        Ok(exit)
    } else {
        Err(Ended::with(Exit::NothingSelected, "the result has no error that can be judged"))
    }
}
