//! The command line: one file per subcommand, exit codes in `exit`.
//!
//! Data go to standard output, everything else to standard error.

pub mod commands;
pub mod exit;
mod help;
pub mod job_list;
pub mod output;
pub mod place;
pub mod progress;
pub mod running;
pub mod slurm;
pub mod study_files;
pub mod trust;
use crate::cli::commands::{
    accept, bisect, check, compare, completions, exact, explain, history, list, merge, new, plan, records,
    report, run, schema, score, solve, stability,
};
use crate::cli::exit::Exit;
use crate::cli::output::{say, written};
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// The command line.
#[derive(Debug, Parser)]
#[command(name = "oedometer", version, about = env!("CARGO_PKG_DESCRIPTION"), after_help = exit::HELP, max_term_width = 80)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run studies: one JSON record per case, one tidy CSV per study
    Run(run::Arguments),
    /// Run missing cases and write the report
    Report(report::Arguments),
    /// Check studies against their expectations and golden values
    Check(check::Arguments),
    /// Accept the current values of a study as its golden values
    Accept(accept::Arguments),
    /// Print an exact solution
    Exact(exact::Arguments),
    /// Solve one case and print its errors
    Solve(solve::Arguments),
    /// Compare another program's result with exact solutions
    Score(score::Arguments),
    /// Predict and observe the critical time step
    Stability(stability::Arguments),
    /// List a study's cases and estimate the run time
    Plan(plan::Arguments),
    /// List the contents of a results folder, or print single records
    Records(records::Arguments),
    /// Merge the records of shards, and write the table of each study
    Merge(merge::Arguments),
    /// List benchmark problems, methods, references and built-in studies
    List(list::Arguments),
    /// Write a commented study
    New(new::Arguments),
    /// Write a study that attaches another solver, with its adapter
    NewSolver(new::SolverArguments),
    /// Show where the error of a case comes from, and what changed
    Explain(explain::Arguments),
    /// Compare two states: results folders or git revisions
    Compare(compare::Arguments),
    /// Show golden values over the commits that changed them
    History(history::Arguments),
    /// Find the commit that changed the results of a study
    Bisect(bisect::Arguments),
    /// Print the JSON Schema of studies, records, mappings or cases
    Schema(schema::Arguments),
    /// Print shell completions
    Completions(completions::Arguments),
}

/// The command line with its help texts.
fn command() -> clap::Command {
    help::dressed(Arguments::command())
}

/// The arguments of a command line. Help texts are dressed where one is asked for, and not at every start.
fn parsed(words: &[OsString]) -> Result<Arguments, clap::Error> {
    Arguments::try_parse_from(words).or_else(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            Arguments::from_arg_matches(&command().try_get_matches_from(words)?)
        }
        _ => Err(error),
    })
}

/// Parses the command line, runs the command, and turns its end into an exit code.
pub fn main() -> ExitCode {
    ExitCode::from(main_with(std::env::args_os()))
}

/// Runs the command of a command line, the program's name first, and returns the exit code.
pub fn main_with(words: impl IntoIterator<Item = OsString>) -> u8 {
    let _at_work = crate::campaign::stop::begin();
    let words: Vec<_> = words.into_iter().collect();
    let arguments = match parsed(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are requested: not a usage error.
            let said = error.print().and_then(|()| std::io::stdout().flush());
            return match written(said) {
                _ if error.use_stderr() => Exit::Usage as u8,
                Ok(()) => Exit::Pass as u8,
                Err(refused) => end_of(Err(refused)),
            };
        }
    };
    end_of(run(arguments.command))
}

fn run(command: Command) -> anyhow::Result<Exit> {
    match command {
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
        Command::Records(arguments) => records::run(&arguments),
        Command::List(arguments) => list::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::NewSolver(arguments) => new::run_solver(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::History(arguments) => history::run(&arguments),
        Command::Bisect(arguments) => bisect::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments, self::command()),
    }
}

/// The exit code of a command; the message of an error goes to standard error.
fn end_of(result: anyhow::Result<Exit>) -> u8 {
    match result {
        Ok(exit) => exit as u8,
        Err(error) => {
            say!("{}", exit::sentence(&error));
            Exit::of(&error) as u8
        }
    }
}
