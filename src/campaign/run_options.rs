//! What of a study is run, and how.

use crate::case::Case;
use crate::case::tier::Tier;
use crate::record::store::RecordStore;
use crate::study::check::Study;

/// A share `index/count` of the cases, by their hashes: the same whatever machine asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `count`.
    pub index: u64,
    /// How many shards there are.
    pub count: u64,
}

impl Shard {
    /// Whether a case belongs to this shard.
    pub fn holds(&self, case: &Case) -> bool {
        u64::from_str_radix(&case.hash(), 16).unwrap_or(0) % self.count == self.index - 1
    }
}

/// How to run a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// Cases at the same time.
    pub jobs: usize,
    /// How much of the study.
    pub tier: Tier,
    /// Which share of it.
    pub shard: Option<Shard>,
    /// Whether finished records are taken up.
    pub resume: bool,
}

impl RunOptions {
    /// A whole tier, every case anew.
    pub fn whole(tier: Tier, jobs: usize) -> Self {
        Self { jobs, tier, shard: None, resume: false }
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
