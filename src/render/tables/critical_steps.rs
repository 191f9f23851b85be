//! Tables of predicted and observed critical steps.

use crate::record::{Probe, Record};
use crate::render::table::{Cell, Mood, Table, TableColumn};

/// One row a case: predicted and observed step, and what the runs beside the limit did.
pub fn table_of(records: &[Record]) -> Table {
    let rows = records.iter().filter_map(row_of).collect();
    Table {
        title: "Critical time step, predicted and observed".to_owned(),
        columns: vec![
            TableColumn::text("case"),
            TableColumn::number("predicted").unit("s"),
            TableColumn::number("observed").unit("s"),
            TableColumn::number("difference"),
            TableColumn::number("over h/c"),
            TableColumn::number("slow growth from").unit("s"),
            TableColumn::text("at 0.97"),
            TableColumn::text("at 1.03"),
        ],
        rows,
        notes: vec![
            "predicted: spectral radius of the step operator on the case's own grid; observed: bisection of runs that \
             know nothing of it; c: the fastest undamped wave"
                .to_owned(),
        ],
    }
}

fn row_of(record: &Record) -> Option<Vec<Cell>> {
    let found = record.stability.as_ref()?;
    let missing = || Cell::Missing("no step left".to_owned());
    let mut row = vec![
        Cell::Code(record.case.label_without_step()),
        Cell::Error(found.predicted),
        found.observed.map_or_else(missing, Cell::Error),
        found.deviation().map_or_else(missing, Cell::Percent),
        Cell::Number(found.predicted / found.wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(found.probes.iter().map(|probe| {
        let mood = if probe.is_as_predicted() { Mood::Pass } else { Mood::Fail };
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
