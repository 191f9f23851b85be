//! Tables over several runs: those of attached solvers, and critical time steps.

use crate::measure::statistics::{WallSpread, spread};
use crate::record::{Probe, Record, WallSample};
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_soil::wording::{count_of, short};

/// Ratio of wall to processor time from which the machine was busy or the solver waited.
const BUSY: f64 = 2.0;

/// One row per run of an attached solver: how it ended, what it took, and whether its repeats agree. `None` where no
/// solver is attached.
pub fn attached_table(records: &[Record]) -> Option<Table> {
    let attached: Vec<&Record> = records.iter().filter(|record| record.attached.is_some()).collect();
    if attached.is_empty() {
        return None;
    }
    let busy = attached.iter().filter(|record| is_busy(&record.wall)).count();
    let busy = (busy > 0).then(|| {
        format!(
            "{busy} of {} runs took more than {BUSY} times their processor time: the machine was busy or they waited, so \
             compare processor times",
            attached.len()
        )
    });
    let columns = columns(
        "case | ended | version | > wall, least [s] | > wall, median [s] | > processor [s] | > memory [MB] \
         | > by its own account [s] | > repeats differ by",
    );
    let rows = attached.iter().map(|record| attached_row(record));
    let table = Table::of("Runs of attached solvers", columns, rows).note(
        "wall time: least and median over the repeats; processor time and memory: of the solver and of the processes that \
         it waited for",
    );
    Some(table.notes(busy))
}

fn attached_row(record: &Record) -> Vec<Cell> {
    let about = record.attached.as_ref();
    let wall = over(&record.wall, |sample| Some(sample.seconds));
    let median = |field| over(&record.wall, field).map(|spread| spread.median);
    let mood = match record.status.failure() {
        None => Mood::Pass,
        Some(_) if record.status.is_skipped() => Mood::Note,
        Some(_) => Mood::Fail,
    };
    let not_told = "the system does not report it";
    vec![
        Cell::Code(record.case.label()),
        Cell::Verdict(mood, record.status.name()),
        about.and_then(|about| about.version.as_deref()).unwrap_or("–").into(),
        Cell::of(wall.map(|wall| wall.minimum), Cell::Seconds, "not run"),
        Cell::of(wall.map(|wall| wall.median), Cell::Seconds, "not run"),
        Cell::of(median(|sample| sample.cpu_seconds), Cell::Seconds, not_told),
        Cell::of(over(&record.wall, megabytes).map(|memory| memory.maximum), Cell::Number, not_told),
        Cell::of(median(|sample| sample.own_seconds), Cell::Seconds, "the solver does not report it"),
        Cell::of(about.and_then(|about| about.repeats_differ_by), Cell::Error, "run once"),
    ]
}

/// The spread of a quantity over the samples that have it.
fn over(samples: &[WallSample], field: fn(&WallSample) -> Option<f64>) -> Option<WallSpread> {
    spread(&samples.iter().filter_map(field).collect::<Vec<_>>())
}

fn megabytes(sample: &WallSample) -> Option<f64> {
    sample.peak_memory.map(|bytes| 1e-6 * bytes as f64)
}

/// Whether the wall times of a run are far above its processor times.
fn is_busy(samples: &[WallSample]) -> bool {
    let wall = over(samples, |sample| Some(sample.seconds));
    wall.zip(over(samples, |sample| sample.cpu_seconds))
        .is_some_and(|(wall, cpu)| wall.median > BUSY * cpu.median)
}

/// Sentences on the run of an attached solver: how it failed, what it is, what it took; none for other cases.
pub fn attached_notes(record: &Record) -> Vec<String> {
    let Some(about) = &record.attached else { return Vec::new() };
    let mut notes: Vec<String> = record.status.failure().map(ToString::to_string).into_iter().collect();
    let version = about.version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
    notes.push(if about.command.is_empty() {
        "read from existing files; nothing was run".to_owned()
    } else {
        format!("run by `{}`{version}", about.command.join(" "))
    });
    notes.extend(times(&record.wall));
    let most = about.repeats_differ_by;
    notes.extend(most.map(|most| format!("results of its repeats differ by at most {}", short(most))));
    notes.extend(about.notes.iter().cloned());
    notes.extend(about.taken.iter().map(|taken| format!("taken: {taken}")));
    notes
}

/// Wall times with processor time, memory and load.
fn times(samples: &[WallSample]) -> Option<String> {
    let wall = over(samples, |sample| Some(sample.seconds))?;
    let processor = over(samples, |sample| sample.cpu_seconds);
    let memory = over(samples, megabytes);
    let mut parts = vec![
        format!(
            "wall time at least {} s, median {} s of {}",
            short(wall.minimum),
            short(wall.median),
            count_of(wall.count, "run", "runs")
        ),
        processor.map_or("the system does not report processor time".to_owned(), |processor| {
            format!("processor {} s", short(processor.median))
        }),
        memory.map_or("the system does not report memory".to_owned(), |memory| {
            format!("memory at most {} MB", short(memory.maximum))
        }),
    ];
    let own = over(samples, |sample| sample.own_seconds);
    parts.extend(own.map(|own| format!("{} s by its own account", short(own.median))));
    let load = over(samples, |sample| sample.load);
    parts.extend(load.map(|load| format!("load of the machine {}", short(load.maximum))));
    parts.extend(
        is_busy(samples).then(|| "the machine was busy or it waited: compare processor times".to_owned()),
    );
    Some(parts.join(", "))
}

/// One row per case: predicted and observed critical step, and what the runs beside the limit did.
pub fn critical_steps(records: &[Record]) -> Table {
    let header = "case | > predicted [s] | > observed [s] | > difference | > over h/c | > slow growth from [s] | at 0.97 \
                  | at 1.03";
    let rows = records.iter().filter_map(critical_step_row);
    Table::of("Critical time step, predicted and observed", columns(header), rows).note(
        "predicted: spectral radius of the step operator on the case's own grid; observed: bisection of runs without the \
         prediction, and in a plane of up to 8 × 8 cells of the eigenvalues of its own step, which show a doubling in \
         10 000 steps; c: the fastest undamped wave",
    )
}

fn critical_step_row(record: &Record) -> Option<Vec<Cell>> {
    let found = record.stability.as_ref()?;
    let mut row = vec![
        Cell::Code(record.case.label_without_step()),
        Cell::of(found.known(), Cell::Error, "no limit is known: something grows under any step"),
        Cell::of(found.observed, Cell::Error, "no step was stable"),
        Cell::of(found.known().and(found.deviation()), Cell::Percent, "no step was stable"),
        Cell::Number(found.predicted / found.wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(
        found.probes.iter().map(|probe| Cell::Verdict(Mood::of(probe.is_as_predicted()), probe_words(probe))),
    );
    Some(row)
}

fn probe_words(probe: &Probe) -> String {
    let Some(failure) = &probe.failure else {
        let end = if probe.reaches_end { " to the end" } else { "" };
        return format!("runs {} steps{end}", probe.steps);
    };
    let growth = failure.growth.map_or(String::new(), |seen| {
        let predicted = probe.predicted_growth.map(|predicted| format!(" ({predicted:.4} predicted)"));
        format!(", grows by {seen:.4} a step{}", predicted.unwrap_or_default())
    });
    format!("{} at step {}{growth}", failure.kind.name(), failure.step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_busy_where_its_wall_time_is_far_above_the_processors() {
        let sample = |seconds: f64, cpu: Option<f64>| WallSample {
            seconds,
            cpu_seconds: cpu,
            ..WallSample::default()
        };
        assert!(is_busy(&[sample(2.1, Some(1.0))]));
        assert!(!is_busy(&[sample(1.9, Some(1.0))]));
        assert!(!is_busy(&[sample(9.0, None)]) && !is_busy(&[]));
    }
}
