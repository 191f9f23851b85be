//! `oedometer check`: the CI tier again, judged by its expectations and by its golden values.

use crate::campaign::runner::{RunReport, Tally};
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit, sentence};
use crate::cli::help::EXPERT;
use crate::cli::output::{
    TableFormat, append, is_on, json_of, path_in, print_coloured, print_data, say, terminal_width,
    write_document,
};
use crate::cli::place::{DEFAULT_RESULTS, StudyArguments, chosen_as, golden_folder, golden_of};
use crate::cli::running::{jobs_of, run_ci_tier};
use crate::cli::study_files::load_sound;
use crate::cli::trust::{self, TrustArguments};
use crate::golden::{GoldenError, GoldenFile};
use crate::history::accepted_inputs::changes_since;
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::judge::study_results::StudyResults;
use crate::judge::unneeded_data::drop_unneeded;
use crate::questions::answers;
use crate::questions::finding::{Finding, Place};
use crate::record::Record;
use crate::report::annotations::annotations_of;
use crate::report::check_page::{self, Terminal};
use crate::report::junit::junit;
use crate::study::check::Study;
use oedometer_wording::count_of;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Arguments of `check`.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Folder of the golden values
    /// [default: `golden` beside the study or above; otherwise, for built-in studies, those in the program]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Results folder; cases that this build has already solved are reused from it. Attached solvers always run,
    /// unless the study declares what identifies them
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Number of cases that run in parallel [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Solve every case; reuse no earlier results
    #[arg(long)]
    fresh: bool,
    /// Write a `JUnit` report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Append a summary in Markdown [default: $`GITHUB_STEP_SUMMARY`, if set]
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    summary: Option<PathBuf>,
    /// Write GitHub annotations of study lines to standard error; default in GitHub workflows
    #[arg(long, help_heading = EXPERT)]
    annotate: bool,
    /// Print only the verdict on each study
    #[arg(short, long, conflicts_with = "format")]
    quiet: bool,
    /// Print all that the studies answer, whether or not it fits a screen
    #[arg(short, long, conflicts_with_all = ["format", "quiet"])]
    verbose: bool,
    #[command(flatten)]
    trust: TrustArguments,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Runs, judges, compares and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let chosen = arguments.studies.chosen()?;
    let (mut studies, bad) = load_sound(&chosen, &arguments.records)?;
    arguments.trust.mark(&mut studies, &chosen);
    let (reports, golden) = reports_of(arguments, &studies, &chosen)?;
    let (results, tally) = results_of(arguments, (&studies, &chosen), &reports, golden);
    if results.is_empty() {
        return Err(Ended::with(Exit::NothingSelected, "no study has a case at the test level `ci`"));
    }
    // What a study answers by itself stands below the verdict on it alone; a reference that refuses a case is a failure there.
    let answers = match results.as_slice() {
        [one] if !arguments.quiet => answers(std::slice::from_ref(one), Place::Terminal).unwrap_or_default(),
        _ => Vec::new(),
    };
    let checks: Vec<StudyCheck> = results.into_iter().map(|results| results.check).collect();
    let verdict = worst_of(&checks);
    // The verdict first; what could not be written is told after it, and hides it nowhere.
    let files = |study: &str| Some(chosen_as(study, &chosen)?.display().to_string());
    // A study that cannot be read keeps no other from being judged.
    let unread = bad.first().map(Exit::of);
    let mut refused = bad;
    let printed = if arguments.quiet {
        print_coloured(&verdicts_alone(&checks))
    } else {
        print(&checks, files, &answers, arguments)
    };
    refused.extend(printed.err());
    if let Some(path) = &arguments.junit {
        refused.extend(write_document(path, &junit(&checks)?).err());
    }
    if let Some(path) = arguments.summary.clone().or_else(|| path_in("GITHUB_STEP_SUMMARY")) {
        refused.extend(append(&path, &check_page::markdown_of(&checks, files)?).err());
    }
    if arguments.annotate || is_on("GITHUB_ACTIONS") {
        for line in annotations_of(&checks, files) {
            say!("{line}");
        }
    }
    for error in &refused {
        say!("{}", sentence(error));
    }
    // Of a study that cannot be read nobody knows whether it passes: that is worse than golden values not yet accepted.
    let end = match verdict {
        Exit::Golden => unread.unwrap_or(verdict),
        Exit::Pass => refused.first().map_or(Exit::Pass, Exit::of),
        failed => failed,
    };
    Ok(trust::end_with(tally, end))
}

/// Cases of a study whose errors are shown, whichever its expectations are of.
const MOST_SHOWN_CASES: usize = 64;

/// Golden values of a study, or why there are none.
type Golden = Result<GoldenFile, GoldenError>;

/// The runs of the CI tier, and the golden values to compare them with.
fn reports_of(
    arguments: &Arguments,
    studies: &[Study],
    chosen: &[PathBuf],
) -> anyhow::Result<(Vec<RunReport>, Vec<Golden>)> {
    let read = |name: &str| golden_of(arguments.golden.as_deref(), name, chosen);
    let golden: Vec<_> = studies.iter().map(|study| read(&study.name)).collect();
    // Where no golden value is compared, a record is held as far as its verdicts go.
    let is_alone = studies.iter().zip(&golden).filter(|(_, golden)| golden.is_err());
    let alone: BTreeSet<&str> = is_alone.map(|(study, _)| study.name.as_str()).collect();
    let thin_alone = |study: &Study, record: &mut Record| {
        if alone.contains(study.name.as_str()) && study.planned.len() > MOST_SHOWN_CASES {
            drop_unneeded(study, record);
        }
    };
    let records = (!arguments.fresh).then_some(arguments.records.as_path());
    let reports = run_ci_tier(studies, jobs_of(arguments.jobs), records, &thin_alone)?;
    let taken: usize = reports.iter().map(|report| report.resumed - report.taken_over.len()).sum();
    if taken > 0 {
        let all: usize = studies.iter().map(|study| study.cases(Tier::Ci).len()).sum();
        say!(
            "reused {taken} of {} from {} (same build); `--fresh` runs them again",
            count_of(all, "case", "cases"),
            arguments.records.display()
        );
    }
    Ok((reports, golden))
}

/// The studies that have cases in the CI tier with the verdicts on them, and how the cases of all ended.
fn results_of<'a>(
    arguments: &Arguments,
    (studies, chosen): (&'a [Study], &[PathBuf]),
    reports: &'a [RunReport],
    golden: Vec<Golden>,
) -> (Vec<StudyResults<'a>>, Tally) {
    let (mut results, mut tally) = (Vec::new(), Tally::default());
    for ((study, golden), report) in studies.iter().zip(golden).zip(reports) {
        tally.join(report.tally);
        if !(report.records.is_empty() && report.errors.is_empty()) {
            let hashes = golden.as_ref().map(|golden| golden.cases.clone()).unwrap_or_default();
            let mut compared = StudyResults::compared(study, &report.records, Tier::Ci, golden);
            compared.check = compared.check.with_errors(&report.errors);
            if !compared.check.other_inputs.is_empty() {
                let folder = golden_folder(arguments.golden.as_deref(), &study.name, chosen);
                let file = chosen_as(&study.name, chosen).unwrap_or(Path::new(&study.name));
                let changes = changes_since(&hashes, study, file, &folder);
                compared.check = compared.check.with_input_changes(changes);
            }
            results.push(compared.with_taken_over(&report.taken_over));
        }
    }
    (results, tally)
}

/// The worst end of checks, in the order verdict, case, golden, pass.
fn worst_of(checks: &[StudyCheck]) -> Exit {
    let order = [
        (CheckEnd::Failed, Exit::VerdictFailed),
        (CheckEnd::CaseFailed, Exit::CaseFailed),
        (CheckEnd::Golden, Exit::Golden),
        (CheckEnd::HeldBack, Exit::IncompleteMerge),
    ];
    let worst = order.into_iter().find(|(end, _)| checks.iter().any(|check| check.end() == *end));
    worst.map_or(Exit::Pass, |(_, exit)| exit)
}

/// The verdicts on all studies, a line each.
fn verdicts_alone(checks: &[StudyCheck]) -> String {
    checks.iter().map(|check| check_page::verdict_on(check, terminal_width())).collect()
}

fn print(
    checks: &[StudyCheck],
    file_of: impl Fn(&str) -> Option<String> + Copy,
    answers: &[Finding],
    arguments: &Arguments,
) -> anyhow::Result<()> {
    let text = match arguments.format {
        TableFormat::Table => {
            let terminal = Terminal { width: terminal_width(), is_whole: arguments.verbose };
            let text = |check: &StudyCheck| {
                check_page::text_of(check, file_of(&check.study).as_deref(), answers, terminal)
            };
            // What fails stands first.
            let (sound, unsound): (Vec<_>, Vec<_>) =
                checks.iter().partition(|check| check.end() == CheckEnd::Pass);
            let texts: Result<String, _> = unsound.into_iter().chain(sound).map(text).collect();
            return print_coloured(&texts?);
        }
        TableFormat::Markdown => check_page::markdown_of(checks, file_of)?,
        TableFormat::Csv => check_page::all_judgements(checks).to_csv()?,
        TableFormat::Json => json_of(&checks)?,
    };
    print_data(&text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::running::run_quietly;
    use crate::judge::study_check::CaseNote;
    use crate::study::file::StudySource;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                         integrator = ['implicit']\ncells = [3]\n";

    /// The check of a study that is as its golden values say, and one whose golden values are missing.
    fn checks() -> [StudyCheck; 2] {
        let source = StudySource { name: "t.toml".to_owned(), text: STUDY.to_owned() };
        let study = Study::check(&source).expect("sound");
        let records = run_quietly(std::slice::from_ref(&study), 1).expect("records").remove(0);
        let golden = GoldenFile::of("t", &records, "a reason");
        [Ok(golden), GoldenFile::read("no-such-folder".as_ref(), "t")]
            .map(|golden| StudyCheck::new(&study, &records, Tier::Ci, golden))
    }

    fn note(case: &str) -> CaseNote {
        CaseNote { case: case.to_owned(), sentence: format!("{case} is odd") }
    }

    #[test]
    fn the_worst_end_of_all_studies_is_that_of_the_command() {
        let with = |change: fn(&mut StudyCheck)| {
            let [mut check, _] = checks();
            change(&mut check);
            check
        };
        let pass = || with(|_| {});
        let case = || with(|check| check.failed_cases = vec![note("a")]);
        let unsound = || with(|check| check.unsound = vec![note("a")]);
        let golden = || checks().into_iter().next_back().expect("one");
        assert_eq!(worst_of(&[]), Exit::Pass);
        for (all, exit) in [
            (vec![pass(), pass()], Exit::Pass),
            (vec![golden(), pass()], Exit::Golden),
            (vec![pass(), golden(), case()], Exit::CaseFailed),
            (vec![case(), golden()], Exit::CaseFailed),
            (vec![unsound(), case(), golden()], Exit::VerdictFailed),
            (vec![golden(), case(), unsound()], Exit::VerdictFailed),
        ] {
            assert_eq!(worst_of(&all), exit);
        }
    }

    #[test]
    fn a_study_without_golden_values_passes_by_its_expectations_alone() {
        for (below, exit) in [("0.9", Exit::Pass), ("1e-9", Exit::VerdictFailed)] {
            let expects = format!("[[expect_case]]\ntime_factor = 0.1\nerror = {{ below = {below} }}\n");
            let text = format!("golden = 'none'\n{STUDY}{expects}");
            let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
            let records = run_quietly(std::slice::from_ref(&study), 1).expect("records").remove(0);
            let missing = GoldenFile::read(std::path::Path::new("no-such-folder"), "t");
            let check = StudyCheck::new(&study, &records, Tier::Ci, missing);
            assert_eq!(worst_of(std::slice::from_ref(&check)), exit);
            assert!(!junit(&[check]).expect("a document").contains("t/golden"));
        }
    }

    #[test]
    fn a_study_that_cannot_be_read_keeps_no_other_from_being_judged() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).expect("a file");
            path
        };
        let [bad, good] = [file("bad.toml", "title = 1"), file("good.toml", STUDY)];
        let (studies, refused) = load_sound(&[bad.clone(), good], folder.path()).expect("one is sound");
        let names: Vec<&str> = studies.iter().map(|study| study.name.as_str()).collect();
        assert_eq!(
            (names, refused.iter().map(Exit::of).collect::<Vec<_>>()),
            (vec!["good"], vec![Exit::Usage])
        );
        assert!(load_sound(&[bad], folder.path()).is_err(), "nothing is left to judge");
    }

    #[test]
    fn the_json_of_a_check_has_each_list_under_its_name() {
        let [mut check, missing] = checks();
        check.failed_cases = vec![note("failed")];
        check.unsound = vec![note("unsound")];
        check.agreeing = 17;
        check.proposals = vec!["proposed".to_owned()];
        check.warnings = vec!["warned".to_owned()];
        check.other_inputs = vec!["changed".to_owned()];
        let wanted = serde_json::json!({
            "study": "t", "end": "failed", "judgements": [],
            "failed_cases": [{ "case": "failed", "sentence": "failed is odd" }],
            "unsound_records": [{ "case": "unsound", "sentence": "unsound is odd" }],
            "golden_values_that_agree": 17, "golden_problem": null, "proposed_expectations": ["proposed"],
            "cases_of_other_inputs": ["changed"],
            "groups": [], "differences": [], "accuracy_and_cost": [], "taken_over": [], "warnings": ["warned"],
            "diagnoses": [],
        });
        assert_eq!(serde_json::to_value(&check).expect("plain data"), wanted);
        let told = serde_json::to_value(&missing).expect("plain data");
        let why = "there are no golden values yet (no-such-folder/t.csv): if the results look right, accept \
                   them with `oedometer accept` and a reason";
        assert_eq!((&told["golden_problem"], &told["end"]), (&why.into(), &"golden".into()));
    }
}
