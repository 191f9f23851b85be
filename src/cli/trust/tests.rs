use super::*;
use crate::study::file::StudySource;
use std::fs;
use std::path::Path;

fn study(folder: &Path, sweep: &str) -> Study {
    let text = format!(
        "title = \"t\"\nscene = \"terzaghi\"\n[[solver]]\nname = \"toy\"\ncommand = [\"sh\", \"adapter.sh\"]\n\
         result = \"{{out}}/a.csv\"\n[[sweep]]\nmethod = [{sweep}]\nintegrator = [\"implicit\"]\ncells = [4]\n"
    );
    let name = folder.join("s.toml").display().to_string();
    Study::check(&StudySource { name, text }).expect("sound")
}

#[test]
fn a_study_starts_nothing_until_somebody_allows_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    fs::write(folder.path().join("adapter.sh"), "true").expect("a file");
    let found = study(folder.path(), "\"toy\"");
    assert!(!found.may_start_solvers && starting(&found).len() == 1);
    assert!(starting(&study(folder.path(), "\"MPM\"")).is_empty(), "no case is of it");
    let mut studies = [found];
    let allow = |allow_solvers| TrustArguments { allow_solvers };
    allow(true).mark(&mut studies, &["s.toml".into()]);
    assert!(studies[0].may_start_solvers);
}

#[test]
fn cases_that_were_not_allowed_to_run_are_no_success_and_hide_no_failure() {
    let tally = |held_back: usize| Tally { held_back, ..Tally::default() };
    assert_eq!(end_with(tally(0), Exit::Pass), Exit::Pass);
    assert_eq!(end_with(tally(0), Exit::VerdictFailed), Exit::VerdictFailed);
    assert_eq!(end_with(tally(2), Exit::Pass), Exit::IncompleteMerge);
    assert_eq!(end_with(tally(2), Exit::VerdictFailed), Exit::VerdictFailed);
}

#[test]
fn what_would_be_started_is_told_with_its_folder_and_without_what_steers_a_terminal() {
    let folder = tempfile::TempDir::new().expect("a folder");
    fs::write(folder.path().join("adapter.sh"), "true").expect("a file");
    let mut study = study(folder.path(), "\"toy\"");
    let at = study.solvers[0].folder.display().to_string();
    assert_eq!(commands_of(&starting(&study)), format!("`sh adapter.sh` in {at}"));
    study.solvers[0].command[1] = "a\u{1b}[2J".to_owned();
    assert_eq!(commands_of(&starting(&study)), format!("`sh a\\u{{1b}}[2J` in {at}"));
    study.solvers[0].command[1] = "x".repeat(400);
    let long = format!("`sh {}` in {at}", "x".repeat(297));
    assert_eq!(commands_of(&starting(&study)), long);
    let twice = [&study.solvers[0], &study.solvers[0]];
    assert_eq!(commands_of(&twice), format!("{long} and {long}"));
}
