//! Progress of long work on standard error: a bar with an estimate on terminals, only failures elsewhere.

use crate::campaign::runner::{LongestCase, Progress};
use crate::case::work_estimate::estimated_seconds;
use crate::cli::stream::say;
use crate::cli::time_notes::{note_on_longest, note_on_run, side_by_side};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use oedometer_soil::wording::{count_of, duration};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The bar of a study, or of several at once.
pub struct StudyBar {
    bar: ProgressBar,
    /// Number of cases at the same time.
    jobs: Arc<AtomicUsize>,
}

/// Seconds left when a share of the work is done: by the plan at first, then more and more by the pace so far.
fn time_left(planned: f64, done: f64, elapsed: f64) -> f64 {
    let by_plan = planned * (1.0 - done).max(0.0);
    let by_experience = elapsed * (1.0 / done.max(f64::MIN_POSITIVE) - 1.0).max(0.0);
    let trust = (done / TRUSTED_SHARE).max(elapsed / TRUSTED_SECONDS).min(1.0);
    if done > 0.0 { (1.0 - trust) * by_plan + trust * by_experience } else { by_plan }
}

/// Share of the work after which only the pace counts.
const TRUSTED_SHARE: f64 = 0.05;
/// Seconds after which only the pace counts.
const TRUSTED_SECONDS: f64 = 20.0;

impl StudyBar {
    /// A bar with a name, hidden if standard error is not a terminal.
    pub fn new(name: &str) -> Self {
        let bar = ProgressBar::new(0);
        let jobs = Arc::new(AtomicUsize::new(1));
        let of_bar = Arc::clone(&jobs);
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        // Name and message are cut on a narrow terminal: a line that wraps would be drawn again below.
        let style =
            ProgressStyle::with_template("{prefix:<24!} [{bar:16}] {percent:>3} %, {left}, {wide_msg}");
        if let Ok(style) = style {
            let left = move |state: &ProgressState, out: &mut dyn Write| {
                let done = state.pos() as f64 / state.len().unwrap_or(1).max(1) as f64;
                let planned = 1e-9 * state.len().unwrap_or(0) as f64 / of_bar.load(Ordering::Relaxed) as f64;
                let _ =
                    write!(out, "{} left", duration(time_left(planned, done, state.elapsed().as_secs_f64())));
            };
            bar.set_style(style.with_key("left", left).progress_chars("=> "));
        }
        bar.set_prefix(name.to_owned());
        Self { bar, jobs }
    }

    /// Takes a message of the runner.
    pub fn tell(&self, progress: Progress) {
        match progress {
            Progress::Planned { cases, resumed, work, jobs, longest } => {
                self.jobs.store(jobs, Ordering::Relaxed);
                self.tell_of_time(cases, work, jobs, longest.as_deref());
                self.bar.set_length(work);
                let taken_up = if resumed > 0 { format!(", {resumed} from disk") } else { String::new() };
                let beyond = if work == u64::MAX { ", more work than can be counted" } else { "" };
                self.bar.set_message(format!("{}{taken_up}{beyond}", count_of(cases, "case", "cases")));
            }
            Progress::Advanced(work) => self.bar.inc(work),
            Progress::Failed { study, label, failure } => {
                self.bar.suspend(|| say!("{study}: {label}: {failure}"));
            }
        }
    }

    /// Prints how long the work will take, if it is long.
    fn tell_of_time(&self, cases: usize, work: u64, jobs: usize, longest: Option<&LongestCase>) {
        let Some(longest) = longest else { return };
        let alone = estimated_seconds(&longest.case).min(longest.case_seconds);
        let seconds = side_by_side(1e-9 * work as f64, alone, jobs);
        let notes = [note_on_longest(longest), note_on_run(&self.bar.prefix(), cases, seconds)];
        for note in notes.into_iter().flatten() {
            self.bar.suspend(|| say!("{note}"));
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_goes_by_the_plan_first_and_by_experience_later() {
        assert_eq!(time_left(3600.0, 0.0, 1.0), 3600.0);
        // A tenth took 10 s, whatever the plan was.
        assert!((time_left(3600.0, 0.1, 10.0) - 90.0).abs() < 1e-9);
        // A thousandth took 1 s: mostly the plan still, and never nothing.
        let early = time_left(3600.0, 0.001, 1.0);
        // A twentieth of 999 s by the pace, the rest of 3596.4 s by the plan.
        assert!((early - 3466.53).abs() < 1e-9, "{early}");
    }
}
