//! Cell-averaged projection. Own invention; the best of the race at 15 % strain (docs/methods.md).
//!
//! A cell has several points but one pressure increment and, a direction, one strain. How stress is
//! spread over the points of a cell is history: as long as points stay in their cells it is the
//! operators' own image of smooth fields, but once they cross faces, what an early, badly resolved
//! front left there stays for ever, and costs the patch an order. Here the points of a cell follow,
//! at the end of every step, the parabola whose means over the cell and its neighbours are those of
//! the points: conservative in each cell, exact for quadratic fields, idempotent while nothing moves.
//! (The null space of the points-to-grid map is what Tran & Sołowski 2019 filter for stresses.)

use crate::operators::stacked_points::StackedPoints;
use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::state::points::Points;
use oedometer_soil::tensor::Vector;

/// Places of the points in their cells, and room for one field at a time; flat index = cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellAverages<const D: usize> {
    /// Initial volume of the cell's points, m^D.
    weight: Vec<f64>,
    /// Their mean place, m.
    centre: Vec<Vector<D>>,
    /// Their mean square distance from it, a direction, m².
    spread: Vec<Vector<D>>,
    /// Mean of the field.
    mean: Vec<f64>,
    /// Slope of the field, a direction, 1/m.
    slope: Vec<Vector<D>>,
    /// Half its second derivative, a direction, 1/m².
    bend: Vec<Vector<D>>,
    /// Points that lie one above another, where they do.
    stacked: Option<StackedPoints>,
}

impl<const D: usize> CellAverages<D> {
    /// Room for the cells of a grid; with the points that lie one above another, where they do.
    pub fn new(grid: &Grid<D>, stacked: Option<StackedPoints>) -> Self {
        let count = grid.cell_count();
        let (scalars, vectors) = (vec![0.0; count], vec![[0.0; D]; count]);
        Self {
            weight: scalars.clone(),
            centre: vectors.clone(),
            spread: vectors.clone(),
            mean: scalars,
            slope: vectors.clone(),
            bend: vectors,
            stacked,
        }
    }

    /// Records the places of the points in the cells that they were last located in.
    fn place(&mut self, cells: &Cells<D>, points: &Points<D>) {
        self.weight.fill(0.0);
        self.centre.fill([0.0; D]);
        self.spread.fill([0.0; D]);
        for point in 0..points.len() {
            let (cell, weight) = (cells.of_point[point], points.initial_volume[point]);
            self.weight[cell] += weight;
            for d in 0..D {
                self.centre[cell][d] += weight * points.position[point][d];
            }
        }
        for cell in cells.occupied() {
            self.centre[cell] = self.centre[cell].map(|sum| sum / self.weight[cell]);
        }
        for point in 0..points.len() {
            let cell = cells.of_point[point];
            let share = points.initial_volume[point] / self.weight[cell];
            for d in 0..D {
                let distance = points.position[point][d] - self.centre[cell][d];
                self.spread[cell][d] += share * distance * distance;
            }
        }
    }

    /// Fits the parabolas to a field of the points.
    fn fit(
        &mut self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        initial_volume: &[f64],
        field: impl Fn(usize) -> f64,
    ) {
        self.mean.fill(0.0);
        for (point, volume) in initial_volume.iter().enumerate() {
            self.mean[cells.of_point[point]] += volume * field(point);
        }
        for cell in cells.occupied() {
            self.mean[cell] /= self.weight[cell];
        }
        for cell in cells.occupied() {
            for d in 0..D {
                let (slope, bend) = self.parabola(grid, cells, cell, d);
                self.slope[cell][d] = slope;
                self.bend[cell][d] = bend;
            }
        }
    }

    /// Slope and half the second derivative of the parabola through a cell's mean and two others':
    /// those of both neighbours, or of two on one side; with one neighbour, a line.
    #[inline]
    fn parabola(&self, grid: &Grid<D>, cells: &Cells<D>, cell: usize, d: usize) -> (f64, f64) {
        let stride = grid.cell_stride()[d];
        let [lower, upper] = [cell - stride, cell + stride];
        let (near, far) = match (cells.is_occupied(lower), cells.is_occupied(upper)) {
            (true, true) => (lower, Some(upper)),
            (true, false) => (lower, cell.checked_sub(2 * stride)),
            (false, true) => (upper, Some(cell + 2 * stride)),
            (false, false) => return (0.0, 0.0),
        };
        let far = far.filter(|far| *far < self.weight.len() && cells.is_occupied(*far));
        let difference = |other: usize| {
            let distance = self.centre[other][d] - self.centre[cell][d];
            let square = distance * distance + self.spread[other][d] - self.spread[cell][d];
            (distance, square, self.mean[other] - self.mean[cell])
        };
        let (x1, s1, f1) = difference(near);
        let Some((x2, s2, f2)) = far.map(difference) else { return (f1 / x1, 0.0) };
        let per_determinant = 1.0 / (x1 * s2 - x2 * s1);
        ((f1 * s2 - f2 * s1) * per_determinant, (x1 * f2 - x2 * f1) * per_determinant)
    }

    /// Value of the parabola at a place in a cell.
    #[inline]
    fn value(&self, cell: usize, place: &Vector<D>) -> f64 {
        let mut value = self.mean[cell];
        for d in 0..D {
            let distance = place[d] - self.centre[cell][d];
            value += self.slope[cell][d] * distance
                + self.bend[cell][d] * (distance * distance - self.spread[cell][d]);
        }
        value
    }

    /// Spreads pressure, effective stress and volume ratio over the points of each cell by the
    /// parabolas through the cells' means.
    pub fn spread_over_points(&mut self, grid: &Grid<D>, cells: &Cells<D>, points: &mut Points<D>) {
        self.place(cells, points);
        self.fit(grid, cells, &points.initial_volume, |point| points.volume_ratio[point]);
        for point in 0..points.len() {
            let ratio = self.value(cells.of_point[point], &points.position[point]);
            // The domains still tile the material: what they fill does not change.
            points.stressed_share[point] *= points.volume_ratio[point] / ratio;
            points.volume_ratio[point] = ratio;
        }
        if let Some(stacked) = &self.stacked {
            stacked.share_out(grid, &cells.of_point, points);
        }
        self.fit(grid, cells, &points.initial_volume, |point| points.pressure[point]);
        for point in 0..points.len() {
            points.pressure[point] = self.value(cells.of_point[point], &points.position[point]);
        }
        for (i, j) in (0..D).flat_map(|i| (i..D).map(move |j| (i, j))) {
            self.fit(grid, cells, &points.initial_volume, |point| points.effective_stress[point][i][j]);
            for point in 0..points.len() {
                let value = self.value(cells.of_point[point], &points.position[point]);
                points.effective_stress[point][i][j] = value;
                points.effective_stress[point][j][i] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::material::Material;

    /// Points of ten cells, shifted by a share of a cell and squeezed towards the base.
    fn crossed() -> (Grid<1>, Points<1>, Cells<1>) {
        let grid = Grid::new(0.1, [12]);
        let mut points = Points::<1>::lattice(0.1, [10], 3);
        for place in &mut points.position {
            place[0] = 0.037 + 0.9 * place[0] + 0.02 * place[0] * place[0];
        }
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, &[Material::default()]);
        (grid, points, cells)
    }

    fn spread(field: &[f64]) -> Vec<f64> {
        let (grid, points, cells) = crossed();
        let mut memory = CellAverages::new(&grid, None);
        memory.place(&cells, &points);
        memory.fit(&grid, &cells, &points.initial_volume, |point| field[point]);
        (0..points.len()).map(|point| memory.value(cells.of_point[point], &points.position[point])).collect()
    }

    #[test]
    fn cell_averages_reproduce_a_quadratic_field() {
        let (_, points, _) = crossed();
        let field: Vec<f64> = points.position.iter().map(|x| 3.0 - 2.0 * x[0] + 5.0 * x[0] * x[0]).collect();
        for (got, exact) in spread(&field).iter().zip(&field) {
            assert!((got - exact).abs() < 1e-12, "{got} for {exact}");
        }
    }

    proptest::proptest! {
        #[test]
        fn cell_averages_keep_means_and_are_idempotent(
            field in proptest::collection::vec(-1.0..1.0_f64, 30)
        ) {
            let (_, points, cells) = crossed();
            let once = spread(&field);
            for cell in cells.occupied() {
                let sum = |values: &[f64]| -> f64 {
                    (0..values.len())
                        .filter(|point| cells.of_point[*point] == cell)
                        .map(|point| points.initial_volume[point] * values[point])
                        .sum()
                };
                proptest::prop_assert!((sum(&once) - sum(&field)).abs() < 1e-14);
            }
            for (twice, once) in spread(&once).iter().zip(&once) {
                proptest::prop_assert!((twice - once).abs() < 1e-12);
            }
        }
    }
}
