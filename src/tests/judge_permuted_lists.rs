//! Lists that are sets: in whatever order a study writes them, its verdicts are the same, and nothing is taken because it
//! stands first.

use crate::campaign::runner::records_of;
use crate::case::planned::Tier;
use crate::judge::paths::StudyPaths;
use crate::judge::study_check::StudyCheck;
use crate::judge::verdict::judge_paths;
use crate::study::check::Study;
use crate::study::file::StudySource;

fn study(text: &str) -> Result<Study, String> {
    Study::check(&StudySource { name: "t.toml".to_owned(), text: text.to_owned() })
        .map_err(|error| error.to_string())
}

/// Verdicts, in the order of their lines and subjects, with every number that was measured.
fn verdicts(text: &str) -> Vec<String> {
    let study = study(text).expect("a sound study");
    let records = records_of(text);
    let told = judge_paths(&study, &records, &StudyPaths::of(&records), Tier::Full);
    let mut told: Vec<String> = told
        .iter()
        .map(|one| {
            let measured: Vec<_> =
                one.verdict.checks.iter().map(|check| (check.pass, check.measured)).collect();
            format!("{}: {} {} {measured:?}", one.subject, one.verdict.pass, one.verdict.reason)
        })
        .collect();
    told.sort();
    let check = StudyCheck::new(
        &study,
        &records,
        Tier::Full,
        Err(crate::golden::GoldenError::Missing("t.csv".into())),
    );
    told.push(format!("{:?} {:?}", check.end(), check.unsound.len()));
    told
}

const STUDY: &str = "title = 't'\nscene = 'terzaghi'\n\
    output = { time_factors = [0.05, 0.2], references = ['terzaghi', 'terzaghi-incompressible'] }\n\
    [[sweep]]\nmethod = ['GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [4, 8, 16]\n\
    time_step = [{ growth = 0.05 }]\n\
    [[expect]]\nmethod = 'GC-SRI-patch'\ntime_factor = 0.2\norder = { value = 2.0, minus = 0.3, plus = 0.3 }\n\
    at = { cells = 8, below = 0.1 }\n\
    [[expect]]\nmethod = 'MPM'\ntime_factor = 0.05\nquantity = 'settlement'\nclass = 'asymptotic'\n\
    [[expect_case]]\ntime_factor = 0.05\nerror = { below = 0.03 }\nsolid_drift_below = 1e-9\n";

#[test]
fn verdicts_do_not_follow_the_order_of_lists() {
    let wanted = verdicts(STUDY);
    assert!(wanted.len() > 8 && wanted.iter().any(|one| one.contains("true")), "{wanted:?}");
    for (from, to) in [
        ("['terzaghi', 'terzaghi-incompressible']", "['terzaghi-incompressible', 'terzaghi']"),
        ("[4, 8, 16]", "[16, 4, 8]"),
        ("[4, 8, 16]", "[8, 16, 4]"),
        ("['GC-SRI-patch', 'MPM']", "['MPM', 'GC-SRI-patch']"),
        ("[0.05, 0.2]", "[0.2, 0.05]"),
    ] {
        assert!(STUDY.contains(from));
        assert_eq!(verdicts(&STUDY.replace(from, to)), wanted, "{to}");
    }
    // Blocks too: every expectation before and after every other.
    let blocks: Vec<&str> = STUDY.split("[[expect").collect();
    let turned = format!("{}[[expect{}[[expect{}[[expect{}", blocks[0], blocks[3], blocks[2], blocks[1]);
    assert_eq!(verdicts(&turned), wanted);
}

#[test]
fn a_reference_that_is_not_named_is_the_scenes_own_or_the_only_one_and_never_the_first() {
    let with = |references: &str, typed: &str| {
        let list = "['terzaghi', 'terzaghi-incompressible']";
        let text = STUDY
            .replace(list, references)
            .replace("time_factor = 0.2\n", &format!("time_factor = 0.2\n{typed}"));
        study(&text).map(|study| {
            let of_case =
                study.case_expectations[0].demand.error.as_ref().expect("an error").measure.reference.clone();
            let listed: Vec<&str> = study.references.iter().map(|kind| kind.name()).collect();
            (study.expectations[0].measure.reference.clone(), of_case, listed.join(" "))
        })
    };
    let told = |own: &str, case: &str, listed: &str| Ok((own.to_owned(), case.to_owned(), listed.to_owned()));
    let (own, other) = ("terzaghi", "terzaghi-incompressible");
    let both = format!("{own} {other}");
    assert_eq!(with("['terzaghi', 'terzaghi-incompressible']", ""), told(own, own, &both));
    assert_eq!(with("['terzaghi-incompressible', 'terzaghi']", ""), told(own, own, &both));
    assert_eq!(with("['terzaghi-incompressible']", ""), told(other, other, other));
    let named = "reference = 'terzaghi-incompressible'\n";
    assert_eq!(with("['terzaghi', 'terzaghi-incompressible']", named), told(other, own, &both));
    for (references, part) in [
        ("[]", "compared with no reference"),
        ("['terzaghi', 'terzaghi']", "listed twice"),
        ("['nobody']", "no reference is called `nobody`"),
    ] {
        let refused = with(references, "").expect_err(references);
        assert!(refused.contains(part), "{refused}");
    }
}
