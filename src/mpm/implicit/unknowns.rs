//! The unknowns of an implicit step and their order: free components of the skeleton's
//! displacement at the nodes, and pressures where the method takes them.

use crate::mpm::body::Body;
use crate::mpm::method::PressureIntegration;
use crate::mpm::operators::volumetric::VolumetricRows;
use crate::mpm::state::cells::Cells;
use crate::mpm::state::grid::Grid;
use crate::mpm::state::nodes::Nodes;
use crate::mpm::state::points::Points;
use crate::soil::material::Material;
use crate::soil::tensor::Vector;

/// Scales that make the unknowns and the equations pure numbers of like size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Displacement of one, m: the cell.
    pub length: f64,
    /// Pressure of one, Pa: the oedometric modulus.
    pub pressure: f64,
    /// Force of one, N: that pressure on the face of a cell.
    pub force: f64,
}

impl Scales {
    /// The scales of a soil on cells of a size, m.
    pub fn of<const D: usize>(soil: &Material, cell_size: f64) -> Self {
        let (length, pressure) = (cell_size, soil.oedometric_modulus());
        let face: f64 = (1..D).map(|_| length).product();
        Self { length, pressure, force: pressure * face }
    }
}

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
    /// Scales of the unknowns and of their equations.
    pub scales: Scales,
}

/// What an unknown stands for, while they are sorted.
#[derive(Clone, Copy)]
enum UnknownKind {
    Displacement { node: usize, direction: usize },
    Pressure { site: usize },
}

impl<const D: usize> Unknowns<D> {
    /// Numbers the unknowns of a body on its present operators.
    pub fn of(body: &Body<D>) -> Self {
        let mut unknowns = Self {
            displacement: Vec::new(),
            sites: Vec::new(),
            pressure: Vec::new(),
            site_of_place: Vec::new(),
            rows: body.volumetric_rows(),
            integration: body.method.pressure,
            count: 0,
            scales: Scales::of::<D>(&body.material, body.grid.cell_size),
        };
        unknowns.number(&body.grid, &body.nodes, &body.cells, &body.points);
        unknowns
    }

    fn number(&mut self, grid: &Grid<D>, nodes: &Nodes<D>, cells: &Cells<D>, points: &Points<D>) {
        let integration = self.integration;
        let (sites, places): (Vec<usize>, usize) = match integration {
            PressureIntegration::Points => ((0..points.len()).collect(), points.len()),
            PressureIntegration::Sri | PressureIntegration::Mean => {
                (cells.occupied().collect(), grid.cell_count())
            }
        };
        let mut site_of_place = vec![None; places];
        for (site, place) in sites.iter().enumerate() {
            site_of_place[*place] = Some(site);
        }
        let site_position = |site: usize| match integration {
            PressureIntegration::Points => points.position[sites[site]],
            PressureIntegration::Sri | PressureIntegration::Mean => grid.cell_centre(sites[site]),
        };
        let mut sorted: Vec<(Vector<D>, UnknownKind)> = Vec::new();
        for node in 0..nodes.len() {
            for direction in (0..D).filter(|d| nodes.free[node][*d] > 0.0) {
                sorted.push((grid.node_position(node), UnknownKind::Displacement { node, direction }));
            }
        }
        sorted.extend((0..sites.len()).map(|site| (site_position(site), UnknownKind::Pressure { site })));
        let slowest = (0..D).max_by_key(|d| grid.cells[*d]).unwrap_or(0);
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
        self.count = sorted.len();
        self.displacement = vec![[None; D]; nodes.len()];
        self.pressure = vec![0; sites.len()];
        for (number, (_, kind)) in sorted.iter().enumerate() {
            match *kind {
                UnknownKind::Displacement { node, direction } => {
                    self.displacement[node][direction] = Some(number);
                }
                UnknownKind::Pressure { site } => self.pressure[site] = number,
            }
        }
        (self.sites, self.site_of_place) = (sites, site_of_place);
    }

    /// Site of a cell or point, where it is one.
    pub fn site_of(&self, place: usize) -> Option<usize> {
        self.site_of_place[place]
    }

    /// Porosity at a site.
    #[inline]
    pub fn porosity(&self, soil: &Material, points: &Points<D>, cells: &Cells<D>, site: usize) -> f64 {
        let place = self.sites[site];
        match self.integration {
            PressureIntegration::Points => soil.porosity_at(points.volume_ratio[place]),
            PressureIntegration::Sri | PressureIntegration::Mean => cells.porosity[place],
        }
    }
}
