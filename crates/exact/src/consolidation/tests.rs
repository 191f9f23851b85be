//! Terzaghi's functions against 20-digit values made by `crates/exact/src/data/make_consolidation.py`.
#![allow(clippy::print_stderr, reason = "a test tells how far it was off")]

use proptest::prelude::*;

use super::*;

/// Accuracy that the module promises.
const TOLERANCE: f64 = 1e-14;

/// Rows of numbers of a table with one line of headings.
fn rows<const N: usize>(table: &str) -> impl Iterator<Item = [f64; N]> {
    table.lines().skip(1).map(|line| {
        let mut row = [0.0; N];
        let mut cells = line.split(',');
        for value in &mut row {
            *value = cells.next().unwrap().parse().unwrap();
        }
        assert_eq!(cells.next(), None);
        row
    })
}

#[test]
fn functions_have_their_fourteen_digits() {
    let mut count = 0;
    let mut worst = [0.0_f64; 3];
    for [zeta, time_factor, w, integral, u] in rows(include_str!("../../tests/reference/consolidation.csv")) {
        let errors = [
            isochrone(zeta, time_factor).unwrap().value - w,
            isochrone_integral(zeta, time_factor).unwrap().value - integral,
            degree_of_consolidation(time_factor).unwrap().value - u,
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            assert!(error.abs() <= TOLERANCE, "{error:e} at zeta {zeta}, T {time_factor}");
            *worst = worst.max(error.abs());
        }
        count += 1;
    }
    eprintln!("worst absolute errors of W, I, U: {worst:?} over {count} points");
    assert_eq!(count, 850);
}

#[test]
fn small_values_keep_their_relative_digits() {
    for [zeta, time_factor, w, integral, u] in rows(include_str!("../../tests/reference/consolidation.csv")) {
        let degree = degree_of_consolidation(time_factor).unwrap().value;
        assert!((degree / u - 1.0).abs() < 2e-15, "U at {time_factor}");
        if time_factor > SWITCH && zeta > 0.0 && zeta < 1.0 {
            let value = isochrone(zeta, time_factor).unwrap().value;
            assert!((value / w - 1.0).abs() < 3e-14, "W at {zeta}, {time_factor}");
            let value = isochrone_integral(zeta, time_factor).unwrap().value;
            assert!((value / integral - 1.0).abs() < 3e-14, "I at {zeta}, {time_factor}");
        }
    }
}

#[test]
fn both_forms_agree_on_both_sides_of_the_switch() {
    for k in 0..=60 {
        // From a fifth of the switch to five times it.
        let time_factor = SWITCH * 5.0_f64.powf(f64::from(k) / 30.0 - 1.0);
        for i in 0..=40 {
            let zeta = f64::from(i) / 40.0;
            let difference =
                images::isochrone(zeta, time_factor).value - modes::isochrone(zeta, time_factor).value;
            assert!(difference.abs() < 2e-15, "W {difference:e}");
            let difference = 1.0
                - zeta
                - images::consolidated_below(zeta, time_factor).value
                - modes::isochrone_integral(zeta, time_factor).value;
            assert!(difference.abs() < 2e-15, "I {difference:e}");
        }
        let ratio = images::consolidation_rate(time_factor) / modes::consolidation_rate(time_factor);
        // The images cancel beyond T = 1/2, where only the modes are used.
        assert!((ratio - 1.0).abs() < 1e-13, "dU/dT {ratio}");
    }
}

#[test]
fn forms_need_few_terms_at_the_switch() {
    assert!(images::isochrone(1.0, SWITCH).terms <= 4);
    assert!(modes::isochrone(1.0, SWITCH).terms <= 5);
}

#[test]
fn tail_bounds_hold() {
    // Each shortened sum's error is within the bound that the next term gives.
    for time_factor in [0.2, 0.5, 1.0] {
        let sum = modes::isochrone(0.7, time_factor);
        assert!(sum.tail_bound < 2.8e-17);
        let m = eigenvalue(sum.terms);
        let first_omitted = 2.0 / m * libm::exp(-m * m * time_factor);
        assert!(sum.tail_bound >= first_omitted);
    }
    for time_factor in [1e-8, 1e-3, 0.1, 0.19] {
        let sum = images::isochrone(1.0, time_factor);
        assert!(sum.tail_bound < 2.3e-17);
    }
}

#[test]
fn limits_are_graceful() {
    assert_eq!(isochrone(0.0, 0.0).unwrap().value, 0.0);
    assert_eq!(isochrone(1e-300, 0.0).unwrap().value, 1.0);
    assert_eq!(degree_of_consolidation(0.0).unwrap().value, 0.0);
    assert_eq!(isochrone_integral(0.25, 0.0).unwrap().value, 0.75);
    for tiny in [5e-324, 1e-300, 1e-40] {
        assert_eq!(isochrone(0.0, tiny).unwrap().value, 0.0);
        assert_eq!(isochrone(1.0, tiny).unwrap().value, 1.0);
        let degree = degree_of_consolidation(tiny).unwrap().value;
        // The quotient T/π itself would be subnormal.
        let early = core::f64::consts::FRAC_2_SQRT_PI * tiny.sqrt();
        assert!((degree / early - 1.0).abs() < 1e-15);
    }
    for late in [50.0, 1e3, 1e300, f64::MAX] {
        assert!(isochrone(1.0, late).unwrap().value < 1e-53);
        assert_eq!(degree_of_consolidation(late).unwrap().value, 1.0);
        assert_eq!(isochrone_integral(1.0, late).unwrap().value, 0.0);
    }
}

#[test]
fn impossible_arguments_are_refused() {
    for (zeta, time_factor) in [
        (0.5, -1e-300),
        (0.5, f64::NAN),
        (0.5, f64::INFINITY),
        (-1e-11, 0.1),
        (1.0 + 1e-11, 0.1),
        (f64::NAN, 0.1),
    ] {
        assert!(isochrone(zeta, time_factor).is_err());
        assert!(isochrone_integral(zeta, time_factor).is_err());
        assert!(consolidated_below(zeta, time_factor).is_err());
    }
    for degree in [-0.1, 1.0, 1.5, f64::NAN] {
        let error = time_factor_for_degree(degree).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("the degree of consolidation must be at least 0 and below 1, got {degree}")
        );
    }
}

#[test]
fn a_depth_beside_the_column_by_round_off_is_its_edge() {
    for (beside, edge) in [(-1e-300, 0.0), (-1e-13, 0.0), (1.0 + f64::EPSILON, 1.0), (1.0 + 1e-13, 1.0)] {
        for at in [isochrone, isochrone_integral, consolidated_below] {
            assert_eq!(at(beside, 0.1).unwrap().value, at(edge, 0.1).unwrap().value, "at {beside:e}");
        }
    }
}

#[test]
fn inverse_has_its_thirteen_digits() {
    let mut worst = 0.0_f64;
    for [degree, time_factor] in rows(include_str!("../../tests/reference/inverse.csv")) {
        let error = time_factor_for_degree(degree).unwrap() / time_factor - 1.0;
        assert!(error.abs() < 2e-14, "{error:e} at U = {degree}");
        worst = worst.max(error.abs());
    }
    eprintln!("worst relative error of the inverse: {worst:e}");
}

proptest! {
    #[test]
    fn functions_are_bounded_and_monotone(
        zeta in 0.0..=1.0_f64,
        deeper in 0.0..=1.0_f64,
        exponent in -9.0..1.5_f64,
        later in 1.0..10.0_f64,
    ) {
        let time_factor = 10.0_f64.powf(exponent);
        let w = |z, t| isochrone(z, t).unwrap().value;
        let value = w(zeta, time_factor);
        prop_assert!((0.0..=1.0 + 1e-15).contains(&value));
        prop_assert!(w(zeta, time_factor * later) <= value + 1e-15);
        prop_assert!(w(zeta.max(deeper), time_factor) >= w(zeta.min(deeper), time_factor) - 1e-15);
        let u = |t| degree_of_consolidation(t).unwrap().value;
        prop_assert!((0.0..=1.0).contains(&u(time_factor)));
        prop_assert!(u(time_factor * later) >= u(time_factor));
        let integral = isochrone_integral(zeta, time_factor).unwrap().value;
        prop_assert!((-1e-15..=1.0 - zeta + 1e-15).contains(&integral));
    }

    #[test]
    fn inverse_returns(degree in 0.0..0.9999_f64) {
        let time_factor = time_factor_for_degree(degree).unwrap();
        let returned = degree_of_consolidation(time_factor).unwrap().value;
        prop_assert!((returned - degree).abs() <= 4.0 * f64::EPSILON * degree);
    }
}
