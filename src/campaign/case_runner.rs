//! Runs the cases of a study with this program or an attached solver, and times them alone.

use crate::campaign::case_run::{Cores, run_case, run_case_within, time_case};
use crate::campaign::runner::{Progress, RunError};
use crate::campaign::stop;
use crate::case::work_estimate::estimated_work;
use crate::case::{Case, Task};
use crate::foreign::attachment::{Attachment, Standing, Wish};
use crate::import::mapping::Axes;
use crate::record::{Record, RecordStore, Status, WallSample};
use crate::study::check::Study;
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::run::Kernel;
use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

/// Repeats of a case that takes long end here: their spread is small, and they would make the study
/// wait for what it knows.
const REPEATS_OF_LONG_CASES: usize = 3;
/// Seconds beyond which the repeats of a case took long.
const LONG_REPEATS: f64 = 0.1;

/// A study with its attached solvers, ready to run.
pub struct CaseRunner<'a> {
    study: &'a Study,
    attachments: Vec<Attachment<'a>>,
}

impl<'a> CaseRunner<'a> {
    /// The runner of a study's cases.
    pub fn of(study: &'a Study) -> Self {
        let axes = Axes::of(study.scene);
        let attachments = study.solvers.iter().map(|solver| Attachment::new(solver, axes)).collect();
        Self { study, attachments }
    }

    /// The study.
    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// Runs a case within the time that the study gives it; what an attached solver leaves is kept in the store.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn run_within(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
        alone: bool,
        observe: &dyn Fn(u64, u64) -> bool,
    ) -> Result<Record, ExactError> {
        if case.is_attached() {
            return self.attached(case, store, alone, observe);
        }
        let (seconds, references) = (self.study.case_seconds, &self.study.references);
        run_case_within(seconds, case, references, Kernel::Fastest, Cores::one(alone), observe)
    }

    /// What a finished record is to the programs of now. Those of this program are told apart by their sources.
    pub fn standing(&self, record: &Record) -> Standing {
        match self.attachments.iter().find(|one| one.is_of(&record.case)) {
            Some(attachment) => attachment.standing(record, !self.study.holds_back(&record.case)),
            None => Standing::Proven,
        }
    }

    /// Runs a case alone, to be timed or looked at.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn run_alone(&self, case: &Case, store: Option<&RecordStore>) -> Result<Record, ExactError> {
        if case.is_attached() {
            return self.attached(case, store, true, &|_, _| true);
        }
        run_case(case, &self.study.references, Kernel::Fastest, true, &|_, _| true)
    }

    /// Wall times of a case alone; its errors are not computed again. None where it was stopped.
    ///
    /// # Errors
    /// When the case's parameters are impossible.
    pub fn time_alone(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
    ) -> Result<Vec<WallSample>, ExactError> {
        if case.is_attached() {
            let timed = self.attached(case, store, true, &|_, _| true)?;
            return Ok(if is_stopped(&timed) { Vec::new() } else { timed.wall });
        }
        time_case(case).map(|wall| vec![wall])
    }

    fn attached(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
        alone: bool,
        observe: &dyn Fn(u64, u64) -> bool,
    ) -> Result<Record, ExactError> {
        let place = store.map(|store| store.folder_of(&case.hash()));
        // It has a process group of its own, which no signal to this program reaches: from now on they are taken, and
        // end it with all that it has started. Where the system refuses, they do what they did.
        let _ = stop::heed_signals();
        // The progress of an attached solver is unknown until it ends.
        let is_wanted = || observe(0, 1) && !stop::is_over();
        let wish = Wish {
            references: &self.study.references,
            place: place.as_deref(),
            alone,
            is_wanted: &is_wanted,
        };
        match self.attachments.iter().find(|one| one.is_of(case)) {
            Some(attachment) if self.study.holds_back(case) => attachment.held_back(case, &wish),
            Some(attachment) => attachment.run(case, &wish),
            None => run_case(case, wish.references, Kernel::Fastest, alone, observe),
        }
    }
}

/// Whether the record of a case tells that it was stopped from outside.
pub fn is_stopped(record: &Record) -> bool {
    let is_it = |failure: &Failure| matches!(failure.kind, FailureKind::Stopped | FailureKind::TimedOut);
    matches!(&record.status, Status::Failed(failure) if is_it(failure))
}

/// Whether the wall time of a case is not known yet as well as its study asks.
fn wants_timing(record: &Record, repeats: usize) -> bool {
    let wall = record.wall_alone();
    let is_long = wall.iter().sum::<f64>() > LONG_REPEATS;
    let enough = if is_long { repeats.min(REPEATS_OF_LONG_CASES) } else { repeats };
    let is_solved = record.case.task == Task::Solve;
    is_solved && record.status == Status::Ok && wall.len() < enough
}

/// Times the cases of records alone, in rounds over all of them, until each has the study's number
/// of samples: what drifts on the machine meets every case alike.
///
/// # Errors
/// When a case cannot be run or its times not be kept.
pub fn time_study(
    study: &Study,
    records: &mut [Record],
    store: Option<&RecordStore>,
    tell: &(dyn Fn(Progress) + Sync),
) -> Result<(), RunError> {
    let runner = CaseRunner::of(study);
    let mut is_timed = false;
    for _ in 0..study.timing_repeats {
        for record in &mut *records {
            if stop::is_asked() || !wants_timing(record, study.timing_repeats) {
                continue;
            }
            let timed = runner
                .time_alone(&record.case, store)
                .map_err(|error| RunError::refused(&record.case, &error))?;
            if timed.is_empty() {
                continue;
            }
            record.wall.extend(timed);
            is_timed = true;
            tell(Progress::Advanced(estimated_work(&record.case)));
        }
    }
    if let Some(store) = store.filter(|_| is_timed) {
        for record in &*records {
            store.write_wall(record)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    fn record(task: &str) -> Record {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\ntask = \"{task}\"\noutput = {{ time_factors = [0.001] }}\n\
             sweep = [{{ method = [\"GIMP\"], cells = [2], time_step = [{{ stable = 0.8 }}] }}]\n"
        );
        records_of(&text).remove(0)
    }

    #[test]
    fn what_is_solved_is_timed_as_often_as_asked_and_what_takes_long_three_times() {
        let mut solved = record("solve");
        solved.wall.clear();
        for (seconds, repeats) in [(0.001, 12), (0.06, 3), (0.022, 5)] {
            solved.wall.clear();
            while wants_timing(&solved, 12) {
                solved.wall.push(WallSample { seconds, alone: true, ..WallSample::default() });
            }
            assert_eq!(solved.wall.len(), repeats, "{seconds} s");
        }
        assert!(!wants_timing(&record("stability"), 12), "a search has no time of its own");
    }

    #[test]
    fn a_run_is_stopped_by_its_time_or_from_outside_and_by_nothing_else() {
        use oedometer_mpm::run::results::outcome::FailureKind as Kind;

        let mut one = record("solve");
        assert!(!is_stopped(&one));
        for (kind, stopped) in
            [(Kind::Stopped, true), (Kind::TimedOut, true), (Kind::Unstable, false), (Kind::Skipped, false)]
        {
            one.status = Status::Failed(Failure::of_attached(kind, String::new()));
            assert_eq!(is_stopped(&one), stopped, "{kind:?}");
        }
    }
}
