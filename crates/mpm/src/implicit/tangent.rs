//! The tangent of the residual, by differences of the residual itself.
//!
//! Unknowns that no balance feels together are moved together, in as many groups as the operators
//! reach (Curtis, Powell & Reid 1974): about a dozen residuals in one dimension, whatever the
//! number of cells. So the tangent is consistent with every law, configuration and continuity by
//! construction: there is no second set of formulas that could disagree with the first.

use crate::body::Body;
use crate::direct_solver::bordered::Bordered;
use crate::implicit::unknown_groups::{Lists, groups_of};
use crate::implicit::unknowns::Unknowns;
use oedometer_soil::conductivity::ConductivityMean;

/// Difference by which a scaled unknown is moved: the square root of the round-off leaves eight
/// digits of a tangent whose unknowns are strains.
const DIFFERENCE: f64 = 1e-7;

/// Room for what a point feels on a line.
const MOST_FELT: usize = 12;

/// Where the operators' rows begin: what the pattern of the tangent depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Structure {
    basis: Vec<usize>,
    strain: Vec<usize>,
    cells: Vec<usize>,
    /// Splines that end at the surface lose a node without any point's row beginning elsewhere.
    last_node: Option<usize>,
    /// A domain that touches a face reaches the node beyond it without its row beginning elsewhere.
    numbers: Vec<Option<usize>>,
    /// Places of the pressures and their numbers.
    sites: Vec<usize>,
    pressures: Vec<usize>,
}

impl Structure {
    fn of<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Self {
        Self {
            basis: body.basis.first().to_vec(),
            strain: body.strain.first().to_vec(),
            cells: body.cells.of_point.clone(),
            last_node: body.last_spline_node(),
            numbers: unknowns.displacement.as_flattened().to_vec(),
            sites: unknowns.rows.sites.clone(),
            pressures: unknowns.pressure.clone(),
        }
    }
}

/// Which balances feel which unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    structure: Structure,
    /// Rows that feel each unknown.
    rows_of_column: Lists,
    /// Unknowns that are moved together.
    groups: Vec<Vec<usize>>,
    /// Zeros in the shape of the tangent.
    zeros: Bordered,
}

impl Pattern {
    /// The pattern of a body on its present operators.
    pub fn of<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Self {
        let columns_of_row = felt_unknowns(body, unknowns);
        let rows_of_column = Lists::turned(&columns_of_row);
        let zeros = Bordered::spanning(&unknowns.positions, unknowns.border, |visitor| {
            for (row, columns) in columns_of_row.iter().enumerate() {
                for column in columns {
                    visitor(row, *column);
                }
            }
        });
        let groups = groups_of(&rows_of_column);
        Self { structure: Structure::of(body, unknowns), rows_of_column, groups, zeros }
    }

    /// Whether it still is the pattern of a body; nothing is allocated.
    pub fn is_of<const D: usize>(&self, body: &Body<D>, unknowns: &Unknowns<D>) -> bool {
        let known = &self.structure;
        known.basis == body.basis.first()
            && known.strain == body.strain.first()
            && known.cells == body.cells.of_point
            && known.last_node == body.last_spline_node()
            && self.has_unknowns(unknowns)
    }

    /// Whether its rows and columns still are those unknowns, whatever they feel.
    pub fn has_unknowns<const D: usize>(&self, unknowns: &Unknowns<D>) -> bool {
        let known = &self.structure;
        known.numbers == unknowns.displacement.as_flattened()
            && known.sites == unknowns.rows.sites
            && known.pressures == unknowns.pressure
    }

    /// Zeros in the shape of the tangent.
    pub fn zeros(&self) -> Bordered {
        self.zeros.clone()
    }

    /// Differences of `residual` at `state`, where it is `base`. `scratch` has the length of the
    /// state; nothing is allocated.
    pub fn differentiate(
        &self,
        state: &mut [f64],
        base: &[f64],
        scratch: &mut [f64],
        tangent: &mut Bordered,
        mut residual: impl FnMut(&[f64], &mut [f64]),
    ) {
        tangent.clear();
        for group in &self.groups {
            for column in group {
                state[*column] += DIFFERENCE;
            }
            residual(state, scratch);
            for column in group {
                state[*column] -= DIFFERENCE;
                for row in self.rows_of_column.of(*column) {
                    tangent.add(*row, *column, (scratch[*row] - base[*row]) / DIFFERENCE);
                }
            }
        }
    }
}

/// Unknowns that the balance of each unknown's row feels.
fn felt_unknowns<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Vec<Vec<usize>> {
    let stride = body.grid.node_stride();
    let by_point: Vec<Vec<usize>> = (0..body.points.len())
        .map(|point| {
            let mut felt = Vec::with_capacity(MOST_FELT);
            let mut feel = |node: usize| felt.extend(unknowns.displacement[node].into_iter().flatten());
            if body.method.strain.is_bbar() {
                body.strain_row(point, &unknowns.rows).iter().for_each(|entry| feel(entry.node));
            } else {
                body.strain.visit(&body.basis, stride, point, |node, _| feel(node));
            }
            felt.extend(unknowns.rows.recovery[point].iter().map(|(site, _)| unknowns.pressure[*site]));
            felt
        })
        .collect();
    // Forces and drag of a node: of all points whose weights reach it.
    let mut by_node = vec![Vec::new(); body.nodes.len()];
    let first = body.basis.first();
    let parts = first.len() / by_point.len();
    let blocks_of = |point: usize| &first[point * parts..(point + 1) * parts];
    for (point, felt) in by_point.iter().enumerate() {
        // Neighbours mostly feel the same, and need not say so twice.
        if point == 0 || blocks_of(point) != blocks_of(point - 1) || *felt != by_point[point - 1] {
            body.basis.visit(stride, point, |node, _, _| by_node[node].extend_from_slice(felt));
        }
    }
    if body.material.conductivity_mean == ConductivityMean::Chord {
        feel_cells(body, &by_point, &mut by_node);
    }
    for (node, felt) in by_node.iter_mut().enumerate() {
        felt.extend(unknowns.displacement[node].into_iter().flatten());
        felt.sort_unstable();
        felt.dedup();
    }
    let mut rows = vec![Vec::new(); unknowns.count];
    for (node, felt) in by_node.iter().enumerate() {
        for row in unknowns.displacement[node].into_iter().flatten() {
            // The nodes of a plate share a row.
            rows[row].extend_from_slice(felt);
        }
    }
    for row in &mut rows[unknowns.count - unknowns.border..] {
        row.sort_unstable();
        row.dedup();
    }
    // Porosity and deformation of a site: of its points.
    let is_by_cells = body.method.pressure.is_by_cells();
    for (point, felt) in by_point.iter().enumerate() {
        let place = if is_by_cells { body.cells.of_point[point] } else { point };
        let Some(site) = unknowns.rows.site_of_place[place] else { continue };
        let row = &mut rows[unknowns.pressure[site]];
        if !row.ends_with(felt) {
            row.extend_from_slice(felt);
        }
    }
    // Site that last felt each unknown: what neighbours feel alike is taken once.
    let mut felt_by = vec![usize::MAX; unknowns.count];
    for (site, number) in unknowns.pressure.iter().enumerate() {
        let row = &mut rows[*number];
        row.retain(|unknown| std::mem::replace(&mut felt_by[*unknown], site) != site);
        let around = unknowns.rows.divergence[site].iter().flat_map(|(node, _)| &by_node[*node]);
        let beyond =
            around.chain([number]).filter(|unknown| std::mem::replace(&mut felt_by[**unknown], site) != site);
        row.extend(beyond);
        row.sort_unstable();
    }
    rows
}

/// Adds what the drag of a node feels by the means of the cells: all points of a cell with one that reaches
/// the node.
fn feel_cells<const D: usize>(body: &Body<D>, by_point: &[Vec<usize>], by_node: &mut [Vec<usize>]) {
    let mut by_cell = vec![Vec::new(); body.grid.cell_count()];
    for (cell, felt) in body.cells.of_point.iter().zip(by_point) {
        by_cell[*cell].extend_from_slice(felt);
    }
    for felt in &mut by_cell {
        felt.sort_unstable();
        felt.dedup();
    }
    let first = body.basis.first();
    let parts = first.len() / by_point.len();
    let mut last = None;
    for (point, cell) in body.cells.of_point.iter().enumerate() {
        // Neighbours mostly reach the same nodes.
        let reached = Some((*cell, &first[point * parts..(point + 1) * parts]));
        if last != reached {
            last = reached;
            body.basis.visit(body.grid.node_stride(), point, |node, _, _| {
                by_node[node].extend_from_slice(&by_cell[*cell]);
            });
        }
    }
}
