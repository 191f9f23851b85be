//! Tables over several runs: those of attached solvers, and critical time steps.

use crate::judge::outside_runs::{BUSY, OutsideRunFinding};
use crate::questions::blocks::stability::CriticalStepFinding;
use crate::record::{Probe, Record};
use crate::render::table::{Cell, Mood, Table, columns};
use oedometer_soil::wording::{count_of, short};

/// One row per run of an attached solver: how it ended, what it took, and whether its repeats agree. `None` where no
/// solver is attached.
pub fn attached_table(outside: &[OutsideRunFinding]) -> Option<Table> {
    if outside.is_empty() {
        return None;
    }
    let busy = outside.iter().filter(|run| run.busy).count();
    let busy = (busy > 0).then(|| {
        format!(
            "{busy} of {} runs took more than {BUSY} times their processor time: the machine was busy or they waited, so \
             compare processor times",
            outside.len()
        )
    });
    let columns = columns(
        "case | ended | made by | > wall, least [s] | > wall, median [s] | > processor [s] | > memory [MB] \
         | > by its own account [s] | > repeats differ by",
    );
    let table = Table::of("Runs of attached solvers", columns, outside.iter().map(attached_row)).note(
        "wall time: least and median over the repeats; processor time and memory: of the solver and of the processes that \
         it waited for",
    );
    Some(table.notes(busy))
}

fn attached_row(run: &OutsideRunFinding) -> Vec<Cell> {
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

/// Sentences on the run of an attached solver: how it failed, what it is, what it took; none for other cases.
pub fn attached_notes(record: &Record, found: Option<&OutsideRunFinding>) -> Vec<String> {
    let (Some(about), Some(found)) = (record.outside_run(), found) else { return Vec::new() };
    let mut notes: Vec<String> = record.status.failure().map(ToString::to_string).into_iter().collect();
    let version = about.version.as_ref().map_or(String::new(), |version| format!(", version {version}"));
    notes.push(if about.command.is_empty() {
        "read from existing files; nothing was run".to_owned()
    } else {
        format!("run by `{}`{version}", about.command.join(" "))
    });
    notes.extend(times(found));
    let most = about.repeats_differ_by;
    notes.extend(most.map(|most| format!("results of its repeats differ by at most {}", short(most))));
    notes.extend(about.notes.iter().cloned());
    notes.extend(about.taken.iter().map(|taken| format!("taken: {taken}")));
    notes
}

/// Wall times with processor time, memory and load.
fn times(found: &OutsideRunFinding) -> Option<String> {
    let (least, median) = found.least_wall.zip(found.median_wall)?;
    let mut parts = vec![
        format!(
            "wall time at least {} s, median {} s of {}",
            short(least),
            short(median),
            count_of(found.timed, "run", "runs")
        ),
        found.processor.map_or("the system does not report processor time".to_owned(), |seconds| {
            format!("processor {} s", short(seconds))
        }),
        found.memory.map_or("the system does not report memory".to_owned(), |megabytes| {
            format!("memory at most {} MB", short(megabytes))
        }),
    ];
    parts.extend(found.reported.map(|seconds| format!("{} s by its own account", short(seconds))));
    parts.extend(found.load.map(|load| format!("load of the machine {}", short(load))));
    parts.extend(found.busy.then(|| "the machine was busy or it waited: compare processor times".to_owned()));
    Some(parts.join(", "))
}

/// One row per case: predicted and observed critical step, and what the runs beside the limit did.
pub fn critical_steps(found: &[CriticalStepFinding]) -> Table {
    let header = "case | > predicted [s] | > observed [s] | > difference | > over h/c | > slow growth from [s] | at 0.97 \
                  | at 1.03";
    let rows = found.iter().map(critical_step_row);
    Table::of("Critical time step, predicted and observed", columns(header), rows).note(
        "predicted: spectral radius of the step operator on the case's own grid; observed: bisection of runs without the \
         prediction, and in a plane of up to 8 × 8 cells of the eigenvalues of its own step, which show a doubling in \
         10 000 steps; where points deform, the smallest predicted of the run and the largest share of it that `solve` runs; c: the \
         fastest undamped wave",
    )
}

fn critical_step_row(found: &CriticalStepFinding) -> Vec<Cell> {
    let (no_limit, not_stable) = ("no limit is known: something grows under any step", "no step was stable");
    let why = if found.predicted.is_none() { no_limit } else { not_stable };
    let mut row = vec![
        Cell::Code(found.case.clone()),
        Cell::of(found.predicted, Cell::Error, no_limit),
        Cell::of(found.observed, Cell::Error, not_stable),
        match found.within {
            Some(within) => Cell::Text(format!("within {:.2} %", 100.0 * within)),
            None => Cell::of(found.deviation, Cell::Percent, why),
        },
        Cell::Number(found.over_wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(
        found.probes.iter().map(|probe| Cell::Verdict(Mood::of(probe.is_as_predicted()), probe_words(probe))),
    );
    row
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
    use crate::judge::outside_runs::outside_runs;
    use crate::questions::blocks::stability::critical_steps;
    use crate::record::{AttachedRun, CriticalStep, Status, WallSample};
    use oedometer_problem::outcome::{Failure, FailureKind};

    fn notes_of(record: &Record) -> Vec<String> {
        attached_notes(record, OutsideRunFinding::new(record).as_ref())
    }

    fn table_of(records: &[Record]) -> Option<Table> {
        attached_table(&outside_runs(records))
    }

    fn record() -> Record {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2]\n";
        crate::campaign::runner::records_of(text).remove(0)
    }

    #[test]
    fn a_limit_that_is_not_known_has_no_difference_and_a_run_beside_it_is_told_by_its_end() {
        let probe = |steps: u64, growth: Option<f64>| Probe {
            share: 1.03,
            step: 0.5,
            steps,
            reaches_end: steps == 7,
            failure: growth.map(|_| {
                let kind = FailureKind::Unstable;
                Failure { kind, step: steps, time: 1.0, growth, reason: String::new() }
            }),
            predicted_growth: (steps == 9).then_some(1.0625),
        };
        let probes = [probe(7, None), probe(8, None), probe(9, Some(1.125)), probe(10, Some(1.25))];
        let words = probes.each_ref().map(probe_words);
        assert_eq!(
            words,
            [
                "runs 7 steps to the end",
                "runs 8 steps",
                "unstable at step 9, grows by 1.1250 a step (1.0625 predicted)",
                "unstable at step 10, grows by 1.2500 a step"
            ]
        );
        let found = |observed: Option<f64>, unknown: Option<&str>| {
            let mut record = record();
            record.stability = Some(CriticalStep {
                predicted: 0.5,
                observed,
                wave_limit: 0.25,
                drag_limit: 1.0,
                combined_limit: 1.0,
                unknown: unknown.map(str::to_owned),
                probes: probes[..2].to_vec(),
                ..CriticalStep::default()
            });
            critical_step_row(&critical_steps(&[record])[0])
        };
        let shown: Vec<String> = found(Some(0.75), None).iter().map(Cell::show).collect();
        assert_eq!(shown[1..6], ["5.00e-1", "7.50e-1", "50.0 %", "2", "–"]);
        let none = Cell::missing("no step was stable");
        assert_eq!(found(None, None)[2..4], [none.clone(), none]);
        let unknown = found(Some(0.75), Some("a reason"));
        let nothing = "no limit is known: something grows under any step";
        assert_eq!((&unknown[1], &unknown[2]), (&Cell::missing(nothing), &Cell::Error(0.75)));
        assert_eq!(unknown[3], Cell::missing(nothing), "a step was stable");
    }

    #[test]
    fn a_run_of_a_solver_is_told_with_its_end_its_command_and_what_the_system_does_not_tell() {
        let sample = |seconds: f64, cpu: Option<f64>, load: f64| WallSample {
            seconds,
            cpu_seconds: cpu,
            load: Some(load),
            ..WallSample::default()
        };
        let mut all = [record(), record(), record(), record()];
        assert!(table_of(&all).is_none() && notes_of(&all[0]).is_empty());
        for record in &mut all[1..] {
            record.outside = Some(AttachedRun::default());
        }
        let failed = |kind: FailureKind| {
            Status::Failed(Failure { kind, step: 0, time: 0.0, growth: None, reason: "why".to_owned() })
        };
        (all[2].status, all[3].status) = (failed(FailureKind::Skipped), failed(FailureKind::TimedOut));
        (all[1].wall, all[2].wall) =
            (vec![sample(5.0, Some(2.0), 3.0), sample(6.0, Some(2.5), 1.5)], Vec::new());
        all[3].wall = vec![sample(1.0, None, 0.5)];
        let table = table_of(&all).expect("three");
        let ends: Vec<String> = table.rows.iter().map(|row| row[1].show()).collect();
        assert_eq!(ends[0], "✓ ok");
        assert!(ends[1].starts_with("• ") && ends[2].starts_with("✗ "), "{ends:?}");
        assert_eq!(
            table.notes[1],
            "1 of 3 runs took more than 2 times their processor time: the machine was busy or they waited, so compare \
             processor times"
        );
        assert_eq!(table.rows[1][3], Cell::missing("not run"));
        assert_eq!(table.rows[2][5], Cell::missing("the system does not report it"));
        assert_eq!(table_of(&all[2..]).expect("two").notes.len(), 1, "none was busy");
        let about = all[1].outside.as_mut().expect("another program's");
        (about.command, about.version) = (["sh", "{case}"].map(str::to_owned).into(), Some("2.1".to_owned()));
        (about.repeats_differ_by, about.notes) = (Some(1e-9), vec!["a note".to_owned()]);
        about.taken = vec!["p from pressure".to_owned()];
        assert_eq!(
            notes_of(&all[1]),
            [
                "run by `sh {case}`, version 2.1",
                "wall time at least 5 s, median 5.5 s of 2 runs, processor 2.25 s, the system does not report memory, load of \
                 the machine 3, the machine was busy or it waited: compare processor times",
                "results of its repeats differ by at most 1e-9",
                "a note",
                "taken: p from pressure"
            ]
        );
        let notes = notes_of(&all[3]);
        assert!(
            notes[0].contains("why") && notes[1] == "read from existing files; nothing was run",
            "{notes:?}"
        );
        let told = "wall time at least 1 s, median 1 s of 1 run, the system does not report processor time, the system does not \
                    report memory, load of the machine 0.5";
        assert_eq!(notes[2..], [told]);
    }
}
