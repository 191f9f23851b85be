//! The seal of a record's text: a digest as its last field, so that damage and tampering are seen.

use serde::Serialize;

/// What stands before the digest where every field has a line of its own, and where all is one line.
const SEALS: [&str; 2] = [",\n  \"digest\": \"", ",\"digest\":\""];
/// What ends the object there.
const ENDS: [&str; 2] = ["\n}", "}"];
/// Hexadecimal digits of a digest.
const DIGEST_DIGITS: usize = 32;

/// How a record is laid out as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Every field on a line of its own, for a file of one record.
    Lines,
    /// All on one line, for a file of many.
    OneLine,
}

/// The JSON of a value with the digest of it as the last field: made of the text and not of the value, so that it
/// is written and read once.
///
/// # Errors
/// When the value has no JSON.
pub fn sealed(value: &impl Serialize, layout: Layout) -> serde_json::Result<String> {
    let content = match layout {
        Layout::Lines => serde_json::to_string_pretty(value)?,
        Layout::OneLine => serde_json::to_string(value)?,
    };
    let (seal, end) = (SEALS[layout as usize], ENDS[layout as usize]);
    let content = content.strip_suffix(end).unwrap_or(&content);
    Ok(format!("{content}{seal}{}\"{end}", digest_of(content)))
}

/// Whether a text is as it was sealed, in either layout.
pub fn is_whole(text: &str) -> bool {
    SEALS.iter().zip(ENDS).any(|(seal, end)| sealed_by(text, seal, end).is_some_and(is_digest_of))
}

/// What a text seals, and the digest that it has of it; none where it does not end as a seal does.
fn sealed_by<'a>(text: &'a str, seal: &str, end: &str) -> Option<(&'a str, &'a str)> {
    let text = text.strip_suffix(end)?.strip_suffix('"')?;
    let (text, digest) = text.split_at_checked(text.len().checked_sub(DIGEST_DIGITS)?)?;
    Some((text.strip_suffix(seal)?, digest))
}

fn is_digest_of((content, digest): (&str, &str)) -> bool {
    digest_of(content) == digest
}

fn digest_of(content: &str) -> String {
    blake3::hash(content.as_bytes()).to_hex()[..DIGEST_DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_whole_in_both_layouts_and_no_longer_after_any_change() {
        let value = serde_json::json!({ "a": 1.5, "b": ["x", "y"] });
        for layout in [Layout::Lines, Layout::OneLine] {
            let text = sealed(&value, layout).expect("JSON");
            assert!(is_whole(&text), "{text}");
            let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(read["a"], value["a"]);
            for place in 0..text.len() {
                let mut damaged = text.clone().into_bytes();
                damaged[place] ^= 1;
                let damaged = String::from_utf8(damaged).expect("ASCII");
                assert!(!is_whole(&damaged), "byte {place} of {text}");
            }
        }
        assert!(!is_whole("{}") && !is_whole(""));
    }
}
