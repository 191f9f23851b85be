//! The critical time step, from the spectral radius of the method's own step operator.

use crate::assembled::step::AssembledStep;
use crate::critical_step::square::square;
use crate::explicit::ExplicitSettings;
use nalgebra::DMatrix;
use oedometer_soil::elementary;

/// Growth a step that counts as none: eigenvalues one in exact arithmetic scatter by round-off,
/// and the null modes of FLIP grow linearly.
pub const GROWTH_TOLERANCE: f64 = 1e-6;
/// Squarings of the step operator: growth is judged over `2^30` steps, for a displacement that grows
/// linearly, as all do where nothing holds them back for the first million steps, still counts as
/// `30 ln 2/2^30` a step.
const SQUARINGS: u32 = 30;
/// Share of the formula's step below which no limit is looked for.
const LEAST_SHARE: f64 = 0.01;
/// Bisections of the bracket: a thousandth of a percent.
const BISECTIONS: u32 = 24;

/// Spectral radius of a square matrix by repeated squaring, `lim ‖A^(2^k)‖^(2^−k)`.
///
/// Bounded work whatever the spectrum: a Schur iteration can hang on a step operator with
/// hundreds of eigenvalues that are exactly one.
pub fn spectral_radius(operator: &DMatrix<f64>) -> f64 {
    let mut power = operator.clone();
    let mut squared = power.clone();
    let mut log_radius = 0.0;
    let mut share = 1.0;
    for _ in 0..SQUARINGS {
        let norm = power.norm();
        if norm == 0.0 {
            return 0.0;
        }
        if !norm.is_finite() {
            return f64::INFINITY;
        }
        log_radius += share * elementary::ln(norm);
        power /= norm;
        square(power.as_slice(), power.nrows(), squared.as_mut_slice());
        std::mem::swap(&mut power, &mut squared);
        share *= 0.5;
    }
    let norm = power.norm();
    if norm > 0.0 { elementary::exp(log_radius + share * elementary::ln(norm)) } else { 0.0 }
}

/// Unknowns of the largest operator that is squared: those of a plane of eight by eight cells.
const MOST_SQUARED: usize = 640;
/// Growth a step that counts as none in a plane, at the formula's step: a doubling takes 70 000 of them. Of smaller steps
/// as much is allowed in the same time: what grows by itself grows no slower in time under them.
pub const SLOW_GROWTH: f64 = 1e-5;
/// Factor by which a limit that is looked for upwards is left behind.
const NEAR: f64 = 1.04;

/// Growth per step of what grows fastest under steps of a size, where the operator is small enough to be
/// known.
pub fn growth<const D: usize>(step: &AssembledStep<D>, dt: f64, settings: &ExplicitSettings) -> Option<f64> {
    (step.unknowns() <= MOST_SQUARED).then(|| spectral_radius(&step.operator(dt, settings)))
}

/// Largest step, s, of a frozen body that nothing grows under by more than `growth` per step, by bisection
/// between a step known to be safe and multiples of it, of the spectral radius. None where something grows under any step:
/// the equations in space are unstable then.
///
/// In a plane squares are dear. There it is found by whether a disturbance of all wavelengths grows within a few hundred
/// steps, and the spectral radius is asked whether nothing grows slowly there; a limit that has to be `sharp` is
/// looked for by the spectral radius beyond it, too.
pub fn critical_step<const D: usize>(
    step: &AssembledStep<D>,
    settings: &ExplicitSettings,
    safe: f64,
    growth: f64,
    sharp: bool,
) -> Option<f64> {
    let radius = |dt: f64| spectral_radius(&step.operator(dt, settings));
    if D == 1 {
        return bracketed([safe, 2.0, 1e-4], &mut |dt| radius(dt) <= 1.0 + growth);
    }
    let mut disturbed = step.clone();
    let soon = bracketed([safe, 2.0, 1e-3], &mut |dt| stays_bounded(&mut disturbed, dt, settings));
    if step.unknowns() > MOST_SQUARED {
        return soon;
    }
    let mut is_stable = |dt: f64| radius(dt) <= 1.0 + SLOW_GROWTH * (dt / safe).min(1.0);
    match soon {
        Some(soon) if !sharp && is_stable(soon) => Some(soon),
        found => bracketed([found.unwrap_or(safe), NEAR, 2e-3], &mut is_stable),
    }
}

/// The step between stable and unstable ones, from a first one to a relative tolerance, where a search upwards goes by
/// a factor. None where there is none down to a hundredth of the first.
fn bracketed([safe, factor, tolerance]: [f64; 3], is_stable: &mut dyn FnMut(f64) -> bool) -> Option<f64> {
    let mut low = safe;
    let mut high = factor * low;
    // The formula is an estimate: go down where it promises too much.
    while !is_stable(low) {
        high = low;
        low *= 0.5;
        if low < LEAST_SHARE * safe {
            return None;
        }
    }
    while high > safe && is_stable(high) && high < 1e3 * safe {
        low = high;
        high *= factor;
    }
    for _ in 0..BISECTIONS {
        if high - low < tolerance * low {
            break;
        }
        let middle = 0.5 * (low + high);
        if is_stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// Steps over which the growth of a disturbance is judged.
const GROWTH_STEPS: usize = 512;
/// Growth of the velocities over them that no stable step reaches: null modes of FLIP double.
const MOST_GROWTH: f64 = 4.0;
/// Steps after which a disturbance is looked at.
const LOOK_INTERVAL: usize = 64;
/// Velocity, m/s, that none of those that began with at most a half reaches under a stable step.
const LOST: f64 = 1e12;

/// Whether a disturbance of all wavelengths stays as large as it soon is.
fn stays_bounded<const D: usize>(step: &mut AssembledStep<D>, dt: f64, settings: &ExplicitSettings) -> bool {
    step.set_step(dt, settings);
    step.disturb();
    let mut sizes = [0.0; 2];
    for size in &mut sizes {
        for _ in 0..GROWTH_STEPS / LOOK_INTERVAL {
            for _ in 0..LOOK_INTERVAL {
                step.step(dt, settings);
            }
            *size = step.largest_velocity();
            if *size > LOST {
                return false;
            }
        }
    }
    sizes[1] <= MOST_GROWTH * sizes[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spectral_radius_of_known_matrices() {
        let rotation = DMatrix::from_row_slice(2, 2, &[0.0, -1.1, 1.1, 0.0]);
        assert!((spectral_radius(&rotation) - 1.1).abs() < 1e-6);
        let jordan = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 0.0, 1.0]);
        assert!((spectral_radius(&jordan) - 1.0).abs() < 2e-6, "linear growth is no growth rate");
        let spread = DMatrix::from_row_slice(2, 2, &[0.5, 100.0, 0.0, 0.25]);
        assert!((spectral_radius(&spread) - 0.5).abs() < 1e-6);
        assert_eq!(spectral_radius(&DMatrix::zeros(3, 3)), 0.0);
    }
}
