//! Runs that differ in one input alone: what the input costs and brings.

use crate::case::keys::{Key, Value};
use crate::case::quantity::{Quantity, Sample};
use crate::judge::comparison::situation::Situation;
use crate::judge::paths::first_norm;
use crate::measure::wall_times::median;
use crate::record::{Record, Status};
use oedometer_mpm::method::Method;
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

/// Twins of one situation and method, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinsOfSituation {
    /// The situation.
    pub situation: Situation,
    /// The method; none of all that have the same errors on both sides.
    pub method: Option<Method>,
    /// Pairs there are.
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
    let mut situations: Vec<Situation> = all.iter().map(|pair| Situation::of(pair.one)).collect();
    situations.sort_unstable();
    situations.dedup();
    situations.into_iter().flat_map(|situation| by_method(situation, all)).collect()
}

/// Errors that differ by less than this share are the same, but for round-off.
const SAME: f64 = 1e-6;

/// The pairs of a situation by their method; those of methods for which the input changes nothing in one, at the end.
fn by_method(situation: Situation, all: &[Twins<'_>]) -> Vec<TwinsOfSituation> {
    let mut methods: Vec<(Method, Vec<&Twins<'_>>)> = Vec::new();
    for pair in all.iter().filter(|pair| Situation::of(pair.one) == situation) {
        let method = pair.one.case.method;
        match methods.iter_mut().find(|(known, _)| *known == method) {
            Some((_, own)) => own.push(pair),
            None => methods.push((method, vec![pair])),
        }
    }
    let is_same = |ratio: f64| (ratio - 1.0).abs() <= SAME;
    let (alike, differing): (Vec<_>, Vec<_>) =
        methods.into_iter().partition(|(_, own)| own.iter().flat_map(|pair| ratios_of(pair)).all(is_same));
    let mut told: Vec<TwinsOfSituation> =
        differing.iter().map(|(method, own)| in_numbers(situation, Some(*method), own)).collect();
    let alike: Vec<&Twins<'_>> = alike.into_iter().flat_map(|(_, own)| own).collect();
    if !alike.is_empty() {
        told.push(in_numbers(situation, None, &alike));
    }
    told
}

fn in_numbers(situation: Situation, method: Option<Method>, own: &[&Twins<'_>]) -> TwinsOfSituation {
    let mut ratios: Vec<f64> = own.iter().flat_map(|pair| ratios_of(pair)).collect();
    ratios.sort_by(f64::total_cmp);
    let failed = |side: fn(&Twins<'_>) -> bool| own.iter().filter(|pair| side(pair)).count();
    let costs: Vec<f64> =
        own.iter().filter_map(|pair| Some(seconds(pair.other)? / seconds(pair.one)?)).collect();
    TwinsOfSituation {
        situation,
        method,
        pairs: own.len(),
        ratios: median(&ratios).and_then(|middle| Some([*ratios.first()?, middle, *ratios.last()?])),
        failed: [
            failed(|pair| pair.one.status != Status::Ok),
            failed(|pair| pair.other.status != Status::Ok),
        ],
        cost: median(&costs),
    }
}

/// Error of the pressure at the points of the second over that of the first at every output that both have.
fn ratios_of(pair: &Twins<'_>) -> Vec<f64> {
    let times = pair.one.case.time_factors.iter();
    let both = times.filter_map(|time| Some((error_at(pair.one, *time)?, error_at(pair.other, *time)?)));
    both.filter(|(one, _)| *one > 0.0).map(|(one, other)| other / one).collect()
}

/// Error of the pressure at the points at an output, against the first reference that it was held against.
fn error_at(record: &Record, time: f64) -> Option<f64> {
    let reference = &record.references.first()?.name;
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
        assert_eq!(told.len(), 2, "a row of each method");
        assert!(told.iter().all(|one| (one.pairs, one.failed) == (2, [0, 0])));
        let errors = |points: usize| -> Vec<f64> {
            let own = |record: &&Record| {
                record.case.points_per_cell == points && Some(record.case.method) == told[0].method
            };
            records.iter().filter(own).filter_map(|record| error_at(record, 0.1)).collect()
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
    fn runs_of_two_layers_have_their_twins_in_one() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\n[output]\ntime_factors = [1e-4]\n[[sweep]]\nmethod = ['GIMP-SRI-patch']\n\
             cells = [4]\nlayers = [1, 2]\n",
        );
        let key = Key::named("layers", "points").expect("a key");
        let pairs = twins(&records, key, (Value::Count(1), Value::Count(2)));
        assert_eq!((records.len(), pairs.len()), (2, 1));
        assert!(pairs[0].other.case.column.points.has_two_layers());
    }
}
