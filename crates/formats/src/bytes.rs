//! Numbers from bytes: scalars of both byte orders, base64, zlib, all within a budget.

use flate2::{Decompress, FlushDecompress, Status};

/// Most bytes that one byte of deflate can become (zlib's technical notes), with some air.
const DEFLATE_RATIO: u64 = 1040;
/// What any file may become in memory, bytes.
const ANY_FILE: u64 = 256 << 20;
/// What a byte of a file may become in memory beyond that.
const PER_BYTE: u64 = 64;

/// Digits of a whole number that is exact in double precision, whatever they are.
const EXACT_DIGITS: usize = 15;

/// How much a file may still become in memory: a small file that claims much is refused, not tried.
#[derive(Clone, Debug)]
pub struct Budget {
    left: u64,
}

impl Budget {
    /// The budget of a file of a size, bytes.
    pub fn of_file(size: usize) -> Self {
        Self { left: ANY_FILE.saturating_add((size as u64).saturating_mul(PER_BYTE)) }
    }

    /// Takes bytes from it.
    ///
    /// # Errors
    /// When there are not so many left.
    pub fn take(&mut self, bytes: u64) -> Result<(), String> {
        match self.left.checked_sub(bytes) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(format!(
                "it claims {bytes} bytes more than the {} that a file of its size may hold",
                self.left
            )),
        }
    }
}

/// Kinds of numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 64 bits.
    U64,
    /// Floating point, 32 bits.
    F32,
    /// Floating point, 64 bits.
    F64,
}

impl Scalar {
    /// Bytes of one.
    pub const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// By the name that VTK's XML files use.
    pub fn of_xml(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    /// By the name that VTK's legacy files use; `long` has eight bytes.
    pub fn of_legacy(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "signed_char" | "vtktypeint8" => Self::I8,
            "unsigned_char" | "vtktypeuint8" => Self::U8,
            "short" | "vtktypeint16" => Self::I16,
            "unsigned_short" | "vtktypeuint16" => Self::U16,
            "int" | "vtktypeint32" => Self::I32,
            "unsigned_int" | "vtktypeuint32" => Self::U32,
            "long" | "vtktypeint64" | "vtkidtype" => Self::I64,
            "unsigned_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    /// The numbers of bytes; a rest that is no whole number is left.
    pub fn decode(self, bytes: &[u8], is_little: bool) -> Vec<f64> {
        self.decode_as(bytes, is_little, Ok).unwrap_or_default()
    }

    /// The same as something else than numbers, like places in a list.
    ///
    /// # Errors
    /// Why a number is none of these.
    pub fn decode_as<T>(
        self,
        bytes: &[u8],
        is_little: bool,
        take: impl Fn(f64) -> Result<T, String>,
    ) -> Result<Vec<T>, String> {
        let mut all = Vec::with_capacity(bytes.len() / self.size());
        macro_rules! numbers {
            ($kind:ty, $size:literal, $as:expr) => {
                for chunk in bytes.chunks_exact($size) {
                    let chunk: [u8; $size] = chunk.try_into().unwrap_or_default();
                    let number =
                        if is_little { <$kind>::from_le_bytes(chunk) } else { <$kind>::from_be_bytes(chunk) };
                    all.push(take($as(number))?);
                }
            };
        }
        match self {
            Self::I8 => numbers!(i8, 1, f64::from),
            Self::U8 => numbers!(u8, 1, f64::from),
            Self::I16 => numbers!(i16, 2, f64::from),
            Self::U16 => numbers!(u16, 2, f64::from),
            Self::I32 => numbers!(i32, 4, f64::from),
            Self::U32 => numbers!(u32, 4, f64::from),
            Self::I64 => numbers!(i64, 8, |number| number as f64),
            Self::U64 => numbers!(u64, 8, |number| number as f64),
            Self::F32 => numbers!(f32, 4, f64::from),
            Self::F64 => numbers!(f64, 8, std::convert::identity),
        }
        Ok(all)
    }
}

/// Whole numbers, as places and counts.
///
/// # Errors
/// When one is negative or has a fraction.
pub fn counts(numbers: &[f64]) -> Result<Vec<usize>, String> {
    numbers.iter().map(|number| as_count(*number)).collect()
}

/// A number as a count.
///
/// # Errors
/// When it is negative or has a fraction.
pub fn as_count(number: f64) -> Result<usize, String> {
    count(number).ok_or_else(|| format!("{number} is no place in a list"))
}

/// A number as a count, where it is one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "held to be a whole number below 2^53"
)]
pub fn count(number: f64) -> Option<usize> {
    (number >= 0.0 && number.fract() == 0.0 && number < 9.0e15).then_some(number as usize)
}

/// The numbers of a text, parted by white space.
///
/// # Errors
/// The first word that is no number, or more numbers than `most`.
pub fn numbers_of_text(text: &[u8], most: usize) -> Result<Vec<f64>, String> {
    decode_text_as(text, most, Ok)
}

/// The same as something else than numbers.
///
/// # Errors
/// As above, and why a number is none of these.
pub fn decode_text_as<T>(
    text: &[u8],
    most: usize,
    take: impl Fn(f64) -> Result<T, String>,
) -> Result<Vec<T>, String> {
    let mut all = Vec::new();
    for word in text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
        if all.len() == most {
            return Err(format!("there are more than the {most} numbers declared"));
        }
        all.push(take(number_of_word(word)?)?);
    }
    Ok(all)
}

/// One number of a text.
///
/// # Errors
/// When it is none.
pub fn number_of_word(word: &[u8]) -> Result<f64, String> {
    // Half of the numbers of a mesh are counts, and these are exact.
    if word.len() <= EXACT_DIGITS && word.iter().all(u8::is_ascii_digit) && !word.is_empty() {
        let number = word.iter().fold(0_u64, |number, digit| 10 * number + u64::from(digit - b'0'));
        return Ok(number as f64);
    }
    let typed = String::from_utf8_lossy(word);
    typed.parse().map_err(|_| format!("`{}` is no number", short(&typed)))
}

/// The beginning of a text that may be long.
pub fn short(text: &str) -> String {
    text.chars().take(40).collect()
}

/// What each character of base64 stands for; 255 where it is none.
const DIGITS: [u8; 256] = digits();

const fn digits() -> [u8; 256] {
    let mut digits = [255; 256];
    let symbols = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut digit = 0_u8;
    while digit < 64 {
        digits[symbols[digit as usize] as usize] = digit;
        digit += 1;
    }
    digits
}

/// The bytes of base64, up to its end or its first padding.
///
/// # Errors
/// When a character is none of base64's, or the text ends inside a byte.
pub fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let mut by_fours = 0;
    for four in text.chunks_exact(4) {
        let digits = [four[0], four[1], four[2], four[3]].map(|symbol| DIGITS[usize::from(symbol)]);
        if digits.iter().any(|digit| *digit > 63) {
            break;
        }
        let [a, b, c, d] = digits;
        bytes.extend_from_slice(&[(a << 2) | (b >> 4), (b << 4) | (c >> 2), (c << 6) | d]);
        by_fours += 4;
    }
    let (mut bits, mut held) = (0_u32, 0_u32);
    let mut digits = 0_usize;
    for symbol in &text[by_fours..] {
        let digit = match (DIGITS[usize::from(*symbol)], symbol) {
            (digit @ 0..=63, _) => digit,
            (_, b'=') => break,
            (_, b' ' | b'\n' | b'\r' | b'\t') => continue,
            _ => return Err(format!("`{}` is no character of base64", char::from(*symbol))),
        };
        digits += 1;
        bits = (bits << 6) | u32::from(digit);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push(u8::try_from((bits >> held) & 0xff).unwrap_or_default());
        }
    }
    if digits % 4 == 1 {
        return Err("base64 ends inside a byte: the file is cut".to_owned());
    }
    Ok(bytes)
}

/// Unpacks zlib's format into bytes of a known length, appended.
///
/// # Errors
/// When they are not that many, their checksum (Adler-32) is another, or it is no zlib at all.
pub fn unzlib(packed: &[u8], length: usize, into: &mut Vec<u8>) -> Result<(), String> {
    unpack(Decompress::new(true), packed, length, into)
}

/// The same of bare deflate, as in a zip.
///
/// # Errors
/// As above.
pub fn inflate(packed: &[u8], length: usize, into: &mut Vec<u8>) -> Result<(), String> {
    unpack(Decompress::new(false), packed, length, into)
}

/// Unpacks up to the end that the packed data state themselves, behind which zlib holds the bytes against their
/// checksum: one that is never reached was never held.
fn unpack(mut unpacker: Decompress, packed: &[u8], length: usize, into: &mut Vec<u8>) -> Result<(), String> {
    if length as u64 > DEFLATE_RATIO * packed.len() as u64 {
        return Err(format!("{} packed bytes cannot hold the {length} that they claim", packed.len()));
    }
    let before = into.len();
    // One more shows that there is more.
    into.reserve_exact(length + 1);
    let mut rest = packed;
    loop {
        let (taken, made) = (unpacker.total_in(), unpacker.total_out());
        let status = unpacker.decompress_vec(rest, into, FlushDecompress::None);
        let status = status.map_err(|error| format!("its packed data are damaged: {error}"))?;
        let found = into.len() - before;
        let moved = unpacker.total_in() - taken;
        rest = &rest[usize::try_from(moved).unwrap_or(rest.len()).min(rest.len())..];
        if status == Status::StreamEnd && found == length {
            return Ok(());
        }
        if status == Status::StreamEnd || found > length {
            let more = if found > length { "more" } else { "less" };
            return Err(format!("its packed data hold {more} than the {length} bytes that they claim"));
        }
        if moved == 0 && unpacker.total_out() == made {
            return Err("its packed data end before their checksum: the file is cut".to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9v\nYmFy", "foobar")]
        {
            assert_eq!(base64(text.as_bytes()).expect("base64"), bytes.as_bytes());
        }
        assert!(base64(b"Zm9vY").is_err_and(|why| why.contains("cut")));
        assert!(base64(b"Zm!v").is_err());
    }

    #[test]
    fn a_claim_beyond_what_can_be_packed_is_not_tried() {
        let mut into = Vec::new();
        let refused = unzlib(&[0x78, 0x9c, 0x03, 0, 0, 0, 0, 1], 10_000_000_000, &mut into);
        assert!(refused.is_err_and(|why| why.contains("cannot hold")));
        assert!(into.capacity() < 100);
        assert!(Budget::of_file(1000).take(10_000_000_000).is_err());
    }

    #[test]
    fn words_are_the_numbers_that_the_standard_reads() {
        for word in ["0", "7", "0042", "999999999999999", "9999999999999999", "-3", "1e3", "0.1", "inf", "+5"]
        {
            let expected: f64 = word.parse().expect("a number");
            assert_eq!(number_of_word(word.as_bytes()), Ok(expected), "{word}");
        }
        for word in ["", "-", "1x", "0x10", "1_000"] {
            assert!(number_of_word(word.as_bytes()).is_err(), "{word}");
        }
    }

    #[test]
    fn numbers_of_both_byte_orders() {
        assert_eq!(Scalar::F64.decode(&1.5_f64.to_le_bytes(), true), [1.5]);
        assert_eq!(Scalar::F32.decode(&1.5_f32.to_be_bytes(), false), [1.5]);
        assert_eq!(Scalar::I16.decode(&[0xff, 0xfe, 0x01], false), [-2.0]);
    }
}
