use super::*;
use proptest::prelude::*;

fn point(cost: f64, error: f64) -> CostPoint {
    CostPoint { cost, error }
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
fn dominates(point: &CostPoint, other: &CostPoint) -> bool {
    point.is_usable()
        && other.is_usable()
        && point.cost <= other.cost
        && point.error <= other.error
        && (point.cost < other.cost || point.error < other.error)
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
            .map(|point| point.is_usable() && !points.iter().any(|other| dominates(other, point)))
            .collect();
        prop_assert_eq!(front(&points), by_pairs);
    }
}
