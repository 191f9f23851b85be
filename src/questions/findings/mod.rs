//! Everything that is found about a study, as one value of plain data: numbers, units, names and choices of a fixed list,
//! each once, and no sentence that a page would not find in the judge itself.
//!
//! `findings.json` is written beside the page of a study, and `oedometer schema findings` describes it. Lengths are in m,
//! pressures in Pa, times in s; errors are relative.

pub mod convergence;
mod series;
pub mod study_answers;
pub mod within;

use crate::case::Tier;
use crate::judge::verdict::{Judgement, VerdictOutcome};
use crate::questions::blocks::StudyBlocks;
use crate::questions::finding::{Finding, Place, unread};
use crate::questions::findings::study_answers::StudyAnswers;
use crate::questions::list;
use crate::questions::study_results::StudyResults;
use crate::record::{ErrorRow, Record};
use oedometer_convergence::Class;
use oedometer_exact::ExactError;
use oedometer_problem::outcome::FailureKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
pub use series::SeriesFinding;
pub use within::QuantityWithin;

/// Version of the layout; it rises when a field goes or changes its meaning.
pub const SCHEMA: u32 = 2;

/// Everything that is found about a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Findings {
    /// Version of the layout.
    pub schema: u32,
    /// Name of the study.
    pub study: String,
    /// Name of its scene.
    pub scene: String,
    /// Names of its references, the scene's own first.
    pub references: Vec<String>,
    /// Cases of the study without a record.
    pub left_out: usize,
    /// Expectations, each with its verdict.
    pub expectations: Vec<ExpectationFinding>,
    /// Every run.
    pub runs: Vec<RunFinding>,
    /// Every error over every axis that the study refines, from two levels on.
    pub series: Vec<SeriesFinding>,
    /// For each quantity and bound the cheapest choice of method, mesh and step within it.
    pub within: Vec<QuantityWithin>,
    /// The answers to the questions that are files of their own.
    #[serde(default, deserialize_with = "unread")]
    #[schemars(schema_with = "list::schema")]
    #[expect(clippy::struct_field_names, reason = "a key of findings.json")]
    pub findings: Vec<Finding>,
    /// What the other blocks of the study's page print.
    #[serde(default)]
    pub blocks: StudyBlocks,
}

/// An expectation with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExpectationFinding {
    /// Line in the study's file.
    pub line: usize,
    /// What is judged: labels of runs, measure and time.
    pub subject: String,
    /// How the verdict came out.
    pub outcome: VerdictOutcome,
    /// Class of the series.
    pub class: Class,
    /// Order on the finest window, where the class allows one.
    pub order: Option<f64>,
    /// Every part that is judged.
    pub checks: Vec<CheckFinding>,
}

/// A part of an expectation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckFinding {
    /// `class`, `order`, `error`, `floor` or another part.
    pub name: String,
    /// Whether it is met.
    pub pass: bool,
    /// The number judged.
    pub measured: Option<f64>,
}

/// A run and its errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunFinding {
    /// Hash of the case.
    pub case: String,
    /// Label of the case.
    pub label: String,
    /// Name of the method.
    pub method: String,
    /// Cells over the height.
    pub cells: usize,
    /// Points in a cell.
    pub points_per_cell: usize,
    /// Why and where it failed; no result of such a run is judged.
    pub failure: Option<FailureFinding>,
    /// Largest time step, s.
    pub largest_step: f64,
    /// Steps taken.
    pub steps: u64,
    /// Shortest wall time over the repeats, s.
    pub seconds: Option<f64>,
    /// `m_vl q`, the final strain of small-strain theory, of the softest soil.
    pub finite_strain: f64,
    /// Every error.
    pub errors: Vec<ErrorRow>,
}

/// How a run failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FailureFinding {
    /// The kind.
    pub kind: FailureKind,
    /// Step at which it was seen.
    pub step: u64,
    /// Time then, s.
    pub time: f64,
}

impl Findings {
    /// Everything about a study, from its records and verdicts and what it answers by itself.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &StudyResults<'_>, answers: &StudyAnswers) -> Result<Self, ExactError> {
        let StudyResults { study, records, paths, check, .. } = results;
        // The page of a race has answers of its own in their place.
        let within = if study.is_race { within::within(study, records) } else { answers.within.clone() };
        Ok(Self {
            schema: SCHEMA,
            study: study.name.clone(),
            scene: study.scene.name.to_owned(),
            references: study.references.iter().map(|kind| kind.name().to_owned()).collect(),
            left_out: study.cases(Tier::Full).len().saturating_sub(records.len()),
            expectations: check.judgements.iter().map(ExpectationFinding::new).collect(),
            runs: records.iter().map(RunFinding::new).collect(),
            series: series::all_series(study, paths),
            within,
            findings: list::answers(std::slice::from_ref(results), Place::Study)?,
            blocks: StudyBlocks::new(results),
        })
    }
}

impl ExpectationFinding {
    fn new(judgement: &Judgement) -> Self {
        let verdict = &judgement.verdict;
        let check = |check: &crate::judge::verdict::Check| CheckFinding {
            name: check.name.clone(),
            pass: check.pass,
            measured: check.measured,
        };
        Self {
            line: judgement.line,
            subject: judgement.subject.clone(),
            outcome: verdict.outcome,
            class: verdict.classification.class,
            order: verdict.classification.order,
            checks: verdict.checks.iter().map(check).collect(),
        }
    }
}

impl RunFinding {
    fn new(record: &Record) -> Self {
        let failure = record.status.failure();
        let seconds = record.wall.iter().map(|sample| sample.seconds).reduce(f64::min);
        Self {
            case: record.hash.clone(),
            label: record.case.label(),
            method: record.case.method.to_string(),
            cells: record.case.cells,
            points_per_cell: record.case.points_per_cell,
            failure: failure.map(|failure| FailureFinding {
                kind: failure.kind,
                step: failure.step,
                time: failure.time,
            }),
            largest_step: record.step_sizes.largest,
            steps: record.counters.steps,
            seconds,
            finite_strain: record.groups.finite_strain,
            errors: record.errors.iter().filter(|row| row.value.is_finite()).cloned().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};

    /// Two meshes and one time, the least that answers anything: every error is in the findings once, a failed run is told
    /// with its reason and is within no bound, and what is read is what was written.
    #[test]
    fn two_meshes_and_one_time_are_told_with_every_error_and_every_failure() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
            method = ['MPM', 'GC-SRI-patch']\nintegrator = ['implicit']\ncells = [4, 8]\n";
        let (study, mut records) = solved("s", text);
        records[0].status = failed_at(3);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let found = results.findings().expect("sound cases").plain;
        assert_eq!((found.runs.len(), found.left_out), (4, 0));
        let failure = found.runs[0].failure.as_ref().expect("it failed");
        assert_eq!((failure.kind.name(), failure.step), ("unstable", 3));
        let choices =
            || found.within.iter().flat_map(|one| &one.bounds).filter_map(|one| one.choice.as_ref());
        assert!(choices().all(|choice| choice.case != records[0].hash) && choices().count() > 0);
        let two = |one: &&SeriesFinding| one.levels.len() == 2 && one.class == Class::NotEvaluable;
        assert!(found.series.iter().filter(two).count() >= 8, "two levels have no class but errors");
        let json = serde_json::to_string(&found).expect("plain data");
        // Answers are asked anew, not read.
        let found = Findings { findings: Vec::new(), ..found };
        assert_eq!(serde_json::from_str::<Findings>(&json).expect("what was written"), found);
    }
}
