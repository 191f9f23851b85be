//! Limits that this process has found before: scenes, total and updated configurations, and runs with other steps often share
//! one operator, and the search for a plane's limit can take longer than the run.

use crate::integrate::assembled::step::AssembledStep;
use crate::kernel::ExplicitSettings;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{LazyLock, Mutex, PoisonError};

/// What a search comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    /// Largest stable step, s; where something grows under any step, the largest under which nothing grows much faster.
    pub step: Option<f64>,
    /// Growth per such step of what grows under any step.
    pub growth: Option<f64>,
}

/// A search by the bits of what it depends on, hashed twice.
pub(super) type Key = [u64; 2];

/// Limits that are kept.
const MOST_KEPT: usize = 4096;

static KNOWN: LazyLock<Mutex<HashMap<Key, Limit>>> = LazyLock::new(Mutex::default);

/// Steps after which a disturbance has felt every entry of the operator.
const FEW_STEPS: usize = 4;

/// The key of a search from a safe step, s: what becomes of a disturbance of all wavelengths, which two operators share only
/// where they are the same. Steps of two sizes tell how the operator depends on the step.
pub(super) fn key_of<const D: usize>(
    step: &AssembledStep<D>,
    settings: &ExplicitSettings,
    safe: f64,
    sharp: bool,
) -> Key {
    let mut disturbed = step.clone();
    let mut bits = vec![step.unknowns() as u64];
    for dt in [safe, 2.0 * safe] {
        disturbed.set_step(dt, settings);
        disturbed.disturb();
        (0..FEW_STEPS).for_each(|_| disturbed.step(dt, settings));
        bits.extend(disturbed.bits());
    }
    [0_u8, 1].map(|first| {
        let mut hasher = DefaultHasher::new();
        (first, sharp, safe.to_bits(), format!("{settings:?}")).hash(&mut hasher);
        bits.hash(&mut hasher);
        hasher.finish()
    })
}

/// The limit of a key: that found before, or else that of a search.
pub(super) fn known_or(key: Key, search: impl FnOnce() -> Limit) -> Limit {
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let before = known().get(&key).copied();
    before.unwrap_or_else(|| {
        let limit = search();
        let mut known = known();
        if known.len() < MOST_KEPT {
            known.insert(key, limit);
        }
        limit
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_searched_once() {
        let limit = Limit { step: Some(0.1), growth: None };
        let other = Limit { step: None, growth: Some(1.5) };
        assert_eq!(known_or([1, 2], || limit), limit);
        assert_eq!(known_or([1, 2], || unreachable!("known")), limit);
        assert_eq!(known_or([1, 3], || other), other);
    }
}
