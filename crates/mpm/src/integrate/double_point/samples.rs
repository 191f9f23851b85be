//! Snapshots of double-point MPM: the skeleton at its own points, the pressure at those of the water.

use crate::integrate::double_point::DoublePoint;
use crate::integrate::sampling::{InternalForces, Means};
use crate::kernel::loaded_body::largest_free_force;
use crate::state::points::Points;
use oedometer_problem::snapshot::{Snapshot, Totals, WaterSamples, WaterTotals};
use oedometer_soil::elementary;
use oedometer_soil::tensor::Vector;

impl<const D: usize> DoublePoint<D> {
    /// Samples both sets of points at `time`. Beside the skeleton's stress stands the pressure of the nearest water point; the
    /// pressures themselves, with the initial places of the soil that the water is in, are the water's samples.
    pub fn snapshot(&self, time: f64, settlement: f64, start: &Points<D>) -> Snapshot {
        let mut body = self.body.clone();
        for (place, pressure) in self.body.points.position.iter().zip(&mut body.points.pressure) {
            *pressure = self.pressure_near(place);
        }
        let mut snapshot = body.snapshot(time, settlement, start);
        let places: Vec<Vector<D>> = self.water.place.iter().map(|place| self.soil_at(place)).collect();
        let (grid, water) = (&self.body.grid, &self.water);
        let mut of_points = Means::new(water.len());
        let mut of_cells = Means::new(grid.cell_count());
        let mut of_nodes = Means::new(self.body.nodes.len());
        for (point, place) in water.place.iter().enumerate() {
            let volume = water.volume_inside(point);
            of_points.add(point, point, volume);
            of_cells.add(grid.flat_cell(&grid.cell_of(place)), point, volume);
            self.basis.visit(grid.node_stride(), point, |node, weight, _| {
                of_nodes.add(node, point, weight * volume);
            });
        }
        for (means, samples) in [
            (of_points, &mut snapshot.points),
            (of_cells, &mut snapshot.centres),
            (of_nodes, &mut snapshot.nodes),
        ] {
            samples.water = Some(WaterSamples {
                initial_height: means.average(&|point| places[point][D - 1]),
                initial_distance: (D > 1).then(|| means.average(&|point| places[point][0])),
                volume: means.volumes(),
                pressure: means.average(&|point| water.pressure[point]),
            });
        }
        snapshot.totals = self.totals(snapshot.totals);
        snapshot
    }

    /// Initial place of the soil that is at a place now, by the nearest point of the skeleton and its stretch: an
    /// oedometer strains vertically only.
    fn soil_at(&self, place: &Vector<D>) -> Vector<D> {
        let points = &self.body.points;
        let Some(point) = nearest(&points.position, &points.half_length, place) else { return *place };
        std::array::from_fn(|d| {
            let stretch = if d == D - 1 { points.volume_ratio[point] } else { 1.0 };
            points.initial_position[point][d] + (place[d] - points.position[point][d]) / stretch
        })
    }

    /// Pressure of the nearest water point, Pa; none where all have left.
    fn pressure_near(&self, place: &Vector<D>) -> f64 {
        let point = nearest(&self.water.place, &self.water.half_length, place);
        point.map_or(0.0, |point| self.water.pressure[point])
    }

    /// Volume by which the water in the soil is compressed, `Σ m_w p/(ρ_w0 K_w)`, m^D.
    pub(super) fn water_compression(&self) -> f64 {
        let (soil, water) = (&self.body.material, &self.water);
        let compressed = |point: usize| water.mass_inside(point) * water.pressure[point];
        (0..water.len()).map(compressed).sum::<f64>() / (soil.water_density * soil.water_bulk_modulus)
    }

    fn totals(&self, of_body: Totals) -> Totals {
        Totals {
            solid_mass: self.slivers.sum_without(&self.body.nodes.solid_mass),
            water_expansion: self.initial_compression - self.water_compression(),
            internal_force_imbalance: self.internal_force_imbalance(),
            unbalanced_force: self.unbalanced_force(),
            double_point: self.body.configuration.moves_points().then(|| self.water_totals()),
            ..of_body
        }
    }

    /// Pores, the water in them, and the water that has left.
    fn water_totals(&self) -> WaterTotals {
        let (soil, points, water) = (&self.body.material, &self.body.points, &self.water);
        let pores = |point: usize| points.volume(point) * soil.porosity_at(points.volume_ratio[point]);
        let inside: f64 = (0..water.len()).map(|point| water.mass_inside(point)).sum();
        let filled = |point: usize| {
            let density =
                soil.water_density * elementary::exp(water.pressure[point] / soil.water_bulk_modulus);
            water.mass_inside(point) / density
        };
        WaterTotals {
            pore_volume: (0..points.len()).map(pores).sum(),
            water_volume: (0..water.len()).map(filled).sum(),
            water_left: 1.0 - inside / self.initial_mass,
            water_points: water.len(),
            largest_pressure: self.largest_pressure,
        }
    }

    fn unbalanced_force(&self) -> f64 {
        let mut double = self.clone();
        double.map_forces();
        largest_free_force(&double.body.nodes)
    }

    /// Sum of the internal forces of both sets over the sum of their sizes: the shape functions of each are a partition
    /// of unity on whatever share of its domains counts.
    fn internal_force_imbalance(&self) -> f64 {
        let (points, water, stride) = (&self.body.points, &self.water, self.body.grid.node_stride());
        let mut forces = InternalForces::default();
        for (point, stress) in points.effective_stress.iter().enumerate() {
            let stress = std::array::from_fn(|d| points.volume(point) * stress[d][d]);
            self.body.operators.basis.visit(stride, point, |_, _, gradient| forces.add(&stress, gradient));
        }
        for (point, pressure) in water.pressure.iter().enumerate() {
            let stress = [-water.volume_inside(point) * pressure; D];
            self.basis.visit(stride, point, |_, _, gradient| forces.add(&stress, gradient));
        }
        forces.imbalance()
    }
}

/// The point whose domain is nearest to a place, by distances in half-lengths.
fn nearest<const D: usize>(
    positions: &[Vector<D>],
    half_lengths: &[Vector<D>],
    place: &Vector<D>,
) -> Option<usize> {
    let distance = |point: usize| {
        let apart = |d: usize| (positions[point][d] - place[d]) / half_lengths[point][d];
        (0..D).map(|d| apart(d) * apart(d)).sum::<f64>()
    };
    (0..positions.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
}
