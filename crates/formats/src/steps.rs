//! From a file to its states: what kind it is, which states it holds or names, and one of them read.

use crate::bytes::Budget;
use crate::collections::{Member, of_blocks, of_pvd, of_series};
use crate::frame::{Frame, Wanted};
use crate::hdf5::Store;
use crate::hints::of_folder;
use crate::import_error::ImportError;
use crate::input_file;
use crate::xdmf::Document;
use crate::{legacy_vtk, numpy, vtu};
use std::collections::{HashMap, HashSet};
use std::io::Read;
use std::path::{Path, PathBuf};

/// How far files may name files.
const DEEPEST: usize = 8;
/// Bytes by which a file is recognised.
const LOOK: u64 = 4096;
/// Most files that a collection may name.
const MOST: usize = 100_000;

/// Kind of a file, by its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rows of a text.
    Table,
    /// VTK's XML of points and cells.
    Vtu,
    /// VTK's legacy format.
    LegacyVtk,
    /// PVD: files by times.
    Collection,
    /// Files by times, in JSON.
    Series,
    /// `.vtm`: files of one time.
    Blocks,
    /// A zip of arrays of `NumPy`.
    Npz,
    /// An array of `NumPy`.
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
        let io = |source| ImportError::Io { path: path.to_owned(), source };
        let mut head = Vec::new();
        let about = std::fs::metadata(path).map_err(io)?;
        if about.is_dir() {
            return Err(ImportError::table(path, of_folder(path)));
        }
        input_file::open(path).map_err(io)?.take(LOOK).read_to_end(&mut head).map_err(io)?;
        Ok(Self::of_head(&head))
    }

    /// The kind of what begins so.
    pub fn of_head(head: &[u8]) -> Self {
        if head.starts_with(b"\x89HDF\r\n\x1a\n") {
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
        let text = String::from_utf8_lossy(head);
        let text = text.trim_start_matches('\u{feff}').trim_start();
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
    /// Its time, where something tells it before the state is read.
    pub time: Option<f64>,
    /// The file that the user named: a collection, or the file itself.
    pub named: PathBuf,
}

/// All states of a file, with what is to be said of them.
///
/// # Errors
/// What cannot be read.
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
    /// Collections that are being read, each named by the one before it.
    above: Vec<PathBuf>,
    /// Files looked at, whatever they held.
    looked_at: usize,
    steps: Vec<Step>,
    notes: &'a mut Vec<String>,
}

impl Listing<'_> {
    fn list(&mut self, path: &Path, time: Option<f64>) -> Result<(), ImportError> {
        let refused = |why: String| ImportError::table(path, why);
        let kind = Kind::of(path)?;
        let step = |place: usize, time: Option<f64>| Step {
            file: path.to_owned(),
            kind,
            place,
            time,
            named: PathBuf::new(),
        };
        self.looked_at += 1;
        if self.looked_at > MOST {
            return Err(refused(format!("it names more than {MOST} files")));
        }
        let members = match kind {
            Kind::Collection => of_pvd(path, &read(path)?).map_err(refused)?,
            Kind::Series => of_series(path, &read(path)?).map_err(refused)?,
            Kind::Hdf5 => {
                let times = Store::open(path).and_then(|mut store| store.times()).map_err(refused)?;
                let of_place = |(place, own): (usize, &f64)| step(place, Some(*own));
                self.steps.extend(times.iter().enumerate().map(of_place));
                self.steps.extend(times.is_empty().then(|| step(0, time)));
                return Ok(());
            }
            Kind::Xdmf => {
                let times =
                    Document::of(path, &read(path)?).and_then(|file| file.times()).map_err(refused)?;
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

    /// The states of the files that a collection names.
    fn members(&mut self, path: &Path, time: Option<f64>, members: &[Member]) -> Result<(), ImportError> {
        let refused = |why: String| ImportError::table(path, why);
        let (mut absent, mut twice) = (0, 0);
        let mut seen: HashMap<&Path, Option<f64>> = HashMap::new();
        for Member { file, time: own } in members {
            if self.above.contains(file) || self.above.len() > DEEPEST {
                return Err(refused(format!("it names {}, which names it again", file.display())));
            }
            match seen.insert(file, *own) {
                Some(other) if other == *own => {
                    twice += 1;
                    continue;
                }
                Some(_) => {
                    let why = format!("it names {} at two times: one state has one time", file.display());
                    return Err(refused(why));
                }
                None => {}
            }
            if !file.is_file() {
                absent += 1;
                continue;
            }
            self.above.push(file.clone());
            self.list(file, own.or(time))?;
            self.above.pop();
        }
        if absent == members.len() {
            return Err(refused(format!("none of the {absent} files that it names is there")));
        }
        let all = members.len();
        for (count, what) in
            [(absent, "are not there, and left out"), (twice, "are named twice, and read once")]
        {
            if count > 0 {
                let path = path.display();
                self.notes.push(format!("{path}: {count} of the {all} files that it names {what}"));
            }
        }
        Ok(())
    }
}

/// Bytes of files together, each once.
fn size_of_all(files: &[PathBuf]) -> usize {
    let once: HashSet<&PathBuf> = files.iter().collect();
    let size = |file: &PathBuf| std::fs::metadata(file).map_or(0, |told| told.len());
    usize::try_from(once.into_iter().map(size).sum::<u64>()).unwrap_or(usize::MAX)
}

fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    input_file::read(path).map_err(|source| ImportError::Io { path: path.to_owned(), source })
}

/// Reads states one after the other. A document or a store of many states is read once for all that follow each other,
/// for a state takes a small part of it.
#[derive(Default)]
pub struct Frames {
    open: Option<(PathBuf, Opened)>,
    /// How many documents and stores were read.
    pub opened: usize,
}

/// A file of several states.
enum Opened {
    Hdf5(Store),
    Xdmf(Document),
}

impl Frames {
    /// Reads a state.
    ///
    /// # Errors
    /// What is damaged, cut or claims too much.
    pub fn frame(&mut self, step: &Step, wanted: Wanted) -> Result<Frame, ImportError> {
        let path = step.file.as_path();
        let refused = |why: String| ImportError::table(path, why);
        if !matches!(step.kind, Kind::Hdf5 | Kind::Xdmf) {
            return frame_of(step, wanted);
        }
        let (file, mut opened) = if let Some(open) = self.open.take().filter(|(file, _)| file == path) {
            open
        } else {
            self.opened += 1;
            let opened = if step.kind == Kind::Hdf5 {
                Opened::Hdf5(Store::open(path).map_err(refused)?)
            } else {
                Opened::Xdmf(Document::of(path, &read(path)?).map_err(refused)?)
            };
            (path.to_owned(), opened)
        };
        let frame = match &mut opened {
            Opened::Hdf5(store) => store.frame(step.place, wanted),
            Opened::Xdmf(document) => document.frame(step.place, wanted),
        };
        self.open = Some((file, opened));
        frame.map_err(refused)
    }
}

/// Reads a state.
///
/// # Errors
/// What is damaged, cut or claims too much.
pub fn frame_of(step: &Step, wanted: Wanted) -> Result<Frame, ImportError> {
    let path = step.file.as_path();
    let refused = |why: String| ImportError::table(path, why);
    match step.kind {
        Kind::Vtu => vtu::read_file(path, wanted).map_err(refused),
        Kind::LegacyVtk => legacy_vtk::read(&read(path)?, wanted).map_err(refused),
        Kind::Npz => numpy::read_npz(&read(path)?, wanted).map_err(refused),
        Kind::Npy => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            numpy::read_npy(&read(path)?, &name, wanted).map_err(refused)
        }
        Kind::Hdf5 | Kind::Xdmf => Frames::default().frame(step, wanted),
        Kind::Blocks => blocks(path, wanted, 0, &mut None),
        Kind::Table | Kind::Collection | Kind::Series => Err(refused("it holds no arrays".to_owned())),
    }
}

/// The blocks of the highest dimension, joined: loads on edges are blocks too, and repeat points. All blocks
/// together, however deep, have the memory that their files may take.
fn blocks(
    path: &Path,
    wanted: Wanted,
    depth: usize,
    budget: &mut Option<Budget>,
) -> Result<Frame, ImportError> {
    let refused = |why: String| ImportError::table(path, why);
    if depth > DEEPEST {
        return Err(refused("its blocks name each other".to_owned()));
    }
    let mut parts = Vec::new();
    let files = of_blocks(path, &read(path)?).map_err(refused)?;
    if budget.is_none() {
        *budget = Some(Budget::of_file(size_of_all(&files)));
    }
    let mut seen = HashSet::new();
    for file in files {
        if !seen.insert(file.clone()) {
            return Err(refused(format!("it names the block {} twice", file.display())));
        }
        // A block that holds nothing takes time all the same.
        let least = 1 << 12;
        let kind = Kind::of(&file)?;
        let frame = match kind {
            Kind::Blocks => blocks(&file, wanted, depth + 1, budget)?,
            Kind::Collection | Kind::Series | Kind::Table => {
                return Err(refused(format!("the block {} holds no arrays", file.display())));
            }
            _ => {
                let step = Step { file: file.clone(), kind, place: 0, time: None, named: PathBuf::new() };
                frame_of(&step, wanted)?
            }
        };
        let taken = budget.as_mut().map_or(Ok(()), |budget| budget.take(frame.bytes().max(least)));
        taken.map_err(refused)?;
        parts.push((file, frame));
    }
    let dimension = |frame: &Frame| frame.cells.as_ref().map_or(0, |cells| cells.dimension() + 1);
    let highest = parts.iter().map(|(_, frame)| dimension(frame)).max().unwrap_or(0);
    let mut whole: Option<Frame> = None;
    let mut notes = Vec::new();
    for (file, frame) in parts {
        if dimension(&frame) < highest {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            notes.push(format!("left out the block {name}: its cells are edges or faces of others"));
            continue;
        }
        match &mut whole {
            Some(whole) => whole.append(frame).map_err(refused)?,
            None => whole = Some(frame),
        }
    }
    let mut whole = whole.ok_or_else(|| refused("it names no block".to_owned()))?;
    whole.notes.extend(notes);
    Ok(whole)
}
