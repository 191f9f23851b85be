//! What people type: TOML, of which every mistake is reported at its place with what would be right; numbers with units; and the
//! key that was meant. Studies, mappings of results and case files are read with it.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod diagnostic;
pub mod mending;
pub mod nearest;
pub mod source;
pub mod synonyms;
pub mod toml_text;
pub mod units;
