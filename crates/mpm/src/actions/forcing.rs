//! Body forces and a water source, as functions of the skeleton point and time.
//!
//! A problem whose motion was chosen has one ([`Forcing`]); [`Forced`] is what a body keeps of it during a run. It is
//! asked for all points of a time at once: what is of the time alone is then made once.

use crate::state::grid::Grid;
use crate::state::points::Points;
pub use oedometer_problem::forcing::{BodyForces, Forcing};
use oedometer_problem::formulation::Formulation;
use oedometer_soil::tensor::{Tensor, Vector};
use std::sync::Arc;

/// Prescribed body forces and water sources of a body, with the state of its points in the middle of the step.
#[derive(Clone, Debug)]
pub struct Forced<const D: usize> {
    /// The prescribed forces and sources.
    pub acting: Arc<dyn Forcing<D>>,
    /// Formulation of the balances to which they are added.
    pub formulation: Formulation,
    /// Time of the present stresses, s.
    pub time: f64,
    /// Point of the skeleton at each cell's centre when it was last looked for, m, `[cell][component]`.
    pub at_centre: Vec<Vector<D>>,
    /// Points of the skeleton at the centres at the two searches before the last, m.
    before: [Vec<Vector<D>>; 2],
    /// Forces at the points, `[point]`.
    forces: Vec<BodyForces<D>>,
    /// Sources at the centres of cells and at the points, 1/s.
    sources: [Vec<f64>; 2],
    /// Volume ratios of the points at the start of the step, and in its middle; `[point]`.
    volume_ratio: [Vec<f64>; 2],
    /// Inverse deformation gradients of the points at the start of the step, and in its middle; `[point]`.
    inverse_deformation: [Vec<Tensor<D>>; 2],
}

impl<const D: usize> Forced<D> {
    /// The forcing of points on a grid, at the start of a run.
    pub fn new(acting: Arc<dyn Forcing<D>>, grid: &Grid<D>, points: &Points<D>) -> Self {
        let at_centre: Vec<_> = (0..grid.cell_count()).map(|cell| grid.cell_centre(cell)).collect();
        let mut forced = Self {
            acting,
            formulation: Formulation::VW,
            time: 0.0,
            before: [at_centre.clone(), at_centre.clone()],
            forces: vec![[[0.0; D]; 2]; points.len()],
            sources: [vec![0.0; at_centre.len()], vec![0.0; points.len()]],
            at_centre,
            volume_ratio: [points.volume_ratio.clone(), points.volume_ratio.clone()],
            inverse_deformation: [points.inverse_deformation.clone(), points.inverse_deformation.clone()],
        };
        forced.take_forces(points, 0.0);
        forced
    }

    /// Begins a step at a time, s: keeps the deformation of its start, and takes the forces.
    pub fn begin_step(&mut self, points: &Points<D>, time: f64) {
        self.time = time;
        self.volume_ratio[0].copy_from_slice(&points.volume_ratio);
        self.inverse_deformation[0].copy_from_slice(&points.inverse_deformation);
        self.take_forces(points, time);
    }

    /// Evaluates the body forces at a time, s.
    pub fn take_forces(&mut self, points: &Points<D>, time: f64) {
        self.acting.body_forces(self.formulation, &points.initial_position, time, &mut self.forces);
    }

    /// Forces at the points, `[point]`.
    #[inline]
    pub fn forces(&self) -> &[BodyForces<D>] {
        &self.forces
    }

    /// Evaluates the sources at a time, s, at the centres of cells, by the points of the skeleton that were found there.
    pub fn take_sources_at_centres(&mut self, mut cells: impl Iterator<Item = usize>, time: f64) {
        self.acting.sources(&self.at_centre, &mut cells, time, &mut self.sources[0]);
    }

    /// Evaluates the sources at a time, s, at the points.
    pub fn take_sources_at_points(&mut self, points: &Points<D>, time: f64) {
        let (places, sources) = (&points.initial_position, &mut self.sources[1]);
        self.acting.sources(places, &mut (0..places.len()), time, sources);
    }

    /// Source at the centre of a cell, 1/s.
    #[inline]
    pub fn source_at_centre(&self, cell: usize) -> f64 {
        self.sources[0][cell]
    }

    /// Source at a point, 1/s.
    #[inline]
    pub fn source_at_point(&self, point: usize) -> f64 {
        self.sources[1][point]
    }

    /// Looks for the points of the skeleton that are now at the centres of some cells: not far from where they would
    /// be, were they to go on along the parabola of the last three.
    pub fn find_centres(&mut self, grid: &Grid<D>, cells: impl Iterator<Item = usize> + Clone) {
        for cell in cells.clone() {
            let [before, earliest] = [self.before[0][cell], self.before[1][cell]];
            let now = self.at_centre[cell];
            (self.before[0][cell], self.before[1][cell]) = (now, before);
            self.at_centre[cell] = std::array::from_fn(|d| 3.0 * (now[d] - before[d]) + earliest[d]);
        }
        let present = |cell| grid.cell_centre(cell);
        self.acting.material_places(&present, &mut { cells }, self.time, &mut self.at_centre);
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
