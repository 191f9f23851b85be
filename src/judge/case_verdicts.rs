//! Judges what a study expects of single cases; hard cases are judged by this, not by series.

use crate::judge::explanation::place_of_attached;
use crate::judge::verdict::{BELOW, Check, IN, Judgement, Verdict, VerdictOutcome};
use crate::measure::other_measures::pressure_peak;
use crate::measure::statistics::{larger, largest};
use crate::record::{Balance, LayerBalance, Record};
use crate::study::expectation::{Bounds, CaseDemand, CaseExpectation, ErrorRange};
use oedometer_convergence::{Class, Classification};
use oedometer_soil::wording::{short, typed};

impl CaseExpectation {
    /// One judgement for each case that it selects; where it selects none, one that fails.
    pub fn judge(&self, records: &[Record]) -> Vec<Judgement> {
        let judge = |record: &Record| {
            let mut checks = self.demand.checks(record);
            let within = self.demand.one_set_within;
            checks.extend(within.map(|within| one_set_found(within, record, records)));
            self.judgement(record.case.label(), checks)
        };
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
        let told: Vec<&str> =
            checks.iter().filter(|check| pass || !check.pass).map(|check| check.reason.as_str()).collect();
        let classification = Classification::new(Class::NotEvaluable, "a single case is not a series");
        let outcome = if pass { VerdictOutcome::Passed } else { VerdictOutcome::Failed };
        let verdict = Verdict { pass, outcome, reason: told.join("; "), classification, checks };
        Judgement { line: self.line, subject, verdict, uncertainty: None }
    }
}

impl CaseDemand {
    /// Every part of the demand, judged; comparisons are written so that NaN fails.
    fn checks(&self, record: &Record) -> Vec<Check> {
        let mut checks = Vec::new();
        checks.extend(self.status.as_ref().map(|wanted| status_found(wanted, record)));
        checks.extend(self.critical_step_within.map(|within| critical_step_found(within, record)));
        checks.extend(self.error.as_ref().map(|range| error_found(range, record)));
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
            ("water over pores, less one", worst_layer(|one| one.pore_water), self.pore_water),
            (
                "water that left, less s/(n_0 H)",
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
        checks.extend(asked.map(|(what, found, bounds)| value_found(what, found, bounds)));
        checks
    }
}

/// Every error of a double-point case against that of the same case with one point set.
fn one_set_found(within: f64, record: &Record, records: &[Record]) -> Check {
    const NAME: &str = "one point set";
    let mut twin = record.case.clone();
    twin.column.points.sets = 1;
    twin.column.points.water_per_cell = 0;
    if twin == record.case {
        return Check::failed(NAME, "the case has one point set itself");
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
            let told = format!(
                "{} {} {} at T_v = {}: {:.10e} with two point sets and {:.10e} with one,",
                two.quantity.name(),
                two.norm,
                two.sample.name(),
                typed(two.time_factor),
                two.value,
                one.value
            );
            let allowed = format!("{} allowed", short(within));
            return Check::compared(NAME, false, difference, &told, ["", "more than"], &allowed);
        }
        worst = f64::max(worst, difference);
    }
    let told = format!("{} errors are those of one point set", record.errors.len());
    Check::compared(NAME, true, worst, &told, ["within", ""], &short(worst))
}

fn status_found(wanted: &str, record: &Record) -> Check {
    let found = record.status.name();
    let how = record
        .status
        .failure()
        .map_or_else(String::new, |failure| format!("{}: {}", failure.place(), failure.reason));
    let pass = found == wanted;
    let instead = if pass { String::new() } else { format!(" instead of {wanted}") };
    Check { name: "status".to_owned(), pass, measured: None, reason: format!("{found}{instead}{how}") }
}

fn critical_step_found(within: f64, record: &Record) -> Check {
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
    let pass = deviation.abs() <= within && found.probes_agree();
    let told = format!(
        "observed {:+.2} % off the predicted {:.4e} s, {} % allowed;",
        100.0 * deviation,
        found.predicted,
        100.0 * within
    );
    Check::compared(NAME, pass, deviation, &told, ["with", "with"], &probes.join(", "))
}

fn error_found(range: &ErrorRange, record: &Record) -> Check {
    let measure = &range.measure;
    let time = typed(measure.time_factor);
    let Some(row) = measure.error(record) else {
        return Check::failed("error", format!("no error at T_v = {time}"));
    };
    let (quantity, sample) = (measure.quantity.name(), measure.sample.name());
    let what = format!("{quantity} {} {sample} at T_v = {time}", measure.norm);
    let found = value_found(&what, Some(row.value.abs()), range.bounds);
    let mut check = Check { name: "error".to_owned(), ..found };
    if let Some(place) = place_of_attached(record, row).filter(|_| !check.pass) {
        check.reason = format!("{}; {place}", check.reason);
    }
    check
}

/// A value in a range whose lower end belongs to it.
fn value_found(what: &str, found: Option<f64>, Bounds { above, below }: Bounds) -> Check {
    let Some(value) = found else {
        return Check::failed(what, format!("no {what} was measured"));
    };
    let pass = value < below && value >= above;
    let told = format!("{what}: {}", short(value));
    if above == 0.0 {
        return Check::compared(what, pass, value, &told, BELOW, &short(below));
    }
    Check::compared(what, pass, value, &told, IN, &format!("{} … {}", short(above), short(below)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::measure::record_checks;
    use crate::record::{CriticalStep, ErrorRow, Probe};
    use crate::study::expectation::Measure;
    use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

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
            error_found(&ErrorRange { measure: measure.clone(), bounds: Bounds { above, below } }, record)
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
    fn double_point_cases_are_compared_with_one_set_and_their_water_with_its_pores() {
        let study = STUDY.replace("cells = [10]", "cells = [3]\nsets = [1, 2]");
        let study = study.replace("\"implicit\"", "\"explicit\"").replace("growth = 0.05", "stable = 0.7");
        let study = study.replace("[0.05]", "[1e-5]");
        let mut records = records_of(&study);
        let demand = CaseDemand { one_set_within: Some(1e-9), ..CaseDemand::default() };
        let selection = crate::study::expectation::Selection::default();
        let expectation =
            CaseExpectation { selection, demand, tier: crate::case::planned::Tier::Ci, line: 1 };
        let verdicts = |records: &[Record]| -> Vec<(bool, String)> {
            let judged = expectation.judge(records);
            judged.into_iter().map(|one| (one.verdict.pass, one.verdict.reason)).collect()
        };
        let found = verdicts(&records);
        assert!(!found[0].0 && found[0].1.contains("one point set itself"), "{found:?}");
        assert!(found[1].0 && found[1].1.contains("are those of one point set"), "{found:?}");
        // A run that ended early has fewer errors, on either side; and no errors agree with nothing.
        let all = records[0].errors.len();
        for (one, two) in [(all, all - 1), (all - 1, all), (all, 1), (1, all), (all, 0), (0, all), (0, 0)] {
            let mut cut = records.clone();
            cut[0].errors.truncate(one);
            cut[1].errors.truncate(two);
            let found = verdicts(&cut);
            let told = format!("{two} errors with two point sets and {one} with one");
            assert!(!found[1].0 && found[1].1.contains(&told), "{found:?}");
        }
        // As large an error of something else is no such error, and one that is off is found wherever it stands.
        for place in [0, all / 2, all - 1] {
            let changes: [fn(&mut ErrorRow); 4] = [
                |row| row.time_factor *= 2.0,
                |row| row.reference = "another".to_owned(),
                |row| row.value += 2e-9,
                |row| row.value -= 2e-9,
            ];
            for (number, change) in changes.into_iter().enumerate() {
                for side in 0..2 {
                    let mut other = records.clone();
                    change(&mut other[side].errors[place]);
                    assert!(!verdicts(&other)[1].0, "change {number} of error {place} on side {side}");
                }
            }
        }
        records[1].errors[3].value += 2e-9;
        let found = verdicts(&records);
        assert!(!found[1].0 && found[1].1.contains("1e-9 allowed"), "{found:?}");
        records[1].errors[3].value = f64::NAN;
        assert!(!verdicts(&records)[1].0);
        records.remove(0);
        assert!(verdicts(&records)[0].1.contains("no such case with one point set"));
        // Nothing moves here, so there is nothing to hold; and what is not as it must be fails.
        let demand = CaseDemand {
            pore_water: Some(Bounds { above: 1e-3, below: 2e-3 }),
            water_left_within: Some(1e-3),
            ..CaseDemand::default()
        };
        assert!(demand.checks(&records[0]).iter().all(|check| !check.pass));
        for (pore_water, water_left_error, passes) in
            [(-1.5e-3, -5e-4, [true, true]), (5e-4, 2e-3, [false, false]), (f64::NAN, f64::NAN, [false; 2])]
        {
            let layers = LayerBalance {
                pore_water,
                water_left: 0.1,
                water_left_error,
                water_points: 3,
                largest_pressure: Some(1.0),
            };
            records[0].balance[0].layers = Some(layers);
            let found: Vec<bool> = demand.checks(&records[0]).iter().map(|check| check.pass).collect();
            assert_eq!(found, passes, "{pore_water}");
        }
        // A burst between outputs is a failed check of the run by that name, and may be asked for.
        let demand =
            CaseDemand { largest_pressure: Some(Bounds { above: 1.5, below: 9.0 }), ..CaseDemand::default() };
        for (largest_pressure, is_burst) in [(1.01, false), (1.6, true), (f64::NAN, true)] {
            let layers = records[0].balance[0].layers.as_mut().expect("layers");
            (layers.pore_water, layers.water_left_error) = (0.0, 0.0);
            layers.largest_pressure = Some(largest_pressure);
            let said = record_checks::complaints(&records[0]);
            assert_eq!(said.iter().any(|one| one.contains("burst")), is_burst, "{said:?}");
            let asked = demand.checks(&records[0])[0].pass;
            assert_eq!(asked, largest_pressure == 1.6);
        }
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

    #[test]
    fn a_critical_step_is_met_where_it_is_near_and_both_probes_end_as_predicted() {
        let probe = |share: f64, fails: bool| Probe {
            share,
            step: share,
            predicted_growth: None,
            steps: 100,
            reaches_end: false,
            failure: fails.then(|| Failure {
                kind: FailureKind::Unstable,
                step: 90,
                time: 90.0,
                growth: None,
                reason: "it grew".to_owned(),
            }),
        };
        let passes = |observed: Option<f64>, fails: [bool; 2]| {
            let mut record = record();
            record.stability = Some(CriticalStep {
                predicted: 1.0,
                creeping_from: None,
                observed,
                wave_limit: 2.0,
                drag_limit: 3.0,
                combined_limit: 4.0,
                unknown: None,
                probes: vec![probe(0.97, fails[0]), probe(1.03, fails[1])],
                asymmetry: None,
            });
            critical_step_found(0.02, &record).pass
        };
        assert!(passes(Some(1.019), [false, true]) && passes(Some(0.981), [false, true]));
        assert!(!passes(Some(1.021), [false, true]) && !passes(Some(0.979), [false, true]));
        assert!(!passes(Some(1.0), [false, false]), "a larger step runs too");
        assert!(!passes(Some(1.0), [true, true]), "a smaller step fails too");
        assert!(!passes(None, [false, true]) && !passes(Some(f64::NAN), [false, true]));
    }
}
