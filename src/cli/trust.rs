//! Which studies may start programs: a study file is text from anywhere, and its `[[solver]]` tables name commands that
//! run with the rights of whoever calls this program.
//!
//! Allowed are studies from inside this program, whatever `--allow-solvers` or its variable says, and what somebody at a
//! terminal said yes to: that is remembered by a digest of the commands and of the adapter's files.

use crate::campaign::runner::Tally;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::cli::place;
use crate::study::check::Study;
use crate::study::check::solvers::digest_of_file;
use crate::study::solver::ExternalSolver;
use clap::builder::FalseyValueParser;
use oedometer_wording::count_of;
use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// File of what was allowed, a digest and a study a line.
const REMEMBERED: &str = "allowed-solvers";
/// Longest answer that is read, bytes.
const LONGEST_ANSWER: u64 = 100;
/// Longest command that a question repeats, letters.
const LONGEST_COMMAND: usize = 300;

/// Whether studies may start programs.
#[derive(Clone, Debug, clap::Args)]
pub struct TrustArguments {
    /// Start the programs that the studies name in `[[solver]]`, with your permissions: review the studies first
    #[arg(long, env = "OEDOMETER_ALLOW_SOLVERS", hide_env_values = true, value_parser = FalseyValueParser::new())]
    allow_solvers: bool,
}

impl TrustArguments {
    /// Marks the studies that may start programs, asks at a terminal, and reports the studies that may not.
    pub fn mark(&self, studies: &mut [Study], named: &[PathBuf]) {
        for study in studies {
            study.may_start_solvers = self.may_start(study, named);
            if !study.may_start_solvers {
                say!(
                    "{}: this study runs {} with your permissions, which you have not allowed yet: its cases \
                     are not run. Review it, then add --allow-solvers (in CI: OEDOMETER_ALLOW_SOLVERS=1)",
                    study.name,
                    commands_of(&starting(study))
                );
            }
        }
    }

    fn may_start(&self, study: &Study, named: &[PathBuf]) -> bool {
        let starting = starting(study);
        starting.is_empty()
            || self.allow_solvers
            || place::is_shipped(&study.name, named)
            || folder().is_some_and(|folder| is_remembered(&folder, &digest_of(study, &starting)))
            || is_answered(study, &starting)
    }

    /// Trust for a command that uses the whole study.
    ///
    /// # Errors
    /// When one may not start its programs.
    pub fn mark_all(&self, studies: &mut [Study], named: &[PathBuf]) -> anyhow::Result<()> {
        self.mark(studies, named);
        if studies.iter().all(|study| study.may_start_solvers) {
            return Ok(());
        }
        Err(Ended::with(
            Exit::IncompleteMerge,
            "nothing was run: some cases start programs that are not allowed",
        ))
    }
}

/// The end of a command whose studies held cases back: it is not that of a whole run.
pub fn end_with(tally: Tally, otherwise: Exit) -> Exit {
    if tally.held_back == 0 {
        return otherwise;
    }
    let cases = count_of(tally.held_back, "case was", "cases were");
    say!("{cases} not run: their programs must not be started without `--allow-solvers`");
    if otherwise == Exit::Pass { Exit::IncompleteMerge } else { otherwise }
}

/// The solvers of a study that its cases would start.
fn starting(study: &Study) -> Vec<&ExternalSolver> {
    let is_used =
        |solver: &&ExternalSolver| study.planned.iter().any(|planned| planned.case.method == solver.method());
    study.solvers.iter().filter(|solver| !solver.is_given()).filter(is_used).collect()
}

/// What would be started, in words that change nothing on a terminal.
fn commands_of(starting: &[&ExternalSolver]) -> String {
    let of_one = |solver: &&ExternalSolver| {
        let command: String = solver.command.join(" ").escape_debug().take(LONGEST_COMMAND).collect();
        format!("`{command}` in {}", solver.folder.display().to_string().escape_debug())
    };
    starting.iter().map(of_one).collect::<Vec<_>>().join(" and ")
}

/// Digest of everything of a study that decides what is started: where it lies, commands, environments, and the contents
/// of the adapters' files.
fn digest_of(study: &Study, starting: &[&ExternalSolver]) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut take = |text: &str| {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    take(&study.name);
    for solver in starting {
        take(&solver.folder.to_string_lossy());
        take(&format!("{:?}", (solver.identity, &solver.command, &solver.version, &solver.environment)));
        for word in solver.words().chain(&solver.version) {
            if let Some(path) = solver.file(word) {
                take(&digest_of_file(&path));
            }
        }
    }
    hasher.finalize().to_hex().to_string()
}

/// Folder of what is remembered.
fn folder() -> Option<PathBuf> {
    folder_by(|name| std::env::var_os(name))
}

fn folder_by(environment: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let variable = |name: &str| environment(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let state = variable("XDG_STATE_HOME")
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| Some(variable("HOME")?.join(".local/state")))?;
    Some(state.join("oedometer"))
}

fn is_remembered(folder: &Path, digest: &str) -> bool {
    let text = fs::read_to_string(folder.join(REMEMBERED));
    text.is_ok_and(|text| text.lines().any(|line| line.split_whitespace().next() == Some(digest)))
}

fn remember(folder: &Path, digest: &str, study: &str) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut file = OpenOptions::new().create(true).append(true).open(folder.join(REMEMBERED))?;
    file.write_all(format!("{digest} {study}\n").as_bytes())
}

/// Whether the answer at a terminal is yes; that is remembered.
fn is_answered(study: &Study, starting: &[&ExternalSolver]) -> bool {
    if !(std::io::stdin().is_terminal() && std::io::stderr().is_terminal()) {
        return false;
    }
    say!("{}: this study runs {} with your permissions.", study.name, commands_of(starting));
    say!("Allow this, now and as long as its commands and files are unchanged? Type `yes`:");
    let mut answer = String::new();
    let mut input = std::io::Read::take(std::io::stdin().lock(), LONGEST_ANSWER);
    let is_yes = input.read_line(&mut answer).is_ok() && ["y", "yes"].contains(&answer.trim());
    if let Some(folder) = folder().filter(|_| is_yes)
        && let Err(error) = remember(&folder, &digest_of(study, starting), &study.name)
    {
        say!("the answer cannot be stored in {}: {error}", folder.display());
    }
    is_yes
}

#[cfg(test)]
mod tests;
