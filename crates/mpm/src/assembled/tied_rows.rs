//! Rows of an assembled step that go together under a rigid plate: the constraint of
//! `operators::rigid_plate` on grid arrays.

use crate::assembled::assembled_state::{FrozenState, MARGIN, SOLID, WATER};
use crate::body::Body;
use crate::operators::rigid_plate::NORMAL;
use oedometer_soil::tensor::Vector;

/// Rows of one velocity along the plate's normal; none where there is no plate.
#[derive(Clone, Debug, Default)]
pub struct TiedRows {
    rows: Vec<TiedRow>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
struct TiedRow {
    /// Place in the grid arrays.
    place: usize,
    /// Masses of both phases over that of all tied rows.
    shares: [f64; 2],
    porosity: f64,
}

impl TiedRows {
    /// Those of a body, by the rows of its nodes.
    pub fn of<const D: usize>(body: &Body<D>, number: &[Option<usize>]) -> Self {
        let tied = body.plate.as_ref().map_or(&[][..], |plate| &plate.nodes);
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

    /// Gives the rows one acceleration, and the velocities that it leads to within `kick` seconds.
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
