//! What the front page of a report says of a user's own study.

use crate::program::{call, folder_with};
use std::fs;

/// The front page of the report of a study.
fn front(study: &str) -> String {
    let folder = folder_with(&format!("title = \"t\"\n{study}"));
    let told = call(folder.path(), &["report", "short.toml", "--out", "made"]);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    fs::read_to_string(folder.path().join("made/README.md")).expect("a page")
}

/// The answer to a question, up to the next one.
fn answer<'a>(front: &'a str, question: &str) -> &'a str {
    let answer = front.split(question).nth(1).unwrap_or_else(|| panic!("not asked: {front}"));
    answer.split("\n## ").next().unwrap_or(answer)
}

#[test]
fn a_study_of_the_step_says_its_order_and_from_where_it_is_unstable() {
    let steps = |integrator: &str, outputs: &str, steps: &[&str]| {
        let steps = steps.iter().map(|step| format!("{{ seconds = {step} }}")).collect::<Vec<_>>().join(", ");
        front(&format!(
            "scene = \"terzaghi\"\noutput.time_factors = [{outputs}]\n[[sweep]]\nmethod = [\"GC-SRI-patch\"]\n\
             integrator = [\"{integrator}\"]\ncells = [20]\ntime_step = [{steps}]\n"
        ))
    };
    let page = steps("implicit", "0.2", &["0.4", "0.2", "0.1", "0.05"]);
    let told = answer(&page, "## What does the time step change?");
    // The scheme is of second order.
    assert!(told.contains("at T_v = 0.2: order 1.9") || told.contains("at T_v = 0.2: order 2.0"), "{told}");
    assert!(told.contains(" for `GC-SRI-patch`. All steps that were tried are stable."), "{told}");
    assert!(
        told.contains("with Δt = 0.4 s and ") && told.contains("with Δt = 0.05 s: the mesh, not"),
        "{told}"
    );
    // The critical step of the explicit scheme on 20 cells is 4.4e-5 s.
    let page = steps("explicit", "0.001", &["8e-5", "4e-5", "2e-5", "1e-5", "5e-6"]);
    let told = answer(&page, "## What does the time step change?");
    assert!(told.contains("`GC-SRI-patch` ends unstable from Δt = 8e-5 s on."), "{told}");
    assert!(told.contains("with Δt = 4e-5 s and ") && told.contains("with Δt = 5e-6 s: the mesh"), "{told}");
    assert!(!told.contains("too few"), "the order is of the stable steps: {told}");
    let page = steps("implicit", "0.2", &["0.4", "0.2", "0.1"]);
    let told = answer(&page, "## What does the time step change?");
    // Two differences have one order and no class.
    assert!(told.contains("at T_v = 0.2: order ") && !told.contains("asymptotic"), "{told}");
}

#[test]
fn a_study_of_the_mesh_says_what_it_converges_to_and_how_fast() {
    let page = front(
        "scene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = [\"MPM\", \"GC-SRI-patch\"]\n\
         integrator = [\"implicit\"]\ncells = [5, 10, 20]\n",
    );
    let told = answer(&page, "## Does it converge, how fast, and to what?");
    assert!(
        told.contains("`GC-SRI-patch` converges to Terzaghi's solution with compressible water"),
        "{told}"
    );
    assert!(told.contains("| method | error of | 5 cells | 10 | 20 | order |"), "{told}");
    let page = front(
        "scene = \"xie-leo\"\noutput.time_factors = [0.1]\ncolumn.load = 428e3\nmaterial.porosity = 0.5\n[[sweep]]\n\
         method = [\"GC-SRI-patch\", \"TL-GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [5, 10, 20]\n\
         time_step = [{ growth = 0.02 }]\n",
    );
    let told = answer(&page, "## Does it converge, how fast, and to what?");
    assert!(told.contains("At a final strain of ") && told.contains("| `TL-GC-SRI-patch` |"), "{told}");
}

#[test]
fn what_is_odd_about_a_study_is_told_before_its_results_and_not_again() {
    let folder = folder_with(
        "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\ncolumn.load = \"50 kPa\"\n[[sweep]]\nmethod = [\"MPM\"]\n\
         integrator = [\"implicit\"]\ncells = [4]\n",
    );
    let tells = |words: &[&str]| call(folder.path(), words).err.contains("strains the column by");
    assert!(tells(&["check", "short.toml"]), "nothing was run");
    assert!(tells(&["plan", "short.toml"]) && tells(&["run", "short.toml"]));
    for command in ["check", "report"] {
        assert!(!tells(&[command, "short.toml"]), "{command} repeats it");
        assert!(tells(&[command, "short.toml", "--records", "elsewhere"]), "{command} is the first to tell");
    }
}
