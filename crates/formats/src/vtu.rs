//! VTK's XML files of points and cells: `.vtu`, and the points of `.vtp`.
//!
//! Format: "VTK XML Formats", docs.vtk.org. Text, base64 inline or appended, raw appended; packed by zlib or not;
//! headers of 32 and 64 bits; both byte orders.

#[cfg(test)]
use crate::appended::parted;
use crate::appended::{Appended, Opened};
use crate::bytes::{Budget, Scalar, as_count, count};
use crate::frame::{Array, Association, Cells, Frame, Wanted};
use crate::vtk_data::{Payloads, Place};
use crate::xml::attributes_of;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::path::Path;

/// Elements that hold arrays.
const SECTIONS: [&str; 9] =
    ["FieldData", "PointData", "CellData", "Points", "Cells", "Verts", "Lines", "Strips", "Polys"];

/// A `DataArray` as declared.
struct Declared<'a> {
    section: String,
    attributes: BTreeMap<String, String>,
    text: &'a [u8],
}

/// A `Piece` with its arrays.
#[derive(Default)]
struct Piece<'a> {
    points: usize,
    cells: usize,
    arrays: Vec<Declared<'a>>,
}

/// What stands in a file before the appended data.
struct Head<'a> {
    kind: String,
    payloads: Payloads<'a>,
    whole: Vec<Declared<'a>>,
    pieces: Vec<Piece<'a>>,
}

/// Reads a file.
///
/// # Errors
/// What is damaged, cut or claims too much.
pub fn read_file(path: &Path, wanted: Wanted) -> Result<Frame, String> {
    let opened = Opened::open(path).map_err(|error| format!("it cannot be read: {error}"))?;
    frame_of(opened.parted()?, opened.size(), wanted)
}

/// The same of a file in memory, as tests make it.
///
/// # Errors
/// As above.
#[cfg(test)]
pub fn read(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    frame_of(parted(bytes)?, bytes.len(), wanted)
}

/// The frame of a text with what is appended to it, of a file of a size.
fn frame_of(
    (text, appended): (&[u8], Option<Appended>),
    size: usize,
    wanted: Wanted,
) -> Result<Frame, String> {
    let mut budget = Budget::of_file(size);
    let head = head_of(text, appended)?;
    let mut frame = Frame::default();
    if head.pieces.is_empty() {
        return Err("it has no piece with points".to_owned());
    }
    for (place, piece) in head.pieces.iter().enumerate() {
        let part = head.part(piece, wanted, &mut budget)?;
        if place == 0 {
            frame = part;
        } else {
            frame.append(part)?;
        }
    }
    for declared in &head.whole {
        let name = declared.name();
        if is_time(name) {
            let numbers = head.numbers(declared, None, &mut budget)?;
            frame.time = numbers.first().copied().filter(|_| numbers.len() == 1);
        }
        frame.arrays.extend(head.array(declared, Association::Whole, None, wanted, &mut budget)?);
    }
    Ok(frame)
}

/// Whether an array of the whole file is its time.
pub fn is_time(name: &str) -> bool {
    ["TimeValue", "TIME", "Time", "time"].contains(&name)
}

impl Declared<'_> {
    fn get(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    fn name(&self) -> &str {
        self.get("Name")
    }

    fn place(&self) -> Result<Place<'_>, String> {
        match self.get("format") {
            "ascii" => Ok(Place::Ascii(self.text)),
            "binary" => Ok(Place::Inline(self.text)),
            "appended" => {
                let typed = self.get("offset");
                let offset = typed.trim().parse();
                offset.map(Place::Appended).map_err(|_| format!("the offset `{typed}` is no number of bytes"))
            }
            other => Err(format!("the format `{other}` is none of ascii, binary, appended")),
        }
    }
}

impl Head<'_> {
    fn numbers(
        &self,
        declared: &Declared,
        expected: Option<usize>,
        budget: &mut Budget,
    ) -> Result<Vec<f64>, String> {
        self.take(declared, expected, budget, Ok)
    }

    /// The numbers of an array, each taken as what it stands for.
    fn take<T>(
        &self,
        declared: &Declared,
        expected: Option<usize>,
        budget: &mut Budget,
        take: impl Fn(f64) -> Result<T, String>,
    ) -> Result<Vec<T>, String> {
        let of_array = |why: String| format!("the array `{}`: {why}", declared.name());
        let kind = declared.get("type");
        let scalar =
            Scalar::of_xml(kind).ok_or_else(|| of_array(format!("`{kind}` is no kind of numbers")))?;
        let place = declared.place().map_err(of_array)?;
        self.payloads.take(place, scalar, expected, budget, take).map_err(of_array)
    }

    /// An array, with its values where they are wanted; one of texts is none.
    fn array(
        &self,
        declared: &Declared,
        on: Association,
        tuples: Option<usize>,
        wanted: Wanted,
        budget: &mut Budget,
    ) -> Result<Option<Array>, String> {
        let name = declared.name().to_owned();
        if Scalar::of_xml(declared.get("type")).is_none() {
            return Ok(None);
        }
        let components = components_of(declared)?;
        let mut array = Array { name, on, components, tuples: tuples.unwrap_or(1), values: Vec::new() };
        if wanted.has(&array.name) {
            let expected = match tuples {
                Some(tuples) => Some(product(tuples, components)?),
                None => None,
            };
            array.values = self.numbers(declared, expected, budget)?;
            array.tuples = array.values.len() / components;
        }
        Ok(Some(array))
    }

    /// A piece as a frame.
    fn part(&self, piece: &Piece, wanted: Wanted, budget: &mut Budget) -> Result<Frame, String> {
        let mut frame = Frame::default();
        let (mut connectivity, mut ends, mut types) = (None, None, Vec::new());
        for declared in &piece.arrays {
            match declared.section.as_str() {
                "Points" => {
                    let numbers = self.numbers(declared, Some(product(piece.points, 3)?), budget)?;
                    frame.coordinates =
                        numbers.chunks_exact(3).map(|place| [place[0], place[1], place[2]]).collect();
                }
                "PointData" => {
                    let on = Association::Points;
                    frame.arrays.extend(self.array(declared, on, Some(piece.points), wanted, budget)?);
                }
                "CellData" if self.kind == "UnstructuredGrid" => {
                    let on = Association::Cells;
                    frame.arrays.extend(self.array(declared, on, Some(piece.cells), wanted, budget)?);
                }
                "Cells" => match declared.name() {
                    "connectivity" => connectivity = Some(self.take(declared, None, budget, as_place)?),
                    "offsets" => ends = Some(self.take(declared, Some(piece.cells), budget, as_count)?),
                    "types" => types = self.take(declared, Some(piece.cells), budget, as_kind)?,
                    _ => {}
                },
                _ => {}
            }
        }
        if frame.coordinates.len() != piece.points {
            return Err(format!("it declares {} points and has no places for them", piece.points));
        }
        if let (Some(connectivity), Some(ends)) = (connectivity, ends) {
            let cells = Cells { types, ends, connectivity };
            cells.check(piece.points)?;
            frame.cells = (cells.count() > 0).then_some(cells);
        }
        Ok(frame)
    }
}

/// Types of cells.
///
/// # Errors
/// When one is no such number.
pub fn kinds(numbers: &[f64]) -> Result<Vec<u8>, String> {
    numbers.iter().map(|number| as_kind(*number)).collect()
}

fn as_kind(number: f64) -> Result<u8, String> {
    let kind = count(number).and_then(|kind| u8::try_from(kind).ok());
    kind.ok_or_else(|| format!("{number} is no type of a cell"))
}

/// Points that cells name.
///
/// # Errors
/// When one is no such number.
pub fn places(numbers: &[f64]) -> Result<Vec<u32>, String> {
    numbers.iter().map(|number| as_place(*number)).collect()
}

fn as_place(number: f64) -> Result<u32, String> {
    let place = count(number).and_then(|place| u32::try_from(place).ok());
    place.ok_or_else(|| format!("{number} names no point"))
}

fn product(tuples: usize, components: usize) -> Result<usize, String> {
    tuples.checked_mul(components).ok_or_else(|| format!("{tuples} tuples are more than a file can hold"))
}

fn components_of(declared: &Declared) -> Result<usize, String> {
    match declared.get("NumberOfComponents") {
        "" => Ok(1),
        typed => match typed.trim().parse() {
            Ok(components) if (1..=1000).contains(&components) => Ok(components),
            _ => Err(format!("the array `{}` has `{typed}` components", declared.name())),
        },
    }
}

/// The head of a file, with the places of its data.
fn head_of<'a>(text: &'a [u8], appended: Option<Appended<'a>>) -> Result<Head<'a>, String> {
    let mut reader = Reader::from_reader(text);
    let payloads = Payloads { is_little: true, header: Scalar::U32, is_packed: false, appended };
    let mut head = Head { kind: String::new(), payloads, whole: Vec::new(), pieces: Vec::new() };
    let mut section = String::new();
    let mut open: Option<Declared> = None;
    // Keys of information lie in an array behind its numbers, and have texts of their own.
    let mut is_of_key = false;
    loop {
        let event = reader.read_event().map_err(|error| {
            format!("it is no sound XML near its byte {}: {error}", reader.buffer_position())
        })?;
        match event {
            Event::Start(tag) | Event::Empty(tag) if tag.name().as_ref() == b"DataArray" => {
                head.close(open.take());
                open =
                    Some(Declared { section: section.clone(), attributes: attributes_of(&tag)?, text: b"" });
                is_of_key = false;
            }
            Event::Start(tag) | Event::Empty(tag) => {
                let name = String::from_utf8_lossy(tag.name().as_ref()).into_owned();
                head.begin(&name, &attributes_of(&tag)?)?;
                is_of_key = open.is_some();
                if SECTIONS.contains(&name.as_str()) {
                    section = name;
                }
            }
            Event::Text(text) => {
                if let (Some(open), std::borrow::Cow::Borrowed(text)) = (&mut open, text.into_inner())
                    && !is_of_key
                    && open.text.is_empty()
                    && !text.trim_ascii().is_empty()
                {
                    open.text = text;
                }
            }
            Event::End(tag) if tag.name().as_ref() == b"DataArray" => head.close(open.take()),
            Event::Eof => break,
            _ => {}
        }
    }
    if appended.is_none() && !text.trim_ascii_end().ends_with(b"</VTKFile>") {
        return Err("it does not end with </VTKFile>: the file is cut".to_owned());
    }
    head.close(open);
    Ok(head)
}

impl<'a> Head<'a> {
    /// Takes what a tag declares.
    fn begin(&mut self, name: &str, attributes: &BTreeMap<String, String>) -> Result<(), String> {
        let get = |name: &str| attributes.get(name).map_or("", String::as_str);
        match name {
            "VTKFile" => {
                get("type").clone_into(&mut self.kind);
                if !["UnstructuredGrid", "PolyData"].contains(&self.kind.as_str()) {
                    return Err(format!(
                        "a VTKFile of the type `{}` is not read as points and cells",
                        self.kind
                    ));
                }
                self.payloads.is_little = get("byte_order") != "BigEndian";
                if get("header_type") == "UInt64" {
                    self.payloads.header = Scalar::U64;
                }
                match get("compressor") {
                    "" => {}
                    "vtkZLibDataCompressor" => self.payloads.is_packed = true,
                    other => {
                        return Err(format!("it is packed by {other}: write it with zlib, or not packed"));
                    }
                }
            }
            "Piece" => {
                let number = |name: &str| {
                    let typed = get(name).trim();
                    let number = if typed.is_empty() { Ok(0) } else { typed.parse() };
                    number.map_err(|_| format!("`{name}` is `{typed}`, which is no number"))
                };
                let (points, cells) = (number("NumberOfPoints")?, number("NumberOfCells")?);
                self.pieces.push(Piece { points, cells, arrays: Vec::new() });
            }
            _ => {}
        }
        Ok(())
    }

    /// Keeps a declared array.
    fn close(&mut self, declared: Option<Declared<'a>>) {
        let Some(declared) = declared else { return };
        match self.pieces.last_mut() {
            Some(piece) if declared.section != "FieldData" => piece.arrays.push(declared),
            _ => self.whole.push(declared),
        }
    }
}
