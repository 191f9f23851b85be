//! `oedometer explain`: which norm and place the error of a case comes from, what changed against the golden values, and the
//! command that runs it again.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::stop;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_data, print_tables, say};
use crate::cli::place::{DEFAULT_RESULTS, StudyArguments, chosen_as, golden_of};
use crate::cli::study_files::load;
use crate::golden::GoldenError;
use crate::judge::explanation::explain;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::report::tables::explanation;
use crate::study::check::Study;
use oedometer_wording::first_few;
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
    /// Results folder; the case is solved if it has no record of this program there. Starts no other program
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Folder of the golden values
    /// [default: `golden` beside the study or above; otherwise, for built-in studies, those in the program]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Finds the case, solves it if its record is missing, and explains it.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let chosen = arguments.studies.chosen()?;
    let studies = load(&chosen, Some(&arguments.records))?;
    let (description, focus) = match arguments.case.split_once(" | ") {
        Some((label, measure)) => (label, Some(measure)),
        None => (arguments.case.as_str(), None),
    };
    let (study, case) = described_case(&studies, description)?;
    let file = chosen_as(&study.name, &chosen).unwrap_or(Path::new(&study.name));
    let record = record_of(study, case, file, &arguments.records)?;
    let golden = match golden_of(arguments.golden.as_deref(), &study.name, &chosen) {
        Ok(golden) => Some(golden.beside(&study.cases(Tier::Ci))),
        Err(GoldenError::Missing(_)) => None,
        Err(error) => return Err(Ended::with(Exit::Golden, error.to_string())),
    };
    let explained = explain(&record, golden.as_ref(), focus)?;
    if arguments.format == TableFormat::Json {
        print_data(&json_of(&explained)?)?;
    } else {
        print_tables(&explanation::tables_of(&record, &explained), arguments.format)?;
    }
    say!("{}: {}", study.name, explanation::golden_sentence(&explained));
    say!("run it again: oedometer run {} --case {}", file.display(), case.hash());
    Ok(Exit::Pass)
}

/// Whether a description fits a case.
type Way<'a> = &'a dyn Fn(&&(&Study, &Case)) -> bool;

/// The only case that a description fits.
fn described_case<'a>(studies: &'a [Study], description: &str) -> anyhow::Result<(&'a Study, &'a Case)> {
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
    let ways: [Way<'_>; 3] = [&is_label, &has_words_of_case, &has_hash_or_words];
    let mut fitting = ways.iter().map(|fits| all.iter().filter(fits).collect::<Vec<_>>());
    let fitting = fitting.find(|fitting| !fitting.is_empty()).unwrap_or_default();
    match fitting.as_slice() {
        [] => {
            let whose = if let [study] = studies { format!(" of `{}`", study.name) } else { String::new() };
            let reason = format!("no case{whose} matches `{description}`: `oedometer plan` lists all cases");
            Err(Ended::with(Exit::NothingSelected, reason))
        }
        [(study, case)] => Ok((study, case)),
        several => {
            let name =
                |(study, case): &&(&Study, &Case)| format!("{} {}/{}", case.hash(), study.name, case.label());
            let names = first_few(several.iter().map(name).collect(), MOST_NAMED);
            Err(Ended::usage(format!(
                "`{description}` matches {} cases; give the first digits of a hash:\n  {}",
                several.len(),
                names.join("\n  ")
            )))
        }
    }
}

/// The stored record, if this program made it; or else the case is solved and nothing is stored. The record of
/// another program is used as it is, because no solver starts here.
fn record_of(study: &Study, case: &Case, file: &Path, results: &Path) -> anyhow::Result<Record> {
    let store = RecordStore::new(results, &study.name);
    if study.solver_of(case).is_some_and(|solver| !solver.is_given()) {
        return store.kept(case).ok_or_else(|| {
            let reason = format!(
                "there is no record of `{}` in {} (`check` writes none), and `explain` starts no solver: first run \
                 `oedometer run {} --case {} --allow-solvers`",
                case.label(),
                store.folder().display(),
                file.display(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::file::StudySource;

    fn study(name: &str, sweep: &str) -> Study {
        let text = format!(
            "title = 't'\nscene = 'terzaghi'\n[[result]]\nname = 'ogs'\nfiles = ['a-{{cells}}.csv']\ncells = [4]\n\
             [[sweep]]\nintegrator = ['implicit']\ntime_step = [{{ growth = 0.1 }}]\n{sweep}\n"
        );
        Study::check(&StudySource { name: format!("{name}.toml"), text }).expect("sound")
    }

    fn found(studies: &[Study], description: &str) -> Result<String, (Exit, String)> {
        match described_case(studies, description) {
            Ok((study, case)) => Ok(format!("{}/{}", study.name, case.label())),
            Err(error) => Err((Exit::of(&error), error.to_string())),
        }
    }

    #[test]
    fn a_case_is_found_by_its_label_its_words_or_the_first_digits_of_its_hash() {
        let swept = "method = ['MPM', 'GIMP']\ncells = [4]\nporosity = [0.3, 0.4]";
        let studies = [study("ogs", swept), study("mine", "method = ['MPM']\ncells = [8]")];
        let label = "MPM implicit cells=4 points=2 growth=0.1 (porosity=0.4)";
        let case = format!("ogs/{label}");
        let hash = studies[0].planned[1].case.hash();
        for description in [label, &case, "MPM porosity=0.4", "porosity=0.4 ogs MPM", &hash, &hash[..9]] {
            assert_eq!(found(&studies, description), Ok(case.clone()), "{description}");
        }
        // The case's own words come before the name of a study.
        assert_eq!(found(&studies[..1], "ogs"), Ok("ogs/ogs cells=4 (porosity=0.3)".to_owned()));
        let mine = "mine/MPM implicit cells=8 points=2 growth=0.1";
        for description in ["cells=8", "mine MPM", "MPM mine"] {
            assert_eq!(found(&studies, description), Ok(mine.to_owned()), "{description}");
        }
        let told = |whose: &str, what: &str| {
            let reason = format!("no case{whose} matches `{what}`: `oedometer plan` lists all cases");
            Err((Exit::NothingSelected, reason))
        };
        assert_eq!(found(&studies, "cells=5"), told("", "cells=5"));
        for what in ["MP", "cells=", "porosity=0.45", "4"] {
            let what = format!("{what} GIMP cells=4");
            assert_eq!(found(&studies[..1], &what), told(" of `ogs`", &what));
        }
    }

    #[test]
    fn ten_of_the_cases_that_a_description_fits_are_listed_and_the_others_counted() {
        for (count, more) in [(2, ""), (10, ""), (11, "\n  and 1 more"), (13, "\n  and 3 more")] {
            let cells: Vec<String> = (2..2 + count).map(|cells| cells.to_string()).collect();
            let studies = [study("mine", &format!("method = ['MPM']\ncells = [{}]", cells.join(", ")))];
            let lines: Vec<String> = studies[0].planned[..count.min(10)]
                .iter()
                .map(|planned| format!("\n  {} mine/{}", planned.case.hash(), planned.case.label()))
                .collect();
            let told = format!(
                "`MPM` matches {count} cases; give the first digits of a hash:{}{more}",
                lines.concat()
            );
            assert_eq!(found(&studies, "MPM"), Err((Exit::Usage, told)));
        }
    }
}
