//! The energy of a body on its way: what it holds may fall, by drag and by what points smooth, and never rises but by the
//! work of its loads.
//!
//! ```text
//! H = Σ ½ (m_s v_s² + m_w v_w²) + ∫ ½ σ':C⁻¹:σ' dV + ∫ n p²/(2 K_w) dV − W
//! ```
//!
//! with the work `W` of the loads since the start (Coussy 2004, section 4.3, for the free energy of a saturated
//! porous solid). `dH/dt = −∫ (n² γ_w/k) |v_w − v_s|² dV ≤ 0`: a step that makes energy has no other way to be told so long
//! before its fields are wrong, for what grows slowly grows in all of them alike.

/// What an energy may rise above the least so far, as a share of the largest that was ever in motion.
///
/// The largest rise of the explicit cases of the shipped studies is a fifth of it; a mode that grows has made pressures
/// wrong by a fifth of the load where its energy is a twentieth of that of the load's own.
const MOST_RISE: f64 = 0.05;
/// The same where points move: stresses of points that cross cells jump.
const MOST_RISE_MOVING: f64 = 0.1;

/// Energy of a body at a time, J; in a column, J a unit area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion.
    pub kinetic: f64,
    /// Of stresses and pressures, since the start or on the whole.
    pub stored: f64,
    /// Work of what acts since the start.
    pub work: f64,
}

/// What was seen of a body's energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyAccount {
    /// Least of kinetic and stored energy less work so far, J.
    least: f64,
    /// Most that was in motion so far, J.
    turned: f64,
    /// Largest rise above the least, over what was in motion.
    pub largest_rise: f64,
}

impl Default for EnergyAccount {
    fn default() -> Self {
        Self { least: f64::INFINITY, turned: 0.0, largest_rise: 0.0 }
    }
}

impl EnergyAccount {
    /// Takes note of an energy; a sentence where it has risen beyond what a sound step makes.
    pub fn note(&mut self, energy: Energy, moves: bool) -> Option<String> {
        let free = energy.kinetic + energy.stored - energy.work;
        self.turned = self.turned.max(energy.kinetic + energy.stored.abs() + energy.work.abs());
        self.least = self.least.min(free);
        let rise = free - self.least;
        let share = rise / self.turned;
        if share > self.largest_rise || share.is_nan() {
            self.largest_rise = share;
        }
        let most = if moves { MOST_RISE_MOVING } else { MOST_RISE };
        // What is no number is no energy.
        let is_within = self.turned == 0.0 || share <= most;
        (!is_within).then(|| {
            format!(
                "energy grew by {rise:.3e} J without work, {share:.3} of all that was in motion: a step that is stable makes \
                 less than {most}"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_may_fall_and_come_from_work_and_nothing_else() {
        let mut account = EnergyAccount::default();
        let energy = |kinetic, stored, work| Energy { kinetic, stored, work };
        for (kinetic, stored, work) in [(0.0, 1.0, 0.0), (1.0, 1.0, 1.0), (0.5, 1.0, 1.5), (0.0, 5.0, 6.0)] {
            assert_eq!(account.note(energy(kinetic, stored, work), false), None);
        }
        assert_eq!(account.largest_rise, 0.0);
        assert_eq!(account.note(energy(0.0, 5.5, 6.0), false), None, "round-off of a scheme");
        let grown = account.note(energy(1.0, 5.5, 6.0), false).expect("it rose by more than a tenth");
        assert!(grown.contains("1.500e0 J without work"), "{grown}");
        assert!(account.note(energy(f64::NAN, 5.5, 6.0), true).is_some());
        let mut smaller = EnergyAccount::default();
        assert_eq!(smaller.note(energy(0.0, 0.0, 0.0), false), None, "nothing has happened yet");
    }
}
