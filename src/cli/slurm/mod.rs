//! The engine of a cluster that runs Slurm: an array of shares, a merge that waits for it, and a process that
//! follows both.
//!
//! Every share is `oedometer run … --shard i/n --resume` into one folder of results, so that a task that is killed,
//! requeued or submitted again goes on where the last one ended, and the shares stay the same.

mod scheduler;

use crate::campaign::shares::Parting;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::job_list::{JobList, missing_of};
use crate::cli::output::{print_data, say};
use crate::cli::slurm::scheduler::{Job, Scripts, cancel, merge_words, most_tasks, submit};
use crate::cli::study_files;
use crate::record::atomic_file::write_atomically;
use crate::record::store::RecordStore;
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_wording::count_of;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of a campaign's scripts and logs within that of the results.
const FOLDER: &str = "slurm";
/// File of the job that is under way.
const JOB: &str = "job";

/// How to run on a cluster.
#[derive(Debug, clap::Args)]
pub struct ClusterArguments {
    /// Number of shards, each a task of the array
    #[arg(long, value_name = "N", default_value_t = 16, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    tasks: u64,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME", requires = "engine")]
    partition: Option<String>,
    /// Time limit of a task, in the format of Slurm: minutes, or hours:minutes:seconds
    #[arg(long, value_name = "TIME", requires = "engine")]
    time: Option<String>,
    /// Cores per task
    #[arg(long, value_name = "N", default_value_t = 1, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=1024))]
    cores: u64,
    /// Another option for sbatch, like --sbatch=--account=soil
    #[arg(long, value_name = "OPTION", requires = "engine", allow_hyphen_values = true)]
    sbatch: Vec<String>,
    /// How often a shard with missing results is submitted at most
    #[arg(long, value_name = "N", default_value_t = 3, requires = "engine", value_parser = clap::value_parser!(u64).range(1..=100))]
    attempts: u64,
    /// Submit, and do not wait for the results
    #[arg(long, requires = "engine")]
    detach: bool,
    /// Print the scripts and the commands that would submit them; submit nothing
    #[arg(long, requires = "engine")]
    dry_run: bool,
}

/// A campaign on a cluster.
pub struct Campaign<'a> {
    studies: Vec<(&'a Study, Vec<&'a Case>)>,
    list: JobList,
    name: String,
}

/// Submits what is missing of studies, follows it, submits again what is missing then, and merges.
///
/// # Errors
/// When the scheduler or the file system refuses.
pub fn run(
    arguments: &ClusterArguments,
    files: &[PathBuf],
    studies: &[Study],
    tier: Tier,
    results: &Path,
    keep_unproven: bool,
) -> anyhow::Result<Exit> {
    let campaign = Campaign::new(arguments, files, studies, tier, results, keep_unproven)?;
    let scripts = Scripts::new(arguments, &campaign.list, &campaign.name)?;
    if arguments.dry_run {
        let shares = campaign.shares_to_run();
        if shares.is_empty() {
            say!("{}: every case has a record: there is nothing to submit", campaign.name);
        } else {
            print_data(&scripts.shown(&shares))?;
        }
        return Ok(Exit::Pass);
    }
    let folder = results.join(FOLDER);
    fs::create_dir_all(folder.join("logs"))?;
    scripts.write()?;
    let mut attempt = 0;
    let mut under_way = Job::under_way(&folder.join(JOB));
    loop {
        let shares = campaign.shares_to_run();
        if under_way.is_none() && shares.is_empty() {
            return campaign.merged();
        }
        let jobs = match under_way.take() {
            Some(jobs) => {
                say!("{}: job {} is already submitted; following it", campaign.name, jobs.array);
                jobs
            }
            None if attempt == arguments.attempts => return Ok(campaign.given_up(attempt, files)),
            None => {
                attempt += 1;
                campaign.submitted(&scripts, &shares, &folder)?
            }
        };
        if arguments.detach {
            say!("{}: not followed; run the command without `--detach` to follow it", campaign.name);
            return Ok(Exit::Pass);
        }
        let was_cancelled = jobs.follow(|| campaign.count_of_done(), campaign.count())?;
        let _ = fs::remove_file(folder.join(JOB));
        if was_cancelled && !campaign.shares_to_run().is_empty() {
            say!(
                "{}: the tasks were cancelled; run the command again to submit what is missing",
                campaign.name
            );
            return Ok(campaign.given_up(attempt, files));
        }
    }
}

impl<'a> Campaign<'a> {
    /// Plans the shares.
    fn new(
        arguments: &ClusterArguments,
        files: &[PathBuf],
        studies: &'a [Study],
        tier: Tier,
        results: &Path,
        keep_unproven: bool,
    ) -> anyhow::Result<Self> {
        let folder = results.join(FOLDER);
        // The text of a study may be edited while its tasks wait: they take a copy.
        let sources = study_files::read_all(files)?;
        let copies: Vec<PathBuf> =
            studies.iter().map(|study| folder.join(format!("{}.toml", study.name))).collect();
        if !arguments.dry_run {
            for (source, copy) in sources.iter().zip(&copies) {
                write_atomically(copy, source.text.as_bytes())?;
            }
        }
        let studies: Vec<(&Study, Vec<&Case>)> =
            studies.iter().map(|study| (study, study.cases(tier))).collect();
        // Whoever may not start them has not come here.
        let starts_solvers = studies.iter().any(|(study, _)| !study.solvers.is_empty());
        let count: usize = studies.iter().map(|(_, cases)| cases.len()).sum();
        if count == 0 {
            return Err(Ended::with(Exit::NothingSelected, "this test level contains no case"));
        }
        let most = most_tasks()?;
        if arguments.tasks.min(count as u64) > most {
            say!(
                "this Slurm accepts at most {most} tasks per array: the cases are divided into as many shards"
            );
        }
        let list = JobList {
            files: copies,
            results: results.to_owned(),
            tier,
            tasks: arguments.tasks.min(count as u64).min(most),
            parting: Parting::Cost,
            allow_solvers: starts_solvers,
            keep_unproven,
        };
        list.tell_of_balance(&studies);
        let name = match studies.as_slice() {
            [(study, _)] => study.name.clone(),
            several => count_of(several.len(), "study", "studies").replace(' ', "-"),
        };
        Ok(Self { studies, list, name })
    }

    fn missing(&self) -> Vec<(&'a Study, Vec<&'a Case>)> {
        let of_study = |(study, cases): &(&'a Study, Vec<&'a Case>)| {
            (*study, missing_of(study, cases, &self.list.results))
        };
        self.studies.iter().map(of_study).collect()
    }

    /// Shares with a case that has no finished record.
    fn shares_to_run(&self) -> BTreeSet<u64> {
        self.list.shares_with(&self.studies, &self.missing())
    }

    fn count(&self) -> usize {
        self.studies.iter().map(|(_, cases)| cases.len()).sum()
    }

    fn count_of_done(&self) -> usize {
        self.count() - self.missing().iter().map(|(_, cases)| cases.len()).sum::<usize>()
    }

    fn submitted(&self, scripts: &Scripts, shares: &BTreeSet<u64>, folder: &Path) -> anyhow::Result<Job> {
        let array = submit(&scripts.of_array(shares))?;
        // An array without its merge would run beside the next attempt.
        let merge = submit(&scripts.of_merge(&array)).inspect_err(|_| cancel(&array))?;
        let job = Job { array, merge };
        job.keep(&folder.join(JOB))?;
        let tasks = count_of(shares.len(), "task", "tasks");
        say!(
            "{}: submitted {tasks} as job {}, and the dependent merge as {}",
            self.name,
            job.array,
            job.merge
        );
        Ok(job)
    }

    /// The end of a campaign without holes: the table, written here where the merge of the cluster did not.
    fn merged(&self) -> anyhow::Result<Exit> {
        let is_there = |(study, _): &(&Study, Vec<&Case>)| {
            let folder = self.list.results.join(&study.name);
            ["csv", "csv.gz"].iter().any(|ending| folder.join(format!("{}.{ending}", study.name)).is_file())
        };
        if !self.studies.iter().all(is_there) {
            let status = Command::new(std::env::current_exe()?).args(merge_words(&self.list)).status()?;
            if !status.success() {
                return Err(Ended::with(Exit::IncompleteMerge, format!("the merge ended with {status}")));
            }
        }
        let mut unforeseen = 0;
        for (study, cases) in &self.studies {
            let store = RecordStore::new(&self.list.results, &study.name);
            let failed: Vec<Record> = cases.iter().filter_map(|case| store.kept(case)).collect();
            let failed: Vec<Record> =
                failed.into_iter().filter(|record| record.status != Status::Ok).collect();
            unforeseen += failed.iter().filter(|record| !study.foresees(record)).count();
            say!("{}: {} of {} cases, {} failed", study.name, cases.len(), cases.len(), failed.len());
        }
        Ok(if unforeseen > 0 { Exit::CaseFailed } else { Exit::Pass })
    }

    fn given_up(&self, attempts: u64, files: &[PathBuf]) -> Exit {
        let missing = self.count() - self.count_of_done();
        let named: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        say!(
            "{}: {} without a result after {}; see {}, and `oedometer plan {} --missing {}`",
            self.name,
            count_of(missing, "case is", "cases are"),
            count_of(usize::try_from(attempts).unwrap_or(usize::MAX), "submission", "submissions"),
            self.list.results.join(FOLDER).join("logs").display(),
            named.join(" "),
            self.list.results.display()
        );
        Exit::IncompleteMerge
    }
}
