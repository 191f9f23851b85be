//! What to name instead, where a user named what cannot be scored: a folder, one step of many, files of another program.

use crate::frame::Frame;
use crate::input_file;
use std::path::{Path, PathBuf};

/// Entries of a folder that are looked at.
const MOST_ENTRIES: usize = 10_000;
/// Largest collection that is searched for a name, bytes.
const LARGEST: u64 = 1 << 20;
/// Endings of files that list others, the best to name first.
const COLLECTIONS: [&str; 3] = ["pvd", "series", "xdmf"];
/// Endings of files with a state each.
const STATES: [&str; 8] = ["vtu", "vtk", "vtp", "npz", "npy", "h5", "hdf5", "csv"];
/// Arrays by which the files of a program are told, with its preset; the first that fits.
const SIGNS: [(&str, &str); 7] = [
    ("WATER_PRESSURE", "kratos"),
    ("OGS_VERSION", "ogs"),
    ("pressure_interpolated", "ogs"),
    ("t_current", "geotaichi"),
    ("estress", "geotaichi"),
    ("mortar_side", "porepy"),
    ("subdomain_id", "porepy"),
];

/// The preset of the program that writes arrays of such names; none where nothing tells.
pub fn program_of(frame: &Frame) -> Option<&'static str> {
    let has = |name: &str| frame.arrays.iter().any(|array| array.name == name);
    SIGNS.iter().find_map(|(name, preset)| has(name).then_some(*preset))
}

/// A sentence on a folder that was named in the place of its files.
pub fn of_folder(folder: &Path) -> String {
    let files = files_of(folder);
    let first = |endings: &[&'static str]| {
        let of = |ending: &&'static str| Some((*ending, files.iter().find(|file| ends_with(file, ending))?));
        endings.iter().find_map(of)
    };
    if let Some((_, collection)) = first(&COLLECTIONS) {
        return format!("it is a folder: name the collection in it, {}", collection.display());
    }
    match first(&STATES) {
        Some((ending, _)) => {
            let pattern = folder.join(format!("*.{ending}"));
            format!(
                "it is a folder: name its files, '{}' with the quotes for all of a kind",
                pattern.display()
            )
        }
        None => "it is a folder, and no file in it is one of VTU, PVD, legacy VTK, NPZ, HDF5, XDMF or CSV"
            .to_owned(),
    }
}

/// The collection beside a file that names it, and with it its time.
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
    // Some programs write one collection a state and one of all: the largest has the times.
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
    fn a_folder_is_answered_by_its_collection_or_a_pattern_and_a_step_by_what_lists_it() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = folder.path();
        let write = |name: &str, text: &str| std::fs::write(at.join(name), text).expect("a file");
        assert!(of_folder(at).contains("no file in it"));
        write("a_1.vtk", "");
        assert!(of_folder(at).ends_with("/*.vtk' with the quotes for all of a kind"), "{}", of_folder(at));
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
