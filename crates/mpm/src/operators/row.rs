//! A row of shape functions along one direction, and what walls and surfaces make of it.

/// Values and gradients of a point's shape functions in one direction, over neighbouring nodes, in units of the cell.
///
/// Every row sums to one and its gradients to zero, by construction and not up to the round-off of a normalisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<const W: usize> {
    /// Lowest node of the row.
    pub first: usize,
    /// Shape function of each node.
    pub values: [f64; W],
    /// Gradient of each, 1/cell.
    pub gradients: [f64; W],
}

impl<const W: usize> Row<W> {
    /// Removes the nodes beyond a wall from the row: a field continues there as a line through its value
    /// at the wall and that at the mirrored node, which for a velocity that the wall holds is its odd
    /// image. Linear fields are still met exactly, and the row still sums to one; a field that bends
    /// at the wall, as above a rough base, is met to first order there.
    pub fn fold_at(&mut self, wall: usize, is_beyond: impl Fn(usize) -> bool) {
        for k in 0..W {
            let node = self.first + k;
            if is_beyond(node) {
                // A row that lies behind the wall altogether is of a run that is lost, and stays as it is.
                let at_wall = wall.wrapping_sub(self.first);
                let mirrored = (2 * wall).wrapping_sub(node + self.first);
                if at_wall >= W || mirrored >= W {
                    continue;
                }
                for side in [&mut self.values, &mut self.gradients] {
                    let beyond = std::mem::replace(&mut side[k], 0.0);
                    side[at_wall] += 2.0 * beyond;
                    side[mirrored] -= beyond;
                }
            }
        }
    }

    /// Removes the nodes above a last one from the row: their values continue along the line through the last
    /// two. Linear fields are still met exactly, and the row still sums to one. A row that would be
    /// left with one node keeps two.
    pub fn straighten_beyond(&mut self, last: usize) {
        let last = last.saturating_sub(self.first).max(1);
        for k in last + 1..W {
            let beyond = (k - last) as f64;
            for side in [&mut self.values, &mut self.gradients] {
                let share = std::mem::replace(&mut side[k], 0.0);
                side[last] += (1.0 + beyond) * share;
                side[last - 1] -= beyond * share;
            }
        }
    }

    /// Mean of two rows, and the slope between them `length` apart, as a row of up to `V` nodes.
    pub fn between<const V: usize>(low: &Self, high: &Self, length: f64) -> Row<V> {
        let first = low.first.min(high.first);
        let mut row = Row { first, values: [0.0; V], gradients: [0.0; V] };
        for (end, sign) in [(low, -1.0), (high, 1.0)] {
            for k in 0..W {
                // Ends more than a cell apart are not a domain; points outside the mesh are left out.
                if let Some(value) = row.values.get_mut(end.first - first + k) {
                    *value += 0.5 * end.values[k];
                    row.gradients[end.first - first + k] += sign * end.values[k] / length;
                }
            }
        }
        row
    }
}
