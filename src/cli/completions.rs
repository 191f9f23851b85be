//! `oedometer completions`: what a shell needs to complete the command line.

use super::exit::Exit;
use clap::CommandFactory;
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Shell to write for
    shell: Shell,
}

/// Prints the script of a shell.
pub fn run(arguments: &Arguments) -> Exit {
    let mut command = super::Arguments::command();
    clap_complete::generate(arguments.shell, &mut command, "oedometer", &mut std::io::stdout());
    Exit::Pass
}
