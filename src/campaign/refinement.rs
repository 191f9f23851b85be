//! The meshes of a contender of the race, from coarse to fine, and when refinement ends.

use crate::case::Case;
use crate::case::contender::CONTENDERS;
use crate::record::Record;
use crate::record::calibration::cost_of;
use crate::record::race_errors::{ARRIVED, NEGLIGIBLE, ROUGH, largest_error};
use crate::study::check::Study;
use oedometer_soil::elementary;
use std::collections::BTreeMap;

/// Counted cost, s, that a mesh may take of a contender that has not arrived.
const MOST_WORK: f64 = 1.0;
/// Counted cost, s, that a mesh may take of one that has: it shows that the error stays below 1 %, or reaches 0.1 %.
const MORE_WORK: f64 = 0.1;
/// By how much an order may rise on finer meshes before a contender is given up.
const RISE: f64 = 1.0;

/// What a mesh came to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mesh {
    cells: usize,
    /// The largest error, none where the run failed.
    error: Option<f64>,
    /// Counted cost, s.
    cost: f64,
}

/// The meshes of a contender that have run so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// Cells of the finest mesh that it may take.
    finest: usize,
    /// By cells.
    meshes: BTreeMap<usize, Mesh>,
}

impl Refinement {
    /// Nothing has run of a study.
    pub fn of(study: &Study) -> Self {
        Self { finest: finest_mesh(study), meshes: BTreeMap::new() }
    }

    /// Adds a run. The first one on a mesh counts: another one with half its step shows what the step does.
    pub fn add(&mut self, record: &Record) {
        let cells = record.case.cells;
        let mesh = || Mesh { cells, error: largest_error(record), cost: cost_of(record) };
        self.meshes.entry(cells).or_insert_with(mesh);
    }

    /// Whether a case is wanted still, after all coarser meshes.
    pub fn wants(&self, case: &Case) -> bool {
        let coarser: Vec<Mesh> = self.meshes.range(..case.cells).map(|(_, mesh)| *mesh).collect();
        let next = |place: usize| coarser.get(place).map_or(case.cells, |mesh| mesh.cells);
        (1..=coarser.len()).all(|count| {
            let (last, before) = (coarser[count - 1], count.checked_sub(2).map(|place| coarser[place]));
            let cost = predicted_cost(before, last, next(count), case.column.dimensions);
            self.goes_on(before, last, cost)
        })
    }

    /// Whether a mesh of a predicted cost follows the last one and that before. Two failures in a row are enough; who has
    /// arrived takes cheap meshes to 0.1 %, and who has not those that its budget allows, as long as the line is in reach.
    fn goes_on(&self, before: Option<Mesh>, last: Mesh, cost: f64) -> bool {
        match (last.error, before) {
            (None, Some(Mesh { error: None, .. })) => false,
            (Some(error), _) if error <= NEGLIGIBLE => false,
            (Some(error), _) if error <= ARRIVED => cost <= MORE_WORK,
            (Some(error), Some(Mesh { error: Some(coarse), cells, .. })) => {
                let finer = last.cells as f64 / cells as f64;
                let order = elementary::ln(coarse / error) / elementary::ln(finer);
                cost <= MOST_WORK && self.is_in_reach(last.cells, error, order)
            }
            _ => cost <= MOST_WORK,
        }
    }

    /// Whether an error may fall below 1 %, or first below 10 %, on the finest mesh, even if its order rises yet.
    fn is_in_reach(&self, cells: usize, error: f64, order: f64) -> bool {
        let finer = self.finest as f64 / cells as f64;
        let least = error * elementary::powf(finer, -(order.max(0.0) + RISE));
        least <= if error > ROUGH { ROUGH } else { ARRIVED }
    }
}

/// Cells of the finest mesh that a study of the race allows.
pub fn finest_mesh(study: &Study) -> usize {
    study.planned.iter().map(|planned| planned.case.cells).max().unwrap_or(0)
}

/// Counted cost of a mesh by those of the meshes before it, s: by the power of both, or that of points and steps.
fn predicted_cost(before: Option<Mesh>, last: Mesh, cells: usize, dimensions: usize) -> f64 {
    let usual = dimensions as f64 + 1.0;
    let finer = cells as f64 / last.cells as f64;
    let observed = before.filter(|before| before.cost > 0.0).map(|before| {
        elementary::ln(last.cost / before.cost) / elementary::ln(last.cells as f64 / before.cells as f64)
    });
    last.cost * elementary::powf(finer, observed.map_or(usual, |power| power.clamp(1.0, usual + 1.0)))
}

/// Places of the cases of the race that run one after the other: those of each contender, from coarse to fine.
pub fn ladders(cases: &[&Case]) -> Vec<Vec<usize>> {
    let mut ladders: Vec<Vec<usize>> = vec![Vec::new(); CONTENDERS.len()];
    let mut others = Vec::new();
    for (place, case) in cases.iter().enumerate() {
        match CONTENDERS.iter().position(|contender| contender.runs(case)) {
            Some(contender) => ladders[contender].push(place),
            None => others.push(vec![place]),
        }
    }
    for ladder in &mut ladders {
        ladder.sort_by_key(|place| cases[*place].cells);
    }
    ladders.into_iter().filter(|ladder| !ladder.is_empty()).chain(others).collect()
}

/// Of cases without a record those that are wanted, by the records of the others.
pub fn wanted<'a>(study: &Study, missing: Vec<&'a Case>, records: &[Record]) -> Vec<&'a Case> {
    let known = |case: &Case| {
        let contender = CONTENDERS.iter().find(|contender| contender.runs(case));
        let mut refinement = Refinement::of(study);
        let own = records.iter().filter(|record| contender.is_some_and(|one| one.runs(&record.case)));
        own.for_each(|record| refinement.add(record));
        refinement
    };
    missing.into_iter().filter(|case| known(case).wants(case)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{RunOptions, records_of, run_study, study_of};
    use crate::case::Tier;

    #[test]
    fn a_contender_goes_on_until_it_arrives_fails_twice_is_out_of_reach_or_has_spent_its_work() {
        let mut case = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [4]\n",
        )
        .remove(0)
        .case;
        case.cells = 32;
        let free = 1e-6;
        for (meshes, is_wanted) in [
            (&[][..], true),
            (&[(4, Some(0.1), free), (8, Some(0.0011), free)], true),
            (&[(4, Some(0.1), free), (8, Some(0.001), free)], false),
            (&[(4, None, free), (8, Some(0.1), free)], true),
            (&[(4, None, free), (8, None, free)], false),
            (&[(4, None, free), (8, None, free), (16, Some(0.1), free)], false),
            (&[(4, None, free), (8, Some(0.1), free), (16, None, free)], true),
            // What is finer says nothing about a mesh.
            (&[(64, Some(0.0), free)], true),
            // From 8 to 64 cells by the order 0.2 + 1 an error falls to a twelfth: 13 % to 1.1 %, below 10 % at least.
            (&[(4, Some(0.1149), free), (8, Some(0.1), free)], true),
            (&[(4, Some(0.1494), free), (8, Some(0.13), free)], true),
            (&[(4, Some(0.1379), free), (8, Some(0.0999), free), (16, Some(0.087), free)], false),
            (&[(4, Some(2.0), free), (8, Some(1.9), free)], false),
            (&[(4, Some(0.1), free), (8, Some(0.2), free)], true),
            // By one mesh a finer one is of the power 2, by two of theirs.
            (&[(16, Some(0.1), 0.24)], true),
            (&[(16, Some(0.1), 0.26)], false),
            (&[(16, None, 0.26)], false),
            (&[(8, Some(0.3), 0.24), (16, Some(0.1), 0.48)], true),
            (&[(8, Some(0.3), 0.05), (16, Some(0.1), 0.26)], false),
            (&[(8, Some(0.3), 0.24), (16, Some(0.1), 0.24)], true),
            (&[(8, Some(0.3), 0.24), (16, Some(0.1), 0.52)], false),
            // The mesh before would have been too dear.
            (&[(8, Some(0.3), 0.26), (16, Some(0.1), 0.26)], false),
            (&[(8, Some(0.3), 0.01), (16, Some(0.01), 0.02)], true),
            (&[(8, Some(0.3), 0.1), (16, Some(0.01), 0.2)], false),
        ] {
            let mut refinement = Refinement { finest: 64, meshes: BTreeMap::new() };
            for (cells, error, cost) in meshes {
                refinement.meshes.insert(*cells, Mesh { cells: *cells, error: *error, cost: *cost });
            }
            assert_eq!(refinement.wants(&case), is_wanted, "{meshes:?}");
        }
    }

    #[test]
    fn a_race_runs_until_each_contender_has_arrived_on_any_number_of_threads_and_after_a_stop() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = ['race']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16, 32, 64]\ntime_step = [{ growth = 0.02 }]\n";
        let study = study_of("race-column-short", text);
        let run = |jobs: usize| run_study(&study, &RunOptions::whole(Tier::Full, jobs), None, &|_| {});
        let report = run(1);
        let cells = |name: &str| -> Vec<usize> {
            let of_method = report.records.iter().filter(|record| record.case.method.to_string() == name);
            of_method.map(|record| record.case.cells).collect()
        };
        // Of first order on the column: 0.1 % is beyond 64 cells.
        assert_eq!(cells("GIMP"), [4, 8, 16, 32, 64]);
        let last = *cells("GC-SRI-patch").last().expect("it ran");
        assert!(last < 64, "{last}");
        let arrived = report
            .records
            .iter()
            .find(|record| record.case.cells == last && record.case.method.to_string() == "GC-SRI-patch");
        assert!(largest_error(arrived.expect("a record")).is_some_and(|error| error <= NEGLIGIBLE));
        let hashes =
            |records: &[Record]| records.iter().map(|record| record.hash.clone()).collect::<Vec<_>>();
        assert_eq!(hashes(&report.records), hashes(&run(3).records));
        assert_eq!(report.tally.recorded, report.records.len());
        // What is not there is not wanted.
        let all = study.cases(Tier::Full);
        let missing: Vec<&Case> = all
            .iter()
            .copied()
            .filter(|case| report.records.iter().all(|record| record.case != **case))
            .collect();
        assert!(!missing.is_empty() && wanted(&study, missing, &report.records).is_empty());
    }
}
