//! The march in time of the pressure at the collocation points.

use nalgebra::{DMatrix, DVector};

use crate::exact_error::ExactError;
use crate::large_strain::chebyshev::{self, EvenGrid};
use crate::large_strain::diffusion::{Diffusion, LargeStrainModel, LoadAt, Loading};
use crate::large_strain::layers::Layers;
use crate::large_strain::legendre;
use crate::large_strain::radau::{POINTS, STAGES, StageFactors, StageModes, weights};
use crate::large_strain::similarity::{Front, with_slopes};
use crate::parameters::ColumnParameters;

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
    space: Space,
    loading: Loading,
    weights: [[f64; STAGES]; STAGES],
    modes: StageModes,
    /// Longest step over the time that has passed.
    growth: f64,
}

/// Where the pressure is known, and what moves it there.
#[derive(Clone, Debug)]
pub enum Space {
    /// A column of one soil: functions that are even about the base.
    Even(Diffusion, EvenGrid),
    /// A column of layers.
    Layers(Layers),
}

/// A state as functions of the depth.
#[derive(Clone, Debug)]
pub enum Profile {
    /// Coefficients of `r` and `1 − J` in `s = 2(1 − ζ)² − 1`.
    Even { ratio: Vec<f64>, shrinkage: Vec<f64> },
    /// The layers from the surface down.
    Layers(Vec<Piece>),
}

/// A state as functions of the height in a layer.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Heights of base and top over that of the column.
    pub ends: [f64; 2],
    /// Legendre coefficients of `r` from −1, the base, to 1.
    pub ratio: Vec<f64>,
    /// Those of `1 − J`.
    pub shrinkage: Vec<f64>,
}

impl Piece {
    /// The place of a height in the layer, from −1 to 1; of one above it 1.
    fn place(&self, height: f64) -> f64 {
        let [base, top] = self.ends;
        (2.0 * (height - base) / (top - base) - 1.0).min(1.0)
    }
}

impl Profile {
    /// Pressure ratio at a depth.
    pub fn pressure_ratio(&self, zeta: f64) -> f64 {
        if zeta == 0.0 {
            return 0.0;
        }
        let height = 1.0 - zeta;
        match self {
            Self::Even { ratio, .. } => chebyshev::evaluate(ratio, 2.0 * height * height - 1.0),
            Self::Layers(pieces) => {
                let holds = |piece: &&Piece| height >= piece.ends[0];
                let piece = pieces.iter().find(holds).or(pieces.last());
                piece.map_or(f64::NAN, |piece| legendre::evaluate(&piece.ratio, piece.place(height)))
            }
        }
    }

    /// `∫_ζ^1 (1 − J) dζ`.
    pub fn shrinkage_below(&self, zeta: f64) -> f64 {
        let height = 1.0 - zeta;
        match self {
            Self::Even { shrinkage, .. } => chebyshev::even_integral_from_zero(shrinkage, height),
            Self::Layers(pieces) => pieces
                .iter()
                .filter(|piece| height > piece.ends[0])
                .map(|piece| {
                    let to_top = |place: f64| legendre::integral_to_one(&piece.shrinkage, place);
                    0.5 * (piece.ends[1] - piece.ends[0]) * (to_top(-1.0) - to_top(piece.place(height)))
                })
                .sum(),
        }
    }
}

impl Space {
    /// That of a column, with so many points in each of its layers.
    ///
    /// # Errors
    /// When a parameter is impossible, or layers are.
    pub fn of(
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        order: usize,
    ) -> Result<Self, ExactError> {
        if parameters.soils.is_empty() {
            Ok(Self::Even(Diffusion::new(model, parameters, 1.0)?, EvenGrid::new(order)))
        } else {
            Layers::of(parameters, model, order).map(Self::Layers)
        }
    }

    /// Points below the surface.
    fn len(&self) -> usize {
        match self {
            Self::Even(_, grid) => grid.heights.len() - 1,
            Self::Layers(layers) => layers.len(),
        }
    }

    /// `r_T = (r_ζζ − G r_ζ² + β_s λ_T)/β` at the points, in layers what their balance says.
    fn rate(&self, ratio: &DVector<f64>, load: LoadAt) -> DVector<f64> {
        let (diffusion, grid) = match self {
            Self::Even(diffusion, grid) => (diffusion, grid),
            Self::Layers(layers) => return layers.rate(ratio, load),
        };
        let slope = &grid.first * ratio;
        let mut rate = &grid.second * ratio;
        for i in 0..ratio.len() {
            let coefficients = diffusion.coefficients(ratio[i] + load.absent);
            let squared = grid.metric[i] * slope[i] * slope[i];
            let squeezed = coefficients.skeleton_storage * load.rate;
            rate[i] = (rate[i] - coefficients.steepening * squared + squeezed) / coefficients.storage;
        }
        rate
    }

    /// Derivative of the rate.
    fn jacobian(&self, ratio: &DVector<f64>, load: LoadAt) -> DMatrix<f64> {
        let (diffusion, grid) = match self {
            Self::Even(diffusion, grid) => (diffusion, grid),
            Self::Layers(layers) => return layers.jacobian(ratio, load),
        };
        let slope = &grid.first * ratio;
        let curvature = &grid.second * ratio;
        let mut jacobian = grid.second.clone();
        for i in 0..ratio.len() {
            let ([storage, steepening, skeleton], [storage_slope, steepening_slope, skeleton_slope]) =
                with_slopes(diffusion, ratio[i] + load.absent);
            let weighted = grid.metric[i] * slope[i];
            let squared = weighted * slope[i];
            let rate = (curvature[i] - steepening * squared + skeleton * load.rate) / storage;
            for j in 0..ratio.len() {
                jacobian[(i, j)] -= 2.0 * steepening * weighted * grid.first[(i, j)];
                jacobian[(i, j)] /= storage;
            }
            let change = skeleton_slope * load.rate - steepening_slope * squared - storage_slope * rate;
            jacobian[(i, i)] += change / storage;
        }
        jacobian
    }
}

impl March {
    /// A march with steps of up to `growth` times the time that has passed.
    pub fn new(space: Space, loading: Loading, growth: f64) -> Self {
        let weights = weights();
        let modes = StageModes::of(&weights);
        Self { space, loading, weights, modes, growth }
    }

    /// Before any load: no pressure at all.
    pub fn rest(&self) -> State {
        State { time_factor: 0.0, ratio: DVector::zeros(self.space.len()) }
    }

    /// State at a time factor at which the front has not reached the base.
    pub fn start(&self, front: &Front, time_factor: f64) -> State {
        let ratio = self.depths().skip(1).map(|zeta| front.pressure_ratio(time_factor, zeta));
        State { time_factor, ratio: DVector::from_iterator(self.space.len(), ratio) }
    }

    /// Functions of the depth through a state.
    pub fn profile(&self, state: &State) -> Profile {
        let absent = 1.0 - self.loading.share(state.time_factor);
        match &self.space {
            Space::Even(diffusion, _) => {
                let values: Vec<f64> = core::iter::once(0.0).chain(state.ratio.iter().copied()).collect();
                let shrinkage: Vec<f64> =
                    values.iter().map(|&ratio| diffusion.shrinkage(ratio + absent)).collect();
                Profile::Even {
                    ratio: chebyshev::coefficients(&values),
                    shrinkage: chebyshev::coefficients(&shrinkage),
                }
            }
            Space::Layers(layers) => layers.profile(&state.ratio, absent),
        }
    }

    /// Depths of the points, from the surface down.
    pub fn depths(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match &self.space {
            Space::Even(_, grid) => Box::new(grid.heights.iter().map(|height| 1.0 - height)),
            Space::Layers(layers) => Box::new(layers.depths()),
        }
    }

    /// `1 − J` at a depth and a time factor where the pressure ratio is so.
    pub fn shrinkage(&self, time_factor: f64, zeta: f64, ratio: f64) -> f64 {
        let lacking = ratio + 1.0 - self.loading.share(time_factor);
        match &self.space {
            Space::Even(diffusion, _) => diffusion.shrinkage(lacking),
            Space::Layers(layers) => layers.shrinkage(zeta, lacking),
        }
    }

    /// `∫ (1 − J) dζ` over the column at the end of consolidation.
    pub fn final_shrinkage(&self) -> f64 {
        match &self.space {
            Space::Even(diffusion, _) => diffusion.shrinkage(0.0),
            Space::Layers(layers) => layers.final_shrinkage(),
        }
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
        let jacobian = self.space.jacobian(ratio, self.loading.within_step(now.time_factor, 0.0));
        let factors = StageFactors::of(&self.modes, &jacobian, step);
        let mut increments = DVector::zeros(STAGES * order);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let rates: Vec<DVector<f64>> = (0..STAGES)
                .map(|stage| self.space.rate(&(ratio + increments.rows(stage * order, order)), loads[stage]))
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
