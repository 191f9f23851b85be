//! The scripts of a campaign, and the commands that submit them.

use crate::cli::exit::{Ended, Exit};
use crate::cli::job_list::{JobList, quoted};
use crate::cli::slurm::arguments::{ClusterArguments, FOLDER};
use crate::cli::slurm::array_limit::{ArrayLimit, ArrayPart};
use crate::record::whole_file::write_whole;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Command;

/// Seconds before its time limit at which a task is told to end.
const WARNING: u64 = 60;

/// The scripts of one campaign.
pub struct Scripts {
    array: String,
    merge: String,
    limit: ArrayLimit,
    tasks: u64,
    folder: PathBuf,
    /// The merge as this program calls itself for it.
    merge_words: Vec<String>,
}

impl Scripts {
    /// Writes the text of both.
    ///
    /// # Errors
    /// When the program does not know where it is.
    pub fn new(
        arguments: &ClusterArguments,
        list: &JobList,
        name: &str,
        limit: ArrayLimit,
    ) -> anyhow::Result<Self> {
        // Of several arrays each is told how many shares stand before its own.
        let share = if list.tasks > limit.most {
            "$((SLURM_ARRAY_TASK_ID + ${1:-0}))"
        } else {
            "$SLURM_ARRAY_TASK_ID"
        };
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
            "{}# One share of {}. It takes up what is finished: killed, requeued or submitted again it goes on, and\n\
             # told to end by SIGTERM it finishes or drops the cases at work and leaves the rest.\n\
             exec {} --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
            head(name, of_array),
            list.tasks,
            list.command(&program, share)
        );
        let mut merge_words = vec!["merge".to_owned()];
        merge_words.extend(list.files.iter().map(|file| file.to_string_lossy().into_owned()));
        let results = list.results.to_string_lossy().into_owned();
        merge_words.extend([results.clone(), "--out".to_owned(), results]);
        merge_words.extend(["--tier".to_owned(), list.tier.name().to_owned()]);
        let of_merge = vec![format!("--output={logs}/merge-%j.log")];
        let words: Vec<String> =
            std::iter::once(&program).chain(&merge_words).map(|word| quoted(word)).collect();
        let merge = format!("{}exec {}\n", head(&format!("{name}-merge"), of_merge), words.join(" "));
        Ok(Self { array, merge, limit, tasks: list.tasks, folder, merge_words })
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).to_string_lossy().into_owned()
    }

    /// Writes them where the commands name them.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self) -> anyhow::Result<()> {
        write_whole(&self.folder.join("array.sh"), self.array.as_bytes())?;
        write_whole(&self.folder.join("merge.sh"), self.merge.as_bytes())?;
        Ok(())
    }

    /// What submits the arrays of some shares, mostly one.
    pub fn array_commands(&self, shares: &BTreeSet<u64>) -> Vec<Vec<String>> {
        let of_part = |ArrayPart { tasks, before }: &ArrayPart| {
            let array = format!("--array={}", ranges(tasks));
            let mut words = vec!["sbatch".to_owned(), "--parsable".to_owned(), array, self.path("array.sh")];
            words.extend((*before > 0).then(|| before.to_string()));
            words
        };
        self.limit.parts(shares).iter().map(of_part).collect()
    }

    /// What is said where the shares are more than one array takes.
    pub fn note(&self, shares: &BTreeSet<u64>) -> Option<String> {
        self.limit.sentence(self.tasks, self.limit.parts(shares).len())
    }

    /// What submits the merge behind arrays, however those end: it names the holes.
    pub fn merge_command(&self, arrays: &[String]) -> Vec<String> {
        let after = format!("--dependency=afterany:{}", arrays.join(":"));
        vec!["sbatch".to_owned(), "--parsable".to_owned(), after, self.path("merge.sh")]
    }

    /// Both as a person reads them.
    pub fn shown(&self, shares: &BTreeSet<u64>) -> String {
        let line = |words: Vec<String>| words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
        let commands = self.array_commands(shares);
        let name =
            |number: usize| if number == 0 { "array".to_owned() } else { format!("array{}", number + 1) };
        let variables: Vec<String> = (0..commands.len()).map(|number| format!("${}", name(number))).collect();
        let arrays: Vec<String> = commands
            .into_iter()
            .enumerate()
            .map(|(number, words)| format!("# {}=$({})\n", name(number), line(words)))
            .collect();
        let merge = line(self.merge_command(&["ARRAYS".to_owned()])).replace("ARRAYS", &variables.join(":"));
        format!(
            "# {}\n{}\n# {}\n{}\n{}{}# {merge}\n",
            self.path("array.sh"),
            self.array,
            self.path("merge.sh"),
            self.merge,
            self.note(shares).map_or_else(String::new, |note| format!("# {note}\n")),
            arrays.concat(),
        )
    }

    /// Merges on this machine.
    ///
    /// # Errors
    /// When the merge does not come to its end.
    pub fn merge_here(&self) -> anyhow::Result<()> {
        let status = Command::new(std::env::current_exe()?).args(&self.merge_words).status()?;
        if status.success() {
            return Ok(());
        }
        Err(Ended::with(Exit::IncompleteMerge, format!("the merge ended with {status}")))
    }
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
    fn shares_are_named_as_an_array_takes_them() {
        assert_eq!(ranges(&[1, 2, 3, 4, 7, 9, 10].into()), "1-4,7,9-10");
        assert_eq!(ranges(&[5].into()), "5");
    }
}
