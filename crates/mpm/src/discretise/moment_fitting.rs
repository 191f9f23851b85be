//! Moment-fitted volumes: what points off their lattice integrate, so that stresses which are constant or linear over a
//! cell give the forces of their integral.
//!
//! ```text
//! w_p = V_p (a + b·ξ_p),   Σ_c w_p = V_c,   Σ_c w_p ξ_p = 0,   ξ_p = (x_p − x_c)/h
//! ```
//!
//! over the points of each cell, where `V_c` and `x_c` are volume and centroid of what the body fills of the cell: of all
//! weights that integrate constant and linear fields, those that change the volumes least (weighted by `1/V_p`). Fitting the
//! weights of given points to moments is Müller, Kummer & Oberlack's way (2013) to integrate over cut cells.

use crate::state::grid::{GHOST_LAYERS, Grid};
use crate::state::points::Points;
use oedometer_soil::tensor::Vector;

/// Least share that a point keeps of what it had if the volumes of a cell were fitted to the constant alone: a volume has
/// a mass.
const LEAST_SHARE: f64 = 0.1;
/// Spread of the points of a cell along a direction, as the mean of `ξ²`, below which they have no slope in it.
const LEAST_SPREAD: f64 = 1e-6;

/// Moments of the points of a cell: `Σ V`, `Σ V ξ` and `Σ V ξξᵀ` as one symmetric matrix over `[1, ξ]`; directions that a
/// column lacks stay zero.
type Moments = [[f64; 3]; 3];

/// A block of cells that a body fills from the base up to a level surface.
#[derive(Clone, Debug)]
struct FilledCells<const D: usize> {
    grid: Grid<D>,
    /// Height of the surface, m.
    surface: f64,
}

/// Gives the points of a body the volumes that integrate constant and linear fields over each cell, and lets the domains
/// of the topmost ones end in the surface.
///
/// The body fills the cells of edge `cell_size` (m) over `extent` up to a height `surface` (m). Where one of its cells
/// has no point, all points keep their volumes.
pub fn fit_volumes<const D: usize>(points: &mut Points<D>, cell_size: f64, extent: [usize; D], surface: f64) {
    let cells = FilledCells { grid: Grid::new(cell_size, extent), surface };
    let home: Vec<usize> = points.position.iter().map(|place| cells.home(place)).collect();
    let mut moments = vec![Moments::default(); cells.grid.cell_count()];
    for (point, cell) in home.iter().enumerate() {
        let row = row_of(&cells.offset(*cell, &points.position[point]));
        for i in 0..3 {
            for j in 0..3 {
                moments[*cell][i][j] += points.initial_volume[point] * row[i] * row[j];
            }
        }
    }
    if cells.inside().any(|cell| moments[cell][0][0] == 0.0) {
        return;
    }
    let fitted: Vec<f64> = home
        .iter()
        .enumerate()
        .map(|(point, cell)| {
            let row = row_of(&cells.offset(*cell, &points.position[point]));
            let factors = factors_of(&moments[*cell], cells.volume(*cell));
            points.initial_volume[point] * (0..3).map(|i| factors[i] * row[i]).sum::<f64>()
        })
        .collect();
    // Where one would keep next to nothing or less, the points of its cell go as much of the way as they can.
    let mut way = vec![1.0_f64; moments.len()];
    let constant =
        |point: usize| points.initial_volume[point] * cells.volume(home[point]) / moments[home[point]][0][0];
    for (point, fitted) in fitted.iter().enumerate() {
        let constant = constant(point);
        if *fitted < LEAST_SHARE * constant {
            let most = (1.0 - LEAST_SHARE) * constant / (constant - fitted);
            way[home[point]] = way[home[point]].min(most);
        }
    }
    let volumes = fitted.iter().enumerate().map(|(point, fitted)| {
        let constant = constant(point);
        constant + way[home[point]] * (fitted - constant)
    });
    points.initial_volume = volumes.collect();
    end_in_surface(points, surface);
}

/// Lets the domains of the topmost points end in the surface, m.
fn end_in_surface<const D: usize>(points: &mut Points<D>, surface: f64) {
    let up = D - 1;
    let highest = points.position.iter().map(|place| place[up]).fold(0.0, f64::max);
    for (place, half_length) in points.position.iter().zip(&mut points.half_length) {
        if place[up] > highest - 1e-9 * surface {
            half_length[up] = surface - place[up];
        }
    }
}

/// The row `[1, ξ]` of a point.
fn row_of<const D: usize>(offset: &Vector<D>) -> [f64; 3] {
    let mut row = [1.0, 0.0, 0.0];
    row[1..=D].copy_from_slice(offset);
    row
}

/// `[a, b]` of a cell of a volume, m^D: the solution of its moments without directions in which its points have no spread.
fn factors_of(moments: &Moments, volume: f64) -> [f64; 3] {
    let mut matrix = *moments;
    let mut right = [volume, 0.0, 0.0];
    let is_spanned = |pivot: f64| pivot > LEAST_SPREAD * moments[0][0];
    for k in 0..3 {
        if !is_spanned(matrix[k][k]) {
            continue;
        }
        for i in k + 1..3 {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..3 {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    let mut factors = [0.0; 3];
    for k in (0..3).rev().filter(|k| is_spanned(matrix[*k][*k])) {
        let known: f64 = (k + 1..3).map(|j| matrix[k][j] * factors[j]).sum();
        factors[k] = (right[k] - known) / matrix[k][k];
    }
    factors
}

impl<const D: usize> FilledCells<D> {
    /// Cell of a place; of one on the outer edge, the cell within.
    fn home(&self, place: &Vector<D>) -> usize {
        self.grid.flat_cell(&self.grid.cell_of(place))
    }

    /// Cells of the body.
    fn inside(&self) -> impl Iterator<Item = usize> + '_ {
        let is_inside = |index: &[usize; D]| {
            (0..D).all(|d| (GHOST_LAYERS..GHOST_LAYERS + self.grid.cells[d]).contains(&index[d]))
        };
        (0..self.grid.cell_count()).filter(move |cell| is_inside(&self.grid.cell_index(*cell)))
    }

    /// Lower corner of a cell, m, and the height that the body fills of it, m.
    fn corner_and_height(&self, cell: usize) -> (Vector<D>, f64) {
        let corner =
            self.grid.cell_index(cell).map(|i| (i as f64 - GHOST_LAYERS as f64) * self.grid.cell_size);
        (corner, (self.surface - corner[D - 1]).min(self.grid.cell_size))
    }

    /// Volume that the body fills of a cell, m^D.
    fn volume(&self, cell: usize) -> f64 {
        (1..D).map(|_| self.grid.cell_size).product::<f64>() * self.corner_and_height(cell).1
    }

    /// `ξ` of a place in a cell.
    fn offset(&self, cell: usize, place: &Vector<D>) -> Vector<D> {
        let (corner, height) = self.corner_and_height(cell);
        std::array::from_fn(|d| {
            let length = if d == D - 1 { height } else { self.grid.cell_size };
            (place[d] - corner[d] - 0.5 * length) * self.grid.inverse_cell_size()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::body::Body;
    use crate::tests::column_problem;
    use oedometer_problem::method::{Configuration, Method};
    use oedometer_scenes::AT_REST;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    /// Sums of `f` times the volumes of the points in each cell of edge 0.5 in a body 1.4 high.
    fn sums<const D: usize>(points: &Points<D>, f: impl Fn(&Vector<D>) -> f64) -> BTreeMap<[usize; D], f64> {
        let mut sums = BTreeMap::new();
        for (place, volume) in points.position.iter().zip(&points.initial_volume) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in the body")]
            let cell = place.map(|x| (2.0 * x) as usize);
            *sums.entry(cell).or_insert(0.0) += volume * f(place);
        }
        sums
    }

    proptest! {
        #[test]
        fn constant_and_linear_fields_are_integrated_exactly(
            shifts in proptest::collection::vec(-0.11..0.11f64, 32),
        ) {
            let mut points = Points::<1>::lattice(0.5, [3], 2);
            for (place, shift) in points.position.iter_mut().zip(&shifts) {
                place[0] += shift;
            }
            // The surface cuts the top cell: its middle is at 1.2.
            (points.position[4], points.position[5]) = ([1.1 + 0.5 * shifts[6].abs()], [1.3 + 0.5 * shifts[7]]);
            fit_volumes(&mut points, 0.5, [3], 1.4);
            let ends = |cell: usize| (0.5 * cell as f64, (0.5 * cell as f64 + 0.5).min(1.4));
            for ([cell], sum) in sums(&points, |_| 1.0) {
                prop_assert!((sum - (ends(cell).1 - ends(cell).0)).abs() < 1e-14);
            }
            for ([cell], sum) in sums(&points, |place| place[0]) {
                let (low, high) = ends(cell);
                prop_assert!((sum - 0.5 * (high * high - low * low)).abs() < 1e-13, "{cell}");
            }
            prop_assert!(points.initial_volume.iter().all(|volume| *volume > 0.0));
            prop_assert!((points.position[5][0] + points.half_length[5][0] - 1.4).abs() < 1e-15);
        }

        #[test]
        fn constant_and_linear_fields_are_integrated_exactly_in_the_plane(shifts in proptest::collection::vec([-0.05..0.05f64, -0.05..0.05f64], 16)) {
            let mut points = Points::<2>::lattice(0.5, [2, 2], 2);
            for (place, shift) in points.position.iter_mut().zip(&shifts) {
                *place = [place[0] + shift[0], place[1] + shift[1]];
            }
            fit_volumes(&mut points, 0.5, [2, 2], 1.0);
            for (_, sum) in sums(&points, |_| 1.0) {
                prop_assert!((sum - 0.25).abs() < 1e-14);
            }
            for d in 0..2 {
                for (cell, sum) in sums(&points, |place| place[d]) {
                    prop_assert!((sum - 0.25 * (0.5 * cell[d] as f64 + 0.25)).abs() < 1e-14, "{cell:?} {sum}");
                }
            }
        }
    }

    #[test]
    fn a_lattice_keeps_its_volumes() {
        let mut points = Points::<2>::lattice(0.5, [2, 3], 2);
        fit_volumes(&mut points, 0.5, [2, 3], 1.5);
        assert!(points.initial_volume.iter().all(|volume| (volume / 0.0625 - 1.0).abs() < 1e-14));
        assert!(points.half_length.iter().all(|half| (half[1] - 0.125).abs() < 1e-15));
    }

    #[test]
    fn no_volume_falls_below_a_tenth_of_that_for_the_constant() {
        // Both points of the lower cell lie on one side of its centre: no positive weights fit a line there.
        let mut points = Points::<1>::lattice(0.5, [2], 2);
        points.position[1] = [0.2];
        fit_volumes(&mut points, 0.5, [2], 1.0);
        let volumes = &points.initial_volume;
        assert!((volumes[0] + volumes[1] - 0.5).abs() < 1e-15);
        assert!((volumes[0].min(volumes[1]) - 0.025).abs() < 1e-15, "{volumes:?}");
        // One point has no slope to fit.
        let mut single = Points::<1>::lattice(0.5, [2], 1);
        single.position[0] = [0.1];
        fit_volumes(&mut single, 0.5, [2], 1.0);
        assert!(single.initial_volume.iter().all(|volume| (volume - 0.5).abs() < 1e-15));
    }

    #[test]
    fn volumes_stay_where_a_cell_is_empty() {
        let mut points = Points::<1>::lattice(0.5, [3], 1);
        points.position[1] = [0.3];
        let before = points.clone();
        fit_volumes(&mut points, 0.5, [3], 1.5);
        assert_eq!(points, before);
    }

    #[test]
    fn a_point_on_the_surface_is_at_home_in_the_cell_within() {
        let mut points = Points::<1>::lattice(0.5, [3], 2);
        points.position[5] = [1.5];
        fit_volumes(&mut points, 0.5, [3], 1.5);
        let [below, above] = [points.initial_volume[4], points.initial_volume[5]];
        assert!((below + above - 0.5).abs() < 1e-14, "{below} + {above}");
        let moment = below * points.position[4][0] + above * points.position[5][0];
        assert!((moment - 0.5 * 1.25).abs() < 1e-14, "{moment}");
    }

    /// Largest force, N, left at the nodes of a column of jittered points at rest under its weight: stress and pressure
    /// are linear over the height, and 21 kPa at the base.
    fn left_at_rest<const D: usize>(method: &str, configuration: Configuration, column: &Column) -> f64 {
        let method =
            Method { configuration: Some(configuration), ..Method::named(method).expect("a known method") };
        let soil = Material::default();
        let problem = column_problem::<D>(&AT_REST, column, &soil, method, 10, 2).expect("a column");
        Body::new(problem).unbalanced_force()
    }

    #[test]
    fn a_column_of_jittered_points_rests_under_its_weight() {
        for (jitter, filling) in [(0.1, 1.0), (0.3, 1.0), (0.3, 0.7)] {
            let mut column = (AT_REST.column)();
            column.points.jitter = jitter;
            column.points.filling = filling;
            let extent = column.points.cell_size(column.height, 10);
            let plane = Column { dimensions: 2, ..column }.with_extent(extent);
            for configuration in [Configuration::Frozen, Configuration::Updated, Configuration::Total] {
                for method in ["MPM-moments", "MPM-SRI-patch-moments"] {
                    let left = left_at_rest::<1>(method, configuration, &column);
                    assert!(left < 1e-10, "{method} {configuration:?} {jitter} {filling}: {left}");
                    let left = left_at_rest::<2>(method, configuration, &plane);
                    assert!(
                        left < 1e-10,
                        "{method} {configuration:?} {jitter} {filling} in the plane: {left}"
                    );
                }
                let left = left_at_rest::<1>("MPM-SRI-patch", configuration, &column);
                assert!(left > 50.0, "volumes as they are leave forces: {left}");
            }
        }
    }
}
