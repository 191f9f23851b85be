//! Golden values that changed, in words and as tables, the worst first.

use crate::golden::compare::{Change, Difference, DifferenceGroup};
use crate::render::number;
use crate::render::table::{Cell, Table, columns};
use oedometer_wording::count_of;
use std::fmt::Write;

/// Differences shown in a table before the rest is only counted.
const MOST_DIFFERENCES: usize = 40;

/// One sentence on the changes of one kind: what the values share, and how far the worst moved.
pub(crate) fn summary(group: &DifferenceGroup) -> String {
    let is = if group.values == 1 { "is" } else { "are" };
    let what = match group.change {
        Change::Moved => "moved".to_owned(),
        Change::Missing => format!("{is} no longer measured"),
        Change::Extra => format!("{is} not in the golden file"),
        Change::Smaller => "fell where others of their case rose".to_owned(),
        Change::Stale => "improved: the golden values are stale".to_owned(),
    };
    let mut sentence = format!(
        "{} {what}, in {}",
        count_of(group.values, "value", "values"),
        count_of(group.cases, "case", "cases")
    );
    let shared =
        |words: &[String]| words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
    if group.values > 1 && !group.shared_by_cases.is_empty() {
        let _ = write!(sentence, ", all with {}", shared(&group.shared_by_cases));
    }
    if group.values > 1 && !group.shared_by_measures.is_empty() {
        let _ = write!(sentence, ", all of {}", shared(&group.shared_by_measures));
    }
    let _ = match (group.worst.growth(), group.worst.relative_change()) {
        (Some(times), _) => write!(sentence, "; the largest is {} times as large", number::rounded(times)),
        (None, Some(change)) => write!(sentence, "; largest relative change {}", number::error(change)),
        (None, None) => Ok(()),
    };
    if let Some(place) = &group.place {
        let _ = write!(sentence, "; {place}");
    }
    sentence
}

/// The summary with the worst value, by its name, and how it changed.
pub fn sentence(group: &DifferenceGroup) -> String {
    let change = match (group.worst.golden, group.worst.found) {
        (Some(golden), Some(found)) => format!(", {}", number::told_apart([golden, found]).join(" → ")),
        _ => String::new(),
    };
    format!("{}: {}{change}", summary(group), group.worst.key)
}

/// Values that differ from their golden ones.
pub fn differences_table(differences: &[Difference]) -> Table {
    let value =
        |value: Option<f64>| value.map_or(Cell::missing("no value"), |v| number::exact(v).as_str().into());
    let rows = differences.iter().map(|one| {
        let change = match (one.golden, one.found) {
            (Some(golden), Some(found)) => Cell::Error(found - golden),
            _ => Cell::missing("nothing to compare"),
        };
        vec![
            one.change.name().into(),
            one.key.to_string().into(),
            value(one.golden),
            value(one.found),
            change,
            Cell::Error(one.tolerance),
        ]
    });
    Table::of(
        "golden values that moved",
        columns("change | value | > golden | > now | > difference | > tolerance"),
        rows,
    )
    .shown(MOST_DIFFERENCES)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::measure::key;

    #[test]
    fn every_kind_of_change_has_its_sentence_of_one_value_and_of_several() {
        let group =
            |change: Change, values: usize, golden: Option<f64>, found: Option<f64>| DifferenceGroup {
                change,
                values,
                cases: values.min(2),
                shared_by_cases: vec!["MPM".to_owned(), "cells=8".to_owned()],
                shared_by_measures: vec!["points".to_owned()],
                worst: Difference { key: key("n", None, "steps"), change, golden, found, tolerance: 1e-9 },
                place: (values == 3).then(|| "most of it is below".to_owned()),
            };
        let shared = ", all with `MPM`, `cells=8`, all of `points`";
        for (change, one, several) in [
            (Change::Moved, "1 value moved, in 1 case", "moved"),
            (Change::Missing, "1 value is no longer measured, in 1 case", "are no longer measured"),
            (Change::Extra, "1 value is not in the golden file, in 1 case", "are not in the golden file"),
            (
                Change::Smaller,
                "1 value fell where others of their case rose, in 1 case",
                "fell where others of their case rose",
            ),
            (
                Change::Stale,
                "1 value improved: the golden values are stale, in 1 case",
                "improved: the golden values are stale",
            ),
        ] {
            assert_eq!(summary(&group(change, 1, None, Some(1.0))), one);
            let grown = group(change, 2, Some(-2.0), Some(7.0));
            let told = format!("2 values {several}, in 2 cases{shared}; the largest is 3.5 times as large");
            assert_eq!(summary(&grown), told);
            assert_eq!(sentence(&grown), format!("{told}: n | steps, -2.00 → 7.00"));
            let moved = format!(
                "3 values {several}, in 2 cases{shared}; largest relative change 2.50e-1; most of it is below"
            );
            assert_eq!(summary(&group(change, 3, Some(4.0), Some(3.0))), moved);
        }
    }

    #[test]
    fn forty_values_are_enough() {
        let moved = |values: usize| {
            let one = |number: usize| Difference {
                key: key(&number.to_string(), None, "steps"),
                change: Change::Moved,
                golden: Some(1.0),
                found: Some(2.0),
                tolerance: 1e-9,
            };
            let table = differences_table(&(0..values).map(one).collect::<Vec<_>>());
            (table.rows.len(), table.shown_rows().last().map(|row| row[1].show()))
        };
        assert_eq!(moved(40), (40, Some("39 | steps".to_owned())));
        assert_eq!(moved(43), (43, Some("39 | steps".to_owned())));
    }
}
