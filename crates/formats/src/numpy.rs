//! Arrays of `NumPy`: `.npy`, and `.npz`, a zip of them.
//!
//! Format: "NEP 1"; zip: PKWARE's APPNOTE, with the entries of 64 bits that `NumPy` writes. Objects that were pickled are
//! programs and not read; they are skipped with a word. Every member is held against its checksum.

use crate::bytes::{Budget, Scalar, inflate, short};
use crate::frame::{Array, Association, Frame, Wanted};

/// Reads an `.npz`.
///
/// # Errors
/// What is damaged, cut or claims too much.
pub fn read_npz(bytes: &[u8], wanted: Wanted) -> Result<Frame, String> {
    let mut budget = Budget::of_file(bytes.len());
    let mut frame = Frame::default();
    let mut skipped = Vec::new();
    let entries = entries_of(bytes)?;
    // What all members claim together, before any is unpacked.
    for entry in &entries {
        budget.take(entry.size)?;
    }
    for entry in entries {
        let name = entry.name.strip_suffix(".npy").unwrap_or(&entry.name).to_owned();
        let of_member = |why: String| format!("the member `{name}`: {why}");
        let content = entry.content(bytes).map_err(of_member)?;
        let header = header_of(&content).map_err(of_member)?;
        match header.scalar {
            Some(_) => frame.arrays.push(header.array(name.clone(), &content, wanted).map_err(of_member)?),
            None => skipped.push(format!("`{name}` ({})", short(&header.kind))),
        }
    }
    if !skipped.is_empty() {
        frame.notes.push(format!(
            "left out {}: no plain numbers, and a pickled object is never opened",
            skipped.join(", ")
        ));
    }
    Ok(frame)
}

/// Reads an `.npy`, as an array by a name.
///
/// # Errors
/// What is damaged, cut or no plain numbers.
pub fn read_npy(bytes: &[u8], name: &str, wanted: Wanted) -> Result<Frame, String> {
    let header = header_of(bytes)?;
    if header.scalar.is_none() {
        return Err(format!("its numbers are `{}`: a pickled object is never opened", short(&header.kind)));
    }
    Ok(Frame { arrays: vec![header.array(name.to_owned(), bytes, wanted)?], ..Frame::default() })
}

/// What stands before the numbers of an array.
struct Header {
    kind: String,
    scalar: Option<Scalar>,
    is_little: bool,
    is_by_columns: bool,
    shape: Vec<usize>,
    start: usize,
}

fn header_of(bytes: &[u8]) -> Result<Header, String> {
    let cut = || "its header is cut".to_owned();
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err("it is no array of NumPy".to_owned());
    }
    let is_short = *bytes.get(6).ok_or_else(cut)? == 1;
    let (length, from) = if is_short { (number::<2>(bytes, 8)?, 10) } else { (number::<4>(bytes, 8)?, 12) };
    let length = place(length)?;
    let start = from + length;
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
    let scalar = match kind.get(1..) {
        Some("f8") => Some(Scalar::F64),
        Some("f4") => Some(Scalar::F32),
        Some("i8") => Some(Scalar::I64),
        Some("i4") => Some(Scalar::I32),
        Some("i2") => Some(Scalar::I16),
        Some("i1") => Some(Scalar::I8),
        Some("u8") => Some(Scalar::U64),
        Some("u4") => Some(Scalar::U32),
        Some("u2") => Some(Scalar::U16),
        Some("u1" | "b1") => Some(Scalar::U8),
        _ => None,
    };
    Ok(Header {
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
        let too_many = || "its shape has more numbers than any file".to_owned();
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
        Ok(Array { name, on, components: components.max(1), tuples, values })
    }
}

/// Numbers that stand with the first index fastest, with the last one fastest.
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

/// A member of a zip.
struct Entry {
    name: String,
    method: u64,
    /// Checksum of what it unpacks to: CRC-32.
    checksum: u64,
    packed: u64,
    size: u64,
    start: u64,
}

/// A number of the lowest byte first.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Result<u64, String> {
    let found = at.checked_add(N).and_then(|end| bytes.get(at..end));
    let found = found.ok_or_else(|| "its list of members is cut".to_owned())?;
    Ok(found.iter().rev().fold(0, |number, byte| (number << 8) | u64::from(*byte)))
}

fn place(number: u64) -> Result<usize, String> {
    usize::try_from(number).map_err(|_| "a member lies beyond any file".to_owned())
}

/// Members of a zip, from the list at its end.
fn entries_of(bytes: &[u8]) -> Result<Vec<Entry>, String> {
    let from = bytes.len().saturating_sub(66_000);
    let end = bytes[from..].windows(4).rposition(|mark| mark == b"PK\x05\x06");
    let end = from + end.ok_or("it has no list of members at its end: the file is cut")?;
    let mut list_end = end;
    let mut count = number::<2>(bytes, end + 10)?;
    let mut at = number::<4>(bytes, end + 16)?;
    if at == 0xffff_ffff || count == 0xffff {
        let wide = bytes[from..end].windows(4).rposition(|mark| mark == b"PK\x06\x06");
        let wide = from + wide.ok_or("its list of members is cut")?;
        (count, at) = (number::<8>(bytes, wide + 32)?, number::<8>(bytes, wide + 48)?);
        list_end = wide;
    }
    let mut entries = Vec::new();
    let mut at = place(at)?;
    for _ in 0..count {
        if number::<4>(bytes, at)? != 0x0201_4b50 {
            return Err("its list of members is damaged".to_owned());
        }
        let (method, checksum) = (number::<2>(bytes, at + 10)?, number::<4>(bytes, at + 16)?);
        let (mut packed, mut size) = (number::<4>(bytes, at + 20)?, number::<4>(bytes, at + 24)?);
        let name_length = place(number::<2>(bytes, at + 28)?)?;
        let extra_length = place(number::<2>(bytes, at + 30)?)?;
        let comment_length = place(number::<2>(bytes, at + 32)?)?;
        let mut start = number::<4>(bytes, at + 42)?;
        let name = bytes.get(at + 46..at + 46 + name_length).ok_or("its list of members is cut")?;
        let extra = bytes.get(at + 46 + name_length..at + 46 + name_length + extra_length);
        let extra = extra.ok_or("its list of members is cut")?;
        widen(extra, [&mut size, &mut packed, &mut start])?;
        let name = String::from_utf8_lossy(name).into_owned();
        entries.push(Entry { name, method, checksum, packed, size, start });
        at += 46 + name_length + extra_length + comment_length;
    }
    if at != list_end {
        return Err(format!("its list of members does not end behind the {count} that it counts"));
    }
    Ok(entries)
}

/// Replaces numbers that do not fit 32 bits by those of the extra field.
fn widen(extra: &[u8], numbers: [&mut u64; 3]) -> Result<(), String> {
    let mut at = 0;
    while at + 4 <= extra.len() {
        let (tag, length) = (number::<2>(extra, at)?, place(number::<2>(extra, at + 2)?)?);
        if tag == 1 {
            let mut from = at + 4;
            for wide in numbers {
                if *wide == 0xffff_ffff {
                    *wide = number::<8>(extra, from)?;
                    from += 8;
                }
            }
            return Ok(());
        }
        at += 4 + length;
    }
    Ok(())
}

impl Entry {
    fn content<'a>(&self, bytes: &'a [u8]) -> Result<std::borrow::Cow<'a, [u8]>, String> {
        let start = place(self.start)?;
        if number::<4>(bytes, start)? != 0x0403_4b50 {
            return Err("it does not begin where the list says".to_owned());
        }
        let name_length = place(number::<2>(bytes, start + 26)?)?;
        let skip = 30 + name_length + place(number::<2>(bytes, start + 28)?)?;
        let name = bytes.get(start + 30..start + 30 + name_length).ok_or("it is cut")?;
        if String::from_utf8_lossy(name) != self.name || number::<2>(bytes, start + 8)? != self.method {
            return Err("it is not what the list says: the file is damaged".to_owned());
        }
        let end = (start + skip).checked_add(place(self.packed)?);
        let packed = end.and_then(|end| bytes.get(start + skip..end)).ok_or("it is cut")?;
        let content: std::borrow::Cow<'a, [u8]> = match self.method {
            0 if self.size == self.packed => packed.into(),
            8 => {
                let mut content = Vec::new();
                inflate(packed, place(self.size)?, &mut content)?;
                content.into()
            }
            0 => return Err(format!("it is not packed, and {} bytes are {}", self.packed, self.size)),
            method => return Err(format!("it is packed by method {method}; NumPy writes 0 and 8")),
        };
        let found = u64::from(crc32fast::hash(&content));
        if found != self.checksum {
            return Err(format!(
                "its checksum is {found:08x}, and {:08x} was written: the file is damaged",
                self.checksum
            ));
        }
        Ok(content)
    }
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
        assert!(values(&npy(header, &[])).is_err_and(|why| why.contains("more numbers")));
    }
}
