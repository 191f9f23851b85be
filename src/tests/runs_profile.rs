//! Where the time goes, and which formulations an integrator takes: whole cases of every integrator.

use crate::campaign::case_run::run_case;
use crate::record::Record;
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_mpm::run::Kernel;
use oedometer_mpm::run::profile::{Phase, PhaseTime, profiled};

fn study_of(scene: &str, sweep: &str) -> Study {
    let text = format!(
        "title = \"Phases\"\nscene = \"{scene}\"\n[output]\ntime_factors = [0.02]\n[[sweep]]\ncells = [4]\n{sweep}\n"
    );
    Study::check(&StudySource { name: "phases.toml".to_owned(), text }).expect("a sound study")
}

fn solved(study: &Study) -> Record {
    let case = &study.planned[0].case;
    let mut record =
        run_case(case, &study.references, Kernel::Fastest, true, &|_, _| true).expect("a record");
    record.wall.clear();
    record
}

/// Where the time of a case goes; its record must be that of a run nobody watches.
fn phases_of(scene: &str, sweep: &str) -> Vec<PhaseTime> {
    let study = study_of(scene, sweep);
    let (watched, phases) = profiled(|| solved(&study));
    assert_eq!(watched, solved(&study), "{sweep}: a profile changed the result");
    let shares: f64 = phases.iter().map(|time| time.share).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{sweep}: shares of {shares}");
    phases
}

fn has(phases: &[PhaseTime], wanted: &[Phase]) {
    for phase in wanted {
        let found = phases.iter().find(|time| time.phase == *phase);
        assert!(found.is_some_and(|time| time.entries > 0), "{}: not among {phases:?}", phase.name());
    }
}

const MOVING: &str = "method = [{ basis = \"cpgimp\", strain = \"cmpm\", pressure = \"sri\", recovery = \"patch\", \
                      configuration = \"updated\" }]";

#[test]
fn every_integrator_says_where_its_time_goes_and_solves_the_same() {
    use Phase::*;
    let frozen = phases_of("terzaghi", "method = [\"GC-SRI-patch\"]");
    has(&frozen, &[CriticalStep, Forces, Motion, Outputs, Assessment]);
    has(&phases_of("terzaghi", MOVING), &[BuildWeights, MapVelocities, Forces, Motion, Stresses, Recovery]);
    let implicit = "method = [\"GC-SRI-patch\"]\nintegrator = [\"implicit\"]";
    has(&phases_of("terzaghi", implicit), &[Assembly, Factors, Solve, Outputs, Assessment]);
    let large = phases_of("xie-leo", implicit);
    has(&large, &[BuildWeights, Balances, Assembly, Factors, Solve]);
    has(&phases_of("cosine-layer", implicit), &[Assembly, Factors, Solve]);
    let plane = "method = [\"GIMP-SRI\"]\ntime_factors = [1e-6]";
    has(&phases_of("cosine-layer", plane), &[CriticalStep, Recovery, Forces, Motion]);
}

#[test]
fn semi_implicit_and_u_p_run_for_every_method_and_configuration() {
    let methods = "method = [\"MPM\", \"GIMP-SRI\", \"GIMP-SRI-patch\", \"GC-SRI-patch\", \"CPDI-SRI-patch\", \
                   \"GIMP-Bbar\", \"GIMP-null-space\", \"PPP-step\", \"TL-GC-SRI-patch\", \
                   { basis = \"cpgimp\", strain = \"cmpm\", pressure = \"sri\", recovery = \"patch\", configuration = \"updated\" }]";
    for rest in [
        "integrator = [\"semi-implicit\"]\nformulation = [\"v-w\", \"u-p\"]\ntime_step = [{ stable = 0.05 }]",
        "integrator = [\"implicit\"]\nformulation = [\"u-p\", \"v-w\"]",
    ] {
        let study = study_of("terzaghi", &format!("{methods}\n{rest}"));
        for planned in &study.planned {
            let record = run_case(&planned.case, &study.references, Kernel::Fastest, true, &|_, _| true);
            let record = record.expect("a record");
            assert_eq!(record.status.name(), "ok", "{}", planned.case.label());
            let error =
                record.errors.iter().find(|row| row.quantity.name() == "settlement").expect("measured");
            // Four cells at this time are a fifth off; a formulation that misses a term is far more.
            assert!(error.value.abs() < 0.35, "{}: {}", planned.case.label(), error.value);
        }
    }
}

#[test]
fn u_p_in_explicit_steps_is_refused_with_the_reason_and_the_way_out() {
    let text = "title = \"x\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\ncells = [4]\nformulation = [\"u-p\"]\n";
    let source = StudySource { name: "up.toml".to_owned(), text: text.to_owned() };
    let told = Study::check(&source).expect_err("refused").to_string();
    for word in ["square of the cell", "semi-implicit", "up.toml:6"] {
        assert!(told.contains(word), "{word} is missing in: {told}");
    }
}
