//! `oedometer completions`: what a shell needs to complete the command line.

use crate::cli::exit::Exit;
use crate::cli::stream::print_data;
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Shell to write for
    shell: Shell,
}

/// Prints the script with which a shell completes a command.
pub fn run(arguments: &Arguments, mut command: clap::Command) -> anyhow::Result<Exit> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "oedometer", &mut script);
    print_data(&String::from_utf8(script)?)?;
    Ok(Exit::Pass)
}
