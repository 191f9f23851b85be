//! Runs the cases of a study, each by whom it is given to: this program, or an attached solver.

use crate::campaign::case_run::{Cores, run_case, run_case_within, time_case};
use crate::campaign::stop;
use crate::case::Case;
use crate::foreign::attachment::{Attachment, Wish};
use crate::record::store::RecordStore;
use crate::record::{Record, Status, WallSample};
use crate::study::check::Study;
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::run::Kernel;
use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

/// A study with its attached solvers, ready to run.
pub struct CaseRunner<'a> {
    study: &'a Study,
    attachments: Vec<Attachment<'a>>,
}

impl<'a> CaseRunner<'a> {
    /// The runner of a study's cases.
    pub fn of(study: &'a Study) -> Self {
        let is_plane = study.scene.has_plane_fields();
        let attachments = study.solvers.iter().map(|solver| Attachment::new(solver, is_plane)).collect();
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

    /// Wall times of a case alone, which says no more than it did: nothing is held against its references again. None
    /// where it was stopped.
    ///
    /// # Errors
    /// When the case's parameters are impossible.
    pub fn time_alone(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
    ) -> Result<Vec<WallSample>, ExactError> {
        if self.study.holds_back(case) {
            return Ok(Vec::new());
        }
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
        // How far it is nobody knows before its end.
        let is_wanted = || observe(0, 1) && !stop::is_over();
        let wish = Wish {
            references: &self.study.references,
            place: place.as_deref(),
            alone,
            is_wanted: &is_wanted,
        };
        let of_case = |one: &&Attachment<'_>| Some(one.solver().attached) == case.method.attached;
        match self.attachments.iter().find(of_case) {
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
