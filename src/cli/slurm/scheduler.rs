//! Scripts of a campaign, and queries of Slurm: submit one, follow its tasks, and ask for the largest array.

use crate::cli::exit::{Ended, Exit};
use crate::cli::job_list::{JobList, quoted};
use crate::cli::output::say;
use crate::cli::slurm::{ClusterArguments, FOLDER};
use crate::record::atomic_file::write_atomically;
use oedometer_formats::input_file;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

/// `MaxArraySize` of Slurm where its configuration says nothing.
const DEFAULT_ARRAY_SIZE: u64 = 1001;
/// First time between two looks; each is half as long again as the one before, up to the longest.
const FIRST: Duration = Duration::from_millis(500);
const LONGEST: Duration = Duration::from_secs(15);
/// Refusals in a row after which Slurm is given up: its controller restarts now and then.
const MOST_REFUSALS: u32 = 20;

/// The array of a campaign and the merge that waits for it, by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The array.
    pub array: String,
    /// The merge.
    pub merge: String,
}

/// Tasks that are not over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tasks {
    /// At work.
    running: usize,
    /// Waiting; those of an array that wait together count as one.
    waiting: usize,
}

impl Job {
    /// Keeps the numbers in a file.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn keep(&self, path: &Path) -> anyhow::Result<()> {
        Ok(write_atomically(path, format!("{}\n{}\n", self.array, self.merge).as_bytes())?)
    }

    /// The job of such a file, where its array is not over yet.
    pub fn under_way(path: &Path) -> Option<Self> {
        let text = input_file::read_text(path).ok()?;
        let mut lines = text.lines().map(str::to_owned);
        let job = Self { array: lines.next()?, merge: lines.next()? };
        (tasks_of(&job.array).ok()? != Tasks::default()).then_some(job)
    }

    /// Waits for the end of the array and its merge and reports how many of `all` cases are done; whether tasks
    /// were cancelled.
    ///
    /// # Errors
    /// When Slurm has not answered for long.
    pub fn follow(&self, done: impl Fn() -> usize, all: usize) -> anyhow::Result<bool> {
        let (mut pause, mut refusals, mut reported) = (FIRST, 0, String::new());
        loop {
            let tasks = tasks_of(&self.array).and_then(|array| Ok((array, tasks_of(&self.merge)?)));
            let (array, merge) = match tasks {
                Ok(tasks) => tasks,
                Err(error) if refusals < MOST_REFUSALS && Exit::of(&error) == Exit::CaseFailed => {
                    refusals += 1;
                    sleep(LONGEST);
                    continue;
                }
                Err(error) => return Err(error),
            };
            refusals = 0;
            if (array, merge) == (Tasks::default(), Tasks::default()) {
                let reported = called("scontrol --oneliner show job", &[&self.array]);
                return Ok(reported.is_ok_and(|reported| reported.contains("JobState=CANCELLED")));
            }
            let work = match array {
                Tasks { running: 0, waiting: 0 } => "merging".to_owned(),
                Tasks { running, waiting: 0 } => format!("{running} tasks running"),
                Tasks { running, .. } => format!("{running} tasks running, others waiting"),
            };
            let line = format!("job {}: {} of {all} cases, {work}", self.array, done());
            if line != reported {
                say!("{line}");
                reported = line;
            }
            sleep(pause);
            pause = (pause * 3 / 2).min(LONGEST);
        }
    }
}

/// Calls a program of Slurm, whose words are parted by spaces, with more words.
fn called(command: &str, more: &[&str]) -> anyhow::Result<String> {
    let mut words = command.split(' ');
    let program = words.next().unwrap_or_default();
    let output = Command::new(program).args(words).args(more).output().map_err(|error| {
        Ended::usage(format!("cannot start {program}: {error}; is this machine part of a Slurm cluster?"))
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    Err(Ended::with(Exit::CaseFailed, format!("`{command} {}` was refused: {why}", more.join(" "))))
}

/// Submits a script by the words behind `sbatch`; the number of its job.
///
/// # Errors
/// When Slurm is not there or refuses.
pub fn submit(words: &[String]) -> anyhow::Result<String> {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let answer = called("sbatch", &words)?;
    // With several clusters the name of one stands behind the number.
    Ok(answer.trim().split(';').next().unwrap_or_default().to_owned())
}

/// Takes back what was submitted, as far as Slurm still knows it.
pub fn cancel(job: &str) {
    let _ = called("scancel", &[job]);
}

/// Most tasks of an array.
///
/// # Errors
/// When Slurm takes no arrays.
pub fn most_tasks() -> anyhow::Result<u64> {
    let settings = called("scontrol show config", &[]).unwrap_or_default();
    match array_size_in(&settings).unwrap_or(DEFAULT_ARRAY_SIZE) {
        size @ (0 | 1) => Err(Ended::with(
            Exit::CaseFailed,
            format!(
                "this Slurm accepts no arrays (MaxArraySize={size}): `oedometer plan --tasks` writes a job list"
            ),
        )),
        // The largest number of a task is one less than the size.
        size => Ok(size - 1),
    }
}

/// The size among the lines of a configuration, as `MaxArraySize            = 1001`.
fn array_size_in(settings: &str) -> Option<u64> {
    let mut pairs = settings.lines().filter_map(|line| line.split_once('='));
    pairs.find(|(name, _)| name.trim() == "MaxArraySize")?.1.trim().parse().ok()
}

/// The unfinished tasks of a job; none if Slurm no longer knows the job.
fn tasks_of(job: &str) -> anyhow::Result<Tasks> {
    match called("squeue --noheader --format=%T", &[&format!("--jobs={job}")]) {
        Err(error) if error.to_string().contains("Invalid job id") => Ok(Tasks::default()),
        answer => Ok(counted(&answer?)),
    }
}

fn counted(states: &str) -> Tasks {
    let count = |names: &[&str]| states.lines().filter(|state| names.contains(&state.trim())).count();
    Tasks {
        running: count(&["RUNNING", "COMPLETING", "CONFIGURING", "STAGE_OUT", "SIGNALING"]),
        waiting: count(&[
            "PENDING",
            "SUSPENDED",
            "REQUEUED",
            "REQUEUE_HOLD",
            "SPECIAL_EXIT",
            "RESIZING",
            "STOPPED",
        ]),
    }
}

/// Seconds before its time limit at which a task gets the signal to end.
const WARNING: u64 = 60;

/// The scripts of one campaign.
pub struct Scripts {
    array: String,
    merge: String,
    folder: PathBuf,
}

impl Scripts {
    /// Writes the text of both.
    ///
    /// # Errors
    /// When the program does not know where it is.
    pub fn new(arguments: &ClusterArguments, list: &JobList, name: &str) -> anyhow::Result<Self> {
        let program = std::env::current_exe()?.to_string_lossy().into_owned();
        let folder = list.results.join(FOLDER);
        let logs = folder.join("logs").to_string_lossy().into_owned();
        let mut options = vec!["--nodes=1".to_owned(), "--ntasks=1".to_owned()];
        options.extend(arguments.partition.iter().map(|name| format!("--partition={name}")));
        options.extend(arguments.sbatch.iter().cloned());
        let head = |job: &str, more: Vec<String>| {
            let lines = options.iter().chain(&more).map(|option| format!("#SBATCH {option}\n"));
            format!("#!/bin/bash\n#SBATCH --job-name=oedometer-{job}\n{}", lines.collect::<String>())
        };
        let mut of_array = vec![
            format!("--cpus-per-task={}", arguments.cores),
            format!("--output={logs}/%A_%a.log"),
            "--open-mode=append".to_owned(),
            "--requeue".to_owned(),
            format!("--signal=B:TERM@{WARNING}"),
        ];
        of_array.extend(arguments.time.iter().map(|time| format!("--time={time}")));
        let array = format!(
            "{}# One shard of {}. It reuses finished cases, so it continues after a kill, a requeue or another submission.\n\
             # On SIGTERM it finishes or drops running cases and starts no others.\n\
             exec {} --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
            head(name, of_array),
            list.tasks,
            list.command(&program, "$SLURM_ARRAY_TASK_ID")
        );
        let of_merge = vec![format!("--output={logs}/merge-%j.log")];
        let words: Vec<String> =
            std::iter::once(program).chain(merge_words(list)).map(|word| quoted(&word)).collect();
        let merge = format!("{}exec {}\n", head(&format!("{name}-merge"), of_merge), words.join(" "));
        Ok(Self { array, merge, folder })
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).to_string_lossy().into_owned()
    }

    /// Writes them where the commands name them.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self) -> anyhow::Result<()> {
        write_atomically(Path::new(&self.path("array.sh")), self.array.as_bytes())?;
        Ok(write_atomically(Path::new(&self.path("merge.sh")), self.merge.as_bytes())?)
    }

    /// What submits the array of some shares, behind `sbatch`.
    pub fn of_array(&self, shares: &BTreeSet<u64>) -> Vec<String> {
        vec!["--parsable".to_owned(), format!("--array={}", ranges(shares)), self.path("array.sh")]
    }

    /// What submits the merge behind an array, however that ends: it names the holes.
    pub fn of_merge(&self, array: &str) -> Vec<String> {
        vec!["--parsable".to_owned(), format!("--dependency=afterany:{array}"), self.path("merge.sh")]
    }

    /// Both as a person reads them.
    pub fn shown(&self, shares: &BTreeSet<u64>) -> String {
        format!(
            "# {}\n{}\n# {}\n{}\n# array=$(sbatch {})\n# sbatch {}\n",
            self.path("array.sh"),
            self.array,
            self.path("merge.sh"),
            self.merge,
            self.of_array(shares).join(" "),
            self.of_merge("$array").join(" "),
        )
    }
}

/// The merge as this program calls itself for it.
pub fn merge_words(list: &JobList) -> Vec<String> {
    let results = list.results.to_string_lossy().into_owned();
    let mut words = vec!["merge".to_owned()];
    words.extend(list.files.iter().map(|file| file.to_string_lossy().into_owned()));
    words.extend([results.clone(), "--out".to_owned(), results]);
    words.extend(["--tier".to_owned(), list.tier.name().to_owned()]);
    words
}

/// Numbers as an array of Slurm names them: `1-4,7`.
fn ranges(numbers: &BTreeSet<u64>) -> String {
    let mut parts: Vec<(u64, u64)> = Vec::new();
    for number in numbers {
        match parts.last_mut() {
            Some((_, last)) if *last + 1 == *number => *last = *number,
            _ => parts.push((*number, *number)),
        }
    }
    let word = |(first, last): &(u64, u64)| {
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    };
    parts.iter().map(word).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_counted_by_their_states() {
        let told = "RUNNING\nRUNNING\n PENDING\nCOMPLETED\nFAILED\nCOMPLETING\n";
        assert_eq!(counted(told), Tasks { running: 3, waiting: 1 });
        assert_eq!(counted(""), Tasks::default());
        for (states, running, waiting) in [
            (&["RUNNING", "COMPLETING", "CONFIGURING", "STAGE_OUT", "SIGNALING"][..], 1, 0),
            (
                &["PENDING", "SUSPENDED", "REQUEUED", "REQUEUE_HOLD", "SPECIAL_EXIT", "RESIZING", "STOPPED"],
                0,
                1,
            ),
            (
                &["COMPLETED", "CANCELLED", "FAILED", "TIMEOUT", "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY"],
                0,
                0,
            ),
        ] {
            for state in states {
                assert_eq!(counted(state), Tasks { running, waiting }, "{state}");
            }
        }
    }

    #[test]
    fn the_size_is_read_among_the_lines_of_a_configuration() {
        let told = "Configuration data as of now\nMaxArrayTasks = 7\nMaxArraySize            = 1001\nMaxDBDMsgs = 2\n";
        assert_eq!(array_size_in(told), Some(1001));
        assert_eq!(array_size_in("MaxArraySize = (null)\n"), None);
        assert_eq!(array_size_in(""), None);
    }

    #[test]
    fn shares_are_named_as_an_array_takes_them() {
        assert_eq!(ranges(&[1, 2, 3, 4, 7, 9, 10].into()), "1-4,7,9-10");
        assert_eq!(ranges(&[5].into()), "5");
        assert_eq!(ranges(&[1, 3, 5].into()), "1,3,5");
        assert_eq!(ranges(&[2, 3].into()), "2-3");
        assert_eq!(ranges(&BTreeSet::new()), "");
    }
}
