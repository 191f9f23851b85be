//! Data of the column with inertia: its initial state, its precomputed modes, and the steady state that they depart from.

use crate::dynamic_column::modes::ModeState;
use crate::parameters::ColumnParameters;

/// How the column is set in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// The whole load at `t = 0`: a discontinuous wave front.
    Step,
    /// A load that grows linearly.
    Ramp {
        /// Time until the whole load acts, s.
        duration: f64,
    },
    /// No load; let go from `p = σ' = p_0 sin(M_0 ζ)` with the velocities that
    /// [`SingleMode::velocities`](crate::single_mode::SingleMode::velocities) has at `t = 0`.
    Mode,
    /// No load; let go at rest from `u = U_w = −(p_0/(Q M_0/H)) sin(M_0 y/H)`: an undrained wave that
    /// stands, `p = p_0 sin(M_0 ζ)` at first.
    StandingWave,
}

impl Start {
    /// Whether the column is let go without a load, and displacements count from there.
    pub(super) fn is_release(self) -> bool {
        matches!(self, Self::Mode | Self::StandingWave)
    }
}

/// Linear v–w column: fixed base, drained and loaded top (theory after Zienkiewicz et al. 1980).
///
/// ```text
/// (1−n) ρ_s ü + d (u̇ − U̇_w) = [E_oed + Q(1−n)²] u'' + Qn(1−n) U_w''
///     n ρ_w Ü_w − d (u̇ − U̇_w) = Qn(1−n) u'' + Qn² U_w''              d = n² γ_w/k
/// p = −Q [(1−n) u' + n U_w']        σ' = E_oed u'
/// ```
///
/// The departure from the final state `u = −(q/E_oed) y`, `(1−n) u + n U_w = 0`, expands in
/// `sin(M_j y/H)`; every mode is a damped oscillator of two degrees of freedom, solved by the
/// residues of its transform.
#[derive(Clone, Debug)]
pub struct DynamicColumn {
    pub(super) parameters: ColumnParameters,
    pub(super) start: Start,
    /// Modal coefficients at the times that were asked for in advance.
    pub(super) prepared: Vec<ModeState>,
}

/// The state in closed form that the modes depart from: fields of the solid and of `ψ = (1 − n) u + n U_w`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steady {
    pub(super) solid: f64,
    pub(super) mixture: f64,
    pub(super) solid_rate: f64,
    pub(super) mixture_rate: f64,
    pub(super) solid_strain: f64,
    pub(super) pressure: f64,
}
