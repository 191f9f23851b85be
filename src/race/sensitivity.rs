//! What an answer rests on: the choice with each family left out, by each quantity alone, and at other thresholds.

use crate::race::finish::RaceQuantity;
use crate::race::profile::{Choice, CostTable};
use crate::record::race_errors::ARRIVED;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Error that a contender must reach.
pub const THRESHOLD: f64 = ARRIVED;
/// Other thresholds that are tried.
pub const OTHER_THRESHOLDS: [f64; 3] = [5e-3, 2e-2, 3e-2];

/// What is changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// A family is left out.
    WithoutFamily(String),
    /// One quantity alone must reach the threshold.
    Quantity(RaceQuantity),
    /// Another threshold.
    Threshold(f64),
}

/// The choice under a change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Variant {
    /// What is changed.
    pub change: Change,
    /// The choice then; none where nobody arrives.
    pub choice: Option<Choice>,
    /// Whether it is the same contender.
    pub holds: bool,
}

/// The choice under every change; `table` gives the costs to a threshold of a quantity.
pub fn variants(table: impl Fn(RaceQuantity, f64) -> CostTable) -> Vec<Variant> {
    let whole = table(RaceQuantity::All, THRESHOLD);
    let method = whole.best().map(|best| best.method);
    let variant = |change: Change, table: &CostTable| {
        let choice = table.best();
        let holds = choice.as_ref().map(|choice| &choice.method) == method.as_ref();
        Variant { change, choice, holds }
    };
    let families = whole.families().into_iter().map(|family| {
        let rest = whole.of_families(|other| other != family);
        variant(Change::WithoutFamily(family.to_owned()), &rest)
    });
    let quantities = RaceQuantity::EACH.into_iter().filter(|quantity| *quantity != RaceQuantity::All);
    let quantities =
        quantities.map(|quantity| variant(Change::Quantity(quantity), &table(quantity, THRESHOLD)));
    let thresholds = OTHER_THRESHOLDS.into_iter();
    let thresholds = thresholds
        .map(|threshold| variant(Change::Threshold(threshold), &table(RaceQuantity::All, threshold)));
    families.chain(quantities).chain(thresholds).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::profile::CostRow;

    #[test]
    fn a_choice_is_told_to_hold_or_to_turn_by_each_change() {
        let table = |quantity: RaceQuantity, threshold: f64| {
            let row = |family: &str, costs: [Option<f64>; 2]| CostRow {
                family: family.to_owned(),
                situation: family.to_owned(),
                costs: costs.to_vec(),
            };
            // `b` is the best of settlements, and at 3 % of everything; without family p it alone arrives.
            let turned = quantity == RaceQuantity::Settlement || threshold > 0.025;
            let p = if turned { [Some(9.0), Some(1.0)] } else { [Some(1.0), None] };
            let q = if turned { [Some(9.0), Some(1.0)] } else { [Some(2.5), Some(1.0)] };
            CostTable {
                contenders: ["a", "b"].map(str::to_owned).to_vec(),
                rows: vec![row("p", p), row("q", q), row("r", [Some(1.0), Some(3.0)])],
            }
        };
        let found = variants(table);
        let told: Vec<(bool, &str)> = found
            .iter()
            .map(|one| (one.holds, one.choice.as_ref().map_or("", |choice| &choice.method)))
            .collect();
        let (holds, turns) = ((true, "a"), (false, "b"));
        assert_eq!(told, [holds, holds, holds, holds, holds, turns, holds, holds, turns]);
        assert_eq!(found[1].change, Change::WithoutFamily("q".to_owned()));
        assert_eq!(found[8].change, Change::Threshold(3e-2));
    }
}
