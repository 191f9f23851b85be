//! How much of a computed profile is spurious oscillation.
//!
//! An error norm sees a checkerboard and a smooth offset of the same size as one and the same
//! number. Two measures tell them apart: the variation of the profile beyond that of the exact
//! one, and the share of the error's energy in the shortest wavelengths the cells can carry.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::elementary;

/// Measures of the oscillation of one profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Oscillation {
    /// `TV(x) / TV(x̂) − 1`: total variation of the computed profile over that of the exact one at
    /// the same places. A smeared profile may be slightly negative. `None` where the exact one is
    /// flat.
    pub variation_excess: Option<f64>,
    /// `TV(x) / Σ |Δx| − 1` with the net changes `Δx` of the computed profile over the stretches
    /// where the exact one is monotone: zero for every profile that rises and falls where the
    /// exact one does, whatever its error. `None` where the computed profile has no net change.
    pub reversal: Option<f64>,
    /// `(TV(x) − TV(x̂)) / max|x̂|`: the excess in units of the exact profile's peak, defined
    /// where the exact profile is flat too.
    pub excess_over_peak: f64,
    /// Share of the error's energy, from 0 to 1, in wavelengths of at most four cells: the
    /// oscillatory half of the modes of a mesh (Briggs, Henson & `McCormick` 2000, chapter 2).
    /// `None` where the error is zero.
    pub short_wave_share: Option<f64>,
}

/// Why the oscillation of a profile has no value.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum UndefinedOscillation {
    /// Fewer than three samples have no oscillation.
    #[error("{samples} samples are too few: a wiggle needs three")]
    TooFewSamples {
        /// Number of samples given.
        samples: usize,
    },
    /// The two profiles are of different lengths.
    #[error("{computed} computed values and {exact} exact values do not match")]
    LengthMismatch {
        /// Number of computed values.
        computed: usize,
        /// Number of exact values.
        exact: usize,
    },
    /// A value is NaN or infinite, or differences overflow.
    #[error("the profile holds values that are not finite, or too large to subtract")]
    NotFinite,
    /// The exact profile is zero everywhere: nothing to compare with.
    #[error("the exact profile is zero")]
    ZeroExact,
    /// The samples in a cell must be a positive, finite number.
    #[error("the number of samples per cell is not a positive number")]
    BadSamplesPerCell,
}

/// Reversals of the exact profile smaller than this share of its range are round-off, not turns.
const TURN_TOLERANCE: f64 = 1e-9;

/// Measures the oscillation of `computed` against `exact`, both along one line in order of place and
/// nearly equally spaced, with `samples_per_cell` samples to a grid cell.
///
/// # Errors
/// [`UndefinedOscillation`] says what is missing.
pub fn oscillation(
    computed: &[f64],
    exact: &[f64],
    samples_per_cell: f64,
) -> Result<Oscillation, UndefinedOscillation> {
    if computed.len() != exact.len() {
        let (computed, exact) = (computed.len(), exact.len());
        return Err(UndefinedOscillation::LengthMismatch { computed, exact });
    }
    if computed.len() < 3 {
        return Err(UndefinedOscillation::TooFewSamples { samples: computed.len() });
    }
    if !samples_per_cell.is_finite() || samples_per_cell <= 0.0 {
        return Err(UndefinedOscillation::BadSamplesPerCell);
    }
    if computed.iter().chain(exact).any(|value| !value.is_finite()) {
        return Err(UndefinedOscillation::NotFinite);
    }
    let peak = exact.iter().map(|value| value.abs()).fold(0.0, f64::max);
    if peak == 0.0 {
        return Err(UndefinedOscillation::ZeroExact);
    }
    let (variation, exact_variation) = (total_variation(computed), total_variation(exact));
    let error: Vec<f64> = computed.iter().zip(exact).map(|(x, exact)| (x - exact) / peak).collect();
    // Sums of finite values can overflow.
    let sums = [variation, exact_variation, total_variation(&error), error.iter().sum()];
    if sums.iter().any(|value: &f64| !value.is_finite()) {
        return Err(UndefinedOscillation::NotFinite);
    }
    let flat = exact_variation <= TURN_TOLERANCE * peak;
    let net = net_changes(computed, exact);
    Ok(Oscillation {
        variation_excess: (!flat).then(|| variation / exact_variation - 1.0),
        reversal: (net > 0.0).then(|| (variation / net - 1.0).max(0.0)),
        excess_over_peak: variation / peak - exact_variation / peak,
        short_wave_share: short_wave_share(&error, samples_per_cell),
    })
}

/// Total variation `Σ |x_{i+1} − x_i|` of a profile, in its unit.
pub fn total_variation(profile: &[f64]) -> f64 {
    profile.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
}

/// Sum of the computed profile's net changes between the turning points of the exact one.
fn net_changes(computed: &[f64], exact: &[f64]) -> f64 {
    let mut stations = vec![0];
    stations.extend(turning_points(exact));
    stations.push(computed.len() - 1);
    stations.windows(2).map(|ends| (computed[ends[1]] - computed[ends[0]]).abs()).sum()
}

/// Interior extremes of a profile; a turn counts once it has gone back by more than round-off.
fn turning_points(profile: &[f64]) -> Vec<usize> {
    let lowest = profile.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = profile.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let tolerance = TURN_TOLERANCE * (highest - lowest).max(highest.abs()).max(lowest.abs());
    let mut turns = Vec::new();
    let (mut lowest_at, mut highest_at, mut rising) = (0, 0, None);
    for (index, value) in profile.iter().enumerate() {
        if *value > profile[highest_at] {
            highest_at = index;
        }
        if *value < profile[lowest_at] {
            lowest_at = index;
        }
        let up = *value > profile[lowest_at] + tolerance;
        let down = *value < profile[highest_at] - tolerance;
        match rising {
            None if up => rising = Some(true),
            None if down => rising = Some(false),
            Some(true) if down => {
                turns.push(highest_at);
                (rising, lowest_at) = (Some(false), index);
            }
            Some(false) if up => {
                turns.push(lowest_at);
                (rising, highest_at) = (Some(true), index);
            }
            // While it rises, only the last peak matters, and the other way round.
            Some(true) => lowest_at = highest_at,
            Some(false) => highest_at = lowest_at,
            None => {}
        }
    }
    turns
}

/// Energy of the modes `cos(πk(i + ½)/N)` with wavelength `2N/k` samples of at most four cells,
/// over the energy of all modes (discrete cosine transform, type II, orthonormal).
fn short_wave_share(error: &[f64], samples_per_cell: f64) -> Option<f64> {
    let count = error.len();
    let largest = error.iter().map(|value| value.abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        return None;
    }
    let first_short = count as f64 / (2.0 * samples_per_cell);
    let (mut short, mut total) = (0.0, 0.0);
    for mode in 0..count {
        let amplitude: f64 = error
            .iter()
            .enumerate()
            .map(|(index, value)| {
                // The angle in whole half-steps of the period, so that large products stay exact.
                let half_steps = (mode * (2 * index + 1)) % (4 * count);
                value / largest * elementary::cos(PI * half_steps as f64 / (2 * count) as f64)
            })
            .sum();
        let energy = amplitude * amplitude * if mode == 0 { 0.5 } else { 1.0 };
        total += energy;
        if mode as f64 >= first_short {
            short += energy;
        }
    }
    Some(short / total)
}

#[cfg(test)]
#[path = "../../tests/unit/measure_oscillation.rs"]
mod tests;
