//! Violations that are known and not mended: each with where it is written down. Empty is right.

use crate::laws::Violation;
use crate::options::Options;

/// A known violation: where it is written down, and which cases are meant.
type Known = (&'static str, fn(&Options, &Violation) -> bool);

const KNOWN: [Known; 0] = [];

/// Where a violation is written down, if it is known.
pub fn line_of(options: &Options, violation: &Violation) -> Option<&'static str> {
    KNOWN.iter().find(|(_, is_meant)| is_meant(options, violation)).map(|(line, _)| *line)
}
