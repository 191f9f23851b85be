//! A body at trial states about an anchored state, and the end of a step at one of them.
//!
//! Points do not move within a step: shape functions stay on the configuration of its start, and gradients are pushed
//! forward from there.

use crate::integrate::implicit::point_strain::{KnownStretch, PointStrain};
use crate::integrate::implicit::unknowns::Unknowns;
use crate::kernel::body::Body;
use crate::operators::recovery::points_in_cells::points_in_cells;
use crate::state::points::Points;
use oedometer_problem::integrator::Formulation;
use oedometer_problem::method::Memory;
use oedometer_soil::tensor::{Tensor, Vector, dot, identity, inverse, product};

/// Time level at which the effective stress acts in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skeleton {
    /// The level of the anchored state.
    Explicit,
    /// The level of the trial state.
    Implicit,
}

/// A body at trial states about an anchored one.
#[derive(Clone, Debug)]
pub struct Trial<const D: usize> {
    /// The body; its nodes hold the quantities of the last residual.
    pub body: Body<D>,
    /// Numbering and scales.
    pub unknowns: Unknowns<D>,
    /// Which terms the balances have.
    pub formulation: Formulation,
    /// Time level of the effective stress.
    pub skeleton: Skeleton,
    /// Points at the start of the run.
    pub start: Points<D>,
    /// Points of the anchored state.
    pub anchor: Points<D>,
    /// Deformation gradients of the anchored state, from the start of the step where points move.
    pub(super) anchor_deformation: Vec<Tensor<D>>,
    /// Deformation gradients from the start of the run to the start of the step, for hyperelastic laws.
    pub(super) carried: Vec<Tensor<D>>,
    /// Velocities of skeleton and water at the nodes in the anchored state, m/s.
    pub velocity: [Vec<Vector<D>>; 2],
    /// Increment of the nodal displacement since the anchor, m.
    pub(super) displacement: Vec<Vector<D>>,
    /// Strains since the anchor for which the points have deformation and stress.
    pub(super) strained: Vec<PointStrain<D>>,
    /// Stretches whose logarithms are known, `[point]`.
    pub(super) stretches: Vec<KnownStretch>,
}

impl<const D: usize> Trial<D> {
    /// A body anchored at its present state.
    pub fn new(mut body: Body<D>, formulation: Formulation, skeleton: Skeleton) -> Self {
        let start = body.points.clone();
        let mut carried = vec![identity(); body.points.len()];
        if let Some(forced) = &mut body.actions.forcing {
            forced.formulation = formulation;
        }
        if body.configuration.moves_points() {
            for (carried, back) in carried.iter_mut().zip(&body.points.inverse_deformation) {
                *carried = inverse(back).0;
            }
            body.points.inverse_deformation.fill(identity());
            body.is_pushed_forward = true;
            body.follow_points();
        }
        let mut trial = Self {
            unknowns: Unknowns::new(&body),
            start,
            anchor: Points::default(),
            anchor_deformation: Vec::new(),
            carried,
            strained: Vec::new(),
            stretches: vec![KnownStretch::default(); body.points.len()],
            velocity: [body.nodes.solid_velocity.clone(), body.nodes.water_velocity.clone()],
            displacement: vec![[0.0; D]; body.nodes.len()],
            formulation,
            skeleton,
            body,
        };
        trial.anchor_here();
        trial
    }

    /// Begins a step at a time, s: finds the points at the centres of the cells for body forces and sources.
    pub fn begin_step(&mut self, time: f64) {
        self.body.begin_forced_step(time);
        self.body.find_centres();
    }

    /// Applies body forces and sources of so many seconds after the start of the step.
    pub fn act_later(&mut self, later: f64) {
        self.body.act_later(later);
    }

    /// Relative flux through the surface now, per area, m/s.
    pub fn outflow(&self) -> f64 {
        self.body.outflow_of(&self.body.nodes.flux)
    }

    /// Rate of the settlement now, m/s: of the plate where there is one, else of the loaded surface.
    pub fn settlement_rate(&self) -> f64 {
        let velocity = &self.body.nodes.solid_velocity;
        let weights = self.body.settling_weights();
        -weights.iter().map(|(node, weight)| dot(weight, &velocity[*node])).sum::<f64>()
    }

    /// Makes the present state the one that increments are measured from.
    fn anchor_here(&mut self) {
        self.anchor.clone_from(&self.body.points);
        let deformation = self.anchor.inverse_deformation.iter().map(|tensor| inverse(tensor).0);
        self.anchor_deformation.clear();
        self.anchor_deformation.extend(deformation);
        self.forget_strains();
    }

    /// Forgets for which strains the points have deformation and stress.
    fn forget_strains(&mut self) {
        self.strained.clear();
        self.strained.resize(self.anchor.len(), PointStrain::UNKNOWN);
    }

    /// Moves the body to increments of the unknowns since the anchor, but for the masses of the nodes. Whether these have to
    /// follow.
    pub fn move_to(&mut self, increments: &[f64]) -> bool {
        for (nodal, numbers) in self.displacement.iter_mut().zip(&self.unknowns.displacement) {
            *nodal = numbers
                .map(|number| number.map_or(0.0, |number| self.unknowns.scales.length * increments[number]));
        }
        if let Some(weight) = &mut self.body.actions.weight {
            weight.rise = self.body.actions.surface.amplitude_of(
                &self.body.grid,
                &self.body.points,
                &self.displacement,
            );
        }
        let rows = &self.unknowns.rows;
        let is_bbar = self.body.method.strain.is_bbar();
        let traces = if is_bbar { rows.at_points(&rows.at_sites(&self.displacement)) } else { Vec::new() };
        let has_deformed = self.strain_points(&traces) && self.body.configuration.deforms();
        self.take_pressures(increments);
        if has_deformed {
            self.body.follow_places();
        }
        has_deformed
    }

    /// Recovers the pressures of the points from those at the sites: in place, or by rows where the recovery would have to
    /// refit its fields.
    fn take_pressures(&mut self, increments: &[f64]) {
        let (unknowns, scale) = (&self.unknowns, self.unknowns.scales.pressure);
        self.body.points.pressure.copy_from_slice(&self.anchor.pressure);
        if !self.body.operators.recovery.is_local() {
            for (pressure, row) in self.body.points.pressure.iter_mut().zip(&unknowns.rows.recovery) {
                let change = |(site, weight): &(usize, f64)| weight * increments[unknowns.pressure[*site]];
                *pressure += scale * row.iter().map(change).sum::<f64>();
            }
            return;
        }
        let body = &mut self.body;
        body.site_values.fill(0.0);
        for (place, number) in unknowns.rows.sites.iter().zip(&unknowns.pressure) {
            body.site_values[*place] = increments[*number];
        }
        let at = points_in_cells!(body, body.operators.basis);
        body.operators.recovery.recover(
            &at,
            &body.site_values,
            &mut body.points.pressure,
            |pressure, change| {
                *pressure += scale * change;
            },
        );
    }

    /// Ends a step at increments of the unknowns, after so much flux through the surface, m. The points keep the state;
    /// where they move, the operators are rebuilt.
    pub fn end_step(&mut self, increments: &[f64], flux: f64) {
        self.body.surface_flux += flux;
        // An explicit skeleton has the stress of the anchor.
        self.forget_strains();
        if self.move_to(increments) {
            self.body.map_masses();
        }
        let moves_points = self.body.configuration.moves_points();
        if moves_points && self.formulation != Formulation::QuasiStatic {
            self.accelerate_points();
        }
        let stride = *self.body.grid.node_stride();
        for point in 0..self.anchor.len() {
            let of_basis = self.body.operators.basis.value(&stride, point, &self.displacement);
            let moved = self.body.carrying(point, &self.displacement, of_basis);
            for d in 0..D {
                self.body.points.displacement[point][d] += moved[d];
            }
            if moves_points {
                self.carry_point(point, &moved);
            }
        }
        for (total, change) in self.body.nodes.displacement.iter_mut().zip(&self.displacement) {
            for d in 0..D {
                total[d] += change[d];
            }
        }
        if moves_points {
            if self.body.method.memory == Memory::Cells {
                let body = &mut self.body;
                if let Some(averages) = &mut body.actions.cell_averages {
                    averages.spread_over_points(&body.grid, &body.cells, &mut body.points);
                }
            }
            self.body.build_operators();
            self.body.map_masses();
            self.unknowns.follow(&self.body);
            if self.formulation != Formulation::QuasiStatic {
                self.body.map_velocities();
            }
        }
        if let Some(weight) = &mut self.body.actions.weight {
            weight.rise = 0.0;
        }
        self.velocity[0].clone_from(&self.body.nodes.solid_velocity);
        self.velocity[1].clone_from(&self.body.nodes.water_velocity);
        self.anchor_here();
    }

    /// Adds the velocity increments of the nodes to the points (FLIP).
    fn accelerate_points(&mut self) {
        let body = &mut self.body;
        let stride = *body.grid.node_stride();
        let phases = [
            (&mut body.points.solid_velocity, &body.nodes.solid_velocity),
            (&mut body.points.water_velocity, &body.nodes.water_velocity),
        ];
        for ((points, nodes), before) in phases.into_iter().zip(&self.velocity) {
            let gained =
                |node: usize| -> Vector<D> { std::array::from_fn(|d| nodes[node][d] - before[node][d]) };
            for (point, velocity) in points.iter_mut().enumerate() {
                body.operators.basis.visit(&stride, point, |node, weight, _| {
                    for (total, gain) in velocity.iter_mut().zip(gained(node)) {
                        *total += weight * gain;
                    }
                });
            }
        }
    }

    /// Moves a point with its domain to its new position, and resets the deformation of the step: the next one starts
    /// there.
    fn carry_point(&mut self, point: usize, moved: &Vector<D>) {
        let follows = self.body.method.domains_follow();
        let points = &mut self.body.points;
        let (deformation, _) = inverse(&points.inverse_deformation[point]);
        for d in 0..D {
            points.position[point][d] += moved[d];
            if follows {
                points.half_length[point][d] *= deformation[d][d];
            }
        }
        points.inverse_deformation[point] = identity();
        if let Some(domains) = &mut self.body.operators.domains {
            domains.carry(point, &deformation);
        }
        self.carried[point] = product(&deformation, &self.carried[point]);
    }
}
