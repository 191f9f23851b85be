//! From a file to its states: its kind, the states that it holds or refers to, and how each is read.

use crate::bytes::Budget;
use crate::collections::{Member, of_blocks, of_folder, of_pieces, of_pvd, of_series};
use crate::frame::{Frame, Wanted};
use crate::hdf5::Store;
use crate::{ImportError, gmsh, input_file, legacy_vtk, numpy, unread, vtu, xdmf, xml};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Deepest nesting of collections.
const DEEPEST: usize = 8;
/// Bytes at the start of a file by which it is recognised.
const LOOK: usize = 4096;
/// First bytes of HDF5.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Most files that a collection may name.
pub(crate) const MOST: usize = 100_000;

/// Kind of a file, by its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Text with one row per line.
    Table,
    /// VTK's XML of points and cells.
    Vtu,
    /// VTK's legacy format.
    LegacyVtk,
    /// PVD: files with their times.
    Collection,
    /// Files with their times, in JSON.
    Series,
    /// `.vtm`: files of one time.
    Blocks,
    /// `.pvtu`, `.pvtp`: pieces of one state, as parallel programs write them.
    Pieces,
    /// gmsh's mesh with data.
    Gmsh,
    /// gmsh's views.
    GmshViews,
    /// A zip of `NumPy` arrays.
    Npz,
    /// A `NumPy` array.
    Npy,
    /// HDF5.
    Hdf5,
    /// XDMF.
    Xdmf,
}

impl Kind {
    /// The kind of a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn of(path: &Path) -> Result<Self, ImportError> {
        let io = ImportError::io(path);
        let about = std::fs::metadata(path).map_err(&io)?;
        if about.is_dir() {
            return Err(ImportError::content(path, of_folder(path)));
        }
        let head = input_file::head(path, LOOK).map_err(&io)?;
        let kind = Self::of_head(&head);
        match unread::named(&head, kind) {
            Some(why) => Err(ImportError::content(path, why)),
            None => Ok(kind),
        }
    }

    /// The kind of a file that begins with these bytes.
    pub(crate) fn of_head(head: &[u8]) -> Self {
        // Behind a block of the user's, as of MATLAB 7.3, which is as long as some power of two.
        let is_hdf5 = |from: &usize| head.get(*from..).is_some_and(|rest| rest.starts_with(HDF5));
        if [0, 512, 1024, 2048].iter().any(is_hdf5) {
            return Self::Hdf5;
        }
        if head.starts_with(b"PK\x03\x04") || head.starts_with(b"PK\x05\x06") {
            return Self::Npz;
        }
        if head.starts_with(b"\x93NUMPY") {
            return Self::Npy;
        }
        if head.starts_with(b"# vtk DataFile") {
            return Self::LegacyVtk;
        }
        if head.starts_with(b"$MeshFormat") {
            return Self::Gmsh;
        }
        let text = String::from_utf8_lossy(head);
        let text = text.trim_start_matches('\u{feff}').trim_start();
        if gmsh::are_views(text) {
            return Self::GmshViews;
        }
        if text.starts_with('{') && text.contains("\"files\"") {
            return Self::Series;
        }
        if !text.starts_with('<') {
            return Self::Table;
        }
        if text.contains("<Xdmf") {
            return Self::Xdmf;
        }
        match text.split_once("<VTKFile") {
            Some((_, rest)) => {
                let tag = rest.split('>').next().unwrap_or_default();
                if tag.contains("vtkMultiBlockDataSet") {
                    Self::Blocks
                } else if tag.contains("\"Collection\"") {
                    Self::Collection
                } else if ["\"PUnstructuredGrid\"", "\"PPolyData\""].iter().any(|kind| tag.contains(kind)) {
                    Self::Pieces
                } else {
                    Self::Vtu
                }
            }
            None => Self::Table,
        }
    }
}

/// One state of a result: a file, or a place in one.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The file.
    pub file: PathBuf,
    /// Its kind.
    pub kind: Kind,
    /// Its place among the states of the file.
    pub place: usize,
    /// Its time, if it is known before the state is read.
    pub time: Option<f64>,
    /// The file that the user gave: a collection, or the file itself.
    pub named: PathBuf,
    /// Further files of this state, which a collection lists as its parts.
    pub others: Vec<PathBuf>,
}

/// Lists the states of a file; notes say what is left out.
///
/// # Errors
/// When a file cannot be read, or a collection is damaged or refers to itself.
pub fn steps_of(path: &Path, notes: &mut Vec<String>) -> Result<Vec<Step>, ImportError> {
    let mut listing = Listing { above: vec![path.to_owned()], looked_at: 0, steps: Vec::new(), notes };
    listing.list(path, None)?;
    let mut steps = listing.steps;
    for step in &mut steps {
        path.clone_into(&mut step.named);
    }
    Ok(steps)
}

/// States found so far.
struct Listing<'a> {
    /// Collections that are being read, each referred to by the one before it.
    above: Vec<PathBuf>,
    /// Files looked at, whatever they hold.
    looked_at: usize,
    steps: Vec<Step>,
    notes: &'a mut Vec<String>,
}

impl Listing<'_> {
    fn list(&mut self, path: &Path, time: Option<f64>) -> Result<(), ImportError> {
        let refused = |why: String| ImportError::content(path, why);
        let kind = Kind::of(path)?;
        let step = |place: usize, time: Option<f64>| Step {
            file: path.to_owned(),
            kind,
            place,
            time,
            named: PathBuf::new(),
            others: Vec::new(),
        };
        self.looked_at += 1;
        if self.looked_at > MOST {
            return Err(refused(format!("it refers to more than {MOST} files")));
        }
        let members = match kind {
            Kind::Collection => of_pvd(path, &read_text(path)?).map_err(refused)?,
            Kind::Series => of_series(path, &read_text(path)?).map_err(refused)?,
            Kind::Hdf5 => {
                let times = Store::open(path).and_then(|mut store| store.times()).map_err(refused)?;
                self.steps.extend(times.iter().enumerate().map(|(place, own)| step(place, own.or(time))));
                return Ok(());
            }
            Kind::Xdmf => {
                let text = read_text(path)?;
                let times =
                    xml::parse(&text).and_then(|document| xdmf::times_of(&document)).map_err(refused)?;
                self.steps.extend(times.iter().enumerate().map(|(place, own)| step(place, own.or(time))));
                return Ok(());
            }
            _ => {
                self.steps.push(step(0, time));
                return Ok(());
            }
        };
        self.members(path, time, &members)
    }

    /// Lists the states of the files in a collection.
    fn members(&mut self, path: &Path, time: Option<f64>, members: &[Member]) -> Result<(), ImportError> {
        let refused = |why: String| ImportError::content(path, why);
        let (mut absent, mut twice) = (0, 0);
        let mut seen: HashMap<&Path, Option<f64>> = HashMap::new();
        // Places among the steps of the first part of a state, by its time.
        let mut first_parts: HashMap<u64, (&str, usize)> = HashMap::new();
        for Member { file, time: own, part } in members {
            if self.above.contains(file) || self.above.len() > DEEPEST {
                return Err(refused(format!("it refers to {}, which refers back to it", file.display())));
            }
            match seen.insert(file, *own) {
                Some(other) if other == *own => {
                    twice += 1;
                    continue;
                }
                Some(_) => {
                    let why = format!("it lists {} at two times, but a state has only one", file.display());
                    return Err(refused(why));
                }
                None => {}
            }
            if !file.is_file() {
                absent += 1;
                continue;
            }
            let first = own.and_then(|own| first_parts.get(&own.to_bits()).copied());
            if let Some((other, place)) = first
                && other != part
            {
                self.looked_at += 1;
                self.steps[place].others.push(file.clone());
                continue;
            }
            self.above.push(file.clone());
            let before = self.steps.len();
            self.list(file, own.or(time))?;
            self.above.pop();
            if let Some(own) = own.filter(|_| self.steps.len() == before + 1) {
                first_parts.entry(own.to_bits()).or_insert((part, before));
            }
        }
        if absent == members.len() {
            return Err(refused(format!("none of its {absent} files is there")));
        }
        let all = members.len();
        for (count, what) in [(absent, "are missing and left out"), (twice, "are listed twice and read once")]
        {
            if count > 0 {
                let path = path.display();
                self.notes.push(format!("{path}: {count} of its {all} files {what}"));
            }
        }
        Ok(())
    }
}

/// Total size of files in bytes, each counted once.
fn size_of_all(files: &[PathBuf]) -> usize {
    let once: HashSet<&PathBuf> = files.iter().collect();
    let size = |file: &PathBuf| std::fs::metadata(file).map_or(0, |metadata| metadata.len());
    usize::try_from(once.into_iter().map(size).sum::<u64>()).unwrap_or(usize::MAX)
}

fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    input_file::read(path).map_err(ImportError::io(path))
}

/// The text of a file; invalid UTF-8 is replaced.
pub(crate) fn read_text(path: &Path) -> Result<String, ImportError> {
    let bytes = read(path)?;
    Ok(String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned()))
}

/// Reads states one after the other and hands each over. A file with several states is opened once for all that follow
/// each other.
///
/// # Errors
/// When a file is damaged, cut or claims too much memory, and what `take` returns.
pub fn read_states(
    steps: &[Step],
    wanted: Wanted,
    take: &mut dyn FnMut(&Step, Frame) -> Result<(), ImportError>,
) -> Result<(), ImportError> {
    for steps in steps.chunk_by(|one, next| one.file == next.file) {
        let path = steps[0].file.as_path();
        let refused = |why: String| ImportError::content(path, why);
        match steps[0].kind {
            Kind::Hdf5 => {
                let mut store = Store::open(path).map_err(refused)?;
                for step in steps {
                    take(step, store.frame(step.place, wanted).map_err(refused)?)?;
                }
            }
            Kind::Xdmf => {
                let text = read_text(path)?;
                let document = xml::parse(&text).map_err(refused)?;
                let mut reader = xdmf::Reader::of(path, &document).map_err(refused)?;
                for step in steps {
                    take(step, reader.frame(step.place, wanted).map_err(refused)?)?;
                }
            }
            _ => {
                for step in steps {
                    take(step, single_state(step, wanted)?)?;
                }
            }
        }
    }
    Ok(())
}

/// Reads a state in one file, or in parts that a collection lists.
fn single_state(step: &Step, wanted: Wanted) -> Result<Frame, ImportError> {
    if step.others.is_empty() {
        return state_of(&step.file, step.kind, wanted, 0, &mut None);
    }
    let files = [std::slice::from_ref(&step.file), &step.others[..]].concat();
    parts_of(&step.named, files, true, wanted, 1, &mut None)
}

/// Reads a file with one state; what it refers to shares the memory that all these files may take.
fn state_of(
    path: &Path,
    kind: Kind,
    wanted: Wanted,
    depth: usize,
    budget: &mut Option<Budget>,
) -> Result<Frame, ImportError> {
    let refused = |why: String| ImportError::content(path, why);
    let frame = match kind {
        Kind::Vtu => vtu::read(&read(path)?, wanted),
        Kind::LegacyVtk => legacy_vtk::read(&read(path)?, wanted),
        Kind::Npz => numpy::read_npz(&read(path)?, wanted),
        Kind::Npy => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            numpy::read_npy(&read(path)?, &name, wanted)
        }
        Kind::Gmsh => gmsh::read_mesh(&read(path)?, wanted),
        Kind::GmshViews => gmsh::read_views(&read(path)?, wanted),
        Kind::Blocks => {
            let files = of_blocks(path, &read_text(path)?).map_err(refused)?;
            let mut seen = HashSet::new();
            if let Some(twice) = files.iter().find(|file| !seen.insert(*file)) {
                return Err(refused(format!("it lists the block {} twice", twice.display())));
            }
            return parts_of(path, files, true, wanted, depth + 1, budget);
        }
        Kind::Pieces => {
            let mut files = of_pieces(path, &read_text(path)?).map_err(refused)?;
            let all = files.len();
            let mut seen = HashSet::new();
            files.retain(|file| seen.insert(file.clone()));
            let mut frame = parts_of(path, files, false, wanted, depth + 1, budget)?;
            if seen.len() < all {
                let twice = all - seen.len();
                frame.notes.push(format!(
                    "{}: {twice} of its {all} pieces are listed twice and read once",
                    path.display()
                ));
            }
            return Ok(frame);
        }
        Kind::Table | Kind::Collection | Kind::Series | Kind::Hdf5 | Kind::Xdmf => {
            Err("it holds no arrays".to_owned())
        }
    };
    let mut frame = frame.map_err(refused)?;
    frame.leave_out_ghosts().map_err(refused)?;
    Ok(frame)
}

/// Joins the files of one state. Of blocks those of the highest dimension: loads on edges are blocks too, and repeat
/// points. All files together, however deep, share the memory that they may take.
fn parts_of(
    path: &Path,
    files: Vec<PathBuf>,
    are_blocks: bool,
    wanted: Wanted,
    depth: usize,
    budget: &mut Option<Budget>,
) -> Result<Frame, ImportError> {
    let refused = |why: String| ImportError::content(path, why);
    if depth > DEEPEST {
        return Err(refused("its files refer to each other".to_owned()));
    }
    let mut parts = Vec::new();
    if budget.is_none() {
        *budget = Some(Budget::of_file(size_of_all(&files)));
    }
    for file in files {
        // An empty part takes time all the same.
        let least = 1 << 12;
        let frame = state_of(&file, Kind::of(&file)?, wanted, depth, budget)?;
        let taken = budget.as_mut().map_or(Ok(()), |budget| budget.take(frame.bytes().max(least)));
        taken.map_err(refused)?;
        parts.push((file, frame));
    }
    let dimension = |frame: &Frame| frame.cells.as_ref().map_or(0, |cells| cells.dimension() + 1);
    let highest = parts.iter().map(|(_, frame)| dimension(frame)).max().unwrap_or(0);
    let mut whole: Option<Frame> = None;
    let mut notes = Vec::new();
    for (file, frame) in parts {
        if are_blocks && dimension(&frame) < highest {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            notes.push(format!("left out the block {name}: its cells are edges or faces of other blocks"));
            continue;
        }
        match &mut whole {
            Some(whole) => whole.append(frame).map_err(refused)?,
            None => whole = Some(frame),
        }
    }
    let what = if are_blocks { "block" } else { "piece" };
    let mut whole = whole.ok_or_else(|| refused(format!("it has no {what}")))?;
    whole.notes.extend(notes);
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_has_the_time_of_the_innermost_collection_that_gives_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
        for name in ["a", "b", "c", "d"] {
            write(name, "x\n0\n");
        }
        let collection = |name: &str, sets: &str| {
            write(name, &format!("<VTKFile type=\"Collection\"><Collection>{sets}</Collection></VTKFile>"));
        };
        let set = |file: &str, time: &str| format!("<DataSet timestep=\"{time}\" file=\"{file}\"/>");
        let series = "{\"files\": [{\"name\": \"d\", \"time\": 4}]}";
        write("series", series);
        collection("inner", &[set("a", "1"), set("b", "2"), set("c", "")].concat());
        for (outer, wanted) in [
            ([("inner", "9"), ("series", "8")], [Some(1.0), Some(2.0), Some(9.0), Some(4.0)]),
            ([("inner", ""), ("series", "")], [Some(1.0), Some(2.0), None, Some(4.0)]),
            ([("inner", "0"), ("d", "7")], [Some(1.0), Some(2.0), Some(0.0), Some(7.0)]),
            ([("inner", ""), ("d", "")], [Some(1.0), Some(2.0), None, None]),
        ] {
            collection("outer", &outer.map(|(file, time)| set(file, time)).concat());
            let steps = steps_of(&folder.path().join("outer"), &mut Vec::new()).expect("states");
            let times: Vec<_> = steps.iter().map(|step| step.time).collect();
            assert_eq!(times, wanted, "{outer:?}");
        }
    }
}
