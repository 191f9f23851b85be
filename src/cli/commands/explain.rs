//! `oedometer explain`: which norm and place the error of a case comes from, how it compares with the other levels,
//! what changed against the golden values, and the command that runs it again.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::stop;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::commands::run::{DEFAULT_RESULTS, load_after_run};
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_data, print_tables, say};
use crate::cli::place::{StudyArguments, chosen_as, golden_of};
use crate::golden::GoldenError;
use crate::golden::inputs::CaseInputs;
use crate::judge::explanation::explain;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::render::tables::explanation;
use crate::study::check::Study;
use std::path::{Path, PathBuf};

/// Cases that a message lists if a description fits several.
const MOST_NAMED: usize = 10;

/// Arguments of `explain`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Case: the first digits of its hash, words of its label, or a golden value as `check` names it
    case: String,
    #[command(flatten)]
    studies: StudyArguments,
    /// Folder of results; the case is solved if it has no record of this program there. No other program is started
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Folder of the golden values
    /// [default: `golden` beside the study or above; for shipped studies without a file there, those inside the program]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Finds the case, solves it if its record is missing, and explains it.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let chosen = arguments.studies.chosen()?;
    let studies = load_after_run(&chosen, &arguments.records)?;
    let (description, focus) = match arguments.case.split_once(" | ") {
        Some((label, measure)) => (label, Some(measure)),
        None => (arguments.case.as_str(), None),
    };
    let (study, case) = the_one(&studies, description)?;
    let record = record_of(study, case, &arguments.records)?;
    let golden = match golden_of(arguments.golden.as_deref(), &study.name, &chosen) {
        Ok(golden) => Some(golden.beside(&CaseInputs::of(study.cases(Tier::Ci))).0),
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
    let file = chosen_as(&study.name, &chosen).unwrap_or(Path::new(&study.name));
    say!("run it again: oedometer run {} --case {}", file.display(), case.hash());
    Ok(Exit::Pass)
}

/// The only case that a description fits.
fn the_one<'a>(studies: &'a [Study], description: &str) -> anyhow::Result<(&'a Study, &'a Case)> {
    let all =
        studies.iter().flat_map(|study| study.cases(Tier::Full).into_iter().map(move |case| (study, case)));
    let all: Vec<(&Study, &Case)> = all.collect();
    let is_label = |(study, case): &&(&Study, &Case)| {
        let label = case.label();
        label == description || format!("{}/{label}", study.name) == description
    };
    let has_words = |text: &str| {
        description.split_whitespace().all(|word| {
            text.split([' ', '/']).any(|part| part == word || part.trim_matches(['(', ')', ',']) == word)
        })
    };
    let has_words_of_case =
        |(_, case): &&(&Study, &Case)| has_words(&format!("{} {}", case.label(), case.method));
    let has_hash_or_words = |(study, case): &&(&Study, &Case)| {
        case.hash().starts_with(description)
            || has_words(&format!("{}/{} {}", study.name, case.label(), case.method))
    };
    // A study may have the name of one of its methods, so the case's own words come first.
    let mut fitting: Vec<_> = all.iter().filter(is_label).collect();
    if fitting.is_empty() {
        fitting = all.iter().filter(has_words_of_case).collect();
    }
    if fitting.is_empty() {
        fitting = all.iter().filter(has_hash_or_words).collect();
    }
    match fitting.as_slice() {
        [] => {
            let whose = if let [study] = studies { format!(" of `{}`", study.name) } else { String::new() };
            let reason =
                format!("no case{whose} is described by `{description}`: `oedometer plan` lists them");
            Err(Ended::with(Exit::NothingSelected, reason))
        }
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

/// The stored record, if this program made it; or else the case is solved and nothing is stored. The record of an
/// attached solver is taken as it is, because no other program is started here.
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
        return Err(Ended::with(Exit::IncompleteMerge, "the case was stopped before its end"));
    }
    Ok(record)
}
