//! What the records of all studies answer, as plain data: one value per question of a reader. Numbers, names and choices of a
//! fixed list, no sentence; `findings.json` beside the report has them, and templates make sentences of them.

pub mod converges;
pub mod time_step;

use crate::case::{Quantity, Sample};
use crate::questions::finding::{Finding, Place, unread};
use crate::questions::list;
use crate::questions::study_results::StudyResults;
use crate::race::RaceFindings;
use oedometer_exact::ExactError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cells of the mesh on which errors are quoted: the paper's.
pub const QUOTED_CELLS: usize = 10;

/// The measures that show what a method converges to.
pub const CONVERGENCE: [(Quantity, Sample); 4] = [
    (Quantity::Pressure, Sample::Points),
    (Quantity::Pressure, Sample::Centres),
    (Quantity::EffectiveStress, Sample::Points),
    (Quantity::Settlement, Sample::Surface),
];

/// Everything that a report of several studies says: the race, where there was one, and the answer to each question that the
/// records answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReportFindings {
    /// The race to 1 %: whole in `tables/race.csv`, its answers among the findings.
    #[serde(skip)]
    pub race: Option<RaceFindings>,
    /// The answers to the questions that are files of their own.
    #[serde(default, deserialize_with = "unread")]
    #[schemars(schema_with = "list::schema")]
    pub findings: Vec<Finding>,
    /// Does the method converge, and to what?
    pub converges: Option<converges::ConvergesFinding>,
    /// What does the time step change?
    pub time_step: Option<time_step::TimeStepFinding>,
    /// Whether everything is as expected.
    pub verdict: VerdictFinding,
}

impl ReportFindings {
    /// The answers of the records of some studies.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &[StudyResults<'_>]) -> Result<Self, ExactError> {
        Ok(Self {
            race: RaceFindings::from_studies(results.iter().map(|one| (one.study, one.records))),
            findings: list::answers(results, Place::Report)?,
            converges: converges::ConvergesFinding::new(results),
            time_step: time_step::TimeStepFinding::new(results),
            verdict: VerdictFinding::new(results),
        })
    }
}

/// Whether everything is as expected.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerdictFinding {
    /// Expectations.
    pub expectations: usize,
    /// Those that are met.
    pub met: usize,
    /// Studies.
    pub studies: usize,
    /// Runs.
    pub runs: usize,
    /// Checks of runs that fail.
    pub unsound: usize,
    /// Names of the studies in which something is not as expected.
    pub failing: Vec<String>,
}

impl VerdictFinding {
    fn new(results: &[StudyResults<'_>]) -> Self {
        let sum = |count: &dyn Fn(&StudyResults<'_>) -> usize| results.iter().map(count).sum::<usize>();
        let failing = results.iter().filter(|one| !one.check.meets_all()).map(|one| one.study.name.clone());
        Self {
            expectations: sum(&|one| one.check.judgements.len()),
            met: sum(&|one| one.check.met()),
            studies: results.len(),
            runs: sum(&|one| one.records.len()),
            unsound: sum(&|one| one.check.unsound.len()),
            failing: failing.collect(),
        }
    }
}

/// The study that has most of what answers a question, the first of equals. The race has an answer of its own.
fn study_with_most<'b, 'a, T, W: PartialOrd>(
    results: &'b [StudyResults<'a>],
    answer: impl Fn(&'b StudyResults<'a>) -> Option<(W, T)>,
) -> Option<(&'b StudyResults<'a>, T)> {
    let studies = results.iter().filter(|one| !one.study.is_race);
    let all = studies.filter_map(|one| answer(one).map(|(worth, answer)| (worth, (one, answer))));
    all.reduce(|most, next| if next.0 > most.0 { next } else { most }).map(|(_, answer)| answer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::study_of;
    use crate::case::planned::Tier;
    use crate::study::check::Study;

    #[test]
    fn of_equals_the_first_study_answers_and_the_race_none() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                    integrator = ['implicit']\ncells = [4]\n";
        let answering = |worths: [Option<usize>; 4], race: usize| {
            let mut studies: Vec<Study> = ["a", "b", "c", "d"].map(|name| study_of(name, text)).into();
            studies[race].is_race = true;
            let results: Vec<_> =
                studies.iter().map(|study| StudyResults::new(study, &[], Tier::Full)).collect();
            let worth = |one: &StudyResults<'_>| {
                worths[results.iter().position(|other| other.study.name == one.study.name)?]
            };
            study_with_most(&results, |one| Some((worth(one)?, ()))).map(|(one, ())| one.study.name.clone())
        };
        for (worths, race, wanted) in [
            ([Some(1), Some(3), Some(3), Some(2)], 3, Some("b")),
            ([Some(3), Some(1), Some(3), None], 3, Some("a")),
            ([Some(3), None, Some(1), Some(4)], 0, Some("d")),
            ([Some(3), None, None, None], 0, None),
        ] {
            assert_eq!(answering(worths, race).as_deref(), wanted, "{worths:?}");
        }
    }
}
