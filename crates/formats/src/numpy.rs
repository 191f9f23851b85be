//! Arrays of `NumPy`: `.npy`, and `.npz`, a zip of them.
//!
//! Format: "NEP 1". Pickled objects are programs: they are never opened, and a note says that they are left out. Every
//! member of a zip is compared with its checksum, and its own name and method with those in the list of members.

use crate::bytes::{Budget, Scalar, excerpt, unpack};
use crate::frame::{Array, Association, Frame, Wanted};
use rawzip::{CompressionMethod, ZipArchive, ZipFileHeaderRecord, ZipSliceArchive, ZipVerification};
use std::borrow::Cow;

/// Reads an `.npz`.
pub(crate) fn read_npz(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let damaged = |error| format!("its list of members is damaged or cut: {error}");
    let archive = ZipArchive::from_slice(bytes).map_err(damaged)?;
    let entries = archive.entries().collect::<Result<Vec<_>, _>>().map_err(damaged)?;
    if entries.len() as u64 != archive.entries_hint() {
        return Err(format!("it lists {} members and counts {}", entries.len(), archive.entries_hint()));
    }
    let mut budget = Budget::of_file(bytes.len());
    // What all members claim together is taken before any is unpacked.
    for entry in &entries {
        budget.take(entry.uncompressed_size_hint())?;
    }
    let mut frame = Frame::default();
    let mut skipped = Vec::new();
    for entry in &entries {
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        if name == "[Content_Types].xml" {
            return Err("it is an Excel workbook: save the sheet as CSV".to_owned());
        }
        let name = name.strip_suffix(".npy").unwrap_or(&name);
        let of_member = |why: String| format!("the member `{name}`: {why}");
        let content = member(&archive, entry).map_err(of_member)?;
        let header = header_of(&content).map_err(of_member)?;
        match header.scalar {
            Some(_) => {
                frame.arrays.push(header.array(name.to_owned(), &content, wanted).map_err(of_member)?);
            }
            None if !header.fields.is_empty() => {
                frame
                    .arrays
                    .extend(header.records(&format!("{name}/"), &content, wanted).map_err(of_member)?);
            }
            None => skipped.push(format!("`{name}` ({})", excerpt(&header.kind))),
        }
    }
    if frame.arrays.is_empty() && skipped.is_empty() {
        return Err(
            "it is a zip without arrays of NumPy (an Excel workbook: save the sheet as CSV)".to_owned()
        );
    }
    if !skipped.is_empty() {
        frame.notes.push(format!(
            "left out {}: not plain numbers, and pickled objects are never opened",
            skipped.join(", ")
        ));
    }
    Ok(frame)
}

/// The unpacked content of a member of a zip.
fn member<'a>(
    archive: &'a ZipSliceArchive<&[u8]>,
    listed: &ZipFileHeaderRecord,
) -> Result<Cow<'a, [u8]>, String> {
    let damaged = |error| format!("it is damaged or cut: {error}");
    let entry = archive.get_entry(listed.wayfinder()).map_err(damaged)?;
    let (local, claim) = (entry.local_header(), entry.claim_verifier());
    let method = listed.compression_method();
    if local.file_path().as_bytes() != listed.file_path().as_bytes() || local.compression_method() != method {
        return Err("it differs from the list of members: the file is damaged".to_owned());
    }
    let content: Cow<[u8]> = match method {
        CompressionMethod::STORE => entry.data().into(),
        CompressionMethod::DEFLATE => {
            let length =
                usize::try_from(claim.uncompressed_size).map_err(|_| "it declares more than it can hold")?;
            unpack(entry.data(), length, false)?.into()
        }
        method => return Err(format!("its compression {method:?} is unknown: NumPy stores or deflates")),
    };
    let found = ZipVerification { crc: rawzip::crc32(&content), uncompressed_size: content.len() as u64 };
    claim.valid(found).map_err(|error| format!("it is damaged: {error}"))?;
    Ok(content)
}

/// Reads an `.npy` as an array of a name.
pub(crate) fn read_npy(bytes: &[u8], name: &str, wanted: Wanted) -> Result<Frame, String> {
    let header = header_of(bytes)?;
    if !header.fields.is_empty() {
        return Ok(Frame { arrays: header.records("", bytes, wanted)?, ..Frame::default() });
    }
    if header.scalar.is_none() {
        return Err(format!("its type is `{}`: pickled objects are never opened", excerpt(&header.kind)));
    }
    Ok(Frame { arrays: vec![header.array(name.to_owned(), bytes, wanted)?], ..Frame::default() })
}

/// The header before the numbers of an array.
struct Header {
    kind: String,
    scalar: Option<Scalar>,
    is_little: bool,
    is_by_columns: bool,
    shape: Vec<usize>,
    start: usize,
    /// The fields of records.
    fields: Vec<Field>,
}

/// A field of a record.
struct Field {
    name: String,
    /// Its numbers; a text has none.
    scalar: Option<Scalar>,
    is_little: bool,
    components: usize,
    /// Bytes.
    size: usize,
}

/// The fields of a type like `[('t', '<f8'), ('u', '<f8', (2,))]`; none where one of them is no number and no text.
fn fields_of(descr: &str) -> Vec<Field> {
    let list = descr.strip_prefix('[').and_then(|rest| rest.split(']').next()).unwrap_or_default();
    let field = |text: &str| {
        let mut parts = text.split('\'');
        let (name, _, code, rest) = (parts.next()?, parts.next()?, parts.next()?, parts.next()?);
        let counts = rest.split(|letter: char| !letter.is_ascii_digit()).filter(|digits| !digits.is_empty());
        let counts = counts.map(|digits| digits.parse::<usize>().ok()).collect::<Option<Vec<usize>>>()?;
        let components = counts.into_iter().try_fold(1_usize, usize::checked_mul)?;
        let (order, kind) = code.split_at_checked(1)?;
        let scalar = Scalar::of_code(kind);
        let letters = kind.get(1..).and_then(|count| count.parse::<usize>().ok());
        let each = match (scalar, kind.chars().next()?) {
            (Some(scalar), _) => scalar.size(),
            (None, 'S' | 'V') => letters?,
            (None, 'U') => letters?.checked_mul(4)?,
            _ => return None,
        };
        let size = each.checked_mul(components)?;
        Some(Field { name: name.to_owned(), scalar, is_little: order != ">", components, size })
    };
    list.split("('").skip(1).map(field).collect::<Option<Vec<Field>>>().unwrap_or_default()
}

fn header_of(bytes: &[u8]) -> Result<Header, String> {
    let cut = || "its header is cut".to_owned();
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err("it is not an array of NumPy".to_owned());
    }
    let is_short = *bytes.get(6).ok_or_else(cut)? == 1;
    let from = if is_short { 10 } else { 12 };
    let length = bytes.get(8..from).ok_or_else(cut)?;
    let start = from + length.iter().rev().fold(0, |number, byte| (number << 8) | usize::from(*byte));
    let text = String::from_utf8_lossy(bytes.get(from..start).ok_or_else(cut)?).into_owned();
    let value = |key: &str| text.split_once(key).map_or("", |(_, rest)| rest.trim_start_matches([':', ' ']));
    let descr = value("'descr'");
    let kind = match descr.strip_prefix('\'') {
        Some(rest) => rest.split('\'').next().unwrap_or_default().to_owned(),
        None => "a record of several fields".to_owned(),
    };
    let shape = value("'shape'").trim_start_matches('(').split(')').next().unwrap_or_default();
    let shape = shape.split(',').map(str::trim).filter(|entry| !entry.is_empty());
    let shape = shape
        .map(|entry| entry.trim_end_matches('L').parse().map_err(|_| format!("its shape has `{entry}`")));
    let scalar = kind.get(1..).and_then(Scalar::of_code);
    let fields = if descr.starts_with('[') { fields_of(descr) } else { Vec::new() };
    Ok(Header {
        fields,
        is_little: !kind.starts_with('>'),
        is_by_columns: value("'fortran_order'").starts_with("True"),
        shape: shape.collect::<Result<_, _>>()?,
        kind,
        scalar,
        start,
    })
}

impl Header {
    fn array(&self, name: String, bytes: &[u8], wanted: Wanted) -> Result<Array, String> {
        let (on, tuples, rest) = match self.shape.split_first() {
            None => (Association::Whole, 1, &[][..]),
            Some((tuples, rest)) => (Association::Points, *tuples, rest),
        };
        let too_many = || "its shape is larger than any file".to_owned();
        let components =
            rest.iter().try_fold(1_usize, |all, one| all.checked_mul(*one)).ok_or_else(too_many)?;
        let total = components.checked_mul(tuples).ok_or_else(too_many)?;
        let mut values = Vec::new();
        if let Some(scalar) = self.scalar.filter(|_| wanted.has(&name)) {
            let size = total.checked_mul(scalar.size()).ok_or_else(too_many)?;
            let data = &bytes[self.start..];
            let data = data.get(..size).ok_or_else(|| {
                format!("its shape has {size} bytes and {} are there: the file is cut", data.len())
            })?;
            values = scalar.decode(data, self.is_little);
            if self.is_by_columns && components > 1 {
                values = by_rows(&values, &self.shape);
            }
        }
        let shape = if self.shape.len() > 2 { self.shape.clone() } else { Vec::new() };
        Ok(Array { name, on, components: components.max(1), tuples, values, shape })
    }
}

impl Header {
    /// The fields of records as arrays, their names behind a prefix.
    fn records(&self, prefix: &str, bytes: &[u8], wanted: Wanted) -> Result<Vec<Array>, String> {
        let too_many = || "its shape is larger than any file".to_owned();
        let tuples =
            self.shape.iter().try_fold(1_usize, |all, one| all.checked_mul(*one)).ok_or_else(too_many)?;
        let record: usize = self.fields.iter().map(|field| field.size).sum();
        let size = tuples.checked_mul(record).ok_or_else(too_many)?;
        let data = &bytes[self.start..];
        let data = data.get(..size).ok_or_else(|| {
            format!("its records have {size} bytes and {} are there: the file is cut", data.len())
        })?;
        let mut offset = 0;
        let mut arrays = Vec::new();
        for Field { name, scalar, is_little, components, size } in &self.fields {
            let name = format!("{prefix}{name}");
            let from = offset;
            offset += size;
            let Some(scalar) = scalar else { continue };
            let mut values = Vec::new();
            if wanted.has(&name) {
                let fields = data.chunks_exact(record.max(1)).map(|record| &record[from..from + size]);
                values = scalar.decode(&fields.collect::<Vec<_>>().concat(), *is_little);
            }
            let (on, components) = (Association::Points, *components);
            arrays.push(Array { name, on, components, tuples, values, shape: Vec::new() });
        }
        Ok(arrays)
    }
}

/// Reorders numbers from column-major (first index fastest) to row-major (last index fastest).
fn by_rows(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut strides = vec![1; shape.len()];
    for axis in 1..shape.len() {
        strides[axis] = strides[axis - 1] * shape[axis - 1];
    }
    let place = |mut index: usize| {
        let mut from = 0;
        for axis in (0..shape.len()).rev() {
            from += index % shape[axis] * strides[axis];
            index /= shape[axis];
        }
        from
    };
    (0..values.len()).map(|index| values[place(index)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn npy(header: &str, data: &[u8]) -> Vec<u8> {
        let length = u16::try_from(header.len()).expect("short").to_le_bytes();
        [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), data].concat()
    }

    fn values(bytes: &[u8]) -> Result<Array, String> {
        let names = BTreeSet::from(["a".to_owned()]);
        read_npy(bytes, "a", Wanted(&names)).map(|frame| frame.arrays[0].clone())
    }

    #[test]
    fn columns_first_is_the_same_array() {
        let data: Vec<u8> = [1.0_f64, 3.0, 5.0, 2.0, 4.0, 6.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let header = "{'descr': '<f8', 'fortran_order': True, 'shape': (3, 2), }";
        let array = values(&npy(header, &data)).expect("an array");
        assert_eq!((array.tuples, array.components), (3, 2));
        assert_eq!(array.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn a_shape_beyond_the_file_and_a_pickle_are_refused() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1250000000,), }";
        assert!(values(&npy(header, &[0; 16])).is_err_and(|why| why.contains("cut")));
        let header = "{'descr': '|O', 'fortran_order': False, 'shape': (), }";
        assert!(values(&npy(header, b"cos\nsystem\n")).is_err_and(|why| why.contains("never opened")));
        let header = "{'descr': '<f8', 'shape': (99999999999, 99999999999, 9), }";
        assert!(values(&npy(header, &[])).is_err_and(|why| why.contains("larger than any file")));
    }

    #[test]
    fn fields_of_records_are_arrays() {
        let header = "{'descr': [('t', '<f8'), ('name', '<U1'), ('a', '>i2', (2,)), ('b', '|u1')], 'fortran_order': False, \
                      'shape': (2,), }";
        let record = |time: f64, [one, other]: [i16; 2], last: u8| -> Vec<u8> {
            [&time.to_le_bytes()[..], b"x\0\0\0", &one.to_be_bytes(), &other.to_be_bytes(), &[last]].concat()
        };
        let data = [record(0.5, [1, -2], 9), record(1.5, [3, 4], 8)].concat();
        let names = BTreeSet::from(["t", "a", "b"].map(str::to_owned));
        let arrays = read_npy(&npy(header, &data), "file", Wanted(&names)).expect("records").arrays;
        let told: Vec<(&str, usize, &[f64])> =
            arrays.iter().map(|array| (array.name.as_str(), array.components, &array.values[..])).collect();
        assert_eq!(
            told,
            [("t", 1, &[0.5, 1.5][..]), ("a", 2, &[1.0, -2.0, 3.0, 4.0]), ("b", 1, &[9.0, 8.0])]
        );
        let cut = read_npy(&npy(header, &data[..20]), "file", Wanted(&names));
        assert!(cut.is_err_and(|why| why.contains("the file is cut")));
        let objects = "{'descr': [('t', '<f8'), ('o', '|O')], 'fortran_order': False, 'shape': (1,), }";
        assert!(values(&npy(objects, &[0; 16])).is_err_and(|why| why.contains("never opened")));
    }

    #[test]
    fn the_second_version_has_a_longer_length_of_the_header() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }";
        let length = u32::try_from(header.len()).expect("short").to_le_bytes();
        let data: Vec<u8> = [7.0_f64, 9.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        for version in [2, 3] {
            let start = [b"\x93NUMPY", &[version, 0][..], &length].concat();
            let array = values(&[&start, header.as_bytes(), &data].concat()).expect("an array");
            assert_eq!(array.values, [7.0, 9.0], "version {version}");
        }
    }
}
