//! The tables of a study as files: the tidy one, those beside it, plain or compressed.

pub mod long_tables;
pub mod machines_table;
pub mod packed_table;
pub mod rows_at_hand;
pub mod table_file;
pub mod tidy;
