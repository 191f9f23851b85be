//! What stands at the gate: golden files that cannot be read, solvers that nobody allowed, golden values in a subfolder, and
//! results whose files are named.
#![cfg(unix)]

use crate::program::{call, call_with};
use oedometer::{GoldenFile, RunOptions, Study, StudySource, Tier, run_study};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                     integrator = ['implicit']\ncells = [3]\n";

/// Writes a study and what it gives as its golden values.
fn accepted(folder: &Path, name: &str, text: &str) -> String {
    fs::create_dir_all(folder).expect("a folder");
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).expect("a file");
    let study = Study::check(&StudySource { name: path.display().to_string(), text: text.to_owned() });
    let report = run_study(&study.expect("sound"), &RunOptions::whole(Tier::Ci, 1), None, &|_| {});
    let golden =
        GoldenFile::of(name, &report.records, "sound").write(&folder.join("golden")).expect("written");
    fs::read_to_string(golden).expect("written")
}

#[test]
fn a_golden_file_that_cannot_be_read_is_never_replaced_and_says_what_to_do() {
    let folder = TempDir::new().expect("a folder");
    let sound = accepted(folder.path(), "s", STUDY);
    let (head, tail) = sound.split_at(sound.find("case,hash").expect("a table"));
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    for (text, words) in [
        (pointer.to_owned(), "git lfs pull"),
        (
            format!("{head}<<<<<<< HEAD\n{tail}=======\n{tail}>>>>>>> other\n"),
            "conflict markers of git (line ",
        ),
        (format!("<<<<<<< HEAD\n{sound}=======\n{sound}>>>>>>> other\n"), "conflict markers of git (line 1)"),
        (sound[..sound.len() - 5].to_owned(), "git checkout HEAD -- golden/s.csv"),
        (String::new(), "git checkout HEAD -- golden/s.csv"),
    ] {
        let file = folder.path().join("golden/s.csv");
        fs::write(&file, &text).expect("a file");
        let told = call(folder.path(), &["check", "s.toml"]);
        let said = told.words();
        assert!(told.code == 5 && said.contains(words) && !said.contains("oedometer accept"), "{said}");
        // From sources that no commit has nothing is taken anyway.
        let told = call(folder.path(), &["accept", "s.toml", "--reason", "a test"]);
        let refused = told.err.contains(words) && told.code == 5 || told.err.contains("uncommitted changes");
        assert!(refused, "{}", told.err);
        assert_eq!(fs::read_to_string(&file).expect("a file"), text);
    }
}

#[test]
fn what_nobody_allowed_to_run_is_not_judged_and_nothing_of_it_is_to_be_accepted() {
    let folder = TempDir::new().expect("a folder");
    let study = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[solver]]\nname = 'mine'\n\
                 command = ['true']\nresult = '{out}/r.csv'\n[[sweep]]\nmethod = ['mine']\ncells = [4]\n\
                 [[expect_case]]\nmethod = 'mine'\ntime_factor = 0.1\nerror = { below = 0.1 }\n";
    fs::write(folder.path().join("s.toml"), study).expect("a file");
    let told = call_with(
        folder.path(),
        &[("OEDOMETER_ALLOW_SOLVERS", "")],
        &["check", "s.toml", "--junit", "j.xml"],
    );
    let said = told.words();
    assert_eq!(told.code, 6, "{said}{}", told.err);
    let words = "none of 1 expectation judged: 1 case not run, because their programs need --allow-solvers";
    assert!(said.contains(words) && !said.contains("next:") && !said.contains("no expectations"), "{said}");
    let junit = fs::read_to_string(folder.path().join("j.xml")).expect("JUnit");
    assert!(junit.contains("<skipped") && !junit.contains("<failure"), "{junit}");
}

#[test]
fn golden_values_in_a_subfolder_are_found_from_the_root() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let git = |words: &[&str]| {
        let names = ["-c", "user.name=t", "-c", "user.email=t@t"];
        assert!(
            Command::new("git").arg("-C").arg(at).args(names).args(words).status().expect("git").success()
        );
    };
    git(&["init", "-q"]);
    accepted(&at.join("cn"), "s", STUDY);
    git(&["add", "-A"]);
    git(&["commit", "-qm", "first"]);
    assert_eq!(call(at, &["run", "cn/s.toml"]).code, 0);
    for words in
        [&["history"][..], &["history", "s"], &["compare", "HEAD", "out"], &["compare", "HEAD", "out", "s"]]
    {
        for place in ["", "cn"] {
            let out = if place.is_empty() { "out" } else { "../out" };
            let words: Vec<&str> = words.iter().map(|word| if *word == "out" { out } else { word }).collect();
            let told = call(&at.join(place), &words);
            assert!(
                told.code == 0 && told.out.contains("\ns "),
                "{words:?} {place}: {}{}",
                told.out,
                told.err
            );
        }
    }
    // Several folders: the study tells which, or the user does.
    accepted(&at.join("deep/er"), "t", STUDY);
    git(&["add", "-A"]);
    git(&["commit", "-qm", "second"]);
    let told = call(at, &["history"]);
    assert!(
        told.code == 2 && told.err.contains("2 folders") && told.err.contains("deep/er/golden"),
        "{}",
        told.err
    );
    for words in [&["history", "t"][..], &["history", "--golden", "deep/er/golden"]] {
        let told = call(at, words);
        assert!(told.code == 0 && told.out.contains("\nt "), "{words:?}: {}{}", told.out, told.err);
    }
    // Another method: which cases were removed and added is told first, and no trend of what cannot be compared.
    accepted(&at.join("cn"), "s", &STUDY.replace("MPM", "GIMP"));
    git(&["commit", "-qam", "exchange the method"]);
    let told = call(at, &["history", "s", "--format", "csv"]);
    let last = told.out.lines().last().expect("a row").to_owned();
    let [went, came] =
        ["MPM implicit cells=3", "GIMP implicit cells=3"].map(|case| last.find(case).expect(case));
    assert!(went < came && !last.contains("same"), "{last}");
    let told = call(at, &["history"]);
    assert!(told.code == 2, "{}", told.err);
    let told = call(at, &["history", "--golden", "cn/golden"]);
    assert!(told.out.contains("GIMP implicit cells=3") && !told.out.contains("nothing"), "{}", told.out);
    let told = call(at, &["compare", "HEAD~1", "HEAD", "s"]);
    assert!(told.out.contains("cases removed and added"), "{}{}", told.out, told.err);
}

#[test]
fn a_score_names_its_file_in_every_failure_and_writes_junit() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let rows = |factor: f64| {
        let row = |place: u32| {
            let y = f64::from(place) / 10.0;
            format!("8.175,{y},{},{}\n", factor * 1e-5 * (1.0 - y), -1e-7 * y)
        };
        "t,y,p,u_y\n".to_owned() + &(0..=10).map(row).collect::<String>()
    };
    fs::write(at.join("a.csv"), rows(1.0)).expect("a file");
    fs::write(at.join("b.csv"), rows(2.0)).expect("a file");
    for (files, cells) in [(&["a.csv"][..], None), (&["a.csv", "b.csv"], Some("10,20"))] {
        let mut words = vec!["score"];
        words.extend(files);
        words.extend(["--scene", "terzaghi", "--below", "1e-3", "--junit", "j.xml"]);
        words.extend(cells.map_or(vec![], |cells| vec!["--cells", cells]));
        let told = call(at, &words);
        let failures: Vec<&str> = told.err.lines().filter(|line| line.starts_with("fail: ")).collect();
        assert!(told.code == 1 && !failures.is_empty(), "{}", told.err);
        assert!(failures.iter().all(|line| line.contains(".csv: ")), "{failures:?}");
        let junit = fs::read_to_string(at.join("j.xml")).expect("JUnit");
        for file in files {
            assert!(junit.contains(&format!("{file}/pressure/T_v=0.1")), "{junit}");
        }
        assert_eq!(junit.matches("<failure").count(), failures.len(), "{junit}");
    }
    let told = call(at, &["score", "a.csv", "--scene", "terzaghi", "--junit", "k.xml"]);
    assert!(told.code == 2 && told.err.contains("--below") && !at.join("k.xml").exists(), "{}", told.err);
}

#[test]
fn results_that_lie_there_take_the_time_of_reading_them() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a.csv"), "t,y,p\n").expect("a file");
    let study =
        "title = 't'\nscene = 'terzaghi'\n[[result]]\nname = 'theirs'\nfiles = ['a.csv']\ncells = [4]\n";
    fs::write(folder.path().join("s.toml"), study).expect("a file");
    let told = call(folder.path(), &["plan", "s.toml"]);
    let seconds = told.out.lines().last().and_then(|row| row.rsplit(',').next()?.parse::<f64>().ok());
    assert!(seconds.is_some_and(|seconds| seconds < 0.05), "{}", told.out);
}
