//! The worst, the best and the largest over outputs, runs, meshes and studies: hand-made records in which one value stands
//! out, first, in the middle and last. Wherever it stands the answer is the same.

use crate::campaign::runner::records_of;
use crate::campaign::shares::balance_of;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::case::quantity::{Quantity, Sample};
use crate::golden::GoldenError;
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::judge::verdict::{Beside, Verdict, judge};
use crate::measure::record_checks::worst_of;
use crate::measure::soundness;
use crate::questions::paper::largest_pressure_error;
use crate::questions::work_precision::{WorkPrecision, worst_error};
use crate::record::{Balance, LayerBalance, Record, Status};
use crate::render::table::Cell;
use crate::report::tables::measures::checks_table;
use crate::study::check::Study;
use crate::study::expectation::{Bounds, CaseDemand, CaseExpectation, Selection};
use crate::study::file::StudySource;
use oedometer_convergence::{ErrorBound, ErrorSeries, SeriesDemand};
use oedometer_problem::outcome::{Failure, FailureKind};

fn table_of_checks(record: &Record) -> Vec<Vec<Cell>> {
    checks_table(record).rows
}

const REFERENCE: &str = "terzaghi";

fn text(sweep: &str, tail: &str) -> String {
    format!(
        "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.1, 0.2]\n[[sweep]]\n\
         method = ['GC-SRI-patch']\nintegrator = ['implicit']\ntime_step = [{{ growth = 0.3 }}]\n{sweep}\n{tail}\n"
    )
}

fn study_of(text: &str) -> Study {
    let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
    Study::check(&source).expect("a sound study")
}

/// Three outputs, each with a double-point balance without errors.
fn calm() -> Record {
    let mut record = records_of(&text("cells = [4]", "")).remove(0);
    let layers = LayerBalance {
        pore_water: 1e-6,
        water_left: 0.1,
        water_left_error: 1e-6,
        water_points: 3,
        largest_pressure: Some(0.9),
    };
    for balance in &mut record.balance {
        balance.layers = Some(layers);
        balance.spurious_velocity = Some(1e-12);
    }
    assert_eq!((record.balance.len(), soundness::complaints(&record)), (3, Vec::new()));
    record
}

/// The errors of the pressure at the points at the outputs.
fn with_pressures(record: &mut Record, errors: [f64; 3]) {
    let mut errors = errors.into_iter();
    for row in &mut record.errors {
        if (row.quantity, row.sample, &*row.reference) == (Quantity::Pressure, Sample::Points, REFERENCE)
            && row.norm == crate::case::quantity::Norm::L2
        {
            row.value = errors.next().expect("three outputs");
        }
    }
    assert_eq!(errors.next(), None);
}

fn judged(demand: &CaseDemand, record: &Record) -> Verdict {
    let expectation =
        CaseExpectation { selection: Selection::default(), demand: demand.clone(), tier: Tier::Ci, line: 1 };
    expectation.judge(std::slice::from_ref(record)).remove(0).verdict
}

type Set = fn(&mut Balance, f64);

#[test]
fn a_drift_or_a_burst_at_any_output_fails_and_is_told() {
    let bounds = Some(Bounds { above: 0.0, below: 1e-3 });
    let demands: [(CaseDemand, Set); 6] = [
        (CaseDemand { solid_drift_below: Some(1e-3), ..CaseDemand::default() }, |one, to| {
            one.solid_mass_drift = to;
        }),
        (CaseDemand { water_drift_below: Some(1e-3), ..CaseDemand::default() }, |one, to| {
            one.water_imbalance = to;
        }),
        (CaseDemand { spurious_velocity: bounds, ..CaseDemand::default() }, |one, to| {
            one.spurious_velocity = Some(to);
        }),
        (CaseDemand { pore_water: bounds, ..CaseDemand::default() }, |one, to| {
            one.layers.as_mut().expect("layers").pore_water = to;
        }),
        (CaseDemand { water_left_within: Some(1e-3), ..CaseDemand::default() }, |one, to| {
            one.layers.as_mut().expect("layers").water_left_error = to;
        }),
        (CaseDemand { largest_pressure: bounds, ..CaseDemand::default() }, |one, to| {
            one.layers.as_mut().expect("layers").largest_pressure = Some(to);
        }),
    ];
    for (number, (demand, set)) in demands.iter().enumerate() {
        let mut record = calm();
        record.balance.iter_mut().for_each(|balance| set(balance, 1e-5));
        assert!(judged(demand, &record).pass, "{number}");
        for place in 0..3 {
            for worst in [2.0, f64::NAN] {
                let mut record = record.clone();
                set(&mut record.balance[place], worst);
                let verdict = judged(demand, &record);
                assert!(!verdict.pass, "{number}: {worst} at output {place}: {}", verdict.reason);
                assert_eq!(verdict.checks[0].measured, Some(worst).filter(|worst| worst.is_finite()));
                if number != 2 || worst.is_nan() {
                    assert!(
                        !soundness::complaints(&record).is_empty(),
                        "{number}: {worst} at output {place}"
                    );
                }
            }
        }
    }
}

#[test]
fn tables_of_checks_show_the_worst_of_all_outputs_and_runs() {
    let burst = |place: usize| {
        let mut record = calm();
        record.balance[place].layers.as_mut().expect("layers").largest_pressure = Some(7.25);
        record.balance[place].water_imbalance = -0.5;
        record
    };
    let value = |records: &[Record], part: &str| {
        let worst = worst_of(records);
        worst.iter().find(|check| check.what.contains(part)).expect("a check").value
    };
    let rows = table_of_checks(&burst(2));
    for place in 0..3 {
        assert_eq!(table_of_checks(&burst(place)), rows, "at output {place}");
        let mut records = [calm(), calm(), calm()];
        records[place] = burst(1);
        assert_eq!((value(&records, "burst"), value(&records, "water-mass")), (7.25, -0.5), "run {place}");
    }
}

#[test]
fn an_error_counts_at_whatever_output_it_is_worst() {
    for place in 0..3 {
        let mut record = calm();
        let mut errors = [1e-3, -2e-3, 3e-3];
        errors[place] = -0.5;
        with_pressures(&mut record, errors);
        assert_eq!(worst_error(&record, REFERENCE), Some(0.5));
        assert_eq!(largest_pressure_error(&record, REFERENCE), Some((0.5, [0.05, 0.1, 0.2][place])));
        errors[place] = f64::NAN;
        with_pressures(&mut record, errors);
        assert!(worst_error(&record, REFERENCE).is_some_and(f64::is_nan), "{errors:?}");
    }
}

#[test]
fn the_cheapest_is_chosen_by_the_worst_of_all_outputs() {
    let soils = "cells = [4, 8]\nhydraulic_conductivity = [1e-5, 1e-3]\nyoungs_modulus = [1e6, 1e7]";
    let all = records_of(&text(soils, ""));
    for place in 0..3 {
        let mut records = all.clone();
        for record in &mut records {
            // Four cells cost less, and are off at one output alone.
            let mut errors = [1e-3; 3];
            if record.case.cells == 4 {
                errors[place] = 0.5;
            }
            with_pressures(record, errors);
        }
        for _ in 0..2 {
            let precision = WorkPrecision::of(&records, REFERENCE, &[]).expect("runs");
            let cheapest = precision.cheapest[0].run.as_ref().expect("within a percent");
            assert_eq!((cheapest.record.case.cells, cheapest.error), (8, 1e-3), "output {place}");
            records.reverse();
        }
    }
}

#[test]
fn a_spread_is_that_of_all_levels_and_a_share_the_largest() {
    let spread = SeriesDemand {
        spread: Some(ErrorBound { size: 1.0, below: 0.5, above: 0.0 }),
        ..SeriesDemand::default()
    };
    let all = records_of(&text("cells = [4, 8, 64]", ""));
    let cases: Vec<&Case> = all.iter().map(|record| &record.case).collect();
    let longest = crate::case::work_estimate::estimated_seconds(cases[2]);
    for place in 0..4 {
        let mut errors = [1.0, 1.1, 1.05, 1.02];
        errors[place] = 4.0;
        let series = ErrorSeries::from_pairs(&[
            (1.0, errors[0]),
            (0.5, errors[1]),
            (0.25, errors[2]),
            (0.125, errors[3]),
        ]);
        let verdict = judge(&spread, &series, &oedometer_convergence::Context::default(), &Beside::default());
        let check = verdict.checks.iter().find(|check| check.name == "spread").expect("asked for");
        let least = if place == 0 { 1.02 } else { 1.0 };
        assert!(!check.pass && check.measured == Some(4.0 / least - 1.0), "{check:?}");
        let mut turned = cases.clone();
        turned.rotate_left(place % 3);
        let balance = balance_of(&turned, &[0, 1, 2], 3);
        assert_eq!((balance.largest, balance.longest_case), (longest, longest));
    }
}

#[test]
fn one_bad_run_of_a_sweep_fails_its_study_wherever_it_stands() {
    let asked = text("cells = [4]\nporosity = [0.3, 0.35, 0.4]", "[[expect_case]]\nsolid_drift_below = 1e-9");
    let study = study_of(&asked);
    let all = records_of(&asked);
    let check = |records: &[Record]| {
        StudyCheck::new(&study, records, Tier::Full, Err(GoldenError::Missing("s.csv".into())))
    };
    assert_eq!(check(&all).end(), CheckEnd::Golden);
    for place in 0..3 {
        let label = all[place].case.label();
        let mut records = all.clone();
        records[place].balance[1].settlement_curve_gap = 0.5;
        let found = check(&records);
        assert_eq!((found.end(), found.unsound.len(), &found.unsound[0].case), (CheckEnd::Failed, 1, &label));
        let mut records = all.clone();
        let (kind, reason) = (FailureKind::Unstable, "a test".to_owned());
        records[place].status = Status::Failed(Failure { kind, step: 1, time: 1.0, growth: None, reason });
        let found = check(&records);
        assert_eq!((found.end(), &found.failed_cases[0].case), (CheckEnd::CaseFailed, &label));
        let mut records = all.clone();
        records[place].balance[2].solid_mass_drift = f64::NAN;
        let found = check(&records);
        let failed: Vec<usize> = (0..3).filter(|number| !found.judgements[*number].verdict.pass).collect();
        assert_eq!((found.end(), failed), (CheckEnd::Failed, vec![place]));
    }
}
