use super::*;
use crate::convergence::class::Context;
use crate::convergence::class::classify::classify;
use crate::convergence::series::ErrorSeries;
use proptest::prelude::*;

fn point(cost: f64, error: f64) -> CostPoint {
    CostPoint { cost, error }
}

fn levels(cost: fn(f64) -> f64, error: fn(f64) -> f64) -> Vec<CostLevel> {
    let sizes = [0.2, 0.1, 0.05, 0.025, 0.0125];
    sizes.map(|size| CostLevel { size, point: point(cost(size), error(size)) }).to_vec()
}

#[test]
fn the_front_has_what_nothing_beats() {
    let points = [
        point(1.0, 1.0),
        point(2.0, 0.5),
        point(2.0, 0.6),
        point(3.0, 0.5),
        point(0.5, f64::NAN),
        point(4.0, 0.1),
        point(4.0, 0.1),
    ];
    assert_eq!(front(&points), [true, true, false, false, false, true, true]);
    assert!(!point(1.0, 1.0).dominates(&point(1.0, 1.0)));
    assert!(!point(f64::NAN, 0.0).dominates(&point(1.0, 1.0)));
}

#[test]
fn the_gate_tells_a_loss_from_a_trade() {
    let golden = point(100.0, 1e-3);
    let change = |cost, error| against_golden(&point(cost, error), &golden, 0.01, 0.05);
    assert_eq!(change(100.5, 1.04e-3), ParetoChange::Same);
    assert_eq!(change(102.0, 1e-3), ParetoChange::Dominated);
    assert_eq!(change(100.0, 1.1e-3), ParetoChange::Dominated);
    assert_eq!(change(110.0, 1.1e-3), ParetoChange::Dominated);
    assert_eq!(change(50.0, 1.1e-3), ParetoChange::Traded);
    assert_eq!(change(50.0, 1e-3), ParetoChange::Better);
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        assert_eq!(change(bad, 1e-3), ParetoChange::NotComparable);
        assert_eq!(change(100.0, bad), ParetoChange::NotComparable);
    }
    let tolerance = against_golden(&golden, &golden, f64::NAN, 0.0);
    assert!(tolerance == ParetoChange::NotComparable && !tolerance.passes());
    assert!(change(50.0, 1.1e-3).passes() && !change(102.0, 1e-3).passes());
}

#[test]
fn the_cheapest_way_to_a_tolerance_is_found() {
    let second = levels(|h| 1.0 / h / h, |h| h * h);
    let first = levels(|h| 0.1 / h / h, |h| h);
    // h² = 5e-4 at cost 2000; cost goes as 1/h².
    let found = cost_to_tolerance(&second, 5e-4).unwrap();
    assert!((found.cost - 2000.0).abs() < 1e-6 && found.basis == CostBasis::Interpolated);
    assert_eq!(cost_to_tolerance(&second, 0.1).unwrap().basis, CostBasis::AtMost);
    let never = cost_to_tolerance(&first, 1e-3);
    assert_eq!(never, Err(NoCost::NotReached { error: 0.0125 }));
    let both = [first, second];
    // At 0.15 the first-order method needs 0.1/0.15² = 4.4, the other 25 at most.
    assert_eq!(cheapest(&both, 0.15).unwrap().0, 0);
    assert_eq!(cheapest(&both, 1e-3).unwrap().0, 1);
    assert_eq!(cheapest(&both, 1e-9), None);
    assert_eq!(cost_to_tolerance(&both[0], f64::NAN), Err(NoCost::BadTolerance));
    assert_eq!(cost_to_tolerance(&[], 1.0), Err(NoCost::NotUsable));
}

#[test]
fn a_lucky_dip_does_not_count() {
    let mut dip = levels(|h| 1.0 / h / h, |h| h * h);
    dip[1].point.error = 1e-6;
    let found = cost_to_tolerance(&dip, 5e-4).unwrap();
    assert!((found.cost - 2000.0).abs() < 1e-6, "{found:?}");
}

#[test]
fn the_next_level_is_predicted_with_and_without_a_floor() {
    let series = |error: fn(f64) -> f64| {
        let levels = levels(|h| 3.0 / h.powi(3), error);
        let pairs: Vec<_> = levels.iter().map(|level| (level.size, level.point.error)).collect();
        let context = Context { formal_order: Some(2.0), ..Context::default() };
        let class = classify(&ErrorSeries::of(&pairs), &context);
        predict_next(&levels, &class, 2.0).unwrap()
    };
    let size: f64 = 0.00625;
    let clean = series(|h| h * h);
    assert!((clean.cost / (3.0 / size.powi(3)) - 1.0).abs() < 1e-12);
    assert!((clean.error.unwrap() / (size * size) - 1.0).abs() < 1e-12);
    assert!((clean.cost_exponent - 3.0).abs() < 1e-12 && (clean.size - size).abs() < 1e-15);
    let floored = series(|h| h * h + 2e-4);
    assert!((floored.error.unwrap() / (size * size + 2e-4) - 1.0).abs() < 1e-6);
    assert_eq!(series(|h| 1.0 / h).error, None);
    assert_eq!(series(|_| f64::MIN_POSITIVE).error, None);
}

proptest! {
    #[test]
    fn every_point_off_the_front_is_dominated_by_one_on_it(
        numbers in prop::collection::vec((0.1..10.0_f64, 0.1..10.0_f64), 1..20),
    ) {
        let points: Vec<_> = numbers.iter().map(|(c, e)| point(*c, *e)).collect();
        let marks = front(&points);
        prop_assert!(marks.contains(&true));
        for (candidate, mark) in points.iter().zip(&marks) {
            let beaten = points.iter().zip(&marks)
                .any(|(other, on_front)| *on_front && other.dominates(candidate));
            prop_assert_eq!(beaten, !mark);
        }
    }
}
