//! Start checks, balances and dimensionless groups of a study's runs, the worst of each.

use crate::measure::record_checks;
use crate::record::Status;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Table, columns};
use crate::render::tables::measures::bound_cell;

/// The worst of every check over the runs of a study, and the groups of its first run.
pub fn block(results: &StudyResults<'_>) -> Block {
    // Runs that failed have no result to check.
    let sound = results.records.iter().filter(|record| record.status == Status::Ok);
    let mut rows: Vec<Vec<Cell>> = record_checks::worst_of(sound)
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
