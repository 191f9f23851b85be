//! The engine of a cluster that runs Slurm: an array of shares, a merge that waits for it, and somebody who looks
//! after both.
//!
//! Every share is `oedometer run … --shard i/n --resume` into one folder of results, so that a task that is killed,
//! requeued or submitted again goes on where the last one ended, and the shares stay the same.

pub mod arguments;
pub mod array_limit;
pub mod commands;
pub mod follow;
pub mod scripts;

use crate::campaign::costs::CostTable;
use crate::campaign::shares::Parting;
use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::cost_files::learned_from;
use crate::cli::exit::{Ended, Exit};
use crate::cli::job_list::{JobList, missing_of};
use crate::cli::slurm::arguments::{ClusterArguments, FOLDER};
use crate::cli::slurm::array_limit::ArrayLimit;
use crate::cli::slurm::commands::{Job, cancel, submit};
use crate::cli::slurm::follow::follow;
use crate::cli::slurm::scripts::Scripts;
use crate::cli::stream::{print_data, say};
use crate::cli::study_files;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::record::whole_file::write_whole;
use crate::study::check::Study;
use oedometer_formats::input_file;
use oedometer_soil::wording::count_of;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// File of the job that is under way.
const JOB: &str = "job";

/// A campaign on a cluster.
pub struct Campaign<'a> {
    studies: Vec<(&'a Study, Vec<&'a Case>)>,
    list: JobList,
    costs: CostTable,
    results: PathBuf,
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
) -> anyhow::Result<Exit> {
    let campaign = Campaign::new(arguments, files, studies, tier, results, !arguments.dry_run)?;
    let scripts = Scripts::new(arguments, &campaign.list, &campaign.name, ArrayLimit::asked()?)?;
    let shares = campaign.shares_to_run();
    if arguments.dry_run {
        print_data(&scripts.shown(&shares))?;
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
            return campaign.merged(&scripts);
        }
        let jobs = match under_way.take() {
            Some(jobs) => {
                say!("{}: job {} is under way already: it is followed", campaign.name, jobs.array);
                jobs
            }
            None if attempt == arguments.attempts => return Ok(campaign.given_up(attempt, files)),
            None => {
                attempt += 1;
                campaign.submitted(&scripts, &shares, &folder)?
            }
        };
        if arguments.detach {
            say!("{}: not followed; the same command without `--detach` does", campaign.name);
            return Ok(Exit::Pass);
        }
        let was_cancelled = follow(&jobs, || campaign.count_of_done(), campaign.count())?;
        let _ = fs::remove_file(folder.join(JOB));
        if was_cancelled && !campaign.shares_to_run().is_empty() {
            say!("{}: the tasks were cancelled; the same command submits what is missing", campaign.name);
            return Ok(campaign.given_up(attempt, files));
        }
    }
}

impl<'a> Campaign<'a> {
    /// Plans the shares; what finished cases cost is kept in a file then, so that the shares stay the same.
    fn new(
        arguments: &ClusterArguments,
        files: &[PathBuf],
        studies: &'a [Study],
        tier: Tier,
        results: &Path,
        is_kept: bool,
    ) -> anyhow::Result<Self> {
        let folder = results.join(FOLDER);
        let costs_file = folder.join("costs.csv");
        let costs = match input_file::read_text(&costs_file) {
            Ok(text) => CostTable::parse(&text)
                .map_err(|error| Ended::usage(format!("{}: {error}", costs_file.display())))?,
            Err(_) => learned_from(studies, tier, results).unwrap_or_default(),
        };
        // The text of a study may be edited while its tasks wait: they take a copy.
        let sources = study_files::read_all(files)?;
        let copies: Vec<PathBuf> =
            studies.iter().map(|study| folder.join(format!("{}.toml", study.name))).collect();
        if is_kept {
            for (source, copy) in sources.iter().zip(&copies) {
                write_whole(copy, source.text.as_bytes())?;
            }
            write_whole(&costs_file, costs.to_csv().as_bytes())?;
        }
        let studies: Vec<(&Study, Vec<&Case>)> =
            studies.iter().map(|study| (study, study.cases(tier))).collect();
        // Whoever may not start them has not come here.
        let starts_solvers = studies.iter().any(|(study, _)| !study.solvers.is_empty());
        let count: usize = studies.iter().map(|(_, cases)| cases.len()).sum();
        if count == 0 {
            return Err(Ended::with(Exit::NothingSelected, "no case belongs to this tier"));
        }
        let list = JobList {
            files: copies,
            results: results.to_owned(),
            tier,
            tasks: arguments.tasks.min(count as u64),
            parting: Parting::Cost,
            allow_solvers: starts_solvers,
            costs: Some(costs_file),
        };
        list.tell_of_balance(&studies, &costs);
        let name = match studies.as_slice() {
            [(study, _)] => study.name.clone(),
            several => count_of(several.len(), "study", "studies").replace(' ', "-"),
        };
        Ok(Self { studies, list, costs, results: results.to_owned(), name })
    }

    fn missing(&self) -> Vec<(&'a Study, Vec<&'a Case>)> {
        let of_study =
            |(study, cases): &(&'a Study, Vec<&'a Case>)| (*study, missing_of(study, cases, &self.results));
        self.studies.iter().map(of_study).collect()
    }

    /// Shares with a case that has no finished record.
    fn shares_to_run(&self) -> BTreeSet<u64> {
        self.list.shares_with(&self.studies, &self.missing(), &self.costs)
    }

    fn count(&self) -> usize {
        self.studies.iter().map(|(_, cases)| cases.len()).sum()
    }

    fn count_of_done(&self) -> usize {
        self.count() - self.missing().iter().map(|(_, cases)| cases.len()).sum::<usize>()
    }

    fn submitted(&self, scripts: &Scripts, shares: &BTreeSet<u64>, folder: &Path) -> anyhow::Result<Job> {
        if let Some(note) = scripts.note(shares) {
            say!("{}: {note}", self.name);
        }
        let mut arrays = Vec::new();
        let merge = scripts
            .array_commands(shares)
            .iter()
            .try_for_each(|command| {
                arrays.push(submit(command)?);
                Ok(())
            })
            .and_then(|()| submit(&scripts.merge_command(&arrays)));
        // What was taken of a campaign that was refused in part would run beside the next attempt.
        let merge = merge.inspect_err(|_: &anyhow::Error| cancel(&arrays))?;
        let job = Job { array: arrays.join(","), merge };
        job.keep(&folder.join(JOB))?;
        let tasks = count_of(shares.len(), "task", "tasks");
        say!(
            "{}: submitted {tasks} as job {}, and the merge behind it as {}",
            self.name,
            job.array,
            job.merge
        );
        Ok(job)
    }

    /// The end of a campaign without holes: the table, written here where the merge of the cluster did not.
    fn merged(&self, scripts: &Scripts) -> anyhow::Result<Exit> {
        let is_there = |(study, _): &(&Study, Vec<&Case>)| {
            let folder = self.results.join(&study.name);
            ["csv", "csv.gz"].iter().any(|ending| folder.join(format!("{}.{ending}", study.name)).is_file())
        };
        if !self.studies.iter().all(is_there) {
            scripts.merge_here()?;
        }
        let mut unforeseen = 0;
        for (study, cases) in &self.studies {
            let store = RecordStore::for_cases(&self.results, &study.name, study.planned.len());
            let failed: Vec<Record> = cases.iter().filter_map(|case| store.failed(case)).collect();
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
            self.results.join(FOLDER).join("logs").display(),
            named.join(" "),
            self.results.display()
        );
        Exit::IncompleteMerge
    }
}
