//! `oedometer completions`: what a shell needs to complete the command line.

use crate::cli::exit::Exit;
use crate::cli::stream::print_data;
use crate::mpm::method::Method;
use crate::mpm::run::integrator::IntegratorKind;
use crate::scene::SceneKind;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Shell to write for
    shell: Shell,
}

/// The command with the names that its arguments take: a shell offers those, and no files.
fn with_names(mut command: clap::Command) -> clap::Command {
    let methods: Vec<&'static str> = Method::names().into_iter().map(|name| &*name.leak()).collect();
    let names: [(&str, Vec<&'static str>); 3] = [
        ("scene", SceneKind::ALL.iter().map(|scene| scene.name()).collect()),
        ("method", methods),
        ("integrator", IntegratorKind::ALL.iter().map(|integrator| integrator.name()).collect()),
    ];
    for subcommand in ["solve", "stability", "score"] {
        for (argument, names) in &names {
            let takes = |argument: clap::Arg| argument.value_parser(PossibleValuesParser::new(names.clone()));
            let has = command.find_subcommand(subcommand);
            if has.is_some_and(|found| found.get_arguments().any(|one| one.get_id() == *argument)) {
                command = command.mut_subcommand(subcommand, |found| found.mut_arg(*argument, takes));
            }
        }
    }
    command
}

/// Prints the script with which a shell completes a command.
pub fn run(arguments: &Arguments, command: clap::Command) -> anyhow::Result<Exit> {
    let mut script = Vec::new();
    let mut command = with_names(command);
    clap_complete::generate(arguments.shell, &mut command, "oedometer", &mut script);
    print_data(&String::from_utf8(script)?)?;
    Ok(Exit::Pass)
}
