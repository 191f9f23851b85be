//! Sparse operators between points and nodes: the shape functions of each point over a small block of nodes.
//!
//! Loops over points read and write nodal fields run by run: a run is `W` neighbouring nodes along the first direction,
//! one slice of a field, whose bounds are checked once.

// A function that is not inlined into a loop for wide registers is compiled for narrow ones (`crate::wide`).
#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::operators::row::Row;
use crate::state::grid::{Grid, power};
use crate::wide::{some_mut, wide};
use oedometer_soil::tensor::{Tensor, Vector};
use std::hint::black_box;

/// Values of a point's shape functions along one direction and their gradients, 1/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<const W: usize> {
    /// Values.
    pub values: [f64; W],
    /// Gradients, 1/m.
    pub gradients: [f64; W],
}

/// Shape functions of every point over a block of `W` nodes in each direction.
///
/// A block is the tensor product of one line a direction. A point whose shape functions are no such product has several
/// blocks, of which they are the sum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stencils<const D: usize, const W: usize> {
    /// Flat index of the lowest node of each block.
    pub first: Vec<usize>,
    lines: Vec<[Line<W>; D]>,
    /// Blocks per point; one on a line.
    parts: usize,
}

/// `W` neighbouring nodes along the first direction in a block, where shape functions are products of what is along the
/// run and what is across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<const D: usize, const W: usize> {
    /// The first of the nodes.
    pub first: usize,
    /// Values along the run.
    pub values: [f64; W],
    /// Gradients along the run, 1/m.
    pub gradients: [f64; W],
    /// Factors from the other directions: of the values and of the gradient's first component, and of each other
    /// component, 1/m.
    pub across: Vector<D>,
}

impl<const D: usize, const W: usize> Run<D, W> {
    /// Value of the shape function of a node of the run.
    #[inline(always)]
    pub fn value(&self, k: usize) -> f64 {
        self.across[0] * self.values[k]
    }

    /// Its gradient, 1/m.
    #[inline(always)]
    pub fn gradient(&self, k: usize) -> Vector<D> {
        let mut gradient = self.across;
        for (d, component) in gradient.iter_mut().enumerate() {
            *component *= if d == 0 { self.gradients[k] } else { self.values[k] };
        }
        gradient
    }

    /// Adds what a point gives to the nodes of the run, times its shape functions.
    #[inline(always)]
    pub fn add_values<const N: usize, const M: usize>(
        &self,
        given: &[[f64; M]; N],
        sums: &mut [[[f64; M]; N]],
    ) {
        let mut scaled = *given;
        for number in scaled.as_flattened_mut() {
            *number *= self.across[0];
        }
        for (node, value) in sums[self.first..self.first + W].iter_mut().zip(&self.values) {
            for i in 0..N {
                for j in 0..M {
                    node[i][j] += value * scaled[i][j];
                }
            }
        }
    }

    /// Adds what a point gives to the nodes of the run, times the gradients of its shape functions, `[direction]`.
    #[inline(always)]
    pub fn add_gradients<const N: usize>(&self, given: &[[Vector<D>; N]; D], sums: &mut [[Vector<D>; N]]) {
        let mut scaled = *given;
        for d in 0..D {
            for number in scaled[d].as_flattened_mut() {
                *number *= self.across[d];
            }
        }
        let nodes = some_mut::<_, W>(sums, self.first);
        for k in 0..W {
            for d in 0..D {
                let along = if d == 0 { self.gradients[k] } else { self.values[k] };
                for i in 0..N {
                    for j in 0..D {
                        nodes[k][i][j] += along * scaled[d][i][j];
                    }
                }
            }
        }
    }
}

impl<const D: usize, const W: usize> Stencils<D, W> {
    /// Room for `points` points of `parts` blocks each, all zero.
    pub fn new(points: usize, parts: usize) -> Self {
        let line = Line { values: [0.0; W], gradients: [0.0; W] };
        Self { first: vec![0; points * parts], lines: vec![[line; D]; points * parts], parts }
    }

    /// Forgets all points from a number on.
    pub fn truncate(&mut self, points: usize) {
        self.first.truncate(points * self.parts);
        self.lines.truncate(points * self.parts);
    }

    /// Sets a block from one row a direction.
    #[inline(always)]
    pub fn set(&mut self, grid: &Grid<D>, block: usize, rows: &[Row<W>; D]) {
        self.put(block, &Block::new(grid, rows));
    }

    /// Sets a block.
    #[inline(always)]
    pub fn put(&mut self, number: usize, block: &Block<D, W>) {
        self.first[number] = block.first;
        self.lines[number] = block.lines;
    }

    /// Lowest nodes and lines of so many points of one block each, to be set.
    #[inline(always)]
    pub fn blocks_mut(&mut self, points: usize) -> (&mut [usize], &mut [[Line<W>; D]]) {
        (&mut self.first[..points], &mut self.lines[..points])
    }

    /// Lowest node of each block, and along each direction which of its nodes it reaches: points whose domains touch a face
    /// reach others before their rows begin elsewhere.
    pub fn reach(&self) -> impl Iterator<Item = usize> + '_ {
        self.first.iter().zip(&self.lines).map(|(first, lines)| {
            let reached = lines.iter().flat_map(|line| line.values.iter().zip(&line.gradients));
            reached.fold(*first, |key, (value, gradient)| {
                2 * key + usize::from(*value != 0.0 || *gradient != 0.0)
            })
        })
    }

    /// Stencils of all points in turn.
    #[inline(always)]
    pub fn all(&self) -> impl Iterator<Item = Stencil<'_, D, W>> {
        // On a line a point has one block, and the compiler knows.
        let parts = if D == 1 { 1 } else { self.parts };
        let blocks = self.first.chunks_exact(parts).zip(self.lines.chunks_exact(parts));
        blocks.map(|(first, lines)| Stencil { first, lines })
    }

    /// Lowest nodes and lines as slices, for a loop over the numbers of so many points: an iterator's `next` is a function
    /// of its own, which the compiler may leave to narrow registers.
    #[inline(always)]
    pub fn slices(&self, points: usize) -> StencilSlices<'_, D, W> {
        // On a line a point has one block, and the compiler knows.
        let parts = if D == 1 { 1 } else { self.parts };
        StencilSlices { first: &self.first[..points * parts], lines: &self.lines[..points * parts], parts }
    }

    /// Stencil of a point.
    #[inline(always)]
    pub fn of_point(&self, point: usize) -> Stencil<'_, D, W> {
        // On a line a point has one block, and the compiler knows.
        let parts = if D == 1 { 1 } else { self.parts };
        let blocks = point * parts..(point + 1) * parts;
        Stencil { first: &self.first[blocks.clone()], lines: &self.lines[blocks] }
    }

    /// Gradients of a nodal vector field at all points, `[point][component][direction]`.
    #[inline(always)]
    pub fn take_gradients(&self, stride: &[usize; D], field: &[Vector<D>], gradients: &mut [Tensor<D>]) {
        let stencils = self.slices(gradients.len());
        for (point, gradient) in gradients.iter_mut().enumerate() {
            *gradient = stencils.of_point(point).gradient(stride, field);
        }
    }

    /// Hands every run of every point to a function, with what the point gives.
    #[inline(always)]
    fn give<G>(&self, stride: &[usize; D], given: impl Fn(usize) -> G, mut add: impl FnMut(&Run<D, W>, &G)) {
        for (point, stencil) in self.all().enumerate() {
            let given = given(point);
            stencil.visit_runs(
                stride,
                #[inline(always)]
                |run| add(run, &given),
            );
        }
    }
}

/// [`Stencils`] of so many points as slices.
#[derive(Clone, Copy)]
pub struct StencilSlices<'a, const D: usize, const W: usize> {
    first: &'a [usize],
    lines: &'a [[Line<W>; D]],
    parts: usize,
}

impl<'a, const D: usize, const W: usize> StencilSlices<'a, D, W> {
    /// Stencil of a point.
    #[inline(always)]
    pub fn of_point(&self, point: usize) -> Stencil<'a, D, W> {
        if self.parts == 1 {
            return Stencil::of_block(&self.first[point], &self.lines[point]);
        }
        let blocks = point * self.parts..(point + 1) * self.parts;
        Stencil { first: &self.first[blocks.clone()], lines: &self.lines[blocks] }
    }
}

/// Lowest node and lines of a block.
#[derive(Clone, Copy, Debug)]
pub struct Block<const D: usize, const W: usize> {
    /// Flat index of the lowest node.
    pub first: usize,
    /// One line a direction.
    pub lines: [Line<W>; D],
}

impl<const D: usize, const W: usize> Block<D, W> {
    /// The block of one row a direction.
    #[inline(always)]
    pub fn new(grid: &Grid<D>, rows: &[Row<W>; D]) -> Self {
        let first = (0..D).map(|d| rows[d].first * grid.node_stride()[d]).sum();
        Self::from_lines(first, &rows.map(|row| [row.values, row.gradients]), grid.inverse_cell_size())
    }

    /// The block of a lowest node, and of values and gradients, 1/cell, along each direction; `per_cell` in 1/m.
    #[inline(always)]
    pub fn from_lines(first: usize, rows: &[[[f64; W]; 2]; D], per_cell: f64) -> Self {
        let mut lines = [Line { values: [0.0; W], gradients: [0.0; W] }; D];
        for d in 0..D {
            let [values, gradients] = &rows[d];
            lines[d].values = *values;
            for k in 0..W {
                lines[d].gradients[k] = gradients[k] * per_cell;
            }
        }
        Self { first, lines }
    }

    /// The shape functions of a point that has this block alone.
    #[inline(always)]
    pub fn stencil(&self) -> Stencil<'_, D, W> {
        Stencil::of_block(&self.first, &self.lines)
    }
}

/// Shape functions of one point.
#[derive(Clone, Copy, Debug)]
pub struct Stencil<'a, const D: usize, const W: usize> {
    first: &'a [usize],
    lines: &'a [[Line<W>; D]],
}

impl<'a, const D: usize, const W: usize> Stencil<'a, D, W> {
    /// The shape functions of a point that has one block, of a lowest node and one line a direction.
    #[inline(always)]
    pub fn of_block(first: &'a usize, lines: &'a [Line<W>; D]) -> Self {
        Self { first: std::slice::from_ref(first), lines: std::slice::from_ref(lines) }
    }

    /// Visits the nodes of the point run by run, except runs on which all is zero.
    #[inline(always)]
    pub fn visit_runs(self, stride: &[usize; D], mut visitor: impl FnMut(&Run<D, W>)) {
        for (lowest, lines) in self.first.iter().zip(self.lines) {
            let Line { values, gradients } = lines[0];
            for number in 0..power(W, D - 1) {
                let (mut first, mut across, mut rest) = (*lowest, [1.0; D], number);
                for direction in 1..D {
                    let k = rest % W;
                    rest /= W;
                    first += k * stride[direction];
                    for (component, factor) in across.iter_mut().enumerate() {
                        let line = &lines[direction];
                        *factor *= if component == direction { line.gradients[k] } else { line.values[k] };
                    }
                }
                if D == 1 || across != [0.0; D] {
                    visitor(&Run { first, values, gradients, across });
                }
            }
        }
    }

    /// Visits the nodes of the point with value and gradient (1/m).
    #[inline(always)]
    pub fn visit(self, stride: &[usize; D], mut visitor: impl FnMut(usize, f64, &Vector<D>)) {
        self.visit_runs(
            stride,
            #[inline(always)]
            |run| {
                for k in 0..W {
                    visitor(run.first + k, run.value(k), &run.gradient(k));
                }
            },
        );
    }

    /// Values at the point of nodal vectors that lie side by side: `Σ N f`.
    #[inline(always)]
    pub fn values_of<const N: usize>(self, stride: &[usize; D], nodal: &[[Vector<D>; N]]) -> [Vector<D>; N] {
        let mut values = [[0.0; D]; N];
        self.visit_runs(
            stride,
            #[inline(always)]
            |run| {
                let nodes = &nodal[run.first..run.first + W];
                // The vectors of a node as one row of numbers, which fills wide registers.
                let mut sums = nodes[0];
                for number in sums.as_flattened_mut() {
                    *number *= run.values[0];
                }
                for k in 1..W {
                    let numbers = nodes[k].as_flattened();
                    for (sum, number) in sums.as_flattened_mut().iter_mut().zip(numbers) {
                        *sum += run.values[k] * number;
                    }
                }
                for (value, sum) in values.as_flattened_mut().iter_mut().zip(sums.as_flattened()) {
                    *value += run.across[0] * sum;
                }
            },
        );
        // In memory: otherwise the compiler sums by vectors, which fill half a wide register.
        black_box(values)
    }

    /// Values of nodal vector fields at the point: `Σ N f`.
    #[inline(always)]
    pub fn values<const N: usize>(self, stride: &[usize; D], fields: [&[Vector<D>]; N]) -> [Vector<D>; N] {
        let mut values = [[0.0; D]; N];
        self.visit_runs(
            stride,
            #[inline(always)]
            |run| {
                for (value, field) in values.iter_mut().zip(fields) {
                    let nodes = &field[run.first..run.first + W];
                    let mut sum = [0.0; D];
                    for k in 0..W {
                        for d in 0..D {
                            sum[d] += run.values[k] * nodes[k][d];
                        }
                    }
                    for d in 0..D {
                        value[d] += run.across[0] * sum[d];
                    }
                }
            },
        );
        values
    }

    /// Gradient of a nodal vector field at the point, `[component][direction]`: `Σ f ⊗ ∇N`.
    #[inline(always)]
    pub fn gradient(self, stride: &[usize; D], field: &[Vector<D>]) -> Tensor<D> {
        // `[direction][component]`: components lie side by side at the nodes.
        let mut slopes = [[0.0; D]; D];
        self.visit_runs(
            stride,
            #[inline(always)]
            |run| {
                let nodes = &field[run.first..run.first + W];
                let [mut slope, mut value] = [[0.0; D]; 2];
                for k in 0..W {
                    for d in 0..D {
                        slope[d] += run.gradients[k] * nodes[k][d];
                        value[d] += run.values[k] * nodes[k][d];
                    }
                }
                for direction in 0..D {
                    let sum = if direction == 0 { &slope } else { &value };
                    for d in 0..D {
                        slopes[direction][d] += run.across[direction] * sum[d];
                    }
                }
            },
        );
        let mut gradient = slopes;
        for component in 0..D {
            for direction in 0..D {
                gradient[component][direction] = slopes[direction][component];
            }
        }
        gradient
    }
}

/// [`Stencils`] as wide as those of a basis: the width is looked at once for a loop over all points.
#[derive(Clone, Debug, PartialEq)]
pub enum PointStencils<const D: usize> {
    /// Two nodes per direction.
    Two(Stencils<D, 2>),
    /// Three.
    Three(Stencils<D, 3>),
    /// Four.
    Four(Stencils<D, 4>),
}

/// Evaluates an expression with the [`Stencils`] of a [`PointStencils`], of whatever width, under a name.
macro_rules! with_stencils {
    ($point_stencils:expr, $name:ident => $result:expr) => {
        match $point_stencils {
            $crate::operators::stencil::PointStencils::Two($name) => $result,
            $crate::operators::stencil::PointStencils::Three($name) => $result,
            $crate::operators::stencil::PointStencils::Four($name) => $result,
        }
    };
}
pub(crate) use with_stencils;

impl<const D: usize> Default for PointStencils<D> {
    fn default() -> Self {
        Self::Two(Stencils::default())
    }
}

impl<const D: usize> PointStencils<D> {
    /// Which nodes each block reaches, as [`Stencils::reach`].
    pub fn reach(&self) -> Vec<usize> {
        with_stencils!(self, stencils => stencils.reach().collect())
    }

    /// Whether the blocks reach those nodes; nothing is allocated.
    pub fn reaches(&self, known: &[usize]) -> bool {
        with_stencils!(self, stencils => stencils.reach().eq(known.iter().copied()))
    }

    /// Visits the nodes of a point with value and gradient (1/m).
    #[inline]
    pub fn visit(&self, stride: &[usize; D], point: usize, visitor: impl FnMut(usize, f64, &Vector<D>)) {
        with_stencils!(self, stencils => stencils.of_point(point).visit(stride, visitor));
    }

    /// Value of a nodal vector field at a point.
    #[inline]
    pub fn value(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Vector<D> {
        let [value] = with_stencils!(self, stencils => stencils.of_point(point).values(stride, [field]));
        value
    }

    /// Gradient of a nodal vector field at a point, `[component][direction]`.
    #[inline]
    pub fn gradient(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> Tensor<D> {
        with_stencils!(self, stencils => stencils.of_point(point).gradient(stride, field))
    }

    /// Divergence of a nodal vector field at a point.
    #[inline]
    pub fn divergence(&self, stride: &[usize; D], point: usize, field: &[Vector<D>]) -> f64 {
        let gradient = self.gradient(stride, point, field);
        (0..D).map(|d| gradient[d][d]).sum()
    }

    /// Sums what each point gives to its nodes, times its shape functions: `Σ_p N_ip g_p`.
    pub fn sum_values<const N: usize, const M: usize>(
        &self,
        stride: &[usize; D],
        given: impl Fn(usize) -> [[f64; M]; N],
        sums: &mut [[[f64; M]; N]],
    ) {
        sums.fill([[0.0; M]; N]);
        with_stencils!(self, stencils => wide!(stencils.give(
            stride,
            given,
            #[inline(always)]
            |run, given| run.add_values(given, sums),
        )));
    }

    /// Sums what each point gives to its nodes, times the gradients of its shape functions: `Σ_p Σ_d ∂_d N_ip g_pd`.
    pub fn sum_gradients<const N: usize>(
        &self,
        stride: &[usize; D],
        given: impl Fn(usize) -> [[Vector<D>; N]; D],
        sums: &mut [[Vector<D>; N]],
    ) {
        sums.fill([[0.0; D]; N]);
        with_stencils!(self, stencils => wide!(stencils.give(
            stride,
            given,
            #[inline(always)]
            |run, given| run.add_gradients(given, sums),
        )));
    }

    /// The nodes of a point with their gradients (1/m), where they are not zero: the divergence at the point as a
    /// functional of a nodal field.
    pub fn gradient_row(&self, grid: &Grid<D>, point: usize) -> Vec<(usize, Vector<D>)> {
        let mut row: Vec<(usize, Vector<D>)> = Vec::new();
        self.visit(grid.node_stride(), point, |node, _, gradient| {
            if *gradient == [0.0; D] {
                return;
            }
            match row.iter_mut().find(|(other, _)| *other == node) {
                Some((_, sum)) => (0..D).for_each(|d| sum[d] += gradient[d]),
                None => row.push((node, *gradient)),
            }
        });
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point at the lower left corner of a cell, where hats have no value but a gradient at the nodes beyond.
    fn at_a_corner(grid: &Grid<2>) -> Stencils<2, 2> {
        let mut stencils = Stencils::new(1, 1);
        stencils.set(grid, 0, &[Row { first: 2, values: [1.0, 0.0], gradients: [-1.0, 1.0] }; 2]);
        stencils
    }

    #[test]
    fn a_node_of_no_value_counts_by_its_gradient() {
        let grid = Grid::new(0.5, [4, 3]);
        let stencils = at_a_corner(&grid);
        let field: Vec<Vector<2>> = (0..grid.node_count()).map(|node| grid.node_position(node)).collect();
        let gradient = stencils.of_point(0).gradient(grid.node_stride(), &field);
        assert_eq!(gradient, [[1.0, 0.0], [0.0, 1.0]]);
        let mut flat = Stencils::<2, 2>::new(1, 1);
        flat.set(&grid, 0, &[Row { first: 2, values: [1.0, 0.0], gradients: [-1.0, 0.0] }; 2]);
        assert!(stencils.reach().ne(flat.reach()));
    }

    #[test]
    fn sums_to_the_nodes_are_adjoint_to_values_and_gradients_at_the_points() {
        let grid = Grid::new(0.5, [4, 3]);
        let mut stencils = Stencils::<2, 3>::new(5, 1);
        for point in 0..5 {
            let row = |d: usize| Row {
                first: 2 + (point + d) % 3,
                values: [0.25, 0.5, 0.25 + 0.1 * point as f64],
                gradients: [-1.0, 0.25, 0.75 + d as f64],
            };
            stencils.set(&grid, point, &[row(0), row(1)]);
        }
        let (basis, stride) = (PointStencils::Three(stencils), grid.node_stride());
        let nodes = grid.node_count();
        let field: Vec<Vector<2>> =
            (0..nodes).map(|node| [(node as f64).sin(), (1.3 * node as f64).cos()]).collect();
        let given = |point: usize| [1.0 + point as f64, -0.5];
        let mut sums = vec![[[0.0; 2]; 1]; nodes];
        basis.sum_values(stride, |point| [given(point)], &mut sums);
        let product = |sums: &[[Vector<2>; 1]]| -> f64 {
            sums.iter().zip(&field).map(|([sum], at)| sum[0] * at[0] + sum[1] * at[1]).sum()
        };
        let of_points = |of: &dyn Fn(usize) -> f64| (0..5).map(of).sum::<f64>();
        let values = of_points(&|point| {
            let (value, given) = (basis.value(stride, point, &field), given(point));
            value[0] * given[0] + value[1] * given[1]
        });
        assert!((product(&sums) - values).abs() < 1e-13);
        // `σ ∇N` with σ = [[a, b], [0, a]] against σ : ∇v.
        let tensor = |point: usize| [[given(point)[0], given(point)[1]], [0.0, given(point)[0]]];
        let columns = |point: usize| {
            let sigma = tensor(point);
            [[[sigma[0][0], sigma[1][0]]], [[sigma[0][1], sigma[1][1]]]]
        };
        basis.sum_gradients(stride, columns, &mut sums);
        let work = of_points(&|point| {
            let (gradient, sigma) = (basis.gradient(stride, point, &field), tensor(point));
            (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).map(|(i, j)| sigma[i][j] * gradient[i][j]).sum()
        });
        assert!((product(&sums) - work).abs() < 1e-12 && work.abs() > 1.0);
        let mut visited = [0.0; 2];
        basis.visit(stride, 3, |node, value, _| (0..2).for_each(|d| visited[d] += value * field[node][d]));
        let direct = basis.value(stride, 3, &field);
        assert!((0..2).all(|d| (visited[d] - direct[d]).abs() < 1e-14));
    }
}
