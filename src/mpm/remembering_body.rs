//! A body whose cells remember what its points carry.

use crate::mpm::body::Body;
use crate::mpm::method::Memory;

impl<const D: usize> Body<D> {
    /// Ends a step of a method whose cells remember, where points move: spreads over the points of each cell what the
    /// cell remembers, with what is known at the drained surface.
    pub(crate) fn remember_by_cells(&mut self) {
        if self.method.memory != Memory::Cells || !self.configuration.moves_points() {
            return;
        }
        // A surface that has settled lies under free water where the soil has a weight.
        let pressure = self.weight.map_or(0.0, |weight| {
            let depth = weight.level - self.surface.height(&self.points);
            self.material.water_density * weight.gravity * depth
        });
        let Self { grid, cells, points, surface, .. } = self;
        self.cell_memory.spread_over_points(grid, cells, points, surface, pressure);
    }
}
