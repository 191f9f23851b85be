//! VTK's legacy files of unstructured grids and points, in text and in binary (big endian).
//!
//! Format: "VTK Legacy Formats", docs.vtk.org; cells of versions up to 4 and from 5.1 on.

use crate::bytes::{Budget, Scalar, excerpt, number_of_word, whole};
use crate::cells::Cells;
use crate::frame::{Array, Association, Frame, Wanted, points_of};
use crate::vtu::is_time;

/// A position in a file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    is_binary: bool,
    budget: Budget,
}

/// Reads a file.
pub(crate) fn read(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let mut cursor = Cursor { bytes, at: 0, is_binary: false, budget: Budget::of_file(bytes.len()) };
    cursor.line();
    cursor.line();
    let mode = cursor.word().unwrap_or_default();
    cursor.is_binary = match mode.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        _ => return Err(format!("its third line is `{}`: expected ASCII or BINARY", excerpt(&mode))),
    };
    let mut reading =
        Reading { cursor, wanted, frame: Frame::default(), on: Association::Whole, points: 0, cells: 0 };
    let (mut listed, mut types) = (None, Vec::new());
    while let Some(word) = reading.cursor.word() {
        match word.to_ascii_uppercase().as_str() {
            "DATASET" => {
                let kind = reading.cursor.word().unwrap_or_default();
                let known = ["UNSTRUCTURED_GRID", "POLYDATA", "STRUCTURED_GRID"];
                if !known.contains(&kind.to_ascii_uppercase().as_str()) {
                    return Err(format!(
                        "a data set of the type `{}` is not read: write an unstructured grid",
                        excerpt(&kind)
                    ));
                }
            }
            "DIMENSIONS" => reading.cursor.skip_words(3),
            "POINTS" => reading.points()?,
            "CELLS" => listed = Some(reading.cells()?),
            "CELL_TYPES" => {
                let count = reading.cursor.count()?;
                types = whole(&reading.cursor.numbers(Scalar::I32, count, 1)?)?;
            }
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" => {
                reading.cells()?;
            }
            "POINT_DATA" => reading.begin(Association::Points)?,
            "CELL_DATA" => reading.begin(Association::Cells)?,
            "METADATA" => reading.cursor.skip_metadata(),
            keyword => reading.data(keyword)?,
        }
    }
    let Reading { mut frame, points, .. } = reading;
    if points == 0 {
        return Err("it has no POINTS".to_owned());
    }
    if let Some((ends, connectivity)) = listed {
        let cells = Cells { types, ends, connectivity };
        cells.check(points)?;
        frame.cells = (cells.count() > 0).then_some(cells);
    }
    Ok(frame)
}

/// A file that is being read.
struct Reading<'a> {
    cursor: Cursor<'a>,
    wanted: Wanted<'a>,
    frame: Frame,
    on: Association,
    points: usize,
    cells: usize,
}

impl Reading<'_> {
    fn points(&mut self) -> Result<(), String> {
        self.points = self.cursor.count()?;
        let scalar = self.cursor.scalar()?;
        self.frame.coordinates = points_of(&self.cursor.numbers(scalar, self.points, 3)?, 3);
        Ok(())
    }

    /// Ends and points of the cells, in both versions of the format.
    fn cells(&mut self) -> Result<(Vec<usize>, Vec<u32>), String> {
        let (first, second) = (self.cursor.count()?, self.cursor.count()?);
        if self.cursor.peek().as_deref() == Some("OFFSETS") {
            self.cursor.word();
            let scalar = self.cursor.scalar()?;
            let offsets: Vec<usize> = whole(&self.cursor.numbers(scalar, first, 1)?)?;
            if self.cursor.word().as_deref() != Some("CONNECTIVITY") {
                return Err("no CONNECTIVITY follows the OFFSETS of the cells".to_owned());
            }
            let scalar = self.cursor.scalar()?;
            let connectivity = whole(&self.cursor.numbers(scalar, second, 1)?)?;
            self.cells = first.saturating_sub(1);
            return Ok((offsets.get(1..).unwrap_or_default().to_vec(), connectivity));
        }
        self.cells = first;
        let list: Vec<u32> = whole(&self.cursor.numbers(Scalar::I32, second, 1)?)?;
        let (mut ends, mut connectivity) = (Vec::new(), Vec::new());
        let mut rest = list.as_slice();
        while let Some((length, after)) = rest.split_first() {
            let length = *length as usize;
            let points = after.get(..length).ok_or("the list of cells ends inside a cell")?;
            connectivity.extend_from_slice(points);
            ends.push(connectivity.len());
            rest = &after[length..];
        }
        if ends.len() != first {
            return Err(format!("{first} cells are declared and {} are listed", ends.len()));
        }
        Ok((ends, connectivity))
    }

    fn begin(&mut self, on: Association) -> Result<(), String> {
        self.on = on;
        let count = self.cursor.count()?;
        let there = if on == Association::Points { self.points } else { self.cells };
        if count != there && !(on == Association::Cells && there == 0) {
            return Err(format!("data for {count} {} are declared, and there are {there}", on.name()));
        }
        Ok(())
    }

    fn tuples(&self) -> usize {
        if self.on == Association::Cells { self.cells } else { self.points }
    }

    /// Reads the arrays behind a keyword.
    fn data(&mut self, keyword: &str) -> Result<(), String> {
        match keyword {
            "SCALARS" => {
                let (name, scalar) = (self.cursor.name()?, self.cursor.scalar()?);
                let mut components = 1;
                if self.cursor.peek().is_some_and(|word| word.parse::<usize>().is_ok()) {
                    components = self.cursor.count()?;
                }
                if self.cursor.peek().is_some_and(|word| word.eq_ignore_ascii_case("LOOKUP_TABLE")) {
                    self.cursor.skip_words(2);
                }
                self.array(name, scalar, self.tuples(), components)
            }
            "VECTORS" | "NORMALS" | "TENSORS" | "TENSORS6" => {
                let (name, scalar) = (self.cursor.name()?, self.cursor.scalar()?);
                let components = match keyword {
                    "TENSORS" => 9,
                    "TENSORS6" => 6,
                    _ => 3,
                };
                self.array(name, scalar, self.tuples(), components)
            }
            "TEXTURE_COORDINATES" => {
                let (name, components) = (self.cursor.name()?, self.cursor.count()?);
                let scalar = self.cursor.scalar()?;
                self.array(name, scalar, self.tuples(), components)
            }
            "GLOBAL_IDS" | "PEDIGREE_IDS" => {
                let (name, scalar) = (self.cursor.name()?, self.cursor.scalar()?);
                self.array(name, scalar, self.tuples(), 1)
            }
            // Colours: bytes in binary, shares of 1 in text.
            "LOOKUP_TABLE" => {
                self.cursor.name()?;
                let colours = self.cursor.count()?;
                self.cursor.numbers(self.colour(), colours, 4).map(|_| ())
            }
            "COLOR_SCALARS" => {
                let (name, components) = (self.cursor.name()?, self.cursor.count()?);
                self.array(name, self.colour(), self.tuples(), components)
            }
            "FIELD" => {
                self.cursor.name()?;
                let arrays = self.cursor.count()?;
                for _ in 0..arrays {
                    while self.cursor.peek().as_deref() == Some("METADATA") {
                        self.cursor.word();
                        self.cursor.skip_metadata();
                    }
                    let name = self.cursor.name()?;
                    let (components, tuples) = (self.cursor.count()?, self.cursor.count()?);
                    let scalar = self.cursor.scalar()?;
                    self.array(name, scalar, tuples, components)?;
                }
                Ok(())
            }
            other => Err(format!(
                "`{}` before byte {} is not a known keyword, or an array is longer than declared",
                excerpt(other),
                self.cursor.at
            )),
        }
    }

    /// Type of the colours of a table.
    fn colour(&self) -> Scalar {
        if self.cursor.is_binary { Scalar::U8 } else { Scalar::F32 }
    }

    fn array(
        &mut self,
        name: String,
        scalar: Scalar,
        tuples: usize,
        components: usize,
    ) -> Result<(), String> {
        let values = self
            .cursor
            .numbers(scalar, tuples, components)
            .map_err(|why| format!("the array `{name}`: {why}"))?;
        if self.on == Association::Whole && is_time(&name) {
            // Of several numbers none is the time.
            self.frame.time = values.first().copied().filter(|_| values.len() == 1);
        }
        if self.on != Association::Whole && tuples != self.tuples() {
            return Err(format!(
                "the array `{name}` has {tuples} tuples for {} {}",
                self.tuples(),
                self.on.name()
            ));
        }
        let values = if self.wanted.has(&name) { values } else { Vec::new() };
        self.frame.arrays.push(Array {
            name,
            on: self.on,
            components: components.max(1),
            tuples,
            values,
            shape: Vec::new(),
        });
        Ok(())
    }
}

impl Cursor<'_> {
    fn line(&mut self) {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        self.at += rest.iter().position(|symbol| *symbol == b'\n').map_or(rest.len(), |end| end + 1);
    }

    fn word_at(&self) -> (usize, usize) {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let start = rest.iter().position(|symbol| !symbol.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        (self.at + start, self.at + start + length)
    }

    fn peek(&self) -> Option<String> {
        let (start, end) = self.word_at();
        (start < end).then(|| String::from_utf8_lossy(&self.bytes[start..end]).into_owned())
    }

    fn word(&mut self) -> Option<String> {
        let word = self.peek();
        self.at = self.word_at().1;
        word
    }

    fn skip_words(&mut self, words: usize) {
        for _ in 0..words {
            self.word();
        }
    }

    /// Skips a block of metadata, which ends with an empty line.
    fn skip_metadata(&mut self) {
        self.line();
        while self.at < self.bytes.len() {
            let start = self.at;
            self.line();
            if self.bytes[start..self.at].trim_ascii().is_empty() {
                break;
            }
        }
    }

    fn name(&mut self) -> Result<String, String> {
        self.word()
            .map(|name| name.replace("%20", " "))
            .ok_or_else(|| "it ends before a name: the file is cut".to_owned())
    }

    fn count(&mut self) -> Result<usize, String> {
        let word = self.word().unwrap_or_default();
        word.parse()
            .map_err(|_| format!("`{}` before byte {} is invalid: expected a count", excerpt(&word), self.at))
    }

    fn scalar(&mut self) -> Result<Scalar, String> {
        let word = self.word().unwrap_or_default();
        Scalar::of_legacy(&word).ok_or_else(|| format!("`{}` is not a type of numbers", excerpt(&word)))
    }

    /// Reads numbers.
    fn numbers(&mut self, scalar: Scalar, tuples: usize, components: usize) -> Result<Vec<f64>, String> {
        let cut = |there: usize| {
            format!(
                "{tuples} tuples of {components} are declared and there is room for {there} numbers: the file is cut"
            )
        };
        let left = self.bytes.len().saturating_sub(self.at);
        // A number in text takes at least two bytes.
        let least = if self.is_binary { scalar.size() } else { 2 };
        let total = tuples.checked_mul(components).filter(|total| *total <= left / least + 1);
        let total = total.ok_or_else(|| cut(left / least))?;
        self.budget.take(8 * total as u64)?;
        if self.is_binary {
            self.line();
            let end = self.at + total * scalar.size();
            let bytes = self.bytes.get(self.at..end).ok_or_else(|| cut(left / least))?;
            self.at = end;
            return Ok(scalar.decode(bytes, false));
        }
        let mut numbers = Vec::with_capacity(total);
        for _ in 0..total {
            let (start, end) = self.word_at();
            if start == end {
                return Err(cut(numbers.len()));
            }
            numbers.push(number_of_word(&String::from_utf8_lossy(&self.bytes[start..end]))?);
            self.at = end;
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_array_of_the_whole_gives_the_time_of_a_state() {
        let field = |name: &str, tuples: usize| {
            format!("FIELD f 1\n{name} 1 {tuples} double\n{}\n", "7 ".repeat(tuples))
        };
        let scalars = "SCALARS Time double\nLOOKUP_TABLE default\n8 9\n";
        let [on_points, on_cells] = ["POINT_DATA 2\n", "CELL_DATA 2\n"];
        for (whole, behind, wanted) in [
            ("FIELD f 1\nTIME 1 1 double\n2.5\n", String::new(), Some(2.5)),
            ("FIELD f 1\nTimeValue 1 2 double\n2.5 3.5\n", String::new(), None),
            ("FIELD f 1\ncycle 1 1 int\n4\n", String::new(), None),
            ("", format!("{on_points}{}", field("Time", 2)), None),
            ("", format!("{on_cells}{}", field("time", 2)), None),
            ("", format!("{on_points}{scalars}"), None),
            ("FIELD f 1\nTIME 1 1 double\n2.5\n", format!("{on_points}{scalars}"), Some(2.5)),
            ("FIELD f 1\nTIME 1 1 double\n2.5\n", format!("{on_cells}{}", field("TIME", 2)), Some(2.5)),
        ] {
            let text = format!(
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n{whole}POINTS 2 double\n0 0 0\n0 1 0\n\
                 VERTICES 2 4\n1 0\n1 1\n{behind}"
            );
            let frame = read(text.as_bytes(), Wanted(&["Time".to_owned()].into())).expect("a state");
            assert_eq!(frame.time, wanted, "{text}");
        }
    }
}
