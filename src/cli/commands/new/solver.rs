//! `oedometer new solver`: writes an adapter for another program's solver, with its mapping and study; they run as is.

use crate::case::solver::{Attached, DIGEST_DIGITS};
use crate::cli::commands::new::not_written;
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::study::shipped::{name_of, refused_name};
use clap::ValueEnum;
use oedometer_mpm::method::Method;
use std::fs;
use std::path::Path;

/// Language of an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Language {
    /// Python 3 without packages
    Python,
    /// A POSIX shell with awk
    Shell,
}

impl Language {
    /// The program that runs the adapter, its file, and its text.
    const fn adapter(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Python => ("python3", "adapter.py", include_str!("adapter.py")),
            Self::Shell => ("sh", "adapter.sh", include_str!("adapter.sh")),
        }
    }
}

/// Writes the three files into a new folder.
pub fn write(folder: &Path, language: Language) -> anyhow::Result<Exit> {
    let given = folder.display().to_string();
    let name = name_of(&given);
    let is_taken = Method::named(name).map(|_| "a method of this program has this name".to_owned());
    let no_solver = || Attached::new(name, &"0".repeat(DIGEST_DIGITS)).err().map(|why| why.to_string());
    if let Some(why) = refused_name(name).or(is_taken).or_else(no_solver) {
        return Err(Ended::usage(format!("a solver and its study cannot be called `{name}`: {why}")));
    }
    let refused = |error: std::io::Error| not_written(folder, &error);
    if let Some(parent) = folder.parent() {
        fs::create_dir_all(parent).map_err(refused)?;
    }
    fs::create_dir(folder).map_err(refused)?;
    let (program, file, adapter) = language.adapter();
    let study = format!("{name}.toml");
    let texts = [
        (study.as_str(), include_str!("solver-study.toml")),
        ("mapping.toml", include_str!("mapping.toml")),
        (file, adapter),
    ];
    for (file_name, text) in texts {
        let text = text.replace("@NAME@", name).replace("@LANGUAGE@", program).replace("@ADAPTER@", file);
        fs::write(folder.join(file_name), text).map_err(refused)?;
    }
    let study = folder.join(study);
    say!(
        "{} attaches {}, a small solver in the place of yours; next: oedometer check {} --allow-solvers",
        study.display(),
        folder.join(file).display(),
        study.display()
    );
    Ok(Exit::Pass)
}
