//! Which options, and which pairs of them, a case of the CI tier has.
//!
//! A fault in a branch that no case takes is not caught. Every value of every option must have a
//! case; pairs of values that a study may ask for and none does are listed in a snapshot, so that the list
//! changes knowingly. What cannot go together is told by the checker itself.

use crate::case::keys::{Key, Kind, Value};
use crate::case::planned::Tier;
use crate::case::{Case, Task};
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::study::shipped::shipped_studies;
use oedometer_exact::parameters::Base;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{
    Basis, Configuration, Memory, PressureIntegration, Quadrature, Recovery, StrainGradient,
};
use oedometer_scenes::NAMES;
use oedometer_soil::material::Material;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::sync::LazyLock;

/// An option and one of its values.
type Choice = (&'static str, &'static str);

/// Scenes that between them take every other option.
const SCENES: [&str; 4] = ["terzaghi", "xie-leo", "cosine-layer", "dynamic-column"];

/// Every option with its values, in the order of the table.
fn options() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![
        ("scene", NAMES.to_vec()),
        ("dimensions", vec!["one", "two"]),
        ("task", Task::ALL.map(Task::name).to_vec()),
        ("base", Base::ALL.map(Base::name).to_vec()),
        ("load", vec!["at once", "while it grows", "after it has grown"]),
        ("points", vec!["regular", "shifted", "jittered", "top cell part filled", "unequal"]),
        ("sets", vec!["one", "two"]),
        ("weight", vec!["none", "own"]),
        ("water", vec!["seed", "softer", "stiffer"]),
        words("law"),
        words("continuity"),
        words("conductivity_mean"),
        words("integrator"),
        words("formulation"),
        ("step", vec!["stable", "courant", "seconds", "growth", "tolerance"]),
        words("scheme"),
        words("drag"),
        ("mapping back", vec!["yes", "no"]),
        ("velocities", vec!["FLIP", "FLIP and PIC", "PIC"]),
        ("basis", Basis::ALL.map(basis).to_vec()),
        ("strain", StrainGradient::ALL.map(StrainGradient::name).to_vec()),
        ("pressure", PressureIntegration::ALL.map(PressureIntegration::name).to_vec()),
        ("recovery", Recovery::ALL.map(Recovery::name).to_vec()),
        ("memory", Memory::ALL.map(memory).to_vec()),
        ("quadrature", Quadrature::ALL.map(Quadrature::name).to_vec()),
        ("configuration", Configuration::ALL.map(Configuration::name).to_vec()),
    ]
}

/// A key of the table of inputs with its words.
fn words(name: &'static str) -> (&'static str, Vec<&'static str>) {
    let key = Key::named(name, "sweep").expect("a key");
    let Kind::Word(words) = key.kind else { panic!("`{name}` has no words") };
    (name, words.to_vec())
}

/// The word that a case has for a key.
fn word_of(case: &Case, name: &'static str) -> Choice {
    match Key::named(name, "sweep").map(|key| key.get(case)) {
        Some(Value::Word(word)) => (name, word),
        other => panic!("`{name}` is {other:?}"),
    }
}

fn basis(basis: Basis) -> &'static str {
    match basis {
        Basis::Hat => "hat",
        Basis::Ugimp => "ugimp",
        Basis::Cpgimp => "cpgimp",
        Basis::Cpdi => "cpdi",
        Basis::Bspline2 => "bspline2",
        Basis::Bspline3 => "bspline3",
    }
}

fn memory(memory: Memory) -> &'static str {
    match memory {
        Memory::Points => "points",
        Memory::Cells => "cells",
    }
}

/// What a case has of the options. Those of the explicit step mean nothing to the other integrators.
fn choices_of(case: &Case) -> BTreeSet<Choice> {
    let (column, soil, method) = (&case.column, &case.material, case.method.built_in().expect("a method"));
    let mut choices: BTreeSet<Choice> = [
        ("scene", case.scene.name),
        ("dimensions", if column.dimensions == 1 { "one" } else { "two" }),
        ("task", case.task.name()),
        ("basis", basis(method.basis)),
        ("strain", method.strain.name()),
        ("pressure", method.pressure.name()),
        ("recovery", method.recovery.name()),
        ("memory", memory(method.memory)),
        ("quadrature", method.quadrature.name()),
        ("configuration", method.configuration_in(case.scene.configuration()).name()),
    ]
    .into();
    choices.extend(
        ["law", "continuity", "conductivity_mean", "integrator", "formulation"]
            .map(|name| word_of(case, name)),
    );
    choices.insert(("step", case.time_step.kind().word));
    let seed = Material::default().water_bulk_modulus;
    choices.insert((
        "water",
        match soil.water_bulk_modulus {
            modulus if modulus < seed => "softer",
            modulus if modulus > seed => "stiffer",
            _ => "seed",
        },
    ));
    choices.extend(column.base().map(|base| ("base", base.name())));
    if column.loading_time == 0.0 {
        choices.insert(("load", "at once"));
    }
    for factor in case.time_factors.iter().filter(|_| column.loading_time > 0.0) {
        let grows = factor * case.seconds_per_time_factor() < column.loading_time * (1.0 - 1e-9);
        choices.insert(("load", if grows { "while it grows" } else { "after it has grown" }));
    }
    let points = &column.points;
    let arranged = [
        (points.offset != 0.0, "shifted"),
        (points.jitter != 0.0, "jittered"),
        (points.filling != 1.0, "top cell part filled"),
        (points.alternating, "unequal"),
    ];
    choices.extend(arranged.iter().filter(|(is, _)| *is).map(|(_, word)| ("points", *word)));
    if arranged.iter().all(|(is, _)| !is) {
        choices.insert(("points", "regular"));
    }
    choices.insert(("sets", if points.has_two_sets() { "two" } else { "one" }));
    choices.insert(("weight", if column.self_weight { "own" } else { "none" }));
    if case.integrator == IntegratorKind::Explicit {
        let settings = &case.settings;
        choices.extend(["scheme", "drag"].map(|name| word_of(case, name)));
        choices.insert(("mapping back", if settings.mapping_back { "yes" } else { "no" }));
        choices.insert((
            "velocities",
            match settings.flip {
                1.0 => "FLIP",
                0.0 => "PIC",
                _ => "FLIP and PIC",
            },
        ));
    }
    choices
}

/// A study of one case with two choices, the rest as it comes.
fn study_with(pair: [Choice; 2], scene: &str, integrator: &str, pressure: &str) -> String {
    let asked = |option: &str| pair.iter().find(|choice| choice.0 == option).map(|choice| choice.1);
    let scene = asked("scene").unwrap_or(scene);
    let load = asked("load").unwrap_or("at once");
    let mut text = format!("title = \"pair\"\nscene = \"{scene}\"\n");
    if let Some(task) = asked("task") {
        let _ = writeln!(text, "task = \"{task}\"");
    }
    if load != "at once" {
        text += "column.loading_time = 1.0\n";
    }
    if asked("dimensions") == Some("two") && scene != "cosine-layer" {
        text += "column.dimensions = 2\n";
    }
    if let Some(base) = asked("base") {
        let _ = writeln!(text, "layer.base = \"{base}\"");
    }
    text += match asked("points") {
        Some("shifted") => "points.offset = 0.25\n",
        Some("jittered") => "points.jitter = 0.25\n",
        Some("top cell part filled") => "points.filling = 0.5\n",
        Some("unequal") => "points.alternating = true\n",
        _ => "",
    };
    if asked("sets") == Some("two") {
        text += "points.sets = 2\n";
    }
    if asked("weight") == Some("own") {
        text += "column.self_weight = true\n";
    }
    text += match asked("water") {
        Some("softer") => "material.water_bulk_modulus = 1e8\n",
        Some("stiffer") => "material.water_bulk_modulus = 1e11\n",
        _ => "",
    };
    let factor = if load == "while it grows" { "1e-3" } else { "0.1" };
    let _ = writeln!(text, "output.time_factors = [{factor}]\n[[sweep]]\ncells = [10]");
    let _ = writeln!(text, "integrator = [\"{}\"]", asked("integrator").unwrap_or(integrator));
    for option in ["law", "continuity", "conductivity_mean", "formulation", "scheme", "drag"] {
        if let Some(word) = asked(option) {
            let _ = writeln!(text, "{option} = [\"{word}\"]");
        }
    }
    if let Some(rule) = asked("step") {
        let _ = writeln!(text, "time_step = [{{ {rule} = 1e-3 }}]");
    }
    if asked("mapping back") == Some("no") {
        text += "mapping_back = [false]\n";
    }
    text += match asked("velocities") {
        Some("FLIP and PIC") => "flip = [0.9]\n",
        Some("PIC") => "flip = [0.0]\n",
        _ => "",
    };
    let pressure = asked("pressure").unwrap_or(pressure);
    let word = |option: &str, default: &'static str| asked(option).unwrap_or(default);
    let basis = if asked("quadrature") == Some("moments") { "hat" } else { "cpgimp" };
    let _ = write!(
        text,
        "method = [{{ basis = \"{}\", strain = \"{}\", pressure = \"{pressure}\", recovery = \"{}\", memory = \"{}\"",
        word("basis", basis),
        word("strain", "standard"),
        word("recovery", "constant"),
        word("memory", "points"),
    );
    if let Some(quadrature) = asked("quadrature") {
        let _ = write!(text, ", quadrature = \"{quadrature}\"");
    }
    if let Some(configuration) = asked("configuration") {
        let _ = write!(text, ", configuration = \"{configuration}\"");
    }
    text + " }]\n"
}

/// Whether some study has both choices, whatever else it must choose for that.
fn goes_together(pair: [Choice; 2]) -> bool {
    let has_both = |text: String| {
        let checked = Study::check(&StudySource { name: "pair".to_owned(), text });
        checked.is_ok_and(|study| {
            study.planned.iter().any(|planned| {
                let choices = choices_of(&planned.case);
                pair.iter().all(|choice| choices.contains(choice))
            })
        })
    };
    SCENES.iter().any(|scene| {
        IntegratorKind::ALL.iter().any(|integrator| {
            ["sri", "points"]
                .iter()
                .any(|pressure| has_both(study_with(pair, scene, integrator.name(), pressure)))
        })
    })
}

/// Choices of every case of the CI tier of the shipped studies.
static VISITED: LazyLock<Vec<BTreeSet<Choice>>> = LazyLock::new(|| {
    let studies = shipped_studies().into_iter().map(|source| Study::check(&source).expect("a shipped study"));
    studies.flat_map(|study| study.cases(Tier::Ci).into_iter().map(choices_of).collect::<Vec<_>>()).collect()
});

#[test]
fn every_value_of_every_option_has_a_case_of_the_ci_tier() {
    let cases = &*VISITED;
    for (option, values) in options() {
        for value in values {
            assert!(cases.iter().any(|case| case.contains(&(option, value))), "no case has {option} {value}");
        }
    }
    // And there is no value that the table leaves out.
    let known: BTreeSet<Choice> =
        options().iter().flat_map(|(option, values)| values.iter().map(|value| (*option, *value))).collect();
    let all: BTreeSet<Choice> = cases.iter().flatten().copied().collect();
    assert!(all.is_subset(&known), "{:?}", all.difference(&known).collect::<Vec<_>>());
}

#[test]
fn the_pairs_of_options_that_no_case_has_are_known() {
    let cases = &*VISITED;
    // Most cases choose as others do.
    let distinct: BTreeSet<&BTreeSet<Choice>> = cases.iter().collect();
    let options = options();
    let mut of_value: BTreeMap<Choice, usize> = BTreeMap::new();
    for choice in cases.iter().flatten() {
        *of_value.entry(*choice).or_default() += 1;
    }
    let (mut table, mut without, mut refused) = (String::new(), String::new(), String::new());
    let mut counts = [0; 3];
    for (option, values) in &options {
        let cells = values.iter().map(|value| format!("{value} {}", of_value[&(*option, *value)]));
        let _ = writeln!(table, "{option}: {}", cells.collect::<Vec<_>>().join(", "));
    }
    for (place, (first, first_values)) in options.iter().enumerate() {
        for (second, second_values) in &options[place + 1..] {
            let [mut unvisited, mut impossible] = [Vec::new(), Vec::new()];
            for one in first_values {
                for other in second_values {
                    let pair: [Choice; 2] = [(*first, *one), (*second, *other)];
                    if distinct.iter().any(|case| pair.iter().all(|choice| case.contains(choice))) {
                        counts[0] += 1;
                    } else if goes_together(pair) {
                        unvisited.push(format!("{one} + {other}"));
                    } else {
                        impossible.push(format!("{one} + {other}"));
                    }
                }
            }
            counts[1] += unvisited.len();
            counts[2] += impossible.len();
            for (list, lines) in [(unvisited, &mut without), (impossible, &mut refused)] {
                if !list.is_empty() {
                    let _ = writeln!(lines, "{first} × {second}: {}", list.join(", "));
                }
            }
        }
    }
    let told = format!(
        "Cases of the CI tier: {}\n\n{table}\nPairs with a case: {}\n\nPairs that a study may ask for and none does: \
         {}\n\n{without}\nPairs that cannot be: {}\n\n{refused}",
        cases.len(),
        counts[0],
        counts[1],
        counts[2]
    );
    insta::with_settings!({ snapshot_path => "../../tests/snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("option_pairs", told);
    });
}
