//! Stiffness of a body as sparse blocks between nodes.

use crate::kernel::body::Body;
use crate::kernel::volumetric::{VectorRow, VolumetricRows};
use crate::operators::sparse_rows::entry_of;
use oedometer_soil::tensor::{Tensor, Vector, dot};

/// A sparse matrix of `D × D` blocks between nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeBlocks<const D: usize> {
    /// Blocks of each node's row, ascending in the column's node.
    pub rows: Vec<Vec<(usize, Tensor<D>)>>,
}

impl<const D: usize> NodeBlocks<D> {
    /// No block at all, for a number of nodes.
    pub fn zero(nodes: usize) -> Self {
        Self { rows: vec![Vec::new(); nodes] }
    }

    /// Product with a nodal field.
    pub fn product(&self, field: &[Vector<D>]) -> Vec<Vector<D>> {
        let of_row = |row: &Vec<(usize, Tensor<D>)>| {
            let mut sum = [0.0; D];
            for (column, block) in row {
                for d in 0..D {
                    sum[d] += dot(&block[d], &field[*column]);
                }
            }
            sum
        };
        self.rows.iter().map(of_row).collect()
    }

    /// The block between two nodes, inserted if missing.
    pub fn block(&mut self, row: usize, column: usize) -> &mut Tensor<D> {
        entry_of(&mut self.rows[row], column, [[0.0; D]; D])
    }

    /// Adds another matrix.
    pub fn add(&mut self, other: &Self) {
        for (row, blocks) in other.rows.iter().enumerate() {
            for (column, block) in blocks {
                let target = self.block(row, *column);
                for d in 0..D {
                    for e in 0..D {
                        target[d][e] += block[d][e];
                    }
                }
            }
        }
    }
}

/// [`entry_of`] that first tries the place after the last entry; `place` is that of the last entry, and then of this.
fn entry_after<'a, T>(
    row: &'a mut Vec<(usize, T)>,
    place: &mut usize,
    column: usize,
    zero: impl FnOnce() -> T,
) -> &'a mut T {
    let next = *place + 1;
    *place = if row.get(next).is_some_and(|entry| entry.0 == column) {
        next
    } else {
        row.binary_search_by_key(&column, |entry| entry.0).unwrap_or_else(|place| {
            row.insert(place, (column, zero()));
            place
        })
    };
    &mut row[*place].1
}

/// Strain at a point by a node's displacement `u`: the gradient `u ⊗ g + (b·u/D) I`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainEntry<const D: usize> {
    /// Node.
    pub node: usize,
    /// `g`, 1/m.
    pub gradient: Vector<D>,
    /// `b`: what B-bar puts in the place of the trace, less the trace, 1/m; zero without it.
    pub dilation: Vector<D>,
}

impl<const D: usize> StrainEntry<D> {
    /// Adds what a displacement of the node does.
    #[inline]
    pub fn add_to(&self, gradient: &mut Tensor<D>, displacement: &Vector<D>) {
        let mut dilation = 0.0;
        for d in 0..D {
            dilation += self.dilation[d] * displacement[d] / D as f64;
            for e in 0..D {
                gradient[d][e] += displacement[d] * self.gradient[e];
            }
        }
        for d in 0..D {
            gradient[d][d] += dilation;
        }
    }
}

impl<const D: usize> Body<D> {
    /// The gradient from which a point's effective stress takes its strain, as a row.
    pub fn strain_row(&self, point: usize, rows: &VolumetricRows<D>) -> Vec<StrainEntry<D>> {
        let mut gradients = Vec::new();
        let stride = self.grid.node_stride();
        self.operators
            .strain
            .visit(&self.operators.basis, stride, point, |node, gradient| gradients.push((node, *gradient)));
        let is_bbar = self.method.strain.is_bbar();
        let mut entries: Vec<StrainEntry<D>> = gradients
            .into_iter()
            .map(|(node, gradient)| {
                let dilation = gradient.map(|component| if is_bbar { -component } else { 0.0 });
                StrainEntry { node, gradient, dilation }
            })
            .collect();
        if is_bbar {
            for (node, coefficients) in rows.dilation_row(point) {
                let place = entries.iter().position(|entry| entry.node == node).unwrap_or_else(|| {
                    entries.push(StrainEntry { node, gradient: [0.0; D], dilation: [0.0; D] });
                    entries.len() - 1
                });
                for d in 0..D {
                    entries[place].dilation[d] += coefficients[d];
                }
            }
        }
        entries
    }

    /// `K_σ = Σ V ∇N ⊗ C G`: force of the effective stress on the nodes over their displacements,
    /// N/m, with its sign turned.
    pub fn skeleton_stiffness(&self, rows: &VolumetricRows<D>) -> NodeBlocks<D> {
        let mut blocks = NodeBlocks::zero(self.nodes.len());
        self.add_stiffness(
            &mut blocks,
            |point| self.strain_row(point, rows),
            |point, gradient, dilation| self.stress_law_of(point).elastic_stress(gradient, dilation),
        );
        blocks
    }

    /// Adds `Σ V ∇N ⊗ C G` for the strain rows of the points and a stress, Pa, that each point makes of a small gradient and
    /// of the volume in it that B-bar adds.
    pub fn add_stiffness<Row: AsRef<[StrainEntry<D>]>>(
        &self,
        blocks: &mut NodeBlocks<D>,
        strain_row: impl Fn(usize) -> Row,
        stress: impl Fn(usize, &Tensor<D>, f64) -> Tensor<D>,
    ) {
        // Stress of a unit displacement along each direction of each node that strains a point.
        let mut stresses: Vec<(usize, [Tensor<D>; D])> = Vec::new();
        for point in 0..self.points.len() {
            let volume = self.points.volume(point);
            let of_unit = |entry: &StrainEntry<D>| {
                let along = |e: usize| {
                    let (mut displaced, mut unit) = ([[0.0; D]; D], [0.0; D]);
                    unit[e] = 1.0;
                    entry.add_to(&mut displaced, &unit);
                    stress(point, &displaced, entry.dilation[e])
                };
                (entry.node, std::array::from_fn(along))
            };
            stresses.clear();
            stresses.extend(strain_row(point).as_ref().iter().map(of_unit));
            for (row, force) in self.operators.basis.gradient_row(&self.grid, point) {
                let (row, mut place) = (&mut blocks.rows[row], 0);
                for (column, stresses) in &stresses {
                    let block = entry_after(row, &mut place, *column, || [[0.0; D]; D]);
                    for d in 0..D {
                        for e in 0..D {
                            block[d][e] += volume * dot(&stresses[e][d], &force);
                        }
                    }
                }
            }
        }
    }

    /// `A = Σ V ∇N ⊗ R`: force on the nodes of unit pressures at the sites, `[node] → (site, N/Pa)`.
    pub fn pressure_forces(&self, rows: &VolumetricRows<D>) -> Vec<Vec<(usize, Vector<D>)>> {
        let mut forces: Vec<Vec<(usize, Vector<D>)>> = vec![Vec::new(); self.nodes.len()];
        for point in 0..self.points.len() {
            let volume = self.points.volume(point);
            for (node, gradient) in self.operators.basis.gradient_row(&self.grid, point) {
                let (forces, mut place) = (&mut forces[node], 0);
                for (site, weight) in &rows.recovery[point] {
                    let force = entry_after(forces, &mut place, *site, || [0.0; D]);
                    for d in 0..D {
                        force[d] += volume * weight * gradient[d];
                    }
                }
            }
        }
        forces
    }

    /// `A Q`: force on the nodes of unit dilations at the sites with its sign turned, `[node] → (site, N)`.
    pub fn coupled_pressure_forces(&self, rows: &VolumetricRows<D>) -> Vec<Vec<(usize, Vector<D>)>> {
        let mut forces = self.pressure_forces(rows);
        for (site, force) in forces.iter_mut().flatten() {
            *force = force.map(|component| rows.coupling[*site] * component);
        }
        forces
    }
}

/// `K_p = A Q D`: force of the pressures of an undrained body over its displacements, N/m, with its sign
/// turned, from `A Q` and `D`.
pub fn pressure_stiffness<const D: usize>(
    coupled_forces: &[Vec<(usize, Vector<D>)>],
    divergence: &[VectorRow<D>],
) -> NodeBlocks<D> {
    let mut blocks = NodeBlocks::zero(coupled_forces.len());
    for (row, forces) in coupled_forces.iter().enumerate() {
        for (site, force) in forces {
            for (column, coefficients) in &divergence[*site] {
                let block = blocks.block(row, *column);
                for d in 0..D {
                    for e in 0..D {
                        block[d][e] += force[d] * coefficients[e];
                    }
                }
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::COSINE_LAYER;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    #[test]
    fn the_stiffness_gives_the_forces_of_a_displacement() {
        // A projected storage makes pressures of dilations by a solution and not site by site.
        let is_tried = |name: &&String| *name != "MPM" && !name.starts_with("TL-") && !name.contains("PPP");
        for name in Method::names().iter().filter(is_tried) {
            let method = Method::named(name).expect("a known method");
            let column = Column { load: 1.0, ..Column::layer() };
            let soil = Material { water_bulk_modulus: 1e7, ..Material::default() };
            let problem = column_problem::<2>(&COSINE_LAYER, &column, &soil, method, 4, 2);
            let mut problem = problem.expect("the seed layer");
            problem.undrained_start = false;
            let mut body = Body::new(problem);
            let field: Vec<Vector<2>> = (0..body.nodes.len())
                .map(|node| {
                    let [x, y] = body.grid.node_position(node);
                    [(3.0 * x + y).sin(), (2.0 * x * y).cos()]
                })
                .collect();
            let rows = body.volumetric_rows();
            let mut stiffness = body.skeleton_stiffness(&rows);
            stiffness.add(&pressure_stiffness(&body.coupled_pressure_forces(&rows), &rows.divergence));
            // The explicit step's way: strains, pressures and forces of the points.
            body.displace_points(&rows, &field, &field, &field);
            body.nodes.external_force.fill([0.0; 2]);
            body.map_forces();
            let scale = body.nodes.mixture_force.iter().flatten().fold(0.0, |s: f64, f| s.max(f.abs()));
            for (node, blocks) in stiffness.rows.iter().enumerate() {
                for d in 0..2 {
                    let force: f64 = blocks
                        .iter()
                        .map(|(column, block)| {
                            block[d][0] * field[*column][0] + block[d][1] * field[*column][1]
                        })
                        .sum();
                    let expected = -body.nodes.mixture_force[node][d];
                    assert!(
                        (force - expected).abs() < 1e-11 * scale,
                        "{name} {node}: {force} for {expected}"
                    );
                }
            }
        }
    }
}
