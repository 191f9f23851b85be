//! Tables of one record.

use crate::case::quantity::{Norm, Quantity};
use crate::measure::record_checks::worst_of;
use crate::measure::soundness;
use crate::questions::checks::{bound_cell, groups_of};
use crate::questions::series::MEASURED;
use crate::record::Record;
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use oedometer_problem::outcome::Failure;
use std::fmt::Write;

/// Errors of a record, start checks and balances, as text.
///
/// # Errors
/// If a table cannot be written.
pub fn table_of(record: &Record, width: usize) -> Result<String, RenderError> {
    let mut text = errors_table(record).to_text(width)?;
    let _ = write!(text, "\n{}", checks_table(record).to_text(width)?);
    Ok(text)
}

/// One row per reference, quantity and sample, one column per time factor: L2 or relative error.
pub fn errors_table(record: &Record) -> Table {
    let case = &record.case;
    let mut columns = columns("reference | quantity | sample");
    columns.extend(
        case.time_factors
            .iter()
            .map(|factor| TableColumn::number(format!("T_v {}", number::time_factor(*factor)))),
    );
    let mut rows = Vec::new();
    for reference in &record.references {
        let is_footing = case.scene.measures(Quantity::LoadFactor);
        for (quantity, sample) in
            MEASURED.into_iter().filter(|one| (one.0 == Quantity::LoadFactor) == is_footing)
        {
            let norm = quantity.first_norm();
            let errors = case.time_factors.iter().map(|factor| {
                match record.error(quantity, sample, norm, &reference.name, *factor) {
                    Some(row) if norm == Norm::Relative => Cell::Percent(row.value),
                    Some(row) => Cell::Error(row.value),
                    None => Cell::Missing(
                        reference.does_not_hold.clone().unwrap_or_else(|| missing_reason(record)),
                    ),
                }
            });
            let mut row: Vec<Cell> =
                vec![Cell::Text(reference.name.clone()), quantity.name().into(), sample.name().into()];
            row.extend(errors);
            rows.push(row);
        }
    }
    Table::of(format!("{}: {}", case.scene.name, case.label()), columns, rows)
        .note(
            "relative L2 error over the places of `sample`, weighted with volume; settlement as \
             s/s_exact − 1",
        )
        .note(work_note(record))
        .notes(case.idle_choices().into_iter().map(str::to_owned))
}

/// Why a relative error has no value.
pub(crate) const NOT_RESOLVED: &str = "the exact value is zero, is negligible against its initial value or \
                                       the load, or is smaller than the round-off of the run or the \
                                       accuracy of the reference";

fn missing_reason(record: &Record) -> String {
    record.status.failure().map_or_else(|| NOT_RESOLVED.to_owned(), Failure::name_with_step)
}

fn work_note(record: &Record) -> String {
    let wall: f64 = record.wall.iter().map(|sample| sample.seconds).sum();
    // No critical step bounds an implicit run.
    let share = if record.case.is_explicit() {
        format!(" ({:.2} of the predicted critical step)", record.groups.step_over_limit)
    } else {
        String::new()
    };
    format!(
        "{} steps of at most {:.3e} s{share}, {} point updates, {wall:.3} s",
        record.counters.steps, record.step_sizes.largest, record.counters.point_updates,
    )
}

/// Start checks, worst balances over all outputs, and dimensionless groups of a record; checks with their bounds.
pub fn checks_table(record: &Record) -> Table {
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut add = |name: &str, value: Cell, bound: Cell| rows.push(vec![name.into(), value, bound]);
    if let Some(start) = &record.start {
        add("points at the start", Cell::Count(start.points as u64), "".into());
    }
    for check in worst_of([record]) {
        add(check.what, Cell::Measured(check.value), bound_cell(&check));
    }
    for row in record.measures.iter().filter(|row| row.time_factor.is_none()) {
        add(&row.name, format!("{:.7}", row.found).into(), format!("exactly {:.7}", row.exact).into());
    }
    for (what, value) in groups_of(record) {
        add(what, Cell::Measured(value), "".into());
    }
    Table::of("checks and groups", columns("what | > value | bound"), rows)
        .notes(soundness::complaints_of_run(record).into_iter().map(|one| format!("✗ {one}")))
}
