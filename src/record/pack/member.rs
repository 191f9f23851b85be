//! One member of a pack: a gzip member (RFC 1952) whose header says what it is.

use crate::record::pack::deflate::{deflate, inflate};

/// Constant bytes at the beginning of every member: magic and method of gzip, its flag of an extra field, no date,
/// no system, then the length of the extra field and the name and length of its one subfield.
const START: [u8; 16] = [0x1f, 0x8b, 8, 4, 0, 0, 0, 0, 0, 0xff, FIELD + 4, 0, b'O', b'e', FIELD, 0];
/// Length of what the subfield holds.
const FIELD: u8 = 33;
/// Length of a header.
pub const HEADER: usize = START.len() + FIELD as usize;
/// What follows the compressed text: its checksum and its length.
const TRAILER: usize = 8;
/// Longest text of a member, bytes: more is no record but an attack.
const MOST_TEXT: u32 = 1 << 30;

/// What a member holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A record of a case that came to its end, and its wall times.
    Record,
    /// That of a case that failed.
    FailedRecord,
    /// A record of a case that ran out of its time.
    LateRecord,
    /// Wall times alone, which take the place of earlier ones.
    Wall,
    /// Rows of a record in a table.
    Rows,
    /// The columns of that table.
    Columns,
}

impl Kind {
    const ALL: [(Self, u8); 6] = [
        (Self::Record, b'R'),
        (Self::FailedRecord, b'F'),
        (Self::LateRecord, b'L'),
        (Self::Wall, b'W'),
        (Self::Rows, b'T'),
        (Self::Columns, b'C'),
    ];

    fn letter(self) -> u8 {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or(b'R', |(_, letter)| *letter)
    }

    fn of(letter: u8) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == letter).map(|(kind, _)| *kind)
    }
}

/// What the header of a member says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// What it holds.
    pub kind: Kind,
    /// Count of the runs into the store: of two members of a case the one with the higher count is the newer.
    pub generation: u32,
    /// Hash of the case.
    pub case: u64,
    /// Tag of the program that made it.
    pub program: u64,
    /// Tag of the build of that program.
    pub build: u64,
    /// Length of the whole member, bytes.
    pub length: u32,
}

impl Header {
    /// Reads the header at the beginning of some bytes; none where they are no member's.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let field = bytes.get(..HEADER)?.strip_prefix(&START)?;
        let word = |at: usize| field.get(at..at + 8)?.try_into().ok().map(u64::from_le_bytes);
        let half = |at: usize| field.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
        let header = Self {
            kind: Kind::of(field[0])?,
            generation: half(1)?,
            case: word(5)?,
            program: word(13)?,
            build: word(21)?,
            length: half(29)?,
        };
        (header.length as usize >= HEADER + TRAILER).then_some(header)
    }

    /// Puts the header on a member in place of the one it has.
    pub fn put_on(&self, member: &mut [u8]) {
        let mut out = Vec::with_capacity(HEADER);
        out.extend(START);
        out.push(self.kind.letter());
        out.extend(self.generation.to_le_bytes());
        for word in [self.case, self.program, self.build] {
            out.extend(word.to_le_bytes());
        }
        out.extend(self.length.to_le_bytes());
        member[..HEADER].copy_from_slice(&out);
    }
}

/// The member of a text; the header's length is filled in.
///
/// # Errors
/// When the text is longer than a member may be.
pub fn packed(mut header: Header, text: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut member = vec![0; HEADER];
    deflate(text, &mut member)?;
    member.extend(crc32fast::hash(text).to_le_bytes());
    let length = u32::try_from(text.len()).map_err(|_| std::io::ErrorKind::FileTooLarge)?;
    member.extend(length.to_le_bytes());
    header.length = u32::try_from(member.len()).map_err(|_| std::io::ErrorKind::FileTooLarge)?;
    header.put_on(&mut member);
    Ok(member)
}

/// The text of a whole member; none where it was damaged.
pub fn unpacked(member: &[u8]) -> Option<String> {
    let (packed, trailer) =
        member.strip_prefix(&START)?.get(usize::from(FIELD)..)?.split_last_chunk::<TRAILER>()?;
    let half = |at: usize| trailer[at..at + 4].try_into().ok().map(u32::from_le_bytes);
    let (checksum, length) = (half(0)?, half(4).filter(|length| *length <= MOST_TEXT)?);
    let text = inflate(packed, length as usize)?;
    if crc32fast::hash(&text) == checksum { String::from_utf8(text).ok() } else { None }
}

/// The place of the next header in some bytes.
pub fn next_start(bytes: &[u8]) -> Option<usize> {
    bytes.windows(START.len()).position(|window| window == START)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    const HEADER_OF_ONE: Header = Header {
        kind: Kind::Record,
        generation: 7,
        case: 0x0123_4567_89ab_cdef,
        program: 1 << 60,
        build: 5,
        length: 0,
    };

    #[test]
    fn a_member_is_read_back_and_any_damage_to_it_is_seen() {
        let text = "{\"hash\":\"0123456789abcdef\"}\n[1.5,2.25]\n".repeat(5);
        let member = packed(HEADER_OF_ONE, text.as_bytes()).expect("packed");
        let header = Header::read(&member).expect("a header");
        let length = u32::try_from(member.len()).expect("short");
        assert_eq!(header, Header { length, ..HEADER_OF_ONE });
        assert_eq!(unpacked(&member).as_deref(), Some(text.as_str()));
        let mut unseen = 0;
        for place in HEADER..member.len() {
            let mut damaged = member.clone();
            damaged[place] ^= 0x10;
            // The last byte of the packed text is filled up with bits that mean nothing.
            if let Some(read) = unpacked(&damaged) {
                assert_eq!(read, text, "byte {place}");
                unseen += 1;
            }
        }
        assert!(unseen <= 1, "{unseen} damages unseen");
        assert_eq!(Header::read(&member[..HEADER - 1]), None);
        assert_eq!(next_start(&[b"rest".as_slice(), &member].concat()), Some(4));
    }

    #[test]
    fn a_member_is_what_other_programs_call_gzip() {
        let member = packed(HEADER_OF_ONE, b"one line\n").expect("packed");
        let two = [member.clone(), member].concat();
        let mut text = String::new();
        flate2::read::MultiGzDecoder::new(two.as_slice()).read_to_string(&mut text).expect("gzip");
        assert_eq!(text, "one line\none line\n");
    }
}
