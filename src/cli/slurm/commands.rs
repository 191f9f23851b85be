//! What is asked of Slurm: to take a script, and what became of it.

use crate::cli::exit::{Ended, Exit};
use crate::record::whole_file::write_whole;
use oedometer_formats::input_file;
use std::path::Path;
use std::process::Command;

/// The arrays of a campaign and the merge that waits for them, by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The arrays, mostly one; parted by commas.
    pub array: String,
    /// The merge.
    pub merge: String,
}

/// Tasks of an array that are not over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tasks {
    /// At work.
    pub running: usize,
    /// Waiting; those of an array that wait together count as one.
    pub waiting: usize,
}

impl Job {
    /// Keeps the numbers in a file.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn keep(&self, path: &Path) -> anyhow::Result<()> {
        Ok(write_whole(path, format!("{}\n{}\n", self.array, self.merge).as_bytes())?)
    }

    /// The job of such a file, where it is not over yet.
    pub fn under_way(path: &Path) -> Option<Self> {
        let text = input_file::read_text(path).ok()?;
        let mut lines = text.lines().map(str::to_owned);
        let job = Self { array: lines.next()?, merge: lines.next()? };
        (job.tasks().ok()? != Tasks::default()).then_some(job)
    }

    /// The tasks of its arrays that are not over.
    ///
    /// # Errors
    /// When Slurm does not answer.
    pub fn tasks(&self) -> anyhow::Result<Tasks> {
        let mut all = Tasks::default();
        for array in self.array.split(',') {
            let Tasks { running, waiting } = tasks_of(array)?;
            all = Tasks { running: all.running + running, waiting: all.waiting + waiting };
        }
        Ok(all)
    }

    /// Whether somebody cancelled one of its arrays, or some of their tasks.
    pub fn was_cancelled(&self) -> bool {
        self.array.split(',').any(was_cancelled)
    }
}

fn called(words: &[String]) -> anyhow::Result<String> {
    let (program, arguments) = words.split_first().ok_or_else(|| Ended::usage("no command"))?;
    let output = Command::new(program).args(arguments).output();
    let output = output.map_err(|error| {
        Ended::usage(format!("cannot call {program}: {error}; is this a machine of a cluster with Slurm?"))
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    Err(Ended::with(Exit::CaseFailed, format!("`{}` was refused: {why}", words.join(" "))))
}

fn words(line: &str) -> Vec<String> {
    line.split(' ').map(str::to_owned).collect()
}

/// Submits a script; the number of its job.
///
/// # Errors
/// When Slurm is not there or refuses.
pub fn submit(command: &[String]) -> anyhow::Result<String> {
    let told = called(command)?;
    // With several clusters the name of one stands behind the number.
    let number = told.trim().split(';').next().unwrap_or_default();
    Ok(number.to_owned())
}

/// Takes back what was submitted, as far as Slurm still knows it.
pub fn cancel(jobs: &[String]) {
    for job in jobs {
        let _ = called(&words(&format!("scancel {job}")));
    }
}

/// What the scheduler tells of its configuration.
///
/// # Errors
/// When Slurm is not there or does not answer.
pub fn told_of_configuration() -> anyhow::Result<String> {
    called(&words("scontrol show config"))
}

/// The tasks of a job that are not over; none of one that Slurm knows no more.
///
/// # Errors
/// When Slurm does not answer.
pub fn tasks_of(job: &str) -> anyhow::Result<Tasks> {
    let told = match called(&words(&format!("squeue --noheader --format=%T --jobs={job}"))) {
        Err(error) if error.to_string().contains("Invalid job id") => return Ok(Tasks::default()),
        told => told?,
    };
    Ok(counted(&told))
}

fn counted(states: &str) -> Tasks {
    let mut tasks = Tasks::default();
    for state in states.lines().map(str::trim) {
        match state {
            "RUNNING" | "COMPLETING" | "CONFIGURING" | "STAGE_OUT" | "SIGNALING" => tasks.running += 1,
            "PENDING" | "SUSPENDED" | "REQUEUED" | "REQUEUE_HOLD" | "SPECIAL_EXIT" | "RESIZING"
            | "STOPPED" => {
                tasks.waiting += 1;
            }
            _ => {}
        }
    }
    tasks
}

/// Whether somebody cancelled a job, or some of its tasks.
fn was_cancelled(job: &str) -> bool {
    let told = called(&words(&format!("scontrol --oneliner show job {job}")));
    told.is_ok_and(|told| told.contains("JobState=CANCELLED"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_counted_by_their_states() {
        let told = "RUNNING\nRUNNING\n PENDING\nCOMPLETED\nFAILED\nCOMPLETING\n";
        assert_eq!(counted(told), Tasks { running: 3, waiting: 1 });
        assert_eq!(counted(""), Tasks::default());
    }
}
