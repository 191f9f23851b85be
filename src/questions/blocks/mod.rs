//! What the page of a study prints that is no answer of a question yet.

pub mod drawn;
