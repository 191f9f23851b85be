//! The state in closed form that the modes depart from.

/// Fields of the solid and of `ψ = (1 − n) u + n U_w`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Steady {
    pub solid: f64,
    pub mixture: f64,
    pub solid_rate: f64,
    pub mixture_rate: f64,
    pub solid_strain: f64,
    pub pressure: f64,
}
