//! Kinematics, stresses and residuals of a prescribed motion and pressure at a skeleton point and time.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

use crate::manufactured::dual::{Four, Jet, Number, Slope, TIME};
use crate::manufactured::motion::{ManufacturedModel, Moment, Spots};
use crate::parameters::ColumnParameters;
use oedometer_soil::law::Law;

/// Parameters of the soil in the balances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soil {
    /// Lamé's first parameter, Pa.
    lame: f64,
    /// Shear modulus, Pa.
    shear: f64,
    /// Share `1 − n_0` of the grains in the initial volume.
    grains: f64,
    /// Density of the grains, kg/m³.
    grain_density: f64,
    /// Density of the water, kg/m³.
    water_density: f64,
    /// Bulk modulus of the water, Pa.
    water_bulk_modulus: f64,
    /// `k_0/γ_w`, m⁴/(N s).
    mobility: f64,
}

impl Soil {
    /// The soil of a column.
    pub fn new(parameters: &ColumnParameters) -> Self {
        let shear = parameters.soil.youngs_modulus / (2.0 * (1.0 + parameters.soil.poissons_ratio));
        Self {
            lame: parameters.soil.oedometric_modulus() - 2.0 * shear,
            shear,
            grains: 1.0 - parameters.soil.porosity,
            grain_density: parameters.soil.grain_density,
            water_density: parameters.soil.water_density,
            water_bulk_modulus: parameters.soil.water_bulk_modulus,
            mobility: parameters.soil.hydraulic_conductivity / parameters.soil.unit_weight_of_water(),
        }
    }
}

/// Accelerations that the momentum balances keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Each phase's own.
    Both,
    /// That of the skeleton, which the water has too.
    Skeleton,
    /// None.
    None,
}

/// The states of four points of the skeleton. Vectors are `[component]`, tensors `[row][column]`. Rarely needed quantities
/// are methods.
#[derive(Clone, Copy, Debug)]
pub struct States {
    soil: Soil,
    law: Law,
    position: [Jet; 2],
    pressure: Jet,
    /// `F`.
    deformation: [[Slope; 2]; 2],
    volume_ratio: Slope,
    /// `1/J`.
    per_volume: Slope,
    porosity: Slope,
    /// `F⁻¹`.
    inverse_deformation: [[Slope; 2]; 2],
    pressure_gradient: [Slope; 2],
    flux: [Slope; 2],
}

/// A vector or a row of a tensor from a function of the component.
#[inline(always)]
fn pair<T>(component: impl Fn(usize) -> T) -> [T; 2] {
    [component(0), component(1)]
}

impl States {
    /// The states of four points at a time (docs/theory.md, Eqs 24 and 25).
    #[inline(always)]
    pub fn new(
        model: ManufacturedModel,
        parameters: &ColumnParameters,
        soil: &Soil,
        spots: &Spots,
        moment: &Moment,
    ) -> Self {
        let position = model.motion.place(&parameters.motion, spots, moment);
        let pressure =
            Jet::growing(&spots.pressure_shape(), moment.beat.map(|value| parameters.load * value));
        let [xx, xy] = pair(|d| position[0].derivative(d));
        let [yx, yy] = pair(|d| position[1].derivative(d));
        let deformation = [[xx, xy], [yx, yy]];
        let volume_ratio = xx * yy - xy * yx;
        let per_volume = volume_ratio.recip();
        let inverse_deformation =
            [[yy * per_volume, xy * per_volume * -1.0], [yx * per_volume * -1.0, xx * per_volume]];
        // grad p = F⁻ᵀ grad_X p
        let [along_x, along_y] = pair(|d| pressure.derivative(d));
        let pressure_gradient = [
            inverse_deformation[0][0] * along_x + inverse_deformation[1][0] * along_y,
            inverse_deformation[0][1] * along_x + inverse_deformation[1][1] * along_y,
        ];
        let porosity = Slope::constant(1.0) - per_volume * soil.grains;
        // w = −(k/γ_w) grad p with k = k_0 J²
        let mobility = volume_ratio * volume_ratio * -soil.mobility;
        let flux = [mobility * pressure_gradient[0], mobility * pressure_gradient[1]];
        Self {
            soil: *soil,
            law: model.law,
            position,
            pressure,
            deformation,
            volume_ratio,
            per_volume,
            porosity,
            inverse_deformation,
            pressure_gradient,
            flux,
        }
    }

    /// Derivative of a quantity along `x` or `y` on the current configuration, `F⁻ᵀ grad_X`.
    #[inline(always)]
    fn derivative(&self, quantity: &Slope, direction: usize) -> Four {
        let inverse = &self.inverse_deformation;
        inverse[0][direction].value * quantity.slope[0] + inverse[1][direction].value * quantity.slope[1]
    }

    /// Divergence of a vector on the current configuration.
    #[inline(always)]
    fn divergence(&self, vector: &[Slope; 2]) -> Four {
        self.derivative(&vector[0], 0) + self.derivative(&vector[1], 1)
    }

    #[inline(always)]
    fn solid_velocity_slope(&self) -> [Slope; 2] {
        pair(|i| self.position[i].derivative(TIME))
    }

    #[inline(always)]
    fn water_velocity_slope(&self) -> [Slope; 2] {
        let per_porosity = self.porosity.recip();
        pair(|i| self.position[i].derivative(TIME) + self.flux[i] * per_porosity)
    }

    /// Effective stress of the law from the deformation gradient; `logarithm` is applied to stretches. Its value enters the
    /// stress but not the slopes of the stress.
    #[inline(always)]
    fn stress(&self, logarithm: impl Fn(Slope) -> Slope) -> [[Slope; 2]; 2] {
        let (soil, deformation) = (&self.soil, &self.deformation);
        if self.law == Law::NeoHookean {
            // [μ (F Fᵀ − I) + λ ln J I]/J
            let pressure = self.volume_ratio.ln() * soil.lame + Slope::constant(-soil.shear);
            let mut stress = *deformation;
            for i in 0..2 {
                for j in 0..2 {
                    let [left, right] = [&deformation[i], &deformation[j]];
                    let stretch = (left[0] * right[0] + left[1] * right[1]) * soil.shear;
                    let kirchhoff = if i == j { stretch + pressure } else { stretch };
                    stress[i][j] = kirchhoff * self.per_volume;
                }
            }
            return stress;
        }
        // Without shear or spin: 2μ ln F_ii + λ ln J, and J = F_xx F_yy.
        let logarithms = pair(|i| logarithm(deformation[i][i]));
        let volumetric = (logarithms[0] + logarithms[1]) * soil.lame;
        pair(|i| {
            pair(
                |j| {
                    if i == j {
                        logarithms[i] * (2.0 * soil.shear) + volumetric
                    } else {
                        Slope::constant(0.0)
                    }
                },
            )
        })
    }

    /// Body forces on the mixture, N per m³ of mixture, and on the water, N per m³ of water: the residuals of the momentum
    /// balances with the accelerations that `inertia` keeps (docs/theory.md, Eq. 26). Rates follow the skeleton.
    #[inline(always)]
    pub fn body_forces(&self, inertia: Inertia) -> [[Four; 2]; 2] {
        let soil = &self.soil;
        let porosity = self.porosity.value;
        let still = [Four::all(0.0); 2];
        let skeleton_acceleration = || pair(|i| self.position[i].derivative(TIME).slope[TIME]);
        let [grain_acceleration, water_acceleration] = match inertia {
            Inertia::Both => {
                let velocity = self.water_velocity_slope();
                [skeleton_acceleration(), pair(|i| velocity[i].slope[TIME])]
            }
            Inertia::Skeleton => [skeleton_acceleration(); 2],
            Inertia::None => [still; 2],
        };
        let stress = self.stress(Slope::ln_slopes);
        let water = pair(|i| water_acceleration[i] * soil.water_density);
        let mixture = pair(|i| {
            let grains = (Four::all(1.0) - porosity) * soil.grain_density * grain_acceleration[i];
            grains + porosity * water[i] - self.divergence(&stress[i]) + self.pressure_gradient[i].value
        });
        // The drag balances the pressure gradient: no more is left for the water.
        [mixture, water]
    }

    /// Source of water, volume per volume of mixture and second: the residual of the continuity equation
    /// (docs/theory.md, Eq. 27).
    #[inline(always)]
    pub fn source(&self) -> Four {
        let storage =
            self.porosity.value.over(Four::all(self.soil.water_bulk_modulus)) * self.pressure.slope[TIME];
        self.divergence(&self.solid_velocity_slope()) + self.divergence(&self.flux) + storage
    }
}

/// The state of a point of the skeleton.
#[derive(Clone, Copy, Debug)]
pub struct State(States);

impl State {
    /// The state of the first of four points.
    pub fn from_first(states: States) -> Self {
        Self(states)
    }

    /// Present place, m.
    pub fn position(&self) -> [f64; 2] {
        pair(|i| self.0.position[i].value.first())
    }

    /// Volume ratio `J`.
    pub fn volume_ratio(&self) -> f64 {
        self.0.volume_ratio.value.first()
    }

    /// Porosity.
    pub fn porosity(&self) -> f64 {
        self.0.porosity.value.first()
    }

    /// Pore pressure, Pa, compression positive.
    pub fn pressure(&self) -> f64 {
        self.0.pressure.value.first()
    }

    /// Effective Cauchy stress, Pa, tension positive.
    pub fn effective_stress(&self) -> [[f64; 2]; 2] {
        self.0.stress(Slope::ln).map(|row| row.map(|component| component.value.first()))
    }

    /// Velocity of the skeleton, m/s.
    pub fn solid_velocity(&self) -> [f64; 2] {
        self.0.solid_velocity_slope().map(|component| component.value.first())
    }

    /// Velocity of the pore water, m/s.
    pub fn water_velocity(&self) -> [f64; 2] {
        self.0.water_velocity_slope().map(|component| component.value.first())
    }

    /// Body forces on mixture and water, as [`States::body_forces`].
    pub fn body_forces(&self, inertia: Inertia) -> [[f64; 2]; 2] {
        self.0.body_forces(inertia).map(|force| force.map(Four::first))
    }

    /// Source of water, as [`States::source`].
    pub fn source(&self) -> f64 {
        self.0.source().first()
    }
}
