//! Time integrators by name.

pub use crate::formulation::Formulation;

use crate::settings::{Drag, ExplicitSettings, Scheme};
use crate::time_step::TimeStep;
use oedometer_wording::words;

/// Share of the critical step where an explicit run names no rule.
const DEFAULT_SHARE: f64 = 0.8;
/// Default step of a semi-implicit run, relative to its limit: of first order in time, it needs a tenth of it.
const SEMI_IMPLICIT_SHARE: f64 = 0.1;
/// Growth of the steps where an implicit run names no rule: its error in time stays below a
/// twentieth of that of ten cells in space.
const DEFAULT_GROWTH: f64 = 0.05;

/// Time integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegratorKind {
    /// The eight steps of Zheng et al. (2021).
    #[default]
    Explicit,
    /// Pressure and drag implicit, inertia kept, skeleton explicit: bounded by the skeleton's
    /// waves and not by the water's.
    SemiImplicit,
    /// SDIRK2, L-stable.
    Implicit,
}

words!(IntegratorKind: Explicit "explicit", SemiImplicit "semi-implicit", Implicit "implicit");

/// Bound on the steps of an integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepBound {
    /// Stability of all its waves: a critical step, predicted from the body's own operators.
    AllWaves,
    /// Stability of the skeleton's waves: a critical step by formula.
    SkeletonWaves,
    /// Accuracy alone.
    Accuracy,
}

impl IntegratorKind {
    /// Bound on its steps.
    pub fn step_bound(self) -> StepBound {
        match self {
            Self::Explicit => StepBound::AllWaves,
            Self::SemiImplicit => StepBound::SkeletonWaves,
            Self::Implicit => StepBound::Accuracy,
        }
    }

    /// Order of its error in time.
    pub fn order_in_time(self, settings: &ExplicitSettings) -> f64 {
        let is_centred = settings.scheme == Scheme::Leapfrog && settings.drag == Drag::Centred;
        match self {
            Self::Implicit => 2.0,
            Self::Explicit if is_centred => 2.0,
            Self::Explicit | Self::SemiImplicit => 1.0,
        }
    }

    /// Step rule where none is given.
    pub fn default_rule(self) -> TimeStep {
        match self {
            Self::Explicit => TimeStep::Stable(DEFAULT_SHARE),
            Self::SemiImplicit => TimeStep::Stable(SEMI_IMPLICIT_SHARE),
            Self::Implicit => TimeStep::Growth(DEFAULT_GROWTH),
        }
    }

    /// Formulation where none is given.
    pub fn default_formulation(self) -> Formulation {
        match self {
            Self::Explicit | Self::SemiImplicit => Formulation::VW,
            Self::Implicit => Formulation::QuasiStatic,
        }
    }

    /// Says why the integrator refuses a formulation, where it does.
    pub fn refuses_formulation(self, formulation: Formulation) -> Option<&'static str> {
        match (self, formulation) {
            (Self::Explicit | Self::SemiImplicit, Formulation::QuasiStatic) => {
                Some("an explicit skeleton needs its accelerations: they cannot be neglected")
            }
            (Self::Explicit, Formulation::UP) => Some(
                "in `u-p` the water has no separate inertia, its pressure diffuses, and explicit steps \
                 would shrink with the square of the cell size: use `v-w`, or `u-p` with `semi-implicit` or \
                 `implicit`",
            ),
            _ => None,
        }
    }

    /// Says why the integrator refuses a step rule, where it does.
    pub fn refuses_rule(self, rule: TimeStep) -> Option<&'static str> {
        match (self, rule) {
            (Self::Explicit, TimeStep::Growth(_)) => {
                Some("the explicit integrator cannot let its steps grow: its critical step bounds them")
            }
            (Self::Explicit | Self::SemiImplicit, TimeStep::Tolerance(_)) => {
                Some("only the implicit integrator estimates its error in time")
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_leapfrog_with_centred_drag_is_an_explicit_step_of_second_order() {
        for scheme in [Scheme::ForwardEuler, Scheme::Leapfrog] {
            for drag in [Drag::Explicit, Drag::Implicit, Drag::Centred] {
                let settings = ExplicitSettings { scheme, drag, ..ExplicitSettings::default() };
                let order = |integrator: IntegratorKind| integrator.order_in_time(&settings);
                let is_second = (scheme, drag) == (Scheme::Leapfrog, Drag::Centred);
                assert_eq!(
                    order(IntegratorKind::Explicit),
                    if is_second { 2.0 } else { 1.0 },
                    "{scheme:?} {drag:?}"
                );
                assert_eq!(order(IntegratorKind::SemiImplicit), 1.0);
                assert_eq!(order(IntegratorKind::Implicit), 2.0);
            }
        }
    }
}
