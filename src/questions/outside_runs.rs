//! How did attached solvers run? How each run ended, what it took, and whether its repeats agree.

use crate::campaign::taken_over::TakenOver;
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::{WallSpread, spread};
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{Record, WallSample};
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};

/// How did attached solvers run?
pub static OUTSIDE_RUNS: Question = Question {
    id: "outside-runs",
    heading: "How did attached solvers run?",
    template: include_str!("outside_runs.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Ratio of wall to processor time from which the machine was busy or the solver waited.
const BUSY: f64 = 2.0;

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Runs of attached solvers.
    runs: usize,
    /// Those that ended well.
    ended: usize,
    /// Those that took more than so many times their processor time.
    busy: usize,
    /// How many times.
    busy_ratio: f64,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let table = table(one.records).unless_empty()?.notes(TakenOver::sentences(&one.check.taken_over));
    let of_others = || one.records.iter().filter(|record| record.outside_run().is_some());
    let facts = Facts {
        runs: table.rows.len(),
        ended: of_others().filter(|record| record.status.failure().is_none()).count(),
        busy: of_others().filter(|record| is_busy(&record.wall)).count(),
        busy_ratio: BUSY,
    };
    Some(OUTSIDE_RUNS.answer([one.study.name.as_str()], &facts).with(Block::Table(table)))
}

/// One row per run: how it ended, what it took, and whether its repeats agree.
pub fn table(records: &[Record]) -> Table {
    let header = "case | ended | made by | > wall, least [s] | > wall, median [s] | > processor [s] | > memory [MB] \
                  | > by its own account [s] | > repeats differ by";
    Table::of("Runs of attached solvers", columns(header), records.iter().filter_map(row))
        .file("outside-runs")
        .note(
            "wall time: least and median over the repeats; processor time and memory: of the solver and of the processes \
             that it waited for",
        )
}

fn row(record: &Record) -> Option<Vec<Cell>> {
    let about = record.outside_run()?;
    let mood = match record.status.failure() {
        None => Mood::Pass,
        Some(_) if record.status.is_skipped() => Mood::Note,
        Some(_) => Mood::Fail,
    };
    let wall = over(&record.wall, |sample| Some(sample.seconds));
    let median = |field| over(&record.wall, field).map(|spread| spread.median);
    let memory = over(&record.wall, |sample| sample.peak_memory.map(|bytes| 1e-6 * bytes as f64));
    let not_told = "the system does not report it";
    Some(vec![
        Cell::Code(record.case.label()),
        Cell::Verdict(mood, record.status.name().to_owned()),
        about.made_by().replace('`', "").into(),
        Cell::of(wall.map(|wall| wall.minimum), Cell::Measured, "not run"),
        Cell::of(wall.map(|wall| wall.median), Cell::Measured, "not run"),
        Cell::of(median(|sample| sample.cpu_seconds), Cell::Measured, not_told),
        Cell::of(memory.map(|memory| memory.maximum), Cell::Number, not_told),
        Cell::of(median(|sample| sample.own_seconds), Cell::Measured, "the solver does not report it"),
        Cell::of(about.repeats_differ_by, Cell::Error, "run once"),
    ])
}

/// The spread of a quantity over the samples that have it.
fn over(samples: &[WallSample], field: fn(&WallSample) -> Option<f64>) -> Option<WallSpread> {
    spread(&samples.iter().filter_map(field).collect::<Vec<_>>())
}

/// Whether the wall times of a run are far above its processor times.
fn is_busy(samples: &[WallSample]) -> bool {
    let wall = over(samples, |sample| Some(sample.seconds));
    wall.zip(over(samples, |sample| sample.cpu_seconds))
        .is_some_and(|(wall, cpu)| wall.median > BUSY * cpu.median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::record::{AttachedRun, Status};
    use oedometer_problem::outcome::{Failure, FailureKind};

    #[test]
    fn runs_are_told_with_their_ends_and_those_that_waited_are_counted() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2, 3, 4, 5]\n";
        let (study, mut records) = solved("s", text);
        let found = |records: &[_]| ask(&[StudyResults::new(&study, records, Tier::Full)]);
        assert_eq!(found(&records), None);
        for record in &mut records[1..] {
            record.outside = Some(AttachedRun::default());
        }
        let failed = |kind: FailureKind| {
            Status::Failed(Failure { kind, step: 0, time: 0.0, growth: None, reason: "why".to_owned() })
        };
        (records[2].status, records[3].status) =
            (failed(FailureKind::Skipped), failed(FailureKind::TimedOut));
        let sample = |seconds: f64, cpu_seconds: Option<f64>| {
            vec![WallSample { seconds, cpu_seconds, ..WallSample::default() }]
        };
        (records[1].wall, records[2].wall) = (sample(5.0, Some(2.0)), Vec::new());
        records[3].wall = sample(1.0, None);
        let answer = found(&records).expect("three");
        assert_eq!(
            answer.sentence().expect("a sentence"),
            "1 of 3 runs of attached solvers succeeded. The wall time of 1 exceeds 2 times the processor \
             time: the machine was busy or the solver waited, so compare processor times."
        );
        let table = answer.tables()[0];
        let ends: Vec<String> = table.rows.iter().map(|row| row[1].show()).collect();
        assert_eq!(ends[0], "✓ ok");
        assert!(ends[1].starts_with("• ") && ends[2].starts_with("✗ "), "{ends:?}");
        assert_eq!(table.rows[1][3], Cell::missing("not run"));
        assert_eq!(table.rows[2][5], Cell::missing("the system does not report it"));
    }

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
