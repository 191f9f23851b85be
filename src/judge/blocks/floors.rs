//! The floor that several series share.

use crate::judge::paths::SeriesSummary;

/// The floor that a figure shows as one line, and its owner: the only limited series, or all series where they end
/// within a tenth of each other. Other floors are in the table.
pub fn shared_floor(summaries: &[SeriesSummary<'_>], labels: &[String]) -> Option<(f64, String)> {
    let floor = |summary: &SeriesSummary<'_>| Some(summary.classification.floor.as_ref()?.value);
    let floors: Vec<(f64, &String)> =
        summaries.iter().zip(labels).filter_map(|(summary, label)| Some((floor(summary)?, label))).collect();
    let (lowest, highest) = floors
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), (floor, _)| (low.min(*floor), high.max(*floor)));
    match floors.as_slice() {
        [(only, label)] => Some((*only, (*label).clone())),
        [_, _, ..] if floors.len() == summaries.len() && highest <= SAME_FLOOR * lowest => {
            Some(((lowest * highest).sqrt(), "all series".to_owned()))
        }
        _ => None,
    }
}

/// Floors within this factor are one line in a figure.
const SAME_FLOOR: f64 = 1.1;
