//! Series of errors as plain data.

use crate::case::{Norm, Quantity, Sample};
use crate::judge::paths::{Path, StudyPaths, first_measure};
use crate::study::check::Study;
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
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
            // Over the step also the differences between neighbouring steps, which the mesh leaves alone.
            let differences = (axis == Axis::TimeStep).then_some(NEXT_FINER);
            for reference in study.references.iter().map(|reference| reference.name()).chain(differences) {
                for time_factor in path.records[0].case.time_factors.iter() {
                    let of = |(quantity, sample)| {
                        let measure = first_measure(quantity, sample, reference, *time_factor);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;

    /// A floor against the theory of incompressible water, of half the size by which it differs from that of compressible.
    #[test]
    fn a_floor_is_told_with_its_causes_the_largest_first_and_those_of_unknown_size_last() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16, 32]\n[[expect]]\nmethod = 'MPM'\ntime_factor = 0.1\n\
                    reference = 'terzaghi-incompressible'\nclass = 'floor-limited'\n";
        let (study, mut records) = solved("s", text);
        let errors = [1e-2, 2.4e-3, 1.01e-3, 1e-3];
        for record in &mut records {
            let level = [4, 8, 16, 32].iter().position(|cells| *cells == record.case.cells).expect("a mesh");
            record.errors.iter_mut().for_each(|row| row.value = errors[level]);
        }
        let found = all_series(&study, &StudyPaths::of(&records));
        let is_it = |one: &&SeriesFinding| {
            (one.quantity, one.sample) == MEASURED[0] && one.reference == "terzaghi-incompressible"
        };
        let pressure = found.iter().find(is_it).expect("a series");
        assert_eq!((pressure.class, pressure.floor.is_some()), (Class::FloorLimited, true));
        let levels: Vec<(f64, Option<f64>)> =
            pressure.levels.iter().map(|level| (level.size, level.error)).collect();
        let right = [4.0, 8.0, 16.0, 32.0].map(|cells| 1.0 / cells).into_iter().zip(errors.map(Some));
        assert_eq!(levels, right.collect::<Vec<_>>());
        assert!(pressure.pair_orders.len() == 3 && pressure.pair_orders[0] > pressure.pair_orders[1]);
        let causes: Vec<Option<f64>> = pressure.causes.iter().map(|cause| cause.magnitude).collect();
        assert!(causes.len() == 2 && causes[0].is_some_and(|model| model > 0.0), "{:?}", pressure.causes);
        assert_eq!(causes[1], None, "the step's floor is not known");
    }
}
