//! The order of the sources of this crate and of those below it, by the paths in their code: no source uses one of a floor
//! above its own, and in the crates that have no circle of sources there is none.

use super::architecture::{is_test_module, sources_below};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The order of the sources of a crate.
struct Order {
    /// Folder of its sources.
    root: &'static str,
    /// Files and folders from the ground up; each uses only itself and those before it. `*` is all that has no other name.
    floors: &'static str,
    /// Files and folders inside which sources may use each other in a circle.
    circles: &'static [&'static str],
    /// Uses of a source above that are licensed until it has moved.
    licensed: &'static [(&'static str, &'static str)],
}

const SOIL: Order = Order {
    root: "crates/soil/src",
    floors: "wide base motion elementary tensor continuity plasticity stiffness law_data laws law conductivity material layers",
    circles: &[],
    licensed: &[],
};
const INPUT: Order = Order {
    root: "crates/input/src",
    floors: "nearest units synonyms diagnostic source mending toml_text",
    circles: &[],
    licensed: &[],
};
/// The ground knows no problem; the door, `reference`, knows all of them, and none of them knows the door.
const EXACT: Order = Order {
    root: "crates/exact/src",
    floors: "exact_error numerics parameters inputs row solution talbot porous_soil consolidation/series * reference",
    circles: &[],
    licensed: &[],
};
const PROBLEM: Order = Order {
    root: "crates/problem/src",
    floors: "formulation method settings arrangement time_step integrator wave_speeds forcing snapshot outcome critical_step quantity problem",
    circles: &[],
    licensed: &[],
};
const SCENES: Order = Order {
    root: "crates/scenes/src",
    floors: "column limit scene manufactured * named problem",
    circles: &[],
    licensed: &[],
};
const MPM: Order = Order {
    root: "crates/mpm/src",
    floors: "entries time_limit direct_solver state operators drag actions kernel integrate run discretise",
    circles: &[],
    licensed: &[],
};
const CONVERGENCE: Order = Order { root: "crates/convergence/src", floors: "*", circles: &[], licensed: &[] };
const HARNESS: Order = Order {
    root: "src",
    floors: "render record measure study campaign golden history score judge race questions report api cli",
    circles: &["render/chart", "study/check", "campaign", "golden", "score", "cli/slurm"],
    licensed: &[],
};

type Sources = BTreeMap<String, String>;

/// Every source but the root of the crate by its path without `.rs` and `/mod.rs`, with its code without tests.
fn sources(order: &Order) -> Sources {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(order.root);
    let mut sources = Sources::new();
    for path in sources_below(&root) {
        let inside = path.strip_prefix(&root).expect("below the root");
        let name = inside.to_string_lossy().replace('\\', "/");
        let name = name.trim_end_matches(".rs").trim_end_matches("/mod");
        if !is_test_module(inside) && !["lib", "main"].contains(&name) {
            let text = fs::read_to_string(&path).expect("a source");
            let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            sources.insert(name.to_owned(), code.to_owned());
        }
    }
    sources
}

/// The steps of a path, each up to what is no name.
fn steps(path: &str) -> Vec<&str> {
    let name = |step: &'_ str| step.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
    let steps = path.trim().split("::").map(|step| &step[..name(step).unwrap_or(step.len())]);
    steps.filter(|step| !step.is_empty()).collect()
}

/// The sources that a source uses: of `use` lines, and of paths in its code. An indented `use super::` is that of a module
/// inside the file, and `super` the file itself.
fn used(name: &str, code: &str, sources: &Sources) -> BTreeSet<String> {
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let code: String = lines.map(|line| line.replace(" use super::", "") + "\n").collect();
    let above = name.rsplit_once('/').map_or(Vec::new(), |(above, _)| above.split('/').collect());
    let mut used = BTreeSet::new();
    for (marker, base) in [("crate::", Vec::new()), (" super::", above)] {
        for path in code.split(marker).skip(1) {
            let end = path.find(|letter: char| !letter.is_alphanumeric() && !"_:".contains(letter));
            let (stem, rest) = path.split_at(end.unwrap_or(path.len()));
            // Of `a::{b, c::d}` every branch.
            let inside = rest.strip_prefix('{').and_then(|rest| rest.split('}').next()).unwrap_or_default();
            for branch in inside.split(',') {
                let full = [base.clone(), steps(stem), steps(branch)].concat();
                // The longest path that is a source.
                let paths = (1..=full.len()).rev().map(|count| full[..count].join("/"));
                used.extend(paths.filter(|path| sources.contains_key(path)).take(1));
            }
        }
    }
    used.remove(name);
    used
}

/// Whether a source is, or lies in, a file or folder.
fn lies_in(name: &str, place: &str) -> bool {
    name.strip_prefix(place).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// Whether both are of commands of the command line, and not of the same one.
fn is_of_another_command(from: &str, to: &str) -> bool {
    let command = |name: &str| Some(name.strip_prefix("cli/commands/")?.split('/').next()?.to_owned());
    command(from).zip(command(to)).is_some_and(|(from, to)| from != to)
}

/// Sources without a floor, arrows up, and circles, but for licensed ones; and licences that nothing needs.
fn complaints(order: &Order, sources: &Sources) -> Vec<String> {
    let floors: Vec<&str> = order.floors.split_whitespace().collect();
    let floor_of = |name: &str| {
        let named = floors.iter().position(|floor| lies_in(name, floor));
        named.or_else(|| floors.iter().position(|floor| *floor == "*"))
    };
    let arrows: BTreeMap<&String, BTreeSet<String>> =
        sources.iter().map(|(name, code)| (name, used(name, code, sources))).collect();
    let is_in_circle = |name: &String| {
        let (mut reached, mut next) = (BTreeSet::new(), vec![name]);
        while let Some(source) = next.pop() {
            next.extend(arrows[source].iter().filter(|to| reached.insert(*to)));
        }
        reached.contains(name)
    };
    let mut complaints = Vec::new();
    let (mut circles, mut up) = (order.circles.to_vec(), order.licensed.to_vec());
    for (from, to) in &arrows {
        let floor = floor_of(from);
        if floor.is_none() {
            complaints.push(format!("{from} is on no floor"));
        }
        for to in to.iter().filter(|to| floor_of(to) > floor) {
            up.retain(|licence| *licence != (from, to));
            if !order.licensed.contains(&(from, to)) {
                complaints.push(format!("{from} → {to}"));
            }
        }
        for to in to.iter().filter(|to| is_of_another_command(from, to)) {
            complaints.push(format!("{from} is a command and uses another, {to}"));
        }
        if is_in_circle(from) {
            circles.retain(|licence| !lies_in(from, licence));
            if !order.circles.iter().any(|licence| lies_in(from, licence)) {
                complaints.push(format!("{from} is in a circle"));
            }
        }
    }
    complaints.extend(circles.iter().map(|licence| format!("{licence} has no circle: its licence can go")));
    complaints.extend(up.iter().map(|(from, to)| format!("{from} does not use {to}: its licence can go")));
    complaints
}

#[test]
fn no_source_uses_one_above_it_or_in_a_circle() {
    for (order, seen) in [
        (SOIL, &[("law", "plasticity")][..]),
        (
            EXACT,
            &[
                ("layered", "talbot"),
                ("mandel/sums", "porous_soil"),
                ("textbook/cryer", "textbook/terms"),
                ("dynamic_column", "dynamic_column/summation"),
                ("consolidation", "consolidation/series"),
            ],
        ),
        (INPUT, &[("toml_text", "mending")]),
        (PROBLEM, &[("integrator", "time_step")]),
        (SCENES, &[("scene", "limit"), ("footing", "limit")]),
        (
            MPM,
            &[
                ("kernel/step", "kernel/body"),
                ("operators/basis", "operators/row"),
                ("run", "integrate/schedule"),
                ("integrate/implicit/newton", "integrate/implicit"),
            ],
        ),
        (CONVERGENCE, &[("class/classify", "class")]),
        (HARNESS, &[("measure/soundness", "record"), ("report/tables/measures", "questions/checks")]),
    ] {
        let sources = sources(&order);
        // Uses that are known to be there are seen.
        for (from, to) in seen {
            assert!(used(from, &sources[*from], &sources).contains(*to), "{}: {from} → {to}", order.root);
        }
        let complaints = complaints(&order, &sources);
        assert!(complaints.is_empty(), "{}:\n{}", order.root, complaints.join("\n"));
    }
}

#[test]
fn a_planted_arrow_or_circle_is_named() {
    for (order, name, line, complaint) in [
        (SOIL, "plasticity", "use crate::law::Stiffness;", "plasticity → law"),
        (SOIL, "new", "", "new is on no floor"),
        (EXACT, "parameters", "use crate::textbook::TextbookProblem;", "parameters → textbook"),
        (EXACT, "solution", "use crate::{exact_error::E, manufactured::M};", "solution → manufactured"),
        (EXACT, "layered", "fn f() { crate::reference::Reference::new(); }", "layered → reference"),
        (
            EXACT,
            "dynamic_column/modes",
            "use super::summation::BLOCK;",
            "dynamic_column/modes is in a circle",
        ),
        (
            EXACT,
            "consolidation/series",
            "use crate::consolidation::W;",
            "consolidation/series is in a circle",
        ),
        (MPM, "operators/row", "fn f() { crate::kernel::body::take() }", "operators/row → kernel/body"),
        (MPM, "operators/row", "use crate::operators::basis::Hat;", "operators/basis is in a circle"),
        (INPUT, "units", "use crate::toml_text::D;", "units → toml_text"),
        (INPUT, "nearest", "use crate::synonyms::K;", "nearest is in a circle"),
        (PROBLEM, "time_step", "use crate::{integrator::I};", "integrator is in a circle"),
        (CONVERGENCE, "class", "use crate::class::classify::classify;", "class is in a circle"),
        (HARNESS, "record", "fn f() { crate::judge::explanation::explain() }", "record → judge/explanation"),
        (HARNESS, "render/page", "use crate::judge::verdict::Verdict;", "render/page → judge/verdict"),
        (
            HARNESS,
            "cli/commands/plan",
            "use crate::cli::commands::run::Engine;",
            "cli/commands/plan is a command and uses another, cli/commands/run",
        ),
        (HARNESS, "questions/finding", "use crate::questions::answers;", "questions/finding is in a circle"),
        (HARNESS, "race/finish", "use crate::race::situation::Entry;", "race/finish is in a circle"),
    ] {
        let mut planted = sources(&order);
        planted.entry(name.to_owned()).or_default().push_str(line);
        let found = complaints(&order, &planted);
        assert!(found.iter().any(|found| found == complaint), "{complaint}: {found:?}");
    }
    let unneeded = Order { circles: &["law"], licensed: &[("law", "material")], ..SOIL };
    assert_eq!(
        complaints(&unneeded, &sources(&SOIL)),
        ["law has no circle: its licence can go", "law does not use material: its licence can go"]
    );
    let mut commented = sources(&SOIL);
    commented.insert("plasticity".to_owned(), "// use crate::law::Stiffness;\n".to_owned());
    assert_eq!(complaints(&SOIL, &commented), [""; 0], "comments may name any source");
}
