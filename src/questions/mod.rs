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
use crate::questions::audit::AUDIT;
use crate::questions::checks::CHECKS;
use crate::questions::choice::CHOICE;
use crate::questions::convergence::CONVERGENCE;
use crate::questions::cost::COST;
use crate::questions::expected::EXPECTED;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::load_curves::LOAD_CURVES;
use crate::questions::locking::LOCKING;
use crate::questions::outside_runs::OUTSIDE_RUNS;
use crate::questions::paper::PAPER;
use crate::questions::peers::PEERS;
use crate::questions::points::{POINTS, WATER};
use crate::questions::profiles::PROFILES;
use crate::questions::setting::SETTING;
use crate::questions::settlement::SETTLEMENT;
use crate::questions::stability::STABILITY;
use crate::questions::time_step::TIME_STEP;
use crate::questions::within::WITHIN;
use crate::race::RaceFindings;
use oedometer_exact::ExactError;
use rayon::prelude::*;

/// Every question, in the order of a page.
pub static QUESTIONS: &[&Question] = &[
    &EXPECTED,
    &SETTING,
    &CHOICE,
    &WITHIN,
    &SETTLEMENT,
    &CONVERGENCE,
    &TIME_STEP,
    &POINTS,
    &WATER,
    &COST,
    &PEERS,
    &PAPER,
    &LOCKING,
    &LOAD_CURVES,
    &PROFILES,
    &STABILITY,
    &CHECKS,
    &OUTSIDE_RUNS,
    &AUDIT,
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
        Some(race) if question.id == CHOICE.id => Ok(choice::answer(race)),
        _ => (question.ask)(studies),
    };
    let asked: Vec<_> = QUESTIONS.par_iter().filter(|question| question.stands_at(place)).map(ask).collect();
    asked.into_iter().filter_map(Result::transpose).collect()
}
