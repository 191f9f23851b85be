//! Curves that a figure holds beside a run: theory lines and what they are drawn over.

use crate::case::Case;
use crate::measure::known_references::{Known, key_of, known_or};
use crate::record::Record;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::elementary;
use std::sync::{LazyLock, Mutex};

/// Points of a theory line.
const LINE_POINTS: u32 = 100;
/// First time factor of a consolidation curve.
const CURVE_START: f64 = 1e-3;

/// Theory's line at one output.
#[derive(Clone, Debug, PartialEq)]
pub struct TheoryIsochrone {
    /// Time factor.
    pub time_factor: f64,
    /// Degree of consolidation by settlement.
    pub degree: f64,
    /// `p/q` over depth `y/H` from the surface.
    pub line: Vec<(f64, f64)>,
}

/// Theory's lines at all outputs of a case: the reference is prepared once.
///
/// # Errors
/// When the reference refuses the case.
pub fn theory_isochrones(case: &Case, kind: ReferenceKind) -> Result<Vec<TheoryIsochrone>, ExactError> {
    static KNOWN: Known<Vec<TheoryIsochrone>> = LazyLock::new(Mutex::default);
    known_or(&KNOWN, key_of(case, kind, &case.time_factors), || new_isochrones(case, kind))
}

/// A reference as good as a line of a figure needs it.
fn drawn(case: &Case, kind: ReferenceKind, times: &[f64]) -> Result<Reference, ExactError> {
    Reference::for_lines(kind, &column_parameters(&case.column, &case.material), times)
}

fn new_isochrones(case: &Case, kind: ReferenceKind) -> Result<Vec<TheoryIsochrone>, ExactError> {
    let reference = drawn(case, kind, &case.time_factors)?;
    let at = |time_factor: f64| {
        let point = |i: u32| {
            let zeta = f64::from(i) / f64::from(LINE_POINTS);
            Ok((reference.fields(time_factor, zeta)?.pressure / case.column.load, zeta))
        };
        let line = (0..=LINE_POINTS).map(point).collect::<Result<_, _>>()?;
        Ok(TheoryIsochrone { time_factor, degree: reference.degree_of_consolidation(time_factor)?, line })
    };
    case.time_factors.iter().map(|time_factor| at(*time_factor)).collect()
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
    static KNOWN: Known<Vec<(f64, f64)>> = LazyLock::new(Mutex::default);
    let growth = elementary::ln(end / CURVE_START) / f64::from(LINE_POINTS);
    let times: Vec<f64> =
        (0..=LINE_POINTS).map(|i| CURVE_START * elementary::exp(growth * f64::from(i))).collect();
    known_or(&KNOWN, key_of(case, kind, &times), || {
        let reference = drawn(case, kind, &times)?;
        times.iter().map(|time| Ok((*time, reference.degree_of_consolidation(*time)?))).collect()
    })
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
