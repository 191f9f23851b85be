//! The frozen body as a linear system of differential and algebraic equations.
//!
//! With the displacement `U` of the skeleton since the start and the change `π` of the pressures,
//!
//! - mixture, at every free component of a node: `K_σ U − A π = F_0`,
//! - storage, at every site: `(n/K_w) π̇ + D U̇ + D n d⁻¹ A π = −D n d⁻¹ F_w0`,
//!
//! with the operators of the explicit step: `K_σ = Σ V ∇N C G`, `A = Σ V ∇N R`, the divergence `D` and recovery `R` of the
//! method, and the lumped nodal drag `d`, through which the water's relative velocity is eliminated. In short
//! `C ẋ + K x = g`, `C` zero in the rows of the mixture.

use crate::direct_solver::system::SystemMatrix;
use crate::integrate::assembled::stiffness::NodeBlocks;
use crate::integrate::implicit::unknowns::Unknowns;
use crate::kernel::body::Body;
use crate::kernel::volumetric::VectorRow;
use crate::operators::sparse_rows::SparseRows;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::tensor::{Vector, dot};

/// `C ẋ + K x = g` of a frozen body, scaled.
#[derive(Clone, Debug)]
pub struct LinearSystem<const D: usize> {
    /// Numbering and scales of `x`.
    pub unknowns: Unknowns<D>,
    /// Part of a step's matrix that does not depend on the step size: `K` in the mixture's rows, `C` in the others.
    pub fixed: SystemMatrix,
    /// Part proportional to the step size: `K` in the storage's rows, 1/s.
    pub proportional: SystemMatrix,
    /// Rows of `C`, one per site.
    pub capacity: SparseRows<f64>,
    /// `g − K x` at the start, where `x` is zero; 1/s in the storage's rows.
    pub start_residual: Vec<f64>,
    /// Vertical displacement of the loaded surface, its component of the load's shape, or displacement of the plate along
    /// its normal, as a row times `x`, m.
    pub surface_displacement: SparseRows<f64>,
    /// Volume that the skeleton's displacement carries through the surface, per area of the surface, as a row times `x`,
    /// m.
    pub mean_displacement: SparseRows<f64>,
    /// Mean over the surface of the relative flux `n (v_w − v_s)`, as a row times `x`, m/s.
    pub surface_outflow: SparseRows<f64>,
    /// The same mean flux at the start, m/s.
    pub start_outflow: f64,
}

/// Sparse operators of a body between its nodes and sites, for any basis.
struct Operators<'a, const D: usize> {
    /// The body, with the forces of the start on its nodes.
    body: &'a Body<D>,
    /// Numbering of `x`, with `D` and `R`.
    unknowns: Unknowns<D>,
    /// `K_σ`, N/m.
    stiffness: NodeBlocks<D>,
    /// Rows of `A`, by node: force of a unit pressure change at each site, m^(D−1).
    pressure_forces: Vec<VectorRow<D>>,
}

/// Entry of the system: row, column, part in `fixed`, part in `proportional`.
type Entry = (usize, usize, f64, f64);

impl<const D: usize> LinearSystem<D> {
    /// Assembles the present operators and forces of a body, whose nodes take the latter.
    pub fn new(body: &mut Body<D>) -> Self {
        body.map_forces();
        let body = &*body;
        let unknowns = Unknowns::new(body);
        let operators = Operators {
            stiffness: body.skeleton_stiffness(&unknowns.rows),
            pressure_forces: body.pressure_forces(&unknowns.rows),
            body,
            unknowns,
        };
        let visit = |visitor: &mut dyn FnMut(Entry)| {
            operators.visit_mixture(visitor);
            operators.visit_storage(visitor);
        };
        let unknowns = &operators.unknowns;
        let mut fixed = SystemMatrix::spanning(&unknowns.positions, unknowns.border, |visitor| {
            visit(&mut |(row, column, _, _)| visitor(row, column));
        });
        let mut proportional = fixed.clone();
        // Each entry belongs to one of the two; looking up the place of a zero would cost time.
        visit(&mut |(row, column, constant, rate)| {
            if constant != 0.0 {
                fixed.add(row, column, constant);
            }
            if rate != 0.0 {
                proportional.add(row, column, rate);
            }
        });
        let outflow_weights = body.outflow_weights();
        let mut outflow = Vec::new();
        let start_outflow =
            operators.visit_flux(&outflow_weights, None, &mut |column, rate| outflow.push((column, rate)));
        Self {
            fixed,
            proportional,
            capacity: SparseRows::from_rows(
                (0..unknowns.pressure.len()).map(|site| operators.capacity_row(site)),
            ),
            start_residual: operators.start_residual(),
            surface_displacement: operators.displacement_row(&body.settling_weights()),
            mean_displacement: operators.displacement_row(&outflow_weights),
            surface_outflow: SparseRows::from_rows([outflow]),
            start_outflow,
            unknowns: operators.unknowns,
        }
    }
}

impl<const D: usize> Operators<'_, D> {
    /// Rows of the mixture: `K_σ` and `−A`.
    fn visit_mixture(&self, visitor: &mut dyn FnMut(Entry)) {
        let (unknowns, scales) = (&self.unknowns, &self.unknowns.scales);
        let per_displacement = scales.length / scales.force;
        unknowns.visit_blocks(&self.stiffness, |row, column, stiffness| {
            visitor((row, column, per_displacement * stiffness, 0.0));
        });
        for (rows, forces) in unknowns.displacement.iter().zip(&self.pressure_forces) {
            for (d, row) in rows.iter().enumerate() {
                let Some(row) = row else { continue };
                for (site, force) in forces.iter().filter(|entry| entry.1[d] != 0.0) {
                    let force = -force[d] * scales.pressure / scales.force;
                    visitor((*row, unknowns.pressure[*site], force, 0.0));
                }
            }
        }
    }

    /// Rows of the storage: `C` and `D n d⁻¹ A`.
    fn visit_storage(&self, visitor: &mut dyn FnMut(Entry)) {
        for (site, row) in self.unknowns.pressure.iter().enumerate() {
            for (column, value) in self.capacity_row(site) {
                visitor((*row, column, value, 0.0));
            }
            self.visit_storage_flux(site, &mut |column, rate| visitor((*row, column, 0.0, rate)));
        }
    }

    /// Row of `C` at a site.
    fn capacity_row(&self, site: usize) -> Vec<(usize, f64)> {
        let (unknowns, scales) = (&self.unknowns, &self.unknowns.scales);
        let storage = self.body.storage_of(self.unknowns.rows.sites[site], self.porosity(site));
        let mut row = self.weighted_displacements(&unknowns.rows.divergence[site]);
        row.push((unknowns.pressure[site], storage * scales.pressure));
        let projected = unknowns.rows.projection.get(site).into_iter().flatten();
        row.extend(projected.map(|(other, value)| (unknowns.pressure[*other], value * scales.pressure)));
        row
    }

    fn porosity(&self, site: usize) -> f64 {
        self.body.porosity_of(self.unknowns.rows.sites[site])
    }

    /// The flux into the storage of a site as [`visit_flux`](Self::visit_flux) has it: with the porosity of each node in
    /// the conservative form, with the site's where the gradient of porosity is dropped.
    fn visit_storage_flux(&self, site: usize, visitor: &mut dyn FnMut(usize, f64)) -> f64 {
        let porosity = match self.body.material.continuity {
            Continuity::Conservative => None,
            Continuity::ConstantPorosityGradient => Some(self.porosity(site)),
        };
        self.visit_flux(&self.unknowns.rows.divergence[site], porosity, visitor)
    }

    /// A weighted sum of the relative fluxes `n d⁻¹ F_w` at nodes: its entries in `x` for the visitor, and its value at the
    /// start. With a porosity for all nodes, or with their own.
    fn visit_flux(
        &self,
        weights: &[(usize, Vector<D>)],
        porosity: Option<f64>,
        visitor: &mut dyn FnMut(usize, f64),
    ) -> f64 {
        let mut start = 0.0;
        for (node, weights) in weights {
            let flux_of_force =
                porosity.unwrap_or(self.body.nodes.porosity[*node]) * self.body.mobility(*node);
            let flowing: Vector<D> = std::array::from_fn(|d| {
                if self.body.water_flows(*node, d) { flux_of_force * weights[d] } else { 0.0 }
            });
            start += dot(&flowing, &self.body.nodes.water_force[*node]);
            for (site, force) in &self.pressure_forces[*node] {
                let rate = dot(&flowing, force);
                if rate != 0.0 {
                    visitor(self.unknowns.pressure[*site], self.unknowns.scales.pressure * rate);
                }
            }
        }
        start
    }

    /// `g`: forces and rates of the initial stresses.
    fn start_residual(&self) -> Vec<f64> {
        let unknowns = &self.unknowns;
        let mut residual = vec![0.0; unknowns.count];
        for (numbers, forces) in unknowns.displacement.iter().zip(&self.body.nodes.mixture_force) {
            for (row, force) in numbers.iter().zip(forces) {
                if let Some(row) = row {
                    residual[*row] += force / unknowns.scales.force;
                }
            }
        }
        for (site, row) in unknowns.pressure.iter().enumerate() {
            residual[*row] = -self.visit_storage_flux(site, &mut |_, _| ());
        }
        residual
    }

    /// A weighted sum of displacements, in unknowns.
    fn weighted_displacements(&self, weights: &[(usize, Vector<D>)]) -> Vec<(usize, f64)> {
        let mut row = Vec::new();
        for (node, weight) in weights {
            for (number, weight) in self.unknowns.displacement[*node].iter().zip(weight) {
                let number = number.filter(|_| *weight != 0.0);
                row.extend(number.map(|number| (number, weight * self.unknowns.scales.length)));
            }
        }
        row
    }

    fn displacement_row(&self, weights: &[(usize, Vector<D>)]) -> SparseRows<f64> {
        SparseRows::from_rows([self.weighted_displacements(weights)])
    }
}

impl<const D: usize> Body<D> {
    /// Whether water may flow along a component at a node: not where it is held, nor through a plate; on a rough base it
    /// slides.
    fn water_flows(&self, node: usize, component: usize) -> bool {
        self.nodes.water_free[node][component] > 0.0 && !self.is_tied(node, component)
    }

    /// Relative velocity per water force at a node, one over the drag, m/(N s).
    fn mobility(&self, node: usize) -> f64 {
        let drag = self.nodes.drag[node];
        if self.nodes.is_active(node) && drag > 0.0 { 1.0 / drag } else { 0.0 }
    }

    /// Water velocities at the nodes from those of the skeleton and Darcy's flow under the present forces.
    pub(crate) fn take_darcy_velocities(&mut self) {
        self.map_forces();
        for node in 0..self.nodes.len() {
            for d in 0..D {
                let flows = self.water_flows(node, d);
                let relative =
                    if flows { self.mobility(node) * self.nodes.water_force[node][d] } else { 0.0 };
                self.nodes.water_velocity[node][d] = self.nodes.solid_velocity[node][d] + relative;
            }
        }
    }
}
