//! The race: every contender in every situation, by the same study. A situation is a study whose sweeps name the race;
//! a contender has one cell in each.

pub mod grid;
mod measures;

use crate::case::contender::{CONTENDERS, Contender};
use crate::judge::race::grid::{Grid, GridRow, Score};
use crate::judge::race::measures::{Runs, scatter_of, score_of};
use crate::record::Record;
use crate::study::check::Study;
use oedometer_convergence::Class;
use std::collections::BTreeSet;

/// An error of the size of the result itself is no usable result: a body that locks, a pressure that jumps.
pub const USELESS: f64 = 1.0;

/// A situation with one cell per contender.
#[derive(Clone, Debug)]
pub struct RaceRow<'a> {
    /// Its study.
    pub study: &'a Study,
    /// Its group: the first word of its name.
    pub group: &'a str,
    /// The finest mesh that every contender that can run here has run: cells over the height.
    pub cells: usize,
    /// One cell per contender, in their order.
    pub contenders: Vec<RaceCell>,
}

/// How a contender did in a situation; `None` where something was not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct RaceCell {
    /// The contender.
    pub name: &'static str,
    /// Largest errors over the outputs on the common mesh: of pressure, effective stress, and settlement or displacement.
    pub errors: [Option<f64>; 3],
    /// Largest errors on every mesh, with the cell size, m, from coarse to fine.
    pub levels: Vec<(f64, [Option<f64>; 3])>,
    /// Order of the pressure at the output of its largest error, with its class.
    pub order: Option<f64>,
    /// Class of that series.
    pub class: Option<Class>,
    /// Processor seconds to an error of 1 % and of 0.1 %, between meshes by powers.
    pub cost: [Option<f64>; 2],
    /// Oscillation index of the pressure.
    pub oscillation: Option<f64>,
    /// Computed over exact settlement; of a plane one minus the error of the displacement.
    pub locking: Option<f64>,
    /// Critical step over the formula's: observed where the study observes it, predicted in other explicit runs.
    pub step_ratio: Option<f64>,
    /// Asymmetry of the stiffness of skeleton and water, where the study observes the critical step: round-off where the
    /// forces do the power of the stresses.
    pub asymmetry: Option<[f64; 2]>,
    /// What the cell is ranked by: smaller is better. The largest of its errors, what moves at rest, or the formula's step
    /// over the observed one.
    pub score: Option<f64>,
    /// Relative change of the score by half the step.
    pub scatter: Option<f64>,
    /// How the runs ended.
    pub ended: Ended,
    /// What is wrong with a balance of the run on the common mesh, where something is.
    pub complaint: Option<String>,
}

/// How the runs of a cell ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// With a result on every mesh.
    Well,
    /// A run failed: the failure by its name, and the sentence of the run.
    Failed(&'static str, String),
    /// The method cannot do it by its definition, with the reason.
    NotApplicable(String),
}

impl RaceCell {
    /// `ok`, the failure by its name, or `n/a`; and the reason, of a run that ended well what is wrong with its balances.
    pub fn ending(&self) -> (&str, &str) {
        match &self.ended {
            Ended::Well => ("ok", self.complaint.as_deref().unwrap_or_default()),
            Ended::Failed(name, why) => (name, why),
            Ended::NotApplicable(why) => ("n/a", why),
        }
    }
}

impl<'a> RaceRow<'a> {
    /// Its name: that of its study, without the first word `race`.
    pub fn name(&self) -> &'a str {
        self.study.name.strip_prefix("race-").unwrap_or(&self.study.name)
    }

    /// The title of its study, without the word `Race`.
    pub fn title(&self) -> &'a str {
        self.study.title.strip_prefix("Race: ").unwrap_or(&self.study.title)
    }

    /// The situation of a study and its records; `None` where the study is not of the race or nothing has run.
    pub fn of(study: &'a Study, records: &[Record]) -> Option<Self> {
        if !study.is_race || records.is_empty() {
            return None;
        }
        let runs: Vec<(&Contender, Runs<'_>)> =
            CONTENDERS.iter().map(|contender| (contender, Runs::of(study, contender, records))).collect();
        let meshes =
            |runs: &Runs<'_>| runs.path.iter().map(|record| record.case.cells).collect::<BTreeSet<_>>();
        let common = runs.iter().map(|(_, runs)| meshes(runs)).filter(|own| !own.is_empty());
        let cells = common.reduce(|one, other| &one & &other)?.into_iter().next_back()?;
        let contenders =
            runs.iter().map(|(contender, runs)| cell_of(study, contender, runs, cells)).collect();
        let name = study.name.strip_prefix("race-").unwrap_or(&study.name);
        let group = name.split('-').next().unwrap_or_default();
        Some(Self { study, group, cells, contenders })
    }
}

fn cell_of(study: &Study, contender: &Contender, runs: &Runs<'_>, cells: usize) -> RaceCell {
    let refused = study.not_applicable.iter().find(|(name, _)| *name == contender.name);
    let on_mesh = runs.path.iter().copied().find(|record| record.case.cells == cells);
    let ended = match (refused, runs.failure()) {
        (Some((_, why)), _) => Ended::NotApplicable(why.clone()),
        (None, Some((name, why))) => Ended::Failed(name, why),
        (None, None) if on_mesh.is_none() => Ended::NotApplicable("it has not been run".to_owned()),
        (None, None) => Ended::Well,
    };
    let classified = runs.classified();
    RaceCell {
        name: contender.name,
        errors: on_mesh.map_or([None; 3], measures::errors_of),
        levels: runs.path.iter().map(|one| (one.case.cell_size(), measures::errors_of(one))).collect(),
        order: classified.as_ref().and_then(|found| found.order),
        class: classified.as_ref().map(|found| found.class),
        cost: [1e-2, 1e-3].map(|tolerance| runs.cost_to(tolerance)),
        oscillation: on_mesh.and_then(measures::oscillation_of),
        locking: on_mesh.and_then(measures::locking_of),
        step_ratio: on_mesh.and_then(measures::step_ratio_of),
        asymmetry: on_mesh.and_then(|record| record.stability.as_ref()?.asymmetry),
        score: on_mesh.and_then(score_of),
        scatter: runs.two_steps.and_then(|(one, other)| scatter_of(one, other)),
        ended,
        complaint: on_mesh.and_then(measures::complaint_of),
    }
}

/// The scores of situations, to be ranked.
pub fn grid_of(situations: &[RaceRow<'_>]) -> Grid {
    let score = |cell: &RaceCell| match (&cell.ended, cell.score) {
        (Ended::NotApplicable(_), _) => Score::NotApplicable,
        (Ended::Well, Some(value)) if value < USELESS => {
            Score::Value { value, scatter: cell.scatter.unwrap_or(0.0) }
        }
        _ => Score::Failed,
    };
    let row = |one: &RaceRow<'_>| GridRow {
        situation: one.title().to_owned(),
        group: one.group.to_owned(),
        scores: one.contenders.iter().map(score).collect(),
    };
    Grid {
        contenders: CONTENDERS.iter().map(|one| one.name.to_owned()).collect(),
        rows: situations.iter().map(row).collect(),
    }
}
