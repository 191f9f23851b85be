//! `oedometer completions`: shell completions.

use crate::cli::exit::Exit;
use crate::cli::output::print_data;
use crate::study::shipped::shipped_names;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;
use oedometer_exact::{ReferenceKind, TextbookProblem};
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_scenes::SCENES;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Shell that the completions are for
    shell: Shell,
}

/// The command with the names that its arguments take, which a shell then offers.
fn with_names(command: clap::Command) -> clap::Command {
    // clap keeps names as long as the program runs.
    let lasting = |names: Vec<String>| names.into_iter().map(|name| &*name.leak()).collect::<Vec<&str>>();
    let references: Vec<&str> = ReferenceKind::ALL.iter().map(|kind| kind.name()).collect();
    let scenes: Vec<&str> = SCENES.iter().map(|scene| scene.name).collect();
    let with_textbook = |names: &[&'static str]| [names, &TextbookProblem::NAMES].concat();
    let integrators = IntegratorKind::NAMES.to_vec();
    let named = [
        ("method", lasting(Method::names())),
        ("integrator", integrators),
        ("reference", references.clone()),
        ("show", lasting(shipped_names())),
    ];
    command.mut_subcommands(|subcommand| {
        let of_scene = match subcommand.get_name() {
            "exact" => with_textbook(&references),
            "score" => with_textbook(&scenes),
            _ => scenes.clone(),
        };
        let named = named.iter().chain([&("scene", of_scene.clone())]).cloned().collect::<Vec<_>>();
        subcommand.mut_args(|argument| match named.iter().find(|(name, _)| argument.get_id() == name) {
            Some((_, names)) => argument.value_parser(PossibleValuesParser::new(names)),
            None => argument,
        })
    })
}

/// Prints the script with which a shell completes a command.
pub fn run(arguments: &Arguments, command: clap::Command) -> anyhow::Result<Exit> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut with_names(command), "oedometer", &mut script);
    print_data(&String::from_utf8(script)?)?;
    Ok(Exit::Pass)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_offers_each_argument_the_names_that_it_takes() {
        let command = with_names(crate::cli::command());
        let offered = |command_name: &str, argument: &str| -> Vec<String> {
            let found = command.find_subcommand(command_name).expect("a command");
            let argument = found.get_arguments().find(|one| one.get_id() == argument).expect("an argument");
            argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect()
        };
        let scenes: Vec<&str> = SCENES.iter().map(|scene| scene.name).collect();
        let references: Vec<&str> = ReferenceKind::ALL.iter().map(|kind| kind.name()).collect();
        let textbook =
            ["biot-column", "cryer", "barron", "barron-free-strain", "seabed", "injection", "davis-raymond"];
        for name in ["solve", "stability", "new"] {
            assert_eq!(offered(name, "scene"), scenes, "{name}");
        }
        assert_eq!(offered("exact", "scene"), [&references[..], &textbook].concat());
        assert_eq!(offered("score", "scene"), [&scenes[..], &textbook].concat());
        assert_eq!(offered("solve", "reference"), references);
        assert_eq!(offered("score", "reference"), references);
        for name in ["solve", "stability"] {
            assert_eq!(offered(name, "method"), Method::names(), "{name}");
        }
        assert_eq!(offered("solve", "integrator"), ["explicit", "semi-implicit", "implicit"]);
        assert_eq!(offered("list", "show"), shipped_names());
        assert!(offered("solve", "cells").is_empty() && offered("run", "studies").is_empty());
    }
}
