//! Durations of the kicks of a run: those of forward Euler, or of a leapfrog.

use oedometer_problem::settings::{ExplicitSettings, Scheme};

/// Durations of the kicks of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rhythm {
    /// Last drift, s; 0 before the first.
    drift: f64,
}

impl Rhythm {
    /// Duration of the kick, s, before a drift of `dt` seconds: from the middle of the last drift to
    /// the middle of this one.
    pub fn kick(&mut self, dt: f64, settings: &ExplicitSettings) -> f64 {
        let last = std::mem::replace(&mut self.drift, dt);
        match settings.scheme {
            Scheme::ForwardEuler => dt,
            Scheme::Leapfrog => 0.5 * (last + dt),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leapfrog_kicks_from_middle_to_middle() {
        let settings = ExplicitSettings { scheme: Scheme::Leapfrog, ..ExplicitSettings::default() };
        let mut rhythm = Rhythm::default();
        let kicks = [0.4, 0.4, 0.2].map(|dt| rhythm.kick(dt, &settings));
        assert_eq!(kicks, [0.2, 0.4, 0.5 * (0.4 + 0.2)]);
        let mut rhythm = Rhythm::default();
        assert_eq!(rhythm.kick(0.4, &ExplicitSettings::default()), 0.4);
    }
}
