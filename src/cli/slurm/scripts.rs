//! Scripts of a campaign and the commands that submit them.

use crate::cli::job_list::{JobList, quoted};
use crate::cli::slurm::{ClusterArguments, FOLDER};
use crate::record::whole_file::write_whole;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Seconds before its time limit at which a task is told to end.
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
            "{}# One share of {}. It takes up what is finished: killed, requeued or submitted again it goes on, and\n\
             # told to end by SIGTERM it finishes or drops the cases at work and leaves the rest.\n\
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
        write_whole(Path::new(&self.path("array.sh")), self.array.as_bytes())?;
        Ok(write_whole(Path::new(&self.path("merge.sh")), self.merge.as_bytes())?)
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
    fn shares_are_named_as_an_array_takes_them() {
        assert_eq!(ranges(&[1, 2, 3, 4, 7, 9, 10].into()), "1-4,7,9-10");
        assert_eq!(ranges(&[5].into()), "5");
    }
}
