//! Which times of several results are one time: no two programs, and no two meshes of an explicit
//! one, stop at the same instant.

use crate::import::table::SampledState;
use oedometer_exact::parameters::ColumnParameters;

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
