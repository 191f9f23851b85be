//! The pressure of a plane run on the lattice of its points, beside the exact one.

use crate::measure::fields::exact_fields::exact_samples;
use crate::measure::fields::oscillation::total_variation;
use crate::measure::known_references::{Known, key_of, known_or, known_reference};
use crate::record::Record;
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::run::results::snapshot::Samples;
use std::sync::{Arc, LazyLock, Mutex};

/// Pressures over the load at the points, row after row from the base, each from `x = 0` on.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneField {
    /// Points along the layer.
    pub columns: usize,
    /// Lines between the points over the length, from 0 to `L/H`.
    pub x_edges: Vec<f64>,
    /// The same over the height.
    pub y_edges: Vec<f64>,
    /// `p/q` of the run.
    pub computed: Vec<f64>,
    /// `p/q` of the scene's own reference.
    pub exact: Vec<f64>,
}

impl PlaneField {
    /// The field of a record at one of its outputs; `None` where there is none or the run has no
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
        let rows = case.cells * case.points_per_cell;
        let per_height = 1.0 / rows as f64;
        let over_load = |pressures: &[f64]| pressures.iter().map(|p| p / case.column.load).collect();
        Ok(Some(Self {
            columns,
            x_edges: (0..=columns).map(|i| i as f64 * per_height).collect(),
            y_edges: (0..=rows).map(|i| i as f64 * per_height).collect(),
            computed: over_load(&snapshot.points.pressure),
            exact: over_load(&exact),
        }))
    }

    /// Oscillation index: total variation of the run's pressure along every row and column of
    /// points over that of the exact one, minus one. A staircase of the right height has none.
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
/// A study of many methods asks for the same field again and again, and it is the dearest thing in a report: it is kept
/// by all that it depends on, geometry, soil, lattice of the points and time.
fn exact_pressure(record: &Record, time_factor: f64, points: &Samples) -> Result<Arc<Vec<f64>>, ExactError> {
    static KNOWN: Known<Arc<Vec<f64>>> = LazyLock::new(Mutex::default);
    let case = &record.case;
    let own = case.scene.references()[0].of_soil(&case.material);
    let lattice = format!("{} {} {}", case.cells, case.points_per_cell, points.pressure.len());
    let key = key_of(case, own, &[time_factor]) + &lattice;
    known_or(&KNOWN, key, || {
        let reference = known_reference(case, own, &[time_factor])?;
        Ok(Arc::new(exact_samples(case, &reference, time_factor, points)?.pressure))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(computed: impl Fn(usize, usize) -> f64) -> PlaneField {
        let exact = |i: usize, j: usize| (i + 2 * j) as f64;
        let all = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..6).flat_map(|j| (0..4).map(move |i| (i, j))).map(|(i, j)| f(i, j)).collect()
        };
        PlaneField {
            columns: 4,
            x_edges: Vec::new(),
            y_edges: Vec::new(),
            computed: all(&computed),
            exact: all(&exact),
        }
    }

    #[test]
    fn a_smooth_error_has_no_oscillation_and_a_checkerboard_has() {
        assert_eq!(field(|i, j| (i + 2 * j) as f64 + 7.0).oscillation_index(), 0.0);
        // A staircase of two points a step.
        let staircase = field(|i, j| (i / 2 * 2) as f64 + 2.0 * j as f64);
        assert!(staircase.oscillation_index() <= 0.0);
        let board = field(|i, j| (i + 2 * j) as f64 + if (i + j) % 2 == 0 { 5.0 } else { -5.0 });
        assert!(board.oscillation_index() > 4.0, "{}", board.oscillation_index());
    }
}
