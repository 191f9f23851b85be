//! Columns of two sets of points for the tests of `crates/mpm/src/integrate/double_point/`, which may not import scenes outside of tests.

use crate::integrate::double_point::DoublePoint;
use crate::kernel::body::Body;
use crate::tests::column_problem;
use oedometer_problem::arrangement::Arrangement;
use oedometer_problem::method::Method;
use oedometer_scenes::XIE_LEO;
use oedometer_scenes::column::Column;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// Five cells of a column that may move, with so many points of skeleton and of water a cell and direction, at its
/// start. In the plane it is two cells wide.
pub(crate) fn moving_column<const D: usize>(
    method: &str,
    [of_skeleton, of_water]: [usize; 2],
    load: f64,
    soil: &Material,
) -> DoublePoint<D> {
    let points = Arrangement { sets: 2, water_per_cell: of_water, ..Arrangement::default() };
    let column = Column { load, points, dimensions: D, ..Column::default() }.with_extent(0.4);
    let soil = Material { law: Law::LogLinear, ..*soil };
    let method = Method::named(method).expect("a known method");
    let mut problem =
        column_problem::<D>(&XIE_LEO, &column, &soil, method, 5, of_skeleton).expect("a column");
    let lattice = problem.water.take().expect("water points");
    let gradient = problem.initial_gradient;
    DoublePoint::new(Body::new(problem), &lattice, &gradient, false)
}

/// A column whose water points all lie somewhat higher than their lattice; so many a cell, four of the skeleton.
pub(crate) fn with_water_shifted(method: &str, of_water: usize) -> DoublePoint<1> {
    let mut double = moving_column::<1>(method, [4, of_water], 2e5, &Material::default());
    let count = double.water.len();
    for place in &mut double.water.place[..count - 1] {
        place[0] += 0.02;
    }
    // The topmost domain holds what is left of the column.
    double.water.place[count - 1][0] += 0.01;
    double.water.reach[count - 1][0] -= 0.01;
    double.water.share[count - 1] = 1.0 - 0.02 / (0.2 / of_water as f64);
    double.build_water_operators();
    double
}
