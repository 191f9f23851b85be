//! From nodes to points: what carries them, and what they give back to the nodes at once.
//!
//! A point's new velocities need no other point: its momenta go back to the nodes in the same pass, while its weights
//! are in registers.

use crate::body::Body;
use crate::explicit::points_to_nodes::{add_momenta_to_run, add_pairs, momenta_of, of_line, volumes_of};
use crate::operators::block_rows::{BlockRows, Blocks};
use crate::operators::line_sums::Window;
use crate::operators::stencil::with_stencils;
use crate::operators::strain_gradient::ENDS_WIDTH;
use crate::state::lanes::{FOUR, some_mut, some_of};
use crate::state::nodes::Nodes;
use crate::state::points::Points;
use crate::wide::wide;
use oedometer_soil::tensor::Vector;

/// Durations and shares of a step, for the points.
#[derive(Clone, Copy)]
struct Motion {
    /// How long velocities and places advance, s.
    kick: f64,
    dt: f64,
    /// Share of the acceleration update in the velocities.
    flip: f64,
    /// Whether the points move.
    is_moving: bool,
    /// `1 − n_0`.
    solid_fraction: f64,
}

impl<const D: usize> Body<D> {
    /// Step 4: velocities and places of the points.
    pub(crate) fn advance_points(&mut self, kick: f64, dt: f64, flip: f64) {
        self.carry_points::<false>(kick, dt, flip);
    }

    /// Steps 4 and 5: velocities and places of the points, and their momenta back at the nodes.
    pub(crate) fn advance_points_and_map_back(&mut self, kick: f64, dt: f64, flip: f64) {
        self.carry_points::<true>(kick, dt, flip);
    }

    fn carry_points<const BACK: bool>(&mut self, kick: f64, dt: f64, flip: f64) {
        let (is_moving, solid_fraction) = (self.configuration.moves_points(), 1.0 - self.material.porosity);
        let motion = Motion { kick, dt, flip, is_moving, solid_fraction };
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => {
            wide!(self.carry_points_by::<BACK, _>(stencils.blocks(), motion));
        });
        self.basis = basis;
    }

    /// The same, some neighbouring points after the others.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn carry_points_by<const BACK: bool, const W: usize>(&mut self, basis: Blocks<'_, D, W>, motion: Motion) {
        let Nodes { solid_velocity, motion: of_nodes, sums, .. } = &mut self.nodes;
        if BACK {
            for [solid, water, ..] in &mut sums.balances {
                (*solid, *water) = ([0.0; D], [0.0; D]);
            }
        }
        let mut carried = Carried {
            motion,
            stride: *self.grid.node_stride(),
            of_nodes: &of_nodes[..],
            solid_field: &solid_velocity[..],
            carrier: self.strain.carrier(),
            points: &mut self.points,
            balances: &mut sums.balances[..],
            window: Window::EMPTY,
        };
        let count = carried.points.len();
        let whole = count / FOUR * FOUR;
        for first in (0..whole).step_by(FOUR) {
            carried.carry::<FOUR, BACK>(basis.four(first), 0, first);
        }
        for point in whole..count {
            carried.carry::<1, BACK>(basis.four(whole), point - whole, point);
        }
        if BACK && D == 1 {
            let Carried { window, balances, .. } = carried;
            window.close(|nodes, sums| add_pairs::<_, 0>(&mut balances[nodes], sums));
        }
    }
}

/// What carries the points, and what they give back.
struct Carried<'a, const D: usize, const W: usize> {
    motion: Motion,
    stride: [usize; D],
    /// As [`Nodes::motion`].
    of_nodes: &'a [[Vector<D>; 4]],
    solid_field: &'a [Vector<D>],
    /// What moves the points where it is not the value of the basis.
    carrier: Option<Blocks<'a, D, ENDS_WIDTH>>,
    points: &'a mut Points<D>,
    balances: &'a mut [[Vector<D>; 4]],
    /// Momenta that the nodes of a line have still to take.
    window: Window<W, 2>,
}

impl<const D: usize, const W: usize> Carried<'_, D, W> {
    /// Carries `N` points from a first one on, which is a lane of the rows: first what the nodes do at each of them, then
    /// what follows.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn carry<const N: usize, const BACK: bool>(
        &mut self,
        rows: BlockRows<'_, D, W>,
        lane: usize,
        first: usize,
    ) {
        let Motion { kick, dt, flip, is_moving, solid_fraction } = self.motion;
        let points = &mut *self.points;
        // Velocities of skeleton and water and their rates.
        let mut at_points = [[[0.0; D]; 4]; N];
        for point in 0..N {
            at_points[point] = rows.values(&self.stride, lane + point, self.of_nodes);
        }
        let mut solid = *some_of::<_, N>(&points.solid_velocity, first);
        let mut water = *some_of::<_, N>(&points.water_velocity, first);
        for point in 0..N {
            let [_, _, solid_rate, water_rate] = &at_points[point];
            for d in 0..D {
                solid[point][d] += kick * solid_rate[d];
                water[point][d] += kick * water_rate[d];
            }
        }
        if flip < 1.0 {
            let pic = 1.0 - flip;
            for point in 0..N {
                let [solid_there, water_there, ..] = &at_points[point];
                for d in 0..D {
                    solid[point][d] = flip * solid[point][d] + pic * solid_there[d];
                    water[point][d] = flip * water[point][d] + pic * water_there[d];
                }
            }
        }
        *some_mut(&mut points.solid_velocity, first) = solid;
        *some_mut(&mut points.water_velocity, first) = water;
        let mut carrying = [[0.0; D]; N];
        for point in 0..N {
            carrying[point] = at_points[point][0];
        }
        if let Some(ends) = self.carrier {
            for (point, carrying) in carrying.iter_mut().enumerate() {
                *carrying = ends.value(&self.stride, first + point, self.solid_field);
            }
        }
        let displacement = some_mut::<_, N>(&mut points.displacement, first);
        for point in 0..N {
            for d in 0..D {
                displacement[point][d] += dt * carrying[point][d];
            }
        }
        if is_moving {
            let position = some_mut::<_, N>(&mut points.position, first);
            for point in 0..N {
                for d in 0..D {
                    position[point][d] += dt * carrying[point][d];
                }
            }
        }
        if BACK {
            let initial = some_of::<_, N>(&points.initial_volume, first);
            let ratio = some_of::<_, N>(&points.volume_ratio, first);
            let mut given = [[[0.0; D]; 2]; N];
            for point in 0..N {
                let volumes = volumes_of(initial[point], ratio[point], solid_fraction);
                given[point] = momenta_of(volumes, &solid[point], &water[point]);
            }
            for point in 0..N {
                self.give_back(&rows, lane + point, &given[point]);
            }
        }
    }

    /// Gives the momenta of a point, a lane of the rows, to its nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn give_back(&mut self, rows: &BlockRows<'_, D, W>, lane: usize, momenta: &[Vector<D>; 2]) {
        let balances = &mut *self.balances;
        if D == 1 {
            self.window.take(
                rows.first(lane),
                #[inline(always)]
                |node| rows.weight(node, lane),
                of_line(momenta),
                #[inline(always)]
                |nodes, sums| add_pairs::<_, 0>(&mut balances[nodes], sums),
            );
            return;
        }
        rows.visit_filled_runs(
            &self.stride,
            lane,
            #[inline(always)]
            |run| add_momenta_to_run(balances, run, momenta),
        );
    }
}
