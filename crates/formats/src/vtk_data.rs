//! The data of one `DataArray` of VTK's XML files: text, base64 or raw, inline or appended, packed or not.

use crate::bytes::{Budget, Scalar, numbers_of_text, unpack, whole};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;

/// The tag of the appended data.
const MARK: &[u8] = b"<AppendedData";

/// Base64 of programs, which may leave out the padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Data that follow the XML, behind an underscore.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Appended<'a> {
    bytes: &'a [u8],
    is_raw: bool,
}

/// Splits a file into its XML and the appended data, which are not XML.
pub(crate) fn split(bytes: &[u8]) -> Result<(&[u8], Option<Appended<'_>>), String> {
    let Some(end) = bytes.windows(MARK.len()).position(|window| window == MARK) else {
        return Ok((bytes, None));
    };
    let (xml, rest) = bytes.split_at(end);
    let cut = || "its appended data are missing: the file is cut".to_owned();
    let tag = rest.iter().position(|symbol| *symbol == b'>').ok_or_else(cut)?;
    let underscore = rest[tag..].iter().position(|symbol| *symbol == b'_').ok_or_else(cut)?;
    let is_raw = rest[..tag].windows(3).any(|window| window == b"raw");
    Ok((xml, Some(Appended { bytes: &rest[tag + underscore + 1..], is_raw })))
}

/// How a file encodes its data.
#[derive(Clone, Debug)]
pub(crate) struct Encoding<'a> {
    /// Whether the lowest byte of a number comes first.
    pub is_little: bool,
    /// Type of the numbers in the headers.
    pub header: Scalar,
    /// Whether blocks are packed by zlib.
    pub is_packed: bool,
    /// The appended data.
    pub appended: Option<Appended<'a>>,
}

/// Where the numbers of an array are.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<'a> {
    /// Written as text.
    Text(&'a str),
    /// In the XML, as base64.
    Inline(&'a str),
    /// In the appended data, from this byte on.
    Appended(usize),
}

impl Encoding<'_> {
    /// The numbers at a place, and a doubt where the header of the data says otherwise. Any other count than the
    /// expected one is an error.
    pub fn numbers(
        &self,
        place: Place,
        scalar: Scalar,
        expected: Option<usize>,
        budget: &mut Budget,
    ) -> Result<(Vec<f64>, Option<String>), String> {
        let joined: Vec<u8>;
        let mut doubt = None;
        let (data, is_raw) = match place {
            Place::Text(text) => {
                budget.take(4 * text.len() as u64)?;
                let numbers = numbers_of_text(text, expected.unwrap_or(usize::MAX))?;
                return Ok((counted(numbers, expected)?, None));
            }
            Place::Inline(text) => {
                joined = text.bytes().filter(|symbol| !symbol.is_ascii_whitespace()).collect();
                let size = expected.and_then(|expected| expected.checked_mul(scalar.size()));
                if let Some((bytes, declared)) = size.and_then(|size| self.misdeclared(&joined, size)) {
                    doubt = Some(format!(
                        "its header declares {declared} bytes, but there are {}, as many as its numbers \
                         need: they are read",
                        bytes.len()
                    ));
                    budget.take(8 * (bytes.len() / scalar.size()) as u64)?;
                    return Ok((scalar.decode(&bytes, self.is_little), doubt));
                }
                (joined.as_slice(), false)
            }
            Place::Appended(offset) => {
                let appended = self.appended.ok_or("its data are appended, and the file has none")?;
                let data = appended.bytes.get(offset..).ok_or_else(|| {
                    let there = appended.bytes.len();
                    format!("an array begins at byte {offset} of {there} appended ones: the file is cut")
                })?;
                (data, appended.is_raw)
            }
        };
        let bytes = self.bytes(data, is_raw, budget)?;
        if !bytes.len().is_multiple_of(scalar.size()) {
            return Err(format!(
                "it has {} bytes, which is not a multiple of the {} bytes of a number",
                bytes.len(),
                scalar.size()
            ));
        }
        budget.take(8 * (bytes.len() / scalar.size()) as u64)?;
        Ok((counted(scalar.decode(&bytes, self.is_little), expected)?, doubt))
    }

    /// The bytes of inline data that are as many as expected though their header declares another number, and that
    /// number: some writers count wrongly.
    fn misdeclared(&self, data: &[u8], expected: usize) -> Option<(Vec<u8>, usize)> {
        if self.is_packed {
            return None;
        }
        let width = self.header.size();
        let symbols = width.div_ceil(3) * 4;
        let head = BASE64.decode(data.get(..symbols)?).ok()?;
        let declared = *self.sizes(head.get(..width)?).ok()?.first()?;
        if declared == expected {
            return None;
        }
        // Some writers encode the header by itself, which then ends with padding.
        let bytes = if data[..symbols].ends_with(b"=") {
            BASE64.decode(&data[symbols..]).ok()?
        } else {
            BASE64.decode(data).ok()?.split_off(width)
        };
        (bytes.len() == expected).then_some((bytes, declared))
    }

    fn sizes(&self, bytes: &[u8]) -> Result<Vec<usize>, String> {
        whole(&self.header.decode(bytes, self.is_little))
    }

    /// The unpacked bytes of data that begin with a header.
    fn bytes<'b>(&self, data: &'b [u8], is_raw: bool, budget: &mut Budget) -> Result<Cow<'b, [u8]>, String> {
        // Symbols that encode so many bytes.
        let symbols = |bytes: usize| if is_raw { bytes } else { bytes.div_ceil(3).saturating_mul(4) };
        let part = |from: usize, count: usize| -> Result<Cow<'b, [u8]>, String> {
            let found = from.checked_add(symbols(count)).and_then(|end| data.get(from..end));
            let cut = || {
                let there = data.len().saturating_sub(from);
                format!("{count} bytes are declared and {there} symbols are there: the file is cut")
            };
            let found = found.ok_or_else(cut)?;
            if is_raw {
                return Ok(found.into());
            }
            let mut decoded =
                BASE64.decode(found).map_err(|error| format!("its base64 is damaged: {error}"))?;
            if decoded.len() < count {
                return Err(cut());
            }
            decoded.truncate(count);
            Ok(decoded.into())
        };
        let width = self.header.size();
        let first = self.sizes(&part(0, width)?)?[0];
        if !self.is_packed {
            // Some writers encode the header by itself, which then ends with padding.
            if is_raw || data[..symbols(width)].ends_with(b"=") {
                return part(symbols(width), first);
            }
            let mut bytes = part(0, first.saturating_add(width))?.into_owned();
            bytes.drain(..width);
            return Ok(bytes.into());
        }
        // Number of blocks, size of a block, size of the last one, packed sizes.
        let head = first.checked_add(3).and_then(|entries| entries.checked_mul(width));
        let head = head.filter(|head| *head <= data.len().max(3 * width)).ok_or_else(|| {
            format!(
                "{first} compressed blocks are declared in {} bytes: the file is damaged or cut",
                data.len()
            )
        })?;
        let header = self.sizes(&part(0, head)?)?;
        let (block, last, sizes) = (header[1], header[2], &header[3..]);
        let total = sizes.iter().try_fold(0_usize, |sum, size| sum.checked_add(*size));
        let total = total.ok_or("its compressed blocks are larger than any file")?;
        let packed = part(symbols(head), total)?;
        let length_of = |place: usize| if place + 1 == sizes.len() && last > 0 { last } else { block };
        // What all blocks claim together is taken before any is unpacked.
        for place in 0..sizes.len() {
            budget.take(length_of(place) as u64)?;
        }
        let mut bytes = Vec::new();
        let mut rest = &packed[..];
        for (place, size) in sizes.iter().enumerate() {
            let (own, after) = rest.split_at(*size);
            bytes.extend(unpack(own, length_of(place), true)?);
            rest = after;
        }
        Ok(bytes.into())
    }
}

fn counted(numbers: Vec<f64>, expected: Option<usize>) -> Result<Vec<f64>, String> {
    match expected {
        Some(expected) if expected != numbers.len() => {
            Err(format!("it holds {} numbers, and {expected} are declared", numbers.len()))
        }
        _ => Ok(numbers),
    }
}
