//! Operators of a frozen step: rows between free nodes.

use crate::integrate::assembled::constraints::{SlidingRows, TiedRows};
use crate::kernel::body::Body;
use crate::kernel::projection::ProjectedStorage;
use crate::kernel::volumetric::VolumetricRows;
use crate::operators::sparse_rows::entry_of;
use oedometer_soil::tensor::{Tensor, Vector};

/// The operators of a frozen body between its rows: the nodes that are free in some component.
#[derive(Clone, Debug)]
pub struct FrozenOperators<const D: usize> {
    /// Node of each row.
    pub nodes: Vec<usize>,
    /// Nodes of the body.
    pub node_count: usize,
    /// 1 where a component of a phase is free, else 0, by row.
    pub free: Vec<[Vector<D>; 2]>,
    /// `D`: dilation at each site over the displacements, `[site] → (row, 1/m)`.
    pub divergence: Vec<Vec<(usize, Vector<D>)>>,
    /// `A Q`: force of a unit dilation of each site with its sign turned, `[row] → (site, N)`.
    pub pressure_force: Vec<Vec<(usize, Vector<D>)>>,
    /// The linear system between `D` and `A Q` where the storage is projected.
    pub storage: Option<ProjectedStorage>,
    /// `K_σ`: force of the effective stress over the displacements with its sign turned,
    /// `[row] → (row, N/m)`.
    pub skeleton_force: Vec<Vec<(usize, Tensor<D>)>>,
    /// `P = M⁻¹ Σ N m ⊗ N` of skeleton and of water: velocities to the points and back, `[row] → (row, 1)`.
    pub projection: Vec<Vec<(usize, [f64; 2])>>,
    /// Rows whose displacements are the settlement, with their weights and its sign turned.
    pub settling: Vec<(usize, Vector<D>)>,
    /// Rows that go together under a rigid plate.
    pub tied: TiedRows,
    /// Rows where the water slides past a skeleton that is held.
    pub sliding: SlidingRows,
    /// `D` and `R` between nodes, sites and points.
    pub volumetric: VolumetricRows<D>,
}

impl<const D: usize> FrozenOperators<D> {
    /// Assembles the present operators of a body.
    pub fn new(body: &Body<D>) -> Self {
        let fields = &body.nodes;
        let is_free = |node: &usize| fields.free[*node] != [0.0; D] || fields.water_free[*node] != [0.0; D];
        let nodes: Vec<usize> = (0..fields.len()).filter(is_free).collect();
        let mut number = vec![None; fields.len()];
        for (row, node) in nodes.iter().enumerate() {
            number[*node] = Some(row);
        }
        let volumetric = body.volumetric_rows();
        let skeleton = body.skeleton_stiffness(&volumetric).rows;
        let forces = body.coupled_pressure_forces(&volumetric);
        let projection = projection(body);
        Self {
            free: nodes.iter().map(|node| [fields.free[*node], fields.water_free[*node]]).collect(),
            divergence: volumetric.divergence.iter().map(|row| numbered(row, &number)).collect(),
            storage: ProjectedStorage::from_body(body, &volumetric.sites, &volumetric.projection),
            pressure_force: nodes.iter().map(|node| forces[*node].clone()).collect(),
            skeleton_force: nodes.iter().map(|node| numbered(&skeleton[*node], &number)).collect(),
            projection: nodes.iter().map(|node| numbered(&projection[*node], &number)).collect(),
            settling: numbered(&body.settling_weights(), &number),
            tied: TiedRows::new(body, &number),
            sliding: SlidingRows::new(body, &number),
            node_count: fields.len(),
            volumetric,
            nodes,
        }
    }
}

/// Entries of a row with the numbers of their nodes; those of held nodes fall away.
fn numbered<T: Copy>(row: &[(usize, T)], number: &[Option<usize>]) -> Vec<(usize, T)> {
    row.iter().filter_map(|(node, value)| Some((number[*node]?, *value))).collect()
}

/// `P` of skeleton and of water, `[node] → (node, 1)`.
fn projection<const D: usize>(body: &Body<D>) -> Vec<Vec<(usize, [f64; 2])>> {
    let mut rows = vec![Vec::new(); body.nodes.len()];
    // Of one porosity, the water lies as the grains do.
    let is_uniform = body.soils.iter().all(|soil| soil.porosity == body.material.porosity);
    for point in 0..body.points.len() {
        let soil = body.soil_of(point);
        let volume = body.points.initial_volume[point];
        let solid_mass = volume * (1.0 - soil.porosity) * soil.grain_density;
        let water_mass = volume * soil.porosity * body.material.water_density;
        let mut weights = Vec::new();
        body.operators.basis.visit(body.grid.node_stride(), point, |node, weight, _| {
            if weight != 0.0 {
                weights.push((node, weight));
            }
        });
        for (row, to) in &weights {
            for (column, from) in &weights {
                let entry = entry_of(&mut rows[*row], *column, [0.0; 2]);
                let of_solid = to * solid_mass * from * body.nodes.per_solid_mass[*row];
                entry[0] += of_solid;
                entry[1] += if is_uniform {
                    of_solid
                } else {
                    to * water_mass * from * body.nodes.per_water_mass[*row]
                };
            }
        }
    }
    rows
}
