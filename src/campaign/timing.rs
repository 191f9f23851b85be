//! Times the cases of a study alone.

use crate::campaign::case_runner::CaseRunner;
use crate::campaign::run_report::{Progress, RunError};
use crate::campaign::stop;
use crate::case::Task;
use crate::case::work_estimate::estimated_work;
use crate::record::store::RecordStore;
use crate::record::{Record, Status};
use crate::study::check::Study;

/// Repeats of a case that takes long end here: their spread is small, and they would make the study
/// wait for what it knows.
const REPEATS_OF_LONG_CASES: usize = 3;
/// Seconds beyond which the repeats of a case took long.
const LONG_REPEATS: f64 = 0.1;

/// Whether the wall time of a case is not known yet as well as its study asks.
fn wants_timing(record: &Record, repeats: usize) -> bool {
    let wall = record.wall_alone();
    let is_long = wall.iter().sum::<f64>() > LONG_REPEATS;
    let enough = if is_long { repeats.min(REPEATS_OF_LONG_CASES) } else { repeats };
    let is_solved = record.case.task == Task::Solve;
    is_solved && record.status == Status::Ok && wall.len() < enough
}

/// Times the cases of records alone, in rounds over all of them, until each has the study's number
/// of samples: what drifts on the machine meets every case alike.
///
/// # Errors
/// When a case cannot be run or its times not be kept.
pub fn time_study(
    study: &Study,
    records: &mut [Record],
    store: Option<&RecordStore>,
    tell: &(dyn Fn(Progress) + Sync),
) -> Result<(), RunError> {
    let runner = CaseRunner::of(study);
    let mut is_timed = false;
    for _ in 0..study.timing_repeats {
        for record in &mut *records {
            if stop::is_asked() || !wants_timing(record, study.timing_repeats) {
                continue;
            }
            let timed = runner
                .time_alone(&record.case, store)
                .map_err(|source| RunError::Case { label: record.case.label(), source })?;
            if timed.is_empty() {
                continue;
            }
            record.wall.extend(timed);
            is_timed = true;
            tell(Progress::Advanced(estimated_work(&record.case)));
        }
    }
    if let Some(store) = store.filter(|_| is_timed) {
        for record in &*records {
            store.write_wall(record)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    fn record(task: &str) -> Record {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\ntask = \"{task}\"\noutput = {{ time_factors = [0.001] }}\n\
             sweep = [{{ method = [\"GIMP\"], cells = [2], time_step = [{{ stable = 0.8 }}] }}]\n"
        );
        records_of(&text).remove(0)
    }

    #[test]
    fn what_is_solved_is_timed_as_often_as_asked_and_what_takes_long_three_times() {
        let mut solved = record("solve");
        solved.wall.clear();
        for (seconds, repeats) in [(0.001, 12), (0.06, 3), (0.022, 5)] {
            solved.wall.clear();
            while wants_timing(&solved, 12) {
                solved.wall.push(WallSample { seconds, alone: true, ..WallSample::default() });
            }
            assert_eq!(solved.wall.len(), repeats, "{seconds} s");
        }
        assert!(!wants_timing(&record("stability"), 12), "a search has no time of its own");
    }
}
