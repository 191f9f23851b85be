//! Methods ranked by how they stand incompressibility: error, oscillation, order, stiff water, stiff
//! skeleton, stable step and cost.

use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::paths;
use crate::measure::fields::plane_field::PlaneField;
use crate::measure::largest::largest;
use crate::measure::wall_times::median;
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::Class;
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::critical_step::formula;
use oedometer_mpm::method::Method;
use oedometer_soil::material::Material;
use std::collections::BTreeSet;

/// Water so much stiffer than the skeleton that a further stiffening should change nothing.
const STIFF_WATER: f64 = 1e3;

/// What one method showed, with what was not measured left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// The method.
    pub method: Method,
    /// Mean of its ranks over the criteria, from 1.
    pub rank: f64,
    /// Relative L2 error of the nodal displacement at the undrained start.
    pub displacement: Option<f64>,
    /// Relative L2 error of the pressure at the points at the undrained start.
    pub pressure: Option<f64>,
    /// Relative L2 error of the pressure at the points at the last output.
    pub consolidated: Option<f64>,
    /// Oscillation index of the pressure at the undrained start.
    pub oscillation: Option<f64>,
    /// Order of the displacement on the finest window, where its class has one.
    pub displacement_order: Option<f64>,
    /// Order of the pressure at the points.
    pub pressure_order: Option<f64>,
    /// Class of the displacement's series.
    pub class: Option<Class>,
    /// Largest over smallest displacement error over the stiff waters, minus one.
    pub spread: Option<f64>,
    /// Displacement error under the skeleton nearest to incompressible.
    pub stiff_skeleton: Option<f64>,
    /// Pressure error there.
    pub stiff_skeleton_pressure: Option<f64>,
    /// Critical explicit step over `h/c`.
    pub critical_step: Option<f64>,
    /// Seconds that the implicit run on the finest mesh that every method ran costs: alone, or of the processor.
    pub seconds: Option<f64>,
}

/// The methods of a study of an undrained start, the best mean rank first.
///
/// # Errors
/// When a reference refuses a case.
pub fn standings(study: &Study, records: &[Record]) -> Result<Vec<Standing>, ExactError> {
    let methods = methods_of(records);
    let reference = study.references[0].name();
    let cells = common_cells(records, &methods);
    let mut standings = methods
        .iter()
        .map(|method| standing(records, *method, cells, reference))
        .collect::<Result<Vec<_>, _>>()?;
    rank(&mut standings);
    standings.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    Ok(standings)
}

/// The methods of records, each once, in their order.
pub(crate) fn methods_of<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<Method> {
    let mut methods: Vec<Method> = Vec::new();
    for record in records {
        if !methods.contains(&record.case.method) {
            methods.push(record.case.method);
        }
    }
    methods
}

/// Whether a record is of the undisturbed soil, by the implicit integrator, and sound.
fn is_plain(record: &Record) -> bool {
    record.case.has_usual_compressibility() && !record.case.is_explicit() && record.status == Status::Ok
}

/// Most cells that every method ran to the last output.
fn common_cells(records: &[Record], methods: &[Method]) -> usize {
    let last = records.iter().filter_map(|record| record.case.time_factors.last());
    let last = last.copied().fold(0.0, f64::max);
    let has_run = |method: &Method, cells: usize| {
        records.iter().any(|record| {
            is_plain(record)
                && record.case.method == *method
                && record.case.cells == cells
                && record.case.time_factors.contains(&last)
        })
    };
    let all: BTreeSet<usize> = records.iter().map(|record| record.case.cells).collect();
    let of_all = |cells: &usize| methods.iter().all(|method| has_run(method, *cells));
    all.into_iter().rev().find(of_all).unwrap_or(0)
}

fn standing(
    records: &[Record],
    method: Method,
    cells: usize,
    reference: &str,
) -> Result<Standing, ExactError> {
    let own: Vec<&Record> = records.iter().filter(|record| record.case.method == method).collect();
    let on_mesh = || own.iter().copied().filter(|record| record.case.cells == cells);
    let error = |record: &Record, quantity, sample, time_factor| {
        record.error(quantity, sample, Norm::L2, reference, time_factor).map(|row| row.value)
    };
    let moved = |record: &Record| error(record, Quantity::Displacement, Sample::Nodes, 0.0);
    let plain = on_mesh().find(|record| is_plain(record));
    let last = plain.and_then(|record| record.case.time_factors.last().copied()).filter(|time| *time > 0.0);
    let stiff: Vec<f64> = on_mesh()
        .filter(|record| {
            let soil = &record.case.material;
            soil.water_bulk_modulus >= STIFF_WATER * soil.youngs_modulus
                && soil.poissons_ratio == Material::default().poissons_ratio
                && !record.case.is_explicit()
        })
        .filter_map(moved)
        .collect();
    let spread = largest(stiff.iter().map(|error| -error)).zip(largest(stiff.iter().copied()));
    let ratio = |record: &Record| record.case.material.poissons_ratio;
    let largest_ratio =
        largest(on_mesh().map(ratio)).filter(|most| *most > Material::default().poissons_ratio);
    // Of runs with the same ratio the worst counts, in whatever order they stand.
    let hardest = |of: &dyn Fn(&Record) -> Option<f64>| {
        largest(on_mesh().filter(|record| Some(ratio(record)) == largest_ratio).filter_map(of))
    };
    let explicit = own.iter().find(|record| record.case.is_explicit());
    let order = |quantity, sample| series_order(records, method, quantity, sample, reference);
    let field = match plain {
        Some(record) => PlaneField::of(record, 0.0)?,
        None => None,
    };
    Ok(Standing {
        method,
        rank: f64::NAN,
        displacement: plain.and_then(moved),
        pressure: plain.and_then(|record| error(record, Quantity::Pressure, Sample::Points, 0.0)),
        consolidated: plain
            .zip(last)
            .and_then(|(record, last)| error(record, Quantity::Pressure, Sample::Points, last)),
        oscillation: field.map(|field| field.oscillation_index()),
        displacement_order: order(Quantity::Displacement, Sample::Nodes).1,
        pressure_order: order(Quantity::Pressure, Sample::Points).1,
        class: order(Quantity::Displacement, Sample::Nodes).0,
        spread: spread.filter(|_| stiff.len() > 1).map(|(minus_least, most)| most / -minus_least - 1.0),
        stiff_skeleton: hardest(&moved),
        stiff_skeleton_pressure: hardest(&|record| error(record, Quantity::Pressure, Sample::Points, 0.0)),
        critical_step: explicit.map(|record| {
            let soil = &record.case.material;
            let speed = formula::fastest_wave_speed(soil, soil.porosity);
            record.step_sizes.predicted_critical * speed / record.case.cell_size()
        }),
        seconds: plain.and_then(seconds_of_work),
    })
}

/// What a run cost, s: the median wall time of runs alone, or the processor's time where none was alone.
fn seconds_of_work(record: &Record) -> Option<f64> {
    let worked: Vec<f64> = record.wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
    median(&record.wall_alone()).or_else(|| median(&worked))
}

/// Class of the undrained errors over the meshes and the order on the finest window.
fn series_order(
    records: &[Record],
    method: Method,
    quantity: Quantity,
    sample: Sample,
    reference: &str,
) -> (Option<Class>, Option<f64>) {
    let plain = records.iter().filter(|record| record.case.method == method && is_plain(record));
    let measure = Measure {
        quantity,
        sample,
        norm: Norm::L2,
        reference: reference.to_owned(),
        time_factor: 0.0,
        probe: None,
    };
    let found = paths(plain, Axis::Cells);
    let Some(path) = found.first() else { return (None, None) };
    let summary = path.summary(&measure);
    let order = summary.finest.ok();
    (Some(summary.classification.class), order.filter(|_| summary.classification.class != Class::Locked))
}

/// Mean rank over the criteria; what was not measured counts in none.
fn rank(standings: &mut [Standing]) {
    let criteria: [fn(&Standing) -> Option<f64>; 9] = [
        |one| one.displacement,
        |one| one.pressure,
        |one| one.consolidated,
        |one| one.oscillation.map(f64::abs),
        |one| Some(-one.displacement_order.unwrap_or(0.0)),
        |one| Some(-one.pressure_order.unwrap_or(0.0)),
        |one| one.stiff_skeleton,
        |one| one.critical_step.map(|step| -step),
        |one| one.seconds,
    ];
    let ranks: Vec<f64> = standings
        .iter()
        .map(|one| {
            let of = |criterion: &fn(&Standing) -> Option<f64>| {
                let value = criterion(one)?;
                // What differs by less than a percent shares its rank.
                let better = |other: &Standing| {
                    criterion(other).is_some_and(|other| other < value - 0.01 * value.abs())
                };
                Some(1.0 + standings.iter().filter(|other| better(other)).count() as f64)
            };
            let ranks: Vec<f64> = criteria.iter().filter_map(of).collect();
            ranks.iter().sum::<f64>() / ranks.len() as f64
        })
        .collect();
    for (one, rank) in standings.iter_mut().zip(ranks) {
        one.rank = rank;
    }
}
