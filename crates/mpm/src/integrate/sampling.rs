//! Samples of a body at points, cell centres and nodes.

use crate::kernel::body::Body;
use crate::state::points::Points;
use oedometer_problem::snapshot::{PlaneSamples, Samples, Snapshot, Totals};
use oedometer_soil::tensor::{Vector, dot};

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
