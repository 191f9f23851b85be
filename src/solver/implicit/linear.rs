//! SDIRK2 on the linear system of a frozen body.
//!
//! Two stages with one matrix, L-stable and stiffly accurate (Alexander 1977): with
//! `γ = 1 − 1/√2`, `x_i = x̂_i + z_i`, `(C + γΔt K) z_i = γΔt (g − K x̂_i)` and
//! `x̂_1 = x_n`, `x̂_2 = x_n + (1−γ)/γ z_1`, `x_{n+1} = x_2`.
//!
//! What a stage leaves of `g − K x` is zero in the rows of the mixture and `C z/(γΔt)` in those of
//! the storage, and an extrapolated state has the extrapolated residual: no product with `K` is
//! ever taken.

use super::assembly::LinearSystem;
use super::banded::{BandedLu, Singular};
use crate::solver::body::{Body, ShapeFunction};
use crate::solver::grid::Vector;
use crate::solver::method::StrainGradient;

/// `γ = 1 − 1/√2`: both stages have the same matrix and the method is L-stable.
pub const SDIRK_GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// `(1 − γ)/γ`: share of the first stage's increment in the start of the second.
pub const SECOND_STAGE: f64 = (1.0 - SDIRK_GAMMA) / SDIRK_GAMMA;

/// A frozen body on its way through time.
#[derive(Clone, Debug)]
pub struct LinearMarch<const D: usize> {
    system: LinearSystem<D>,
    lu: BandedLu,
    /// Step size that the factors belong to, s.
    factored: Option<f64>,
    /// State `x`.
    state: Vec<f64>,
    /// `g − K x`.
    residual: Vec<f64>,
    increment: Vec<f64>,
    /// Factor of the last increment that makes it the rate of `x`, 1/s: one over `γΔt`.
    rate_scale: f64,
    /// Relative flux that passed the surface, `∫ n (v_w − v_s) dt`, m.
    outflow: f64,
    /// Times the matrix was factored.
    pub factorisations: u64,
}

impl<const D: usize> LinearMarch<D> {
    /// A body at its start.
    pub fn new<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        let system = LinearSystem::of(body);
        let zero = vec![0.0; system.unknowns.count];
        Self {
            lu: BandedLu::of_shape(&system.fixed),
            factored: None,
            state: zero.clone(),
            residual: system.start_residual.clone(),
            increment: zero,
            rate_scale: 0.0,
            outflow: 0.0,
            factorisations: 0,
            system,
        }
    }

    /// Factors the matrix of steps of `dt` seconds, where it is not that of the last ones.
    ///
    /// # Errors
    /// [`Singular`] when the matrix has no inverse.
    pub fn set_step(&mut self, dt: f64) -> Result<(), Singular> {
        if self.factored != Some(dt) {
            let system = &self.system;
            self.lu.factor_combination(&system.fixed, SDIRK_GAMMA * dt, &system.proportional)?;
            self.factored = Some(dt);
            self.factorisations += 1;
        }
        Ok(())
    }

    /// One step of the size last set; nothing is allocated.
    pub fn step(&mut self) {
        let Some(dt) = self.factored else { return };
        let stage = SDIRK_GAMMA * dt;
        let system = &self.system;
        let sites = &system.unknowns.pressure;
        // After the first stage the state goes on to the start of the second, then to the end.
        for share in [SECOND_STAGE, 1.0] {
            self.increment.copy_from_slice(&self.residual);
            for unknown in sites {
                self.increment[*unknown] *= stage;
            }
            self.lu.solve(&mut self.increment);
            let outflow_rate = system.start_outflow
                + system.surface_outflow.product(0, &self.state)
                + system.surface_outflow.product(0, &self.increment);
            self.outflow += share * stage * outflow_rate;
            for (state, increment) in self.state.iter_mut().zip(&self.increment) {
                *state += share * increment;
            }
            for residual in &mut self.residual {
                *residual *= 1.0 - share;
            }
            for (site, unknown) in sites.iter().enumerate() {
                self.residual[*unknown] += share * system.capacity.product(site, &self.increment) / stage;
            }
        }
        self.rate_scale = 1.0 / stage;
    }

    /// Vertical displacement of the loaded surface since the start, m.
    pub fn surface_displacement(&self) -> f64 {
        self.system.surface_displacement.product(0, &self.state)
    }

    /// Its rate at the end of the last step, m/s.
    pub fn surface_velocity(&self) -> f64 {
        self.rate_scale * self.system.surface_displacement.product(0, &self.increment)
    }

    /// Whether every unknown is a number.
    pub fn is_finite(&self) -> bool {
        self.state.iter().all(|value| value.is_finite())
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.system.unknowns.count
    }

    /// The body at the present state, from the body that was assembled.
    pub fn body_now<const W: usize, S: ShapeFunction<W>>(&self, start: &Body<D, W, S>) -> Body<D, W, S> {
        let mut body = start.clone();
        let unknowns = &self.system.unknowns;
        let nodal = |values: &[f64], scale: f64| -> Vec<Vector<D>> {
            let component = |unknown: Option<usize>| unknown.map_or(0.0, |unknown| scale * values[unknown]);
            unknowns.displacement.iter().map(|node| node.map(component)).collect()
        };
        let displacement = nodal(&self.state, self.system.scales.length);
        let stride = *body.grid.node_stride();
        for point in 0..body.points.len() {
            let gradient = match body.method.strain {
                StrainGradient::Standard => body.basis.gradient(&stride, point, &displacement),
                StrainGradient::Cmpm => body.composite.gradient(&stride, point, &displacement),
            };
            let stress = body.stiffness.stress(&gradient);
            let moved = body.basis.value(&stride, point, &displacement);
            for i in 0..D {
                for j in 0..D {
                    body.points.effective_stress[point][i][j] += stress[i][j];
                }
                body.points.displacement[point][i] += moved[i];
            }
            let mut pressure = 0.0;
            unknowns.visit_recovery(start, point, |site, weight| {
                pressure += weight * self.state[unknowns.pressure[site]];
            });
            body.points.pressure[point] += pressure * self.system.scales.pressure;
        }
        for (total, change) in body.nodes.displacement.iter_mut().zip(&displacement) {
            for d in 0..D {
                total[d] += change[d];
            }
        }
        body.nodes.solid_velocity = nodal(&self.increment, self.rate_scale * self.system.scales.length);
        body.surface_flux += self.surface_displacement() + self.outflow;
        body
    }
}
