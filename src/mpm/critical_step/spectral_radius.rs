//! The critical time step, from the spectral radius of the method's own step operator.

use crate::elementary;
use crate::mpm::assembled::column::{AssembledColumn, STATE_FIELDS};
use crate::mpm::assembled::plane::AssembledPlane;
use crate::mpm::explicit::ExplicitSettings;
use nalgebra::DMatrix;

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
    let mut square = power.clone();
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
        power.mul_to(&power, &mut square);
        std::mem::swap(&mut power, &mut square);
        share *= 0.5;
    }
    let norm = power.norm();
    if norm > 0.0 { elementary::exp(log_radius + share * elementary::ln(norm)) } else { 0.0 }
}

/// The step operator of an assembled column, loads removed: velocities of both phases, straining
/// and flux displacement of every free node.
pub fn step_operator(column: &AssembledColumn, dt: f64, settings: &ExplicitSettings) -> DMatrix<f64> {
    let mut column = column.clone().without_loads();
    column.set_step(dt, settings);
    let free = column.free_nodes();
    let size = STATE_FIELDS * free.len();
    let mut operator = DMatrix::zeros(size, size);
    for field in 0..STATE_FIELDS {
        for (place, node) in free.iter().enumerate() {
            let image = operator.column_mut(field * free.len() + place).data.into_slice_mut();
            column.column_of_step(field, *node, dt, settings, &free, image);
        }
    }
    operator
}

/// Largest step, s, of an assembled column that nothing grows under by more than `growth` a step, by
/// bisection of the spectral radius between a step known to be safe and multiples of it.
pub fn critical_step(column: &AssembledColumn, settings: &ExplicitSettings, safe: f64, growth: f64) -> f64 {
    let mut is_stable = |dt: f64| spectral_radius(&step_operator(column, dt, settings)) <= 1.0 + growth;
    bracketed(safe, 1e-4, &mut is_stable)
}

/// The step between stable and unstable ones, to a relative `tolerance`.
fn bracketed(safe: f64, tolerance: f64, is_stable: &mut dyn FnMut(f64) -> bool) -> f64 {
    let mut low = safe;
    // The formula is an estimate: go down where it promises too much.
    while !is_stable(low) {
        low *= 0.5;
        if low < LEAST_SHARE * safe {
            // What grows under such steps grows under any: the equations in space are unstable. Steps of
            // the formula's size show it soonest.
            return safe;
        }
    }
    let mut high = 2.0 * low;
    while is_stable(high) && high < 1e3 * safe {
        low = high;
        high *= 2.0;
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
    low
}

/// Steps over which the growth of a plane body's disturbance is judged.
const GROWTH_STEPS: usize = 512;
/// Growth of the velocities over them that no stable step reaches: null modes of FLIP double.
const MOST_GROWTH: f64 = 4.0;

/// Largest stable step, s, of an assembled plane body: by bisection of whether a disturbance of all
/// wavelengths grows. Its step operator is too large to be squared.
pub fn critical_step_of_plane<const D: usize>(
    plane: &AssembledPlane<D>,
    settings: &ExplicitSettings,
    safe: f64,
) -> f64 {
    let mut disturbed = plane.clone();
    let mut is_stable = |dt: f64| {
        disturbed.set_step(dt, settings);
        disturbed.disturb();
        let mut sizes = [0.0; 2];
        for size in &mut sizes {
            for _ in 0..GROWTH_STEPS {
                disturbed.step(dt, settings);
            }
            *size = disturbed.largest_velocity();
        }
        sizes[1].is_finite() && sizes[1] <= MOST_GROWTH * sizes[0]
    };
    bracketed(safe, 1e-3, &mut is_stable)
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
