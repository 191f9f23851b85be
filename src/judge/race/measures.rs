//! Measures of a contender's runs in a situation.

use crate::case::contender::Contender;
use crate::case::{Quantity, Sample};
use crate::judge::path_context;
use crate::judge::paths::{Path, first_error, first_measure};
use crate::judge::soundness;
use crate::measure::statistics::{largest, median};
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::Classification;
use oedometer_mpm::critical_step::formula;
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::elementary;

/// The runs of a contender: one path over the mesh, and one of its meshes again with another step.
pub struct Runs<'a> {
    /// From coarse to fine.
    pub path: Vec<&'a Record>,
    /// The run on a mesh, and that with half its step.
    pub two_steps: Option<(&'a Record, &'a Record)>,
}

impl<'a> Runs<'a> {
    /// Those of a contender among the records of a study. Where it has two steps on a mesh, the longer one is the race's.
    pub fn of(study: &Study, contender: &Contender, records: &'a [Record]) -> Self {
        let is_refused = study.not_applicable.iter().any(|(name, _)| *name == contender.name);
        let mut own: Vec<&Record> =
            records.iter().filter(|record| !is_refused && contender.runs(&record.case)).collect();
        let step = |record: &Record| record.step_sizes.target;
        own.sort_by(|a, b| a.case.cells.cmp(&b.case.cells).then(step(b).total_cmp(&step(a))));
        let (mut path, mut two_steps) = (Vec::<&Record>::new(), None);
        for record in own {
            match path.last() {
                Some(last) if last.case.cells == record.case.cells => two_steps = Some((*last, record)),
                _ => path.push(record),
            }
        }
        Self { path, two_steps }
    }

    /// The failure of the coarsest run that failed: its name, and where and why.
    pub fn failure(&self) -> Option<(&'static str, String)> {
        self.path.iter().find_map(|record| {
            let failure = record.status.failure()?;
            Some((failure.kind.name(), format!("on {} cells: {}", record.case.cells, failure.reason)))
        })
    }

    /// The class of the pressure's series, of a footing of its load's, at the output of its largest error on the finest mesh.
    pub fn classified(&self) -> Option<Classification> {
        let finest = *self.path.last()?;
        let reference = finest.references.first()?.name.as_str();
        let (quantity, sample) = match finest.case.scene {
            SceneKind::Footing => (Quantity::LoadFactor, Sample::Surface),
            _ => (Quantity::Pressure, Sample::Points),
        };
        let error = |time: f64| first_error(finest, quantity, sample, reference, time);
        let times = finest.case.time_factors.iter().copied().filter(|time| error(*time).is_some());
        let time = times.max_by(|a, b| error(*a).unwrap_or(0.0).total_cmp(&error(*b).unwrap_or(0.0)))?;
        let path = Path { axis: Axis::Cells, records: self.path.clone() };
        let measure = first_measure(quantity, sample, reference, time);
        Some(path.summary(&measure).classification)
    }

    /// Processor seconds to a score: between two meshes by powers of both; those of the coarsest mesh where it is good
    /// enough; none where the finest is not.
    pub fn cost_to(&self, tolerance: f64) -> Option<f64> {
        let level = |record: &&Record| {
            let seconds: Vec<f64> = record.wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
            Some((score_of(record)?, median(&seconds).filter(|seconds| *seconds > 0.0)?))
        };
        let levels: Vec<(f64, f64)> = self.path.iter().filter_map(level).collect();
        let place = levels.iter().position(|(error, _)| *error <= tolerance)?;
        let (error, cost) = levels[place];
        let Some((coarse_error, coarse_cost)) = place.checked_sub(1).map(|before| levels[before]) else {
            return Some(cost);
        };
        let share = elementary::ln(coarse_error / tolerance) / elementary::ln(coarse_error / error);
        Some(coarse_cost * elementary::powf(cost / coarse_cost, share))
    }
}

/// Largest errors over the outputs, of pressure and effective stress at the points and of the settlement; of a plane, of
/// the displacement at the nodes; of a footing, of its load.
pub fn errors_of(record: &Record) -> [Option<f64>; 3] {
    let Some(reference) = record.references.first().filter(|_| record.status == Status::Ok) else {
        return [None; 3];
    };
    let largest_of = |quantity, sample| {
        let errors = record.case.time_factors.iter();
        largest(errors.filter_map(|time| first_error(record, quantity, sample, &reference.name, *time)))
    };
    let settlement = largest_of(Quantity::Settlement, Sample::Surface);
    [
        largest_of(Quantity::Pressure, Sample::Points),
        largest_of(Quantity::EffectiveStress, Sample::Points),
        settlement
            .or_else(|| largest_of(Quantity::Displacement, Sample::Nodes))
            .or_else(|| largest_of(Quantity::LoadFactor, Sample::Surface)),
    ]
}

/// What a run is ranked by: the largest of its errors; where nothing may move, what moves; where the critical step was
/// asked for, the formula's step over the observed one.
pub fn score_of(record: &Record) -> Option<f64> {
    if record.stability.is_some() {
        return step_ratio_of(record).map(f64::recip);
    }
    if record.case.scene.is_at_rest() && record.status == Status::Ok {
        return largest(record.balance.iter().filter_map(|balance| balance.spurious_velocity));
    }
    largest(errors_of(record).into_iter().flatten())
}

/// Relative change of the score from one run to another.
pub fn scatter_of(one: &Record, other: &Record) -> Option<f64> {
    let (one, other) = (score_of(one)?, score_of(other)?);
    Some((other / one - 1.0).abs())
}

/// The first complaint about the balances of a run that ended well.
pub fn complaint_of(record: &Record) -> Option<String> {
    if record.status == Status::Ok { soundness::complaints(record).into_iter().next() } else { None }
}

/// Oscillation index of the pressure at the last output.
pub fn oscillation_of(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.last()?);
    let measure = first_measure(Quantity::Pressure, Sample::Points, &reference.name, time);
    path_context::oscillation_of(record, &measure)
}

/// Computed over exact settlement at the first output; of a plane one minus the error of the displacement.
pub fn locking_of(record: &Record) -> Option<f64> {
    let (reference, time) = (record.references.first()?, *record.case.time_factors.first()?);
    let of_reference =
        |row: &&crate::record::ErrorRow| row.reference == reference.name && row.time_factor == time;
    let rows = || record.errors.iter().filter(of_reference);
    let settlement = rows().find(|row| row.quantity == Quantity::Settlement).map(|row| 1.0 + row.value);
    settlement.or_else(|| {
        let error = first_error(record, Quantity::Displacement, Sample::Nodes, &reference.name, time)?;
        Some(1.0 - error)
    })
}

/// Critical step over the formula's: observed, or else predicted for an explicit run.
pub fn step_ratio_of(record: &Record) -> Option<f64> {
    if let Some(found) = &record.stability {
        return Some(found.observed? / found.combined_limit);
    }
    let case = &record.case;
    let limit = formula::combined_limit(&case.material, case.cell_size(), case.settings.drag);
    let ratio = record.step_sizes.predicted_critical / limit;
    (case.is_explicit() && ratio.is_finite() && ratio > 0.0).then_some(ratio)
}
