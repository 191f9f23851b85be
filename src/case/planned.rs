//! The cases of a study in order, each once, with the inputs that neighbours share stored once.

use crate::case::Case;
use crate::case::tier::Tier;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

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

    /// Puts a case among those that are planned: each once, in the smallest tier that has it.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_mpm::scene::SceneKind;

    #[test]
    fn cases_are_planned_once_and_share_what_they_have_in_common() {
        let case = |cells, porosity| {
            let mut case = Case { cells, ..Case::seed(Task::Solve, SceneKind::Terzaghi) };
            (case.material.porosity, case.column.load) = (porosity, 2.0);
            case.time_factors = vec![0.1].into();
            case
        };
        let mut planner = Planner::default();
        for (cells, porosity, tier) in
            [(2, 0.3, Tier::Full), (2, 0.4, Tier::Ci), (3, 0.3, Tier::Ci), (2, 0.3, Tier::Ci)]
        {
            planner.put(case(cells, porosity), tier);
        }
        let planned = planner.into_cases();
        assert_eq!(planned.iter().map(|one| one.case.cells).collect::<Vec<_>>(), [2, 2, 3]);
        assert!(planned.iter().all(|one| one.tier == Tier::Ci), "the smallest tier that has it");
        let [first, other, third] = [0, 1, 2].map(|place| &planned[place].case);
        assert_eq!(*first, case(2, 0.3));
        assert!(first.column.is_one_with(&third.column) && !first.material.is_one_with(&other.material));
        assert!(
            first.column.is_one_with(&other.column) && first.time_factors.is_one_with(&other.time_factors)
        );
    }

    #[test]
    fn a_planned_case_is_small() {
        // A million of them are the memory of a plan.
        let bytes = size_of::<PlannedCase>();
        assert!(bytes <= 160, "{bytes} bytes");
    }
}
