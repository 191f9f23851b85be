//! References and theory lines that were made before: runs and reports ask for the same ones again and again, and one at
//! large strain takes a march in time.

use crate::case::Case;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::scene::column::column_parameters;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex};

/// Values by what they depend on.
pub type Known<T> = LazyLock<Mutex<HashMap<String, T>>>;

/// Values that are kept of each kind.
const MOST_KNOWN: usize = 256;

/// What a reference depends on: the columns of many methods and studies are the same.
pub fn key_of(case: &Case, kind: ReferenceKind, times: &[f64]) -> String {
    format!("{:?} {:?} {kind:?} {times:?}", case.column, case.material)
}

/// What is known by a key, or else is made and kept.
///
/// # Errors
/// Those of the making; nothing is kept then.
pub fn known_or<T: Clone>(
    known: &Known<T>,
    key: String,
    make: impl FnOnce() -> Result<T, ExactError>,
) -> Result<T, ExactError> {
    if let Some(found) = known.lock().ok().and_then(|known| known.get(&key).cloned()) {
        return Ok(found);
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

/// A reference for the column and soil of a case, prepared for time factors; made once where it has to be computed in
/// advance, with the same bits as if it were made anew.
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
    if !kind.is_prepared() {
        return make();
    }
    known_or(&KNOWN, format!("{kind:?} {parameters:?} {times:?}"), make)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_mpm::scene::SceneKind;
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
        let case = Case::seed(Task::Solve, SceneKind::Terzaghi);
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
        let case = Case::seed(Task::Solve, SceneKind::Terzaghi);
        let mut softer = case.clone();
        softer.material.youngs_modulus *= 0.5;
        let kind = ReferenceKind::DynamicSingleMode;
        assert!(kind.is_prepared() && !ReferenceKind::Terzaghi.is_prepared());
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
