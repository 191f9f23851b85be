use super::*;
use proptest::prelude::*;

#[test]
fn the_published_example_is_reproduced() {
    // Celik et al. 2008, table 1, φ = dimensionless reattachment length, and axial velocity.
    let first = [(1.0, 6.063), (1.5, 5.972), (1.5 * 1.333, 5.863)];
    let estimate = three_grids(first, None).unwrap().estimate.unwrap();
    assert!((estimate.order - 1.53).abs() < 0.01, "{estimate:?}");
    assert!((estimate.extrapolated - 6.1685).abs() < 5e-4);
    assert!((estimate.relative_index_fine.unwrap() - 0.022).abs() < 5e-4);
    let second = [(1.0, 10.7880), (2.0, 10.7250), (2.0 * 2.143, 10.6050)];
    let estimate = three_grids(second, None).unwrap().estimate.unwrap();
    assert!((estimate.order - 0.75).abs() < 0.01, "{estimate:?}");
    assert!((estimate.extrapolated - 10.8801).abs() < 5e-4);
    assert!((estimate.relative_index_fine.unwrap() - 0.011).abs() < 5e-4);
    // The third column converges in oscillation, and is said to.
    let third = [(1.0, 6.0042), (2.0, 5.9624), (2.0 * 2.143, 6.0909)];
    let three = three_grids(third, None).unwrap();
    assert_eq!((three.behaviour, three.estimate), (Behaviour::Oscillatory, None));
    assert!((three.range - 0.1285).abs() < 1e-12);
}

#[test]
fn values_that_diverge_oscillate_or_are_equal_get_no_estimate() {
    let for_values =
        |values: [f64; 3]| three_grids([(1.0, values[0]), (2.0, values[1]), (4.0, values[2])], None).unwrap();
    // The sequence for which other tools report order 2 and an index of 4 %.
    let diverging = for_values([1.5, 1.1, 1.0]);
    assert_eq!((diverging.behaviour, diverging.estimate), (Behaviour::Divergent, None));
    assert_eq!(for_values([1.0, 2.0, 3.0]).behaviour, Behaviour::Divergent);
    assert_eq!(for_values([1.0, 1.1, 0.9]).behaviour, Behaviour::Oscillatory);
    for equal in [[1.0; 3], [1.0, 1.0, 2.0], [1.0, 2.0, 2.0], [0.0; 3], [1.0, 1.0 + 1e-15, 2.0]] {
        let three = for_values(equal);
        assert_eq!((three.behaviour, three.estimate), (Behaviour::Equal, None));
    }
    let json = serde_json::to_string(&for_values([0.0; 3])).unwrap();
    assert!(json.contains("\"convergence_ratio\":null") && !json.contains("NaN"), "{json}");
}

#[test]
fn unequal_ratios_do_not_fool_the_classification() {
    // R = 3.6 by the plain rule, and yet these are values of 1 + h².
    let grids = [1.0, 2.0, 2.2].map(|h: f64| (h, 1.0 + h * h));
    let three = three_grids(grids, None).unwrap();
    assert_eq!(three.behaviour, Behaviour::Monotone);
    assert!((three.estimate.unwrap().order - 2.0).abs() < 1e-12);
}

#[test]
fn the_formal_order_rules_the_safety_factor_and_the_asymptotic_check() {
    let values = |p: f64| [1.0, 2.0, 4.0].map(|h: f64| (h, 5.0 + h.powf(p)));
    let for_order = |p| three_grids(values(p), Some(2.0)).unwrap().estimate.unwrap();
    assert_eq!((for_order(1.95).order_used, for_order(1.95).safety_factor), (2.0, 1.25));
    assert_eq!((for_order(3.5).order_used, for_order(3.5).safety_factor), (2.0, 3.0));
    assert_eq!((for_order(0.2).order_used, for_order(0.2).safety_factor), (0.5, 3.0));
    assert!((for_order(2.0).asymptotic_ratio.unwrap() - 1.0).abs() < 1e-12);
    assert!((for_order(1.0).asymptotic_ratio.unwrap() - 0.5).abs() < 1e-12);
}

#[test]
fn unusable_values_are_refused_with_a_reason() {
    let ok = [(1.0, 1.0), (2.0, 1.1), (4.0, 1.5)];
    assert!(three_grids(ok, None).is_ok());
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert!(three_grids([(bad, 1.0), ok[1], ok[2]], None).is_err());
        assert!(three_grids(ok, Some(bad)).is_err());
    }
    assert!(three_grids([(1.0, f64::NAN), ok[1], ok[2]], None).is_err());
    assert!(three_grids([ok[0], ok[0], ok[2]], None).is_err());
    assert!(three_grids([(1.0, f64::MAX), (2.0, -f64::MAX), ok[2]], None).is_err());
}

proptest! {
    #[test]
    fn any_power_law_is_extrapolated(
        p in 0.2..8.0_f64, limit in -5.0..5.0_f64, r21 in 1.2..4.0_f64, r32 in 1.2..4.0_f64,
    ) {
        let grids = [1.0, r21, r21 * r32].map(|h: f64| (h, limit + 3.0 * h.powf(p)));
        let three = three_grids(grids, None).unwrap();
        prop_assert_eq!(three.behaviour, Behaviour::Monotone);
        let estimate = three.estimate.unwrap();
        prop_assert!((estimate.order - p).abs() < 1e-9, "{:?}", estimate);
        prop_assert!((estimate.extrapolated - limit).abs() < 1e-7 * limit.abs().max(1.0));
        // The index covers the error that is left, by its safety factor.
        prop_assert!((estimate.index_fine - 1.25 * 3.0).abs() < 1e-6);
    }
}
