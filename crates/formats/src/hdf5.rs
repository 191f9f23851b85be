//! HDF5: data sets by their paths, with a list of times if there is one, and tables of records. Layouts of programs
//! have separate files: `exodus`, `pflotran`, `vtkhdf`.
//!
//! The groups are walked once and the data sets kept: the library would walk a group again for each path.

use crate::bytes::{Budget, Scalar};
use crate::frame::{Array, Association, Frame, PLACES, Wanted};
use crate::{exodus, input_file, pflotran, vtkhdf};
use hdf5_pure::{ChunkCacheConfig, Dataset, Datatype, DatatypeByteOrder, File, FileAccessProperties, Group};
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

/// Data sets that list the times.
const TIMES: [&str; 2] = ["times", "time"];

/// Fields of a record that are its place.
const PLACE: [&str; 3] = ["coord_x", "coord_y", "coord_z"];
/// Deepest group that is looked into.
const DEEPEST: usize = 16;
/// Most data sets and groups of a file that are looked at.
const MOST: usize = 200_000;
/// Most data sets that are read as one state.
const MOST_OF_A_STATE: usize = 10_000;

/// How the data sets of a file belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    /// Each by itself.
    Plain,
    Exodus,
    Pflotran,
    VtkHdf,
}

/// An open file.
pub(crate) struct Store {
    path: PathBuf,
    layout: Layout,
    sets: Vec<Listed>,
    /// Places in the list by path.
    by_path: HashMap<String, usize>,
    /// Data sets and groups that were listed.
    pub(super) listed: usize,
    size: usize,
    budget: Budget,
}

/// A data set with its path.
struct Listed {
    path: String,
    shape: Vec<u64>,
    set: Dataset,
}

impl Store {
    /// Opens a file.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let bytes = input_file::read(path).map_err(|error| error.to_string())?;
        let size = bytes.len();
        // Without a cache of unpacked chunks: each data set has its own, and there may be thousands.
        let pieces = ChunkCacheConfig::new().with_max_bytes(0).with_max_slots(0);
        let access = FileAccessProperties::new().with_chunk_cache(pieces);
        let file = File::from_bytes_with_options(bytes, access).map_err(|error| damaged(&error))?;
        let mut store = Self {
            path: path.to_owned(),
            layout: Layout::Plain,
            sets: Vec::new(),
            by_path: HashMap::new(),
            listed: 0,
            size,
            budget: Budget::of_file(size),
        };
        store.list(&file.root(), "", 0)?;
        store.by_path = store.sets.iter().enumerate().map(|(place, set)| (set.path.clone(), place)).collect();
        store.layout = match () {
            () if exodus::is_layout(&store) => Layout::Exodus,
            () if vtkhdf::is_layout(&store) => Layout::VtkHdf,
            () if pflotran::is_layout(&store) => Layout::Pflotran,
            () => Layout::Plain,
        };
        Ok(store)
    }

    /// Whether the file has a data set.
    pub fn has(&self, path: &str) -> bool {
        self.by_path.contains_key(path)
    }

    /// Lengths of the axes of a data set.
    pub fn shape(&self, path: &str) -> Option<&[u64]> {
        self.by_path.get(path).and_then(|place| self.sets.get(*place)).map(|set| &set.shape[..])
    }

    /// Paths of all data sets.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.sets.iter().map(|set| set.path.as_str())
    }

    /// The texts of a data set of letters, one per row, without what fills them up.
    pub(crate) fn texts(&mut self, path: &str) -> Result<Vec<String>, String> {
        let named = |why: String| format!("the data set `{path}`: {why}");
        let known = self.by_path.get(path).and_then(|place| self.sets.get(*place));
        let Listed { shape, set, .. } = known.ok_or_else(|| named("the file does not have it".to_owned()))?;
        let width = set.element_size().map_err(|error| named(damaged(&error)))?;
        let total = product(shape).map_err(named)?.saturating_mul(width);
        self.budget.take(total).map_err(named)?;
        let bytes = set.read_raw().map_err(|error| named(damaged(&error)))?;
        let rows = usize::try_from(shape.first().copied().unwrap_or(1)).unwrap_or(0);
        let length = bytes.len().checked_div(rows).unwrap_or(0).max(1);
        let text = |row: &[u8]| {
            let end = row.iter().position(|symbol| *symbol == 0).unwrap_or(row.len());
            String::from_utf8_lossy(&row[..end]).trim().to_owned()
        };
        Ok(bytes.chunks_exact(length).map(text).collect())
    }

    /// Renews the memory budget for another state.
    pub fn renew_budget(&mut self) {
        self.budget = Budget::of_file(self.size);
    }

    /// The numbers of a data set, of all rows or of a first one and a count.
    pub(crate) fn numbers(&mut self, path: &str, rows: Option<(u64, u64)>) -> Result<Vec<f64>, String> {
        let named = |why: String| format!("the data set `{path}`: {why}");
        let known = self.by_path.get(path.trim_matches('/'));
        let listed = known.and_then(|place| self.sets.get(*place));
        let Listed { shape, set, .. } =
            listed.ok_or_else(|| named("the file does not have it".to_owned()))?;
        let per_row = product(shape.get(1..).unwrap_or_default()).map_err(named)?;
        let (first, count) = rows.unwrap_or((0, shape.first().copied().unwrap_or(1)));
        let total = per_row
            .checked_mul(count)
            .ok_or_else(|| named("it declares more than it can hold".to_owned()))?;
        let width = set.element_size().map_err(|error| named(damaged(&error)))?.max(8);
        self.budget.take(total.saturating_mul(width)).map_err(named)?;
        let numbers = match rows {
            Some(_) => set.read_f64_rows(first, count),
            None => set.read_f64(),
        };
        let mut numbers = numbers.map_err(|error| named(damaged(&error)))?;
        let packing = Packing::of(set);
        if packing != Packing::default() {
            for number in &mut numbers {
                *number = packing.value(*number);
            }
        }
        if numbers.len() as u64 != total {
            return Err(named(format!("it holds {} numbers, and {total} are declared", numbers.len())));
        }
        Ok(numbers)
    }

    /// The states of the file, each with its time if the file's layout gives it one. A file without such a layout is one
    /// state, whose arrays may run over the times that it lists.
    pub(crate) fn times(&mut self) -> Result<Vec<Option<f64>>, String> {
        match self.layout {
            Layout::Plain => Ok(vec![None]),
            Layout::Exodus => exodus::times(self),
            Layout::Pflotran => Ok(pflotran::times(self)),
            Layout::VtkHdf => vtkhdf::times(self),
        }
    }

    /// A state by its place in the list of states.
    pub(crate) fn frame(&mut self, place: usize, wanted: Wanted) -> Result<Frame, String> {
        self.renew_budget();
        let mut frame = match self.layout {
            Layout::Plain => self.plain_frame(wanted),
            Layout::Exodus => exodus::frame(self, place, wanted),
            Layout::Pflotran => pflotran::frame(self, place, wanted),
            Layout::VtkHdf => vtkhdf::frame(self, place, wanted),
        }?;
        frame.leave_out_ghosts()?;
        Ok(frame)
    }

    /// All data sets, whole.
    fn plain_frame(&mut self, wanted: Wanted) -> Result<Frame, String> {
        if self.sets.len() > MOST_OF_A_STATE {
            return Err(format!(
                "it has more than {MOST_OF_A_STATE} data sets: name them with an XDMF beside it"
            ));
        }
        let mut frame = Frame::default();
        for number in 0..self.sets.len() {
            if self.records(number, wanted, &mut frame)? {
                continue;
            }
            let path = self.sets[number].path.clone();
            let Some(mut array) = self.array_of(number, path)? else { continue };
            let is_time = is_named(&array.name, &TIMES);
            if is_time || is_named(&array.name, &PLACES) || wanted.has(&array.name) {
                self.read_into(number, &mut array, &mut frame)?;
            }
            if is_time && frame.times.is_empty() {
                frame.times.clone_from(&array.values);
            }
            frame.arrays.push(array);
        }
        self.follow_links(wanted, &mut frame)?;
        if frame.arrays.is_empty() {
            return Err("it has no numbers".to_owned());
        }
        frame.place_from_array();
        Ok(frame)
    }

    /// A data set as an array of a name, without its values; none where it has no numbers.
    fn array_of(&self, number: usize, name: String) -> Result<Option<Array>, String> {
        let Listed { shape, set, .. } = &self.sets[number];
        if set.datatype().map_or(true, |kind| scalar_of(&kind).is_none()) {
            return Ok(None);
        }
        let count = |length: &u64| {
            usize::try_from(*length).map_err(|_| "it declares more than it can hold".to_owned())
        };
        let shape = shape.iter().map(count).collect::<Result<Vec<usize>, String>>()?;
        let too_much = || "its shape is larger than any file".to_owned();
        let components = shape.iter().skip(1).try_fold(1_usize, |all, axis| all.checked_mul(*axis));
        Ok(Some(Array {
            on: if shape.is_empty() { Association::Whole } else { Association::Points },
            components: components.ok_or_else(too_much)?.max(1),
            tuples: shape.first().copied().unwrap_or(1),
            values: Vec::new(),
            name,
            shape,
        }))
    }

    /// Reads the values of a data set into its array, and into a state what is said of them.
    fn read_into(&mut self, number: usize, array: &mut Array, frame: &mut Frame) -> Result<(), String> {
        let Packing { unit, fill, .. } = Packing::of(&self.sets[number].set);
        frame.units.extend(unit.map(|unit| (array.name.clone(), unit)));
        frame.fills.extend(fill.map(|fill| (array.name.clone(), fill)));
        let path = self.sets[number].path.clone();
        array.values = self.numbers(&path, None)?;
        Ok(())
    }

    /// Adds the wanted arrays that are links to files in the folder of this one, or below it.
    fn follow_links(&self, wanted: Wanted, frame: &mut Frame) -> Result<(), String> {
        for name in wanted.0.iter().filter(|name| !self.sets.iter().any(|set| is_named_as(&set.path, name))) {
            let link = name.rsplit('/').next().and_then(|name| linked(&self.path, name));
            let Some((file, path)) = link.filter(|(file, _)| is_below(file)) else { continue };
            let named = |why: String| format!("`{name}` is a link to `{path}` of {file}: {why}");
            let folder = self.path.parent().unwrap_or(Path::new(""));
            let mut other = Self::open(&folder.join(&file)).map_err(named)?;
            let number = other.by_path.get(path.trim_matches('/')).copied();
            let number = number.ok_or_else(|| named("it does not have it".to_owned()))?;
            if let Some(mut array) = other.array_of(number, name.clone()).map_err(named)? {
                other.read_into(number, &mut array, frame).map_err(named)?;
                frame.arrays.push(array);
            }
        }
        Ok(())
    }

    /// Adds the columns of a table of records; false if the set is not a table.
    fn records(&mut self, number: usize, wanted: Wanted, frame: &mut Frame) -> Result<bool, String> {
        let Listed { shape, set, .. } = &self.sets[number];
        let Ok(Datatype::Compound { size, members }) = set.datatype() else { return Ok(false) };
        let rows = product(shape)?;
        let tuples = usize::try_from(rows).map_err(|_| "it declares more than it can hold")?;
        let axis_of = |name: &str| PLACE.iter().position(|axis| *axis == name);
        let is_wanted = |name: &str| wanted.has(name) || axis_of(name).is_some();
        let any = members.iter().any(|member| is_wanted(&member.name));
        let bytes = if any {
            self.budget.take(rows.saturating_mul(u64::from(size)))?;
            set.read_raw().map_err(|error| damaged(&error))?
        } else {
            Vec::new()
        };
        for member in members {
            let Some((scalar, is_little)) = scalar_of(&member.datatype) else { continue };
            let mut array = Array {
                name: member.name,
                on: Association::Points,
                components: 1,
                tuples,
                values: Vec::new(),
                shape: Vec::new(),
            };
            if is_wanted(&array.name) {
                for record in bytes.chunks_exact((size as usize).max(1)) {
                    let field = field_of(record, member.byte_offset, scalar.size())?;
                    array.values.extend(scalar.decode(field, is_little));
                }
            }
            if let Some(axis) = axis_of(&array.name) {
                frame.coordinates.resize(tuples, [0.0; 3]);
                for (place, value) in frame.coordinates.iter_mut().zip(&array.values) {
                    place[axis] = *value;
                }
            }
            frame.arrays.push(array);
        }
        Ok(true)
    }

    /// Lists the data sets of a group and of the groups in it.
    fn list(&mut self, group: &Group, path: &str, depth: usize) -> Result<(), String> {
        for (name, set) in group.iter_datasets().map_err(|error| damaged(&error))? {
            self.count()?;
            let shape = set.shape().map_err(|error| damaged(&error))?;
            self.sets.push(Listed { path: format!("{path}{name}"), shape, set });
        }
        for (name, below) in group.iter_groups().map_err(|error| damaged(&error))? {
            self.count()?;
            if depth == DEEPEST {
                return Err(format!("it has groups deeper than {DEEPEST}"));
            }
            self.list(&below, &format!("{path}{name}/"), depth + 1)?;
        }
        Ok(())
    }

    fn count(&mut self) -> Result<(), String> {
        self.listed += 1;
        if self.listed > MOST { Err(format!("it has more than {MOST} data sets and groups")) } else { Ok(()) }
    }
}

/// What the attributes of a data set say of its numbers, as in netCDF ("Climate and Forecast conventions", 2.5 and 8.1).
#[derive(Clone, Debug, Default, PartialEq)]
struct Packing {
    unit: Option<String>,
    /// A number that stands for no value.
    fill: Option<f64>,
    scale: Option<f64>,
    offset: Option<f64>,
}

impl Packing {
    fn of(set: &Dataset) -> Self {
        let Ok(attributes) = set.attrs() else { return Self::default() };
        let number = |name: &str| {
            let value = attributes.get(name)?;
            value.as_f64().or_else(|| Some(value.as_i64()? as f64))
        };
        let unit = ["units", "unit"].iter().find_map(|name| attributes.get(*name)?.as_str());
        Self {
            unit: unit.map(str::trim).filter(|unit| !unit.is_empty()).map(str::to_owned),
            fill: number("_FillValue").or_else(|| number("missing_value")).filter(|fill| !fill.is_nan()),
            scale: number("scale_factor"),
            offset: number("add_offset"),
        }
    }

    /// The number that a stored one means.
    fn value(&self, stored: f64) -> f64 {
        if self.fill == Some(stored) {
            return f64::NAN;
        }
        let scaled = self.scale.map_or(stored, |scale| stored * scale);
        self.offset.map_or(scaled, |offset| scaled + offset)
    }
}

fn is_named(path: &str, names: &[&str]) -> bool {
    let name = path.rsplit('/').next().unwrap_or_default().to_ascii_lowercase();
    names.contains(&name.as_str())
}

fn product(shape: &[u64]) -> Result<u64, String> {
    let all = shape.iter().try_fold(1_u64, |all, one| all.checked_mul(*one));
    all.ok_or_else(|| "its shape is larger than any file".to_owned())
}

/// The bytes of a field that begins so many bytes behind the start of its record.
fn field_of(record: &[u8], from: u64, size: usize) -> Result<&[u8], String> {
    let behind = usize::try_from(from).ok().and_then(|from| record.get(from..));
    let field = behind.and_then(|rest| rest.get(..size));
    field.ok_or_else(|| "a field lies outside its record".to_owned())
}

fn damaged(error: &hdf5_pure::Error) -> String {
    let message = error.to_string();
    if ["not supported", "nsupported", "virtual"].iter().any(|word| message.contains(word)) {
        return format!(
            "its HDF5 uses a feature that is not read ({message}): write the numbers themselves, like `g[\"p\"] = f[\"p\"][:]` of h5py"
        );
    }
    format!("its HDF5 is damaged: {message}")
}

/// Whether a path is that of a data set, or ends as it does.
fn is_named_as(path: &str, name: &str) -> bool {
    path == name || path.ends_with(&format!("/{name}"))
}

/// Whether a file that is linked lies in the folder of the one with the link, or below it: no result reads elsewhere.
fn is_below(file: &str) -> bool {
    Path::new(file).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// The file and path that an array of a name is linked to, where an HDF5 has such a link instead of the array. Format: "HDF5 file format specification", IV.A.2.g, the link message.
pub fn linked(file: &Path, name: &str) -> Option<(String, String)> {
    let bytes = input_file::read(file).ok()?;
    let length = u8::try_from(name.len()).ok().filter(|length| *length > 0)?;
    let head = [&[length], name.as_bytes()].concat();
    let target = |at: usize| {
        let rest = bytes.get(at + head.len()..)?;
        let size = usize::from(u16::from_le_bytes([*rest.first()?, *rest.get(1)?]));
        let value = rest.get(2..2 + size)?.strip_prefix(&[0])?.strip_suffix(&[0])?;
        let end = value.iter().position(|byte| *byte == 0)?;
        let [file, path] = [&value[..end], &value[end + 1..]].map(|text| std::str::from_utf8(text).ok());
        Some((file?.to_owned(), path.filter(|path| !path.contains('\0'))?.to_owned()))
    };
    let starts = |at: &usize| bytes[*at..].starts_with(&head);
    (0..bytes.len())
        .filter(starts)
        .filter_map(target)
        .find(|(file, path)| !file.is_empty() && !path.is_empty())
}

/// The files beside an HDF5, or below its folder, that it may link to: those whose name stands in it where a link has one.
pub(crate) fn linked_files(path: &Path) -> Vec<PathBuf> {
    let Ok(bytes) = input_file::read(path) else { return Vec::new() };
    let is_text = |text: &&[u8]| {
        text.contains(&b'.') && u8::try_from(text.len()).is_ok() && !text.iter().any(u8::is_ascii_control)
    };
    let names =
        bytes.split(|byte| *byte == 0).filter(is_text).filter_map(|text| std::str::from_utf8(text).ok());
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<PathBuf> = names.filter(|name| is_below(name)).map(|name| folder.join(name)).collect();
    files.sort();
    files.dedup();
    files.retain(|file| file.is_file() && file != path);
    files
}

/// Type of the numbers of a field, and whether the lowest byte comes first.
fn scalar_of(kind: &Datatype) -> Option<(Scalar, bool)> {
    let (code, size, order) = match kind {
        Datatype::FixedPoint { size, byte_order, layout } => {
            (if layout.signed { 'i' } else { 'u' }, size, byte_order)
        }
        Datatype::FloatingPoint { size, byte_order, .. } => ('f', size, byte_order),
        _ => return None,
    };
    let scalar = Scalar::of_code(&format!("{code}{size}"))?;
    Some((scalar, *order == DatatypeByteOrder::LittleEndian))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hdf5_pure::{AttrValue, FileBuilder};
    use std::collections::BTreeSet;

    #[test]
    fn a_table_of_records_has_its_fields_as_arrays() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("particles.h5");
        let mut builder = FileBuilder::new();
        let records: Vec<(i8, u64, f32)> = vec![(-1, 5, 0.5), (2, 6, 1.5)];
        builder.create_dataset("table").with_compound_values(&records).expect("records");
        builder.write(&path).expect("a file");
        let mut store = Store::open(&path).expect("a file");
        let names = BTreeSet::from(["0", "1", "2"].map(str::to_owned));
        let frame = store.frame(0, Wanted(&names)).expect("a state");
        let values: Vec<&[f64]> = frame.arrays.iter().map(|array| &array.values[..]).collect();
        assert_eq!(values, [[-1.0, 2.0], [5.0, 6.0], [0.5, 1.5]]);
    }

    #[test]
    fn attributes_unpack_the_numbers_and_name_their_unit_and_what_is_none() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.h5");
        let mut builder = FileBuilder::new();
        let set = builder.create_dataset("p").with_i16_data(&[100, -999, 300]).with_shape(&[3]);
        set.set_attr("units", AttrValue::String("kPa".to_owned()));
        set.set_attr("scale_factor", AttrValue::F64(0.5));
        set.set_attr("add_offset", AttrValue::F64Array(vec![7.0]));
        set.set_attr("_FillValue", AttrValue::I16(-999));
        builder.create_dataset("q").with_f64_data(&[100.0, -999.0]).with_shape(&[2]);
        builder.write(&path).expect("a file");
        let mut store = Store::open(&path).expect("a file");
        let names = BTreeSet::from(["p", "q"].map(str::to_owned));
        let frame = store.frame(0, Wanted(&names)).expect("a state");
        let [p, q] = ["p", "q"].map(|name| &frame.array(name, None).expect("there").values[..]);
        assert!((p[0], p[2]) == (57.0, 157.0) && p[1].is_nan() && q == [100.0, -999.0], "{p:?} {q:?}");
        assert_eq!(frame.units.get("p").map(String::as_str), Some("kPa"));
        assert_eq!((frame.fills.get("p"), frame.fills.len(), frame.units.len()), (Some(&-999.0), 1, 1));
    }

    #[test]
    fn a_link_is_followed_to_files_beside_the_one_that_has_it_and_no_others() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.h5");
        let mut builder = FileBuilder::new();
        builder.create_dataset("t").with_f64_data(&[1.0, 2.0]).with_shape(&[2]);
        builder.write(&path).expect("a file");
        let sound = std::fs::read(&path).expect("a file");
        let mut source = FileBuilder::new();
        let set = source.create_dataset("q").with_i16_data(&[3, 4]).with_shape(&[2]);
        set.set_attr("scale_factor", AttrValue::F64(0.5));
        std::fs::create_dir(folder.path().join("below")).expect("a folder");
        let names = BTreeSet::from(["p".to_owned()]);
        let read = |target: &str, to: &str| -> Result<Option<Vec<f64>>, String> {
            // The link message as h5py writes it: name, length, and what is linked.
            let value = [b"\0", target.as_bytes(), b"\0", to.as_bytes(), b"\0"].concat();
            let length = u16::try_from(value.len()).expect("short").to_le_bytes();
            let link = [&[1, b'p'][..], &length, &value].concat();
            std::fs::write(&path, [&sound[..], &link].concat()).expect("a file");
            let frame = Store::open(&path)?.frame(0, Wanted(&names))?;
            Ok(frame.array("p", None).map(|array| array.values.clone()))
        };
        assert!(read("b.h5", "/q").is_err_and(|why| why.contains("`p` is a link to `/q` of b.h5")));
        source.write(folder.path().join("b.h5")).expect("a file");
        std::fs::copy(folder.path().join("b.h5"), folder.path().join("below/b.h5")).expect("a file");
        for beside in ["b.h5", "./b.h5", "below/b.h5"] {
            assert_eq!(read(beside, "/q"), Ok(Some(vec![1.5, 2.0])), "{beside}");
        }
        for elsewhere in ["../b.h5", "/b.h5"] {
            assert_eq!(read(elsewhere, "/q"), Ok(None), "{elsewhere}");
        }
        assert!(read("b.h5", "/r").is_err_and(|why| why.contains("does not have it")));
    }

    #[test]
    fn a_field_that_begins_or_ends_beyond_what_can_be_counted_is_outside_its_record() {
        let record = [1, 2, 3, 4];
        assert_eq!(field_of(&record, 2, 2), Ok(&record[2..]));
        for from in [3, 4, 5, u64::from(u32::MAX), usize::MAX as u64 - 1, u64::MAX] {
            assert!(field_of(&record, from, 2).is_err_and(|why| why.contains("outside")), "{from}");
        }
    }

    #[test]
    fn a_shape_with_more_numbers_than_can_be_counted_is_refused() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.h5");
        let mut builder = FileBuilder::new();
        builder.create_dataset("p").with_f64_data(&[0.5; 15]).with_shape(&[3, 5]);
        builder.write(&path).expect("a file");
        let sound = std::fs::read(&path).expect("a file");
        let shape_of = |[rows, columns]: [u64; 2]| [rows.to_le_bytes(), columns.to_le_bytes()].concat();
        let places: Vec<usize> =
            (0..sound.len() - 16).filter(|place| sound[*place..place + 16] == shape_of([3, 5])).collect();
        assert!(!places.is_empty(), "the shape stands in the file");
        let names = BTreeSet::from(["p".to_owned()]);
        let read = |shape| {
            let mut bytes = sound.clone();
            for place in &places {
                bytes[*place..place + 16].copy_from_slice(&shape_of(shape));
            }
            std::fs::write(&path, bytes).expect("a file");
            let mut store = Store::open(&path)?;
            store.numbers("p", None)?;
            store.frame(0, Wanted(&names)).map(|frame| frame.arrays[0].values.len())
        };
        assert_eq!(read([3, 5]), Ok(15));
        // Numbers beyond 2⁶⁴, bytes beyond 2⁶⁴, and bytes beyond any memory.
        for shape in [[u64::MAX, 2], [1 << 33, 1 << 32], [1 << 61, 1], [1 << 60, 7], [1 << 40, 1]] {
            let refused = read(shape);
            assert!(refused.as_ref().is_err_and(|why| !why.is_empty()), "{shape:?}: {refused:?}");
        }
    }
}
