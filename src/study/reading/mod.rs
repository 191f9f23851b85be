//! From the text of a study to typed tables: the tree that serde walks, and what is said of text that is none.

pub mod grammar;
pub mod mistakes;
pub mod toml_tree;
