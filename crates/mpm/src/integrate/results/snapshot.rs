//! The state of a body at one time, sampled at points, cell centres and nodes.

use crate::kernel::body::Body;
use crate::state::points::Points;
use oedometer_soil::tensor::{Vector, dot};
use serde::{Deserialize, Serialize};

/// Fields at one kind of places. Stresses and displacements are the vertical ones; in two
/// dimensions the places along the layer and the horizontal displacements stand beside them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Samples {
    /// Initial height of each place above the base, m.
    pub initial_height: Vec<f64>,
    /// Initial height of the places of the displacement, m, where they are not the same.
    pub displacement_height: Option<Vec<f64>>,
    /// Volume that each place stands for, m^D.
    pub volume: Vec<f64>,
    /// Excess pore pressure, Pa, compression positive: without the hydrostatic one where the soil has a weight.
    pub pressure: Vec<f64>,
    /// Vertical effective stress, Pa, tension positive.
    pub effective_stress: Vec<f64>,
    /// Vertical displacement of the skeleton, m, upward positive.
    pub displacement: Vec<f64>,
    /// Components along the layer, in two dimensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneSamples>,
    /// Samples of the water points; `pressure` is then that of the nearest of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub water: Option<WaterSamples>,
}

impl Samples {
    /// Pressures, Pa, and the volumes that they stand for, m^D: of the water's own points where there are such.
    pub fn pressures(&self) -> (&[f64], &[f64]) {
        match &self.water {
            Some(water) => (&water.pressure, &water.volume),
            None => (&self.pressure, &self.volume),
        }
    }
}

/// The pressure where the water has points of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WaterSamples {
    /// Initial height above the base of the soil that is there now, m.
    pub initial_height: Vec<f64>,
    /// Its initial distance along the layer, m, in two dimensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_distance: Option<Vec<f64>>,
    /// Volume that each place stands for, m^D.
    pub volume: Vec<f64>,
    /// Pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
}

/// Components along the layer, which samples of two dimensions have beside those of a column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PlaneSamples {
    /// Initial distance of each place along the layer, m.
    pub initial_distance: Vec<f64>,
    /// Initial distance of the places of the displacement, m, where they are not the same.
    pub displacement_distance: Option<Vec<f64>>,
    /// Horizontal displacement of the skeleton, m.
    pub horizontal_displacement: Vec<f64>,
}

/// State at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// Settlement of the loaded surface, m. The result of another program may have none: then it is no number,
    /// and left out on disk.
    #[serde(default = "unknown", skip_serializing_if = "is_unknown")]
    pub settlement: f64,
    /// Force, N, upward positive, of the soil on a plate that is pushed into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate_force: Option<f64>,
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

fn unknown() -> f64 {
    f64::NAN
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_unknown(value: &f64) -> bool {
    value.is_nan()
}

/// Conserved quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
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
    /// Largest nodal velocity of either phase, m/s.
    #[serde(default)]
    pub largest_velocity: f64,
    /// Pores and water, where both are counted apart: in double-point MPM, where points move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub double_point: Option<WaterTotals>,
}

/// Pores and water of double-point MPM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WaterTotals {
    /// Volume of the pores, `Σ n_s V_s`, m^D.
    pub pore_volume: f64,
    /// Volume of the water in the soil, `Σ m_w/ρ_w`, m^D.
    pub water_volume: f64,
    /// Share of the water's mass that has left the soil.
    pub water_left: f64,
    /// Water points that are in the soil still.
    pub water_points: usize,
    /// Largest size of the pressure of any water point since the start, between outputs too, Pa.
    #[serde(default)]
    pub largest_pressure: f64,
}

impl<const D: usize> Body<D> {
    /// Settlement, m, of the loaded surface, which was at `initial_height`, or of the rigid plate.
    pub fn settlement(&self, initial_height: f64) -> f64 {
        if self.actions.plate.is_some() {
            let moved = |(node, weight): &(usize, Vector<D>)| dot(weight, &self.nodes.displacement[*node]);
            -self.settling_weights().iter().map(moved).sum::<f64>()
        } else if self.configuration.moves_points() {
            initial_height - self.actions.surface.height(&self.points)
        } else {
            -self.actions.surface.amplitude_of(&self.grid, &self.points, &self.nodes.displacement)
        }
    }

    /// Samples the body at `time`; water is balanced against the points of the `start`.
    pub fn snapshot(&self, time: f64, settlement: f64, start: &Points<D>) -> Snapshot {
        let in_excess = self.in_excess();
        let body = in_excess.as_ref().unwrap_or(self);
        Snapshot {
            time,
            settlement,
            plate_force: None,
            points: body.sample_points(),
            centres: body.sample_centres(),
            nodes: body.sample_nodes(),
            totals: self.totals(start),
        }
    }

    fn sample_points(&self) -> Samples {
        let points = &self.points;
        let count = points.len();
        let volumes = (0..count).map(|point| points.volume(point)).collect();
        samples_of(points, volumes, &|value| (0..count).map(value).collect())
    }

    fn sample_centres(&self) -> Samples {
        let mut means = Means::new(self.grid.cell_count());
        for (point, position) in self.points.position.iter().enumerate() {
            means.add(self.grid.flat_cell(&self.grid.cell_of(position)), point, self.points.volume(point));
        }
        means.sample(&self.points)
    }

    fn sample_nodes(&self) -> Samples {
        let mut means = Means::new(self.nodes.len());
        for point in 0..self.points.len() {
            self.operators.basis.visit(self.grid.node_stride(), point, |node, weight, _| {
                means.add(node, point, weight * self.points.volume(point));
            });
        }
        if self.method.basis.is_spline() {
            // Splines reach to nodes that lie outside the body, where no exact field is.
            let mut inside = vec![false; self.nodes.len()];
            for cell in self.cells.occupied() {
                self.grid.corners(self.cells.first_node(cell)).for_each(|node| inside[node] = true);
            }
            for node in (0..inside.len()).filter(|node| !inside[*node]) {
                means.volume[node] = 0.0;
            }
        }
        let mut samples = means.sample(&self.points);
        if !self.configuration.moves_points() {
            // The nodes' own displacement is known, and better than any projection.
            let places = means.places();
            let displacement =
                |d: usize| places.iter().map(|node| self.displacement_at_node(*node)[d]).collect();
            let position = |d: usize| places.iter().map(|node| self.grid.node_position(*node)[d]).collect();
            samples.displacement = displacement(D - 1);
            samples.displacement_height = Some(position(D - 1));
            if let Some(plane) = &mut samples.plane {
                plane.horizontal_displacement = displacement(0);
                plane.displacement_distance = Some(position(0));
            }
        }
        samples
    }

    fn totals(&self, start: &Points<D>) -> Totals {
        let count = self.points.len();
        let compliance = |point: usize| {
            let soil = self.soil_of(point);
            let share = self.material.water_bulk_modulus / soil.water_bulk_modulus;
            start.volume(point) * soil.porosity_at(start.volume_ratio[point]) * share
        };
        Totals {
            volume: (0..count).map(|point| self.points.volume(point)).sum(),
            solid_mass: self.nodes.solid_mass.iter().sum(),
            surface_flux: self.surface_flux,
            water_expansion: (0..count)
                .map(|point| compliance(point) * (start.pressure[point] - self.points.pressure[point]))
                .sum::<f64>()
                / self.material.water_bulk_modulus,
            internal_force_imbalance: self.internal_force_imbalance(),
            unbalanced_force: self.unbalanced_force(),
            double_point: None,
            largest_velocity: self.largest_velocity(),
        }
    }

    fn internal_force_imbalance(&self) -> f64 {
        let mut forces = InternalForces::default();
        for point in 0..self.points.len() {
            let (volume, stress) = (self.points.volume(point), &self.points.effective_stress[point]);
            let total = std::array::from_fn(|d| volume * (stress[d][d] - self.points.pressure[point]));
            self.operators
                .basis
                .visit(self.grid.node_stride(), point, |_, _, gradient| forces.add(&total, gradient));
        }
        forces.imbalance()
    }
}

/// Sum of the internal forces on all nodes, N, and the sum of their sizes.
#[derive(Default)]
pub(crate) struct InternalForces {
    sum: [f64; 2],
    size: f64,
}

impl InternalForces {
    /// Adds the force on a node of normal stresses times the volume that they act in, by the gradient there.
    pub fn add<const D: usize>(&mut self, stresses: &Vector<D>, gradient: &Vector<D>) {
        for d in 0..D {
            let force = stresses[d] * gradient[d];
            self.sum[d] += force;
            self.size += force.abs();
        }
    }

    /// The first over the second: zero to round-off by the partition of unity.
    pub fn imbalance(&self) -> f64 {
        let largest = self.sum.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if self.size > 0.0 { largest / self.size } else { 0.0 }
    }
}

/// Volume-weighted means over the points that belong to a place.
pub(crate) struct Means {
    /// Volume of each place.
    volume: Vec<f64>,
    /// Place, point and volume that they share.
    shares: Vec<(usize, usize, f64)>,
}

impl Means {
    /// Means at `places` places, without points yet.
    pub fn new(places: usize) -> Self {
        Self { volume: vec![0.0; places], shares: Vec::new() }
    }

    /// Gives a place a volume of a point, m^D.
    pub fn add(&mut self, place: usize, point: usize, volume: f64) {
        self.volume[place] += volume;
        self.shares.push((place, point, volume));
    }

    /// Places with more than a negligible volume of points.
    fn places(&self) -> Vec<usize> {
        let least = 1e-12 * self.volume.iter().copied().fold(0.0, f64::max);
        (0..self.volume.len()).filter(|place| self.volume[*place] > least).collect()
    }

    /// Volumes of the places, m^D.
    pub fn volumes(&self) -> Vec<f64> {
        self.places().into_iter().map(|place| self.volume[place]).collect()
    }

    /// Averages of a value of the points at each place, weighted by volume.
    pub fn average(&self, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.volume.len()];
        for (place, point, volume) in &self.shares {
            sums[*place] += volume * value(*point);
        }
        self.places().into_iter().map(|place| sums[place] / self.volume[place]).collect()
    }

    fn sample<const D: usize>(&self, points: &Points<D>) -> Samples {
        samples_of(points, self.volumes(), &|value| self.average(value))
    }
}

/// Lists for some places what each point has.
type List<'a> = &'a dyn Fn(&dyn Fn(usize) -> f64) -> Vec<f64>;

/// Samples at places of given volumes, m^D, with what is listed for them.
fn samples_of<const D: usize>(points: &Points<D>, volume: Vec<f64>, list: List<'_>) -> Samples {
    Samples {
        initial_height: list(&|point| points.initial_position[point][D - 1]),
        volume,
        pressure: list(&|point| points.pressure[point]),
        effective_stress: list(&|point| points.effective_stress[point][D - 1][D - 1]),
        displacement: list(&|point| points.displacement[point][D - 1]),
        plane: (D > 1).then(|| PlaneSamples {
            initial_distance: list(&|point| points.initial_position[point][0]),
            displacement_distance: None,
            horizontal_displacement: list(&|point| points.displacement[point][0]),
        }),
        ..Samples::default()
    }
}
