//! A small repository of golden values over its commits, folders of records, and commands in turn.

use crate::campaign::runner::{RunOptions, run_study};
use crate::case::{Case, Tier};
use crate::golden::GoldenFile;
use crate::golden::measure::key;
use crate::history::comparison::Trend;
use crate::history::repository::{Commit, GitError, Repository};
use crate::history::state::{State, StateError};
use crate::history::timeline::timelines;
use crate::record::{Record, RecordStore};
use crate::study::check::Study;
use crate::study::file::StudySource;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

fn git(at: &Path, words: &[&str]) {
    let mut command = Command::new("git");
    command.args(["-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false"]);
    command.env("GIT_COMMITTER_DATE", "2026-11-20T12:00:00Z").env("GIT_AUTHOR_DATE", "2020-01-01T12:00:00Z");
    let output = command.args(words).current_dir(at).output().expect("git");
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
}

const LABEL: &str = "MPM implicit cells=4 points=2 growth=0.05";
const PRESSURE: &str = "pressure points terzaghi";

/// A golden file of one case with an error and its steps.
fn golden(study: &str, error: f64, steps: f64, reason: &str) -> String {
    let values = [(key(LABEL, 0.1, PRESSURE), error), (key(LABEL, None, "steps"), steps)];
    GoldenFile { values: values.into(), ..GoldenFile::of(study, &[], reason) }.to_text().expect("a text")
}

const STUDY: &str = "title = 't'\nscene = 'terzaghi'\nmaterial.porosity = 0.3\noutput.time_factors = [0.1]\n[[sweep]]\n\
                     method = ['MPM']\nintegrator = ['implicit']\ncells = [4]\n";

/// Commits on a main line with a branch that comes back, a file that takes another name, and files that are none.
fn repository() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let write = |name: &str, text: &[u8]| {
        fs::create_dir_all(at.join(name).parent().expect("a folder")).expect("made");
        fs::write(at.join(name), text).expect("written");
    };
    let commit = |subject: &str| {
        git(at, &["add", "-A"]);
        git(at, &["commit", "-q", "-m", subject]);
    };
    git(at, &["init", "-q", "-b", "main"]);
    for name in ["golden/a.csv", "golden/sub/c.csv", "other/a.csv"] {
        write(name, golden("a", 1e-2, 40.0, "the first").as_bytes());
    }
    write("golden/b.csv", golden("b", 3e-2, 10.0, "its first").as_bytes());
    write("golden/old.json", b"{}\n");
    write("studies/a.toml", STUDY.as_bytes());
    commit("Begin");
    git(at, &["checkout", "-q", "-b", "side"]);
    write("golden/b.csv", golden("b", 3e-2, 5.0, "half the steps").as_bytes());
    commit("Halve the steps");
    git(at, &["checkout", "-q", "main"]);
    write("golden/a.csv", golden("a", 2e-2, 40.0, "the second").as_bytes());
    write("studies/a.toml", STUDY.replace("0.3", "0.4").as_bytes());
    commit("Double\tthe error");
    git(at, &["merge", "-q", "--no-ff", "-m", "Merge", "side"]);
    write("README", b"words\n");
    commit("Describe");
    git(at, &["mv", "golden/a.csv", "golden/d.csv"]);
    commit("Rename");
    fs::remove_file(at.join("golden/b.csv")).expect("removed");
    write("golden/bad.csv", b"no golden file");
    write("golden/binary.csv", b"\xff\xfe\n");
    write("golden/\u{fc}.csv", golden("\u{fc}", 1e-2, 40.0, "by another name").as_bytes());
    commit("End");
    folder
}

#[test]
fn the_history_of_a_folder_is_that_of_the_main_line_by_the_names_of_its_files() {
    let folder = repository();
    let at = folder.path();
    let repository = Repository::around(&at.join("golden/sub")).expect("a repository");
    assert_eq!(fs::canonicalize(repository.root()).ok(), fs::canonicalize(at).ok());
    let found = repository.changes_below("golden").expect("commits");
    let told: Vec<(&str, Vec<&str>)> = found
        .iter()
        .map(|(commit, files)| (commit.subject.as_str(), files.iter().map(String::as_str).collect()))
        .collect();
    let wanted: [(&str, Vec<&str>); 5] = [
        ("Begin", vec!["golden/a.csv", "golden/b.csv", "golden/old.json", "golden/sub/c.csv"]),
        ("Double\tthe error", vec!["golden/a.csv"]),
        ("Merge", vec!["golden/b.csv"]),
        ("Rename", vec!["golden/a.csv", "golden/d.csv"]),
        ("End", vec!["golden/b.csv", "golden/bad.csv", "golden/binary.csv", "golden/\u{fc}.csv"]),
    ];
    assert_eq!(told, wanted);
    let (first, last) = (&found[0].0, &found[4].0);
    assert_eq!(repository.commit("HEAD").ok().as_ref(), Some(last));
    assert_eq!((last.date.as_str(), last.hash.len(), last.short()), ("2026-11-20", 40, &last.hash[..8]));
    assert_eq!(Commit { hash: "12345".to_owned(), ..last.clone() }.short(), "12345");
    let files = ["README", "golden/bad.csv", "golden/binary.csv", "golden/d.csv", "golden/old.json"];
    let files =
        files.into_iter().chain(["golden/sub/c.csv", "golden/\u{fc}.csv", "other/a.csv", "studies/a.toml"]);
    assert_eq!(repository.files(last).expect("files"), files.collect::<Vec<_>>());
    // Each asked for at its commit; what is not there or no text is left out.
    let object = |commit: &Commit, path: &str| format!("{}:{path}", commit.hash);
    let asked = [
        (first, "golden/b.csv"),
        (last, "golden/b.csv"),
        (last, "golden/binary.csv"),
        (last, "golden/d.csv"),
    ]
    .map(|(commit, path)| object(commit, path));
    let texts = repository.texts(&asked).expect("texts");
    assert_eq!(texts.keys().collect::<Vec<_>>().len(), 2);
    assert_eq!(texts.get(&asked[0]), Some(&golden("b", 3e-2, 10.0, "its first")));
    assert_eq!(texts.get(&asked[3]), Some(&golden("a", 2e-2, 40.0, "the second")));
    assert_eq!(repository.texts(&[]).expect("nothing").len(), 0);
}

#[test]
fn what_git_does_not_know_is_told_in_sentences() {
    let folder = repository();
    let at = folder.path();
    let repository = Repository::around(at).expect("a repository");
    let root = repository.root().display();
    for revision in ["nowhere", "--all", "HEAD:golden", "HEAD~99"] {
        let told = repository.commit(revision).expect_err("no commit").to_string();
        assert_eq!(told, format!("`{revision}` is neither a folder nor a revision of {root}"));
    }
    let shallow =
        GitError::UnknownRevision { revision: "v1".to_owned(), root: "/r".into(), is_shallow: true };
    let told = "`v1` is neither a folder nor a revision of /r: the clone is shallow; `git fetch \
                --unshallow` fetches the rest of the history";
    assert_eq!(shallow.to_string(), told);
    assert!(!repository.is_shallow());
    let told = repository.run(&["cat-file", "-p", "nowhere"]).expect_err("no object").to_string();
    assert_eq!(told, "`git cat-file -p nowhere` failed: fatal: Not a valid object name nowhere");
    let outside = TempDir::new().expect("a folder");
    let told = Repository::around(outside.path()).expect_err("none").to_string();
    let what =
        "is not in a git repository: run the command inside the repository that holds the golden values";
    assert_eq!(told, format!("{} {what}", outside.path().display()));
    // Only what lies where it is asked for is a change of it.
    let dirty = |words: &[&str]| repository.is_dirty(words);
    assert!(!dirty(&[]));
    fs::write(at.join("README"), "other words\n").expect("written");
    assert_eq!([dirty(&[]), dirty(&["--", "golden"]), dirty(&["--", "README"])], [true, false, true]);
}

#[test]
fn timelines_are_those_that_are_asked_for_with_what_is_passed_over() {
    use Trend::{Improved, Regressed, Same};
    let folder = repository();
    let repository = Repository::around(folder.path()).expect("a repository");
    let end = repository.commit("HEAD").expect("a commit");
    let of = |only: &[&str]| {
        let only: Vec<String> = only.iter().map(|name| (*name).to_owned()).collect();
        timelines(&repository, "golden", &only).expect("timelines")
    };
    let (all, notes) = of(&[]);
    let steps = all.iter().flat_map(|line| line.steps.iter().map(move |step| (line.study.as_str(), step)));
    let told: Vec<_> = steps
        .map(|(study, step)| {
            (study, step.commit.subject.as_str(), step.reason.as_str(), step.accuracy, step.cost)
        })
        .collect();
    let wanted = [
        ("a", "Begin", "the first", Same, Same),
        ("a", "Double\tthe error", "the second", Regressed, Same),
        ("b", "Begin", "its first", Same, Same),
        ("b", "Merge", "half the steps", Same, Improved),
        ("d", "Rename", "the second", Same, Same),
        ("\u{fc}", "End", "by another name", Same, Same),
    ];
    assert_eq!(told, wanted);
    let json = "1 golden file in JSON is skipped, like golden/old.json: only golden values from layout 2 \
                on, in CSV, are read";
    let bad = format!("golden/bad.csv at {} is skipped: line 1: the file ends within this line", end.short());
    assert_eq!(notes, [json, &bad]);
    let named = |only: &[&str]| {
        let (lines, notes) = of(only);
        (lines.into_iter().map(|line| line.study).collect::<Vec<_>>(), notes)
    };
    assert_eq!(named(&["b"]), (vec!["b".to_owned()], vec![]));
    assert_eq!(named(&["old", "d"]), (vec!["d".to_owned()], vec![json.to_owned()]));
    assert_eq!(named(&["bad", "none"]), (vec![], vec![bad]));
}

#[test]
fn a_revision_has_the_studies_of_its_folder_with_the_inputs_that_they_had_then() {
    let folder = repository();
    let repository = Repository::around(folder.path()).expect("a repository");
    let of = |revision: &str, folder: &str| State::of_revision(&repository, revision, folder);
    let names = |state: &State| state.studies.keys().cloned().collect::<Vec<String>>();
    let short = |revision: &str| repository.commit(revision).expect("a commit").short().to_owned();
    for (revision, porosity, error) in [("HEAD~5", "0.3", 1e-2), ("HEAD~2", "0.4", 2e-2)] {
        let state = of(revision, "golden").expect("a state");
        assert_eq!(state.name, format!("{revision} ({})", short(revision)));
        assert_eq!(names(&state), ["a", "b"]);
        assert_eq!(state.notes, [""; 0]);
        let found = &state.studies["a"];
        let study = STUDY.replace("0.3", porosity);
        let study = Study::check(&StudySource { name: "a.toml".to_owned(), text: study }).expect("sound");
        assert_eq!(found.cases.values().collect::<Vec<&Case>>(), study.cases(Tier::Full));
        assert_eq!(found.golden.values[&key(LABEL, 0.1, PRESSURE)], error);
        assert_eq!(found.made_by, [format!("what commit {} has", short(revision))]);
        assert!(state.studies["b"].cases.is_empty(), "no study of its name");
    }
    let state = of("HEAD", "golden").expect("a state");
    let bad =
        format!("golden/bad.csv at {} is skipped: line 1: the file ends within this line", short("HEAD"));
    assert_eq!(names(&state), ["d", "\u{fc}"]);
    assert_eq!(state.notes, [bad]);
    assert_eq!(of("HEAD", "other").expect("a state").studies.keys().collect::<Vec<_>>(), ["a"]);
    let told = of("HEAD", "gold").expect_err("nothing there").to_string();
    assert_eq!(told, format!("HEAD ({}) has no golden values in gold/", short("HEAD")));
}

#[test]
fn records_that_cannot_be_read_are_counted_and_a_folder_without_any_is_refused() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    fs::write(at.join("words.txt"), "no folder\n").expect("a file");
    let none = State::of_records(at).expect_err("no records");
    assert!(matches!(none, StateError::NoRecords(_)));
    let what = "has no records: give the folder that `oedometer run --out` wrote, or a git revision";
    assert_eq!(none.to_string(), format!("{} {what}", at.display()));
    let text = STUDY.replace("[4]", "[4, 5]");
    let study = Study::check(&StudySource { name: "s.toml".to_owned(), text }).expect("sound");
    let store = RecordStore::new(at, "s");
    let records = run_study(&study, &RunOptions::whole(Tier::Full, 1), Some(&store), &|_| {}).records;
    let read = |cases: usize, passed_over: &[&str]| {
        let state = State::of_records(at).expect("a state");
        assert_eq!(state.name, at.display().to_string());
        assert_eq!(state.studies.get("s").map_or(0, |study| study.cases.len()), cases);
        let end = format!(
            "of `s` in {} skipped, because their layout is different or they are damaged; run the \
                     study again",
            at.display()
        );
        let wanted: Vec<String> = passed_over.iter().map(|count| format!("{count} {end}")).collect();
        assert_eq!(state.notes, wanted);
    };
    read(2, &[]);
    for (record, cases, told) in [(&records[1], 1, "1 record"), (&records[0], 0, "2 records")] {
        store.write(&Record { schema: 999, ..record.clone() }).expect("written");
        read(cases, &[told]);
    }
}

#[test]
#[cfg(unix)]
fn every_other_round_begins_with_the_second_command_and_the_first_tells_what_failed() {
    use crate::history::state::{states_of_commands, with_command};
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let rows = "printf 't,y,p,u_y\\n8.175,0,0.9,0\\n8.175,0.5,0.6,-1e-7\\n8.175,1,0,-3e-7\\n' > $2/r.csv";
    fs::write(at.join("run.sh"), format!("echo $1 >> {}\n{rows}\ntest $1 = a\n", at.join("log").display()))
        .expect("a file");
    let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[solver]]\nname = 'own'\n\
                command = ['false']\nresult = '{out}/r.csv'\n[[sweep]]\nmethod = ['own']\ncells = [2]\n";
    let source = StudySource { name: at.join("s.toml").display().to_string(), text: text.to_owned() };
    let study = Study { may_start_solvers: true, ..Study::check(&source).expect("sound") };
    let studies =
        ["a", "b"].map(|one| with_command(&study, &format!("sh run.sh {one} {{out}}")).expect("one solver"));
    let states = states_of_commands(&studies, ["first", "second"], 3);
    assert_eq!(fs::read_to_string(at.join("log")).expect("a log"), "a\nb\nb\na\na\nb\n");
    let label = study.planned[0].case.label();
    assert_eq!(states.each_ref().map(|state| state.name.as_str()), ["`first`", "`second`"]);
    assert_eq!(states.each_ref().map(|state| state.studies["s"].seconds[&label].len()), [3, 3]);
    assert_eq!(states[0].notes, [""; 0]);
    assert_eq!(states[1].notes, [format!("`second`: {label}: failed")]);
    assert!(
        !states[0].studies["s"].golden.values.is_empty() && states[1].studies["s"].golden.values.is_empty()
    );
}
