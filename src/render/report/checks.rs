//! Start checks, balances and dimensionless groups of a study's runs, the worst of each.

use super::StudyResults;
use crate::record::Record;
use crate::render::page::Block;
use crate::render::table::{Cell, Column, Table};

/// The worst of every check over the runs of a study, and the groups of its first run.
pub fn block(results: &StudyResults<'_>) -> Block {
    let worst = |of: &dyn Fn(&Record) -> Option<f64>| {
        let sizes = results.records.iter().filter_map(|record| of(record).map(f64::abs));
        sizes.fold(0.0, f64::max)
    };
    let balance = |of: fn(&crate::record::Balance) -> f64| {
        worst(&|record: &Record| record.balance.iter().map(|one| of(one).abs()).reduce(f64::max))
    };
    let wrong_points = results.records.iter().filter_map(|record| record.start.as_ref());
    let wrong_points = wrong_points.filter(|start| start.points != start.points_expected).count();
    let mut rows: Vec<Vec<Cell>> = vec![
        vec!["runs with a wrong number of points".into(), Cell::Count(wrong_points as u64)],
        vec![
            "volume at the start, relative error".into(),
            Cell::Error(worst(&|record| record.start.map(|start| start.volume_error))),
        ],
        vec![
            "undrained pressure against q/(1 + n E_oed/K_w), over q".into(),
            Cell::Error(worst(&|record| record.start.map(|start| start.undrained_pressure_error))),
        ],
        vec![
            "unbalanced force at the start, over the load".into(),
            Cell::Error(worst(&|record| record.start.map(|start| start.unbalanced_force))),
        ],
        vec!["mass of solids, drift".into(), Cell::Error(balance(|one| one.solid_mass_drift))],
        vec!["water balance, over the outflow".into(), Cell::Error(balance(|one| one.water_imbalance))],
        vec![
            "sum of internal forces, relative".into(),
            Cell::Error(balance(|one| one.internal_force_imbalance)),
        ],
        vec!["equilibrium (σ' − p + q)/q, rms".into(), Cell::Error(balance(|one| one.equilibrium_residual))],
    ];
    if let Some(record) = results.records.first() {
        let groups = &record.groups;
        rows.push(vec!["storage of the water n E_oed/K_w".into(), Cell::Error(groups.storage)]);
        rows.push(vec!["finite strain m_vl q".into(), Cell::Error(groups.finite_strain)]);
        rows.push(vec!["inertia c_v/(H V)".into(), Cell::Error(groups.inertia)]);
    }
    let table = Table {
        title: "Start checks, balances and groups".to_owned(),
        columns: vec![Column::text("what"), Column::number("worst of all runs")],
        rows,
        notes: vec![
            "A patch does not conserve the water's storage exactly: its imbalance falls with the mesh. A zero \
             equilibrium residual is no evidence: constant recovery leaves both stresses wrong alike."
                .to_owned(),
        ],
    };
    Block::Details {
        summary: "Start checks, balances and dimensionless groups".to_owned(),
        blocks: vec![Block::Table(table)],
    }
}
