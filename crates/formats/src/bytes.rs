//! Numbers from bytes and text, and unpacking, all within a memory budget.

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_with_limit, decompress_to_vec_zlib_with_limit};

/// Most bytes that one byte of deflate can become (zlib's technical notes), with a margin.
const DEFLATE_RATIO: u64 = 1040;
/// Memory that any file may take, bytes.
const ANY_FILE: u64 = 256 << 20;
/// Memory that a file may take beyond that, per byte of its size.
const PER_BYTE: u64 = 64;

/// Memory that a file may still take: a small file that claims much is refused before anything is allocated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Budget {
    left: u64,
}

impl Budget {
    /// The budget of a file of a size in bytes.
    pub fn of_file(size: usize) -> Self {
        Self { left: ANY_FILE.saturating_add((size as u64).saturating_mul(PER_BYTE)) }
    }

    /// Takes bytes from the budget, if enough are left.
    pub(crate) fn take(&mut self, bytes: u64) -> Result<(), String> {
        let left = self.left.checked_sub(bytes);
        self.left = left.ok_or_else(|| {
            format!("it declares {bytes} bytes, but a file of its size can hold only {} more", self.left)
        })?;
        Ok(())
    }
}

/// Types of numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Types with `NumPy`'s code, whose digit is the size in bytes, and their names in VTK's XML and legacy files.
const SCALARS: [(Scalar, &str, &str, &[&str]); 10] = [
    (Scalar::I8, "i1", "Int8", &["char", "signed_char"]),
    (Scalar::U8, "u1", "UInt8", &["unsigned_char"]),
    (Scalar::I16, "i2", "Int16", &["short"]),
    (Scalar::U16, "u2", "UInt16", &["unsigned_short"]),
    (Scalar::I32, "i4", "Int32", &["int"]),
    (Scalar::U32, "u4", "UInt32", &["unsigned_int"]),
    (Scalar::I64, "i8", "Int64", &["long", "vtkidtype"]),
    (Scalar::U64, "u8", "UInt64", &["unsigned_long"]),
    (Scalar::F32, "f4", "Float32", &["float"]),
    (Scalar::F64, "f8", "Float64", &["double"]),
];

impl Scalar {
    /// Size in bytes.
    pub const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The type of a `NumPy` code without the byte order, like `f8`; truth values are bytes.
    pub fn of_code(code: &str) -> Option<Self> {
        let code = if code == "b1" { "u1" } else { code };
        SCALARS.iter().find(|(_, known, ..)| *known == code).map(|found| found.0)
    }

    /// The type of a name in VTK's XML files.
    pub fn of_xml(name: &str) -> Option<Self> {
        SCALARS.iter().find(|(_, _, known, _)| *known == name).map(|found| found.0)
    }

    /// The type of a name in VTK's legacy files; `long` has eight bytes.
    pub fn of_legacy(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let is_name = |(_, _, xml, names): &&(Scalar, &str, &str, &[&str])| {
            names.contains(&name.as_str())
                || name.strip_prefix("vtktype").is_some_and(|rest| rest.eq_ignore_ascii_case(xml))
        };
        SCALARS.iter().find(is_name).map(|found| found.0)
    }

    /// The numbers in bytes; an incomplete number at the end is ignored.
    pub fn decode(self, bytes: &[u8], is_little: bool) -> Vec<f64> {
        macro_rules! numbers {
            ($kind:ty, $to_f64:expr) => {{
                let from_bytes = if is_little { <$kind>::from_le_bytes } else { <$kind>::from_be_bytes };
                let (numbers, _) = bytes.as_chunks();
                numbers.iter().map(|number| $to_f64(from_bytes(*number))).collect()
            }};
        }
        match self {
            Self::I8 => numbers!(i8, f64::from),
            Self::U8 => numbers!(u8, f64::from),
            Self::I16 => numbers!(i16, f64::from),
            Self::U16 => numbers!(u16, f64::from),
            Self::I32 => numbers!(i32, f64::from),
            Self::U32 => numbers!(u32, f64::from),
            Self::I64 => numbers!(i64, |number| number as f64),
            Self::U64 => numbers!(u64, |number| number as f64),
            Self::F32 => numbers!(f32, f64::from),
            Self::F64 => numbers!(f64, std::convert::identity),
        }
    }
}

/// Numbers as counts, indices or codes: whole, not negative, and within the range of the type.
pub(crate) fn whole<T: TryFrom<u64>>(numbers: &[f64]) -> Result<Vec<T>, String> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to be a whole number below 2^53"
    )]
    let one = |number: &f64| {
        let is_whole = *number >= 0.0 && number.fract() == 0.0 && *number < 9.0e15;
        let found = is_whole.then_some(*number as u64).and_then(|number| T::try_from(number).ok());
        found.ok_or_else(|| format!("{number} is invalid: expected a count or an index"))
    };
    numbers.iter().map(one).collect()
}

/// The numbers of a text, separated by white space; more than `most` are an error.
pub(crate) fn numbers_of_text(text: &str, most: usize) -> Result<Vec<f64>, String> {
    let mut all = Vec::new();
    for word in text.split_ascii_whitespace() {
        if all.len() == most {
            return Err(format!("there are more than the {most} numbers declared"));
        }
        all.push(number_of_word(word)?);
    }
    Ok(all)
}

/// One number.
pub(crate) fn number_of_word(word: &str) -> Result<f64, String> {
    let number = bare_number(word);
    let parsed = number.parse().ok().or_else(|| with_exponent(number)?.parse().ok());
    parsed.ok_or_else(|| format!("`{}` is not a number", excerpt(word)))
}

/// A number that Fortran wrote with an exponent of three digits, for which it has no room for the letter: `0.573-104`.
pub fn with_exponent(number: &str) -> Option<String> {
    let at = number.rfind(['+', '-']).filter(|at| *at > 0)?;
    let (mantissa, exponent) = number.split_at(at);
    let is_whole = exponent.len() == 4 && exponent[1..].bytes().all(|digit| digit.is_ascii_digit());
    let is_fraction =
        mantissa.contains('.') && mantissa.ends_with(|last: char| last.is_ascii_digit() || last == '.');
    (is_whole && is_fraction).then(|| format!("{mantissa}e{exponent}"))
}

/// A number without the type that Python shows around it since numpy 2: meshio 5.3 writes `np.float64(1.5)` into gmsh's files.
pub fn bare_number(word: &str) -> &str {
    let inside = word.strip_prefix("np.").and_then(|rest| rest.strip_suffix(')')?.split_once('('));
    let is_number =
        |kind: &str| kind.starts_with("float") || kind.starts_with("int") || kind.starts_with("uint");
    inside.filter(|(kind, _)| is_number(kind)).map_or(word, |(_, number)| number)
}

/// The first 40 letters of a text that may be long, for a message.
pub fn excerpt(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Unpacks deflate, in zlib's wrapper or without one, into bytes of a known length. The data must end as they say
/// themselves: behind that end zlib compares the bytes with their checksum (Adler-32).
pub(crate) fn unpack(packed: &[u8], length: usize, is_zlib: bool) -> Result<Vec<u8>, String> {
    if length as u64 > DEFLATE_RATIO * packed.len() as u64 {
        return Err(format!("{} compressed bytes cannot hold the {length} that they declare", packed.len()));
    }
    let unpacked = if is_zlib {
        decompress_to_vec_zlib_with_limit(packed, length)
    } else {
        decompress_to_vec_with_limit(packed, length)
    };
    match unpacked {
        Ok(bytes) if bytes.len() == length => Ok(bytes),
        Ok(_) => Err(format!("its compressed data hold fewer than the {length} bytes that they declare")),
        Err(error) if error.status == TINFLStatus::HasMoreOutput => {
            Err(format!("its compressed data hold more than the {length} bytes that they declare"))
        }
        Err(_) => Err("its compressed data are damaged, or cut before their checksum".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponent_of_three_digits_needs_no_letter() {
        for (word, number) in
            [("0.573-104", 0.573e-104), ("-1.5+100", -1.5e100), ("1.-123", 1e-123), ("2e-3", 2e-3)]
        {
            assert_eq!(number_of_word(word), Ok(number), "{word}");
        }
        for word in ["573-104", "0.573-10", "0.573-1044", "1-2", "a.5-104", "0.5e3-104"] {
            assert!(number_of_word(word).is_err(), "{word}");
        }
    }

    #[test]
    fn a_claim_beyond_what_can_be_packed_is_not_tried() {
        let refused = unpack(&[0x78, 0x9c, 0x03, 0, 0, 0, 0, 1], 10_000_000_000, true);
        assert!(refused.is_err_and(|why| why.contains("cannot hold")));
        assert!(Budget::of_file(1000).take(10_000_000_000).is_err());
    }

    #[test]
    fn packed_data_have_exactly_the_length_that_they_claim() {
        let empty = [0x78, 0x9c, 0x03, 0, 0, 0, 0, 1];
        assert_eq!(unpack(&empty, 0, true), Ok(Vec::new()));
        assert!(unpack(&empty, 1, true).is_err_and(|why| why.contains("fewer than the 1 bytes")));
        let packed = miniz_oxide::deflate::compress_to_vec(&[7; 100], 6);
        assert_eq!(unpack(&packed, 100, false), Ok(vec![7; 100]));
        assert!(unpack(&packed, 99, false).is_err_and(|why| why.contains("more than the 99 bytes")));
    }

    #[test]
    fn a_number_may_be_wrapped_as_numpy_shows_it() {
        for (word, number) in [
            ("np.float64(-1.5e-3)", Some(-1.5e-3)),
            ("np.int64(7)", Some(7.0)),
            ("np.float64(1.5", None),
            ("np.array(1.5)", None),
            ("float64(1.5)", None),
            ("np.float64(np.float64(1.5))", None),
        ] {
            assert_eq!(number_of_word(word).ok(), number, "{word}");
        }
    }

    #[test]
    fn names_of_types_are_those_of_the_formats() {
        for (scalar, code, xml, legacy) in SCALARS {
            assert_eq!(code[1..].parse(), Ok(scalar.size()), "{code}");
            assert_eq!([Scalar::of_code(code), Scalar::of_xml(xml)], [Some(scalar); 2]);
            for name in legacy {
                assert_eq!(Scalar::of_legacy(&name.to_uppercase()), Some(scalar));
            }
        }
        assert_eq!(Scalar::of_legacy("vtktypeint64"), Some(Scalar::I64));
        assert_eq!(Scalar::of_xml("String"), None);
    }

    #[test]
    fn numbers_of_both_byte_orders() {
        assert_eq!(Scalar::F64.decode(&1.5_f64.to_le_bytes(), true), [1.5]);
        assert_eq!(Scalar::F32.decode(&1.5_f32.to_be_bytes(), false), [1.5]);
        assert_eq!(Scalar::I16.decode(&[0xff, 0xfe, 0x01], false), [-2.0]);
        assert_eq!(whole::<u8>(&[0.0, 255.0]), Ok(vec![0, 255]));
        for wrong in [-1.0, 0.5, 256.0, f64::NAN, f64::INFINITY] {
            assert!(whole::<u8>(&[wrong]).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_code_of_numpy_is_the_number_that_it_says_and_a_truth_is_a_byte() {
        for (code, scalar) in
            [("b1", Scalar::U8), ("i2", Scalar::I16), ("u4", Scalar::U32), ("f4", Scalar::F32)]
        {
            assert_eq!(Scalar::of_code(code), Some(scalar), "{code}");
        }
        assert_eq!(Scalar::of_code("c16"), None);
    }
}
