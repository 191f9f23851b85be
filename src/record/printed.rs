//! A record as `oedometer records` prints it.

use crate::record::{Record, WallSample};

/// A record as it is printed: with its wall times, which are kept beside it.
#[derive(serde::Serialize, schemars::JsonSchema)]
pub struct PrintedRecord<'a> {
    #[serde(flatten)]
    record: &'a Record,
    /// Wall times, all of them.
    wall: &'a [WallSample],
}

impl<'a> PrintedRecord<'a> {
    /// A record as it is printed.
    pub fn of(record: &'a Record) -> Self {
        Self { record, wall: &record.wall }
    }
}
