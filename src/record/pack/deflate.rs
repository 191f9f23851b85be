//! Deflate with working memory that each thread keeps: getting a third of a megabyte for every record took longer
//! than packing it.

use flate2::{Compress, Compression, Decompress, FlushCompress, FlushDecompress, Status};
use std::cell::RefCell;
use std::io;

/// Effort of the compression: more of it makes a record a hundredth smaller, most of it a twentieth, and takes longer
/// than a small case.
const EFFORT: u32 = 1;
/// Most bytes that one byte of deflate can become (zlib's technical notes), with some air.
const RATIO: usize = 1040;

thread_local! {
    static COMPRESSOR: RefCell<Compress> = RefCell::new(Compress::new(Compression::new(EFFORT), false));
    static DECOMPRESSOR: RefCell<Decompress> = RefCell::new(Decompress::new(false));
}

/// Appends the packed bytes of a text: the same for the same text, whatever was packed before.
///
/// # Errors
/// Never for bytes in memory; the packer's own otherwise.
pub fn deflate(text: &[u8], into: &mut Vec<u8>) -> io::Result<()> {
    COMPRESSOR.with_borrow_mut(|compressor| {
        compressor.reset();
        let mut rest = text;
        loop {
            into.reserve(rest.len() / 4 + 256);
            let before = compressor.total_in();
            let status = compressor.compress_vec(rest, into, FlushCompress::Finish)?;
            let taken = usize::try_from(compressor.total_in() - before).unwrap_or(rest.len());
            rest = &rest[taken..];
            if status == Status::StreamEnd {
                return Ok(());
            }
        }
    })
}

/// The text of packed bytes, which are all of them; none where they are damaged, or more or less than `length`.
pub fn inflate(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    if length > RATIO.saturating_mul(packed.len()) {
        return None;
    }
    DECOMPRESSOR.with_borrow_mut(|decompressor| {
        decompressor.reset(false);
        // A byte more than there is to be shows what is longer.
        let mut text = Vec::with_capacity(length + 1);
        let status = decompressor.decompress_vec(packed, &mut text, FlushDecompress::Finish).ok()?;
        let is_whole = status == Status::StreamEnd && decompressor.total_in() == packed.len() as u64;
        (is_whole && text.len() == length).then_some(text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut packed = Vec::new();
        deflate(text, &mut packed).expect("in memory");
        packed
    }

    #[test]
    fn what_was_packed_before_leaves_no_trace() {
        let long: Vec<u8> = (0..200_000_u64).flat_map(|i| (i * i % 1009).to_string().into_bytes()).collect();
        let texts = [b"".as_slice(), b"one line\n", &long, b"one line\n", &long[..70_000]];
        let first: Vec<Vec<u8>> = texts.iter().map(|text| packed(text)).collect();
        for (text, first) in texts.iter().zip(&first).rev() {
            let fresh = std::thread::scope(|scope| scope.spawn(|| packed(text)).join().expect("packed"));
            assert_eq!((&packed(text), &fresh), (first, first));
            assert_eq!(inflate(first, text.len()).as_deref(), Some(*text));
        }
    }

    #[test]
    fn what_is_cut_longer_or_shorter_than_it_says_is_none() {
        let text = "0.125 0.25 ".repeat(100).into_bytes();
        let whole = packed(&text);
        assert_eq!(inflate(&whole, text.len() - 1), None);
        assert_eq!(inflate(&whole, text.len() + 1), None);
        assert_eq!(inflate(&whole[..whole.len() - 1], text.len()), None);
        assert_eq!(inflate(&[&whole[..], b"x"].concat(), text.len()), None);
        assert_eq!(inflate(&whole, usize::MAX), None, "more than its bytes can be");
        assert_eq!(inflate(&whole, text.len()), Some(text), "damage before leaves no trace");
    }
}
