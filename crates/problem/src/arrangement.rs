//! Arrangements of the points in their cells: the regular lattice, shifted or jittered points, one or two point sets.

use oedometer_wording::is_default;
use serde::{Deserialize, Serialize};

/// Departure of the points from the regular lattice, the same for every point of a row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Arrangement {
    /// Shift of all points upward, in spacings of the points: −0.5 puts them on cell faces.
    pub offset: f64,
    /// Largest shift of a row up or down, in spacings: deterministic, and different for every row.
    pub jitter: f64,
    /// Share of the top cell that is filled; its points share it.
    pub filling: f64,
    /// Whether every second cell has one point more, from the second on; in columns of one dimension.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub alternating: bool,
    /// Point sets: 1 carries skeleton and water, 2 are one of each (double-point MPM).
    #[serde(default = "single_set", skip_serializing_if = "is_single_set")]
    pub sets: usize,
    /// Points of the water a cell and direction in double-point MPM; 0 otherwise.
    #[serde(default, skip_serializing_if = "is_default")]
    pub water_per_cell: usize,
}

/// One set: that of a study that names none.
pub fn single_set() -> usize {
    1
}

/// Whether a count is one.
pub fn is_single_set(count: &usize) -> bool {
    *count == 1
}

impl Default for Arrangement {
    /// The regular lattice, every cell full, in one set.
    fn default() -> Self {
        Self { offset: 0.0, jitter: 0.0, filling: 1.0, alternating: false, sets: 1, water_per_cell: 0 }
    }
}

impl Arrangement {
    /// Whether this is the regular lattice in one set.
    pub fn is_regular(&self) -> bool {
        *self == Self::default()
    }

    /// Whether every point lies where the regular lattice has it, in however many sets.
    pub fn is_lattice(&self) -> bool {
        Self { sets: 1, water_per_cell: 0, ..*self }.is_regular()
    }

    /// Whether the water has points of its own: double-point MPM.
    pub fn has_two_sets(&self) -> bool {
        self.sets == 2
    }

    /// Names the water's points where nothing else does: as many as the skeleton's, or none in one set.
    pub fn name_water_points(&mut self, points_per_cell: usize) {
        if !self.has_two_sets() {
            self.water_per_cell = 0;
        } else if self.water_per_cell == 0 {
            self.water_per_cell = points_per_cell;
        }
    }

    /// Cell size, m, with which `cells` cells hold a column of a height, the top one partly.
    pub fn cell_size(&self, height: f64, cells: usize) -> f64 {
        height / ((cells - 1) as f64 + self.filling)
    }

    /// Points over a height of `cells` cells that have `per_cell` of them, or one more; none where they have none.
    pub fn points_up(&self, cells: usize, per_cell: usize) -> usize {
        cells * per_cell + if self.alternating && per_cell > 0 { cells / 2 } else { 0 }
    }
}
