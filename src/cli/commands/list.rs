//! `oedometer list`: the names of scenes, methods, integrators, references and shipped studies.

use crate::case::contender::CONTENDERS;
use crate::case::method_words::parts;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::print_data;
use crate::study::shipped::{shipped_names, shipped_study, shipped_titles};
use oedometer_exact::{ReferenceKind, TextbookProblem};
use oedometer_input::nearest::nearest;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_scenes::{SCENES, Scene};
use std::fmt::Write;

/// Arguments of `list`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Explain a method or a benchmark problem, or print the file of a built-in study
    #[arg(long, value_name = "NAME")]
    show: Option<String>,
    /// List all methods, including those that the report does not compare
    #[arg(long, conflicts_with = "show")]
    all: bool,
}

/// Prints all names, a method in words, or the file of a shipped study.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if let Some(name) = &arguments.show {
        return show(name);
    }
    let mut out = String::new();
    writeln!(out, "benchmark problems (scenes)")?;
    for scene in SCENES {
        writeln!(out, "  {:<26} {}", scene.name, scene.summary)?;
    }
    writeln!(out, "methods")?;
    let racing = CONTENDERS.iter().map(|contender| contender.name.to_owned());
    let names: Vec<String> = if arguments.all { Method::names() } else { racing.collect() };
    for name in &names {
        let parts = Method::named(name).map(|method| method.choices()).unwrap_or_default();
        writeln!(out, "  {name:<26} {parts}")?;
    }
    let others = Method::names().len() - names.len();
    if others > 0 {
        writeln!(out, "  and {others} more: `oedometer list --all`")?;
    }
    writeln!(out, "integrators")?;
    for integrator in IntegratorKind::ALL {
        writeln!(out, "  {}", integrator.name())?;
    }
    writeln!(out, "references")?;
    for kind in ReferenceKind::ALL {
        writeln!(out, "  {}", kind.name())?;
    }
    writeln!(out, "exact solutions without a solver in this program")?;
    for problem in TextbookProblem::ALL {
        writeln!(out, "  {problem}")?;
    }
    writeln!(out, "built-in studies")?;
    for (name, title) in shipped_titles() {
        writeln!(out, "  {name:<26} {title}")?;
    }
    print_data(&out)?;
    Ok(Exit::Pass)
}

/// Prints a method part by part with its sources, or the file of a shipped study.
fn show(name: &str) -> anyhow::Result<Exit> {
    let method = Method::named(name).map(|method| in_words(name, &method));
    let study = || shipped_study(name).map(|study| study.text);
    let scene = || Scene::named(name).map(scene_in_words);
    if let Some(text) = method.or_else(study).or_else(scene) {
        print_data(&text)?;
        return Ok(Exit::Pass);
    }
    let scenes = SCENES.map(|scene| scene.name.to_owned());
    let names: Vec<String> = shipped_names().into_iter().chain(Method::names()).chain(scenes).collect();
    let near = nearest(name, names.iter().map(String::as_str));
    let help =
        near.map_or("`oedometer list` names them".to_owned(), |near| format!("did you mean `{near}`?"));
    Err(Ended::usage(format!("no method, problem or built-in study is called `{name}`: {help}")))
}

/// A scene in words, with its exact solutions, and how to write it in a study.
fn scene_in_words(scene: &Scene) -> String {
    let (name, summary) = (scene.name, scene.summary);
    let solutions: Vec<&str> = scene.reference_kinds().into_iter().map(ReferenceKind::name).collect();
    let solutions = if solutions.is_empty() { "none".to_owned() } else { solutions.join(", ") };
    format!("{name}\n\n  {summary}\n\nexact solutions: {solutions}\nin a study: scene = \"{name}\"\n")
}

/// A method in words: a line for each of its parts, and how to write it in a study.
fn in_words(name: &str, method: &Method) -> String {
    let parts = parts(method);
    let lines = parts.iter().map(|part| {
        let source = if part.source.is_empty() { String::new() } else { format!(" [{}]", part.source) };
        format!("  {:<14} {:<12} {}{source}\n", part.choice, part.word, part.description)
    });
    let lines: String = lines.collect();
    let keys = parts.iter().filter(|part| !part.word.is_empty());
    let keys: Vec<String> = keys.map(|part| format!("{} = \"{}\"", part.choice, part.word)).collect();
    format!("{name}\n\n{lines}\nin a study: method = [\"{name}\"], or its parts: {{ {} }}\n", keys.join(", "))
}
