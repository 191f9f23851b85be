//! The volumetric operators of a method as sparse rows: `D` from nodes to the sites of the
//! dilation, `R` from the sites to the points.
//!
//! The explicit step walks the grid instead; whoever assembles (the frozen step, the undrained
//! start, implicit integrators) takes the rows.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::method::{PressureIntegration, Recovery};
use crate::mpm::operators::recovery::{filtered_rows, nodal_row};
use crate::soil::tensor::Vector;

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
        if self.method.pressure.is_by_cells() { self.rows_of_cells() } else { self.rows_at_points() }
    }

    fn rows_at_points(&self) -> VolumetricRows<D> {
        let count = self.points.len();
        let stiffness = self.material.water_bulk_modulus;
        let coupling = |point: usize| stiffness / self.material.porosity_at(self.points.volume_ratio[point]);
        VolumetricRows {
            divergence: (0..count).map(|point| self.basis.gradient_row(&self.grid, point)).collect(),
            coupling: (0..count).map(coupling).collect(),
            recovery: match self.method.recovery {
                Recovery::NullSpace => filtered_rows(&self.grid, &self.cells, &self.nodes, &self.points),
                Recovery::Constant | Recovery::Patch | Recovery::Nodal => {
                    (0..count).map(|point| vec![(point, 1.0)]).collect()
                }
            },
        }
    }

    fn rows_of_cells(&self) -> VolumetricRows<D> {
        let mut site = vec![usize::MAX; self.grid.cell_count()];
        let mut rows = VolumetricRows::default();
        for cell in self.cells.occupied() {
            site[cell] = rows.divergence.len();
            rows.divergence.push(Vec::new());
            rows.coupling.push(self.material.water_bulk_modulus / self.cells.porosity[cell]);
        }
        if self.method.pressure == PressureIntegration::Mean {
            for point in 0..self.points.len() {
                let cell = self.cells.of_point[point];
                let share = self.points.volume(point) / self.cells.volume(cell);
                let row = &mut rows.divergence[site[cell]];
                for (node, gradient) in self.basis.gradient_row(&self.grid, point) {
                    accumulate(row, node, &gradient.map(|component| share * component));
                }
            }
        } else {
            for cell in self.cells.occupied() {
                let row = &mut rows.divergence[site[cell]];
                self.cells.visit_centre_divergence(&self.grid, cell, |node, coefficients| {
                    row.push((node, *coefficients));
                });
            }
        }
        rows.recovery = (0..self.points.len())
            .map(|point| {
                let cells = match self.method.recovery {
                    Recovery::Constant | Recovery::NullSpace => vec![(self.cells.of_point[point], 1.0)],
                    Recovery::Patch => self.patch.entries(&self.grid, point).collect(),
                    Recovery::Nodal => nodal_row(&self.grid, &self.cells, &self.points, point),
                };
                let cells = cells.into_iter().filter(|(_, weight)| *weight != 0.0);
                cells.map(|(cell, weight)| (site[cell], weight)).collect()
            })
            .collect();
        rows
    }
}

/// Adds to a node's coefficients in a short row.
fn accumulate<const D: usize>(row: &mut VectorRow<D>, node: usize, coefficients: &Vector<D>) {
    let place = row.iter().position(|entry| entry.0 == node).unwrap_or_else(|| {
        row.push((node, [0.0; D]));
        row.len() - 1
    });
    for d in 0..D {
        row[place].1[d] += coefficients[d];
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

impl<const D: usize> VolumetricRows<D> {
    /// The volumetric rate at a point as a functional of the field: `R D` without moduli.
    pub fn dilation_row(&self, point: usize) -> VectorRow<D> {
        let mut row = VectorRow::new();
        for (site, weight) in &self.recovery[point] {
            for (node, coefficients) in &self.divergence[*site] {
                accumulate(&mut row, *node, &coefficients.map(|component| weight * component));
            }
        }
        row
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
