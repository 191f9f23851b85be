//! The end of a run by its name, and who made the error: a closed list; the first that applies holds.
//!
//! | status | when | whose |
//! | :-- | :-- | :-- |
//! | `timed-out` | its time was over, whatever it had printed by then | the solver's |
//! | `not-startable` | the program or its folder does not exist | the study's command's, or the machine's |
//! | `killed` | a signal ended it that this program did not send | the solver's, or the machine's |
//! | `failed` | it ended with an exit code other than 0 and 77 | the solver's, or its adapter's |
//! | `skipped` | it ended with exit code 77: it cannot run here | none |
//! | `no-result` | it ended well, and its result is not there | the adapter's |
//! | `unreadable` | the result is missing, or not what the mapping says | the adapter's, or the mapping's |
//! | `not-finite` | the result contains a value that is not finite | the solver's |
//! | `incomplete` | outputs or places are missing | the adapter's |
//! | `ok` | none of these | |

use crate::import::SampledState;
use crate::process::{Ending, Finished, last_lines};
use crate::reading::Unread;
use crate::solver::ExternalSolver;
use crate::started_processes::named;
use oedometer_case::complete_states::SAME_TIME;
use oedometer_case::{Case, Sample};
use oedometer_problem::outcome::{Failure, FailureKind};
use oedometer_wording::{rounded, typed};
use std::process::ExitStatus;

/// Exit code by which a program says that it cannot run here.
const SKIPPED: i32 = 77;
/// Most lines that are kept of what a program said before it failed.
const MOST_LINES: usize = 12;
/// Those of them that a message repeats.
const TOLD_LINES: usize = 4;
/// Longest of these lines, letters.
const LONGEST_LINE: usize = 200;

/// Begin of a traceback of Python.
const TRACEBACK: &str = "Traceback (most recent call last)";
/// Parts of lines that name what went wrong.
const WRONG: [&str; 9] = [
    "error",
    "exception",
    "fatal",
    "assert",
    "fault",
    "terminate called",
    "abort",
    "not found",
    "no such file",
];
/// Parts of lines that MPI's launchers write about a process that ended.
const LAUNCHERS: [&str; 12] = [
    "mpi_abort",
    "mpirun",
    "mpiexec",
    "prterun",
    "orterun",
    "primary job",
    "your application process",
    "application called",
    "errorcode",
    "with errorcode",
    "proc: [[",
    "hydra",
];

/// The end of a run that left no result; none where it may have.
pub fn of_process(run: &Finished, solver: &ExternalSolver) -> Option<Failure> {
    let (kind, what) = match &run.ending {
        Ending::TimedOut => (
            FailureKind::TimedOut,
            format!(
                "the solver exceeded its {} s and was killed with everything that it had started{}; it \
                 hangs, or `timeout` is too short",
                typed(solver.timeout),
                if run.found.lives_on.is_empty() {
                    String::new()
                } else {
                    format!(", except for {}, which could not be killed", named(&run.found.lives_on))
                }
            ),
        ),
        Ending::Stopped => return Some(of_stopped()),
        Ending::NotStarted(error) => (
            FailureKind::NotStartable,
            format!(
                "`{}` could not be started: {error}; the command in the study is wrong, or the program is \
                 not installed",
                solver.command.first().map_or("", String::as_str)
            ),
        ),
        Ending::Ended(status) => of_status(*status)?,
    };
    Some(Failure::of_attached(kind, what + &last_words(run)))
}

/// A sentence on processes that a run left behind, or that could not be ended.
pub fn of_processes(run: &Finished) -> Option<String> {
    let found = &run.found;
    if !found.lives_on.is_empty() {
        return Some(format!("processes of it could not be ended: {}", named(&found.lives_on)));
    }
    let left = matches!(run.ending, Ending::Ended(_)) && !found.seen.is_empty();
    left.then(|| format!("it left processes behind, which were ended: {}", named(&found.seen)))
}

/// The end of a cancelled run: Ctrl-C, or another result that could not be kept.
pub fn of_stopped() -> Failure {
    Failure::of_attached(FailureKind::Stopped, "stopped from outside".to_owned())
}

/// The end of a run that was not begun because the study may not start programs.
pub fn of_held_back() -> Failure {
    let reason = "this study may not start programs without `--allow-solvers`".to_owned();
    Failure::of_attached(FailureKind::Skipped, reason)
}

/// The end of a program by its status; none where it ended well.
fn of_status(status: ExitStatus) -> Option<(FailureKind, String)> {
    match status.code() {
        Some(0) => None,
        Some(SKIPPED) => {
            Some((FailureKind::Skipped, format!("it reports that it cannot run here (exit code {SKIPPED})")))
        }
        Some(code) => Some((
            FailureKind::Failed,
            format!("it ended with exit code {code}; an error of the solver, or of its adapter"),
        )),
        None => Some((
            FailureKind::Killed,
            format!(
                "{status} ended it, which this program did not send; the solver crashed, or memory ran out"
            ),
        )),
    }
}

/// The end of a run whose result cannot be taken.
pub fn of_reading(unread: Unread, solver: &ExternalSolver, contents: &str) -> Failure {
    let no_file = format!(
        "it ended with exit code 0 and left no {}; {{out}} has {contents}: the adapter writes it elsewhere, \
         or `result` in the study has another name",
        solver.result
    );
    of_unread(unread, no_file, "; the adapter wrote it wrongly, or the mapping describes it wrongly")
}

/// The end of a result that was there already and cannot be taken.
pub fn of_given(unread: Unread, files: &[String]) -> Failure {
    let files = files.join(", ");
    let no_file = format!(
        "there is no file {files}: the solver did not run, or `files` in the study names another result"
    );
    of_unread(unread, no_file, "")
}

/// The end of a result that cannot be taken, with what to say where there is none and whose error it is that it cannot be
/// read.
fn of_unread(unread: Unread, no_file: String, whose: &str) -> Failure {
    let (kind, what) = match unread {
        Unread::NoFile => (FailureKind::NoResult, no_file),
        Unread::Unreadable(why) => (FailureKind::Unreadable, why + whose),
        Unread::NotFinite(why) => (FailureKind::NotFinite, format!("{why}; an error of the solver")),
    };
    Failure::of_attached(kind, what)
}

/// The end of a run whose result lacks something.
pub fn of_incomplete(lack: &str) -> Failure {
    let reason = format!("{lack}; the adapter left data out, or the solver ended early without an error");
    Failure::of_attached(FailureKind::Incomplete, reason)
}

/// The end of a run for which the machine had no place.
pub fn of_folder(error: &std::io::Error) -> Failure {
    let reason =
        format!("its folder could not be created: {error}; an error of the machine, not of the solver");
    Failure::of_attached(FailureKind::NotStartable, reason)
}

/// The end of a run whose mapping is wrong.
pub fn of_mapping(why: &str) -> Failure {
    Failure::of_attached(FailureKind::Unreadable, format!("the mapping cannot be used: {why}"))
}

/// The last lines of a run's errors, or of its output if it wrote no errors, behind the first that names what went wrong:
/// what follows a crash is the launcher's.
pub fn kept_words(run: &Finished) -> Vec<String> {
    let text = if run.errors.trim().is_empty() { &run.output } else { &run.errors };
    let mut lines = last_lines(text, MOST_LINES, LONGEST_LINE);
    if let Some(first) = first_message(&run.errors).or_else(|| first_message(&run.output))
        && !lines.contains(&first)
    {
        lines.insert(0, first);
    }
    lines
}

/// The first line that names what went wrong; of a traceback of Python the line that ends it.
fn first_message(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().map(str::trim_end).filter(|line| !line.trim().is_empty()).collect();
    let is_message = |line: &str| {
        let small = line.to_lowercase();
        !is_of_launcher(line) && WRONG.iter().any(|word| small.contains(word))
    };
    let place = lines.iter().position(|line| line.starts_with(TRACEBACK) || is_message(line))?;
    let line = if lines[place].starts_with(TRACEBACK) {
        lines[place + 1..].iter().find(|line| !line.starts_with([' ', '\t']))?
    } else {
        &lines[place]
    };
    Some(line.trim().chars().take(LONGEST_LINE).collect())
}

/// Whether a line is what MPI says when one of its processes ends.
fn is_of_launcher(line: &str) -> bool {
    let small = line.to_lowercase();
    LAUNCHERS.iter().any(|word| small.contains(word))
        || line.trim().chars().all(|symbol| "-=*".contains(symbol))
}

fn last_words(run: &Finished) -> String {
    let lines = kept_words(run);
    let own: Vec<String> = lines.iter().filter(|line| !is_of_launcher(line)).cloned().collect();
    // Nothing but the launcher's is better than nothing.
    let own = if own.is_empty() { lines } else { own };
    let last = &own[own.len().saturating_sub(TOLD_LINES)..];
    let first = first_message(&run.errors).or_else(|| first_message(&run.output));
    match first.filter(|first| !last.contains(first)) {
        Some(first) => format!(". Its output began: {first}. It ended: {}", last.join(" / ")),
        None if last.is_empty() => String::new(),
        None => format!(". Its output ended: {}", last.join(" / ")),
    }
}

/// Distance between neighbouring samples, over the cell size, from which on a cell between them has none.
const GAP: f64 = 1.5;
/// Distance of the last samples from base and surface, over the cell size, from which on the last cell has none.
const END: f64 = 0.75;
/// Share of a distance that round-off may add.
const ROUND_OFF: f64 = 1e-6;
/// Most outputs that a message names.
const MOST_TIMES: usize = 6;

/// The states at the outputs of a case, one an output; they have equally many samples, unless the mesh changes.
///
/// # Errors
/// What is missing, a sentence.
pub(crate) fn states_at_outputs(
    case: &Case,
    states: &[SampledState],
    has_changing_mesh: bool,
) -> Result<Vec<SampledState>, String> {
    let unit = case.seconds_per_time_factor();
    let nearest = |factor: f64| {
        let off = |state: &&SampledState| (state.time / unit - factor).abs();
        let near = states.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        near.filter(|state| off(state) <= SAME_TIME * factor)
    };
    let found: Vec<Option<&SampledState>> = case.time_factors.iter().map(|factor| nearest(*factor)).collect();
    let missing: Vec<f64> = (case.time_factors.iter().zip(&found))
        .filter_map(|(factor, state)| state.is_none().then_some(*factor))
        .collect();
    if !missing.is_empty() {
        let listed = |factors: &mut dyn Iterator<Item = f64>| {
            factors.take(MOST_TIMES).map(rounded).collect::<Vec<_>>().join(", ")
        };
        let there = if states.is_empty() {
            "it has none".to_owned()
        } else {
            format!("it has {}", listed(&mut states.iter().map(|state| state.time / unit)))
        };
        return Err(format!(
            "there is no state at T_v = {} (within {SAME_TIME} of it); {there}",
            listed(&mut missing.into_iter())
        ));
    }
    let states: Vec<SampledState> = found.into_iter().flatten().cloned().collect();
    match case
        .time_factors
        .iter()
        .zip(&states)
        .find_map(|(factor, state)| lack(case, *factor, state, has_changing_mesh))
    {
        Some(lack) => Err(lack),
        None if has_changing_mesh => Ok(states),
        None => same_counts(case, &states).map_or(Ok(states), Err),
    }
}

/// What the samples of a state leave bare; the cells of a mesh that changes are no measure.
fn lack(case: &Case, time_factor: f64, state: &SampledState, has_changing_mesh: bool) -> Option<String> {
    let when = format!("at T_v = {}", typed(time_factor));
    if let Some(lack) =
        state.beside.iter().find_map(|set| lack(case, time_factor, &set.state, has_changing_mesh))
    {
        return Some(lack);
    }
    if state.repeated > 0 {
        let at = state.repeated_at.as_ref().map_or(String::new(), |at| format!(", the first at {at}"));
        return Some(format!("{when}, {} samples are repeated with different values{at}", state.repeated));
    }
    if state.initial_height.is_empty() {
        // A settlement curve alone has none.
        let has_curve = state.surface_displacement.is_some();
        return (!has_curve).then(|| format!("{when}, there is no sample"));
    }
    if has_changing_mesh {
        return None;
    }
    let column = &case.column;
    let size = case.cell_size();
    // A top cell that is partly filled has its surface where the case puts it.
    let is_held = column.points.is_regular();
    let stretch = bare(&state.initial_height, column.height, size, is_held);
    let of_height = stretch.map(|stretch| ("heights", stretch));
    let is_plane = case.scene.body.is_plane();
    let along = || bare(&state.initial_distance, column.extent(), size, true);
    let of_length = || along().filter(|_| is_plane).map(|stretch| ("distances", stretch));
    let (places, [from, to]) = of_height.or_else(of_length)?;
    Some(format!(
        "{when}, no sample lies between the {places} {} m and {} m, with cells of {} m",
        rounded(from),
        rounded(to),
        rounded(size)
    ))
}

/// The first stretch between 0 and `extent` in which a cell of a size has no sample; the end counts where it is held.
fn bare(places: &[f64], extent: f64, size: f64, is_end_held: bool) -> Option<[f64; 2]> {
    let mut places = places.to_vec();
    places.sort_by(f64::total_cmp);
    let (lowest, highest) = (*places.first()?, *places.last()?);
    let beyond = |distance: f64, share: f64| distance > share * size * (1.0 + ROUND_OFF);
    if beyond(lowest, END) {
        return Some([0.0, lowest]);
    }
    if is_end_held && beyond(extent - highest, END) {
        return Some([highest, extent]);
    }
    places.windows(2).find(|pair| beyond(pair[1] - pair[0], GAP)).map(|pair| [pair[0], pair[1]])
}

/// What to say of states with different numbers of samples.
fn same_counts(case: &Case, states: &[SampledState]) -> Option<String> {
    let first = states.first()?;
    let differs = |state: &SampledState| state.initial_height.len() != first.initial_height.len();
    let place = states.iter().position(differs)?;
    Some(format!(
        "there are {} samples at T_v = {}, and {} at {}",
        states[place].initial_height.len(),
        typed(case.time_factors[place]),
        first.initial_height.len(),
        typed(case.time_factors[0])
    ))
}

/// Largest difference of two results, over the largest value of its field; infinite where they have not the same
/// places, or not the same fields.
pub fn difference(first: &[SampledState], second: &[SampledState]) -> f64 {
    let sets = |states: &[SampledState]| -> Vec<SampledState> {
        let all = states.iter().flat_map(|state| state.sets(Sample::Points));
        all.map(|(_, state)| SampledState { beside: Vec::new(), ..state.clone() }).collect()
    };
    let (first, second) = (&sets(first)[..], &sets(second)[..]);
    let places = |states: &[SampledState]| -> Vec<[Vec<f64>; 2]> {
        states.iter().map(|state| [state.initial_height.clone(), state.initial_distance.clone()]).collect()
    };
    let same_places = places(first) == places(second);
    if !same_places {
        return f64::INFINITY;
    }
    let fields: [fn(&SampledState) -> &[f64]; 5] = [
        |state| &state.pressure,
        |state| &state.effective_stress,
        |state| &state.displacement,
        |state| &state.horizontal_displacement,
        |state| state.surface_displacement.as_slice(),
    ];
    fields.into_iter().map(|field| difference_of_field(first, second, field)).fold(0.0, f64::max)
}

fn difference_of_field(
    first: &[SampledState],
    second: &[SampledState],
    field: fn(&SampledState) -> &[f64],
) -> f64 {
    let counts = |states: &[SampledState]| states.iter().map(|state| field(state).len()).collect::<Vec<_>>();
    if counts(first) != counts(second) {
        return f64::INFINITY;
    }
    let (a, b) = (first.iter().flat_map(field), second.iter().flat_map(field));
    let largest = a.clone().fold(0.0_f64, |most, value| most.max(value.abs()));
    let off = a.zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if off == 0.0 { 0.0 } else { off / largest }
}

#[cfg(test)]
mod tests;
