//! Packs: the records of a large study, many to a file.
//!
//! A pack is a file of gzip members one behind the other, one member a record, and in it lines of JSON: the record,
//! and its wall times. `zcat STUDY/records/*.jsonl.gz` shows them all. What a member is, which case it is of and how
//! long it is stands in the extra field of its header, so that a reader goes from header to header and unpacks only
//! what it is asked for.
//!
//! Each writer appends to a pack of its own and takes up an older one only where it can lock it, on the machine that
//! began it. A member is written in one go behind the last one: a writer that ends at any moment leaves whole members
//! and at most one cut one at the end, which readers leave out and name.

pub mod deflate;
pub mod index;
pub mod member;
pub mod writer;

/// Ending of a pack's name.
pub const ENDING: &str = ".jsonl.gz";
/// Folder of the packs within that of a study's results.
pub const FOLDER: &str = "records";
