//! A study with the last digit of one input changed: the change of its results is round-off.

use crate::case::planned::PlannedCase;
use crate::study::check::Study;
use oedometer_soil::wording::words;

/// The input whose last digit changes. Every operator's entries follow, and with them every rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LastDigit {
    /// Young's modulus, upwards.
    Stiffness,
    /// Hydraulic conductivity, downwards.
    Conductivity,
}

words!(
    LastDigit:
    Stiffness "last digit of the stiffness", Conductivity "last digit of the conductivity",
);

impl LastDigit {
    /// Changes the digit.
    pub fn change(self, youngs_modulus: &mut f64, hydraulic_conductivity: &mut f64) {
        match self {
            Self::Stiffness => *youngs_modulus = youngs_modulus.next_up(),
            Self::Conductivity => *hydraulic_conductivity = hydraulic_conductivity.next_down(),
        }
    }
}

impl Study {
    /// The study with the last digit of an input of every case changed; its cases keep their labels.
    #[must_use]
    pub fn perturbed(&self, digit: LastDigit) -> Self {
        let planned = self.planned.iter().cloned().map(|mut planned: PlannedCase| {
            let soil = &mut *planned.case.material;
            digit.change(&mut soil.youngs_modulus, &mut soil.hydraulic_conductivity);
            planned
        });
        Self { planned: planned.collect(), ..self.clone() }
    }
}
