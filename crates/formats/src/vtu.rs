//! VTK's XML files of points and cells: `.vtu`, and the points of `.vtp`.
//!
//! Format: "VTK XML Formats", docs.vtk.org. Text, base64 inline or appended, raw appended; packed by zlib or not;
//! headers of 32 and 64 bits; both byte orders.

use crate::bytes::{Budget, Scalar, whole};
use crate::cells::Cells;
use crate::frame::{Array, Association, Frame, Wanted, points_of};
use crate::vtk_data::{Appended, Encoding, Place, split};
use crate::xml::{all, attribute, child, parse};
use roxmltree::Node;

/// Reads a file.
pub(crate) fn read(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let (xml, appended) = split(bytes)?;
    let mut text = String::from_utf8_lossy(xml);
    if appended.is_some() {
        // The tag that the appended data stand in.
        text.to_mut().push_str("</VTKFile>");
    } else if !text.trim_end().ends_with("</VTKFile>") {
        return Err("it does not end with </VTKFile>: the file is cut".to_owned());
    }
    let document = parse(&text)?;
    let root = document.root_element();
    let kind = attribute(root, "type");
    if !["UnstructuredGrid", "PolyData"].contains(&kind) {
        return Err(format!(
            "a VTKFile of the type `{kind}` is not read as points and cells: write VTU (ParaView: Append Datasets, Save Data) or CSV"
        ));
    }
    let mut reader = Reader {
        encoding: encoding_of(root, appended)?,
        wanted,
        budget: Budget::of_file(bytes.len()),
        has_cells: kind == "UnstructuredGrid",
        doubts: Vec::new(),
    };
    let mut frame: Option<Frame> = None;
    for piece in all(root, "Piece") {
        let part = reader.piece(piece)?;
        match &mut frame {
            Some(frame) => frame.append(part)?,
            None => frame = Some(part),
        }
    }
    let mut frame = frame.ok_or("it has no piece with points")?;
    for array in all(root, "FieldData").flat_map(data_arrays) {
        if is_time(attribute(array, "Name")) {
            let numbers = reader.numbers(array, None)?;
            frame.time = numbers.first().copied().filter(|_| numbers.len() == 1);
        }
        frame.arrays.extend(reader.array(array, Association::Whole, None)?);
    }
    frame.doubts.append(&mut reader.doubts);
    Ok(frame)
}

/// Whether an array of the whole file is its time.
pub(crate) fn is_time(name: &str) -> bool {
    ["TimeValue", "TIME", "Time", "time"].contains(&name)
}

fn encoding_of<'a>(root: Node, appended: Option<Appended<'a>>) -> Result<Encoding<'a>, String> {
    let is_packed = match attribute(root, "compressor") {
        "" => false,
        "vtkZLibDataCompressor" => true,
        other => return Err(format!("it is compressed by {other}: write it with zlib, or uncompressed")),
    };
    Ok(Encoding {
        is_little: attribute(root, "byte_order") != "BigEndian",
        header: if attribute(root, "header_type") == "UInt64" { Scalar::U64 } else { Scalar::U32 },
        is_packed,
        appended,
    })
}

fn data_arrays<'a, 'input: 'a>(section: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    section.children().filter(|child| child.has_tag_name("DataArray"))
}

/// A whole number in an attribute, 0 if it is missing.
fn count_in(node: Node, name: &str) -> Result<usize, String> {
    match attribute(node, name) {
        "" => Ok(0),
        typed => typed.parse().map_err(|_| format!("`{name}` is `{typed}`: expected a whole number")),
    }
}

fn product(tuples: usize, components: usize) -> Result<usize, String> {
    tuples.checked_mul(components).ok_or_else(|| format!("{tuples} tuples are more than a file can hold"))
}

struct Reader<'a> {
    encoding: Encoding<'a>,
    wanted: Wanted<'a>,
    budget: Budget,
    has_cells: bool,
    doubts: Vec<String>,
}

impl Reader<'_> {
    /// A piece as a frame.
    fn piece(&mut self, piece: Node) -> Result<Frame, String> {
        let (points, cells) = (count_in(piece, "NumberOfPoints")?, count_in(piece, "NumberOfCells")?);
        let mut frame = Frame::default();
        if let Some(places) = child(piece, "Points").and_then(|section| data_arrays(section).next()) {
            frame.coordinates = points_of(&self.numbers(places, Some(product(points, 3)?))?, 3);
        }
        if frame.coordinates.len() != points {
            return Err(format!("it declares {points} points and has no places for them"));
        }
        let sections = [("PointData", Association::Points, points), ("CellData", Association::Cells, cells)];
        for (name, on, tuples) in &sections[..if self.has_cells { 2 } else { 1 }] {
            for array in child(piece, name).into_iter().flat_map(data_arrays) {
                frame.arrays.extend(self.array(array, *on, Some(*tuples))?);
            }
        }
        if let Some(section) = child(piece, "Cells") {
            frame.cells = self.cells(section, cells)?;
        }
        if let Some(cells) = &frame.cells {
            cells.check(points)?;
        }
        Ok(frame)
    }

    fn cells(&mut self, section: Node, count: usize) -> Result<Option<Cells>, String> {
        let named = |name| data_arrays(section).find(|array| attribute(*array, "Name") == name);
        let (Some(connectivity), Some(offsets)) = (named("connectivity"), named("offsets")) else {
            return Ok(None);
        };
        let connectivity = whole(&self.numbers(connectivity, None)?)?;
        let ends = whole(&self.numbers(offsets, Some(count))?)?;
        let types = match named("types") {
            Some(types) => whole(&self.numbers(types, Some(count))?)?,
            None => Vec::new(),
        };
        let cells = Cells { types, ends, connectivity };
        Ok((cells.count() > 0 || !cells.connectivity.is_empty()).then_some(cells))
    }

    /// An array, with its values if they are wanted; nothing if it holds texts.
    fn array(&mut self, node: Node, on: Association, tuples: Option<usize>) -> Result<Option<Array>, String> {
        let name = attribute(node, "Name").to_owned();
        if Scalar::of_xml(attribute(node, "type")).is_none() {
            return Ok(None);
        }
        let components = match node.attribute("NumberOfComponents") {
            None => 1,
            Some(typed) => match typed.trim().parse::<usize>() {
                // As VTK reads 0, and DOLFINx writes it.
                Ok(components) if components <= 1000 => components.max(1),
                _ => return Err(format!("the array `{name}` has `{typed}` components")),
            },
        };
        let mut array = Array {
            name,
            on,
            components,
            tuples: tuples.unwrap_or(1),
            values: Vec::new(),
            shape: Vec::new(),
        };
        if self.wanted.has(&array.name) {
            let expected = tuples.map(|tuples| product(tuples, components)).transpose()?;
            array.values = self.numbers(node, expected)?;
            array.tuples = array.values.len() / components;
        }
        Ok(Some(array))
    }

    fn numbers(&mut self, node: Node, expected: Option<usize>) -> Result<Vec<f64>, String> {
        let kind = attribute(node, "type");
        // The numbers may follow elements with keys.
        let text = || {
            let texts = node.children().filter(roxmltree::Node::is_text).filter_map(|child| child.text());
            texts.map(str::trim).find(|text| !text.is_empty()).unwrap_or_default()
        };
        let found = match (Scalar::of_xml(kind), attribute(node, "format")) {
            (None, _) => Err(format!("`{kind}` is not a type of numbers")),
            // As VTK reads them: data with an offset are appended, and any others that are not binary are text.
            (Some(scalar), "binary") => Ok((scalar, Place::Inline(text()))),
            (Some(scalar), format) => match (node.attribute("offset"), format) {
                (None, "appended") => Err("its data are appended, and it has no offset".to_owned()),
                (None, _) => Ok((scalar, Place::Text(text()))),
                (Some(typed), _) => {
                    let offset = typed.trim().parse().map(|offset| (scalar, Place::Appended(offset)));
                    offset.map_err(|_| format!("its offset is `{typed}`: expected a whole number"))
                }
            },
        };
        let named = |why: String| format!("the array `{}`: {why}", attribute(node, "Name"));
        let (scalar, place) = found.map_err(named)?;
        let read = self.encoding.numbers(place, scalar, expected, &mut self.budget);
        let (numbers, doubt) = read.map_err(named)?;
        self.doubts.extend(doubt.map(named));
        Ok(numbers)
    }
}
