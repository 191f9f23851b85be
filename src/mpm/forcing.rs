//! What acts on a body from outside at every point: body forces and a source of water, each a function of the point
//! of the skeleton and the time.
//!
//! A scene whose motion was chosen gives one ([`Forcing`]); [`Forced`] is what a body keeps of it during a run.

use crate::mpm::state::grid::Grid;
use crate::mpm::state::points::Points;
use crate::soil::tensor::{Tensor, Vector};
use std::fmt::Debug;
use std::sync::Arc;

/// Body forces and a source of water on a motion that is known. Places `X` are those of the initial configuration, m.
pub trait Forcing<const D: usize>: Debug + Send + Sync {
    /// Force on the mixture, N per m^D of mixture, and on the water, N per m^D of water, at a point and time, s.
    fn body_forces(&self, place: &Vector<D>, time: f64) -> [Vector<D>; 2];

    /// Volume of water that is added, per volume of mixture and second.
    fn source(&self, place: &Vector<D>, time: f64) -> f64;

    /// The point that is at a present place at a time, looked for from a guess.
    fn material_place(&self, place: &Vector<D>, time: f64, guess: &Vector<D>) -> Vector<D>;
}

/// What a body keeps of what acts on it: the time, and the middle of the step.
#[derive(Clone, Debug)]
pub struct Forced<const D: usize> {
    /// What acts.
    pub acting: Arc<dyn Forcing<D>>,
    /// Time of the present stresses, s.
    pub time: f64,
    /// Point of the skeleton at each cell's centre when it was last looked for, m, `[cell][component]`.
    pub at_centre: Vec<Vector<D>>,
    /// Volume ratios of the points at the start of the step, and in its middle; `[point]`.
    volume_ratio: [Vec<f64>; 2],
    /// The same of the inverse deformation gradients.
    inverse_deformation: [Vec<Tensor<D>>; 2],
}

impl<const D: usize> Forced<D> {
    /// At the start of a run of points on a grid.
    pub fn of(acting: Arc<dyn Forcing<D>>, grid: &Grid<D>, points: &Points<D>) -> Self {
        Self {
            acting,
            time: 0.0,
            at_centre: (0..grid.cell_count()).map(|cell| grid.cell_centre(cell)).collect(),
            volume_ratio: [points.volume_ratio.clone(), points.volume_ratio.clone()],
            inverse_deformation: [points.inverse_deformation.clone(), points.inverse_deformation.clone()],
        }
    }

    /// Keeps the deformation at the start of a step.
    pub fn begin_step(&mut self, points: &Points<D>) {
        self.volume_ratio[0].copy_from_slice(&points.volume_ratio);
        self.inverse_deformation[0].copy_from_slice(&points.inverse_deformation);
    }

    /// Gives points that have been strained the deformation in the middle of the step; a second call gives them that
    /// of its end again.
    pub fn swap_middle(&mut self, points: &mut Points<D>) {
        std::mem::swap(&mut self.volume_ratio[1], &mut points.volume_ratio);
        std::mem::swap(&mut self.inverse_deformation[1], &mut points.inverse_deformation);
    }

    /// Takes the middle between the start of the step and its end.
    pub fn find_middle(&mut self, points: &Points<D>) {
        let [start, middle] = &mut self.volume_ratio;
        for ((middle, start), end) in middle.iter_mut().zip(start).zip(&points.volume_ratio) {
            *middle = 0.5 * (*start + end);
        }
        let [start, middle] = &mut self.inverse_deformation;
        for ((middle, start), end) in middle.iter_mut().zip(start).zip(&points.inverse_deformation) {
            *middle = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (start[i][j] + end[i][j])));
        }
    }
}
