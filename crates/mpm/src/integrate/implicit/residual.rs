//! The residual of the balances at a trial state, for every nonlinear or inertial implicit step, from the operators of
//! the explicit step.

use crate::drag::{NodalBalance, NodalDrag};
use crate::integrate::implicit::trial::{Skeleton, Trial};
use crate::integrate::stepper::StepFailure;
use oedometer_problem::integrator::Formulation;
use oedometer_soil::tensor::Vector;

/// Start of a stage: the terms known before it is solved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageStart<const D: usize> {
    /// `γ Δt`, s.
    pub duration: f64,
    /// Unknowns, scaled.
    pub unknowns: Vec<f64>,
    /// Velocity of the skeleton at the nodes, m/s.
    pub solid_velocity: Vec<Vector<D>>,
    /// Velocity of the water at the nodes, m/s.
    pub water_velocity: Vec<Vector<D>>,
}

impl<const D: usize> Trial<D> {
    /// Residual at increments of the unknowns, scaled: unbalanced forces on the mixture, and volume that a site gained
    /// beyond its storage.
    ///
    /// # Errors
    /// [`StepFailure`] if the pores of a point are closed: the residual is undefined then.
    pub fn residual(
        &mut self,
        increments: &[f64],
        start: &StageStart<D>,
        residual: &mut [f64],
    ) -> Result<(), StepFailure> {
        let has_deformed = self.move_to(increments);
        if self.skeleton == Skeleton::Explicit {
            self.body.points.effective_stress.clone_from(&self.anchor.effective_stress);
        }
        if has_deformed {
            self.body.map_masses_and_forces();
        } else {
            self.body.map_forces();
        }
        self.momentum(increments, start, residual);
        self.body.nodes.take_flux();
        self.storage(increments, start, residual);
        self.body.closed_pores().map_or(Ok(()), Err)
    }

    /// Nodal velocities of both phases at the end of the stage, and the residual of the mixture's momentum balance.
    fn momentum(&mut self, increments: &[f64], start: &StageStart<D>, residual: &mut [f64]) {
        let per_duration = 1.0 / start.duration;
        residual.fill(0.0);
        let water_density = self.body.material.water_density;
        let nodes = &mut self.body.nodes;
        for node in 0..nodes.len() {
            nodes.solid_velocity[node] = [0.0; D];
            nodes.water_velocity[node] = [0.0; D];
            let drag = nodes.drag[node];
            let water_inertia = water_density * nodes.volume[node];
            let nodal_drag = NodalDrag { coefficient: drag, implicit: start.duration * drag };
            // The motion of the skeleton is given: the water does not change it.
            let balance = NodalBalance {
                per_solid_mass: 0.0,
                water_share: 0.0,
                per_water_inertia: 1.0 / nodal_drag.inertia(water_inertia, 0.0),
                drag: nodal_drag,
            };
            for d in 0..D {
                // Where the skeleton is held, the water may still slide.
                let number = self.unknowns.displacement[node][d];
                let moved = number.map_or(0.0, |number| increments[number] - start.unknowns[number]);
                let solid = self.unknowns.scales.length * per_duration * moved;
                let solid_change = solid - start.solid_velocity[node][d];
                let is_tied = self.body.actions.plate.as_ref().is_some_and(|plate| plate.ties(node, d));
                let force = nodes.water_force[node][d];
                let before = [start.solid_velocity[node][d], start.water_velocity[node][d]];
                let water = match self.formulation {
                    // An impermeable plate carries the water along.
                    _ if is_tied => solid,
                    Formulation::QuasiStatic => solid + force / drag,
                    Formulation::UP => solid + (force - water_inertia * per_duration * solid_change) / drag,
                    Formulation::VW => {
                        let skeleton = per_duration * solid_change;
                        before[1] + start.duration * balance.water_acceleration(force, before, skeleton)
                    }
                };
                nodes.solid_velocity[node][d] = solid;
                if nodes.water_free[node][d] > 0.0 {
                    nodes.water_velocity[node][d] = water;
                }
                let Some(row) = number else { continue };
                let water_change = match self.formulation {
                    Formulation::QuasiStatic => {
                        residual[row] -= nodes.mixture_force[node][d] / self.unknowns.scales.force;
                        continue;
                    }
                    Formulation::UP => solid_change,
                    Formulation::VW => water - before[1],
                };
                let momentum = nodes.solid_mass[node] * solid_change + nodes.water_mass[node] * water_change;
                // A sum: the nodes of a plate share a row.
                residual[row] +=
                    (per_duration * momentum - nodes.mixture_force[node][d]) / self.unknowns.scales.force;
            }
        }
    }

    /// Residual of the mixture's volume balance at each site.
    fn storage(&mut self, increments: &[f64], start: &StageStart<D>, residual: &mut [f64]) {
        self.body.evaluate_volume_rates();
        let (body, unknowns) = (&self.body, &self.unknowns);
        let changed =
            |number: usize| unknowns.scales.pressure * (increments[number] - start.unknowns[number]);
        for (place, number) in unknowns.rows.sites.iter().zip(&unknowns.pressure) {
            let porosity = body.porosity_of(*place);
            let stored = body.storage_of(*place, porosity) * changed(*number);
            residual[*number] = stored + start.duration * body.site_values[*place];
        }
        for (number, row) in unknowns.pressure.iter().zip(&unknowns.rows.projection) {
            let projected = |(site, value): &(usize, f64)| value * changed(unknowns.pressure[*site]);
            residual[*number] += row.iter().map(projected).sum::<f64>();
        }
    }
}
