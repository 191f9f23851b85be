//! Errors of the methods over Poisson's ratio of the skeleton at the last output.

use crate::case::grouping::grouped;
use crate::case::{Quantity, Sample, SolverName};
use crate::judge::paths::first_error;
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_problem::outcome::Failure;
use std::collections::BTreeSet;

/// The methods of records, each once, in their order.
fn methods_of<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<SolverName> {
    let groups = grouped(records, |record| record.case.method.to_string());
    groups.into_iter().map(|(_, records)| records[0].case.method).collect()
}

/// Fewest values of a sweep.
const LEAST_VALUES: usize = 2;

fn ratio_of(record: &Record) -> f64 {
    record.case.material.poissons_ratio
}

/// The stiffness of the water of most records, the first of equally frequent ones: it must not vary with the ratio.
fn usual_water<'a>(records: impl Iterator<Item = &'a Record>) -> Option<f64> {
    let groups = grouped(records, |record| record.case.material.water_bulk_modulus.to_bits());
    let most = groups.iter().map(|(_, records)| records.len()).max()?;
    groups.into_iter().find(|(_, records)| records.len() == most).map(|(bits, _)| f64::from_bits(bits))
}

/// One method over all ratios.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// The method.
    pub method: SolverName,
    /// At each ratio the relative L2 errors of the nodal displacement and of the pressure at the points.
    pub found: Vec<[Option<f64>; 2]>,
    /// The first value at which the run failed, and how: such a run has no result that could be lost.
    pub failed: Option<(usize, String)>,
}

/// A method keeps its result where displacement and pressure are off by less than this.
pub const KEPT: f64 = 0.1;

impl SweepRow {
    /// The first value of the sweep at which the result of a run that ended is lost; nothing where it is kept at all of
    /// them, and of a value at which the method did not run nothing is known.
    pub fn lost_from(&self) -> Option<usize> {
        let is_kept = |error: &Option<f64>| error.is_some_and(|error| error < KEPT);
        self.found.iter().position(|errors| has_run(errors) && !errors.iter().all(is_kept))
    }
}

/// Whether there is a result at a value.
fn has_run(errors: &[Option<f64>; 2]) -> bool {
    errors.iter().any(Option::is_some)
}

/// Every method over Poisson's ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessSweep {
    /// Cells over the height.
    pub cells: usize,
    /// Values, ascending.
    pub values: Vec<f64>,
    /// Time factor of the output.
    pub time_factor: f64,
    /// One row for each method.
    pub rows: Vec<SweepRow>,
}

impl StiffnessSweep {
    /// The sweep of a study's records on one mesh; `None` where the study has none. Step sizes may
    /// differ: a stiffer skeleton consolidates faster.
    pub fn new(study: &Study, records: &[Record]) -> Option<Self> {
        // The fields under a footing are not unique.
        if !study.scene.measures(Quantity::Pressure) {
            return None;
        }
        let implicit = || records.iter().filter(|record| !record.case.is_explicit());
        let usual = usual_water(implicit())?;
        let begun = || implicit().filter(|record| record.case.material.water_bulk_modulus == usual);
        let swept = begun().filter(|record| record.status == Status::Ok);
        // The mesh and the outputs with which most methods ran in most soils, of equals the finest.
        let mesh = |record: &Record| {
            let times: Vec<u64> = record.case.time_factors.iter().map(|time| time.to_bits()).collect();
            (record.case.cells, record.case.points_per_cell, times)
        };
        let runs = |records: &[&Record]| {
            let run = |record: &&Record| (record.case.method.to_string(), ratio_of(record).to_bits());
            records.iter().map(run).collect::<BTreeSet<_>>().len()
        };
        let meshes = grouped(swept.clone(), |record| mesh(record));
        let (_, shown) = meshes.into_iter().max_by_key(|(mesh, records)| (runs(records), mesh.0, mesh.1))?;
        let hardest = shown.into_iter().max_by(|a, b| ratio_of(a).total_cmp(&ratio_of(b)))?;
        let alike: Vec<&Record> = swept.filter(|record| mesh(record) == mesh(hardest)).collect();
        let failed: Vec<&Record> = begun()
            .filter(|record| record.status.failure().is_some() && mesh(record) == mesh(hardest))
            .collect();
        let both = || alike.iter().chain(&failed).copied();
        let mut values: Vec<f64> = both().map(ratio_of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let methods = methods_of(both());
        // Values at which most methods ran: nothing is said of the others there.
        values.retain(|value| {
            2 * methods_of(both().filter(|record| ratio_of(record) == *value)).len() >= methods.len()
        });
        if values.len() < LEAST_VALUES {
            return None;
        }
        let time_factor = *hardest.case.time_factors.last()?;
        let reference = study.references[0].name();
        let found = |method: SolverName, value: f64| {
            let record =
                alike.iter().find(|record| record.case.method == method && ratio_of(record) == value);
            let error = |quantity, sample| first_error(record?, quantity, sample, reference, time_factor);
            [error(Quantity::Displacement, Sample::Nodes), error(Quantity::Pressure, Sample::Points)]
        };
        let failure = |method: SolverName, value: f64| {
            let is_of = |record: &&&Record| record.case.method == method && ratio_of(record) == value;
            failed.iter().find(is_of)?.status.failure().map(Failure::name_with_step)
        };
        let row = |method: SolverName| SweepRow {
            method,
            found: values.iter().map(|value| found(method, *value)).collect(),
            failed: (0..values.len()).find_map(|place| Some((place, failure(method, values[place])?))),
        };
        let runs = |row: &SweepRow| row.found.iter().filter(|errors| has_run(errors)).count();
        let is_told = |row: &SweepRow| runs(row) >= LEAST_VALUES || row.failed.is_some();
        let rows = methods.into_iter().map(row).filter(is_told).collect();
        Some(Self { cells: hardest.case.cells, values, time_factor, rows })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::study::file::StudySource;
    use oedometer_problem::outcome::FailureKind;

    #[test]
    fn a_sweep_is_of_the_mesh_on_which_most_ran_and_of_equals_the_finest() {
        let values = [0.1, 0.2, 0.3];
        let text = format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
             integrator = ['implicit']\ncells = [4, 16, 8]\npoissons_ratio = {values:?}\n"
        );
        let study = Study::check(&StudySource { name: "s.toml".to_owned(), text: text.clone() });
        let study = study.expect("a sound study");
        let mut records = records_of(&text);
        // An error by which a run is known: its cells, and the place of its value.
        let mark = |cells: usize, place: usize| cells as f64 + 0.1 * place as f64;
        let place_of = |record: &Record| {
            values.iter().position(|value| *value == ratio_of(record)).expect("a value of the sweep")
        };
        for record in &mut records {
            let error = mark(record.case.cells, place_of(record));
            record.errors.iter_mut().for_each(|row| row.value = error);
        }
        let sweep = |records: &[Record]| StiffnessSweep::new(&study, records);
        let cells = |records: &[Record]| sweep(records).map(|found| found.cells);
        for _ in 0..2 {
            let found = sweep(&records).expect("three values");
            assert_eq!((found.cells, &found.values[..]), (16, &values[..]));
            let row = &found.rows[0];
            let expected = [0, 1, 2].map(|place| [Some(mark(16, place)); 2]);
            assert_eq!(row.found, expected);
            records.reverse();
        }
        // Without the run of the finest mesh in the least compressible soil, the next one is shown.
        let without = |skip: &dyn Fn(usize, usize) -> bool| -> Vec<Record> {
            let kept = |record: &&Record| !skip(record.case.cells, place_of(record));
            records.iter().filter(kept).cloned().collect()
        };
        assert_eq!(cells(&without(&|cells, place| cells == 16 && place == 2)), Some(8));
        assert_eq!(cells(&without(&|cells, place| cells > 4 && place == 2)), Some(4));
        assert_eq!(cells(&without(&|cells, place| cells == 16 && place == 0)), Some(8), "two values");
        assert_eq!(cells(&without(&|cells, place| cells < 16 || place == 0)), Some(16), "two are enough");
        let mut failed = records.clone();
        for record in failed.iter_mut().filter(|one| one.case.cells == 16 && place_of(one) == 2) {
            let (kind, reason) = (FailureKind::Unstable, "a test".to_owned());
            record.status = Status::Failed(Failure { kind, step: 1, time: 1.0, growth: None, reason });
        }
        assert_eq!(cells(&failed), Some(8));
        // A failed run is told with its reason, and is no lost result.
        let mut among = records.clone();
        among[1].case.method =
            SolverName::Own(oedometer_problem::method::Method::named("MPM").expect("a method"));
        among[1].case.cells = 16;
        among[1].status =
            failed.iter().find(|one| one.status != Status::Ok).expect("it failed").status.clone();
        let found = sweep(&among).expect("values");
        let row = found.rows.iter().find(|row| row.method.to_string() == "MPM").expect("a row");
        assert_eq!(row.failed.as_ref().map(|(_, how)| how.as_str()), Some("unstable at step 1"), "{row:?}");
        // A soil in another water is in no sweep.
        for record in records.iter_mut().filter(|record| place_of(record) == 2) {
            record.case.material.water_bulk_modulus *= 1.5;
        }
        assert_eq!(sweep(&records).map(|found| found.values.len()), Some(2));
    }

    #[test]
    fn fields_under_a_footing_are_in_no_sweep() {
        let text = "title = 't'\nscene = 'footing'\noutput.time_factors = [0.01]\n[[sweep]]\nmethod = ['GIMP-Bbar']\n\
                    integrator = ['implicit']\ncells = [2]\ntime_step = [{ growth = 0.5 }]\npoissons_ratio = [0.3, 0.4]\n";
        let study = Study::check(&StudySource { name: "s.toml".to_owned(), text: text.to_owned() });
        let found = StiffnessSweep::new(&study.expect("a sound study"), &records_of(text));
        assert_eq!(found, None);
    }
}
