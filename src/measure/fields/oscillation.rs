//! Spurious oscillation of a computed profile, and of the pressure of a plane run.
//!
//! An error norm cannot tell a checkerboard from a smooth offset of the same size; the variation of the profile
//! beyond its net changes can.

use crate::measure::fields::exact_samples;
use crate::measure::theory::{Known, key_of, known_or, known_reference};
use crate::record::Record;
use oedometer_exact::ExactError;
use oedometer_problem::snapshot::Samples;
use std::sync::{Arc, LazyLock, Mutex};

/// Reversals of the exact profile smaller than this share of its range are round-off, not turns.
const TURN_TOLERANCE: f64 = 1e-9;

/// Spurious oscillation of a computed profile, both profiles along one line in order of place:
/// `TV(x) / Σ |Δx| − 1` with the net changes `Δx` of the computed one over the stretches where the exact one is
/// monotone. Zero for every profile that rises and falls where the exact one does, whatever its error.
///
/// `None` for fewer than three samples, lists of different lengths, values that are not finite or too large to
/// subtract, an exact profile of zero, and a computed one without any net change.
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
fn total_variation(profile: &[f64]) -> f64 {
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

/// Pressures over the load at the points, row after row from the base, each from `x = 0` on.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneField {
    /// Points along the layer.
    pub columns: usize,
    /// `p/q` of the run.
    pub computed: Vec<f64>,
    /// `p/q` of the scene's own reference.
    pub exact: Vec<f64>,
}

impl PlaneField {
    /// The field of a record at one of its outputs; `None` if the output is missing or the run has no
    /// second dimension.
    ///
    /// # Errors
    /// When the reference refuses the case.
    pub fn of(record: &Record, time_factor: f64) -> Result<Option<Self>, ExactError> {
        let case = &record.case;
        let Some(snapshot) = record.snapshot(time_factor) else { return Ok(None) };
        let Some(across) = case.column.cells_across(case.cells).filter(|_| snapshot.points.plane.is_some())
        else {
            return Ok(None);
        };
        let exact = exact_pressure(record, time_factor, &snapshot.points)?;
        let columns = across * case.points_per_cell;
        let over_load =
            |pressures: &[f64]| pressures.iter().map(|p| p / case.column.pressure_scale()).collect();
        Ok(Some(Self { columns, computed: over_load(&snapshot.points.pressure), exact: over_load(&exact) }))
    }

    /// Oscillation index: total variation of the run's pressure along every row and column of
    /// points over that of the exact one, minus one. A staircase of the right height has index 0.
    pub fn oscillation_index(&self) -> f64 {
        let variation = |field: &[f64]| {
            let along: f64 = field.chunks(self.columns).map(total_variation).sum();
            let up: f64 = (0..self.columns)
                .map(|column| {
                    let line: Vec<f64> = field.iter().skip(column).step_by(self.columns).copied().collect();
                    total_variation(&line)
                })
                .sum();
            along + up
        };
        variation(&self.computed) / variation(&self.exact) - 1.0
    }
}

/// Pressures, Pa, of the scene's own reference at the points of a run.
///
/// A study of many methods asks for the same field repeatedly, and it is the most expensive part of a report: it is
/// cached by everything that it depends on, geometry, soil, lattice of the points and time.
fn exact_pressure(record: &Record, time_factor: f64, points: &Samples) -> Result<Arc<Vec<f64>>, ExactError> {
    static KNOWN: Known<Arc<Vec<f64>>> = LazyLock::new(Mutex::default);
    let case = &record.case;
    let kind = case.scene.references[0].kind.for_soil(&case.material);
    let lattice = format!("{} {} {}", case.cells, case.points_per_cell, points.pressure.len());
    let key = key_of(case, kind, &[time_factor]) + &lattice;
    known_or(&KNOWN, key, || {
        let reference = known_reference(case, kind, &[time_factor])?;
        Ok(Arc::new(exact_samples(case, &reference, time_factor, points)?.pressure))
    })
}

#[cfg(test)]
mod tests;
