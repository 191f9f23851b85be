//! What no result may be, and no run may do: beyond what its scene can reach, out of balance, held
//! against a theory that leaves out what rules, or without an end.

use crate::program::call;
use oedometer::{
    FailureKind, Kernel, Quantity, Record, RunOptions, Sample, Status, Study, StudyResults, StudySource,
    Tier, balance_checks, measures, render_markdown, run_case, run_study, soundness, start_checks,
    study_page,
};
use oedometer_soil::material::Material;
use std::path::Path;
use std::time::{Duration, Instant};

fn study(text: &str) -> Study {
    let source =
        StudySource { name: "impossible.toml".to_owned(), text: format!("title = 'impossible'\n{text}") };
    Study::check(&source).expect("a sound study")
}

/// The record of a study with one case.
fn record(text: &str) -> Record {
    let study = study(text);
    let case = &study.planned[0].case;
    run_case(case, &study.references, Kernel::Fastest, false, &|_, _| true).expect("a possible column")
}

fn failure(record: &Record) -> Option<(FailureKind, &str)> {
    match &record.status {
        Status::Ok => None,
        Status::Failed(failure) => Some((failure.kind, &failure.reason)),
    }
}

#[test]
fn steps_beyond_the_limit_are_unstable_long_before_they_are_beyond_all_numbers() {
    let semi_implicit = |share: f64| {
        record(&format!(
            "scene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
             integrator = ['semi-implicit']\ncells = [10]\ntime_step = [{{ stable = {share} }}]"
        ))
    };
    // 14 steps at 1.43 of the limit end at a settlement of 144 times the final one.
    let beyond = semi_implicit(1.5);
    let (kind, reason) = failure(&beyond).expect("beyond its limit");
    assert_eq!(kind, FailureKind::Unstable);
    assert!(reason.contains("beyond what the problem can reach") && reason.contains("1.42"), "{reason}");
    assert!(beyond.errors.is_empty(), "no error is told of what is no result");
    assert_eq!(failure(&semi_implicit(0.1)), None);
    let undamped = record(
        "scene = 'standing-wave'\nintegrator.scheme = 'leapfrog'\noutput.time_factors = [1e-4]\n[[sweep]]\n\
         method = ['GC-SRI-patch']\ncells = [10]\ntime_step = [{ courant = 0.5 }]",
    );
    assert_eq!(failure(&undamped), None, "waves swing as far as waves do");
}

#[test]
fn a_layer_that_locks_reaches_its_end() {
    // An undrained start with pressures of many times the load is what such studies are about.
    let locked = record(
        "scene = 'cosine-layer'\nmaterial.water_bulk_modulus = 1e12\noutput.time_factors = [0]\n[[sweep]]\n\
         method = ['GIMP']\ncells = [8]",
    );
    assert_eq!(failure(&locked), None);
    let largest = locked.snapshots[0].points.pressure.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    assert!(largest > 5.0, "{largest}: a column would be ended");
}

#[test]
fn tolerance_steps_cross_a_layer_and_more_of_them_err_less() {
    let to = |rule: &str| {
        record(&format!(
            "scene = 'cosine-layer'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
             integrator = ['implicit']\ncells = [4]\ntime_step = [{{ {rule} }}]"
        ))
    };
    let settlement = |record: &Record| {
        assert_eq!(failure(record), None);
        record.snapshots[0].settlement
    };
    let exact_in_time = settlement(&to("growth = 0.002"));
    let runs = ["tolerance = 1e-2", "tolerance = 1e-3", "tolerance = 1e-4"].map(to);
    let errors = [0, 1, 2].map(|run| (settlement(&runs[run]) / exact_in_time - 1.0).abs());
    for (coarse, fine) in [(0, 1), (1, 2)] {
        let ratio = runs[fine].counters.steps as f64 / runs[coarse].counters.steps as f64;
        // The estimate is of second order in the step: ten times less is 3.2 times the steps.
        assert!((2.0..4.5).contains(&ratio), "{ratio} times the steps");
        assert!(errors[fine] < 0.5 * errors[coarse], "{errors:?}");
    }
}

/// A record of each kind of scene that its checks can hold, or not.
fn sound_records() -> [Record; 2] {
    let method = "[[sweep]]\nmethod = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [6]";
    ["terzaghi", "cosine-layer"]
        .map(|scene| record(&format!("scene = '{scene}'\noutput.time_factors = [0.05, 0.2]\n{method}")))
}

#[test]
fn every_check_that_shows_a_mark_can_fail_and_spoils_the_record() {
    for sound in sound_records() {
        assert_eq!(soundness::complaints(&sound), Vec::<String>::new());
        let count = start_checks(&sound).iter().chain(&balance_checks(&sound, &sound.balance[1])).count();
        assert_eq!(count, 10);
        let spoilt: [fn(&mut Record); 11] = [
            |one| one.step_sizes.growth = Some(2.1),
            |one| one.step_sizes.growth = Some(f64::NAN),
            |one| one.start.iter_mut().for_each(|start| start.points -= 1),
            |one| one.start.iter_mut().for_each(|start| start.volume_error = 1e-6),
            |one| one.start.iter_mut().for_each(|start| start.undrained_pressure_error = 1e-6),
            |one| one.start.iter_mut().for_each(|start| start.unbalanced_force = 1e-3),
            |one| one.balance[1].solid_mass_drift = f64::NAN,
            |one| one.balance[1].water_imbalance = -1e-3,
            |one| one.balance[1].internal_force_imbalance = 1e-6,
            |one| one.balance[1].settlement_curve_gap = 0.01,
            |one| one.snapshots[1].points.pressure[3] = -1e3 * one.case.column.load,
        ];
        for (index, spoil) in spoilt.into_iter().enumerate() {
            let mut one = sound.clone();
            spoil(&mut one);
            assert_eq!(soundness::complaints(&one).len(), 1, "{index}");
            let table = measures::checks_table(&one).to_text(200).expect("a table");
            assert_eq!(table.matches("  ✗").count(), 1, "{index}: {table}");
        }
    }
}

#[test]
fn a_layer_balances_its_water_to_round_off_and_a_column_to_its_storage() {
    let [column, layer] = sound_records();
    for balance in &layer.balance {
        assert!(balance.water_imbalance.abs() < 1e-12, "{balance:?}");
    }
    for balance in &column.balance {
        // What a patch misplaces is a part of the water's own storage, 1.6e-4 here.
        let imbalance = balance.water_imbalance.abs();
        assert!(imbalance > 1e-8 && imbalance < 1.6e-5, "{balance:?}");
    }
}

#[test]
fn a_check_that_fails_stands_at_the_head_of_the_report() {
    let text = "scene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                integrator = ['implicit']\ncells = [4]";
    let (study, mut records) = (study(text), vec![record(text)]);
    let page = |records: &[Record]| {
        let results = StudyResults::new(&study, records, Tier::Full);
        let page = study_page(&results, &[]).expect("a page");
        render_markdown(&page).expect("Markdown")
    };
    assert!(!page(&records).contains('✗'));
    records[0].balance[0].water_imbalance = 0.3;
    let told = page(&records);
    assert!(told.contains("✗ GC-SRI-patch implicit"), "{told}");
}

#[test]
fn no_error_is_held_against_a_theory_that_leaves_out_what_rules() {
    let of = |scene: &str, integrator: &str, conductivity: f64| {
        record(&format!(
            "scene = '{scene}'\nmaterial.hydraulic_conductivity = {conductivity:e}\n\
             output.time_factors = [0.001]\n[[sweep]]\nmethod = ['GC-SRI-patch']\nintegrator = ['{integrator}']\ncells = [4]"
        ))
    };
    let ruled = of("terzaghi", "explicit", 9.9);
    assert_eq!(failure(&ruled), None);
    assert!(ruled.errors.is_empty());
    let reasons: Vec<&str> =
        ruled.references.iter().filter_map(|reference| reference.does_not_hold.as_deref()).collect();
    assert_eq!(reasons.len(), 2);
    assert!(reasons[0].starts_with("`terzaghi` is quasi-static and does not apply"), "{reasons:?}");
    assert_eq!(soundness::complaints(&ruled).len(), 2);
    // Without inertia in the equations it cannot rule, and a scene of waves is about it.
    for holds in [
        of("terzaghi", "implicit", 9.9),
        of("dynamic-column", "explicit", 9.9),
        of("terzaghi", "explicit", 1e-3),
    ] {
        assert!(holds.references.iter().all(|reference| reference.does_not_hold.is_none()));
        let pressure =
            |row: &&oedometer::ErrorRow| row.quantity == Quantity::Pressure && row.sample == Sample::Points;
        assert!(holds.errors.iter().any(|row| pressure(&row)));
    }
}

#[test]
fn beyond_the_bound_of_inertia_theory_is_off_by_thousandths() {
    // Terzaghi's settlement against that of the column with its inertia, both exact.
    use oedometer::exact::ColumnParameters;
    use oedometer::exact::reference::{Reference, ReferenceKind};
    let gap = |conductivity: f64| {
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity: conductivity, ..Material::default() },
            ..ColumnParameters::default()
        };
        let settlement = |kind| {
            let reference = Reference::new(kind, &column, &[0.05]).expect("the seed column");
            reference.settlement(0.05).expect("a settlement")
        };
        (settlement(ReferenceKind::Terzaghi) / settlement(ReferenceKind::DynamicColumn) - 1.0).abs()
    };
    // The rate changes by 1.1e-3 at k = 3.2e-3 m/s and with the square of k.
    let (at_the_bound, below) = (gap(3.2e-3), gap(1e-3));
    assert!((1e-3..4e-3).contains(&at_the_bound), "{at_the_bound}");
    assert!((at_the_bound / below / 3.2_f64.powi(2) - 1.0).abs() < 0.1, "{below}");
}

#[test]
fn numbers_that_no_run_can_go_on_from_are_refused_by_every_integrator() {
    for integrator in ["explicit", "semi-implicit", "implicit"] {
        for (set, said) in [
            ("material.hydraulic_conductivity=5e-324", "coefficient of consolidation"),
            ("material.hydraulic_conductivity=1e-310", "the critical time step"),
            ("material.water_bulk_modulus=1e308", "Biot modulus"),
            ("material.youngs_modulus=1e308", "final settlement"),
            ("column.height=1e300", "time at a time factor of 1"),
            ("column.load=5e-324", "the load must be positive and finite, got 5e-324"),
        ] {
            let start = Instant::now();
            let told = call(
                Path::new("."),
                &[
                    "solve",
                    "terzaghi",
                    "--integrator",
                    integrator,
                    "--cells",
                    "4",
                    "--time-factor",
                    "0.01",
                    "--set",
                    set,
                ],
            );
            assert_eq!(told.code, 2, "{integrator} {set}: {}", told.err);
            let or_time = told.err.contains("time at a time factor of 1");
            assert!(told.err.contains(said) || or_time, "{integrator} {set}: {}", told.err);
            assert!(told.err.lines().all(|line| line.len() < 300), "{}", told.err);
            assert!(start.elapsed() < Duration::from_secs(60));
        }
    }
}

#[test]
fn times_and_rules_at_the_edge_of_the_numbers_are_refused_or_end_at_the_deadline() {
    for integrator in ["explicit", "semi-implicit", "implicit"] {
        let solve = |more: &[&str]| {
            let first = [
                "solve",
                "terzaghi",
                "--integrator",
                integrator,
                "--cells",
                "4",
                "--set",
                "case_seconds=0.2",
            ];
            call(Path::new("."), &[&first[..], more].concat())
        };
        for (factors, said) in [
            ("5e-324,0.1", "0, or 1e-15 and later"),
            ("1e-300,0.1", "0, or 1e-15 and later"),
            ("1e-16", "0, or 1e-15 and later"),
            ("101", "lies between 0 and 100"),
            ("1e308", "lies between 0 and 100"),
        ] {
            let told = solve(&["--time-factor", factors]);
            assert_eq!(told.code, 2, "{factors}: {}", told.err);
            assert!(told.err.contains(said), "{}", told.err);
        }
        for rule in ["stable=1e-300", "courant=5e-324", "growth=1e-300", "tolerance=1e-300"] {
            let told = solve(&["--time-factor", "0.1", "--time-step", rule]);
            assert_eq!(told.code, 2, "{rule}: {}", told.err);
        }
        // Legal and endless: the deadline ends them.
        let told = solve(&["--time-factor", "1e-15,0.1", "--time-step", "seconds=5e-324"]);
        assert_eq!(told.code, 3, "{}", told.err);
        // Steps of nothing may let round-off grow, or leave a tangent without a digit, before.
        let named = ["timed-out", "unstable", "singular"].iter().any(|end| told.err.contains(end));
        assert!(named, "{}", told.err);
    }
}

#[test]
fn deadlines_hold_in_set_up_and_in_a_search_for_the_critical_step() {
    for (text, most) in [
        ("scene = 'terzaghi'\n[[sweep]]\nmethod = ['GC-SRI-patch']\ncells = [50000]", 90.0),
        ("scene = 'terzaghi'\ntask = 'stability'\n[[sweep]]\nmethod = ['GIMP']\ncells = [4000]", 90.0),
    ] {
        let study = study(&format!("case_seconds = 0.5\n{text}"));
        let start = Instant::now();
        let report = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {});
        let seconds = start.elapsed().as_secs_f64();
        assert_eq!(failure(&report.records[0]).map(|(kind, _)| kind), Some(FailureKind::TimedOut));
        // Without optimisation on a loaded machine; it took minutes where the deadline did not hold.
        assert!(seconds < most, "{seconds} s");
    }
}
