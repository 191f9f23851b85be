//! Mandel's slab at short times, in closed form.
//!
//! In the Laplace domain, `r = √s`, the strain of the plates is `1/(r (r − κ tanh r))` of its undrained
//! value and the pressure follows it through `1 − cosh(r x)/cosh r`. As long as neither side feels the
//! other, `tanh r = 1`, and what is left is the transform of `e^{κ²T} erfc` (Abramowitz & Stegun 29.3.90):
//! no series that creeps, however short the time.

use crate::mandel::ratios::{Groups, MandelRatios};
use oedometer_soil::elementary;

/// Inverse of `e^{−k r}/(r (r − κ))`: `e^{κ²T − κk} erfc(k/(2√T) − κ√T)`.
fn felt_from(kappa: f64, time: f64, way: f64) -> f64 {
    if time == 0.0 {
        return if way > 0.0 { 0.0 } else { 1.0 };
    }
    let root = time.sqrt();
    elementary::exp(kappa * (kappa * time - way)) * elementary::erfc(0.5 * way / root - kappa * root)
}

/// The same for `e^{−k r}/r²`, without the plates.
fn diffused(time: f64, way: f64) -> f64 {
    if time == 0.0 {
        return if way > 0.0 { 0.0 } else { 1.0 };
    }
    elementary::erfc(0.5 * way / time.sqrt())
}

/// The ratios at `T = c t/a²`; at 0 the undrained start, in which the drained side has its pressure yet.
pub(super) fn ratios(groups: &Groups, time: f64, distance: f64) -> MandelRatios {
    let Groups { poissons_ratio: nu, kappa, start, .. } = *groups;
    let plates = felt_from(kappa, time, 0.0);
    let strain = 0.5 * (1.0 - nu) * groups.undrained_share() * plates;
    let (near, far) = (1.0 - distance, 1.0 + distance);
    let is_start = time == 0.0;
    let (from_near, from_far) =
        if is_start { (0.0, 0.0) } else { (felt_from(kappa, time, near), felt_from(kappa, time, far)) };
    let drained = if is_start { 0.0 } else { from_near + from_far };
    // ∫ of what has drained, from the middle outward, times κ.
    let drained_within =
        if is_start { 0.0 } else { from_near - diffused(time, near) - (from_far - diffused(time, far)) };
    MandelRatios {
        pressure: start * (plates - drained),
        stress: plates - kappa * drained,
        displacement: 0.5 * (kappa * plates * distance - drained_within)
            + nu / (1.0 - nu) * strain * distance,
        strain,
    }
}

/// Bound on what any of the ratios loses for `tanh r = 1`.
///
/// With `q = e^{−2r}` all that is left out is a sum of terms `± c e^{−kr}/r^m`, `m ≥ 2`, whose inverses
/// with every sign positive only grow; and `f(T) ≤ s e^{sT} F(s)` for what grows, at `s = 1/T²`.
pub(super) fn bound(groups: &Groups, time: f64) -> f64 {
    if time == 0.0 {
        return 0.0;
    }
    let (kappa, r) = (groups.kappa, 1.0 / time);
    // e^{sT} q = e^{1/T − 2/T}; q itself underflows beside the rest.
    let left = elementary::exp(-r);
    let echo = 2.0 * kappa / (-elementary::exp_m1(-2.0 * r));
    let own = r - kappa;
    let plates = echo / (own * (own - echo * elementary::exp(-2.0 * r)));
    let drained = 3.0 * plates + 4.0 / own;
    4.0 * left * r * (plates + drained)
}
