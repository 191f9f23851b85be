//! How much of a study is run.

/// How much of a study is run: a tier includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// Seconds.
    Smoke,
    /// What a CI runs.
    #[default]
    Ci,
    /// Everything.
    Full,
}

impl Tier {
    /// Every tier, the smallest first.
    pub const ALL: [Self; 3] = [Self::Smoke, Self::Ci, Self::Full];

    /// Name in study files and at the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smoke => "smoke",
            Self::Ci => "ci",
            Self::Full => "full",
        }
    }
}
