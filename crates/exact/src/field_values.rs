//! The fields that every solution gives at a place and time, and their accuracy.

/// Fields at one depth and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldValues {
    /// Excess pore pressure, compression positive, Pa.
    pub pressure: f64,
    /// Vertical effective (Cauchy) stress, *tension positive*: `p − q` under a load, Pa.
    pub effective_stress: f64,
    /// Displacement of the solid, upward positive, from the unloaded state before `t = 0`
    /// (single mode: from the state at `t = 0`), m.
    pub displacement: f64,
}

/// How far a reference itself can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Number of terms (modes, images, unknowns) used.
    pub terms: usize,
    /// Bound on the truncation error of the pressure over the load, the worst over the depth.
    pub tail_bound: f64,
    /// Bound on what round-off leaves of the phases of waves that have run for long, of pressures over the load and of
    /// displacements over the start's or the final one, and of pressures of stiff water; 0 where no waves run.
    pub phase_bound: f64,
}

impl Accuracy {
    /// So many terms, and what the others may add.
    pub fn of(terms: usize, tail_bound: f64) -> Self {
        Self { terms, tail_bound, phase_bound: 0.0 }
    }

    /// Bound on both errors.
    pub fn bound(&self) -> f64 {
        self.tail_bound + self.phase_bound
    }
}
