//! `oedometer explain`: which norm and place carries the error of a case, how it stands among the
//! other levels, what changed against the golden values, and the command that runs it again.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::stop;
use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::commands::check::golden_of;
use crate::cli::commands::run::{DEFAULT_RESULTS, load_or_shipped};
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_tables};
use crate::cli::stream::{print_data, say};
use crate::cli::study_files::file_of;
use crate::golden::GoldenError;
use crate::judge::explanation::explain;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::render::tables::explanation;
use crate::study::check::Study;
use std::path::{Path, PathBuf};

/// Cases that are named where a description fits several.
const MOST_NAMED: usize = 10;

/// Arguments of `explain`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Case: the first digits of its hash, words of its label, or a golden value as `check` names it
    case: String,
    /// Study files or names of shipped studies; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder of results: a record that this program made is taken from there, else the case is solved; no other program
    /// is ever started
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Folder of the golden values
    /// [default: golden; for shipped studies without a file there, those inside the program]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Finds, runs where it must, and explains.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let studies = load_or_shipped(&arguments.studies)?;
    let (description, focus) = match arguments.case.split_once(" | ") {
        Some((label, measure)) => (label, Some(measure)),
        None => (arguments.case.as_str(), None),
    };
    let (study, case) = the_one(&studies, description)?;
    let record = record_of(study, case, &arguments.records)?;
    let golden = match golden_of(arguments.golden.as_deref(), &study.name, &arguments.studies) {
        Ok(golden) => Some(golden),
        Err(GoldenError::Missing(_)) => None,
        Err(error) => return Err(Ended::with(Exit::Golden, error.to_string())),
    };
    let siblings = study.cases(Tier::Full);
    let found = explain(&record, &siblings, golden.as_ref(), focus)?;
    if arguments.format == TableFormat::Json {
        print_data(&json_of(&found)?)?;
    } else {
        print_tables(&explanation::tables_of(&record, &found), arguments.format)?;
    }
    say!("{}: {}", study.name, explanation::golden_sentence(&found));
    let file = file_of(&study.name, &arguments.studies);
    say!("run it again: oedometer run {file} --case {}", case.hash());
    Ok(Exit::Pass)
}

/// The one case that a description fits.
fn the_one<'a>(studies: &'a [Study], description: &str) -> anyhow::Result<(&'a Study, &'a Case)> {
    let all =
        studies.iter().flat_map(|study| study.cases(Tier::Full).into_iter().map(move |case| (study, case)));
    let all: Vec<(&Study, &Case)> = all.collect();
    let exact: Vec<_> = all
        .iter()
        .filter(|(study, case)| {
            let label = case.label();
            label == description || format!("{}/{label}", study.name) == description
        })
        .collect();
    let has_words = |told: &str| {
        description.split_whitespace().all(|word| {
            told.split([' ', '/']).any(|part| part == word || part.trim_matches(['(', ')', ',']) == word)
        })
    };
    let by_label = |(_, case): &&(&Study, &Case)| has_words(&format!("{} {}", case.label(), case.method));
    let by_words = |(study, case): &&(&Study, &Case)| {
        case.hash().starts_with(description)
            || has_words(&format!("{}/{} {}", study.name, case.label(), case.method))
    };
    let mut fitting = exact;
    // A study may be called as one of its methods: the case's own words go first.
    if fitting.is_empty() {
        fitting = all.iter().filter(by_label).collect();
    }
    if fitting.is_empty() {
        fitting = all.iter().filter(by_words).collect();
    }
    match fitting.as_slice() {
        [] => Err(Ended::with(
            Exit::NothingSelected,
            match studies {
                [study] => {
                    format!(
                        "no case of `{}` is described by `{description}`: `oedometer plan` lists them",
                        study.name
                    )
                }
                _ => format!("no case is described by `{description}`: `oedometer plan` lists them all"),
            },
        )),
        [(study, case)] => Ok((study, case)),
        several => {
            let mut lines: Vec<String> = several
                .iter()
                .take(MOST_NAMED)
                .map(|(study, case)| format!("  {} {}/{}", case.hash(), study.name, case.label()))
                .collect();
            if several.len() > MOST_NAMED {
                lines.push(format!("  and {} more", several.len() - MOST_NAMED));
            }
            Err(Ended::usage(format!(
                "`{description}` describes {} cases; give the first digits of a hash:\n{}",
                several.len(),
                lines.join("\n")
            )))
        }
    }
}

/// The stored record, if this very program made it; else the case is solved and nothing is kept. Of a case of an attached
/// solver that is run the record is taken as it is, for nothing is started here.
fn record_of(study: &Study, case: &Case, results: &Path) -> anyhow::Result<Record> {
    let store = RecordStore::new(results, &study.name);
    if study.solver_of(case).is_some_and(|solver| !solver.is_given()) {
        return store.kept(case).ok_or_else(|| {
            let reason = format!(
                "there is no record of `{}` in {}, and `explain` starts no solver: `oedometer run … --case {}` does",
                case.label(),
                store.folder().display(),
                case.hash()
            );
            Ended::with(Exit::NothingSelected, reason)
        });
    }
    if let Some(record) = store.finished(case) {
        return Ok(record);
    }
    let record = CaseRunner::of(study).run_alone(case, None)?;
    if stop::is_asked() && is_stopped(&record) {
        return Err(Ended::with(
            Exit::IncompleteMerge,
            "the case was not run to its end, for it was told to end",
        ));
    }
    Ok(record)
}
