//! From the records of a study to its paths and their series of errors.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::{Case, step_label};
use crate::judge::error_place::place_of_attached;
use crate::measure::fields::norms::relative_error;
use crate::record::Record;
use crate::study::expectation::{Axis, Measure, NEXT_FINER, NO_REFERENCE};
use oedometer_convergence::class::classify::classify;
use oedometer_convergence::class::{Classification, Context};
use oedometer_convergence::orders::{SlopeFit, finest_order, pair_orders, slope};
use oedometer_convergence::series::{ErrorSeries, SeriesLevel, Undefined};
use oedometer_convergence::series_demand::SeriesDemand as Demand;
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_soil::material::Material;
use std::collections::HashMap;

/// Errors up to this are round-off of a long run.
const ROUND_OFF: f64 = 1e-12;

/// The records of one path through a study: alike in everything but the axis.
#[derive(Clone, Debug)]
pub struct Path<'a> {
    /// What is refined.
    pub axis: Axis,
    /// Records from coarse to fine.
    pub records: Vec<&'a Record>,
}

/// A series of errors with everything that is said of it.
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
    /// Straight fit over all levels.
    pub slope: Result<SlopeFit, Undefined>,
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
    /// Those of records.
    pub fn of(records: &'a [Record]) -> Self {
        Self { along: Axis::ALL.map(|axis| paths(records, axis)) }
    }

    /// Those along an axis.
    pub fn along(&self, axis: Axis) -> &[Path<'a>] {
        Axis::ALL.iter().position(|one| *one == axis).map_or(&[], |place| &self.along[place])
    }
}

/// Paths of the records along an axis: every group of at least two levels.
pub fn paths<'a>(records: impl IntoIterator<Item = &'a Record>, axis: Axis) -> Vec<Path<'a>> {
    let mut groups: Vec<Path<'_>> = Vec::new();
    // A group by what its cases share, so that no case of thousands is held against the others.
    let mut places: HashMap<u64, usize> = HashMap::new();
    for record in records {
        let place = *places.entry(what_is_shared(&record.case, axis)).or_insert(groups.len());
        match groups.get_mut(place) {
            Some(group) => group.records.push(record),
            None => groups.push(Path { axis, records: vec![record] }),
        }
    }
    groups.retain(|group| group.records.len() > 1);
    for group in &mut groups {
        group.records.sort_by(|a, b| level_size(b, axis).total_cmp(&level_size(a, axis)));
    }
    groups
}

/// A number for everything but the axis: the same for cases that differ along it at most. What is only asked for at
/// the output, time factors, makes no difference.
fn what_is_shared(case: &Case, axis: Axis) -> u64 {
    case.number_with(|case| {
        case.time_factors.clear();
        match axis {
            Axis::Cells => case.cells = 0,
            // Rules of one kind are steps of one path; of different kinds they are different schemes.
            Axis::TimeStep => case.time_step = case.time_step.with_number(0.0),
            Axis::PointsPerCell => case.points_per_cell = 0,
            Axis::WaterBulkModulus => case.material.water_bulk_modulus = 0.0,
        }
    })
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
    /// are no levels of it; a level that should have an error and has none stays, empty.
    pub fn series(&self, measure: &Measure) -> ErrorSeries {
        if measure.reference == NO_REFERENCE {
            return self.values(measure).differences();
        }
        let records = self.asked(measure);
        let level = |record: &Record, error: Option<f64>| SeriesLevel {
            size: level_size(record, self.axis),
            error: error.map(f64::abs),
        };
        let levels = if measure.reference == NEXT_FINER {
            let neighbours = records.windows(2);
            neighbours.map(|pair| level(pair[0], difference_of(pair[0], pair[1], measure))).collect()
        } else {
            let error_of = |record| measure.error(record).map(|row| row.value);
            records.iter().map(|record| level(record, error_of(record))).collect()
        };
        ErrorSeries::new(levels)
    }

    /// The runs whose case asks for the time of a measure, from coarse to fine.
    fn asked(&self, measure: &Measure) -> Vec<&'a Record> {
        let asked = |record: &&&Record| record.case.time_factors.contains(&measure.time_factor);
        self.records.iter().filter(asked).copied().collect()
    }

    /// The series with orders and class.
    pub fn summary(&self, measure: &Measure) -> SeriesSummary<'a> {
        let series = self.series(measure);
        SeriesSummary {
            pairs: pair_orders(&series),
            slope: slope(&series),
            finest: finest_order(&series),
            classification: classify(&series, &self.context(measure)),
            path: self.clone(),
            measure: measure.clone(),
            series,
        }
    }

    /// What is known beside the errors: formal order, accuracy of the reference, and the model's
    /// difference where the reference is not of the scene's own equations.
    pub(crate) fn context(&self, measure: &Measure) -> Context {
        let case = &self.records[0].case;
        let finest = self.records[self.records.len() - 1];
        let used = finest.references.iter().find(|used| used.name == measure.reference);
        Context {
            formal_order: (self.axis == Axis::Cells).then(|| formal_order(case, measure)).flatten(),
            round_off: Some(ROUND_OFF),
            reference_accuracy: used.map(|used| used.tail_bound),
            limiters: self.limiters(measure),
            mobility: self.mobility(measure),
            signed: self.signed(measure),
        }
    }

    /// The errors with their signs, where they are of a single number; a value without a reference has its differences
    /// from level to level.
    fn signed(&self, measure: &Measure) -> Vec<f64> {
        if measure.reference == NO_REFERENCE {
            return self
                .values(measure)
                .signed_differences()
                .into_iter()
                .filter_map(|level| level.1)
                .collect();
        }
        if measure.norm != Norm::Relative {
            return Vec::new();
        }
        if measure.reference == NEXT_FINER {
            let asked = self.asked(measure);
            let neighbours = asked.windows(2);
            return neighbours.filter_map(|pair| difference_of(pair[0], pair[1], measure)).collect();
        }
        self.asked(measure).into_iter().filter_map(|record| Some(measure.error(record)?.value)).collect()
    }

    /// Settlement over the exact one at each level, for the errors of displacements: a locked body
    /// has hardly any.
    fn mobility(&self, measure: &Measure) -> Vec<f64> {
        if !matches!(measure.quantity, Quantity::Displacement | Quantity::Settlement) {
            return Vec::new();
        }
        let (quantity, sample, norm) = (Quantity::Settlement, Sample::Surface, Norm::Relative);
        let settlement = Measure { quantity, sample, norm, ..measure.clone() };
        self.records.iter().filter_map(|record| Some(1.0 + settlement.error(record)?.value)).collect()
    }

    /// A measure at the points, for an attached solver at the places that it has instead.
    pub fn own_measure(&self, measure: &Measure) -> Measure {
        let own = self
            .records
            .iter()
            .find(|record| record.attached.as_ref().is_some_and(|one| one.sample.is_some()));
        match own {
            Some(record) if measure.sample == Sample::Points => {
                Measure { sample: record.main_sample(), ..measure.clone() }
            }
            _ => measure.clone(),
        }
    }

    /// Where most of the error of somebody else's result is: at the level that is bounded, or the finest.
    pub(crate) fn place(&self, demand: &Demand, measure: &Measure) -> Option<String> {
        let is_bounded =
            |record: &&&Record| demand.at.is_some_and(|at| at.size == level_size(record, self.axis));
        let record = self.records.iter().find(is_bounded).or(self.records.last())?;
        place_of_attached(record, measure.error(record)?)
    }

    /// What the runs of the path share, in words, the method first.
    pub fn parts(&self) -> Vec<String> {
        let mut case = self.records[0].case.clone();
        if self.axis == Axis::WaterBulkModulus {
            case.material.water_bulk_modulus = Material::default().water_bulk_modulus;
        }
        case.swept = case.swept.iter().copied().filter(|name| *name != self.axis.name()).collect();
        let mut parts = vec![case.method.to_string()];
        if case.is_attached() {
            parts.extend((self.axis != Axis::Cells).then(|| format!("{} cells", case.cells)));
            parts.extend(Some(case.variant()).filter(|variant| !variant.is_empty()));
            return parts;
        }
        if case.integrator != IntegratorKind::Explicit {
            parts.push(case.integrator.name().to_owned());
            // Steps of the explicit integrator go by its limit, and say little of the result.
            parts.extend((self.axis != Axis::TimeStep).then(|| step_label(&case.time_step)));
        }
        if self.axis != Axis::Cells {
            parts.push(format!("{} cells", case.cells));
        }
        if self.axis != Axis::PointsPerCell {
            parts.push(format!("{} points a cell", case.points_per_cell));
        }
        parts.extend(Some(case.variant()).filter(|variant| !variant.is_empty()));
        parts
    }

    /// The parts in one line.
    pub fn label(&self) -> String {
        self.parts().join(", ")
    }
}

/// Difference of a run from the next finer one, whose places are the same; of a settlement with its sign.
fn difference_of(record: &Record, finer: &Record, measure: &Measure) -> Option<f64> {
    let (coarse, fine) = (record.snapshot(measure.time_factor)?, finer.snapshot(measure.time_factor)?);
    if measure.quantity == Quantity::Settlement {
        return Some(coarse.settlement / fine.settlement - 1.0);
    }
    let (coarse, fine) = [coarse, fine].map(|one| measure.sample.of(one).unwrap_or(&one.nodes)).into();
    let (computed, exact) = (measure.quantity.field(coarse)?, measure.quantity.field(fine)?);
    relative_error(measure.norm, computed, exact, &fine.volume)
}

/// Order in the cell size that a method's operators promise at small strain, where they promise
/// one: constant fields in a cell are of first order at points and of second at the centres.
fn formal_order(case: &Case, measure: &Measure) -> Option<f64> {
    let method = &case.method;
    if case.is_attached() {
        return None;
    }
    let by_points = |second: bool| if second { 2.0 } else { 1.0 };
    match (measure.quantity, measure.sample) {
        (Quantity::Pressure, Sample::Points) => {
            Some(by_points(method.uses_patch() || method.has_nodal_pressure()))
        }
        (Quantity::EffectiveStress, Sample::Points) => Some(by_points(method.strain.is_composite())),
        (Quantity::Pressure | Quantity::EffectiveStress, Sample::Centres)
        | (Quantity::Settlement, _)
        | (Quantity::Displacement, Sample::Nodes) => Some(2.0),
        _ => None,
    }
}

/// The norm in which a quantity is reported first.
pub fn first_norm(quantity: Quantity) -> Norm {
    if quantity == Quantity::Settlement { Norm::Relative } else { Norm::L2 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    /// Whether two cases differ along an axis at most, held against each other input by input.
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
}
