//! Energy and unbalanced forces of a frozen body during a run.
//!
//! With the forces `K_σ u` and `K_p U` of the displacement `u` that strained the skeleton and of the flux `U`, and the
//! constant ones `f` on the mixture and `f_w` on the water,
//!
//! ```text
//! H = Σ ½ (m_s v_s² + m_w v_w²) + ½ uᵀK_σ u + ½ UᵀK_p U − [(f − f_w)·u + f_w·U]
//! ```
//!
//! falls by what drag takes, and by nothing else, where the operators are symmetric. Of a step whose velocities and
//! displacements take turns the product of two neighbouring displacements stays, not the square of one (Hairer, Lubich
//! & Wanner 2006, section IX.8): `u` at the start of the last step times the force at its end, and the mean of both in the
//! work. Velocities that were mapped back, `v = P w`, are smoother than the `w` of the points, and `½ wᵀ M P w = ½ vᵀ M P⁻¹ v` is
//! what they have in motion: two terms of the series of `P⁻¹ = I + (I − P) + …`, which suffice where a mesh resolves a wave.

use crate::integrate::assembled::rows::{BandsWithin, REACH, RowStorage, Rows};
use crate::integrate::assembled::state::{Displacements, LANES, MARGIN, SOLID, WATER, lanes};
use crate::integrate::assembled::step::{AssembledStep, BlockConstants};
use crate::kernel::energy::Energy;
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

impl<const D: usize> AssembledStep<D> {
    /// Follows a drift of `dt` seconds of the nodes of the same body, which goes point by point.
    pub fn follow(&mut self, nodes: &Nodes<D>, dt: f64) {
        for (row, &node) in self.nodes.iter().enumerate() {
            let place = MARGIN + row;
            for (phase, field) in [(SOLID, &nodes.solid_velocity), (WATER, &nodes.water_velocity)] {
                self.state.velocity[phase][place] = field[node];
                self.state.trial[phase][place] = field[node];
            }
            for d in 0..D {
                self.state.strain_displacement[place][d] += dt * nodes.solid_velocity[node][d];
                self.state.flux_displacement[place][d] += dt * nodes.flux[node][d];
            }
        }
    }

    /// Energy after a drift of `dt` seconds, J, by velocities that were mapped back or not.
    pub fn energy(&mut self, dt: f64, mapping_back: bool) -> Energy {
        let Self { rows, constants, state, .. } = self;
        if let RowStorage::Sparse(rows) = rows {
            rows.dilate(&state.flux_displacement, &mut state.dilation);
        }
        let velocity = if mapping_back { &state.velocity } else { &state.trial };
        let moved = Moved {
            displacements: Displacements {
                strained: &state.strain_displacement,
                flux: &state.flux_displacement,
                dilation: &state.dilation,
            },
            velocity: velocity.each_ref().map(|field| &field[..]),
            mapping_back,
            dt,
        };
        match rows {
            RowStorage::Banded(bands) => sum_of(&BandsWithin::<D, REACH>(bands), constants, &moved),
            RowStorage::Sparse(rows) => sum_of(rows, constants, &moved),
        }
    }

    /// Largest force on a free component of the skeleton that accelerates its node, N.
    pub fn largest_accelerating_force(&self) -> f64 {
        let acceleration = &self.state.acceleration;
        let mut largest: f64 = 0.0;
        for row in 0..self.nodes.len() {
            let (block, i) = (&self.constants[row / LANES], row % LANES);
            let [solid_mass, water_mass] = block.masses(i);
            for d in (0..D).filter(|d| block.free[SOLID][*d][i] > 0.0) {
                let force = solid_mass * acceleration[SOLID][MARGIN + row][d]
                    + water_mass * acceleration[WATER][MARGIN + row][d];
                largest = if force.is_finite() { largest.max(force.abs()) } else { f64::INFINITY };
            }
        }
        largest
    }
}

/// Displacements and velocities at the end of a step of `dt` seconds.
struct Moved<'a, const D: usize> {
    displacements: Displacements<'a, D>,
    velocity: [&'a [Vector<D>]; 2],
    mapping_back: bool,
    dt: f64,
}

fn sum_of<const D: usize>(
    rows: &impl Rows<D>,
    constants: &[BlockConstants<D>],
    Moved { displacements, velocity, mapping_back, dt }: &Moved<'_, D>,
) -> Energy {
    let mut energy = Energy::default();
    for (block, nodes) in constants.iter().enumerate() {
        let [pressure, skeleton] = rows.forces(block, *displacements);
        let smoothed = mapping_back.then(|| rows.projected(block, *velocity));
        for d in 0..D {
            let [solid, water] = velocity.map(|field| lanes(field, block, d));
            let [solid_smoothed, water_smoothed] =
                smoothed.map_or([solid, water], |phases| phases.map(|of| of[d]));
            let strained = lanes(displacements.strained, block, d);
            let flux = lanes(displacements.flux, block, d);
            for i in (0..LANES).filter(|i| nodes.holds_row(*i)) {
                let [solid_mass, water_mass] = nodes.masses(i);
                let flowing = solid[i] + nodes.porosity(i) * (water[i] - solid[i]);
                let before = [strained[i] - dt * solid[i], flux[i] - dt * flowing];
                let mean = [strained[i] - 0.5 * dt * solid[i], flux[i] - 0.5 * dt * flowing];
                energy.kinetic += 0.5 * solid_mass * solid[i] * (2.0 * solid[i] - solid_smoothed[i])
                    + 0.5 * water_mass * water[i] * (2.0 * water[i] - water_smoothed[i]);
                energy.stored += 0.5 * (before[0] * skeleton[d][i] + before[1] * pressure[d][i]);
                let [mixture, on_water] = nodes.given_forces(d, i);
                energy.work += (mixture - on_water) * mean[0] + on_water * mean[1];
            }
        }
    }
    energy
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::body::Body;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::{Drag, ExplicitSettings};
    use oedometer_problem::wave_speeds::combined_limit;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{DYNAMIC_COLUMN, STANDING_WAVE};
    use oedometer_soil::material::Material;

    /// Checks that what is stored after a step is the product of the displacements before and after it, which `energy`
    /// knows from the velocities alone.
    fn stored_between_two_displacements<const D: usize>(mapping_back: bool) {
        let soil = Material { porosity: 0.43, ..Material::default() };
        let column = Column { dimensions: D, height: 2.3, load: 37.0, ..Column::default() }.with_extent(0.92);
        let method = Method::named("GIMP-SRI").expect("a known method");
        let problem = column_problem::<D>(&DYNAMIC_COLUMN, &column, &soil, method, 5, 2);
        let problem = problem.expect("a column");
        let dt = 0.5 * combined_limit(&soil, problem.grid.cell_size, Drag::Implicit);
        let settings = ExplicitSettings { drag: Drag::Implicit, mapping_back, ..ExplicitSettings::default() };
        let mut before = AssembledStep::new(&Body::new(problem));
        before.set_step(dt, &settings);
        for _ in 0..20 {
            before.kick_and_drift(dt, dt, &settings);
        }
        let mut after = before.clone();
        after.kick_and_drift(dt, dt, &settings);
        let mut change = after.clone();
        let fields = |step: &AssembledStep<D>| {
            [step.state.strain_displacement.clone(), step.state.flux_displacement.clone()]
        };
        let [strained, flux] = fields(&before);
        let state = &mut change.state;
        for (now, last) in [(&mut state.strain_displacement, strained), (&mut state.flux_displacement, flux)]
        {
            for (now, last) in now.iter_mut().flatten().zip(last.iter().flatten()) {
                *now -= last;
            }
        }
        let [start, end, of_change] =
            [&mut before, &mut after, &mut change].map(|step| step.energy(0.0, mapping_back).stored);
        let stored = after.energy(dt, mapping_back).stored;
        let expected = 0.5 * (start + end - of_change);
        assert!((stored / expected - 1.0).abs() < 1e-10, "{stored:e} for {expected:e}, {of_change:e}");
        assert!(of_change > 1e-4 * end, "the change shows: {of_change:e} of {end:e}");
    }

    #[test]
    fn the_stored_energy_is_the_product_of_the_displacements_before_and_after_a_step() {
        for mapping_back in [true, false] {
            stored_between_two_displacements::<1>(mapping_back);
            stored_between_two_displacements::<2>(mapping_back);
        }
    }

    #[test]
    fn what_velocities_that_were_mapped_back_have_in_motion_is_what_work_and_stresses_leave() {
        let soil = Material { hydraulic_conductivity: 1e3, ..Material::default() };
        let column = Column::default().with_extent(1.0);
        let method = Method::named("B2").expect("a known method");
        let problem = column_problem::<1>(&STANDING_WAVE, &column, &soil, method, 2, 2).expect("a column");
        let dt = 0.02 * combined_limit(&soil, problem.grid.cell_size, Drag::Implicit);
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let mut step = AssembledStep::new(&Body::new(problem));
        step.set_step(dt, &settings);
        for _ in 0..30 {
            step.kick_and_drift(dt, dt, &settings);
        }
        let Energy { kinetic, stored, work } = step.energy(dt, true);
        let lost = (work - stored - kinetic) / (work - stored);
        assert!(lost.abs() < 0.05, "{lost:e} of {kinetic:e} J");
    }
}
