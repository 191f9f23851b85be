//! The undrained start: the static equilibrium under the load before any water has moved.
//!
//! An elastic body whose volume costs the skeleton's and the water's stiffness (`λ_u = λ + Q`),
//! found by the method's own operators. It is a pure test of volumetric locking, and the start from
//! which an explicit run has no waves.

use crate::assembled::stiffness::{NodeBlocks, pressure_stiffness};
use crate::body::Body;
use crate::direct_solver::bordered::{Bordered, BorderedLu};
use crate::direct_solver::singular::Singular;
use crate::method::Configuration;
use crate::operators::rigid_plate::NORMAL;
use crate::operators::volumetric::VolumetricRows;
use crate::state::grid::Grid;
use crate::time_limit::TimeLimit;
use oedometer_soil::tensor::{Tensor, Vector};

/// Free components of the nodes, in the order of the unknowns: one for all that go with a rigid plate, the last.
#[derive(Clone, Debug, Default, PartialEq)]
struct FreeComponents {
    /// Node, component and unknown of each free component.
    places: Vec<(usize, usize, usize)>,
    /// Unknown of each component of each node, node by node.
    number: Vec<Option<usize>>,
    /// Unknowns.
    count: usize,
    /// Unknowns at the end that are a plate's.
    border: usize,
}

impl FreeComponents {
    /// Numbers the components that are free.
    fn of<const D: usize>(body: &Body<D>) -> Self {
        let free = &body.nodes.free;
        let border = usize::from(body.plate.is_some());
        let mut components =
            Self { places: Vec::new(), number: vec![None; D * free.len()], count: 0, border };
        for (node, free) in free.iter().enumerate() {
            for d in (0..D).filter(|d| free[*d] > 0.0 && !body.is_tied(node, *d)) {
                components.places.push((node, d, components.places.len()));
            }
        }
        let plate = components.places.len();
        for node in body.plate.iter().flat_map(|plate| &plate.nodes) {
            components.places.push((*node, NORMAL, plate));
        }
        components.count = plate + border;
        for (node, d, unknown) in &components.places {
            components.number[D * node + d] = Some(*unknown);
        }
        components
    }

    /// The blocks between free components of the nodes of a grid as a matrix.
    fn matrix<const D: usize>(&self, blocks: &NodeBlocks<D>, grid: &Grid<D>) -> Bordered {
        let entries = || {
            self.places.iter().flat_map(move |(node, d, row)| {
                blocks.rows[*node].iter().flat_map(move |(column, block)| {
                    (0..D).filter_map(move |e| Some((*row, self.number[D * column + e]?, block[*d][e])))
                })
            })
        };
        let counting = || entries().filter(|entry| entry.2 != 0.0);
        let alone = &self.places[..self.count - self.border];
        let positions: Vec<Vector<D>> = alone.iter().map(|(node, _, _)| grid.node_position(*node)).collect();
        let mut matrix = Bordered::spanning(&positions, self.border, |visitor| {
            counting().for_each(|(row, column, _)| visitor(row, column));
        });
        for (row, column, value) in counting() {
            matrix.add(row, column, value);
        }
        matrix
    }
}

/// A body's undrained stiffness, factorised.
#[derive(Clone, Debug)]
pub struct UndrainedSystem<const D: usize> {
    unknowns: FreeComponents,
    /// The stiffness, where its factors need it for a second look.
    stiffness: Option<Bordered>,
    factors: BorderedLu,
    rows: VolumetricRows<D>,
}

impl<const D: usize> UndrainedSystem<D> {
    /// Assembles and factorises the stiffness of a body's present operators, by so many threads where that pays.
    ///
    /// # Errors
    /// When it is singular: a body that nothing holds; or when the time is over.
    pub fn of(body: &Body<D>, threads: usize, time_limit: TimeLimit) -> Result<Self, Singular> {
        let rows = body.volumetric_rows();
        let mut stiffness = body.skeleton_stiffness(&rows);
        stiffness.add(&pressure_stiffness(&body.coupled_pressure_forces(&rows), &rows.divergence));
        let unknowns = FreeComponents::of(body);
        let matrix = unknowns.matrix(&stiffness, &body.grid);
        let mut factors = BorderedLu::of_shape(&matrix, threads).within(time_limit);
        factors.factor(&matrix)?;
        Ok(Self { unknowns, stiffness: (!matrix.is_banded()).then_some(matrix), factors, rows })
    }

    /// Displacements of the nodes under forces on them.
    pub fn displacements(&mut self, forces: &[Vector<D>]) -> Vec<Vector<D>> {
        let places = &self.unknowns.places;
        let mut values = vec![0.0; self.unknowns.count];
        for (node, d, unknown) in places {
            values[*unknown] += forces[*node][*d];
        }
        let mut rest = values.clone();
        self.factors.solve(&mut values);
        // Water that is nearly incompressible costs fronts, whose pivots are few to choose from, some digits; what
        // the solution leaves of the forces brings them back.
        if let Some(stiffness) = &self.stiffness {
            stiffness.take_product(&values, &mut rest);
            self.factors.solve(&mut rest);
            for (value, correction) in values.iter_mut().zip(&rest) {
                *value += correction;
            }
        }
        let mut displacements = vec![[0.0; D]; forces.len()];
        for (node, d, unknown) in places {
            displacements[*node][*d] = values[*unknown];
        }
        displacements
    }
}

impl<const D: usize> Body<D> {
    /// Brings the body into undrained equilibrium with its load, by so many threads where that pays.
    ///
    /// # Errors
    /// When its stiffness is singular, or the time is over.
    pub fn settle_undrained(&mut self, threads: usize, time_limit: TimeLimit) -> Result<(), Singular> {
        let mut system = UndrainedSystem::of(self, threads, time_limit)?;
        self.map_forces();
        let displacements = system.displacements(&self.nodes.mixture_force);
        let field = &displacements[..];
        self.displace_points(&system.rows, field, field, field);
        self.follow_points();
        Ok(())
    }

    /// Displaces nodes and points by a field, strains the skeleton by another and compresses the
    /// water by a third, all nodal.
    pub fn displace_points(
        &mut self,
        rows: &VolumetricRows<D>,
        strained: &[Vector<D>],
        flux: &[Vector<D>],
        displacements: &[Vector<D>],
    ) {
        let mut pressures = rows.at_sites(flux);
        for (value, coupling) in pressures.iter_mut().zip(&rows.coupling) {
            *value *= -coupling;
        }
        self.change_points(rows, strained, &pressures, displacements);
    }

    /// Displaces nodes and points by a field, strains the skeleton by another and changes the
    /// pressures by those of the sites, Pa.
    pub fn change_points(
        &mut self,
        rows: &VolumetricRows<D>,
        strained: &[Vector<D>],
        site_pressures: &[f64],
        displacements: &[Vector<D>],
    ) {
        let pressures = rows.at_points(site_pressures);
        for point in 0..self.points.len() {
            let (gradient, dilation) = self.gradient_of(point, rows, strained);
            let stress = self.stress_law.elastic_stress(&gradient, dilation);
            let of_basis = self.basis.value(self.grid.node_stride(), point, displacements);
            let moved = self.carrying(point, displacements, of_basis);
            self.points.pressure[point] += pressures[point];
            for d in 0..D {
                self.points.displacement[point][d] += moved[d];
                for e in 0..D {
                    self.points.effective_stress[point][d][e] += stress[d][e];
                }
                if self.configuration == Configuration::Updated {
                    self.points.position[point][d] += moved[d];
                }
            }
            if self.configuration.deforms() {
                self.deform(point, &gradient);
            }
        }
        for (node, displacement) in displacements.iter().enumerate() {
            for d in 0..D {
                self.nodes.displacement[node][d] += displacement[d];
            }
        }
    }

    /// Gradient of a nodal field from which a point's effective stress takes its strain, and the
    /// dilation that B-bar put into it.
    fn gradient_of(&self, point: usize, rows: &VolumetricRows<D>, field: &[Vector<D>]) -> (Tensor<D>, f64) {
        let (mut gradient, mut dilation) = ([[0.0; D]; D], 0.0);
        for entry in self.strain_row(point, rows) {
            let displacement = &field[entry.node];
            entry.add_to(&mut gradient, displacement);
            dilation += (0..D).map(|d| entry.dilation[d] * displacement[d]).sum::<f64>();
        }
        (gradient, dilation)
    }
}
