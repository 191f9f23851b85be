//! The place: the studies that a command takes where none is named, and the folder of the golden values of a study.
//!
//! The project is the current folder or the nearest one above it that has `oedometer.toml`, `golden/` or `studies/`. Its
//! studies are those of `studies/`, or those beside it where there are none.

use crate::case::contender::RACE;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::golden::{GoldenError, GoldenFile};
use crate::history::repository::Repository;
use crate::study::shipped::{name_of, shipped_names, shipped_study};
use oedometer_formats::input_file::read_text;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folder of results where none is named.
pub const DEFAULT_RESULTS: &str = "out";
/// Name of the folder of the golden values.
pub const GOLDEN: &str = "golden";
/// Name of the folder of a project's studies.
const STUDIES: &str = "studies";
/// Empty file that says where a project begins.
const MARK: &str = "oedometer.toml";

/// Which studies a command takes.
#[derive(Debug, clap::Args)]
pub struct StudyArguments {
    /// Study files, folders of them, or names of built-in studies [default: the studies of this project,
    /// `studies/*.toml` or `*.toml`, here or above]
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Take all built-in studies
    #[arg(long, conflicts_with = "studies")]
    shipped: bool,
}

impl StudyArguments {
    /// Files and names of the studies, one each.
    ///
    /// # Errors
    /// When none is named and there is none here, or a named folder has none.
    pub fn chosen(&self) -> anyhow::Result<Vec<PathBuf>> {
        if self.shipped {
            return Ok(shipped_names().into_iter().map(PathBuf::from).collect());
        }
        if self.names_none() { studies_of_this_project() } else { named(&self.studies) }
    }

    /// Whether all studies are taken, of the project or of the program.
    pub fn names_none(&self) -> bool {
        self.studies.is_empty()
    }
}

/// The studies that were named, with those of folders and of the race one by one.
///
/// # Errors
/// When a folder has no study.
pub fn named(given: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut chosen = Vec::new();
    for path in given {
        if path.is_dir() && shipped_study(&path.to_string_lossy()).is_none() {
            let studies = studies_in(path);
            if studies.is_empty() {
                let shown = path.display();
                return Err(Ended::usage(format!(
                    "the folder {shown} contains no study: `oedometer new {}` writes one there",
                    path.join("my-study").display()
                )));
            }
            chosen.extend(studies);
        } else if path.as_os_str() == RACE && !path.exists() {
            let is_of_race = |name: &String| name.split('-').next() == Some(RACE);
            chosen.extend(shipped_names().into_iter().filter(is_of_race).map(PathBuf::from));
        } else {
            chosen.push(path.clone());
        }
    }
    Ok(chosen)
}

/// The studies of the project around the current folder.
///
/// # Errors
/// When there are none.
pub fn studies_of_this_project() -> anyhow::Result<Vec<PathBuf>> {
    let is_project = |folder: &Path| {
        folder.as_os_str().is_empty()
            || folder.join(MARK).is_file()
            || [GOLDEN, STUDIES].iter().any(|name| folder.join(name).is_dir())
    };
    let mut folders = with_parents(Path::new("")).into_iter().filter(|folder| is_project(folder));
    folders.find_map(|folder| Some(studies_in(&folder)).filter(|studies| !studies.is_empty())).ok_or_else(
        || {
            let why = "there is no study in this folder, in its `studies/` or in a project above: name one, \
                       write one with `oedometer new my-study`, or use `--shipped` for the built-in ones";
            Ended::with(Exit::NothingSelected, why)
        },
    )
}

/// The studies of a folder: those in its `studies/`, or those in itself where there are none. The shipped ones in the
/// order of the report, then all others by name.
fn studies_in(folder: &Path) -> Vec<PathBuf> {
    let order = shipped_names();
    let mut studies = [folder.join(STUDIES), folder.to_owned()]
        .iter()
        .map(|folder| study_files_of(folder))
        .find(|studies| !studies.is_empty())
        .unwrap_or_default();
    studies.sort_by_cached_key(|file| {
        let shown = file.display().to_string();
        (order.iter().position(|name| *name == name_of(&shown)).unwrap_or(order.len()), shown)
    });
    studies
}

/// The study files in a folder. Mappings and the settings of other programs, which have no scene and no sweep, are none.
fn study_files_of(folder: &Path) -> Vec<PathBuf> {
    let begins = |line: &str| ["scene", "[[sweep]]"].iter().any(|word| line.trim_start().starts_with(word));
    // One that cannot be read is told of when it is.
    let is_study = |path: &PathBuf| read_text(path).map_or(true, |text| text.lines().any(begins));
    let entries = std::fs::read_dir(Path::new(".").join(folder)).into_iter().flatten().flatten();
    let files = entries.map(|entry| folder.join(entry.file_name()));
    files.filter(|path| path.extension().is_some_and(|end| end == "toml")).filter(is_study).collect()
}

/// A folder and all those above it, as they are reached from the current one.
fn with_parents(folder: &Path) -> Vec<PathBuf> {
    let depth = absolute(folder).map_or(1, |folder| folder.ancestors().count());
    std::iter::successors(Some(folder.to_owned()), |folder| Some(above(folder))).take(depth).collect()
}

/// The absolute path of a folder, where it is there.
fn absolute(folder: &Path) -> Option<PathBuf> {
    Path::new(".").join(folder).canonicalize().ok()
}

/// The folder above one.
fn above(folder: &Path) -> PathBuf {
    match (folder.parent(), folder.file_name()) {
        (Some(parent), Some(_)) => parent.to_owned(),
        _ => folder.join(".."),
    }
}

/// The folder of the golden values of a study file, or of a study from inside the program: `golden/` beside the file or
/// above it, up to the root of its project or repository; else the one here. Where there is none yet, beside the file
/// or beside its `studies/`.
pub fn folder_of_golden(file: Option<&Path>) -> PathBuf {
    let beside = file.and_then(Path::parent).unwrap_or(Path::new(""));
    let is_root = |folder: &PathBuf| folder.join(MARK).is_file() || folder.join(".git").exists();
    let folders = with_parents(beside);
    let is_home = absolute(beside).is_some_and(|beside| beside.ends_with(STUDIES));
    let root = folders.iter().position(is_root).unwrap_or(usize::from(is_home));
    let mut searched = folders[..=root.min(folders.len() - 1)].to_vec();
    searched.push(PathBuf::new());
    let folder = searched.into_iter().map(|folder| folder.join(GOLDEN)).find(|folder| folder.is_dir());
    folder.unwrap_or_else(|| if is_home { above(beside) } else { beside.to_owned() }.join(GOLDEN))
}

/// The golden values of a chosen study or of the exact solutions: from a folder where one is given, else from that of its
/// file; of what is inside the program from there, where the folder has none.
///
/// # Errors
/// As [`GoldenFile::read`].
pub fn golden_of(given: Option<&Path>, study: &str, chosen: &[PathBuf]) -> Result<GoldenFile, GoldenError> {
    let is_inside = is_shipped(study, chosen);
    match given {
        Some(folder) => GoldenFile::read(folder, study),
        None if is_inside => GoldenFile::read_or_embedded(&golden_folder(None, study, chosen), study),
        None => GoldenFile::read(&golden_folder(None, study, chosen), study),
    }
}

/// The folder of the golden values of a chosen study: the given one, or that of its file.
pub fn golden_folder(given: Option<&Path>, study: &str, chosen: &[PathBuf]) -> PathBuf {
    let is_stream = |path: &Path| ["/dev", "/proc"].iter().any(|folder| path.starts_with(folder));
    let file = chosen_as(study, chosen).filter(|path| path.is_file() && !is_stream(path));
    given.map_or_else(|| folder_of_golden(file), Path::to_owned)
}

/// As what a study was chosen: a file, or the name of a shipped one.
pub fn chosen_as<'a>(study: &str, chosen: &'a [PathBuf]) -> Option<&'a Path> {
    chosen.iter().find(|path| name_of(&path.to_string_lossy()) == study).map(PathBuf::as_path)
}

/// Whether a chosen study comes from inside the program.
pub fn is_shipped(study: &str, chosen: &[PathBuf]) -> bool {
    chosen_as(study, chosen).is_some_and(|path| !path.is_file() && shipped_study(study).is_some())
}

/// The repository around the current folder, and the path of its golden values from the root.
pub fn repository_with(golden: Option<&Path>, studies: &[String]) -> anyhow::Result<(Repository, String)> {
    let here = std::env::current_dir()?;
    let repository = Repository::around(&here).map_err(|error| Ended::usage(error.to_string()))?;
    let root = repository.root().canonicalize()?;
    let given = match golden {
        Some(folder) => folder.to_owned(),
        None => Some(folder_of_golden(None))
            .filter(|folder| folder.is_dir())
            .map_or_else(|| only_golden_folder(&repository, &root, studies), Ok)?,
    };
    let whole = here.canonicalize()?.join(given);
    let whole = whole.canonicalize().unwrap_or(whole);
    let inside = whole.strip_prefix(&root).map_err(|_| {
        Ended::usage(format!("{} lies outside the repository {}", whole.display(), root.display()))
    })?;
    let folder = inside.to_string_lossy().trim_end_matches('/').replace('\\', "/");
    if repository.is_dirty(&["--", &folder]) {
        say!("{folder}/ has uncommitted changes, which no revision contains");
    }
    Ok((repository, folder))
}

/// The one folder of golden values in a repository that has none here or above: `accept` writes beside a study.
///
/// # Errors
/// When there are several.
fn only_golden_folder(repository: &Repository, root: &Path, studies: &[String]) -> anyhow::Result<PathBuf> {
    let pattern = format!("**/{GOLDEN}/*.csv");
    let listed = repository.run(&[
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
        "--",
        &format!(":(glob){pattern}"),
    ])?;
    let is_named = |path: &&Path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        studies.is_empty() || studies.iter().any(|study| *study == name)
    };
    let files = listed.split_terminator('\0').map(Path::new).filter(is_named);
    let folders: BTreeSet<&Path> = files.filter_map(Path::parent).collect();
    match folders.iter().collect::<Vec<_>>()[..] {
        [] => Ok(folder_of_golden(None)),
        [only] => Ok(root.join(only)),
        ref several => {
            let several: Vec<String> =
                several.iter().map(|folder| format!("--golden {}", root.join(folder).display())).collect();
            Err(Ended::usage(format!(
                "golden values are in {} folders: give one of them, {}",
                several.len(),
                several.join(" or ")
            )))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_values_are_those_of_the_nearest_folder_up_to_the_root_and_else_those_here() {
        // The folder of the tests has golden values.
        let here = Path::new(GOLDEN);
        assert!(here.is_dir());
        // Folder of the study, what marks a root, folders with golden values, that which is taken.
        for (own, mark, with_golden, wanted) in [
            ("p/a/b", "p/.git", &["", "p", "p/a", "p/a/b"][..], Some("p/a/b")),
            ("p/a/b", "p/.git", &["", "p", "p/a"], Some("p/a")),
            ("p/a/b", "p/.git", &["", "p"], Some("p")),
            ("p/a/b", "p/.git", &[""], None),
            ("p/a/b", "p/a/oedometer.toml", &["", "p", "p/a"], Some("p/a")),
            ("p/a/b", "p/a/oedometer.toml", &["", "p"], None),
            ("p/a/b", "p/a/b/.git", &["p", "p/a"], None),
            // Without a root that of the study alone, and beside its `studies/`.
            ("p/a/b", "", &["p/a", "p/a/b"], Some("p/a/b")),
            ("p/a/b", "", &["p", "p/a"], None),
            ("p/a/studies", "", &["p", "p/a", "p/a/studies"], Some("p/a/studies")),
            ("p/a/studies", "", &["p", "p/a"], Some("p/a")),
            ("p/a/studies", "", &["p"], None),
        ] {
            let folder = tempfile::TempDir::new().expect("a folder");
            let at = |name: &str| folder.path().join(name);
            std::fs::create_dir_all(at(own)).expect("a folder");
            if !mark.is_empty() {
                std::fs::write(at(mark), "").expect("a file");
            }
            for place in with_golden {
                std::fs::create_dir_all(at(place).join(GOLDEN)).expect("a folder");
            }
            let found = folder_of_golden(Some(&at(own).join("s.toml")));
            let wanted = wanted.map_or(here.to_owned(), |wanted| at(wanted).join(GOLDEN));
            assert_eq!(found, wanted, "{own} with {mark:?} and {with_golden:?}");
        }
        assert_eq!(folder_of_golden(None), here, "of a study from inside the program");
    }

    #[test]
    fn studies_of_a_folder_are_the_shipped_ones_in_the_order_of_the_report_and_then_the_others_by_name() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = folder.path();
        for (name, text) in [
            ("zz.toml", "title = 't'\nscene = 'terzaghi'\n"),
            ("aa.toml", "  [[sweep]]\n"),
            ("at-rest.toml", "scene = 'at-rest'\n"),
            ("terzaghi-mesh.toml", "scene = 'terzaghi'\n"),
            ("mapping.toml", "[columns]\np = 'scene'\n"),
            ("notes.md", "scene\n"),
            ("deep.toml.bak", "scene\n"),
        ] {
            std::fs::write(at.join(name), text).expect("a file");
        }
        // What cannot be read is named, so that somebody is told of it.
        std::fs::write(at.join("bytes.toml"), b"\xff").expect("a file");
        std::fs::create_dir(at.join("folder.toml")).expect("a folder");
        let names = |found: Vec<PathBuf>| -> Vec<String> {
            found.iter().map(|path| name_of(&path.to_string_lossy())).collect()
        };
        let here = ["terzaghi-mesh", "at-rest", "aa", "bytes", "folder", "zz"];
        assert_eq!(names(studies_in(at)), here);
        // An empty `studies/` hides nothing, and one with a study hides what is beside it.
        std::fs::create_dir(at.join(STUDIES)).expect("a folder");
        assert_eq!(names(studies_in(at)), here);
        std::fs::write(at.join("studies/inner.toml"), "scene = 'terzaghi'\n").expect("a file");
        assert_eq!(names(studies_in(at)), ["inner"]);
        let given = ["b.toml".into(), at.to_owned(), RACE.into(), "a.toml".into()];
        let chosen = names(named(&given).expect("a folder with a study"));
        assert_eq!(chosen[..3], ["b", "inner", "race-column-usual"]);
        assert_eq!(chosen[chosen.len() - 2..], ["race-footing", "a"]);
        let race = &chosen[2..chosen.len() - 1];
        assert!(race.iter().all(|name| name.starts_with("race-")), "{race:?}");
        assert_eq!(race.len(), shipped_names().iter().filter(|name| name.starts_with("race-")).count());
        let empty = at.join("empty");
        std::fs::create_dir(&empty).expect("a folder");
        let told = named(std::slice::from_ref(&empty)).expect_err("no study").to_string();
        let shown = empty.display();
        assert_eq!(
            told,
            format!(
                "the folder {shown} contains no study: `oedometer new {shown}/my-study` writes one there"
            )
        );
    }
}
