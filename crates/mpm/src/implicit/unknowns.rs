//! The unknowns of an implicit step and their order: free components of the skeleton's
//! displacement at the nodes, and pressures where the method takes them.

use crate::body::Body;
use crate::method::PressureIntegration;
use crate::operators::rigid_plate::NORMAL;
use crate::operators::volumetric::VolumetricRows;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Vector;

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
    /// Unknown of each component at each node, where it is free: one for all that go with a rigid plate, the last.
    pub displacement: Vec<[Option<usize>; D]>,
    /// Unknown of each site.
    pub pressure: Vec<usize>,
    /// `D` and `R` of the method: those of an earlier step where `has_old_rows`, but for their sites.
    pub rows: VolumetricRows<D>,
    /// Whether the coefficients of the rows are to be made before somebody takes them.
    has_old_rows: bool,
    /// Number of unknowns.
    pub count: usize,
    /// Where each unknown before the border lies, `[unknown][component]`, m.
    pub positions: Vec<Vector<D>>,
    /// Unknowns at the end that balances everywhere feel: that of a rigid plate.
    pub border: usize,
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
            pressure: Vec::new(),
            rows: body.volumetric_rows(),
            has_old_rows: false,
            count: 0,
            positions: Vec::new(),
            border: usize::from(body.plate.is_some()),
            scales: Scales::of::<D>(&body.material, body.grid.cell_size),
        };
        unknowns.number(body);
        unknowns
    }

    /// Follows a body whose points have moved on: what most steps leave as it was, numbers and sites, stays, and rows that
    /// only a new tangent takes wait for it.
    pub fn follow(&mut self, body: &Body<D>) {
        if !self.has_numbers_of(body) {
            *self = Self::of(body);
            return;
        }
        self.has_old_rows = true;
        if body.method.strain.is_bbar() || !body.recovery.is_local() {
            self.take_rows(body);
        }
    }

    /// Makes the rows anew where they are old.
    pub fn take_rows(&mut self, body: &Body<D>) {
        if self.has_old_rows {
            self.rows = body.volumetric_rows();
            self.has_old_rows = false;
        }
    }

    /// Whether a body has the sites and free components that were numbered, at places that stay; one with a plate is
    /// not looked at.
    fn has_numbers_of(&self, body: &Body<D>) -> bool {
        body.method.pressure.is_by_cells()
            && body.plate.is_none()
            && self.border == 0
            && body.cells.occupied().eq(self.rows.sites.iter().copied())
            && self
                .displacement
                .iter()
                .zip(&body.nodes.free)
                .all(|(numbers, free)| (0..D).all(|d| numbers[d].is_some() == (free[d] > 0.0)))
    }

    fn number(&mut self, body: &Body<D>) {
        let (grid, nodes, sites) = (&body.grid, &body.nodes, &self.rows.sites);
        let site_position = |site: usize| match body.method.pressure {
            PressureIntegration::Points => body.points.position[sites[site]],
            PressureIntegration::Sri | PressureIntegration::Mean => grid.cell_centre(sites[site]),
        };
        let mut sorted: Vec<(Vector<D>, UnknownKind)> = Vec::new();
        for node in 0..nodes.len() {
            for direction in (0..D).filter(|d| nodes.free[node][*d] > 0.0 && !body.is_tied(node, *d)) {
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
        self.count = sorted.len() + self.border;
        self.positions = sorted.iter().map(|(position, _)| *position).collect();
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
        for node in body.plate.iter().flat_map(|plate| &plate.nodes) {
            self.displacement[*node][NORMAL] = Some(sorted.len());
        }
    }
}
