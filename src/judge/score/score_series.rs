//! Orders and classes of external results on finer and finer meshes.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::score::series_row::SeriesRow;
use crate::judge::score::times::TimeGroups;
use crate::judge::score::{Leaning, Score};
use crate::record::ErrorRow;
use oedometer_convergence::{Classification, Context, ErrorSeries, SeriesLevel, classify};
use std::collections::HashMap;

/// Errors up to this are round-off of a written number.
const ROUND_OFF: f64 = 1e-12;

/// Cosine between error and field from which on the error has the sign of one number: half of its square lies along the
/// field.
const CLEAR: f64 = 0.7;

impl ScoredSeries {
    /// The series with the cells of its meshes.
    pub fn row(&self, cells: &[usize]) -> SeriesRow {
        let ErrorRow { time_factor, quantity, sample, norm, ref reference, .. } = self.measure;
        SeriesRow {
            time_factor,
            quantity,
            sample,
            norm,
            reference: reference.clone(),
            cells: cells.to_vec(),
            errors: self.series.levels().iter().map(|level| level.error).collect(),
            order: self.classification.order,
            class: self.classification.class.name(),
            reason: self.classification.reason.clone(),
        }
    }
}

/// A series of one error over results on finer and finer meshes, with its class.
#[derive(Clone, Debug)]
pub struct ScoredSeries {
    /// The group of its times.
    pub group: usize,
    /// What the errors are of; its time is that of the group, its value that on the coarsest mesh.
    pub measure: ErrorRow,
    /// Largest difference between the times of the meshes and that of the group, relative.
    pub time_difference: f64,
    /// Cell sizes, m, and errors.
    pub series: ErrorSeries,
    /// Class with its reason.
    pub classification: Classification,
}

/// What a series is of: the group of its times, quantity, sample, norm and reference.
type SeriesKey = (usize, Quantity, Sample, Norm, String);

/// The series over results with numbers of cells over the height, coarsest first, the main norm of
/// each quantity; `times` groups the times of the results in the same order. An error that a level
/// lacks leaves a hole, and a series with a hole is not evaluable.
pub fn series_of(levels: &[(usize, &Score)], times: &TimeGroups, height: f64) -> Vec<ScoredSeries> {
    let mut order: Vec<SeriesKey> = Vec::new();
    let mut found: HashMap<SeriesKey, Vec<Option<&ErrorRow>>> = HashMap::new();
    for (place, (_, score)) in levels.iter().enumerate() {
        let group_of: HashMap<u64, usize> = (score.samples.iter().zip(&times.groups[place]))
            .filter_map(|((time, _), group)| Some((time.to_bits(), (*group)?)))
            .collect();
        for row in score.errors.iter().filter(|row| matches!(row.norm, Norm::L2 | Norm::Relative)) {
            let Some(group) = group_of.get(&row.time_factor.to_bits()) else { continue };
            let key = (*group, row.quantity, row.sample, row.norm, row.reference.clone());
            let rows = found.entry(key.clone()).or_insert_with(|| {
                order.push(key);
                vec![None; levels.len()]
            });
            rows[place] = Some(row);
        }
    }
    // Stable: within a time in the order in which the first level has them.
    order.sort_by_key(|key| key.0);
    order
        .iter()
        .filter_map(|key| {
            let rows = found.get(key)?;
            let time_factor = times.time_factors[key.0];
            one_series(rows, levels, (key.0, time_factor), height)
        })
        .collect()
}

/// The series of the rows of one measure, one a level.
fn one_series(
    rows: &[Option<&ErrorRow>],
    levels: &[(usize, &Score)],
    (group, time_factor): (usize, f64),
    height: f64,
) -> Option<ScoredSeries> {
    let first = rows.iter().flatten().next()?;
    let level = |(row, (cells, _)): (Option<&ErrorRow>, &(usize, &Score))| SeriesLevel {
        size: height / *cells as f64,
        error: row.map(|row| row.value.abs()),
    };
    let series = ErrorSeries::new(rows.iter().copied().zip(levels).map(level).collect());
    // A settlement's error has a sign, which tells a limit from a growing error.
    let signed = match first.norm {
        Norm::Relative => rows.iter().flatten().map(|row| row.value).collect(),
        _ => signed_by_leaning(rows, levels),
    };
    let context = Context { round_off: Some(ROUND_OFF), signed, ..Context::default() };
    let differences =
        rows.iter().flatten().map(|row| (row.time_factor - time_factor).abs() / time_factor.abs());
    Some(ScoredSeries {
        group,
        measure: ErrorRow { time_factor, ..(*first).clone() },
        time_difference: differences.filter(|difference| difference.is_finite()).fold(0.0, f64::max),
        classification: classify(&series, &context),
        series,
    })
}

/// The errors of a field with the signs by which they lean, where they lean clearly on every mesh and not all one way;
/// none elsewhere.
fn signed_by_leaning(rows: &[Option<&ErrorRow>], levels: &[(usize, &Score)]) -> Vec<f64> {
    let signed = |(row, (_, score)): (Option<&ErrorRow>, &(usize, &Score))| {
        let row = row?;
        let is_own = score.errors.first().is_some_and(|own| own.reference == row.reference);
        let like = |one: &&Leaning| (one.time_factor, one.quantity) == (row.time_factor, row.quantity);
        let leaning = score.leanings.iter().find(like).filter(|_| is_own)?;
        (leaning.cosine.abs() >= CLEAR).then_some(row.value.abs() * leaning.cosine.signum())
    };
    let signed: Vec<f64> = rows.iter().copied().zip(levels).map_while(signed).collect();
    let is_mixed = signed.iter().any(|error| *error > 0.0) && signed.iter().any(|error| *error < 0.0);
    if is_mixed && signed.len() == rows.len() { signed } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::score::tests::{scored, state};
    use oedometer_convergence::Class;

    fn series(levels: &[(usize, Score)]) -> Vec<ScoredSeries> {
        let levels: Vec<(usize, &Score)> = levels.iter().map(|(cells, score)| (*cells, score)).collect();
        let times: Vec<Vec<f64>> =
            levels.iter().map(|(_, score)| score.samples.iter().map(|(time, _)| *time).collect()).collect();
        series_of(&levels, &TimeGroups::of(&[], &times, 1e-3), 1.0)
    }

    #[test]
    fn results_on_finer_meshes_have_an_order_and_a_missing_time_none() {
        let level = |cells: usize| {
            let error = (cells as f64).powi(-2);
            (cells, scored(&[state(4 * cells, 0.1, |_| error)]))
        };
        let levels: Vec<_> = [10, 20, 40].into_iter().map(level).collect();
        let all = series(&levels);
        let pressure = &all[0];
        assert_eq!(pressure.classification.class, Class::Asymptotic, "{:?}", pressure.classification);
        assert!((pressure.classification.order.expect("an order") - 2.0).abs() < 0.05);
        let holes = [levels[0].clone(), levels[1].clone(), (40, scored(&[state(160, 0.2, |_| 0.0)]))];
        let with_holes = series(&holes);
        assert_eq!(with_holes.len(), 2 * all.len(), "the time that the finest alone has is there too");
        assert!(with_holes.iter().all(|one| one.classification.class == Class::NotEvaluable));
    }

    #[test]
    fn a_field_whose_error_changes_its_sign_goes_to_a_limit_and_does_not_diverge() {
        // Errors of −3e-3 + 5.15e-3 (10/cells)²: +2.15e-3, −1.7e-3, −2.7e-3, −2.9e-3.
        let level = |cells: usize| {
            let error = 5.15e-3 * (10.0 / cells as f64).powi(2) - 3e-3;
            (cells, scored(&[state(4 * cells, 0.1, |_| error)]))
        };
        let class = |meshes: &[usize]| {
            let levels: Vec<_> = meshes.iter().copied().map(level).collect();
            series(&levels)[0].classification.class
        };
        assert_eq!(
            class(&[10, 20, 40]),
            Class::PreAsymptotic,
            "three levels cannot tell a limit from growth"
        );
        assert_eq!(class(&[10, 20, 40, 80]), Class::FloorLimited);
    }

    #[test]
    fn times_that_differ_a_little_are_one_series_each_held_against_its_own() {
        let level = |(cells, time): (usize, f64)| {
            let error = (cells as f64).powi(-2);
            (cells, scored(&[state(4 * cells, time, |_| error)]))
        };
        let levels: Vec<_> = [(10, 0.049_98), (20, 0.050_01), (40, 0.05)].into_iter().map(level).collect();
        let all = series(&levels);
        assert_eq!(all[0].classification.class, Class::Asymptotic, "{:?}", all[0].classification);
        assert!((all[0].measure.time_factor - 0.049_98).abs() < 1e-15);
        assert!((all[0].time_difference - 3e-5 / 0.049_98).abs() < 1e-9);
    }
}
