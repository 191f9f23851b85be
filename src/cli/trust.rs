//! Which studies may start programs: a study file is text from anywhere, and its `[[solver]]` tables name commands that
//! run with the rights of whoever calls this program.
//!
//! Allowed are studies from inside this program, and all where `--allow-solvers` or its variable says so.

use crate::campaign::runner::Tally;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::cli::place;
use crate::study::check::Study;
use crate::study::solver::ExternalSolver;
use clap::builder::FalseyValueParser;
use oedometer_wording::count_of;
use std::path::PathBuf;

/// Longest command that is repeated, letters.
const LONGEST_COMMAND: usize = 300;

/// Whether studies may start programs.
#[derive(Clone, Debug, clap::Args)]
pub struct TrustArguments {
    /// Start the programs that the studies name in `[[solver]]`, with your permissions: review the studies first
    #[arg(long, env = "OEDOMETER_ALLOW_SOLVERS", hide_env_values = true, value_parser = FalseyValueParser::new())]
    allow_solvers: bool,
}

impl TrustArguments {
    /// Marks the studies that may start programs, and reports the studies that may not.
    pub fn mark(&self, studies: &mut [Study], named: &[PathBuf]) {
        for study in studies {
            let starting = starting(study);
            let is_allowed = self.allow_solvers || place::is_shipped(&study.name, named);
            if starting.is_empty() || is_allowed {
                study.may_start_solvers = true;
                continue;
            }
            say!(
                "{}: this study runs {} with your permissions, which you have not allowed yet: its cases \
                 are not run. Review it, then add --allow-solvers (in CI: OEDOMETER_ALLOW_SOLVERS=1)",
                study.name,
                commands_of(&starting)
            );
        }
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

#[cfg(test)]
mod tests;
