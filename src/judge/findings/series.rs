//! Series of errors as plain data.

use crate::case::{Norm, Quantity, Sample};
use crate::judge::paths::{Path, StudyPaths, first_measure};
use crate::study::check::Study;
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::{Class, LimiterKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One error over levels of refinement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeriesFinding {
    /// What is refined.
    pub axis: Axis,
    /// What the runs share.
    pub runs: String,
    /// Quantity.
    pub quantity: Quantity,
    /// Places.
    pub sample: Sample,
    /// Norm.
    pub norm: Norm,
    /// Reference.
    pub reference: String,
    /// Time factor.
    pub time_factor: f64,
    /// Levels from coarse to fine.
    pub levels: Vec<LevelFinding>,
    /// Orders between neighbours, one fewer than levels.
    pub pair_orders: Vec<Option<f64>>,
    /// Order fitted to all levels.
    pub fitted_order: Option<f64>,
    /// Half of its 95 % interval.
    pub half_width: Option<f64>,
    /// Order on the finest three levels.
    pub finest_order: Option<f64>,
    /// Class.
    pub class: Class,
    /// Order that the class allows.
    pub order: Option<f64>,
    /// Height of the floor.
    pub floor: Option<f64>,
    /// Kind of what causes the floor.
    pub limiter: Option<String>,
    /// Causes that a floor might have, the largest first.
    pub causes: Vec<Undecided>,
}

/// A possible cause of a floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Undecided {
    /// Its kind: `step`, `mesh`, `points-per-cell`, `reference`, `model`, `round-off`.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// The floor it causes, where it is known.
    pub magnitude: Option<f64>,
}

/// One level of a series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LevelFinding {
    /// What is refined: m of cells, s of steps, 1/points per cell, 1/Pa of the water's stiffness.
    pub size: f64,
    /// The error, where there is one.
    pub error: Option<f64>,
}

/// Quantities and places of the series.
const MEASURED: [(Quantity, Sample); 6] = [
    (Quantity::Pressure, Sample::Points),
    (Quantity::Pressure, Sample::Centres),
    (Quantity::EffectiveStress, Sample::Points),
    (Quantity::Displacement, Sample::Nodes),
    (Quantity::Settlement, Sample::Surface),
    (Quantity::LoadFactor, Sample::Surface),
];

/// Every series with an error, over every axis, reference and time.
pub fn all_series(study: &Study, paths: &StudyPaths<'_>) -> Vec<SeriesFinding> {
    let mut found = Vec::new();
    for axis in Axis::ALL {
        for path in paths.along(axis) {
            for reference in &study.references {
                for time_factor in path.records[0].case.time_factors.iter() {
                    let of = |(quantity, sample)| {
                        let measure = first_measure(quantity, sample, reference.name(), *time_factor);
                        series_of(path, &path.own_measure(&measure))
                    };
                    found.extend(MEASURED.into_iter().filter_map(of));
                }
            }
        }
    }
    found
}

fn kind_of(kind: LimiterKind) -> String {
    let name = match kind {
        LimiterKind::Step => "step",
        LimiterKind::Mesh => "mesh",
        LimiterKind::PointsPerCell => "points-per-cell",
        LimiterKind::Reference => "reference",
        LimiterKind::Model => "model",
        LimiterKind::RoundOff => "round-off",
    };
    name.to_owned()
}

fn series_of(path: &Path<'_>, measure: &Measure) -> Option<SeriesFinding> {
    let summary = path.summary(measure);
    let levels: Vec<LevelFinding> = summary
        .series
        .levels()
        .iter()
        .map(|level| LevelFinding { size: level.size, error: level.error.filter(|error| error.is_finite()) })
        .collect();
    levels.iter().any(|level| level.error.is_some()).then(|| {
        let class = summary.classification;
        let mut causes = if class.floor.is_some() { path.limiters(measure) } else { Vec::new() };
        causes.sort_by(|a, b| b.magnitude.unwrap_or(f64::MIN).total_cmp(&a.magnitude.unwrap_or(f64::MIN)));
        let fit = summary.slope.ok();
        SeriesFinding {
            axis: path.axis,
            runs: path.label(),
            quantity: measure.quantity,
            sample: measure.sample,
            norm: measure.norm,
            reference: measure.reference.clone(),
            time_factor: measure.time_factor,
            levels,
            pair_orders: summary.pairs.into_iter().map(Result::ok).collect(),
            fitted_order: fit.map(|fit| fit.order),
            half_width: fit.and_then(|fit| fit.half_width),
            finest_order: summary.finest.ok(),
            class: class.class,
            order: class.order,
            floor: class.floor.as_ref().map(|floor| floor.value),
            limiter: class.floor.as_ref().and_then(|floor| floor.limiter).map(kind_of),
            causes: causes
                .into_iter()
                .map(|cause| Undecided {
                    kind: kind_of(cause.kind),
                    name: cause.name,
                    magnitude: cause.magnitude,
                })
                .collect(),
        }
    })
}
