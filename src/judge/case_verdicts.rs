//! Judges what a study expects of single cases; hard cases are judged by this, not by series.

use crate::judge::error_place::place_in_kept;
use crate::judge::verdict::{BELOW, Check, IN, Judgement, Verdict, VerdictOutcome};
use crate::measure::other_measures::pressure_peak;
use crate::measure::soundness::{complaints, is_sound};
use crate::measure::statistics::{larger, largest};
use crate::record::{Balance, LayerBalance, Record, Status};
use crate::study::expectation::{Bounds, CaseDemand, CaseExpectation, ErrorRange, UNSOUND};
use oedometer_convergence::{Class, Classification};
use oedometer_wording::{rounded, typed};
use std::collections::HashSet;

impl CaseExpectation {
    /// One judgement for each case that it selects; where it selects none, one that fails.
    pub fn judge(&self, records: &[Record]) -> Vec<Judgement> {
        let all: Vec<&Record> = records.iter().collect();
        let judge =
            |record: &Record| self.judgement(record.case.label(), self.demand.all_checks(record, &all));
        let selected = records.iter().filter(|record| self.selection.fits(&record.case));
        let judgements: Vec<Judgement> = selected.map(judge).collect();
        if judgements.is_empty() {
            let check = Check::failed("cases", "no case is selected");
            return vec![self.judgement("any case".to_owned(), vec![check])];
        }
        judgements
    }

    fn judgement(&self, subject: String, checks: Vec<Check>) -> Judgement {
        let pass = checks.iter().all(|check| check.pass);
        let reasons: Vec<&str> =
            checks.iter().filter(|check| pass || !check.pass).map(|check| check.reason.as_str()).collect();
        let classification = Classification::new(Class::NotEvaluable, "a single case is not a series");
        let outcome = if pass { VerdictOutcome::Passed } else { VerdictOutcome::Failed };
        let verdict = Verdict { pass, outcome, reason: reasons.join("; "), classification, checks };
        Judgement { line: self.line, subject, verdict, uncertainty: None }
    }
}

/// Hashes of the records that may be recommended: sound ones that meet every expectation of their cases.
pub fn recommendable<'a>(
    expectations: &[CaseExpectation],
    records: impl IntoIterator<Item = &'a Record>,
) -> HashSet<&'a str> {
    let records: Vec<&Record> = records.into_iter().collect();
    let meets = |record: &Record| {
        let of_case = expectations.iter().filter(|one| one.selection.fits(&record.case));
        of_case.flat_map(|one| one.demand.all_checks(record, &records)).all(|check| check.pass)
    };
    let sound = records.iter().copied().filter(|record| is_sound(record) && meets(record));
    sound.map(|record| record.hash.as_str()).collect()
}

impl CaseDemand {
    /// Every part of the demand, with the comparison of a double-point case with its twin among all records.
    fn all_checks(&self, record: &Record, records: &[&Record]) -> Vec<Check> {
        let mut checks = self.checks(record);
        checks.extend(self.one_set_within.map(|within| point_sets_check(within, record, records)));
        checks
    }

    /// Every part of the demand, judged; comparisons are written so that NaN fails.
    fn checks(&self, record: &Record) -> Vec<Check> {
        let mut checks = Vec::new();
        checks.extend(self.status.as_ref().map(|wanted| status_check(wanted, record)));
        checks.extend(self.critical_step_within.map(|within| critical_step_check(within, record)));
        checks.extend(self.error.as_ref().map(|range| error_check(range, record)));
        let balance = &record.balance;
        let worst = |of: fn(&Balance) -> f64| largest(balance.iter().map(|balance| of(balance).abs()));
        // Only where every output has the balance of two point sets.
        let worst_layer = |of: fn(&LayerBalance) -> f64| {
            let layers = balance.iter().map(|balance| balance.layers.as_ref().map(|one| of(one).abs()));
            layers.reduce(|worst, next| Some(larger(worst?, next?))).flatten()
        };
        let largest_pressure =
            largest(balance.iter().filter_map(|balance| balance.layers.as_ref()?.largest_pressure));
        let peak = pressure_peak(&record.case, &record.snapshots);
        let below = |below: f64| Bounds { above: 0.0, below };
        let ranges = [
            (
                "drift of the mass of solids",
                worst(|balance| balance.solid_mass_drift),
                self.solid_drift_below.map(below),
            ),
            (
                "drift of the water",
                worst(|balance| balance.water_imbalance),
                self.water_drift_below.map(below),
            ),
            ("water over pores, minus one", worst_layer(|one| one.pore_water), self.pore_water),
            (
                "water that left, minus s/(n_0 H)",
                worst_layer(|one| one.water_left_error),
                self.water_left_within.map(below),
            ),
            (
                "spurious velocity over the conductivity",
                largest(balance.iter().filter_map(|balance| balance.spurious_velocity)),
                self.spurious_velocity,
            ),
            ("time factor of the highest pressure", peak.map(|peak| peak.time_factor), self.peak_time_factor),
            ("largest pressure of the water over the load", largest_pressure, self.largest_pressure),
            ("highest pressure over the load", peak.map(|peak| peak.height), self.peak_pressure),
        ];
        let asked = ranges.into_iter().filter_map(|(what, found, bounds)| Some((what, found, bounds?)));
        checks.extend(asked.map(|(what, found, bounds)| value_check(what, found, bounds)));
        checks
    }
}

/// Every error of a double-point case against that of the same case with one point set.
fn point_sets_check(within: f64, record: &Record, records: &[&Record]) -> Check {
    const NAME: &str = "one point set";
    let mut twin = record.case.clone();
    twin.column.points.sets = 1;
    twin.column.points.water_per_cell = 0;
    if twin == record.case {
        return Check::failed(NAME, "the case itself has one point set");
    }
    let Some(one) = records.iter().find(|other| other.case == twin) else {
        return Check::failed(NAME, "the study has no such case with one point set");
    };
    if record.errors.is_empty() || record.errors.len() != one.errors.len() {
        let (two, one) = (record.errors.len(), one.errors.len());
        return Check::failed(NAME, format!("{two} errors with two point sets and {one} with one"));
    }
    let mut worst = 0.0;
    for (two, one) in record.errors.iter().zip(&one.errors) {
        let is_same = (two.quantity, two.sample, two.norm, &two.reference, two.time_factor)
            == (one.quantity, one.sample, one.norm, &one.reference, one.time_factor);
        let difference = (two.value - one.value).abs();
        // Written so that NaN fails.
        if !(is_same && difference <= within) {
            let statement = format!(
                "{} {} {} at T_v = {}: {:.10e} with two point sets and {:.10e} with one,",
                two.quantity.name(),
                two.norm,
                two.sample.name(),
                typed(two.time_factor),
                two.value,
                one.value
            );
            let allowed = format!("{} allowed", rounded(within));
            return Check::compared(NAME, false, difference, &statement, ["", "more than"], &allowed);
        }
        worst = f64::max(worst, difference);
    }
    let statement = format!("{} errors are those of one point set", record.errors.len());
    Check::compared(NAME, true, worst, &statement, ["within", ""], &rounded(worst))
}

fn status_check(wanted: &str, record: &Record) -> Check {
    let complaint =
        if wanted == UNSOUND && record.status == Status::Ok { complaints(record).pop() } else { None };
    if let Some(complaint) = complaint {
        return Check::new("status", true, format!("{UNSOUND}: {complaint}"));
    }
    let found = record.status.name();
    let how = record
        .status
        .failure()
        .map_or_else(String::new, |failure| format!("{}: {}", failure.place(), failure.reason));
    let pass = found == wanted;
    let instead = if pass { String::new() } else { format!(" instead of {wanted}") };
    Check::new("status", pass, format!("{found}{instead}{how}"))
}

fn critical_step_check(within: f64, record: &Record) -> Check {
    const NAME: &str = "critical step";
    let Some(found) = &record.stability else {
        return Check::failed(NAME, "the critical step was not searched");
    };
    if let Some(sentence) = &found.unknown {
        return Check::failed(NAME, sentence);
    }
    let Some(deviation) = found.deviation() else {
        return Check::failed(NAME, "no step was observed to become unstable");
    };
    let probes: Vec<String> = found
        .probes
        .iter()
        .map(|probe| match &probe.failure {
            None => format!("{} runs {} steps", probe.share, probe.steps),
            Some(failure) => format!("{} is {} at step {}", probe.share, failure.kind.name(), failure.step),
        })
        .collect();
    // Of a difference below the resolution of the search no more is known.
    let is_resolved = found.within().is_none_or(|resolution| resolution <= within);
    let pass = deviation.abs() <= within && is_resolved && found.probes_agree();
    let off = match found.within() {
        Some(resolution) => format!("within {:.2} % of", 100.0 * resolution),
        None => format!("{:+.2} % off", 100.0 * deviation),
    };
    let statement =
        format!("observed {off} the predicted {:.4e} s, {} % allowed;", found.predicted, 100.0 * within);
    Check::compared(NAME, pass, deviation, &statement, ["with", "with"], &probes.join(", "))
}

fn error_check(range: &ErrorRange, record: &Record) -> Check {
    let own = if range.any_places { range.measure.at_places_of(record) } else { range.measure.clone() };
    let measure = &own;
    let time = typed(measure.time_factor);
    let Some(row) = measure.error(record) else {
        let why = measure
            .elsewhere(record)
            .or_else(|| measure.unjudged(record))
            .map_or(String::new(), |why| format!(": {why}"));
        return Check::failed("error", format!("no error at T_v = {time}{why}"));
    };
    let (quantity, sample) = (measure.quantity.name(), measure.sample.name());
    let what = format!("{quantity} {} {sample} at T_v = {time}", measure.norm);
    let found = value_check(&what, Some(row.value.abs()), range.bounds);
    let mut check = Check { name: "error".to_owned(), ..found };
    if let Some(place) = place_in_kept(record, row).filter(|_| !check.pass) {
        check.reason = format!("{}; {place}", check.reason);
    }
    check
}

/// A value in a range whose lower end belongs to it.
fn value_check(what: &str, found: Option<f64>, Bounds { above, below }: Bounds) -> Check {
    let Some(value) = found else {
        return Check::failed(what, format!("no {what} was measured"));
    };
    let pass = value < below && value >= above;
    let statement = format!("{what}: {}", rounded(value));
    if above == 0.0 && (value.is_nan() || value >= 0.0) {
        return Check::compared(what, pass, value, &statement, BELOW, &rounded(below));
    }
    if below == f64::MAX {
        return Check::compared(what, pass, value, &statement, ["at least", "less than"], &rounded(above));
    }
    Check::compared(what, pass, value, &statement, IN, &format!("{} … {}", rounded(above), rounded(below)))
}

#[cfg(test)]
mod tests;
