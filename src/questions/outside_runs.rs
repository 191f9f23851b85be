//! How did attached solvers run? How each run ended, what it took, and whether its repeats agree.

use crate::campaign::taken_over::TakenOver;
use crate::judge::outside_runs::{BUSY, OutsideRunFinding, outside_runs};
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
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
    let runs = outside_runs(one.records);
    if runs.is_empty() {
        return None;
    }
    let count = |is: fn(&OutsideRunFinding) -> bool| runs.iter().filter(|run| is(run)).count();
    let facts = Facts {
        runs: runs.len(),
        ended: count(|run| !run.failed),
        busy: count(|run| run.busy),
        busy_ratio: BUSY,
    };
    let table = table(&runs).notes(TakenOver::sentences(&one.check.taken_over));
    Some(OUTSIDE_RUNS.answer([one.study.name.as_str()], &facts).with(Block::Table(table)))
}

/// One row per run: how it ended, what it took, and whether its repeats agree.
pub fn table(runs: &[OutsideRunFinding]) -> Table {
    let header = "case | ended | made by | > wall, least [s] | > wall, median [s] | > processor [s] | > memory [MB] \
                  | > by its own account [s] | > repeats differ by";
    Table::of("Runs of attached solvers", columns(header), runs.iter().map(row)).file("outside-runs").note(
        "wall time: least and median over the repeats; processor time and memory: of the solver and of the processes that \
         it waited for",
    )
}

fn row(run: &OutsideRunFinding) -> Vec<Cell> {
    let mood = match (run.failed, run.skipped) {
        (false, _) => Mood::Pass,
        (true, true) => Mood::Note,
        (true, false) => Mood::Fail,
    };
    let not_told = "the system does not report it";
    vec![
        Cell::Code(run.case.clone()),
        Cell::Verdict(mood, run.status.clone()),
        run.made_by.as_str().into(),
        Cell::of(run.least_wall, Cell::Seconds, "not run"),
        Cell::of(run.median_wall, Cell::Seconds, "not run"),
        Cell::of(run.processor, Cell::Seconds, not_told),
        Cell::of(run.memory, Cell::Number, not_told),
        Cell::of(run.reported, Cell::Seconds, "the solver does not report it"),
        Cell::of(run.repeats_differ_by, Cell::Error, "run once"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::record::{AttachedRun, Status, WallSample};
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
}
