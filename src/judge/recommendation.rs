//! Which runs may be recommended for a tolerance: those on a mesh from which all finer ones stay within it.

use crate::case::Case;
use crate::case::grouping::grouped;
use crate::judge::case_verdicts::recommendable;
use crate::record::Record;
use crate::study::expectation::CaseExpectation;
use oedometer_convergence::reached;
use oedometer_problem::time_step::TimeStep;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Runs with an error each, where it may be quoted.
pub struct QuotedRuns<'a>(Vec<QuotedRun<'a>>);

impl<'a> QuotedRuns<'a> {
    /// The errors of sound runs that meet the expectations of their cases.
    pub fn new(
        records: impl IntoIterator<Item = &'a Record> + Clone,
        expectations: &[CaseExpectation],
        error: impl Fn(&Record) -> Option<f64>,
    ) -> Self {
        let quotable: HashSet<&str> = recommendable(expectations, records.clone());
        let quoted = |record: &'a Record| {
            let error = Some(record).filter(|record| quotable.contains(&*record.hash)).and_then(&error);
            (record, error.map(f64::abs))
        };
        Self(records.into_iter().map(quoted).collect())
    }

    /// Whether the error of a run may be quoted.
    pub fn quotes(&self, record: &Record) -> bool {
        self.0.iter().any(|(other, error)| error.is_some() && other.hash == record.hash)
    }

    /// The runs that reach a tolerance by [`reached`], by their hash, and whether a finer mesh confirms it.
    pub fn reaching(&self, tolerance: f64) -> HashMap<&'a str, bool> {
        let refinements = grouped(self.0.iter().copied(), |(record, _)| on_any_mesh(&record.case));
        refinements.into_iter().flat_map(|(_, runs)| reaching_of(&runs, tolerance)).collect()
    }
}

/// A run and its error that may be quoted.
type QuotedRun<'a> = (&'a Record, Option<f64>);

/// The same of runs that differ in meshes, steps and outputs alone.
fn reaching_of<'a>(runs: &[QuotedRun<'a>], tolerance: f64) -> Vec<(&'a str, bool)> {
    let rules = grouped(runs.iter().copied(), |(record, _)| rule_of(&record.case));
    let meshes: Vec<MeshErrors> = rules.iter().map(|(_, runs)| errors_of_meshes(runs)).collect();
    let reaching = |(place, (_, runs)): (usize, &(String, Vec<QuotedRun<'a>>))| {
        // A mesh without a run by this rule, as where mesh and step are refined together, counts by its best one.
        let mut all: MeshErrors = BTreeMap::new();
        for (cells, error) in meshes.iter().flatten() {
            let best = all.get(cells).copied().flatten();
            all.insert(*cells, [best, *error].into_iter().flatten().min_by(f64::total_cmp));
        }
        all.extend(&meshes[place]);
        let is_within = |error: &Option<f64>| error.is_some_and(|error| error <= tolerance);
        let is_within: Vec<bool> = all.values().map(is_within).collect();
        let coarsest = reached(&is_within).and_then(|level| all.keys().nth(level.place).copied());
        let finest = all.keys().next_back().copied();
        let runs = runs.iter().map(|(record, _)| (record.hash.as_str(), Some(record.case.cells)));
        let reaching = runs.filter(|(_, cells)| coarsest.is_some() && coarsest <= *cells);
        reaching.map(|(hash, cells)| (hash, cells < finest)).collect::<Vec<_>>()
    };
    rules.iter().enumerate().flat_map(reaching).collect()
}

/// By the number of cells the largest error on a mesh; none where a run has none to quote.
type MeshErrors = BTreeMap<usize, Option<f64>>;

fn errors_of_meshes(runs: &[QuotedRun<'_>]) -> MeshErrors {
    let largest = |runs: Vec<QuotedRun<'_>>| {
        let errors: Option<Vec<f64>> = runs.into_iter().map(|(_, error)| error).collect();
        errors?.into_iter().max_by(f64::total_cmp)
    };
    let meshes = grouped(runs.iter().copied(), |(record, _)| record.case.cells);
    meshes.into_iter().map(|(cells, runs)| (cells, largest(runs))).collect()
}

/// A number for what is solved and by whom, whatever the mesh, the steps and the outputs.
fn on_any_mesh(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene);
        (case.cells, case.time_step, case.time_factors) = (seed.cells, seed.time_step, seed.time_factors);
    })
}

/// The rule of the steps; steps given in seconds follow the mesh.
fn rule_of(case: &Case) -> String {
    match case.time_step {
        TimeStep::Seconds(_) => String::new(),
        rule => rule.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of};

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
        integrator = ['implicit']\ncells = [2, 4, 8]\ntime_step = [{ growth = 0.3 }, { growth = 0.2 }]\n";

    /// The cells of the runs that reach 1 %, with a mark where that is unconfirmed, by the errors of both steps on each mesh.
    fn reaching(errors: [[f64; 2]; 3], change: impl Fn(&mut Record)) -> [Vec<String>; 2] {
        let mut records = records_of(STUDY);
        records.iter_mut().for_each(change);
        let step = |record: &Record| usize::from(record.case.time_step == TimeStep::Growth(0.2));
        let error = |record: &Record| Some(errors[record.case.cells.ilog2() as usize - 1][step(record)]);
        records.retain(|record| error(record).is_some_and(f64::is_finite));
        let found = QuotedRuns::new(&records, &[], error).reaching(0.01);
        [0, 1].map(|rule| {
            let of_rule = records.iter().filter(|record| step(record) == rule);
            let told = of_rule.filter_map(|record| {
                let mark = if *found.get(record.hash.as_str())? { "" } else { "?" };
                Some(format!("{}{mark}", record.case.cells))
            });
            told.collect()
        })
    }

    #[test]
    fn a_run_reaches_a_tolerance_with_all_finer_ones_of_its_rule_or_else_the_best_of_others() {
        let none = |_: &mut Record| ();
        let (far, near, absent) = (0.12, 0.006, f64::NAN);
        let list = |cells: &[&str]| cells.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>();
        for (errors, coarse, fine) in [
            ([[near, near], [far, near], [far, near]], &[][..], &["2", "4", "8?"][..]),
            ([[near, near], [near, far], [near, near]], &["2", "4", "8?"], &["8?"]),
            // Mesh and step refined together.
            ([[near, absent], [absent, near], [absent, near]], &["2"], &["4", "8?"]),
            ([[near, absent], [absent, far], [absent, far]], &[], &[]),
            ([[near, absent], [absent, absent], [absent, absent]], &["2?"], &[]),
        ] {
            assert_eq!(reaching(errors, none), [list(coarse), list(fine)], "{errors:?}");
        }
    }

    #[test]
    fn a_run_that_failed_or_is_unsound_confirms_nothing() {
        let near = [[0.001; 2]; 3];
        let on_8 = |change: fn(&mut Record)| {
            move |record: &mut Record| {
                if record.case.cells == 8 {
                    change(record);
                }
            }
        };
        for change in [(|record| record.status = failed_at(1)) as fn(&mut Record), |record| {
            record.balance[0].water_imbalance = 0.164;
        }] {
            assert_eq!(reaching(near, on_8(change)), [Vec::<String>::new(), Vec::new()]);
        }
    }
}
