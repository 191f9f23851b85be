//! Is everything as expected? Expectations met in all studies, checks of runs that fail, and the studies in which something is not
//! as expected.

use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Place, Question};
use serde::Serialize;

/// Is everything as expected?
pub static EXPECTED: Question = Question {
    id: "expected",
    heading: "Is everything as expected?",
    template: include_str!("expected.md"),
    places: &[Place::Report],
    ask: |studies| Ok(Some(EXPECTED.answer([], &Facts::new(studies)))),
};

/// Every number and name of the sentence.
#[derive(Serialize)]
struct Facts {
    /// Expectations.
    expectations: usize,
    /// Those that are met.
    met: usize,
    /// Studies.
    studies: usize,
    /// Runs.
    runs: usize,
    /// Checks of runs that fail.
    unsound: usize,
    /// Names of the studies in which something is not as expected.
    failing: Vec<String>,
}

impl Facts {
    fn new(studies: &[StudyResults<'_>]) -> Self {
        let sum = |count: &dyn Fn(&StudyResults<'_>) -> usize| studies.iter().map(count).sum::<usize>();
        let failing = studies.iter().filter(|one| !one.check.meets_all()).map(|one| one.study.name.clone());
        Self {
            expectations: sum(&|one| one.check.judgements.len()),
            met: sum(&|one| one.check.met()),
            studies: studies.len(),
            runs: sum(&|one| one.records.len()),
            unsound: sum(&|one| one.check.unsound.len()),
            failing: failing.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::Tier;
    use crate::judge::study_check::CaseNote;

    #[test]
    fn what_is_met_is_counted_and_what_is_not_as_expected_is_named() {
        let told = |name: &str, bounds: &[f64], wrong: usize| {
            let expect = |below: &f64| {
                format!("[[expect_case]]\ntime_factor = 0.1\nerror = {{ below = {below:e} }}\n")
            };
            let text =
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                        integrator = ['implicit']\ncells = [4]\n"
                    .to_owned() + &bounds.iter().map(expect).collect::<String>();
            let (study, records) = solved(name, &text);
            let mut one = StudyResults::new(&study, &records, Tier::Full);
            let note = CaseNote { case: "a case".to_owned(), sentence: "why".to_owned() };
            one.check.unsound = vec![note; wrong];
            let finding = (EXPECTED.ask)(&[one]).expect("sound cases").expect("an answer");
            finding.sentence().expect("a sentence")
        };
        assert_eq!(told("met", &[0.9, 0.8], 0), "**2 of 2 expectations met** in 1 study with 1 run.");
        assert_eq!(
            told("unmet", &[0.9, 1e-9], 0),
            "**1 of 2 expectations met** in 1 study with 1 run. Not as expected: `unmet`."
        );
        assert_eq!(
            told("bare", &[], 2),
            "**No expectations** in 1 study with 1 run. 2 checks of runs fail. Not as expected: `bare`."
        );
    }
}
