//! Likely mistakes behind the numbers of an external result.
//!
//! A hypothesis is a row of a table: what a column would hold (its unit, another array, an earlier output), or what all
//! columns would show in another world (a clock, a load, a drained base). Structure is looked at before anything is
//! fitted, and every column is judged on its own residual: one that is right is never explained, and what varies in the
//! prediction, never the load, is the yardstick. Where nothing explains, the place of the residual is said.

mod columns;
mod fits;
mod hypotheses;
mod patterns;
mod readings;
mod search;
mod structure;
mod world;

use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::score::coverage::SAME_PLACE;
use columns::{Column, Field, Given, Output};
use oedometer_exact::row::Axis;
use oedometer_exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use oedometer_soil::wording::short;
use search::{Explanation, Found};

/// Samples of an output that are looked at for patterns, and in the trials of hypotheses, where there are more than twice
/// as many.
const SAMPLES: [usize; 2] = [5000, 16];
/// Difference over the final settlement from which on the top of a column is not plane.
const UNEVEN_TOP: f64 = 0.02;
/// Relative distance of times that stand for one.
const SAME_TIME: f64 = 1e-6;
/// Words of a sentence about several runs.
pub const SEVERAL_RUNS: &str = "runs in one file";
/// Words of a question about one column, where the others match.
const ONLY: &str = "and only it: ";
/// Error up to which a column matches.
const MATCHES: f64 = 0.1;

/// What a result is held against.
struct Scene<'a> {
    parameters: &'a ColumnParameters,
    solution: Reference,
    mapping: &'a Mapping,
}

/// Sentences on what seems to be wrong with the numbers of a result, compared with a reference.
///
/// # Errors
/// When the reference refuses the result's own times.
pub fn diagnosis(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
    mapping: &Mapping,
) -> Result<Vec<String>, ExactError> {
    let times: Vec<f64> = states.iter().map(|state| parameters.time_factor(state.time)).collect();
    let solution = Reference::new(reference, parameters, &times)?;
    let scene = Scene { parameters, solution, mapping };
    let runs = runs(states);
    let Told { causes: mut sentences, places } = match &runs[..] {
        [outputs] => scene.told(outputs, None),
        runs => Told { causes: vec![scene.told_of_runs(runs)], places: Vec::new() },
    };
    let uneven = scene.uneven_top(states);
    sentences.extend(places.into_iter().filter(|_| uneven.is_none()));
    sentences.extend(uneven);
    Ok(sentences)
}

/// What is told of a result: likely causes, and where a residual without one is.
#[derive(Default)]
struct Told {
    causes: Vec<String>,
    places: Vec<String>,
}

impl Told {
    fn of(cause: String) -> Self {
        Self { causes: vec![cause], places: Vec::new() }
    }

    fn joined(self) -> Option<String> {
        let all: Vec<String> = self.causes.into_iter().chain(self.places).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }
}

/// The outputs of every run in a file: where two stand at one time with other values, the later one is of the next run.
fn runs(states: &[SampledState]) -> Vec<Vec<Output<'_>>> {
    let mut runs: Vec<Vec<Output<'_>>> = vec![Vec::new()];
    let mut rank = 0;
    for (place, state) in states.iter().enumerate() {
        let before = place.checked_sub(1).map(|before| &states[before]);
        let is_again =
            before.is_some_and(|before| (state.time - before.time).abs() <= SAME_TIME * state.time.abs());
        if is_again
            && before.is_some_and(|before| SampledState { time: state.time, ..before.clone() } == *state)
        {
            continue;
        }
        rank = if is_again { rank + 1 } else { 0 };
        if rank == runs.len() {
            runs.push(Vec::new());
        }
        let before = runs[rank].last().map_or(0.0, |output: &Output<'_>| output.state.time);
        runs[rank].push(Output { state, before });
    }
    runs
}

impl Scene<'_> {
    /// A sentence on several runs in one file.
    fn told_of_runs(&self, runs: &[Vec<Output<'_>>]) -> String {
        let of = |(place, outputs): (usize, &Vec<Output<'_>>)| match self.told(outputs, None).joined() {
            None => format!("run {} is right", place + 1),
            Some(told) => format!("in run {} {told}", place + 1),
        };
        let sentences: Vec<String> = runs.iter().enumerate().map(of).collect();
        let count = runs.len();
        format!(
            "there are {count} {SEVERAL_RUNS}, with other values at the same times: {}: was a second run appended?",
            sentences.join("; ")
        )
    }

    /// What seems wrong at the outputs of a run, or with some columns at some of them.
    fn told(&self, outputs: &[Output<'_>], some: Option<&[Field]>) -> Told {
        let given = |most: usize| Given::of(self.parameters, &self.solution, outputs, self.mapping, most);
        let (Some(mut whole), Some(mut thin)) = (given(SAMPLES[0]), given(SAMPLES[1])) else {
            return Told::default();
        };
        let are_all = some.is_none();
        whole
            .columns
            .retain(|column| column.is_right() || some.is_none_or(|some| some.contains(&column.field)));
        thin.judge_as(&whole);
        let wrong: Vec<&Column> = whole.columns.iter().filter(|column| !column.is_right()).collect();
        let are_all_wrong = wrong.len() == whole.columns.len();
        let Some(first) = wrong.first() else { return Told::default() };
        // Structure first.
        let zeros = || structure::content(first, &whole).filter(|_| wrong.len() == 1 && first.is_zero());
        let steps = || structure::step_numbers(&thin).filter(|_| are_all);
        if let Some(told) = Some(()).filter(|()| are_all_wrong).and_then(|()| zeros().or_else(steps)) {
            return Told::of(told);
        }
        let found = search::explanation(&thin, &whole, are_all);
        let is_world = found.as_ref().is_some_and(|found| found.best.world.count > 0);
        let is_other = wrong.iter().any(|column| structure::content(column, &whole).is_some());
        let is_closed = found.as_ref().is_some_and(|found| found.best.is_closed());
        if let Some(told) = structure::same_state(&thin).filter(|_| !(is_world && is_closed || is_other)) {
            return Told::of(told);
        }
        let causes = found.as_ref().map_or(Vec::new(), |found| sentences_of(found, &thin));
        let mut told = Told { causes, places: Vec::new() };
        let is_open = |column: &&Column| match &found {
            Some(found) => found.best.leaves(column.field, &thin),
            None => !column.is_right(),
        };
        let open: Vec<&Column> = whole.columns.iter().filter(is_open).collect();
        if are_all && !is_world && self.tell_apart(&open, &whole, outputs, &mut told) {
            return told;
        }
        for column in open.into_iter().filter(|column| !column.is_as_good_as_its_mesh()) {
            if let Some(content) = structure::content(column, &whole).filter(|_| are_all) {
                told.causes.push(content);
            } else if is_world && structure::is_told(column) {
                told.causes
                    .push(format!("your {} does not match that: it is wrong in its own right", column.name));
            } else if structure::is_told(column) {
                told.places.extend(structure::place(column, &whole));
            }
        }
        told
    }

    /// Tells of columns that are wrong at some of the outputs alone, with what explains these.
    fn tell_apart(
        &self,
        columns: &[&Column],
        given: &Given<'_>,
        outputs: &[Output<'_>],
        told: &mut Told,
    ) -> bool {
        let Some([right, wrong]) = structure::apart(columns, given) else { return false };
        let times = |numbers: &[usize]| {
            numbers.iter().map(|output| short(given.times[*output])).collect::<Vec<_>>().join(", ")
        };
        let is_wrong =
            |output: &Output<'_>| wrong.iter().any(|number| given.times[*number] == output.state.time);
        let others: Vec<Output<'_>> = outputs.iter().filter(|output| is_wrong(output)).copied().collect();
        let fields: Vec<Field> = columns.iter().map(|column| column.field).collect();
        let there = self.told(&others, Some(&fields));
        if there.causes.is_empty()
            && !columns.iter().any(|column| structure::is_told_at(column, given, &wrong))
        {
            return false;
        }
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let (who, are) = (who(&names, "your"), if names.len() == 1 { "is" } else { "are" });
        let alone =
            format!("{who} {are} right at t = {} s and wrong only at t = {} s", times(&right), times(&wrong));
        let run = there.causes.iter().any(|cause| cause.contains("× the time"));
        let run = if run { "; are these outputs of another run?" } else { "" };
        if there.causes.is_empty() {
            told.places.push(alone);
        } else {
            told.causes.push(format!("{alone}: there {}{run}", there.causes.join("; ")));
        }
        true
    }

    /// A sentence about the top of a column that does not stay plane: samples of its highest row that settle differently.
    fn uneven_top(&self, states: &[SampledState]) -> Option<String> {
        if self.solution.kind().row().axis != Axis::OverDepth {
            return None;
        }
        let settled = self.parameters.final_settlement();
        let last = states.last().filter(|state| state.displacement.len() == state.initial_height.len())?;
        let highest = last.initial_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_top = |y: f64| highest - y <= SAME_PLACE * self.parameters.height;
        let top = last.initial_height.iter().zip(&last.displacement).filter(|(y, _)| is_top(**y));
        let moved = top.map(|(_, moved)| *moved);
        let [least, most] = moved.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], moved| {
            [least.min(moved), most.max(moved)]
        });
        // Places that are repeated are of several states.
        (last.repeated == 0 && most - least > UNEVEN_TOP * settled.abs()).then(|| {
            format!(
                "your top is not plane: at y = {} m u_y lies between {} and {} m: are the sides on rollers, and does the \
                 load press evenly?",
                short(highest),
                short(least),
                short(most)
            )
        })
    }
}

/// The sentences of an explanation, one for all columns that are read alike; of what they share first, its questions once.
fn sentences_of(found: &Found, given: &Given<'_>) -> Vec<String> {
    let Explanation { world, readings, .. } = &found.best;
    let mut groups: Vec<(&readings::Reading, Vec<&str>)> = Vec::new();
    for (reading, column) in readings.iter().zip(&given.columns) {
        let Some(reading) = reading.as_ref().filter(|reading| reading.count + world.count > 0) else {
            continue;
        };
        if column.is_right() && reading.count == 0 && !is_seen(column, found) {
            continue;
        }
        let like = |group: &&mut (&readings::Reading, Vec<&str>)| {
            (&group.0.begin, &group.0.asked) == (&reading.begin, &reading.asked)
        };
        match groups.iter_mut().find(like) {
            Some((_, columns)) => columns.push(column.name),
            None => groups.push((reading, vec![column.name])),
        }
    }
    groups.sort_by_key(|(reading, _)| reading.count);
    let is_match = |(reading, column): (&Option<readings::Reading>, &Column)| {
        column.residual <= MATCHES || reading.as_ref().is_some_and(|reading| reading.left <= MATCHES)
    };
    let do_others_match = readings.iter().zip(&given.columns).all(is_match);
    let is_alone = given.columns.len() == 1;
    let sentence = |(place, (reading, columns)): (usize, (&readings::Reading, Vec<&str>))| {
        let begin = match reading.factor {
            Some(factor) if is_alone && world.count == 0 => {
                format!("is the load {} × that of the problem? Or ", fits::shown(factor))
            }
            Some(_) if do_others_match && columns.len() == 1 => ONLY.to_owned(),
            _ => String::new(),
        };
        let mut questions = reading.asked.clone();
        if place == 0 {
            questions.extend(world.asked.iter().cloned());
        }
        let alternatives = found.alternatives.iter().filter(|_| place == 0);
        let asked = std::iter::once(&questions.join(" And "))
            .chain(alternatives)
            .map(|asked| &**asked)
            .collect::<Vec<_>>()
            .join(" Or ");
        format!("{} {}{}: {begin}{asked}", who(&columns, "each of your"), reading.begin, world.said)
    };
    groups.into_iter().enumerate().map(sentence).collect()
}

/// Whether a column that is right takes part in what is said of all.
fn is_seen(column: &Column, found: &Found) -> bool {
    found.best.world.count > 0 && column.residual > 0.0
}

/// Columns by their names.
fn who(names: &[&str], several: &str) -> String {
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{several} {} and {last}", others.join(", ")),
        _ => format!("your {}", names.concat()),
    }
}

#[cfg(test)]
mod tests;
