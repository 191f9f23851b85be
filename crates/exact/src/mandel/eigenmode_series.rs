//! Mandel's series, over the roots of `tan α/α = 1/κ` (Mandel 1953; Cheng & Detournay 1988, Eqs 41–46).

use core::f64::consts::{FRAC_PI_2, PI};

use crate::mandel::ratios::{Groups, MandelRatios, Sums};
use oedometer_soil::elementary;

/// What the terms left out may add up to.
const NEGLIGIBLE: f64 = 1e-18;
/// More terms than the shortest time asks for: a dozen are enough from `T = 0.02` on, two thousand at 1e-6.
const MOST_TERMS: usize = 10_000;
/// Newton's iterations for a root: it gains twice its digits from each, and begins with one.
const MOST_ITERATIONS: usize = 60;

/// `(i + ½)π − α_i` of the root in `(iπ, (i + ½)π)`.
///
/// `δ = atan(κ/((i + ½)π − δ))`, whose right side bends upward: Newton's iteration from 0 rises to the
/// root and never beyond it, whatever `κ < 1`.
pub(super) fn gap_below_pole(kappa: f64, index: usize) -> f64 {
    let pole = (index as f64 + 0.5) * PI;
    let mut gap = 0.0;
    for _ in 0..MOST_ITERATIONS {
        let root = pole - gap;
        let excess = gap - elementary::atan(kappa / root);
        let change = -excess / (1.0 - kappa / (root * root + kappa * kappa));
        gap += change;
        if change.abs() <= f64::EPSILON * gap.abs() {
            break;
        }
    }
    gap.clamp(0.0, FRAC_PI_2)
}

/// Terms after which the rest is negligible.
pub(super) fn terms(time: f64) -> usize {
    (1..MOST_TERMS).find(|terms| bound(time, *terms) <= NEGLIGIBLE).unwrap_or(MOST_TERMS)
}

/// Bound on what any of the ratios loses without the terms from `terms` on.
///
/// With `α_i ≥ iπ` and `d ≥ α − ½` a term of any sum is at most `e^{−(iπ)²T}/(iπ − ½)`, from one to the
/// next it falls by `e^{−(2i + 1)π²T}` at least, and a ratio has less than eight of the sums.
pub(super) fn bound(time: f64, terms: usize) -> f64 {
    let first = terms as f64 * PI;
    let fall = -elementary::exp_m1(-(2.0 * first + PI) * PI * time);
    8.0 * elementary::exp(-first * first * time) / ((first - 0.5) * fall)
}

/// The ratios at `T = c t/a²`.
pub(super) fn ratios(groups: &Groups, time: f64, distance: f64) -> MandelRatios {
    sum(groups, time, distance, terms(time))
}

/// The ratios of so many terms.
pub(super) fn sum(groups: &Groups, time: f64, distance: f64, terms: usize) -> MandelRatios {
    let mut sums = Sums::default();
    // The small ones first.
    for index in (0..terms).rev() {
        let gap = gap_below_pole(groups.kappa, index);
        let root = (index as f64 + 0.5) * PI - gap;
        let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
        let (sine, cosine) = (sign * elementary::cos(gap), sign * elementary::sin(gap));
        let weight = elementary::exp(-root * root * time) / (root - sine * cosine);
        sums.mean += sine * cosine * weight;
        sums.wave += sine * elementary::cos(root * distance) * weight;
        sums.slope += cosine * elementary::sin(root * distance) * weight;
    }
    let mut ratios = MandelRatios::of(groups, distance, sums);
    if distance == 1.0 {
        // cos(αx) = cos α, to the last digit.
        ratios.pressure = 0.0;
    }
    ratios
}
