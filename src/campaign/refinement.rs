//! The runs of a method of the benchmark: its meshes from coarse to fine until it reaches the tolerance for good, and shorter steps where
//! a result rests on them or a run has failed.

use crate::case::Case;
use crate::case::contender::CONTENDERS;
use crate::measure::record_checks::complaints;
use crate::record::Record;
use crate::record::calibration::cost_of;
use crate::record::race_errors::{ARRIVED, LOOSEST, ROUGH, ReadOut, RunErrors, SMALLEST};
use crate::study::check::Study;
use oedometer_convergence::reached;
use oedometer_soil::elementary;
use std::collections::BTreeMap;

/// Counted cost, s, that a mesh may take in one dimension and in the plane: several times what the cheapest method takes for 1 %
/// in the dearest problem.
pub const MOST_WORK: [f64; 2] = [0.3, 1.0];
/// By how much an order may rise on finer meshes before a method is given up.
const RISE: f64 = 1.0;

/// The errors of a run that the race judges: one that fails a check has not ended well.
pub fn judged_errors(record: &Record) -> RunErrors {
    let errors = RunErrors::of(record);
    RunErrors { is_whole: errors.is_whole && complaints(record).is_empty(), ..errors }
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mesh {
    cells: usize,
    /// The largest error by read-out, none where the run failed.
    errors: [Option<f64>; 2],
    /// Whether it failed while its errors were small.
    grew: bool,
    /// Counted cost, s.
    cost: f64,
}

impl Mesh {
    fn is_within(&self, read_out: ReadOut, tolerance: f64) -> bool {
        self.errors[read_out as usize].is_some_and(|error| error <= tolerance)
    }
}

/// The steps of a study on each mesh: the race's own, its half and its quarter.
pub type StepsOfMesh = BTreeMap<usize, Vec<f64>>;

/// The steps that a study tries on each mesh, the longest first.
pub fn steps_of(study: &Study) -> StepsOfMesh {
    let mut steps = StepsOfMesh::new();
    for planned in &study.planned {
        steps.entry(planned.case.cells).or_default().push(planned.case.time_step.number());
    }
    for numbers in steps.values_mut() {
        numbers.sort_by(|a, b| b.total_cmp(a));
        numbers.dedup();
    }
    steps
}

/// How often the step of a case is halved.
pub fn halvings(steps: &StepsOfMesh, case: &Case) -> usize {
    let longer = |number: &&f64| **number > case.time_step.number();
    steps.get(&case.cells).map_or(0, |numbers| numbers.iter().filter(longer).count())
}

/// The runs of a method so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    steps: StepsOfMesh,
    /// By halvings of the step and cells.
    runs: BTreeMap<(usize, usize), Mesh>,
}

impl Refinement {
    /// Nothing has run of a study.
    pub fn of(study: &Study) -> Self {
        Self { steps: steps_of(study), runs: BTreeMap::new() }
    }

    /// Adds a run.
    pub fn add(&mut self, record: &Record) {
        let cells = record.case.cells;
        let errors = judged_errors(record);
        let small =
            |read_out| errors.largest_reached(read_out, None, None).is_some_and(|error| error <= ROUGH);
        let grew = !errors.is_whole && ReadOut::BOTH.into_iter().any(small);
        let errors = ReadOut::BOTH.map(|read_out| errors.largest(read_out, None, None));
        let mesh = Mesh { cells, errors, grew, cost: cost_of(record) };
        self.runs.insert((halvings(&self.steps, &record.case), cells), mesh);
    }

    /// Whether a case is wanted still, after all coarser meshes and longer steps.
    pub fn wants(&self, case: &Case) -> bool {
        match halvings(&self.steps, case) {
            0 => self.wants_mesh(case.cells, case.column.dimensions),
            halvings => self.wants_step(halvings, case.cells, case.column.dimensions),
        }
    }

    fn wants_mesh(&self, cells: usize, dimensions: usize) -> bool {
        let coarser: Vec<Mesh> = self.runs.range(..(0, cells)).map(|(_, mesh)| *mesh).collect();
        let next = |place: usize| coarser.get(place).map_or(cells, |mesh| mesh.cells);
        (1..=coarser.len()).all(|count| {
            let (last, before) = (coarser[count - 1], count.checked_sub(2).map(|place| coarser[place]));
            predicted_cost(before, last, next(count), dimensions) <= most_work(dimensions)
                && self.goes_on(before, last)
        })
    }

    /// Half the step is taken on the mesh that reaches the tolerance within the budget and on the next, and where the finest mesh fails from
    /// small errors; a quarter where half of it does so too.
    fn wants_step(&self, halvings: usize, cells: usize, dimensions: usize) -> bool {
        let meshes: Vec<Mesh> = (self.runs.range(..(1, 0)).map(|(_, mesh)| *mesh))
            .filter(|mesh| self.wants_mesh(mesh.cells, dimensions))
            .collect();
        let grew = |halvings: usize| self.runs.get(&(halvings, cells)).is_some_and(|mesh| mesh.grew);
        if meshes.last().is_some_and(|last| last.cells == cells) && (0..halvings).all(grew) {
            return true;
        }
        let rests_on_it = |read_out: ReadOut| {
            let holds = |mesh: &Mesh| {
                let halved = self.runs.get(&(1, mesh.cells)).filter(|mesh| mesh.cells < cells);
                mesh.is_within(read_out, ARRIVED) && halved.is_none_or(|run| run.is_within(read_out, ARRIVED))
            };
            let arrival = reached(&meshes.iter().map(holds).collect::<Vec<_>>());
            // The last mesh of the study is beyond the budget.
            let within = arrival.filter(|at| meshes[at.place].cells < self.finest());
            within.is_some_and(|at| meshes[at.place..].iter().take(2).any(|mesh| mesh.cells == cells))
        };
        halvings == 1 && ReadOut::BOTH.into_iter().any(rests_on_it)
    }

    /// Whether a mesh follows the last one and that before. Two failures in a row are enough, and so are two meshes within
    /// the smallest tolerance, however it is read; a method that has not reached it goes on as long as it can.
    fn goes_on(&self, before: Option<Mesh>, last: Mesh) -> bool {
        let Some(before) = before else { return true };
        let is_wanted = |read_out: ReadOut| {
            let place = read_out as usize;
            match (before.errors[place], last.errors[place]) {
                (None, None) => false,
                (Some(coarse), Some(fine)) if coarse.max(fine) <= SMALLEST => false,
                (Some(coarse), Some(fine)) if fine > ARRIVED => {
                    let finer = last.cells as f64 / before.cells as f64;
                    let order = elementary::ln(coarse / fine) / elementary::ln(finer);
                    self.is_in_reach(last.cells, fine, order)
                }
                _ => true,
            }
        };
        ReadOut::BOTH.into_iter().any(is_wanted)
    }

    /// Cells of the finest mesh of the study.
    fn finest(&self) -> usize {
        self.steps.keys().next_back().copied().unwrap_or(0)
    }

    /// Whether an error may fall below 1 %, or, from above 10 %, below the loosest tolerance, on the finest mesh, even if its
    /// order rises yet.
    fn is_in_reach(&self, cells: usize, error: f64, order: f64) -> bool {
        let finer = self.finest().max(cells) as f64 / cells as f64;
        let least = error * elementary::powf(finer, -(order.max(0.0) + RISE));
        least <= if error > ROUGH { LOOSEST } else { ARRIVED }
    }
}

fn most_work(dimensions: usize) -> f64 {
    MOST_WORK[dimensions.clamp(1, 2) - 1]
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

/// Places of the cases of the race that run one after the other: those of each method, from coarse to fine and then with
/// shorter steps.
pub fn ladders(study: &Study, cases: &[&Case]) -> Vec<Vec<usize>> {
    let steps = steps_of(study);
    let mut ladders: Vec<Vec<usize>> = vec![Vec::new(); CONTENDERS.len()];
    let mut others = Vec::new();
    for (place, case) in cases.iter().enumerate() {
        match CONTENDERS.iter().position(|contender| contender.runs(case)) {
            Some(contender) => ladders[contender].push(place),
            None => others.push(vec![place]),
        }
    }
    for ladder in &mut ladders {
        ladder.sort_by_key(|place| (halvings(&steps, cases[*place]), cases[*place].cells));
    }
    ladders.into_iter().filter(|ladder| !ladder.is_empty()).chain(others).collect()
}

/// Of cases without a record those that are wanted, by the records of the others.
pub fn wanted<'a>(study: &Study, missing: Vec<&'a Case>, records: &[Record]) -> Vec<&'a Case> {
    let known = |case: &Case| {
        let contender = CONTENDERS.iter().find(|contender| contender.runs(case));
        let mut refinement = Refinement::of(study);
        let records_of_method =
            records.iter().filter(|record| contender.is_some_and(|candidate| candidate.runs(&record.case)));
        records_of_method.for_each(|record| refinement.add(record));
        refinement
    };
    missing.into_iter().filter(|case| known(case).wants(case)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{RunOptions, run_study, study_of};
    use crate::case::Tier;

    /// A case of the race with 4 to 64 cells and three steps on each.
    fn ladder() -> (Study, Case) {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['race']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16, 32, 64]\n\
                    time_step = [{ growth = 0.1 }, { growth = 0.05 }, { growth = 0.025 }]\n";
        let study = study_of("race-column-short", text);
        let case = study.planned[0].case.clone();
        (study, case)
    }

    /// Runs by halvings, cells, error at both read-outs and counted cost.
    type Given<'a> = &'a [(usize, usize, [Option<f64>; 2], f64)];

    fn wants(given: Given<'_>, halvings: usize, cells: usize) -> bool {
        let (study, mut case) = ladder();
        let mut refinement = Refinement::of(&study);
        for (halvings, cells, errors, cost) in given {
            let mesh = Mesh { cells: *cells, errors: *errors, grew: *errors == [None; 2], cost: *cost };
            refinement.runs.insert((*halvings, *cells), mesh);
        }
        case.cells = cells;
        case.time_step = case.time_step.with_number([0.1, 0.05, 0.025][halvings]);
        refinement.wants(&case)
    }

    #[test]
    fn a_contender_goes_on_until_two_meshes_are_within_fail_or_its_work_is_spent() {
        let free = 1e-6;
        let at = |cells: usize, error: f64| (0, cells, [Some(error); 2], free);
        let fails = |cells: usize| (0, cells, [None; 2], free);
        for (meshes, is_wanted) in [
            (&[][..], true),
            (&[at(4, 0.1), at(8, 0.004)], true),
            (&[at(8, 0.005), at(16, 0.004)], false),
            // Read at the centres it has not reached the tolerance.
            (&[(0, 8, [Some(0.005), Some(0.02)], free), (0, 16, [Some(0.004), Some(0.01)], free)], true),
            (&[at(8, 0.009), at(16, 0.008)], true),
            (&[fails(4), at(8, 0.1)], true),
            (&[fails(8), fails(16)], false),
            (&[fails(4), fails(8), at(16, 0.1)], false),
            (&[at(8, 0.1), fails(16)], true),
            // What is finer says nothing about a mesh.
            (&[at(64, 0.0)], true),
            // From 8 to 64 cells by the order 0.2 + 1 an error falls to a twelfth: 13 % to 1.1 %, below 10 % at least.
            (&[at(4, 0.1494), at(8, 0.13)], true),
            (&[at(4, 0.1379), at(8, 0.0999), at(16, 0.087)], false),
            (&[at(4, 2.0), at(8, 1.9)], false),
            // 62 % to 5.2 %: beyond every tolerance.
            (&[at(4, 0.71), at(8, 0.62)], false),
            // By one mesh a finer one is of the power 2.
            (&[(0, 16, [Some(0.1); 2], 0.24 * MOST_WORK[0])], true),
            (&[(0, 16, [Some(0.1); 2], 0.26 * MOST_WORK[0])], false),
        ] {
            assert_eq!(wants(meshes, 0, 32), is_wanted, "{meshes:?}");
        }
    }

    #[test]
    fn shorter_steps_are_taken_where_an_arrival_rests_on_them_and_where_the_finest_mesh_fails() {
        let run = |halvings: usize, cells: usize, error: Option<f64>| (halvings, cells, [error; 2], 1e-6);
        let meshes =
            [run(0, 4, Some(0.1)), run(0, 8, Some(0.009)), run(0, 16, Some(0.008)), run(0, 32, Some(0.007))];
        let of = |given: Given<'_>, halvings| [4, 8, 16, 32, 64].map(|cells| wants(given, halvings, cells));
        assert_eq!(of(&meshes, 1), [false, true, true, false, false]);
        // Half the step undoes the arrival on 8 cells: that on 16 rests on 16 and 32.
        let undone = [&meshes[..], &[run(1, 8, Some(0.5))]].concat();
        assert_eq!(of(&undone, 1), [false, true, true, true, false]);
        assert_eq!(of(&undone, 2), [false; 5]);
        // An arrival on the last mesh alone is beyond the budget.
        let late = [&meshes[..1], &[run(0, 32, Some(0.02)), run(0, 64, Some(0.009))]].concat();
        assert_eq!(of(&late, 1), [false; 5]);
        let failed = [&meshes[..1], &[run(0, 8, None)]].concat();
        assert_eq!(of(&failed, 1), [false, true, false, false, false]);
        assert_eq!(of(&failed, 2), [false; 5]);
        assert_eq!(of(&[&failed[..], &[run(1, 8, None)]].concat(), 2), [false, true, false, false, false]);
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
        let errors = RunErrors::of(arrived.expect("a record"));
        assert!(errors.largest(ReadOut::Points, None, None).is_some_and(|error| error <= SMALLEST));
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
