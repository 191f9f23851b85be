//! Files that name other files: PVD, `.vtm` of several blocks, and series in JSON.

use crate::xml::tree_of;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A file of a collection with the time that the collection gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The file, beside the collection.
    pub file: PathBuf,
    /// Its time, in the unit of the program that wrote it.
    pub time: Option<f64>,
}

/// A series as `ParaView` writes and reads it.
#[derive(Deserialize)]
struct Series {
    files: Vec<OfSeries>,
}

#[derive(Deserialize)]
struct OfSeries {
    name: String,
    time: f64,
}

/// Files of a PVD.
///
/// # Errors
/// When it is no sound XML, or a time is no number.
pub fn of_pvd(path: &Path, bytes: &[u8]) -> Result<Vec<Member>, String> {
    let root = tree_of(bytes)?;
    let mut sets = Vec::new();
    root.all("DataSet", &mut sets);
    let member = |set: &&crate::xml::Element| {
        let time = match set.attribute("timestep") {
            "" => None,
            typed => Some(time_of(typed)?),
        };
        Ok(Member { file: beside(path, set.attribute("file")), time })
    };
    sets.iter().map(member).collect()
}

/// Files of the blocks of a `.vtm`.
///
/// # Errors
/// When it is no sound XML.
pub fn of_blocks(path: &Path, bytes: &[u8]) -> Result<Vec<PathBuf>, String> {
    let root = tree_of(bytes)?;
    let mut sets = Vec::new();
    root.all("DataSet", &mut sets);
    let files = sets.iter().map(|set| set.attribute("file")).filter(|file| !file.is_empty());
    Ok(files.map(|file| beside(path, file)).collect())
}

/// Files of a series.
///
/// # Errors
/// When it is no such JSON.
pub fn of_series(path: &Path, bytes: &[u8]) -> Result<Vec<Member>, String> {
    let series: Series =
        serde_json::from_slice(bytes).map_err(|error| format!("it is no series of files: {error}"))?;
    Ok(series
        .files
        .into_iter()
        .map(|one| Member { file: beside(path, &one.name), time: Some(one.time) })
        .collect())
}

/// A time as typed in a collection.
///
/// # Errors
/// When it is no finite number.
pub fn time_of(typed: &str) -> Result<f64, String> {
    let time = typed.trim().parse().ok().filter(|time: &f64| time.is_finite());
    time.ok_or_else(|| format!("the time `{typed}` is no finite number"))
}

/// A file that another one names.
pub fn beside(path: &Path, name: &str) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collections_name_files_and_times() {
        let pvd = br#"<VTKFile type="Collection"><Collection><DataSet timestep="4.5" part="" file="a.vtu"/>
            <DataSet file="b.vtu"/></Collection></VTKFile>"#;
        let members = of_pvd(Path::new("in/col.pvd"), pvd).expect("a collection");
        assert_eq!(members[0], Member { file: PathBuf::from("in/a.vtu"), time: Some(4.5) });
        assert_eq!(members[1].time, None);
        let series = br#"{"file-series-version":"1.0","files":[{"name":"c.vtm","time":1e0}]}"#;
        assert_eq!(of_series(Path::new("s"), series).expect("a series")[0].time, Some(1.0));
        assert!(of_series(Path::new("s"), b"{}").is_err());
        assert!(time_of("nan").is_err());
    }
}
