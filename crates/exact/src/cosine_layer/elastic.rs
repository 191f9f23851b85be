//! The six exponentials that solve Biot's equations in a layer, and their boundary conditions.

use nalgebra::{Complex, DMatrix, DVector};

use crate::exact_error::ExactError;
use crate::parameters::Base;
use oedometer_soil::elementary;

/// Elastic and hydraulic constants of the layer, SI.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    /// Lamé's drained `λ` and `μ`, Pa.
    pub lame: f64,
    pub shear: f64,
    /// Storage `S = n/K_w`, 1/Pa; 0 with incompressible water.
    pub storage: f64,
    /// `k/γ_w`, m⁴/(N s).
    pub mobility: f64,
    /// Wave number `β = π/L` along the layer, 1/m.
    pub wave_number: f64,
    pub height: f64,
    pub base: Base,
}

/// Which limit, or which point of the Laplace domain, is solved.
#[derive(Clone, Copy, Debug)]
pub enum Regime {
    /// No flow.
    Undrained,
    /// No excess pressure.
    Drained,
    /// Transform variable `s`, 1/s.
    Transformed(Complex<f64>),
}

/// Amplitudes and their slopes in height.
#[derive(Clone, Copy, Debug, Default)]
pub struct Local {
    /// `U`, of `sin βx`, m.
    pub horizontal: Complex<f64>,
    pub horizontal_slope: Complex<f64>,
    /// `V`, of `cos βx`, upward, m.
    pub vertical: Complex<f64>,
    pub vertical_slope: Complex<f64>,
    /// `P`, of `cos βx`, Pa.
    pub pressure: Complex<f64>,
    pub pressure_slope: Complex<f64>,
}

/// General solution of one regime with the coefficients that fit the boundary.
///
/// With `h = M ε − p` harmonic and `p = p_α − θh`, `∇²p_α = (s/c) p_α`,
///
/// ```text
/// u = (c/(s M)) ∇p_α + u_h,   μ∇²u_h = −ω∇h,   ∇·u_h = (1 − θ) h/M
/// ```
///
/// each in `exp(±βy)` and `exp(±αy)`, `α² = β² + s/c`, measured from the boundary they decay from:
/// the six by six system stays well conditioned however thin the boundary layers are.
#[derive(Clone, Debug)]
pub struct ElasticSolution {
    constants: Constants,
    theta: f64,
    omega: f64,
    /// `α` and `c/(s M)`, where there is diffusion.
    layer: Option<(Complex<f64>, Complex<f64>)>,
    coefficients: Vec<Complex<f64>>,
}

/// Round-off of a term over its size, in units of the last place.
const ROUND_OFF_OF_TERM: f64 = 4.0;

/// A boundary that a solution decays from.
#[derive(Clone, Copy)]
enum Side {
    Top,
    Base,
}

impl ElasticSolution {
    /// Solves a regime under the unit load `cos βx` on the top.
    ///
    /// # Errors
    /// When the boundary's system is singular in `f64`.
    pub fn new(constants: Constants, regime: Regime) -> Result<Self, ExactError> {
        let modulus = constants.lame + 2.0 * constants.shear;
        let theta = match regime {
            Regime::Drained => 0.0,
            Regime::Undrained | Regime::Transformed(_) => 1.0 / (1.0 + modulus * constants.storage),
        };
        let layer = match regime {
            Regime::Undrained | Regime::Drained => None,
            Regime::Transformed(s) => {
                let diffusivity = constants.mobility / (1.0 / modulus + constants.storage);
                let beta = constants.wave_number;
                let alpha = elementary::sqrt_complex(s / diffusivity + beta * beta);
                Some((alpha, (s / diffusivity * modulus).inv()))
            }
        };
        let mut solution = Self {
            constants,
            theta,
            omega: theta + (1.0 - theta) * (constants.lame + constants.shear) / modulus,
            layer,
            coefficients: Vec::new(),
        };
        let system = solution.system();
        let mut load = DVector::zeros(system.nrows());
        load[0] = Complex::new(-1.0, 0.0);
        solution.coefficients = system
            .lu()
            .solve(&load)
            .filter(|coefficients| coefficients.iter().all(|c| c.is_finite()))
            .ok_or(ExactError::LayerSingular {
                ratio: core::f64::consts::PI / (constants.wave_number * constants.height),
            })?
            .iter()
            .copied()
            .collect();
        Ok(solution)
    }

    /// Conditions of the boundary, one row each, of every term.
    fn system(&self) -> DMatrix<Complex<f64>> {
        let unknowns = if self.layer.is_some() { 6 } else { 4 };
        let top: Vec<_> = (0..unknowns).map(|k| self.term(k, self.constants.height)).collect();
        let base: Vec<_> = (0..unknowns).map(|k| self.term(k, 0.0)).collect();
        DMatrix::from_fn(unknowns, unknowns, |row, k| self.condition(row, &top[k], &base[k]))
    }

    /// How far the coefficients move where each entry of the system moves by its own size: `|A⁻¹| |A| |x|` (Skeel 1979);
    /// infinite where the system has no inverse.
    pub fn sensitivities(&self) -> Vec<f64> {
        let system = self.system();
        let Some(inverse) = system.clone().try_inverse() else {
            return vec![f64::INFINITY; self.coefficients.len()];
        };
        let sizes = DVector::from_iterator(
            self.coefficients.len(),
            self.coefficients.iter().map(|&coefficient| elementary::modulus(coefficient)),
        );
        let moved = inverse.map(elementary::modulus) * (system.map(elementary::modulus) * sizes);
        moved.iter().copied().collect()
    }

    /// Boundary condition `row` of one term: traction and shear on the top, base, then pressure.
    fn condition(&self, row: usize, top: &Local, base: &Local) -> Complex<f64> {
        let beta = self.constants.wave_number;
        let stiffness = 2.0 * self.constants.shear * beta;
        let shear = |at: &Local| (at.horizontal_slope - at.vertical * beta) * self.constants.shear;
        match row {
            0 => {
                let strain = self.strain(top);
                strain * self.constants.lame + top.vertical_slope * (2.0 * self.constants.shear)
                    - top.pressure
            }
            1 => shear(top),
            2 => base.vertical * stiffness,
            3 => match self.constants.base {
                Base::Rough => base.horizontal * stiffness,
                Base::Smooth => shear(base),
            },
            4 => top.pressure,
            _ => {
                let scale = self.layer.map_or(1.0, |(alpha, _)| elementary::modulus(alpha));
                base.pressure_slope / scale
            }
        }
    }

    /// Volume strain `ε = βU + V'`.
    pub fn strain(&self, local: &Local) -> Complex<f64> {
        local.horizontal * self.constants.wave_number + local.vertical_slope
    }

    /// One of the six terms at a height over the base in m.
    fn term(&self, index: usize, y: f64) -> Local {
        let side = if index.is_multiple_of(2) { Side::Top } else { Side::Base };
        let (sign, from) = match side {
            Side::Top => (1.0, self.constants.height),
            Side::Base => (-1.0, 0.0),
        };
        let (beta, shear) = (self.constants.wave_number, self.constants.shear);
        let away = y - from;
        let decay = elementary::exp(sign * beta * away);
        match index / 2 {
            0 => {
                // Without volume change or pressure; of unit stress.
                let vertical = decay / (2.0 * shear * beta);
                Local {
                    horizontal: Complex::from(-sign * vertical),
                    horizontal_slope: Complex::from(-beta * vertical),
                    vertical: Complex::from(vertical),
                    vertical_slope: Complex::from(sign * beta * vertical),
                    ..Local::default()
                }
            }
            1 => {
                // h = exp(±β(y − y_σ)).
                let modulus = self.constants.lame + 2.0 * shear;
                let steep = self.omega / (2.0 * shear);
                let constant = ((1.0 - self.theta) / modulus + steep) / beta;
                let horizontal = constant + sign * steep * away;
                let vertical = -steep * away;
                Local {
                    horizontal: Complex::from(horizontal * decay),
                    horizontal_slope: Complex::from(sign * (steep + beta * horizontal) * decay),
                    vertical: Complex::from(vertical * decay),
                    vertical_slope: Complex::from((sign * beta * vertical - steep) * decay),
                    pressure: Complex::from(-self.theta * decay),
                    pressure_slope: Complex::from(-self.theta * sign * beta * decay),
                }
            }
            _ => self.layer.map_or_else(Local::default, |(alpha, potential)| {
                let pressure = elementary::exp_complex(alpha * (sign * away));
                let slope = alpha * sign * pressure;
                Local {
                    horizontal: -pressure * potential * beta,
                    horizontal_slope: -slope * potential * beta,
                    vertical: slope * potential,
                    vertical_slope: alpha * alpha * pressure * potential,
                    pressure,
                    pressure_slope: slope,
                }
            }),
        }
    }

    /// Round-off of pressures and stresses at a height, m over the base, in units of the last place: it is of the size of
    /// the terms, and not of their sum's.
    pub fn round_off(&self, sensitivities: &[f64], y: f64) -> f64 {
        let terms = self.coefficients.iter().zip(sensitivities).enumerate();
        let rounded = terms.map(|(index, (&coefficient, sensitivity))| {
            let term = self.term(index, y);
            let Constants { lame, shear, wave_number, .. } = self.constants;
            // The volume strain is a difference: near ν = ½ it has lost the digits of its parts.
            let along = term.horizontal * (wave_number * lame);
            let sizes = [term.pressure, along, term.vertical_slope * (lame + 2.0 * shear)];
            let size: f64 = sizes.into_iter().map(elementary::modulus).sum();
            size * (ROUND_OFF_OF_TERM * elementary::modulus(coefficient) + sensitivity)
        });
        rounded.sum()
    }

    /// The solution at a height over the base in m.
    pub fn at(&self, y: f64) -> Local {
        let mut sum = Local::default();
        for (index, &coefficient) in self.coefficients.iter().enumerate() {
            let term = self.term(index, y);
            sum.horizontal += coefficient * term.horizontal;
            sum.horizontal_slope += coefficient * term.horizontal_slope;
            sum.vertical += coefficient * term.vertical;
            sum.vertical_slope += coefficient * term.vertical_slope;
            sum.pressure += coefficient * term.pressure;
            sum.pressure_slope += coefficient * term.pressure_slope;
        }
        sum
    }
}
