//! How the pore water is conserved: docs/theory.md, Eqs 4 and 4'.

use oedometer_wording::words;

/// Continuity equation of the mixture (docs/theory.md, Eqs 4 and 4').
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Continuity {
    /// Eq. 4, `dp/dt = −(K_w/n)[∇·v_s + ∇·(n(v_w − v_s))]`: conserves water.
    Conservative,
    /// Eq. 4', `dp/dt = −(K_w/n)[(1−n)∇·v_s + n∇·v_w]`: Zheng et al. Eq. 6 drops `(v_w − v_s)·∇n`.
    ConstantPorosityGradient,
}

words!(
    Continuity: Conservative "conservative", ConstantPorosityGradient "constant-porosity-gradient"
);
