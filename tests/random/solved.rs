//! What a case comes to: its end by kind, and its record where it ran.

use crate::options::Options;
use oedometer::{Kernel, Record, Status, estimated_seconds, run_case, soundness};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Estimated seconds of a case that is still drawn: a bound on its work, and not on a clock.
const LONGEST: f64 = 0.05;

/// Whether a checker of studies takes options, and they are short enough for a sweep.
pub fn is_short(options: &Options) -> bool {
    let estimate = || options.study().map(|study| estimated_seconds(&study.planned[0].case));
    catch_unwind(AssertUnwindSafe(estimate)).is_ok_and(|seconds| seconds.is_ok_and(|of| of <= LONGEST))
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The checker of studies had something against it.
    Refused(String),
    /// It would be too long for a sweep.
    TooLong,
    /// The exact solutions or the door of the solver had something against it.
    Impossible(String),
    /// It ended by this name.
    Failed(String),
    /// Its numbers are there, and what is wrong with them is told.
    Warned(Vec<String>),
    /// Its numbers are there, and nothing is said against them.
    Sound,
    /// It panicked.
    Panicked,
}

impl End {
    /// The kind of end, for a count.
    pub fn kind(&self) -> String {
        match self {
            Self::Refused(_) => "refused".to_owned(),
            Self::TooLong => "too long".to_owned(),
            Self::Impossible(_) => "impossible".to_owned(),
            Self::Failed(why) => format!("failed: {}", why.split(':').next().unwrap_or_default()),
            Self::Warned(_) => "warned".to_owned(),
            Self::Sound => "ok".to_owned(),
            Self::Panicked => "panicked".to_owned(),
        }
    }
}

/// A case with its end.
pub struct Solved {
    pub end: End,
    pub record: Option<Record>,
}

impl Solved {
    fn without_record(end: End) -> Self {
        Self { end, record: None }
    }

    /// Solves what options describe, by the fastest kernel.
    pub fn of(options: &Options) -> Self {
        Self::by(options, Kernel::Fastest)
    }

    /// The same by a kernel.
    pub fn by(options: &Options, kernel: Kernel) -> Self {
        Self::within(options, kernel, LONGEST)
    }

    /// The same where it takes at most so many estimated seconds.
    pub fn within(options: &Options, kernel: Kernel, longest: f64) -> Self {
        let study = match catch_unwind(AssertUnwindSafe(|| options.study())) {
            Ok(Ok(study)) => study,
            Ok(Err(told)) => return Self::without_record(End::Refused(told)),
            Err(_) => return Self::without_record(End::Panicked),
        };
        let case = &study.planned[0].case;
        if estimated_seconds(case) > longest {
            return Self::without_record(End::TooLong);
        }
        let run = || run_case(case, &study.references, kernel, false, &|_, _| true);
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok(record)) => Self { end: end_of(&record), record: Some(record) },
            Ok(Err(told)) => Self::without_record(End::Impossible(told.to_string())),
            Err(_) => Self::without_record(End::Panicked),
        }
    }
}

fn end_of(record: &Record) -> End {
    if let Status::Failed(failure) = &record.status {
        return End::Failed(format!("{}: {}", failure.kind.name(), failure.reason));
    }
    let complaints = soundness::complaints(record);
    if complaints.is_empty() { End::Sound } else { End::Warned(complaints) }
}
