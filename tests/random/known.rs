//! Violations that are known and not mended: each with where it is written down. Empty is right.

use crate::laws::Violation;
use crate::options::Options;

/// A known violation: where it is written down, and which cases are meant.
type Known = (&'static str, fn(&Options, &Violation) -> bool);

const KNOWN: [Known; 1] = [(
    "docs/theory.md, section 5: two measures of the settlement differ between outputs, frozen and moving",
    |options, violation| {
        options.scene == "cosine-layer" && violation.said.starts_with("TotalAndFrozen: the settlement curve")
    },
)];

/// Where a violation is written down, if it is known.
pub fn line_of(options: &Options, violation: &Violation) -> Option<&'static str> {
    KNOWN.iter().find(|(_, is_meant)| is_meant(options, violation)).map(|(line, _)| *line)
}
