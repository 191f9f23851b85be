//! Reads study files and checks their names before any work begins: results are stored under the name of the study.

use crate::cli::exit::Ended;
use crate::study::diagnostic::nearest;
use crate::study::file::StudySource;
use crate::study::shipped::{name_of, refused_name};
use crate::study::shipped::{shipped_names, shipped_study};
use oedometer_formats::input_file::{self, LARGEST_TEXT};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Reads study files, whose names must be valid and differ.
pub fn read_all(paths: &[PathBuf]) -> anyhow::Result<Vec<StudySource>> {
    let sources = paths.iter().map(|path| read(path)).collect::<anyhow::Result<Vec<StudySource>>>()?;
    for (number, source) in sources.iter().enumerate() {
        let name = name_of(&source.name);
        if let Some(why) = refused_name(name) {
            let file = &source.name;
            return Err(Ended::usage(format!("the study {file} cannot be called `{name}`: {why}")));
        }
        if let Some(other) = sources[..number].iter().find(|other| name_of(&other.name) == name) {
            return Err(Ended::usage(format!(
                "{} and {} are both called `{name}`, and one would overwrite the results of the other: rename one",
                other.name, source.name
            )));
        }
    }
    Ok(sources)
}

/// The shipped study of a name, unless there is a file of that name.
fn shipped_of(path: &Path) -> Option<StudySource> {
    if path.is_file() { None } else { shipped_study(path.to_str()?) }
}

/// The message about a study that is neither a file nor shipped, with what may have been meant.
fn not_there(path: &Path) -> String {
    let told = path.display().to_string();
    let with_end = PathBuf::from(format!("{told}.toml"));
    let mut known = shipped_names();
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let help = if with_end.is_file() {
        format!("did you mean the file `{}`?", with_end.display())
    } else if path.extension().is_some() && known.contains(&stem) {
        format!("the shipped study is called `{stem}`, without folder and extension")
    } else {
        // The study files in the folder, as they would be given.
        let folder = path.parent().unwrap_or(Path::new(""));
        let searched = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = std::fs::read_dir(searched).into_iter().flatten().flatten();
        let files = entries.map(|entry| folder.join(entry.file_name()));
        let files = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
        known.extend(files.map(|file| file.display().to_string()));
        match nearest(&told, known.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => {
                "`oedometer list` prints the shipped ones, and `oedometer new NAME` writes one of your own"
                    .to_owned()
            }
        }
    };
    format!("cannot read the study {told}: no such file, and no shipped study: {help}")
}

/// Reads a file, or a pipe of this program.
fn read(path: &Path) -> anyhow::Result<StudySource> {
    if let Some(shipped) = shipped_of(path) {
        return Ok(shipped);
    }
    if !path.exists() {
        return Err(Ended::usage(not_there(path)));
    }
    let refused =
        |error: std::io::Error| Ended::usage(format!("cannot read the study {}: {error}", path.display()));
    let text = if is_own_stream(path) { read_stream(path) } else { input_file::read_text(path) };
    Ok(StudySource { name: path.display().to_string(), text: text.map_err(refused)? })
}

/// Whether a path is one of this program's own open files: its standard input, or what a shell makes of `<(…)`. Opening
/// any other pipe waits for a writer that may never come.
fn is_own_stream(path: &Path) -> bool {
    let is_listed = ["/dev/fd", "/proc/self/fd"].iter().any(|folder| path.starts_with(folder));
    (is_listed || path == Path::new("/dev/stdin")) && !path.is_file()
}

/// Reads a stream, up to the size of the largest study.
fn read_stream(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(LARGEST_TEXT + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST_TEXT {
        let why = format!("it has more than {} MB, which is too large for a study", LARGEST_TEXT / 1_000_000);
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, why));
    }
    Ok(text)
}
