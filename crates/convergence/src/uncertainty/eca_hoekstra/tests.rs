use super::*;

const SIZES: [f64; 7] = [2.66, 2.28, 2.0, 1.6, 1.33, 1.14, 1.0];

fn uncertainty(values: [f64; 7]) -> LeastSquaresUncertainty {
    let grids: Vec<_> = SIZES.into_iter().zip(values).collect();
    least_squares_uncertainty(&grids, 2.0).unwrap()
}

#[test]
fn the_orders_of_a_published_figure_are_reproduced() {
    // Figure 9 of the paper, Spalart–Allmaras at Re = 10⁷, sets A, B, C, as digitised for the
    // package cfdverify; the paper gives p = 1.37, p = 0.98 and a fit with first and second order.
    // Which of the thirteen grids the paper fitted is not known here: the seven finest agree with
    // it, other choices do not, so this is a plausibility check and no proof.
    let above = |hundred_thousandths| 2.86 + 1e-5 * f64::from(hundred_thousandths);
    let a = uncertainty([777, 991, 1094, 1300, 1396, 1470, 1536].map(above));
    assert!((a.observed_order - 1.37).abs() < 0.04, "{a:?}");
    assert_eq!(a.model, ErrorModel::PowerLaw);
    let b = uncertainty([1190, 1278, 1352, 1433, 1506, 1536, 1587].map(above));
    assert!((b.observed_order - 0.98).abs() < 0.08, "{b:?}");
    let c = uncertainty([1639, 1624, 1610, 1624, 1654, 1646, 1632].map(above));
    assert!(c.observed_order < 0.5 && c.model != ErrorModel::PowerLaw, "{c:?}");
    assert_eq!(c.safety_factor, 3.0);
}

#[test]
fn a_manufactured_value_is_extrapolated_and_covered() {
    for (p, model) in [(1.5, ErrorModel::PowerLaw), (2.0, ErrorModel::PowerLaw), (1.0, ErrorModel::PowerLaw)]
    {
        let computed = uncertainty(SIZES.map(|h| 3.0 + 0.01 * h.powf(p)));
        // At the formal order itself, round-off decides which of two equal models is taken.
        assert!(computed.model == model || p == 2.0, "{computed:?}");
        assert!((computed.extrapolated - 3.0).abs() < 1e-6 && (computed.observed_order - p).abs() < 1e-3);
        assert_eq!(computed.safety_factor, 1.25);
        for grid in &computed.grids {
            let error = 0.01 * grid.size.powf(p);
            assert!((grid.uncertainty / error - 1.25).abs() < 1e-2, "{grid:?}");
        }
    }
}

#[test]
fn an_observed_order_beyond_the_formal_one_gets_a_safety_factor_of_three() {
    let computed = uncertainty(SIZES.map(|h| 3.0 + 0.01 * h.powi(4)));
    assert!(computed.observed_order > 3.9 && computed.model == ErrorModel::SecondOrder);
    assert_eq!(computed.safety_factor, 3.0);
    // The true error of the finest grid, 0.01, is covered all the same.
    assert!(computed.grids[6].uncertainty > 0.01, "{computed:?}");
}

#[test]
fn noise_gives_a_wide_uncertainty_and_never_nan() {
    let computed = uncertainty([100.0, 98.0, 101.0, 98.4, 100.5, 99.0, 100.1]);
    assert!(computed.deviation > computed.data_range && computed.safety_factor == 3.0);
    for grid in &computed.grids {
        let sum = grid.error.abs() + computed.deviation + grid.misfit.abs();
        let wanted = 3.0 * computed.deviation / computed.data_range * sum;
        assert!((grid.uncertainty / wanted - 1.0).abs() < 1e-12 && wanted > 1.0);
    }
}

#[test]
fn unusable_values_are_refused_with_a_reason() {
    let equal: Vec<_> = SIZES.iter().map(|h| (*h, 0.3)).collect();
    assert_eq!(least_squares_uncertainty(&equal, 2.0), Err(Undefined::EqualValues));
    let zero: Vec<_> = SIZES.iter().map(|h| (*h, 0.0)).collect();
    assert_eq!(least_squares_uncertainty(&zero, 2.0), Err(Undefined::EqualValues));
    let few = least_squares_uncertainty(&equal[..3], 2.0);
    assert_eq!(few, Err(Undefined::TooFewLevels { levels: 3, needed: 4 }));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut grids: Vec<_> = SIZES.iter().map(|h| (*h, h * h)).collect();
        grids[2].1 = bad;
        assert_eq!(least_squares_uncertainty(&grids, 2.0), Err(Undefined::NotFinite { size: 2.0 }));
        grids[2] = (bad, 1.0);
        assert_eq!(least_squares_uncertainty(&grids, 2.0), Err(Undefined::BadSize { number: 1 }));
    }
    let mut twice: Vec<_> = SIZES.iter().map(|h| (*h, h * h)).collect();
    twice[2].0 = twice[1].0;
    assert!(matches!(least_squares_uncertainty(&twice, 2.0), Err(Undefined::SameSize { .. })));
}
