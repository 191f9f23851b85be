//! Which studies a command takes where none is named, where their golden values lie, and which records `check` takes.

use crate::program::{Told, call};
use oedometer::{GoldenFile, Record, RecordStore, RunOptions, Study, StudySource, Tier, run_study};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Two cases that take a moment.
const STUDY: &str = "title = \"A short study\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[[sweep]]\n\
                     method = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\ncells = [3, 6]\n";

/// A project with two studies, a mapping and the settings of another program beside them, and golden values of one of them.
fn project() -> TempDir {
    let project = TempDir::new().expect("a folder");
    let at = project.path();
    fs::create_dir_all(at.join("studies/deep")).expect("folders");
    fs::create_dir_all(at.join("source/deep")).expect("folders");
    for (file, text) in [
        ("studies/second.toml", STUDY),
        ("studies/first.toml", STUDY),
        ("studies/mapping.toml", "[columns]\npressure = \"p\"\n"),
        ("Cargo.toml", "[package]\nname = \"solver\"\n"),
    ] {
        fs::write(at.join(file), text).expect("a file");
    }
    let golden = GoldenFile::of("first", &records(STUDY), "for a test");
    golden.write(&at.join("golden")).expect("written");
    project
}

fn records(text: &str) -> Vec<Record> {
    let source = StudySource { name: "first.toml".to_owned(), text: text.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    run_study(&study, &RunOptions::whole(Tier::Ci, 1), None, &|_| {}).records
}

/// The studies of a plan, each once.
fn planned(told: &Told) -> Vec<String> {
    assert_eq!(told.code, 0, "{}", told.err);
    let mut names: Vec<String> =
        told.out.lines().skip(1).filter_map(|line| Some(line.split(',').next()?.to_owned())).collect();
    names.dedup();
    names
}

#[test]
fn without_names_the_studies_of_this_project_are_taken_from_any_of_its_folders() {
    let project = project();
    for folder in ["", "studies", "studies/deep", "source/deep"] {
        let told = call(&project.path().join(folder), &["plan"]);
        assert_eq!(planned(&told), ["first", "second"], "{folder}");
    }
    assert_eq!(planned(&call(project.path(), &["plan", "studies"])), ["first", "second"]);
    assert_eq!(planned(&call(project.path(), &["plan", "."])), ["first", "second"]);
    let shipped = planned(&call(project.path(), &["plan", "--shipped"]));
    assert!(shipped.len() > 80 && !shipped.contains(&"first".to_owned()), "{shipped:?}");
    // Neither of them a project: a study beside a folder is none of that folder's.
    let lone = TempDir::new().expect("a folder");
    fs::create_dir(lone.path().join("inner")).expect("a folder");
    fs::write(lone.path().join("lone.toml"), STUDY).expect("a file");
    assert_eq!(planned(&call(lone.path(), &["plan"])), ["lone"]);
    for command in ["run", "plan", "check", "report"] {
        let told = call(&lone.path().join("inner"), &[command]);
        assert_eq!(told.code, 4, "{command}: {}", told.err);
        assert!(
            told.err.contains("there is no study in this folder") && told.err.contains("--shipped"),
            "{}",
            told.err
        );
    }
    let told = call(project.path(), &["check", "source"]);
    assert!(told.code == 2 && told.err.contains("the folder source contains no study"), "{}", told.err);
}

#[test]
fn a_report_in_a_project_has_its_studies_and_no_other() {
    let project = project();
    let told = call(project.path(), &["report"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let listed = |folder: &str| {
        let entries = fs::read_dir(project.path().join(folder)).expect("a folder");
        let mut names: Vec<String> =
            entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
        names.sort();
        names
    };
    assert_eq!(listed("out"), ["first", "second"]);
    let pages: Vec<String> =
        listed("report/studies").into_iter().filter(|name| name.contains(".html")).collect();
    assert_eq!(pages, ["first.html", "index.html", "second.html"]);
}

#[test]
fn golden_values_are_found_beside_the_study_whatever_the_current_folder() {
    let project = project();
    let elsewhere = TempDir::new().expect("a folder");
    let whole = project.path().join("studies/first.toml").display().to_string();
    for (folder, study) in [
        (project.path().to_owned(), "studies/first.toml"),
        (project.path().join("studies"), "first.toml"),
        (project.path().join("source/deep"), "../../studies/first.toml"),
        (elsewhere.path().to_owned(), whole.as_str()),
    ] {
        let told = call(&folder, &["check", study]);
        assert_eq!(told.code, 0, "{}: {}", folder.display(), told.out);
        assert!(told.words().contains("golden values agree"), "{}", told.out);
    }
    let told = call(&project.path().join("studies"), &["check", "second.toml"]);
    assert_eq!(told.code, 5, "{}", told.out);
    assert!(told.out.contains("golden/second.csv"), "{}", told.out);
}

/// Changes the records of the first study as another program would have made and signed them.
fn changed(at: &Path, change: fn(&mut Record)) {
    let source = StudySource { name: "first.toml".to_owned(), text: STUDY.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    let store = RecordStore::new(&at.join("out"), "first");
    for case in study.cases(Tier::Ci) {
        let mut record = store.kept(case).expect("a record");
        change(&mut record);
        store.write(&record).expect("written");
    }
}

#[test]
fn a_check_takes_what_this_build_has_solved_and_nothing_of_another() {
    let project = project();
    let at = project.path();
    let check = || call(at, &["check", "studies/first.toml"]);
    assert!(!check().err.contains("taken from"), "there is nothing to take");
    assert_eq!(call(at, &["run", "studies/first.toml"]).code, 0);
    let told = check();
    assert_eq!(told.code, 0, "{}", told.out);
    assert!(told.err.contains("reused 2 of 2 cases from out (same build)"), "{}", told.err);
    assert!(!call(at, &["check", "studies/first.toml", "--records", "none"]).err.contains("taken from"));
    // What a record says is what is judged: it was not solved again.
    changed(at, |record| record.errors.iter_mut().for_each(|row| row.value *= 2.0));
    let told = check();
    assert_eq!(told.code, 1, "{}", told.out);
    for other in [
        (|record| record.provenance.sources = "0123456789abcdef".to_owned()) as fn(&mut Record),
        |record| record.provenance.compiler = "another".to_owned(),
        |record| record.provenance.profile = "another".to_owned(),
    ] {
        changed(at, other);
        let told = check();
        assert_eq!(told.code, 0, "{}", told.out);
        assert!(!told.err.contains("taken from"), "{}", told.err);
        assert_eq!(call(at, &["run", "studies/first.toml"]).code, 0, "whole again");
        changed(at, |record| record.errors.iter_mut().for_each(|row| row.value *= 2.0));
    }
}

/// What git says to some words in a folder, by a name of its own.
pub fn git(at: &Path, words: &[&str]) -> String {
    let names =
        ["user.name=t", "user.email=t@example.org", "commit.gpgsign=false", "init.defaultBranch=main"];
    let mut command = Command::new("git");
    command.args(names.iter().flat_map(|name| ["-c", name])).args(words);
    let output = command.current_dir(at).output().expect("git");
    assert!(output.status.success(), "git {words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("words").trim().to_owned()
}
