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
//! what they have in motion.

use crate::integrate::assembled::rows::{BandsWithin, REACH, RowStorage, Rows};
use crate::integrate::assembled::state::{Displacements, LANES, MARGIN, SOLID, WATER, lanes, set_lanes};
use crate::integrate::assembled::step::{AssembledStep, BlockConstants};
use crate::kernel::energy::Energy;
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

/// Terms of the series of the kinetic energy.
const MOST_TERMS: usize = 64;
/// Share of the sum that a term adds at least.
const LEAST_TERM: f64 = 1e-3;

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
            terms: if mapping_back { MOST_TERMS } else { 1 },
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
    terms: usize,
    dt: f64,
}

fn sum_of<const D: usize>(
    rows: &impl Rows<D>,
    constants: &[BlockConstants<D>],
    Moved { displacements, velocity, terms, dt }: &Moved<'_, D>,
) -> Energy {
    let kinetic = kinetic_energy(rows, constants, *velocity, *terms);
    let mut energy = Energy { kinetic, ..Energy::default() };
    for (block, nodes) in constants.iter().enumerate() {
        let [pressure, skeleton] = rows.forces(block, *displacements);
        for d in 0..D {
            let [solid, water] = velocity.map(|field| lanes(field, block, d));
            let strained = lanes(displacements.strained, block, d);
            let flux = lanes(displacements.flux, block, d);
            for i in (0..LANES).filter(|i| nodes.holds_row(*i)) {
                let flowing = solid[i] + nodes.porosity(i) * (water[i] - solid[i]);
                let before = [strained[i] - dt * solid[i], flux[i] - dt * flowing];
                let mean = [strained[i] - 0.5 * dt * solid[i], flux[i] - 0.5 * dt * flowing];
                energy.stored += 0.5 * (before[0] * skeleton[d][i] + before[1] * pressure[d][i]);
                let [mixture, on_water] = nodes.given_forces(d, i);
                energy.work += (mixture - on_water) * mean[0] + on_water * mean[1];
            }
        }
    }
    energy
}

/// `½ vᵀ M P⁻¹ v`, J, by `P⁻¹ = I + (I − P) + (I − P)² + …` up to so many terms, or one that adds little: two suffice where a
/// mesh resolves a wave, and the first is all where nothing was mapped back.
fn kinetic_energy<const D: usize>(
    rows: &impl Rows<D>,
    constants: &[BlockConstants<D>],
    velocity: [&[Vector<D>]; 2],
    terms: usize,
) -> f64 {
    let (mut rest, mut energy) = (velocity.map(<[Vector<D>]>::to_vec), 0.0);
    for _ in 0..terms {
        let mut smoother = rest.clone();
        let mut term = 0.0;
        for (block, nodes) in constants.iter().enumerate() {
            let smoothed = rows.projected(block, rest.each_ref().map(|field| &field[..]));
            for phase in [SOLID, WATER] {
                for d in 0..D {
                    let [moving, mut left] =
                        [velocity[phase], &rest[phase]].map(|field| lanes(field, block, d));
                    for i in (0..LANES).filter(|i| nodes.holds_row(*i)) {
                        term += 0.5 * nodes.masses(i)[phase] * moving[i] * left[i];
                        left[i] -= smoothed[phase][d][i];
                    }
                    set_lanes(&mut smoother[phase], block, d, left);
                }
            }
        }
        (rest, energy) = (smoother, energy + term);
        let adds = term > LEAST_TERM * energy;
        if !adds {
            break;
        }
    }
    energy
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::critical_step::predicted::predicted_critical_step;
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
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        for (name, points, share) in [("B2", 2, 0.02), ("B2", 2, 0.95), ("GIMP-SRI-nodal", 1, 0.95)] {
            let column = Column::default().with_extent(1.0);
            let method = Method::named(name).expect("a known method");
            let problem = column_problem::<1>(&STANDING_WAVE, &column, &soil, method, 2, points);
            let problem = problem.expect("a column");
            let dt = share * predicted_critical_step(&problem, &settings);
            let mut step = AssembledStep::new(&Body::new(problem));
            step.set_step(dt, &settings);
            let (mut turned, mut gained) = (0.0_f64, 0.0_f64);
            for _ in 0..400 {
                step.kick_and_drift(dt, dt, &settings);
                let Energy { kinetic, stored, work } = step.energy(dt, true);
                turned = turned.max(kinetic + stored.abs() + work.abs());
                gained = gained.max((kinetic + stored - work).abs());
            }
            assert!(gained < 0.01 * turned, "{name} {share}: {gained:e} of {turned:e} J");
        }
    }
}
