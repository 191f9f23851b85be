//! The undrained start: the static equilibrium under the load before any water has moved.
//!
//! The equilibrium of an elastic body with the bulk stiffness of skeleton and water together (`λ_u = λ + Q`), by the
//! method's own operators. It is a pure test of volumetric locking, and an explicit run that starts from it has no waves.

use crate::direct_solver::Singular;
use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::integrate::assembled::stiffness::pressure_stiffness;
use crate::integrate::implicit::linear_system::LinearSystem;
use crate::integrate::implicit::unknowns::Unknowns;
use crate::kernel::body::Body;
use crate::kernel::projection::ProjectedStorage;
use crate::kernel::volumetric::VolumetricRows;
use crate::time_limit::TimeLimit;
use oedometer_problem::method::Configuration;
use oedometer_soil::tensor::{Tensor, Vector};

impl<const D: usize> Body<D> {
    /// Brings the body into undrained equilibrium with its load, by so many threads where that pays.
    ///
    /// # Errors
    /// When its stiffness is singular, because nothing holds the body, or the time is over.
    pub fn settle_undrained(&mut self, threads: usize, time_limit: TimeLimit) -> Result<(), Singular> {
        if self.method.has_projection() {
            return self.settle_with_pressures(threads, time_limit);
        }
        let rows = self.volumetric_rows();
        let mut stiffness = self.skeleton_stiffness(&rows);
        stiffness.add(&pressure_stiffness(&self.coupled_pressure_forces(&rows), &rows.divergence));
        let unknowns = Unknowns::of_displacements(self, rows);
        let mut matrix = SystemMatrix::spanning(&unknowns.positions, unknowns.border, |visitor| {
            unknowns.visit_blocks(&stiffness, |row, column, _| visitor(row, column));
        });
        unknowns.visit_blocks(&stiffness, |row, column, value| matrix.add(row, column, value));
        drop(stiffness);
        self.map_forces();
        let mut rest = vec![0.0; unknowns.count];
        for (numbers, force) in unknowns.displacement.iter().zip(&self.nodes.mixture_force) {
            for (number, force) in numbers.iter().zip(force) {
                if let Some(number) = number {
                    rest[*number] += force;
                }
            }
        }
        let mut factors = Factors::of_shape(&matrix, threads, time_limit);
        factors.factor(&matrix)?;
        let solution = solved_twice(&mut factors, &matrix, rest);
        let displacement = |number: Option<usize>| number.map_or(0.0, |number| solution[number]);
        let field: Vec<Vector<D>> =
            unknowns.displacement.iter().map(|numbers| numbers.map(displacement)).collect();
        self.displace_points(&unknowns.rows, &field, &field, &field);
        self.follow_points();
        Ok(())
    }

    /// The undrained equilibrium with the pressures of the sites as unknowns: a projected storage is no pressure times
    /// modulus site by site.
    fn settle_with_pressures(&mut self, threads: usize, time_limit: TimeLimit) -> Result<(), Singular> {
        let system = LinearSystem::new(self);
        let (unknowns, scales) = (&system.unknowns, &system.unknowns.scales);
        let mut rest = system.start_residual.clone();
        for unknown in &unknowns.pressure {
            rest[*unknown] = 0.0;
        }
        let mut factors = Factors::of_shape(&system.fixed, threads, time_limit);
        factors.factor(&system.fixed)?;
        let solution = solved_twice(&mut factors, &system.fixed, rest);
        let displacement =
            |number: Option<usize>| number.map_or(0.0, |number| scales.length * solution[number]);
        let field: Vec<Vector<D>> =
            unknowns.displacement.iter().map(|numbers| numbers.map(displacement)).collect();
        let pressures: Vec<f64> =
            unknowns.pressure.iter().map(|unknown| scales.pressure * solution[*unknown]).collect();
        self.change_points(&unknowns.rows, &field, &pressures, &field);
        self.follow_points();
        Ok(())
    }

    /// Displaces nodes and points by a nodal field, strains the skeleton by another and compresses the water by a third.
    pub fn displace_points(
        &mut self,
        rows: &VolumetricRows<D>,
        strained: &[Vector<D>],
        flux: &[Vector<D>],
        displacements: &[Vector<D>],
    ) {
        let mut pressures = rows.at_sites(flux);
        for (value, coupling) in pressures.iter_mut().zip(&rows.coupling) {
            *value *= -coupling;
        }
        if let Some(mut storage) = ProjectedStorage::from_body(self, &rows.sites, &rows.projection) {
            storage.project(&mut pressures);
        }
        self.change_points(rows, strained, &pressures, displacements);
    }

    /// Displaces nodes and points by a nodal field, strains the skeleton by another and adds the pressures of the sites,
    /// Pa.
    pub fn change_points(
        &mut self,
        rows: &VolumetricRows<D>,
        strained: &[Vector<D>],
        site_pressures: &[f64],
        displacements: &[Vector<D>],
    ) {
        let pressures = rows.at_points(site_pressures);
        for point in 0..self.points.len() {
            let (gradient, dilation) = self.gradient_of(point, rows, strained);
            let stress = self.stress_law_of(point).elastic_stress(&gradient, dilation);
            let of_basis = self.operators.basis.value(self.grid.node_stride(), point, displacements);
            let moved = self.carrying(point, displacements, of_basis);
            self.points.pressure[point] += pressures[point];
            for d in 0..D {
                self.points.displacement[point][d] += moved[d];
                for e in 0..D {
                    self.points.effective_stress[point][d][e] += stress[d][e];
                }
                if self.configuration == Configuration::Updated {
                    self.points.position[point][d] += moved[d];
                }
            }
            if self.configuration.deforms() {
                self.deform(point, &gradient);
            }
        }
        for (node, displacement) in displacements.iter().enumerate() {
            for d in 0..D {
                self.nodes.displacement[node][d] += displacement[d];
            }
        }
    }

    /// Gradient of a nodal field that strains a point's skeleton, and the dilation that B-bar adds to it.
    fn gradient_of(&self, point: usize, rows: &VolumetricRows<D>, field: &[Vector<D>]) -> (Tensor<D>, f64) {
        let (mut gradient, mut dilation) = ([[0.0; D]; D], 0.0);
        for entry in self.strain_row(point, rows) {
            let displacement = &field[entry.node];
            entry.add_to(&mut gradient, displacement);
            dilation += (0..D).map(|d| entry.dilation[d] * displacement[d]).sum::<f64>();
        }
        (gradient, dilation)
    }
}

/// The solution of a factored system. Water that is nearly incompressible costs a sparse factorisation, with few pivots to
/// choose from, some digits; a second solve with what is left of the right-hand side brings them back.
fn solved_twice(factors: &mut Factors, matrix: &SystemMatrix, mut rest: Vec<f64>) -> Vec<f64> {
    let mut solution = vec![0.0; rest.len()];
    for _ in 0..2 {
        let mut correction = rest.clone();
        factors.solve(&mut correction);
        matrix.subtract_product(&correction, &mut rest);
        for (value, correction) in solution.iter_mut().zip(&correction) {
            *value += correction;
        }
    }
    solution
}
