//! Start checks, balances and dimensionless groups of a study's runs, the worst of each.

use crate::measure::record_checks;
use crate::measure::record_checks::RecordCheck;
use crate::record::{Record, Status};
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};
use crate::render::tables::measures::bound_cell;

/// The worst of every check over the runs of a study, and the groups of its first run.
pub fn block(results: &StudyResults<'_>) -> Block {
    let mut rows: Vec<Vec<Cell>> = worst_of(results.records)
        .iter()
        .map(|check| vec![check.what.into(), Cell::Error(check.value.abs()), bound_cell(check)])
        .collect();
    if let Some(record) = results.records.first() {
        let groups = &record.groups;
        for (what, value) in [
            ("storage of the water n E_oed/K_w", groups.storage),
            ("finite strain m_vl q", groups.finite_strain),
            ("inertia c_v/(H V)", groups.inertia),
        ] {
            rows.push(vec![what.into(), Cell::Error(value), Cell::Text(String::new())]);
        }
    }
    let table =
        Table::of("Start checks, balances and groups", columns("what | > worst of all runs | bound"), rows)
            .note(
                "Pressures recovered over a patch of cells (`-patch`) do not conserve the stored water exactly: the imbalance falls with the mesh. \
             An equilibrium residual of zero proves nothing: with one value a cell both stresses can be wrong \
             by the same amount.",
            );
    Block::Details {
        summary: "Start checks, balances and dimensionless groups".to_owned(),
        blocks: vec![Block::Table(table)],
    }
}

/// Of every check the one nearest to its bound, or the farthest beyond it, in the order of a record's;
/// of those that no run judges the largest. Runs that failed have no result to check.
fn worst_of(records: &[Record]) -> Vec<RecordCheck> {
    let mut worst: Vec<RecordCheck> = Vec::new();
    for record in records.iter().filter(|record| record.status == Status::Ok) {
        let at_outputs =
            record.balance.iter().flat_map(|balance| record_checks::balance_checks(record, balance));
        for check in record_checks::start_checks(record).into_iter().chain(at_outputs) {
            match worst.iter_mut().find(|other| other.what == check.what) {
                Some(other) if is_worse(&check, other) => *other = check,
                Some(_) => {}
                None => worst.push(check),
            }
        }
    }
    worst
}

/// Whether a check says more against its run than another of the same kind; what is judged says more
/// than what is not, and what is no number most of all.
fn is_worse(one: &RecordCheck, other: &RecordCheck) -> bool {
    let size = |check: &RecordCheck| match check.bound {
        _ if check.value.is_nan() => (check.bound.is_some(), f64::INFINITY),
        Some(bound) if bound > 0.0 => (true, check.value.abs() / bound),
        Some(_) => (true, if check.holds() { 0.0 } else { f64::INFINITY }),
        None => (false, check.value.abs()),
    };
    size(one) > size(other)
}
