//! The payload of one `DataArray` of VTK's XML files: text, base64, appended, packed or not.

use crate::appended::{Appended, Raw};
use crate::bytes::{Budget, Scalar, base64, counts, decode_text_as, unzlib};
use std::borrow::Cow;

/// How a file keeps its data.
#[derive(Clone, Debug)]
pub struct Payloads<'a> {
    /// Whether the lowest byte stands first.
    pub is_little: bool,
    /// Kind of the numbers in the headers.
    pub header: Scalar,
    /// Whether blocks are packed by zlib.
    pub is_packed: bool,
    /// What stands behind the underscore of `AppendedData`.
    pub appended: Option<Appended<'a>>,
}

/// Where the numbers of an array stand.
#[derive(Clone, Copy, Debug)]
pub enum Place<'a> {
    /// In a text, as written numbers.
    Ascii(&'a [u8]),
    /// In a text, as base64.
    Inline(&'a [u8]),
    /// So many bytes into the appended data.
    Appended(usize),
}

impl Payloads<'_> {
    /// The numbers at a place, each taken as what it stands for; `expected` of them, where that is known.
    ///
    /// # Errors
    /// When they are damaged, cut, not as many as expected, or one stands for nothing.
    pub fn take<T>(
        &self,
        place: Place,
        scalar: Scalar,
        expected: Option<usize>,
        budget: &mut Budget,
        take: impl Fn(f64) -> Result<T, String>,
    ) -> Result<Vec<T>, String> {
        let all = if let Place::Ascii(text) = place {
            budget.take(4 * text.len() as u64)?;
            decode_text_as(text, expected.unwrap_or(usize::MAX), take)?
        } else {
            let bytes = self.bytes(place, budget)?;
            if !bytes.len().is_multiple_of(scalar.size()) {
                return Err(format!(
                    "its {} bytes are no whole numbers of {} bytes",
                    bytes.len(),
                    scalar.size()
                ));
            }
            budget.take(8 * (bytes.len() / scalar.size()) as u64)?;
            scalar.decode_as(&bytes, self.is_little, take)?
        };
        match expected {
            Some(expected) if expected != all.len() => {
                Err(format!("it holds {} numbers, and {expected} are declared", all.len()))
            }
            _ => Ok(all),
        }
    }

    /// The bytes at a place, unpacked.
    fn bytes<'b>(&'b self, place: Place<'b>, budget: &mut Budget) -> Result<Cow<'b, [u8]>, String> {
        match place {
            Place::Ascii(text) => Ok(text.into()),
            Place::Inline(text) => Ok(self.of_base64(text.trim_ascii(), budget)?.into()),
            Place::Appended(offset) => {
                let beyond = |there: usize| {
                    format!("an array begins at the byte {offset} of {there} appended ones: the file is cut")
                };
                match self.appended.ok_or("its data are appended, and nothing is")? {
                    Appended::Raw(data) if offset <= data.count() => self.of_raw(data, offset, budget),
                    Appended::Raw(data) => Err(beyond(data.count())),
                    Appended::Base64(data) => {
                        let data = data.get(offset..).ok_or_else(|| beyond(data.len()))?;
                        Ok(self.of_base64(data, budget)?.into())
                    }
                }
            }
        }
    }

    fn sizes(&self, bytes: &[u8]) -> Result<Vec<usize>, String> {
        counts(&self.header.decode(bytes, self.is_little))
    }

    /// Bytes behind the header with which raw ones begin, unpacked.
    fn of_raw<'b>(&self, data: Raw<'b>, offset: usize, budget: &mut Budget) -> Result<Cow<'b, [u8]>, String> {
        let width = self.header.size();
        let first = self.sizes(&data.part(offset, width)?)?[0];
        if !self.is_packed {
            return data.part(offset + width, first);
        }
        let head = packed_head(first, width, data.count() - offset)?;
        let header = self.sizes(&data.part(offset, head)?)?;
        let packed = data.part(offset + head, blocks_of(&header)?)?;
        Ok(unpacked(&header, &packed, budget)?.into())
    }

    /// Bytes of base64 that begins with a header, unpacked.
    fn of_base64(&self, text: &[u8], budget: &mut Budget) -> Result<Vec<u8>, String> {
        let spaced = text.iter().take(1 << 16).any(u8::is_ascii_whitespace) && self.appended.is_none();
        let joined: Vec<u8>;
        let text = if spaced {
            joined = text.iter().copied().filter(|symbol| !symbol.is_ascii_whitespace()).collect();
            &joined
        } else {
            text
        };
        let width = self.header.size();
        let part = |from: usize, bytes: usize| {
            let symbols = bytes.div_ceil(3).checked_mul(4).and_then(|symbols| symbols.checked_add(from));
            let text = symbols.and_then(|end| text.get(from..end)).ok_or_else(|| {
                let there = text.len().saturating_sub(from) / 4 * 3;
                format!("{bytes} bytes are declared and {there} are there: the file is cut")
            })?;
            let found = base64(text)?;
            match found.len().checked_sub(bytes) {
                Some(_) => Ok(found),
                None => Err(format!("{bytes} bytes are declared and {} are there", found.len())),
            }
        };
        let first = self.sizes(&part(0, width)?[..width])?[0];
        let symbols = width.div_ceil(3) * 4;
        if !self.is_packed {
            // Some writers encode the header by itself, which then ends with padding.
            let is_alone = text[..symbols].ends_with(b"=");
            let (from, skip) = if is_alone { (symbols, 0) } else { (0, width) };
            let length = first.checked_add(skip).ok_or("it declares more bytes than there can be")?;
            let mut bytes = part(from, length)?;
            bytes.truncate(length);
            bytes.drain(..skip);
            return Ok(bytes);
        }
        let head = packed_head(first, width, text.len())?;
        let header = self.sizes(&part(0, head)?[..head])?;
        let packed = part(head.div_ceil(3) * 4, blocks_of(&header)?)?;
        unpacked(&header, &packed, budget)
    }
}

/// Bytes of the header of packed data: number of blocks, size of one, size of the last, packed sizes.
fn packed_head(blocks: usize, width: usize, there: usize) -> Result<usize, String> {
    let head = blocks.checked_add(3).and_then(|entries| entries.checked_mul(width));
    head.filter(|head| *head <= there.max(3 * width)).ok_or_else(|| {
        format!("{blocks} packed blocks are declared in {there} bytes: the file is damaged or cut")
    })
}

/// Bytes of all packed blocks together.
fn blocks_of(header: &[usize]) -> Result<usize, String> {
    let sum = header[3..].iter().try_fold(0_usize, |sum, size| sum.checked_add(*size));
    sum.ok_or_else(|| "the packed blocks are larger than any file".to_owned())
}

/// The blocks of a header, unpacked one after the other.
fn unpacked(header: &[usize], packed: &[u8], budget: &mut Budget) -> Result<Vec<u8>, String> {
    let (block, last, sizes) = (header[1], header[2], &header[3..]);
    let length_of = |place: usize| if place + 1 == sizes.len() && last > 0 { last } else { block };
    // What all blocks claim together, before any is unpacked.
    for place in 0..sizes.len() {
        budget.take(length_of(place) as u64)?;
    }
    let mut bytes = Vec::new();
    let mut from = 0;
    for (place, size) in sizes.iter().enumerate() {
        let length = length_of(place);
        unzlib(&packed[from..from + size], length, &mut bytes)?;
        from += size;
    }
    Ok(bytes)
}
