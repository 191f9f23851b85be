//! Porosities, domains and operators of the water points, taken from the soil at their new places.

use crate::integrate::double_point::DoublePoint;
use crate::operators::basis::Shapes;
use oedometer_soil::elementary;

/// Share of a domain that is too little to stand alone.
const LEAST_SHARE: f64 = 1e-3;

impl<const D: usize> DoublePoint<D> {
    /// Updates porosities, volumes and domains of the water to the soil, and the operators to the domains.
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
    use crate::tests::double_point_columns::moving_column;
    use oedometer_problem::settings::{Drag, ExplicitSettings};
    use oedometer_soil::material::Material;

    #[test]
    fn a_water_point_has_the_volume_of_the_pores_at_its_place() {
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
            // The change of a pressure over its domain stays as the domain stretches.
            let change = water.slope[point][0] * water.half_length[point][0];
            assert!((change / (3e4 * halves[point][0]) - 1.0).abs() < 1e-12, "{change}");
        }
        assert!(water.volume[0] / water.volume[9] > 1.15, "{:?}", water.volume);
    }

    #[test]
    fn a_point_above_the_surface_is_removed_with_all_its_fields() {
        let mut double = moving_column::<1>("GIMP", [2, 2], 1.0, &Material::default());
        for point in 0..double.water.len() {
            // No two masses and velocities are alike.
            double.water.mass[point] *= 1.0 + 1e-3 * point as f64;
            double.water.velocity[point] = [point as f64];
        }
        let (masses, total) = (double.water.mass.clone(), double.water.mass.iter().sum::<f64>());
        let height = double.body.grid.cell_size * 5.0;
        double.water.position[3] = [height + 3.0 * double.water.half_length[3][0]];
        double.follow_water();
        let water = &double.water;
        assert_eq!(water.len(), masses.len() - 1);
        assert!((water.left_mass - masses[3]).abs() < 1e-12 * masses[3], "{}", water.left_mass);
        let stay: Vec<usize> = (0..masses.len()).filter(|point| *point != 3).collect();
        let is_unchanged = |(here, before): (usize, &usize)| {
            water.mass[here] == masses[*before] && water.velocity[here] == [*before as f64]
        };
        assert!(stay.iter().enumerate().all(is_unchanged), "{:?} {:?}", water.mass, water.velocity);
        assert!((water.mass.iter().sum::<f64>() + water.left_mass - total).abs() < 1e-12 * total);
        let places = [&water.position, &water.half_length, &water.slope, &water.place, &water.reach];
        assert!(places.iter().all(|field| field.len() == water.len()));
        let numbers = [&water.pressure, &water.porosity, &water.volume, &water.share];
        assert!(numbers.iter().all(|field| field.len() == water.len()));
    }

    /// Water domains keep their axes. That is right where those of the skeleton do: in the only scene in which two
    /// sets move, a column.
    #[test]
    fn domains_of_a_plane_column_of_two_sets_do_not_turn() {
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
