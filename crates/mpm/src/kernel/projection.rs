//! Polynomial pressure projection (PPP): what stabilises a nodal pressure of the order of the velocities (Dohrmann & Bochev
//! 2004; in poromechanics White & Borja 2008, by material points Zhao & Choo 2020, Eqs 73–79; docs/theory.md, Eq. 41).
//!
//! ```text
//! V_j (n_j/K_w) ṗ_j + τ Σ_k P_jk ṗ_k = −Σ_p N_jp V_p (∇·f)_p,     P = Σ_p V_p (N_p − N̄_c)(N_p − N̄_c)ᵀ,
//! N̄_c = Σ_{p in c} V_p N_p / Σ_{p in c} V_p
//! ```
//!
//! `P` sees only what a pressure has beyond its mean over each cell: constants are free of it, a smooth field feels it with
//! the square of the cell size, and the checkerboard that no divergence sees feels it in full.

use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::kernel::body::Body;
use crate::operators::recovery::points_in_cells::points_in_cells;
use crate::operators::sparse_rows::entry_of;
use crate::time_limit::TimeLimit;

/// Rows of a matrix between sites.
pub type SiteRows = Vec<Vec<(usize, f64)>>;

impl<const D: usize> Body<D> {
    /// The nodes that carry a pressure of their own, and the site of each node.
    pub(crate) fn nodal_sites(&self) -> (Vec<usize>, Vec<Option<usize>>) {
        let mut site_of_node = vec![None; self.nodes.len()];
        for (site, node) in self.nodes.active.iter().enumerate() {
            site_of_node[*node] = Some(site);
        }
        (self.nodes.active.clone(), site_of_node)
    }

    /// Sites around a point with the values of their shape functions there.
    pub(crate) fn sites_around(&self, point: usize, site_of_node: &[Option<usize>]) -> Vec<(usize, f64)> {
        let around = points_in_cells!(self, self.operators.basis).around(point);
        around.into_iter().filter_map(|(node, value)| Some((site_of_node[node]?, value))).collect()
    }

    /// `τ P_jk/V_j` of each site, 1/Pa, with the parameter of each point's soil; nothing for a method without projection.
    pub(crate) fn projection_rows(&self, sites: &[usize], site_of_node: &[Option<usize>]) -> SiteRows {
        if !self.method.has_projection() {
            return Vec::new();
        }
        let mut rows: SiteRows = vec![Vec::new(); sites.len()];
        let mut add = |around: &[(usize, f64)], factor: f64| {
            for (row, value) in around {
                let factor = factor * value / self.nodes.volume[sites[*row]];
                for (column, other) in around {
                    *entry_of(&mut rows[*row], *column, 0.0) += factor * other;
                }
            }
        };
        let mut sums: Vec<(f64, Vec<(usize, f64)>)> = vec![(0.0, Vec::new()); self.grid.cell_count()];
        for point in 0..self.points.len() {
            let around = self.sites_around(point, site_of_node);
            let weight = self.points.volume(point) * self.method.projection_parameter(self.soil_of(point));
            add(&around, weight);
            let (total, sum) = &mut sums[self.cells.of_point[point]];
            *total += weight;
            for (site, value) in around {
                *entry_of(sum, site, 0.0) += weight * value;
            }
        }
        for (total, sum) in sums.iter().filter(|(total, _)| *total > 0.0) {
            add(sum, -1.0 / total);
        }
        rows
    }

    /// Makes of the increments at the nodes without projection, in `site_values`, those with it.
    pub(crate) fn project_site_values(&mut self) {
        if !self.method.has_projection() {
            return;
        }
        let (sites, site_of_node) = self.nodal_sites();
        let rows = self.projection_rows(&sites, &site_of_node);
        let Some(mut storage) = ProjectedStorage::from_body(self, &sites, &rows) else { return };
        let mut values: Vec<f64> = sites.iter().map(|node| self.site_values[*node]).collect();
        storage.project(&mut values);
        for (node, value) in sites.iter().zip(values) {
            self.site_values[*node] = value;
        }
    }
}

/// Factors of `I + τ Q V⁻¹ P`.
#[derive(Clone, Debug)]
pub struct ProjectedStorage(Factors);

impl ProjectedStorage {
    /// The storage of a body at the nodes that are its sites, from its [`Body::projection_rows`]; `None` if there are no
    /// such rows.
    pub(crate) fn from_body<const D: usize>(
        body: &Body<D>,
        sites: &[usize],
        rows: &SiteRows,
    ) -> Option<Self> {
        if rows.is_empty() {
            return None;
        }
        let positions: Vec<_> = sites.iter().map(|node| body.grid.node_position(*node)).collect();
        let mut matrix = SystemMatrix::spanning(&positions, 0, |visitor| {
            for (row, entries) in rows.iter().enumerate() {
                for (column, _) in entries {
                    visitor(row, *column);
                }
            }
        });
        for (row, entries) in rows.iter().enumerate() {
            let coupling = body.coupling_of(sites[row], body.porosity_of(sites[row]));
            matrix.add(row, row, 1.0);
            for (column, value) in entries {
                matrix.add(row, *column, coupling * value);
            }
        }
        let mut factors = Factors::of_shape(&matrix, 1, TimeLimit::default());
        factors.factor(&matrix).is_ok().then_some(Self(factors))
    }

    /// From the pressures at the sites that an unprojected storage would have to those of the projected one.
    pub(crate) fn project(&mut self, pressures: &mut [f64]) {
        self.0.solve(pressures);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, LAYERED};
    use oedometer_soil::layers::{SoilLayer, SoilLayers};
    use oedometer_soil::material::Material;

    /// `1/(2G)` of the seed soil, 1/Pa: E = 1 `MPa`, ν = 1/4, G = 400 kPa.
    const PARAMETER: f64 = 1.0 / 8e5;

    fn layer(name: &str) -> Body<2> {
        let (column, method) = (Column::layer(), Method::named(name).expect("a known method"));
        let problem = column_problem::<2>(&COSINE_LAYER, &column, &Material::default(), method, 4, 2);
        Body::new(problem.expect("the seed layer"))
    }

    #[test]
    fn a_projection_leaves_constants_and_resists_a_checkerboard() {
        let body = layer("PPP");
        let (sites, site_of_node) = body.nodal_sites();
        let rows = body.projection_rows(&sites, &site_of_node);
        let product = |row: &Vec<(usize, f64)>, field: &dyn Fn(usize) -> f64| -> f64 {
            row.iter().map(|(site, value)| value * field(sites[*site])).sum()
        };
        let sign = |node: usize| {
            let [x, y] = body.grid.node_position(node).map(|place| (place / body.grid.cell_size).round());
            if (x + y) % 2.0 == 0.0 { 1.0 } else { -1.0 }
        };
        for (site, row) in rows.iter().enumerate() {
            let node = sites[site];
            assert!(product(row, &|_| 1.0).abs() < 1e-14 * PARAMETER);
            // Two points a direction have ±1/4 of the sign, and a node the share 9/16, 3/16 or 1/16 of each.
            assert!((product(row, &sign) / sign(node) / PARAMETER - 0.0625).abs() < 1e-12, "{node}");
            // Symmetric but for the volumes of the rows.
            for (column, value) in row {
                let back =
                    rows[*column].iter().find(|entry| entry.0 == site).expect("a pattern that is symmetric");
                let volume = |site: usize| body.nodes.volume[sites[site]];
                assert!((volume(site) * value - volume(*column) * back.1).abs() < 1e-15 * PARAMETER);
            }
        }
    }

    #[test]
    fn the_projected_storage_solves_its_linear_system() {
        let body = layer("PPP");
        let (sites, site_of_node) = body.nodal_sites();
        let rows = body.projection_rows(&sites, &site_of_node);
        let given: Vec<f64> = (0..sites.len()).map(|site| (1.3 * site as f64).sin()).collect();
        let mut solved = given.clone();
        ProjectedStorage::from_body(&body, &sites, &rows).expect("a projection").project(&mut solved);
        for (site, row) in rows.iter().enumerate() {
            let coupling = body.material.water_bulk_modulus / body.porosity_of(sites[site]);
            let projected: f64 = row.iter().map(|(column, value)| value * solved[*column]).sum();
            let sum = solved[site] + coupling * projected;
            assert!((sum - given[site]).abs() < 1e-9, "{sum} for {}", given[site]);
        }
    }

    #[test]
    fn a_projection_slows_the_longest_wave_by_what_it_stores() {
        let soil = Material { porosity: 0.5, water_bulk_modulus: 1e9, ..Material::default() };
        let share =
            |name: &str, cells| Method::named(name).expect("a method").share_of_wave_speed(&soil, cells);
        assert_eq!(share("VP", 4), 1.0);
        // The storage n/K_w is 5e-10 1/Pa, and τ = 1/(2G) at eight cells (π/16)² τ/12.
        let added = (1.0 + soil.poissons_ratio) / soil.youngs_modulus * 0.038_553_142 / 12.0;
        let stiffness = |storage: f64| soil.oedometric_modulus() + 1.0 / storage;
        let expected = (stiffness(5e-10 + added) / stiffness(5e-10)).sqrt();
        assert!((share("PPP", 8) / expected - 1.0).abs() < 1e-6, "{} for {expected}", share("PPP", 8));
        assert!(share("PPP", 8) < 0.5 && share("PPP", 256) > 0.9);
    }

    #[test]
    fn the_parameter_is_that_of_the_source_times_the_share_of_the_method() {
        let soil = Material::default();
        let parameter = |method: Method| method.projection_parameter(&soil);
        let method = Method::named("PPP").expect("a known method");
        assert!((parameter(method) / PARAMETER - 1.0).abs() < 1e-12);
        assert!((parameter(Method { projection: 125, ..method }) / PARAMETER - 0.125).abs() < 1e-12);
        assert_eq!(parameter(Method::named("VP").expect("a known method")), 0.0);
    }

    #[test]
    fn nodes_of_layers_store_what_the_water_of_each_soil_does() {
        let layer = |thickness, water_bulk_modulus, youngs_modulus, porosity| SoilLayer {
            thickness,
            water_bulk_modulus: Some(water_bulk_modulus),
            youngs_modulus: Some(youngs_modulus),
            porosity: Some(porosity),
            ..SoilLayer::default()
        };
        let layers = [layer(0.5, 5e6, 2e6, 0.25), layer(0.5, 2e9, 1e6, 0.4)];
        let column = Column { soils: SoilLayers::from_slice(&layers).expect("two"), ..Column::default() };
        let method = Method::named("PPP").expect("a known method");
        let problem = column_problem::<1>(&LAYERED, &column, &Material::default(), method, 4, 2);
        let body = Body::new(problem.expect("a column"));
        let storage = |row: usize| {
            let node = body.grid.flat_node(&[2 + row]);
            body.storage_of(node, body.porosity_of(node))
        };
        let [below, above] = [0.25 / 5e6, 0.4 / 2e9];
        for (row, exact) in [(1, below), (2, 0.5 * (below + above)), (3, above)] {
            assert!((storage(row) / exact - 1.0).abs() < 1e-12, "{row}: {} for {exact}", storage(row));
        }
        // The projection resists the soil's share too.
        let (sites, site_of_node) = body.nodal_sites();
        let rows = body.projection_rows(&sites, &site_of_node);
        let ends = [&rows[0], &rows[4]].map(|row| row.iter().map(|(_, value)| value.abs()).sum::<f64>());
        assert!((ends[1] / ends[0] - 2.0).abs() < 1e-12, "{ends:?}");
    }
}
