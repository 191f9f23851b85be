//! Every series of errors gets its class, and nonsense never passes as asymptotic.

use crate::class::{Class, Classification, Context, classify};
use crate::fit::floor::{Limiter, LimiterKind};
use crate::series::{ErrorSeries, SeriesLevel};
use proptest::prelude::*;

const SIZES: [f64; 6] = [1.0 / 5.0, 1.0 / 10.0, 1.0 / 20.0, 1.0 / 40.0, 1.0 / 80.0, 1.0 / 160.0];

fn series(error: impl Fn(f64) -> f64) -> ErrorSeries {
    ErrorSeries::from_pairs(&SIZES.map(|size| (size, error(size))))
}

fn listed(errors: &[f64]) -> ErrorSeries {
    ErrorSeries::from_pairs(&SIZES.into_iter().zip(errors.iter().copied()).collect::<Vec<_>>())
}

fn formal(order: f64) -> Context {
    Context { formal_order: Some(order), ..Context::default() }
}

fn class(series: &ErrorSeries) -> [Class; 2] {
    [None, Some(2.0)]
        .map(|formal_order| classify(series, &Context { formal_order, ..Context::default() }).class)
}

fn with_and_without_order(class: Class) -> [Class; 2] {
    [class; 2]
}

#[test]
fn a_higher_term_a_lower_term_a_floor_and_growth_get_their_classes() {
    for context in [formal(2.0), Context::default()] {
        let higher = classify(&series(|h| h * h + 8.0 * h.powi(3)), &context);
        assert_eq!(higher.class, Class::Asymptotic, "{higher:?}");
        assert!((higher.order.unwrap() - 2.096).abs() < 1e-3, "{higher:?}");

        let lower = classify(&series(|h| h * h + 0.05 * h), &context);
        assert_eq!(lower.class, Class::Contaminated, "{lower:?}");
        assert!(lower.reason.contains("order 1.00"), "{lower:?}");
        assert!(lower.advice.unwrap().contains("below size 0.05"));

        let floored = classify(&series(|h| h * h + 2e-4), &context);
        assert_eq!(floored.class, Class::FloorLimited, "{floored:?}");
        let floor = floored.floor.unwrap();
        assert!((floor.value - 2e-4).abs() < 1e-8 && floor.fitted);
        assert_eq!(floor.limits_from, 1.0 / 80.0);
        assert!((floored.order.unwrap() - 2.0).abs() < 1e-4);

        let growing = classify(&series(|h| 1.0 / h), &context);
        assert_eq!(growing.class, Class::Divergent, "{growing:?}");
        assert_eq!(growing.order, None);
    }
}

#[test]
fn clean_series_are_asymptotic_at_any_ratio() {
    assert_eq!(class(&series(|h| h * h)), with_and_without_order(Class::Asymptotic));
    let mixed = [5.0, 8.0, 11.0, 30.0, 37.0_f64].map(|n| (1.0 / n, 3.0 / n / n));
    let classification = classify(&ErrorSeries::from_pairs(&mixed), &formal(2.0));
    assert_eq!(classification.class, Class::Asymptotic, "{classification:?}");
    assert!((classification.order.unwrap() - 2.0).abs() < 1e-12);
    // Second order with three digits and a few per cent of noise.
    assert_eq!(
        class(&listed(&[1.36e-2, 3.6e-3, 8.9e-4, 2.23e-4])),
        with_and_without_order(Class::Asymptotic)
    );
}

#[test]
fn errors_that_are_not_positive_and_finite_are_not_evaluable() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e-3, 0.0, 1e-310] {
        for place in 0..6 {
            let mut errors = SIZES.map(|h| h * h);
            errors[place] = bad;
            assert_eq!(
                class(&listed(&errors)),
                with_and_without_order(Class::NotEvaluable),
                "{bad} at {place}"
            );
        }
    }
    assert_eq!(class(&listed(&[f64::NAN; 6])), with_and_without_order(Class::NotEvaluable));
    assert_eq!(class(&ErrorSeries::default()), with_and_without_order(Class::NotEvaluable));
    assert_eq!(class(&listed(&[0.04])), with_and_without_order(Class::NotEvaluable));
    assert_eq!(class(&listed(&[0.04, 0.01])), with_and_without_order(Class::NotEvaluable));
    let close = [100.0, 110.0, 121.0, 133.0_f64].map(|n| (1.0 / n, 1.0 / n / n));
    assert_eq!(class(&ErrorSeries::from_pairs(&close)), with_and_without_order(Class::NotEvaluable));
    let same = [(0.2, 0.04), (0.1, 0.01), (0.1, 0.01), (0.05, 0.0025)];
    assert_eq!(class(&ErrorSeries::from_pairs(&same)), with_and_without_order(Class::NotEvaluable));
    let mut levels = series(|h| h * h).levels().to_vec();
    levels[5].error = None;
    let gap = classify(&ErrorSeries::new(levels), &Context::default());
    assert_eq!(gap.class, Class::NotEvaluable);
    assert!(gap.reason.contains("missing"), "{gap:?}");
    for size in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let sizes = [(0.2, 0.04), (0.1, 0.01), (0.05, 0.0025), (size, 0.1)];
        assert_eq!(class(&ErrorSeries::from_pairs(&sizes)), with_and_without_order(Class::NotEvaluable));
    }
}

#[test]
fn round_off_is_exact_and_not_an_order() {
    assert_eq!(class(&listed(&[0.0; 4])), with_and_without_order(Class::Exact));
    assert_eq!(class(&listed(&[1e-310; 4])), with_and_without_order(Class::Exact));
    let noise = listed(&[3e-16, 1e-16, 2e-16, 5e-17]);
    let context = Context { round_off: Some(1e-14), ..Context::default() };
    assert_eq!(classify(&noise, &context).class, Class::Exact);
    let reaching = listed(&[1e-6, 1e-9, 1e-12, 1e-15]);
    let classification = classify(&reaching, &context);
    assert_eq!(classification.class, Class::FloorLimited, "{classification:?}");
    assert_eq!(classification.floor.unwrap().limiter, Some(LimiterKind::RoundOff));
}

#[test]
fn standing_still_is_a_floor() {
    assert_eq!(class(&listed(&[0.3; 6])), with_and_without_order(Class::FloorLimited));
    assert_eq!(class(&listed(&[0.3; 4])), with_and_without_order(Class::FloorLimited));
    assert_eq!(class(&listed(&[4e-2, 1e-2, 2.7e-3, 2.2e-3])), with_and_without_order(Class::FloorLimited));
    let noisy = listed(&[4e-2, 1e-2, 2.6e-3, 2.1e-3, 2.5e-3, 2.2e-3]);
    assert_eq!(class(&noisy), with_and_without_order(Class::FloorLimited));
    assert_eq!(class(&series(|h| h.powf(0.2))), with_and_without_order(Class::FloorLimited));
    // A dip that six levels fit, though the last four do not confirm its limit.
    let dipping = listed(&[2.63e-2, 5.78e-3, 8.04e-4, 4.32e-4, 7.37e-4, 8.13e-4]);
    assert_eq!(class(&dipping), with_and_without_order(Class::FloorLimited));
    // Against water that cannot be compressed, on 10 to 640 cells.
    let sizes = [10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 640.0_f64].map(f64::recip);
    let errors = [5.512e-3, 1.31e-3, 3.11e-4, 1.34e-4, 1.35e-4, 1.403e-4, 1.42e-4];
    let model = ErrorSeries::from_pairs(&sizes.into_iter().zip(errors).collect::<Vec<_>>());
    assert_eq!(class(&model), with_and_without_order(Class::FloorLimited));
    // Creeping up over the last levels, by no more than before: still a floor.
    let creeping = listed(&[1.24e-2, 3.0e-3, 6.9e-4, 1.5e-4, 1.2e-4, 1.36e-4]);
    assert_eq!(class(&creeping), with_and_without_order(Class::FloorLimited));
    // A floor of opposite sign: the error dips at 1/80 and comes up again to 2e-4.
    let dip = classify(&series(|h| (h * h - 2e-4).abs()), &formal(2.0));
    assert_eq!(dip.class, Class::FloorLimited, "{dip:?}");
    assert!((dip.floor.unwrap().value - 2e-4).abs() < 1e-9);
}

/// Errors of an element code in backward Euler steps of 0.001 in `T_v`, on 10, 20, … cells: the step leaves
/// a limit, which the mesh approaches at second order. The first two as measured; of the others the
/// errors on 10 and 40 cells were, and what lies between and beyond follows from the order.
const GO_TO_A_LIMIT: [(&[f64], f64); 5] = [
    (&[2.70e-5, 2.29e-3, 2.85e-3, 3.00e-3, 3.03e-3], 3.04e-3),
    (&[1.71e-3, -1.45e-3, -2.23e-3, -2.43e-3], -2.49e-3),
    (&[9.0e-4, -7.0e-4, -1.1e-3, -1.2e-3], -1.23e-3),
    (&[2.0e-4, -1.2e-4, -2.0e-4, -2.2e-4], -2.27e-4),
    (&[1.04e-3, 1.40e-3, 1.49e-3, 1.5125e-3], 1.52e-3),
];

fn with_signs(values: &[f64]) -> (ErrorSeries, Context) {
    let sizes = [10.0, 20.0, 40.0, 80.0, 160.0_f64].map(f64::recip);
    let points: Vec<_> = sizes.into_iter().zip(values.iter().map(|value| value.abs())).collect();
    (ErrorSeries::from_pairs(&points), Context { signed: values.to_vec(), ..Context::default() })
}

#[test]
fn a_limit_other_than_zero_is_a_floor_from_either_side() {
    for (values, limit) in GO_TO_A_LIMIT {
        for formal_order in [None, Some(2.0)] {
            let (series, context) = with_signs(values);
            let classification = classify(&series, &Context { formal_order, ..context });
            assert_eq!(classification.class, Class::FloorLimited, "{classification:?}");
            let floor = classification.floor.expect("a floor");
            assert!((floor.value / f64::abs(limit) - 1.0).abs() < 0.02 && floor.fitted, "{floor:?}");
            assert!((classification.order.expect("an order") - 2.0).abs() < 0.3, "{values:?}");
            // The same on three levels is told, and is no floor and no divergence.
            let (series, context) = with_signs(&values[..3]);
            let classification = classify(&series, &Context { formal_order, ..context });
            assert_eq!(classification.class, Class::PreAsymptotic, "{classification:?}");
            assert!(
                classification.reason.contains("3 levels cannot distinguish a limit from growth"),
                "{classification:?}"
            );
            assert!(classification.advice.expect("advice").contains("add a level: at size 0.0125"));
        }
    }
}

#[test]
fn signs_decide_only_where_they_belong_to_the_errors() {
    // Of a settlement +0.4, +0.1, +0.025 % falls to zero; through zero it goes to a limit.
    let (series, context) = with_signs(&[4e-3, 1e-3, 2.5e-4, 6.25e-5]);
    assert_eq!(classify(&series, &context).class, Class::Asymptotic);
    let (series, context) = with_signs(&[1.2e-2, 2.61e-3, 3.47e-4, -2.16e-4]);
    assert_eq!(classify(&series, &context).class, Class::FloorLimited);
    // Signs of other values than the errors are none.
    let foreign = Context { signed: GO_TO_A_LIMIT[1].0.to_vec(), ..Context::default() };
    let falling = listed(&[4e-3, 1e-3, 2.5e-4, 6.25e-5]);
    assert_eq!(classify(&falling, &foreign), classify(&falling, &Context::default()));
    let short = Context { signed: context.signed[..3].to_vec(), ..Context::default() };
    assert_eq!(classify(&series, &short), classify(&series, &Context::default()));
}

#[test]
fn three_levels_cannot_show_a_floor_and_four_can() {
    for formal_order in [None, Some(2.0)] {
        let context = Context { formal_order, ..Context::default() };
        for errors in [[0.3, 0.3, 0.3], [4e-3, 1.2e-3, 1.0e-3], [3e-3, 3.6e-4, 8.9e-5]] {
            let classification = classify(&listed(&errors), &context);
            assert!(
                classification.floor.is_none() && classification.class != Class::FloorLimited,
                "{classification:?}"
            );
        }
    }
    let floored = |levels: usize| {
        let points: Vec<_> = SIZES[..levels].iter().map(|h| (*h, h * h + 1e-3)).collect();
        classify(&ErrorSeries::from_pairs(&points), &formal(2.0))
    };
    let three = floored(3);
    assert_eq!(three.class, Class::PreAsymptotic, "{three:?}");
    assert!(three.reason.contains("3 levels cannot distinguish a plateau of about 1e-3"), "{three:?}");
    assert!(three.advice.expect("advice").contains("add a finer level"));
    assert_eq!(floored(4).class, Class::FloorLimited);
    // What three levels took for a floor of 8.9e-5, two more show to be none.
    let falls_on = listed(&[1.3e-3, 1.6e-4, 8.9e-5, 3.3e-5, 1.1e-5]);
    assert_ne!(classify(&falls_on, &formal(2.0)).class, Class::FloorLimited);
    let before = classify(&listed(&[1.3e-3, 1.6e-4, 8.9e-5]), &formal(2.0));
    assert_ne!(before.class, Class::FloorLimited, "{before:?}");
}

#[test]
fn of_two_classes_that_fit_the_documented_one_wins() {
    let class_of = |errors: &[f64], context: Context| classify(&listed(errors), &context).class;
    let plain = Context::default;
    // Nonsense in the context before round-off, and round-off before everything else.
    let all_round_off = Context { round_off: Some(1e-12), ..plain() };
    assert_eq!(class_of(&[1e-15, 4e-15, 2e-14, 9e-14], all_round_off.clone()), Class::Exact);
    let nonsense = Context { formal_order: Some(-1.0), ..all_round_off.clone() };
    assert_eq!(class_of(&[1e-15, 4e-15, 2e-14, 9e-14], nonsense), Class::NotEvaluable);
    // A locked body is locked, whatever its errors do; but a hole is told before.
    let stuck = Context { mobility: vec![0.01, 0.02, 0.03], ..plain() };
    assert_eq!(class_of(&[1.0, 2.0, 4.0], stuck.clone()), Class::Locked);
    assert_eq!(class_of(&[1.0, f64::NAN, 4.0], stuck.clone()), Class::NotEvaluable);
    assert_eq!(class_of(&[1e-15; 3], Context { round_off: Some(1e-12), ..stuck }), Class::Exact);
    let loosened = Context { mobility: vec![0.01, 0.3, 0.8], ..plain() };
    assert_ne!(class_of(&[1.0, 0.7, 0.2], loosened), Class::Locked, "the finest mesh moves");
    // One level of round-off is a floor before it is an order, on three levels too.
    assert_eq!(class_of(&[1e-6, 1e-9, 1e-13], all_round_off), Class::FloorLimited);
    // A limit comes before growth, and growth before a standstill.
    assert_eq!(class_of(&[1.0, 2.0, 2.5, 2.75], plain()), Class::FloorLimited);
    assert_eq!(class_of(&[1.0, 1.1, 1.2, 1.3, 1.4, 1.5], plain()), Class::Divergent);
    // Ups and downs come before an alternating order.
    assert_eq!(class_of(&[1.0, 0.5, 1.0, 0.5, 1.0], plain()), Class::Oscillatory);
    // A poor reference unmakes an order, not a divergence.
    let poor = Context { reference_accuracy: Some(1.0), ..plain() };
    assert_eq!(class_of(&[4e-2, 1e-2, 2.5e-3, 6.25e-4], poor.clone()), Class::NotEvaluable);
    assert_eq!(class_of(&[1.0, 2.0, 4.0, 8.0], poor), Class::Divergent);
}

#[test]
fn growing_and_oscillating_errors_get_different_classes() {
    assert_eq!(class(&listed(&[1.0, 2.0, 4.0])), with_and_without_order(Class::Divergent));
    assert_eq!(class(&listed(&[4e-2, 1e-2, 2.5e-3, 6e-3, 2e-2])), with_and_without_order(Class::Divergent));
    assert_eq!(class(&listed(&[1.0, 1.1, 1.2, 1.3, 1.4, 1.5])), with_and_without_order(Class::Divergent));
    assert_eq!(class(&listed(&[1.0, 0.5, 1.0, 0.5, 1.0, 0.5])), with_and_without_order(Class::Oscillatory));
    assert_eq!(class(&listed(&[1.0, 0.3, 0.6, 0.1, 0.2])), with_and_without_order(Class::Oscillatory));
    // Falling all the way, with an order that jumps: 0.4, 3.6, 0.4, 3.6, …
    let jumping = [1.5, 0.5, 1.5, 0.5, 1.5, 0.5];
    let errors: Vec<_> = SIZES.iter().zip(jumping).map(|(h, factor)| factor * h * h).collect();
    assert_eq!(class(&listed(&errors)), with_and_without_order(Class::Oscillatory));
}

#[test]
fn orders_off_the_formal_one_have_their_names() {
    let with_two = |error: fn(f64) -> f64| classify(&series(error), &formal(2.0));
    assert_eq!(with_two(|h| h).class, Class::Contaminated);
    assert_eq!(with_two(|h| h.powi(3)).class, Class::Superconvergent);
    assert_eq!(with_two(|h| h * h + 80.0 * h.powi(3)).class, Class::PreAsymptotic);
    assert_eq!(with_two(|h| h * h + 800.0 * h.powi(3)).class, Class::PreAsymptotic);
    // Rising towards 2 from below, as where the coarse levels do not resolve the solution.
    assert_eq!(with_two(|h| h * h / (1.0 + 9000.0 * h * h)).class, Class::PreAsymptotic);
    let absurd = classify(&series(|h| h.powf(75.98)), &Context::default());
    assert_eq!(absurd.class, Class::Superconvergent);
    assert_eq!(classify(&series(|h| h), &Context::default()).class, Class::Asymptotic);
}

#[test]
fn round_off_does_not_choose_between_explanations() {
    // One power, 3.1, noisy, with 4 expected: a floor of nothing and a lower-order term alone fit
    // it alike, and which came first once depended on the unit of the error.
    let logs =
        [-2.864_802_598_733_636, 0.106_719_851_636_363_06, -2.029_327_346_204_365, -0.921_801_065_561_571_9];
    let points = |unit: f64| {
        let noisy = |(h, log): (&f64, f64)| {
            (*h, unit * h.powf(3.090_663_476_155_412_6) * (0.041_887_047_716_129_21 * log).exp())
        };
        ErrorSeries::from_pairs(&SIZES.iter().zip(logs).map(noisy).collect::<Vec<_>>())
    };
    let context = formal(3.986_613_621_413_895);
    for unit in [1.0, 12.208_959_938_961_737_f64.exp(), 1e3, 1e-3, 0.7] {
        assert_eq!(classify(&points(unit), &context).class, Class::Contaminated, "{unit}");
    }
}

#[test]
fn a_second_term_is_named_before_the_order_leaves_the_band() {
    // At a fifth of the finest error a floor governs, though the order is still above 1.75.
    let with_floor = |floor: f64| classify(&series(|h| h * h + floor), &formal(2.0)).class;
    assert_eq!(with_floor(1.1e-5), Class::FloorLimited);
    assert_eq!(with_floor(4e-6), Class::Asymptotic);
}

#[test]
fn a_lower_order_that_has_settled_is_wrong_only_where_another_is_expected() {
    let sizes = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 640.0_f64].map(f64::recip);
    let late = ErrorSeries::from_pairs(&sizes.map(|h| (h, h * h + 0.05 * h)));
    assert_eq!(class(&late), [Class::Asymptotic, Class::Contaminated]);
}

#[test]
fn a_floor_is_attributed_to_the_cause_that_fits_it_with_advice() {
    let limiter =
        |kind, name: &str, magnitude| Limiter { kind, name: name.to_owned(), magnitude, order: None };
    let step = limiter(LimiterKind::Step, "the time step", Some(2.2e-4));
    let model = limiter(LimiterKind::Model, "the water's storage", Some(1.4e-4));
    let floored = |floor: f64, limiters: &[Limiter]| {
        let context = Context { limiters: limiters.to_vec(), ..formal(2.0) };
        classify(&series(|h| h * h + floor), &context)
    };
    let classification = floored(2e-4, &[step.clone(), model.clone()]);
    assert_eq!(classification.floor.clone().unwrap().limiter, Some(LimiterKind::Step), "{classification:?}");
    assert_eq!(classification.advice.unwrap(), "lower the time step by 64");
    // A plateau of opposite sign, which the error passes through zero on its way to, is as high.
    let context = Context { limiters: vec![step.clone()], ..formal(2.0) };
    let dipped = classify(&series(|h| (h * h - 2e-4).abs()), &context);
    assert_eq!(dipped.advice.as_deref(), Some("lower the time step by 64"), "{dipped:?}");
    let classification = floored(1.4e-4, &[step.clone(), model]);
    assert_eq!(classification.floor.clone().unwrap().limiter, Some(LimiterKind::Model));
    assert!(classification.advice.unwrap().contains("its own equations"));
    let classification = floored(1e-2, std::slice::from_ref(&step));
    assert_eq!(classification.floor.unwrap().limiter, None);
    // A step rule of unknown height is put forward where nothing else is left, and only as likely.
    let rule = limiter(LimiterKind::Step, "`tolerance`", None);
    let classification = floored(1e-2, &[step, rule]);
    assert_eq!(classification.floor.unwrap().limiter, Some(LimiterKind::Step));
    assert!(classification.reason.contains("most likely by `tolerance`"), "{}", classification.reason);
    assert!(classification.advice.unwrap().starts_with("lower `tolerance` by"));
}

#[test]
fn a_poor_reference_is_no_evidence() {
    let context = |accuracy| Context { reference_accuracy: Some(accuracy), ..formal(2.0) };
    let clean = series(|h| h * h);
    assert_eq!(classify(&clean, &context(1e-7)).class, Class::Asymptotic);
    assert_eq!(classify(&clean, &context(0.0)).class, Class::Asymptotic);
    let poor = classify(&clean, &context(2e-5));
    assert_eq!(poor.class, Class::NotEvaluable, "{poor:?}");
    let floored = classify(&series(|h| h * h + 2e-4), &context(1.9e-4));
    assert_eq!(floored.floor.unwrap().limiter, Some(LimiterKind::Reference));
}

#[test]
fn an_invalid_context_is_not_evaluable() {
    let clean = series(|h| h * h);
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let contexts = [
            Context { formal_order: Some(bad), ..Context::default() },
            Context { round_off: Some(bad), ..Context::default() },
            Context { reference_accuracy: Some(bad), ..Context::default() },
        ];
        for context in contexts {
            assert_eq!(classify(&clean, &context).class, Class::NotEvaluable, "{context:?}");
        }
    }
}

fn any_error() -> impl Strategy<Value = Option<f64>> {
    let nonsense = vec![0.0, f64::NAN, f64::INFINITY, 1e-310, -1.0];
    prop_oneof![
        16 => (-12.0..2.0_f64).prop_map(|log| Some(log.exp())),
        2 => any::<f64>().prop_map(Some),
        1 => Just(None),
        1 => prop::sample::select(nonsense).prop_map(Some),
    ]
}

fn never_wrong(classification: &Classification, levels: &[SeriesLevel]) -> Result<(), TestCaseError> {
    prop_assert!(!classification.reason.is_empty());
    if classification.class == Class::Asymptotic {
        // Counted anew, apart from the code: steady positive orders on sound finest levels.
        let order = |pair: &[SeriesLevel]| {
            let (a, b) = (pair[0].error.unwrap(), pair[1].error.unwrap());
            (a.ln() - b.ln()) / (pair[0].size / pair[1].size).ln()
        };
        let pairs: Vec<_> = levels.windows(2).map(order).collect();
        let (coarse, fine) = (pairs[pairs.len() - 2], pairs[pairs.len() - 1]);
        prop_assert!(levels.iter().all(|level| level.error.unwrap().is_normal()));
        prop_assert!((coarse - fine).abs() <= 0.2501 && fine > 0.29, "{:?} {:?}", classification, pairs);
    }
    if let Some(order) = classification.order {
        prop_assert!(order.is_finite());
        let without = [Class::NotEvaluable, Class::Exact, Class::Divergent, Class::Oscillatory];
        prop_assert!(!without.contains(&classification.class));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn any_numbers_get_a_class_and_none_passes_wrongly(
        errors in prop::collection::vec(any_error(), 0..7),
        ratios in prop::collection::vec(1.0..4.0_f64, 7),
        formal_order in prop::option::of(0.5..4.0_f64),
        round_off in prop::option::of(Just(1e-13)),
    ) {
        let mut size = 1.0;
        let levels: Vec<_> = errors.iter().zip(&ratios).map(|(error, ratio)| {
            size /= ratio;
            SeriesLevel { size, error: *error }
        }).collect();
        let context = Context { formal_order, round_off, ..Context::default() };
        let series = ErrorSeries::new(levels);
        never_wrong(&classify(&series, &context), series.levels())?;
    }

    #[test]
    fn nearly_steady_series_never_pass_wrongly(
        slopes in prop::collection::vec(-0.5..3.0_f64, 2..6),
        formal_order in prop::option::of(0.5..3.0_f64),
    ) {
        let mut error = 1.0;
        let mut points = vec![(SIZES[0], error)];
        for (slope, size) in slopes.iter().zip(&SIZES[1..]) {
            error *= 0.5_f64.powf(*slope);
            points.push((*size, error));
        }
        let context = Context { formal_order, ..Context::default() };
        let series = ErrorSeries::from_pairs(&points);
        never_wrong(&classify(&series, &context), series.levels())?;
    }

    #[test]
    fn scaling_errors_or_sizes_leaves_the_class(
        logs in prop::collection::vec(-3.0..3.0_f64, 3..7),
        slope in -1.0..4.0_f64,
        noise in 0.0..0.3_f64,
        factor in -20.0..20.0_f64,
        formal_order in prop::option::of(0.5..4.0_f64),
    ) {
        let points: Vec<_> = logs.iter().zip(SIZES)
            .map(|(log, h)| (h, h.powf(slope) * (noise * log).exp())).collect();
        let context = Context { formal_order, ..Context::default() };
        let k = factor.exp();
        let plain = classify(&ErrorSeries::from_pairs(&points), &context).class;
        let errors: Vec<_> = points.iter().map(|(h, e)| (*h, k * e)).collect();
        let meshes: Vec<_> = points.iter().map(|(h, e)| (k * h, *e)).collect();
        prop_assert_eq!(classify(&ErrorSeries::from_pairs(&errors), &context).class, plain);
        prop_assert_eq!(classify(&ErrorSeries::from_pairs(&meshes), &context).class, plain);
    }

    #[test]
    fn power_laws_of_the_formal_order_are_asymptotic(
        p in 0.5..5.0_f64, c in -20.0..20.0_f64, noise in prop::collection::vec(-1.0..1.0_f64, 6),
    ) {
        // 1 % of noise is 0.02/ln 2 = 0.03 in a pair order at most.
        let points: Vec<_> = SIZES.iter().zip(&noise)
            .map(|(h, noise)| (*h, c.exp() * h.powf(p) * (1.0 + 0.01 * noise))).collect();
        let classification = classify(&ErrorSeries::from_pairs(&points), &formal(p));
        prop_assert_eq!(classification.class, Class::Asymptotic, "{:?}", classification);
    }
}

/// `h^p + b h^q` on six levels that halve: the share of the second term in the finest error, by hand.
#[test]
fn the_share_of_a_second_term_is_given_at_the_finest_level() {
    for (p, q, share, class) in [
        (1.0, 0.0, 0.21, Class::FloorLimited),
        (2.0, 1.0, 0.22, Class::Contaminated),
        (2.0, 1.0, 0.25, Class::Contaminated),
        (2.0, 1.5, 0.3, Class::Contaminated),
        (2.0, 1.5, 0.4, Class::Contaminated),
    ] {
        let coefficient = share / (1.0 - share) * SIZES[5].powf(p - q);
        let classification = classify(&series(|h| h.powf(p) + coefficient * h.powf(q)), &Context::default());
        assert_eq!(classification.class, class, "{share}: {classification:?}");
        let share_text = format!(" makes up {:.0} % of the finest error", 100.0 * share);
        let is_named = classification.reason.contains("over all 6 levels")
            && classification.reason.contains(&share_text);
        assert!(is_named, "{share}: {}", classification.reason);
    }
}
