//! `oedometer new`: writes a commented study to start from, or an adapter for another program's solver.

use crate::case::solver::{Attached, DIGEST_DIGITS};
use crate::cli::exit::{Ended, Exit};
use crate::cli::job_list::quoted;
use crate::cli::output::say;
use crate::study::file::StudySource;
use crate::study::shipped::{name_of, refused_name, shipped_studies};
use clap::ValueEnum;
use oedometer_problem::method::Method;
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Texts of new studies by their scenes, the default first; `{name}` stands for the name.
const STARTERS: [(&str, &str); 5] = [
    ("terzaghi", include_str!("starter.toml")),
    ("xie-leo", include_str!("starter-large.toml")),
    ("cosine-layer", include_str!("starter-plane.toml")),
    ("layered", include_str!("starter-layered.toml")),
    ("footing", include_str!("starter-footing.toml")),
];

/// Arguments of `new`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name or file of the study
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// Benchmark problem [default: terzaghi]: xie-leo for large strain, cosine-layer for the plane, layered for several
    /// soils, footing for a plate on soil that yields
    #[arg(long, value_name = "SCENE")]
    scene: Option<String>,
}

/// Arguments of `new-solver`.
#[derive(Debug, clap::Args)]
pub struct SolverArguments {
    /// Name of the solver, and of the folder for its study, adapter and mapping
    #[arg(value_name = "NAME", default_value = "my-solver")]
    name: PathBuf,
    /// Language of the adapter
    #[arg(long, value_enum, default_value_t = Language::Python)]
    language: Language,
}

/// Writes the adapter of a solver, with its study and its mapping.
pub fn run_solver(arguments: &SolverArguments) -> anyhow::Result<Exit> {
    write_adapter(&arguments.name, arguments.language)
}

/// Writes a new study or adapter; an existing file is kept.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let given = arguments.name.display().to_string();
    let name = name_of(&given);
    if let Some(why) = refused_name(&name) {
        return Err(Ended::usage(format!("a study cannot be called `{name}`: {why}")));
    }
    let text = starter(&name, arguments.scene.as_deref())?;
    let path = arguments.name.with_file_name(format!("{name}.toml"));
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| not_written(folder, &error))?;
    }
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|error| not_written(&path, &error))?;
    say!("wrote {}; next: oedometer check {}", path.display(), quoted(&path.to_string_lossy()));
    Ok(Exit::Pass)
}

/// The starter of a scene with a name, or an error with what to use instead.
fn starter(name: &str, scene: Option<&str>) -> anyhow::Result<String> {
    let scene = scene.unwrap_or(STARTERS[0].0);
    if let Some((_, text)) = STARTERS.iter().find(|(known, _)| *known == scene) {
        return Ok(text.replace("{name}", name));
    }
    let starters = STARTERS.map(|(known, _)| known).join(", ");
    let line = format!("scene = \"{scene}\"");
    let has_scene = |study: &StudySource| study.text.lines().any(|written| written.starts_with(&line));
    let help = match shipped_studies().into_iter().find(has_scene) {
        Some(study) => {
            format!("`oedometer list --show {}` prints a built-in study of it", name_of(&study.name))
        }
        None => "`oedometer list` lists all benchmark problems".to_owned(),
    };
    Err(Ended::usage(format!("there is no starter for `{scene}` (only for {starters}): {help}")))
}

/// The error of a file or folder that cannot be written.
fn not_written(path: &Path, error: &std::io::Error) -> anyhow::Error {
    match error.kind() {
        ErrorKind::AlreadyExists => {
            Ended::usage(format!("{} already exists: use another name", path.display()))
        }
        _ => Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display())),
    }
}

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
fn write_adapter(folder: &Path, language: Language) -> anyhow::Result<Exit> {
    let given = folder.display().to_string();
    let name = name_of(&given);
    let is_taken = Method::named(&name).map(|_| "a method of this program has this name".to_owned());
    let no_solver = || Attached::new(&name, &"0".repeat(DIGEST_DIGITS)).err().map(|why| why.to_string());
    if let Some(why) = refused_name(&name).or(is_taken).or_else(no_solver) {
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
        let text = text.replace("@NAME@", &name).replace("@LANGUAGE@", program).replace("@ADAPTER@", file);
        fs::write(folder.join(file_name), text).map_err(refused)?;
    }
    let study = folder.join(study);
    say!(
        "{} attaches {}, a small solver to replace with yours; next: oedometer check {} --allow-solvers",
        study.display(),
        folder.join(file).display(),
        quoted(&study.to_string_lossy())
    );
    Ok(Exit::Pass)
}
