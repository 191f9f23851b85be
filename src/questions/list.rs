//! The questions in the order of a reader, and their answers.

use crate::judge::study_results::StudyResults;
use crate::questions::audit::AUDIT;
use crate::questions::checks::CHECKS;
use crate::questions::choice::CHOICE;
use crate::questions::convergence::CONVERGENCE;
use crate::questions::cost::COST;
use crate::questions::ends::ENDS;
use crate::questions::expected::EXPECTED;
use crate::questions::fields::FIELDS;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::load_curves::LOAD_CURVES;
use crate::questions::locking::LOCKING;
use crate::questions::outside_runs::OUTSIDE_RUNS;
use crate::questions::paper::PAPER;
use crate::questions::peers::PEERS;
use crate::questions::point_sets::POINT_SETS;
use crate::questions::points::{POINTS, WATER};
use crate::questions::profiles::PROFILES;
use crate::questions::setting::SETTING;
use crate::questions::settlement::SETTLEMENT;
use crate::questions::stability::STABILITY;
use crate::questions::time_step::TIME_STEP;
use crate::questions::uncertainty::UNCERTAINTY;
use crate::questions::within::WITHIN;
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
    &FIELDS,
    &LOAD_CURVES,
    &PROFILES,
    &STABILITY,
    &ENDS,
    &UNCERTAINTY,
    &CHECKS,
    &OUTSIDE_RUNS,
    &AUDIT,
    &POINT_SETS,
];

/// What studies answer at a place, in the order of the questions.
///
/// # Errors
/// When a reference refuses a case: that of the first question, on any number of threads.
pub fn answers(studies: &[StudyResults<'_>], place: Place) -> Result<Vec<Finding>, ExactError> {
    let asked: Vec<_> = QUESTIONS
        .par_iter()
        .filter(|question| question.stands_at(place))
        .map(|question| (question.ask)(studies))
        .collect();
    asked.into_iter().filter_map(Result::transpose).collect()
}
