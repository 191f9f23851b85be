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
use columns::{CLEAN, Column, Given, MOST, right_beside};
use oedometer_exact::row::Axis;
use oedometer_exact::{ColumnParameters, ReferenceKind};
use oedometer_wording::rounded;
use readings::Reading;
use search::Explanation;
use world::World;

/// Relative distance of times that stand for one.
const SAME_TIME: f64 = 1e-6;
/// Words of a sentence about several runs.
pub const SEVERAL_RUNS: &str = "runs in one file";
/// Words of a sentence about the place of a residual.
const NO_MISTAKE: &str = "no known mistake explains it";

/// Sentences on what seems to be wrong with the numbers of a result, compared with a reference.
pub fn diagnosis(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
    mapping: &Mapping,
) -> Vec<String> {
    let own = World::own(reference, parameters);
    let of_run = |states: &Vec<&SampledState>| {
        Given::of(&own, mapping, states).map_or(Vec::new(), |given| match step_numbers(states, &given) {
            Some(numbered) => vec![numbered],
            None => mistakes_of(&given, false),
        })
    };
    let runs = runs(states);
    let mut mistakes = runs.iter().map(of_run);
    let mut mistakes = if runs.len() == 1 {
        mistakes.next().unwrap_or_default()
    } else {
        let of_run = |(place, mistakes): (usize, Vec<String>)| match mistakes.join("; ") {
            mistakes if mistakes.is_empty() => format!("run {} is right", place + 1),
            mistakes => format!("in run {} {mistakes}", place + 1),
        };
        let mistakes = mistakes.enumerate().map(of_run).collect::<Vec<_>>().join("; ");
        vec![format!(
            "there are {} {SEVERAL_RUNS}, with other values at the same times: {mistakes}: was a second run appended?",
            runs.len()
        )]
    };
    if reference.row().axis == Axis::OverDepth
        && let Some(uneven) = uneven_top(parameters, states)
    {
        mistakes.retain(|mistake| !mistake.contains(NO_MISTAKE));
        mistakes.push(uneven);
    }
    mistakes
}

/// The outputs of every run in a file: where two stand at one time with other values, the later one is of the next run.
fn runs(states: &[SampledState]) -> Vec<Vec<&SampledState>> {
    let mut runs: Vec<Vec<&SampledState>> = vec![Vec::new()];
    let is_again = |a: &SampledState, b: &SampledState| (b.time - a.time).abs() <= SAME_TIME * b.time.abs();
    for at_one_time in states.chunk_by(is_again) {
        let mut different: Vec<&SampledState> = at_one_time.iter().collect();
        different.dedup_by(|b, a| SampledState { time: b.time, ..a.clone() } == **b);
        runs.resize(runs.len().max(different.len()), Vec::new());
        runs.iter_mut().zip(different).for_each(|(run, state)| run.push(state));
    }
    runs
}

/// What seems wrong with a run, or with some of its outputs.
fn mistakes_of(given: &Given<'_>, is_part: bool) -> Vec<String> {
    let Some(found) = given.thin().and_then(|thin| search::explanation(&thin, given, is_part)) else {
        return Vec::new();
    };
    let is_world = found.of.count > 0;
    let mut mistakes = sentences(&found, given);
    let columns = given.columns.iter().zip(&found.readings);
    let open: Vec<&Column> =
        columns.filter(|(_, reading)| reading.is_none()).map(|(column, _)| column).collect();
    let apart = (!is_part && !is_world).then(|| told_apart(&open, given)).flatten();
    if apart.is_some() {
        mistakes.extend(apart);
        return mistakes;
    }
    for column in open {
        mistakes.extend(patterns::unexplained(column, given).or_else(|| match is_world {
            _ if column.residual <= MOST => None,
            true => Some(format!("your {} does not match that: it is wrong in its own right", column.name)),
            false => patterns::place(column, given),
        }));
    }
    mistakes
}

/// A sentence on times that count outputs, with the time factors that the columns are at.
fn step_numbers(states: &[&SampledState], given: &Given<'_>) -> Option<String> {
    let Given { own, mapping, columns, .. } = given;
    let seconds = mapping.units.time.seconds(1.0, own.parameters.time(1.0));
    let first = (states.first()?.time / seconds).round();
    let is_counted =
        |(place, state): (usize, &&SampledState)| (state.time / seconds - first - place as f64).abs() < 1e-6;
    let are_wrong = !columns.iter().any(|column| column.is_right() || column.is_zero());
    if states.len() < 3 || first > 1.0 || !are_wrong || !states.iter().enumerate().all(is_counted) {
        return None;
    }
    let own_time = |state: &&SampledState| {
        let (time, left) = search::one_time(&Given::of(own, mapping, &[state])?.thin()?)?;
        (left <= CLEAN).then(|| digits(own.parameters.time_factor(time)))
    };
    let times: Option<Vec<String>> = states.iter().map(own_time).collect();
    Some(format!(
        "your times count outputs ({first}, {}, {}, …): are they step numbers instead of times? At T_v = {} all \
         matches the exact solution",
        first + 1.0,
        first + 2.0,
        times?.join(", ")
    ))
}

/// A sentence on columns that are wrong at some of the outputs alone, with what explains these.
fn told_apart(columns: &[&Column], given: &Given<'_>) -> Option<String> {
    let misfit = |output: usize| {
        let of = columns.iter().filter(|column| column.outputs.contains(&output));
        let of = of.map(|column| column.misfit(&column.itself(&column.exact), 1.0, Some(output)));
        of.fold(0.0, f64::max)
    };
    let misfits: Vec<f64> = (0..given.times.len()).map(misfit).collect();
    let worst = misfits.iter().copied().fold(0.0, f64::max);
    let is_right = |output: &usize| misfits[*output] <= right_beside(worst);
    let (right, wrong): (Vec<usize>, Vec<usize>) = (0..misfits.len()).partition(is_right);
    if right.is_empty() || wrong.is_empty() {
        return None;
    }
    let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
    let there = mistakes_of(&given.at_outputs(&wrong, &names)?, true).join("; ");
    if worst <= MOST && there.is_empty() {
        return None;
    }
    let begin = if there.is_empty() { "" } else { ": there " };
    let end = if there.contains("× the time") { "; are these outputs of another run?" } else { "" };
    let who = who(&names);
    let [right, wrong] =
        [right, wrong].map(|outputs| listed(outputs.into_iter().map(|output| given.times[output])));
    Some(format!("{who} is right at t = {right} s and wrong only at t = {wrong} s{begin}{there}{end}"))
}

/// The sentences of an explanation, one for all columns that are read alike; of what they share first, its questions once.
fn sentences(found: &Explanation, given: &Given<'_>) -> Vec<String> {
    // A column that is right takes part in what is said of all.
    let is_told = |(reading, column): &(&Reading, &Column)| {
        reading.count > 0 || found.of.count > 0 && column.residual > 0.0
    };
    let columns = given.columns.iter().zip(&found.readings);
    let read = columns.filter_map(|(column, reading)| Some((reading.as_ref()?, column)));
    let mut readings: Vec<(&Reading, &Column)> = read.filter(is_told).collect();
    readings.sort_by_key(|(reading, _)| (reading.count, &reading.key));
    let none = Reading::default();
    let sentence = |(place, alike): (usize, &[(&Reading, &Column)])| {
        let (of, shared) = (alike[0].0, if place == 0 { &found.of } else { &none });
        let asked = [&of.asked[..], &shared.asked].concat().join(", and ");
        let asked = [&[asked][..], &of.or, &shared.or].concat().join(", or ");
        let names: Vec<&str> = alike.iter().map(|(_, column)| column.name).collect();
        format!("{} {}{}: {asked}?", who(&names), of.said, found.of.said)
    };
    readings.chunk_by(|(a, _), (b, _)| a.key == b.key).enumerate().map(sentence).collect()
}

/// Columns by their names.
fn who(names: &[&str]) -> String {
    match names {
        [others @ .., last] if !others.is_empty() => format!("each of your {} and {last}", others.join(", ")),
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
