//! Files that list other files: PVD, `.vtm` with several blocks, and series in JSON; and which one to give instead of a
//! folder or of one file of a series.

use crate::input_file;
use crate::xml::{all, attribute, parse};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Entries of a folder that are looked at.
const MOST_ENTRIES: usize = 10_000;
/// Largest collection that is searched for a file name, bytes.
const LARGEST: u64 = 1 << 20;
/// Extensions of files that list others, the preferred first.
const COLLECTIONS: [&str; 4] = ["pvd", "series", "xdmf", "pvtu"];
/// Extensions of files with one state each.
const STATES: [&str; 12] =
    ["vtu", "vtk", "vtp", "npz", "npy", "h5", "hdf5", "vtkhdf", "e", "nc", "msh", "csv"];
/// Files of a folder that ADIOS2 writes as one file.
const ADIOS2: [&str; 3] = ["md.idx", "md.0", "data.0"];

/// A file of a collection and its time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    /// The file; a relative name counts from the folder of the collection.
    pub file: PathBuf,
    /// Its time, in the unit of the program that wrote it.
    pub time: Option<f64>,
    /// Which part of a state it is.
    pub part: String,
}

/// A series as `ParaView` writes and reads it.
#[derive(Deserialize)]
struct Series {
    files: Vec<SeriesFile>,
}

#[derive(Deserialize)]
struct SeriesFile {
    name: String,
    time: f64,
}

/// Files of a PVD.
pub(crate) fn of_pvd(path: &Path, text: &str) -> Result<Vec<Member>, String> {
    let document = parse(text)?;
    let member = |set| {
        let time = match attribute(set, "timestep") {
            "" => None,
            typed => Some(time_of(typed)?),
        };
        let part = attribute(set, "part").to_owned();
        Ok(Member { file: beside(path, attribute(set, "file")), time, part })
    };
    all(document.root(), "DataSet").map(member).collect()
}

/// Files of the blocks of a `.vtm`.
pub(crate) fn of_blocks(path: &Path, text: &str) -> Result<Vec<PathBuf>, String> {
    let document = parse(text)?;
    let files = all(document.root(), "DataSet").map(|set| attribute(set, "file"));
    Ok(files.filter(|file| !file.is_empty()).map(|file| beside(path, file)).collect())
}

/// Files of the pieces of a `.pvtu` or `.pvtp`.
pub(crate) fn of_pieces(path: &Path, text: &str) -> Result<Vec<PathBuf>, String> {
    let document = parse(text)?;
    let files = all(document.root(), "Piece").map(|piece| attribute(piece, "Source"));
    Ok(files.filter(|file| !file.is_empty()).map(|file| beside(path, file)).collect())
}

/// Files of a series.
pub(crate) fn of_series(path: &Path, text: &str) -> Result<Vec<Member>, String> {
    let series: Series =
        serde_json::from_str(text).map_err(|error| format!("it is not a series of files: {error}"))?;
    let member = |listed: SeriesFile| Member {
        file: beside(path, &listed.name),
        time: Some(listed.time),
        part: String::new(),
    };
    Ok(series.files.into_iter().map(member).collect())
}

/// A time as written in a collection: a finite number.
pub(crate) fn time_of(typed: &str) -> Result<f64, String> {
    let time = typed.trim().parse().ok().filter(|time: &f64| time.is_finite());
    time.ok_or_else(|| format!("the time `{typed}` is invalid: expected a finite number"))
}

/// A file that another one names.
pub(crate) fn beside(path: &Path, name: &str) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

/// A sentence for a folder that was given instead of its files.
pub(crate) fn of_folder(folder: &Path) -> String {
    let files = files_of(folder);
    if ADIOS2.iter().any(|name| folder.join(name).is_file()) || ends_with(folder, "bp") {
        return "it is an ADIOS2 file, which is not read: write XDMF (dolfinx.io.XDMFFile) or VTU (dolfinx.io.VTKFile)"
            .to_owned();
    }
    let first = |endings: &[&'static str]| {
        let of = |ending: &&'static str| Some((*ending, files.iter().find(|file| ends_with(file, ending))?));
        endings.iter().find_map(of)
    };
    if let Some((_, collection)) = first(&COLLECTIONS) {
        return format!("it is a folder: give the collection in it, {}", collection.display());
    }
    match first(&STATES) {
        Some((ending, _)) => {
            let pattern = folder.join(format!("*.{ending}"));
            format!(
                "it is a folder: give its files, '{}' with the quotes for all of this kind",
                pattern.display()
            )
        }
        None => "it is a folder without VTU, PVD, legacy VTK, NPZ, HDF5, XDMF or CSV files".to_owned(),
    }
}

/// The collection beside a file that lists the file with its time.
pub fn collection_of(file: &Path) -> Option<PathBuf> {
    let name = file.file_name()?.to_str()?.as_bytes().to_vec();
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names_it = |path: &&PathBuf| {
        let is_small = path.metadata().is_ok_and(|about| about.len() <= LARGEST);
        is_small && input_file::read(path).is_ok_and(|text| text.windows(name.len()).any(|part| part == name))
    };
    let files = files_of(folder);
    let collections =
        files.iter().filter(|path| COLLECTIONS[..2].iter().any(|ending| ends_with(path, ending)));
    // Some programs write one collection per state and one for all: the largest has the times.
    let found =
        collections.filter(names_it).max_by_key(|path| path.metadata().map_or(0, |about| about.len()))?;
    Some(found.strip_prefix(".").unwrap_or(found).to_owned())
}

fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// Files of a folder in the order of their names.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_ENTRIES);
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collections_name_files_and_times() {
        let pvd = r#"<VTKFile type="Collection"><Collection><DataSet timestep="4.5" part="" file="a.vtu"/>
            <DataSet file="b.vtu"/></Collection></VTKFile>"#;
        let members = of_pvd(Path::new("in/col.pvd"), pvd).expect("a collection");
        assert_eq!(
            members[0],
            Member { file: PathBuf::from("in/a.vtu"), time: Some(4.5), part: String::new() }
        );
        assert_eq!(members[1].time, None);
        let series = r#"{"file-series-version":"1.0","files":[{"name":"c.vtm","time":1e0}]}"#;
        assert_eq!(of_series(Path::new("s"), series).expect("a series")[0].time, Some(1.0));
        assert!(of_series(Path::new("s"), "{}").is_err());
        assert!(time_of("nan").is_err());
    }

    #[test]
    fn a_folder_is_answered_by_its_collection_or_a_pattern_and_a_step_by_what_lists_it() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = folder.path();
        let write = |name: &str, text: &str| std::fs::write(at.join(name), text).expect("a file");
        assert!(of_folder(at).contains("a folder without"));
        write("a_1.vtk", "");
        assert!(of_folder(at).ends_with("/*.vtk' with the quotes for all of this kind"), "{}", of_folder(at));
        assert_eq!(collection_of(&at.join("a_1.vtu")), None);
        write("a_1.pvd", "<DataSet file=\"a_1.vtu\"/>");
        write(
            "all.pvd",
            "<DataSet timestep=\"1\" file=\"a_1.vtu\"/><DataSet timestep=\"2\" file=\"a_2.vtu\"/>",
        );
        assert_eq!(collection_of(&at.join("a_1.vtu")), Some(at.join("all.pvd")));
        assert_eq!(collection_of(&at.join("b.vtu")), None);
        assert!(of_folder(at).contains("the collection in it, ") && of_folder(at).ends_with("a_1.pvd"));
    }
}
