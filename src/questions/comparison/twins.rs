//! Situations, what makes a run hard, derived from its inputs; and runs that differ in one input alone: the cost and the
//! benefit of the input in each situation.

use crate::case::{Key, Quantity, Sample, SolverName, Value};
use crate::judge::paths::{first_error, grouped};
use crate::measure::statistics::median;
use crate::record::{Record, Status};
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Two runs that are equal in everything but one input.
#[derive(Clone, Copy, Debug)]
pub struct Twins<'a> {
    /// With the first value.
    pub one: &'a Record,
    /// With the second.
    pub other: &'a Record,
}

/// The runs with the second value of a key that have a twin with the first.
pub fn twins<'a>(records: &'a [Record], key: &Key, (first, second): (Value, Value)) -> Vec<Twins<'a>> {
    let firsts: HashMap<&str, &Record> = records
        .iter()
        .filter(|record| key.get(&record.case) == first)
        .map(|record| (record.hash.as_str(), record))
        .collect();
    if firsts.is_empty() {
        return Vec::new();
    }
    let seconds = records.iter().filter(|record| key.get(&record.case) == second);
    let pair = |other: &'a Record| {
        let mut case = other.case.clone();
        key.set(&mut case, first);
        Some(Twins { one: firsts.get(case.hash().as_str())?, other })
    };
    seconds.filter_map(pair).collect()
}

/// Twins of one situation and method, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinsOfSituation {
    /// The situation.
    pub situation: Situation,
    /// The method; `None` for all methods that have equal errors on both sides.
    pub method: Option<SolverName>,
    /// Number of pairs.
    pub pairs: usize,
    /// Error of the pressure at the points of the second over that of the first: least, median and largest of the pairs
    /// and outputs in which both have one.
    pub ratios: Option<[f64; 3]>,
    /// Runs that ended before their last output, of each side.
    pub failed: [usize; 2],
    /// Time of the second over that of the first: median over the pairs that were timed.
    pub cost: Option<f64>,
}

/// Pairs by their situation, the easy ones first.
pub fn by_situation(all: &[Twins<'_>]) -> Vec<TwinsOfSituation> {
    let mut situations = grouped(all, |pair| Situation::of(pair.one));
    situations.sort_by_key(|group| group.0);
    situations.into_iter().flat_map(|(situation, pairs)| by_method(situation, pairs)).collect()
}

/// Errors that differ by less than this share are equal up to round-off.
const SAME: f64 = 1e-6;

/// The pairs of a situation by their method; last, in one row, those of methods for which the input changes nothing.
fn by_method(situation: Situation, pairs: Vec<&Twins<'_>>) -> Vec<TwinsOfSituation> {
    let is_same = |ratio: f64| (ratio - 1.0).abs() <= SAME;
    let (alike, differing): (Vec<_>, Vec<_>) = grouped(pairs, |pair| pair.one.case.method.to_string())
        .into_iter()
        .partition(|(_, own)| own.iter().flat_map(|pair| ratios_of(pair)).all(is_same));
    let differing = differing.iter().map(|(_, own)| in_numbers(situation, Some(own[0].one.case.method), own));
    let alike: Vec<&Twins<'_>> = alike.into_iter().flat_map(|(_, own)| own).collect();
    let alike = (!alike.is_empty()).then(|| in_numbers(situation, None, &alike));
    differing.chain(alike).collect()
}

fn in_numbers(situation: Situation, method: Option<SolverName>, own: &[&Twins<'_>]) -> TwinsOfSituation {
    let mut ratios: Vec<f64> = own.iter().flat_map(|pair| ratios_of(pair)).collect();
    ratios.sort_by(f64::total_cmp);
    let failed = |status: for<'a> fn(&'a Twins<'_>) -> &'a Status| {
        own.iter().filter(|pair| *status(pair) != Status::Ok).count()
    };
    let costs: Vec<f64> =
        own.iter().filter_map(|pair| Some(seconds(pair.other)? / seconds(pair.one)?)).collect();
    TwinsOfSituation {
        situation,
        method,
        pairs: own.len(),
        ratios: median(&ratios).and_then(|middle| Some([*ratios.first()?, middle, *ratios.last()?])),
        failed: [failed(|pair| &pair.one.status), failed(|pair| &pair.other.status)],
        cost: median(&costs),
    }
}

/// Error of the pressure at the points of the second over that of the first at every output that both have.
fn ratios_of(pair: &Twins<'_>) -> Vec<f64> {
    let times = pair.one.case.time_factors.iter();
    // Against the first reference of each.
    let error_at = |record: &Record, time: f64| {
        let reference = &record.references.first()?.name;
        first_error(record, Quantity::Pressure, Sample::Points, reference, time)
    };
    let both = times.filter_map(|time| Some((error_at(pair.one, *time)?, error_at(pair.other, *time)?)));
    both.filter(|(one, _)| *one > 0.0).map(|(one, other)| other / one).collect()
}

/// Median time of a run: processor time where it is known, because other runs do not lengthen it.
fn seconds(record: &Record) -> Option<f64> {
    let times: Vec<f64> =
        record.wall.iter().map(|sample| sample.cpu_seconds.unwrap_or(sample.seconds)).collect();
    median(&times).filter(|seconds| *seconds > 0.0)
}

/// Final strain from which on the loss of height dominates everything else.
const MUCH_OF_THE_HEIGHT: f64 = 0.4;
/// Heights, m, of a usual column.
const USUAL_HEIGHTS: [f64; 2] = [0.05, 500.0];
/// Porosities of a usual soil.
const USUAL_POROSITIES: [f64; 2] = [0.1, 0.8];
/// `n E_oed/K_w` of a usual soil in water: from stiff rock to soft clay with some air.
const USUAL_STORAGE: [f64; 2] = [1e-6, 1e-1];
/// `c_v/(H V)` below which the water cannot move in any time that a run with inertia can wait for.
const USUAL_INERTIA: f64 = 1e-9;
/// A last output before this time factor is a very early one.
const EARLY: f64 = 1e-3;
/// What makes a run hard, in the order of a report: the easy ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Situation {
    /// Small strain in a usual soil, points on their lattice.
    Usual,
    /// Small strain with points off their lattice, or one a cell.
    OutOfPlace,
    /// Small strain in an unusual soil, size or time.
    Extreme,
    /// Waves.
    Waves,
    /// Large strain under a load that is applied at once.
    LoadAtOnce,
    /// Large strain under a load that grows.
    GrowingLoad,
    /// Large strain that takes much of the height.
    MuchOfTheHeight,
    /// Large strain without a load on the surface.
    BodyForces,
}

/// Names in tables, in the order of the enumeration.
const NAMES: [&str; 8] = [
    "Small strain, usual soil",
    "Small strain, points out of place",
    "Small strain, extreme soil, size or time",
    "Waves",
    "Large strain, load at once",
    "Large strain, load that grows",
    "Large strain of 40 % and more",
    "Large strain under body forces",
];

impl Situation {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        NAMES[self as usize]
    }

    /// The situation of a run.
    pub fn of(record: &Record) -> Self {
        let within = |value: f64, range: [f64; 2]| (range[0]..=range[1]).contains(&value);
        let (case, groups) = (&record.case, &record.groups);
        let column = &case.column;
        let last = case.time_factors.last().copied().unwrap_or(0.0);
        if case.scene.is_large_strain() {
            return match 1.0 - elementary::exp(-groups.finite_strain) {
                _ if !case.scene.is_loaded() => Self::BodyForces,
                strain if strain >= MUCH_OF_THE_HEIGHT => Self::MuchOfTheHeight,
                _ if column.loading_time > 0.0 => Self::GrowingLoad,
                _ => Self::LoadAtOnce,
            };
        }
        let is_usual = within(column.height, USUAL_HEIGHTS)
            && within(case.material.porosity, USUAL_POROSITIES)
            && within(groups.storage, USUAL_STORAGE)
            && groups.inertia >= USUAL_INERTIA
            && last >= EARLY;
        match () {
            () if case.scene.waves => Self::Waves,
            () if !column.points.is_regular() || case.points_per_cell == 1 => Self::OutOfPlace,
            () if !is_usual => Self::Extreme,
            () => Self::Usual,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;
    use oedometer_scenes::{DYNAMIC_COLUMN, MANUFACTURED_BOX};

    #[test]
    fn twins_differ_in_one_input_alone() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch', 'MPM']\n\
             integrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [2, 4]\n",
        );
        let key = Key::named("points_per_cell", "sweep").expect("a key");
        let pairs = twins(&records, key, (Value::Count(2), Value::Count(4)));
        assert_eq!(pairs.len(), 4, "two methods on two meshes");
        for pair in &pairs {
            assert_eq!((pair.one.case.points_per_cell, pair.other.case.points_per_cell), (2, 4));
            assert_eq!(
                (pair.one.case.cells, pair.one.case.method),
                (pair.other.case.cells, pair.other.case.method)
            );
        }
        let told = by_situation(&pairs);
        assert_eq!(told.len(), 2, "a row of each method");
        assert!(told.iter().all(|one| (one.pairs, one.failed) == (2, [0, 0])));
        let errors = |points: usize| -> Vec<f64> {
            let own = |record: &&Record| {
                record.case.points_per_cell == points && Some(record.case.method) == told[0].method
            };
            records
                .iter()
                .filter(own)
                .filter_map(|record| {
                    first_error(record, Quantity::Pressure, Sample::Points, &record.references[0].name, 0.1)
                })
                .collect()
        };
        let mut ratios: Vec<f64> = errors(4).iter().zip(errors(2)).map(|(four, two)| four / two).collect();
        ratios.sort_by(f64::total_cmp);
        assert_eq!(told[0].ratios, Some([ratios[0], 0.5 * (ratios[0] + ratios[1]), ratios[1]]));
        // A record beside itself: no method differs from another, and one row says so.
        let same: Vec<Twins<'_>> =
            records.iter().map(|record| Twins { one: record, other: record }).collect();
        let told = by_situation(&same);
        assert_eq!((told.len(), told[0].method, told[0].ratios), (1, None, Some([1.0; 3])));
        assert!(twins(&records, key, (Value::Count(2), Value::Count(3))).is_empty());
    }

    #[test]
    fn double_point_runs_have_their_twins_with_one_set() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [1e-4]\n[[sweep]]\nmethod = ['GIMP-SRI-patch']\n\
             cells = [4]\nsets = [1, 2]\n",
        );
        let key = Key::named("sets", "points").expect("a key");
        let pairs = twins(&records, key, (Value::Count(1), Value::Count(2)));
        assert_eq!((records.len(), pairs.len()), (2, 1));
        assert!(pairs[0].other.case.column.points.has_two_sets());
    }

    #[test]
    fn a_situation_is_read_off_the_inputs() {
        let one = |table: &str, sweep: &str| {
            let text = format!(
                "title = 't'\n{table}\n[output]\ntime_factors = [0.05]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
                 integrator = ['implicit']\ncells = [4]\n{sweep}"
            );
            Situation::of(&records_of(&text)[0])
        };
        assert_eq!(one("scene = 'terzaghi'", ""), Situation::Usual);
        assert_eq!(one("scene = 'terzaghi'\npoints.jitter = 0.1", ""), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'", "points_per_cell = [1]"), Situation::OutOfPlace);
        assert_eq!(one("scene = 'terzaghi'\ncolumn.height = 1e-6", ""), Situation::Extreme);
        assert_eq!(one("scene = 'xie-leo'\ncolumn.load = 2e5", ""), Situation::LoadAtOnce);
        let growing = "scene = 'xie-leo'\ncolumn = { load = 2e5, loading_time = 1.0 }";
        assert_eq!(one(growing, ""), Situation::GrowingLoad);
        let much = "scene = 'xie-leo'\ncolumn.load = 8.4e5\nmaterial.porosity = 0.7";
        assert_eq!(one(much, ""), Situation::MuchOfTheHeight);
    }

    #[test]
    fn a_cost_is_the_time_of_the_other_over_that_of_the_one() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [4]\npoints_per_cell = [2, 4]\n",
        );
        for record in &mut records {
            let seconds = if record.case.points_per_cell == 2 { 2.0 } else { 5.0 };
            record.wall = vec![WallSample { seconds, ..WallSample::default() }];
        }
        let key = Key::named("points_per_cell", "sweep").expect("a key");
        let pairs = twins(&records, key, (Value::Count(2), Value::Count(4)));
        assert_eq!(by_situation(&pairs)[0].cost, Some(2.5));
    }

    #[test]
    fn a_situation_changes_at_its_bounds() {
        type Input = fn(&mut Record, f64);
        use Situation::{
            BodyForces, Extreme, GrowingLoad, LoadAtOnce, MuchOfTheHeight, OutOfPlace, Usual, Waves,
        };
        let record = |scene: &str| {
            records_of(&format!(
                "title = 't'\nscene = '{scene}'\n[output]\ntime_factors = [1e-3]\n[[sweep]]\n\
                 method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [4]\n"
            ))
            .remove(0)
        };
        // A strain of 40 % of the height is one of −ln 0.6 = 0.511 by the load over the modulus.
        let mut large = record("xie-leo");
        for (strain, loading_time, expected) in [
            (0.1, 0.0, LoadAtOnce),
            (0.1, 1.0, GrowingLoad),
            (0.399, 0.0, LoadAtOnce),
            (0.41, 0.0, LoadAtOnce),
            (0.41, 1.0, GrowingLoad),
            (0.51, 0.0, LoadAtOnce),
            (0.512, 0.0, MuchOfTheHeight),
            (0.512, 1.0, MuchOfTheHeight),
        ] {
            large.groups.finite_strain = strain;
            large.case.column.loading_time = loading_time;
            assert_eq!(Situation::of(&large), expected, "{strain} {loading_time}");
        }
        large.case.scene = &MANUFACTURED_BOX;
        assert_eq!(Situation::of(&large), BodyForces);
        // Every range of a usual soil, just inside and just outside of both ends.
        let usual = record("terzaghi");
        assert_eq!(Situation::of(&usual), Usual);
        let inputs: [(Input, &[f64], &[f64]); 5] = [
            (|one, value| one.case.column.height = value, &[0.051, 499.0], &[0.049, 501.0]),
            (|one, value| one.case.material.porosity = value, &[0.11, 0.79], &[0.09, 0.81]),
            (|one, value| one.groups.storage = value, &[1.1e-6, 0.09], &[0.9e-6, 0.11]),
            (|one, value| one.groups.inertia = value, &[1.1e-9, 1.0], &[0.9e-9]),
            (|one, value| one.case.time_factors = vec![value].into(), &[1e-3, 2.0], &[0.9e-3]),
        ];
        for (number, (set, inside, outside)) in inputs.into_iter().enumerate() {
            for (values, expected) in [(inside, Usual), (outside, Extreme)] {
                for value in values {
                    let mut one = usual.clone();
                    set(&mut one, *value);
                    assert_eq!(Situation::of(&one), expected, "{value} of input {number}");
                    // Waves and places come before the soil.
                    one.case.points_per_cell = 1;
                    assert_eq!(Situation::of(&one), OutOfPlace, "{value} of input {number}");
                    one.case.scene = &DYNAMIC_COLUMN;
                    assert_eq!(Situation::of(&one), Waves, "{value} of input {number}");
                }
            }
        }
        // Of several outputs the last one counts.
        let mut early = usual;
        early.case.time_factors = vec![1e-4, 0.1].into();
        assert_eq!(Situation::of(&early), Usual);
    }

    #[test]
    fn runs_that_failed_and_times_count_for_the_side_that_they_are_of() {
        use Situation::{
            BodyForces, Extreme, GrowingLoad, LoadAtOnce, MuchOfTheHeight, OutOfPlace, Usual, Waves,
        };
        let names = [Usual, OutOfPlace, Extreme, Waves, LoadAtOnce, GrowingLoad, MuchOfTheHeight, BodyForces];
        assert!(names.is_sorted(), "the easy ones first");
        let told = [
            "Small strain, usual soil",
            "Small strain, points out of place",
            "Small strain, extreme soil, size or time",
            "Waves",
            "Large strain, load at once",
            "Large strain, load that grows",
            "Large strain of 40 % and more",
            "Large strain under body forces",
        ];
        assert_eq!(names.map(Situation::name), told);
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [0.1, 0.2]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [4]\npoints_per_cell = [2, 4]\n",
        );
        let (mut one, mut other) = (records[0].clone(), records[1].clone());
        for (record, errors) in [(&mut one, [-0.5, 0.25]), (&mut other, [1.0, -1.0])] {
            for row in &mut record.errors {
                row.value = errors[usize::from(row.time_factor == 0.2)];
            }
        }
        let sample = |seconds: f64, cpu_seconds: Option<f64>| WallSample {
            seconds,
            cpu_seconds,
            ..WallSample::default()
        };
        one.wall = vec![sample(9.0, Some(2.0)), sample(9.0, Some(3.0)), sample(1.0, Some(9.0))];
        other.wall = vec![sample(6.0, None)];
        let of = |one: &Record, other: &Record| by_situation(&[Twins { one, other }]).remove(0);
        let found = of(&one, &other);
        assert_eq!((found.situation, found.method, found.pairs), (Usual, Some(one.case.method), 1));
        assert_eq!((found.ratios, found.failed, found.cost), (Some([2.0, 3.0, 4.0]), [0, 0], Some(2.0)));
        other.wall = vec![sample(0.0, None)];
        assert_eq!(of(&one, &other).cost, None, "no time at all");
        let failure = oedometer_problem::outcome::Failure::of_attached(
            oedometer_problem::outcome::FailureKind::Unstable,
            String::new(),
        );
        other.status = Status::Failed(failure);
        assert_eq!(of(&one, &other).failed, [0, 1]);
        assert_eq!(of(&other, &one).failed, [1, 0]);
        // Where one of both has no error at an output, the other outputs count.
        other.errors.retain(|row| row.time_factor == 0.2);
        assert_eq!(of(&one, &other).ratios, Some([4.0; 3]));
        // Errors that differ by a millionth are the same, in one row without a method.
        for (share, is_same) in [(1.0 + 0.9e-6, true), (1.0 - 0.9e-6, true), (1.0 + 1.1e-6, false)] {
            other.errors.iter_mut().for_each(|row| row.value = 0.25 * share);
            assert_eq!(of(&one, &other).method.is_none(), is_same, "{share}");
        }
    }
}
