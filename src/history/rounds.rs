//! Runs two commands of an attached solver in alternating rounds on the cases of a study.

use crate::campaign::runner::{RunOptions, run_study};
use crate::case::tier::Tier;
use crate::golden::compare::compare;
use crate::history::state::{State, StudyState};
use crate::record::{Record, Status};
use crate::study::check::Study;
use std::collections::BTreeMap;

/// The study with a command in place of that of its one solver, and with the cases of that solver alone. The command is
/// words with blanks between them and the placeholders of `[[solver]]`.
///
/// # Errors
/// When the study attaches no solver or several, or the command is empty.
pub(crate) fn with_command(study: &Study, command: &str) -> Result<Study, String> {
    let mut study = study.clone();
    let [solver] = study.solvers.as_mut_slice() else {
        let count = study.solvers.len();
        return Err(format!(
            "{} attaches {count} solvers: a command stands for the one `[[solver]]` of a study",
            study.name
        ));
    };
    solver.command = command.split_whitespace().map(str::to_owned).collect();
    if solver.command.is_empty() {
        return Err(
            "the command is empty: give a program with its arguments, like `python3 new.py {case} {out}`"
                .to_owned(),
        );
    }
    // Nothing of a result that is there already, one run a round, and no version of another program.
    (solver.repeats, solver.warm_up) = (1, false);
    (solver.files, solver.version) = (Vec::new(), Vec::new());
    study.planned.retain(|planned| planned.case.is_attached());
    Ok(study)
}

/// The states of two commands after some rounds: the values are those of the first round, the times those of all. Every
/// other round begins with the second command, so that a machine that slows down slows both.
pub(crate) fn states_of_commands(study: &[Study; 2], names: [&str; 2], rounds: usize) -> [State; 2] {
    let mut states =
        names.map(|name| State { name: format!("`{name}`"), studies: BTreeMap::new(), notes: Vec::new() });
    for round in 0..rounds {
        for side in if round % 2 == 0 { [0, 1] } else { [1, 0] } {
            let report = run_study(&study[side], &RunOptions::whole(Tier::Full, 1), None, &|_| {});
            let failed = report.records.iter().filter(|record| record.status != Status::Ok);
            let failed = failed.map(|record| format!("{}: {}", record.case.label(), record.status.name()));
            let told = report.errors.iter().map(ToString::to_string).chain(failed);
            if round == 0 {
                let name = states[side].name.clone();
                states[side].notes.extend(told.map(|what| format!("{name}: {what}")));
            }
            states[side].add_round(&study[side].name, &report.records);
        }
    }
    states
}

impl State {
    /// Takes the values of the first round and the times of each.
    fn add_round(&mut self, study: &str, records: &[Record]) {
        let found = StudyState::of_records(study, records);
        let Some(first) = self.studies.get_mut(study) else {
            self.studies.insert(study.to_owned(), found);
            return;
        };
        let others = compare(&first.golden, &found.golden.values).len();
        if others > 0 {
            self.notes.push(format!("{}: {others} values of {study} differ from round to round", self.name));
        }
        for (case, seconds) in found.seconds {
            first.seconds.entry(case).or_default().extend(seconds);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    #[test]
    fn a_round_adds_its_times_to_those_of_the_first_and_tells_values_that_differ() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\ncells = [2]\n\
             integrator = ['implicit']\ntime_step = [{ growth = 0.5 }]\n",
        );
        let mut state = State { name: "now".to_owned(), studies: BTreeMap::new(), notes: Vec::new() };
        let mut round = |records: &[Record]| {
            state.add_round("t", records);
            let times: usize = state.studies["t"].seconds.values().map(Vec::len).sum();
            (times, state.notes.len())
        };
        let (once, _) = round(&records);
        assert!(once > 0);
        assert_eq!(round(&records), (2 * once, 0));
        records[0].errors[0].value *= 2.0;
        records[0].errors[0].absolute *= 2.0;
        assert_eq!(round(&records), (3 * once, 1));
    }
}
