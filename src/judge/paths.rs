//! Groups the records of a study into paths along an axis, with their series of errors.

use crate::case::grouping::grouped;
use crate::case::{Quantity, Sample};
use crate::judge::error_place::place_in_kept;
use crate::measure::fields::relative_error;
use crate::record::{Record, Status};
use crate::study::expectation::{Axis, Measure, NEXT_FINER, NO_REFERENCE};
use oedometer_convergence::{
    Classification, ErrorSeries, SeriesDemand, SeriesLevel, Undefined, classify, finest_order, pair_orders,
};
use oedometer_problem::integrator::IntegratorKind;
use oedometer_soil::material::Material;
use std::collections::HashMap;

/// The records of one path through a study: equal in everything but the axis.
#[derive(Clone, Debug)]
pub struct Path<'a> {
    /// What is refined.
    pub axis: Axis,
    /// Records from coarse to fine.
    pub records: Vec<&'a Record>,
    /// Of a path over meshes, the run on its finest mesh with the smallest step, where one is smaller than that of the
    /// path.
    pub smaller_step: Option<&'a Record>,
}

/// A series of errors with its orders and class.
#[derive(Clone, Debug)]
pub struct SeriesSummary<'a> {
    /// The runs.
    pub path: Path<'a>,
    /// Which error.
    pub measure: Measure,
    /// Sizes and absolute values of the errors.
    pub series: ErrorSeries,
    /// Orders between neighbours.
    pub pairs: Vec<Result<f64, Undefined>>,
    /// Order on the finest window.
    pub finest: Result<f64, Undefined>,
    /// Class, reason and floor.
    pub classification: Classification,
}

/// The paths of some records along every axis, made once.
#[derive(Clone, Debug)]
pub struct StudyPaths<'a> {
    along: [Vec<Path<'a>>; Axis::ALL.len()],
}

impl<'a> StudyPaths<'a> {
    /// The paths of records.
    pub fn of(records: &'a [Record]) -> Self {
        Self { along: Axis::ALL.map(|axis| paths(records, axis)) }
    }

    /// The paths along an axis.
    pub fn along(&self, axis: Axis) -> &[Path<'a>] {
        Axis::ALL.iter().position(|one| *one == axis).map_or(&[], |place| &self.along[place])
    }
}

/// Paths of the records along an axis: every group of at least two levels.
pub fn paths<'a>(records: impl IntoIterator<Item = &'a Record>, axis: Axis) -> Vec<Path<'a>> {
    // By a number for what cases share, so that thousands of cases are not compared pairwise.
    let records: Vec<&Record> = records.into_iter().collect();
    let groups = grouped(records.iter().copied(), |record| axis.what_is_shared(&record.case));
    let path = |(_, mut records): (u64, Vec<&'a Record>)| {
        records.sort_by(|a, b| level_size(b, axis).total_cmp(&level_size(a, axis)));
        Path { axis, records, smaller_step: None }
    };
    let mut paths: Vec<Path<'a>> =
        groups.into_iter().filter(|(_, records)| records.len() > 1).map(path).collect();
    if axis == Axis::Cells && !paths.is_empty() {
        add_smaller_steps(&mut paths, &records);
    }
    paths
}

/// A step smaller than this share of another shows what the other one leaves.
const SMALLER: f64 = 0.75;

/// Adds to each path the run that differs from its finest one in a smaller step alone.
fn add_smaller_steps<'a>(paths: &mut [Path<'a>], records: &[&'a Record]) {
    let ended = records.iter().copied().filter(|record| record.status == Status::Ok);
    let by_step: HashMap<u64, Vec<&Record>> =
        grouped(ended, |record| Axis::TimeStep.what_is_shared(&record.case)).into_iter().collect();
    for path in paths {
        let finest = path.records[path.records.len() - 1];
        let alike = by_step.get(&Axis::TimeStep.what_is_shared(&finest.case)).into_iter().flatten();
        let smaller =
            alike.copied().filter(|record| record.step_sizes.target < SMALLER * finest.step_sizes.target);
        path.smaller_step = smaller.min_by(|a, b| a.step_sizes.target.total_cmp(&b.step_sizes.target));
    }
}

/// The times of the outputs that all paths have.
pub(crate) fn common_times(all: &[Path<'_>]) -> Vec<f64> {
    let first = all[0].records[0].case.time_factors.iter().copied();
    first.filter(|time| all.iter().all(|path| path.records[0].case.time_factors.contains(time))).collect()
}

/// Size of a record's level: cell size (m), time step (s), spacing of points in cells, or
/// compressibility of the water (1/Pa).
pub fn level_size(record: &Record, axis: Axis) -> f64 {
    match axis {
        Axis::Cells => record.case.cell_size(),
        Axis::TimeStep => record.step_sizes.target,
        Axis::PointsPerCell => 1.0 / record.case.points_per_cell as f64,
        Axis::WaterBulkModulus => 1.0 / record.case.material.water_bulk_modulus,
    }
}

impl<'a> Path<'a> {
    /// The series of one error along the path. Levels whose case does not ask for the time factor
    /// are left out; a level that should have an error and has none stays, empty.
    pub fn series(&self, measure: &Measure) -> ErrorSeries {
        let level = |(size, error): (f64, Option<f64>)| SeriesLevel { size, error: error.map(f64::abs) };
        ErrorSeries::new(self.signed_levels(measure).into_iter().map(level).collect())
    }

    /// Sizes and errors with their signs; of a value without a reference its differences from level to level.
    pub(crate) fn signed_levels(&self, measure: &Measure) -> Vec<(f64, Option<f64>)> {
        let records = self.asked(measure);
        let size = |record: &Record| level_size(record, self.axis);
        match measure.reference.as_str() {
            NO_REFERENCE => self.values(measure).signed_differences(),
            NEXT_FINER => {
                let difference = |pair: &[&Record]| (size(pair[0]), difference_of(pair[0], pair[1], measure));
                records.windows(2).map(difference).collect()
            }
            _ => {
                let error = |record: &&Record| (size(record), measure.error(record).map(|row| row.value));
                records.iter().map(error).collect()
            }
        }
    }

    /// The runs whose case asks for the time of a measure, from coarse to fine.
    pub(crate) fn asked(&self, measure: &Measure) -> Vec<&'a Record> {
        let asked = |record: &&&Record| record.case.time_factors.contains(&measure.time_factor);
        self.records.iter().filter(asked).copied().collect()
    }

    /// The series with orders and class.
    pub fn summary(&self, measure: &Measure) -> SeriesSummary<'a> {
        let series = self.series(measure);
        SeriesSummary {
            pairs: pair_orders(&series),
            finest: finest_order(&series),
            classification: classify(&series, &self.context(measure)),
            path: self.clone(),
            measure: measure.clone(),
            series,
        }
    }

    /// A measure at the points, or at the places that the solver has instead.
    pub fn own_measure(&self, measure: &Measure) -> Measure {
        let own =
            self.records.iter().find(|record| record.outside_run().is_some_and(|run| run.sample.is_some()));
        own.map_or(measure.clone(), |record| measure.at_places_of(record))
    }

    /// The level that a demand bounds, else the finest.
    pub(crate) fn bounded_level(&self, demand: &SeriesDemand) -> &'a Record {
        let is_bounded = |record: &&&Record| {
            let size = level_size(record, self.axis);
            demand.at.is_some_and(|at| (size - at.size).abs() <= 1e-9 * at.size)
        };
        self.records.iter().find(is_bounded).unwrap_or(&self.records[self.records.len() - 1])
    }

    /// Where most of the error lies at the level that a demand bounds, where that cannot be made again.
    pub(crate) fn place(&self, demand: &SeriesDemand, measure: &Measure) -> Option<String> {
        let record = self.bounded_level(demand);
        place_in_kept(record, measure.error(record)?)
    }

    /// What the runs of the path share, in words, the method first.
    pub fn parts(&self) -> Vec<String> {
        let mut case = self.records[0].case.clone();
        if self.axis == Axis::WaterBulkModulus {
            case.material.water_bulk_modulus = Material::default().water_bulk_modulus;
        }
        case.swept = case.swept.iter().copied().filter(|name| *name != self.axis.name()).collect();
        let variant = Some(case.variant()).filter(|variant| !variant.is_empty());
        let cells = (self.axis != Axis::Cells).then(|| format!("{} cells", case.cells));
        let method = Some(case.method.to_string());
        if !case.has_integrator() {
            return [method, cells, variant].into_iter().flatten().collect();
        }
        let has_step = case.integrator != IntegratorKind::Explicit;
        let parts = [
            method,
            has_step.then(|| case.integrator.name().to_owned()),
            // Steps of the explicit integrator follow its limit, and say little about the result.
            (has_step && self.axis != Axis::TimeStep).then(|| case.time_step.to_string()),
            cells,
            (self.axis != Axis::PointsPerCell).then(|| format!("{} points per cell", case.points_per_cell)),
            variant,
        ];
        parts.into_iter().flatten().collect()
    }

    /// The parts in one line.
    pub fn label(&self) -> String {
        self.parts().join(", ")
    }
}

/// Difference of a run from the next finer one, whose places are the same; signed for a settlement.
fn difference_of(record: &Record, finer: &Record, measure: &Measure) -> Option<f64> {
    // Nothing is relative to a body that has not moved.
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    let (coarse, fine) = (record.snapshot(measure.time_factor)?, finer.snapshot(measure.time_factor)?);
    if measure.quantity == Quantity::Settlement {
        return finite(coarse.settlement / fine.settlement - 1.0);
    }
    if measure.quantity == Quantity::LoadFactor {
        return finite(coarse.plate_force? / fine.plate_force? - 1.0);
    }
    let (coarse, fine) = [coarse, fine].map(|one| measure.sample.samples(one).unwrap_or(&one.nodes)).into();
    let (computed, exact) = (measure.quantity.field(coarse)?, measure.quantity.field(fine)?);
    relative_error(measure.norm, computed, exact, &fine.volume)
}

/// A quantity in its first norm, against a reference at a time factor.
pub fn first_measure(quantity: Quantity, sample: Sample, reference: &str, time_factor: f64) -> Measure {
    let (norm, reference) = (quantity.first_norm(), reference.to_owned());
    Measure { quantity, sample, norm, reference, time_factor, probe: None }
}

/// The size of a record's error of a quantity in its first norm.
pub fn first_error(
    record: &Record,
    quantity: Quantity,
    sample: Sample,
    reference: &str,
    time_factor: f64,
) -> Option<f64> {
    let row = record.error(quantity, sample, quantity.first_norm(), reference, time_factor)?;
    Some(row.value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of};
    use crate::case::Case;
    use oedometer_problem::time_step::TimeStep;
    use oedometer_scenes::COSINE_LAYER;

    /// Whether two cases differ along an axis at most, compared input by input.
    fn alike(a: &Case, b: &Case, axis: Axis) -> bool {
        let mut b = Case { time_factors: a.time_factors.clone(), swept: a.swept.clone(), ..b.clone() };
        match axis {
            Axis::Cells => b.cells = a.cells,
            Axis::TimeStep
                if std::mem::discriminant(&a.time_step) == std::mem::discriminant(&b.time_step) =>
            {
                b.time_step = a.time_step;
            }
            Axis::TimeStep => {}
            Axis::PointsPerCell => b.points_per_cell = a.points_per_cell,
            Axis::WaterBulkModulus => b.material.water_bulk_modulus = a.material.water_bulk_modulus,
        }
        *a == b
    }

    #[test]
    fn paths_are_the_groups_of_cases_that_differ_along_their_axis_alone() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\nmethod = ['MPM', 'GC-SRI-patch']\n\
             integrator = ['implicit']\ncells = [2, 4]\npoints_per_cell = [2, 3]\nporosity = [0.3, 0.4]\n\
             time_step = [{ growth = 0.5 }, { growth = 0.3 }, { seconds = 10.0 }]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\nwater_bulk_modulus = [1e8, 1e9]\ntime_step = [{ growth = 0.5 }]\n",
        );
        let all = StudyPaths::of(&records);
        for axis in Axis::ALL {
            let paths = all.along(axis);
            let places: usize = paths.iter().map(|path| path.records.len()).sum();
            let lonely = |one: &&Record| {
                records.iter().filter(|other| alike(&one.case, &other.case, axis)).count() == 1
            };
            assert_eq!(places + records.iter().filter(lonely).count(), records.len(), "{axis:?}");
            for (number, path) in paths.iter().enumerate() {
                let first = &path.records[0].case;
                assert!(path.records.iter().all(|record| alike(first, &record.case, axis)), "{axis:?}");
                let others = paths.iter().skip(number + 1);
                assert!(others.clone().all(|other| !alike(first, &other.records[0].case, axis)), "{axis:?}");
                let sizes: Vec<f64> = path.records.iter().map(|record| level_size(record, axis)).collect();
                assert!(sizes.is_sorted_by(|a, b| a >= b), "{axis:?}: {sizes:?}");
            }
        }
        assert_eq!(Axis::ALL.map(|axis| all.along(axis).len()), [24, 16, 24, 1]);
    }

    #[test]
    fn a_difference_from_the_next_finer_level_is_over_the_finer_one() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\ntime_step = [{ growth = 0.5 }, { growth = 0.3 }, { growth = 0.1 }]\n",
        );
        for (record, settlement) in records.iter_mut().zip([1.25, 1.0, 0.8]) {
            record.snapshots[0].settlement = settlement;
        }
        let measure = first_measure(Quantity::Settlement, Sample::Surface, NEXT_FINER, 0.05);
        let all = StudyPaths::of(&records);
        let levels = all.along(Axis::TimeStep)[0].signed_levels(&measure);
        let found: Vec<f64> = levels.iter().filter_map(|(_, difference)| *difference).collect();
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|difference| (difference - 0.25).abs() < 1e-15), "{found:?}");
    }

    #[test]
    fn the_smallest_of_clearly_smaller_steps_that_ended_well_shows_what_the_step_does() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2, 4]\ntime_step = [{ growth = 0.5 }, { growth = 0.3 }, { growth = 0.1 }]\n",
        );
        let is = |record: &Record, cells: usize, growth: f64| {
            record.case.cells == cells && record.case.time_step == TimeStep::Growth(growth)
        };
        for smallest in [Some(0.1), Some(0.3), None] {
            let paths = StudyPaths::of(&records);
            let path =
                paths.along(Axis::Cells).iter().find(|path| is(path.records[1], 4, 0.5)).expect("a path");
            let found = path.smaller_step.is_some_and(|record| is(record, 4, smallest.unwrap_or(0.0)));
            assert!(found == smallest.is_some() && (found || path.smaller_step.is_none()), "{smallest:?}");
            for record in records.iter_mut().filter(|record| is(record, 4, smallest.unwrap_or(0.0))) {
                record.status = failed_at(1);
            }
        }
    }

    #[test]
    fn a_path_is_told_by_what_its_runs_share_and_not_by_what_is_refined() {
        type Change = fn(&mut Case);
        let record = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\ntime_step = [{ growth = 0.5 }]\n",
        )
        .remove(0);
        let attach: Change = |case| {
            let ogs = crate::case::Attached::new("ogs", "0123456789abcdef").expect("plain");
            case.method = crate::case::SolverName::Attached(ogs);
            case.swept = ["cells", "porosity"].into();
        };
        let (step, cells, points) = ("growth=0.5", "2 cells", "2 points per cell");
        let table: [(Axis, Change, &[&str]); 8] = [
            (Axis::Cells, |_| {}, &["MPM", "implicit", step, points]),
            (Axis::TimeStep, |_| {}, &["MPM", "implicit", cells, points]),
            (Axis::PointsPerCell, |_| {}, &["MPM", "implicit", step, cells]),
            (
                Axis::WaterBulkModulus,
                |case| (case.material.water_bulk_modulus, case.scene) = (1e9, &COSINE_LAYER),
                &["MPM", "implicit", step, cells, points],
            ),
            (
                Axis::Cells,
                |case| case.integrator = IntegratorKind::Explicit,
                &["MPM", points, "quasi-static"],
            ),
            (
                Axis::Cells,
                |case| (case.settings.flip, case.swept) = (0.5, ["cells", "porosity"].into()),
                &["MPM", "implicit", step, points, "FLIP 0.5, porosity=0.3"],
            ),
            (Axis::Cells, attach, &["ogs", "porosity=0.3"]),
            (Axis::PointsPerCell, attach, &["ogs", cells, "cells=2, porosity=0.3"]),
        ];
        for (place, (axis, change, parts)) in table.into_iter().enumerate() {
            let mut record = record.clone();
            change(&mut record.case);
            let path = Path { axis, records: vec![&record], smaller_step: None };
            assert_eq!(path.parts(), parts, "row {place}");
            assert_eq!(path.label(), parts.join(", "));
        }
    }
}
