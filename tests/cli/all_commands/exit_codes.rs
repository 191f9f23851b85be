//! How commands end on small inputs: exit codes with whole sentences, and what `list` and `plan` print.

use crate::program::{call, folder_with};
use oedometer::scenes::SCENES;
use oedometer::{IntegratorKind, Method};
use oedometer_exact::{ReferenceKind, TextbookProblem};
use std::fs;
use tempfile::TempDir;

/// Twelve cases.
const STUDY: &str = "title = \"Short\"\nscene = \"terzaghi\"\noutput.time_factors = [0.01]\n\n[[sweep]]\nmethod = [\"MPM\"]\n\
                     integrator = [\"implicit\"]\ncells = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]\n";

fn place() -> TempDir {
    let folder = folder_with(STUDY);
    fs::create_dir(folder.path().join("empty")).expect("a folder");
    fs::write(folder.path().join("map.toml"), "sample = \"nodes\"\n").expect("a file");
    fs::write(folder.path().join("a.csv"), "t,y,p,u_y\n8.175,0.5,0.7,0\n").expect("a file");
    folder
}

/// Commands, their exit codes and what they say.
const ENDS: &str = "
plan short.toml --missing none | 2 | there is no results folder none
merge short.toml empty none | 2 | there is no results folder none
merge empty | 4 | the folders contain no results of a study of this project or of a built-in one
records empty | 4 | empty has no such record
records none | 2 | there is no results folder of a study at none
exact mandel --zeta 0.5 | 2 | the fields of `mandel` depend on the distance from the middle: give it by `--x`
exact single-mode --degree 0.5 | 2 | `single-mode` has no time factor for a degree in closed form
score a.csv --scene terzaghi --time-tolerance 1 | 2 | `--time-tolerance 1` is invalid: expected a number from 0 to below 1
score a.csv --scene terzaghi --time-tolerance -0.1 | 2 | `--time-tolerance -0.1` is invalid: expected a number from 0 to below 1
score a.csv --scene terzaghi --mapping map.toml --set-time-step 0 | 2 | `--set-time-step 0` is invalid: give seconds above 0
run short.toml --shard 0/2 | 2 | `--shard 0/2` is not a shard: write i/n with 1 ≤ i ≤ n, like 2/3
run short.toml --shard 1/0 | 2 | `--shard 1/0` is not a shard: write i/n with 1 ≤ i ≤ n, like 2/3
run short.toml --shard 2 | 2 | `--shard 2` is not a shard: write i/n with 1 ≤ i ≤ n, like 2/3
solve terzaghi --set method=1 | 2 | `method` has a separate option: --method NAME
solve terzaghi --set sweep.method=1 | 2 | `method` has a separate option: --method NAME
solve terzaghi --set integrator=1 | 2 | `integrator` has a separate option: --integrator NAME
solve terzaghi --set sweep.cells=1 | 2 | `cells` has a separate option: --cells NUMBER
solve terzaghi --set points_per_cell=1 | 2 | `points_per_cell` has a separate option: --points-per-cell NUMBER
solve terzaghi --set sweep.time_step=1 | 2 | `time_step` has a separate option: --time-step RULE
solve terzaghi --set task=1 | 2 | `--set task` has no effect here: `oedometer stability` finds critical steps
solve terzaghi --set timing.repeats=1 | 2 | `--set timing.repeats` has no effect here: cases are timed by `oedometer run` with a study file
exact terzaghi --set case_seconds=1 | 2 | `--set case_seconds` has no effect here: nothing is run
exact terzaghi --set scene=layered | 2 | `scene` is given by the solution's name and by `--set`: leave one out
solve terzaghi --set title=a | 2 | `title` is given by `solve` and by `--set`: leave one out
stability terzaghi --set task=a | 2 | `task` is given by `stability` and by `--set`: leave one out
stability terzaghi --set output.time_factors=[1] | 2 | `output.time_factors` is given by `--time-factor` and by `--set`: leave one out
solve terzaghi --reference terzaghi --set output.references=[] | 2 | `output.references` is given by `--reference` and by `--set`: leave one out
";

#[test]
fn what_cannot_be_done_is_told_in_a_sentence_with_its_exit_code() {
    let folder = place();
    for row in ENDS.trim().lines() {
        let [words, code, told] = row.split(" | ").collect::<Vec<_>>()[..] else { panic!("{row}") };
        let found = call(folder.path(), &words.split(' ').collect::<Vec<_>>());
        let wanted = (code.to_owned(), "", format!("error: {told}\n"));
        assert_eq!((found.code.to_string(), found.out.as_str(), found.err), wanted, "{words}");
    }
    assert!(!folder.path().join("out").exists());
    let told = call(folder.path(), &["exact", "terzaghi", "--time-factor", "0.1", "--zeta", "0.5"]).err;
    assert!(told.starts_with("T_v = 0.1: ") && told.ends_with(", round-off below 1e-14\n"), "{told}");
}

#[test]
fn ten_of_the_holes_of_a_merge_are_named_and_the_others_counted() {
    let folder = place();
    let planned = call(folder.path(), &["plan", "short.toml"]).out;
    let rows: Vec<Vec<&str>> = planned.lines().skip(1).map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len(), 12);
    let holes: Vec<String> =
        rows.iter().map(|row| format!("short: no result of {} {}\n", row[1], row[3])).collect();
    let told = call(folder.path(), &["merge", "short.toml", "empty"]);
    let more = "short: and 2 more; `plan --missing` lists them all\n";
    assert_eq!((told.code, told.err), (6, holes[..10].concat() + more));
    assert!(!folder.path().join("out/short/short.csv").exists());
    for hash in [rows[0][1], rows[1][1]] {
        let run = call(folder.path(), &["run", "short.toml", "--case", hash, "--out", "two"]);
        assert_eq!(run.code, 0, "{}", run.err);
    }
    let told = call(folder.path(), &["merge", "short.toml", "empty", "two"]);
    let table = "short: 2 of 12 cases, out/short/short.csv\n".to_owned();
    assert_eq!((told.code, told.err), (6, table + &holes[2..].concat()));
    // Holes of one study are not filled by those that are whole, before it or behind it.
    for name in ["one.toml", "other.toml"] {
        let whole = STUDY.replace("cells = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]", "cells = [2]");
        fs::write(folder.path().join(name), whole).expect("a file");
        assert_eq!(call(folder.path(), &["run", name, "--out", "two"]).code, 0);
    }
    let studies = ["short.toml", "one.toml", "other.toml"];
    for order in [[0, 1, 2], [1, 0, 2], [1, 2, 0]] {
        let told = call(folder.path(), &[&["merge", "two"][..], &order.map(|place| studies[place])].concat());
        assert_eq!(told.code, 6, "{order:?}: {}", told.err);
    }
    assert_eq!(call(folder.path(), &["merge", "two", "one.toml", "other.toml"]).code, 0);
}

#[test]
fn a_job_list_goes_on_where_its_results_are() {
    let folder = place();
    for (options, list) in [
        ("--tasks 1", "--out out --shard 1/1 --resume"),
        ("--tasks 1 --missing empty", "--out empty --shard 1/1 --resume"),
        ("--tasks 1 --missing empty --out other", "--out other --shard 1/1 --resume"),
        ("--tasks 1 --tier ci --balance", "--out out --tier ci --shard 1/1 --balance --resume"),
    ] {
        let words: Vec<&str> = ["plan", "short.toml"].into_iter().chain(options.split(' ')).collect();
        let told = call(folder.path(), &words);
        assert_eq!((told.code, told.out), (0, format!("oedometer run short.toml {list}\n")), "{options}");
        assert!(told.err.starts_with("1 shard: the largest takes "), "{}", told.err);
    }
}

#[test]
fn all_names_are_listed_under_their_headings() {
    let told = call(place().path(), &["list", "--all"]);
    assert_eq!((told.code, told.err.as_str()), (0, ""));
    let mut sections: Vec<(&str, Vec<(&str, &str)>)> = Vec::new();
    for line in told.out.lines() {
        match line.strip_prefix("  ") {
            None => sections.push((line, Vec::new())),
            Some(entry) => {
                let (name, about) = entry.split_once(' ').unwrap_or((entry, ""));
                sections.last_mut().expect("a heading").1.push((name, about.trim_start()));
            }
        }
    }
    let names = Method::names();
    let with_nothing = |names: &[&'static str]| names.iter().map(|name| (*name, "")).collect::<Vec<_>>();
    let titles: Vec<(String, String)> = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/studies"))
        .expect("studies")
        .filter_map(|entry| {
            let path = entry.expect("an entry").path();
            let text = fs::read_to_string(&path).ok()?;
            let study: toml::Table = toml::from_str(&text).expect("TOML");
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            Some((name, study["title"].as_str().expect("a title").to_owned()))
        })
        .collect();
    let (heading, mut shipped) = sections.pop().expect("a section");
    assert_eq!(
        (heading, shipped[0].0, shipped[shipped.len() - 1].0),
        ("built-in studies", "terzaghi-mesh", "race-footing")
    );
    shipped.sort_unstable();
    let mut wanted: Vec<(&str, &str)> = titles.iter().map(|(name, title)| (&**name, &**title)).collect();
    wanted.sort_unstable();
    assert_eq!(shipped, wanted);
    let choices: Vec<String> =
        names.iter().filter_map(|name| Method::named(name)).map(|method| method.choices()).collect();
    assert_eq!(
        sections,
        [
            ("benchmark problems (scenes)", SCENES.map(|scene| (scene.name, scene.summary)).to_vec()),
            ("methods", names.iter().zip(&choices).map(|(name, parts)| (&**name, &**parts)).collect()),
            ("integrators", with_nothing(&IntegratorKind::NAMES)),
            (
                "references",
                with_nothing(&ReferenceKind::ALL.iter().map(|kind| kind.name()).collect::<Vec<_>>())
            ),
            ("exact solutions without a solver in this program", with_nothing(&TextbookProblem::NAMES)),
        ]
    );
}
