//! The work of a case before it runs.

use crate::case::Case;
use crate::case::planned::Tier;
use crate::case::work_estimate::{
    MOST_PROBE_STEPS, estimated_seconds, estimated_steps, estimated_updates, estimated_work,
};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_problem::critical_step::OBSERVED_STEPS;

fn cases(head: &str, sweep: &str) -> Vec<Case> {
    let text =
        format!("title = \"t\"\nscene = \"terzaghi\"\n{head}\n[[sweep]]\nmethod = [\"MPM\"]\n{sweep}\n");
    let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
    study.cases(Tier::Full).into_iter().cloned().collect()
}

#[test]
fn work_beyond_counting_stays_the_largest_number() {
    let endless = cases("", "cells = [3, 4]\ntime_step = [{ seconds = 1e-300 }]");
    assert_eq!(endless.len(), 2);
    assert!(endless.iter().all(|case| estimated_work(case) == u64::MAX));
    assert!(cases("", "cells = [3, 4]").iter().all(|case| estimated_work(case) < 1_000_000_000));
}

#[test]
fn the_work_of_a_critical_step_has_an_end() {
    let endless = cases("task = \"stability\"", "cells = [8]\nhydraulic_conductivity = [1e-300]");
    let most = (4 * OBSERVED_STEPS + MOST_PROBE_STEPS) * 16;
    assert_eq!(estimated_updates(&endless[0]), most);
    let short = cases("task = \"stability\"\n[output]\ntime_factors = [1e-9]", "cells = [8]");
    assert_eq!(estimated_updates(&short[0]), (4 + 1) * OBSERVED_STEPS * 16);
}

#[test]
fn an_undrained_start_alone_takes_no_steps_and_a_known_time() {
    for rule in ["{ growth = 0.01 }", "{ tolerance = 1e-4 }"] {
        let start = cases(
            "[output]\ntime_factors = [0.0]",
            &format!("integrator = [\"implicit\"]\ntime_step = [{rule}]\ncells = [8]"),
        );
        let seconds = estimated_seconds(&start[0]);
        assert!(seconds > 0.0 && seconds < 1.0, "{rule}: {seconds} s");
    }
}

#[test]
fn memory_and_steps_of_a_small_case_are_those_counted_by_hand() {
    let rule = "time_step = [{ seconds = 0.01 }]\ncells = [8]";
    let [explicit, implicit] = ["explicit", "implicit"].map(|integrator| {
        cases("output.time_factors = [0.1]", &format!("integrator = [\"{integrator}\"]\n{rule}")).remove(0)
    });
    // 16 points of 500 bytes; a row of the solver has a displacement and two pressures, and a band of 36 numbers.
    assert_eq!(explicit.estimated_bytes(), 16.0 * 500.0);
    assert_eq!(implicit.estimated_bytes(), 16.0 * 500.0 + 8.0 * 3.0 * 16.0 * 36.0);
    // T_v = 0.1 is reached after 8.175 s.
    for case in [&explicit, &implicit] {
        let steps = estimated_steps(case);
        assert!((steps - 817.5).abs() <= 1.0, "{steps}");
    }
}

#[test]
fn the_steps_of_layers_are_those_of_the_soil_that_sets_the_limit() {
    let sweep = "integrator = [\"explicit\"]\ntime_step = [{ stable = 0.5 }]\ncells = [8]";
    let tight = "material.hydraulic_conductivity = 1e-8";
    let alone = estimated_steps(&cases(tight, sweep)[0]);
    let [open, tight] = ["", ",hydraulic_conductivity=1e-8"].map(|own| format!("{{thickness=0.5{own}}}"));
    // The time factors are those of [material].
    let of_material = 1e-8 / 1e-4;
    for layers in [format!("[{open},{tight}]"), format!("[{tight},{open}]")] {
        let text = format!(
            "title = \"t\"\nscene = \"layered\"\ncolumn.soils = {layers}\n[[sweep]]\nmethod = [\"MPM\"]\n{sweep}\n"
        );
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
        let steps = estimated_steps(study.cases(Tier::Full)[0]);
        assert!((steps / (of_material * alone) - 1.0).abs() < 1e-9, "{layers}: {steps} for {alone}");
    }
}

#[test]
fn a_label_names_all_that_is_unusual_about_the_points() {
    for (points, parts) in [
        ("sets = 2, water_per_cell = 3", &["two point sets, 3 of the water"][..]),
        ("offset = 0.25, filling = 0.5", &["points shifted by 0.25", "top cell filled to 0.5"]),
    ] {
        let label = cases(&format!("points = {{ {points} }}"), "cells = [8]")[0].label();
        assert!(parts.iter().all(|part| label.contains(part)), "{parts:?} in {label}");
    }
}
