//! Cached references and theory lines of a case: runs and reports use them repeatedly, and the large-strain one marches
//! in time.

use crate::case::Case;
use crate::record::Record;
use oedometer_exact::{ExactError, Reference, ReferenceKind};
use oedometer_scenes::column::column_parameters;
use oedometer_soil::elementary;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex};

/// Cached values by what they depend on.
pub type Known<T> = LazyLock<Mutex<HashMap<String, T>>>;

/// Most cached values of each kind.
const MOST_KNOWN: usize = 256;

/// What a reference depends on; many methods and studies have the same column.
pub fn key_of(case: &Case, kind: ReferenceKind, times: &[f64]) -> String {
    format!("{:?} {:?} {kind:?} {times:?}", case.column, case.material)
}

/// The cached value of a key, or else a new one, which is cached.
///
/// # Errors
/// Those of making the value; nothing is cached then.
pub fn known_or<T: Clone>(
    known: &Known<T>,
    key: String,
    make: impl FnOnce() -> Result<T, ExactError>,
) -> Result<T, ExactError> {
    if let Some(kept) = known.lock().ok().and_then(|known| known.get(&key).cloned()) {
        return Ok(kept);
    }
    let made = make()?;
    if let Ok(mut known) = known.lock() {
        if known.len() >= MOST_KNOWN {
            known.clear();
        }
        known.insert(key, made.clone());
    }
    Ok(made)
}

/// A reference for the column and soil of a case, prepared for time factors; cached where it has to be computed in
/// advance, with the bits of a new one.
///
/// # Errors
/// When it refuses them.
pub fn known_reference(
    case: &Case,
    kind: ReferenceKind,
    times: &[f64],
) -> Result<Arc<Reference>, ExactError> {
    static KNOWN: Known<Arc<Reference>> = LazyLock::new(Mutex::default);
    let parameters = column_parameters(&case.column, &case.material);
    let make = || Reference::new(kind, &parameters, times).map(Arc::new);
    if !kind.row().is_prepared {
        return make();
    }
    known_or(&KNOWN, format!("{kind:?} {parameters:?} {times:?}"), make)
}

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
            Ok((reference.fields(time_factor, zeta)?.pressure / case.column.pressure_scale(), zeta))
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
    let points = record.main_sample().samples(snapshot).unwrap_or(&snapshot.points);
    let pairs = points.pressure.iter().zip(&points.initial_height);
    pairs
        .map(|(pressure, height)| {
            (pressure / record.case.column.pressure_scale(), 1.0 - height / record.case.column.height)
        })
        .collect()
}

/// A run's degree of consolidation over the time factor.
pub fn computed_consolidation(record: &Record) -> Vec<(f64, f64)> {
    record.history.iter().map(|row| (row.time_factor, row.degree_of_consolidation)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_scenes::TERZAGHI;
    use std::cell::Cell;

    #[test]
    fn the_same_is_made_once_and_another_column_is_another() {
        let known: Known<f64> = LazyLock::new(Mutex::default);
        let made = Cell::new(0);
        let ask = |case: &Case, times: &[f64]| {
            let make = || {
                made.set(made.get() + 1);
                Ok(case.column.height)
            };
            known_or(&known, key_of(case, ReferenceKind::Terzaghi, times), make).expect("made")
        };
        let case = Case::seed(Task::Solve, &TERZAGHI);
        let mut higher = case.clone();
        higher.column.height *= 2.0;
        assert_eq!([ask(&case, &[0.1]), ask(&case, &[0.1])], [case.column.height; 2]);
        assert_eq!(made.get(), 1);
        assert_eq!(ask(&higher, &[0.1]), higher.column.height);
        let _ = ask(&case, &[0.2]);
        assert_eq!(made.get(), 3);
        let mut softer = case.clone();
        softer.material.youngs_modulus *= 0.5;
        let _ = ask(&softer, &[0.1]);
        assert_eq!(made.get(), 4, "another soil");
    }

    #[test]
    fn what_is_refused_is_not_kept() {
        let known: Known<f64> = LazyLock::new(Mutex::default);
        let refuse = || Err(ExactError::UnknownReference("none".to_owned()));
        assert!(known_or(&known, "key".to_owned(), refuse).is_err());
        assert_eq!(known_or(&known, "key".to_owned(), || Ok(2.0)).expect("made"), 2.0);
    }

    #[test]
    fn a_known_reference_is_that_of_the_soil_to_the_bit() {
        let case = Case::seed(Task::Solve, &TERZAGHI);
        let mut softer = case.clone();
        softer.material.youngs_modulus *= 0.5;
        let kind = ReferenceKind::DynamicSingleMode;
        assert!(kind.row().is_prepared && !ReferenceKind::Terzaghi.row().is_prepared);
        // The second time all of them are known.
        for case in [&case, &softer, &case, &softer] {
            let parameters = column_parameters(&case.column, &case.material);
            let known = known_reference(case, kind, &[0.1]).expect("the seed column");
            let anew = Reference::new(kind, &parameters, &[0.1]).expect("the seed column");
            assert_eq!(known.fields(0.1, 0.5), anew.fields(0.1, 0.5));
        }
        let again = known_reference(&case, kind, &[0.1]).expect("known");
        assert!(Arc::ptr_eq(&again, &known_reference(&case, kind, &[0.1]).expect("known")));
        assert!(!Arc::ptr_eq(&again, &known_reference(&softer, kind, &[0.1]).expect("known")));
    }
}
