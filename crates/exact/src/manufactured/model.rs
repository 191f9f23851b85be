//! Which stress–strain law goes with which motion.

use crate::manufactured::motion::Motion;
use oedometer_soil::law::Law;

/// A motion with the law of its soil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ManufacturedModel {
    /// Form of the motion.
    pub motion: Motion,
    /// Stress–strain law.
    pub law: Law,
}

impl ManufacturedModel {
    /// A motion with the law that it has where nobody names one: of the constant modulus where nothing shears.
    pub const fn of(motion: Motion) -> Self {
        let law = match motion {
            Motion::Box => Law::LogLinear,
            Motion::Shear | Motion::Vortex => Law::NeoHookean,
        };
        Self { motion, law }
    }

    /// Whether stresses of the law follow from this motion in closed form: a rate of the constant modulus does where
    /// nothing shears or turns.
    pub fn has_law(self) -> bool {
        match self.law {
            Law::NeoHookean => true,
            Law::LogLinear => self.motion == Motion::Box,
            Law::Linear | Law::PorosityDependent | Law::Engineering => false,
        }
    }
}
