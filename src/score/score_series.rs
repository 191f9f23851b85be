//! Orders and classes of external results on refined meshes, and the grouping of their times, which differ slightly
//! between programs and meshes.

use crate::case::grouping::grouped;
use crate::case::{Norm, Quantity, Sample};
use crate::import::SampledState;
use crate::measure::round_off::{ROUND_OFF, SINGLE_PRECISION};
use crate::record::ErrorRow;
use crate::score::{Leaning, Score};
use oedometer_convergence::{Classification, Context, ErrorSeries, SeriesLevel, classify};
use oedometer_exact::ColumnParameters;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::collections::HashMap;

/// Cosine between error and field from which on the error has a sign: half of its square lies along the field.
const CLEAR: f64 = 0.7;

/// A series of one error over results on finer and finer meshes, with its class.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoredSeries {
    /// The group of its times.
    pub group: usize,
    /// Cells of its meshes, from coarse to fine.
    pub cells: Vec<usize>,
    /// What the errors are of; its time is that of the group, its value that on the coarsest mesh.
    pub measure: ErrorRow,
    /// Largest difference between the times of the meshes and that of the group, relative.
    pub time_difference: f64,
    /// Cell sizes, m, and errors.
    pub series: ErrorSeries,
    /// Class with its reason.
    pub classification: Classification,
}

/// A series in machine-readable output.
impl Serialize for ScoredSeries {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (of, class) = (&self.measure, &self.classification);
        let errors: Vec<Option<f64>> = self.series.levels().iter().map(|level| level.error).collect();
        let mut out = serializer.serialize_struct("ScoredSeries", 10)?;
        out.serialize_field("time_factor", &of.time_factor)?;
        out.serialize_field("quantity", &of.quantity)?;
        out.serialize_field("sample", &of.sample)?;
        out.serialize_field("norm", &of.norm)?;
        out.serialize_field("reference", &of.reference)?;
        out.serialize_field("cells", &self.cells)?;
        out.serialize_field("errors", &errors)?;
        out.serialize_field("order", &class.order)?;
        out.serialize_field("class", class.class.name())?;
        out.serialize_field("reason", &class.reason)?;
        out.end()
    }
}

/// What a series is of: the group of its times, quantity, sample, norm and reference.
type SeriesKey = (usize, Quantity, Sample, Norm, String);

/// The series over results with numbers of cells over the height, coarsest first, the main norm of
/// each quantity; `times` groups the times of the results in the same order. An error that a level
/// lacks leaves a hole, and a series with a hole is not evaluable.
pub fn series_of(levels: &[(usize, &Score)], times: &TimeGroups, height: f64) -> Vec<ScoredSeries> {
    let mut rows: Vec<(SeriesKey, usize, &ErrorRow)> = Vec::new();
    for (place, (_, score)) in levels.iter().enumerate() {
        let group_of: HashMap<u64, usize> = (score.samples.iter().zip(&times.groups[place]))
            .filter_map(|((time, _), group)| Some((time.to_bits(), (*group)?)))
            .collect();
        for row in score.errors.iter().filter(|row| matches!(row.norm, Norm::L2 | Norm::Relative)) {
            let Some(group) = group_of.get(&row.time_factor.to_bits()) else { continue };
            let key = (*group, row.quantity, row.sample, row.norm, row.reference.clone());
            rows.push((key, place, row));
        }
    }
    let mut series = grouped(rows, |(key, ..)| key.clone());
    // Stable: within a time in the order in which the first level has them.
    series.sort_by_key(|(key, _)| key.0);
    let of_levels = |(key, found): (SeriesKey, Vec<(SeriesKey, usize, &ErrorRow)>)| {
        let mut rows = vec![None; levels.len()];
        for (_, place, row) in found {
            rows[place] = Some(row);
        }
        one_series(&rows, levels, (key.0, times.time_factors[key.0]), height)
    };
    series.into_iter().filter_map(of_levels).collect()
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
    let round_off = Some(ROUND_OFF.max(2.0 * largest_digit(rows, levels)));
    let context = Context { round_off, tolerance: Some(SINGLE_PRECISION), signed, ..Context::default() };
    let differences =
        rows.iter().flatten().map(|row| (row.time_factor - time_factor).abs() / time_factor.abs());
    Some(ScoredSeries {
        group,
        cells: levels.iter().map(|(cells, _)| *cells).collect(),
        measure: ErrorRow { time_factor, ..(*first).clone() },
        time_difference: differences.filter(|difference| difference.is_finite()).fold(0.0, f64::max),
        classification: classify(&series, &context),
        series,
    })
}

/// The coarsest half digit of the fields of a series; a settlement has that of the displacement.
fn largest_digit(rows: &[Option<&ErrorRow>], levels: &[(usize, &Score)]) -> f64 {
    let digit = |(row, (_, score)): (Option<&ErrorRow>, &(usize, &Score))| {
        let row = row?;
        let quantity =
            if row.quantity == Quantity::Settlement { Quantity::Displacement } else { row.quantity };
        let like =
            |leaning: &&Leaning| (leaning.time_factor, leaning.quantity) == (row.time_factor, quantity);
        score.leanings.iter().find(like).map(|leaning| leaning.half_a_digit)
    };
    rows.iter().copied().zip(levels).filter_map(digit).fold(0.0, f64::max)
}

/// The errors of a field with the signs of their cosines, where these are clear on every mesh and differ; else empty.
fn signed_by_leaning(rows: &[Option<&ErrorRow>], levels: &[(usize, &Score)]) -> Vec<f64> {
    let signed = |(row, (_, score)): (Option<&ErrorRow>, &(usize, &Score))| {
        let row = row?;
        let is_own = score.errors.first().is_some_and(|own| own.reference == row.reference);
        let like =
            |leaning: &&Leaning| (leaning.time_factor, leaning.quantity) == (row.time_factor, row.quantity);
        let leaning = score.leanings.iter().find(like).filter(|_| is_own)?;
        (leaning.cosine.abs() >= CLEAR).then_some(row.value.abs() * leaning.cosine.signum())
    };
    let signed: Vec<f64> = rows.iter().copied().zip(levels).map_while(signed).collect();
    let is_mixed = signed.iter().any(|error| *error > 0.0) && signed.iter().any(|error| *error < 0.0);
    if is_mixed && signed.len() == rows.len() { signed } else { Vec::new() }
}

/// Time factors of states.
pub fn time_factors(parameters: &ColumnParameters, states: &[SampledState]) -> Vec<f64> {
    states.iter().map(|state| parameters.time_factor(state.time)).collect()
}

/// Times of results by the time that they stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeGroups {
    /// Time factor of each group, in rising order: the requested one, or else that of the first
    /// result that has it.
    pub time_factors: Vec<f64>,
    /// For each result and each of its times the group, where it is in one.
    pub groups: Vec<Vec<Option<usize>>>,
}

impl TimeGroups {
    /// Groups the times of results, each list in rising order: with the nearest of the requested
    /// time factors, or, where none are requested, with the nearest time of the results before it.
    /// Two are one where they differ by no more than `tolerance`, relative; of two times of one
    /// result the nearer one is taken.
    pub fn of(requested: &[f64], results: &[Vec<f64>], tolerance: f64) -> Self {
        let mut time_factors = requested.to_vec();
        time_factors.sort_by(f64::total_cmp);
        time_factors.dedup();
        if requested.is_empty() {
            for times in results {
                let places = nearest(&time_factors, times, tolerance);
                let new = times.iter().zip(places).filter(|(_, place)| place.is_none());
                time_factors.extend(new.map(|(time, _)| *time).collect::<Vec<f64>>());
                time_factors.sort_by(f64::total_cmp);
            }
        }
        let groups = results.iter().map(|times| nearest(&time_factors, times, tolerance)).collect();
        Self { time_factors, groups }
    }

    /// Groups that a result lacks.
    pub fn missing(&self, result: usize) -> Vec<f64> {
        let mut has = vec![false; self.time_factors.len()];
        for group in self.groups[result].iter().flatten() {
            has[*group] = true;
        }
        self.time_factors.iter().zip(has).filter(|(_, has)| !has).map(|(time, _)| *time).collect()
    }
}

/// For each time the nearest of sorted anchors within a relative tolerance, each anchor once.
fn nearest(anchors: &[f64], times: &[f64], tolerance: f64) -> Vec<Option<usize>> {
    let mut taken: Vec<Option<(f64, usize)>> = vec![None; anchors.len()];
    for (index, time) in times.iter().enumerate() {
        let after = anchors.partition_point(|anchor| anchor < time);
        let candidates = after.saturating_sub(1)..(after + 1).min(anchors.len());
        let distance = |place: &usize| (anchors[*place] - time).abs();
        let Some(place) = candidates.min_by(|a, b| distance(a).total_cmp(&distance(b))) else { continue };
        let off = distance(&place);
        let is_near = off <= tolerance * anchors[place].abs();
        if is_near && taken[place].is_none_or(|(other, _)| off < other) {
            taken[place] = Some((off, index));
        }
    }
    let mut places = vec![None; times.len()];
    for (place, time) in taken.iter().enumerate() {
        if let Some((_, index)) = time {
            places[*index] = Some(place);
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::tests::{scored, state};
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

    #[test]
    fn times_of_explicit_codes_are_the_one_that_was_requested() {
        let results = [vec![0.04998, 0.1], vec![0.05001, 0.10004], vec![0.05, 0.2]];
        let groups = TimeGroups::of(&[0.1, 0.05], &results, 1e-3);
        assert_eq!(groups.time_factors, [0.05, 0.1]);
        assert_eq!(groups.groups, [vec![Some(0), Some(1)], vec![Some(0), Some(1)], vec![Some(0), None]]);
        assert_eq!((groups.missing(0), groups.missing(2)), (vec![], vec![0.1]));
        let strict = TimeGroups::of(&[0.05], &results, 1e-9);
        assert_eq!(strict.missing(0), [0.05]);
    }

    #[test]
    fn without_a_request_the_first_result_names_the_times() {
        let groups = TimeGroups::of(&[], &[vec![0.04998, 0.1], vec![0.05001, 0.2]], 1e-3);
        assert_eq!(groups.time_factors, [0.04998, 0.1, 0.2]);
        assert_eq!(groups.groups[1], [Some(0), Some(2)]);
        assert_eq!((groups.missing(0), groups.missing(1)), (vec![0.2], vec![0.1]));
    }

    #[test]
    fn times_closer_than_the_tolerance_stay_apart_within_a_result() {
        let dense: Vec<f64> = (0..100).map(|step| 0.5 + 1e-4 * f64::from(step)).collect();
        let moved: Vec<f64> = dense.iter().map(|time| time + 1e-5).collect();
        let groups = TimeGroups::of(&[], &[dense.clone(), moved], 1e-3);
        assert_eq!(groups.time_factors, dense);
        assert!(groups.groups[1].iter().enumerate().all(|(index, group)| *group == Some(index)));
        let start = TimeGroups::of(&[0.0], &[vec![0.0, 1e-9]], 1e-3);
        assert_eq!(start.groups[0], [Some(0), None], "nothing is near the start in relative terms");
    }
}
