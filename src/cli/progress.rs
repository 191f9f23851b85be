//! Progress of long work on standard error: a bar with an estimate on a terminal, nothing but
//! failures elsewhere.

use crate::campaign::run_report::Progress;
use crate::cli::stream::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// Bar of a study, or of several at once.
pub struct StudyBar {
    bar: ProgressBar,
}

impl StudyBar {
    /// A bar with a name; hidden where standard error is no terminal.
    pub fn new(name: &str) -> Self {
        let bar = ProgressBar::new(0);
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        // The name and the message are cut where the terminal is narrow: a line that wraps is drawn anew below.
        let style =
            ProgressStyle::with_template("{prefix:<24!} [{bar:16}] {percent:>3} %, {eta} left, {wide_msg}");
        if let Ok(style) = style {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_prefix(name.to_owned());
        Self { bar }
    }

    /// Takes a word of the runner.
    pub fn tell(&self, progress: Progress) {
        match progress {
            Progress::Planned { cases, resumed, work } => {
                self.bar.set_length(work);
                let taken_up = if resumed > 0 { format!(", {resumed} from disk") } else { String::new() };
                let beyond = if work == u64::MAX { ", more work than can be counted" } else { "" };
                self.bar.set_message(format!("{cases} cases{taken_up}{beyond}"));
            }
            Progress::Advanced(work) => self.bar.inc(work),
            Progress::Finished { study, label, failure } => {
                if let Some(failure) = failure {
                    self.bar.suspend(|| say!("{study}: {label}: {failure}"));
                }
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
