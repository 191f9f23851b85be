//! The scene `xie-leo` through the public door: what it refuses, where it starts, what it solves.

use crate::campaign::case_run::run_case;
use crate::case::quantity::{Quantity, Sample};
use crate::measure::soundness::complaints;
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::run::Kernel;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;

fn study(lines: &str, sweep: &str) -> Result<Study, String> {
    let text = format!(
        "title = \"t\"\nscene = \"xie-leo\"\n{lines}\n[integrator]\ndrag = \"implicit\"\n[output]\ntime_factors = [0.05]\n\
         [[sweep]]\ncells = [5]\npoints_per_cell = [2]\n{sweep}\n"
    );
    Study::check(&StudySource { name: "typed.toml".to_owned(), text }).map_err(|error| error.to_string())
}

fn record(lines: &str, sweep: &str) -> Record {
    let study = study(lines, sweep).expect("a good study");
    run_case(&study.planned[0].case, &study.references, Kernel::Fastest, false, &|_, _| true)
        .expect("references that hold")
}

const LOADED: &str = "[column]\nload = 200e3";

#[test]
fn the_default_law_is_the_scene_s() {
    let study = study(LOADED, "method = [\"GIMP\"]").expect("a good study");
    assert_eq!(study.planned[0].case.material.law, Law::LogLinear);
    assert_eq!(study.references[0].name(), "large-strain");
    assert_eq!(study.references[1], ReferenceKind::XieLeo);
}

#[test]
fn impossible_porosities_small_strain_laws_and_frozen_points_are_refused_at_their_place() {
    let refused = |lines: &str, sweep: &str| study(lines, sweep).expect_err("a refusal");
    let closing = refused("[column]\nload = 450e3", "method = [\"GIMP\"]");
    assert!(closing.contains("typed.toml:4") && closing.contains("the pores close at 0.3"), "{closing}");
    assert!(closing.contains('^'), "{closing}");
    let linear = refused("[material]\nlaw = \"linear\"", "method = [\"GIMP\"]");
    assert!(linear.contains("typed.toml:4") && linear.contains("small strain"), "{linear}");
    let table = "method = [{ basis = \"hat\", strain = \"standard\", pressure = \"points\", configuration = \"frozen\" }]";
    let frozen = refused(LOADED, table);
    assert!(frozen.contains("nothing moves") && frozen.contains("typed.toml:12"), "{frozen}");
}

#[test]
fn the_start_is_the_undrained_equilibrium_of_every_model() {
    for law in [Law::LogLinear, Law::PorosityDependent, Law::Engineering] {
        for method in ["GC-SRI-patch", "TL-GIMP-SRI-patch"] {
            let sweep = format!("method = [\"{method}\"]\nlaw = [\"{}\"]\ntime_factors = [0.0]", law.name());
            let start = record(LOADED, &sweep).start.expect("a start");
            assert!(start.undrained_pressure_error < 1e-11, "{law:?} {method} {start:?}");
            assert!(start.unbalanced_force < 1e-9, "{law:?} {method} {start:?}");
        }
    }
}

const GROWING: &str = "[column]\nload = 200e3\nloading_time = 4.0";

#[test]
fn a_growing_load_finds_the_soil_at_rest_and_has_its_own_reference() {
    let references = study(GROWING, "method = [\"GIMP\"]").expect("a good study").references;
    assert_eq!(references.iter().map(|kind| kind.name()).collect::<Vec<_>>(), ["large-strain"]);
    for integrator in ["explicit", "implicit"] {
        let sweep = format!(
            "method = [\"TL-GC-SRI-patch\"]\nintegrator = [\"{integrator}\"]\ntime_factors = [0.0, 0.03, 0.05]"
        );
        let record = record(GROWING, &sweep);
        assert_eq!(record.status, Status::Ok);
        let at_rest = &record.snapshots[0];
        assert!(at_rest.points.pressure.iter().chain(&at_rest.points.effective_stress).all(|p| *p == 0.0));
        let norm = crate::case::quantity::Norm::L2;
        for (time_factor, most) in [(0.03, 0.08), (0.05, 0.06)] {
            let error = record.error(Quantity::Pressure, Sample::Points, norm, "large-strain", time_factor);
            let error = error.expect("an error").value;
            assert!(error < most, "{integrator} {time_factor}: {error}");
        }
    }
}

#[test]
fn the_reference_of_a_load_at_once_is_refused_for_one_that_grows() {
    let told = Study::check(&StudySource {
        name: "typed.toml".to_owned(),
        text: format!(
            "title = \"t\"\nscene = \"xie-leo\"\n{GROWING}\n[output]\nreferences = [\"xie-leo\"]\n[[sweep]]\n\
             cells = [5]\nmethod = [\"GIMP\"]\n"
        ),
    })
    .expect_err("a refusal")
    .to_string();
    assert!(told.contains("is sudden, but this column's grows") && told.contains("large-strain"), "{told}");
    assert!(told.contains("typed.toml:7") && told.contains('^'), "{told}");
}

#[test]
fn every_model_comes_near_its_own_reference_and_keeps_its_water() {
    for law in [Law::LogLinear, Law::PorosityDependent, Law::Engineering] {
        for continuity in Continuity::ALL {
            let sweep = format!(
                "method = [\"TL-GIMP-SRI-patch\"]\nlaw = [\"{}\"]\ncontinuity = [\"{}\"]",
                law.name(),
                continuity.name()
            );
            let record = record(LOADED, &sweep);
            assert_eq!(record.status, Status::Ok);
            let norm = crate::case::quantity::Norm::L2;
            let error = record.error(Quantity::Pressure, Sample::Points, norm, "large-strain", 0.05);
            let error = error.expect("an error").value;
            assert!(error < 0.045, "{law:?} {continuity:?} {error}");
            let balance = record.balance[0];
            if continuity == Continuity::Conservative {
                assert!(balance.water_imbalance.abs() < 1e-3, "{balance:?}");
            }
            assert!(balance.solid_mass_drift.abs() < 1e-12, "{balance:?}");
        }
    }
}

#[test]
fn splines_end_at_the_surface_wherever_it_is() {
    // The surface of eight cells of 12.5 cm passes the middle of its cell at 6.2 cm: a spline that kept the
    // node beyond it would close the pores of the last points there.
    for basis in ["bspline2", "bspline3"] {
        // Half a spline is lighter than the start's: the explicit step leaves room for it.
        for (integrator, step) in [("implicit", "growth = 0.05"), ("explicit", "stable = 0.4")] {
            let sweep = format!(
                "method = [{{ basis = \"{basis}\", strain = \"standard\", pressure = \"sri\", recovery = \"patch\" }}]\n\
                 integrator = [\"{integrator}\"]\ntime_step = [{{ {step} }}]\ntime_factors = [0.2]"
            );
            let study = study(LOADED, &sweep).expect("a good study");
            let mut case = study.planned[0].case.clone();
            (case.cells, case.points_per_cell) = (8, 4);
            let record =
                run_case(&case, &study.references, Kernel::Fastest, false, &|_, _| true).expect("runs");
            assert_eq!(record.status, Status::Ok, "{}", case.label());
            let settled = record.snapshots[0].settlement;
            assert!(settled > 0.07, "past the middle of the cell: {settled}");
            let norm = crate::case::quantity::Norm::L2;
            let error = record.error(Quantity::Pressure, Sample::Points, norm, "large-strain", 0.2);
            let error = error.expect("an error").value;
            assert!(error < 0.02, "{}: {error}", case.label());
        }
    }
}

#[test]
fn a_cell_that_loses_its_last_point_does_not_end_the_run() {
    let sweep = "method = [\"GIMP-SRI-patch\", \"GC-SRI-patch\"]\ntime_factors = [0.5]";
    let study = study(LOADED, sweep).expect("a good study");
    for planned in &study.planned {
        // Eight cells of 12.5 cm: the surface sinks by 12.7 cm until T_v = 0.5.
        let mut case = planned.case.clone();
        (case.cells, case.points_per_cell) = (8, 4);
        let record = run_case(&case, &study.references, Kernel::Fastest, false, &|_, _| true).expect("runs");
        assert_eq!(record.status, Status::Ok, "{}", case.label());
    }
}

#[test]
fn moving_points_whose_stresses_leave_the_balance_are_named() {
    let halved = "[column]\nstrain = 0.5\n[material]\nporosity = 0.7";
    for (method, is_named) in [("MPM", true), ("GIMP", false), ("GIMP-SRI-patch", false)] {
        let sweep = format!(
            "method = [\"{method}\"]\nintegrator = [\"implicit\"]\ntime_step = [{{ growth = 0.04 }}]\ntime_factors = [1.0]"
        );
        let study = study(halved, &sweep).expect("a good study");
        let mut case = study.planned[0].case.clone();
        case.cells = 24;
        let record =
            run_case(&case, &study.references, Kernel::Fastest, false, &|_, _| true).expect("references");
        assert_eq!(record.status, Status::Ok, "{method}");
        let settlement =
            record.errors.iter().find(|row| row.quantity == Quantity::Settlement).expect("an error").value;
        assert_eq!(settlement.abs() > 0.05, is_named, "{method}: {settlement}");
        let complaints = complaints(&record);
        assert_eq!(
            complaints.iter().any(|one| one.starts_with("equilibrium")),
            is_named,
            "{method}: {complaints:?}"
        );
    }
}
