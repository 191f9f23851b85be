//! Accuracy and cost together: a case that is dearer or worse, and in nothing better, than its own
//! golden values is dominated by them; one that pays with one for the other makes a trade.

use crate::golden::compare::{Change, Difference};
use crate::golden::{is_counter, parts};
use oedometer_convergence::ParetoChange;

/// A case that differs from its golden values.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CaseChange {
    /// Label of the case.
    pub case: String,
    /// Accuracy and cost together.
    pub change: ParetoChange,
    /// Largest ratio of a work counter to its golden value; 1 where none changed.
    pub cost_ratio: f64,
    /// Errors that grew beyond their tolerance.
    pub worse: usize,
    /// Errors that fell beyond their tolerance.
    pub better: usize,
    /// Values that are missing, or that nothing is known of.
    pub unpaired: usize,
}

impl CaseChange {
    /// Whether the golden values are to be looked at again and nothing has failed: all that changed
    /// is better, or cost was traded for accuracy throughout.
    pub fn is_stale(&self) -> bool {
        let cheaper = self.cost_ratio < 1.0;
        let dearer = self.cost_ratio > 1.0;
        match self.change {
            ParetoChange::Better => true,
            ParetoChange::Traded => cheaper && self.better == 0 || dearer && self.worse == 0,
            ParetoChange::Same | ParetoChange::Dominated | ParetoChange::NotComparable => false,
        }
    }
}

/// The cases of differences, in their order.
pub fn case_changes(differences: &[Difference]) -> Vec<CaseChange> {
    let mut changes: Vec<CaseChange> = Vec::new();
    for difference in differences {
        let (case, measure) = parts(&difference.name);
        let place = changes.iter().position(|change| change.case == case).unwrap_or_else(|| {
            changes.push(CaseChange {
                case: case.to_owned(),
                change: ParetoChange::Same,
                cost_ratio: 1.0,
                worse: 0,
                better: 0,
                unpaired: 0,
            });
            changes.len() - 1
        });
        let change = &mut changes[place];
        match (difference.golden, difference.found) {
            (Some(golden), Some(found)) if is_counter(measure) => {
                let ratio = found / golden;
                if (ratio - 1.0).abs() > (change.cost_ratio - 1.0).abs() {
                    change.cost_ratio = ratio;
                }
            }
            (Some(_), Some(_)) if matches!(difference.change, Change::Stale | Change::Smaller) => {
                change.better += 1;
            }
            (Some(_), Some(_)) => change.worse += 1,
            _ => change.unpaired += 1,
        }
    }
    for change in &mut changes {
        let worse = change.worse > 0 || change.cost_ratio > 1.0;
        let better = change.better > 0 || change.cost_ratio < 1.0;
        change.change = match (change.unpaired > 0 || !change.cost_ratio.is_finite(), better, worse) {
            (true, ..) => ParetoChange::NotComparable,
            (_, false, false) => ParetoChange::Same,
            (_, true, false) => ParetoChange::Better,
            (_, true, true) => ParetoChange::Traded,
            (_, false, true) => ParetoChange::Dominated,
        };
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn difference(name: &str, golden: f64, found: f64) -> Difference {
        Difference {
            name: name.to_owned(),
            change: if found.abs() < golden.abs() { Change::Stale } else { Change::Moved },
            golden: Some(golden),
            found: Some(found),
            tolerance: 0.0,
        }
    }

    fn only(differences: &[Difference]) -> CaseChange {
        let mut changes = case_changes(differences);
        assert_eq!(changes.len(), 1);
        changes.remove(0)
    }

    #[test]
    fn accuracy_and_cost_are_judged_together() {
        let (steps, error, other) = ("a | steps", "a | pressure T_v=0.1", "a | settlement T_v=0.1");
        let dominated = only(&[difference(steps, 100.0, 120.0), difference(error, 0.1, 0.2)]);
        assert_eq!((dominated.change, dominated.is_stale()), (ParetoChange::Dominated, false));
        let worse = only(&[difference(error, 0.1, 0.2)]);
        assert_eq!((worse.change, worse.is_stale()), (ParetoChange::Dominated, false));
        let better = only(&[difference(steps, 100.0, 50.0), difference(error, 0.1, 0.05)]);
        assert_eq!((better.change, better.is_stale()), (ParetoChange::Better, true));
        let trade = only(&[difference(steps, 100.0, 50.0), difference(error, 0.1, 0.2)]);
        assert_eq!((trade.change, trade.is_stale()), (ParetoChange::Traded, true));
        // At the same cost some errors fell and some grew: that is no trade but a change of method.
        let mixed = only(&[difference(error, 0.1, 0.2), difference(other, 0.1, 0.05)]);
        assert_eq!((mixed.change, mixed.is_stale()), (ParetoChange::Traded, false));
    }

    #[test]
    fn what_has_no_partner_cannot_be_compared() {
        let missing = Difference { found: None, ..difference("a | pressure T_v=0.1", 0.1, 0.1) };
        assert_eq!(only(&[missing]).change, ParetoChange::NotComparable);
        let names: Vec<String> = case_changes(&[
            difference("a | steps", 1.0, 2.0),
            difference("b | steps", 1.0, 2.0),
            difference("a | pressure T_v=1", 1.0, 2.0),
        ])
        .into_iter()
        .map(|change| change.case)
        .collect();
        assert_eq!(names, ["a", "b"]);
    }
}
