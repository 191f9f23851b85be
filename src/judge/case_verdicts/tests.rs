use super::*;
use crate::campaign::runner::records_of;
use crate::case::{Norm, Quantity, Sample};
use crate::measure::record_checks;
use crate::record::{CriticalStep, ErrorRow, Probe};
use crate::study::expectation::Measure;
use oedometer_problem::outcome::{Failure, FailureKind};

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
        error_check(
            &ErrorRange { measure: measure.clone(), any_places: false, bounds: Bounds { above, below } },
            record,
        )
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
    let expectation = CaseExpectation { selection, demand, tier: crate::case::planned::Tier::Ci, line: 1 };
    let verdicts = |records: &[Record]| -> Vec<(bool, String)> {
        let judged = expectation.judge(records);
        judged.into_iter().map(|one| (one.verdict.pass, one.verdict.reason)).collect()
    };
    let found = verdicts(&records);
    assert!(!found[0].0 && found[0].1.contains("itself has one point set"), "{found:?}");
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
    for (found, passes) in
        [(Some(1.0), true), (Some(2.0), false), (Some(0.9), false), (Some(f64::NAN), false), (None, false)]
    {
        assert_eq!(value_check("velocity", found, bounds).pass, passes, "{found:?}");
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
            observed,
            wave_limit: 2.0,
            drag_limit: 3.0,
            combined_limit: 4.0,
            probes: vec![probe(0.97, fails[0]), probe(1.03, fails[1])],
            ..CriticalStep::default()
        });
        let check = critical_step_check(0.02, &record);
        let ends = fails.map(|fails| if fails { "is unstable at step 90" } else { "runs 100 steps" });
        let told = match observed {
            None => "no step was observed to become unstable".to_owned(),
            Some(step) => format!(
                "observed {:+.2} % off the predicted 1.0000e0 s, 2 % allowed; with 0.97 {}, 1.03 {}",
                100.0 * (step - 1.0),
                ends[0],
                ends[1]
            ),
        };
        assert_eq!((&*check.name, &*check.reason), ("critical step", &*told));
        check.pass
    };
    assert!(passes(Some(1.019), [false, true]) && passes(Some(0.981), [false, true]));
    assert!(!passes(Some(1.021), [false, true]) && !passes(Some(0.979), [false, true]));
    assert!(!passes(Some(1.0), [false, false]), "a larger step runs too");
    assert!(!passes(Some(1.0), [true, true]), "a smaller step fails too");
    assert!(!passes(None, [false, true]) && !passes(Some(f64::NAN), [false, true]));
}

#[test]
fn a_value_under_a_range_from_nothing_on_lies_outside_of_it() {
    let told = |value: f64| value_check("x", Some(value), Bounds { above: 0.0, below: 0.5 }).reason;
    assert_eq!(told(-0.25), "x: -0.25 outside 0 … 0.5");
    assert_eq!(told(0.75), "x: 0.75 not below 0.5");
    assert_eq!(told(0.0), "x: 0 below 0.5");
}

#[test]
fn every_demand_of_a_case_says_in_its_own_words_what_was_found() {
    // What is asked, and what is said of it where it is met and where it is not.
    let words = [
        ("drift of the mass of solids", "2e-9 below 3e-9", "2e-9 not below 2e-9"),
        ("drift of the water", "0.03 below 0.05", "0.03 not below 0.03"),
        ("water over pores, minus one", "0.005 in 0.004 … 0.006", "0.005 outside 0.006 … 0.007"),
        ("water that left, minus s/(n_0 H)", "6e-4 below 0.001", "6e-4 not below 6e-4"),
        ("spurious velocity over the conductivity", "4e-8 below 5e-8", "4e-8 not below 4e-8"),
        ("time factor of the highest pressure", "0.062 in 0.06 … 0.07", "0.062 outside 0.05 … 0.06"),
        ("largest pressure of the water over the load", "1.75 in 1.5 … 2", "1.75 outside 1 … 1.5"),
        ("highest pressure over the load", "0.55 in 0.5 … 0.6", "0.55 not below 0.5"),
    ];
    let within = |above: f64, below: f64| Some(Bounds { above, below });
    let met = CaseDemand {
        solid_drift_below: Some(3e-9),
        water_drift_below: Some(0.05),
        pore_water: within(4e-3, 6e-3),
        water_left_within: Some(1e-3),
        spurious_velocity: within(0.0, 5e-8),
        peak_time_factor: within(0.06, 0.07),
        largest_pressure: within(1.5, 2.0),
        peak_pressure: within(0.5, 0.6),
        ..CaseDemand::default()
    };
    let unmet = CaseDemand {
        solid_drift_below: Some(2e-9),
        water_drift_below: Some(0.03),
        pore_water: within(6e-3, 7e-3),
        water_left_within: Some(6e-4),
        spurious_velocity: within(0.0, 4e-8),
        peak_time_factor: within(0.05, 0.06),
        largest_pressure: within(1.0, 1.5),
        peak_pressure: within(0.0, 0.5),
        ..CaseDemand::default()
    };
    let mut record = records_of(&STUDY.replace("[0.05]", "[0.05, 0.06, 0.07]")).remove(0);
    // A parabola in ln T_v about 0.062, of the height 0.55 of the load.
    for (snapshot, time) in record.snapshots.iter_mut().zip([0.05, 0.06, 0.07_f64]) {
        snapshot.centres.pressure.fill(0.55 - 0.3 * (time / 0.062).ln().powi(2));
    }
    for (balance, share) in record.balance.iter_mut().zip([0.25, -1.0, 0.5_f64]) {
        (balance.solid_mass_drift, balance.water_imbalance) = (2e-9 * share, 3e-2 * share);
        balance.spurious_velocity = Some(4e-8 * share.abs());
        balance.layers = Some(LayerBalance {
            pore_water: 5e-3 * share,
            water_left: 0.1,
            water_left_error: 6e-4 * share,
            water_points: 3,
            largest_pressure: Some(1.75 * share.abs()),
        });
    }
    let told = |demand: &CaseDemand, record: &Record| -> Vec<(bool, String, String)> {
        let checks = demand.checks(record).into_iter();
        checks.map(|check| (check.pass, check.name, check.reason)).collect()
    };
    let row = |pass: bool, name: &str, said: &str| (pass, name.to_owned(), format!("{name}: {said}"));
    assert_eq!(told(&met, &record), words.map(|(name, said, _)| row(true, name, said)));
    assert_eq!(told(&unmet, &record), words.map(|(name, _, said)| row(false, name, said)));
    // One output without water points, wherever it stands, leaves nothing to judge.
    for place in 0..3 {
        let mut other = record.clone();
        other.balance[place].layers = None;
        let found = told(&met, &other);
        for number in [2, 3] {
            assert_eq!(found[number].2, format!("no {} was measured", words[number].0), "{place}");
        }
    }
    for balance in &mut record.balance {
        (balance.layers, balance.spurious_velocity) = (None, None);
    }
    record.snapshots.iter_mut().for_each(|snapshot| snapshot.centres.pressure.fill(0.5));
    let missing: Vec<String> = told(&met, &record).into_iter().skip(2).map(|one| one.2).collect();
    assert_eq!(missing, [2, 3, 4, 5, 6, 7].map(|number| format!("no {} was measured", words[number].0)));
    assert_eq!(critical_step_check(0.1, &record).reason, "the critical step was not searched");
}

#[test]
fn a_judgement_tells_all_that_passed_or_what_failed_alone() {
    let mut record = record();
    let judged = |record: &Record, demand: CaseDemand, records: &[Record]| {
        let selection = crate::study::expectation::Selection::default();
        let tier = crate::case::planned::Tier::Ci;
        let one = CaseExpectation { selection, demand, tier, line: 7 }.judge(records).remove(0);
        assert_eq!((one.line, one.uncertainty), (7, None));
        let class = (one.verdict.classification.class, &*one.verdict.classification.reason);
        assert_eq!(class, (Class::NotEvaluable, "a single case is not a series"));
        assert_eq!(one.verdict.pass, one.verdict.outcome == VerdictOutcome::Passed);
        let subject = if records.is_empty() { "any case".to_owned() } else { record.case.label() };
        assert_eq!(one.subject, subject);
        (one.verdict.outcome, one.verdict.reason)
    };
    let row = record.errors[0].clone();
    let (quantity, sample, norm) = (row.quantity, row.sample, row.norm);
    let (reference, time_factor) = (row.reference, row.time_factor);
    let measure = Measure { quantity, sample, norm, reference, time_factor, probe: None };
    record.errors[0].value = -0.25;
    record.balance[0].solid_mass_drift = 2e-9;
    let demand = |status: &str, below: f64, drift: f64| CaseDemand {
        status: Some(status.to_owned()),
        error: Some(ErrorRange {
            measure: measure.clone(),
            any_places: false,
            bounds: Bounds { above: 0.0, below },
        }),
        solid_drift_below: Some(drift),
        ..CaseDemand::default()
    };
    let error = "pressure l1 points at T_v = 0.05: 0.25";
    let drift = "drift of the mass of solids: 2e-9";
    let (passed, failed) = (VerdictOutcome::Passed, VerdictOutcome::Failed);
    for (status, below, most, outcome, told) in [
        ("ok", 0.3, 1e-8, passed, format!("ok; {error} below 0.3; {drift} below 1e-8")),
        ("ok", 0.2, 1e-8, failed, format!("{error} not below 0.2")),
        ("ok", 0.2, 1e-9, failed, format!("{error} not below 0.2; {drift} not below 1e-9")),
        ("stopped", 0.3, 1e-9, failed, format!("ok instead of stopped; {drift} not below 1e-9")),
    ] {
        let one = std::slice::from_ref(&record);
        assert_eq!(judged(&record, demand(status, below, most), one), (outcome, told));
    }
    assert_eq!(judged(&record, demand("ok", 1.0, 1.0), &[]), (failed, "no case is selected".to_owned()));
    record.errors.clear();
    record.status = crate::record::Status::Failed(Failure {
        kind: FailureKind::Unstable,
        step: 12,
        time: 0.5,
        growth: None,
        reason: "it grew".to_owned(),
    });
    let end = "at step 12, t = 5.0000e-1 s: it grew";
    let absent = "no error at T_v = 0.05";
    for (status, told) in [
        ("ok", format!("unstable instead of ok {end}; {absent}; {drift} not below 1e-9")),
        ("unstable", format!("{absent}; {drift} not below 1e-9")),
    ] {
        let one = std::slice::from_ref(&record);
        assert_eq!(judged(&record, demand(status, 1.0, 1e-9), one), (failed, told));
    }
    let ends = CaseDemand { status: Some("unstable".to_owned()), ..CaseDemand::default() };
    assert_eq!(judged(&record, ends, std::slice::from_ref(&record)), (passed, format!("unstable {end}")));
}

#[test]
fn errors_beside_those_of_one_set_are_told_with_both_numbers() {
    let study = STUDY.replace("cells = [10]", "cells = [3]\nsets = [1, 2]");
    let study = study.replace("\"implicit\"", "\"explicit\"").replace("growth = 0.05", "stable = 0.7");
    let mut records = records_of(&study.replace("[0.05]", "[1e-5]"));
    let row = |quantity: Quantity, value: f64| ErrorRow {
        time_factor: 1e-5,
        quantity,
        sample: Sample::Nodes,
        norm: Norm::Linf,
        reference: "terzaghi".to_owned(),
        value,
        absolute: 0.0,
    };
    let mut told = |own: [f64; 2], of_one: [f64; 2]| {
        for (record, values) in records.iter_mut().zip([of_one, own]) {
            let kinds = [Quantity::Pressure, Quantity::Displacement];
            record.errors = kinds.into_iter().zip(values).map(|(kind, value)| row(kind, value)).collect();
        }
        let check = point_sets_check(1e-9, &records[1], &[&records[0], &records[1]]);
        (check.pass, check.reason)
    };
    let all = "2 errors are those of one point set within";
    assert_eq!(told([0.5, 0.25], [0.5, 0.25]), (true, format!("{all} 0")));
    assert_eq!(told([0.5 + 1e-10, 0.25], [0.5, 0.25 + 5e-10]), (true, format!("{all} 5e-10")));
    assert_eq!(told([0.5 + 5e-10, 0.25], [0.5, 0.25 + 1e-10]), (true, format!("{all} 5e-10")));
    let apart = "displacement linf nodes at T_v = 0.00001: 2.5000100000e-1 with two point sets and \
                 2.5000000000e-1 with one, more than 1e-9 allowed";
    assert_eq!(told([0.5, 0.250_001], [0.5, 0.25]), (false, apart.to_owned()));
    let [one, two] = [0, 1].map(|place| records[place].clone());
    let alone = |record: &Record, records: &[&Record]| point_sets_check(1.0, record, records).reason;
    assert_eq!(alone(&one, &[&one, &two]), "the case itself has one point set");
    assert_eq!(alone(&two, &[&two]), "the study has no such case with one point set");
}
