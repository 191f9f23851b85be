//! Runs that differ in one input alone: what the input costs and brings.

use crate::case::keys::{Key, Value};
use crate::case::quantity::{Quantity, Sample};
use crate::judge::comparison::situation::Situation;
use crate::judge::paths::first_norm;
use crate::measure::wall_times::median;
use crate::record::{Record, Status};
use std::collections::HashMap;

/// Two runs alike in everything but one input.
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

/// Twins of one situation, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinsOfSituation {
    /// The situation.
    pub situation: Situation,
    /// Pairs there are.
    pub pairs: usize,
    /// Largest errors of the pressure at the points, of the pairs in which both have one.
    pub errors: Option<[f64; 2]>,
    /// Runs that ended before their last output, of each side.
    pub failed: [usize; 2],
    /// Time of the second over that of the first: median over the pairs that were timed.
    pub cost: Option<f64>,
}

/// Pairs by their situation, the easy ones first.
pub fn by_situation(all: &[Twins<'_>]) -> Vec<TwinsOfSituation> {
    let mut situations: Vec<Situation> = all.iter().map(|pair| Situation::of(pair.one)).collect();
    situations.sort_unstable();
    situations.dedup();
    let of_situation = |situation: Situation| {
        let own: Vec<&Twins<'_>> = all.iter().filter(|pair| Situation::of(pair.one) == situation).collect();
        let errors = own.iter().filter_map(|pair| Some([last_error(pair.one)?, last_error(pair.other)?]));
        let failed = |side: fn(&Twins<'_>) -> bool| own.iter().filter(|pair| side(pair)).count();
        let costs: Vec<f64> =
            own.iter().filter_map(|pair| Some(seconds(pair.other)? / seconds(pair.one)?)).collect();
        TwinsOfSituation {
            situation,
            pairs: own.len(),
            errors: errors.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]),
            failed: [
                failed(|pair| pair.one.status != Status::Ok),
                failed(|pair| pair.other.status != Status::Ok),
            ],
            cost: median(&costs),
        }
    };
    situations.into_iter().map(of_situation).collect()
}

/// Error of the pressure at the points at the last output, against the first reference that it was held against.
fn last_error(record: &Record) -> Option<f64> {
    let reference = &record.references.first()?.name;
    let time = *record.case.time_factors.last()?;
    let quantity = Quantity::Pressure;
    Some(record.error(quantity, Sample::Points, first_norm(quantity), reference, time)?.value.abs())
}

/// Median time of a run: of the processor where it is known, which other runs beside it do not lengthen.
fn seconds(record: &Record) -> Option<f64> {
    let times: Vec<f64> =
        record.wall.iter().map(|sample| sample.cpu_seconds.unwrap_or(sample.seconds)).collect();
    median(&times).filter(|seconds| *seconds > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

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
        assert_eq!(told.len(), 1);
        assert_eq!((told[0].pairs, told[0].failed), (4, [0, 0]));
        let worst = |points| {
            let own = records.iter().filter(|record| record.case.points_per_cell == points);
            own.filter_map(last_error).fold(0.0, f64::max)
        };
        assert_eq!(told[0].errors, Some([worst(2), worst(4)]));
        assert!(twins(&records, key, (Value::Count(2), Value::Count(3))).is_empty());
    }
}
