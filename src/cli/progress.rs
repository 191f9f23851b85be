//! Progress of long work on standard error: a bar with an estimate on terminals, only failures elsewhere;
//! and notes on long runs before they start: the estimated time, and what would take less.

use crate::campaign::endless::{LONGEST_CASE as LONGEST_ALLOWED, faster};
use crate::campaign::runner::{LongestCase, Progress};
use crate::case::Task;
use crate::case::work_estimate::estimated_seconds;
use crate::cli::output::say;
use crate::study::check::Study;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use oedometer_wording::{count_of, duration};
use std::io::IsTerminal;
use std::time::Duration;

/// The bar of a study, or of several at once.
pub struct StudyBar(ProgressBar);

impl StudyBar {
    /// A bar with the study's name or the number of studies, hidden if standard error is not a terminal.
    pub fn of(studies: &[Study]) -> Self {
        // Name and message are cut on a narrow terminal: a line that wraps would be drawn again below.
        let template = "{prefix:<24!} [{bar:16}] {percent:>3} %, {eta} left, {wide_msg}";
        let bar = at_terminal(ProgressBar::new(0), template);
        bar.set_prefix(match studies {
            [study] => study.name.clone(),
            _ => count_of(studies.len(), "study", "studies"),
        });
        Self(bar)
    }

    /// Takes a message of the runner.
    pub fn tell(&self, progress: Progress) {
        match progress {
            Progress::Planned { cases, resumed, work, seconds, jobs, longest } => {
                self.tell_of_time(cases, seconds, jobs, longest.as_deref());
                self.0.set_length(work);
                let taken_up = if resumed > 0 { format!(", {resumed} reused") } else { String::new() };
                let beyond = if work == u64::MAX { ", more work than can be counted" } else { "" };
                self.0.set_message(format!("{}{taken_up}{beyond}", count_of(cases, "case", "cases")));
            }
            Progress::Advanced(work) => self.0.inc(work),
            Progress::Failed { study, label, failure } => {
                self.0.suspend(|| say!("{study}: {label}: {failure}"));
            }
        }
    }

    /// Prints how long the work will take, if it is long.
    fn tell_of_time(&self, cases: usize, total: f64, jobs: usize, longest: Option<&LongestCase>) {
        let Some(longest) = longest else { return };
        let seconds = side_by_side(total, estimated_seconds(&longest.case), jobs);
        let notes = [note_on_longest(longest), note_on_run(&self.0.prefix(), cases, seconds)];
        for note in notes.into_iter().flatten() {
            self.0.suspend(|| say!("{note}"));
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar with a template, drawn at a terminal alone.
fn at_terminal(bar: ProgressBar, template: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// The case that is being solved, with the time it has taken: from a second on, on terminals.
pub struct RunningCase(ProgressBar);

impl RunningCase {
    /// A line that is not yet drawn.
    pub fn new() -> Self {
        let bar = at_terminal(ProgressBar::new_spinner(), "{prefix}{wide_msg} {elapsed}");
        bar.enable_steady_tick(SHOWN_AFTER);
        Self(bar)
    }

    /// Names the case that starts, by its place among all.
    pub fn tell(&self, label: &str, place: usize, all: usize) {
        if all > 1 {
            self.0.set_prefix(format!("{} of {all}: ", place + 1));
        }
        self.0.set_message(label.to_owned());
    }

    /// Removes the line.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// How long a case runs before its line is drawn.
const SHOWN_AFTER: Duration = Duration::from_secs(1);

/// Seconds from which on a case is worth a word before it starts.
const LONG_CASE: f64 = 120.0;
/// Seconds from which on a whole run is.
const LONG_RUN: f64 = 60.0;

/// Time of cases side by side, s: that of their sum over the cores, and of the longest at least.
pub fn side_by_side(total: f64, longest: f64, jobs: usize) -> f64 {
    (total / jobs.max(1) as f64).max(longest)
}

/// How long a run will take, where that is worth a word.
pub fn note_on_run(name: &str, cases: usize, seconds: f64) -> Option<String> {
    (seconds >= LONG_RUN).then(|| format!("{name}: {cases} cases, about {}", duration(seconds)))
}

/// What is to be said of the longest case of a run, where it is long: its time, and what would take less.
pub fn note_on_longest(longest: &LongestCase) -> Option<String> {
    note_with(longest, |integrator| format!("`integrator = [\"{integrator}\"]` in its [[sweep]]"))
}

/// Time notes of a case that the command line describes.
pub fn note_on_solve(longest: &LongestCase) -> Option<String> {
    note_with(longest, |integrator| format!("`--integrator {integrator}`"))
}

fn note_with(longest: &LongestCase, take: impl Fn(&str) -> String) -> Option<String> {
    let LongestCase { study, case, case_seconds } = longest;
    let seconds = estimated_seconds(case);
    if seconds < LONG_CASE {
        return None;
    }
    let integrator = case.integrator.name();
    let remedy = match faster(case) {
        Some(other) => {
            format!("; {}: {}", take(other.integrator.name()), duration(estimated_seconds(&other)))
        }
        None if case.task == Task::Stability => "; an earlier last output takes less".to_owned(),
        None => "; larger steps, fewer cells or an earlier last output take less".to_owned(),
    };
    let end = if seconds > LONGEST_ALLOWED.max(*case_seconds) {
        ", longer than a week: the case is refused".to_owned()
    } else if *case_seconds < seconds {
        format!("; the case is stopped after {} (`case_seconds = {case_seconds}`)", duration(*case_seconds))
    } else {
        String::new()
    };
    Some(format!(
        "warning: {study}: {}\n  {integrator}: about {}{remedy}{end}",
        case.label(),
        duration(seconds)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::case::keys::{Key, Value};
    use oedometer_problem::integrator::IntegratorKind;
    use oedometer_scenes::{DYNAMIC_COLUMN, Scene, TERZAGHI};

    fn longest(scene: &'static Scene, integrator: IntegratorKind, conductivity: f64) -> LongestCase {
        let mut case = Case::seed(Task::Solve, scene);
        case.cells = 20;
        case.time_factors = vec![1.0].into();
        case.material.hydraulic_conductivity = conductivity;
        let key = Key::named("integrator", "sweep").expect("a key");
        key.set(&mut case, Value::Word(integrator.name()));
        LongestCase { study: "soft".to_owned(), case, case_seconds: 3600.0 }
    }

    #[test]
    fn a_case_of_hours_is_told_with_what_takes_seconds() {
        let note = note_on_longest(&longest(&TERZAGHI, IntegratorKind::Explicit, 1e-7));
        let case = longest(&TERZAGHI, IntegratorKind::Explicit, 1e-7);
        let [own, other] = [&case, &longest(&TERZAGHI, IntegratorKind::Implicit, 1e-7)]
            .map(|one| duration(estimated_seconds(&one.case)));
        let head = format!("warning: soft: {}\n  explicit: about {own}; ", case.case.label());
        let end = "; the case is stopped after 60 min (`case_seconds = 3600`)";
        let sweep = "`integrator = [\"implicit\"]` in its [[sweep]]";
        assert_eq!(note, Some(format!("{head}{sweep}: {other}{end}")));
        assert_eq!(note_on_solve(&case), Some(format!("{head}`--integrator implicit`: {other}{end}")));
        let patient = LongestCase { case_seconds: estimated_seconds(&case.case), ..case };
        assert_eq!(note_on_longest(&patient), Some(format!("{head}{sweep}: {other}")));
        assert_eq!(note_on_longest(&longest(&TERZAGHI, IntegratorKind::Explicit, 1e-3)), None);
        assert_eq!(note_on_longest(&longest(&TERZAGHI, IntegratorKind::Implicit, 1e-7)), None);
    }

    #[test]
    fn no_scene_of_waves_is_sent_to_long_steps() {
        let note = note_on_longest(&longest(&DYNAMIC_COLUMN, IntegratorKind::Explicit, 1e-7));
        let remedy = "; larger steps, fewer cells or an earlier last output take less";
        assert!(note.is_some_and(|note| !note.contains("implicit") && note.contains(remedy)));
        let mut search = longest(&TERZAGHI, IntegratorKind::Explicit, 1e-7);
        (search.case.task, search.case.cells) = (Task::Stability, 100_000);
        search.case_seconds = f64::INFINITY;
        let note = note_on_longest(&search).expect("it is long");
        assert!(note.ends_with("; an earlier last output takes less"), "{note}");
    }

    #[test]
    fn a_run_of_a_minute_is_worth_a_word() {
        assert_eq!(note_on_run("s", 7, 59.9), None);
        assert_eq!(note_on_run("s", 7, 60.0).as_deref(), Some("s: 7 cases, about 60 s"));
        assert_eq!(note_on_run("s", 7, 7200.0).as_deref(), Some("s: 7 cases, about 2 h"));
    }

    #[test]
    fn cases_side_by_side_take_as_long_as_the_longest() {
        assert_eq!(side_by_side(10.0, 2.0, 4), 2.5);
        assert_eq!(side_by_side(10.0, 8.0, 4), 8.0);
        assert_eq!(side_by_side(10.0, 8.0, 0), 10.0, "no job is one");
    }
}
