//! One set of material points or two? Runs of single-point and double-point MPM that differ in nothing else, by their
//! situation.

use crate::case::keys::{Key, Value};
use crate::measure::record_checks::has_burst;
use crate::questions::comparison::twins::{Situation, Twins, TwinsOfSituation, by_situation, twins};
use crate::questions::study_results::StudyResults;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The key of the number of point sets, and its table in a study file.
const KEY: [&str; 2] = ["sets", "points"];

/// Error, robustness and cost of double-point MPM over those of single-point MPM.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DoublePointFinding {
    /// Studies.
    pub studies: Vec<String>,
    /// Pairs of runs that differ in the point sets alone.
    pub pairs: usize,
    /// Least and largest ratio of the errors of the pressure at the points, at every output.
    pub error_ratios: Option<[f64; 2]>,
    /// Least and largest of the situations' ratios of the time that a run takes.
    pub time_ratios: Option<[f64; 2]>,
    /// Runs that ended before their last output, single-point and double-point.
    pub failed: [usize; 2],
    /// Labels of the double-point runs in which the pressure exceeded what the load can cause.
    pub bursts: Vec<String>,
    /// The pairs by situation and method.
    pub situations: Vec<DoublePointSituation>,
}

/// Pairs of one situation and method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DoublePointSituation {
    /// Situation.
    pub situation: Situation,
    /// Method; none for all methods of the situation that have equal errors on both sides.
    pub method: Option<String>,
    /// Number of pairs.
    pub pairs: usize,
    /// Least, median and largest ratio of the errors.
    pub error_ratios: Option<[f64; 3]>,
    /// Median ratio of the times.
    pub time_ratio: Option<f64>,
}

impl DoublePointFinding {
    pub(super) fn new(results: &[StudyResults<'_>]) -> Option<Self> {
        Key::named(KEY[0], KEY[1]).and_then(|key| Self::along(results, key))
    }

    /// The comparison by a key with the values one and two; `None` where no study has such pairs.
    fn along(results: &[StudyResults<'_>], key: &Key) -> Option<Self> {
        let mut all: Vec<Twins<'_>> = Vec::new();
        let mut studies: Vec<String> = Vec::new();
        for one in results {
            let pairs = twins(one.records, key, (Value::Count(1), Value::Count(2)));
            if !pairs.is_empty() {
                studies.push(one.study.name.clone());
            }
            all.extend(pairs);
        }
        let records = results.iter().flat_map(|one| one.records);
        let bursts = records.filter(|record| has_burst(record)).map(|record| record.case.label()).collect();
        Self::from_situations(studies, &by_situation(&all), bursts)
    }

    fn from_situations(
        studies: Vec<String>,
        situations: &[TwinsOfSituation],
        bursts: Vec<String>,
    ) -> Option<Self> {
        if situations.is_empty() {
            return None;
        }
        let ratios = situations.iter().filter_map(|one| one.ratios);
        let situation = |one: &TwinsOfSituation| DoublePointSituation {
            situation: one.situation,
            method: one.method.map(|method| method.to_string()),
            pairs: one.pairs,
            error_ratios: one.ratios,
            time_ratio: one.cost,
        };
        Some(Self {
            studies,
            pairs: situations.iter().map(|one| one.pairs).sum(),
            error_ratios: ends(ratios.flat_map(|[least, _, most]| [least, most])),
            time_ratios: ends(situations.iter().filter_map(|one| one.cost)),
            failed: [0, 1].map(|side| situations.iter().map(|one| one.failed[side]).sum()),
            bursts,
            situations: situations.iter().map(situation).collect(),
        })
    }
}

/// The least and the largest of some ratios; `None` without any.
fn ends(ratios: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    Some([ratios.clone().reduce(f64::min)?, ratios.reduce(f64::max)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    #[test]
    fn double_point_runs_are_compared_by_situation_and_nothing_is_found_without_pairs() {
        let text = "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                    integrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [1, 2]\n";
        let (study, records) = solved("s", text);
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        // Any key of one and two will do.
        let key = Key::named("points_per_cell", "sweep").expect("a key");
        let found = DoublePointFinding::along(&results, key).expect("both are there");
        assert_eq!((found.pairs, found.failed, found.bursts.len()), (2, [0, 0], 0));
        let [situation] = &found.situations[..] else { panic!("one situation: {found:?}") };
        let [least, median, largest] = situation.error_ratios.expect("errors");
        assert!(least < median && median < largest);
        assert_eq!((found.error_ratios, found.studies), (Some([least, largest]), vec!["s".to_owned()]));
        let dimensions = Key::named("dimensions", "column").expect("a key");
        assert_eq!(DoublePointFinding::along(&results, dimensions), None);
    }

    #[test]
    fn the_ends_of_all_ratios_are_found_wherever_they_are_and_each_side_is_counted() {
        let row = |ratios: Option<[f64; 3]>, failed: [usize; 2], cost: Option<f64>| TwinsOfSituation {
            situation: Situation::Usual,
            method: None,
            pairs: 3,
            ratios,
            failed,
            cost,
        };
        let rows = [
            row(Some([0.5, 1.0, 4.0]), [1, 0], Some(2.0)),
            row(Some([0.25, 0.9, 1.1]), [0, 2], None),
            row(None, [0, 1], Some(3.5)),
        ];
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let rows = order.map(|place| rows[place].clone());
            let found = DoublePointFinding::from_situations(Vec::new(), &rows, Vec::new()).expect("rows");
            assert_eq!((found.pairs, found.failed), (9, [1, 3]));
            assert_eq!(found.error_ratios, Some([0.25, 4.0]));
            assert_eq!(found.time_ratios, Some([2.0, 3.5]));
        }
        assert_eq!(DoublePointFinding::from_situations(Vec::new(), &[], Vec::new()), None);
    }
}
