//! The tangent of the residual, by differences of the residual itself.
//!
//! Unknowns that no balance contains together are perturbed together, in groups (Curtis, Powell & Reid 1974): about a dozen
//! residuals in one dimension, for any number of cells. So the tangent is consistent with every law, configuration and
//! continuity by construction: no second set of formulas could disagree with the first.

use crate::direct_solver::system::SystemMatrix;
use crate::integrate::implicit::unknowns::Unknowns;
use crate::kernel::body::Body;
use oedometer_soil::conductivity::ConductivityMean;

/// Perturbation of a scaled unknown: about the square root of the round-off, which leaves eight digits of the tangent.
pub const DIFFERENCE: f64 = 1e-7;

/// Usual number of unknowns that a point depends on in one dimension.
const MOST_FELT: usize = 12;

/// Which nodes the rows of the operators reach, on which the pattern of the tangent depends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Structure {
    basis: Vec<usize>,
    strain: Vec<usize>,
    cells: Vec<usize>,
    /// Splines that end at the surface can lose a node although no row begins elsewhere.
    last_node: Option<usize>,
    /// Numbers of the displacements.
    numbers: Vec<Option<usize>>,
    /// Cells or points of the pressures, and their numbers.
    sites: Vec<usize>,
    pressures: Vec<usize>,
}

impl Structure {
    fn new<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Self {
        Self {
            basis: body.operators.basis.reach(),
            strain: body.operators.strain.reach(),
            cells: body.cells.of_point.clone(),
            last_node: body.last_spline_node(),
            numbers: unknowns.displacement.as_flattened().to_vec(),
            sites: unknowns.rows.sites.clone(),
            pressures: unknowns.pressure.clone(),
        }
    }
}

/// Which balances depend on which unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    structure: Structure,
    /// Rows that depend on each unknown.
    rows_of_column: Lists,
    /// Unknowns that are perturbed together.
    groups: Vec<Vec<usize>>,
    /// Zeros in the shape of the tangent.
    zeros: SystemMatrix,
}

impl Pattern {
    /// The pattern of a body on its present operators.
    pub fn new<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Self {
        let columns_of_row = dependencies(body, unknowns);
        let rows_of_column = Lists::turned(&columns_of_row);
        let zeros = SystemMatrix::spanning(&unknowns.positions, unknowns.border, |visitor| {
            for (row, columns) in columns_of_row.iter().enumerate() {
                for column in columns {
                    visitor(row, *column);
                }
            }
        });
        // Pressures apart: a residual whose strains stay takes half of the work.
        let mut is_pressure = vec![false; unknowns.count];
        unknowns.pressure.iter().for_each(|number| is_pressure[*number] = true);
        let (pressures, displacements): (Vec<_>, Vec<_>) =
            (0..unknowns.count).partition(|unknown| is_pressure[*unknown]);
        let mut groups = groups_of(&rows_of_column, &displacements);
        groups.extend(groups_of(&rows_of_column, &pressures));
        Self { structure: Structure::new(body, unknowns), rows_of_column, groups, zeros }
    }

    /// Whether the pattern is still that of the body; allocates nothing.
    pub fn matches<const D: usize>(&self, body: &Body<D>, unknowns: &Unknowns<D>) -> bool {
        if !body.configuration.moves_points() {
            return true;
        }
        let known = &self.structure;
        body.operators.basis.reaches(&known.basis)
            && body.operators.strain.reaches(&known.strain)
            && known.cells == body.cells.of_point
            && known.last_node == body.last_spline_node()
            && self.has_unknowns(unknowns)
    }

    /// Whether its rows and columns are still those unknowns, whatever depends on them.
    pub fn has_unknowns<const D: usize>(&self, unknowns: &Unknowns<D>) -> bool {
        let known = &self.structure;
        known.numbers == unknowns.displacement.as_flattened()
            && known.sites == unknowns.rows.sites
            && known.pressures == unknowns.pressure
    }

    /// Zeros in the shape of the tangent.
    pub fn zeros(&self) -> SystemMatrix {
        self.zeros.clone()
    }

    /// Differences of `residual` at `state`, where it is `base`, for a perturbation of `difference`. `scratch` has the length
    /// of the state; nothing is allocated.
    pub fn differentiate(
        &self,
        difference: f64,
        state: &mut [f64],
        base: &[f64],
        scratch: &mut [f64],
        tangent: &mut SystemMatrix,
        mut residual: impl FnMut(&[f64], &mut [f64]),
    ) {
        tangent.clear();
        for group in &self.groups {
            for column in group {
                state[*column] += difference;
            }
            residual(state, scratch);
            for column in group {
                state[*column] -= difference;
                for row in self.rows_of_column.list(*column) {
                    tangent.add(*row, *column, (scratch[*row] - base[*row]) / difference);
                }
            }
        }
    }
}

/// Unknowns that each row depends on.
fn dependencies<const D: usize>(body: &Body<D>, unknowns: &Unknowns<D>) -> Vec<Vec<usize>> {
    let stride = body.grid.node_stride();
    let by_point: Vec<Vec<usize>> = (0..body.points.len())
        .map(|point| {
            let mut felt = Vec::with_capacity(MOST_FELT);
            let mut feel = |node: usize| felt.extend(unknowns.displacement[node].into_iter().flatten());
            if body.method.strain.is_bbar() {
                body.strain_row(point, &unknowns.rows).iter().for_each(|entry| feel(entry.node));
            } else {
                body.operators.strain.visit(&body.operators.basis, stride, point, |node, _| feel(node));
            }
            felt.extend(unknowns.rows.recovery[point].iter().map(|(site, _)| unknowns.pressure[*site]));
            felt
        })
        .collect();
    // Forces and drag of a node depend on all points whose shape functions reach it.
    let mut by_node = vec![Vec::new(); body.nodes.len()];
    let reach = body.operators.basis.reach();
    let parts = reach.len() / by_point.len();
    let blocks_of = |point: usize| &reach[point * parts..(point + 1) * parts];
    for (point, felt) in by_point.iter().enumerate() {
        // Neighbours mostly depend on the same unknowns: skip repetitions.
        if point == 0 || blocks_of(point) != blocks_of(point - 1) || *felt != by_point[point - 1] {
            body.operators.basis.visit(stride, point, |node, _, _| by_node[node].extend_from_slice(felt));
        }
    }
    if body.material.conductivity_mean == ConductivityMean::Chord {
        add_cell_means(body, &by_point, &mut by_node);
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
    // Porosity and deformation of a site depend on its points.
    let is_by_cells = body.method.pressure.is_by_cells();
    for (point, felt) in by_point.iter().enumerate() {
        let place = if is_by_cells { body.cells.of_point[point] } else { point };
        // Sites that are nodes depend on the points around them, which `by_node` has below.
        let site = unknowns.rows.site_of_place.get(place).copied().flatten();
        let Some(site) = site.filter(|_| !body.method.has_projection()) else { continue };
        let row = &mut rows[unknowns.pressure[site]];
        if !row.ends_with(felt) {
            row.extend_from_slice(felt);
        }
    }
    // The last site that listed each unknown: each is listed once per site.
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

/// Adds what the drag of a node depends on through the cell means: all points of a cell with a point that reaches the
/// node.
fn add_cell_means<const D: usize>(body: &Body<D>, by_point: &[Vec<usize>], by_node: &mut [Vec<usize>]) {
    let mut by_cell = vec![Vec::new(); body.grid.cell_count()];
    for (cell, felt) in body.cells.of_point.iter().zip(by_point) {
        by_cell[*cell].extend_from_slice(felt);
    }
    for felt in &mut by_cell {
        felt.sort_unstable();
        felt.dedup();
    }
    let reach = body.operators.basis.reach();
    let parts = reach.len() / by_point.len();
    let mut last = None;
    for (point, cell) in body.cells.of_point.iter().enumerate() {
        // Neighbours mostly reach the same nodes.
        let reached = Some((*cell, &reach[point * parts..(point + 1) * parts]));
        if last != reached {
            last = reached;
            body.operators.basis.visit(body.grid.node_stride(), point, |node, _, _| {
                by_node[node].extend_from_slice(&by_cell[*cell]);
            });
        }
    }
}

/// Puts each of some unknowns into the first group in which no other shares a row with it.
pub fn groups_of(rows_of_column: &Lists, columns: &[usize]) -> Vec<Vec<usize>> {
    let count = rows_of_column.count();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    // Groups that have an unknown in each row, one bit each, in so many words per row.
    let (mut words, mut taken) = (1, vec![0_u64; count]);
    let mut felt = vec![0_u64];
    for &column in columns {
        felt.fill(0);
        for row in rows_of_column.list(column) {
            for (felt, taken) in felt.iter_mut().zip(&taken[row * words..]) {
                *felt |= taken;
            }
        }
        let free = felt.iter().position(|word| *word != u64::MAX);
        let word = free.unwrap_or_else(|| {
            taken = taken.chunks(words).flat_map(|row| row.iter().copied().chain([0])).collect();
            words += 1;
            felt.push(0);
            words - 1
        });
        let bit = felt[word].trailing_ones() as usize;
        for row in rows_of_column.list(column) {
            taken[row * words + word] |= 1 << bit;
        }
        let group = word * u64::BITS as usize + bit;
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(column);
    }
    groups
}

/// Lists of numbers in one allocation.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists {
    /// Start of each list, and the end of the last.
    starts: Vec<usize>,
    items: Vec<usize>,
}

impl Lists {
    /// Transposes lists: for each number the lists that contain it.
    pub fn turned(lists: &[Vec<usize>]) -> Self {
        let mut starts = vec![0; lists.len() + 1];
        for item in lists.iter().flatten() {
            starts[item + 1] += 1;
        }
        for item in 0..lists.len() {
            starts[item + 1] += starts[item];
        }
        let (mut next, mut items) = (starts.clone(), vec![0; starts[lists.len()]]);
        for (number, list) in lists.iter().enumerate() {
            for item in list {
                items[next[*item]] = number;
                next[*item] += 1;
            }
        }
        Self { starts, items }
    }

    /// Number of lists.
    fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The list with a number.
    pub fn list(&self, number: usize) -> &[usize] {
        &self.items[self.starts[number]..self.starts[number + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_of_a_group_share_no_row_and_groups_are_no_more_than_the_unknowns_of_a_row() {
        // Bands of a width, and for more groups than a word has bits a row that feels all.
        for (count, reach, full) in [(40, 2, false), (150, 40, false), (70, 1, true)] {
            let felt = |row: usize| row.saturating_sub(reach)..(row + reach + 1).min(count);
            let mut columns: Vec<Vec<usize>> = (0..count).map(|row| felt(row).collect()).collect();
            if full {
                columns[count - 1] = (0..count).collect();
            }
            let rows = Lists::turned(&columns);
            assert!(
                columns
                    .iter()
                    .enumerate()
                    .all(|(row, felt)| felt.iter().all(|column| rows.list(*column).contains(&row)))
            );
            let groups = groups_of(&rows, &(0..count).collect::<Vec<_>>());
            assert_eq!(groups.len(), if full { count } else { 2 * reach + 1 });
            assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), count, "each unknown once");
            for (row, felt) in columns.iter().enumerate() {
                for group in &groups {
                    let shared = group.iter().filter(|column| felt.contains(column)).count();
                    assert!(shared < 2, "row {row} feels {shared} of a group");
                }
            }
        }
    }
}
