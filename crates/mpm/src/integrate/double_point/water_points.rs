//! The points of the water in double-point MPM: they carry its mass and its pressure, and move with it. Their porosity is
//! that of the soil where they are, and their domains are as large as the pores that their mass fills.
//!
//! ```text
//! n_w = Σ_i N_iw n_i / Σ_i N_iw       V_w = m_w/(ρ_w(p) n_w),   ρ_w = ρ_w0 exp(p/K_w)
//! ```
//!
//! over the nodes with soil. Water stands still above the soil while the soil sinks under it: only the share of a
//! domain that lies below the surface of the soil counts, and a point without one is out.

use crate::integrate::double_point::DoublePoint;
use crate::state::points::Points;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector};

/// State of the water points, structure of arrays; index = point. A point that has left the soil is taken out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaterPoints<const D: usize> {
    /// Mass of the water, for ever, kg.
    pub mass: Vec<f64>,
    /// Middle of the whole domain, m.
    pub position: Vec<Vector<D>>,
    /// Half-lengths of the whole domain, m.
    pub half_length: Vec<Vector<D>>,
    /// Velocity of the water, m/s.
    pub velocity: Vec<Vector<D>>,
    /// Excess pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
    /// Slope of the pressure over the domain, Pa/m; zero where points know no more than their cell's pressure.
    pub slope: Vec<Vector<D>>,
    /// Porosity of the soil there.
    pub porosity: Vec<f64>,
    /// Volume of soil whose pores the water fills, of the whole domain, m^D.
    pub volume: Vec<f64>,
    /// Share of the domain that lies below the surface of the soil: only that counts.
    pub share: Vec<f64>,
    /// Middle of that share, m.
    pub place: Vec<Vector<D>>,
    /// Its half-lengths, m.
    pub reach: Vec<Vector<D>>,
    /// Mass of the points that have left, kg.
    pub left_mass: f64,
}

impl<const D: usize> WaterPoints<D> {
    /// The water in the pores of a lattice: its pressures and velocities, and where points move, displaced by a
    /// uniform gradient with the soil.
    pub fn of(lattice: &Points<D>, soil: &Material, gradient: Option<&Tensor<D>>) -> Self {
        let (mut position, mut half_length) = (lattice.position.clone(), lattice.half_length.clone());
        let mut stretch = 1.0;
        if let Some(gradient) = gradient {
            for (place, half) in position.iter_mut().zip(&mut half_length) {
                let before = *place;
                for d in 0..D {
                    place[d] += (0..D).map(|e| gradient[d][e] * before[e]).sum::<f64>();
                    half[d] *= 1.0 + gradient[d][d];
                }
            }
            stretch = (0..D).map(|d| 1.0 + gradient[d][d]).product();
        }
        let initial = &lattice.initial_volume;
        Self {
            mass: initial.iter().map(|volume| soil.porosity * soil.water_density * volume).collect(),
            velocity: lattice.water_velocity.clone(),
            pressure: lattice.pressure.clone(),
            slope: vec![[0.0; D]; lattice.len()],
            porosity: vec![soil.porosity_at(stretch); lattice.len()],
            volume: initial.iter().map(|volume| stretch * volume).collect(),
            share: vec![1.0; lattice.len()],
            place: position.clone(),
            reach: half_length.clone(),
            position,
            half_length,
            left_mass: 0.0,
        }
    }

    /// Number of points in the soil.
    #[inline]
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Takes a point out that has left the soil; the order of the others stays.
    pub fn remove(&mut self, point: usize) {
        self.left_mass += self.mass.remove(point);
        for field in [&mut self.position, &mut self.half_length, &mut self.velocity] {
            field.remove(point);
        }
        for field in [&mut self.place, &mut self.reach, &mut self.slope] {
            field.remove(point);
        }
        for field in [&mut self.pressure, &mut self.porosity, &mut self.volume, &mut self.share] {
            field.remove(point);
        }
    }

    /// Volume of soil below the surface that a point's water fills, m^D.
    #[inline]
    pub fn volume_inside(&self, point: usize) -> f64 {
        self.volume[point] * self.share[point]
    }

    /// Mass of its water there, kg.
    #[inline]
    pub fn mass_inside(&self, point: usize) -> f64 {
        self.mass[point] * self.share[point]
    }

    /// Volume of the water below the surface, m^D, and pressure, Pa, of every point.
    pub fn volumes_and_pressures(&self) -> impl Iterator<Item = (f64, f64)> {
        (0..self.len()).map(|point| (self.porosity[point] * self.volume_inside(point), self.pressure[point]))
    }
}

/// Share of a domain that is too little to stand alone.
const LEAST_SHARE: f64 = 1e-3;

impl<const D: usize> DoublePoint<D> {
    /// Brings porosities, volumes and domains of the water up to the soil, and the operators up to the domains.
    pub fn follow_water(&mut self) {
        self.take_porosities();
        self.take_domains();
        self.build_water_operators();
    }

    /// Porosity at every point by its last weights; a point that no node with soil knows keeps its own.
    fn take_porosities(&mut self) {
        let (stride, nodes) = (*self.body.grid.node_stride(), &self.body.nodes);
        for (point, porosity) in self.water.porosity.iter_mut().enumerate() {
            let (mut sum, mut weights) = (0.0, 0.0);
            self.basis.visit(&stride, point, |node, weight, _| {
                if nodes.is_active(node) {
                    sum += weight * nodes.porosity[node];
                    weights += weight;
                }
            });
            if weights > 0.0 {
                *porosity = sum / weights;
            }
        }
    }

    /// Volumes and domains, cut at the surface.
    fn take_domains(&mut self) {
        let (soil, up) = (self.body.material, D - 1);
        let lowest_surface = self.body.actions.surface.lowest(&self.body.points);
        let water = &mut self.water;
        let mut point = 0;
        while point < water.len() {
            let density =
                soil.water_density * elementary::exp(water.pressure[point] / soil.water_bulk_modulus);
            let volume = water.mass[point] / (density * water.porosity[point]);
            let across: f64 = water.half_length[point][..up].iter().map(|half| 2.0 * half).product();
            let half = 0.5 * volume / across;
            water.volume[point] = volume;
            // An oedometer strains vertically only, and so does its water; a slope stretches with the domain.
            water.slope[point][up] *= water.half_length[point][up] / half;
            water.half_length[point][up] = half;
            water.place[point] = water.position[point];
            water.reach[point] = water.half_length[point];
            water.share[point] = 1.0;
            let (low, high) = (water.position[point][up] - half, water.position[point][up] + half);
            if high > lowest_surface {
                let surface =
                    self.body.actions.surface.height_over(&self.body.points, &water.position[point]);
                let kept = high.min(surface) - low;
                if kept < 2.0 * half * LEAST_SHARE {
                    water.remove(point);
                    continue;
                }
                water.share[point] = kept / (2.0 * half);
                water.place[point][up] = low + 0.5 * kept;
                water.reach[point][up] = 0.5 * kept;
            }
            point += 1;
        }
    }

    /// Builds weights and recovery of the water points on their places.
    pub(crate) fn build_water_operators(&mut self) {
        let (body, water) = (&self.body, &self.water);
        let slivers = &self.slivers;
        self.cells.locate_among(&body.grid, &water.place, &body.cells, |cell| {
            slivers.close(&body.grid, body.cells.first_node(cell))
        });
        if self.takes_means {
            self.cells.keep_located(&water.volume, &water.share);
        }
        let places = [&self.cells.place[..], &water.reach[..]];
        body.method.basis.build(&mut self.basis, &body.grid, &body.support(), places);
        self.recovery.build(&body.grid, &self.cells);
        if self.keeps_cell_rates {
            self.take_middles();
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::{Drag, ExplicitSettings};
    use crate::tests::double_point_columns::moving_column;
    use oedometer_soil::material::Material;

    #[test]
    fn a_water_point_is_as_large_as_the_pores_it_fills_where_it_is() {
        let soil = Material::default();
        let mut double = moving_column::<1>("GIMP", [2, 2], 1.0, &soil);
        double.water.slope.fill([3e4]);
        let halves = double.water.half_length.clone();
        // Soil that lost a sixth of its pores below, and none of them on top.
        let height = double.body.grid.cell_size * 5.0;
        let porosity = |place: f64| soil.porosity * (1.0 + 0.2 * (place / height - 1.0));
        for node in 0..double.body.nodes.len() {
            double.body.nodes.porosity[node] = porosity(double.body.grid.node_position(node)[0]);
        }
        double.follow_water();
        let water = &double.water;
        for point in 0..water.len() {
            // Constant density: the pressure of the start is that of the load, a part in ten thousand of K_w.
            let pores = water.mass[point] / soil.water_density;
            let volume = pores / porosity(water.position[point][0]);
            assert!((water.volume[point] / volume - 1.0).abs() < 1e-2, "{point}: {}", water.volume[point]);
            assert!((2.0 * water.half_length[point][0] / volume - 1.0).abs() < 1e-2);
            // What a pressure changes by over its domain stays as the domain stretches.
            let change = water.slope[point][0] * water.half_length[point][0];
            assert!((change / (3e4 * halves[point][0]) - 1.0).abs() < 1e-12, "{change}");
        }
        assert!(water.volume[0] / water.volume[9] > 1.15, "{:?}", water.volume);
    }

    #[test]
    fn a_point_above_the_surface_leaves_with_all_that_is_its_own() {
        let mut double = moving_column::<1>("GIMP", [2, 2], 1.0, &Material::default());
        for point in 0..double.water.len() {
            // No two masses and velocities are alike.
            double.water.mass[point] *= 1.0 + 1e-3 * point as f64;
            double.water.velocity[point] = [point as f64];
        }
        let (masses, whole) = (double.water.mass.clone(), double.water.mass.iter().sum::<f64>());
        let height = double.body.grid.cell_size * 5.0;
        double.water.position[3] = [height + 3.0 * double.water.half_length[3][0]];
        double.follow_water();
        let water = &double.water;
        assert_eq!(water.len(), masses.len() - 1);
        assert!((water.left_mass - masses[3]).abs() < 1e-12 * masses[3], "{}", water.left_mass);
        let stay: Vec<usize> = (0..masses.len()).filter(|point| *point != 3).collect();
        let is_their_own = |(here, before): (usize, &usize)| {
            water.mass[here] == masses[*before] && water.velocity[here] == [*before as f64]
        };
        assert!(stay.iter().enumerate().all(is_their_own), "{:?} {:?}", water.mass, water.velocity);
        assert!((water.mass.iter().sum::<f64>() + water.left_mass - whole).abs() < 1e-12 * whole);
        let places = [&water.position, &water.half_length, &water.slope, &water.place, &water.reach];
        assert!(places.iter().all(|field| field.len() == water.len()));
        let numbers = [&water.pressure, &water.porosity, &water.volume, &water.share];
        assert!(numbers.iter().all(|field| field.len() == water.len()));
    }

    /// Water domains keep their axes. That is right where those of the skeleton do: in the only scene in which two
    /// sets move, a column.
    #[test]
    fn nothing_turns_where_two_sets_move_in_the_plane() {
        let soil = Material { hydraulic_conductivity: 1e-3, ..Material::default() };
        let mut double = moving_column::<2>("CPDI-SRI-patch", [2, 2], 2e5, &soil);
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        for _ in 0..300 {
            double.kick_and_drift(4e-5, 4e-5, &settings);
        }
        let domains = double.body.operators.domains.as_ref().expect("domains that could turn");
        let settled = double.body.settlement(1.0);
        assert!(settled > 1e-4, "{settled}");
        for [along, up] in &domains.half_edges {
            let turned = along[1].abs().max(up[0].abs());
            assert!(turned < 1e-12 * along[0], "{along:?} {up:?}");
        }
        // Each reaches as far across as the skeleton's.
        let widths = double.water.half_length.iter().map(|half| half[0]);
        for (width, [along, _]) in widths.zip(&domains.half_edges) {
            assert!((width / along[0] - 1.0).abs() < 1e-12, "{width} {along:?}");
        }
    }
}
