//! Waits for a job and tells how far the shares are.

use crate::cli::slurm::commands::{Job, Tasks, tasks_of};
use crate::cli::stream::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// First time between two looks; each is half as long again as the one before, up to the longest.
const FIRST: Duration = Duration::from_millis(500);
const LONGEST: Duration = Duration::from_secs(15);
/// Time between two lines where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(30);
/// Answers that Slurm may owe in a row before it is given up: its controller restarts now and then.
const MOST_SILENT: u32 = 20;

/// Waits until the array and its merge are over; whether somebody cancelled them.
///
/// # Errors
/// When Slurm has not answered for long.
pub fn follow(job: &Job, done: impl Fn() -> usize, all: usize) -> anyhow::Result<bool> {
    let bar = ProgressBar::new(all as u64);
    let is_terminal = std::io::stderr().is_terminal();
    if !is_terminal {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:24}] {pos}/{len} cases, {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_prefix(format!("job {}", job.array));
    let (mut pause, mut told, mut silent) = (FIRST, Instant::now(), 0);
    loop {
        let tasks = job.tasks().and_then(|array| Ok((array, tasks_of(&job.merge)?)));
        let (array, merge) = match tasks {
            Ok(tasks) => tasks,
            Err(error) if silent < MOST_SILENT && error.to_string().contains("was refused") => {
                silent += 1;
                sleep(LONGEST);
                continue;
            }
            Err(error) => return Err(error),
        };
        silent = 0;
        let count = done();
        let message = match array {
            Tasks { running: 0, waiting: 0 } => "merging".to_owned(),
            Tasks { running, waiting: 0 } => format!("{running} tasks at work"),
            Tasks { running, .. } => format!("{running} tasks at work, others wait"),
        };
        if !is_terminal && told.elapsed() > BETWEEN_LINES {
            say!("job {}: {count} of {all} cases, {message}", job.array);
            told = Instant::now();
        }
        bar.set_position(count as u64);
        bar.set_message(message);
        if (array, merge) == (Tasks::default(), Tasks::default()) {
            bar.finish_and_clear();
            return Ok(job.was_cancelled());
        }
        sleep(pause);
        pause = (pause * 3 / 2).min(LONGEST);
    }
}
