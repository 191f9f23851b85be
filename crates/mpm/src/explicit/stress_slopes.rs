//! Forces of stresses that slope over the points' domains.
//!
//! ```text
//! f_i = Σ_p ∫_Ωp [τ_p + g_c·(x − x_p)]·∇N_i dx,   τ = p I − σ'
//! ```
//!
//! With one stress over its domain a point whose domain a line of nodes cuts gives its force as if the stress of its
//! middle were that of both parts. Where points lie alike about all nodes the errors of neighbouring nodes cancel; where
//! they have moved they do not, and what is left is a share of the force that does not fall with the cells. The slope
//! `g_c` is that of the plane through the means of a cell and its neighbours.

use crate::body::Body;
use crate::operators::stencil::with_stencils;
use crate::state::grid::{GHOST_LAYERS, SIXTH};
use crate::state::stress_planes::{StressPlanes, Stresses};
use oedometer_soil::tensor::Vector;

/// Means over a domain of the distance from its middle times the hat of a node, and times its gradient, along one
/// direction.
#[derive(Clone, Copy, Debug)]
struct Levers {
    /// Of the hat, m.
    weight: f64,
    /// Of its gradient.
    gradient: f64,
}

impl Levers {
    /// Of a domain of such a half-length, cells, whose middle is so far from the node, m, and has that weight there; cells
    /// of such a size, m.
    #[inline]
    fn of(distance: f64, half: f64, weight: f64, cell_size: f64) -> Self {
        let middle = distance / cell_size;
        let (low, high) = (middle - half, middle + half);
        let ends = 0.5 * (hat(low) + hat(high));
        let once = 0.5 * (hat_integral(low) + hat_integral(high));
        let twice = 0.5 / half * (hat_second_integral(high) - hat_second_integral(low));
        Self { weight: cell_size * (once - twice), gradient: ends - weight }
    }
}

/// The hat function, cells from its node.
#[inline]
fn hat(place: f64) -> f64 {
    let near = 1.0 - place.abs();
    if near > 0.0 { near } else { 0.0 }
}

/// Its integral from below.
#[inline]
fn hat_integral(place: f64) -> f64 {
    let near = hat(place);
    let beyond = 0.5 * near * near;
    if place > 0.0 { 1.0 - beyond } else { beyond }
}

/// The integral of that from below.
#[inline]
fn hat_second_integral(place: f64) -> f64 {
    let near = hat(place);
    let beyond = SIXTH * near * near * near;
    if place > 0.0 { place + beyond } else { beyond }
}

impl<const D: usize> Body<D> {
    /// Lets stresses slope over the points' domains.
    pub fn slope_stresses(&mut self) {
        self.stress_planes = Some(StressPlanes::new(&self.grid));
    }

    /// Adds what the slopes of the stresses give to the forces on the nodes.
    pub(crate) fn add_stress_slopes(&mut self) {
        let Some(mut planes) = self.stress_planes.take() else { return };
        planes.fit(&self.grid, &self.cells, &self.points);
        let (stride, points, cell_size) = (*self.grid.node_stride(), &self.points, self.grid.cell_size);
        let sums = &mut self.nodes.sums.balances;
        with_stencils!(&self.basis, stencils => {
            let blocks = stencils.blocks();
            for (point, in_cells) in self.cells.place.iter().enumerate() {
                let place: Vector<D> =
                    std::array::from_fn(|d| (in_cells[d] - GHOST_LAYERS as f64) * cell_size);
                let half = points.half_length[point].map(|length| (length / cell_size).min(0.5));
                let volume = points.volume(point) * points.stressed_share[point];
                let given = given_by(&planes.slopes[self.cells.of_point[point]], volume);
                let levers = |node: &Vector<D>, d: usize, weight: f64| {
                    Levers::of(place[d] - node[d], half[d], weight, cell_size)
                };
                // The runs of a point lie above each other: what is along them is theirs together.
                let mut of_runs = None;
                blocks.visit_filled_runs(&stride, point, |run| {
                    let nodes = &planes.nodes[run.first..run.first + run.weights.len()];
                    let (along, weights) = of_runs.get_or_insert_with(|| {
                        let mut along = run.weights.map(|weight| Levers { weight, gradient: 0.0 });
                        for (along, node) in along.iter_mut().zip(nodes) {
                            *along = levers(node, 0, along.weight);
                        }
                        (along, run.weights)
                    });
                    assert_eq!(*weights, run.weights, "a point whose weights are no product has no slopes");
                    // In the plane one direction goes across the run.
                    let other = (D > 1).then(|| levers(&nodes[0], D - 1, run.across[0]));
                    for (k, (weight, gradient)) in run.weights.iter().zip(&run.gradients).enumerate() {
                        let along = along[k];
                        let mut means = [[0.0; D]; D];
                        means[0][0] = along.gradient * run.across[0];
                        if let Some(other) = other {
                            means[0][D - 1] = along.weight * run.across[D - 1];
                            means[D - 1][0] = other.weight * gradient;
                            means[D - 1][D - 1] = other.gradient * weight;
                        }
                        let [_, _, mixture, water] = &mut sums[run.first + k];
                        for d in 0..D {
                            for e in 0..D {
                                for c in 0..D {
                                    mixture[c] += means[d][e] * given[d].effective[c][e];
                                }
                                water[e] += means[d][e] * given[d].pressure;
                            }
                        }
                    }
                });
            }
        });
        self.stress_planes = Some(planes);
    }
}

/// What slopes give to the mixture, `(p I − σ') V`, and to the water, `p V`, over a distance.
#[inline]
fn given_by<const D: usize>(slopes: &[Stresses<D>; D], volume: f64) -> [Stresses<D>; D] {
    slopes.map(|slope| {
        let pressure = volume * slope.pressure;
        let mut effective = slope.effective;
        for c in 0..D {
            for e in 0..D {
                effective[c][e] *= -volume;
            }
            effective[c][c] += pressure;
        }
        Stresses { effective, pressure }
    })
}

#[cfg(test)]
mod tests;
