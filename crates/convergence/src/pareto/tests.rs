use super::*;
use crate::class::{Context, classify};
use crate::series::ErrorSeries;
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
                .any(|(other, on_front)| *on_front && dominates(other, candidate));
            prop_assert_eq!(beaten, !mark);
        }
    }
}

/// Whether a point is nowhere worse than another and somewhere better.
fn dominates(one: &CostPoint, other: &CostPoint) -> bool {
    one.is_usable()
        && other.is_usable()
        && one.cost <= other.cost
        && one.error <= other.error
        && (one.cost < other.cost || one.error < other.error)
}

proptest! {
    #[test]
    fn the_front_is_what_no_point_dominates(
        numbers in proptest::collection::vec((0..6_u8, 0..6_u8), 0..40),
    ) {
        // Few values, so that many points share a cost, an error or both.
        let points: Vec<CostPoint> = numbers
            .iter()
            .map(|(cost, error)| point(f64::from(*cost), if *error == 5 { f64::NAN } else { f64::from(*error) }))
            .collect();
        let by_pairs: Vec<bool> = points
            .iter()
            .map(|one| one.is_usable() && !points.iter().any(|other| dominates(other, one)))
            .collect();
        prop_assert_eq!(front(&points), by_pairs);
    }
}
