//! The explicit integrator: the eight steps of Zheng et al., section 4 (docs/theory.md, section 3).
//!
//! A body's step reads as the paper's list: [`kick_and_drift`](Body::kick_and_drift). Drag is part of step 2.

pub mod deformation;
pub mod nodes_to_points;
pub mod points_to_nodes;
pub mod scheme;

use crate::mpm::body::Body;
use crate::mpm::explicit::deformation::{Following, middle_gradient, rotated, stretch_of};
use crate::mpm::method::{Configuration, Memory, PressureIntegration};
use crate::mpm::momentum::{NodalBalance, implicit_drag, per_water_inertia};
use crate::mpm::operators::recovery::points_in_cells::points_in_cells;
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::mpm::operators::strain_gradient::StrainOperator;
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::state::nodes::Nodes;
use crate::soil::tensor::{Tensor, inverse, product};

pub use crate::mpm::explicit::scheme::{Drag, ExplicitSettings};

impl<const D: usize> Body<D> {
    /// One explicit step of `dt` seconds, as the paper has it.
    pub fn explicit_step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        self.reset_grid(settings); // step 1
        enter(Phase::Forces);
        self.nodal_accelerations(kick, settings.drag); // step 2
        if let Some(plate) = &self.plate {
            plate.tie_accelerations(&mut self.nodes);
        }
        enter(Phase::Motion);
        self.nodal_velocities(kick, dt); // step 3
        if settings.mapping_back {
            self.advance_points_and_map_back(kick, dt, settings.flip); // steps 4 and 5
        } else {
            self.advance_points(kick, dt, settings.flip); // step 4
        }
        enter(Phase::Stresses);
        self.update_effective_stress(dt); // step 6
        enter(Phase::Recovery);
        self.update_pressure(dt); // step 7, and step 8 is the next one
        if self.method.memory == Memory::Cells && self.configuration.moves_points() {
            self.cell_memory.spread_over_points(&self.grid, &self.cells, &mut self.points);
        }
    }

    /// Step 1: operators, masses and velocities on the points' places. Where nothing moves, the
    /// operators stand, and velocities mapped back by the last step are already there; where something does, one pass
    /// takes the forces of step 2 along.
    fn reset_grid(&mut self, settings: &ExplicitSettings) {
        enter(Phase::BuildWeights);
        self.follow_places();
        if self.configuration.deforms() {
            enter(Phase::MapVelocities);
            self.map_masses_velocities_and_forces();
        } else if !settings.mapping_back {
            enter(Phase::MapVelocities);
            self.map_velocities();
        }
    }

    /// Step 2: accelerations of water and skeleton at the nodes.
    fn nodal_accelerations(&mut self, kick: f64, drag_level: Drag) {
        if !self.configuration.deforms() {
            self.map_forces();
        }
        let water_density = self.material.water_density;
        self.accelerate_nodes(kick, drag_level, |nodes, node| water_density * nodes.volume[node]);
    }

    /// Accelerations of both phases from the forces on the nodes, with the water's inertia per volume of water
    /// at each, kg.
    #[inline]
    pub(crate) fn accelerate_nodes(
        &mut self,
        kick: f64,
        drag_level: Drag,
        water_inertia: impl Fn(&Nodes<D>, usize) -> f64,
    ) {
        let nodes = &mut self.nodes;
        for active in 0..nodes.active().len() {
            let node = nodes.active()[active];
            let (water_inertia, drag) = (water_inertia(nodes, node), nodes.drag[node]);
            let whole_share = nodes.water_mass[node] * nodes.per_solid_mass[node];
            let implicit_drag = implicit_drag(drag_level, kick, drag, whole_share, water_inertia);
            for d in 0..D {
                let (free, water_free) = (nodes.free[node][d], nodes.water_free[node][d]);
                let water_share = free * whole_share;
                let balance = NodalBalance {
                    per_solid_mass: free * nodes.per_solid_mass[node],
                    water_share,
                    per_water_inertia: per_water_inertia(
                        water_inertia,
                        implicit_drag,
                        water_share,
                        water_free,
                    ),
                    drag,
                    implicit_drag,
                };
                let velocity = [nodes.solid_velocity[node][d], nodes.water_velocity[node][d]];
                let (mixture, water) = (nodes.mixture_force[node][d], nodes.water_force[node][d]);
                [nodes.solid_acceleration[node][d], nodes.water_acceleration[node][d]] =
                    balance.accelerations(mixture, water, velocity);
            }
        }
    }

    /// Step 3: nodal velocities by forward Euler.
    pub(crate) fn nodal_velocities(&mut self, kick: f64, dt: f64) {
        let nodes = &mut self.nodes;
        for active in 0..nodes.active().len() {
            let node = nodes.active()[active];
            for d in 0..D {
                nodes.solid_velocity[node][d] += kick * nodes.solid_acceleration[node][d];
                nodes.water_velocity[node][d] += kick * nodes.water_acceleration[node][d];
                nodes.displacement[node][d] += dt * nodes.solid_velocity[node][d];
            }
        }
    }

    /// Step 6: effective stress by the method's strain gradient; at finite strain also volume and
    /// domain.
    pub(crate) fn update_effective_stress(&mut self, dt: f64) {
        if self.method.strain.is_bbar() {
            self.recover_dilation_rates();
        }
        let (basis, strain) = (std::mem::take(&mut self.basis), std::mem::take(&mut self.strain));
        match &strain {
            StrainOperator::Basis => {
                with_stencils!(&basis, stencils => self.strain_points(stencils.blocks(), dt));
            }
            StrainOperator::Composite(stencils) => self.strain_points(stencils.blocks(), dt),
            StrainOperator::BetweenEnds(stencils) => self.strain_points(stencils.blocks(), dt),
        }
        (self.basis, self.strain) = (basis, strain);
    }

    fn strain_points<const W: usize>(&mut self, blocks: Blocks<'_, D, W>, dt: f64) {
        let (deforms, is_bbar) = (self.configuration.deforms(), self.method.strain.is_bbar());
        let (following, is_total) = (self.following(), self.configuration == Configuration::Total);
        let stride = *self.grid.node_stride();
        let (field, dilation_rates) = (&self.nodes.solid_velocity[..], &self.dilation_rates[..]);
        let (law, stiffness) = (self.material.law, self.stiffness);
        // A motion that is held against exact fields is followed at the middle of the step, to second order.
        let is_at_middle = self.forcing.is_some();
        let points = &mut self.points;
        let count = points.len();
        let (volume_ratio, half_length) =
            (&mut points.volume_ratio[..count], &mut points.half_length[..count]);
        let (inverse_deformation, effective_stress) =
            (&mut points.inverse_deformation[..count], &mut points.effective_stress[..count]);
        for point in 0..count {
            let mut gradient = blocks.gradient(&stride, point, field);
            if is_total {
                gradient = product(&gradient, &inverse_deformation[point]);
            }
            if is_at_middle {
                gradient = middle_gradient(&gradient, dt);
            }
            let mut increment = gradient.map(|row| row.map(|rate| dt * rate));
            let before = volume_ratio[point];
            if deforms {
                volume_ratio[point] *=
                    following.deform(&mut half_length[point], &mut inverse_deformation[point], &increment);
            }
            if law.is_hyperelastic() {
                let deformation = inverse(&inverse_deformation[point]).0;
                effective_stress[point] = stiffness.neo_hookean_stress(&deformation, volume_ratio[point]);
                continue;
            }
            let mut shared = 0.0;
            if is_bbar {
                // Of the kinematics only the volume goes the way of the water's.
                let trace: f64 = (0..D).map(|d| gradient[d][d]).sum();
                let dilation = dt * (dilation_rates[point] - trace);
                if deforms {
                    volume_ratio[point] *= stretch_of(dilation);
                }
                for d in 0..D {
                    increment[d][d] += dilation / D as f64;
                }
                shared = stiffness.shared_dilation_stress::<D>(dilation);
            }
            let mut stress = effective_stress[point];
            if deforms && D > 1 {
                stress = rotated(&stress, &increment);
            }
            let modulus = law.modulus_ratio(before, volume_ratio[point]);
            let change = stiffness.stress(&increment);
            for d in 0..D {
                for e in 0..D {
                    stress[d][e] += modulus * change[d][e];
                }
                stress[d][d] += modulus * shared;
            }
            effective_stress[point] = stress;
        }
    }

    /// Volume ratio, exact in the logarithmic strain, and the domain where it follows.
    pub(crate) fn deform(&mut self, point: usize, increment: &Tensor<D>) {
        let following = self.following();
        let points = &mut self.points;
        points.volume_ratio[point] *= following.deform(
            &mut points.half_length[point],
            &mut points.inverse_deformation[point],
            increment,
        );
    }

    #[inline]
    fn following(&self) -> Following {
        let is_hyperelastic = self.material.law.is_hyperelastic();
        match self.configuration {
            Configuration::Updated if self.method.domains_follow() && is_hyperelastic => Following::Both,
            Configuration::Updated if self.method.domains_follow() => Following::Domain,
            Configuration::Updated if is_hyperelastic => Following::InverseDeformation,
            Configuration::Total => Following::InverseDeformation,
            Configuration::Updated | Configuration::Frozen => Following::Nothing,
        }
    }

    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the points:
    /// `Δp = −Δt (K_w/n) [∇·v_s + ∇·w]` (docs/theory.md, Eq. 8).
    fn update_pressure(&mut self, dt: f64) {
        if self.forcing.is_some() {
            self.update_forced_pressure(dt);
            return;
        }
        self.nodal_flux();
        self.surface_flux += dt * self.outflow_of(&self.nodes.flux);
        self.evaluate_sites(|body, place, porosity| {
            let rate = body.volume_rate(porosity, |field| body.divergence_at(place, field));
            let bulk_modulus = body.material.water_bulk_modulus;
            // The same product in two orders of rounding: those of the accepted values.
            match body.method.pressure {
                PressureIntegration::Points => dt * (-bulk_modulus / porosity * rate),
                PressureIntegration::Sri | PressureIntegration::Mean => -dt * bulk_modulus / porosity * rate,
            }
        });
        let at = points_in_cells!(self);
        let pressures = &mut self.points.pressure;
        self.recovery
            .recover(&at, &self.site_values, pressures, |pressure, increment| *pressure += increment);
    }
}
