//! Judges what a study expects of single cases; hard cases are judged by this, not by series.

use crate::convergence::class::Class;
use crate::convergence::class::evaluable_series::plain;
use crate::judge::error_place::place_of_attached;
use crate::judge::paths::Judgement;
use crate::judge::verdict::{Check, Verdict, VerdictOutcome, check};
use crate::measure::pressure_peak::pressure_peak;
use crate::record::{Balance, Record};
use crate::study::case_expectation::{Bounds, CaseDemand, CaseExpectation, ErrorRange};
use crate::wording::typed;

impl CaseExpectation {
    /// One judgement a case that it selects; where it selects none, one that fails.
    pub fn judge(&self, records: &[Record]) -> Vec<Judgement> {
        let selected: Vec<&Record> =
            records.iter().filter(|record| self.selection.fits(&record.case)).collect();
        if selected.is_empty() {
            let check = check("cases", false, None, "no case is selected".to_owned());
            return vec![self.judgement("any case".to_owned(), vec![check])];
        }
        selected
            .iter()
            .map(|record| self.judgement(record.case.label(), self.demand.checks(record)))
            .collect()
    }

    fn judgement(&self, subject: String, checks: Vec<Check>) -> Judgement {
        let pass = checks.iter().all(|check| check.pass);
        let told: Vec<&str> =
            checks.iter().filter(|check| pass || !check.pass).map(|check| check.reason.as_str()).collect();
        let classification = plain(Class::NotEvaluable, "a case is no series".to_owned());
        let outcome = if pass { VerdictOutcome::Passed } else { VerdictOutcome::Failed };
        let verdict = Verdict { pass, outcome, reason: told.join("; "), classification, checks };
        Judgement { line: self.line, subject, verdict, uncertainty: None }
    }
}

impl CaseDemand {
    /// Everything asked, judged; comparisons are written so that NaN fails.
    fn checks(&self, record: &Record) -> Vec<Check> {
        let mut checks = Vec::new();
        checks.extend(self.status.as_ref().map(|wanted| status_found(wanted, record)));
        checks.extend(self.critical_step_within.map(|within| critical_step_found(within, record)));
        checks.extend(self.error.as_ref().map(|range| error_found(range, record)));
        let worst =
            |of: fn(&Balance) -> f64| record.balance.iter().map(|balance| of(balance).abs()).reduce(f64::max);
        let drifts = [
            ("mass of solids", worst(|balance| balance.solid_mass_drift), self.solid_drift_below),
            ("water", worst(|balance| balance.water_imbalance), self.water_drift_below),
        ];
        let asked = drifts.into_iter().filter_map(|(what, found, below)| Some((what, found, below?)));
        checks.extend(asked.map(|(what, found, below)| drift_found(what, found, below)));
        let spurious = record.balance.iter().filter_map(|balance| balance.spurious_velocity).reduce(f64::max);
        let peak = pressure_peak(record);
        let ranges = [
            ("spurious velocity over the conductivity", spurious, self.spurious_velocity),
            ("time factor of the highest pressure", peak.map(|peak| peak.time_factor), self.peak_time_factor),
            ("highest pressure over the load", peak.map(|peak| peak.height), self.peak_pressure),
        ];
        let asked = ranges.into_iter().filter_map(|(what, found, bounds)| Some((what, found, bounds?)));
        checks.extend(asked.map(|(what, found, bounds)| value_found(what, found, bounds)));
        checks
    }
}

fn status_found(wanted: &str, record: &Record) -> Check {
    let found = record.status.name();
    let how = record
        .status
        .failure()
        .map_or_else(String::new, |failure| format!("{}: {}", failure.place(), failure.reason));
    let pass = found == wanted;
    let instead = if pass { String::new() } else { format!(" instead of {wanted}") };
    check("status", pass, None, format!("{found}{instead}{how}"))
}

fn critical_step_found(within: f64, record: &Record) -> Check {
    let Some(found) = &record.stability else {
        return check("critical step", false, None, "the critical step was not searched".to_owned());
    };
    let Some(deviation) = found.deviation() else {
        return check("critical step", false, None, "no step was observed to leave".to_owned());
    };
    let clean = found.probes_agree();
    let probes: Vec<String> = found
        .probes
        .iter()
        .map(|probe| match &probe.failure {
            None => format!("{} runs {} steps", probe.share, probe.steps),
            Some(failure) => format!("{} is {} at step {}", probe.share, failure.kind.name(), failure.step),
        })
        .collect();
    let reason = format!(
        "observed {:+.2} % of the predicted {:.4e} s, {} % allowed; {}",
        100.0 * deviation,
        found.predicted,
        100.0 * within,
        probes.join(", ")
    );
    check("critical step", deviation.abs() <= within && clean, Some(deviation), reason)
}

fn error_found(range: &ErrorRange, record: &Record) -> Check {
    let measure = &range.measure;
    let Some(row) = measure.error(record) else {
        return check("error", false, None, format!("no error at T_v = {}", typed(measure.time_factor)));
    };
    let error = row.value.abs();
    let pass = error < range.below && error >= range.above;
    let inside = if pass { "in" } else { "outside" };
    let reason = format!(
        "{} {} {} at T_v = {}: {error:.3e} {inside} {:.1e} … {:.1e}",
        measure.quantity.name(),
        measure.norm,
        measure.sample.name(),
        typed(measure.time_factor),
        range.above,
        range.below
    );
    let place = if pass { None } else { place_of_attached(record, row) };
    let reason = place.map_or(reason.clone(), |place| format!("{reason}; {place}"));
    check("error", pass, Some(error), reason)
}

fn value_found(what: &'static str, found: Option<f64>, bounds: Bounds) -> Check {
    let Some(value) = found else {
        return check(what, false, None, format!("no {what} was found"));
    };
    let pass = value < bounds.below && value >= bounds.above;
    let inside = if pass { "in" } else { "outside" };
    let range = format!("{:.4e} … {:.4e}", bounds.above, bounds.below);
    check(what, pass, Some(value), format!("{what}: {value:.5e} {inside} {range}"))
}

fn drift_found(what: &str, found: Option<f64>, below: f64) -> Check {
    let Some(drift) = found else {
        return check("drift", false, None, format!("no balance of the {what}"));
    };
    let pass = drift < below;
    let relation = if pass { "below" } else { "not below" };
    check("drift", pass, Some(drift), format!("{what}: drift {drift:.1e}, {relation} {below:.0e}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::study::expectation::Measure;

    const STUDY: &str = r#"title = "One case"
scene = "terzaghi"
output = { time_factors = [0.05] }

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [10]
time_step = [{ growth = 0.05 }]
"#;

    fn record() -> Record {
        records_of(STUDY).remove(0)
    }

    #[test]
    fn an_error_is_held_from_both_sides_and_a_missing_one_fails() {
        let mut record = record();
        let row = record.errors[0].clone();
        let measure = Measure {
            quantity: row.quantity,
            sample: row.sample,
            norm: row.norm,
            reference: row.reference.clone(),
            time_factor: row.time_factor,
            probe: None,
        };
        let error = row.value.abs();
        let found = |record: &Record, above: f64, below: f64| {
            error_found(&ErrorRange { measure: measure.clone(), above, below }, record)
        };
        assert!(found(&record, 0.9 * error, 1.1 * error).pass);
        assert!(found(&record, error, 1.1 * error).pass, "the lower end belongs to the range");
        let too_good = found(&record, 1.1 * error, 2.0 * error);
        assert!(!too_good.pass && too_good.reason.contains("outside"), "{}", too_good.reason);
        assert!(!found(&record, 0.0, error).pass, "the upper end does not");
        record.errors[0].value = f64::NAN;
        assert!(!found(&record, 0.0, 1e9).pass);
        record.errors.clear();
        assert!(!found(&record, 0.0, 1e9).pass);
    }

    #[test]
    fn a_value_that_is_missing_or_no_number_is_in_no_range() {
        let bounds = Bounds { above: 1.0, below: 2.0 };
        for (found, passes) in [
            (Some(1.0), true),
            (Some(2.0), false),
            (Some(0.9), false),
            (Some(f64::NAN), false),
            (None, false),
        ] {
            assert_eq!(value_found("velocity", found, bounds).pass, passes, "{found:?}");
        }
    }

    #[test]
    fn drifts_are_judged_at_every_output_and_say_on_which_side_they_are() {
        let mut record = record();
        let demand = CaseDemand { solid_drift_below: Some(1e-9), ..CaseDemand::default() };
        assert!(demand.checks(&record)[0].pass);
        record.balance[0].solid_mass_drift = -2e-9;
        let check = demand.checks(&record).remove(0);
        assert!(!check.pass && check.reason.contains("not below"), "{}", check.reason);
        record.balance.clear();
        assert!(!demand.checks(&record)[0].pass, "without a balance there is no drift to pass");
    }
}
