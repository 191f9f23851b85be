//! Tiers of a study: how much of it runs.

use oedometer_soil::wording::words;

/// How much of a study is run: a tier includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Tier {
    /// Seconds.
    Smoke,
    /// What a CI runs.
    #[default]
    Ci,
    /// Everything.
    Full,
}

words!(Tier: Smoke "smoke", Ci "ci", Full "full");
