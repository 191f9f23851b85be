//! Tables of predicted and observed critical steps.

use crate::record::{Probe, Record};
use crate::render::table::{Cell, Mood, Table, columns};

/// One row a case: predicted and observed step, and what the runs beside the limit did.
pub fn table_of(records: &[Record]) -> Table {
    let rows = records.iter().filter_map(row_of);
    Table::of(
        "Critical time step, predicted and observed",
        columns(
            "case | > predicted [s] | > observed [s] | > difference | > over h/c | > slow growth from \
             [s] | at 0.97 | at 1.03",
        ),
        rows,
    )
    .note(
        "predicted: spectral radius of the step operator on the case's own grid; observed: \
                     bisection of runs that know nothing of it, and in a plane of up to eight by eight cells of the \
                     eigenvalues of its own step, which show a doubling in ten thousand steps; c: the fastest \
                     undamped wave",
    )
}

fn row_of(record: &Record) -> Option<Vec<Cell>> {
    let found = record.stability.as_ref()?;
    let mut row = vec![
        Cell::Code(record.case.label_without_step()),
        Cell::of(found.known(), Cell::Error, "no limit is known: something grows under any step"),
        Cell::of(found.observed, Cell::Error, "no step left"),
        Cell::of(found.known().and(found.deviation()), Cell::Percent, "no step left"),
        Cell::Number(found.predicted / found.wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(found.probes.iter().map(|probe| {
        let mood = Mood::of(probe.is_as_predicted());
        Cell::Verdict(mood, words(probe))
    }));
    Some(row)
}

fn words(probe: &Probe) -> String {
    match &probe.failure {
        None if probe.reaches_end => format!("runs to the end, {} steps", probe.steps),
        None => format!("runs {} steps", probe.steps),
        Some(failure) => {
            let growth = match (failure.growth, probe.predicted_growth) {
                (Some(seen), Some(predicted)) => {
                    format!(", grows by {seen:.4} a step ({predicted:.4} predicted)")
                }
                (Some(seen), None) => format!(", grows by {seen:.4} a step"),
                _ => String::new(),
            };
            format!("{} at step {}{growth}", failure.kind.name(), failure.step)
        }
    }
}
