//! Reads study files and checks their names before any work begins: results are stored under the name of the study. Writes the
//! tables of a study from its stored records.

use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::exit::Ended;
use crate::cli::output::say;
use crate::foreign::reading::mapping_of;
use crate::import::mapping::Axes;
use crate::record::Record;
use crate::record::atomic_file::write_atomically;
use crate::record::csv::long_tables::{LongTable, columns_csv};
use crate::record::csv::{TableForm, tidy};
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::study::check::{Purpose, Study};
use crate::study::file::StudySource;
use crate::study::shipped::{name_of, refused_name, shipped_names, shipped_study};
use oedometer_formats::input_file::{self, LARGEST_TEXT};
use oedometer_input::nearest::nearest;
use std::borrow::Cow;
use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Reads study files, whose names must be valid and differ.
pub fn read_all(paths: &[PathBuf]) -> anyhow::Result<Vec<StudySource>> {
    read_each(paths).into_iter().collect()
}

/// Each study file, or why it cannot be taken.
pub fn read_each(paths: &[PathBuf]) -> Vec<anyhow::Result<StudySource>> {
    let mut names: Vec<String> = Vec::new();
    let mut read_one = |path: &PathBuf| {
        let source = read(path)?;
        let name = name_of(&source.name);
        if let Some(why) = refused_name(&name) {
            let file = &source.name;
            return Err(Ended::usage(format!("the study {file} cannot be called `{name}`: {why}")));
        }
        if let Some(other) = names.iter().find(|other| name_of(other) == name) {
            return Err(Ended::usage(format!(
                "{other} and {} are both called `{name}`, and one would overwrite the other's results: rename one",
                source.name
            )));
        }
        names.push(source.name.clone());
        Ok(source)
    };
    paths.iter().map(&mut read_one).collect()
}

/// The shipped study of a name, unless there is a file of that name.
fn shipped_of(path: &Path) -> Option<StudySource> {
    if path.is_file() { None } else { shipped_study(path.to_str()?) }
}

/// The message about a study that is neither a file nor shipped, with what may have been meant.
fn not_there(path: &Path) -> String {
    let shown = path.display().to_string();
    let with_end = PathBuf::from(format!("{shown}.toml"));
    let mut known = shipped_names();
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let help = if with_end.is_file() {
        format!("did you mean the file `{}`?", with_end.display())
    } else if path.extension().is_some() && known.contains(&stem) {
        format!("the built-in study is called `{stem}`, without folder and extension")
    } else {
        // The study files in the folder, as they would be given.
        let folder = path.parent().unwrap_or(Path::new(""));
        let searched = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = std::fs::read_dir(searched).into_iter().flatten().flatten();
        let files = entries.map(|entry| folder.join(entry.file_name()));
        let files = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
        let files: Vec<PathBuf> = files.collect();
        let stem_of = |file: &PathBuf| file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        // By their names: that both end alike makes no two files alike.
        known.extend(files.iter().filter_map(stem_of));
        let near = nearest(&stem, known.iter().map(String::as_str)).map(str::to_owned);
        let near = near.map(|near| {
            let file = files.iter().find(|file| stem_of(file).as_ref() == Some(&near));
            file.map_or(near, |file| file.display().to_string())
        });
        match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`oedometer list` prints the built-in ones, and `oedometer new NAME` writes a new one"
                .to_owned(),
        }
    };
    format!("cannot read the study {shown}: no such file, and no built-in study: {help}")
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

/// Reads and checks study files; what is odd about them goes to standard error, but of a study with results in a folder, whose
/// run said it.
pub fn load(paths: &[PathBuf], results: Option<&Path>) -> anyhow::Result<Vec<Study>> {
    let studies = read_all(paths)?.iter().map(checked).collect::<anyhow::Result<Vec<Study>>>()?;
    tell_what_is_new(&studies, results);
    Ok(studies)
}

/// The studies among several that can run, with their warnings, and why each of the others cannot.
///
/// # Errors
/// Where none can run.
pub fn load_sound(paths: &[PathBuf], results: &Path) -> anyhow::Result<(Vec<Study>, Vec<anyhow::Error>)> {
    let (mut studies, mut refused) = (Vec::new(), Vec::new());
    for study in read_each(paths).into_iter().map(|source| checked(&source?)) {
        match study {
            Ok(study) => studies.push(study),
            Err(error) => refused.push(error),
        }
    }
    if studies.is_empty() && !refused.is_empty() {
        return Err(refused.remove(0));
    }
    tell_what_is_new(&studies, Some(results));
    Ok((studies, refused))
}

fn tell_what_is_new(studies: &[Study], results: Option<&Path>) {
    let is_new = |study: &&Study| results.is_none_or(|results| !results.join(&study.name).is_dir());
    studies.iter().filter(is_new).for_each(tell_warnings);
}

/// A study that can run, with the mappings of its solvers.
fn checked(source: &StudySource) -> anyhow::Result<Study> {
    let study = Study::check_for(source, Purpose::Solving)?;
    for solver in &study.solvers {
        mapping_of(solver, Axes::of(study.scene)).map_err(|error| Ended::usage(error.to_string()))?;
    }
    Ok(study)
}

/// What is odd about a study, on standard error.
pub fn tell_warnings(study: &Study) {
    for warning in &study.warnings {
        say!("{warning}");
    }
}

/// Cases up to which a study is small: its records are held in memory while it runs, and all its tables are written, by
/// every share too. Of more cases the tables of profiles and of settlement are long.
const MOST_CASES_OF_SMALL: usize = 64;
/// Cases up to which a table is plain CSV; that of more is compressed, to a fifteenth.
const MOST_PLAIN_CASES: usize = 2000;

/// Whether a study has few cases.
pub fn is_small(study: &Study) -> bool {
    study.planned.len() <= MOST_CASES_OF_SMALL
}

/// Whether the tables of a study are compressed, whatever was asked for.
pub fn is_compressed(study: &Study) -> bool {
    study.planned.len() > MOST_PLAIN_CASES
}

/// Says what lies in the store of a study and is not read.
pub fn tell_of_passed_over(study: &Study, store: &RecordStore) {
    for sentence in store.passed_over() {
        say!("{}: {sentence}", study.name);
    }
}

/// Writes the CSV of every record that a store keeps of a study, whichever run made it: a run of one tier or shard takes
/// nothing away from what others found. Those that are at hand are not read again. Beside it stands the table of what
/// every column means, and of a small study those of profiles and of settlement over time: of a larger one `oedometer
/// records` prints them.
pub fn write_tables(
    study: &Study,
    store: &RecordStore,
    at_hand: &[Record],
    asked: TableForm,
) -> anyhow::Result<PathBuf> {
    store.refresh();
    let cases = study.cases(Tier::Full);
    let form = if is_compressed(study) { TableForm::Compressed } else { asked };
    let at_hand: HashMap<&str, &Record> =
        at_hand.iter().map(|record| (record.hash.as_str(), record)).collect();
    let record_of = |case: &Case| match at_hand.get(case.hash().as_str()) {
        Some(record) => Some(Cow::Borrowed(*record)),
        None => store.kept(case).map(Cow::Owned),
    };
    let write = |name: &str, header, rows: &(dyn Fn(&Record) -> csv::Result<String> + Sync)| {
        form.write(store.folder(), name, header, &cases, |case| match record_of(case) {
            Some(record) => Ok(rows(&record)?),
            None => Ok(String::new()),
        })
    };
    let sources = Provenance::of_this_program().sources;
    let foreign = AtomicUsize::new(0);
    let table = write(&study.name, tidy::header_line(), &|record| {
        foreign.fetch_add(usize::from(record.provenance.sources != sources), Ordering::Relaxed);
        tidy::rows_of(&study.name, record)
    })?;
    let foreign = foreign.into_inner();
    if foreign > 0 {
        say!("{}: {foreign} older records in the table come from other sources", study.name);
    }
    for long in LongTable::ALL.into_iter().filter(|_| is_small(study)) {
        write(long.name(), long.header_line(), &|record| long.rows_of(record))?;
    }
    write_atomically(&store.folder().join("columns.csv"), columns_csv()?.as_bytes())?;
    Ok(table)
}
