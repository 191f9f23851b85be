//! Job lists: the commands that run the shares of a campaign, one per line, for any scheduler.

use crate::campaign::refinement;
use crate::campaign::shares::{Parting, balance_of, shares_of};
use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::output::say;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::study::check::Study;
use oedometer_wording::{count_of, duration};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Largest share over the mean from which on it is worth a word.
const UNEVEN: f64 = 1.1;

/// What the commands of a campaign have in common.
#[derive(Clone, Debug)]
pub struct JobList {
    /// Study files as they were named.
    pub files: Vec<PathBuf>,
    /// Folder of the results.
    pub results: PathBuf,
    /// How much of the studies.
    pub tier: Tier,
    /// How many shares there are.
    pub tasks: u64,
    /// How they are divided.
    pub parting: Parting,
    /// Whether the studies may start their solvers.
    pub allow_solvers: bool,
    /// Whether results are kept that nothing proves to be of the present program.
    pub keep_unproven: bool,
}

impl JobList {
    /// The shares that have one of the wanted cases, from 1 on; the shares are those of all cases.
    pub fn shares_with(
        &self,
        all: &[(&Study, Vec<&Case>)],
        wanted: &[(&Study, Vec<&Case>)],
    ) -> BTreeSet<u64> {
        let cases: Vec<&Case> = all.iter().flat_map(|(_, cases)| cases).copied().collect();
        let shares = shares_of(&cases, self.tasks, self.parting);
        // Both lists have the order of the studies: the wanted ones are met on the way.
        let mut wanted = wanted.iter().flat_map(|(_, cases)| cases).copied().peekable();
        let mut is_wanted = |case: &Case| wanted.next_if(|next| std::ptr::eq(*next, case)).is_some();
        cases.iter().zip(shares).filter(|(case, _)| is_wanted(case)).map(|(_, share)| share + 1).collect()
    }

    /// The commands of those shares, a line each.
    pub fn commands(&self, all: &[(&Study, Vec<&Case>)], wanted: &[(&Study, Vec<&Case>)]) -> String {
        let shares = self.shares_with(all, wanted);
        shares.iter().map(|share| self.command("oedometer", &share.to_string()) + "\n").collect()
    }

    /// The command of a share, which may be the variable of a scheduler.
    pub fn command(&self, program: &str, share: &str) -> String {
        let mut words = vec![quoted(program), "run".to_owned()];
        words.extend(self.files.iter().map(|file| quoted_path(file)));
        words.extend(["--out".to_owned(), quoted_path(&self.results)]);
        if self.tier != Tier::Full {
            words.extend(["--tier".to_owned(), self.tier.name().to_owned()]);
        }
        words.extend(["--shard".to_owned(), format!("{share}/{}", self.tasks)]);
        if self.parting == Parting::Cost {
            words.push("--balance".to_owned());
        }
        if self.allow_solvers {
            words.push("--allow-solvers".to_owned());
        }
        words.push("--resume".to_owned());
        if self.keep_unproven {
            words.push("--keep-unproven".to_owned());
        }
        words.join(" ")
    }

    /// Says how even the shares are, and where no number of them helps.
    pub fn tell_of_balance(&self, all: &[(&Study, Vec<&Case>)]) {
        let cases: Vec<&Case> = all.iter().flat_map(|(_, cases)| cases).copied().collect();
        let shares = shares_of(&cases, self.tasks, self.parting);
        let balance = balance_of(&cases, &shares, self.tasks);
        let ratio = balance.largest / balance.mean;
        say!(
            "{}: the largest takes {}, {ratio:.2} times the mean",
            count_of(usize::try_from(self.tasks).unwrap_or(usize::MAX), "shard", "shards"),
            duration(balance.largest)
        );
        if balance.longest_case > balance.mean {
            say!(
                "one case alone takes {}, more than a shard of {}: more than {:.0} shards bring no gain",
                duration(balance.longest_case),
                duration(balance.mean),
                (balance.mean * self.tasks as f64 / balance.longest_case).max(1.0).floor()
            );
        } else if ratio > UNEVEN && self.parting == Parting::Hash {
            say!("`--balance` makes the shards even: the longest case goes to the smallest shard");
        }
        if balance.empty > 0 {
            say!("{} of the shards have no case", balance.empty);
        }
    }
}

/// The cases that have no finished record of this program.
pub fn missing_of<'a>(study: &Study, cases: &[&'a Case], folder: &Path) -> Vec<&'a Case> {
    let store = RecordStore::new(folder, &study.name);
    let missing: Vec<&Case> = cases.iter().filter(|case| !store.is_done(case)).copied().collect();
    if !study.is_race {
        return missing;
    }
    let records: Vec<Record> = cases.iter().filter_map(|case| store.kept(case)).collect();
    refinement::wanted(study, missing, &records)
}

fn quoted_path(path: &Path) -> String {
    quoted(&path.to_string_lossy())
}

/// A word as a shell takes it.
pub fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=+:,@%".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_what_a_shell_takes() {
        let list = JobList {
            files: vec!["my study.toml".into(), "b.toml".into()],
            results: "o'ut".into(),
            tier: Tier::Ci,
            tasks: 8,
            parting: Parting::Cost,
            allow_solvers: false,
            keep_unproven: false,
        };
        assert_eq!(
            list.command("oedometer", "3"),
            r"oedometer run 'my study.toml' b.toml --out 'o'\''ut' --tier ci --shard 3/8 --balance --resume"
        );
        let list = JobList {
            results: "out".into(),
            tier: Tier::Full,
            parting: Parting::Hash,
            allow_solvers: true,
            keep_unproven: true,
            ..list
        };
        assert_eq!(
            list.command("/a b/oedometer", "$TASK"),
            "'/a b/oedometer' run 'my study.toml' b.toml --out out --shard $TASK/8 --allow-solvers --resume --keep-unproven"
        );
    }

    #[test]
    fn a_word_is_quoted_where_a_shell_would_read_it_otherwise() {
        for (word, expected) in [
            ("", "''"),
            ("a b", "'a b'"),
            ("$x", "'$x'"),
            ("*", "'*'"),
            ("~", "'~'"),
            ("é", "'é'"),
            ("#a;", "'#a;'"),
            ("a'b", r"'a'\''b'"),
            ("a-b_c.d/e=f:1,2+3@4%", "a-b_c.d/e=f:1,2+3@4%"),
        ] {
            assert_eq!(quoted(word), expected);
        }
        // Every other sign there is, by itself and at either end of a word.
        let plain = "-_./=+:,@%";
        let signs = (0_u8..128).map(char::from).filter(|sign| !sign.is_ascii_alphanumeric() && *sign != '\'');
        for sign in signs {
            for word in [sign.to_string(), format!("{sign}a"), format!("a{sign}")] {
                let expected = if plain.contains(sign) { word.clone() } else { format!("'{word}'") };
                assert_eq!(quoted(&word), expected, "{word:?}");
            }
        }
    }

    #[test]
    fn shares_are_counted_from_one_and_those_without_a_wanted_case_are_left_out() {
        let records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2, 3, 4, 5, 6, 7]\n",
        );
        let source = crate::study::shipped::shipped_study("terzaghi-mesh").expect("a shipped study");
        let study = Study::check(&source).expect("sound");
        let list = JobList {
            files: vec!["s.toml".into()],
            results: "out".into(),
            tier: Tier::Full,
            tasks: 3,
            parting: Parting::Hash,
            allow_solvers: false,
            keep_unproven: false,
        };
        let all = [(&study, records.iter().map(|record| &record.case).collect::<Vec<_>>())];
        let own = |case: &Case| case.number() % 3 + 1;
        for wanted in [&all[0].1[..], &all[0].1[2..3], &[]] {
            let expected: BTreeSet<u64> = wanted.iter().map(|case| own(case)).collect();
            assert_eq!(list.shares_with(&all, &[(&study, wanted.to_vec())]), expected);
        }
    }
}
