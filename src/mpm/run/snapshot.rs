//! The state of a body at one time, sampled at points, cell centres and nodes.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::state::points::Points;
use crate::soil::tensor::Vector;
use serde::{Deserialize, Serialize};

/// Fields at one kind of places. Stresses and displacements are the vertical ones; in two
/// dimensions the places along the layer and the horizontal displacements stand beside them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// Initial height of each place above the base, m.
    pub initial_height: Vec<f64>,
    /// Initial height of the places of the displacement, m, where they are not the same.
    pub displacement_height: Option<Vec<f64>>,
    /// Volume that each place stands for, m^D.
    pub volume: Vec<f64>,
    /// Pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, Pa, tension positive.
    pub effective_stress: Vec<f64>,
    /// Vertical displacement of the skeleton, m, upward positive.
    pub displacement: Vec<f64>,
    /// What a second dimension adds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneSamples>,
}

/// What the samples of two dimensions have beside those of a column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlaneSamples {
    /// Initial distance of each place along the layer, m.
    pub initial_distance: Vec<f64>,
    /// Initial distance of the places of the displacement, m, where they are not the same.
    pub displacement_distance: Option<Vec<f64>>,
    /// Horizontal displacement of the skeleton, m.
    pub horizontal_displacement: Vec<f64>,
}

/// State at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// Settlement of the loaded surface, m.
    pub settlement: f64,
    /// Values at the material points.
    pub points: Samples,
    /// Volume-weighted means over the points of each cell, at their mean initial place.
    pub centres: Samples,
    /// Values projected to the nodes with weights times volume, at the mean initial place that
    /// belongs to the projection: a linear field is exact at boundary nodes too.
    pub nodes: Samples,
    /// Mass and momentum at this time.
    pub totals: Totals,
}

/// Conserved quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Volume of the mixture, m^D.
    pub volume: f64,
    /// Mass of the grains as the grid sees it, kg: what a point outside its weights would lose.
    pub solid_mass: f64,
    /// Volume of mixture that passed the loaded surface since the start,
    /// `∫ v_s + n(v_w − v_s) dt`, m a unit area.
    pub surface_flux: f64,
    /// Expansion of the pore water since the start, `Σ n V (p_0 − p)/K_w`, m^D. Continuity says
    /// that it is what passed the surface.
    pub water_expansion: f64,
    /// Sum of the internal forces on all nodes over the sum of their sizes: zero to round-off by
    /// the partition of unity.
    pub internal_force_imbalance: f64,
    /// Largest force on a free node that nothing balances, N.
    pub unbalanced_force: f64,
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Body<D, W, S> {
    /// Samples the body at `time`; water is balanced against the points of the `start`.
    pub fn snapshot(&self, time: f64, settlement: f64, start: &Points<D>) -> Snapshot {
        Snapshot {
            time,
            settlement,
            points: self.sample_points(),
            centres: self.sample_centres(),
            nodes: self.sample_nodes(),
            totals: self.totals(start),
        }
    }

    fn sample_points(&self) -> Samples {
        let points = &self.points;
        let count = points.len();
        let vertical = |field: &[Vector<D>]| field.iter().map(|vector| vector[D - 1]).collect();
        let horizontal = |field: &[Vector<D>]| field.iter().map(|vector| vector[0]).collect();
        Samples {
            initial_height: vertical(&points.initial_position),
            displacement_height: None,
            volume: (0..count).map(|point| points.volume(point)).collect(),
            pressure: points.pressure.clone(),
            effective_stress: points.effective_stress.iter().map(|stress| stress[D - 1][D - 1]).collect(),
            displacement: vertical(&points.displacement),
            plane: (D > 1).then(|| PlaneSamples {
                initial_distance: horizontal(&points.initial_position),
                displacement_distance: None,
                horizontal_displacement: horizontal(&points.displacement),
            }),
        }
    }

    fn sample_centres(&self) -> Samples {
        let mut means = Means::new(self.grid.cell_count());
        for point in 0..self.points.len() {
            let cell = self.grid.flat_cell(&self.grid.cell_of(&self.points.position[point]));
            self.add_point(&mut means, cell, point, 1.0);
        }
        means.finish(D)
    }

    fn sample_nodes(&self) -> Samples {
        let mut means = Means::new(self.nodes.len());
        for point in 0..self.points.len() {
            self.basis.visit(self.grid.node_stride(), point, |node, weight, _| {
                self.add_point(&mut means, node, point, weight);
            });
        }
        if S::PASSES_WALLS {
            // Splines reach to nodes that lie outside the body, where no exact field is.
            let mut inside = vec![false; self.nodes.len()];
            for cell in self.cells.occupied() {
                self.grid.corners(self.cells.first_node(cell)).for_each(|node| inside[node] = true);
            }
            for node in (0..inside.len()).filter(|node| !inside[*node]) {
                means.volume[node] = 0.0;
            }
        }
        let mut samples = means.finish(D);
        if !self.configuration.moves_points() {
            // The nodes' own displacement is known, and better than any projection.
            let least = means.least_volume();
            let places = || (0..self.nodes.len()).filter(|node| means.volume[*node] > least);
            samples.displacement = places().map(|node| self.displacement_at_node(node)[D - 1]).collect();
            samples.displacement_height =
                Some(places().map(|node| self.grid.node_position(node)[D - 1]).collect());
            if let Some(plane) = &mut samples.plane {
                plane.horizontal_displacement =
                    places().map(|node| self.displacement_at_node(node)[0]).collect();
                plane.displacement_distance =
                    Some(places().map(|node| self.grid.node_position(node)[0]).collect());
            }
        }
        samples
    }

    fn add_point(&self, means: &mut Means, place: usize, point: usize, weight: f64) {
        let share = weight * self.points.volume(point);
        let height = self.points.initial_position[point][D - 1];
        means.volume[place] += share;
        means.height[place] += share * height;
        means.pressure[place] += share * self.points.pressure[point];
        means.effective_stress[place] += share * self.points.effective_stress[point][D - 1][D - 1];
        means.displacement[place] += share * self.points.displacement[point][D - 1];
        if D > 1 {
            means.distance[place] += share * self.points.initial_position[point][0];
            means.horizontal_displacement[place] += share * self.points.displacement[point][0];
        }
    }

    fn totals(&self, start: &Points<D>) -> Totals {
        let soil = &self.material;
        let count = self.points.len();
        let pore_volume = |point: usize| start.volume(point) * soil.porosity_at(start.volume_ratio[point]);
        Totals {
            volume: (0..count).map(|point| self.points.volume(point)).sum(),
            solid_mass: self.nodes.solid_mass.iter().sum(),
            surface_flux: self.surface_flux,
            water_expansion: (0..count)
                .map(|point| pore_volume(point) * (start.pressure[point] - self.points.pressure[point]))
                .sum::<f64>()
                / soil.water_bulk_modulus,
            internal_force_imbalance: self.internal_force_imbalance(),
            unbalanced_force: self.unbalanced_force(),
        }
    }

    fn unbalanced_force(&self) -> f64 {
        let mut body = self.clone();
        body.map_forces();
        let forces = body.nodes.mixture_force.iter().flatten().zip(body.nodes.free.iter().flatten());
        forces.fold(0.0, |largest: f64, (force, free)| largest.max((force * free).abs()))
    }

    fn internal_force_imbalance(&self) -> f64 {
        let (mut sum, mut size) = ([0.0; D], 0.0);
        for point in 0..self.points.len() {
            let volume = self.points.volume(point);
            self.basis.visit(self.grid.node_stride(), point, |_, _, gradient| {
                for d in 0..D {
                    let stress = self.points.effective_stress[point][d][d] - self.points.pressure[point];
                    sum[d] += volume * stress * gradient[d];
                    size += (volume * stress * gradient[d]).abs();
                }
            });
        }
        let largest = sum.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if size > 0.0 { largest / size } else { 0.0 }
    }
}

/// Volume-weighted means over the points that belong to a place.
struct Means {
    volume: Vec<f64>,
    height: Vec<f64>,
    pressure: Vec<f64>,
    effective_stress: Vec<f64>,
    displacement: Vec<f64>,
    distance: Vec<f64>,
    horizontal_displacement: Vec<f64>,
}

impl Means {
    fn new(places: usize) -> Self {
        let zero = vec![0.0; places];
        Self {
            volume: zero.clone(),
            height: zero.clone(),
            pressure: zero.clone(),
            effective_stress: zero.clone(),
            displacement: zero.clone(),
            distance: zero.clone(),
            horizontal_displacement: zero,
        }
    }

    /// Places with less volume than this hold a ghost of a point.
    fn least_volume(&self) -> f64 {
        1e-12 * self.volume.iter().copied().fold(0.0, f64::max)
    }

    fn finish(&self, dimensions: usize) -> Samples {
        let least = self.least_volume();
        let places: Vec<usize> = (0..self.volume.len()).filter(|place| self.volume[*place] > least).collect();
        let mean = |sum: &[f64]| places.iter().map(|place| sum[*place] / self.volume[*place]).collect();
        Samples {
            initial_height: mean(&self.height),
            displacement_height: None,
            volume: places.iter().map(|place| self.volume[*place]).collect(),
            pressure: mean(&self.pressure),
            effective_stress: mean(&self.effective_stress),
            displacement: mean(&self.displacement),
            plane: (dimensions > 1).then(|| PlaneSamples {
                initial_distance: mean(&self.distance),
                displacement_distance: None,
                horizontal_displacement: mean(&self.horizontal_displacement),
            }),
        }
    }
}
