//! Reads a git repository by the program `git`.

use crate::foreign::git::command;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Why git gives no answer.
#[derive(Debug, thiserror::Error)]
pub(crate) enum GitError {
    /// The program cannot be started.
    #[error("cannot start `git`: {0}; install it, or give folders of records")]
    NotStartable(std::io::Error),
    /// No repository holds the folder.
    #[error("{} is not in a git repository: run the command inside the repository that holds the golden values", .0.display())]
    NoRepository(PathBuf),
    /// A revision that the repository does not have.
    #[error("`{revision}` is neither a folder nor a revision of {}{}", root.display(), shallow_hint(*is_shallow))]
    UnknownRevision {
        /// What was asked for.
        revision: String,
        /// Root of the repository.
        root: PathBuf,
        /// Whether the clone has only part of the history.
        is_shallow: bool,
    },
    /// Anything else that git says.
    #[error("`git {command}` failed: {said}")]
    Failed {
        /// Its words.
        command: String,
        /// Its standard error.
        said: String,
    },
}

fn shallow_hint(is_shallow: bool) -> &'static str {
    if is_shallow {
        ": the clone is shallow; `git fetch --unshallow` fetches the rest of the history"
    } else {
        ""
    }
}

/// A repository.
#[derive(Clone, Debug)]
pub(crate) struct Repository {
    root: PathBuf,
}

/// A commit.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub(crate) struct Commit {
    /// Full hash.
    pub hash: String,
    /// Day of the commit, `2026-11-25`.
    pub date: String,
    /// First line of its message.
    pub subject: String,
}

impl Commit {
    /// The hash as people write it.
    pub fn short(&self) -> &str {
        &self.hash[..self.hash.len().min(8)]
    }
}

/// A commit with the files that it changed below the folder that was asked for.
pub(crate) type ChangedFiles = (Commit, Vec<String>);

impl Repository {
    /// The repository that holds a folder.
    ///
    /// # Errors
    /// When git is missing or cannot be started.
    pub fn around(folder: &Path) -> Result<Self, GitError> {
        let output = git(folder, &["rev-parse", "--show-toplevel"])?;
        match output {
            Ok(root) => Ok(Self { root: PathBuf::from(root.trim_end()) }),
            Err(_) => Err(GitError::NoRepository(folder.to_owned())),
        }
    }

    /// Its root.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// What a git command prints in the root.
    ///
    /// # Errors
    /// When it fails.
    pub fn run(&self, words: &[&str]) -> Result<String, GitError> {
        git(&self.root, words)?.map_err(|said| GitError::Failed { command: words.join(" "), said })
    }

    /// Whether the clone has only part of the history.
    pub fn is_shallow(&self) -> bool {
        self.run(&["rev-parse", "--is-shallow-repository"]).is_ok_and(|answer| answer.trim() == "true")
    }

    /// Whether files have changes that no commit has; `words` narrow `git status`.
    pub fn is_dirty(&self, words: &[&str]) -> bool {
        let command = [&["status", "--porcelain"], words].concat();
        self.run(&command).is_ok_and(|changes| !changes.trim().is_empty())
    }

    /// The commit of a revision: a branch, a tag, a hash, `HEAD~3`.
    ///
    /// # Errors
    /// When the revision does not exist.
    pub fn commit(&self, revision: &str) -> Result<Commit, GitError> {
        let name = format!("{revision}^{{commit}}");
        let shown = ["log", "-1", "--format=%H%x09%cs%x09%s", "--end-of-options", &name];
        match git(&self.root, &shown)? {
            Ok(line) => Ok(commit_of(line.trim_end())),
            Err(_) => Err(GitError::UnknownRevision {
                revision: revision.to_owned(),
                root: self.root.clone(),
                is_shallow: self.is_shallow(),
            }),
        }
    }

    /// The files of a revision, from the root.
    ///
    /// # Errors
    /// When git fails.
    pub fn files(&self, commit: &Commit) -> Result<Vec<String>, GitError> {
        let listed = self.run(&["ls-tree", "-r", "-z", "--name-only", &commit.hash])?;
        Ok(listed.split_terminator('\0').map(str::to_owned).collect())
    }

    /// The commits that changed files below a folder, the first one first, along the main line of history.
    ///
    /// # Errors
    /// When git fails.
    pub fn changes_below(&self, folder: &str) -> Result<Vec<ChangedFiles>, GitError> {
        let log = [
            "log",
            "--reverse",
            "--format=%x01%H%x09%cs%x09%s",
            "--name-only",
            "--no-renames",
            "-m",
            "--first-parent",
            "--",
            folder,
        ];
        let text = self.run(&log)?;
        let of_commit = |block: &str| {
            let mut lines = block.lines();
            let commit = commit_of(lines.next().unwrap_or_default());
            (commit, lines.filter(|line| !line.is_empty()).map(str::to_owned).collect())
        };
        Ok(text.split('\x01').skip(1).map(of_commit).collect())
    }

    /// The texts of files at commits, `hash:path`, by one process; missing and binary files are left out.
    ///
    /// # Errors
    /// When git fails.
    pub fn texts(&self, objects: &[String]) -> Result<BTreeMap<String, String>, GitError> {
        let failed = |said: std::io::Error| GitError::Failed {
            command: "cat-file --batch".to_owned(),
            said: said.to_string(),
        };
        let mut child = command(&self.root, &["cat-file", "--batch"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(GitError::NotStartable)?;
        let (Some(mut input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(failed(std::io::ErrorKind::BrokenPipe.into()));
        };
        let asked = objects.join("\n") + "\n";
        // It answers while it is asked: both pipes are served at the same time.
        let asking = std::thread::spawn(move || input.write_all(asked.as_bytes()));
        let mut output = BufReader::new(output);
        let mut texts = BTreeMap::new();
        for object in objects {
            let mut head = String::new();
            output.read_line(&mut head).map_err(failed)?;
            let Some(size) = head.trim_end().rsplit(' ').next().and_then(|size| size.parse::<usize>().ok())
            else {
                continue;
            };
            let mut bytes = vec![0; size + 1];
            output.read_exact(&mut bytes).map_err(failed)?;
            bytes.pop();
            if let Ok(text) = String::from_utf8(bytes) {
                texts.insert(object.clone(), text);
            }
        }
        let asked = asking.join();
        let ended = child.wait().map_err(failed)?;
        if asked.is_ok_and(|asked| asked.is_ok()) && ended.success() {
            Ok(texts)
        } else {
            Err(failed(std::io::Error::other("it ended early")))
        }
    }
}

/// A commit of a line `hash TAB date TAB subject`.
fn commit_of(line: &str) -> Commit {
    let mut parts = line.splitn(3, '\t').map(str::to_owned);
    let mut next = || parts.next().unwrap_or_default();
    Commit { hash: next(), date: next(), subject: next() }
}

/// What a git command prints, or what it says where it fails.
fn git(folder: &Path, words: &[&str]) -> Result<Result<String, String>, GitError> {
    let output = command(folder, words).stdin(Stdio::null()).output().map_err(GitError::NotStartable)?;
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ok(if output.status.success() {
        Ok(text(output.stdout))
    } else {
        Err(text(output.stderr).trim().to_owned())
    })
}
