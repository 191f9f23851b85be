//! Commands of `git`, whose answers do not depend on the caller's variables.

use std::path::Path;
use std::process::{Command, Stdio};

/// Variables in which a hook of git passes the place of the repository to its commands.
const PLACES: [&str; 5] =
    ["GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_COMMON_DIR", "GIT_OBJECT_DIRECTORY"];

/// A git command in a folder.
pub fn command(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new("git");
    command.arg("-C").arg(folder).args(["-c", "core.quotePath=off"]).args(words).env("LC_ALL", "C");
    for variable in PLACES {
        command.env_remove(variable);
    }
    command
}

/// What a git command prints in a folder; `None` where it fails or there is no git.
pub fn answer(folder: &Path, words: &[&str]) -> Option<String> {
    let output = command(folder, words).stdin(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}
