//! The march in time of the pressure at the collocation points.

use nalgebra::DVector;

use crate::large_strain::diffusion::Loading;
use crate::large_strain::layers::{Layers, Profile};
use crate::large_strain::radau::{POINTS, STAGES, StageFactors, StageModes, weights};
use crate::large_strain::similarity::Front;

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
    /// Time factor of the state.
    pub time_factor: f64,
    /// `r = p/q` at the points below the surface.
    ratio: DVector<f64>,
}

/// March at one resolution.
#[derive(Clone, Debug)]
pub struct March {
    /// The spatial discretisation.
    pub layers: Layers,
    loading: Loading,
    weights: [[f64; STAGES]; STAGES],
    modes: StageModes,
    /// Longest step over the time that has passed.
    growth: f64,
}

impl March {
    /// A march with steps of up to `growth` times the time that has passed.
    pub fn new(layers: Layers, loading: Loading, growth: f64) -> Self {
        let weights = weights();
        let modes = StageModes::new(&weights);
        Self { layers, loading, weights, modes, growth }
    }

    /// The state before any load, without pressure.
    pub fn rest(&self) -> State {
        State { time_factor: 0.0, ratio: DVector::zeros(self.layers.len()) }
    }

    /// State at a time factor at which the front has not reached the base.
    pub fn start(&self, front: &Front, time_factor: f64) -> State {
        let ratio = self.layers.depths().skip(1).map(|zeta| front.pressure_ratio(time_factor, zeta));
        State { time_factor, ratio: DVector::from_iterator(self.layers.len(), ratio) }
    }

    /// Functions of the height through a state.
    pub fn profile(&self, state: &State) -> Profile {
        self.layers.profile(&state.ratio, 1.0 - self.loading.share(state.time_factor))
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

    /// One step of Radau IIA, by simplified Newton iteration on all stages at once.
    fn step(&self, now: &State, step: f64) -> Option<DVector<f64>> {
        let ratio = &now.ratio;
        let order = ratio.len();
        let loads = POINTS.map(|point| self.loading.within_step(now.time_factor, point * step));
        let jacobian = self.layers.jacobian(ratio, self.loading.within_step(now.time_factor, 0.0));
        let factors = StageFactors::new(&self.modes, &jacobian, step);
        let mut increments = DVector::zeros(STAGES * order);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let rates: Vec<DVector<f64>> = (0..STAGES)
                .map(|stage| self.layers.rate(&(ratio + increments.rows(stage * order, order)), loads[stage]))
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
