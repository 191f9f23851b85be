//! Some hundred series whose truth is known, each with the classes that it may get, at refinement ratios from 1.2 to 4.
//!
//! The table of right and wrong calls is a snapshot: a rule that changes shows what it gains and what it costs. What is called
//! wrong there: a per cent of noise on levels a fifth apart moves an order by a tenth, and may hide how a floor bends it.

use crate::class::{Class, Classification, Context, classify};
use crate::series::ErrorSeries;
use crate::uncertainty::{Behaviour, ValueSeries};
use std::fmt::Write as _;

pub(super) const RATIOS: [f64; 6] = [1.2, 1.5, 2.0, 2.5, 3.0, 4.0];

/// Series of a kind at each ratio.
const TIMES: usize = 4;

/// Numbers between two others, the same on every machine (the generator of Park & Miller 1988).
pub(super) struct Draw(pub u64);

impl Draw {
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        from + (to - from) * self.0 as f64 / 2_147_483_647.0
    }

    pub fn choose<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.place(choices.len() as f64).min(choices.len() - 1)]
    }

    /// A whole number from 0 on, below another.
    pub fn place(&mut self, below: f64) -> usize {
        let at = self.between(0.0, below);
        (1..u16::MAX).take_while(|number| f64::from(*number) <= at).count()
    }
}

/// A series with what is true of it.
pub(super) struct Known {
    /// Errors with their signs, coarse to fine.
    pub points: Vec<(f64, f64)>,
    pub formal: Option<f64>,
    /// Classes that are right.
    right: &'static [Class],
    /// Where the class is asymptotic, the order that it must have, and within how much.
    order: (f64, f64),
    /// Size of a level that must be named.
    named: Option<f64>,
}

impl Known {
    fn new(points: Vec<(f64, f64)>, formal: Option<f64>, right: &'static [Class]) -> Self {
        Self { points, formal, right, order: (f64::NAN, f64::INFINITY), named: None }
    }

    fn with_order(self, order: f64, within: f64) -> Self {
        Self { order: (order, within), ..self }
    }

    fn classified(&self) -> Classification {
        let magnitudes: Vec<_> = self.points.iter().map(|(size, error)| (*size, error.abs())).collect();
        let signed = self.points.iter().map(|point| point.1).collect();
        let context = Context { formal_order: self.formal, signed, ..Context::default() };
        classify(&ErrorSeries::from_pairs(&magnitudes), &context)
    }

    /// What is wrong with a classification.
    fn wrong(&self, classification: &Classification) -> Option<String> {
        let (wanted, within) = self.order;
        if !self.right.contains(&classification.class) {
            return Some(classification.class.to_string());
        }
        let off = classification.order.map_or(f64::NAN, |order| (order - wanted).abs());
        let is_near = off <= within;
        if classification.class == Class::Asymptotic && wanted.is_finite() && !is_near {
            return Some(format!("asymptotic with order {:?} for {wanted:.2}", classification.order));
        }
        let unnamed = self.named.filter(|size| {
            !classification
                .reason
                .contains(&format!("level of size {} is an outlier", oedometer_wording::rounded(*size)))
        });
        unnamed.map(|size| format!("{} without a word on size {size:.4}", classification.class))
    }
}

/// Errors on levels finer and finer by a ratio.
fn levels(ratio: f64, count: usize, error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let mut size = 0.125;
    let level = |_| {
        let point = (size, error(size));
        size /= ratio;
        point
    };
    (0..count).map(level).collect()
}

/// Share of the second of two powers at the finest level, as the coefficient that gives it.
fn coefficient(share: f64, ratio: f64, count: usize, first: f64, second: f64) -> f64 {
    let finest = 0.125 / ratio.powi(i32::try_from(count).expect("few") - 1);
    share / (1.0 - share) * finest.powf(first - second)
}

fn noisy(draw: &mut Draw, points: &mut [(f64, f64)], share: f64) {
    for point in points {
        point.1 *= 1.0 + draw.between(-share, share);
    }
}

use Class::{Asymptotic, Contaminated, Divergent, FloorLimited, Oscillatory, PreAsymptotic, Superconvergent};

pub(super) type Kind = (&'static str, fn(&mut Draw, f64) -> Known);

pub(super) const KINDS: [Kind; 19] = [
    ("one power, order known", |draw, ratio| {
        let p = draw.between(0.5, 4.0);
        let c = draw.between(0.1, 10.0);
        let points = levels(ratio, draw.choose(&[3, 4, 6]), |h| c * h.powf(p));
        Known::new(points, Some(p), &[Asymptotic]).with_order(p, 1e-9)
    }),
    ("one power, order unknown", |draw, ratio| {
        let p = draw.between(0.5, 4.0);
        let points = levels(ratio, draw.choose(&[3, 4, 6]), |h| 3.0 * h.powf(p));
        Known::new(points, None, &[Asymptotic]).with_order(p, 1e-9)
    }),
    ("a higher order nearly gone", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 2.0]), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.001, 0.03), ratio, count, p, p + 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p + 1.0));
        let formal = draw.choose(&[None, Some(p)]);
        Known::new(points, formal, &[Asymptotic, PreAsymptotic]).with_order(p, 0.25)
    }),
    ("a higher order that governs", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 2.0]), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.4, 0.9), ratio, count, p, p + 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p + 1.0));
        Known::new(points, Some(p), &[PreAsymptotic, Superconvergent])
    }),
    ("a lower order that governs, order known", |draw, ratio| {
        let (p, count) = (draw.choose(&[2.0, 3.0]), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.4, 0.95), ratio, count, p, p - 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p - 1.0));
        Known::new(points, Some(p), &[Contaminated, PreAsymptotic])
    }),
    ("a lower order that governs, order unknown", |draw, ratio| {
        let (p, count) = (draw.choose(&[2.0, 3.0]), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.6, 0.95), ratio, count, p, p - 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p - 1.0));
        let right = &[Contaminated, PreAsymptotic, Asymptotic];
        Known::new(points, None, right).with_order(p - 1.0, 0.35)
    }),
    ("a floor that governs, order known", |draw, ratio| {
        let (p, count) = (draw.between(0.5, 3.0), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.3, 0.9), ratio, count, p, 0.0);
        let points = levels(ratio, count, |h| h.powf(p) + b);
        Known::new(points, Some(p), &[FloorLimited, PreAsymptotic, Contaminated])
    }),
    ("a floor that governs, order unknown", |draw, ratio| {
        let (p, count) = (draw.between(0.5, 3.0), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.3, 0.9), ratio, count, p, 0.0);
        let points = levels(ratio, count, |h| h.powf(p) + b);
        Known::new(points, None, &[FloorLimited])
    }),
    ("a floor on three levels", |draw, ratio| {
        let p = draw.between(0.5, 3.0);
        let b = coefficient(draw.between(0.4, 0.9), ratio, 3, p, 0.0);
        let points = levels(ratio, 3, |h| h.powf(p) + b);
        Known::new(points, draw.choose(&[None, Some(p)]), &[PreAsymptotic, Contaminated])
    }),
    ("a floor of a hundredth", |draw, ratio| {
        let (p, count) = (draw.between(0.5, 3.0), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.0, 0.01), ratio, count, p, 0.0);
        let points = levels(ratio, count, |h| h.powf(p) + b);
        Known::new(points, draw.choose(&[None, Some(p)]), &[Asymptotic]).with_order(p, 0.1)
    }),
    ("half a per cent of noise", |draw, ratio| {
        let (p, count) = (draw.between(0.8, 2.5), draw.choose(&[4, 5, 6]));
        let mut points = levels(ratio, count, |h| h.powf(p));
        noisy(draw, &mut points, 0.005);
        let formal = draw.choose(&[None, Some(p)]);
        let right: &[Class] = if ratio < 1.9 { &[Asymptotic, PreAsymptotic] } else { &[Asymptotic] };
        Known::new(points, formal, right).with_order(p, 0.15)
    }),
    ("two per cent of noise", |draw, ratio| {
        let (p, count) = (draw.between(0.8, 2.5), draw.choose(&[4, 5, 6]));
        let mut points = levels(ratio, count, |h| h.powf(p));
        noisy(draw, &mut points, 0.02);
        Known::new(points, draw.choose(&[None, Some(p)]), &[Asymptotic, PreAsymptotic]).with_order(p, 0.25)
    }),
    ("a floor with a per cent of noise", |draw, ratio| {
        let (p, count) = (draw.between(0.8, 2.5), draw.choose(&[4, 5, 6]));
        let b = coefficient(draw.between(0.5, 0.9), ratio, count, p, 0.0);
        let mut points = levels(ratio, count, |h| h.powf(p) + b);
        noisy(draw, &mut points, 0.01);
        let right = &[FloorLimited, PreAsymptotic, Contaminated];
        Known::new(points, draw.choose(&[None, Some(p)]), right)
    }),
    ("a logarithm", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 2.0]), draw.choose(&[4, 5, 6]));
        let points = levels(ratio, count, |h| h.powf(p) * (1.0 / h).ln());
        let right = &[Asymptotic, PreAsymptotic, Contaminated];
        Known::new(points, draw.choose(&[None, Some(p)]), right).with_order(p, 0.45)
    }),
    ("signs in turn", |draw, ratio| {
        let (p, count) = (draw.between(0.5, 3.0), draw.choose(&[3, 4, 6]));
        let mut points = levels(ratio, count, |h| h.powf(p));
        points.iter_mut().step_by(2).for_each(|point| point.1 *= -1.0);
        Known::new(points, draw.choose(&[None, Some(p)]), &[Oscillatory])
    }),
    ("through zero to a limit", |draw, ratio| {
        let (p, count) = (draw.between(0.8, 2.5), draw.choose(&[4, 5, 6]));
        let zero = 0.125 / ratio.powf(draw.between(0.3, count as f64 - 1.3));
        let points = levels(ratio, count, |h| zero.powf(p) - h.powf(p));
        Known::new(points, draw.choose(&[None, Some(p)]), &[FloorLimited, PreAsymptotic])
    }),
    ("one wrong level", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 2.0]), draw.choose(&[4, 5, 6]));
        let mut points = levels(ratio, count, |h| h.powf(p));
        let place = draw.place(count as f64 - 1.001);
        points[place].1 *= draw.choose(&[0.2, 0.5, 2.0, 5.0]);
        let named = Some(points[place].0);
        // Beyond the window the order is that of the finest levels, and the level is named beside it.
        let is_beyond = place + 3 < count;
        let right: &[Class] = if is_beyond {
            &[Asymptotic, PreAsymptotic, Contaminated, Superconvergent, Oscillatory]
        } else {
            &[PreAsymptotic, Oscillatory, Divergent, Contaminated, Superconvergent, FloorLimited]
        };
        Known { named, ..Known::new(points, draw.choose(&[None, Some(p)]), right).with_order(p, 0.1) }
    }),
    ("growth", |draw, ratio| {
        let p = draw.between(0.3, 2.0);
        let points = levels(ratio, draw.choose(&[3, 4, 6]), |h| h.powf(-p));
        Known::new(points, draw.choose(&[None, Some(2.0)]), &[Divergent])
    }),
    ("a standstill", |draw, ratio| {
        let mut points = levels(ratio, draw.choose(&[4, 5, 6]), |_| 0.1);
        noisy(draw, &mut points, 0.005);
        Known::new(points, draw.choose(&[None, Some(2.0)]), &[FloorLimited])
    }),
];

/// What the finest three levels hide and five show, what must not be taken for it, and floors that are reached from below.
const HIDDEN_KINDS: [Kind; 7] = [
    ("a floor of a quarter on five levels and more", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 1.5, 2.0, 3.0]), draw.choose(&[5, 6, 7]));
        let b = coefficient(draw.between(0.22, 0.3), ratio, count, p, 0.0);
        let points = levels(ratio, count, |h| h.powf(p) + b);
        Known::new(points, draw.choose(&[None, Some(p)]), &[FloorLimited, PreAsymptotic, Contaminated])
    }),
    ("a lower order of a quarter on five levels and more", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.5, 2.0, 3.0]), draw.choose(&[5, 6, 7]));
        let b = coefficient(draw.between(0.22, 0.3), ratio, count, p, p - 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p - 1.0));
        Known::new(points, draw.choose(&[None, Some(p)]), &[Contaminated, PreAsymptotic])
    }),
    ("a lower order of the other sign on five levels and more", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.5, 2.0, 3.0]), draw.choose(&[5, 6, 7]));
        let b = coefficient(-draw.between(0.22, 0.3), ratio, count, p, p - 1.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p - 1.0));
        Known::new(points, draw.choose(&[None, Some(p)]), &[Contaminated, PreAsymptotic])
    }),
    ("a logarithm on five levels and more", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 1.5, 2.0, 3.0]), draw.choose(&[5, 6, 7]));
        let points = levels(ratio, count, |h| h.powf(p) * (1.0 / h).ln());
        Known::new(points, draw.choose(&[None, Some(p)]), &[PreAsymptotic, Contaminated])
    }),
    ("a higher order of either sign on five levels and more", |draw, ratio| {
        let (p, count) = (draw.choose(&[1.0, 2.0]), draw.choose(&[5, 6, 7]));
        let b = coefficient(draw.between(0.001, 0.03), ratio, count, p, p + 1.0) * draw.choose(&[-1.0, 1.0]);
        // At a ratio of 4 the coarse levels would vanish.
        let b = b.max(-6.0);
        let points = levels(ratio, count, |h| h.powf(p) + b * h.powf(p + 1.0));
        Known::new(points, draw.choose(&[None, Some(p)]), &[Asymptotic, PreAsymptotic]).with_order(p, 0.25)
    }),
    ("five per cent of noise on five levels and more", |draw, ratio| {
        let (p, count) = (draw.between(0.8, 2.5), draw.choose(&[5, 6, 7]));
        let mut points = levels(ratio, count, |h| h.powf(p));
        noisy(draw, &mut points, 0.05);
        let right: &[Class] = if ratio < 1.9 {
            &[Asymptotic, PreAsymptotic, Contaminated, Superconvergent, Oscillatory]
        } else {
            &[Asymptotic, PreAsymptotic]
        };
        Known::new(points, draw.choose(&[None, Some(p)]), right).with_order(p, 0.4)
    }),
    ("a small rise to a floor", |draw, ratio| {
        let count = draw.choose(&[4, 5, 6]);
        let mut points = levels(ratio, count, |_| 2.15e-4);
        noisy(draw, &mut points[1..], 0.02 * ratio.ln());
        points[0].1 *= draw.between(0.8, 0.95);
        Known::new(points, draw.choose(&[None, Some(2.0)]), &[FloorLimited])
    }),
];

#[test]
fn series_of_known_truth_get_their_class() {
    let mut draw = Draw(20_260_301);
    let mut table = format!("{:44}", "right of 4 (undecided) at a ratio of");
    let mut wrong = String::new();
    let (mut all, mut right) = (0, 0);
    for ratio in RATIOS {
        write!(table, "{ratio:8}").expect("memory");
    }
    for (kind, make) in KINDS.into_iter().chain(HIDDEN_KINDS) {
        write!(table, "\n{kind:44}").expect("memory");
        for ratio in RATIOS {
            let (mut met, mut undecided) = (0, 0);
            for _ in 0..TIMES {
                let known = make(&mut draw, ratio);
                let classification = known.classified();
                undecided += usize::from(classification.class == PreAsymptotic);
                match known.wrong(&classification) {
                    None => met += 1,
                    Some(complaint) => {
                        let errors: Vec<_> =
                            known.points.iter().map(|point| oedometer_wording::rounded(point.1)).collect();
                        writeln!(
                            wrong,
                            "{kind}, ratio {ratio}, order {:?}: {complaint}: {}",
                            known.formal,
                            errors.join(" ")
                        )
                        .expect("memory");
                    }
                }
            }
            (all, right) = (all + TIMES, right + met);
            let cell = if undecided > 0 { format!("{met} ({undecided})") } else { met.to_string() };
            write!(table, "{cell:>8}").expect("memory");
        }
    }
    insta::with_settings!({ snapshot_path => "../../../../tests/snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("known_truth", format!("{right} of {all} calls are right\n\n{table}\n{wrong}"));
    });
}

/// Errors of a sealed element in double precision, and of results in single precision, which go anywhere.
#[test]
fn digits_that_move_are_exact_or_a_floor_and_never_divergence() {
    for (errors, class) in [
        (&[2e-13, 1.7e-12][..], Class::NotEvaluable),
        (&[2e-13, 6e-13, 9e-13], Class::Exact),
        (&[2e-13, 6e-13, 1.7e-12], FloorLimited),
        (&[6e-8, 1.1e-7, 2.3e-7, 4.1e-7], FloorLimited),
        (&[6e-8, 2.1e-7, 9e-8, 4.1e-7], FloorLimited),
        (&[1e-3, 2.4e-5, 6e-7, 1.2e-7, 3e-7], FloorLimited),
        (&[3e-7, 2e-7, 9e-8], PreAsymptotic),
        (&[1.0e-4, 2.0e-4, 2.19e-4, 2.15e-4], FloorLimited),
        (&[8e-7, 2e-7, 5e-8], Asymptotic),
        (&[1.94e-4, 2.19e-4, 2.15e-4, 2.14e-4], FloorLimited),
        (&[1.94e-4, 2.19e-4, 2.15e-4], PreAsymptotic),
        (&[2.3e-4, 1.94e-4, 2.19e-4, 2.15e-4], FloorLimited),
        (&[1.0e-4, 1.9e-4, 4.1e-4, 8.2e-4], Divergent),
    ] {
        let points: Vec<_> = (0..).zip(errors).map(|(level, error)| (0.5_f64.powi(level), *error)).collect();
        let context = Context { round_off: Some(1e-12), tolerance: Some(1e-6), ..Context::default() };
        let classification = classify(&ErrorSeries::from_pairs(&points), &context);
        assert_eq!(classification.class, class, "{errors:?}: {classification:?}");
    }
}

#[test]
fn a_floor_of_two_thirds_of_the_finest_error_is_not_an_order() {
    // 0.4 h and a floor of two thirds of the finest error, on 8, 12, 18 and 27 cells.
    let points = [8.0, 12.0, 18.0, 27.0_f64].map(|cells| (1.0 / cells, 0.4 / cells + 0.8 / 27.0));
    for formal_order in [None, Some(1.0), Some(2.0)] {
        let context = Context { formal_order, ..Context::default() };
        let classification = classify(&ErrorSeries::from_pairs(&points), &context);
        // Where second order is expected, a term of low order is as good a name.
        let right = if formal_order == Some(2.0) { Class::Contaminated } else { Class::FloorLimited };
        assert_eq!(classification.class, right, "{classification:?}");
        let off = classification.floor.map(|floor| (floor.value * 27.0 / 0.8 - 1.0).abs());
        assert!(off.is_none_or(|off| off < 1e-3), "{off:?}");
    }
}

#[test]
fn oscillating_values_have_no_order() {
    let sizes = [0.1, 0.05, 0.025, 0.0125, 0.006_25];
    let values = [1.04, 0.99, 1.0025, 0.999_375, 1.000_156_25];
    for levels in 4..=5 {
        let series =
            ValueSeries::new(sizes.into_iter().zip(values.map(Some)).take(levels).collect::<Vec<_>>());
        let signed: Vec<f64> = series.signed_differences().into_iter().filter_map(|level| level.1).collect();
        assert!(signed.windows(2).all(|pair| pair[0] * pair[1] < 0.0), "{signed:?}");
        for formal_order in [None, Some(2.0)] {
            let context = Context { formal_order, signed: signed.clone(), ..Context::default() };
            let classification = classify(&series.differences(), &context);
            assert_eq!(classification.class, Class::Oscillatory, "{classification:?}");
            assert_eq!(classification.order, None);
        }
        let uncertainty = series.uncertainty(2.0).expect("numbers");
        assert_eq!(uncertainty.finest_three.behaviour, Behaviour::Oscillatory);
    }
}

#[test]
fn a_single_change_of_sign_on_the_finest_window_has_no_order() {
    let points = [(0.1, 0.05), (0.05, -0.0125), (0.025, -0.003_125)];
    let known = Known::new(points.to_vec(), None, &[PreAsymptotic]);
    let classification = known.classified();
    assert!(
        classification.class == PreAsymptotic && classification.reason.contains("sign changes"),
        "{classification:?}"
    );
}
