//! The frozen body as a linear system of differential and algebraic equations.
//!
//! With the displacement `U` of the skeleton since the start and the change `π` of the pressures,
//!
//! - mixture, at every free component of a node: `K_σ U − A π = F_0`,
//! - storage, at every site: `(n/K_w) π̇ + D U̇ + D n d⁻¹ A π = −D n d⁻¹ F_w0`,
//!
//! with the operators of the explicit step: `K_σ = Σ V ∇N C G`, `A = Σ V ∇N R`, the divergence `D`
//! and recovery `R` of the method, and the lumped nodal drag `d`, through which the water's
//! relative velocity is eliminated. In short `C ẋ + K x = g`, `C` zero in the rows of the mixture.

use crate::assembled::stiffness::NodeBlocks;
use crate::body::Body;
use crate::direct_solver::bordered::Bordered;
use crate::implicit::unknowns::Unknowns;
use crate::operators::rigid_plate::RigidPlate;
use crate::operators::sparse_rows::SparseRows;
use crate::operators::volumetric::VectorRow;
use crate::state::nodes::Nodes;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::tensor::Vector;

/// A frozen body as sparse operators between nodes and sites, whatever its basis.
#[derive(Clone, Debug)]
pub struct LinearOperators<const D: usize> {
    /// Numbering of `x`, with `D` and `R`.
    unknowns: Unknowns<D>,
    /// `K_σ`, N/m.
    stiffness: NodeBlocks<D>,
    /// Rows of `A`, by node: force of a unit pressure change at each site, m^(D−1).
    pressure_forces: Vec<VectorRow<D>>,
    /// Porosity of each site.
    porosity: Vec<f64>,
    water_bulk_modulus: f64,
    continuity: Continuity,
    /// Nodes with the forces of the start.
    nodes: Nodes<D>,
    /// Plate that some of them go with.
    plate: Option<RigidPlate>,
    /// Weights of the nodes in the settlement, with its sign turned, and in what leaves the body.
    settling: Vec<(usize, Vector<D>)>,
    outflow: Vec<(usize, Vector<D>)>,
}

/// `C ẋ + K x = g` of a frozen body, scaled.
#[derive(Clone, Debug)]
pub struct LinearSystem<const D: usize> {
    /// Numbering and scales of `x`.
    pub unknowns: Unknowns<D>,
    /// What a step's matrix has whatever its size: `K` in the mixture's rows, `C` in the others.
    pub fixed: Bordered,
    /// What it has in proportion to its size: `K` in the storage's rows, 1/s.
    pub proportional: Bordered,
    /// Rows of `C`, one per site.
    pub capacity: SparseRows<f64>,
    /// `g − K x` at the start, where `x` is zero; 1/s in the storage's rows.
    pub start_residual: Vec<f64>,
    /// Vertical displacement of the loaded surface, as much of it as has the load's shape, or that of the
    /// plate along its normal, as a row times `x`, m.
    pub surface_displacement: SparseRows<f64>,
    /// What the skeleton's displacement carries through the surface and before the plate, per area of the
    /// surface, as a row times `x`, m.
    pub mean_displacement: SparseRows<f64>,
    /// Mean over the surface of the relative flux `n (v_w − v_s)`, as a row times `x`, m/s.
    pub surface_outflow: SparseRows<f64>,
    /// The same at the start.
    pub start_outflow: f64,
}

/// Entry of the system: row, column, part in `fixed`, part in `proportional`.
type Entry = (usize, usize, f64, f64);

impl<const D: usize> LinearOperators<D> {
    /// Takes a body's present operators and forces.
    pub fn of(body: &Body<D>) -> Self {
        let unknowns = Unknowns::of(body);
        let mut loaded = body.clone();
        loaded.map_forces();
        Self {
            stiffness: body.skeleton_stiffness(&unknowns.rows),
            pressure_forces: body.pressure_forces(&unknowns.rows),
            porosity: unknowns.rows.sites.iter().map(|place| body.porosity_of(*place)).collect(),
            water_bulk_modulus: body.material.water_bulk_modulus,
            continuity: body.material.continuity,
            nodes: loaded.nodes,
            plate: body.plate.clone(),
            settling: body.settling_weights(),
            outflow: body.outflow_weights(),
            unknowns,
        }
    }

    /// Whether the water may flow along a component at a node: not where it is held, nor through a plate.
    fn flows(&self, node: usize, component: usize) -> bool {
        let is_tied = self.plate.as_ref().is_some_and(|plate| plate.ties(node, component));
        self.nodes.water_free[node][component] > 0.0 && !is_tied
    }

    /// Relative velocity that a unit of water force makes at a node, one over the drag, m/(N s).
    fn mobility(&self, node: usize) -> f64 {
        let drag = self.nodes.drag[node];
        if self.nodes.is_active(node) && drag > 0.0 { 1.0 / drag } else { 0.0 }
    }

    /// Relative flux at a node over the water's force there, as the storage of a site sees it: with
    /// the node's own porosity in the conservative form, with the site's where its gradient is dropped.
    fn flux_of_force(&self, site: usize, node: usize) -> f64 {
        let porosity = match self.continuity {
            Continuity::Conservative => self.nodes.porosity[node],
            Continuity::ConstantPorosityGradient => self.porosity[site],
        };
        porosity * self.mobility(node)
    }

    /// Rows of the mixture: `K_σ` and `−A`.
    fn visit_mixture(&self, visitor: &mut dyn FnMut(Entry)) {
        let (unknowns, scales) = (&self.unknowns, &self.unknowns.scales);
        let per_displacement = scales.length / scales.force;
        for (node, blocks) in self.stiffness.rows.iter().enumerate() {
            for d in 0..D {
                let Some(row) = unknowns.displacement[node][d] else { continue };
                for (other, block) in blocks {
                    for (column, stiffness) in unknowns.displacement[*other].iter().zip(&block[d]) {
                        if let Some(column) = column.filter(|_| *stiffness != 0.0) {
                            visitor((row, column, per_displacement * stiffness, 0.0));
                        }
                    }
                }
                for (site, force) in self.pressure_forces[node].iter().filter(|entry| entry.1[d] != 0.0) {
                    let column = unknowns.pressure[*site];
                    visitor((row, column, -force[d] * scales.pressure / scales.force, 0.0));
                }
            }
        }
    }

    /// Rows of the storage: `C` and `D n d⁻¹ A`.
    fn visit_storage(&self, visitor: &mut dyn FnMut(Entry)) {
        let unknowns = &self.unknowns;
        for (site, divergence) in unknowns.rows.divergence.iter().enumerate() {
            let row = unknowns.pressure[site];
            for (column, value) in self.capacity_row(site) {
                visitor((row, column, value, 0.0));
            }
            for (node, coefficients) in divergence {
                let flux_of_force = self.flux_of_force(site, *node) * self.unknowns.scales.pressure;
                // Where the water is held, nothing flows; on a rough base it slides.
                for d in (0..D).filter(|d| self.flows(*node, *d)) {
                    for (other, force) in self.pressure_forces[*node].iter().filter(|other| other.1[d] != 0.0)
                    {
                        let rate = coefficients[d] * flux_of_force * force[d];
                        visitor((row, unknowns.pressure[*other], 0.0, rate));
                    }
                }
            }
        }
    }

    /// Row of `C` at a site.
    fn capacity_row(&self, site: usize) -> Vec<(usize, f64)> {
        let storage = self.porosity[site] / self.water_bulk_modulus;
        let mut row = vec![(self.unknowns.pressure[site], storage * self.unknowns.scales.pressure)];
        for (node, coefficients) in &self.unknowns.rows.divergence[site] {
            for (column, coefficient) in self.unknowns.displacement[*node].iter().zip(coefficients) {
                row.extend(column.map(|column| (column, coefficient * self.unknowns.scales.length)));
            }
        }
        row
    }

    /// `g`: what the stresses of the start do.
    fn start_residual(&self) -> Vec<f64> {
        let (unknowns, nodes) = (&self.unknowns, &self.nodes);
        let mut residual = vec![0.0; unknowns.count];
        for (numbers, forces) in unknowns.displacement.iter().zip(&nodes.mixture_force) {
            for (row, force) in numbers.iter().zip(forces) {
                if let Some(row) = row {
                    residual[*row] += force / self.unknowns.scales.force;
                }
            }
        }
        for (site, divergence) in unknowns.rows.divergence.iter().enumerate() {
            let mut rate = 0.0;
            for (node, coefficients) in divergence {
                let flux_of_force = self.flux_of_force(site, *node);
                for d in (0..D).filter(|d| self.flows(*node, *d)) {
                    rate += coefficients[d] * flux_of_force * nodes.water_force[*node][d];
                }
            }
            residual[unknowns.pressure[site]] = -rate;
        }
        residual
    }

    /// Displacements with some weights as a row.
    fn displacement_row(&self, weights: &[(usize, Vector<D>)]) -> SparseRows<f64> {
        let mut row = Vec::new();
        for (node, weight) in weights {
            for (number, weight) in self.unknowns.displacement[*node].iter().zip(weight) {
                let number = number.filter(|_| *weight != 0.0);
                row.extend(number.map(|number| (number, weight * self.unknowns.scales.length)));
            }
        }
        SparseRows::of([row])
    }

    /// The mean relative flux through the surface as a row, and at the start.
    fn outflow(&self) -> (SparseRows<f64>, f64) {
        let (mut row, mut start) = (Vec::new(), 0.0);
        let nodes = &self.nodes;
        for (node, weights) in &self.outflow {
            for d in (0..D).filter(|d| weights[*d] != 0.0) {
                let flux_of_force = weights[d] * nodes.porosity[*node] * self.mobility(*node);
                if !self.flows(*node, d) {
                    continue;
                }
                start += flux_of_force * nodes.water_force[*node][d];
                if self.unknowns.displacement[*node][d].is_some() {
                    let scale = flux_of_force * self.unknowns.scales.pressure;
                    let forces = self.pressure_forces[*node].iter();
                    row.extend(forces.map(|(site, force)| (self.unknowns.pressure[*site], scale * force[d])));
                }
            }
        }
        (SparseRows::of([row]), start)
    }
}

impl<const D: usize> Body<D> {
    /// Velocities of the water at the nodes from those of the skeleton and Darcy's flow under the present forces.
    pub(crate) fn take_darcy_velocities(&mut self) {
        self.map_forces();
        for node in 0..self.nodes.len() {
            let per_drag = if self.nodes.drag[node] > 0.0 { 1.0 / self.nodes.drag[node] } else { 0.0 };
            for d in 0..D {
                let flows = self.nodes.water_free[node][d] > 0.0 && !self.is_tied(node, d);
                let relative = if flows { per_drag * self.nodes.water_force[node][d] } else { 0.0 };
                self.nodes.water_velocity[node][d] = self.nodes.solid_velocity[node][d] + relative;
            }
        }
    }
}

impl<const D: usize> LinearSystem<D> {
    /// Assembles a body's operators.
    pub fn of(operators: LinearOperators<D>) -> Self {
        let visit = |visitor: &mut dyn FnMut(Entry)| {
            operators.visit_mixture(visitor);
            operators.visit_storage(visitor);
        };
        let (positions, border) = (&operators.unknowns.positions, operators.unknowns.border);
        let mut fixed = Bordered::spanning(positions, border, |visitor| {
            visit(&mut |(row, column, _, _)| visitor(row, column));
        });
        let mut proportional = fixed.clone();
        // Each entry belongs to one of them: a zero is not worth looking for its place.
        visit(&mut |(row, column, constant, rate)| {
            if constant != 0.0 {
                fixed.add(row, column, constant);
            }
            if rate != 0.0 {
                proportional.add(row, column, rate);
            }
        });
        let (surface_outflow, start_outflow) = operators.outflow();
        Self {
            fixed,
            proportional,
            capacity: SparseRows::of((0..operators.porosity.len()).map(|site| operators.capacity_row(site))),
            start_residual: operators.start_residual(),
            surface_displacement: operators.displacement_row(&operators.settling),
            mean_displacement: operators.displacement_row(&operators.outflow),
            surface_outflow,
            start_outflow,
            unknowns: operators.unknowns,
        }
    }
}
