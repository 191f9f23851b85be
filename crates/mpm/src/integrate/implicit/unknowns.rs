//! The unknowns of an implicit step and their order: free components of the skeleton's
//! displacement at the nodes, and pressures where the method takes them.

use crate::actions::rigid_plate::NORMAL;
use crate::integrate::assembled::stiffness::NodeBlocks;
use crate::kernel::body::Body;
use crate::kernel::volumetric::VolumetricRows;
use oedometer_problem::method::PressureIntegration;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Vector;

/// Scales that make unknowns and equations dimensionless and of similar size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Unit of displacement, m: the cell size.
    pub length: f64,
    /// Unit of pressure, Pa: the oedometric modulus.
    pub pressure: f64,
    /// Unit of force, N: the unit pressure on the face of a cell.
    pub force: f64,
}

impl Scales {
    /// The scales of a soil on cells of a size, m.
    pub fn new<const D: usize>(soil: &Material, cell_size: f64) -> Self {
        let (length, pressure) = (cell_size, soil.oedometric_modulus());
        let face: f64 = (1..D).map(|_| length).product();
        Self { length, pressure, force: pressure * face }
    }
}

/// Numbering of the unknowns. Neighbours in space are neighbours in number, along the longest
/// direction of the grid: that keeps the band of the matrices narrow.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknowns<const D: usize> {
    /// Unknown of each component of each node, where it is free. All nodes tied to a rigid plate share the last one.
    pub displacement: Vec<[Option<usize>; D]>,
    /// Unknown of each site.
    pub pressure: Vec<usize>,
    /// `D` and `R` of the method; the coefficients, but not the sites, are those of an earlier step where `has_old_rows`.
    pub rows: VolumetricRows<D>,
    /// Whether the coefficients of the rows have to be updated before they are used.
    has_old_rows: bool,
    /// Number of unknowns.
    pub count: usize,
    /// Position of each unknown before the border, `[unknown][component]`, m.
    pub positions: Vec<Vector<D>>,
    /// Number of unknowns at the end that balances everywhere depend on: 1 with a rigid plate, else 0.
    pub border: usize,
    /// Scales of the unknowns and of their equations.
    pub scales: Scales,
}

/// Kind of an unknown, during sorting.
#[derive(Clone, Copy)]
enum UnknownKind {
    Displacement { node: usize, direction: usize },
    Pressure { site: usize },
}

impl<const D: usize> Unknowns<D> {
    /// Numbers displacements and pressures of a body on its present operators.
    pub fn new(body: &Body<D>) -> Self {
        let rows = body.volumetric_rows();
        let position = |site: &usize| match body.method.pressure {
            PressureIntegration::Points if body.method.has_projection() => body.grid.node_position(*site),
            PressureIntegration::Points => body.points.position[*site],
            PressureIntegration::Sri | PressureIntegration::Mean => body.grid.cell_centre(*site),
        };
        let sites: Vec<Vector<D>> = rows.sites.iter().map(position).collect();
        Self::numbered(body, rows, &sites)
    }

    /// Numbers the displacements of a body alone; `rows` are its volumetric operators.
    pub fn of_displacements(body: &Body<D>, rows: VolumetricRows<D>) -> Self {
        Self::numbered(body, rows, &[])
    }

    fn numbered(body: &Body<D>, rows: VolumetricRows<D>, sites: &[Vector<D>]) -> Self {
        let mut unknowns = Self {
            displacement: Vec::new(),
            pressure: Vec::new(),
            rows,
            has_old_rows: false,
            count: 0,
            positions: Vec::new(),
            border: usize::from(body.actions.plate.is_some()),
            scales: Scales::new::<D>(&body.material, body.grid.cell_size),
        };
        unknowns.number(body, sites);
        unknowns
    }

    /// Follows a body whose points have moved. Most steps leave numbers and sites as they were; rows that only a new
    /// tangent needs are updated with it.
    pub fn follow(&mut self, body: &Body<D>) {
        if !self.has_numbers_of(body) {
            *self = Self::new(body);
            return;
        }
        self.has_old_rows = true;
        if body.method.strain.is_bbar() || !body.operators.recovery.is_local() {
            self.take_rows(body);
        }
    }

    /// Updates the rows where they are old.
    pub fn take_rows(&mut self, body: &Body<D>) {
        if self.has_old_rows {
            self.rows = body.volumetric_rows();
            self.has_old_rows = false;
        }
    }

    /// Whether a body still has the sites and free components that were numbered, at positions that do not change; false
    /// with a plate.
    fn has_numbers_of(&self, body: &Body<D>) -> bool {
        body.method.pressure.is_by_cells()
            && body.actions.plate.is_none()
            && self.border == 0
            && body.cells.occupied().eq(self.rows.sites.iter().copied())
            && self
                .displacement
                .iter()
                .zip(&body.nodes.free)
                .all(|(numbers, free)| (0..D).all(|d| numbers[d].is_some() == (free[d] > 0.0)))
    }

    /// Lists the free components of the nodes: node, component and number.
    pub fn visit_numbers(&self, mut visitor: impl FnMut(usize, usize, usize)) {
        for (node, numbers) in self.displacement.iter().enumerate() {
            for (d, number) in numbers.iter().enumerate() {
                if let Some(number) = number {
                    visitor(node, d, *number);
                }
            }
        }
    }

    /// Lists the places of a matrix of blocks between nodes: row and column.
    pub fn visit_places(&self, blocks: &NodeBlocks<D>, visitor: &mut dyn FnMut(usize, usize)) {
        self.visit_numbers(|node, _, row| {
            for (other, _) in &blocks.rows[node] {
                self.displacement[*other].iter().flatten().for_each(|column| visitor(row, *column));
            }
        });
    }

    /// Lists the entries of a matrix of blocks between nodes that are not zero: row, column and value.
    pub fn visit_blocks(&self, blocks: &NodeBlocks<D>, mut visitor: impl FnMut(usize, usize, f64)) {
        for (rows, blocks) in self.displacement.iter().zip(&blocks.rows) {
            for (d, row) in rows.iter().enumerate() {
                let Some(row) = row else { continue };
                for (other, block) in blocks {
                    for (column, value) in self.displacement[*other].iter().zip(&block[d]) {
                        if let Some(column) = column.filter(|_| *value != 0.0) {
                            visitor(*row, column, *value);
                        }
                    }
                }
            }
        }
    }

    fn number(&mut self, body: &Body<D>, sites: &[Vector<D>]) {
        let (grid, nodes) = (&body.grid, &body.nodes);
        let mut sorted: Vec<(Vector<D>, UnknownKind)> = Vec::new();
        for node in 0..nodes.len() {
            for direction in (0..D).filter(|d| nodes.free[node][*d] > 0.0 && !body.is_tied(node, *d)) {
                sorted.push((grid.node_position(node), UnknownKind::Displacement { node, direction }));
            }
        }
        let pressures = sites.iter().enumerate();
        sorted.extend(pressures.map(|(site, position)| (*position, UnknownKind::Pressure { site })));
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
        for node in body.actions.plate.iter().flat_map(|plate| &plate.nodes) {
            self.displacement[*node][NORMAL] = Some(sorted.len());
        }
    }
}
