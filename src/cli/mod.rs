//! The command line: one file a subcommand, exit codes in one place.
//!
//! Data goes to standard output, everything else to standard error.

mod accept;
mod check;
mod completions;
mod exact;
mod exit;
mod explain;
mod list;
mod merge;
mod output;
mod overrides;
mod plan;
mod progress;
mod report;
mod run;
mod schema;
mod score;
mod solve;
mod spread;
mod stability;
mod study_files;

pub use exit::Exit;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Verifies coupled material point solvers for saturated soil against exact solutions.
#[derive(Debug, Parser)]
#[command(name = "oedometer", version, about, after_help = exit::HELP, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run studies: one JSON record a case, one tidy CSV a study
    Run(run::Arguments),
    /// Run what is missing and render the whole report
    Report(report::Arguments),
    /// Judge studies by their expectations and by their golden values
    Check(check::Arguments),
    /// Take the present values of a study as its golden values
    Accept(accept::Arguments),
    /// Print an exact solution
    Exact(exact::Arguments),
    /// Solve one case and print its errors
    Solve(solve::Arguments),
    /// Hold somebody else's result against exact solutions
    Score(score::Arguments),
    /// Predict and observe the critical time step
    Stability(stability::Arguments),
    /// List the cases of studies with their hashes
    Plan(plan::Arguments),
    /// Bring the records of shards together, with the whole table of each study
    Merge(merge::Arguments),
    /// List scenes, methods, references and shipped studies
    List,
    /// Say where the error of a case comes from and what changed
    Explain(explain::Arguments),
    /// Measure how far results scatter that should be equal
    Spread(spread::Arguments),
    /// Print the JSON Schema of study files, records or mappings
    Schema(schema::Arguments),
    /// Print the completions of a shell
    Completions(completions::Arguments),
}

/// Parses the command line, runs the command, and turns its end into an exit code.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are asked for, and no usage error.
            let exit = if error.use_stderr() { Exit::Usage } else { Exit::Pass };
            let _ = error.print();
            return exit.into();
        }
    };
    let result = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Accept(arguments) => accept::run(&arguments),
        Command::Exact(arguments) => exact::run(&arguments),
        Command::Solve(arguments) => solve::run(&arguments),
        Command::Score(arguments) => score::run(&arguments),
        Command::Stability(arguments) => stability::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::List => list::run(),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Spread(arguments) => spread::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
        Command::Completions(arguments) => Ok(completions::run(&arguments)),
    };
    match result {
        Ok(exit) => exit.into(),
        Err(error) => {
            let failure = exit::Failure::of(&error);
            if !failure.is_silent {
                eprintln!("{}", exit::sentence(&error));
            }
            failure.exit.into()
        }
    }
}
