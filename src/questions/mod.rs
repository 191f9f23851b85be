//! What readers ask of studies: a question is one file with its template beside it, and answers with a finding, from which
//! the terminal, the page of a study, the report and `findings.json` are written.

pub mod audit;
pub mod checks;
pub mod choice;
pub mod convergence;
pub mod cost;
pub mod expected;
pub mod finding;
pub mod load_curves;
pub mod locking;
pub mod outside_runs;
pub mod paper;
pub mod peers;
pub mod points;
pub mod profiles;
pub mod published_equations;
pub mod race_tables;
pub mod sentence;
pub mod series;
pub mod series_figure;
pub mod setting;
pub mod settlement;
pub mod stability;
pub mod stiffness_sweep;
pub mod time_step;
pub mod within;
pub mod words;
pub mod work_precision;

use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::race::RaceFindings;
use oedometer_exact::ExactError;
use rayon::prelude::*;

/// Every question, in the order of a page.
pub static QUESTIONS: &[&Question] = &[
    &expected::EXPECTED,
    &setting::SETTING,
    &choice::CHOICE,
    &within::WITHIN,
    &settlement::SETTLEMENT,
    &convergence::CONVERGENCE,
    &time_step::TIME_STEP,
    &points::POINTS,
    &points::WATER,
    &cost::COST,
    &peers::PEERS,
    &paper::PAPER,
    &locking::LOCKING,
    &load_curves::LOAD_CURVES,
    &profiles::PROFILES,
    &stability::STABILITY,
    &checks::CHECKS,
    &outside_runs::OUTSIDE_RUNS,
    &audit::AUDIT,
];

/// What studies answer at a place, in the order of the questions.
///
/// # Errors
/// When a reference refuses a case: that of the first question, on any number of threads.
pub fn answers(studies: &[StudyResults<'_>], place: Place) -> Result<Vec<Finding>, ExactError> {
    answers_with(studies, place, None)
}

/// The same with a race that is computed already.
///
/// # Errors
/// As above.
pub fn answers_with(
    studies: &[StudyResults<'_>],
    place: Place,
    race: Option<&RaceFindings>,
) -> Result<Vec<Finding>, ExactError> {
    let ask = |question: &&Question| match race {
        Some(race) if question.id == choice::CHOICE.id => Ok(choice::answer(race)),
        _ => (question.ask)(studies),
    };
    let asked: Vec<_> = QUESTIONS.par_iter().filter(|question| question.stands_at(place)).map(ask).collect();
    asked.into_iter().filter_map(Result::transpose).collect()
}
