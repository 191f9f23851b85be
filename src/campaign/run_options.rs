//! What of a study is run, and how.

use crate::campaign::costs::CostTable;
use crate::campaign::shares::Shard;
use crate::case::tier::Tier;
use crate::record::store::RecordStore;
use crate::study::check::Study;

/// How to run a study.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptions {
    /// Cases at the same time.
    pub jobs: usize,
    /// How much of the study.
    pub tier: Tier,
    /// Which share of it.
    pub shard: Option<Shard>,
    /// What the cases cost, where shares go by that.
    pub costs: CostTable,
    /// Whether finished records are taken up.
    pub resume: bool,
    /// Whether records are only kept on disk and not in the report: any number of cases takes the same memory.
    pub only_on_disk: bool,
}

impl RunOptions {
    /// A whole tier, every case anew.
    pub fn whole(tier: Tier, jobs: usize) -> Self {
        Self { jobs, tier, shard: None, costs: CostTable::default(), resume: false, only_on_disk: false }
    }
}

/// A study to run, and where its records are kept.
#[derive(Clone, Copy, Debug)]
pub struct Selected<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its store; without one nothing is kept.
    pub store: Option<&'a RecordStore>,
}
