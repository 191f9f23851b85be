//! Everything that the crate says of some hundreds of generated series, as snapshots: class, sentence, advice, order, floor,
//! fits and uncertainties. A changed rule, number or word shows as a difference that can be read.

use super::known_truth::{Draw, KINDS};
use crate::{
    Class, Context, CostPoint, ErrorBound, ErrorSeries, FloorBand, KnownFailure, Limiter, LimiterKind,
    OrderBand, SeriesDemand, SeriesLevel, ValueSeries, classify, finest_order, front, hidden_floor,
    pair_orders, slope,
};
use oedometer_wording::rounded;
use serde_json::Value;
use std::fmt::Write as _;

/// What is serialised, on one line, with as many digits as every machine has in common.
fn serialised(value: &impl serde::Serialize) -> String {
    fn write(value: &Value) -> String {
        match value {
            // Residuals of exact fits are round-off.
            Value::Number(number) => match number.as_f64().expect("a number") {
                tiny if tiny.abs() < 1e-13 => "0".to_owned(),
                number => rounded(number),
            },
            Value::Array(all) => format!("[{}]", all.iter().map(write).collect::<Vec<_>>().join(" ")),
            Value::Object(all) => {
                let part = |(name, value): (&String, &Value)| format!("{name} {}", write(value));
                format!("{{{}}}", all.iter().map(part).collect::<Vec<_>>().join(", "))
            }
            Value::String(text) => text.clone(),
            other => other.to_string(),
        }
    }
    write(&serde_json::to_value(value).expect("plain data"))
}

/// A number with as many digits as every machine has in common, or why there is none.
fn number<E: ToString>(value: Result<f64, E>) -> String {
    value.map_or_else(|obstacle| obstacle.to_string(), rounded)
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(rounded).collect::<Vec<_>>().join(" ")
}

/// Orders on both sides of every limit of the rules.
const ORDERS: [f64; 20] = [
    -1.2, -0.4, -0.151, -0.149, 0.0, 0.1, 0.149, 0.151, 0.299, 0.301, 0.45, 0.55, 0.8, 0.95, 1.0, 1.05, 1.3,
    1.8, 2.0, 2.6,
];

/// Errors with these orders from level to level, at a ratio of two.
fn with_orders(orders: &[f64]) -> Vec<(f64, f64)> {
    let mut points = vec![(0.25, 0.3)];
    for order in orders {
        let (size, error) = points[points.len() - 1];
        points.push((0.5 * size, error * 2.0_f64.powf(-order)));
    }
    points
}

/// What else may be known of a series: a floor's candidates, accuracies and mobilities about the limits of the rules.
fn context(draw: &mut Draw, points: &[(f64, f64)], formal: Option<f64>) -> Context {
    let least = points.iter().map(|point| point.1.abs()).fold(f64::INFINITY, f64::min);
    let mut context = Context { formal_order: formal, ..Context::default() };
    match draw.place(9.0) {
        0 => context.round_off = Some(least * draw.choose(&[0.5, 0.99, 1.5, 4.0])),
        1 => context.reference_accuracy = Some(least * draw.choose(&[0.05, 0.099, 0.11, 0.7])),
        2 => context.mobility = points.iter().map(|_| draw.choose(&[0.1, 0.3, 0.499, 0.5])).collect(),
        3 | 4 => {
            for (kind, name) in [(LimiterKind::Step, "the step"), (LimiterKind::Model, "the water's storage")]
            {
                let magnitude = draw.choose(&[None, Some(0.2), Some(0.9), Some(1.1), Some(6.0)]);
                let magnitude = magnitude.map(|share| share * least);
                let order = draw.choose(&[None, Some(1.0), Some(2.0)]);
                context.limiters.push(Limiter { magnitude, order, ..Limiter::new(kind, name) });
            }
        }
        _ => {}
    }
    if points.iter().any(|point| point.1 < 0.0) {
        context.signed = points.iter().map(|point| point.1).collect();
    }
    context
}

fn line(text: &mut String, context: &Context, points: &[(f64, f64)]) {
    let magnitudes: Vec<_> = points.iter().map(|point| (point.0, point.1.abs())).collect();
    let series = ErrorSeries::from_pairs(&magnitudes);
    let Context { formal_order, round_off, reference_accuracy, limiters, mobility, signed, tolerance } =
        context;
    let known = [
        ("formal", formal_order),
        ("round-off", round_off),
        ("tolerance", tolerance),
        ("reference", reference_accuracy),
    ];
    write!(text, "{}", numbers(points.iter().map(|point| point.1))).expect("memory");
    for (name, value) in known {
        if let Some(value) = value {
            write!(text, ", {name} {}", rounded(*value)).expect("memory");
        }
    }
    if !mobility.is_empty() {
        write!(text, ", mobility {}", numbers(mobility.iter().copied())).expect("memory");
    }
    if !limiters.is_empty() {
        write!(text, ", limiters {}", serialised(limiters)).expect("memory");
    }
    let signs = if signed.is_empty() { "" } else { ", with signs" };
    let floor = rounded(hidden_floor(&series, *formal_order));
    writeln!(text, "{signs}\n    {}; hidden floor {floor}", serialised(&classify(&series, context)))
        .expect("memory");
}

fn assert_snapshot(name: &str, text: &str) {
    insta::with_settings!({
        snapshot_path => "../../../../tests/snapshots", prepend_module_to_snapshot => false, omit_expression => true
    }, { insta::assert_snapshot!(name, text) });
}

/// A power over floors of several heights, of which some have a known cause.
fn floors(draw: &mut Draw, text: &mut String) {
    *text += "floors and their causes\n";
    for turn in 0..70 {
        let (order, ratio) = (draw.choose(&[0.6, 1.0, 1.5, 2.0, 3.0]), draw.choose(&[1.5, 2.0, 3.0]));
        let count = draw.choose(&[4, 5, 6, 7]);
        let (mut points, mut size) = (Vec::new(), 0.25);
        let floor = draw.choose(&[1e-4, 1e-3, 0.01, 0.03]) * if turn % 9 == 4 { -1.0 } else { 1.0 };
        for _ in 0..count {
            points.push((size, 0.4 * f64::powf(size, order) + floor));
            size /= ratio;
        }
        let formal = draw.choose(&[None, Some(order), Some(2.0)]);
        let mut context = context(draw, &points, formal);
        for kind in [LimiterKind::Step, LimiterKind::Mesh, LimiterKind::PointsPerCell, LimiterKind::Model] {
            if draw.place(3.0) == 0 {
                let magnitude =
                    draw.choose(&[None, Some(0.5 * floor.abs()), Some(floor.abs()), Some(2.1 * floor.abs())]);
                let order = draw.choose(&[None, Some(1.0), Some(2.0)]);
                context.limiters.push(Limiter { magnitude, order, ..Limiter::new(kind, "something") });
            }
        }
        line(text, &context, &points);
    }
}

/// Errors that go up and down, a few of them equal.
fn ups_and_downs(draw: &mut Draw, text: &mut String) {
    *text += "ups and downs\n";
    for _ in 0..40 {
        let count = draw.choose(&[3, 4, 5, 6]);
        let factors = [0.5, 0.7, 1.0, 1.0, 1.3, 1.31, 1.5, 2.0];
        let mut points = vec![(0.25, 0.3)];
        for _ in 0..count {
            let (size, error) = points[points.len() - 1];
            points.push((0.5 * size, error * draw.choose(&factors)));
        }
        let formal = draw.choose(&[None, Some(1.0)]);
        let context = context(draw, &points, formal);
        line(text, &context, &points);
    }
}

#[test]
fn classes_of_series_come_with_their_numbers() {
    let mut draw = Draw(19_880_401);
    let mut text = String::new();
    for (kind, make) in KINDS {
        writeln!(text, "{kind}").expect("memory");
        for ratio in [1.3, 2.0, 3.0] {
            let known = make(&mut draw, ratio);
            let context = context(&mut draw, &known.points, known.formal);
            line(&mut text, &context, &known.points);
        }
    }
    for count in [2, 3, 3, 4, 5] {
        writeln!(text, "{count} orders").expect("memory");
        for turn in 0..45 {
            let mut orders: Vec<f64> = (0..count).map(|_| draw.choose(&ORDERS)).collect();
            if turn % 3 > 0 {
                // Near a steady order the rules differ by little.
                let (steady, by) = (draw.choose(&ORDERS), draw.choose(&[0.02, 0.06, 0.11, 0.2, 0.3]));
                for order in &mut orders {
                    *order = steady + draw.between(-by, by);
                }
            }
            let points = with_orders(&orders);
            let formal = draw.choose(&[None, Some(1.0), Some(2.0)]);
            let context = context(&mut draw, &points, formal);
            line(&mut text, &context, &points);
        }
    }
    floors(&mut draw, &mut text);
    ups_and_downs(&mut draw, &mut text);
    assert_snapshot("convergence_classes", &text);
}

#[test]
fn series_that_cannot_be_evaluated_say_why() {
    let mut text = String::new();
    let sizes = [0.4, 0.2, 0.1, 0.05];
    let third = [None, Some(f64::NAN), Some(f64::INFINITY), Some(-0.3), Some(0.0), Some(1e-310), Some(0.08)];
    for error in third {
        let level = |(place, size): (usize, &f64)| SeriesLevel {
            size: *size,
            error: if place == 2 { error } else { Some(size * size) },
        };
        let series = ErrorSeries::new(sizes.iter().enumerate().map(level).collect());
        let orders: Vec<_> = pair_orders(&series).into_iter().map(number).collect();
        let fit = slope(&series).map(|fit| {
            let width = fit.half_width.map_or("none".to_owned(), rounded);
            format!("order {} ± {width}, {} of {}", rounded(fit.order), rounded(fit.coefficient), fit.levels)
        });
        let fit = fit.unwrap_or_else(|obstacle| obstacle.to_string());
        let finest = number(finest_order(&series));
        let class = serialised(&classify(&series, &Context::default()));
        writeln!(text, "{error:?}: {}; slope {fit}; finest {finest}\n    {class}", orders.join(" | "))
            .expect("memory");
    }
    for ratio in [1.0, 1.000_000_001, 1.1, 1.149, 1.151] {
        let series = ErrorSeries::from_pairs(&[(0.4 * ratio, 0.4), (0.4, 0.1), (0.1, 0.03)]);
        writeln!(text, "ratio {ratio}: {}", serialised(&classify(&series, &Context::default())))
            .expect("memory");
    }
    for count in 0..4 {
        let series = ErrorSeries::from_pairs(&sizes.map(|size| (size, size * size))[..count]);
        let finest = number(finest_order(&series));
        writeln!(text, "{count} levels: {finest}; {}", serialised(&classify(&series, &Context::default())))
            .expect("memory");
    }
    let series = ErrorSeries::from_pairs(&sizes.map(|size| (size, size * size)));
    for wrong in [-1.0, 0.0, 1e-9, f64::NAN, f64::INFINITY] {
        let some = Some(wrong);
        for (name, context) in [
            ("formal order", Context { formal_order: some, ..Context::default() }),
            ("round-off", Context { round_off: some, ..Context::default() }),
            ("reference", Context { reference_accuracy: some, ..Context::default() }),
        ] {
            writeln!(text, "{name} {wrong}: {}", serialised(&classify(&series, &context))).expect("memory");
        }
    }
    for (errors, round_off) in
        [([0.0, 0.0, 0.0], None), ([2e-13, 1e-13, 3e-13], Some(3e-13)), ([2e-13, 1e-13, 4e-13], Some(3e-13))]
    {
        let series = ErrorSeries::from_pairs(&[(0.4, errors[0]), (0.2, errors[1]), (0.1, errors[2])]);
        let classification = classify(&series, &Context { round_off, ..Context::default() });
        writeln!(text, "{}: {}", numbers(errors), serialised(&classification)).expect("memory");
    }
    assert_snapshot("convergence_obstacles", &text);
}

#[test]
fn uncertainties_come_with_everything_they_are_derived_from() {
    let mut draw = Draw(5_551_212);
    let mut text = String::new();
    for turn in 0..70 {
        let ratio = draw.choose(&[1.2, 1.5, 2.0, 3.0]);
        let count = draw.choose(&[3, 3, 4, 5, 6]);
        let order = draw.choose(&[0.3, 0.5, 0.95, 1.0, 1.5, 2.0, 2.3, 3.0]);
        let formal = draw.choose(&[1.0, 2.0]);
        let limit = draw.choose(&[0.0, 1.7, -2.3]);
        let (scale, noise) = (draw.choose(&[0.3, -0.6]), draw.choose(&[0.0, 0.0, 0.01, 0.1, 0.4]));
        let mut size = 0.5;
        let mut levels = Vec::new();
        for place in 0..count {
            let turned = if turn % 7 == 3 && place % 2 == 1 { -1.0 } else { 1.0 };
            let factor = turned * (1.0 + draw.between(-noise, noise));
            let power = if turn % 11 == 5 { -order } else { order };
            levels.push((size, Some(limit + scale * factor * f64::powf(size, power))));
            size /= ratio;
        }
        let values: Vec<f64> = levels.iter().filter_map(|level| level.1).collect();
        let series = ValueSeries::new(levels.into_iter().rev().collect());
        let uncertainty = match series.uncertainty(formal) {
            Ok(uncertainty) => format!(
                "{}; {} of {}, relative {}",
                serialised(&uncertainty),
                uncertainty.estimator.name(),
                rounded(uncertainty.finest()),
                rounded(uncertainty.relative())
            ),
            Err(obstacle) => obstacle.to_string(),
        };
        let differences: Vec<_> = series.signed_differences().into_iter().filter_map(|pair| pair.1).collect();
        writeln!(
            text,
            "{} at ratio {ratio}, formal {formal}; differences {}\n    {uncertainty}",
            numbers(values),
            numbers(differences)
        )
        .expect("memory");
    }
    let odd: [&[(f64, Option<f64>)]; 7] = [
        &[(0.4, Some(1.0)), (0.2, Some(2.0))],
        &[(0.4, Some(1.0)), (0.2, None), (0.1, Some(2.0))],
        &[(0.4, Some(1.0)), (0.2, Some(1.0)), (0.1, Some(1.0))],
        &[(0.4, Some(1.0)), (0.2, Some(1.2)), (0.1, Some(1.2))],
        &[(0.4, Some(1.0)), (0.2, Some(f64::NAN)), (0.1, Some(1.2))],
        &[(0.4, Some(1.0)), (0.2, Some(1.5)), (0.2, Some(1.2))],
        &[(0.4, Some(1.0)), (-0.2, Some(1.5)), (0.1, Some(1.2))],
    ];
    for levels in odd {
        let uncertainty = ValueSeries::new(levels.to_vec()).uncertainty(2.0);
        let uncertainty =
            uncertainty.map_or_else(|obstacle| obstacle.to_string(), |uncertainty| serialised(&uncertainty));
        writeln!(text, "{levels:?}\n    {uncertainty}").expect("memory");
    }
    assert_snapshot("convergence_uncertainties", &text);
}

#[test]
fn invalid_demands_are_refused_with_a_reason() {
    let none = SeriesDemand::default();
    let at = |size, below, above| Some(ErrorBound { size, below, above });
    let order = |value, minus, plus| Some(OrderBand { value, minus, plus });
    let floor = |above, below| Some(FloorBand { above, below });
    let mut demands = vec![none.clone(), SeriesDemand { class: Some(Class::Locked), ..none.clone() }];
    for bad in [-0.1, 0.0, 0.1, 0.3, f64::NAN, f64::INFINITY] {
        let uncertainty = Some(bad);
        demands.extend([
            SeriesDemand { order: order(bad, 0.1, 0.2), ..none.clone() },
            SeriesDemand { order: order(2.0, bad, 0.2), ..none.clone() },
            SeriesDemand { order: order(2.0, 0.1, bad), ..none.clone() },
            SeriesDemand { at: at(bad, 0.3, 0.2), ..none.clone() },
            SeriesDemand { at: at(0.5, bad, 0.0), ..none.clone() },
            SeriesDemand { at: at(0.5, 0.3, bad), ..none.clone() },
            SeriesDemand { spread: at(bad, 0.3, 0.0), ..none.clone() },
            SeriesDemand { spread: at(0.5, bad, 0.0), ..none.clone() },
            SeriesDemand { floor: floor(bad, 0.3), ..none.clone() },
            SeriesDemand { floor: floor(0.1, bad), ..none.clone() },
            SeriesDemand { oscillation_below: Some(bad), ..none.clone() },
            SeriesDemand { uncertainty_below: uncertainty, ..none.clone() },
        ]);
    }
    for reason in ["", " ", "known"] {
        let xfail = Some(KnownFailure { strict: true, reason: reason.to_owned() });
        demands.push(SeriesDemand { xfail, order: order(1.0, 0.1, 0.2), ..none.clone() });
    }
    let mut text = String::new();
    for demand in demands {
        let class = demand.expected_class().map_or("no class", Class::name);
        let problems: Vec<&str> = demand.problems().iter().map(|problem| problem.sentence).collect();
        writeln!(text, "{demand:?}\n    {class}; {}", problems.join("; ")).expect("memory");
    }
    for value in [1.69, 1.7, 2.0, 2.25, 2.26, f64::NAN] {
        let band = OrderBand { value: 2.0, minus: 0.3, plus: 0.25 };
        let floor = FloorBand { above: 1.7, below: 2.25 };
        writeln!(text, "{value} in the bands: {} {}", band.contains(value), floor.contains(value))
            .expect("memory");
    }
    assert_snapshot("convergence_demands", &text);
}

#[test]
fn the_front_is_what_no_other_point_dominates() {
    let mut draw = Draw(77);
    for _ in 0..300 {
        let count = draw.place(9.0);
        let cost = [1.0, 2.0, 3.0, 5.0, 0.0, f64::NAN, f64::INFINITY];
        let error = [0.0, 0.1, 0.2, 0.4, -0.1, f64::NAN, f64::INFINITY];
        let points: Vec<CostPoint> =
            (0..count).map(|_| CostPoint { cost: draw.choose(&cost), error: draw.choose(&error) }).collect();
        let is_usable =
            |point: &CostPoint| (1.0..10.0).contains(&point.cost) && (0.0..10.0).contains(&point.error);
        let dominates = |a: &CostPoint, b: &CostPoint| {
            a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error)
        };
        let wanted: Vec<bool> = points
            .iter()
            .map(|b| is_usable(b) && !points.iter().any(|a| is_usable(a) && dominates(a, b)))
            .collect();
        assert_eq!(front(&points), wanted, "{points:?}");
        assert!(points.iter().all(|point| point.is_usable() == is_usable(point)), "{points:?}");
    }
}
