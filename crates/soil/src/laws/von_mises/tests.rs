use super::*;
use crate::material::Material;

fn clay() -> VonMises {
    let soil = Material { youngs_modulus: 1e7, poissons_ratio: 0.3, ..Material::default() };
    VonMises { stiffness: soil.stiffness(), strength: 1e4 }
}

fn along(law: &impl PointLaw, path: &[Components], steps: u32) -> PointState {
    let mut state = PointState::default();
    for part in path {
        let increment = part.map(|component| component / f64::from(steps));
        for _ in 0..steps {
            state = law.update(&state, &increment).0;
        }
    }
    state
}

#[test]
fn a_uniaxial_strain_yields_where_the_closed_form_says_and_goes_on_with_the_bulk_modulus() {
    let law = clay();
    let (bulk, shear) = (law.stiffness.bulk(), law.stiffness.shear);
    // s_yy = 4/3 G ε, s_xx = s_zz = −s_yy/2: |s| = √(3/2) s_yy = √2 k at s_yy = 2k/√3.
    let at_yield = 2.0 / 3.0_f64.sqrt() * law.strength;
    for (strain, steps) in [(1e-3, 1), (5e-3, 1), (5e-3, 13), (2e-2, 40)] {
        let state = along(&law, &[[0.0, -strain, 0.0, 0.0]], steps);
        let shear_stress = (4.0 / 3.0 * shear * strain).min(at_yield);
        let expected = [0.5, -1.0, 0.5, 0.0].map(|share| share * shear_stress);
        for (i, expected) in expected.into_iter().enumerate() {
            let expected = expected - bulk * strain * UNIT[i];
            assert!((state.stress[i] - expected).abs() < 1e-9 * law.strength, "{strain} {steps}: {state:?}");
        }
        let plastic = (2.0 / 3.0 * strain - at_yield / (2.0 * shear)).max(0.0);
        assert!((state.plastic_strain - plastic).abs() < 1e-12, "{state:?} for {plastic}");
    }
}

#[test]
fn a_simple_shear_ends_at_the_strength_and_unloads_elastically() {
    let law = clay();
    let shear = law.stiffness.shear;
    let forth = [0.0, 0.0, 0.0, 4.0 * law.strength / (2.0 * shear)];
    for steps in [1, 9] {
        let yielded = along(&law, &[forth], steps);
        assert!((yielded.stress[3] - law.strength).abs() < 1e-9 * law.strength, "{yielded:?}");
        // γ_p = γ − k/G, and its equivalent is γ_p/√3.
        let plastic = 3.0 * law.strength / shear / 3.0_f64.sqrt();
        assert!((yielded.plastic_strain - plastic).abs() < 1e-12);
        let back = forth.map(|component| -0.25 * component);
        let unloaded = along(&law, &[forth, back], steps);
        assert!(unloaded.stress[3].abs() < 1e-9 * law.strength, "{unloaded:?}");
        assert_eq!(unloaded.plastic_strain, yielded.plastic_strain);
    }
}

#[test]
fn plane_strain_flow_ends_at_trescas_condition() {
    let law = clay();
    // Plane strain that keeps the volume, from a start whose s_zz is not zero.
    let state = along(&law, &[[0.0, -2e-3, 0.0, 0.0], [4e-2, -4e-2, 0.0, 0.0]], 200);
    assert!(deviator(&state.stress)[2].abs() < 1e-6 * law.strength, "{state:?}");
    assert!((state.stress[0] - state.stress[1] - 2.0 * law.strength).abs() < 1e-6 * law.strength);
}

/// Checks a law's tangent by central differences.
pub fn tangent_is_consistent(law: &impl PointLaw, state: &PointState, strain: &Components, tolerance: f64) {
    let tangent = law.update(state, strain).1;
    let scale = tangent.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    for j in 0..4 {
        let step = 1e-8;
        let moved = |by: f64| {
            let mut strain = *strain;
            strain[j] += by;
            law.update(state, &strain).0.stress
        };
        let (after, before) = (moved(step), moved(-step));
        for (i, row) in tangent.iter().enumerate() {
            let difference = (after[i] - before[i]) / (2.0 * step);
            assert!((row[j] - difference).abs() < tolerance * scale, "{i} {j}: {} for {difference}", row[j]);
        }
    }
}

#[test]
fn the_tangent_agrees_with_finite_differences() {
    let law = clay();
    let start = along(&law, &[[1e-3, -3e-3, 5e-4, 2e-3]], 5);
    for strain in [[1e-4, -2e-4, 0.0, 1e-5], [1e-3, -4e-3, 2e-4, 3e-3], [-6e-4, 8e-4, 0.0, -9e-4]] {
        tangent_is_consistent(&law, &start, &strain, 1e-6);
        tangent_is_consistent(&law.stiffness, &start, &strain, 1e-6);
    }
}
