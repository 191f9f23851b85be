//! The volumetric operators of a method as sparse rows: `D` from nodes to the sites of the
//! dilation, `R` from the sites to the points.
//!
//! The explicit step walks the grid instead; whoever assembles (the frozen step, the undrained
//! start, implicit integrators) takes the rows.

use super::body::{Body, ShapeFunction};
use super::grid::Vector;
use super::method::{PressureIntegration, Recovery};

/// A linear functional of a nodal vector field: one vector of coefficients a node.
pub type VectorRow<const D: usize> = Vec<(usize, Vector<D>)>;

/// `D` and `R` of a method on a body's present operators.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VolumetricRows<const D: usize> {
    /// Divergence at each site, 1/m of the field: occupied cells, or points.
    pub divergence: Vec<VectorRow<D>>,
    /// Coupling modulus `K_w/n` of each site, Pa.
    pub coupling: Vec<f64>,
    /// Sites that each point recovers its value from, with their weights.
    pub recovery: Vec<Vec<(usize, f64)>>,
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Body<D, W, S> {
    /// The volumetric rows of the body's method; gradients are those of small strain.
    pub fn volumetric_rows(&self) -> VolumetricRows<D> {
        match self.method.pressure {
            PressureIntegration::Points => self.rows_at_points(),
            PressureIntegration::Sri => self.rows_at_centres(),
        }
    }

    fn rows_at_points(&self) -> VolumetricRows<D> {
        let count = self.points.len();
        let stiffness = self.material.water_bulk_modulus;
        let coupling = |point: usize| stiffness / self.material.porosity_at(self.points.volume_ratio[point]);
        VolumetricRows {
            divergence: (0..count).map(|point| self.basis.gradient_row(&self.grid, point)).collect(),
            coupling: (0..count).map(coupling).collect(),
            recovery: (0..count).map(|point| vec![(point, 1.0)]).collect(),
        }
    }

    fn rows_at_centres(&self) -> VolumetricRows<D> {
        let mut site = vec![usize::MAX; self.grid.cell_count()];
        let mut rows = VolumetricRows::default();
        for cell in self.cells.occupied() {
            site[cell] = rows.divergence.len();
            let mut row = Vec::with_capacity(1 << D);
            self.cells.visit_centre_divergence(&self.grid, cell, |node, coefficients| {
                row.push((node, *coefficients));
            });
            rows.divergence.push(row);
            rows.coupling.push(self.material.water_bulk_modulus / self.cells.porosity[cell]);
        }
        rows.recovery = (0..self.points.len())
            .map(|point| match self.method.recovery {
                Recovery::Constant => vec![(site[self.cells.of_point[point]], 1.0)],
                Recovery::Patch => self
                    .patch
                    .entries(&self.grid, point)
                    .filter(|(_, weight)| *weight != 0.0)
                    .map(|(cell, weight)| (site[cell], weight))
                    .collect(),
            })
            .collect();
        rows
    }
}

impl<const D: usize> VolumetricRows<D> {
    /// Divergence of a nodal field at every site.
    pub fn at_sites(&self, field: &[Vector<D>]) -> Vec<f64> {
        self.divergence.iter().map(|row| applied(row, field)).collect()
    }

    /// Values at the points from those at the sites.
    pub fn at_points(&self, sites: &[f64]) -> Vec<f64> {
        let value = |row: &Vec<(usize, f64)>| row.iter().map(|(site, weight)| weight * sites[*site]).sum();
        self.recovery.iter().map(value).collect()
    }
}

/// A functional applied to a field.
pub fn applied<const D: usize>(row: &VectorRow<D>, field: &[Vector<D>]) -> f64 {
    let mut sum = 0.0;
    for (node, coefficients) in row {
        for d in 0..D {
            sum += coefficients[d] * field[*node][d];
        }
    }
    sum
}
