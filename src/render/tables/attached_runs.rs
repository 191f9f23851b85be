//! The runs of attached solvers: how each ended, what it took, and whether its repeats agree.

use crate::measure::statistics::spread;
use crate::record::{Record, WallSample};
use crate::render::table::{Cell, Mood, Table, columns};

/// Wall time over processor time from which on a machine was busy, or the solver waited.
const BUSY: f64 = 2.0;

/// One row a run; none where no solver is attached.
pub fn table_of(records: &[Record]) -> Option<Table> {
    let attached: Vec<&Record> = records.iter().filter(|record| record.attached.is_some()).collect();
    if attached.is_empty() {
        return None;
    }
    let mut notes = vec![
        "wall time is the least and the median over the repeats, processor time and memory are those of the solver \
         and of the processes that it waited for"
            .to_owned(),
    ];
    let busy = attached.iter().filter(|record| is_busy(&record.wall)).count();
    if busy > 0 {
        notes.push(format!(
            "{busy} of {} runs took more than {BUSY} times their processor time: the machine was busy, or they waited; \
             compare processor times",
            attached.len()
        ));
    }
    let columns = columns(
        "case | ended | version | > wall, least [s] | > wall, median [s] | > processor [s] | > memory [MB] \
         | > by its own account [s] | > repeats differ by",
    );
    let rows = attached.iter().map(|record| row(record));
    Some(Table::of("Runs of attached solvers", columns, rows).notes(notes))
}

/// Whether the wall times of a run are far beyond what the processor worked.
pub fn is_busy(samples: &[WallSample]) -> bool {
    let wall = median_of(samples, |sample| Some(sample.seconds));
    let cpu = median_of(samples, |sample| sample.cpu_seconds);
    wall.zip(cpu).is_some_and(|(wall, cpu)| wall > BUSY * cpu)
}

fn median_of(samples: &[WallSample], field: fn(&WallSample) -> Option<f64>) -> Option<f64> {
    spread(&samples.iter().filter_map(field).collect::<Vec<_>>()).map(|spread| spread.median)
}

fn row(record: &Record) -> Vec<Cell> {
    let about = record.attached.as_ref();
    let wall = spread(&record.wall.iter().map(|sample| sample.seconds).collect::<Vec<_>>());
    let median = |field| median_of(&record.wall, field);
    let memory = record.wall.iter().filter_map(|sample| sample.peak_memory).max();
    let not_told = "the system does not tell";
    let status = record.status.name();
    vec![
        Cell::Code(record.case.label()),
        match record.status.failure() {
            None => Cell::Verdict(Mood::Pass, status),
            Some(_) if record.status.is_skipped() => Cell::Verdict(Mood::Note, status),
            Some(_) => Cell::Verdict(Mood::Fail, status),
        },
        about.and_then(|about| about.version.as_deref()).unwrap_or("–").into(),
        Cell::of(wall.map(|wall| wall.minimum), Cell::Seconds, "it was not run"),
        Cell::of(wall.map(|wall| wall.median), Cell::Seconds, "it was not run"),
        Cell::of(median(|sample| sample.cpu_seconds), Cell::Seconds, not_told),
        Cell::of(memory.map(|bytes| 1e-6 * bytes as f64), Cell::Number, not_told),
        Cell::of(median(|sample| sample.own_seconds), Cell::Seconds, "it does not say"),
        Cell::of(about.and_then(|about| about.repeats_differ_by), Cell::Error, "it was run once"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_busy_where_its_wall_time_is_far_beyond_the_processors() {
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
