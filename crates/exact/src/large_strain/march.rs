//! The march in time of the pressure at the collocation points.

use nalgebra::{DMatrix, DVector};

use crate::large_strain::chebyshev::{self, EvenGrid};
use crate::large_strain::diffusion::{Diffusion, LoadAt, Loading};
use crate::large_strain::radau::{POINTS, STAGES, StageFactors, StageModes, weights};
use crate::large_strain::similarity::{Front, with_slopes};

/// Simplified Newton iterations before a step is halved.
const MOST_ITERATIONS: usize = 40;
/// A step may be halved this often.
const MOST_HALVINGS: usize = 12;
/// Longest step in units of the column's time factor: the slowest mode decays with `π²/4`.
const LONGEST_STEP: f64 = 0.25;
/// Pressure ratio below which consolidation has ended.
const ENDED: f64 = 1e-17;

/// Solution at one time factor.
#[derive(Clone, Debug)]
pub struct State {
    /// When.
    pub time_factor: f64,
    /// `r = p/q` at the points below the surface.
    ratio: DVector<f64>,
}

/// March at one resolution.
#[derive(Clone, Debug)]
pub struct March {
    diffusion: Diffusion,
    loading: Loading,
    grid: EvenGrid,
    weights: [[f64; STAGES]; STAGES],
    modes: StageModes,
    /// Longest step over the time that has passed.
    growth: f64,
}

/// A state as functions of the depth.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Coefficients of `r` in `s = 2(1 − ζ)² − 1`.
    ratio: Vec<f64>,
    /// Coefficients of `1 − J`.
    shrinkage: Vec<f64>,
}

impl Profile {
    /// Pressure ratio at a depth.
    pub fn pressure_ratio(&self, zeta: f64) -> f64 {
        if zeta == 0.0 {
            return 0.0;
        }
        let height = 1.0 - zeta;
        chebyshev::evaluate(&self.ratio, 2.0 * height * height - 1.0)
    }

    /// `∫_ζ^1 (1 − J) dζ`.
    pub fn shrinkage_below(&self, zeta: f64) -> f64 {
        chebyshev::even_integral_from_zero(&self.shrinkage, 1.0 - zeta)
    }
}

impl March {
    /// A march on `order` points with steps of up to `growth` times the time that has passed.
    pub fn new(diffusion: Diffusion, loading: Loading, order: usize, growth: f64) -> Self {
        let weights = weights();
        let modes = StageModes::of(&weights);
        Self { diffusion, loading, grid: EvenGrid::new(order), weights, modes, growth }
    }

    /// Before any load: no pressure at all.
    pub fn rest(&self) -> State {
        State { time_factor: 0.0, ratio: DVector::zeros(self.grid.heights.len() - 1) }
    }

    /// State at a time factor at which the front has not reached the base.
    pub fn start(&self, front: &Front, time_factor: f64) -> State {
        let ratio =
            self.grid.heights[1..].iter().map(|height| front.pressure_ratio(time_factor, 1.0 - height));
        State { time_factor, ratio: DVector::from_iterator(self.grid.heights.len() - 1, ratio) }
    }

    /// Functions of the depth through a state.
    pub fn profile(&self, state: &State) -> Profile {
        let values: Vec<f64> = core::iter::once(0.0).chain(state.ratio.iter().copied()).collect();
        let absent = 1.0 - self.loading.share(state.time_factor);
        let shrinkage: Vec<f64> =
            values.iter().map(|&ratio| self.diffusion.shrinkage(ratio + absent)).collect();
        Profile { ratio: chebyshev::coefficients(&values), shrinkage: chebyshev::coefficients(&shrinkage) }
    }

    /// Depths of the points.
    pub fn depths(&self) -> impl Iterator<Item = f64> {
        self.grid.heights.iter().map(|height| 1.0 - height)
    }

    /// Marches from a state to a later time factor; `None` where Newton's iteration fails.
    pub fn advance(&self, state: &State, time_factor: f64) -> Option<State> {
        match self.loading.kink_between(state.time_factor, time_factor) {
            Some(kink) => self.advance_smoothly(&self.advance_smoothly(state, kink)?, time_factor),
            None => self.advance_smoothly(state, time_factor),
        }
    }

    /// Marches to a time before which the growth of the load does not change.
    fn advance_smoothly(&self, state: &State, time_factor: f64) -> Option<State> {
        let mut now = state.clone();
        let mut halvings = 0;
        let mut shortened = 1.0;
        while now.time_factor < time_factor {
            if now.ratio.amax() < ENDED && self.loading.rate(now.time_factor) == 0.0 {
                now.time_factor = time_factor;
                break;
            }
            let left = time_factor - now.time_factor;
            let step = shortened * (self.growth * self.loading.age(now.time_factor)).min(LONGEST_STEP);
            // Even out the last steps: none is a sliver.
            let step = left / (left / step).ceil();
            match self.step(&now, step) {
                Some(ratio) => {
                    now.ratio = ratio;
                    let last = step >= left;
                    now.time_factor = if last { time_factor } else { now.time_factor + step };
                }
                None if halvings < MOST_HALVINGS => {
                    halvings += 1;
                    shortened *= 0.5;
                }
                None => return None,
            }
        }
        Some(now)
    }

    /// `r_T = (r_ζζ − G r_ζ² + β_s λ_T)/β` at the points.
    fn rate(&self, ratio: &DVector<f64>, load: LoadAt) -> DVector<f64> {
        let slope = &self.grid.first * ratio;
        let mut rate = &self.grid.second * ratio;
        for i in 0..ratio.len() {
            let coefficients = self.diffusion.coefficients(ratio[i] + load.absent);
            let squared = self.grid.metric[i] * slope[i] * slope[i];
            let squeezed = coefficients.skeleton_storage * load.rate;
            rate[i] = (rate[i] - coefficients.steepening * squared + squeezed) / coefficients.storage;
        }
        rate
    }

    /// Derivative of the rate.
    fn jacobian(&self, ratio: &DVector<f64>, load: LoadAt) -> DMatrix<f64> {
        let slope = &self.grid.first * ratio;
        let curvature = &self.grid.second * ratio;
        let mut jacobian = self.grid.second.clone();
        for i in 0..ratio.len() {
            let ([storage, steepening, skeleton], [storage_slope, steepening_slope, skeleton_slope]) =
                with_slopes(&self.diffusion, ratio[i] + load.absent);
            let weighted = self.grid.metric[i] * slope[i];
            let squared = weighted * slope[i];
            let rate = (curvature[i] - steepening * squared + skeleton * load.rate) / storage;
            for j in 0..ratio.len() {
                jacobian[(i, j)] -= 2.0 * steepening * weighted * self.grid.first[(i, j)];
                jacobian[(i, j)] /= storage;
            }
            let change = skeleton_slope * load.rate - steepening_slope * squared - storage_slope * rate;
            jacobian[(i, i)] += change / storage;
        }
        jacobian
    }

    /// One step of Radau IIA, by simplified Newton iteration on all stages at once.
    fn step(&self, now: &State, step: f64) -> Option<DVector<f64>> {
        let ratio = &now.ratio;
        let order = ratio.len();
        let loads = POINTS.map(|point| self.loading.within_step(now.time_factor, point * step));
        let jacobian = self.jacobian(ratio, self.loading.within_step(now.time_factor, 0.0));
        let factors = StageFactors::of(&self.modes, &jacobian, step);
        let mut increments = DVector::zeros(STAGES * order);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let rates: Vec<DVector<f64>> = (0..STAGES)
                .map(|stage| self.rate(&(ratio + increments.rows(stage * order, order)), loads[stage]))
                .collect();
            let mut residual = -&increments;
            for (i, row) in self.weights.iter().enumerate() {
                let mut part = residual.rows_mut(i * order, order);
                for (weight, rate) in row.iter().zip(&rates) {
                    part.axpy(step * weight, rate, 1.0);
                }
            }
            let change = factors.solve(&residual)?;
            increments += &change;
            let size = change.amax();
            if !size.is_finite() || size > 1e3 {
                return None;
            }
            // Round-off of the second derivative stops the iteration somewhere above 1e-15.
            if size < 1e-15 || (size < 1e-10 && size >= 0.5 * last) {
                return Some(ratio + increments.rows((STAGES - 1) * order, order));
            }
            last = size;
        }
        None
    }
}
