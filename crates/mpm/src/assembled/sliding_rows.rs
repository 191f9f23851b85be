//! Rows of an assembled step where the water slides past a skeleton that the base holds: the node remembers the water's
//! velocity there, and no point takes part in it (`Nodes::sliding` on grid arrays).

use crate::assembled::assembled_state::{FrozenState, MARGIN, WATER};
use crate::body::Body;

/// Components of rows in which the water slides; none where no base is rough.
#[derive(Clone, Debug, Default)]
pub struct SlidingRows {
    components: Vec<SlidingComponent>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
struct SlidingComponent {
    /// Place in the grid arrays.
    place: usize,
    /// Direction.
    direction: usize,
    porosity: f64,
}

impl SlidingRows {
    /// Those of a body, by the rows of its nodes.
    pub fn of<const D: usize>(body: &Body<D>, number: &[Option<usize>]) -> Self {
        let fields = &body.nodes;
        let of_node = |(node, row): (usize, &Option<usize>)| {
            let (place, porosity) = (MARGIN + (*row)?, fields.porosity[node]);
            let slides = move |direction: &usize| fields.sliding[node][*direction] > 0.0;
            Some((0..D).filter(slides).map(move |direction| SlidingComponent { place, direction, porosity }))
        };
        Self { components: number.iter().enumerate().filter_map(of_node).flatten().collect() }
    }

    /// Takes the acceleration of what slides from what the points are given, once its velocity after the kick is known.
    pub fn keep_accelerations<const D: usize>(&self, state: &mut FrozenState<D>) {
        for one in &self.components {
            state.acceleration[WATER][one.place][one.direction] = 0.0;
        }
    }

    /// Gives what slides the velocity after the kick instead of one mapped back, and takes what it would have let through
    /// in a drift of `dt` seconds back to it where pressures see the mapped velocities.
    pub fn keep_velocities<const D: usize>(&self, state: &mut FrozenState<D>, dt: f64, mapping_back: bool) {
        for one in &self.components {
            let kicked = state.trial[WATER][one.place][one.direction];
            let mapped = std::mem::replace(&mut state.velocity[WATER][one.place][one.direction], kicked);
            if mapping_back {
                state.flux_displacement[one.place][one.direction] += dt * one.porosity * (kicked - mapped);
            }
        }
    }
}
