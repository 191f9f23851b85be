//! The meshes of a contender of the race, from coarse to fine: when there is no need to go on.

use crate::case::Case;
use crate::case::contender::CONTENDERS;
use crate::record::Record;
use crate::record::calibration::cost_of;
use crate::record::race_errors::{NEGLIGIBLE, largest_error};
use std::collections::BTreeMap;

/// Meshes in a row on which a contender may fail before it is given up.
const MOST_FAILURES: usize = 2;

/// Counted cost of a run, s, beyond which no finer mesh is begun: it would take several times as long.
const MOST_WORK: f64 = 0.6;

/// What a mesh came to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mesh {
    /// The largest error, none where the run failed.
    error: Option<f64>,
    /// Counted cost, s.
    cost: f64,
}

/// The meshes of a contender that have run so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refinement {
    /// By cells.
    meshes: BTreeMap<usize, Mesh>,
}

impl Refinement {
    /// Adds a run. The first one on a mesh counts: another one with half its step shows what the step does.
    pub fn add(&mut self, record: &Record) {
        let mesh = || Mesh { error: largest_error(record), cost: cost_of(record) };
        self.meshes.entry(record.case.cells).or_insert_with(mesh);
    }

    /// Whether a case is wanted still: no coarser mesh has arrived or spent the work of a mesh, and not two in a row before
    /// it have failed.
    pub fn wants(&self, case: &Case) -> bool {
        let mut failures = 0;
        for (_, mesh) in self.meshes.range(..case.cells) {
            match mesh.error {
                _ if mesh.cost > MOST_WORK => return false,
                Some(error) if error <= NEGLIGIBLE => return false,
                Some(_) => failures = 0,
                None => failures += 1,
            }
            if failures == MOST_FAILURES {
                return false;
            }
        }
        true
    }
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
pub fn wanted<'a>(missing: Vec<&'a Case>, records: &[Record]) -> Vec<&'a Case> {
    let known = |case: &Case| {
        let contender = CONTENDERS.iter().find(|contender| contender.runs(case));
        let mut refinement = Refinement::default();
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
    fn a_contender_goes_on_until_it_arrives_or_has_failed_twice_in_a_row() {
        let mut record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
             integrator = ['implicit']\ncells = [4]\n",
        )
        .remove(0);
        for (meshes, wanted) in [
            (&[][..], true),
            (&[(4, Some(0.1)), (8, Some(0.0011))], true),
            (&[(4, Some(0.1)), (8, Some(0.001))], false),
            (&[(4, None), (8, Some(0.1))], true),
            (&[(4, None), (8, None)], false),
            (&[(4, None), (8, Some(0.1)), (16, None)], true),
            // What is finer says nothing about a mesh.
            (&[(64, Some(0.0))], true),
        ] {
            let mut refinement = Refinement::default();
            for (cells, error) in meshes {
                refinement.meshes.insert(*cells, Mesh { error: *error, cost: MOST_WORK });
            }
            record.case.cells = 32;
            assert_eq!(refinement.wants(&record.case), wanted, "{meshes:?}");
        }
        let mut spent = Refinement::default();
        spent.meshes.insert(16, Mesh { error: Some(0.1), cost: 1.01 * MOST_WORK });
        assert!(!spent.wants(&record.case));
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
        assert!(!missing.is_empty() && wanted(missing, &report.records).is_empty());
    }
}
