//! `oedometer new`: a commented study to start from, or an adapter for somebody else's solver.

pub mod solver;

use crate::cli::commands::new::solver::Language;
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::study::shipped::shipped_studies;
use crate::study::shipped::{name_of, refused_name};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

/// Texts of new studies by their scenes, the first where none is named; `{name}` stands for the name.
const STARTERS: [(&str, &str); 3] = [
    ("terzaghi", include_str!("starter.toml")),
    ("xie-leo", include_str!("starter-large.toml")),
    ("cosine-layer", include_str!("starter-plane.toml")),
];

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
    /// Scene of the study: terzaghi where not given, xie-leo at large strain, cosine-layer in the plane
    #[arg(long, value_name = "SCENE")]
    scene: Option<String>,
    /// What the adapter of a solver is written in
    #[arg(long, value_enum)]
    language: Option<Language>,
}

/// The text of a starter of a name.
///
/// # Errors
/// A sentence with what to take where the scene has none.
fn starter(name: &str, scene: Option<&str>) -> anyhow::Result<String> {
    let [(usual, _), ..] = STARTERS;
    let scene = scene.unwrap_or(usual);
    if let Some((_, text)) = STARTERS.iter().find(|(known, _)| *known == scene) {
        return Ok(text.replace("{name}", name));
    }
    let with = STARTERS.map(|(known, _)| known).join(", ");
    let line = format!("scene = \"{scene}\"");
    let shipped =
        shipped_studies().into_iter().find(|study| study.text.lines().any(|one| one.starts_with(&line)));
    Err(Ended::usage(match shipped {
        Some(study) => format!(
            "there is no starter of the scene `{scene}` (there is of {with}); `oedometer list --show {}` prints a shipped \
             study of it",
            name_of(&study.name)
        ),
        None => format!(
            "no scene with a study is called `{scene}`: there are starters of {with}; `oedometer list` names all"
        ),
    }))
}

/// Writes the file, where there is none yet.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let is_solver = arguments.solver.is_some() || arguments.language.is_some();
    if is_solver && arguments.scene.is_some() {
        return Err(Ended::usage(
            "`--scene` belongs to `oedometer new NAME`: the adapter of a solver is for `terzaghi`",
        ));
    }
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
    let text = starter(name, arguments.scene.as_deref())?;
    let folder = arguments.name.parent().map_or_else(PathBuf::new, std::path::Path::to_path_buf);
    let path = folder.join(format!("{name}.toml"));
    let written = OpenOptions::new().write(true).create_new(true).open(&path);
    let written = written.and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => {
            Ended::usage(format!("{} is there already: take another name", path.display()))
        }
        _ => Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display())),
    })?;
    say!("{} is a study that runs; next: oedometer check {}", path.display(), path.display());
    Ok(Exit::Pass)
}
