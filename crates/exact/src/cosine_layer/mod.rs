//! A layer under a cosine load: Biot's consolidation in two dimensions.

mod elastic;

use core::f64::consts::PI;

use nalgebra::Complex;

use crate::cosine_layer::elastic::{Constants, ElasticSolution, Local, Regime};
use crate::exact_error::{ExactError, checked_depth, checked_time_factor, held_within, positive};
use crate::inputs::{COLUMN_KEYS, LAW_KEY, WATER_KEYS};
use crate::parameters::{Base, ColumnParameters, Water};
use crate::row::{Axis, Row};
use crate::solution::{Accuracy, FieldValues, Solution};
use crate::talbot::{NODES, talbot_contour};
use oedometer_soil::elementary;

/// Its row with compressible water.
pub(crate) static COSINE_LAYER: Row = Row {
    name: "cosine-layer",
    words: "the exact layer with compressible water",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY, &["length", "base"]],
    axis: Axis::InPlane,
    adds_up: true,
    ..Row::COLUMN
};
/// Its row with incompressible water.
pub(crate) static COSINE_LAYER_INCOMPRESSIBLE: Row = Row {
    name: "cosine-layer-incompressible",
    words: "the exact layer with incompressible water",
    inputs: &[COLUMN_KEYS, LAW_KEY, &["length", "base"]],
    axis: Axis::InPlane,
    adds_up: true,
    ..Row::COLUMN
};

/// `B T_v` from which on the slowest mode is below round-off, and the contour so near the origin
/// that flow and stress can hardly be told apart.
const ENDED: f64 = 100.0;

/// Layer `0 < x < L`, `0 < y < H` in plane strain, drained at its top under `q cos(πx/L)`, on
/// rollers at both sides, on an impermeable base (Biot 1941).
///
/// `u_x = U(y) sin βx`, `u_y = V(y) cos βx`, `p = P(y) cos βx`, `β = π/L`, solved in the Laplace
/// domain in closed form and inverted on Talbot's contour. `load` is the amplitude `q`, and time is
/// measured as `T_v = c_v t/H²` with the drained oedometric `c_v`.
#[derive(Clone, Copy, Debug)]
pub struct CosineLayer {
    parameters: ColumnParameters,
    constants: Constants,
}

/// The layer at one time factor.
#[derive(Clone, Debug)]
pub struct LayerState {
    constants: Constants,
    load: f64,
    /// Solutions and the complex weights of their sum's real part.
    parts: Vec<(ElasticSolution, Complex<f64>)>,
}

/// Fields of the layer at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerFields {
    /// Displacement of the solid in `x` and upward, m.
    pub displacement: [f64; 2],
    /// Excess pore pressure, compression positive, Pa.
    pub pressure: f64,
    /// Effective stresses `σ'_xx`, `σ'_yy`, `σ'_zz`, `σ'_xy`, tension positive, Pa.
    pub effective_stress: [f64; 4],
}

impl LayerFields {
    /// Fields at the phase `βx` of amplitudes.
    #[must_use]
    pub fn at(&self, phase: f64) -> Self {
        let (sine, cosine) = (elementary::sin(phase), elementary::cos(phase));
        let [xx, yy, zz, xy] = self.effective_stress;
        Self {
            displacement: [self.displacement[0] * sine, self.displacement[1] * cosine],
            pressure: self.pressure * cosine,
            effective_stress: [xx * cosine, yy * cosine, zz * cosine, xy * sine],
        }
    }
}

impl CosineLayer {
    /// The layer of a column's material and height, and of a length `L` in m.
    ///
    /// # Errors
    /// When the parameters or the length are impossible.
    pub fn new(
        parameters: &ColumnParameters,
        length: f64,
        base: Base,
        water: Water,
    ) -> Result<Self, ExactError> {
        parameters.validate()?;
        let wave_number = PI / positive("length of the layer", length)?;
        let (modulus, ratio) = (parameters.soil.youngs_modulus, parameters.soil.poissons_ratio);
        let constants = Constants {
            lame: modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)),
            shear: modulus / (2.0 * (1.0 + ratio)),
            storage: match water {
                Water::Compressible => 1.0 / parameters.soil.coupling_modulus(),
                Water::Incompressible => 0.0,
            },
            mobility: parameters.soil.hydraulic_conductivity / parameters.soil.unit_weight_of_water(),
            wave_number: positive("wave number of the load", wave_number)?,
            height: parameters.height,
            base,
        };
        Ok(Self { parameters: *parameters, constants })
    }

    /// A limit in closed form.
    fn limit(&self, regime: Regime) -> Result<LayerState, ExactError> {
        Ok(LayerState {
            constants: self.constants,
            load: self.parameters.load,
            parts: vec![(ElasticSolution::new(self.constants, regime)?, Complex::new(1.0, 0.0))],
        })
    }

    /// The undrained start: an elastic layer with `λ_u = λ + Q`, `p = −Q ∇·u`.
    ///
    /// # Errors
    /// When the layer is so long that its system is singular.
    pub fn undrained(&self) -> Result<LayerState, ExactError> {
        self.limit(Regime::Undrained)
    }

    /// The drained end, without excess pressure.
    ///
    /// # Errors
    /// When the layer is so long that its system is singular.
    pub fn drained(&self) -> Result<LayerState, ExactError> {
        self.limit(Regime::Drained)
    }

    /// The layer at a time factor; at 0 the undrained start, in which the top still has pressure.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or the system is singular.
    pub fn at(&self, time_factor: f64) -> Result<LayerState, ExactError> {
        self.inverted(time_factor, NODES)
    }

    /// The layer by a number of nodes on Talbot's contour.
    fn inverted(&self, time_factor: f64, nodes: usize) -> Result<LayerState, ExactError> {
        if checked_time_factor(time_factor)? == 0.0 {
            return self.undrained();
        }
        let storage_ratio = match self.constants.storage {
            0.0 => 1.0,
            _ => self.parameters.storage_ratio(),
        };
        if storage_ratio * time_factor > ENDED {
            return self.drained();
        }
        let time = positive("time", self.parameters.time(time_factor))?;
        // The load is a step: 1/s.
        let parts = talbot_contour(nodes)
            .map(|(z, weight)| {
                let regime = Regime::Transformed(z / time);
                Ok((ElasticSolution::new(self.constants, regime)?, weight / z))
            })
            .collect::<Result<_, ExactError>>()?;
        Ok(LayerState { constants: self.constants, load: self.parameters.load, parts })
    }
}

impl Solution for CosineLayer {
    /// Fields under the crest of the load, `x = 0`, at the depth `zeta` below the surface.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let depth = checked_depth(zeta)?;
        let crest = self.at(time_factor)?.amplitudes(self.constants.height * (1.0 - depth))?;
        Ok(FieldValues {
            pressure: crest.pressure,
            effective_stress: crest.effective_stress[1],
            displacement: crest.displacement[1],
        })
    }

    /// Settlement under the crest of the load, `x = 0`, downward positive, m.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let crest = self.at(time_factor)?.fields(0.0, self.constants.height)?;
        Ok(-crest.displacement[1])
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(-self.drained()?.amplitudes(self.constants.height)?.displacement[1])
    }

    /// Nodes of the contour, and the difference that a fourth fewer make to the pressure, over the
    /// load.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let fine = self.at(time_factor)?;
        let coarse = self.inverted(time_factor, NODES * 3 / 4)?;
        let sensitivities: Vec<_> = fine.parts.iter().map(|(part, _)| part.sensitivities()).collect();
        let (mut worst, mut rounded) = (0.0_f64, 0.0_f64);
        for i in 0..=20 {
            let y = self.constants.height * f64::from(i) / 20.0;
            let difference = fine.fields(0.0, y)?.pressure - coarse.fields(0.0, y)?.pressure;
            worst = worst.max(difference.abs() / self.parameters.load);
            rounded = rounded.max(fine.round_off(&sensitivities, y));
        }
        Ok(Accuracy { phase_bound: rounded, ..Accuracy::new(NODES, worst) })
    }
}

impl LayerState {
    /// Fields at `x` along the layer and `y` over its base, m.
    ///
    /// # Errors
    /// When `y` is outside the layer or `x` not finite.
    pub fn fields(&self, x: f64, y: f64) -> Result<LayerFields, ExactError> {
        if !x.is_finite() {
            return Err(ExactError::NotFinite { quantity: "place along the layer", value: x });
        }
        Ok(self.amplitudes(y)?.at(self.constants.wave_number * x))
    }

    /// Amplitudes of the fields at `y` over the base, m: of `sin βx` in the horizontal displacement
    /// and the shear stress, of `cos βx` in the others. They are what costs: a grid of places has
    /// few heights.
    ///
    /// # Errors
    /// When `y` is outside the layer.
    pub fn amplitudes(&self, y: f64) -> Result<LayerFields, ExactError> {
        let height = self.constants.height;
        let y = held_within(y, height).ok_or(ExactError::OutsideLayer { y, height })?;
        let mut sum = LayerFields::default();
        for (solution, weight) in &self.parts {
            let part = self.real_part(solution, &solution.at(y), *weight);
            sum.pressure += part.pressure;
            for (total, value) in sum.displacement.iter_mut().zip(part.displacement) {
                *total += value;
            }
            for (total, value) in sum.effective_stress.iter_mut().zip(part.effective_stress) {
                *total += value;
            }
        }
        Ok(sum)
    }

    /// Round-off error of pressures and stresses over the load at `y` over the base, m: most terms of the sum over the
    /// contour cancel.
    fn round_off(&self, sensitivities: &[Vec<f64>], y: f64) -> f64 {
        let terms = self.parts.iter().zip(sensitivities).map(|((part, weight), sensitivities)| {
            elementary::modulus(*weight) * part.round_off(sensitivities, y)
        });
        f64::EPSILON * terms.sum::<f64>()
    }

    /// Wave number `β = π/L` along the layer, 1/m.
    pub fn wave_number(&self) -> f64 {
        self.constants.wave_number
    }

    /// Amplitudes of one node of the contour.
    fn real_part(&self, solution: &ElasticSolution, local: &Local, weight: Complex<f64>) -> LayerFields {
        let real = |value: Complex<f64>| self.load * (value * weight).re;
        let (lame, shear) = (self.constants.lame, self.constants.shear);
        let beta = self.constants.wave_number;
        let mean = solution.strain(local) * lame;
        LayerFields {
            displacement: [real(local.horizontal), real(local.vertical)],
            pressure: real(local.pressure),
            effective_stress: [
                real(mean + local.horizontal * (2.0 * shear * beta)),
                real(mean + local.vertical_slope * (2.0 * shear)),
                real(mean),
                real((local.horizontal_slope - local.vertical * beta) * shear),
            ],
        }
    }
}

#[cfg(test)]
mod tests;
