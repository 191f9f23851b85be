//! What a frozen step makes of states without loads, for stability analysis.

use crate::assembled::assembled_state::{FIELDS, LANES, MARGIN, SOLID, WATER};
use crate::assembled::step::AssembledStep;
use crate::explicit::ExplicitSettings;
use nalgebra::DMatrix;

impl<const D: usize> AssembledStep<D> {
    /// Rows and components that are free in some phase, in order: the unknowns of the step operator.
    fn free_components(&self) -> Vec<(usize, usize)> {
        let is_free = |row: usize, d: usize| {
            self.constants[row / LANES].free.iter().any(|free| free[d][row % LANES] > 0.0)
        };
        let components = (0..self.nodes.len()).flat_map(|row| (0..D).map(move |d| (row, d)));
        components.filter(|(row, d)| is_free(*row, *d)).collect()
    }

    /// Number of unknowns of the step operator.
    pub fn unknowns(&self) -> usize {
        FIELDS * self.free_components().len()
    }

    /// The step as a matrix, loads removed: velocities of both phases, straining and flux displacement of
    /// every free component, displacements in units of what a unit velocity makes in a step.
    pub fn operator(&self, dt: f64, settings: &ExplicitSettings) -> DMatrix<f64> {
        let mut step = self.clone();
        step.forget_loads();
        step.set_step(dt, settings);
        let free = step.free_components();
        // For a balanced matrix.
        let unit = |field: usize| if field < 2 { 1.0 } else { dt };
        let size = FIELDS * free.len();
        let mut operator = DMatrix::zeros(size, size);
        for (column, mut image) in operator.column_iter_mut().enumerate() {
            let (field, (row, d)) = (column / free.len(), free[column % free.len()]);
            step.come_to_rest();
            step.state.field_mut(field)[MARGIN + row][d] = unit(field);
            step.step(dt, settings);
            for target in 0..FIELDS {
                let values = step.state.field_mut(target);
                for (place, (row, d)) in free.iter().enumerate() {
                    image[target * free.len() + place] = values[MARGIN + row][*d] / unit(target);
                }
            }
        }
        operator
    }

    /// Forgets loads, stresses and displacements and sets every node in some motion: what grows from
    /// there on grows by the step alone.
    pub fn disturb(&mut self) {
        self.forget_loads();
        // A fixed sequence without a pattern on any grid (Knuth's multiplicative hash).
        let mut seed = 1_u32;
        for row in 0..self.nodes.len() {
            for phase in [SOLID, WATER] {
                for d in 0..D {
                    seed = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
                    let free = self.constants[row / LANES].free[phase][d][row % LANES];
                    self.state.velocity[phase][MARGIN + row][d] =
                        free * (f64::from(seed) / f64::from(u32::MAX) - 0.5);
                }
            }
        }
    }
}
