//! The subcommands, one file each.

pub mod accept;
pub mod bisect;
pub mod check;
pub mod compare;
pub mod completions;
pub mod exact;
pub mod explain;
pub mod history;
pub mod list;
pub mod merge;
pub mod new;
pub mod plan;
pub mod records;
pub mod report;
pub mod run;
pub mod schema;
pub mod score;
pub mod solve;
pub mod stability;
