//! Methods ranked by how well they handle incompressibility: error, oscillation, order, stiff water, stiff skeleton,
//! stable step and cost; and their errors over the stiffness of the water and of the skeleton, at the start and
//! through consolidation.

use crate::case::solver::Solver;
use crate::case::{Case, Quantity, Sample};
use crate::judge::paths::{first_error, first_measure, grouped, paths};
use crate::measure::fields::PlaneField;
use crate::measure::statistics::{largest, median};
use crate::record::{Record, Status};
use crate::study::check::Study;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use oedometer_exact::ExactError;
use oedometer_mpm::critical_step::formula;
use oedometer_soil::material::Material;

/// `K_w/E` from which on stiffer water should change nothing.
const STIFF_WATER: f64 = 1e3;

/// The results of one method; `None` where something was not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// The method.
    pub method: Solver,
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
fn methods_of<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<Solver> {
    let groups = grouped(records, |record| record.case.method.to_string());
    groups.into_iter().map(|(_, records)| records[0].case.method).collect()
}

/// Whether a record is of the usual soil, by the implicit integrator, and sound.
fn is_plain(record: &Record) -> bool {
    record.case.has_usual_compressibility() && !record.case.is_explicit() && record.status == Status::Ok
}

/// Most cells that every method ran to the last output.
fn common_cells(records: &[Record], methods: &[Solver]) -> usize {
    let last = records.iter().filter_map(|record| record.case.time_factors.last());
    let last = last.copied().fold(0.0, f64::max);
    let is_whole = |record: &&Record| is_plain(record) && record.case.time_factors.contains(&last);
    let runs: Vec<&Record> = records.iter().filter(is_whole).collect();
    let has_run = |method: &Solver, cells: usize| {
        runs.iter().any(|record| record.case.method == *method && record.case.cells == cells)
    };
    let cells = runs.iter().map(|record| record.case.cells);
    cells.filter(|cells| methods.iter().all(|method| has_run(method, *cells))).max().unwrap_or(0)
}

fn standing(
    records: &[Record],
    method: Solver,
    cells: usize,
    reference: &str,
) -> Result<Standing, ExactError> {
    let own: Vec<&Record> = records.iter().filter(|record| record.case.method == method).collect();
    let on_mesh = || own.iter().copied().filter(|record| record.case.cells == cells);
    let moved = |record: &Record| first_error(record, Quantity::Displacement, Sample::Nodes, reference, 0.0);
    let pressure_at =
        |record: &Record, time| first_error(record, Quantity::Pressure, Sample::Points, reference, time);
    let pressure = |record: &Record| pressure_at(record, 0.0);
    let plain = on_mesh().find(|record| is_plain(record));
    let last = plain.and_then(|record| record.case.time_factors.last().copied()).filter(|time| *time > 0.0);
    let seed_ratio = Material::default().poissons_ratio;
    let is_stiff = |record: &&Record| {
        let soil = &record.case.material;
        soil.water_bulk_modulus >= STIFF_WATER * soil.youngs_modulus
            && soil.poissons_ratio == seed_ratio
            && !record.case.is_explicit()
    };
    let stiff: Vec<f64> = on_mesh().filter(is_stiff).filter_map(moved).collect();
    let spread = largest(stiff.iter().map(|error| -error)).zip(largest(stiff.iter().copied()));
    let ratio = |record: &Record| record.case.material.poissons_ratio;
    let largest_ratio = largest(on_mesh().map(ratio)).filter(|most| *most > seed_ratio);
    // Of runs with the same ratio the worst counts, whatever their order.
    let hardest = |of: &dyn Fn(&Record) -> Option<f64>| {
        largest(on_mesh().filter(|record| Some(ratio(record)) == largest_ratio).filter_map(of))
    };
    let explicit = own.iter().find(|record| record.case.is_explicit());
    let order = |quantity, sample| series_order(records, method, quantity, sample, reference);
    let (class, displacement_order) = order(Quantity::Displacement, Sample::Nodes);
    let field = plain.map(|record| PlaneField::of(record, 0.0)).transpose()?.flatten();
    Ok(Standing {
        method,
        rank: f64::NAN,
        displacement: plain.and_then(moved),
        pressure: plain.and_then(pressure),
        consolidated: plain.zip(last).and_then(|(record, last)| pressure_at(record, last)),
        oscillation: field.map(|field| field.oscillation_index()),
        displacement_order,
        pressure_order: order(Quantity::Pressure, Sample::Points).1,
        class,
        spread: spread.filter(|_| stiff.len() > 1).map(|(minus_least, most)| most / -minus_least - 1.0),
        stiff_skeleton: hardest(&moved),
        stiff_skeleton_pressure: hardest(&pressure),
        critical_step: explicit.map(|record| {
            let soil = &record.case.material;
            let speed = formula::fastest_wave_speed(soil, soil.porosity);
            record.step_sizes.predicted_critical * speed / record.case.cell_size()
        }),
        seconds: plain.and_then(seconds_of_work),
    })
}

/// Cost of a run, s: the median wall time of runs that had the machine to themselves, or else the processor time.
fn seconds_of_work(record: &Record) -> Option<f64> {
    let worked: Vec<f64> = record.wall.iter().filter_map(|sample| sample.cpu_seconds).collect();
    median(&record.wall_alone()).or_else(|| median(&worked))
}

/// Class of the undrained errors over the meshes and the order on the finest window.
fn series_order(
    records: &[Record],
    method: Solver,
    quantity: Quantity,
    sample: Sample,
    reference: &str,
) -> (Option<Class>, Option<f64>) {
    let plain = records.iter().filter(|record| record.case.method == method && is_plain(record));
    let found = paths(plain, Axis::Cells);
    let Some(path) = found.first() else { return (None, None) };
    let summary = path.summary(&first_measure(quantity, sample, reference, 0.0));
    let class = summary.classification.class;
    (Some(class), summary.finest.ok().filter(|_| class != Class::Locked))
}

/// Mean rank over the criteria; a criterion that was not measured does not count.
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
    // What differs by less than a percent shares its rank.
    let rank_in = |one: &Standing, criterion: &fn(&Standing) -> Option<f64>| {
        let bound = criterion(one)? - 0.01 * criterion(one)?.abs();
        let better = standings.iter().filter(|other| criterion(other).is_some_and(|other| other < bound));
        Some(1.0 + better.count() as f64)
    };
    let mean_rank = |one: &Standing| {
        let ranks: Vec<f64> = criteria.iter().filter_map(|criterion| rank_in(one, criterion)).collect();
        ranks.iter().sum::<f64>() / ranks.len() as f64
    };
    let ranks: Vec<f64> = standings.iter().map(mean_rank).collect();
    for (one, rank) in standings.iter_mut().zip(ranks) {
        one.rank = rank;
    }
}

/// Fewest values of a sweep.
const LEAST_VALUES: usize = 3;

/// What makes a soil hard to compress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweptStiffness {
    /// The water, by `K_w/E`.
    Water,
    /// The skeleton, by Poisson's ratio.
    Skeleton,
}

impl SweptStiffness {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Water, Self::Skeleton];

    /// Its number in a case.
    fn of(self, case: &Case) -> f64 {
        match self {
            Self::Water => case.material.water_bulk_modulus / case.material.youngs_modulus,
            Self::Skeleton => case.material.poissons_ratio,
        }
    }

    /// Whether a case differs from the seed's soil in this stiffness alone.
    fn is_alone_in(self, case: &Case) -> bool {
        let seed = Material::default();
        match self {
            Self::Water => case.material.poissons_ratio == seed.poissons_ratio,
            Self::Skeleton => case.material.water_bulk_modulus == seed.water_bulk_modulus,
        }
    }
}

/// What is measured of each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Showing {
    /// Relative L2 error of the nodal displacement.
    Displacement,
    /// Relative L2 error of the pressure at the points.
    Pressure,
    /// Oscillation index of the pressure.
    Oscillation,
}

impl Showing {
    /// Everything measured.
    pub const ALL: [Self; 3] = [Self::Displacement, Self::Pressure, Self::Oscillation];
}

/// One method at one time over all values of a stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// The method.
    pub method: Solver,
    /// Time factor of the output.
    pub time_factor: f64,
    /// What was found at each value of the sweep, in the order of [`Showing::ALL`].
    pub found: Vec<[Option<f64>; Showing::ALL.len()]>,
}

/// Every method over one stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessSweep {
    /// What varies.
    pub stiffness: SweptStiffness,
    /// Cells over the height.
    pub cells: usize,
    /// Values, ascending.
    pub values: Vec<f64>,
    /// Time factors of the outputs, ascending.
    pub time_factors: Vec<f64>,
    /// One row for each method and time.
    pub rows: Vec<SweepRow>,
}

impl StiffnessSweep {
    /// The sweep of a study's records over a stiffness on one mesh; `None` where the study has none beyond
    /// the start. Step sizes may differ: a stiffer skeleton consolidates faster.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn of(
        study: &Study,
        records: &[Record],
        stiffness: SweptStiffness,
    ) -> Result<Option<Self>, ExactError> {
        let is_swept = |record: &&Record| {
            let case = &record.case;
            record.status == Status::Ok
                && !case.is_explicit()
                && case.time_factors.last().is_some_and(|last| *last > 0.0)
                && stiffness.is_alone_in(case)
        };
        let swept = records.iter().filter(is_swept);
        // The mesh of the runs with the least compressible soil.
        let hardest = swept.clone().max_by(|a, b| {
            stiffness.of(&a.case).total_cmp(&stiffness.of(&b.case)).then(a.case.cells.cmp(&b.case.cells))
        });
        let Some(hardest) = hardest else { return Ok(None) };
        let mesh = |record: &Record| (record.case.cells, record.case.points_per_cell);
        let alike: Vec<&Record> = swept.filter(|record| mesh(record) == mesh(hardest)).collect();
        let mut values: Vec<f64> = alike.iter().map(|record| stiffness.of(&record.case)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        if values.len() < LEAST_VALUES {
            return Ok(None);
        }
        let methods = methods_of(alike.iter().copied());
        let time_factors = hardest.case.time_factors.to_vec();
        let reference = study.references[0].name();
        let found = |method: Solver, time_factor: f64, value: f64| {
            let record = alike
                .iter()
                .find(|record| record.case.method == method && stiffness.of(&record.case) == value);
            record.map_or(Ok([None; 3]), |record| found(record, time_factor, reference))
        };
        let mut rows = Vec::new();
        for time_factor in time_factors.iter().copied() {
            for method in methods.iter().copied() {
                let found = values.iter().map(|value| found(method, time_factor, *value));
                rows.push(SweepRow { method, time_factor, found: found.collect::<Result<_, _>>()? });
            }
        }
        Ok(Some(Self { stiffness, cells: hardest.case.cells, values, time_factors, rows }))
    }

    /// The rows of one output.
    pub fn at(&self, time_factor: f64) -> impl Iterator<Item = &SweepRow> {
        self.rows.iter().filter(move |row| row.time_factor == time_factor)
    }
}

fn found(record: &Record, time_factor: f64, reference: &str) -> Result<[Option<f64>; 3], ExactError> {
    let error = |quantity, sample| first_error(record, quantity, sample, reference, time_factor);
    Ok([
        error(Quantity::Displacement, Sample::Nodes),
        error(Quantity::Pressure, Sample::Points),
        PlaneField::of(record, time_factor)?.map(|field| field.oscillation_index()),
    ])
}
