//! How much of a computed profile is spurious oscillation.
//!
//! An error norm sees a checkerboard and a smooth offset of the same size as one and the same number; the
//! variation of the profile beyond its net changes tells them apart.

/// Reversals of the exact profile smaller than this share of its range are round-off, not turns.
const TURN_TOLERANCE: f64 = 1e-9;

/// Spurious oscillation of a computed profile, both profiles along one line in order of place:
/// `TV(x) / Σ |Δx| − 1` with the net changes `Δx` of the computed one over the stretches where the exact one is
/// monotone. Zero for every profile that rises and falls where the exact one does, whatever its error.
///
/// None for fewer than three samples, lists that do not match, what is not a number or too large to subtract, an
/// exact profile of zero, and a computed one without any net change.
pub fn reversal(computed: &[f64], exact: &[f64]) -> Option<f64> {
    let variation = total_variation(computed);
    let is_measurable = computed.len() == exact.len()
        && computed.len() > 2
        && computed.iter().chain(exact).all(|value| value.is_finite())
        && exact.iter().any(|value| *value != 0.0)
        && variation.is_finite();
    let net = if is_measurable { net_changes(computed, exact) } else { 0.0 };
    (net > 0.0).then(|| (variation / net - 1.0).max(0.0))
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

#[cfg(test)]
mod tests;
