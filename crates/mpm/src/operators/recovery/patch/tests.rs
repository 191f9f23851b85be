//! Patches against the fit by the normal equations, and what they reproduce.

use super::*;
use crate::state::grid::GHOST_LAYERS;
use crate::state::points::Points;
use oedometer_soil::material::Material;
use proptest::prelude::*;

fn recovered<const D: usize>(
    grid: &Grid<D>,
    points: &Points<D>,
    field: impl Fn(&Vector<D>) -> f64,
) -> Vec<(f64, f64)> {
    let mut cells = Cells::new(grid, points.len());
    cells.locate(grid, points, &[Material::default()]);
    let mut rows = PatchRows::new(points.len(), grid);
    rows.build(grid, &cells);
    let at_cells: Vec<f64> = (0..grid.cell_count()).map(|cell| field(&grid.cell_centre(cell))).collect();
    let mut values = vec![0.0; points.len()];
    rows.recover(grid, &cells, &at_cells, &mut values, |place, value| *place = value);
    values.into_iter().zip(points.position.iter().map(field)).collect()
}

proptest! {
    #[test]
    fn a_plane_is_recovered_exactly_in_every_cell(a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64,
                                                  jitter in proptest::collection::vec(-0.2..0.2f64, 48)) {
        let grid = Grid::new(0.5, [3, 4]);
        let mut points = Points::lattice(0.5, [3, 4], 2);
        for (place, nudge) in points.position.iter_mut().zip(&jitter) {
            place[0] += 0.5 * nudge;
            place[1] -= 0.5 * nudge;
        }
        for (got, exact) in recovered(&grid, &points, |x| a + b * x[0] + c * x[1]) {
            prop_assert!((got - exact).abs() < 1e-13, "{got} for {exact}");
        }
    }
}

#[test]
fn a_line_is_recovered_exactly_in_a_column_and_in_its_boundary_cells() {
    let grid = Grid::new(0.1, [12]);
    for per_cell in [3, 4] {
        let points = Points::lattice(0.1, [10], per_cell);
        for (got, exact) in recovered(&grid, &points, |x| 2.0 - 5.0 * x[0]) {
            assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
        }
    }
}

#[test]
fn a_line_is_recovered_exactly_in_a_plane_column_of_one_cell() {
    let grid = Grid::new(0.1, [1, 12]);
    let points = Points::lattice(0.1, [1, 10], 2);
    for (got, exact) in recovered(&grid, &points, |x| 2.0 - 5.0 * x[1]) {
        assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
    }
}

/// The row of a point in a cell of which only some of the neighbours are occupied, and that of its fit.
fn both_rows<const D: usize>(place: Vector<D>, is_occupied: impl Fn(&[usize; D]) -> bool) -> [Vec<f64>; 2] {
    let grid = Grid::new(1.0, [3; D]);
    let mut points = Points::lattice(1.0, [3; D], 1);
    let centre = points.len() / 2;
    let keep: Vec<usize> = (0..points.len())
        .filter(|point| {
            let cell = grid.cell_of(&points.position[*point]).map(|index| index - GHOST_LAYERS);
            *point == centre || is_occupied(&cell)
        })
        .collect();
    points = points.select(&keep);
    let point = keep.iter().position(|kept| *kept == centre).expect("the middle");
    points.position[point] = place.map(|x| 1.0 + x);
    let mut cells = Cells::new(&grid, points.len());
    cells.locate(&grid, &points, &[Material::default()]);
    let mut rows = PatchRows::new(points.len(), &grid);
    rows.build(&grid, &cells);
    let mut fitted = vec![0.0; power(BLOCK, D)];
    fit(&grid, cells.of_point[point], &cells.place[point], &mut fitted, |cell| cells.is_occupied(cell));
    [rows.row(&grid, &cells, point).into_iter().map(|entry| entry.1).collect(), fitted]
}

#[test]
fn closed_forms_are_the_fit_in_a_column_and_for_every_pattern_of_a_plane() {
    for step in 0..40 {
        let place = f64::from(step) / 40.0;
        for pattern in 0..4 {
            let [got, fitted] = both_rows([place], |[cell]| pattern >> (cell / 2) & 1 == 1);
            for (got, fitted) in got.iter().zip(&fitted) {
                assert!((got - fitted).abs() < 1e-14, "{got} for {fitted} at {place}");
            }
        }
    }
    for pattern in 0..512 {
        let place = [0.3 + 0.001 * f64::from(pattern), 0.9 - 0.0015 * f64::from(pattern)];
        let [got, fitted] = both_rows(place, |[x, y]| pattern >> (x + 3 * y) & 1 == 1);
        for (got, fitted) in got.iter().zip(&fitted) {
            assert!((got - fitted).abs() < 1e-13, "{got} for {fitted} in pattern {pattern}");
        }
    }
}

#[test]
fn closed_forms_are_the_fit_in_a_column_of_one_cell_across() {
    let (grid, mut points) = (Grid::new(0.5, [1, 4]), Points::<2>::lattice(0.5, [1, 4], 2));
    for (point, place) in points.position.iter_mut().enumerate() {
        let nudge = 0.02 * (1.7 * point as f64).sin();
        *place = [place[0] + nudge, place[1] - nudge];
    }
    let mut cells = Cells::new(&grid, points.len());
    cells.locate(&grid, &points, &[Material::default()]);
    let mut rows = PatchRows::new(points.len(), &grid);
    rows.build(&grid, &cells);
    for point in 0..points.len() {
        let mut fitted = vec![0.0; power(BLOCK, 2)];
        fit(&grid, cells.of_point[point], &cells.place[point], &mut fitted, |cell| cells.is_occupied(cell));
        for ((_, weight), fitted) in rows.row(&grid, &cells, point).iter().zip(&fitted) {
            assert!((weight - fitted).abs() < 1e-14, "{weight} for {fitted} at {point}");
        }
    }
}

#[test]
fn too_few_cells_drop_the_order_and_never_divide_by_zero() {
    let one_cell = recovered(&Grid::new(1.0, [1]), &Points::lattice(1.0, [1], 2), |x| 1.0 + x[0]);
    assert_eq!(one_cell[0].0, 1.5, "one cell: its own value");
    // A column one cell wide in 2D: the plane has no slope across.
    let narrow = recovered(&Grid::new(1.0, [1, 4]), &Points::lattice(1.0, [1, 4], 2), |x| 3.0 * x[1]);
    for (got, exact) in narrow {
        assert!((got - exact).abs() < 1e-13);
    }
    // Cells along a diagonal lie on a line: constant, finite.
    let mut points = Points::<2>::lattice(1.0, [2, 2], 1);
    points.position = vec![[0.5, 0.5], [0.5, 0.5], [1.5, 1.5], [1.5, 1.5]];
    for (got, _) in recovered(&Grid::new(1.0, [2, 2]), &points, |x| x[0] + 2.0 * x[1]) {
        assert!(got.is_finite() && (1.5..=4.5).contains(&got));
    }
}

#[test]
fn the_recovery_never_turns_a_pressure_wave_round() {
    // Fourier symbol of patch recovery followed by the mean over the cell's points.
    let grid = Grid::new(1.0, [9]);
    for per_cell in 1..=4 {
        let points = Points::lattice(1.0, [9], per_cell);
        for step in 0..=32 {
            let theta = std::f64::consts::PI * f64::from(step) / 32.0;
            let wave = recovered(&grid, &points, |x| (theta * (x[0] - 4.5)).cos());
            let middle = &wave[4 * per_cell..5 * per_cell];
            let symbol: f64 = middle.iter().map(|pair| pair.0).sum::<f64>() / per_cell as f64;
            assert!(symbol > 0.0, "symbol {symbol} at θ = {theta}, {per_cell} points per cell");
        }
    }
}

fn assert_same_side_by_side<const D: usize>(extent: [usize; D], per_cell: usize) {
    let grid = Grid::new(0.5, extent);
    let mut points = Points::lattice(0.5, extent, per_cell);
    points.position.iter_mut().flatten().for_each(|place| *place *= 0.93);
    let mut cells = Cells::new(&grid, points.len());
    cells.locate(&grid, &points, &[Material::default()]);
    let mut rows = PatchRows::new(points.len(), &grid);
    rows.look_around(&grid, &cells);
    let fitting = rows.fitting(&grid, &cells, points.len());
    let field: Vec<f64> = (0..grid.cell_count()).map(|cell| (1.3 * cell as f64).sin()).collect();
    let mut together = 0;
    for first in 0..points.len() {
        let Some(values) = fitting.values::<LANES>(&field, first) else { continue };
        together += 1;
        for p in 0..LANES {
            assert_eq!(values[p], fitting.value(&field, first + p), "point {}", first + p);
        }
    }
    assert!(together > 0 && together < points.len() - LANES, "{together} have cells of one shape");
}

#[test]
fn values_side_by_side_are_those_of_each_point() {
    assert_same_side_by_side([5], 3);
    assert_same_side_by_side([5, 4], 2);
    assert_same_side_by_side([1, 4], 4);
}

#[test]
fn rows_follow_the_occupied_cells() {
    let grid = Grid::new(0.5, [3, 6]);
    let mut points = Points::lattice(0.5, [3, 4], 2);
    let (mut cells, mut rows) = (Cells::new(&grid, points.len()), PatchRows::new(points.len(), &grid));
    let mut shapes = Vec::new();
    for _ in 0..10 {
        points.position.iter_mut().for_each(|place| place[1] += 0.1);
        cells.locate(&grid, &points, &[Material::default()]);
        rows.look_around(&grid, &cells);
        let mut anew = PatchRows::new(points.len(), &grid);
        anew.look_around(&grid, &cells);
        let sides = |rows: &PatchRows<2>| cells.occupied().map(|cell| rows.sides[cell]).collect::<Vec<_>>();
        assert_eq!(sides(&rows), sides(&anew));
        shapes.push(cells.changes());
    }
    shapes.dedup();
    assert!(
        (2..10).contains(&shapes.len()),
        "some steps change the occupied cells, others do not: {shapes:?}"
    );
}
