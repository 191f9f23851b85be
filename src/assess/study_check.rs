//! A study held against its expectations and its golden values.

use super::summary::{Judgement, judge_study};
use crate::golden::{Difference, GoldenError, GoldenFile, compare, values_of};
use crate::record::{Record, Status};
use crate::study::{Study, Tier};

/// Everything found about one study.
#[derive(Debug)]
pub struct StudyCheck {
    /// Name of the study.
    pub study: String,
    /// Cases that failed, with their sentences.
    pub failed_cases: Vec<(String, String)>,
    /// Verdicts on expectations.
    pub judgements: Vec<Judgement>,
    /// Differences from the golden values, or why there are none to hold against.
    pub golden: Result<Vec<Difference>, GoldenError>,
    /// Golden values that agree.
    pub agreeing: usize,
}

impl StudyCheck {
    /// Judges records and compares them.
    pub fn new(
        study: &Study,
        records: &[Record],
        tier: Tier,
        golden: Result<GoldenFile, GoldenError>,
    ) -> Self {
        let values = values_of(records);
        let golden = golden.map(|golden| compare(&golden, &values));
        let changed =
            golden.as_ref().map_or(values.len(), |all| all.iter().filter(|one| one.found.is_some()).count());
        Self {
            study: study.name.clone(),
            failed_cases: records
                .iter()
                .filter(|record| !study.foresees(record))
                .filter_map(failure_sentence)
                .collect(),
            judgements: judge_study(study, records, tier),
            agreeing: values.len() - changed,
            golden,
        }
    }

    /// Differences from the golden values; none where there is no golden file.
    pub fn differences(&self) -> &[Difference] {
        self.golden.as_deref().unwrap_or_default()
    }
}

fn failure_sentence(record: &Record) -> Option<(String, String)> {
    match &record.status {
        Status::Ok => None,
        Status::Failed(failure) => Some((
            record.case.label(),
            format!(
                "{} at step {}, t = {:.4e} s: {}",
                failure.kind.name(),
                failure.step,
                failure.time,
                failure.reason
            ),
        )),
    }
}
