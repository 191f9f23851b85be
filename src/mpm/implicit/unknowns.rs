//! The unknowns of an implicit step and their order: free components of the skeleton's
//! displacement at the nodes, and pressures where the method takes them.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::method::PressureIntegration;
use crate::mpm::operators::volumetric::VolumetricRows;
use crate::soil::tensor::Vector;

/// Numbering of the unknowns. Neighbours in space are neighbours in number, along the longest
/// direction of the grid: that keeps the band of the matrices narrow.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknowns<const D: usize> {
    /// Unknown of each component at each node, where it is free.
    pub displacement: Vec<[Option<usize>; D]>,
    /// Cells or points that carry a pressure unknown.
    pub sites: Vec<usize>,
    /// Unknown of each site.
    pub pressure: Vec<usize>,
    /// Site of each cell or point, where it is one.
    site_of_place: Vec<Option<usize>>,
    /// `D` and `R` of the method.
    pub rows: VolumetricRows<D>,
    /// Where the sites are.
    pub integration: PressureIntegration,
    /// Number of unknowns.
    pub count: usize,
}

/// What an unknown stands for, while they are sorted.
#[derive(Clone, Copy)]
enum Kind {
    Displacement { node: usize, direction: usize },
    Pressure { site: usize },
}

impl<const D: usize> Unknowns<D> {
    /// Numbers the unknowns of a body on its present operators.
    pub fn of<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        let integration = body.method.pressure;
        let (sites, places): (Vec<usize>, usize) = match integration {
            PressureIntegration::Points => ((0..body.points.len()).collect(), body.points.len()),
            PressureIntegration::Sri | PressureIntegration::Mean => {
                (body.cells.occupied().collect(), body.grid.cell_count())
            }
        };
        let mut site_of_place = vec![None; places];
        for (site, place) in sites.iter().enumerate() {
            site_of_place[*place] = Some(site);
        }
        let site_position = |site: usize| match integration {
            PressureIntegration::Points => body.points.position[sites[site]],
            PressureIntegration::Sri | PressureIntegration::Mean => body.grid.cell_centre(sites[site]),
        };
        let mut sorted: Vec<(Vector<D>, Kind)> = Vec::new();
        for node in 0..body.nodes.len() {
            for direction in (0..D).filter(|d| body.nodes.free[node][*d] > 0.0) {
                sorted.push((body.grid.node_position(node), Kind::Displacement { node, direction }));
            }
        }
        sorted.extend((0..sites.len()).map(|site| (site_position(site), Kind::Pressure { site })));
        let slowest = (0..D).max_by_key(|d| body.grid.cells[*d]).unwrap_or(0);
        let key = |place: &Vector<D>| {
            let mut key = *place;
            key.swap(0, slowest);
            key
        };
        sorted.sort_by(|(a, _), (b, _)| {
            let pairs = key(a).into_iter().zip(key(b));
            pairs
                .map(|(a, b)| a.total_cmp(&b))
                .find(|order| order.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut displacement = vec![[None; D]; body.nodes.len()];
        let mut pressure = vec![0; sites.len()];
        for (number, (_, kind)) in sorted.iter().enumerate() {
            match *kind {
                Kind::Displacement { node, direction } => displacement[node][direction] = Some(number),
                Kind::Pressure { site } => pressure[site] = number,
            }
        }
        Self {
            displacement,
            pressure,
            rows: body.volumetric_rows(),
            site_of_place,
            integration,
            count: sorted.len(),
            sites,
        }
    }

    /// Site of a cell or point, where it is one.
    pub fn site_of(&self, place: usize) -> Option<usize> {
        self.site_of_place[place]
    }

    /// Visits the sites that a point's pressure comes from, with their weights.
    pub fn visit_recovery(&self, point: usize, mut visitor: impl FnMut(usize, f64)) {
        for (site, weight) in &self.rows.recovery[point] {
            visitor(*site, *weight);
        }
    }

    /// Visits the nodes of a site's divergence with its coefficients, 1/m.
    pub fn visit_divergence(&self, site: usize, mut visitor: impl FnMut(usize, &Vector<D>)) {
        for (node, coefficients) in &self.rows.divergence[site] {
            visitor(*node, coefficients);
        }
    }

    /// Porosity at a site.
    pub fn porosity<const W: usize, S: ShapeFunction<W>>(&self, body: &Body<D, W, S>, site: usize) -> f64 {
        let place = self.sites[site];
        match self.integration {
            PressureIntegration::Points => body.material.porosity_at(body.points.volume_ratio[place]),
            PressureIntegration::Sri | PressureIntegration::Mean => body.cells.porosity[place],
        }
    }
}
