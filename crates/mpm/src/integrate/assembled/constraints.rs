//! Constraints on the rows of a frozen step, as grid arrays have them: rows that go together under a rigid plate
//! (`loaded_body`), and rows where the water slides past a skeleton that the base holds (`Nodes::sliding`).

use crate::actions::rigid_plate::NORMAL;
use crate::integrate::assembled::state::{FrozenState, MARGIN, SOLID, WATER};
use crate::kernel::body::Body;
use oedometer_soil::tensor::Vector;

/// Rows of one velocity along the plate's normal; empty without a plate.
#[derive(Clone, Debug, Default)]
pub struct TiedRows {
    rows: Vec<TiedRow>,
}

/// A row under the plate.
#[derive(Clone, Copy, Debug)]
struct TiedRow {
    /// Place in the grid arrays.
    place: usize,
    /// Masses of both phases over that of all tied rows.
    shares: [f64; 2],
    porosity: f64,
}

impl TiedRows {
    /// The tied rows of a body; `number` has the row of each node.
    pub fn new<const D: usize>(body: &Body<D>, number: &[Option<usize>]) -> Self {
        let tied = body.actions.plate.as_ref().map_or(&[][..], |plate| &plate.nodes);
        let fields = &body.nodes;
        let mass: f64 = tied.iter().map(|node| fields.solid_mass[*node] + fields.water_mass[*node]).sum();
        let row = |node: &usize| {
            let shares = [fields.solid_mass[*node] / mass, fields.water_mass[*node] / mass];
            Some(TiedRow { place: MARGIN + number[*node]?, shares, porosity: fields.porosity[*node] })
        };
        Self { rows: tied.iter().filter_map(row).collect() }
    }

    /// Mean of both phases by mass.
    fn mean<const D: usize>(&self, fields: &[Vec<Vector<D>>; 2]) -> f64 {
        let of_row = |row: &TiedRow| {
            row.shares[SOLID] * fields[SOLID][row.place][NORMAL]
                + row.shares[WATER] * fields[WATER][row.place][NORMAL]
        };
        self.rows.iter().map(of_row).sum()
    }

    /// Sets one acceleration for the rows, and the velocities that it leads to within `kick` seconds.
    pub fn tie_accelerations<const D: usize>(&self, state: &mut FrozenState<D>, kick: f64) {
        let rate = self.mean(&state.acceleration);
        for row in &self.rows {
            for phase in [SOLID, WATER] {
                state.acceleration[phase][row.place][NORMAL] = rate;
                state.trial[phase][row.place][NORMAL] =
                    state.velocity[phase][row.place][NORMAL] + kick * rate;
            }
        }
    }

    /// Gives the rows one velocity, and takes what they would have strained and let through in a drift of `dt`
    /// seconds back to it where stresses see the mapped velocities.
    pub fn tie_velocities<const D: usize>(&self, state: &mut FrozenState<D>, dt: f64, mapping_back: bool) {
        let velocity = self.mean(&state.velocity);
        for row in &self.rows {
            let [solid, water] = [SOLID, WATER].map(|phase| state.velocity[phase][row.place][NORMAL]);
            if mapping_back {
                let flux = solid + row.porosity * (water - solid);
                state.strain_displacement[row.place][NORMAL] += dt * (velocity - solid);
                state.flux_displacement[row.place][NORMAL] += dt * (velocity - flux);
            }
            for phase in [SOLID, WATER] {
                state.velocity[phase][row.place][NORMAL] = velocity;
            }
        }
    }
}

/// Components of rows in which the water slides; none where no base is rough.
#[derive(Clone, Debug, Default)]
pub struct SlidingRows {
    components: Vec<SlidingComponent>,
}

/// A component in which the water slides.
#[derive(Clone, Copy, Debug)]
struct SlidingComponent {
    /// Place in the grid arrays.
    place: usize,
    /// Direction.
    direction: usize,
    porosity: f64,
}

impl SlidingRows {
    /// The sliding components of a body; `number` has the row of each node.
    pub fn new<const D: usize>(body: &Body<D>, number: &[Option<usize>]) -> Self {
        let fields = &body.nodes;
        let of_node = |(node, row): (usize, &Option<usize>)| {
            let (place, porosity) = (MARGIN + (*row)?, fields.porosity[node]);
            let slides = move |direction: &usize| fields.sliding[node][*direction] > 0.0;
            Some((0..D).filter(slides).map(move |direction| SlidingComponent { place, direction, porosity }))
        };
        Self { components: number.iter().enumerate().filter_map(of_node).flatten().collect() }
    }

    /// Removes the acceleration of sliding components from the points' update, once the velocity after the kick is known.
    pub fn keep_accelerations<const D: usize>(&self, state: &mut FrozenState<D>) {
        for component in &self.components {
            state.acceleration[WATER][component.place][component.direction] = 0.0;
        }
    }

    /// Gives what slides the velocity after the kick instead of one mapped back, and takes what it would have let through
    /// in a drift of `dt` seconds back to it where pressures see the mapped velocities.
    pub fn keep_velocities<const D: usize>(&self, state: &mut FrozenState<D>, dt: f64, mapping_back: bool) {
        for component in &self.components {
            let kicked = state.trial[WATER][component.place][component.direction];
            let mapped =
                std::mem::replace(&mut state.velocity[WATER][component.place][component.direction], kicked);
            if mapping_back {
                state.flux_displacement[component.place][component.direction] +=
                    dt * component.porosity * (kicked - mapped);
            }
        }
    }
}
