//! Manufactured solutions: prescribed motions at large strain in the plane, with the body forces that make them exact.
//!
//! A motion of the unit square and a pore pressure are written down; velocities, porosity, flux, stresses and
//! accelerations follow from them, and the residuals of the balances act on the body as body forces of mixture and water
//! and as a source of water (docs/theory.md, Eqs 24–27). Points move through the mesh in both directions and return; no
//! wall moves, and no front, load or surface limits the order of convergence.
//!
//! `dual` is the arithmetic with derivatives, `motion` has the motions, their inverses and the laws that each supports,
//! `motion_state` the quantities that follow from a motion at a point and time.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

pub mod dual;
pub mod motion;
pub mod motion_state;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, positive};
use crate::inputs::LAW_KEY;
use crate::manufactured::dual::PLACES;
use crate::manufactured::motion::{ManufacturedModel, Moment, Motion, Spot, Spots};
use crate::manufactured::motion_state::{Soil, State, States};
use crate::parameters::ColumnParameters;
use crate::row::{Axis, Changes, Row};
use crate::solution::{Accuracy, FieldValues, Solution};
use std::f64::consts::PI;

/// The row of a motion by its name.
const fn row(name: &'static str) -> Row {
    let inputs: &'static [&'static [&'static str]] = &[
        LAW_KEY,
        &[
            "youngs_modulus",
            "poissons_ratio",
            "porosity",
            "amplitude_x",
            "amplitude_y",
            "amplitude",
            "frequency",
            "pressure",
        ],
    ];
    let words = "the manufactured solution";
    Row { name, words, inputs, axis: Axis::InPlane, changes: Changes::AsPrescribed, ..Row::COLUMN }
}

/// The rows of the motions.
pub(crate) static ROWS: [Row; 3] =
    [row(Motion::Box.name()), row(Motion::Shear.name()), row(Motion::Vortex.name())];

/// Intervals of the grid on which volume ratios are checked.
const GRID: u32 = 40;
/// Round-off of the fields over their scales.
const ROUND_OFF: f64 = 1e-14;

/// A manufactured solution. Times are in half periods of the frequency: the factor is `ωt/π`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manufactured {
    model: ManufacturedModel,
    parameters: ColumnParameters,
    soil: Soil,
}

impl Manufactured {
    /// The solution of a model for a soil; the load of the parameters is the amplitude `P_0` of the pressure.
    ///
    /// # Errors
    /// When the parameters are impossible, the motion folds the square, or the pores close on the way.
    pub fn new(model: ManufacturedModel, parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        positive("frequency", parameters.motion.frequency)?;
        if !model.has_law() {
            return Err(ExactError::LawOfMotion { law: model.law.name(), motion: model.motion.name() });
        }
        let soil = Soil::new(parameters);
        let solution = Self { model, parameters: *parameters, soil };
        let least = solution.least_volume_ratio();
        // NaN is refused too.
        let stays_open = least > 1.0 - parameters.soil.porosity;
        if stays_open {
            Ok(solution)
        } else {
            Err(ExactError::MotionClosesPores { least, grains: 1.0 - parameters.soil.porosity })
        }
    }

    /// Least volume ratio `J` at the largest displacement, on a grid of points.
    pub fn least_volume_ratio(&self) -> f64 {
        let largest = self.time(0.5);
        let at = |i: u32| f64::from(i) / f64::from(GRID);
        let ratios = (0..=GRID).flat_map(|i| (0..=GRID).map(move |j| [at(i), at(j)]));
        ratios.map(|place| self.state_at(place, largest).volume_ratio()).fold(f64::INFINITY, f64::min)
    }

    /// Time of a factor, s.
    pub fn time(&self, time_factor: f64) -> f64 {
        self.parameters.time(time_factor)
    }

    /// State of the point `X` (m) of the skeleton at a time, s.
    pub fn state_at(&self, place: [f64; 2], time: f64) -> State {
        State::from_first(self.states_at(&Spots::new(&[Spot::new(place); PLACES]), &self.moment(time)))
    }

    /// The states of four points at a time, from precomputed functions of place and time.
    #[inline(always)]
    pub fn states_at(&self, spots: &Spots, moment: &Moment) -> States {
        States::new(self.model, &self.parameters, &self.soil, spots, moment)
    }

    /// The functions of a time, s, that all points share.
    pub fn moment(&self, time: f64) -> Moment {
        Moment::new(self.parameters.motion.frequency, time)
    }

    /// The points of the skeleton that are at four places at a time, from guesses, m.
    #[inline(always)]
    pub fn material_places(
        &self,
        places: &[[f64; 2]; PLACES],
        moment: &Moment,
        guesses: &[[f64; 2]; PLACES],
    ) -> [[f64; 2]; PLACES] {
        self.model.motion.material_places(&self.parameters.motion, places, moment, guesses)
    }

    /// The fields at the point `X` of the skeleton, m, at a time factor.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or the point is not finite.
    pub fn plane_fields(&self, time_factor: f64, place: [f64; 2]) -> Result<PlaneValues, ExactError> {
        let time = self.time(checked_time_factor(time_factor)?);
        for (quantity, value) in [("place x", place[0]), ("place y", place[1])] {
            if !value.is_finite() {
                return Err(ExactError::NotFinite { quantity, value });
            }
        }
        let state = self.state_at(place, time);
        let position = state.position();
        Ok(PlaneValues {
            pressure: state.pressure(),
            effective_stress: state.effective_stress(),
            displacement: [position[0] - place[0], position[1] - place[1]],
        })
    }
}

impl Solution for Manufactured {
    /// Pressure, vertical effective stress and vertical displacement along the wall `X = 0`, at the depth `zeta`
    /// below the upper one.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let PlaneValues { pressure, effective_stress, displacement } =
            self.plane_fields(time_factor, [0.0, 1.0 - checked_depth(zeta)?])?;
        Ok(FieldValues { pressure, effective_stress: effective_stress[1][1], displacement: displacement[1] })
    }

    /// No wall moves.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| 0.0)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(0.0)
    }

    /// Share of the largest displacement, `sin²(ωt)`.
    fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        let sine = oedometer_soil::elementary::sin(PI * checked_time_factor(time_factor)?);
        Ok(sine * sine)
    }

    /// A formula without terms: only round-off.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        checked_time_factor(time_factor).map(|_| Accuracy::new(0, ROUND_OFF))
    }

    /// Largest displacement of a point, m.
    fn displacement_scale(&self) -> Result<f64, ExactError> {
        Ok(self.model.motion.largest_displacement(&self.parameters.motion))
    }

    fn least_porosity(&self) -> Option<f64> {
        Some(1.0 - (1.0 - self.parameters.soil.porosity) / self.least_volume_ratio())
    }

    /// Nothing consolidates: the degree is the share of the largest displacement.
    fn has_degree(&self) -> bool {
        false
    }
}

/// Fields at a point of the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneValues {
    /// Pore pressure, Pa, compression positive.
    pub pressure: f64,
    /// Effective Cauchy stress, Pa, tension positive, `[row][column]` of x and y.
    pub effective_stress: [[f64; 2]; 2],
    /// Displacement, m, `[component]`.
    pub displacement: [f64; 2],
}

#[cfg(test)]
mod tests;
