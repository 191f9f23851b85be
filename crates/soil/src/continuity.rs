//! How the pore water is conserved: docs/theory.md, Eqs 4 and 4'.

use serde::{Deserialize, Serialize};

/// Continuity equation of the mixture (docs/theory.md, Eqs 4 and 4').
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Continuity {
    /// Eq. 4, `dp/dt = −(K_w/n)[∇·v_s + ∇·(n(v_w − v_s))]`: conserves water.
    Conservative,
    /// Eq. 4', `dp/dt = −(K_w/n)[(1−n)∇·v_s + n∇·v_w]`: Zheng et al. Eq. 6 drops `(v_w − v_s)·∇n`.
    ConstantPorosityGradient,
}

impl Continuity {
    /// Both, the one that conserves water first.
    pub const ALL: [Self; 2] = [Self::Conservative, Self::ConstantPorosityGradient];

    /// Name in study files.
    #[inline]
    pub fn name(self) -> &'static str {
        match self {
            Self::Conservative => "conservative",
            Self::ConstantPorosityGradient => "constant-porosity-gradient",
        }
    }
}
