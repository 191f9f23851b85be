//! Curves that a figure holds beside a run: theory lines and what they are drawn over.

use crate::case::Case;
use crate::elementary;
use crate::exact::exact_error::ExactError;
use crate::exact::reference::ReferenceKind;
use crate::measure::exact_fields::reference_of;
use crate::record::Record;

/// Points of a theory line.
const LINE_POINTS: u32 = 100;
/// First time factor of a consolidation curve.
const CURVE_START: f64 = 1e-3;

/// Theory's `p/q` over depth `y/H` from the surface at a time factor.
///
/// # Errors
/// When the reference refuses the case.
pub fn theory_isochrone(
    case: &Case,
    kind: ReferenceKind,
    time_factor: f64,
) -> Result<Vec<(f64, f64)>, ExactError> {
    let reference = reference_of(case, kind, &[time_factor])?;
    (0..=LINE_POINTS)
        .map(|i| {
            let zeta = f64::from(i) / f64::from(LINE_POINTS);
            Ok((reference.fields(time_factor, zeta)?.pressure / case.column.load, zeta))
        })
        .collect()
}

/// Theory's degree of consolidation by settlement over the time factor, up to `end`.
///
/// # Errors
/// When the reference refuses the case.
pub fn theory_consolidation(
    case: &Case,
    kind: ReferenceKind,
    end: f64,
) -> Result<Vec<(f64, f64)>, ExactError> {
    let growth = elementary::ln(end / CURVE_START) / f64::from(LINE_POINTS);
    let times: Vec<f64> =
        (0..=LINE_POINTS).map(|i| CURVE_START * elementary::exp(growth * f64::from(i))).collect();
    let reference = reference_of(case, kind, &times)?;
    times.iter().map(|time| Ok((*time, reference.degree_of_consolidation(*time)?))).collect()
}

/// Theory's degree of consolidation by settlement at a time factor.
///
/// # Errors
/// When the reference refuses the case.
pub fn theory_degree(case: &Case, kind: ReferenceKind, time_factor: f64) -> Result<f64, ExactError> {
    reference_of(case, kind, &[time_factor])?.degree_of_consolidation(time_factor)
}

/// A run's `p/q` at its points over depth, at the output of a time factor.
pub fn computed_isochrone(record: &Record, time_factor: f64) -> Vec<(f64, f64)> {
    let Some(snapshot) = record.snapshot(time_factor) else { return Vec::new() };
    // Of an attached solver the places that it has.
    let points = record.main_sample().of(snapshot).unwrap_or(&snapshot.points);
    let pairs = points.pressure.iter().zip(&points.initial_height);
    pairs
        .map(|(pressure, height)| {
            (pressure / record.case.column.load, 1.0 - height / record.case.column.height)
        })
        .collect()
}

/// A run's degree of consolidation over the time factor.
pub fn computed_consolidation(record: &Record) -> Vec<(f64, f64)> {
    record.history.iter().map(|row| (row.time_factor, row.degree_of_consolidation)).collect()
}

/// Relative L2 error that a constant value a cell must leave at its points, for a field with the
/// slope of the slowest mode: `(π/2) (h/H) √((1 − 1/m²)/12)` with `m` points a cell.
pub fn constant_recovery_error(case: &Case) -> f64 {
    let points = case.points_per_cell as f64;
    let size = case.cell_size() / case.column.height;
    std::f64::consts::FRAC_PI_2 * size * ((1.0 - 1.0 / (points * points)) / 12.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn seed_case() -> Case {
        let text =
            "title = 'x'\nscene = 'terzaghi'\n[[sweep]]\nmethod = ['GIMP-SRI']\ncells = [10]\n".to_owned();
        let study = Study::check(&StudySource { name: "x.toml".to_owned(), text }).expect("a sound study");
        study.planned[0].case.clone()
    }

    #[test]
    fn a_theory_line_begins_at_the_drained_surface_and_falls_with_time() {
        let case = seed_case();
        let early = theory_isochrone(&case, ReferenceKind::Terzaghi, 0.05).expect("the seed column");
        let late = theory_isochrone(&case, ReferenceKind::Terzaghi, 0.5).expect("the seed column");
        assert_eq!(early[0], (0.0, 0.0));
        assert!((early[100].0 - 1.0).abs() < 0.01 && (early[100].1 - 1.0).abs() < 1e-15);
        assert!(late[100].0 < early[100].0);
    }

    #[test]
    fn the_error_of_a_constant_in_a_cell_is_that_of_the_oracle() {
        // Two points at a quarter of the cell from its centre: offset h/4, slope π/2.
        let expected = std::f64::consts::FRAC_PI_2 * 0.1 * 0.25;
        assert!((constant_recovery_error(&seed_case()) - expected).abs() < 1e-15);
    }
}
