//! How many tasks Slurm takes in one array, and the parts of a campaign that has more.

use crate::cli::exit::{Ended, Exit};
use crate::cli::slurm::commands::told_of_configuration;
use oedometer_soil::wording::count_of;
use std::collections::BTreeSet;

/// `MaxArraySize` of Slurm where its configuration says nothing.
const DEFAULT_SIZE: u64 = 1001;

/// Most tasks of one array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayLimit {
    /// The largest number that a task may have; the first has 1.
    pub most: u64,
    /// Whether the scheduler said so; else it is Slurm's default.
    pub is_asked: bool,
}

/// Shares that go into one array: task `i` is the share `i + before`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArrayPart {
    /// Numbers of its tasks.
    pub tasks: BTreeSet<u64>,
    /// What is added to each.
    pub before: u64,
}

impl ArrayLimit {
    /// Asks the scheduler.
    ///
    /// # Errors
    /// When it takes no arrays.
    pub fn asked() -> anyhow::Result<Self> {
        let size = told_of_configuration().ok().and_then(|told| size_in(&told));
        // The largest number of a task is one less than the size.
        match size {
            None => Ok(Self { most: DEFAULT_SIZE - 1, is_asked: false }),
            Some(size @ (0 | 1)) => Err(Ended::with(
                Exit::CaseFailed,
                format!(
                    "this Slurm takes no arrays (MaxArraySize={size}): `oedometer plan --tasks` writes a job list"
                ),
            )),
            Some(size) => Ok(Self { most: size - 1, is_asked: true }),
        }
    }

    /// Shares by arrays that the scheduler takes.
    pub fn parts(self, shares: &BTreeSet<u64>) -> Vec<ArrayPart> {
        let mut parts: Vec<ArrayPart> = Vec::new();
        for share in shares {
            let before = (share - 1) / self.most * self.most;
            if parts.last().is_none_or(|part| part.before != before) {
                parts.push(ArrayPart { tasks: BTreeSet::new(), before });
            }
            if let Some(part) = parts.last_mut() {
                part.tasks.insert(share - before);
            }
        }
        parts
    }

    /// A sentence on more tasks than one array takes; none where they fit.
    pub fn sentence(self, tasks: u64, arrays: usize) -> Option<String> {
        let whose = if self.is_asked {
            "this Slurm takes"
        } else {
            "Slurm could not be asked (scontrol), and by default takes"
        };
        (tasks > self.most).then(|| {
            format!(
                "{whose} at most {} tasks an array: {tasks} tasks are {}",
                self.most,
                count_of(arrays, "array", "arrays")
            )
        })
    }
}

/// The size among the lines of a configuration, as `MaxArraySize            = 1001`.
fn size_in(told: &str) -> Option<u64> {
    told.lines().find_map(|line| {
        let (name, value) = line.split_once('=')?;
        (name.trim() == "MaxArraySize").then(|| value.trim().parse().ok())?
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_is_read_among_the_lines_of_a_configuration() {
        let told = "Configuration data as of now\nMaxArrayTasks = 7\nMaxArraySize            = 1001\nMaxDBDMsgs = 2\n";
        assert_eq!(size_in(told), Some(1001));
        assert_eq!(size_in("MaxArraySize = (null)\n"), None);
        assert_eq!(size_in(""), None);
    }

    #[test]
    fn every_share_is_in_one_array_under_a_number_that_is_taken() {
        for most in [1, 2, 3, 7, 1000] {
            let limit = ArrayLimit { most, is_asked: true };
            for shares in [(1..=7).collect::<BTreeSet<u64>>(), [2, 3, 6, 7, 14, 15].into(), [1001].into()] {
                let parts = limit.parts(&shares);
                let back: Vec<u64> =
                    parts.iter().flat_map(|part| part.tasks.iter().map(|task| task + part.before)).collect();
                assert_eq!(back, shares.iter().copied().collect::<Vec<_>>(), "{most}");
                assert!(
                    parts.iter().flat_map(|part| &part.tasks).all(|task| (1..=most).contains(task)),
                    "{most}"
                );
            }
        }
        let limit = ArrayLimit { most: 1000, is_asked: true };
        assert_eq!(limit.parts(&(1..=1000).collect()).len(), 1, "a full array is one");
        assert_eq!(limit.sentence(1000, 1), None);
        let told = limit.sentence(2001, 3).expect("a sentence");
        assert_eq!(told, "this Slurm takes at most 1000 tasks an array: 2001 tasks are 3 arrays");
        assert!(
            ArrayLimit { is_asked: false, ..limit }.sentence(2001, 3).expect("one").contains("by default")
        );
    }
}
