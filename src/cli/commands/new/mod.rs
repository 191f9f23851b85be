//! `oedometer new`: a commented study to start from, or an adapter for somebody else's solver.

pub mod solver;

use crate::cli::commands::new::solver::Language;
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::study::name::{name_of, refused_name};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

/// The text of a new study; `{name}` stands for its name.
const STARTER: &str = include_str!("starter.toml");

/// Arguments of `new`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of the study, or the file that it shall stand in; `solver` for an adapter of somebody else's solver
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// After `solver`: the name of the solver and of the folder for its study, adapter and mapping
    /// [default: my-solver]
    #[arg(value_name = "SOLVER")]
    solver: Option<PathBuf>,
    /// What the adapter of a solver is written in
    #[arg(long, value_enum)]
    language: Option<Language>,
}

/// The text of a starter of a name.
fn starter(name: &str) -> String {
    STARTER.replace("{name}", name)
}

/// Writes the file, where there is none yet.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let is_solver = arguments.solver.is_some() || arguments.language.is_some();
    if is_solver && arguments.name.as_os_str() == "solver" {
        let folder = arguments.solver.clone().unwrap_or_else(|| PathBuf::from("my-solver"));
        return solver::write(&folder, arguments.language.unwrap_or(Language::Python));
    }
    if is_solver {
        return Err(Ended::usage(
            "a second name or `--language` belongs to `oedometer new solver NAME --language python`",
        ));
    }
    let given = arguments.name.display().to_string();
    let name = name_of(&given);
    if let Some(why) = refused_name(name) {
        return Err(Ended::usage(format!("a study cannot be called `{name}`: {why}")));
    }
    let folder = arguments.name.parent().map_or_else(PathBuf::new, std::path::Path::to_path_buf);
    let path = folder.join(format!("{name}.toml"));
    let written = OpenOptions::new().write(true).create_new(true).open(&path);
    let written = written.and_then(|mut file| file.write_all(starter(name).as_bytes()));
    written.map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => {
            Ended::usage(format!("{} is there already: take another name", path.display()))
        }
        _ => Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display())),
    })?;
    say!("{} is a study that runs; next: oedometer check {}", path.display(), path.display());
    Ok(Exit::Pass)
}
