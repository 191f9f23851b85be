//! `oedometer bisect`: the first commit with different results of a study.
//!
//! Drives `git bisect` in a separate work tree. A commit is bad where values that moved between the good and the
//! bad one have moved; one that cannot be built or run, or has none of these values, is skipped.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{print_data, say};
use crate::golden::compare::{Change, Difference, compare, groups_of};
use crate::history::repository::{Commit, Repository};
use crate::history::state::{State, StudyState};
use crate::judge::study_check::diagnoses;
use crate::record::{Record, RecordStore};
use crate::report::tables::golden_changes::sentence;
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::study::shipped::name_of;
use oedometer_formats::input_file::read_text;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Arguments of `bisect`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study file or name, looked up in each commit
    #[arg(value_name = "STUDY")]
    study: String,
    /// Revision with the right results
    #[arg(long, value_name = "A")]
    good: String,
    /// Revision with the changed results
    #[arg(long, value_name = "B")]
    bad: String,
    /// Command that runs the study in the folder of each commit and leaves its records in `{out}` [default:
    /// `oedometer run` of this program]
    #[arg(long, value_name = "COMMAND")]
    run: Option<String>,
    /// Command that builds the program; if it fails, the commit is skipped
    #[arg(long, value_name = "COMMAND")]
    build: Option<String>,
    /// Start the programs that the study names in `[[solver]]` in each commit, with your permissions
    #[arg(long)]
    allow_solvers: bool,
}

/// Values of a commit, or why it has none.
type Tried = Result<StudyState, String>;

/// Searches, and prints the commit with what moved.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let usage = |error: &dyn std::fmt::Display| Ended::usage(error.to_string());
    let here = std::env::current_dir()?;
    let repository = Repository::around(&here).map_err(|error| usage(&error))?;
    let [good, bad] = [&arguments.good, &arguments.bad].map(|named| repository.commit(named));
    let (good, bad) = (good.map_err(|error| usage(&error))?, bad.map_err(|error| usage(&error))?);
    if repository.is_dirty(&["--untracked-files=no"]) {
        say!("the work tree has uncommitted changes, which the tested commits lack");
    }
    let trial = Trial::new(arguments, &repository, &bad)?;
    let ended = search(&trial, &good, &bad);
    trial.clean();
    let first_bad = ended?;
    print_data(&first_bad)?;
    Ok(Exit::Pass)
}

/// The report of the search.
fn search(trial: &Trial<'_>, good: &Commit, bad: &Commit) -> anyhow::Result<String> {
    let ends = |commit: &Commit, which: &str| {
        trial.values_at(commit).map_err(|reason| {
            Ended::with(
                Exit::CaseFailed,
                format!("the {which} commit {} has no results: {reason}", commit.short()),
            )
        })
    };
    let right = ends(good, "good")?;
    let wrong = ends(bad, "bad")?;
    let moved = moved_values(&right, &wrong);
    if moved.is_empty() {
        return Err(Ended::with(
            Exit::NothingSelected,
            format!(
                "no value differs between {} and {}: there is nothing to search for",
                good.short(),
                bad.short()
            ),
        ));
    }
    say!("{} values moved between {} and {}", moved.len(), good.short(), bad.short());
    let mut skipped = Vec::new();
    let mut output = trial.git(&["bisect", "start", "--no-checkout", &bad.hash, &good.hash])?;
    loop {
        if let Some(hash) = output.lines().find_map(|line| line.strip_suffix(" is the first bad commit")) {
            return report(trial, &right, hash, &skipped);
        }
        if output.contains("only 'skip'ped commits left") {
            let list =
                output.lines().filter(|line| line.len() == 40).map(|hash| &hash[..8]).collect::<Vec<_>>();
            let reason = format!(
                "the remaining commits cannot be tested; one of them is the first bad one: {}",
                list.join(", ")
            );
            return Err(Ended::with(Exit::IncompleteMerge, reason));
        }
        let commit = trial.repository.commit(trial.git(&["rev-parse", "BISECT_HEAD"])?.trim())?;
        let word = match trial.values_at(&commit) {
            Ok(values) => match moved_like(&right, &values, &moved) {
                Some(true) => "bad",
                Some(false) => "good",
                None => skip(&mut skipped, &commit, "it lacks the values that moved"),
            },
            Err(reason) => skip(&mut skipped, &commit, &reason),
        };
        say!("{} {word}: {}", commit.short(), commit.subject);
        output = trial.git(&["bisect", word, &commit.hash])?;
    }
}

fn skip(skipped: &mut Vec<String>, commit: &Commit, reason: &str) -> &'static str {
    skipped.push(format!("{} {}: {reason}", commit.short(), commit.subject));
    "skip"
}

/// Values that differ beyond their tolerance: those that got worse, or all where none did.
fn moved_values(right: &StudyState, wrong: &StudyState) -> Vec<Difference> {
    let moved: Vec<Difference> =
        compare(&right.golden, &wrong.golden.values).into_iter().filter(Difference::is_paired).collect();
    let is_worse = |difference: &&Difference| difference.change == Change::Moved;
    let worse: Vec<Difference> = moved.iter().filter(is_worse).cloned().collect();
    if worse.is_empty() { moved } else { worse }
}

/// Whether any of the values has moved from the right ones in the direction that it had gone at the bad commit, or has
/// become no number, or one again; `None` where none of them is there.
fn moved_like(right: &StudyState, here: &StudyState, moved: &[Difference]) -> Option<bool> {
    let there =
        moved.iter().filter_map(|difference| Some((difference, *here.golden.values.get(&difference.key)?)));
    let has_moved = |(difference, value): (&Difference, f64)| {
        let (Some(before), Some(after)) = (difference.golden, difference.found) else { return false };
        if !(before.is_finite() && value.is_finite()) {
            return before.is_finite() != value.is_finite();
        }
        let tolerance = right.golden.tolerance(&difference.key, before.abs().max(value.abs()));
        after.is_finite() && (value - before).abs() > tolerance && (value > before) == (after > before)
    };
    there.map(has_moved).reduce(|any, moved| any || moved)
}

/// The first bad commit, what moved there, and what was skipped.
fn report(trial: &Trial<'_>, right: &StudyState, hash: &str, skipped: &[String]) -> anyhow::Result<String> {
    let commit = trial.repository.commit(hash)?;
    let mut text = format!("first bad commit: {} {} {}\n", commit.hash, commit.date, commit.subject);
    if let Ok(values) = trial.values_at(&commit) {
        let differences = compare(&right.golden, &values.golden.values);
        for group in groups_of(&differences, right.golden.values.keys()) {
            writeln!(text, "  {}", sentence(&group))?;
        }
        for sentence in trial.diagnoses() {
            writeln!(text, "  diagnosis: {sentence}")?;
        }
    }
    for line in skipped {
        writeln!(text, "  skipped {line}")?;
    }
    Ok(text)
}

/// A separate work tree in which commits are tested one after the other.
struct Trial<'a> {
    arguments: &'a Arguments,
    repository: &'a Repository,
    folder: PathBuf,
}

impl<'a> Trial<'a> {
    fn new(arguments: &'a Arguments, repository: &'a Repository, first: &Commit) -> anyhow::Result<Self> {
        let folder = std::env::temp_dir().join(format!("oedometer-bisect-{}", std::process::id()));
        let tree = folder.join("tree");
        let place = tree.to_string_lossy();
        repository.run(&["worktree", "add", "--detach", "--quiet", &place, &first.hash])?;
        Ok(Self { arguments, repository, folder })
    }

    fn tree(&self) -> PathBuf {
        self.folder.join("tree")
    }

    fn git(&self, words: &[&str]) -> anyhow::Result<String> {
        Ok(Repository::around(&self.tree())?.run(words)?)
    }

    /// Removes the work tree; the user's own is never touched.
    fn clean(&self) {
        let place = self.tree();
        let _ = self.repository.run(&["worktree", "remove", "--force", &place.to_string_lossy()]);
        let _ = std::fs::remove_dir_all(&self.folder);
    }

    /// Checks a commit out, builds and runs it, and reads its records.
    fn values_at(&self, commit: &Commit) -> Tried {
        let said = |error: anyhow::Error| error.to_string();
        self.git(&["checkout", "--quiet", "--force", "--detach", &commit.hash]).map_err(said)?;
        let out = self.folder.join("out");
        let _ = std::fs::remove_dir_all(&out);
        if let Some(build) = &self.arguments.build {
            self.shell(build, &out).map_err(|reason| format!("the build failed: {reason}"))?;
        }
        let study = self.study_file()?;
        match &self.arguments.run {
            Some(command) => self.shell(command, &out)?,
            None => self.run_here(&study, &out)?,
        }
        let mut state = State::of_records(&out).map_err(|error| error.to_string())?;
        let name = name_of(&study);
        state.studies.remove(&name).ok_or_else(|| format!("there are no records of `{name}`"))
    }

    /// What the results of the commit that was tried last look like, where another program made them.
    fn diagnoses(&self) -> Vec<String> {
        let study = self.study_file().ok().and_then(|file| {
            let path = self.tree().join(file);
            let text = read_text(&path).ok()?;
            Study::check(&StudySource { name: path.display().to_string(), text }).ok()
        });
        let Some(study) = study else { return Vec::new() };
        let store = RecordStore::new(&self.folder.join("out"), &study.name);
        let records: Vec<Record> = store.hashes().iter().filter_map(|hash| store.read(hash)).collect();
        diagnoses(&study, &records)
    }

    /// The study in this commit: where it is named, or by its name anywhere.
    fn study_file(&self) -> Result<String, String> {
        let named = &self.arguments.study;
        if self.tree().join(named).is_file() {
            return Ok(named.clone());
        }
        let name = name_of(named);
        let listed = self.git(&["ls-files", &format!("{name}.toml"), &format!("*/{name}.toml")]);
        let listed = listed.map_err(|error| error.to_string())?;
        listed.lines().next().map(str::to_owned).ok_or_else(|| format!("it has no study `{named}`"))
    }

    /// Runs the study by this program. Cases that fail leave records, and show by their missing values.
    fn run_here(&self, study: &str, out: &Path) -> Result<(), String> {
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = Command::new(program);
        command.args(["run", study, "--out"]).arg(out);
        if self.arguments.allow_solvers {
            command.arg("--allow-solvers");
        }
        ended(command.current_dir(self.tree()))
    }

    fn shell(&self, line: &str, out: &Path) -> Result<(), String> {
        let line = line.replace("{out}", &out.to_string_lossy());
        let mut command = if cfg!(windows) { Command::new("cmd") } else { Command::new("sh") };
        command.arg(if cfg!(windows) { "/C" } else { "-c" }).arg(line);
        ended(command.current_dir(self.tree()))
    }
}

/// Runs a command to its end; its last words where it fails.
fn ended(command: &mut Command) -> Result<(), String> {
    let output = command.stdin(Stdio::null()).output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it printed nothing");
    Err(format!("{}: {}", output.status, last.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenFile;
    use crate::golden::measure::{GoldenKey, key};

    fn error(case: &str) -> GoldenKey {
        key(case, 0.1, "pressure points terzaghi")
    }

    fn state(value: f64) -> StudyState {
        let values = [(error("a"), value)].into();
        StudyState::of_golden(GoldenFile { values, ..GoldenFile::of("s", &[], "-") })
    }

    #[test]
    fn a_value_moves_to_no_number_and_back_and_never_agrees_with_one() {
        let (nan, infinite) = (f64::NAN, f64::INFINITY);
        for (right, wrong, here, has_moved) in [
            (0.1, 0.2, 0.1, false),
            (0.1, 0.2, 0.3, true),
            // Better than the good commit is not what is searched for.
            (0.1, 0.2, 0.05, false),
            (0.1, 0.2, nan, true),
            (0.1, infinite, infinite, true),
            (0.1, infinite, 0.1, false),
            // It got worse earlier, and was still a number.
            (0.1, nan, 0.2, false),
            (0.1, nan, infinite, true),
            (nan, 0.1, nan, false),
            (nan, 0.1, 0.1, true),
            (infinite, 0.1, 0.2, true),
        ] {
            let moved = moved_values(&state(right), &state(wrong));
            assert_eq!(moved.len(), 1, "{right} {wrong}");
            let found = moved_like(&state(right), &state(here), &moved);
            assert_eq!(found, Some(has_moved), "{right} -> {wrong}, here {here}");
        }
        let none = StudyState::of_golden(GoldenFile::of("s", &[], "-"));
        assert_eq!(moved_like(&state(0.1), &none, &moved_values(&state(0.1), &state(0.2))), None);
    }

    #[test]
    fn a_commit_is_bad_where_any_of_the_values_that_got_worse_has_moved() {
        let keys = [error("a"), error("b"), key("a", None, "steps"), key("b", None, "steps")];
        let states = |values: [Option<f64>; 4]| {
            let values = keys.iter().zip(values).filter_map(|(key, value)| Some((key.clone(), value?)));
            StudyState::of_golden(GoldenFile { values: values.collect(), ..GoldenFile::of("s", &[], "-") })
        };
        let of = |values: [f64; 4]| states(values.map(Some));
        let right = [0.1, 0.2, 100.0, 200.0];
        let sought = |wrong: [f64; 4]| -> Vec<GoldenKey> {
            moved_values(&of(right), &of(wrong)).into_iter().map(|difference| difference.key).collect()
        };
        let mut all = sought([0.15, 0.3, 110.0, 210.0]);
        all.sort();
        assert_eq!(all, [&keys[2], &keys[0], &keys[3], &keys[1]].map(Clone::clone));
        // What got better is sought only where nothing got worse.
        for (wrong, place) in [
            ([0.15, 0.1, 90.0, 190.0], 0),
            ([0.05, 0.3, 90.0, 190.0], 1),
            ([0.05, 0.1, 110.0, 190.0], 2),
            ([0.05, 0.1, 90.0, 210.0], 3),
        ] {
            assert_eq!(sought(wrong), [keys[place].clone()], "{wrong:?}");
        }
        assert_eq!(sought([0.05, 0.1, 90.0, 190.0]).len(), 4);
        let wrong = [0.15, 0.3, 110.0, 210.0];
        let moved = moved_values(&of(right), &of(wrong));
        // Which of the values have moved, and which are there at all.
        for number in 0..16_usize {
            let has = |place: usize| number >> place & 1 == 1;
            let here = std::array::from_fn(|place| if has(place) { wrong[place] } else { right[place] });
            assert_eq!(moved_like(&of(right), &of(here), &moved), Some(number > 0), "{here:?}");
            let only = |bad: bool| {
                let from = if bad { wrong } else { right };
                let there = std::array::from_fn(|place| has(place).then_some(from[place]));
                moved_like(&of(right), &states(there), &moved)
            };
            let (none, some) = (number == 0, number > 0);
            assert_eq!(
                [only(true), only(false)],
                [some.then_some(true), (!none).then_some(false)],
                "{number}"
            );
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_command_that_fails_is_told_by_its_status_and_its_last_words() {
        let of = |line: &str| ended(Command::new("sh").args(["-c", line]));
        assert_eq!(of("echo odd >&2; exit 0"), Ok(()));
        let last = "echo first >&2; echo '  last  ' >&2; echo ' ' >&2; exit 3";
        assert_eq!(of(last), Err("exit status: 3: last".to_owned()));
        assert_eq!(of("echo out; exit 4"), Err("exit status: 4: it printed nothing".to_owned()));
        let told = ended(&mut Command::new("no-such-program-of-a-test")).expect_err("no program");
        assert!(told.contains("No such file"), "{told}");
    }
}
