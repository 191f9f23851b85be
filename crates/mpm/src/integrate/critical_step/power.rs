//! The power balance of a step: whether forces do the power that stresses do on strain rates, `Σ f·v = −∫ σ:ε̇ dV` for every
//! velocity.
//!
//! They do where the gradient of the strains is that of the forces. Then the stiffness is symmetric (Betti 1872), and how far
//! it is not says how much power a step makes or loses.

use crate::integrate::assembled::stiffness::{NodeBlocks, pressure_stiffness};
use crate::kernel::body::Body;

/// Largest difference of a stiffness from its transpose over its largest entry: of the skeleton, and of the water's
/// pressure. Round-off where forces and strains are adjoint.
pub fn asymmetry<const D: usize>(body: &Body<D>) -> [f64; 2] {
    let rows = body.volumetric_rows();
    let water = pressure_stiffness(&body.coupled_pressure_forces(&rows), &rows.divergence);
    [body.skeleton_stiffness(&rows), water].map(|stiffness| of_blocks(&stiffness))
}

fn of_blocks<const D: usize>(stiffness: &NodeBlocks<D>) -> f64 {
    let entry = |row: usize, column: usize, d: usize, e: usize| {
        let blocks = &stiffness.rows[row];
        blocks.binary_search_by_key(&column, |block| block.0).map_or(0.0, |place| blocks[place].1[d][e])
    };
    let (mut largest, mut difference) = (0.0_f64, 0.0_f64);
    for (row, blocks) in stiffness.rows.iter().enumerate() {
        for (column, block) in blocks {
            for (d, of_direction) in block.iter().enumerate() {
                for (e, value) in of_direction.iter().enumerate() {
                    largest = largest.max(value.abs());
                    difference = difference.max((value - entry(*column, row, e, d)).abs());
                }
            }
        }
    }
    if largest > 0.0 { difference / largest } else { 0.0 }
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
    fn forces_are_adjoint_to_strains_where_both_have_one_gradient() {
        let asymmetry_of = |name: &str| {
            let method = Method::named(name).expect("a known method");
            let (column, soil) = (Column { load: 1.0, ..Column::layer() }, Material::default());
            let problem = column_problem::<2>(&COSINE_LAYER, &column, &soil, method, 4, 2);
            let mut problem = problem.expect("the seed layer");
            problem.undrained_start = false;
            asymmetry(&Body::new(problem))
        };
        let is_adjoint = |asymmetry: [f64; 2]| asymmetry.map(|difference| difference < 1e-12);
        assert_eq!(is_adjoint(asymmetry_of("GIMP")), [true, true], "{:?}", asymmetry_of("GIMP"));
        // The composite gradient strains more nodes than the forces act on; the patch spreads pressures likewise.
        assert_eq!(
            is_adjoint(asymmetry_of("GC-SRI-patch")),
            [false, false],
            "{:?}",
            asymmetry_of("GC-SRI-patch")
        );
        assert!(
            is_adjoint(asymmetry_of("GIMP-SRI-patch"))[0] && !is_adjoint(asymmetry_of("GIMP-SRI-patch"))[1]
        );
        // So is B-bar by cells and by nodes: its forces do the power of the strains whose volumes it shares out.
        for (name, expected) in
            [("GIMP-Bbar", [true, true]), ("VP-Bbar", [true, true]), ("GIMP-Bbar-patch", [false, false])]
        {
            assert_eq!(is_adjoint(asymmetry_of(name)), expected, "{name}: {:?}", asymmetry_of(name));
        }
    }
}
