//! Limits that this process has found before: scenes, total and updated configurations, and runs with other steps often share
//! one operator, and the search for a plane's limit can take longer than the run.

use crate::integrate::assembled::step::AssembledStep;
use oedometer_problem::settings::ExplicitSettings;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{LazyLock, Mutex, PoisonError};

/// Result of a search for the critical step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    /// Largest stable step, s; where a mode grows under any step, the largest under which nothing grows much faster.
    pub step: Option<f64>,
    /// Growth per such step of the mode that grows under any step.
    pub growth: Option<f64>,
}

/// A search by the bits of what it depends on, hashed twice.
pub(super) type Key = [u64; 2];

/// Limits that are kept.
const MOST_KEPT: usize = 4096;

static KNOWN: LazyLock<Mutex<HashMap<Key, Limit>>> = LazyLock::new(Mutex::default);

/// Steps after which a disturbance has felt every entry of the operator.
const FEW_STEPS: usize = 4;

/// The key of a search from a safe step, s: the state of a disturbance of all wavelengths after a few steps, which two
/// operators share only where they are the same. Steps of one size are enough: their result depends on stiffness, drag and
/// inertia, and these determine steps of any other size.
pub(super) fn key_of<const D: usize>(
    step: &AssembledStep<D>,
    settings: &ExplicitSettings,
    safe: f64,
    sharp: bool,
) -> Key {
    let mut disturbed = step.clone();
    let mut bits = vec![step.unknowns() as u64];
    disturbed.set_step(safe, settings);
    disturbed.disturb();
    (0..FEW_STEPS).for_each(|_| disturbed.step(safe, settings));
    bits.extend(disturbed.bits());
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
    use crate::kernel::body::Body;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::Drag;
    use oedometer_scenes::COSINE_LAYER;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    #[test]
    fn the_key_of_a_search_changes_with_each_of_its_inputs() {
        let usual = Material::default();
        let key = |name: &str, soil: &Material, drag: Drag, safe: f64, sharp: bool| {
            let method = Method::named(name).expect("a known method");
            let problem = column_problem::<2>(&COSINE_LAYER, &Column::layer(), soil, method, 2, 2);
            let step = AssembledStep::new(&Body::new(problem.expect("a layer")));
            key_of(&step, &ExplicitSettings { drag, ..ExplicitSettings::default() }, safe, sharp)
        };
        let known = key("GIMP-SRI", &usual, Drag::Implicit, 1e-5, false);
        assert_eq!(known, key("GIMP-SRI", &usual, Drag::Implicit, 1e-5, false));
        let other_drag = Material { hydraulic_conductivity: 1.1e-3, ..usual };
        for (name, soil, drag, safe, sharp) in [
            ("GIMP", &usual, Drag::Implicit, 1e-5, false),
            ("GIMP-SRI", &other_drag, Drag::Implicit, 1e-5, false),
            ("GIMP-SRI", &usual, Drag::Centred, 1e-5, false),
            ("GIMP-SRI", &usual, Drag::Implicit, 1.1e-5, false),
            ("GIMP-SRI", &usual, Drag::Implicit, 1e-5, true),
        ] {
            assert_ne!(known, key(name, soil, drag, safe, sharp), "{name} {drag:?} {safe} {sharp}");
        }
    }

    #[test]
    fn a_limit_is_searched_once() {
        let limit = Limit { step: Some(0.1), growth: None };
        let other = Limit { step: None, growth: Some(1.5) };
        assert_eq!(known_or([1, 2], || limit), limit);
        assert_eq!(known_or([1, 2], || unreachable!("known")), limit);
        assert_eq!(known_or([1, 3], || other), other);
    }
}
