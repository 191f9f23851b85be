//! A body at a trial state, and what its balances leave: the one residual of every nonlinear or
//! inertial implicit step, made of the operators of the explicit one.

use crate::elementary;
use crate::mpm::body::Body;
use crate::mpm::implicit::assembly::Scales;
use crate::mpm::implicit::unknowns::Unknowns;
use crate::mpm::method::{Configuration, Memory, PressureIntegration};
use crate::mpm::operators::basis::ShapeFunction;
use crate::mpm::run::integrator::Formulation;
use crate::mpm::state::points::Points;
use crate::soil::tensor::{Tensor, Vector, identity, inverse, strain_between};

/// Where a stage starts: the unknowns' share that is known before it is solved.
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

/// Time level at which the effective stress acts in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skeleton {
    /// That of the anchored state.
    Explicit,
    /// That of the trial state.
    Implicit,
}

/// A body that is moved to trial states about an anchored one.
#[derive(Clone, Debug)]
pub struct Trial<const D: usize, const W: usize, S: ShapeFunction<W>> {
    /// The body; its nodes hold what the last residual was made of.
    pub body: Body<D, W, S>,
    /// Numbering.
    pub unknowns: Unknowns<D>,
    /// Scales.
    pub scales: Scales,
    /// Terms of the balances.
    formulation: Formulation,
    /// Time level of the effective stress.
    skeleton: Skeleton,
    /// Points of the anchored state.
    anchor: Points<D>,
    /// Their deformation gradients.
    anchor_deformation: Vec<Tensor<D>>,
    /// Velocities of skeleton and water at the nodes in the anchored state, m/s.
    pub velocity: [Vec<Vector<D>>; 2],
    /// Increment of the nodal displacement since the anchor, m.
    displacement: Vec<Vector<D>>,
    /// Whether points move between steps. Within a step they never do: weights stay on the
    /// configuration of its start, and gradients are pushed forward from there.
    moves_points: bool,
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Trial<D, W, S> {
    /// A body anchored at its present state.
    pub fn new(mut body: Body<D, W, S>, formulation: Formulation, skeleton: Skeleton) -> Self {
        let moves_points = body.configuration.moves_points();
        if moves_points {
            body.points.inverse_deformation.fill(identity());
            body.configuration = Configuration::Total;
            body.follow_points();
        }
        let mut trial = Self {
            moves_points,
            unknowns: Unknowns::of(&body),
            scales: Scales::of(&body),
            anchor: Points::default(),
            anchor_deformation: Vec::new(),
            velocity: [body.nodes.solid_velocity.clone(), body.nodes.water_velocity.clone()],
            displacement: vec![[0.0; D]; body.nodes.len()],
            formulation,
            skeleton,
            body,
        };
        trial.anchor_here();
        trial
    }

    /// The body as it is, in the configuration it was given in.
    pub fn body_now(&self) -> Body<D, W, S> {
        let mut body = self.body.clone();
        if self.moves_points {
            body.configuration = Configuration::Updated;
        }
        body
    }

    /// Settlement of the loaded surface, m, of a body whose surface was at `initial_height`.
    pub fn settlement(&self, initial_height: f64) -> f64 {
        let body = &self.body;
        if self.moves_points {
            initial_height - body.surface.height(&body.points)
        } else {
            -body.surface.amplitude_of(&body.grid, &body.points, &body.nodes.displacement)
        }
    }

    /// Loads the surface, Pa.
    pub fn load(&mut self, load: f64) {
        let body = &mut self.body;
        body.surface.load = load;
        body.surface.apply(&body.grid, &body.points, &mut body.nodes);
    }

    /// Makes the present state the one that increments count from.
    pub fn anchor_here(&mut self) {
        self.anchor.clone_from(&self.body.points);
        let deformation = self.anchor.inverse_deformation.iter().map(|tensor| inverse(tensor).0);
        self.anchor_deformation.clear();
        self.anchor_deformation.extend(deformation);
    }

    /// Moves the body to increments of the unknowns since the anchor.
    pub fn move_to(&mut self, increments: &[f64]) {
        for (nodal, numbers) in self.displacement.iter_mut().zip(&self.unknowns.displacement) {
            *nodal =
                numbers.map(|number| number.map_or(0.0, |number| self.scales.length * increments[number]));
        }
        let rows = &self.unknowns.rows;
        let is_bbar = self.body.method.strain.is_bbar();
        let dilations = if is_bbar { rows.at_points(&rows.at_sites(&self.displacement)) } else { Vec::new() };
        for point in 0..self.anchor.len() {
            let mut gradient = self.body.strain_gradient(point, &self.displacement);
            let mut dilation = 0.0;
            if let Some(volumetric) = dilations.get(point) {
                dilation = volumetric - (0..D).map(|d| gradient[d][d]).sum::<f64>();
                for d in 0..D {
                    gradient[d][d] += dilation / D as f64;
                }
            }
            self.strain_point(point, &gradient, dilation);
            let mut change = 0.0;
            self.unknowns.visit_recovery(point, |site, weight| {
                change += weight * increments[self.unknowns.pressure[site]];
            });
            self.body.points.pressure[point] = self.anchor.pressure[point] + self.scales.pressure * change;
        }
        if self.body.configuration.deforms() {
            self.body.follow_points();
        }
    }

    /// Deformation and effective stress of a point under a displacement gradient since the anchor.
    fn strain_point(&mut self, point: usize, gradient: &Tensor<D>, dilation: f64) {
        let anchor = &self.anchor;
        let points = &mut self.body.points;
        let (mut strain, mut modulus) = (*gradient, 1.0);
        if self.body.configuration.deforms() {
            let before = &self.anchor_deformation[point];
            let after: Tensor<D> =
                std::array::from_fn(|i| std::array::from_fn(|j| before[i][j] + gradient[i][j]));
            let (inverse_after, _) = inverse(&after);
            points.inverse_deformation[point] = inverse_after;
            let ratio = inverse(&after).1 / inverse(before).1;
            points.volume_ratio[point] = anchor.volume_ratio[point] * ratio;
            strain = strain_between(before, &after, elementary::ln(ratio));
            modulus =
                self.body.material.law.modulus_ratio(anchor.volume_ratio[point], points.volume_ratio[point]);
        }
        let mut stress = self.body.stiffness.stress(&strain);
        for i in 0..D {
            stress[i][i] += self.body.stiffness.shared_dilation_stress::<D>(dilation);
        }
        for i in 0..D {
            for j in 0..D {
                points.effective_stress[point][i][j] =
                    anchor.effective_stress[point][i][j] + modulus * stress[i][j];
            }
        }
    }

    /// What the balances leave at increments of the unknowns, scaled: forces on the mixture that
    /// nothing balances, and volume that a site gained beyond its storage.
    ///
    /// # Errors
    /// The index of a point whose pores are closed: there is no residual then.
    pub fn residual(
        &mut self,
        increments: &[f64],
        start: &StageStart<D>,
        residual: &mut [f64],
    ) -> Result<(), usize> {
        self.move_to(increments);
        if self.skeleton == Skeleton::Explicit {
            self.body.points.effective_stress.clone_from(&self.anchor.effective_stress);
        }
        self.body.map_forces();
        self.momentum(increments, start, residual);
        self.body.nodal_flux();
        self.storage(increments, start, residual);
        let grains = 1.0 - self.body.material.porosity;
        match self.body.points.volume_ratio.iter().position(|ratio| *ratio <= grains || ratio.is_nan()) {
            Some(point) => Err(point),
            None => Ok(()),
        }
    }

    /// Nodal velocities of both phases at the end of the stage, and what is left of the mixture's
    /// momentum.
    fn momentum(&mut self, increments: &[f64], start: &StageStart<D>, residual: &mut [f64]) {
        let per_duration = 1.0 / start.duration;
        let water_density = self.body.material.water_density;
        let nodes = &mut self.body.nodes;
        for node in 0..nodes.len() {
            nodes.solid_velocity[node] = [0.0; D];
            nodes.water_velocity[node] = [0.0; D];
            let drag = nodes.drag[node];
            let water_inertia = water_density * nodes.volume[node] * per_duration;
            for d in 0..D {
                // Where the skeleton is held, the water may still slide.
                let number = self.unknowns.displacement[node][d];
                let moved = number.map_or(0.0, |number| increments[number] - start.unknowns[number]);
                let solid = self.scales.length * per_duration * moved;
                let solid_change = solid - start.solid_velocity[node][d];
                let force = nodes.water_force[node][d];
                let before = start.water_velocity[node][d];
                let water = match self.formulation {
                    Formulation::QuasiStatic => solid + force / drag,
                    Formulation::UP => solid + (force - water_inertia * solid_change) / drag,
                    Formulation::VW => {
                        (water_inertia * before + force + drag * solid) / (water_inertia + drag)
                    }
                };
                nodes.solid_velocity[node][d] = solid;
                if nodes.water_free[node][d] > 0.0 {
                    nodes.water_velocity[node][d] = water;
                }
                let Some(row) = number else { continue };
                let water_change = match self.formulation {
                    Formulation::QuasiStatic => {
                        residual[row] = -nodes.mixture_force[node][d] / self.scales.force;
                        continue;
                    }
                    Formulation::UP => solid_change,
                    Formulation::VW => water - before,
                };
                let momentum = nodes.solid_mass[node] * solid_change + nodes.water_mass[node] * water_change;
                residual[row] = (per_duration * momentum - nodes.mixture_force[node][d]) / self.scales.force;
            }
        }
    }

    /// What is left of the mixture's volume at each site.
    fn storage(&self, increments: &[f64], start: &StageStart<D>, residual: &mut [f64]) {
        let body = &self.body;
        let rates = self.volume_rates();
        for (site, rate) in rates.iter().enumerate() {
            let number = self.unknowns.pressure[site];
            let stored = self.unknowns.porosity(body, site) / body.material.water_bulk_modulus
                * self.scales.pressure
                * (increments[number] - start.unknowns[number]);
            residual[number] = stored + start.duration * rate;
        }
    }

    /// Rate of the mixture's volume at each site, 1/s.
    fn volume_rates(&self) -> Vec<f64> {
        let (body, unknowns) = (&self.body, &self.unknowns);
        let at_point = |point: usize, porosity: f64| {
            body.volume_rate(porosity, |field| body.divergence_at_point(point, field))
        };
        if unknowns.integration == PressureIntegration::Mean {
            let mut rates = vec![0.0; unknowns.sites.len()];
            for point in 0..body.points.len() {
                let cell = body.cells.of_point[point];
                if let Some(site) = unknowns.site_of(cell) {
                    let share = body.points.volume(point) / body.cells.volume(cell);
                    rates[site] += share * at_point(point, body.cells.porosity[cell]);
                }
            }
            return rates;
        }
        let rate = |(site, place): (usize, &usize)| {
            let porosity = unknowns.porosity(body, site);
            match unknowns.integration {
                PressureIntegration::Points => at_point(*place, porosity),
                PressureIntegration::Sri | PressureIntegration::Mean => {
                    body.volume_rate(porosity, |field| body.divergence_at_centre(*place, field))
                }
            }
        };
        unknowns.sites.iter().enumerate().map(rate).collect()
    }

    /// Ends a step at increments of the unknowns: the points keep the state, and where they move,
    /// the operators follow them.
    pub fn commit(&mut self, increments: &[f64]) {
        self.move_to(increments);
        if self.moves_points && self.formulation != Formulation::QuasiStatic {
            self.accelerate_points();
        }
        let stride = *self.body.grid.node_stride();
        for point in 0..self.anchor.len() {
            let of_basis = self.body.basis.value(&stride, point, &self.displacement);
            let moved = self.body.carrying(point, &self.displacement, of_basis);
            for d in 0..D {
                self.body.points.displacement[point][d] += moved[d];
            }
            if self.moves_points {
                self.carry_point(point, &moved);
            }
        }
        for (total, change) in self.body.nodes.displacement.iter_mut().zip(&self.displacement) {
            for d in 0..D {
                total[d] += change[d];
            }
        }
        if self.moves_points {
            if self.body.method.memory == Memory::Cells {
                let body = &mut self.body;
                body.cell_memory.spread_over_points(&body.grid, &body.cells, &mut body.points);
            }
            self.body.build_operators();
            self.body.map_masses();
            self.unknowns = Unknowns::of(&self.body);
            if self.formulation != Formulation::QuasiStatic {
                self.body.map_velocities();
            }
        }
        self.velocity[0].clone_from(&self.body.nodes.solid_velocity);
        self.velocity[1].clone_from(&self.body.nodes.water_velocity);
        self.anchor_here();
    }

    /// Gives the points what their nodes gained in velocity (FLIP).
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
                body.basis.visit(&stride, point, |node, weight, _| {
                    for (total, gain) in velocity.iter_mut().zip(gained(node)) {
                        *total += weight * gain;
                    }
                });
            }
        }
    }

    /// Takes a point to its new place, with its domain, and forgets the step's deformation: the
    /// next one starts from there.
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
    }
}
