//! A study with its records, their paths and the verdicts on them: what pages are made of.

use crate::campaign::taken_over::TakenOver;
use crate::case::planned::Tier;
use crate::golden::{GoldenError, GoldenFile};
use crate::judge::paths::{Path, StudyPaths};
use crate::judge::study_check::StudyCheck;
use crate::record::Record;
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::WINDOW;

/// A study with its records and the verdicts on them.
pub struct StudyResults<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its records.
    pub records: &'a [Record],
    /// Their paths along every axis.
    pub paths: StudyPaths<'a>,
    /// The verdicts.
    pub check: StudyCheck,
    /// The file of the study, as it was given.
    pub file: String,
    /// Whether it has a page of its own: a shipped study has one where it is asked for by name.
    pub has_page: bool,
}

impl<'a> StudyResults<'a> {
    /// Judges the records of a study, and compares them with no golden values.
    pub fn new(study: &'a Study, records: &'a [Record], tier: Tier) -> Self {
        let none = GoldenError::Missing(format!("golden/{}.csv", study.name).into());
        Self::compared(study, records, tier, Err(none))
    }

    /// Judges the records of a study, and compares them with its golden values.
    pub fn compared(
        study: &'a Study,
        records: &'a [Record],
        tier: Tier,
        golden: Result<GoldenFile, GoldenError>,
    ) -> Self {
        let paths = StudyPaths::of(records);
        let check = StudyCheck::along(&paths, study, records, tier, golden);
        let file = format!("studies/{}.toml", study.name);
        Self { study, records, paths, check, file, has_page: true }
    }

    /// Adds the results that were not made for this page.
    #[must_use]
    pub fn with_taken_over(mut self, taken_over: &[TakenOver]) -> Self {
        self.check = self.check.with_taken_over(taken_over);
        self
    }

    /// Cases of the study that have no record. A race leaves out what nobody needs any more.
    pub fn left_out(&self) -> usize {
        if self.study.is_race {
            return 0;
        }
        self.study.planned.len().saturating_sub(self.records.len())
    }

    /// The paths of at least three levels along an axis: two levels have no order.
    pub(crate) fn refined(&self, axis: Axis) -> Vec<Path<'a>> {
        let mut paths = self.paths.along(axis).to_vec();
        paths.retain(|path| path.records.len() >= WINDOW);
        paths
    }

    /// The command that runs the study again.
    pub(crate) fn run_command(&self) -> String {
        if self.file.contains(char::is_whitespace) {
            format!("oedometer run \"{}\"", self.file)
        } else {
            format!("oedometer run {}", self.file)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};

    #[test]
    fn what_ended_well_outside_of_the_race_is_checked_and_a_name_with_spaces_is_quoted() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                    integrator = ['implicit']\ncells = [2, 4, 8]\n";
        let (mut study, mut records) = solved("s", text);
        for record in &mut records[1..] {
            record.start.as_mut().expect("a start").volume_error = 0.5;
        }
        records[2].status = failed_at(1);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let cases: Vec<&str> = results.check.unsound.iter().map(|note| note.case.as_str()).collect();
        assert_eq!(cases, [records[1].case.label()]);
        assert!(!results.check.meets_all() && results.check.met() == 0);
        assert!(StudyResults::new(&study, &records[..1], Tier::Full).check.meets_all());
        assert_eq!(
            (results.left_out(), StudyResults::new(&study, &records[..1], Tier::Full).left_out()),
            (0, 2)
        );
        assert_eq!(results.run_command(), "oedometer run studies/s.toml");
        assert_eq!(
            StudyResults { file: "my files/s.toml".to_owned(), ..results }.run_command(),
            "oedometer run \"my files/s.toml\""
        );
        study.is_race = true;
        assert_eq!(
            StudyResults::new(&study, &records, Tier::Full).check.unsound,
            [],
            "the race tells it in its cells"
        );
    }
}
