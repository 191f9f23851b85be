//! `oedometer compare`: two states of studies beside each other, accuracy and cost apart.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_data, print_tables, say};
use crate::cli::place::repository_with;
use crate::cli::study_files::load;
use crate::cli::trust::TrustArguments;
use crate::history::comparison::{StudyComparison, compare_states};
use crate::history::state::{self, State, with_command};
use crate::report::history_tables::{comparison_rows, comparison_tables};
use std::path::{Path, PathBuf};

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// First state: a results folder of `run --out`, or a git revision with golden values
    #[arg(value_name = "A")]
    before: String,
    /// Second state
    #[arg(value_name = "B")]
    after: String,
    /// Names of studies [default: all studies in both states]
    #[arg(value_name = "STUDY")]
    studies: Vec<String>,
    /// A and B are commands that replace the command of the study's `[[solver]]`
    #[arg(long)]
    commands: bool,
    /// How often each command runs, in turn
    #[arg(long, value_name = "N", default_value_t = 3, requires = "commands", value_parser = clap::value_parser!(u64).range(1..=1000))]
    rounds: u64,
    #[command(flatten)]
    trust: TrustArguments,
    /// Folder of the golden values in the repository [default: `golden` here or above]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Reads or makes both states, compares and prints; exit code 1 where something got worse.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let named = [&arguments.before, &arguments.after].map(String::as_str);
    let ([before, after], studies) = if arguments.commands {
        (states_of_commands(named, arguments)?, &[][..])
    } else {
        let [before, after] =
            named.map(|name| state_of(name, arguments.golden.as_deref(), &arguments.studies));
        ([before?, after?], &arguments.studies[..])
    };
    if !arguments.commands {
        let [before, after] = named.map(what_of);
        say!("compared: {before} with {after}; nothing was solved");
    }
    let (mut comparisons, notes) = compare_states(&before, &after, studies);
    for note in &notes {
        say!("{note}");
    }
    // Nothing that is the same is no agreement.
    comparisons.retain(|comparison| comparison.values + comparison.unpaired > 0);
    if comparisons.is_empty() {
        return Err(Ended::with(
            Exit::NothingSelected,
            format!("{} and {} share no values of any study", before.name, after.name),
        ));
    }
    let names = [before.name.as_str(), &after.name];
    match arguments.format {
        TableFormat::Json => print_data(&json_of(&comparisons)?)?,
        TableFormat::Csv => print_tables(&[comparison_rows(&comparisons, names)], TableFormat::Csv)?,
        format => print_tables(&comparison_tables(&comparisons, names), format)?,
    }
    let regressed: Vec<&StudyComparison> =
        comparisons.iter().filter(|comparison| comparison.is_regression()).collect();
    say!("{} of {} studies got worse", regressed.len(), comparisons.len());
    Ok(if regressed.is_empty() { Exit::Pass } else { Exit::VerdictFailed })
}

/// What is compared of a state as it is named.
fn what_of(named: &str) -> String {
    let what = if Path::new(named).is_dir() { "the records in" } else { "the golden values in" };
    format!("{what} {named}")
}

/// The states of two commands on the one study that is named.
fn states_of_commands(commands: [&str; 2], arguments: &Arguments) -> anyhow::Result<[State; 2]> {
    let [named] = arguments.studies.as_slice() else {
        return Err(Ended::usage(
            "`--commands` takes one study file: the commands replace that of its `[[solver]]`",
        ));
    };
    let named = [PathBuf::from(named)];
    let study = load(&named, None)?;
    let [before, after] = commands.map(|command| with_command(&study[0], command).map_err(Ended::usage));
    let mut studies = [before?, after?];
    arguments.trust.mark_all(&mut studies, &named)?;
    let rounds = usize::try_from(arguments.rounds).unwrap_or(1);
    Ok(state::states_of_commands(&studies, commands, rounds))
}

/// A state as it is named: a folder, or a revision of the repository around the current folder.
pub fn state_of(named: &str, golden: Option<&Path>, studies: &[String]) -> anyhow::Result<State> {
    let usage = |error: &dyn std::fmt::Display| Ended::usage(error.to_string());
    let folder = Path::new(named);
    if folder.is_dir() {
        return State::of_records(folder).map_err(|error| usage(&error));
    }
    let (repository, folder) = repository_with(golden, studies)?;
    State::of_revision(&repository, named, &folder).map_err(|error| usage(&error))
}
