//! Expectations that `check` proposes to a study that has none.

use crate::program::{call, folder_with};
use oedometer::{CheckEnd, GoldenError, Record, RunOptions, Study, StudyCheck, StudySource, Tier, run_study};
use std::fs;

/// Meshes, and in a second study steps, of two methods.
const MESHES: &str = "cells = [4, 8, 16]";
const STEPS: &str =
    "cells = [6]\ntime_step = [{ growth = 0.1 }, { growth = 0.05 }, { growth = 0.025 }, { growth = 0.0125 }]";

fn study(swept: &str) -> String {
    format!(
        "title = \"A study\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1, 0.2]\n\n[[sweep]]\n\
         method = [\"GC-SRI-patch\", \"MPM\"]\nintegrator = [\"implicit\"]\n{swept}\n"
    )
}

/// What stands between the sentence above the proposed lines and what follows them.
fn pasted(out: &str) -> String {
    let text = out.split_once("[[expect]]").expect(out).1;
    format!("\n[[expect]]{}", text.split("\nnext:").next().unwrap_or(text))
}

fn checked(text: &str, change: impl Fn(&mut Record)) -> StudyCheck {
    let source = StudySource { name: "short.toml".to_owned(), text: text.to_owned() };
    let study = Study::check(&source).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let mut records = run_study(&study, &RunOptions::whole(Tier::Ci, 1), None, &|_| {}).records;
    records.iter_mut().for_each(change);
    StudyCheck::new(&study, &records, Tier::Ci, Err(GoldenError::Missing("short.csv".into())))
}

#[test]
fn pasted_as_they_are_they_are_met_and_a_worse_solver_fails_them() {
    for swept in [MESHES, STEPS] {
        let folder = folder_with(&study(swept));
        let told = call(folder.path(), &["check", "short.toml", "--verbose"]);
        assert_eq!(told.code, 5, "only golden values are missing: {}{}", told.out, told.err);
        let whole = study(swept) + &pasted(&told.out);
        fs::write(folder.path().join("short.toml"), &whole).expect("written");
        let told = call(folder.path(), &["check", "short.toml"]);
        assert!(
            told.out.starts_with("• short: 2 of 2 expectations met"),
            "{}{}\n{whole}",
            told.out,
            told.err
        );
        assert!(!told.out.contains("no expectations yet"), "{}", told.out);
        assert_eq!(checked(&whole, |_| {}).end(), CheckEnd::Golden, "{whole}");
    }
    let whole = study(MESHES);
    let proposed = checked(&whole, |_| {}).proposals;
    assert!(proposed.len() == 2 && proposed.iter().all(|one| one.contains("order = ")), "{proposed:?}");
    let whole = format!("{whole}\n{}", proposed.join("\n"));
    let unmet = |change: &dyn Fn(&Record, f64) -> f64| {
        let check = checked(&whole, |record| {
            let factor = change(record, record.case.cells as f64);
            record.errors.iter_mut().for_each(|row| row.value *= factor);
        });
        check.judgements.iter().filter(|judgement| !judgement.verdict.pass).count()
    };
    assert_eq!(unmet(&|_, _| 2.0), 2, "twice the error");
    assert_eq!(
        unmet(&|_, cells| (cells / 16.0).sqrt()),
        2,
        "half an order, with the error of the finest mesh as it was"
    );
    assert_eq!(unmet(&|_, _| 1.2), 0, "a fifth more is within the room");
}

#[test]
fn a_study_with_expectations_gets_none() {
    let with_one = study(MESHES) + "\n[[expect_case]]\nstatus = \"ok\"\n";
    assert!(checked(&with_one, |_| {}).proposals.is_empty());
}
