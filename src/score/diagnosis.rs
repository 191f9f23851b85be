//! Likely mistakes behind the numbers of an external result.
//!
//! A hypothesis is a row of a table: what a column would hold (its unit, another array, an earlier output), or what all
//! columns would show in another world (a clock, a load, a drained base). Structure is looked at before anything is
//! fitted, and every column is judged on its own residual: one that is right is never explained, and what varies in the
//! prediction, never the load, is the yardstick. Where nothing explains, the place of the residual is said.

mod columns;
mod hypotheses;
mod patterns;
mod readings;
mod search;
mod world;

use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::score::coverage::uneven_top;
use columns::{Column, Field, Given, Output};
use oedometer_exact::row::Axis;
use oedometer_exact::{ColumnParameters, ReferenceKind};
use oedometer_wording::rounded;
use readings::Reading;
use search::{Explanation, Mistake};
use world::World;

/// Samples of an output that are looked at for patterns, and in the trials of hypotheses, where there are more than twice
/// as many.
const SAMPLES: [usize; 2] = [5000, 16];
/// Relative distance of times that stand for one.
const SAME_TIME: f64 = 1e-6;
/// Words of a sentence about several runs.
pub const SEVERAL_RUNS: &str = "runs in one file";
/// Words of a sentence about the place of a residual.
const NO_MISTAKE: &str = "no known mistake explains it";
/// Residual from which on one that nothing explains is told.
const TOLD: f64 = 0.1;
/// Error that an output at a time of its own may leave.
const AT_ITS_TIME: f64 = 0.02;
/// Error of an output that is right where others are wrong: at least, at most, and its share of the largest.
const ELSEWHERE: [f64; 3] = [1e-3, 0.03, 0.1];

/// Sentences on what seems to be wrong with the numbers of a result, compared with a reference.
pub fn diagnosis(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
    mapping: &Mapping,
) -> Vec<String> {
    let scene = Scene { own: World::own(reference, parameters), mapping };
    let mut told = match &runs(states)[..] {
        [outputs] => scene.told(outputs, None),
        runs => vec![scene.told_of_runs(runs)],
    };
    let is_over_depth = reference.row().axis == Axis::OverDepth;
    if let Some(uneven) = uneven_top(parameters, states).filter(|_| is_over_depth) {
        told.retain(|told| !told.contains(NO_MISTAKE));
        told.push(uneven);
    }
    told
}

/// A scene as it is, with the mapping of the files that are held against it.
struct Scene<'a> {
    own: World,
    mapping: &'a Mapping,
}

/// The outputs of every run in a file: where two stand at one time with other values, the later one is of the next run.
fn runs(states: &[SampledState]) -> Vec<Vec<Output<'_>>> {
    let mut runs: Vec<Vec<Output<'_>>> = vec![Vec::new()];
    let mut rank = 0;
    for (place, state) in states.iter().enumerate() {
        let before = place.checked_sub(1).map(|before| &states[before]);
        let is_again =
            |before: &&SampledState| (state.time - before.time).abs() <= SAME_TIME * state.time.abs();
        let again = before.filter(is_again);
        if again.is_some_and(|before| SampledState { time: state.time, ..before.clone() } == *state) {
            continue;
        }
        rank = if again.is_some() { rank + 1 } else { 0 };
        if rank == runs.len() {
            runs.push(Vec::new());
        }
        let before = runs[rank].last().map_or(0.0, |output: &Output<'_>| output.state.time);
        runs[rank].push(Output { state, before });
    }
    runs
}

impl<'a> Scene<'a> {
    /// A sentence on several runs in one file.
    fn told_of_runs(&self, runs: &[Vec<Output<'a>>]) -> String {
        let of = |(place, outputs): (usize, &Vec<Output<'a>>)| match self.told(outputs, None).join("; ") {
            told if told.is_empty() => format!("run {} is right", place + 1),
            told => format!("in run {} {told}", place + 1),
        };
        let told: Vec<String> = runs.iter().enumerate().map(of).collect();
        let [count, told] = [runs.len().to_string(), told.join("; ")];
        format!(
            "there are {count} {SEVERAL_RUNS}, with other values at the same times: {told}: was a second run appended?"
        )
    }

    /// What seems wrong at the outputs of a run, or with some columns at some of them.
    fn told(&self, outputs: &[Output<'a>], some: Option<&[Field]>) -> Vec<String> {
        let given = |most: usize| Given::of(&self.own, self.mapping, outputs, most);
        let (Some(mut whole), Some(mut thin)) = (given(SAMPLES[0]), given(SAMPLES[1])) else {
            return Vec::new();
        };
        whole
            .columns
            .retain(|column| column.is_right() || some.is_none_or(|some| some.contains(&column.field)));
        thin.judge_as(&whole);
        // Structure first.
        let are_all_wrong = !whole.columns.iter().any(Column::is_right);
        let content = |column: &Column| patterns::content(column, &whole).filter(|_| some.is_none());
        let alone = match &whole.columns[..] {
            [column] if column.is_zero() => content(column),
            _ if are_all_wrong && some.is_none() => self.step_numbers(outputs),
            _ => None,
        };
        if let Some(told) = alone {
            return vec![told];
        }
        let found = search::explanation(&thin, &whole, some.is_none());
        let is_world = found.as_ref().is_some_and(|found| found.of.count > 0);
        let mut told = found.as_ref().map_or(Vec::new(), |found| sentences(found, &thin));
        let is_open = |column: &&Column| match &found {
            Some(found) => found.leaves(column.field, &thin),
            None => !column.is_right(),
        };
        let open: Vec<&Column> = whole.columns.iter().filter(is_open).collect();
        let apart = || self.told_apart(&open, &whole, outputs);
        if let Some(apart) = (some.is_none() && !is_world).then(apart).flatten() {
            told.push(apart);
            return told;
        }
        for column in open.into_iter().filter(|column| column.residual > column.mesh) {
            let unlike = || patterns::unlike(column, &whole).filter(|_| some.is_none());
            told.extend(content(column).or_else(unlike).or_else(|| match is_world {
                _ if column.residual <= TOLD => None,
                true => {
                    Some(format!("your {} does not match that: it is wrong in its own right", column.name))
                }
                false => patterns::place(column, &whole),
            }));
        }
        told
    }

    /// A sentence on times that count outputs, with the time factors that the columns are at.
    fn step_numbers(&self, outputs: &[Output<'a>]) -> Option<String> {
        let parameters = &self.own.parameters;
        let seconds = self.mapping.units.time.seconds(1.0, parameters.time(1.0));
        let first = (outputs.first()?.state.time / seconds).round();
        let is_counted = |(place, output): (usize, &Output<'a>)| {
            (output.state.time / seconds - first - place as f64).abs() < 1e-6
        };
        if outputs.len() < 3 || first > 1.0 || !outputs.iter().enumerate().all(is_counted) {
            return None;
        }
        let own_time = |output: &Output<'a>| {
            let given = Given::of(&self.own, self.mapping, std::slice::from_ref(output), SAMPLES[1])?;
            let (time, _) = search::one_time(&given).filter(|(_, left)| *left <= AT_ITS_TIME)?;
            Some(digits(parameters.time_factor(time)))
        };
        let times: Option<Vec<String>> = outputs.iter().map(own_time).collect();
        let [second, third] = [first + 1.0, first + 2.0];
        Some(format!(
            "your times count outputs ({first}, {second}, {third}, …): are they step numbers instead of times? At T_v = {} all \
             matches the exact solution",
            times?.join(", ")
        ))
    }

    /// A sentence on columns that are wrong at some of the outputs alone, with what explains these.
    fn told_apart(&self, columns: &[&Column], given: &Given<'_>, outputs: &[Output<'a>]) -> Option<String> {
        let misfit = |output: usize| {
            let of = columns.iter().filter(|column| column.outputs.contains(&output));
            let of = of
                .map(|column| column.misfit(&column.itself(&column.exact(&given.exact)), 1.0, Some(output)));
            of.fold(0.0, f64::max)
        };
        let misfits: Vec<f64> = (0..given.times.len()).map(misfit).collect();
        let worst = misfits.iter().copied().fold(0.0, f64::max);
        let [least, most, share] = ELSEWHERE;
        let [right, wrong] = [true, false].map(|is_right| {
            let is_so = |misfit: f64| (misfit <= (share * worst).clamp(least, most)) == is_right;
            let all = given.times.iter().zip(&misfits).filter(|(_, misfit)| is_so(**misfit));
            all.map(|(time, _)| *time).collect::<Vec<f64>>()
        });
        let is_wrong = |output: &&Output<'a>| wrong.contains(&output.state.time);
        let others: Vec<Output<'a>> = outputs.iter().filter(is_wrong).copied().collect();
        if right.is_empty() || others.is_empty() {
            return None;
        }
        let fields: Vec<Field> = columns.iter().map(|column| column.field).collect();
        let there = match self.told(&others, Some(&fields)).join("; ") {
            there if there.is_empty() => there,
            there if there.contains("× the time") => {
                format!(": there {there}; are these outputs of another run?")
            }
            there => format!(": there {there}"),
        };
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let (who, are) = (who(&names, "your"), if names.len() == 1 { "is" } else { "are" });
        let [right, wrong] = [right, wrong].map(|times| listed(times.into_iter()));
        let told = format!("{who} {are} right at t = {right} s and wrong only at t = {wrong} s{there}");
        (worst > TOLD || !there.is_empty()).then_some(told)
    }
}

/// The sentences of an explanation, one for all columns that are read alike; of what they share first, its questions once.
fn sentences(found: &Explanation, given: &Given<'_>) -> Vec<String> {
    let mut groups: Vec<(&Mistake, Vec<&str>)> = Vec::new();
    for (reading, column) in found.readings.iter().zip(&given.columns) {
        // A column that is right takes part in what is said of all.
        let is_seen = found.of.count > 0 && column.residual > 0.0;
        let is_told = |reading: &&Reading| reading.of.count > 0 || is_seen;
        let Some(Reading { of, .. }) = reading.as_ref().filter(is_told) else {
            continue;
        };
        match groups.iter_mut().find(|(other, _)| (&other.said, &other.asked) == (&of.said, &of.asked)) {
            Some((_, columns)) => columns.push(column.name),
            None => groups.push((of, vec![column.name])),
        }
    }
    groups.sort_by_key(|(of, _)| of.count);
    let shared = [&found.of.asked[..], &[]];
    let alternatives = [&found.alternatives[..], &[]];
    let sentence = |(place, (of, columns)): (usize, (&Mistake, Vec<&str>))| {
        let place = place.min(1);
        let asked = [&of.asked[..], shared[place]].concat().join(", and ");
        let asked = [&[asked][..], alternatives[place]].concat().join(", or ");
        format!("{} {}{}: {asked}?", who(&columns, "each of your"), of.said, found.of.said)
    };
    groups.into_iter().enumerate().map(sentence).collect()
}

/// Columns by their names.
fn who(names: &[&str], several: &str) -> String {
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => {
            format!("{several} {} and {last}", others.join(", "))
        }
        _ => format!("your {}", names.concat()),
    }
}

fn listed(numbers: impl Iterator<Item = f64>) -> String {
    numbers.map(rounded).collect::<Vec<_>>().join(", ")
}

/// A number to three digits: a fit gives no more.
fn digits(number: f64) -> String {
    rounded(format!("{number:.2e}").parse().unwrap_or(number))
}

/// A factor in words: −1.00, 0.001, 60.
fn shown(factor: f64) -> String {
    let digits = if factor.abs() == 1.0 { format!("{factor:.2}") } else { digits(factor) };
    digits.replace('-', "−")
}

#[cfg(test)]
mod tests;
