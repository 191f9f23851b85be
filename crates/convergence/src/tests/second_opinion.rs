//! Every statistic of the convergence code against a second implementation: plain least squares by normal equations, scans
//! for exponents, integrals for quantiles, fixed points for orders. Nothing of the first is used here.

use crate::fit::Exponent;
use crate::fit::approach_to_limit::{Limit, fit_cancelling, limit_of};
use crate::fit::floor::fit_floor;
use crate::fit::two_terms::fit_two_terms;
use crate::orders::{finest_order, quantile_975, slope};
use crate::series::ErrorSeries;
use crate::uncertainty::{ErrorModel, ValueSeries, least_squares_uncertainty, three_grids};

/// Unequal ratios, and lengths that are not of the order of 1.
const SIZES: [f64; 6] = [7.3, 4.1, 2.9, 1.7, 1.1, 0.6];

/// Deviations of like size and no pattern, per cent.
const NOISE: [f64; 6] = [1.3, -0.7, 0.9, -1.6, 0.4, -0.2];

fn noisy(error: impl Fn(f64) -> f64, share: f64) -> Vec<(f64, f64)> {
    SIZES.iter().zip(NOISE).map(|(h, noise)| (*h, error(*h) * (1.0 + share * noise / 100.0))).collect()
}

/// Coefficients and weighted sum of squares by normal equations and Gauss's elimination with pivots.
fn normal_equations(columns: &[Vec<f64>], target: &[f64], weights: &[f64]) -> (Vec<f64>, f64) {
    let count = columns.len();
    let dot = |a: &[f64], b: &[f64]| -> f64 { (0..a.len()).map(|row| weights[row] * a[row] * b[row]).sum() };
    let mut system: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| {
            let mut row: Vec<f64> = columns.iter().map(|other| dot(column, other)).collect();
            row.push(dot(column, target));
            row
        })
        .collect();
    for pivot in 0..count {
        let best = (pivot..count).max_by(|a, b| system[*a][pivot].abs().total_cmp(&system[*b][pivot].abs()));
        system.swap(pivot, best.expect("a row"));
        for row in 0..count {
            if row != pivot {
                let factor = system[row][pivot] / system[pivot][pivot];
                for column in pivot..=count {
                    system[row][column] -= factor * system[pivot][column];
                }
            }
        }
    }
    let solution: Vec<f64> = (0..count).map(|row| system[row][count] / system[row][row]).collect();
    let left = |row: usize| -> f64 {
        let model: f64 = (0..count).map(|column| solution[column] * columns[column][row]).sum();
        weights[row] * (target[row] - model).powi(2)
    };
    let square = (0..target.len()).map(left).sum();
    (solution, square)
}

/// Where a function of one number is least, by scans that close in.
fn least(mut from: f64, mut to: f64, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..12 {
        let place = |step: u32| from + (to - from) * f64::from(step) / 200.0;
        let best = (0..=200).min_by(|a, b| value(place(*a)).total_cmp(&value(place(*b)))).expect("a step");
        (from, to) = (place(best.saturating_sub(1)), place((best + 1).min(200)));
    }
    0.5 * (from + to)
}

fn near(computed: f64, wanted: f64, within: f64, what: &str) {
    assert!((computed / wanted - 1.0).abs() < within, "{what}: {computed} for {wanted}");
}

#[test]
fn quantiles_are_integrals_of_the_density() {
    // P(|t| < q) by Simpson's rule over the density, normalised by the integral over an angle.
    for freedom in 1..=12_usize {
        let q = quantile_975(freedom).expect("a quantile");
        // With t = √ν tan θ the density is cos^(ν−1) θ, from −π/2 to π/2.
        let simpson = |to: f64| {
            let steps = 20_000;
            let width = to / f64::from(steps);
            let at =
                |step: i32| (f64::from(step) * width).cos().powi(i32::try_from(freedom).expect("few") - 1);
            let weight =
                |step: i32| if step == 0 || step == steps { 1.0 } else { f64::from(2 + 2 * (step % 2)) };
            (0..=steps).map(|step| weight(step) * at(step)).sum::<f64>() * width / 3.0
        };
        let share = simpson((q / (freedom as f64).sqrt()).atan()) / simpson(std::f64::consts::FRAC_PI_2);
        assert!((share - 0.95).abs() < 1e-9, "{freedom}: {share}");
    }
}

#[test]
fn slopes_and_their_intervals_are_those_of_normal_equations() {
    // Quantiles from any table.
    let table = [12.706_205, 4.302_653, 3.182_446, 2.776_445];
    for levels in 3..=6 {
        let points = &noisy(|h| 0.03 * h.powf(1.7), 5.0)[..levels];
        let x: Vec<f64> = points.iter().map(|point| point.0.ln()).collect();
        let y: Vec<f64> = points.iter().map(|point| point.1.ln()).collect();
        let (coefficients, square) =
            normal_equations(&[vec![1.0; levels], x.clone()], &y, &vec![1.0; levels]);
        let mean = x.iter().sum::<f64>() / levels as f64;
        let spread: f64 = x.iter().map(|place| (place - mean).powi(2)).sum();
        let freedom = levels - 2;
        let half_width = table[freedom - 1] * (square / freedom as f64 / spread).sqrt();
        let fit = slope(&ErrorSeries::from_pairs(points)).expect("a slope");
        near(fit.order, coefficients[1], 1e-9, "order");
        near(fit.coefficient, coefficients[0].exp(), 1e-8, "coefficient");
        near(fit.half_width.expect("an interval"), half_width, 1e-5, "half-width");
        assert_eq!(fit.levels, levels);
        let last: Vec<usize> = (levels - 3..levels).collect();
        let pick = |from: &[f64]| last.iter().map(|place| from[*place]).collect::<Vec<f64>>();
        let (window, _) = normal_equations(&[vec![1.0; 3], pick(&x)], &pick(&y), &[1.0; 3]);
        near(
            finest_order(&ErrorSeries::from_pairs(points)).expect("an order"),
            window[1],
            1e-9,
            "finest order",
        );
    }
}

/// Root mean square of relative residuals of `a h^p + b h^q`, and both coefficients.
fn two_powers(points: &[(f64, f64)], p: f64, q: f64) -> (Vec<f64>, f64) {
    let column = |power: f64| points.iter().map(|(h, e)| h.powf(power) / e).collect::<Vec<f64>>();
    let ones = vec![1.0; points.len()];
    let (coefficients, square) = normal_equations(&[column(p), column(q)], &ones, &ones);
    (coefficients, (square / points.len() as f64).sqrt())
}

#[test]
fn two_powers_are_those_of_normal_equations() {
    let points = noisy(|h| 0.02 * h + 0.05 * h * h, 1.0);
    let fit = fit_two_terms(&points, Exponent::Fixed(1.0), Exponent::Fixed(2.0)).expect("a fit");
    let (coefficients, residual) = two_powers(&points, 1.0, 2.0);
    near(fit.low_coefficient, coefficients[0], 1e-9, "low");
    near(fit.high_coefficient, coefficients[1], 1e-9, "high");
    near(fit.residual, residual, 1e-9, "residual");
    let size = 1.3;
    let share = coefficients[0] * size / (coefficients[0] * size + coefficients[1] * size * size);
    near(fit.low_share(size), share, 1e-9, "share");
    near(fit.crossover().expect("both terms"), coefficients[0] / coefficients[1], 1e-9, "crossover");
}

#[test]
fn floors_their_exponents_and_their_tests_are_those_of_a_scan() {
    for (noise, floor, significant) in [(0.5, 0.15, true), (2.0, 0.002, false), (0.0, 0.01, true)] {
        let points = noisy(|h| floor + 0.04 * h.powf(1.8), noise);
        let fit = fit_floor(&points).expect("a fit");
        let order = least(0.3, 6.0, |p| two_powers(&points, 0.0, p).1);
        let (coefficients, residual) = two_powers(&points, 0.0, order);
        if noise > 0.0 {
            near(fit.residual, residual, 1e-4, "residual");
        }
        near(fit.order, order, 1e-4, "order");
        near(fit.floor, coefficients[0], 1e-3, "floor");
        near(fit.coefficient, coefficients[1], 1e-3, "coefficient");
        // Fisher's test of one more number: three are fitted to six levels, and F(1, 3) at 95 % is 10.128.
        let x: Vec<f64> = points.iter().map(|point| point.0.ln()).collect();
        let y: Vec<f64> = points.iter().map(|point| point.1.ln()).collect();
        let (line, _) = normal_equations(&[vec![1.0; 6], x], &y, &[1.0; 6]);
        let off = |(h, e): &(f64, f64)| (line[0].exp() * h.powf(line[1]) / e - 1.0).powi(2);
        let straight: f64 = points.iter().map(off).sum();
        let left = 6.0 * residual * residual;
        assert_eq!((straight - left) / (left / 3.0) > 10.128, significant, "{noise} {floor}");
        assert_eq!(fit.significant, significant, "{noise} {floor}: {fit:?}");
    }
}

#[test]
fn a_dip_is_where_normal_equations_put_it() {
    // |0.04 h² − 0.3|: passes through zero at 2.74, between the third level and the fourth.
    let points = noisy(|h| (0.04 * h * h - 0.3).abs(), 0.3);
    let fit = fit_cancelling(&points).expect("a dip");
    let signed: Vec<(f64, f64)> =
        points.iter().map(|(h, e)| (*h, if 0.04 * h * h < 0.3 { -e } else { *e })).collect();
    let order = least(0.5, 5.0, |p| two_powers(&signed, 0.0, p).1);
    let (coefficients, _) = two_powers(&signed, 0.0, order);
    near(fit.order, order, 1e-4, "order");
    near(fit.floor, -coefficients[0], 1e-3, "floor");
    near(fit.coefficient, coefficients[1], 1e-3, "coefficient");
    near(fit.cancels_at, (-coefficients[0] / coefficients[1]).powf(1.0 / order), 1e-3, "place");
}

#[test]
fn a_limit_is_the_one_of_normal_equations_on_the_last_four_levels() {
    let values: Vec<(f64, f64)> =
        SIZES.iter().zip(NOISE).map(|(h, noise)| (*h, 0.3 - 0.004 * h.powf(1.6) + 2e-6 * noise)).collect();
    let Some(Limit::Confirmed(approach)) = limit_of(&values) else { panic!("{:?}", limit_of(&values)) };
    let four = &values[2..];
    let target: Vec<f64> = four.iter().map(|value| value.1).collect();
    let fit = |p: f64| {
        let powers = four.iter().map(|value| value.0.powf(p)).collect();
        normal_equations(&[vec![1.0; 4], powers], &target, &[1.0; 4])
    };
    let order = least(0.5, 5.0, |p| fit(p).1);
    near(approach.limit, fit(order).0[0], 1e-6, "limit");
    near(approach.order, order, 1e-3, "order");
    near(approach.at(0.3), fit(order).0[0] + fit(order).0[1] * 0.3_f64.powf(order), 1e-6, "value");
}

/// A model of Eça & Hoekstra by normal equations: exponents, whether weighted, coefficients, deviation.
type Model = (ErrorModel, bool, Vec<f64>, Vec<f64>, f64);

/// Name, value over the size, and per cent of noise in the per cent of [`NOISE`].
type Kind = (&'static str, fn(f64) -> f64, f64);

fn models_of(values: &[(f64, f64)]) -> Vec<Model> {
    let count = values.len() as f64;
    let target: Vec<f64> = values.iter().map(|value| value.1).collect();
    let sum: f64 = values.iter().map(|value| 1.0 / value.0).sum();
    let mut all = Vec::new();
    for weighted in [false, true] {
        // Appendix A: w_i = (1/h_i)/Σ(1/h), which times n keeps the deviation in the unit of the value.
        let weight = |value: &(f64, f64)| if weighted { count / value.0 / sum } else { 1.0 };
        let weights: Vec<f64> = values.iter().map(weight).collect();
        let fit = |exponents: &[f64]| {
            let mut columns = vec![vec![1.0; values.len()]];
            columns.extend(exponents.iter().map(|p| values.iter().map(|value| value.0.powf(*p)).collect()));
            normal_equations(&columns, &target, &weights)
        };
        let p = least(0.01, 8.0, |p| fit(&[p]).1);
        // Numbers fitted: the power law has three (φ0, α, p), one power two, two powers three.
        for (model, exponents, fitted) in [
            (ErrorModel::PowerLaw, vec![p], 3.0),
            (ErrorModel::FirstOrder, vec![1.0], 2.0),
            (ErrorModel::SecondOrder, vec![2.0], 2.0),
            (ErrorModel::FirstAndSecondOrder, vec![1.0, 2.0], 3.0),
        ] {
            let (coefficients, square) = fit(&exponents);
            all.push((model, weighted, exponents, coefficients, (square / (count - fitted)).sqrt()));
        }
    }
    all
}

#[test]
fn every_error_model_of_eca_and_hoekstra_is_that_of_normal_equations() {
    // By the order that the power law finds: in range, above it, below it, and noise.
    let kinds: [Kind; 5] = [
        ("in range", |h| 3.0 + 0.02 * h.powf(1.4), 0.02),
        ("too high", |h| 3.0 + 1e-4 * h.powi(4), 0.02),
        ("too high and first", |h| 3.0 + 1e-5 * h.powi(5) + 0.01 * h, 0.02),
        ("too low", |h| 3.0 + 0.05 * h.powf(0.1), 0.02),
        ("noise", |_| 3.0, 5.0),
    ];
    let mut chosen = Vec::new();
    for (kind, value, share) in kinds {
        for levels in 4..=6 {
            let values = &noisy(value, share)[6 - levels..];
            let uncertainty = least_squares_uncertainty(values, 2.0).expect("numbers");
            let models = models_of(values);
            let best = |wanted: &[ErrorModel]| {
                let candidates = models.iter().filter(|model| wanted.contains(&model.0));
                candidates.min_by(|a, b| a.4.total_cmp(&b.4)).expect("a model").clone()
            };
            let power = best(&[ErrorModel::PowerLaw]);
            let order = power.2[0];
            let (first, second, mixed) =
                (ErrorModel::FirstOrder, ErrorModel::SecondOrder, ErrorModel::FirstAndSecondOrder);
            let model = match order {
                _ if (0.5..=2.0).contains(&order) => power,
                _ if order > 2.0 => best(&[first, second]),
                _ => best(&[first, second, mixed]),
            };
            let what = format!("{kind} on {levels}: {:?} {order:.3}", model.0);
            near(uncertainty.observed_order, order, 2e-3, &what);
            assert_eq!(
                (uncertainty.model, uncertainty.weighted),
                (model.0, model.1),
                "{what}: {uncertainty:?}"
            );
            near(uncertainty.deviation, model.4, 1e-4, &what);
            near(uncertainty.extrapolated, model.3[0], 1e-5, &what);
            let highest = values.iter().map(|value| value.1).fold(f64::MIN, f64::max);
            let lowest = values.iter().map(|value| value.1).fold(f64::MAX, f64::min);
            let range = (highest - lowest) / (levels as f64 - 1.0);
            near(uncertainty.data_range, range, 1e-12, &what);
            let factor = if model.4 < range && (0.5..2.1).contains(&order) { 1.25 } else { 3.0 };
            assert_eq!(uncertainty.safety_factor, factor, "{what}");
            for (grid, (size, value)) in uncertainty.grids.iter().zip(values) {
                let error: f64 = model.2.iter().zip(&model.3[1..]).map(|(p, a)| a * size.powf(*p)).sum();
                let misfit = value - model.3[0] - error;
                let uncertainty = if model.4 < range {
                    factor * error.abs() + model.4 + misfit.abs()
                } else {
                    3.0 * model.4 / range * (error.abs() + model.4 + misfit.abs())
                };
                assert_eq!(grid.size, *size);
                near(grid.uncertainty, uncertainty, 1e-2, &what);
            }
            chosen.push(uncertainty.model);
        }
    }
    for model in [
        ErrorModel::PowerLaw,
        ErrorModel::FirstOrder,
        ErrorModel::SecondOrder,
        ErrorModel::FirstAndSecondOrder,
    ] {
        assert!(chosen.contains(&model), "{model:?} was never chosen: {chosen:?}");
    }
}

#[test]
fn the_index_of_three_grids_is_that_of_the_fixed_point() {
    // Celik et al. (2008), equations 5a to 5c, as they iterate; sizes 0.6, 1.1, 2.9: unequal ratios.
    for (order, formal, safety, used) in [
        (1.93, Some(2.0), 1.25, 2.0),
        (1.3, Some(2.0), 3.0, 1.3),
        (2.6, Some(2.0), 3.0, 2.0),
        (1.3, None, 1.25, 1.3),
    ] {
        let grids = [0.6, 1.1, 2.9].map(|h: f64| (h, 4.0 - 0.3 * h.powf(order)));
        let [(h1, f1), (h2, f2), (h3, f3)] = grids;
        let (r21, r32, ratio) = (h2 / h1, h3 / h2, (f3 - f2) / (f2 - f1));
        let mut p = 1.0_f64;
        for _ in 0..500 {
            p = (ratio.ln() + ((r21.powf(p) - 1.0) / (r32.powf(p) - 1.0)).ln()).abs() / r21.ln();
        }
        let used = if used == order { p } else { used };
        let three = three_grids([grids[2], grids[0], grids[1]], formal).expect("numbers");
        let estimate = three.estimate.expect("it converges");
        near(estimate.order, p, 1e-9, "order");
        near(estimate.order_used, used, 1e-9, "order used");
        assert_eq!(estimate.safety_factor, safety);
        near(estimate.extrapolated, (r21.powf(used) * f1 - f2) / (r21.powf(used) - 1.0), 1e-9, "limit");
        near(estimate.index_fine, safety * (f1 - f2).abs() / (r21.powf(used) - 1.0), 1e-9, "fine");
        near(estimate.index_medium, safety * (f2 - f3).abs() / (r32.powf(used) - 1.0), 1e-9, "medium");
        near(
            estimate.relative_index_fine.expect("a value"),
            estimate.index_fine / f1.abs(),
            1e-12,
            "relative",
        );
        near(three.range, f1 - f3, 1e-12, "range");
        let expected = (f2 - f1) / (f3 - f2) * r32.ln() / r21.ln();
        near(three.convergence_ratio.expect("a ratio"), expected, 1e-12, "ratio");
        if let (Some(formal), Some(asymptotic)) = (formal, estimate.asymptotic_ratio) {
            let index = |r: f64, difference: f64| difference.abs() / (r.powf(formal) - 1.0);
            near(
                asymptotic,
                index(r32, f3 - f2) / (r21.powf(formal) * index(r21, f2 - f1)),
                1e-9,
                "range of orders",
            );
        }
    }
}

#[test]
fn the_uncertainty_of_a_value_is_that_of_its_estimator_on_the_finest_grid() {
    let values = |levels: usize| {
        ValueSeries::new(
            noisy(|h| 3.0 + 0.02 * h.powf(1.4), 0.01)[6 - levels..]
                .iter()
                .map(|(h, v)| (*h, Some(*v)))
                .collect(),
        )
    };
    let all = values(5).uncertainty(2.0).expect("it converges");
    let fit = least_squares_uncertainty(&all.values, 2.0).expect("five values");
    assert_eq!(all.uncertainty, fit.grids[4].uncertainty);
    assert_eq!((all.finest(), all.extrapolated), (all.values[4].1, Some(fit.extrapolated)));
    near(all.relative(), all.uncertainty / all.values[4].1, 1e-12, "relative");
    let three = values(3).uncertainty(2.0).expect("it converges");
    let index = three_grids([three.values[0], three.values[1], three.values[2]], Some(2.0)).expect("numbers");
    assert_eq!(Some(three.uncertainty), index.estimate.map(|estimate| estimate.index_fine));
    let differences = values(5).signed_differences();
    for (pair, (size, difference)) in all.values.windows(2).zip(differences) {
        assert_eq!((size, difference), (pair[0].0, Some(pair[0].1 - pair[1].1)));
    }
}
