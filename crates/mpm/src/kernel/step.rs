//! The explicit step: the eight steps of Zheng et al., section 4 (docs/theory.md, section 3), by name and in order.
//!
//! [`kick_and_drift`](Body::kick_and_drift) reads as the paper's list. Steps share passes over the points where they can:
//! the pass of step 1 sums the forces of step 2 as well, that of step 4 the momenta of step 5. Drag is part of step 2.

use crate::drag::{NodalBalance, NodalDrag};
use crate::entries::of_dimension;
use crate::kernel::body::Body;
use crate::kernel::nodes_to_points::Motion;
use crate::kernel::points_to_nodes::{All, Forces, Momenta, Nothing};
use oedometer_problem::settings::Drag;
use oedometer_problem::settings::ExplicitSettings;

/// The steps of Zheng et al., section 4, in order; the eighth is the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// 1: shape functions, masses, momenta and velocities of the nodes, and the sums of the forces on them.
    Grid,
    /// 2: accelerations of water and skeleton at the nodes (docs/theory.md, Eqs 1 and 2).
    NodalAccelerations,
    /// 3: velocities at the nodes by forward Euler.
    NodalVelocities,
    /// 4: velocities and places of the points, and the sums of the momenta that they give back.
    Points,
    /// 5: velocities at the nodes, mapped back.
    MappingBack,
    /// 6: effective stresses, volumes and domains of the points.
    EffectiveStress,
    /// 7: pressures of the points (docs/theory.md, Eq. 8).
    Pressure,
}

/// What other crates call of a step.
struct Entries<const D: usize> {
    kick_and_drift: fn(&mut Body<D>, f64, f64, &ExplicitSettings),
    step_by_step: fn(&mut Body<D>, f64, f64, &ExplicitSettings, &mut dyn FnMut(Step)),
}

static LINE: Entries<1> = Entries::TABLE;
static PLANE: Entries<2> = Entries::TABLE;

impl<const D: usize> Entries<D> {
    const TABLE: Self = Self {
        kick_and_drift: |body, kick, dt, settings| body.take_step(kick, dt, settings, |_| ()),
        step_by_step: |body, kick, dt, settings, done| body.take_step(kick, dt, settings, done),
    };
}

impl<const D: usize> Body<D> {
    /// One explicit step of `dt` seconds by forward Euler.
    pub fn explicit_step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.kick_and_drift)(self, kick, dt, settings);
    }

    /// The same step; `done` is called after each of its steps, so that they can be timed.
    pub fn step_by_step(
        &mut self,
        kick: f64,
        dt: f64,
        settings: &ExplicitSettings,
        mut done: impl FnMut(Step),
    ) {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.step_by_step)(self, kick, dt, settings, &mut done);
    }

    fn take_step(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings, mut done: impl FnMut(Step)) {
        self.reset_grid(settings);
        done(Step::Grid);
        self.nodal_accelerations(kick, settings.drag);
        done(Step::NodalAccelerations);
        self.nodal_velocities(kick, dt);
        done(Step::NodalVelocities);
        let motion = Motion { kick, dt, flip: settings.flip };
        if settings.mapping_back {
            self.advance_points::<Momenta>(motion);
            done(Step::Points);
            self.take_velocities();
        } else {
            self.advance_points::<Nothing>(motion);
            done(Step::Points);
        }
        done(Step::MappingBack);
        self.update_effective_stress(dt);
        done(Step::EffectiveStress);
        self.update_pressure(dt);
        self.average_over_cells();
        done(Step::Pressure);
    }

    /// Lets the points follow the means over their cells, where they do.
    fn average_over_cells(&mut self) {
        let moves = self.configuration.moves_points();
        if let Some(averages) = self.actions.cell_averages.as_mut().filter(|_| moves) {
            averages.spread_over_points(&self.grid, &self.cells, &mut self.points);
        }
    }

    /// Step 1: shape functions, masses and velocities at the points' places, and in the same pass the sums of step 2's
    /// forces. Where nothing moves all but these stands, and velocities that the last step has not mapped back do not.
    fn reset_grid(&mut self, settings: &ExplicitSettings) {
        if !self.configuration.deforms() {
            if !settings.mapping_back {
                self.map_velocities();
            }
            self.sum_points::<Forces>();
            return;
        }
        if self.configuration.moves_points() {
            self.follow_moved_points();
        } else {
            self.follow_places();
            self.sum_points::<All>();
        }
        self.take_masses();
        self.take_velocities();
    }

    /// Step 2: accelerations of water and skeleton at the nodes.
    fn nodal_accelerations(&mut self, kick: f64, drag: Drag) {
        self.take_forces();
        let water_density = self.material.water_density;
        self.accelerate_nodes(kick, drag, |volume, _| water_density * volume);
        if let Some(plate) = &self.actions.plate {
            plate.tie_accelerations(&mut self.nodes);
        }
    }

    /// Accelerations of both phases from the forces on the nodes, with the water's inertia per volume of water
    /// at each, kg, from the volume of the mixture at a node and its number.
    pub(crate) fn accelerate_nodes(
        &mut self,
        kick: f64,
        level: Drag,
        water_inertia: impl Fn(f64, usize) -> f64,
    ) {
        let (count, nodes) = (self.nodes.len(), &mut self.nodes);
        let [volume, water_mass, per_solid_mass, drag] =
            [&nodes.volume, &nodes.water_mass, &nodes.per_solid_mass, &nodes.drag]
                .map(|field| &field[..count]);
        let [free, water_free] = [&nodes.free, &nodes.water_free].map(|field| &field[..count]);
        let velocity = [&nodes.solid_velocity, &nodes.water_velocity].map(|field| &field[..count]);
        let force = [&nodes.mixture_force, &nodes.water_force].map(|field| &field[..count]);
        let [solid_acceleration, water_acceleration] =
            [&mut nodes.solid_acceleration, &mut nodes.water_acceleration].map(|field| &mut field[..count]);
        for &node in &nodes.active {
            let inertia = water_inertia(volume[node], node);
            let share = water_mass[node] * per_solid_mass[node];
            let drag = NodalDrag::new(level, kick, drag[node], share, inertia);
            for d in 0..D {
                let (free, water_free) = (free[node][d], water_free[node][d]);
                let balance = NodalBalance {
                    per_solid_mass: free * per_solid_mass[node],
                    water_share: free * share,
                    per_water_inertia: water_free / drag.inertia(inertia, free * share),
                    drag,
                };
                let [force, velocity] =
                    [force, velocity].map(|[solid, water]| [solid[node][d], water[node][d]]);
                let [solid, water] = balance.accelerations(force[0], force[1], velocity);
                (solid_acceleration[node][d], water_acceleration[node][d]) = (solid, water);
            }
        }
    }

    /// Step 3: nodal velocities by forward Euler.
    pub(crate) fn nodal_velocities(&mut self, kick: f64, dt: f64) {
        let (count, nodes) = (self.nodes.len(), &mut self.nodes);
        let [solid_velocity, water_velocity, displacement, water_acceleration] = [
            &mut nodes.solid_velocity,
            &mut nodes.water_velocity,
            &mut nodes.displacement,
            &mut nodes.water_acceleration,
        ]
        .map(|field| &mut field[..count]);
        let [solid_acceleration, sliding] =
            [&nodes.solid_acceleration, &nodes.sliding].map(|field| &field[..count]);
        let motion = &mut nodes.motion[..count];
        for &node in &nodes.active {
            for d in 0..D {
                solid_velocity[node][d] += kick * solid_acceleration[node][d];
                water_velocity[node][d] += kick * water_acceleration[node][d];
                displacement[node][d] += dt * solid_velocity[node][d];
                // What slides along the base is the node's alone: the points have no part in it.
                water_acceleration[node][d] *= 1.0 - sliding[node][d];
            }
            motion[node] = [
                solid_velocity[node],
                solid_acceleration[node],
                water_velocity[node],
                water_acceleration[node],
            ];
        }
        if let Some(gradients) = &mut self.actions.velocity_gradients {
            gradients.take(&self.grid, &self.operators.basis, &self.nodes);
        }
    }

    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the points:
    /// `Δp = −Δt (K_w/n) [∇·v_s + ∇·w]` (docs/theory.md, Eq. 8), with the flux that the nodes have.
    fn update_pressure(&mut self, dt: f64) {
        if self.actions.forcing.is_some() {
            self.update_forced_pressure(dt);
            return;
        }
        self.nodes.take_flux();
        self.surface_flux += dt * self.outflow_of(&self.nodes.flux);
        self.add_pressure_increments(dt, |body, place, porosity| {
            body.volume_rate(porosity, |field| body.divergence_at(place, field))
        });
    }
}
