use super::*;
use crate::study::file::StudySource;

fn study(folder: &Path, more: &str, sweep: &str) -> Study {
    let text = format!(
        "title = \"t\"\nscene = \"terzaghi\"\n[[solver]]\nname = \"toy\"\ncommand = [\"sh\", \"adapter.sh\"]\n\
         result = \"{{out}}/a.csv\"\n{more}\n[[sweep]]\nmethod = [{sweep}]\nintegrator = [\"implicit\"]\ncells = [4]\n"
    );
    let name = folder.join("s.toml").display().to_string();
    Study::check(&StudySource { name, text }).expect("sound")
}

#[test]
fn what_is_remembered_follows_commands_environment_and_files_and_no_sweep() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let other = tempfile::TempDir::new().expect("a folder");
    for at in [folder.path(), other.path()] {
        fs::write(at.join("adapter.sh"), "true").expect("a file");
    }
    let digest = |at: &Path, more: &str, sweep: &str| {
        let study = study(at, more, sweep);
        digest_of(&study, &starting(&study))
    };
    let at = folder.path();
    let own = digest(at, "", "\"toy\"");
    assert_eq!(
        digest(at, "timeout = 5\n", "\"MPM\", \"toy\""),
        own,
        "neither cases nor times start anything else"
    );
    assert_ne!(digest(at, "env = { A = \"1\" }\n", "\"toy\""), own);
    assert_ne!(digest(at, "version = [\"sh\", \"-c\", \"true\"]\n", "\"toy\""), own);
    assert_ne!(digest(other.path(), "", "\"toy\""), own, "in another folder it starts another file");
    let mut renamed = study(at, "", "\"toy\"");
    renamed.name = "other".to_owned();
    assert_ne!(digest_of(&renamed, &starting(&renamed)), own, "another study is asked about by itself");
    fs::write(at.join("adapter.sh"), "rm -r elsewhere").expect("a file");
    assert_ne!(digest(at, "", "\"toy\""), own, "the adapter is another one");
}

/// The question names the commands that would start then: a file of a study may have changed since it was read, and
/// the version command is not part of a case's identity.
#[test]
fn a_yes_ends_with_a_change_of_any_file_that_is_started() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    for name in ["adapter.sh", "version.sh", "other.sh", "template.prj", "by-variable.txt"] {
        fs::write(at.join(name), "true").expect("a file");
    }
    let more = "version = [\"sh\", \"version.sh\"]\nfiles = [\"template.prj\"]\n\
                env = { INPUT = \"{study}/by-variable.txt\" }\n";
    let again = |command: &str| {
        let mut study = study(at, more, "\"toy\"");
        study.solvers[0].command[1] = command.to_owned();
        study
    };
    for command in ["adapter.sh", "./adapter.sh", "{study}/adapter.sh"] {
        let read_before = again(command);
        for (name, is_started) in
            [("adapter.sh", true), ("version.sh", true), ("by-variable.txt", true), ("other.sh", false)]
        {
            let digest = |study: &Study| digest_of(study, &starting(study));
            let before = digest(&read_before);
            fs::write(at.join(name), "rm -r elsewhere").expect("a file");
            assert_eq!(digest(&read_before) != before, is_started, "{command}: {name}");
            assert_eq!(digest(&again(command)) != before, is_started, "{command}: {name}, read anew");
            fs::write(at.join(name), "true").expect("a file");
            assert_eq!(digest(&again(command)), before, "{name} is as it was");
        }
        let before = digest_of(&read_before, &starting(&read_before));
        fs::write(at.join("template.prj"), "another").expect("a file");
        let study = again(command);
        assert_ne!(digest_of(&study, &starting(&study)), before, "a file that `files` names");
        fs::write(at.join("template.prj"), "true").expect("a file");
    }
}

#[test]
fn a_study_starts_nothing_until_somebody_allows_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    fs::write(folder.path().join("adapter.sh"), "true").expect("a file");
    let found = study(folder.path(), "", "\"toy\"");
    assert!(!found.may_start_solvers && starting(&found).len() == 1);
    assert!(starting(&study(folder.path(), "", "\"MPM\"")).is_empty(), "no case is of it");
    let mut studies = [found];
    let allow = |allow_solvers| TrustArguments { allow_solvers };
    allow(true).mark(&mut studies, &["s.toml".into()]);
    assert!(studies[0].may_start_solvers);
    remember(&folder.path().join("state"), "abc", "s").expect("written");
    remember(&folder.path().join("state"), "def", "s").expect("written");
    let text = fs::read_to_string(folder.path().join("state").join(REMEMBERED)).expect("a file");
    assert_eq!(text, "abc s\ndef s\n");
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
fn a_digest_is_remembered_as_a_whole_and_in_its_folder_alone() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    assert!(!is_remembered(at, "abcd"), "nothing is remembered yet");
    remember(at, "abcd", "first").expect("written");
    remember(at, "ef01", "second").expect("written");
    for (digest, is_there) in
        [("abcd", true), ("ef01", true), ("abc", false), ("abcde", false), ("first", false), ("", false)]
    {
        assert_eq!(is_remembered(at, digest), is_there, "{digest}");
    }
    assert!(!is_remembered(&at.join("other"), "abcd"));
}

#[test]
fn what_is_allowed_is_kept_with_the_state_of_the_user() {
    let of = |variables: &[(&str, &str)]| {
        folder_by(|name| {
            variables.iter().find(|(own, _)| *own == name).map(|(_, value)| OsString::from(value))
        })
    };
    let [state, local, home] =
        [("XDG_STATE_HOME", "/state"), ("LOCALAPPDATA", "/local"), ("HOME", "/home/me")];
    for (variables, wanted) in [
        (&[home, local, state][..], Some("/state/oedometer")),
        (&[home, local], Some("/local/oedometer")),
        (&[home], Some("/home/me/.local/state/oedometer")),
        (&[("XDG_STATE_HOME", "state"), home], Some("/home/me/.local/state/oedometer")),
        (&[("XDG_STATE_HOME", ""), local], Some("/local/oedometer")),
        (&[("HOME", "me")], None),
        (&[], None),
    ] {
        assert_eq!(of(variables), wanted.map(PathBuf::from), "{variables:?}");
    }
}

#[test]
fn what_would_be_started_is_told_with_its_folder_and_without_what_steers_a_terminal() {
    let folder = tempfile::TempDir::new().expect("a folder");
    fs::write(folder.path().join("adapter.sh"), "true").expect("a file");
    let mut study = study(folder.path(), "", "\"toy\"");
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
