//! The cases of a study in their order, each once, with the tier from which on each runs; and what neighbours have in
//! common, kept once and read as if each had its own.

use crate::Case;
use oedometer_wording::words;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// A case with the tier from which on it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedCase {
    /// What to run.
    pub case: Case,
    /// Smallest tier that includes it.
    pub tier: Tier,
}

/// Gathers the cases of a study.
#[derive(Debug, Default)]
pub struct Planner {
    planned: Vec<PlannedCase>,
    /// Place of each case by the number that its hash is.
    places: HashMap<u64, usize>,
}

impl Planner {
    /// Makes room for so many more cases, and no more: of a million that is what a plan takes.
    pub fn reserve(&mut self, more: usize) {
        self.planned.reserve_exact(more);
    }

    /// Adds a case to the plan: each once, in the smallest tier that includes it.
    pub fn put(&mut self, mut case: Case, tier: Tier) {
        match self.places.entry(case.number()) {
            Entry::Occupied(place) => {
                let other = &mut self.planned[*place.get()];
                other.tier = other.tier.min(tier);
            }
            Entry::Vacant(place) => {
                place.insert(self.planned.len());
                if let Some(PlannedCase { case: last, .. }) = self.planned.last() {
                    case.column.share_with(&last.column);
                    case.material.share_with(&last.material);
                    case.time_factors.share_with(&last.time_factors);
                }
                self.planned.push(PlannedCase { case, tier });
            }
        }
    }

    /// The cases in the order in which they came.
    pub fn into_cases(self) -> Vec<PlannedCase> {
        self.planned
    }
}

/// A value that copies share until one of them is changed, which has its own from then on.
#[derive(Clone, Default, PartialEq)]
pub struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// Makes it one with an equal value.
    pub fn share_with(&mut self, other: &Self)
    where
        T: PartialEq,
    {
        if self.0 == other.0 {
            self.0 = Arc::clone(&other.0);
        }
    }
}

impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Clone> DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}

impl<T: fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(out)
    }
}

impl<T: Serialize> Serialize for Shared<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        T::serialize(self, serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Shared<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::from)
    }
}

/// How much of a study is run: a tier includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Tier {
    /// Seconds.
    Smoke,
    /// What CI runs.
    #[default]
    Ci,
    /// Everything.
    Full,
}

words!(Tier: Smoke "smoke", Ci "ci", Full "full");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Task;
    use oedometer_scenes::TERZAGHI;
    use oedometer_soil::material::Material;

    fn are_one<T>(first: &Shared<T>, other: &Shared<T>) -> bool {
        Arc::ptr_eq(&first.0, &other.0)
    }

    #[test]
    fn cases_are_planned_once_and_share_what_they_have_in_common() {
        let case = |cells, porosity| {
            let mut case = Case { cells, ..Case::seed(Task::Solve, &TERZAGHI) };
            (case.material.porosity, case.column.load) = (porosity, 2.0);
            case.time_factors = vec![0.1].into();
            case
        };
        let mut planner = Planner::default();
        for (cells, porosity, tier) in [
            (2, 0.3, Tier::Full),
            (2, 0.4, Tier::Ci),
            (3, 0.3, Tier::Ci),
            (2, 0.3, Tier::Ci),
            (2, 0.4, Tier::Full),
        ] {
            planner.put(case(cells, porosity), tier);
        }
        let planned = planner.into_cases();
        assert_eq!(planned.iter().map(|planned_case| planned_case.case.cells).collect::<Vec<_>>(), [2, 2, 3]);
        assert!(
            planned.iter().all(|planned_case| planned_case.tier == Tier::Ci),
            "the smallest tier that has it"
        );
        let [first, other, third] = [0, 1, 2].map(|place| &planned[place].case);
        assert_eq!(*first, case(2, 0.3));
        assert!(are_one(&first.column, &third.column) && !are_one(&first.material, &other.material));
        assert!(are_one(&first.column, &other.column) && are_one(&first.time_factors, &other.time_factors));
    }

    #[test]
    fn a_planned_case_is_small() {
        // A million of them are the memory of a plan.
        let bytes = size_of::<PlannedCase>();
        assert!(bytes <= 160, "{bytes} bytes");
    }

    #[test]
    fn changing_a_copy_leaves_the_others_unchanged() {
        let first = Shared::from(Material::default());
        let mut other = first.clone();
        assert!(are_one(&other, &first));
        other.porosity = 0.4;
        assert_eq!((first.porosity, other.porosity), (Material::default().porosity, 0.4));
        assert!(!are_one(&other, &first) && other != first);
    }

    #[test]
    fn equal_values_are_shared_and_different_ones_are_not() {
        let first = Shared::from(Material::default());
        let [mut equal, mut other] = [0.3, 0.4].map(|porosity| Shared::from(Material { porosity, ..*first }));
        equal.share_with(&first);
        other.share_with(&first);
        assert!(are_one(&equal, &first) && !are_one(&other, &first));
        assert_eq!(other.porosity, 0.4);
    }

    #[test]
    fn a_shared_value_is_written_and_read_as_the_value_itself() {
        let times = Shared::from(vec![0.1, 0.2]);
        let text = serde_json::to_string(&times).expect("plain");
        assert_eq!((text.as_str(), format!("{times:?}")), ("[0.1,0.2]", "[0.1, 0.2]".to_owned()));
        assert_eq!(serde_json::from_str::<Shared<Vec<f64>>>(&text).expect("the same"), times);
    }
}
